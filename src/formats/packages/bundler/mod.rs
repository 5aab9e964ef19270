//! Bundler's `bundle.out`, from the manual ("Bundler v0.4 User's Manual", section "Output format") and
//! Bundler's source (`src/BundleIO.cpp`, `ReadBundleFile`). Other programs write it as well
//! (VisualSFM, OpenMVG, COLMAP, OpenSfM, Metashape).
//!
//! ```text
//! # Bundle file v0.3
//! <count of cameras> <count of points>
//! <camera> = [name width height]         in v0.4 only
//!            f k1 k2
//!            R                           9 numbers, row-major
//!            t                           3 numbers
//! <point>  = x y z
//!            red green blue
//!            n, then n times: camera key x y
//! ```
//!
//! - X_camera = R X + t with camera axes x right, y UP, z BACK: the camera looks along -z.
//!   p = -X_camera.xy / X_camera.z, pixel = f (1 + k1 |p|2 + k2 |p|4) p, from the MIDDLE of the image
//!   with y UP; x and y of a point's measurements likewise. Each photo has a camera of its own.
//! - A camera with f = 0 was not registered.
//! - White space only separates: the lines are as they like.
//! - v0.3 has no image sizes; the names are in `list.txt`, one line a camera (names.rs).
//! - Before v0.3 Bundler mirrored the scene; such files are refused.
//! - MVE's `synth_0.out` begins with "drews 1.0". It looks the same, but its focal lengths are in
//!   units of the longer side of images whose sizes it does not hold, its cameras look along +z,
//!   and it names no photos. It is refused.

mod names;
mod tokens;

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

use crate::camera::{Brown, Camera, Distortion, HALF_TURN_ABOUT_X, Pose};
use crate::fault::Fault;
use crate::files::{FileError, read_text};
use crate::packages::reconstruction::{
    Observation, Origin, PosedPhoto, Project, Reconstruction, Sizes,
};
use crate::poses::rounded_rotation::{from_row_major, pose_from_camera_from_world};
use names::Names;
use tokens::Tokens;

const EXPORT: &str = "export the Bundler file again";

/// Whether a file that begins with `start` is Bundler's, or MVE's of the same name.
pub(crate) fn is_bundle(start: &[u8], name: &str) -> bool {
    let first = start.trim_ascii_start();
    first.starts_with(b"# Bundle file")
        || first.starts_with(b"drews ")
        || (name.starts_with("bundle") && name.ends_with(".out"))
}

/// The `bundle.out` of a folder, or of the folder `bundle` in it, where Bundler writes it; else the
/// `bundle.rd.out` that it and VisualSFM write beside undistorted photos.
pub(crate) fn bundle_of_folder(folder: &Path) -> Option<PathBuf> {
    ["bundle.out", "bundle/bundle.out", "bundle.rd.out"]
        .map(|name| folder.join(name))
        .into_iter()
        .find(|file| file.is_file())
}

/// Reads a Bundler file and the list of its photos.
///
/// # Errors
/// With the file and the place in it.
pub(crate) fn read_file(path: &Path) -> Result<Project, FileError> {
    let mut bundle = read(&read_text(path)?).map_err(|fault| FileError::new(path, fault))?;
    let names = match &bundle.names {
        Some(names) => Names::of_bundle(names.clone()),
        None => Names::beside(path, bundle.registered.len())?,
    };
    let indices = bundle.registered_indices();
    let reconstruction = &mut bundle.reconstruction;
    let mut seen = HashSet::new();
    let cameras = reconstruction.cameras.iter_mut();
    for ((photo, camera), index) in reconstruction.photos.iter_mut().zip(cameras).zip(indices) {
        photo.name = names.name(index);
        camera.name.clone_from(&photo.name);
        if !seen.insert(photo.name.clone()) {
            let what = format!("two cameras have the photo '{}'", photo.name);
            let remedy = "give each its own name in the list of photos";
            return Err(FileError::new(path, Fault::new(what, remedy)));
        }
    }
    reconstruction.warnings.extend(names.warning);
    Ok(Project {
        photos: names.folder,
        ..Project::from(bundle.reconstruction)
    })
}

/// What a file holds; photos and cameras have no names yet.
#[derive(Debug)]
struct Bundle {
    /// One camera a photo, in their order.
    reconstruction: Reconstruction,
    /// Whether each camera of the file was registered.
    registered: Vec<bool>,
    /// The names of all cameras, in v0.4.
    names: Option<Vec<String>>,
}

impl Bundle {
    /// The cameras of the file that the photos were, in their order.
    fn registered_indices(&self) -> Vec<usize> {
        let all = self.registered.iter().enumerate();
        all.filter_map(|(index, registered)| registered.then_some(index))
            .collect()
    }
}

fn read(text: &str) -> Result<Bundle, Fault> {
    let mut tokens = Tokens::new(text);
    let with_names = read_header(&mut tokens)?;
    let cameras: u64 = tokens.whole("the count of cameras")?;
    let points: u64 = tokens.whole("the count of points")?;
    let mut bundle = Bundle {
        reconstruction: Reconstruction {
            package: "bundler",
            sizes: match with_names {
                true => Sizes::Known,
                false => Sizes::default(),
            },
            observed_from: Origin::Middle,
            ..Reconstruction::default()
        },
        registered: Vec::new(),
        names: with_names.then(Vec::new),
    };
    for _ in 0..cameras {
        read_camera(&mut tokens, &mut bundle)?;
    }
    if bundle.reconstruction.photos.is_empty() {
        let remedy = "reconstruct the scene again, and check that photos were registered";
        return Err(Fault::new("it holds no registered camera", remedy));
    }
    let mut next = 0;
    let photo_of_camera: Vec<Option<u32>> = bundle
        .registered
        .iter()
        .map(|&registered| {
            let photo = registered.then_some(next);
            next += u32::from(registered);
            photo
        })
        .collect();
    for _ in 0..points {
        read_point(&mut tokens, &photo_of_camera, &mut bundle.reconstruction)?;
    }
    let not_registered = bundle
        .registered
        .iter()
        .filter(|registered| !**registered)
        .count();
    let warnings = &mut bundle.reconstruction.warnings;
    if not_registered > 0 {
        warnings.push(format!(
            "{not_registered} of {cameras} photos were not registered and are left out"
        ));
    }
    if tokens.has_more() {
        warnings.push(format!(
            "there is more after the last point, from line {}; it is not read",
            tokens.line()
        ));
    }
    Ok(bundle)
}

/// Reads the first line; whether the file is of v0.4, which has names and sizes.
fn read_header(tokens: &mut Tokens<'_>) -> Result<bool, Fault> {
    let line = tokens.rest_of_line();
    if line.starts_with("drews") {
        return Err(Fault::at(
            1,
            "it is MVE's bundle, not Bundler's: it holds neither the image sizes that its focal \
             lengths are in units of, nor the photos' names",
            "open what MVE's scene was imported from: a COLMAP, VisualSFM, Bundler or OpenDroneMap \
             reconstruction",
        ));
    }
    let version = line
        .trim_start_matches(['#', ' '])
        .strip_prefix("Bundle file v");
    match version.map(str::trim) {
        Some("0.3") => Ok(false),
        Some("0.4") => Ok(true),
        _ => {
            let what = "only versions 0.3 and 0.4 of Bundler's format are known ('# Bundle file v0.3'); \
                        older ones are mirrored";
            Err(Fault::at(1, what, "write it with a newer Bundler"))
        }
    }
}

fn read_camera(tokens: &mut Tokens<'_>, bundle: &mut Bundle) -> Result<(), Fault> {
    let mut size = (0, 0);
    if let Some(names) = &mut bundle.names {
        names.push(tokens.word("a camera's name")?.to_owned());
        size = (
            tokens.whole("the image width")?,
            tokens.whole("the image height")?,
        );
    }
    let f = tokens.number("the focal length")?;
    let line = tokens.line();
    let (k1, k2) = (tokens.number("k1")?, tokens.number("k2")?);
    let mut rotation = [0.0; 9];
    for entry in &mut rotation {
        *entry = tokens.number("an entry of R")?;
    }
    let translation = tokens.triple("an entry of t")?;
    // Bundler writes 0, some writers -1.
    bundle.registered.push(f > 0.0);
    if f <= 0.0 {
        return Ok(());
    }
    let photo = bundle.reconstruction.photos.len();
    let (w, h) = (f64::from(size.0), f64::from(size.1));
    let camera = Camera {
        name: String::new(),
        width: size.0,
        height: size.1,
        fx: f,
        fy: f,
        cx: w / 2.0,
        cy: h / 2.0,
        skew: 0.0,
        distortion: Distortion::Brown(Brown::new([k1, k2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
    };
    if bundle.names.is_some() {
        camera
            .validate()
            .map_err(|e| Fault::at(line, e.to_string(), EXPORT))?;
    }
    bundle.reconstruction.cameras.push(camera);
    bundle.reconstruction.photos.push(PosedPhoto {
        name: String::new(),
        camera: photo,
        pose: pose(rotation, translation).map_err(|e| Fault::at(line, e, EXPORT))?,
    });
    Ok(())
}

/// The pose of x right, y up, z back axes.
fn pose(rotation: [f64; 9], translation: DVec3) -> Result<Pose, String> {
    let rotation = HALF_TURN_ABOUT_X * from_row_major(rotation);
    let pose = pose_from_camera_from_world(rotation, HALF_TURN_ABOUT_X * translation);
    pose.map_err(|e| format!("R of the camera that begins here: {e}"))
}

fn read_point(
    tokens: &mut Tokens<'_>,
    photo_of_camera: &[Option<u32>],
    found: &mut Reconstruction,
) -> Result<(), Fault> {
    let position = tokens.triple("a point's position")?;
    let point = u32::try_from(found.cloud.points.len())
        .map_err(|_| tokens.fault("more points than fragscale can count"))?;
    found.cloud.points.push(position);
    let color = tokens.triple("a point's colour")?;
    // Whole numbers, from some writers with a point.
    found
        .cloud
        .colors
        .push(color.to_array().map(|c| c.round().clamp(0.0, 255.0) as u8));
    let measurements: u64 = tokens.whole("the count of measurements")?;
    for _ in 0..measurements {
        let camera: usize = tokens.whole("a measurement's camera")?;
        let Some(&photo) = photo_of_camera.get(camera) else {
            let cameras = photo_of_camera.len();
            return Err(tokens.fault(format!(
                "a measurement in camera {camera}, where there are {cameras}, counted from 0"
            )));
        };
        tokens.word("a measurement's key")?;
        let x = tokens.number("a measured x")?;
        let y = tokens.number("a measured y")?;
        if let Some(photo) = photo {
            found.observations.push(Observation {
                photo,
                point,
                pixel: DVec2::new(x, -y),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
