//! Pix4Dmapper's params folder (`PROJECT/1_initial/params`), from Pix4D's articles 202977149 "What
//! does the Output Params Folder contain?" and 202559089 "How are the Internal and External Camera
//! Parameters defined?" (support.pix4d.com).
//!
//! ```text
//! P_calibrated_camera_parameters.txt            one record a photo:
//!     name width height
//!     K in 3 lines, radial (3), tangential (2), t (3), R in 3 lines       m = K [R | -R t] X
//! P_offset.xyz                                  x y z, added to t to get the world
//! P_wkt.prj                                     the world's coordinate system
//! P_pmatrix.txt                                 name and the 12 numbers of K [R | -R t]
//! P_calibrated_external_camera_parameters.txt   imageName X Y Z Omega Phi Kappa, in the world
//! P_calibrated_external_camera_parameters_error.txt   see deviations.rs
//! P_pix4d_calibrated_internal_camera_parameters.cam    the calibration in mm
//! ```
//!
//! - R takes world coordinates to camera axes x right, y down, z forward; t is the camera CENTRE.
//!   Omega, phi, kappa are PATB's: Rx Ry Rz from (x right, y up, z back) to the world. In degrees.
//! - Pixels count from the OUTER CORNER of the top-left pixel. The articles do not say so; Pix4D's
//!   Open Photogrammetry Format does for the same parameters ("(0, 0) being at the top left corner of
//!   the top left pixel", opf-spec, calibrated_cameras), and the .cam's offsets count from W/2, H/2.
//! - Distortion: `xd = x (1 + R1 r2 + R2 r4 + R3 r6) + 2 T1 x y + T2 (r2 + 2 x2)` and alike for y:
//!   OpenCV's k1 k2 k3 p1 p2.
//! - The offset file is missing: the difference to the external parameters stands in for it; without
//!   those the coordinates stay relative, and a warning says so.
//! - pmatrix is a cross-check alone: a warning says by how many pixels it disagrees.
//! - Without the camera parameters, the external ones and the .cam of one perspective lens make a
//!   reconstruction without image sizes.
//! - A fish-eye's record has no K and no distortion (its polynomial is in the .cam, in keywords that
//!   no source states): such photos are left out, with a warning.
//! - Left out: sparse points (`*_tp_pix4d.txt` has image points only), rolling shutter,
//!   positions on WGS 84 (`*_wgs84.txt`).
//! - Opened by the folder, by any of these files, by a project folder that has `1_initial/params`, or
//!   by the .p4d beside it; a .p4d alone has no calibration. A project's one LAS or LAZ in
//!   `2_densification/point_cloud` is its surface.

mod calibrated;
mod deviations;
mod external;
mod internal;
mod project;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::files::{FileError, read_text};
use crate::geometry::median;
use crate::packages::pose_covariance::PassedOver;
use crate::packages::reconstruction::{
    ImageUnit, Origin, PosedPhoto, Project, Reconstruction, Sizes,
};
use calibrated::Calibrated;
use external::ProjectionMatrix;

const PARAMETERS: &str = "calibrated_camera_parameters.txt";
const EXTERNAL: &str = "calibrated_external_camera_parameters.txt";
const EXTERNAL_WGS84: &str = "calibrated_external_camera_parameters_wgs84.txt";
const EXTERNAL_ERRORS: &str = "calibrated_external_camera_parameters_error.txt";
const INTERNAL: &str = "calibrated_internal_camera_parameters.cam";
const OFFSET: &str = "offset.xyz";
const SYSTEM: &str = "wkt.prj";
const MATRICES: &str = "pmatrix.txt";

/// How far pmatrix.txt, whose numbers are rounded to 1e-6, may be off, in pixels.
const MATRICES_AGREE_PX: f64 = 0.1;

/// How far from the camera, in the world's unit, pmatrix.txt is compared.
const COMPARED_AT: f64 = 50.0;

/// Whether a file is one of a params folder, or a Pix4D project.
pub(crate) fn is_pix4d_file(path: &Path, name: &str) -> bool {
    if name.ends_with(".p4d")
        || [PARAMETERS, EXTERNAL, EXTERNAL_WGS84, INTERNAL]
            .iter()
            .any(|end| name.ends_with(end))
    {
        return true;
    }
    // "quarry_offset.xyz" alone may be a cloud.
    [OFFSET, SYSTEM, MATRICES]
        .iter()
        .any(|end| name.ends_with(end))
        && path.parent().is_some_and(is_params)
}

/// Whether a folder is a params folder, or of a project that has one.
pub(crate) fn has_params(path: &Path) -> bool {
    is_params(path) || is_params(&path.join(PARAMS))
}

/// Whether a folder holds a project file.
pub(crate) fn is_bare_project(path: &Path) -> bool {
    project::file_in(path).is_some()
}

/// Where a project keeps its params.
pub(crate) const PARAMS: &str = "1_initial/params";

fn is_params(path: &Path) -> bool {
    let params = Params::of_folder(path);
    let ends = [PARAMETERS, EXTERNAL];
    ends.iter().any(|end| params.ending(end).next().is_some())
}

/// Reads a params folder, or the one of a project.
///
/// # Errors
/// Names the file that is missing or cannot be used.
pub(crate) fn read(path: &Path) -> Result<Project, FileError> {
    if path.is_dir() {
        if is_params(path) {
            let all = Params::of_folder(path);
            let count = all.ending(PARAMETERS).count();
            if count > 1 {
                let what = format!("a folder with the parameters of {count} Pix4D projects");
                let remedy = format!("name the *_{PARAMETERS} of one");
                return Err(FileError::new(path, Fault::new(what, remedy)));
            }
            return params(&all);
        }
        let folder = path.join(PARAMS);
        if is_params(&folder) {
            let mut project = params(&Params::of_folder(&folder))?;
            project.surface = project::surface(path, &mut project.reconstruction.warnings);
            return Ok(project);
        }
        return match project::file_in(path) {
            Some(file) => read(&file),
            None => Err(without_calibration(path)),
        };
    }
    if path
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("p4d"))
    {
        let folder = project::results(path).ok_or_else(|| without_calibration(path))?;
        let mut found = read(&folder)?;
        found
            .reconstruction
            .warnings
            .extend(project::not_calibrated(path, &found.reconstruction));
        return Ok(found);
    }
    params(&Params::of_file(path))
}

fn without_calibration(path: &Path) -> FileError {
    let what = "a Pix4D project without calibration: it lists the photos, but there is no \
                1_initial/params folder with *_calibrated_camera_parameters.txt beside it";
    let remedy = "run Pix4D's initial processing, or give the 1_initial/params folder";
    FileError::new(path, Fault::new(what, remedy))
}

/// The files of a params folder; more than one project's may lie in it.
struct Params {
    folder: PathBuf,
    /// What the names of the project's files begin with, where it is known.
    prefix: Option<String>,
    files: Vec<(String, PathBuf)>,
}

impl Params {
    fn of_folder(folder: &Path) -> Self {
        let mut files: Vec<_> = fs::read_dir(folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| {
                let path = entry.ok()?.path();
                Some((
                    path.file_name()?.to_string_lossy().to_ascii_lowercase(),
                    path,
                ))
            })
            .collect();
        files.sort();
        let mut params = Self {
            folder: folder.to_owned(),
            prefix: None,
            files,
        };
        params.prefix = [PARAMETERS, EXTERNAL]
            .iter()
            .find_map(|end| prefix_of(&params.ending(end).next()?.0));
        params
    }

    /// The files that belong to one of them.
    fn of_file(path: &Path) -> Self {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let mut params = Self::of_folder(folder.unwrap_or(Path::new(".")));
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase();
        params.prefix = prefix_of(&name);
        params
    }

    fn ending<'a>(&'a self, end: &'a str) -> impl Iterator<Item = &'a (String, PathBuf)> {
        self.files
            .iter()
            .filter(move |(name, _)| name.ends_with(end))
    }

    /// The project's file whose name ends so, or the only one where a name does not tell whose it is.
    fn find<'a>(&'a self, end: &'a str) -> Option<&'a Path> {
        let own = |(name, _): &&(String, PathBuf)| prefix_of(name) == self.prefix;
        // Of the two .cam files Pix4D's own form comes last.
        if let Some((_, path)) = self.ending(end).filter(own).last() {
            return Some(path);
        }
        let mut ending = self.ending(end);
        let (name, path) = ending.next()?;
        let tells = |prefix: Option<String>| prefix.is_some_and(|prefix| !prefix.is_empty());
        let others = tells(prefix_of(name)) && tells(self.prefix.clone());
        (ending.next().is_none() && !others).then_some(path.as_path())
    }

    fn text<'a>(&'a self, end: &'a str) -> Result<Option<(&'a Path, String)>, FileError> {
        let Some(path) = self.find(end) else {
            return Ok(None);
        };
        Ok(Some((path, read_text(path)?)))
    }

    /// Reads a file of the folder, if it is there.
    fn parsed<T>(
        &self,
        end: &str,
        read: impl Fn(&str) -> Result<T, Fault>,
    ) -> Result<Option<T>, FileError> {
        self.text(end)?
            .map(|(path, text)| read(&text).map_err(|fault| FileError::new(path, fault)))
            .transpose()
    }
}

/// What the name of a params folder's file begins with.
fn prefix_of(name: &str) -> Option<String> {
    let ends = [
        PARAMETERS,
        EXTERNAL,
        EXTERNAL_WGS84,
        EXTERNAL_ERRORS,
        INTERNAL,
        OFFSET,
        SYSTEM,
        MATRICES,
    ];
    let prefix = ends.iter().find_map(|end| name.strip_suffix(end))?;
    Some(prefix.strip_suffix("pix4d_").unwrap_or(prefix).to_owned())
}

fn params(params: &Params) -> Result<Project, FileError> {
    let mut reconstruction = match params.parsed(PARAMETERS, calibrated::read)? {
        Some(photos) => of_parameters(params, photos)?,
        None => of_external(params)?,
    };
    take_deviations(params, &mut reconstruction)?;
    match params.text(SYSTEM)? {
        Some((_, text)) if !text.trim().is_empty() => {
            reconstruction.crs = Some(text.trim().to_owned());
        }
        _ => reconstruction.warnings.push(
            "the coordinate system is not said: there is no *_wkt.prj with a definition".to_owned(),
        ),
    }
    Ok(Project::from(reconstruction))
}

/// How sure Pix4D says the poses are, in either of the two files.
fn take_deviations(params: &Params, found: &mut Reconstruction) -> Result<(), FileError> {
    let mut stated = HashMap::new();
    for end in [EXTERNAL_ERRORS, EXTERNAL] {
        let Some((_, text)) = params.text(end)? else {
            continue;
        };
        for of_photo in deviations::read(&text) {
            stated.entry(of_photo.photo.clone()).or_insert(of_photo);
        }
    }
    if stated.is_empty() {
        return Ok(());
    }
    let mut passed_over = PassedOver::default();
    let of_photo = |photo: &PosedPhoto| {
        let stated = stated.get(&photo.name)?;
        Some(stated.of(&photo.pose, &mut passed_over))
    };
    let errors = found.photos.iter().map(of_photo);
    found.pose_errors = errors.map(Option::unwrap_or_default).collect();
    found.warnings.extend(passed_over.warning());
    Ok(())
}

fn of_parameters(params: &Params, photos: Vec<Calibrated>) -> Result<Reconstruction, FileError> {
    let mut found = Reconstruction {
        package: "pix4d",
        sizes: Sizes::Known,
        ..Reconstruction::default()
    };
    let external = params.parsed(EXTERNAL, external::read_poses)?;
    let offset = offset(params, &photos, external.as_deref(), &mut found.warnings)?;
    let matrices = params.parsed(MATRICES, external::read_matrices)?;
    let mut fisheyes = Vec::new();
    for photo in photos {
        let Some(camera) = photo.camera else {
            fisheyes.push(photo.name);
            continue;
        };
        // Each record repeats its camera.
        let same = |known: &crate::camera::Camera| {
            let mut known = known.clone();
            known.name.clear();
            known == camera
        };
        let index = found.cameras.iter().rposition(same).unwrap_or_else(|| {
            let mut camera = camera.clone();
            camera.name = (found.cameras.len() + 1).to_string();
            found.cameras.push(camera);
            found.cameras.len() - 1
        });
        found.photos.push(PosedPhoto {
            name: photo.name,
            camera: index,
            pose: photo.pose,
        });
    }
    if !fisheyes.is_empty() {
        let matter = format!(
            "{} photos have a fish-eye lens ({}), whose calibration Pix4D keeps out of \
             {PARAMETERS}",
            fisheyes.len(),
            some_of(&fisheyes)
        );
        if found.photos.is_empty() {
            let remedy = "export the project as OPF, or give undistorted photos' calibration";
            return Err(FileError::new(&params.folder, Fault::new(matter, remedy)));
        }
        found.warnings.push(format!("{matter}: they are left out"));
    }
    if let Some(matrices) = matrices {
        let disagreement = disagreement(&found, &matrices);
        found.warnings.extend(disagreement);
    }
    for photo in &mut found.photos {
        photo.pose.center += offset;
    }
    number_names(&mut found);
    Ok(found)
}

/// What leads from Pix4D's coordinates to the world.
fn offset(
    params: &Params,
    photos: &[Calibrated],
    external: Option<&[(String, Pose)]>,
    warnings: &mut Vec<String>,
) -> Result<DVec3, FileError> {
    if let Some(offset) = params.parsed(OFFSET, external::read_offset)? {
        return Ok(offset);
    }
    let known: HashMap<&str, DVec3> = external
        .unwrap_or_default()
        .iter()
        .map(|(name, pose)| (name.as_str(), pose.center))
        .collect();
    let mut differences: [Vec<f64>; 3] = Default::default();
    for photo in photos {
        if let Some(center) = known.get(photo.name.as_str()) {
            for (axis, difference) in differences.iter_mut().enumerate() {
                difference.push(center[axis] - photo.pose.center[axis]);
            }
        }
    }
    let [x, y, z] = differences.each_mut().map(|axis| median(axis));
    let (Some(x), Some(y), Some(z)) = (x, y, z) else {
        warnings.push(
            "there is no *_offset.xyz, so the coordinates are relative: what has to be added to \
             get the world's is not known"
                .to_owned(),
        );
        return Ok(DVec3::ZERO);
    };
    warnings.push(format!(
        "there is no *_offset.xyz; {x:.3} {y:.3} {z:.3} is added, by which *_{EXTERNAL} differs"
    ));
    Ok(DVec3::new(x, y, z))
}

/// By how much pmatrix.txt disagrees, where it does; before the offset is added.
fn disagreement(found: &Reconstruction, matrices: &[(String, ProjectionMatrix)]) -> Option<String> {
    let matrices: HashMap<&str, &ProjectionMatrix> = matrices
        .iter()
        .map(|(name, matrix)| (name.as_str(), matrix))
        .collect();
    let mut off = Vec::new();
    for photo in &found.photos {
        let (Some(camera), Some(matrix)) = (
            found.cameras.get(photo.camera),
            matrices.get(photo.name.as_str()),
        ) else {
            continue;
        };
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        let worst = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(|corner| {
            let pixel = corner * size;
            let ray = camera.direction_undistorted(pixel).normalize();
            let point = photo.pose.center + photo.pose.rotation * ray * COMPARED_AT;
            (matrix.pixel(point) - pixel).length()
        });
        let worst = worst.into_iter().fold(0.0, f64::max);
        if worst.is_nan() || worst > MATRICES_AGREE_PX {
            off.push((worst, photo.name.as_str()));
        }
    }
    let (worst, name) = off.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(format!(
        "*_{MATRICES} disagrees with K [R | -R t] for {} of {} photos, by up to {worst:.1} px \
         (photo '{name}'); it is not used",
        off.len(),
        found.photos.len()
    ))
}

fn of_external(params: &Params) -> Result<Reconstruction, FileError> {
    let needed = |what: &str| {
        let remedy = format!("give the whole params folder, with *_{PARAMETERS}");
        FileError::new(&params.folder, Fault::new(what, remedy))
    };
    let photos = params
        .parsed(EXTERNAL, external::read_poses)?
        .ok_or_else(|| needed(&format!("a Pix4D params folder without *_{PARAMETERS}")))?;
    let camera = params
        .parsed(INTERNAL, internal::read)?
        .ok_or_else(|| needed("Pix4D's poses without a calibration of their camera"))?;
    let mut found = Reconstruction {
        package: "pix4d",
        sizes: Sizes::Unknown {
            unit: ImageUnit::LongerSide,
            principal_points_from: Origin::Middle,
        },
        cameras: vec![camera],
        ..Reconstruction::default()
    };
    found.warnings.push(format!(
        "there is no *_{PARAMETERS}: all photos are taken as of the one camera of the .cam file"
    ));
    found.photos = photos
        .into_iter()
        .map(|(name, pose)| PosedPhoto {
            name,
            camera: 0,
            pose,
        })
        .collect();
    number_names(&mut found);
    Ok(found)
}

/// Pix4D writes no folders, so flights that were merged may share names.
fn number_names(found: &mut Reconstruction) {
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut twice = Vec::new();
    for photo in &mut found.photos {
        let count = seen.entry(photo.name.clone()).or_default();
        *count += 1;
        if *count > 1 {
            twice.push(photo.name.clone());
            photo.name = format!("{} ({count})", photo.name);
        }
    }
    if !twice.is_empty() {
        found.warnings.push(format!(
            "{} photos have the name of another ({}) and get a number behind it: which image file \
             is whose is not known",
            twice.len(),
            some_of(&twice)
        ));
    }
}

/// A few names for a sentence.
fn some_of(names: &[String]) -> String {
    let dots = if names.len() > 3 { ", ..." } else { "" };
    let named: Vec<_> = names
        .iter()
        .take(3)
        .map(|name| format!("'{name}'"))
        .collect();
    format!("{}{dots}", named.join(", "))
}
