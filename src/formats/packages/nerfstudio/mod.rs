//! `transforms.json`, which nerfstudio and instant-ngp read, and which Polycam, Luma, Blender add-ons and
//! others write.
//!
//! Written from nerfstudio's documentation ("Data conventions") and source
//! (`data/dataparsers/nerfstudio_dataparser.py`, `cameras/camera_utils.py`) and instant-ngp's
//! `docs/nerf_dataset_tips.md` and `src/nerf_loader.cu`.
//!
//! ```text
//! {INTRINSICS, ply_file_path, applied_transform, applied_scale,
//!  frames [{file_path, transform_matrix [4][4], INTRINSICS}]}
//! INTRINSICS  fl_x fl_y cx cy w h, k1 k2 k3 k4 p1 p2, camera_model, is_fisheye,
//!             camera_angle_x camera_angle_y
//! ```
//!
//! - Intrinsics of a frame stand before those of the file. fl_y is fl_x, cx and cy the middle where they
//!   are left out. camera_angle_x is the horizontal field of view in radians, where there is no fl_x; beside one that it shows to be
//!   in millimetres the file is refused. Sizes that are left out are the photos' own.
//! - cx and cy count from the top-left corner, as COLMAP's do, which most of these files come from.
//! - transform_matrix is `world_from_camera`, row-major, with OpenGL's camera axes: x right, y UP, z BACK.
//! - camera_model: OPENCV, PINHOLE, SIMPLE_PINHOLE, SIMPLE_RADIAL, RADIAL or none is brown k1 k2 p1 p2 k3;
//!   nerfstudio's k4 of these is the term of r8, which is refused unless it is 0. OPENCV_FISHEYE and
//!   instant-ngp's is_fisheye are fisheye k1..k4. Others (nerfstudio's EQUIRECTANGULAR, ...; instant-ngp's
//!   ftheta_p0, latlong, equirectangular) are refused for their photos.
//! - The frame is the file's; applied_transform (and applied_scale) tell how the original
//!   reconstruction's was changed into it. ply_file_path is a cloud in the file's frame.
//! - file_path is relative to the file; without an extension it stands for a .png.

mod intrinsics;

use std::collections::HashMap;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::Deserialize;
use serde::de::IgnoredAny;

use self::intrinsics::RawIntrinsics;
use crate::camera::{HALF_TURN_ABOUT_X, Pose};
use crate::fault::Fault;
use crate::files::{FileError, last_segment, open_file, read_bytes};
use crate::packages::reconstruction::{PosedPhoto, Project, Reconstruction, Sizes};
use crate::photos::photo_size;
use crate::poses::rounded_rotation::{from_row_major, rounded_rotation};
use crate::text::json::parse;

/// The `transforms.json` of a folder.
pub(crate) fn transforms_of_folder(folder: &Path) -> Option<PathBuf> {
    Some(folder.join("transforms.json")).filter(|file| file.is_file())
}

/// Reads a `transforms.json` and finds the files that it names.
///
/// # Errors
/// With the file and the place in it.
pub(crate) fn read_file(path: &Path) -> Result<Project, FileError> {
    let at = |fault| FileError::new(path, fault);
    let folder = path.parent().unwrap_or(Path::new(""));
    let size_of = |photo: &str| {
        let file = open_file(&folder.join(photo)).ok()?;
        photo_size::read(BufReader::new(file)).ok()
    };
    let (reconstruction, cloud) = read(&read_bytes(path)?, size_of).map_err(at)?;
    let surface = cloud
        .map(|name| folder.join(name))
        .filter(|file| file.is_file());
    Ok(Project {
        reconstruction,
        surface,
        photos: Some(folder.to_owned()),
        ..Project::default()
    })
}

#[derive(Deserialize)]
struct RawFile {
    #[serde(flatten)]
    intrinsics: RawIntrinsics,
    frames: Vec<RawFrame>,
    ply_file_path: Option<String>,
    applied_transform: Option<IgnoredAny>,
    applied_scale: Option<f64>,
}

#[derive(Deserialize)]
struct RawFrame {
    file_path: String,
    transform_matrix: Option<Vec<Vec<f64>>>,
    #[serde(flatten)]
    intrinsics: RawIntrinsics,
}

/// Reads the cameras and poses, and the name of the cloud's file. `size_of` tells the size of a photo's
/// file, where there is one.
fn read(
    json: &[u8],
    size_of: impl Fn(&str) -> Option<(u32, u32)>,
) -> Result<(Reconstruction, Option<String>), Fault> {
    let raw: RawFile = parse(json)?;
    let mut found = Reconstruction {
        package: "nerfstudio",
        sizes: Sizes::Known,
        ..Reconstruction::default()
    };
    if raw.applied_transform.is_some() {
        found.warnings.push(
            "its frame is not that of the reconstruction that it was made from: applied_transform \
             says how it was turned"
                .to_owned(),
        );
    }
    if let Some(scale) = raw.applied_scale.filter(|scale| *scale != 1.0) {
        found.warnings.push(format!(
            "its frame is {scale} times as large as that of the reconstruction that it was made from (applied_scale): a unit that was \
             stated there is not its own"
        ));
    }
    let count = raw.frames.len();
    let mut matrices = HashMap::new();
    let mut again = 0;
    let mut kinds: Vec<RawIntrinsics> = Vec::new();
    let (mut without_pose, mut unusable) = (0, Vec::new());
    for frame in raw.frames {
        let name = photo_name(&frame.file_path, &size_of);
        match matrices.insert(name.clone(), frame.transform_matrix.clone()) {
            None => {}
            Some(matrix) if matrix == frame.transform_matrix => {
                again += 1;
                continue;
            }
            Some(_) => {
                let what = format!("two frames with different poses have the photo \"{name}\"");
                return Err(Fault::new(what, "remove one of them"));
            }
        }
        let Some(matrix) = frame.transform_matrix else {
            without_pose += 1;
            continue;
        };
        let pose = pose(&matrix).map_err(|what| {
            let what = format!("the transform_matrix of \"{name}\" {what}");
            Fault::new(
                what,
                "write it again: four rows of four numbers, a rotation and a position",
            )
        })?;
        let mut intrinsics = frame.intrinsics.or(&raw.intrinsics);
        if intrinsics.w.is_none() || intrinsics.h.is_none() {
            let Some((w, h)) = size_of(&name) else {
                return Err(Fault::new(
                    format!(
                        "it has no w and h, and there is no image file \"{name}\" to take them from"
                    ),
                    "add w and h, the image size in pixels, or put the photos where file_path says",
                ));
            };
            (intrinsics.w, intrinsics.h) = (Some(f64::from(w)), Some(f64::from(h)));
        }
        if let Some(model) = intrinsics.unsupported_model() {
            unusable.push(model);
            continue;
        }
        let camera = match kinds.iter().position(|known| *known == intrinsics) {
            Some(known) => known,
            None => {
                let number = (kinds.len() + 1).to_string();
                let camera = intrinsics.camera(number).map_err(|what| {
                    Fault::new(
                        format!("the camera of \"{name}\": {what}"),
                        "correct the number",
                    )
                })?;
                found.warnings.extend(intrinsics.contradiction(&camera));
                found.cameras.push(camera);
                kinds.push(intrinsics);
                kinds.len() - 1
            }
        };
        found.photos.push(PosedPhoto { name, camera, pose });
    }
    let mut models: Vec<String> = unusable.clone();
    models.sort_unstable();
    models.dedup();
    let models = models.join(", ");
    if found.photos.is_empty() {
        let (what, remedy) = if unusable.is_empty() {
            (
                "it holds no frame with a transform_matrix".to_owned(),
                "export the poses again",
            )
        } else {
            let remedy = "export it with a perspective or OPENCV_FISHEYE camera";
            (
                format!("fragscale does not have its camera model ({models})"),
                remedy,
            )
        };
        return Err(Fault::new(what, remedy));
    }
    if again > 0 {
        found.warnings.push(format!(
            "{again} of {count} frames stand there a second time with the same pose and are left out"
        ));
    }
    if without_pose > 0 {
        found.warnings.push(format!(
            "{without_pose} of {count} photos have no pose and are left out"
        ));
    }
    if !unusable.is_empty() {
        found.warnings.push(format!(
            "{} of {count} photos are left out: fragscale does not have their camera model ({models})",
            unusable.len()
        ));
    }
    Ok((found, raw.ply_file_path))
}

/// The name of a photo's file below the folder.
fn photo_name(file_path: &str, size_of: impl Fn(&str) -> Option<(u32, u32)>) -> String {
    let name = file_path.strip_prefix("./").unwrap_or(file_path);
    if last_segment(name).contains('.') || size_of(name).is_some() {
        return name.to_owned();
    }
    format!("{name}.png")
}

/// The pose of an OpenGL camera.
fn pose(matrix: &[Vec<f64>]) -> Result<Pose, String> {
    let mut m = [0.0; 9];
    let mut center = [0.0; 3];
    if !matches!(matrix.len(), 3 | 4) || matrix.iter().any(|row| row.len() != 4) {
        return Err("is not 4 x 4".to_owned());
    }
    for ((row, entries), center) in matrix.iter().zip(m.chunks_mut(3)).zip(&mut center) {
        entries.copy_from_slice(row.get(..3).unwrap_or(&[0.0; 3]));
        *center = row.last().copied().unwrap_or_default();
    }
    if let Some(last) = matrix.get(3)
        && last != &[0.0, 0.0, 0.0, 1.0]
    {
        return Err("has another last row than 0 0 0 1".to_owned());
    }
    let rotation = rounded_rotation(from_row_major(m)).map_err(|e| format!("is unusable: {e}"))?;
    Ok(Pose {
        rotation: rotation * HALF_TURN_ABOUT_X,
        center: DVec3::from(center),
    })
}

#[cfg(test)]
mod tests;
