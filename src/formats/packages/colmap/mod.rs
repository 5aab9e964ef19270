//! A COLMAP model: a folder with `cameras`, `images` and `points3D`, each as `.bin` or as `.txt`
//! (COLMAP's documentation, "Output Format"; the files themselves: `text.rs`,
//! `binary.rs`, `models.rs`).
//!
//! - Where a folder holds both kinds, COLMAP prefers the binary one, and so does this reader.
//! - `points3D` may be missing: then there are no points and no observations.
//! - `rigs` and `frames`, which COLMAP writes since 3.12, are not needed: `images` holds every
//!   image's pose as before.
//! - A project folder keeps its models in `sparse/0`, `sparse/1`, ... (the mapper) or in `sparse`
//!   (the undistorter). The parts 0, 1, ... do not share a frame, so only the first is read.
//! - CAMERA_ID, IMAGE_ID and POINT3D_ID are identifiers, not indices: they have gaps and no order.

mod binary;
mod models;
mod text;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt::Display;
use std::fs;
use std::hash::Hash;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::surface::Cloud;

use crate::FileError;
use crate::Observation;
use crate::PosedPhoto;
use crate::Reconstruction;
use crate::Sizes;
use crate::read_bytes;
use crate::read_text;

/// An image of COLMAP's.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Image {
    /// IMAGE_ID.
    pub(crate) id: u32,
    /// Where it stands in a text file.
    pub(crate) line: Option<u64>,
    /// CAMERA_ID.
    pub(crate) camera: u32,
    /// Relative to the project's image folder.
    pub(crate) name: String,
    /// Already `world_from_camera`.
    pub(crate) pose: Pose,
    /// POINT3D_ID and pixel of the measured points that belong to a 3D point.
    pub(crate) observed: Vec<(u64, DVec2)>,
}

/// A 3D point of COLMAP's.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Point {
    /// POINT3D_ID.
    pub(crate) id: u64,
    /// In the model's frame.
    pub(crate) position: DVec3,
    /// Red, green, blue.
    pub(crate) color: [u8; 3],
}

/// The pose of QW QX QY QZ and TX TY TZ, or what is wrong with them.
pub(crate) fn pose([w, x, y, z]: [f64; 4], translation: DVec3) -> Result<Pose, String> {
    let squared = w * w + x * x + y * y + z * z;
    let pose =
        Pose::from_camera_from_world([x, y, z, w], translation).map_err(|e| e.to_string())?;
    if squared.is_finite() && pose.center.is_finite() {
        return Ok(pose);
    }
    Err("the numbers of its pose are too large".to_owned())
}

/// The two kinds of files, the preferred one first.
const KINDS: [&str; 2] = ["bin", "txt"];

/// The kind of the model that lies in a folder, `None` where there is none.
fn kind_of_model(folder: &Path) -> Option<&'static str> {
    KINDS.into_iter().find(|kind| {
        ["cameras", "images"]
            .into_iter()
            .all(|part| folder.join(format!("{part}.{kind}")).is_file())
    })
}

const PARTS: [&str; 3] = ["cameras", "images", "points3D"];

/// Whether a file is called as a part of a model; `name` is in lower case.
pub(crate) fn is_part(name: &str) -> bool {
    PARTS.iter().any(|part| {
        let rest = name.strip_prefix(&part.to_ascii_lowercase());
        matches!(rest, Some(".bin" | ".txt"))
    })
}

/// What is wrong with a folder that holds a part of a model.
pub(crate) fn incomplete(dir: &Path) -> Option<Fault> {
    let has = |part: &str| {
        [".bin", ".txt"]
            .iter()
            .any(|end| dir.join(format!("{part}{end}")).is_file())
    };
    let missing = PARTS.into_iter().find(|part| !has(part))?;
    PARTS.into_iter().any(has).then(|| {
        Fault::new(
            format!("a COLMAP model without {missing}.bin or {missing}.txt"),
            "copy the whole model",
        )
    })
}

/// The folder of the model that `dir` stands for: itself, its `sparse/0` or its `sparse`, whichever
/// first holds cameras and images; `None` where none does.
pub(crate) fn model_folder(dir: &Path) -> Option<PathBuf> {
    let sparse = dir.join("sparse");
    [dir.to_owned(), sparse.join("0"), sparse]
        .into_iter()
        .find(|folder| kind_of_model(folder).is_some())
}

/// The folders of all models that `dir` may stand for: itself, its `sparse` and what lies in that, of
/// which `most` entries are looked at.
pub(crate) fn models_in(dir: &Path, most: usize) -> Vec<PathBuf> {
    let sparse = dir.join("sparse");
    let entries = fs::read_dir(&sparse).into_iter().flatten().flatten();
    let mut parts: Vec<PathBuf> = entries.take(most).map(|entry| entry.path()).collect();
    parts.sort_unstable();
    let folders = [dir.to_owned(), sparse].into_iter().chain(parts);
    folders
        .filter(|folder| kind_of_model(folder).is_some())
        .collect()
}

/// How many images a model has, where that is quick to tell: a binary one begins with it, a text says
/// it in a comment.
pub(crate) fn count_of_images(folder: &Path) -> Option<usize> {
    let kind = kind_of_model(folder)?;
    let mut start = Vec::new();
    let file = fs::File::open(folder.join(format!("images.{kind}"))).ok()?;
    file.take(1024).read_to_end(&mut start).ok()?;
    if kind == "bin" {
        let count: [u8; 8] = start.get(..8)?.try_into().ok()?;
        return usize::try_from(u64::from_le_bytes(count)).ok();
    }
    let text = String::from_utf8_lossy(&start);
    let line = text
        .lines()
        .find(|line| line.starts_with("# Number of images:"))?;
    let number = line.split(':').nth(1)?.split(',').next()?;
    number.trim().parse().ok()
}

/// Reads the COLMAP model in `dir`, or in the `sparse/0` or `sparse` of a project folder.
///
/// The frame is the model's own, the length unit too. Photos and points keep the files' order;
/// a photo's name is its path below the project's image folder.
///
/// # Errors
/// Where there is no model, a file cannot be read or is damaged, two things share an identifier, or
/// a camera has a lens that fragscale does not know.
pub(crate) fn read_folder(dir: &Path) -> Result<Reconstruction, FileError> {
    let found = model_folder(dir).and_then(|folder| Some((kind_of_model(&folder)?, folder)));
    let Some((kind, folder)) = found else {
        let what = "it holds no COLMAP model";
        let remedy = "name the folder with cameras.txt and images.txt, or .bin (often sparse/0)";
        return Err(FileError::new(dir, Fault::new(what, remedy)));
    };
    let file = |part: &str| folder.join(format!("{part}.{kind}"));
    let (cameras_file, images_file, points_file) =
        (file("cameras"), file("images"), file("points3D"));
    let binary = kind == "bin";
    let cameras = read_part(
        &cameras_file,
        binary,
        binary::read_cameras,
        text::read_cameras,
    )?;
    let images = read_part(&images_file, binary, binary::read_images, text::read_images)?;
    let points = if points_file.exists() {
        let points = read_part(&points_file, binary, binary::read_points, text::read_points)?;
        Some(points)
    } else {
        None
    };

    let mut model = Reconstruction {
        package: "colmap",
        sizes: Sizes::Known,
        ..Reconstruction::default()
    };
    let camera_of_id = indices("CAMERA_ID", cameras.iter().map(|(id, _)| *id))
        .map_err(|fault| FileError::new(&cameras_file, fault))?;
    let point_of_id = indices("POINT3D_ID", points.iter().flatten().map(|point| point.id))
        .map_err(|fault| FileError::new(&points_file, fault))?;
    model.cameras = cameras.into_iter().map(|(_, camera)| camera).collect();
    let unknown = add_photos(&mut model, images, &camera_of_id, &point_of_id)
        .map_err(|fault| FileError::new(&images_file, fault))?;
    if points.is_none() {
        model.warnings.push(format!(
            "there is no points3D.{kind}: the reconstruction has no points, and its {unknown} \
             observations are left out"
        ));
    } else if unknown > 0 {
        model.warnings.push(format!(
            "left out: {unknown} observations of 3D points that points3D.{kind} does not have"
        ));
    }
    let points = points.unwrap_or_default();
    model.cloud = Cloud {
        points: points.iter().map(|point| point.position).collect(),
        colors: points.iter().map(|point| point.color).collect(),
        triangles: Vec::new(),
    };
    warn_of_further_models(&mut model.warnings, dir, &folder);
    Ok(model)
}

/// One file of the model, by the reader for its kind.
fn read_part<T>(
    file: &Path,
    binary: bool,
    from_bytes: impl Fn(&[u8]) -> Result<T, Fault>,
    from_text: impl Fn(&str) -> Result<T, Fault>,
) -> Result<T, FileError> {
    let read = if binary {
        from_bytes(&read_bytes(file)?)
    } else {
        from_text(&read_text(file)?)
    };
    read.map_err(|fault| FileError::new(file, fault))
}

/// Adds the images' photos and observations; returns how many observations name unknown points.
fn add_photos(
    model: &mut Reconstruction,
    images: Vec<Image>,
    camera_of_id: &HashMap<u32, u32>,
    point_of_id: &HashMap<u64, u32>,
) -> Result<u64, Fault> {
    if images.is_empty() {
        let remedy = "reconstruct the scene in COLMAP first, or name another model";
        return Err(Fault::new("it holds no image", remedy));
    }
    indices("IMAGE_ID", images.iter().map(|image| image.id))?;
    indices("NAME", images.iter().map(|image| image.name.as_str()))?;
    let mut unknown = 0;
    for (photo, image) in (0..).zip(images) {
        let Some(&camera) = camera_of_id.get(&image.camera) else {
            let what = format!(
                "image '{}' uses camera id {}, which the cameras file does not have",
                image.name, image.camera
            );
            return Err(Fault {
                line: image.line,
                ..Fault::new(what, EXPORT)
            });
        };
        for (id, pixel) in image.observed {
            match point_of_id.get(&id) {
                Some(&point) => model.observations.push(Observation {
                    photo,
                    point,
                    pixel,
                }),
                None => unknown += 1,
            }
        }
        model.photos.push(PosedPhoto {
            name: image.name,
            camera: camera as usize,
            pose: image.pose,
        });
    }
    Ok(unknown)
}

const EXPORT: &str = "export the whole model from COLMAP again";

/// Where each identifier stands; the same one twice is an error.
fn indices<K: Eq + Hash + Display>(
    kind: &str,
    ids: impl Iterator<Item = K>,
) -> Result<HashMap<K, u32>, Fault> {
    let mut indices = HashMap::new();
    for (index, id) in (0..).zip(ids) {
        match indices.entry(id) {
            Entry::Occupied(entry) => {
                let what = format!("the {kind} '{}' is there twice", entry.key());
                return Err(Fault::new(what, EXPORT));
            }
            Entry::Vacant(entry) => {
                entry.insert(index);
            }
        }
    }
    Ok(indices)
}

/// Says so where the mapper split the project into models that are not read.
fn warn_of_further_models(warnings: &mut Vec<String>, dir: &Path, folder: &Path) {
    let sparse = dir.join("sparse");
    if folder != sparse.join("0") {
        return;
    }
    let further: Vec<String> = (1_u32..)
        .map(|index| index.to_string())
        .take_while(|index| kind_of_model(&sparse.join(index)).is_some())
        .collect();
    if !further.is_empty() {
        warnings.push(format!(
            "only the model sparse/0 is read; the project also has sparse/{}, each in its own frame",
            further.join(", sparse/")
        ));
    }
}

#[cfg(test)]
mod tests;
