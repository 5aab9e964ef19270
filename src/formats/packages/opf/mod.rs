//! Open Photogrammetry Format, version 1 (PIX4Dmatic, pyopf), from its specification
//! (pix4d.github.io/opf-spec).
//!
//! ```text
//! project.opf                     items of a type, each with resources: uri, format
//!   opf-camera-list+json          cameras: id, uri of the image file
//!   opf-input-cameras+json        sensors: id, image_size_px; captures: cameras, geolocation
//!   opf-calibrated-cameras+json   sensors: id, internals; cameras: id, sensor_id, position,
//!                                 orientation_deg
//!   opf-scene-reference-frame+json    crs, base_to_canonical: scale, swap_xy, shift
//! ```
//!
//! - Rx(omega) Ry(phi) Rz(kappa) takes camera axes (x right, y up, z back) to the processing frame;
//!   position is the camera centre there.
//! - From the world to the processing frame coordinates are scaled, x and y swapped where the world's
//!   system is left-handed, and shifted. Here the shift and the scale are taken back, the swap is not:
//!   east stands in x whatever order the system's definition has. Where the vertical unit is another
//!   than the horizontal one, and the system does not say so, heights stay in the horizontal one, with a warning.
//! - Pixels count from the top-left corner of the top-left pixel.
//! - perspective: R1 R2 R3 T1 T2 are OpenCV's k1 k2 k3 p1 p2 (Pix4D's article 202559089). fisheye is
//!   read where it is OpenCV's or near it (see `polynomial_fisheye`); others and spherical ones are
//!   left out.
//! - Image sizes stand in the input cameras; without them they come from the photos.
//! - Of several resources of one format the first is read, but for camera lists: of them all. A
//!   calibrated camera that no list names is called by its number.
//! - A geolocation in EPSG:4326 or 4979 has (latitude, longitude, height), as these systems order
//!   them; others are passed over.
//! - Left out: point clouds (glTF in the processing frame), control points, constraints, rolling
//!   shutter, rigs (each of their cameras has its own pose).

mod parts;
#[cfg(test)]
mod tests;

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::de::DeserializeOwned;

use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::cameras::polynomial_fisheye;
use crate::fault::Fault;
use crate::files::{FileError, read_bytes};
use crate::geodesy::{Crs, Geographic};
use crate::packages::reconstruction::{
    ImageUnit, MeasuredPosition, Origin, PosedPhoto, Project, Reconstruction, Sizes,
};
use crate::text::json;
use parts::{
    CalibratedCameras, CalibratedSensor, CameraList, InputCameras, Internals, ProjectFile,
    SceneFrame,
};

/// The one project.opf of a folder.
pub(crate) fn project_in(folder: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(folder).ok()?;
    let is_project = |path: &PathBuf| {
        path.extension()
            .is_some_and(|end| end.eq_ignore_ascii_case("opf"))
            && path.is_file()
    };
    let mut projects = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(is_project);
    let first = projects.next()?;
    projects.next().is_none().then_some(first)
}

/// Reads a project.
///
/// # Errors
/// Names the file that is missing or cannot be used.
pub(crate) fn read(path: &Path) -> Result<Project, FileError> {
    let project: ProjectFile = parsed(path)?;
    let resources = Resources {
        folder: path.parent().unwrap_or(Path::new("")),
        project: &project,
    };
    let calibrated: CalibratedCameras =
        resources.first("opf-calibrated-cameras")?.ok_or_else(|| {
            let what = "an OPF project without calibrated cameras";
            let remedy = "calibrate the project, and export it again";
            FileError::new(path, Fault::new(what, remedy))
        })?;
    let inputs: InputCameras = resources.first("opf-input-cameras")?.unwrap_or_default();
    let frame: Option<SceneFrame> = resources.first("opf-scene-reference-frame")?;
    let mut names: HashMap<u64, String> = HashMap::new();
    for list in resources.all::<CameraList>("opf-camera-list")? {
        names.extend(
            list.cameras
                .iter()
                .map(|camera| (camera.id, parts::file_name(&camera.uri))),
        );
    }
    let mut found = Reconstruction {
        package: "opf",
        ..Reconstruction::default()
    };
    let sensors = sensors(&calibrated.sensors, &inputs, &mut found.warnings);
    let at_cameras = |fault| FileError::new(path, fault);
    // All or none: where one size is not known, all come from the photos.
    found.sizes = match sensors.values().flatten().any(|camera| camera.width == 0) {
        true => Sizes::Unknown {
            unit: ImageUnit::Pixel,
            principal_points_from: Origin::Corner,
        },
        false => Sizes::Known,
    };
    let world = World::of(frame.as_ref(), &mut found.warnings).map_err(at_cameras)?;
    add_photos(&mut found, &calibrated, sensors, &names, &world);
    found.crs = frame
        .map(|frame| frame.crs.definition)
        .filter(|crs| !crs.trim().is_empty());
    if found.photos.is_empty() {
        let what = found
            .warnings
            .first()
            .map_or("no camera is calibrated", String::as_str);
        let what = format!("an OPF project of which no photo can be read: {what}");
        return Err(at_cameras(Fault::new(
            what,
            "calibrate the project, and export it again",
        )));
    }
    let posed: HashSet<u64> = calibrated.cameras.iter().map(|camera| camera.id).collect();
    let missing = inputs.captures.iter().flat_map(|capture| &capture.cameras);
    let missing = missing.filter(|camera| !posed.contains(&camera.id)).count();
    if missing > 0 {
        let warning = format!("{missing} photos were not calibrated and are left out");
        found.warnings.push(warning);
    }
    if resources.has("model/gltf") {
        found
            .warnings
            .push("its point clouds (glTF) are not read: name a surface".to_owned());
    }
    add_measured(&mut found, &inputs, &names);
    Ok(Project::from(found))
}

fn parsed<T: DeserializeOwned>(path: &Path) -> Result<T, FileError> {
    json::parse(&read_bytes(path)?).map_err(|fault| FileError::new(path, fault))
}

/// The files that a project names.
struct Resources<'a> {
    folder: &'a Path,
    project: &'a ProjectFile,
}

impl Resources<'_> {
    fn paths(&self, format: &str) -> impl Iterator<Item = PathBuf> {
        let resources = self.project.items.iter().flat_map(|item| &item.resources);
        resources
            .filter(move |resource| resource.format.contains(format))
            .map(|resource| self.folder.join(parts::path_of(&resource.uri)))
    }

    fn has(&self, format: &str) -> bool {
        self.paths(format).next().is_some()
    }

    fn first<T: DeserializeOwned>(&self, format: &str) -> Result<Option<T>, FileError> {
        self.paths(format)
            .next()
            .map(|path| parsed(&path))
            .transpose()
    }

    fn all<T: DeserializeOwned>(&self, format: &str) -> Result<Vec<T>, FileError> {
        self.paths(format).map(|path| parsed(&path)).collect()
    }
}

/// The camera of each sensor; `None` for those that cannot be modelled.
fn sensors(
    calibrated: &[CalibratedSensor],
    inputs: &InputCameras,
    warnings: &mut Vec<String>,
) -> HashMap<u64, Option<Camera>> {
    let sizes: HashMap<u64, [u32; 2]> = inputs
        .sensors
        .iter()
        .map(|sensor| (sensor.id, sensor.image_size_px))
        .collect();
    let mut cameras = HashMap::new();
    for sensor in calibrated {
        let [width, height] = sizes.get(&sensor.id).copied().unwrap_or([0, 0]);
        let id = sensor.id;
        let camera = match camera(sensor, width, height) {
            Ok((camera, off)) => {
                let said = |off| format!("sensor {id}: its fish-eye is fitted, to {off:.3} px");
                warnings.extend(off.map(said));
                Some(camera)
            }
            Err(why) => {
                warnings.push(format!("photos of sensor {id} are left out: {why}"));
                None
            }
        };
        cameras.insert(id, camera);
    }
    cameras
}

/// The camera, and by how many pixels it is off where it had to be fitted.
fn camera(
    sensor: &CalibratedSensor,
    width: u32,
    height: u32,
) -> Result<(Camera, Option<f64>), String> {
    let blank = |[cx, cy]: [f64; 2]| Camera {
        name: sensor.id.to_string(),
        width,
        height,
        fx: 1.0,
        fy: 1.0,
        cx,
        cy,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let (camera, off) = match &sensor.internals {
        Internals::Perspective {
            principal_point_px,
            focal_length_px,
            radial_distortion: [r1, r2, r3],
            tangential_distortion: [t1, t2],
        } => {
            let plain = [*r1, *r2, *r3, *t1, *t2] == [0.0; 5];
            let brown = Brown::new([*r1, *r2, *t1, *t2, *r3, 0.0, 0.0, 0.0]);
            let camera = Camera {
                fx: *focal_length_px,
                fy: *focal_length_px,
                distortion: if plain {
                    Distortion::None
                } else {
                    Distortion::Brown(brown)
                },
                ..blank(*principal_point_px)
            };
            (camera, None)
        }
        Internals::Fisheye {
            principal_point_px,
            affine,
            polynomial,
        } => polynomial_fisheye::with_lens(blank(*principal_point_px), *affine, polynomial)?,
        Internals::Other => return Err("its camera model is not perspective or fish-eye".into()),
    };
    if camera.fx > 0.0 && camera.fy > 0.0 {
        Ok((camera, off))
    } else {
        Err(format!("its focal length is {} px", camera.fx))
    }
}

/// The way from the processing frame to the world.
struct World {
    shift: DVec3,
    /// Along each axis.
    scale: DVec3,
}

impl World {
    fn of(frame: Option<&SceneFrame>, warnings: &mut Vec<String>) -> Result<Self, Fault> {
        let Some(frame) = frame else {
            warnings
                .push("the project says no reference frame: coordinates are its own".to_owned());
            return Ok(Self {
                shift: DVec3::ZERO,
                scale: DVec3::ONE,
            });
        };
        let transform = &frame.base_to_canonical;
        let [x, y, z] = transform.scale;
        if x != y || x <= 0.0 {
            let what = format!("the reference frame scales by {x}, {y}, {z}");
            return Err(Fault::new(what, "export the project in a metric system"));
        }
        // A system that says what its heights count in has them in that; of another nobody would know.
        let crs = Crs::understand(&frame.crs.definition);
        let says_heights = crs.is_ok_and(|crs| crs.heights_factor() != 1.0);
        if z != x && !says_heights {
            warnings.push(format!(
                "heights are in the unit of the horizontal axes: the system's own are {} times \
                 theirs",
                x / z
            ));
        }
        Ok(Self {
            shift: DVec3::from_array(transform.shift),
            scale: DVec3::new(x, x, if says_heights { z } else { x }),
        })
    }

    fn point(&self, point: DVec3) -> DVec3 {
        (point - self.shift) / self.scale
    }
}

fn add_photos(
    found: &mut Reconstruction,
    calibrated: &CalibratedCameras,
    sensors: HashMap<u64, Option<Camera>>,
    names: &HashMap<u64, String>,
    world: &World,
) {
    let mut index_of: HashMap<u64, usize> = HashMap::new();
    let mut nameless = 0;
    let mut lensless = 0;
    let mut used: HashSet<String> = HashSet::new();
    for camera in &calibrated.cameras {
        let Some(Some(model)) = sensors.get(&camera.sensor_id) else {
            lensless += 1;
            continue;
        };
        let index = *index_of.entry(camera.sensor_id).or_insert_with(|| {
            found.cameras.push(model.clone());
            found.cameras.len() - 1
        });
        let mut name = names.get(&camera.id).cloned().unwrap_or_else(|| {
            nameless += 1;
            camera.id.to_string()
        });
        if !used.insert(name.clone()) {
            // Image files of several folders may share a name; their numbers differ.
            name = format!("{name} ({})", camera.id);
            found.warnings.push(format!(
                "two photos have one file name: one is called '{name}'"
            ));
        }
        let center = world.point(DVec3::from_array(camera.position));
        found.photos.push(PosedPhoto {
            name,
            camera: index,
            pose: Pose::from_omega_phi_kappa(center, camera.orientation_deg),
        });
    }
    for (count, what) in [
        (
            nameless,
            "are in no camera list and called by their numbers",
        ),
        (
            lensless,
            "have no calibration that can be read and are left out",
        ),
    ] {
        if count > 0 {
            found.warnings.push(format!("{count} photos {what}"));
        }
    }
}

fn add_measured(found: &mut Reconstruction, inputs: &InputCameras, names: &HashMap<u64, String>) {
    for capture in &inputs.captures {
        let (Some(place), Some(name)) = (
            &capture.geolocation,
            names.get(&capture.reference_camera_id),
        ) else {
            continue;
        };
        let system = place.crs.definition.trim();
        if ["EPSG:4326", "EPSG:4979"]
            .iter()
            .any(|known| system.starts_with(known))
        {
            let [latitude, longitude, height] = place.coordinates;
            found.measured_positions.push(MeasuredPosition {
                photo: name.clone(),
                position: Geographic {
                    longitude,
                    latitude,
                    height,
                },
            });
        }
    }
}
