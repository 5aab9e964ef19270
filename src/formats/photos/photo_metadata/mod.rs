//! What a photo says about itself in EXIF and XMP: its camera, where it was taken, which way the
//! camera looked, and what is known of the lens. Only the file's header is read.
//!
//! `blocks` finds EXIF and XMP in the file, `exif_fields` and `xmp` take them apart,
//! `makers` knows what each maker writes, `focal` what it says about the lens, and
//! `calibrated_frame` for which image. Damaged blocks are warnings: the photo itself may be whole.

mod blocks;
mod calibrated_frame;
mod exif_fields;
mod focal;
mod makers;
mod xmp;

use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

use glam::{DMat3, DVec3};

pub use focal::{FocalCandidate, FocalSource, is_another_focal};

use crate::camera::Pose;
use crate::fault::{Fault, by_cause};
use crate::files::{FileError, open_file};
use crate::geodesy::Geographic;
use crate::photos::photo_size;
use exif_fields::ExifFields;
use xmp::{Vocabulary, Xmp};

/// What a photo says about itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoMetadata {
    /// Who made the camera.
    pub make: Option<String>,
    /// What the camera is called.
    pub model: Option<String>,
    /// The camera's serial number.
    pub serial: Option<String>,
    /// What the lens is called.
    pub lens: Option<String>,
    /// "YYYY:MM:DD HH:MM:SS" by the camera's clock.
    pub time: Option<String>,
    /// Width and height of the stored pixels.
    pub size: (u32, u32),
    /// EXIF's Orientation, 1 to 8: how viewers show these pixels, turned or mirrored. 1, as they are stored, where it does not say.
    pub shown: u32,
    /// Where it was taken.
    pub place: Option<MeasuredPlace>,
    /// Metres above the take-off.
    pub relative_altitude: Option<f64>,
    /// Metres to what the middle of the photo shows, by laser.
    pub laser_range: Option<f64>,
    /// Which way the camera looked.
    pub orientation: Option<CameraOrientation>,
    /// Where that is not known though XMP has angles: the URIs of their namespaces, in which it is
    /// not known whose angles they are.
    pub unknown_angles: Vec<String>,
    /// What is known of the lens, the most trustworthy first.
    pub focal: Vec<FocalCandidate>,
    /// What could not be read or has to be doubted, one sentence each.
    pub warnings: Vec<String>,
}

impl PhotoMetadata {
    /// What its camera is called, with its maker: "DJI FC6310R"; "camera" where nothing says it.
    pub fn camera_name(&self) -> String {
        let make = self.make.as_deref().unwrap_or_default();
        let model = self.model.as_deref().unwrap_or("camera");
        // Some models begin with the maker's name.
        match model.to_lowercase().starts_with(&make.to_lowercase()) {
            true => model.to_owned(),
            false => format!("{make} {model}"),
        }
    }
}

/// Where a receiver was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPlace {
    /// On WGS 84; its height is 0 where `height` is `None`.
    pub place: Geographic,
    /// What the height counts from.
    pub height: Option<HeightReference>,
    /// How it was found, where the maker says so.
    pub fix: Option<Fix>,
    /// Standard deviations towards east, north and up in metres, where they are stated.
    pub deviation: Option<DVec3>,
}

impl MeasuredPlace {
    /// Whether it is on the Earth, and not the zeros that a receiver without a fix writes.
    fn is_somewhere(&self) -> bool {
        let Geographic {
            longitude,
            latitude,
            ..
        } = self.place;
        longitude.abs() <= 180.0
            && latitude.abs() <= 90.0
            && (longitude.abs() > 1e-9 || latitude.abs() > 1e-9)
    }
}

/// What a height counts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum HeightReference {
    /// The ellipsoid of WGS 84, or of the correction service.
    Ellipsoid,
    /// Mean sea level, by the receiver's own model of it.
    SeaLevel,
    /// Sea level as the barometer has it, which was set at take-off: off by tens of metres.
    Barometer,
}

impl HeightReference {
    /// What is to be said of such heights: "the heights ...".
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Ellipsoid => "are above the ellipsoid, not above sea level",
            Self::SeaLevel => "are above sea level by the receiver's model, some 5 to 15 m off",
            Self::Barometer => {
                "come from the barometer and may be off by tens of metres; compare them with the cloud"
            }
        }
    }
}

/// How a receiver found its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fix {
    /// Centimetres.
    RtkFixed,
    /// Decimetres to metres.
    RtkFloat,
    /// Metres.
    Single,
    /// No fix.
    Nothing,
}

impl Fix {
    /// From DJI's RtkFlag: 0 none, 16 single, 32 to 49 float, 50 fixed.
    pub fn of_dji(flag: u32) -> Self {
        match flag {
            50 => Self::RtkFixed,
            32..=49 => Self::RtkFloat,
            1..=31 => Self::Single,
            _ => Self::Nothing,
        }
    }
}

/// Which way a camera looked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraOrientation {
    /// Yaw, pitch, roll.
    pub degrees: [f64; 3],
    /// Whose angles they are.
    pub angles: Angles,
}

/// Whose angles an orientation is written in; all aerospace, north-east-down, in z-y-x order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Angles {
    /// The camera's, which looks along its own forward axis: pitch -90 looks straight down.
    Camera,
    /// Those of a body that the camera looks down from, its top to the front: pitch 0 looks straight
    /// down.
    BodyLookingDown,
}

impl CameraOrientation {
    /// The pose in east, north, up at `center`.
    pub fn pose(&self, center: DVec3) -> Pose {
        let pose = Pose::from_yaw_pitch_roll(center, self.degrees);
        match self.angles {
            Angles::Camera => pose,
            // Of a camera that looks forward, the axes of one that looks down from the same body:
            // right as before, the image's bottom to the back, forward to the body's down.
            Angles::BodyLookingDown => Pose {
                rotation: pose.rotation * DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
                center,
            },
        }
    }
}

/// Reads the header of a photo file.
///
/// # Errors
/// Where it is no image that can be read.
pub fn read_file(path: &Path) -> Result<PhotoMetadata, FileError> {
    read(BufReader::new(open_file(path)?)).map_err(|fault| FileError::new(path, fault))
}

/// Reads the header of a photo.
///
/// # Errors
/// Where it is no image that can be read.
pub fn read(mut input: impl BufRead + Seek) -> Result<PhotoMetadata, Fault> {
    let blocks = blocks::read(&mut input);
    let size = match blocks.size {
        Some(size) => size,
        None => {
            let unreadable = |e| Fault::new(format!("it cannot be read ({e})"), "check the disk");
            input.rewind().map_err(unreadable)?;
            photo_size::read(input)?
        }
    };
    let mut warnings = blocks.warnings;
    let mut exif = ExifFields::default();
    match blocks.exif.map(exif_fields::read) {
        Some(Ok(fields)) => exif = fields,
        Some(Err(what)) => warnings.push(format!("its EXIF cannot be read ({what})")),
        None => {}
    }
    warnings.append(&mut exif.warnings);
    let mut xmp = Xmp::default();
    for packet in &blocks.xmp {
        if let Err(what) = xmp.add(packet) {
            warnings.push(format!("its XMP cannot be read ({what})"));
        }
    }
    let text = |name| xmp.text(Vocabulary::Tiff, name).map(str::to_owned);
    let make = exif.make.clone().or_else(|| text("Make"));
    let orientation = makers::orientation(&xmp, make.as_deref(), &mut warnings);
    if let Some(orientation) = &orientation {
        doubt_orientation(orientation, &exif, &xmp, &mut warnings);
    }
    let unknown_angles = match orientation {
        Some(_) => Vec::new(),
        None => makers::unknown_angles(&xmp),
    };
    let focal = focal::candidates(&exif, &xmp, size, &mut warnings);
    Ok(PhotoMetadata {
        place: place(&exif, &xmp, make.as_deref(), &mut warnings),
        make,
        model: exif.model.or_else(|| text("Model")),
        serial: exif.serial.or_else(|| makers::serial(&xmp)),
        lens: exif.lens,
        time: exif.time,
        size,
        shown: exif
            .orientation
            .filter(|shown| (1..=8).contains(shown))
            .unwrap_or(1),
        relative_altitude: makers::relative_altitude(&xmp),
        laser_range: makers::laser_range(&xmp),
        orientation,
        unknown_angles,
        focal,
        warnings,
    })
}

/// What photos' headers leave in doubt, a sentence a cause with the photos that it is about.
pub fn warnings_of<'a>(
    photos: impl IntoIterator<Item = (&'a str, &'a PhotoMetadata)>,
) -> Vec<String> {
    let of_each = photos.into_iter().flat_map(|(name, metadata)| {
        let warnings = metadata.warnings.iter();
        warnings.map(move |warning| (name, warning.clone()))
    });
    by_cause(of_each, "photos")
}

/// Whether a program is one in which people turn photos. Measured: three of the four photos in
/// shared/data/odm-brighton-0 were turned upside down in Windows Photo Viewer.
fn is_editor(software: &str) -> bool {
    let software = software.to_lowercase();
    [
        "microsoft",
        "windows",
        "photoshop",
        "lightroom",
        "gimp",
        "paint",
        "picasa",
        "irfanview",
        "xnview",
        "faststone",
        "acdsee",
        "imagemagick",
        "capture one",
    ]
    .iter()
    .any(|editor| software.contains(editor))
}

fn doubt_orientation(
    orientation: &CameraOrientation,
    exif: &ExifFields,
    xmp: &Xmp,
    warnings: &mut Vec<String>,
) {
    if orientation.degrees == [0.0; 3] && orientation.angles == Angles::Camera {
        warnings.push("all its gimbal angles are 0, which is most often no measurement".to_owned());
    }
    if let Some(editor) = exif.software.as_deref().filter(|name| is_editor(name)) {
        warnings.push(format!(
            "it was last written by '{editor}', which may have turned the pixels and left the camera's angles"
        ));
    }
    if makers::is_reversed(xmp) {
        warnings.push(
            "its camera or gimbal is marked as reversed (CamReverse, GimbalReverse), which is not understood: the photo may be upside down".to_owned(),
        );
    }
    if exif.orientation.is_some_and(|turned| turned > 1) {
        warnings.push(
            "its pixels are stored turned (EXIF Orientation), and the camera's angles may be those of the upright photo".to_owned(),
        );
    }
}

/// The place of EXIF or of XMP, whichever is written finer, with what XMP says about it.
fn place(
    exif: &ExifFields,
    xmp: &Xmp,
    make: Option<&str>,
    warnings: &mut Vec<String>,
) -> Option<MeasuredPlace> {
    let of_xmp = makers::degrees(xmp)
        .map(|(place, step)| {
            let place = MeasuredPlace {
                place,
                height: None,
                fix: None,
                deviation: None,
            };
            (place, step)
        })
        .filter(|(place, _)| place.is_somewhere());
    let mut found = match (exif.place, of_xmp) {
        (Some(exif_place), Some((xmp_place, step))) => {
            let apart = (exif_place.place.latitude - xmp_place.place.latitude)
                .abs()
                .max((exif_place.place.longitude - xmp_place.place.longitude).abs());
            if apart > 1e-3 {
                warnings.push(format!(
                    "its EXIF and its XMP state places {apart:.4} degrees apart; EXIF's is taken"
                ));
            }
            let finer = step < exif.place_step && apart <= 1e-3;
            let mut place = exif_place;
            if finer {
                place.place.longitude = xmp_place.place.longitude;
                place.place.latitude = xmp_place.place.latitude;
            }
            place
        }
        (Some(place), None) | (None, Some((place, _))) => place,
        (None, None) => return None,
    };
    makers::complete(&mut found, xmp, make);
    Some(found)
}

#[cfg(test)]
mod crop_tests;
#[cfg(test)]
mod namespace_tests;
#[cfg(test)]
mod tests;
