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

use std::collections::HashMap;
use std::f64::consts::PI;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::camera::{Brown, Camera, Distortion, Fisheye, HALF_TURN_ABOUT_X, Pose};
use crate::fault::Fault;
use crate::files::{FileError, last_segment, open_file, read_bytes};
use crate::packages::reconstruction::{PosedPhoto, Project, Reconstruction, Sizes};
use crate::photos::photo_size;
use crate::poses::rounded_rotation::{from_row_major, rounded_rotation};
use crate::text::json::parse;

/// The widest field of view that a lens without a fish-eye's projection is believed, degrees: the widest that are made see about 130
/// across their longer side.
const WIDEST: f64 = 150.0;

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

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
struct RawIntrinsics {
    camera_model: Option<String>,
    is_fisheye: Option<bool>,
    w: Option<f64>,
    h: Option<f64>,
    fl_x: Option<f64>,
    fl_y: Option<f64>,
    cx: Option<f64>,
    cy: Option<f64>,
    camera_angle_x: Option<f64>,
    camera_angle_y: Option<f64>,
    ftheta_p0: Option<f64>,
    latlong: Option<bool>,
    equirectangular: Option<bool>,
    k1: Option<f64>,
    k2: Option<f64>,
    k3: Option<f64>,
    k4: Option<f64>,
    p1: Option<f64>,
    p2: Option<f64>,
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

/// How much of the world a pinhole sees across this many pixels, radians.
fn field_of_view(pixels: f64, focal: f64) -> f64 {
    2.0 * (pixels / 2.0 / focal).atan()
}

/// Whether an angle is that of another lens.
fn is_another(field_of_view: f64, angle: f64) -> bool {
    (field_of_view - angle).abs() > 0.05 * field_of_view
}

impl RawIntrinsics {
    /// These, and the file's where they say nothing.
    fn or(self, file: &Self) -> Self {
        // An angle is another word for a focal length: the frame's stands before the file's length.
        let own_x = self.fl_x.is_some() || self.camera_angle_x.is_some();
        let own_y = own_x || self.fl_y.is_some() || self.camera_angle_y.is_some();
        Self {
            camera_model: self.camera_model.or_else(|| file.camera_model.clone()),
            is_fisheye: self.is_fisheye.or(file.is_fisheye),
            w: self.w.or(file.w),
            h: self.h.or(file.h),
            fl_x: self.fl_x.or(file.fl_x.filter(|_| !own_x)),
            fl_y: self.fl_y.or(file.fl_y.filter(|_| !own_y)),
            cx: self.cx.or(file.cx),
            cy: self.cy.or(file.cy),
            camera_angle_x: self
                .camera_angle_x
                .or(file.camera_angle_x.filter(|_| !own_x)),
            camera_angle_y: self
                .camera_angle_y
                .or(file.camera_angle_y.filter(|_| !own_y)),
            ftheta_p0: self.ftheta_p0.or(file.ftheta_p0),
            latlong: self.latlong.or(file.latlong),
            equirectangular: self.equirectangular.or(file.equirectangular),
            k1: self.k1.or(file.k1),
            k2: self.k2.or(file.k2),
            k3: self.k3.or(file.k3),
            k4: self.k4.or(file.k4),
            p1: self.p1.or(file.p1),
            p2: self.p2.or(file.p2),
        }
    }

    /// Whether the lens is a fish-eye; `None` for a model that fragscale does not have.
    fn is_fisheye(&self) -> Option<bool> {
        match self.camera_model.as_deref() {
            None => Some(self.is_fisheye.unwrap_or(false)),
            Some("OPENCV_FISHEYE") => Some(true),
            Some("OPENCV" | "PINHOLE" | "SIMPLE_PINHOLE" | "SIMPLE_RADIAL" | "RADIAL") => {
                Some(self.is_fisheye.unwrap_or(false))
            }
            Some(_) => None,
        }
    }

    fn unsupported_model(&self) -> Option<String> {
        let panorama = self.latlong == Some(true) || self.equirectangular == Some(true);
        if panorama || self.ftheta_p0.is_some() {
            let model = if panorama { "a panorama" } else { "F-theta" };
            return Some(model.to_owned());
        }
        match self.is_fisheye() {
            Some(false) if self.k4.unwrap_or(0.0) != 0.0 => {
                Some("a perspective one with k4".into())
            }
            Some(_) => None,
            None => self.camera_model.clone(),
        }
    }

    /// What to say where the focal length and the angle beside it, which is only for information, are
    /// of different lenses: often a focal length of another image size. One in millimetres is refused by that angle; without it,
    /// it is named.
    fn contradiction(&self, camera: &Camera) -> Option<String> {
        let fl_x = self.fl_x?;
        let own = field_of_view(f64::from(camera.width), fl_x);
        let seen = format!(
            "camera '{}': fl_x {fl_x} px is a field of view of {:.1} degrees",
            camera.name,
            own.to_degrees()
        );
        match self.camera_angle_x {
            Some(angle) => is_another(own, angle).then(|| {
                let angle = angle.to_degrees();
                format!("{seen}, but camera_angle_x says {angle:.1}; fl_x is taken")
            }),
            None => self
                .is_too_wide(own)
                .then(|| format!("{seen}; if it is in millimetres, no scale is right")),
        }
    }

    /// Refuses a focal length that cannot be in pixels, as the angle beside it tells.
    fn check_focal(&self, width: f64, fx: f64) -> Result<(), String> {
        let own = field_of_view(width, fx);
        let angle = self.camera_angle_x.filter(|_| self.fl_x.is_some());
        match angle.filter(|angle| self.is_too_wide(own) && is_another(own, *angle)) {
            Some(angle) => Err(format!(
                "fl_x {fx} px is a field of view of {:.1} degrees, but camera_angle_x says {:.1}: fl_x counts in pixels, and this looks like millimetres",
                own.to_degrees(),
                angle.to_degrees()
            )),
            None => Ok(()),
        }
    }

    /// Whether no such lens has this field of view, radians.
    fn is_too_wide(&self, field_of_view: f64) -> bool {
        self.is_fisheye() == Some(false) && field_of_view.to_degrees() > WIDEST
    }

    fn camera(&self, name: String) -> Result<Camera, String> {
        let size = |value: Option<f64>, name: &str| {
            let count = value.unwrap_or(0.0);
            let is_size = count.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&count);
            is_size
                .then_some(count as u32)
                .ok_or_else(|| format!("{name} is {count}, not a number of pixels"))
        };
        let (width, height) = (size(self.w, "w")?, size(self.h, "h")?);
        let (w, h) = (f64::from(width), f64::from(height));
        let of_angle = |side: f64, angle: f64| {
            let is_angle = angle > 0.0 && angle < PI;
            is_angle
                .then(|| side / 2.0 / (angle / 2.0).tan())
                .ok_or_else(|| format!("the field of view is {angle} radians"))
        };
        let fx = match (self.fl_x, self.camera_angle_x) {
            (Some(fx), _) => fx,
            (None, Some(angle)) => of_angle(w, angle)?,
            (None, None) => return Err("it has neither fl_x nor camera_angle_x".to_owned()),
        };
        self.check_focal(w, fx)?;
        let fy = match (self.fl_y, self.camera_angle_y) {
            (Some(fy), _) => fy,
            // Beside a focal length the angle is only for information.
            (None, Some(angle)) if self.fl_x.is_none() => of_angle(h, angle)?,
            (None, _) => fx,
        };
        let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
        let [k1, k2, k3, k4] = [self.k1, self.k2, self.k3, self.k4].map(or_zero);
        let [p1, p2] = [self.p1, self.p2].map(or_zero);
        let distortion = if self.is_fisheye() == Some(true) {
            Distortion::Fisheye(Fisheye::new([k1, k2, k3, k4]))
        } else if [self.k1, self.k2, self.k3, self.p1, self.p2] == [None; 5] {
            Distortion::None
        } else {
            Distortion::Brown(Brown::new([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0]))
        };
        let camera = Camera {
            name,
            width,
            height,
            fx,
            fy,
            cx: self.cx.unwrap_or(w / 2.0),
            cy: self.cy.unwrap_or(h / 2.0),
            skew: 0.0,
            distortion,
        };
        camera.validate().map_err(|e| e.to_string())?;
        Ok(camera)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use proptest::prelude::*;

    use glam::DMat3;

    use super::*;

    /// Looks straight down from (5, 6, 7) with its top to north: the identity in OpenGL's axes.
    const MATRIX: &str = "[[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]";

    fn transforms(intrinsics: &str, frame: &str) -> String {
        format!(
            r#"{{{intrinsics}, "frames": [{{"file_path": "./images/a.jpg",
                "transform_matrix": {MATRIX}{frame}}}]}}"#
        )
    }

    fn camera_of(intrinsics: &str, frame: &str) -> Result<Camera, Fault> {
        let json = transforms(intrinsics, frame);
        let (mut found, _) = read(json.as_bytes(), |_| Some((800, 600)))?;
        Ok(found.cameras.remove(0))
    }

    #[test]
    fn poses_and_names() {
        let json = transforms(
            r#""fl_x": 400, "w": 800, "h": 600, "ply_file_path": "x.ply""#,
            "",
        );
        let (found, cloud) = read(json.as_bytes(), |_| None).unwrap();
        let photo = &found.photos[0];
        assert_eq!(
            (photo.name.as_str(), cloud.as_deref()),
            ("images/a.jpg", Some("x.ply"))
        );
        assert_eq!(photo.pose.center, DVec3::new(5.0, 6.0, 7.0));
        let nadir = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);
        assert_eq!(photo.pose.rotation, nadir);
        assert_eq!(photo_name("./train/r_0", |_| None), "train/r_0.png");
        assert_eq!(
            photo_name("r_0", |name| (name == "r_0").then_some((1, 1))),
            "r_0"
        );
    }

    #[test]
    fn intrinsics_in_every_form() {
        let pinhole = camera_of(r#""fl_x": 400, "w": 800, "h": 600"#, "").unwrap();
        assert_eq!(
            (pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy),
            (400.0, 400.0, 400.0, 300.0)
        );
        assert_eq!(
            (pinhole.distortion, pinhole.name.as_str()),
            (Distortion::None, "1")
        );
        // A right angle: f is half the width. The size is that of the file.
        let angle = camera_of(&format!(r#""camera_angle_x": {}"#, PI / 2.0), "").unwrap();
        assert!((angle.fx - 400.0).abs() < 1e-9 && (angle.fy - 400.0).abs() < 1e-9);
        assert_eq!((angle.width, angle.height), (800, 600));
        let all = r#""camera_model": "OPENCV", "fl_x": 401, "fl_y": 402, "cx": 403, "cy": 304, "w": 800,
            "h": 600, "k1": 0.1, "k2": 0.2, "p1": 0.3, "p2": 0.4, "k3": 0.5, "k4": 0, "camera_angle_x": 9"#;
        let opencv = camera_of(all, "").unwrap();
        assert_eq!(
            (opencv.fx, opencv.fy, opencv.cx, opencv.cy),
            (401.0, 402.0, 403.0, 304.0)
        );
        assert_eq!(
            opencv.distortion.coefficients()[..5],
            [0.1, 0.2, 0.3, 0.4, 0.5]
        );
        let fisheye = camera_of(&all.replace("OPENCV", "OPENCV_FISHEYE"), "").unwrap();
        assert_eq!(fisheye.distortion.coefficients(), [0.1, 0.2, 0.5, 0.0]);
        let ngp = camera_of(r#""fl_x": 400, "is_fisheye": true, "k1": 0.1"#, "").unwrap();
        assert_eq!(ngp.distortion.name(), "fisheye");
    }

    #[test]
    fn a_frames_intrinsics_stand_before_the_files() {
        let file = r#""fl_x": 400, "fl_y": 390, "w": 800, "h": 600, "k1": 0.1"#;
        let own = camera_of(file, r#", "fl_x": 500, "cx": 410, "k1": 0.2"#).unwrap();
        assert_eq!((own.fx, own.fy, own.cx), (500.0, 500.0, 410.0));
        assert_eq!(own.distortion.coefficients()[0], 0.2);
        let json = format!(
            r#"{{{file}, "frames": [
                {{"file_path": "a.jpg", "transform_matrix": {MATRIX}}},
                {{"file_path": "b.jpg", "transform_matrix": {MATRIX}, "fl_x": 500}},
                {{"file_path": "c.jpg", "transform_matrix": {MATRIX}}},
                {{"file_path": "d.jpg"}},
                {{"file_path": "e.jpg", "transform_matrix": {MATRIX}, "camera_model": "EQUIRECTANGULAR"}}],
               "applied_transform": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}}"#
        );
        let (found, _) = read(json.as_bytes(), |_| None).unwrap();
        let cameras: Vec<usize> = found.photos.iter().map(|photo| photo.camera).collect();
        assert_eq!(cameras, [0, 1, 0]);
        for (warning, named) in found.warnings.iter().zip([
            "applied_transform",
            "1 of 5 photos have no pose",
            "EQUIRECTANGULAR",
        ]) {
            assert!(warning.contains(named), "{warning}");
        }
        assert_eq!(found.warnings.len(), 3);
    }

    #[test]
    fn what_stands_twice_or_contradicts_itself_is_said() {
        // 400 px of a width of 800 are a right angle.
        let frame = format!(r#"{{"file_path": "a.jpg", "transform_matrix": {MATRIX}}}"#);
        let file = |angle: f64, second: &str| {
            let json = format!(
                r#"{{"fl_x": 400, "w": 800, "h": 600, "camera_angle_x": {angle}, "frames": [{frame}, {second}]}}"#
            );
            read(json.as_bytes(), |_| None)
        };
        let (found, _) = file(PI / 2.0, &frame).unwrap();
        assert_eq!(found.photos.len(), 1);
        assert!(found.warnings[0].starts_with("1 of 2 frames stand there a second time"));
        assert_eq!(found.warnings.len(), 1);
        let fault = file(PI / 2.0, &frame.replace("5]", "6]")).unwrap_err();
        assert!(fault.what.contains("different poses"), "{fault}");
        let (found, _) = file(PI / 3.0, &frame.replace("a.jpg", "b.jpg")).unwrap();
        let [warning] = &found.warnings[..] else {
            panic!("{:?}", found.warnings);
        };
        assert!(
            warning.contains("90.0 degrees, but camera_angle_x says 60.0"),
            "{warning}"
        );
    }

    /// 1500 px across 49.3 degrees are 1634 px of focal length: 35.7 is in millimetres, on a sensor of 32.8 mm. Fish-eyes see that much.
    #[test]
    fn a_focal_length_in_millimetres_is_refused() {
        let millimetres = r#""fl_x": 35.7, "w": 1500, "h": 1000"#;
        let angle = format!(
            r#"{millimetres}, "camera_angle_x": {}"#,
            49.3_f64.to_radians()
        );
        let fault = camera_of(&angle, "").unwrap_err();
        for words in ["field of view of 174.5 degrees", "says 49.3", "millimetres"] {
            assert!(fault.what.contains(words), "{fault}");
        }
        let right = angle.replace("35.7", "1634.2");
        assert!(camera_of(&right, "").is_ok());
        assert!(camera_of(&format!(r#"{angle}, "is_fisheye": true"#), "").is_ok());
        // Nothing contradicts it, and it is said.
        let json = transforms(millimetres, "");
        let (found, _) = read(json.as_bytes(), |_| None).unwrap();
        let [warning] = &found.warnings[..] else {
            panic!("{:?}", found.warnings);
        };
        assert!(
            warning.contains("174.5 degrees; if it is in millimetres"),
            "{warning}"
        );
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (intrinsics, frame, named) in [
            (r#""w": 800"#, "", "neither fl_x nor camera_angle_x"),
            (r#""fl_x": 0"#, "", "fx is 0"),
            (r#""fl_x": 1, "w": 0.5, "h": 1"#, "", "w is 0.5"),
            (r#""camera_angle_x": 4"#, "", "field of view is 4"),
            (r#""fl_x": 1, "k4": 0.1"#, "", "a perspective one with k4"),
            (
                r#""fl_x": 1, "camera_model": "EQUIRECTANGULAR""#,
                "",
                "EQUIRECTANGULAR",
            ),
            (r#""fl_x": 1, "ftheta_p0": 0.1"#, "", "F-theta"),
            (r#""fl_x": 1, "latlong": true"#, "", "a panorama"),
            (r#""fl_x": "1""#, "", "invalid type"),
            (r#""fl_x": NaN"#, "", "expected value"),
        ] {
            let fault = camera_of(intrinsics, frame).unwrap_err();
            assert!(fault.what.contains(named), "{intrinsics}: {fault}");
        }
        let json = transforms(r#""fl_x": 400"#, "");
        let fault = read(json.as_bytes(), |_| None).unwrap_err();
        assert!(fault.what.contains("no w and h"), "{fault}");
        for (from, to, named) in [
            ("[0, 0, 1, 7]", "[0, 0, 1]", "not 4 x 4"),
            ("[0, 0, 1, 7]", "[0, 0, -1, 7]", "mirrors"),
            ("[0, 0, 0, 1]", "[0, 0, 0, 2]", "last row"),
            ("[1, 0, 0, 5], ", "", "rotation"),
            (
                "\"transform_matrix\"",
                "\"x\"",
                "no frame with a transform_matrix",
            ),
        ] {
            let fault = read(json.replace(from, to).as_bytes(), |_| Some((8, 6))).unwrap_err();
            assert!(fault.what.contains(named), "{to}: {fault}");
        }
        assert!(read(br#"{"frames": []}"#, |_| None).is_err());
        for cut in 0..json.len() {
            assert!(read(&json.as_bytes()[..cut], |_| Some((8, 6))).is_err());
        }
    }

    #[test]
    fn files_are_found_beside() {
        let dir = tempfile::tempdir().unwrap();
        let json = transforms(r#""fl_x": 4, "ply_file_path": "x.ply""#, "");
        fs::create_dir(dir.path().join("images")).unwrap();
        image::RgbImage::new(8, 6)
            .save(dir.path().join("images/a.jpg"))
            .unwrap();
        fs::write(dir.path().join("transforms.json"), json).unwrap();
        let file = transforms_of_folder(dir.path()).unwrap();
        let project = read_file(&file).unwrap();
        let camera = &project.reconstruction.cameras[0];
        assert_eq!((camera.width, camera.cy, project.surface), (8, 3.0, None));
        fs::write(dir.path().join("x.ply"), "").unwrap();
        assert!(read_file(&file).unwrap().surface.is_some());
    }

    proptest! {
        #[test]
        fn damaged_files_never_panic(edits in prop::collection::vec((0_usize..2000, any::<u8>()), 1..6)) {
            let mut json = transforms(r#""fl_x": 400, "w": 800, "h": 600, "k1": 0.1"#, "").into_bytes();
            for (at, byte) in edits {
                let place = at % json.len();
                json[place] = byte;
            }
            let _ = read(&json, |_| None);
        }
    }
}
