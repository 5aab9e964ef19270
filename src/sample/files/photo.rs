//! Photos as a drone's camera writes them: JPEG (ITU-T T.81) with EXIF in an APP1 segment right behind
//! the start of the image, then, where the gimbal is known, DJI's XMP in another one. The JFIF segment
//! is left out, as cameras do: JFIF and Exif both want to be the first.

use std::io::Cursor;

use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;

use super::exif;
use super::photo_metadata::PhotoMetadata;
use super::xmp;

/// The image as a JPEG of that quality (1 to 100) with its metadata. The EXIF also says the image's
/// size.
///
/// # Errors
/// Where the image is empty or larger than 65535 pixels, the quality is not from 1 to 100, a number
/// is not finite or does not fit its field, or a text is not what EXIF holds.
pub fn jpeg(image: &RgbImage, quality: u8, metadata: &PhotoMetadata) -> Result<Vec<u8>, String> {
    let (width, height) = image.dimensions();
    if !(1..=65_535).contains(&width) || !(1..=65_535).contains(&height) {
        return Err(format!("no JPEG has {width} x {height} pixels"));
    }
    if !(1..=100).contains(&quality) {
        return Err(format!("the JPEG quality {quality} is not from 1 to 100"));
    }
    let mut encoded = Cursor::new(Vec::new());
    JpegEncoder::new_with_quality(&mut encoded, quality)
        .encode_image(image)
        .map_err(|error| format!("the JPEG cannot be written ({error})"))?;
    let encoded = encoded.into_inner();
    let rest = encoded
        .strip_prefix(&[0xff, 0xd8])
        .ok_or("the encoder wrote no JPEG")?;

    let mut bytes = vec![0xff, 0xd8];
    app1(
        &mut bytes,
        b"Exif\0\0",
        &exif::tiff(width, height, metadata)?,
    )?;
    if let Some(gimbal) = &metadata.dji {
        let packet = xmp::dji_packet(gimbal, metadata.gps.as_ref(), metadata.rtk)?;
        app1(
            &mut bytes,
            b"http://ns.adobe.com/xap/1.0/\0",
            packet.as_bytes(),
        )?;
    }
    bytes.extend(without_jfif(rest));
    Ok(bytes)
}

/// Adds an APP1 segment: marker, length with itself, identifier, content.
fn app1(bytes: &mut Vec<u8>, identifier: &[u8], content: &[u8]) -> Result<(), String> {
    let length = u16::try_from(2 + identifier.len() + content.len())
        .map_err(|_| "the metadata does not fit a JPEG segment (64 KiB)".to_owned())?;
    bytes.extend([0xff, 0xe1]);
    bytes.extend(length.to_be_bytes());
    bytes.extend(identifier);
    bytes.extend(content);
    Ok(())
}

/// The segments behind the start of the image, without a JFIF segment at their begin.
fn without_jfif(segments: &[u8]) -> &[u8] {
    match segments {
        [0xff, 0xe0, high, low, rest @ ..] if rest.starts_with(b"JFIF\0") => {
            // The length counts its own two bytes.
            let length = usize::from(u16::from_be_bytes([*high, *low]));
            rest.get(length.saturating_sub(2)..).unwrap_or(segments)
        }
        _ => segments,
    }
}

#[cfg(test)]
mod tests {
    use ::exif::{Context, Exif, In, Reader, Tag, Value};
    use image::Rgb;

    use super::*;
    use crate::files::photo_metadata::{DjiGimbal, GpsPosition};

    fn picture() -> RgbImage {
        RgbImage::from_fn(37, 21, |x, y| Rgb([(x * 6) as u8, (y * 12) as u8, 90]))
    }

    fn whole() -> PhotoMetadata {
        PhotoMetadata {
            make: Some("DJI".to_owned()),
            model: Some("M3E".to_owned()),
            date_time_original: Some("2017:02:28 13:05:59".to_owned()),
            exposure_time_s: Some(1.0 / 640.0),
            f_number: Some(2.8),
            iso: Some(100),
            focal_length_mm: Some(12.29),
            focal_length_35mm: Some(24),
            gps: Some(GpsPosition {
                latitude: -43.123_456_789,
                longitude: 79.999_999_999_9,
                altitude: -12.345_6,
            }),
            rtk: None,
            dji: Some(DjiGimbal {
                roll: -0.001,
                yaw: 1.2,
                pitch: -89.9,
                relative_altitude: 60.0,
            }),
        }
    }

    fn read_exif(bytes: &[u8]) -> Exif {
        Reader::new()
            .read_from_container(&mut Cursor::new(bytes))
            .unwrap()
    }

    fn text(exif: &Exif, tag: Tag) -> String {
        match &exif.get_field(tag, In::PRIMARY).unwrap().value {
            Value::Ascii(lines) => String::from_utf8(lines[0].clone()).unwrap(),
            other => panic!("{tag}: {other:?}"),
        }
    }

    fn rationals(exif: &Exif, tag: Tag) -> Vec<(u32, u32)> {
        match &exif.get_field(tag, In::PRIMARY).unwrap().value {
            Value::Rational(values) => values.iter().map(|r| (r.num, r.denom)).collect(),
            other => panic!("{tag}: {other:?}"),
        }
    }

    fn whole_number(exif: &Exif, tag: Tag) -> u32 {
        exif.get_field(tag, In::PRIMARY)
            .unwrap()
            .value
            .get_uint(0)
            .unwrap()
    }

    fn degrees(exif: &Exif, tag: Tag) -> f64 {
        let values = rationals(exif, tag);
        let parts = values.iter().map(|&(n, d)| f64::from(n) / f64::from(d));
        parts
            .zip([1.0, 60.0, 3600.0])
            .map(|(part, of)| part / of)
            .sum()
    }

    #[test]
    fn another_reader_finds_every_tag() {
        let exif = read_exif(&jpeg(&picture(), 90, &whole()).unwrap());
        assert!(exif.little_endian());
        assert_eq!(text(&exif, Tag::Make), "DJI");
        assert_eq!(text(&exif, Tag::Model), "M3E");
        assert_eq!(text(&exif, Tag::DateTimeOriginal), "2017:02:28 13:05:59");
        assert_eq!(rationals(&exif, Tag::ExposureTime), [(1, 640)]);
        assert_eq!(rationals(&exif, Tag::FNumber), [(28, 10)]);
        assert_eq!(rationals(&exif, Tag::FocalLength), [(1229, 100)]);
        assert_eq!(whole_number(&exif, Tag::PhotographicSensitivity), 100);
        assert_eq!(whole_number(&exif, Tag::FocalLengthIn35mmFilm), 24);
        assert_eq!(whole_number(&exif, Tag::PixelXDimension), 37);
        assert_eq!(whole_number(&exif, Tag::PixelYDimension), 21);
        assert_eq!(text(&exif, Tag::GPSLatitudeRef), "S");
        assert_eq!(text(&exif, Tag::GPSLongitudeRef), "E");
        // Half of the millionth of a second that the fields keep; 80 degrees carry over.
        let latitude = degrees(&exif, Tag::GPSLatitude);
        assert!((latitude - 43.123_456_789).abs() < 0.51e-6 / 3600.0);
        assert_eq!(
            rationals(&exif, Tag::GPSLongitude),
            [(80, 1), (0, 1), (0, 1_000_000)]
        );
        assert_eq!(whole_number(&exif, Tag::GPSAltitudeRef), 1);
        assert_eq!(rationals(&exif, Tag::GPSAltitude), [(12_346, 1000)]);
        let gps = exif.fields().filter(|f| f.tag.context() == Context::Gps);
        assert_eq!(gps.count(), 7);
    }

    #[test]
    fn what_is_not_known_is_not_written() {
        let bytes = jpeg(&picture(), 90, &PhotoMetadata::default()).unwrap();
        let exif = read_exif(&bytes);
        assert_eq!(whole_number(&exif, Tag::PixelXDimension), 37);
        for tag in [Tag::Make, Tag::ExposureTime, Tag::GPSLatitude] {
            assert!(exif.get_field(tag, In::PRIMARY).is_none(), "{tag}");
        }
        assert!(!bytes.windows(3).any(|part| part == b"DJI"));
    }

    /// (marker, content) of the segments in front of the image data.
    fn segments(bytes: &[u8]) -> Vec<(u8, &[u8])> {
        assert_eq!(bytes[..2], [0xff, 0xd8]);
        let (mut at, mut found) = (2, Vec::new());
        while bytes[at + 1] != 0xda {
            assert_eq!(bytes[at], 0xff);
            let length = usize::from(u16::from_be_bytes([bytes[at + 2], bytes[at + 3]]));
            found.push((bytes[at + 1], &bytes[at + 4..at + 2 + length]));
            at += 2 + length;
        }
        found
    }

    #[test]
    fn exif_stands_first_then_xmp() {
        let bytes = jpeg(&picture(), 90, &whole()).unwrap();
        let segments = segments(&bytes);
        assert_eq!(segments[0].0, 0xe1);
        assert!(segments[0].1.starts_with(b"Exif\0\0II*\0"));
        assert_eq!(segments[1].0, 0xe1);
        let packet = segments[1]
            .1
            .strip_prefix(b"http://ns.adobe.com/xap/1.0/\0")
            .unwrap();
        assert!(
            segments[2..]
                .iter()
                .all(|(marker, _)| !(0xe0..=0xef).contains(marker))
        );

        let packet = std::str::from_utf8(packet).unwrap();
        let document = roxmltree::Document::parse(packet).unwrap();
        let description = document
            .descendants()
            .find(|node| node.has_tag_name("Description"))
            .unwrap();
        let attribute = |name: &str| {
            let namespace = "http://www.dji.com/drone-dji/1.0/";
            description.attribute((namespace, name)).unwrap()
        };
        assert_eq!(attribute("GimbalRollDegree"), "+0.00");
        assert_eq!(attribute("GimbalYawDegree"), "+1.20");
        assert_eq!(attribute("GimbalPitchDegree"), "-89.90");
        assert_eq!(attribute("RelativeAltitude"), "+60.000");
        assert_eq!(attribute("AbsoluteAltitude"), "-12.346");
        assert_eq!(attribute("GpsLatitude"), "-43.123456789");
        assert_eq!(attribute("GpsLongitude"), "+80.000000000");
    }

    #[test]
    fn decodes_to_the_same_picture() {
        let bytes = jpeg(&picture(), 100, &whole()).unwrap();
        assert_eq!(jpeg(&picture(), 100, &whole()).unwrap(), bytes);
        let decoded = image::load_from_memory(&bytes).unwrap().into_rgb8();
        assert_eq!(decoded.dimensions(), (37, 21));
        // Also without JFIF the three channels are taken for YCbCr; 100 leaves a few steps.
        let worst = decoded
            .iter()
            .zip(picture().iter())
            .map(|(a, b)| a.abs_diff(*b))
            .max();
        assert!(worst.unwrap() <= 12, "{worst:?}");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let refuse = |metadata: PhotoMetadata| jpeg(&picture(), 90, &metadata).unwrap_err();
        let none = PhotoMetadata::default;
        assert!(jpeg(&RgbImage::new(0, 0), 90, &none()).is_err());
        assert!(jpeg(&RgbImage::new(70_000, 1), 90, &none()).is_err());
        assert!(jpeg(&picture(), 0, &none()).is_err());
        assert!(jpeg(&picture(), 101, &none()).is_err());
        for date in [
            "",
            "2017-02-28 13:05:59",
            "2017:02:28T13:05:59",
            "2017:13:28 13:05:59",
        ] {
            let date_time_original = Some(date.to_owned());
            refuse(PhotoMetadata {
                date_time_original,
                ..none()
            });
        }
        for make in ["Größe", "a\0b", ""] {
            refuse(PhotoMetadata {
                make: Some(make.to_owned()),
                ..none()
            });
        }
        for number in [f64::NAN, f64::INFINITY, -1.0, 0.0, 5e9, 1e-12] {
            refuse(PhotoMetadata {
                exposure_time_s: Some(number),
                ..none()
            });
        }
        let gps = |latitude, longitude, altitude| PhotoMetadata {
            gps: Some(GpsPosition {
                latitude,
                longitude,
                altitude,
            }),
            ..none()
        };
        for bad in [
            gps(90.1, 0.0, 0.0),
            gps(0.0, -180.1, 0.0),
            gps(0.0, 0.0, f64::NAN),
        ] {
            refuse(bad);
        }
        assert!(jpeg(&picture(), 90, &gps(-90.0, 180.0, 0.0)).is_ok());
        let mut nan = whole();
        nan.dji.as_mut().unwrap().pitch = f64::NAN;
        refuse(nan);
        refuse(PhotoMetadata {
            model: Some("a".repeat(70_000)),
            ..none()
        });
    }
}
