//! The fields of EXIF (CIPA DC-008-2023, "Exif 3.0") that a photo's camera and place come from.
//!
//! - GPSAltitudeRef: 0 above, 1 below sea level; since Exif 3.0 2 above, 3 below the ellipsoid.
//! - FocalPlaneXResolution, FocalPlaneYResolution: pixels of the image per FocalPlaneResolutionUnit
//!   (2 inch, 3 cm; 4 mm and 5 micrometre are in use beyond the standard).
//! - FocalLengthIn35mmFilm: whole millimetres, 0 for unknown.
//! - A rational with the denominator 0 means that the value is not known.

use exif::{Exif, In, Reader, Tag, Value};

use super::{HeightReference, MeasuredPlace};
use crate::geodesy::Geographic;

/// What EXIF says; all as written.
#[derive(Debug, Default)]
pub(super) struct ExifFields {
    pub(super) make: Option<String>,
    pub(super) model: Option<String>,
    pub(super) serial: Option<String>,
    pub(super) lens: Option<String>,
    pub(super) time: Option<String>,
    /// The program or firmware that wrote the file last.
    pub(super) software: Option<String>,
    /// Of the image as the camera wrote it.
    pub(super) size: Option<(u32, u32)>,
    /// 1 where the pixels lie as they are seen.
    pub(super) orientation: Option<u32>,
    pub(super) focal_length: Option<FocalLength>,
    /// Pixels per millimetre on the sensor, across and down.
    pub(super) plane: Option<(f64, f64)>,
    /// In millimetres.
    pub(super) film_equivalent: Option<f64>,
    pub(super) digital_zoom: Option<f64>,
    pub(super) place: Option<MeasuredPlace>,
    /// How fine the place is written, in degrees.
    pub(super) place_step: f64,
    pub(super) warnings: Vec<String>,
}

/// A focal length as it is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct FocalLength {
    pub(super) millimetres: f64,
    /// The step that it is written in.
    pub(super) step: f64,
}

/// Reads the TIFF of an EXIF block.
///
/// # Errors
/// In words, where it is none.
pub(super) fn read(tiff: Vec<u8>) -> Result<ExifFields, String> {
    let mut incomplete = None;
    let exif = Reader::new()
        .continue_on_error(true)
        .read_raw(tiff)
        .or_else(|error| {
            error.distill_partial_result(|errors| {
                incomplete = errors.first().map(ToString::to_string);
            })
        })
        .map_err(|error| error.to_string())?;
    let exif = Fields(&exif);
    let pixels = |tag| exif.whole(tag).filter(|&n| n > 0);
    let mut fields = ExifFields {
        make: exif.text(Tag::Make),
        model: exif.text(Tag::Model),
        serial: exif.text(Tag::BodySerialNumber),
        lens: exif.text(Tag::LensModel),
        time: exif.text(Tag::DateTimeOriginal),
        software: exif.text(Tag::Software),
        size: pixels(Tag::PixelXDimension).zip(pixels(Tag::PixelYDimension)),
        orientation: exif.whole(Tag::Orientation),
        focal_length: exif.focal_length(),
        plane: exif.plane(),
        film_equivalent: exif.number(Tag::FocalLengthIn35mmFilm, 0),
        digital_zoom: exif.number(Tag::DigitalZoomRatio, 0),
        ..ExifFields::default()
    };
    fields.film_equivalent = fields.film_equivalent.filter(|&length| length > 0.0);
    if let Some(incomplete) = incomplete {
        let warning = format!("its EXIF is damaged ({incomplete}); what can be read is used");
        fields.warnings.push(warning);
    }
    if let Some((place, step)) = exif.place(&mut fields.warnings) {
        fields.place = Some(place);
        fields.place_step = step;
    }
    Ok(fields)
}

struct Fields<'a>(&'a Exif);

impl Fields<'_> {
    fn value(&self, tag: Tag) -> Option<&Value> {
        self.0.get_field(tag, In::PRIMARY).map(|field| &field.value)
    }

    fn text(&self, tag: Tag) -> Option<String> {
        let Value::Ascii(lines) = self.value(tag)? else {
            return None;
        };
        // Some fill the field with zeros, which end the text.
        let line = lines.iter().find(|line| !line.is_empty())?;
        let text = String::from_utf8_lossy(line);
        let text = text.trim_matches(|c: char| c.is_whitespace() || c.is_control());
        (!text.is_empty()).then(|| text.to_owned())
    }

    fn whole(&self, tag: Tag) -> Option<u32> {
        self.value(tag)?.get_uint(0)
    }

    fn number(&self, tag: Tag, place: usize) -> Option<f64> {
        number(self.value(tag)?, place)
    }

    fn focal_length(&self) -> Option<FocalLength> {
        let millimetres = self.number(Tag::FocalLength, 0).filter(|&f| f > 0.0)?;
        let step = match self.value(Tag::FocalLength)? {
            Value::Rational(numbers) => 1.0 / f64::from(numbers.first()?.denom),
            _ => 1.0,
        };
        Some(FocalLength { millimetres, step })
    }

    fn plane(&self) -> Option<(f64, f64)> {
        let unit = match self.whole(Tag::FocalPlaneResolutionUnit).unwrap_or(2) {
            2 => 25.4,
            3 => 10.0,
            4 => 1.0,
            5 => 1e-3,
            _ => return None,
        };
        let of = |tag| self.number(tag, 0).filter(|&r| r > 0.0).map(|r| r / unit);
        let x = of(Tag::FocalPlaneXResolution);
        let y = of(Tag::FocalPlaneYResolution);
        Some((x.or(y)?, y.or(x)?))
    }

    /// The place, and how fine it is written, in degrees.
    fn place(&self, warnings: &mut Vec<String>) -> Option<(MeasuredPlace, f64)> {
        let (latitude, step) = self.degrees(Tag::GPSLatitude)?;
        let (longitude, _) = self.degrees(Tag::GPSLongitude)?;
        let mut side = |tag, negative: char, missing: &str| {
            let text = self.text(tag);
            if text.is_none() {
                warnings.push(format!("its EXIF does not say {missing}; it is assumed"));
            }
            let is_negative = text.is_some_and(|text| {
                text.starts_with(negative) || text.starts_with(negative.to_ascii_lowercase())
            });
            if is_negative { -1.0 } else { 1.0 }
        };
        let latitude = latitude * side(Tag::GPSLatitudeRef, 'S', "that it is north");
        let longitude = longitude * side(Tag::GPSLongitudeRef, 'W', "that it is east");
        let reference = self.whole(Tag::GPSAltitudeRef).unwrap_or(0);
        let height = self.number(Tag::GPSAltitude, 0);
        let place = MeasuredPlace {
            place: Geographic {
                longitude,
                latitude,
                height: height.map_or(0.0, |height| match reference {
                    1 | 3 => -height,
                    _ => height,
                }),
            },
            height: height.map(|_| match reference {
                2 | 3 => HeightReference::Ellipsoid,
                _ => HeightReference::SeaLevel,
            }),
            fix: None,
            deviation: None,
        };
        place.is_somewhere().then_some((place, step))
    }

    /// Degrees, minutes and seconds as degrees, and the step of the finest of them.
    fn degrees(&self, tag: Tag) -> Option<(f64, f64)> {
        let value = self.value(tag)?;
        let (mut degrees, mut step) = (number(value, 0)?, 1.0);
        for (place, part) in [(0, 1.0), (1, 60.0), (2, 3600.0)] {
            let Some(number) = number(value, place) else {
                continue;
            };
            if place > 0 {
                degrees += number / part;
            }
            if let Value::Rational(numbers) = value
                && let Some(rational) = numbers.get(place)
                && rational.num > 0
            {
                step = f64::min(step, 1.0 / (part * f64::from(rational.denom)));
            }
        }
        Some((degrees, step))
    }
}

/// One of a value's numbers, where it is finite.
fn number(value: &Value, place: usize) -> Option<f64> {
    let number = match value {
        Value::Rational(numbers) => numbers.get(place)?.to_f64(),
        Value::SRational(numbers) => numbers.get(place)?.to_f64(),
        Value::Double(numbers) => *numbers.get(place)?,
        Value::Float(numbers) => f64::from(*numbers.get(place)?),
        _ => f64::from(value.get_uint(place)?),
    };
    number.is_finite().then_some(number)
}
