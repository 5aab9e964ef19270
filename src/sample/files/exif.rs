//! EXIF (CIPA DC-008, "Exif 2.32") as a little-endian TIFF 6.0: the directory of the image, that of
//! the exposure, and that of the position where it is known. Written by hand: 20 tags of 5 types.
//!
//! A directory is a count, entries of 12 bytes in the order of their tags (tag, type, number of
//! values, the value or the place where it is), and the place of the next one. Values of more than 4
//! bytes follow their directory, each at an even place.

use super::photo_metadata::{GpsPosition, PhotoMetadata};

/// The value of an entry.
enum Value {
    Bytes(Vec<u8>),
    /// Without its closing zero.
    Ascii(String),
    Short(u16),
    Long(u32),
    /// Numerators and denominators.
    Rationals(Vec<(u32, u32)>),
    /// Bytes whose meaning the tag knows.
    Undefined([u8; 4]),
    /// The place of another directory: its number in the list.
    Directory(usize),
}

type Entry = (u16, Value);

/// The TIFF behind "Exif\0\0" for an image of that size.
///
/// # Errors
/// Where a text is not ASCII, the date is none, or a number does not fit its field.
pub(super) fn tiff(width: u32, height: u32, photo: &PhotoMetadata) -> Result<Vec<u8>, String> {
    let mut image = Vec::new();
    if let Some(make) = &photo.make {
        image.push((0x010f, ascii("make", make)?));
    }
    if let Some(model) = &photo.model {
        image.push((0x0110, ascii("model", model)?));
    }
    // Orientation: as stored. Resolution: 72 dpi stands for unknown. Chroma: centred, as JFIF's.
    image.push((0x0112, Value::Short(1)));
    image.push((0x011a, Value::Rationals(vec![(72, 1)])));
    image.push((0x011b, Value::Rationals(vec![(72, 1)])));
    image.push((0x0128, Value::Short(2)));
    image.push((0x0213, Value::Short(1)));
    image.push((0x8769, Value::Directory(1)));

    let mut exposure = Vec::new();
    if let Some(time) = photo.exposure_time_s {
        exposure.push((0x829a, rational("exposure time", time)?));
    }
    if let Some(number) = photo.f_number {
        exposure.push((0x829d, rational("f-number", number)?));
    }
    if let Some(iso) = photo.iso {
        exposure.push((0x8827, Value::Short(iso)));
    }
    exposure.push((0x9000, Value::Undefined(*b"0232")));
    if let Some(date) = &photo.date_time_original {
        exposure.push((0x9003, date_time(date)?));
    }
    // Components: Y Cb Cr.
    exposure.push((0x9101, Value::Undefined([1, 2, 3, 0])));
    if let Some(length) = photo.focal_length_mm {
        exposure.push((0x920a, rational("focal length", length)?));
    }
    exposure.push((0xa000, Value::Undefined(*b"0100")));
    // Colour space: sRGB.
    exposure.push((0xa001, Value::Short(1)));
    exposure.push((0xa002, Value::Long(width)));
    exposure.push((0xa003, Value::Long(height)));
    if let Some(length) = photo.focal_length_35mm {
        exposure.push((0xa405, Value::Short(length)));
    }

    let mut directories = vec![image, exposure];
    if let Some(gps) = &photo.gps {
        if let Some(image) = directories.first_mut() {
            image.push((0x8825, Value::Directory(2)));
        }
        directories.push(position(gps)?);
    }
    write(&directories)
}

/// The directory of the position.
fn position(gps: &GpsPosition) -> Result<Vec<Entry>, String> {
    let GpsPosition {
        latitude,
        longitude,
        altitude,
    } = *gps;
    let side = |value: f64, sides: [&str; 2]| {
        let [negative, positive] = sides;
        Value::Ascii(if value < 0.0 { negative } else { positive }.to_owned())
    };
    let millimetres = (altitude.abs() * 1000.0).round();
    if !(0.0..=f64::from(u32::MAX)).contains(&millimetres) {
        return Err(format!("the altitude {altitude} m does not fit EXIF"));
    }
    Ok(vec![
        (0, Value::Bytes(vec![2, 3, 0, 0])),
        (1, side(latitude, ["S", "N"])),
        (2, degrees("latitude", latitude, 90.0)?),
        (3, side(longitude, ["W", "E"])),
        (4, degrees("longitude", longitude, 180.0)?),
        // Below sea level?
        (5, Value::Bytes(vec![u8::from(altitude < 0.0)])),
        (6, Value::Rationals(vec![(millimetres as u32, 1000)])),
    ])
}

/// Degrees, minutes and millionths of a second.
fn degrees(what: &str, value: f64, limit: f64) -> Result<Value, String> {
    if !(-limit..=limit).contains(&value) {
        return Err(format!(
            "the {what} is {value}, not from -{limit} to {limit}"
        ));
    }
    const SECOND: u64 = 1_000_000;
    // At most 180 * 3600 * 1e6: each part fits its field.
    let all = (value.abs() * 3600.0 * SECOND as f64).round() as u64;
    Ok(Value::Rationals(vec![
        ((all / (3600 * SECOND)) as u32, 1),
        ((all / (60 * SECOND) % 60) as u32, 1),
        ((all % (60 * SECOND)) as u32, SECOND as u32),
    ]))
}

fn ascii(what: &str, text: &str) -> Result<Value, String> {
    if text.is_empty() || !text.chars().all(|c| c.is_ascii() && !c.is_ascii_control()) {
        return Err(format!(
            "the {what} {text:?} is not ASCII, as EXIF wants it"
        ));
    }
    Ok(Value::Ascii(text.to_owned()))
}

/// "YYYY:MM:DD HH:MM:SS".
fn date_time(text: &str) -> Result<Value, String> {
    let pattern = b"dddd:dd:dd dd:dd:dd";
    let shaped = text.len() == pattern.len()
        && text.bytes().zip(pattern).all(|(byte, like)| match like {
            b'd' => byte.is_ascii_digit(),
            _ => byte == *like,
        });
    let within = |at: usize, from: u8, to: u8| {
        let number = text.get(at..at + 2).and_then(|part| part.parse().ok());
        number.is_some_and(|number: u8| (from..=to).contains(&number))
    };
    let valid = shaped
        && within(5, 1, 12)
        && within(8, 1, 31)
        && within(11, 0, 23)
        && within(14, 0, 59)
        && within(17, 0, 59);
    if !valid {
        return Err(format!("the date {text:?} is not YYYY:MM:DD HH:MM:SS"));
    }
    Ok(Value::Ascii(text.to_owned()))
}

/// A positive number as people expect it: 1/n, or a decimal fraction of up to six places.
fn rational(what: &str, value: f64) -> Result<Value, String> {
    let whole = |number: f64| {
        let rounded = number.round();
        let near = (number - rounded).abs() <= 1e-9 * number;
        (near && (1.0..=f64::from(u32::MAX)).contains(&rounded)).then_some(rounded as u32)
    };
    if value > 0.0
        && value < 1.0
        && let Some(n) = whole(1.0 / value)
    {
        return Ok(Value::Rationals(vec![(1, n)]));
    }
    let mut coarse = None;
    for denominator in (0..=6).map(|digits| 10_u32.pow(digits)) {
        let scaled = value * f64::from(denominator);
        if let Some(n) = whole(scaled) {
            return Ok(Value::Rationals(vec![(n, denominator)]));
        }
        if let Some(n) = whole(scaled.round()) {
            coarse = Some((n, denominator));
        }
    }
    coarse
        .map(|fraction| Value::Rationals(vec![fraction]))
        .ok_or_else(|| format!("the {what} {value} does not fit EXIF"))
}

/// Type, number of values and bytes of a value; the places of directories are known by now.
fn encode(value: &Value, places: &[u32]) -> (u16, usize, Vec<u8>) {
    match value {
        Value::Bytes(bytes) => (1, bytes.len(), bytes.clone()),
        Value::Ascii(text) => {
            let bytes: Vec<u8> = text.bytes().chain([0]).collect();
            (2, bytes.len(), bytes)
        }
        Value::Short(number) => (3, 1, number.to_le_bytes().to_vec()),
        Value::Long(number) => (4, 1, number.to_le_bytes().to_vec()),
        Value::Rationals(fractions) => {
            let numbers = fractions.iter().flat_map(|(n, d)| [*n, *d]);
            (
                5,
                fractions.len(),
                numbers.flat_map(u32::to_le_bytes).collect(),
            )
        }
        Value::Undefined(bytes) => (7, bytes.len(), bytes.to_vec()),
        Value::Directory(index) => {
            let place = places.get(*index).copied().unwrap_or_default();
            (4, 1, place.to_le_bytes().to_vec())
        }
    }
}

/// How many bytes a directory takes together with its long values.
fn size(directory: &[Entry]) -> usize {
    let long: usize = directory
        .iter()
        .map(|(_, value)| encode(value, &[]).2.len())
        .filter(|&length| length > 4)
        .map(|length| length.next_multiple_of(2))
        .sum();
    2 + directory.len() * 12 + 4 + long
}

/// The header and the directories, one behind the other.
fn write(directories: &[Vec<Entry>]) -> Result<Vec<u8>, String> {
    let too_long = |_| "the EXIF is too long".to_owned();
    let mut places = Vec::new();
    let mut end = 8;
    for directory in directories {
        places.push(u32::try_from(end).map_err(too_long)?);
        end += size(directory);
    }
    u32::try_from(end).map_err(too_long)?;

    let mut bytes = b"II*\0\x08\0\0\0".to_vec();
    for directory in directories {
        let mut place = bytes.len() + 2 + directory.len() * 12 + 4;
        let mut long = Vec::new();
        // A few dozen entries, and `end` fits: so do all that follow.
        bytes.extend((directory.len() as u16).to_le_bytes());
        for (tag, value) in directory {
            let (kind, count, mut content) = encode(value, &places);
            bytes.extend(tag.to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend((count as u32).to_le_bytes());
            if content.len() <= 4 {
                content.resize(4, 0);
                bytes.extend(content);
            } else {
                content.resize(content.len().next_multiple_of(2), 0);
                bytes.extend((place as u32).to_le_bytes());
                place += content.len();
                long.extend(content);
            }
        }
        // There is no next directory: the others hang on the first one's entries.
        bytes.extend([0; 4]);
        bytes.extend(long);
    }
    Ok(bytes)
}
