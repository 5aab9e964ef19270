//! A calibration that somebody gives is kept to the last digit, whatever model of a lens an engine knows: for the
//! adjustment with the photos' places, pixels are those of a pinhole of the same focal lengths, and that pinhole
//! stays as it is. Before, while a model grows, the lens is one like the given one and may give way.

use std::collections::HashMap;

use cumulus3d_core::{Camera as EngineCamera, CameraModelKind, Reconstruction, Vec2};
use glam::DVec2;

use super::in_order::with_pixels;
use super::{Whose, failed};
use crate::camera::{Camera, Distortion};
use crate::fault::Fault;
use crate::photo_set::{PhotoSet, SurveyCamera};

/// The lenses of a model that are given, and its pixels as shot.
pub(super) struct GivenLenses<'a> {
    cameras: HashMap<u32, &'a Camera>,
    pixels: HashMap<u32, Vec<Vec2>>,
}

impl<'a> GivenLenses<'a> {
    /// `None` where none is.
    pub(super) fn of(model: &Reconstruction, whose: &Whose<'a>) -> Option<Self> {
        let given = whose.cameras().filter(|(_, camera)| camera.is_given);
        let cameras: HashMap<u32, &Camera> = given
            .map(|(id, SurveyCamera { camera, .. })| (id, camera))
            .collect();
        let pixels = model.images().map(|image| {
            let pixels = image.points2d().iter().map(|point| point.xy);
            (image.image_id, pixels.collect())
        });
        (!cameras.is_empty()).then(|| Self {
            pixels: pixels.collect(),
            cameras,
        })
    }

    /// The model as pinholes saw it. Where the lens has no inverse at a pixel, what was seen there is forgotten.
    ///
    /// # Errors
    /// Where the model contradicts itself.
    pub(super) fn as_pinholes(
        &self,
        model: &mut Reconstruction,
        photos: &PhotoSet,
    ) -> Result<(), Fault> {
        let mut nowhere = Vec::new();
        let pixel = |image: u32, camera: u32, number: usize, pixel: Vec2| {
            let Some(camera) = self.cameras.get(&camera) else {
                return pixel;
            };
            let ray = camera.direction_as_shot(DVec2::new(pixel.x, pixel.y));
            match ray.ok().filter(|ray| ray.z > 0.0) {
                Some(ray) => Vec2::new(
                    camera.fx * ray.x / ray.z + camera.cx,
                    camera.fy * ray.y / ray.z + camera.cy,
                ),
                None => {
                    nowhere.push((image, number));
                    pixel
                }
            }
        };
        *model = with_pixels(model, photos, pixel)?;
        for (image, number) in nowhere {
            let number = u32::try_from(number).map_err(|_| failed("reading the model"))?;
            if model
                .image(image)
                .is_some_and(|image| image.point2d(number).has_point3d())
            {
                model
                    .delete_observation(image, number)
                    .map_err(|_| failed("reading the model"))?;
            }
        }
        self.set_pinholes(model)
    }

    /// The model as the photos were shot, once it is adjusted. Its cameras have the first four numbers alone: see
    /// [`GivenLenses::write`].
    ///
    /// # Errors
    /// Likewise.
    pub(super) fn as_shot(
        &self,
        model: &mut Reconstruction,
        photos: &PhotoSet,
    ) -> Result<(), Fault> {
        let pixel = |image: u32, _, number: usize, pixel: Vec2| {
            let all = self.pixels.get(&image);
            all.and_then(|all| all.get(number))
                .copied()
                .unwrap_or(pixel)
        };
        *model = with_pixels(model, photos, pixel)?;
        Ok(())
    }

    /// Gives the model pinholes of the given focal lengths and principal points.
    fn set_pinholes(&self, model: &mut Reconstruction) -> Result<(), Fault> {
        let kind = CameraModelKind::Pinhole;
        for (&id, given) in &self.cameras {
            let numbers = vec![given.fx, given.fy, given.cx, given.cy];
            let (width, height) = (u64::from(given.width), u64::from(given.height));
            let made = EngineCamera::new(id, kind, width, height, numbers);
            let made = made.map_err(|_| failed("making a camera"))?;
            if let Some(camera) = model.camera_mut(id) {
                *camera = made;
            }
        }
        Ok(())
    }

    /// COLMAP's cameras.txt with the lenses as they are given.
    pub(super) fn write(&self, cameras: &[u8]) -> Vec<u8> {
        let text = String::from_utf8_lossy(cameras);
        let line = |line: &str| {
            let id = line.split(' ').next().and_then(|id| id.parse().ok());
            match id.and_then(|id: u32| Some((id, self.cameras.get(&id)?))) {
                Some((id, camera)) => colmap_line(id, camera),
                None => format!("{line}\n"),
            }
        };
        text.lines().map(line).collect::<String>().into_bytes()
    }
}

/// CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]: numbers read back to the same f64.
fn colmap_line(id: u32, camera: &Camera) -> String {
    let Camera {
        width,
        height,
        fx,
        fy,
        cx,
        cy,
        ..
    } = camera;
    let model = match camera.distortion {
        Distortion::Fisheye(_) => "OPENCV_FISHEYE",
        Distortion::Brown(_) => "FULL_OPENCV",
        _ => "PINHOLE",
    };
    let mut line = format!("{id} {model} {width} {height} {fx} {fy} {cx} {cy}");
    for coefficient in camera.distortion.coefficients() {
        line += &format!(" {coefficient}");
    }
    line + "\n"
}
