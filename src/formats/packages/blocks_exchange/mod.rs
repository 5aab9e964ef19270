//! Bentley's BlocksExchange XML (ContextCapture, iTwin Capture), from the ContextCapture User Guide
//! ("BlocksExchange XML/XMLZ format", "Camera model") and Bentley's "CC Orientations" page.
//!
//! ```text
//! BlocksExchange/SpatialReferenceSystems/SRS: Id, Name, Definition
//! BlocksExchange/Block: SRSId, Photogroups/Photogroup, TiePoints, ControlPoints
//! Photogroup: ImageDimensions, CameraModelType, FocalLengthPixels | FocalLength + (SensorSize |
//!             PixelSize), CameraOrientation, PrincipalPoint, Distortion, AspectRatio, Skew, Photo...
//! Photo: Id, ImagePath, Component, Pose/Rotation, Pose/Center, ExifData/GPS
//! TiePoint: Position, Color, Measurement: PhotoId, x, y
//! ```
//!
//! - Rotation takes world coordinates to camera axes that CameraOrientation names (XRightYDown where
//!   it is not there; z is x cross y): M_00 to M_22, or degrees. Omega, phi, kappa make the transpose
//!   of Rx Ry Rz. Yaw, pitch and roll are taken as aerospace angles (north-east-down in z-y-x order,
//!   pitch -90 looks down) of the photo whatever its CameraOrientation; Bentley's definition of them
//!   was not to be had, so a warning says so.
//! - Center is the camera centre in the SRS of the Photogroup, or of its Block.
//! - Pixels count from the CENTRE of the top-left pixel, x right and y down: +0.5 here. Without a
//!   PrincipalPoint it is the middle of the image.
//! - SensorSize is the longer side's, in mm as FocalLength; PixelSize may stand in its place. A
//!   PrincipalPoint may be told as xmm, ymm from the sensor's middle, along CameraOrientation's axes.
//! - Distortion: `u (1 + K1 r2 + K2 r4 + K3 r6) + 2 P2 u v + P1 (r2 + 2 u2)` and alike for v: P1 and
//!   P2 are OpenCV's p2 and p1.
//! - AspectRatio is taken as fy / fx, Skew as pixels; a warning says so where they are not 1 and 0.
//! - A fish-eye is read where it is OpenCV's or near it (see `polynomial_fisheye`), else its photos are
//!   left out.
//! - Definitions: `EPSG:n+m` (m: heights), `EPSG:4978`, WKT, PROJ strings,
//!   `ENU:latitude,longitude[,height]`. Longitude stands in x, latitude in y. Others are local.
//! - Where photos have different systems, those of the first one are read. Photos without whole pose,
//!   and those outside the main component (Component 1) where there is one, are left out. Only the
//!   first Block with posed photos is read. All of that is said in warnings.
//! - Left out: ControlPoints, tie points in a file of their own (TiePoints/Path), masks, depths,
//!   XMLZ, ATExport XML.

mod photogroup;
mod pose;
mod system;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use roxmltree::{Document, Node};

use crate::camera::Camera;
use crate::fault::Fault;
use crate::files::last_segment;
use crate::geodesy::Geographic;
use crate::packages::reconstruction::{
    MeasuredPosition, Observation, PosedPhoto, Reconstruction, Sizes,
};
use crate::surface::Cloud;
use crate::text::fields::shown;
use crate::text::xml_document::{line_of, parse};
use system::System;

const EXPORT: &str = "export the block from ContextCapture again";

/// Reads the first block that has posed photos.
///
/// # Errors
/// Text that is no BlocksExchange XML, with the line; no photo with a pose.
pub(crate) fn read(text: &str) -> Result<Reconstruction, Fault> {
    let document = parse(text)?;
    let root = document.root_element();
    if root.tag_name().name() != "BlocksExchange" {
        let name = shown(root.tag_name().name());
        return Err(Fault::new(
            format!("the XML is of '{name}', not of 'BlocksExchange'"),
            EXPORT,
        ));
    }
    let mut unposed = None;
    let mut blocks = children(root, "Block");
    for block in blocks.by_ref() {
        let mut reader = Reader::of(&document, block)?;
        if reader.found.photos.is_empty() {
            unposed = unposed.or(Some(reader.found.warnings));
            continue;
        }
        let others = blocks.count();
        if others > 0 {
            let warning = format!("{others} more blocks stand behind the one that is read");
            reader.found.warnings.push(warning);
        }
        return Ok(reader.found);
    }
    let what = match unposed.unwrap_or_default().first() {
        Some(warning) => format!("it holds no photo with a pose: {warning}"),
        None => "it holds no photo with a pose".to_owned(),
    };
    Err(Fault::new(
        what,
        "run the aerotriangulation, and export the block again",
    ))
}

struct Reader<'a, 'input> {
    document: &'a Document<'input>,
    found: Reconstruction,
    /// Where the photo of an identifier went; `None` where it was left out.
    photo_of_id: HashMap<u64, Option<u32>>,
    paths: Vec<String>,
    /// The system of what is read, set by the first posed photo.
    system: Option<String>,
    without_pose: usize,
    of_other_system: usize,
}

impl<'a, 'input> Reader<'a, 'input> {
    fn of(document: &'a Document<'input>, block: Node<'a, 'input>) -> Result<Self, Fault> {
        let mut reader = Self {
            document,
            found: Reconstruction {
                package: "contextcapture",
                sizes: Sizes::Known,
                ..Reconstruction::default()
            },
            photo_of_id: HashMap::new(),
            paths: Vec::new(),
            system: None,
            without_pose: 0,
            of_other_system: 0,
        };
        let block_system = text_of(block, "SRSId").unwrap_or_default();
        let groups = child(block, "Photogroups");
        let with_main =
            descendants(block, "Photo").any(|photo| text_of(photo, "Component") == Some("1"));
        for group in groups
            .into_iter()
            .flat_map(|groups| children(groups, "Photogroup"))
        {
            reader.add_group(group, block_system, with_main)?;
        }
        let bulk = child(block, "BulkPhotos");
        reader.without_pose += bulk.map_or(0, |bulk| children(bulk, "Photo").count());
        reader.name_photos();
        if let Some(points) = child(block, "TiePoints") {
            reader.add_points(points, block_system)?;
        }
        let controls = descendants(block, "ControlPoint").count();
        let warnings = &mut reader.found.warnings;
        if controls > 0 {
            warnings.push(format!("{controls} control points are not read"));
        }
        for (count, what) in [
            (reader.without_pose, "have no whole pose"),
            (reader.of_other_system, "are in another coordinate system"),
        ] {
            if count > 0 {
                warnings.push(format!("{count} photos {what} and are left out"));
            }
        }
        reader.set_system()?;
        Ok(reader)
    }

    fn add_group(
        &mut self,
        group: Node<'a, 'input>,
        block_system: &'a str,
        with_main: bool,
    ) -> Result<(), Fault> {
        let photos: Vec<_> = children(group, "Photo").collect();
        let name = text_of(group, "Name").unwrap_or("the photogroup");
        let camera = match photogroup::camera(group, &mut self.found.warnings)? {
            Ok(camera) => camera,
            Err(why) => {
                let count = photos.len();
                let warning = format!("{count} photos of '{}' are left out: {why}", shown(name));
                self.found.warnings.push(warning);
                for photo in photos {
                    self.add_id(photo, None)?;
                }
                return Ok(());
            }
        };
        let axes = photogroup::axes(group)?;
        let system = text_of(group, "SRSId").unwrap_or(block_system);
        let camera = self.unique_name(camera);
        let index = self.found.cameras.len();
        let mut by_yaw = 0;
        let mut outside = 0;
        for photo in photos {
            self.measured(photo);
            let in_main = !with_main || text_of(photo, "Component").is_none_or(|c| c == "1");
            let read = match child(photo, "Pose") {
                Some(pose) => pose::read(pose, axes)?,
                None => None,
            };
            let Some((pose, is_yaw)) = read else {
                self.without_pose += 1;
                self.add_id(photo, None)?;
                continue;
            };
            if !in_main {
                outside += 1;
                self.add_id(photo, None)?;
                continue;
            }
            if *self.system.get_or_insert_with(|| system.to_owned()) != system {
                self.of_other_system += 1;
                self.add_id(photo, None)?;
                continue;
            }
            by_yaw += usize::from(is_yaw);
            let place = u32::try_from(self.found.photos.len()).ok();
            self.add_id(photo, place)?;
            let path = text_of(photo, "ImagePath")
                .ok_or_else(|| fault(photo, "a Photo without ImagePath"))?;
            self.paths.push(path.to_owned());
            self.found.photos.push(PosedPhoto {
                name: path.to_owned(),
                camera: index,
                pose,
            });
        }
        if self.found.photos.iter().any(|photo| photo.camera == index) {
            self.found.cameras.push(camera);
        }
        if outside > 0 {
            self.found.warnings.push(format!(
                "{outside} photos are not of the main component (Component 1) and are left out"
            ));
        }
        if by_yaw > 0 {
            self.found.warnings.push(format!(
                "{by_yaw} photos have yaw, pitch and roll; they are taken as aerospace angles, with \
                 which pitch -90 looks straight down: check that the photos look at the ground"
            ));
        }
        Ok(())
    }

    fn unique_name(&self, mut camera: Camera) -> Camera {
        let taken = |name: &str| self.found.cameras.iter().any(|camera| camera.name == name);
        if camera.name.is_empty() || taken(&camera.name) {
            camera.name = format!("{} {}", camera.name, self.found.cameras.len() + 1);
            camera.name = camera.name.trim().to_owned();
        }
        camera
    }

    fn add_id(&mut self, photo: Node<'_, '_>, place: Option<u32>) -> Result<(), Fault> {
        // Without an Id nothing can refer to it.
        let Some(text) = text_of(photo, "Id") else {
            return Ok(());
        };
        let id = text.parse().map_err(|_| {
            fault(
                photo,
                format!("the Id '{}' is no whole number", shown(text)),
            )
        })?;
        match self.photo_of_id.insert(id, place) {
            None => Ok(()),
            Some(_) => Err(fault(
                photo,
                format!("the Id {id} of a Photo is there twice"),
            )),
        }
    }

    /// The receiver's position, which EXIF has in degrees.
    fn measured(&mut self, photo: Node<'_, '_>) {
        let gps = child(photo, "ExifData").and_then(|exif| child(exif, "GPS"));
        let number = |name| {
            let number = text_of(gps?, name)?.parse::<f64>().ok()?;
            number.is_finite().then_some(number)
        };
        // Without a height it is no place: 0 would be one that nobody measured.
        if let (Some(latitude), Some(longitude), Some(height), Some(path)) = (
            number("Latitude"),
            number("Longitude"),
            number("Altitude"),
            text_of(photo, "ImagePath"),
        ) {
            self.found.measured_positions.push(MeasuredPosition {
                photo: path.to_owned(),
                position: Geographic {
                    longitude,
                    latitude,
                    height,
                },
            });
        }
    }

    /// Calls photos by their file's name where that is clear, else by the whole path.
    fn name_photos(&mut self) {
        let file = |path: &str| last_segment(path).to_owned();
        let mut counts: HashMap<String, usize> = HashMap::new();
        for path in &self.paths {
            *counts.entry(file(path)).or_default() += 1;
        }
        let name = |path: &mut String| {
            let name = file(path);
            if counts.get(&name).is_none_or(|count| *count == 1) {
                *path = name;
            }
        };
        self.found
            .photos
            .iter_mut()
            .for_each(|photo| name(&mut photo.name));
        self.found
            .measured_positions
            .iter_mut()
            .for_each(|measured| name(&mut measured.photo));
    }

    fn add_points(&mut self, points: Node<'_, '_>, block_system: &str) -> Result<(), Fault> {
        if let Some(path) = text_of(points, "Path") {
            self.found.warnings.push(format!(
                "the tie points are in a file of their own ('{}'), which is not read",
                shown(path)
            ));
        }
        let system = text_of(points, "SRSId").unwrap_or(block_system);
        let mut skipped = 0;
        let mut cloud = Cloud::default();
        let mut observations = Vec::new();
        for point in children(points, "TiePoint") {
            let own = text_of(point, "SRSId").unwrap_or(system);
            let Some(position) =
                child(point, "Position").filter(|_| Some(own) == self.system.as_deref())
            else {
                skipped += 1;
                continue;
            };
            let index = u32::try_from(cloud.points.len())
                .map_err(|_| fault(point, "too many tie points"))?;
            cloud.points.push(vector(position)?);
            cloud.colors.extend(child(point, "Color").and_then(color));
            for measurement in children(point, "Measurement") {
                let id: u64 = text_of(measurement, "PhotoId")
                    .and_then(|id| id.parse().ok())
                    .ok_or_else(|| fault(measurement, "a Measurement without PhotoId"))?;
                let photo = self.photo_of_id.get(&id).ok_or_else(|| {
                    fault(
                        measurement,
                        format!("a Measurement of photo {id}, which is not there"),
                    )
                })?;
                let Some(photo) = *photo else {
                    continue;
                };
                let (x, y) = (number(measurement, "x")?, number(measurement, "y")?);
                observations.push(Observation {
                    photo,
                    point: index,
                    pixel: DVec2::new(x, y) + 0.5,
                });
            }
        }
        if cloud.colors.len() != cloud.points.len() {
            cloud.colors.clear();
        }
        if skipped > 0 {
            self.found.warnings.push(format!(
                "{skipped} tie points have no position in the photos' coordinate system and are \
                 left out"
            ));
        }
        self.found.cloud = cloud;
        self.found.observations = observations;
        Ok(())
    }

    /// What the identifier of the system stands for.
    fn set_system(&mut self) -> Result<(), Fault> {
        let Some(id) = self.system.as_deref().filter(|id| !id.is_empty()) else {
            return Ok(());
        };
        let system = descendants(self.document.root_element(), "SRS")
            .find(|system| text_of(*system, "Id") == Some(id));
        let Some(system) = system else {
            let what = format!("SRSId {} stands for no SRS of the file", shown(id));
            return Err(Fault::new(what, EXPORT));
        };
        match system::read(text_of(system, "Definition").unwrap_or_default()) {
            System::Named(crs) => self.found.crs = Some(crs),
            System::EastNorthUp(origin) => self.found.enu_origin = Some(origin),
            System::Local => {}
            System::Unknown(definition) => self.found.warnings.push(format!(
                "the coordinate system '{}' is not understood and taken as a local one",
                shown(&definition)
            )),
        }
        Ok(())
    }
}

fn color(color: Node<'_, '_>) -> Option<[u8; 3]> {
    let part = |name| {
        let part = text_of(color, name)?.parse::<f64>().ok()?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 to 255 by then, and NaN is 0"
        )]
        Some((part * 255.0).round().clamp(0.0, 255.0) as u8)
    };
    Some([part("Red")?, part("Green")?, part("Blue")?])
}

fn children<'a, 'input: 'a>(
    node: Node<'a, 'input>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children()
        .filter(move |child| child.tag_name().name() == name)
}

fn descendants<'a, 'input: 'a>(
    node: Node<'a, 'input>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'input>> {
    node.descendants()
        .filter(move |child| child.tag_name().name() == name)
}

fn child<'a, 'input: 'a>(node: Node<'a, 'input>, name: &'static str) -> Option<Node<'a, 'input>> {
    children(node, name).next()
}

/// The text of a child, if it has any.
fn text_of<'a>(node: Node<'a, '_>, name: &'static str) -> Option<&'a str> {
    let text = child(node, name)?.text()?.trim();
    (!text.is_empty()).then_some(text)
}

fn fault(node: Node<'_, '_>, what: impl Into<String>) -> Fault {
    Fault::at(line_of(node), what, EXPORT)
}

/// The child's finite number.
fn number(node: Node<'_, '_>, name: &'static str) -> Result<f64, Fault> {
    optional(node, name)?
        .ok_or_else(|| fault(node, format!("a {} without {name}", node.tag_name().name())))
}

/// The child's finite number, if it is there.
fn optional(node: Node<'_, '_>, name: &'static str) -> Result<Option<f64>, Fault> {
    let Some(text) = text_of(node, name) else {
        return Ok(None);
    };
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(Some(number)),
        _ => Err(fault(
            node,
            format!("{name} is '{}', not a finite number", shown(text)),
        )),
    }
}

fn vector(node: Node<'_, '_>) -> Result<DVec3, Fault> {
    Ok(DVec3::new(
        number(node, "x")?,
        number(node, "y")?,
        number(node, "z")?,
    ))
}
