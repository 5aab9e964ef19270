//! What is true of a simulated flight: corner points and scales of the noise-free geometry, met by
//! the lab's own rays (not by `surface` and `scale`, which are to be tested against them), the best
//! line through each photo's scale, and the sizes of all fragments. Where errors were drawn into what
//! is written, what was written stands beside it.

mod field;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::flight_plan::Shot;
use super::scene::{Scene, SceneCaster, Thing};
use super::written::Written;
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::Ray;

/// Density of the rock, kg/m3: granite.
pub(super) const DENSITY: f64 = 2700.0;

/// An image whose truth is looked for.
#[derive(Debug, Clone, Copy)]
struct Image<'a> {
    camera: &'a Camera,
    /// In the lab's frame.
    pose: Pose,
    /// The photo as shot, or else the undistorted one.
    as_shot: bool,
}

impl Image<'_> {
    /// The direction of a pixel in camera axes; `None` where the lens has none.
    fn direction(&self, pixel: DVec2) -> Option<DVec3> {
        match self.as_shot {
            true => self.camera.direction_as_shot(pixel).ok(),
            false => Some(self.camera.direction_undistorted(pixel)),
        }
    }
}

/// The truth of a flight, as the JSON of truth.json. `origin` is added to every point.
///
/// # Errors
/// Where the scene cannot be met.
pub(super) fn truth(
    scene: &Scene,
    camera: &Camera,
    shots: &[Shot],
    written: &Written,
    origin: DVec3,
) -> Result<Value, Fault> {
    let photo = |(index, shot): (usize, &Shot)| {
        let mut caster = scene.caster()?;
        let pose = |(center, [tilt, pan]): (DVec3, [f64; 2])| json!({"center": (center + origin).to_array(), "tilt": tilt, "pan": pan});
        let mut image = |as_shot| {
            let pose = shot.pose();
            let image = Image {
                camera,
                pose,
                as_shot,
            };
            image_truth(&mut caster, &image, origin)
        };
        let mut value = json!({
            "photo": shot.name,
            "planned": pose(shot.planned),
            "actual": pose(shot.actual),
            "undistorted": image(false),
            "as_shot": image(true),
        });
        if let Some(pose) = written.pose(index)
            && written.differs()
        {
            value["written"] = json!({
                "center": (pose.center + origin).to_array(),
                "rotation": pose.rotation.transpose().to_cols_array(),
            });
        }
        Ok(value)
    };
    let photos: Vec<Value> = shots
        .par_iter()
        .enumerate()
        .map(photo)
        .collect::<Result<_, Fault>>()?;
    let pile = scene.pile();
    let fragments: Vec<Value> = pile
        .fragments
        .iter()
        .map(|fragment| {
            let volume = pile.volume(fragment);
            // Five digits: a ten-thousandth of a fragment.
            let digits = |x: f64| format!("{x:.4e}").parse::<f64>().unwrap_or(x);
            json!([digits(fragment.size), digits(volume)])
        })
        .collect();
    let spheres: Vec<Value> = scene
        .spheres()
        .iter()
        .map(|sphere| {
            json!({"center": (sphere.center + origin).to_array(), "diameter": sphere.radius * 2.0})
        })
        .collect();
    let mut truth = json!({
        "unit": "m",
        "photos": photos,
        "spheres": spheres,
        "density_kg_per_m3": DENSITY,
        "fragment_columns": ["sieve_size_m", "volume_m3"],
        "fragments": fragments,
    });
    if written.differs() {
        // How many times too long what is written is.
        truth["written"] = json!({
            "focal_factor": written.focal_factor(),
            "world_factor": written.world_factor(),
        });
    }
    Ok(truth)
}

/// Corners, edge scales (pixels per metre) and the best line of one image.
fn image_truth(caster: &mut SceneCaster<'_>, image: &Image<'_>, origin: DVec3) -> Value {
    let (camera, pose) = (image.camera, image.pose);
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(u, v)| {
        let in_camera = image.direction(DVec2::new(u, v));
        let direction = (pose.rotation * in_camera?).normalize();
        let ray = Ray {
            origin: pose.center,
            direction,
        };
        caster
            .cast_at_surface(&ray)
            .map(|met| (direction * met.t, met))
    });
    let scale = |pixels: f64, a: usize, b: usize| {
        let (a, b) = (corners[a].as_ref()?, corners[b].as_ref()?);
        Some(pixels / (a.0 - b.0).length())
    };
    let points = corners.iter().map(|corner| {
        corner.as_ref().map(|(_, met)| {
            let on = match met.thing {
                Thing::Ground => json!("ground"),
                Thing::Fragment(index) => json!(index + 1),
                // Not met at the surface.
                Thing::Sphere(_) => Value::Null,
            };
            json!({"point": (met.point + origin).to_array(), "on": on})
        })
    });
    let fitted = field::fitted(&field::samples(caster, image));
    json!({
        "corners": points.collect::<Vec<_>>(),
        "scale": {
            "top": scale(w, 0, 1), "right": scale(h, 1, 2),
            "bottom": scale(w, 3, 2), "left": scale(h, 0, 3),
        },
        "fitted": fitted.map(field::Fitted::to_json),
    })
}
