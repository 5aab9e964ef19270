//! A recording as a flight: its images are the photos.
//!
//! - An image topic's camera is the CameraInfo beside it (`NS/camera_info` for `NS/image...`, as
//!   image_transport pairs them), else the only one of the same frame. Of several image topics of one
//!   camera (raw, compressed, colour) the one with most images is taken.
//! - Left out, with a warning: rectified images (`image_rect...`), whose camera is P instead of K and
//!   D; depth images; images of another size than the first of their topic.
//! - A photo is called by its topic and its stamp in nanoseconds: `cam0/image_raw/1403715273262142976`.
//! - Its pose is that of its frame (`pose_source.rs`) at its stamp. It is interpolated, not over more
//!   than half a second, and never extrapolated.
//! - Several topics may give poses: the densest is taken, or the one that the user names.
//! - The world is the frame that the poses are in; called `earth`, it is ECEF (REP 105), else no
//!   coordinate system is known.
//! - `sensor_msgs/NavSatFix` gives measured positions, interpolated over 1.5 s at most. They are those
//!   of the antenna: its distance to the camera is not known here.

use std::collections::BTreeMap;

use super::pose_source::{PoseSource, Wanted, pose_source};
use super::recording::{CameraTopic, ImageTopic, Recording};
use crate::camera::Camera;
use crate::cameras::camera_file;
use crate::fault::Fault;
use crate::geodesy::Geographic;
use crate::packages::reconstruction::{MeasuredPosition, PosedPhoto, Reconstruction, Sizes};
use crate::poses::trajectory::{NoPose, PosedFiles, Stamp, pose_photos, stamp_of};
use crate::units::LengthUnit;

/// The longest time between two fixes that a position is interpolated over, in nanoseconds:
/// receivers send one a second.
const LONGEST_FIX_GAP: u64 = 1_500_000_000;

/// What to do with a recording that is no flight.
const USE_AS_POSES: &str = "record images, camera_info and tf, or name it in a flight.toml as [photos] poses beside a [[camera]] and a folder of photo files called by their stamps";

impl Recording {
    /// The flight that was recorded, with the densest poses.
    ///
    /// # Errors
    /// Where images, their camera or their poses are missing, naming what.
    pub fn reconstruction(&self) -> Result<Reconstruction, Fault> {
        self.reconstruction_by(None)
    }

    /// The flight that was recorded, with the poses of a topic, where one is named.
    ///
    /// # Errors
    /// As [`Self::reconstruction`], and where that topic gives no poses of the camera.
    pub fn reconstruction_by(&self, topic: Option<&str>) -> Result<Reconstruction, Fault> {
        let missing = match (self.images.is_empty(), self.cameras.is_empty()) {
            (true, true) => Some(
                "neither images (sensor_msgs/Image, CompressedImage) nor a camera (sensor_msgs/CameraInfo)",
            ),
            (true, false) => Some("no images (sensor_msgs/Image, CompressedImage)"),
            (false, true) => Some("no camera (sensor_msgs/CameraInfo) of its images"),
            (false, false) => None,
        };
        if let Some(missing) = missing {
            let mut what = format!("the recording holds {missing}");
            if let Some(other) = self.not_read().next() {
                what = format!("{what}; {other}");
            }
            return Err(Fault::new(what, USE_AS_POSES));
        }
        let mut reconstruction = Reconstruction {
            package: "ros",
            sizes: Sizes::Known,
            // REP 103.
            unit: Some(LengthUnit::Metre),
            warnings: self.warnings(),
            ..Reconstruction::default()
        };
        let shots = self.photo_topics(&mut reconstruction.warnings)?;
        let mut without: Vec<(String, NoPose)> = Vec::new();
        let mut stamps = Vec::new();
        let mut world_frame: Option<String> = None;
        // All cameras' images, so that two cameras of one body take the same poses.
        let taken: Vec<Stamp> = shots
            .iter()
            .flat_map(|shot| shot.image.stamps.iter().copied())
            .collect();
        for shot in &shots {
            let wanted = Wanted {
                frame: &shot.camera_topic.frame,
                stamps: &taken,
                topic,
            };
            let source = pose_source(self, wanted)?;
            let world = world_frame.get_or_insert_with(|| source.way.root.clone());
            if *world != source.way.root {
                let what = format!(
                    "the cameras' poses are in two worlds, '{world}' and '{}'",
                    source.way.root
                );
                return Err(Fault::new(
                    what,
                    "record the tf between the two, or one camera",
                ));
            }
            for said in source.said {
                if !reconstruction.warnings.contains(&said) {
                    reconstruction.warnings.push(said);
                }
            }
            let camera = reconstruction.cameras.len();
            reconstruction.cameras.push(shot.camera.clone());
            for (name, stamp) in shot.names(&mut reconstruction.warnings) {
                match source.way.at(stamp) {
                    Ok(pose) => {
                        reconstruction
                            .photos
                            .push(PosedPhoto { name, camera, pose });
                        stamps.push(stamp);
                    }
                    Err(reason) => without.push((name, reason)),
                }
            }
        }
        // REP 105: the frame called earth is ECEF.
        if world_frame.as_deref() == Some("earth") {
            reconstruction.crs = Some("ECEF".to_owned());
        }
        let count = without.len() + reconstruction.photos.len();
        if let Some((name, reason)) = without.first() {
            let what = format!("'{name}', for one: {reason}");
            if reconstruction.photos.is_empty() {
                return Err(Fault::new(
                    format!("none of {count} images has a pose: {what}"),
                    "record poses at twice a second or more, from before the first image to after the last",
                ));
            }
            let left_out = without.len();
            reconstruction.warnings.push(format!(
                "{left_out} of {count} images have no pose and are left out: {what}"
            ));
        }
        self.add_measured_positions(&mut reconstruction, &stamps);
        Ok(reconstruction)
    }

    /// Gives image files that are called by their stamps the poses of the recording, those of a topic
    /// where one is named.
    ///
    /// # Errors
    /// Where the recording has several cameras or no poses, or no file gets one.
    pub fn pose_files(&self, files: &[String], topic: Option<&str>) -> Result<PosedFiles, Fault> {
        let mut frames: Vec<&str> = self.cameras.values().map(|c| c.frame.as_str()).collect();
        frames.sort_unstable();
        frames.dedup();
        let frame = match frames[..] {
            [] => "",
            [frame] => frame,
            ref several => {
                return Err(Fault::new(
                    format!("it has several cameras: {}", several.join(", ")),
                    "keep the camera_info of the one whose photos these are",
                ));
            }
        };
        let stamps: Vec<Stamp> = files.iter().filter_map(|file| stamp_of(file)).collect();
        let wanted = Wanted {
            frame,
            stamps: &stamps,
            topic,
        };
        let PoseSource { way, said } = pose_source(self, wanted)?;
        let mut posed = pose_photos(files, way.span(), |stamp| way.at(stamp))?;
        posed
            .warnings
            .splice(0..0, self.warnings().into_iter().chain(said));
        Ok(posed)
    }

    /// The image topics that serve as photos, each with its camera.
    fn photo_topics(&self, warnings: &mut Vec<String>) -> Result<Vec<PhotoTopic<'_>>, Fault> {
        let mut left_out = Vec::new();
        let mut of_camera: BTreeMap<usize, Vec<(usize, &ImageTopic)>> = BTreeMap::new();
        for (&index, image) in &self.images {
            let name = self.name_of(index);
            match self.camera_of(name, image) {
                Ok(camera) => of_camera.entry(camera).or_default().push((index, image)),
                Err(why) => left_out.push(format!("{name}: {why}; its images are left out")),
            }
        }
        let mut topics = Vec::new();
        for (camera_index, mut images) in of_camera {
            // image_raw stands in front of image_raw/compressed.
            images.sort_by_key(|(index, image)| {
                (
                    std::cmp::Reverse(image.stamps.len()),
                    self.name_of(*index).len(),
                )
            });
            let Some(camera_topic) = self.cameras.get(&camera_index) else {
                continue;
            };
            let mut images = images.into_iter();
            let Some((index, image)) = images.next() else {
                continue;
            };
            let (name, camera_name) = (self.name_of(index), self.name_of(camera_index));
            for (other, _) in images {
                let other = self.name_of(other);
                left_out.push(format!(
                    "{other}: the photos are those of {name}, of the same camera"
                ));
            }
            if camera_topic.changes {
                left_out.push(format!(
                    "{camera_name}: the calibration changes; its first message is used"
                ));
            }
            if image.other_sizes > 0 {
                left_out.push(format!(
                    "{name}: {} images have another size than the first and are left out",
                    image.other_sizes
                ));
            }
            match camera(camera_name, camera_topic, image) {
                Ok((camera, rescaled)) => {
                    left_out.extend(rescaled);
                    topics.push(PhotoTopic {
                        name,
                        image,
                        camera,
                        camera_topic,
                    });
                }
                Err(fault) => left_out.push(format!(
                    "{camera_name}: {}; its images are left out",
                    fault.what
                )),
            }
        }
        if topics.is_empty() {
            return Err(Fault::new(
                format!("no images are of use: {}", left_out.join("; ")),
                USE_AS_POSES,
            ));
        }
        warnings.extend(left_out);
        Ok(topics)
    }

    /// The index of the CameraInfo topic of an image topic.
    fn camera_of(&self, name: &str, image: &ImageTopic) -> Result<usize, String> {
        let (base, transport) = match name.rsplit_once('/') {
            Some((base, transport)) if transport.starts_with("compressed") => (base, transport),
            _ => (name, ""),
        };
        let (namespace, last) = base.rsplit_once('/').unwrap_or(("", base));
        let is_depth = matches!(image.encoding.as_str(), "16UC1" | "32FC1")
            || image.encoding.contains("compressedDepth");
        if is_depth || transport == "compressedDepth" {
            return Err("depth images".to_owned());
        }
        if last.starts_with("image_rect") {
            return Err("rectified images, whose camera is P, not K and D".to_owned());
        }
        let beside = format!("{namespace}/camera_info");
        let beside = beside.trim_start_matches('/');
        let by_name = self
            .cameras
            .keys()
            .find(|&&index| self.name_of(index).trim_start_matches('/') == beside);
        if let Some(&index) = by_name {
            return Ok(index);
        }
        let mut same_frame = self
            .cameras
            .iter()
            .filter(|(_, camera)| !image.frame.is_empty() && camera.frame == image.frame);
        match (same_frame.next(), same_frame.next()) {
            (Some((&index, _)), None) => Ok(index),
            (None, _) => Err(format!(
                "no camera_info beside it or of its frame '{}'",
                image.frame
            )),
            (Some(_), Some(_)) => Err(format!(
                "several camera_info of its frame '{}'",
                image.frame
            )),
        }
    }

    /// Adds where the receiver was at each photo.
    fn add_measured_positions(&self, reconstruction: &mut Reconstruction, stamps: &[Stamp]) {
        let mut topics = self.fixes.iter().filter(|(_, fixes)| !fixes.is_empty());
        let (Some((_, fixes)), None) = (topics.next(), topics.next()) else {
            if self
                .fixes
                .values()
                .filter(|fixes| !fixes.is_empty())
                .count()
                > 1
            {
                let warning = "several topics of sensor_msgs/NavSatFix: none is used";
                reconstruction.warnings.push(warning.to_owned());
            }
            return;
        };
        let mut fixes = fixes.clone();
        fixes.sort_by_key(|(stamp, _)| *stamp);
        let photos = reconstruction.photos.iter().zip(stamps);
        let measured = photos.filter_map(|(photo, stamp)| {
            Some(MeasuredPosition {
                photo: photo.name.clone(),
                position: place_at(&fixes, *stamp)?,
            })
        });
        reconstruction.measured_positions = measured.collect();
    }
}

/// An image topic with its camera.
struct PhotoTopic<'a> {
    name: &'a str,
    image: &'a ImageTopic,
    camera: Camera,
    camera_topic: &'a CameraTopic,
}

impl PhotoTopic<'_> {
    /// Each photo's name and stamp, in order of time.
    fn names(&self, warnings: &mut Vec<String>) -> Vec<(String, Stamp)> {
        let mut stamps = self.image.stamps.clone();
        stamps.sort_unstable();
        stamps.dedup();
        let twice = self.image.stamps.len() - stamps.len();
        if twice > 0 {
            warnings.push(format!(
                "{}: {twice} images have the stamp of another and are left out",
                self.name
            ));
        }
        let topic = self.name.trim_start_matches('/');
        let named = |stamp: Stamp| (format!("{topic}/{}", stamp.0), stamp);
        stamps.into_iter().map(named).collect()
    }
}

/// The camera of an image topic, at the size of its images, and what was done to it for that.
fn camera(
    name: &str,
    topic: &CameraTopic,
    image: &ImageTopic,
) -> Result<(Camera, Option<String>), Fault> {
    let info = &topic.info;
    let mut camera =
        camera_file::of_camera_info(info.size, info.region, &info.k, &info.model, &info.d)?;
    let namespace = name.trim_start_matches('/').trim_end_matches("camera_info");
    let namespace = namespace.trim_end_matches('/');
    camera.name = if namespace.is_empty() {
        &topic.frame
    } else {
        namespace
    }
    .to_owned();
    let Some((width, height)) = image.size.filter(|size| *size != info.size) else {
        return Ok((camera, None));
    };
    let rescaled = camera
        .rescaled(width, height)
        .map_err(|error| Fault::new(error.to_string(), "record camera_info of the images' size"))?;
    let warning = format!(
        "camera '{}' is for {} x {}, its images are {width} x {height}: its intrinsics are scaled to the images' size",
        camera.name, info.size.0, info.size.1
    );
    Ok((rescaled, Some(warning)))
}

/// A receiver's place at a time, between two fixes in order of time.
fn place_at(fixes: &[(Stamp, Geographic)], stamp: Stamp) -> Option<Geographic> {
    let next = fixes.partition_point(|(other, _)| *other < stamp);
    let (to, b) = fixes.get(next)?;
    if *to == stamp {
        return Some(*b);
    }
    let (from, a) = fixes.get(next.checked_sub(1)?)?;
    let gap = from.apart(*to);
    if gap > LONGEST_FIX_GAP {
        return None;
    }
    let share = from.apart(stamp) as f64 / gap as f64;
    let between = |a: f64, b: f64| a + (b - a) * share;
    Some(Geographic {
        longitude: between(a.longitude, b.longitude),
        latitude: between(a.latitude, b.latitude),
        height: between(a.height, b.height),
    })
}
