//! OpenSfM's `reconstruction.json`.
//!
//! Written from OpenSfM's documentation ("Dataset Structure", "Reconstruction file format";
//! "Geometric Models", coordinate systems) and `opensfm/io.py` (`reconstruction_from_json`).
//!
//! ```text
//! [RECONSTRUCTION, ...]           the one with most shots first; shots of different ones have
//!                                 nothing in common, not even a frame
//! RECONSTRUCTION {
//!   cameras        {name: model}                             see camera.rs
//!   shots          {name: {camera, rotation [3], translation [3], gps_position [3], gps_dop,
//!                          covariance [6][6]}}                see covariance.rs
//!   points         {name: {coordinates [3], color [3]}}      may be left out
//!   pano_shots     panoramas                                 left out here, with a warning
//!   reference_lla  {latitude, longitude, altitude}           also in reference_lla.json
//!   rig_cameras    {name: {rotation, translation}}
//!   rig_instances  {name: {rotation, translation, rig_camera_ids {shot: rig camera}}}
//!   biases, ...                                              not needed
//! }
//! ```
//!
//! rotation is an axis of length angle (radians), translation may be left out (0):
//! x_camera = R x_world + t, with camera axes x right, y down, z forward. A shot of a rig carries its
//! own pose as well; one that does not has the rig camera's after its instance's. The world is
//! east-north-up at `reference_lla` (WGS 84) where there was GPS, else arbitrary and the reference is
//! 0, 0, 0; it names no coordinate system. OpenDroneMap writes another frame into the same file, which
//! only the positions tell (frame/). gps_position is what the receiver said, east-north-up; a
//! gps_dop of 999999 stands for a photo without GPS. Colours are 0 to 255, written as floats. Image
//! points count in the photo as stored, whatever its EXIF orientation.

pub(crate) mod camera;
mod covariance;
mod dataset;
mod frame;
mod reference;
mod rig;
mod stats;
mod tracks;

use std::collections::HashMap;
use std::fmt;

use glam::{DMat3, DVec3};
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, SeqAccess, Visitor};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::geometry::Similarity;
use crate::packages::pose_covariance::{PassedOver, PoseCovariance};
use crate::packages::reconstruction::{PosedPhoto, Reconstruction, Sizes};
use crate::surface::Cloud;
use crate::text::json::{Object, parse};
use camera::{CameraModel, usable_cameras};
pub(crate) use dataset::{count_of_photos, dataset_file, read_file, scale_error};
use frame::{Frame, Hint, frame_of};
use reference::{Measured, RawReference, enu_origin, measured_positions, scale_error_of};
use rig::{RawRigCamera, RawRigInstance, Rigs};

/// A `reconstruction.json` with the names of its points, which `tracks.csv` calls them by.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OpenSfm {
    /// In OpenSfM's own frame; the photos in the file's order.
    pub reconstruction: Reconstruction,
    /// Index into the cloud's points, by name.
    point_indices: HashMap<String, u32>,
    /// What the receivers said of the photos, in the file's order.
    measured: Vec<Measured>,
}

/// Reads the first, largest reconstruction of a `reconstruction.json`.
///
/// # Errors
/// As [`OpenSfm::read`].
#[cfg(test)]
pub(crate) fn read(json: &[u8]) -> Result<Reconstruction, Fault> {
    Ok(OpenSfm::read(json)?.reconstruction)
}

impl OpenSfm {
    /// Reads the first, largest reconstruction of a `reconstruction.json`, without observations,
    /// which [`OpenSfm::add_observations`] adds.
    ///
    /// # Errors
    /// Where it is no JSON of that shape (with the line), a number is not usable, a shot names a
    /// camera that is not there, or nothing was aligned.
    pub(crate) fn read(json: &[u8]) -> Result<Self, Fault> {
        let list: List = parse(json)?;
        let Some(mut raw) = list.largest else {
            return Err(nothing_aligned("it holds no reconstruction"));
        };
        if raw.shots.0.is_empty() {
            return Err(nothing_aligned("its reconstruction has no shots"));
        }
        let mut warnings = Vec::new();
        if list.others > 0 {
            warnings.push(format!(
                "{} more reconstructions with {} photos in all, not connected to the largest, are left out",
                list.others, list.other_shots
            ));
        }
        if !raw.pano_shots.0.is_empty() {
            let count = raw.pano_shots.0.len();
            warnings.push(format!("{count} panoramas are left out"));
        }
        leave_out_unsupported(&mut raw, &mut warnings)?;
        let is_used = |id: &str| raw.shots.0.iter().any(|(_, shot)| shot.camera == id);
        let cameras = usable_cameras(&raw.cameras, is_used, &mut warnings)?;
        let camera_indices: HashMap<&str, usize> = cameras
            .iter()
            .enumerate()
            .map(|(index, camera)| (camera.name.as_str(), index))
            .collect();
        let enu_origin = raw.reference_lla.and_then(enu_origin);
        let of_shots = raw.shots.0.iter();
        let measured: Vec<Measured> = of_shots
            .filter_map(|(name, shot)| Measured::of_shot(name, shot.gps_position, shot.gps_dop))
            .collect();
        let measured_positions = measured_positions(&measured, enu_origin, &mut warnings);
        let rigs = Rigs::new(raw.rig_cameras, raw.rig_instances);
        let mut photos = Vec::with_capacity(raw.shots.0.len());
        let mut pose_errors = Vec::with_capacity(raw.shots.0.len());
        let mut passed_over = PassedOver::default();
        let mut without_translation = 0;
        for (name, shot) in raw.shots.0 {
            let Some(&camera) = camera_indices.get(shot.camera.as_str()) else {
                return Err(Fault::new(
                    format!(
                        "shot \"{name}\" names the camera \"{}\", which is not there",
                        shot.camera
                    ),
                    "export it again",
                ));
            };
            let pose = match shot.rotation {
                Some(rotation) => {
                    without_translation += usize::from(shot.translation.is_none());
                    pose_from(rotation, shot.translation.unwrap_or_default())
                }
                None => rigs.pose_of(&name)?,
            };
            let pose = checked(pose, &name)?;
            let rotation = shot.rotation.map(|r| -DVec3::from(r));
            pose_errors.push(match rotation {
                Some(rotation) => covariance::of(&shot.covariance, rotation, &mut passed_over),
                None => PoseCovariance::default(),
            });
            photos.push(PosedPhoto { name, camera, pose });
        }
        if without_translation > 0 {
            warnings.push(format!(
                "{without_translation} shots have no translation; 0 is taken, as OpenSfM does"
            ));
        }
        warnings.extend(passed_over.warning());
        let (cloud, point_indices) = points(raw.points)?;
        Ok(Self {
            reconstruction: Reconstruction {
                package: "opensfm",
                enu_origin,
                measured_positions,
                cameras,
                photos,
                pose_errors,
                cloud,
                sizes: Sizes::PerhapsReduced,
                // OpenDroneMap, which most often brings it, has reduced photos before it.
                warnings,
                ..Reconstruction::default()
            },
            point_indices,
            measured,
        })
    }

    /// Takes the origin of a `reference_lla.json` that lies beside, where the file states none itself.
    ///
    /// # Errors
    /// Where it is no JSON of that shape.
    fn add_reference(&mut self, json: &[u8]) -> Result<(), Fault> {
        let reference: RawReference = parse(json)?;
        if let Some(origin) = enu_origin(reference)
            && self.reconstruction.enu_origin.is_none()
        {
            self.reconstruction.enu_origin = Some(origin);
            let warnings = &mut self.reconstruction.warnings;
            let positions = measured_positions(&self.measured, Some(origin), warnings);
            self.reconstruction.measured_positions = positions;
        }
        Ok(())
    }

    /// Puts the reconstruction where it stands on the Earth, if it has a reference: that depends on
    /// which frame it is in, which nothing states. Warns where that is not what OpenSfM writes.
    fn place(&mut self, hint: Hint) {
        let Some((frame, said)) = self.frame(hint) else {
            return;
        };
        let reconstruction = &mut self.reconstruction;
        reconstruction.warnings.extend(said);
        match frame {
            Frame::Topocentric => {}
            Frame::Unknown => reconstruction.enu_origin = None,
            Frame::Projected { crs, offset } => {
                let offset = Similarity::new(1.0, DMat3::IDENTITY, offset.extend(0.0));
                reconstruction.transform(&offset);
                reconstruction.enu_origin = None;
                reconstruction.crs = Some(crs);
            }
        }
    }

    /// The standard error of all lengths in percent by its receivers' positions, where they placed it.
    pub(crate) fn scale_error_by_receivers(&self) -> Option<f64> {
        let photos = self.reconstruction.photos.iter();
        let centers: HashMap<&str, DVec3> = photos
            .map(|photo| (photo.name.as_str(), photo.pose.center))
            .collect();
        let pairs = self.measured.iter().filter_map(|one| {
            let solved = centers.get(one.photo.as_str())?;
            Some((*solved, one.position))
        });
        scale_error_of(&pairs.collect::<Vec<_>>())
    }

    /// The sentence that says so where the photos' positions tell that OpenDroneMap has put projected
    /// coordinates less an offset into it.
    pub(crate) fn said_to_be_projected(&self) -> Option<String> {
        match self.frame(Hint::None)? {
            (Frame::Projected { .. }, said) => said,
            _ => None,
        }
    }

    /// The frame that it is in, with what there is to say; `None` where it has no reference.
    fn frame(&self, hint: Hint) -> Option<(Frame, Option<String>)> {
        let origin = self.reconstruction.enu_origin?;
        let photos = self.reconstruction.photos.iter();
        let centers: HashMap<&str, DVec3> = photos
            .map(|photo| (photo.name.as_str(), photo.pose.center))
            .collect();
        let pairs: Vec<(DVec3, DVec3)> = self
            .measured
            .iter()
            .filter_map(|one| Some((one.position, *centers.get(one.photo.as_str())?)))
            .collect();
        Some(frame_of(&pairs, origin, hint))
    }

    /// Adds the image points of a `tracks.csv`. Those of photos and points that the reconstruction
    /// does not have are left out.
    ///
    /// # Errors
    /// Where the file is of an unknown version or a line is broken, with the line; nothing is added
    /// then.
    pub(crate) fn add_observations(&mut self, tracks: &str) -> Result<(), Fault> {
        let reconstruction = &self.reconstruction;
        let observations = tracks::read(tracks, reconstruction, |point| {
            self.point_indices.get(point).copied()
        })?;
        self.reconstruction.observations = observations;
        Ok(())
    }
}

fn nothing_aligned(what: &str) -> Fault {
    Fault::new(what, "check that the alignment succeeded")
}

#[derive(Deserialize)]
struct RawReconstruction {
    cameras: Object<CameraModel>,
    shots: Object<RawShot>,
    #[serde(default)]
    points: Object<RawPoint>,
    #[serde(default)]
    pano_shots: Object<IgnoredAny>,
    reference_lla: Option<RawReference>,
    #[serde(default)]
    rig_cameras: Object<RawRigCamera>,
    #[serde(default)]
    rig_instances: Object<RawRigInstance>,
}

#[derive(Deserialize)]
struct RawShot {
    camera: String,
    rotation: Option<[f64; 3]>,
    translation: Option<[f64; 3]>,
    gps_position: Option<[f64; 3]>,
    gps_dop: Option<f64>,
    /// Of any shape: it only adds to the pose.
    #[serde(default)]
    covariance: serde_json::Value,
}

#[derive(Deserialize)]
struct RawPoint {
    coordinates: [f64; 3],
    color: Option<[f64; 3]>,
}

/// The pose of a rotation vector and a translation of `camera_from_world`.
fn pose_from(rotation: [f64; 3], translation: [f64; 3]) -> Pose {
    let rotation = DVec3::from(rotation);
    let mut pose = Pose::from_rotation_vector_of_camera_from_world(DVec3::ZERO, rotation);
    pose.center = -(pose.rotation * DVec3::from(translation));
    pose
}

/// Leaves out the shots of cameras that fragscale has no lens for, unless there are no others.
fn leave_out_unsupported(
    raw: &mut RawReconstruction,
    warnings: &mut Vec<String>,
) -> Result<(), Fault> {
    let unsupported: Vec<(String, Fault)> = raw
        .cameras
        .0
        .iter()
        .filter_map(|(id, model)| Some((id.clone(), model.unsupported(id)?)))
        .collect();
    for (id, fault) in unsupported {
        let all = raw.shots.0.len();
        let shots = raw.shots.0.iter();
        let kept = shots.filter(|(_, shot)| shot.camera != id).count();
        if kept == 0 {
            return Err(fault);
        }
        raw.shots.0.retain(|(_, shot)| shot.camera != id);
        raw.cameras.0.retain(|(name, _)| *name != id);
        warnings.push(match all - kept {
            0 => format!("{}; no photo uses it, it is left out", fault.what),
            count => format!("{}; its {count} photos are left out", fault.what),
        });
    }
    Ok(())
}

/// Refuses a pose whose numbers ran over.
pub(crate) fn checked(pose: Pose, name: &str) -> Result<Pose, Fault> {
    if pose.rotation.is_finite() && pose.center.is_finite() {
        return Ok(pose);
    }
    Err(Fault::new(
        format!("the rotation or the position of shot \"{name}\" is too large to compute with"),
        "export it again, or leave the shot out",
    ))
}

/// The points with their colours (none where one has none), and the indices of their names.
fn points(raw: Object<RawPoint>) -> Result<(Cloud, HashMap<String, u32>), Fault> {
    let mut cloud = Cloud::default();
    let mut indices = HashMap::with_capacity(raw.0.len());
    for (index, (name, point)) in raw.0.into_iter().enumerate() {
        let index = u32::try_from(index)
            .map_err(|_| Fault::new("it has more than 4 294 967 295 points", "thin them out"))?;
        cloud.points.push(DVec3::from(point.coordinates));
        if let Some(color) = point.color {
            cloud
                .colors
                .push(color.map(|c| c.round().clamp(0.0, 255.0) as u8));
        }
        indices.insert(name, index);
    }
    if cloud.colors.len() != cloud.points.len() {
        cloud.colors.clear();
    }
    Ok((cloud, indices))
}

/// The reconstruction with most shots, of equals the first, and of the others only how many there are.
#[derive(Default)]
struct List {
    largest: Option<RawReconstruction>,
    others: usize,
    other_shots: usize,
}

impl<'de> Deserialize<'de> for List {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(ListVisitor)
    }
}

struct ListVisitor;

impl<'de> Visitor<'de> for ListVisitor {
    type Value = List;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of reconstructions")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<List, A::Error> {
        let mut list = List::default();
        while let Some(mut next) = seq.next_element::<RawReconstruction>()? {
            let Some(largest) = &mut list.largest else {
                list.largest = Some(next);
                continue;
            };
            if next.shots.0.len() > largest.shots.0.len() {
                std::mem::swap(largest, &mut next);
            }
            list.others += 1;
            list.other_shots += next.shots.0.len();
        }
        Ok(list)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;
    use fragscale_test_data::shared_data;

    const SMALL: &str = r#"[
        {"cameras": {"v2 c": {"focal": 0.5, "width": 400, "height": 200}},
         "shots": {
            "z.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [1, 2, 3]},
            "a.jpg": {"camera": "v2 c", "rotation": [0, 0, 0], "orientation": 6, "gps_dop": 1e9}},
         "points": {
            "7": {"coordinates": [-1, 2, -7], "color": [255.0, 300, -1]},
            "3": {"coordinates": [-1, 0, 1], "color": [1.6, 2, 3]}},
         "rig_cameras": {}, "reference_lla": {"latitude": 1}},
        {"shots": {"b.jpg": {"camera": "bad"}}, "cameras": {"bad": {"projection_type": "dual"}}}
    ]"#;

    #[test]
    fn poses_points_and_order_of_a_small_file() {
        let reconstruction = read(SMALL.as_bytes()).unwrap();
        let names: Vec<_> = reconstruction.photos.iter().map(|p| &*p.name).collect();
        assert_eq!(names, ["z.jpg", "a.jpg"]);
        // Half a turn about x: looks down. t = (1, 2, 3) = -R r, so r = (-1, 2, 3).
        let pose = reconstruction.photos[0].pose;
        assert!((pose.rotation.z_axis - DVec3::NEG_Z).length() < 1e-15);
        assert!((pose.center - DVec3::new(-1.0, 2.0, 3.0)).length() < 1e-15);
        assert_eq!(reconstruction.photos[1].pose.center, DVec3::ZERO);
        assert_eq!(reconstruction.cloud.points[0], DVec3::new(-1.0, 2.0, -7.0));
        assert_eq!(reconstruction.cloud.colors, [[255, 255, 0], [2, 2, 3]]);
        assert_eq!(reconstruction.package, "opensfm");
        assert!(reconstruction.sizes.are_known() && reconstruction.crs.is_none());
        assert_eq!(
            reconstruction.warnings.len(),
            2,
            "{:?}",
            reconstruction.warnings
        );
        assert!(reconstruction.warnings[0].contains("1 more reconstructions with 1 photos"));
    }

    #[test]
    fn tracks_join_by_the_points_names() {
        let mut file = OpenSfm::read(SMALL.as_bytes()).unwrap();
        // Point 7 lies 10 below the camera z.jpg, on its axis; the others are not there.
        let tracks = "OPENSFM_TRACKS_VERSION_v1\n\
                      z.jpg\t7\t5\t0.0\t0.005\t0.01\t1\t2\t3\n\
                      z.jpg\t8\t5\t0.0\t0.0\t0.01\t1\t2\t3\n\
                      b.jpg\t7\t5\t0.0\t0.0\t0.01\t1\t2\t3\n";
        file.add_observations(tracks).unwrap();
        let [seen] = file.reconstruction.observations[..] else {
            panic!("one observation");
        };
        assert_eq!(
            (seen.photo, seen.point, seen.pixel),
            (0, 0, DVec2::new(200.0, 102.0))
        );
        let off = file.reconstruction.median_reprojection_px().unwrap();
        assert!((off - 2.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let with = |from: &str, to: &str| {
            assert!(SMALL.contains(from), "{from}");
            read(SMALL.replacen(from, to, 1).as_bytes())
        };
        for (from, to, named) in [
            (
                "\"v2 c\", \"rotation\": [0",
                "\"x\", \"rotation\": [0",
                "shot \"a.jpg\" names the camera \"x\"",
            ),
            ("[0, 0, 0]", "[0, 0]", "invalid length 2"),
            ("[0, 0, 0]", "[0, 0, NaN]", "expected value"),
            ("[0, 0, 0]", "[0, 1e308, 1e308]", "shot \"a.jpg\""),
            ("\"shots\"", "\"shot\"", "missing field `shots`"),
            ("\"a.jpg\"", "\"z.jpg\"", "\"z.jpg\" stands twice"),
            (
                "\"focal\": 0.5",
                "\"k1\": 0.5",
                "camera \"v2 c\" (perspective) has no `focal`",
            ),
            ("[-1, 0, 1]", "null", "invalid type: null"),
        ] {
            let fault = with(from, to).unwrap_err();
            assert!(fault.what.contains(named), "{to}: {fault}");
        }
        assert!(read(b"[]").is_err());
        assert!(
            read(b"{}")
                .unwrap_err()
                .what
                .contains("a list of reconstructions")
        );
        assert!(read(br#"[{"cameras": {}, "shots": {}}]"#).is_err());
        assert_eq!(
            with("[0, 0, 0]", "[0, \"0\", 0]").unwrap_err().line,
            Some(5)
        );
    }

    #[test]
    fn colours_need_all_points() {
        let json = SMALL.replace(", \"color\": [1.6, 2, 3]", "");
        let reconstruction = read(json.as_bytes()).unwrap();
        assert_eq!(reconstruction.cloud.points.len(), 2);
        assert!(reconstruction.cloud.colors.is_empty());
    }

    #[test]
    fn truncated_anywhere_it_is_an_error() {
        let end = SMALL.trim_end().len();
        for cut in 0..end {
            assert!(read(&SMALL.as_bytes()[..cut]).is_err(), "cut at {cut}");
        }
    }

    proptest! {
        #[test]
        fn damaged_files_never_panic(edits in prop::collection::vec((0_usize..2000, any::<u8>()), 1..6)) {
            let mut json = SMALL.as_bytes().to_vec();
            for (at, byte) in edits {
                let place = at % json.len();
                json[place] = byte;
            }
            let _ = read(&json);
        }
    }

    #[test]
    fn berlin_reprojects() {
        let Some(folder) = shared_data("opensfm-berlin") else {
            return;
        };
        let json = std::fs::read(folder.join("reconstruction_example.json")).unwrap();
        let tracks = std::fs::read_to_string(folder.join("tracks_example.csv")).unwrap();
        let mut file = OpenSfm::read(&json).unwrap();
        file.add_observations(&tracks).unwrap();
        let reconstruction = file.reconstruction;
        let names: Vec<_> = reconstruction.photos.iter().map(|p| &*p.name).collect();
        assert_eq!(names, ["03.jpg", "01.jpg", "02.jpg"]);
        let camera = &reconstruction.cameras[0];
        assert_eq!(
            (camera.width, camera.height, camera.cx, camera.cy),
            (3264, 2448, 1632.0, 1224.0)
        );
        assert!((camera.fx - 0.869_665_848_485_535_9 * 3264.0).abs() < 1e-9);
        assert_eq!(reconstruction.cloud.points.len(), 1430);
        assert_eq!(reconstruction.cloud.colors.len(), 1430);
        assert_eq!(reconstruction.observations.len(), 3082);
        assert_eq!(reconstruction.warnings, [""; 0]);
        let median = reconstruction.median_reprojection_px().unwrap();
        assert!((median - 0.796).abs() < 5e-4, "{median}");
    }
}
