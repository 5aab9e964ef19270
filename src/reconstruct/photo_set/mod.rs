//! The photos of a folder that go into a reconstruction: whose camera took them, from where.

mod found_lens;
mod given_camera;
mod in_world;
mod twins;

use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3};
use image::RgbImage;

use self::in_world::World;
use self::twins::Twins;
use crate::camera::{Camera, Distortion};
use crate::fault::{Fault, first_names};
use crate::files::{FileError, read_bytes};
use crate::formats::photos::photo_metadata::{self, PhotoMetadata};
use crate::formats::{PhotoCameras, PhotosBelow, Reconstruction, expected_deviation};
use crate::jobs::Progress;
use crate::opening::covariance::lens_deviations;
use crate::picture;

/// A photo to be reconstructed.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyPhoto {
    /// The file's name, behind that of a folder within and a slash where it lies in one.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// The place of its camera in [`PhotoSet::cameras`].
    pub camera: usize,
    /// Where it was taken.
    pub place: Option<Place>,
    /// How its camera was turned, from its axes (x right, y down, z forward) to east, north and up, where it
    /// says so.
    pub gimbal: Option<DMat3>,
}

impl SurveyPhoto {
    /// Its pixels, as many as its header says; `camera` is its own. An error says why not, as a clause.
    pub(crate) fn pixels(&self, camera: &Camera) -> Result<RgbImage, String> {
        let bytes = read_bytes(&self.path).map_err(|error| error.fault);
        // A photo that is cut off is refused: half of it would be grey, and its depths from nowhere.
        let image = bytes.and_then(|bytes| picture::decode(&bytes));
        let image = image.map_err(|fault| format!("it cannot be read ({})", fault.what))?;
        match (image.width(), image.height()) == (camera.width, camera.height) {
            true => Ok(image),
            false => Err("its pixels are not as many as its header says".to_owned()),
        }
    }
}

/// Where a photo was taken, by its own receiver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// From [`PhotoSet::origin`], metres.
    pub center: DVec3,
    /// Standard deviations towards east, north and up, metres, where they can be known.
    pub deviation: Option<DVec3>,
}

/// A camera as the photos state it.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyCamera {
    /// Its intrinsics; a guess where `focal_error` is `None`.
    pub camera: Camera,
    /// How far its focal length is expected to be off, a part of it.
    pub focal_error: Option<f64>,
    /// Whether it is a calibration that somebody gave, which is kept.
    pub is_given: bool,
}

impl SurveyCamera {
    /// Its lens as it is expected: fx fy cx cy k1 k2 p1 p2 of OpenCV's model, each with a standard deviation. A focal
    /// length that nobody states is free.
    pub(crate) fn expected(&self) -> ([f64; 8], [f64; 8]) {
        let camera = &self.camera;
        let [k1, k2, p1, p2, ..] = match &camera.distortion {
            Distortion::Brown(brown) => brown.coefficients(),
            _ => [0.0; 8],
        };
        let kept = if self.is_given { 1e-6 } else { 1.0 };
        let deviations = lens_deviations(camera, self.focal_error.unwrap_or(1.0));
        (
            [camera.fx, camera.fy, camera.cx, camera.cy, k1, k2, p1, p2],
            deviations.map(|deviation| kept * deviation),
        )
    }
}

/// A photo that is left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// The file's name.
    pub photo: String,
    /// Why, as a clause: "it cannot be read (...)".
    pub why: String,
}

/// The photos of a folder.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoSet {
    /// In the order of their names.
    pub photos: Vec<SurveyPhoto>,
    /// Their cameras.
    pub cameras: Vec<SurveyCamera>,
    /// Files that are none.
    pub left_out: Vec<LeftOut>,
    /// From where places count, metres on the grid of the world.
    pub origin: DVec3,
    /// How many photos the folder has.
    pub count: usize,
    /// What their headers leave in doubt, a sentence a cause.
    pub warnings: Vec<String>,
}

/// The focal length that is tried where nothing is known of it, in parts of the longer side: between that
/// of a drone's wide lens (0.7) and that of a camera's normal one (1.4).
const GUESSED_FOCAL: f64 = 1.0;

impl PhotoSet {
    /// The photo of that name.
    pub fn named(&self, name: &str) -> Option<&SurveyPhoto> {
        // Sorted as paths are: not quite as names.
        self.photos.iter().find(|photo| photo.name == name)
    }

    /// What is known of a model's camera, by its place there, before the adjustment: that of the first photo
    /// that it took. `None` where the model has no photo of it.
    pub(crate) fn camera_of(&self, model: &Reconstruction, camera: usize) -> Option<&SurveyCamera> {
        let taken = model.photos.iter().find(|photo| photo.camera == camera)?;
        self.cameras.get(self.named(&taken.name)?.camera)
    }

    /// The photos that lie in a folder, or, where it has none, in those that a camera made in it. `crs` is the world's, else the zone of UTM of the first place.
    ///
    /// # Errors
    /// Where the folder cannot be read or has fewer than three photos, or the coordinate system is none.
    pub fn read(folder: &Path, crs: Option<&str>, progress: &Progress) -> Result<Self, FileError> {
        let at = |fault| FileError::new(folder, fault);
        let PhotosBelow {
            photos: files,
            others: below,
            of_other_endings,
        } = PhotosBelow::read(folder)?;
        progress.stage(format!("reading the headers of {} photos", files.len()));
        let mut left_out = Vec::new();
        let mut read = Vec::new();
        let mut twins = Twins::default();
        for (done, (name, path)) in files.iter().enumerate() {
            progress
                .advance(done as u64, files.len() as u64)
                .map_err(at)?;
            let metadata = photo_metadata::read_file(path);
            let both = metadata.and_then(|metadata| Ok((metadata, twins.same_as(path)?)));
            let why = match both {
                Ok((metadata, None)) => {
                    read.push((name.clone(), path, metadata));
                    continue;
                }
                Ok((_, Some(first))) => {
                    let first = first.file_name().unwrap_or_default().to_string_lossy();
                    format!("it is a copy of {first}")
                }
                Err(error) => error.fault.what,
            };
            left_out.push(LeftOut {
                photo: name.clone(),
                why,
            });
        }
        if read.len() < 3 {
            let out = left_out.iter().take(3);
            let reasons: Vec<String> = out.map(|of| format!("{}: {}", of.photo, of.why)).collect();
            let reasons = match reasons.join("; ") {
                none if none.is_empty() => none,
                some if left_out.len() > 3 => format!(" ({some}; ...)"),
                some => format!(" ({some})"),
            };
            let what = format!(
                "{} of its {} photos can be read{reasons}; a reconstruction needs three at least",
                read.len(),
                files.len()
            );
            let remedy = match below.is_empty() {
                true if !of_other_endings.is_empty() => format!(
                    "make JPEG files with their metadata of those that are not read: {}",
                    first_names(&of_other_endings)
                ),
                true => "add photos that overlap, or name the folder in which they lie".to_owned(),
                false => format!(
                    "name one of its folders that have some: {}",
                    first_names(&below)
                ),
            };
            return Err(at(Fault::new(what, remedy)));
        }
        let headers = read
            .iter()
            .map(|(name, _, metadata)| (name.as_str(), metadata));
        let mut warnings = photo_metadata::warnings_of(headers);
        if !below.is_empty() {
            let names = first_names(&below);
            warnings.push(format!("photos in folders within it are not taken ({names}): move them to the others, or name that folder"));
        }
        if !of_other_endings.is_empty() {
            warnings.push(format!(
                "{} files are not taken, whose metadata are not read ({}): make JPEG files with their metadata of those that are photos",
                of_other_endings.len(),
                first_names(&of_other_endings)
            ));
        }
        let world = World::of(crs, read.iter().map(|(.., metadata)| metadata)).map_err(at)?;
        let mut cameras = Cameras::default();
        let photos: Vec<SurveyPhoto> = read
            .into_iter()
            .map(|(name, path, metadata)| {
                let world = world.as_ref();
                let center = world.and_then(|world| world.place(&metadata));
                let measured = metadata.place;
                let orientation = metadata.orientation.as_ref();
                SurveyPhoto {
                    name,
                    path: path.clone(),
                    camera: cameras.of(&metadata),
                    place: center.map(|center| Place {
                        center,
                        deviation: measured.and_then(expected_deviation),
                    }),
                    // East and north of the Earth are near enough those of a grid.
                    gimbal: orientation.map(|angles| angles.pose(DVec3::ZERO).rotation),
                }
            })
            .collect();
        Ok(Self {
            photos,
            cameras: cameras.all(),
            left_out,
            origin: world.map_or(DVec3::ZERO, |world| world.origin),
            count: files.len(),
            warnings,
        })
    }
}

/// The cameras found so far: those of which the photos state the focal length, then the others.
#[derive(Default)]
struct Cameras {
    stated: PhotoCameras,
    all: Vec<(Key, SurveyCamera)>,
}

#[derive(PartialEq)]
enum Key {
    Stated(usize),
    Unknown([Option<String>; 4], (u32, u32)),
}

impl Cameras {
    fn of(&mut self, photo: &PhotoMetadata) -> usize {
        let key = match self.stated.of(photo) {
            Some(place) => Key::Stated(place),
            None => {
                let device = [&photo.make, &photo.model, &photo.serial, &photo.lens];
                Key::Unknown(device.map(Clone::clone), photo.size)
            }
        };
        if let Some(place) = self.all.iter().position(|(known, _)| *known == key) {
            return place;
        }
        let stated = match key {
            Key::Stated(place) => self.stated.at(place),
            Key::Unknown(..) => None,
        };
        let camera = match stated {
            Some((camera, focal)) => SurveyCamera {
                camera: camera.clone(),
                focal_error: Some(focal.relative_error),
                is_given: false,
            },
            None => guessed(photo),
        };
        self.all.push((key, camera));
        self.all.len() - 1
    }

    fn all(self) -> Vec<SurveyCamera> {
        self.all.into_iter().map(|(_, camera)| camera).collect()
    }
}

fn guessed(photo: &PhotoMetadata) -> SurveyCamera {
    let (width, height) = photo.size;
    let focal = GUESSED_FOCAL * f64::from(width.max(height));
    SurveyCamera {
        camera: Camera {
            name: photo.model.clone().unwrap_or_else(|| "camera".to_owned()),
            width,
            height,
            fx: focal,
            fy: focal,
            cx: f64::from(width) / 2.0,
            cy: f64::from(height) / 2.0,
            skew: 0.0,
            distortion: Distortion::None,
        },
        focal_error: None,
        is_given: false,
    }
}

/// One of 4000 x 3000 px without distortion.
#[cfg(test)]
pub(crate) fn camera_of_tests(focal: f64) -> Camera {
    Camera {
        name: "DJI FC6310R".to_owned(),
        width: 4000,
        height: 3000,
        fx: focal,
        fy: focal,
        cx: 2000.0,
        cy: 1500.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}
