//! `<sensors>` and `<cameras>` of a chunk: which photo has which camera, and its pose.
//!
//! - A `<sensor>` has an id, a label, a `type`, a `<resolution>` and one `<calibration>` or two:
//!   `class="adjusted"` is the solution, `"initial"` what it started from. Without any, Metashape's
//!   own start is made of its focal length and pixel size in mm.
//! - `<camera>`s, perhaps in `<group>`s, have an id, a `sensor_id`, a label, perhaps a
//!   `component_id`, `enabled="false"` (or 0) and `<transform>`, camera to chunk. Without a
//!   transform they are not aligned. `<reference>` is where the receiver measured them.
//! - Rigs: a sensor with `master_id` has `<rotation>` (9 numbers) and `<location>`, which lead from
//!   its axes to those of its master sensor. A camera with `master_id` has no transform; it is at
//!   master's transform * sensor's rotation and location. A rig's first camera, which carries the
//!   transform, need not be of the master sensor: its transform is the master sensor's all the same,
//!   so its own sensor's offset applies to it too (as Meta's Metashape-to-KRT converter has it).
//! - `<location_covariance>` (9 numbers, the square of the chunk's unit, in its axes) and
//!   `<rotation_covariance>` (square radians, of small turns about the camera's own axes x, y, z, after
//!   its rotation) of an aligned camera: so Agisoft's own script `save_estimated_reference.py`
//!   (github.com/agisoft-llc/metashape-scripts) takes them, and makes the standard deviations of the
//!   Reference pane of them. Those of a rig's masters and slaves are not theirs alone, and not taken.
//! - `<covariance>` of a sensor: `<params>`, names of its calibration's elements, and `<coeffs>`, the
//!   matrix row by row; the variance of f is taken, in square pixels.
//! - `<rolling_shutter>` moves the rows of a photo while it is read out: not applied, counted.

use std::collections::{HashMap, HashSet};

use glam::{DMat3, DVec3};
use roxmltree::Node;

use super::calibration;
use super::georeference::pose_of;
use super::names::{Named, distinct_names};
use super::xml::{EXPORT, attribute, child, children, is_off, line, numbers, text};
use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::packages::pose_covariance::{
    NoCovariance, PassedOver, PoseCovariance, Taken, covariance, degrees,
};
use crate::text::fields::shown;

/// A `<sensor>`.
pub(super) struct Sensor {
    /// As cameras call it.
    pub(super) id: String,
    /// Or why there is none.
    pub(super) camera: Result<Camera, Fault>,
    /// Standard deviation of its focal length, percent.
    pub(super) focal_error: Option<f64>,
    /// Its axes in those of its master.
    offset: Option<Pose>,
}

/// A `<camera>`, enabled or not.
pub(super) struct Photo<'a> {
    /// As frames and tie points call it.
    pub(super) id: &'a str,
    /// Unique among the photos.
    pub(super) name: String,
    /// Index of its sensor.
    pub(super) sensor: Option<usize>,
    /// As `<components>` call it.
    pub(super) component: Option<&'a str>,
    /// In the chunk's frame, or in the component's.
    pub(super) pose: Option<Pose>,
    /// In the same frame.
    pub(super) errors: PoseCovariance,
    /// Whether it takes part.
    pub(super) enabled: bool,
    /// What its receiver measured: x, y, z in the chunk's coordinate system.
    pub(super) measured: Option<DVec3>,
    /// Whether its rows were moved.
    pub(super) rolling_shutter: bool,
}

/// Reads the sensors of a chunk.
///
/// # Errors
/// Where a rig's numbers are none, or an id stands twice.
pub(super) fn sensors(
    chunk: Node<'_, '_>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Sensor>, Fault> {
    let Some(list) = child(chunk, "sensors") else {
        return Ok(Vec::new());
    };
    let mut labels: HashMap<&str, usize> = HashMap::new();
    for sensor in children(list, "sensor") {
        *labels.entry(label_of(sensor)).or_default() += 1;
    }
    let mut sensors = Vec::new();
    let mut ids = HashSet::new();
    let mut passed_over = PassedOver::default();
    for node in children(list, "sensor") {
        let id = node.attribute("id").unwrap_or_default();
        if !ids.insert(id) {
            return Err(twice(node, "sensor", id));
        }
        let label = label_of(node);
        let name = match labels.get(label) {
            Some(1) if !label.is_empty() => label.to_owned(),
            _ => format!("{label} (sensor {id})").trim().to_owned(),
        };
        sensors.push(Sensor {
            id: id.to_owned(),
            camera: camera_of(node, name, warnings),
            focal_error: passed_over.or_count(focal_error(node)),
            offset: offset_of(node)?,
        });
    }
    warnings.extend(passed_over.warning());
    Ok(sensors)
}

/// The standard deviation of the adjusted focal length, percent.
fn focal_error(sensor: Node<'_, '_>) -> Taken<f64> {
    let adjusted =
        children(sensor, "calibration").find(|c| c.attribute("class") == Some("adjusted"));
    let (Some(adjusted), Some(stated)) = (adjusted, child(sensor, "covariance")) else {
        return Ok(None);
    };
    let names = child(stated, "params").map_or("", text).split_whitespace();
    let names: Vec<&str> = names.collect();
    let focal = child(adjusted, "f").and_then(|f| text(f).parse::<f64>().ok());
    let (Some(at), Some(focal)) = (names.iter().position(|name| *name == "f"), focal) else {
        // It was not adjusted.
        return Ok(None);
    };
    let numbers = child(stated, "coeffs").map_or("", text).split_whitespace();
    let numbers: Vec<&str> = numbers.collect();
    let count = names.len();
    let variance = numbers
        .get(at * count + at)
        .filter(|_| numbers.len() == count * count);
    let variance = variance.and_then(|number| number.parse::<f64>().ok());
    match variance {
        Some(0.0) => Ok(None),
        Some(variance) if variance > 0.0 && variance.is_finite() && focal > 0.0 => {
            Ok(Some(100.0 * variance.sqrt() / focal))
        }
        _ => Err(NoCovariance),
    }
}

/// What an aligned camera states of its own pose.
fn pose_errors(camera: Node<'_, '_>, passed_over: &mut PassedOver) -> PoseCovariance {
    let mut stated = |name: &'static str| {
        let element = child(camera, name)?;
        let taken = numbers(element)
            .map_err(|_| NoCovariance)
            .and_then(covariance);
        passed_over.or_count(taken)
    };
    PoseCovariance {
        position: stated("location_covariance"),
        angle: stated("rotation_covariance").as_ref().map(degrees),
    }
}

fn label_of<'a>(node: Node<'a, '_>) -> &'a str {
    node.attribute("label").unwrap_or_default().trim()
}

fn twice(node: Node<'_, '_>, what: &str, id: &str) -> Fault {
    let what = format!("the {what} '{}' is there twice", shown(id));
    Fault::at(line(node), what, EXPORT)
}

fn camera_of(
    sensor: Node<'_, '_>,
    name: String,
    warnings: &mut Vec<String>,
) -> Result<Camera, Fault> {
    let of_class =
        |class: &str| children(sensor, "calibration").find(|c| c.attribute("class") == Some(class));
    let calibration = of_class("adjusted")
        .or_else(|| of_class("initial"))
        .or_else(|| child(sensor, "calibration"));
    let size = calibration::size_of(sensor);
    let kind = sensor.attribute("type").unwrap_or("frame");
    let Some(calibration) = calibration else {
        let camera = uncalibrated(sensor, kind, &name, size)?;
        warnings.push(format!(
            "camera '{name}' has no calibration; its focal length and pixel size in mm are used, which may be off by several percent"
        ));
        return Ok(camera);
    };
    if property(sensor, "film_camera").is_some_and(|value| matches!(value, "1" | "true")) {
        let what = "it is of scanned film, whose photos have fiducial marks";
        return Err(Fault::at(line(sensor), what, "use digital photos"));
    }
    let unknown = calibration::unknown(calibration);
    if !unknown.is_empty() {
        warnings.push(format!(
            "camera '{name}' has corrections that are left out: {}",
            shown(&unknown.join(", "))
        ));
    }
    let kind = calibration.attribute("type").unwrap_or(kind);
    if child(calibration, "f").is_none() && child(calibration, "fx").is_some() {
        warnings.push(format!(
            "camera '{name}' is written as PhotoScan did before 1.3 (fx, fy); p1 and p2 are taken in its manual's order"
        ));
    }
    calibration::camera(calibration, name, kind, size)
}

fn property<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    children(node, "property")
        .find(|property| property.attribute("name") == Some(name))
        .and_then(|property| property.attribute("value"))
}

/// The camera of a sensor without any calibration.
fn uncalibrated(
    sensor: Node<'_, '_>,
    kind: &str,
    name: &str,
    size: Option<(u32, u32)>,
) -> Result<Camera, Fault> {
    let at = |what: &str| Fault::at(line(sensor), what, EXPORT);
    let number = |name| {
        let number = property(sensor, name)?.trim().parse::<f64>().ok();
        number.filter(|number| number.is_finite() && *number > 0.0)
    };
    let parts = (number("focal_length"), number("pixel_width"), size);
    let (Some(focal), Some(pixel_width), Some((width, height)), "frame") =
        (parts.0, parts.1, parts.2, kind)
    else {
        return Err(at("it has no calibration"));
    };
    let pixel_height = number("pixel_height").unwrap_or(pixel_width);
    let camera = Camera {
        name: name.to_owned(),
        width,
        height,
        fx: focal / pixel_width,
        fy: focal / pixel_height,
        cx: f64::from(width) / 2.0,
        cy: f64::from(height) / 2.0,
        skew: 0.0,
        distortion: Distortion::Brown(Brown::new([0.0; 8])),
    };
    camera.validate().map_err(|error| at(&error.to_string()))?;
    Ok(camera)
}

/// Where the axes of a slave sensor lie in those of its master.
fn offset_of(sensor: Node<'_, '_>) -> Result<Option<Pose>, Fault> {
    if sensor.attribute("master_id").is_none() {
        return Ok(None);
    }
    let [x, y, z] = child(sensor, "location").map_or(Ok([0.0; 3]), numbers)?;
    let center = DVec3::new(x, y, z);
    let Some(rotation) = child(sensor, "rotation") else {
        return Ok(Some(Pose {
            rotation: DMat3::IDENTITY,
            center,
        }));
    };
    let offset = Pose::from_row_major(center, numbers(rotation)?).map_err(|error| {
        let what = format!("a sensor's rotation: {error}");
        Fault::at(line(rotation), what, EXPORT)
    })?;
    Ok(Some(offset))
}

/// Reads the cameras of a chunk, in their order. `paths` are the files of the photos by camera id,
/// where a frame names them.
///
/// # Errors
/// Where a transform is none, or an id stands twice.
pub(super) fn photos<'a>(
    chunk: Node<'a, '_>,
    sensors: &[Sensor],
    paths: &HashMap<&str, &str>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Photo<'a>>, Fault> {
    let Some(list) = child(chunk, "cameras") else {
        return Ok(Vec::new());
    };
    let nodes: Vec<_> = list
        .descendants()
        .filter(|node| node.has_tag_name("camera"))
        .collect();
    let names = distinct_names(&nodes, |node| named(*node, paths), warnings);
    let mut by_id = HashMap::new();
    for &node in &nodes {
        let id = node.attribute("id").unwrap_or_default();
        if by_id.insert(id, node).is_some() {
            return Err(twice(node, "camera", id));
        }
    }
    let sensor_of: HashMap<&str, usize> = sensors
        .iter()
        .enumerate()
        .map(|(index, sensor)| (sensor.id.as_str(), index))
        .collect();
    let mut photos = Vec::new();
    let mut passed_over = PassedOver::default();
    for (&node, name) in nodes.iter().zip(names) {
        let master = node.attribute("master_id").and_then(|id| by_id.get(id));
        let sensor_id = node.attribute("sensor_id").unwrap_or_default();
        let sensor = sensor_of.get(sensor_id).copied();
        let own = child(node, "transform").map(pose_of).transpose()?;
        let of_master = || master.and_then(|&master| child(master, "transform"));
        let offset = sensor.and_then(|index| sensors.get(index)?.offset);
        let pose = match (own, master) {
            (Some(own), Some(_)) => Some(own),
            (Some(own), None) => Some(after(&own, offset)),
            (None, _) => of_master()
                .map(pose_of)
                .transpose()?
                .map(|pose| after(&pose, offset)),
        };
        let is_own = own.is_some() && master.is_none() && offset.is_none();
        let errors = is_own.then(|| pose_errors(node, &mut passed_over));
        photos.push(Photo {
            id: node.attribute("id").unwrap_or_default(),
            name,
            sensor,
            component: node
                .attribute("component_id")
                .or_else(|| master?.attribute("component_id")),
            pose,
            errors: errors.unwrap_or_default(),
            enabled: !is_off(node, "enabled"),
            measured: child(node, "reference").and_then(measured),
            rolling_shutter: child(node, "rolling_shutter").is_some(),
        });
    }
    warnings.extend(passed_over.warning());
    Ok(photos)
}

/// The pose of a slave, given its master's and its offset.
fn after(master: &Pose, offset: Option<Pose>) -> Pose {
    offset.map_or(*master, |offset| master.carrying(&offset))
}

fn measured(reference: Node<'_, '_>) -> Option<DVec3> {
    if is_off(reference, "enabled") {
        return None;
    }
    let at = |name| attribute(reference, name);
    Some(DVec3::new(at("x")?, at("y")?, at("z")?))
}

/// What a camera may be called.
fn named<'a>(node: Node<'a, '_>, paths: &HashMap<&str, &'a str>) -> Named<'a> {
    let id = node.attribute("id").unwrap_or_default();
    let parts = match paths.get(id) {
        Some(path) => path
            .split(['/', '\\'])
            .filter(|part| !part.is_empty())
            .collect(),
        None => {
            let group = node.parent().filter(|parent| parent.has_tag_name("group"));
            let label = label_of(node);
            group
                .map(label_of)
                .into_iter()
                .chain([label])
                .filter(|part| !part.is_empty())
                .collect()
        }
    };
    Named { id, parts }
}

/// How many photos each component has.
pub(super) fn count_components<'a>(photos: &[Photo<'a>]) -> HashMap<Option<&'a str>, usize> {
    let mut counts = HashMap::new();
    for photo in photos.iter().filter(|photo| photo.pose.is_some()) {
        *counts.entry(photo.component).or_default() += 1;
    }
    counts
}
