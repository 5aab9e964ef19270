//! `*_calibrated_camera_parameters.txt`: a header that names the fields, then a record a photo.
//!
//! Records are told from the lines themselves, because lenses of one project may differ: the line of
//! a photo is its name and two whole numbers, all others are numbers alone. Nine of them belong to a
//! perspective lens (K in three, radial, tangential, t, R in three), four to a fish-eye (t, R).

use glam::DVec3;

use crate::camera::{Brown, Camera, CameraError, Distortion, Pose};
use crate::fault::Fault;
use crate::text::fields::Fields;

const EXPORT: &str = "let Pix4D write its params folder again (Process > Reoptimize)";

/// One photo of the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Calibrated {
    pub(super) name: String,
    /// Without a name; `None` for a fish-eye, whose record has no calibration.
    pub(super) camera: Option<Camera>,
    /// In Pix4D's coordinates, less the offset.
    pub(super) pose: Pose,
}

/// Reads all records.
///
/// # Errors
/// A record that is not of the form above, with its line; no record at all.
pub(super) fn read(text: &str) -> Result<Vec<Calibrated>, Fault> {
    let mut photos = Vec::new();
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty())
        .peekable();
    // The header's lines have words, but none ends with two whole numbers.
    while lines
        .next_if(|(_, line)| split_name(line).is_none())
        .is_some()
    {}
    while let Some((line, text)) = lines.next() {
        let Some((name, size)) = split_name(text) else {
            let what = "a line of numbers where a photo's name and size should be";
            return Err(Fault::at(line, what, EXPORT));
        };
        let mut numbers = Vec::new();
        while let Some(next) = lines.next_if(|(_, line)| split_name(line).is_none()) {
            numbers.push(next);
            if numbers.len() > 9 {
                return Err(Fault::at(next.0, too_many(name), EXPORT));
            }
        }
        photos.push(record(line, name, size, &numbers)?);
    }
    if photos.is_empty() {
        return Err(Fault::new("it holds no calibrated photo", EXPORT));
    }
    Ok(photos)
}

fn too_many(name: &str) -> String {
    format!("photo '{name}' has more than the nine lines of K, distortion, t and R")
}

/// The name and the size of the line that begins a record; `None` for all others.
fn split_name(line: &str) -> Option<(&str, (u32, u32))> {
    let (rest, height) = line.trim().rsplit_once(char::is_whitespace)?;
    let (name, width) = rest.trim_end().rsplit_once(char::is_whitespace)?;
    let size = (width.parse().ok()?, height.parse().ok()?);
    // A line of K may be whole numbers.
    let is_name = name
        .split_whitespace()
        .any(|word| word.parse::<f64>().is_err());
    is_name.then_some((name.trim(), size))
}

fn record(
    line: u64,
    name: &str,
    size: (u32, u32),
    numbers: &[(u64, &str)],
) -> Result<Calibrated, Fault> {
    let (calibration, [t, r0, r1, r2]) = match *numbers {
        [k0, k1, k2, radial, tangential, t, r0, r1, r2] => {
            let camera = camera(size, [k0, k1, k2], radial, tangential)?;
            (Some(camera), [t, r0, r1, r2])
        }
        [t, r0, r1, r2] => (None, [t, r0, r1, r2]),
        _ => {
            let what = format!(
                "photo '{name}' has {} lines of numbers, not the nine of a perspective lens or the \
                 four of a fish-eye",
                numbers.len()
            );
            return Err(Fault::at(line, what, EXPORT));
        }
    };
    let center = triple(t, "the camera position t")?;
    let rows = [r0, r1, r2].map(|row| triple(row, "a row of the rotation R"));
    let [x, y, z] = rows;
    // The rows are the camera's axes in the world, which are the columns of world_from_camera.
    let (x, y, z) = (x?, y?, z?);
    let matrix = [x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z];
    let pose = Pose::from_row_major(center, matrix)
        .map_err(|error| Fault::at(r0.0, format!("photo '{name}', rotation R: {error}"), EXPORT))?;
    Ok(Calibrated {
        name: name.to_owned(),
        camera: calibration,
        pose,
    })
}

fn camera(
    (width, height): (u32, u32),
    [k0, k1, k2]: [(u64, &str); 3],
    radial: (u64, &str),
    tangential: (u64, &str),
) -> Result<Camera, Fault> {
    let (x, y, z) = (
        triple(k0, "the first row of K")?,
        triple(k1, "the second row of K")?,
        triple(k2, "the third row of K")?,
    );
    if y.x != 0.0 || z != DVec3::Z {
        let what = "K is no camera matrix: its lower left is not 0 0 0, its last number not 1";
        return Err(Fault::at(k1.0, what, EXPORT));
    }
    let r = triple(radial, "the radial distortion")?;
    let mut fields = Fields::new(tangential.0, tangential.1, EXPORT);
    let t = fields.pair("the tangential distortion")?;
    let camera = Camera {
        name: String::new(),
        width,
        height,
        fx: x.x,
        fy: y.y,
        cx: x.z,
        cy: y.z,
        skew: x.y,
        distortion: distortion([r.x, r.y, r.z], [t.x, t.y]),
    };
    camera
        .validate()
        .map_err(|error: CameraError| Fault::at(k0.0, error.to_string(), EXPORT))?;
    Ok(camera)
}

/// Pix4D's R1 R2 R3, T1 T2 are OpenCV's k1 k2 k3, p1 p2.
pub(super) fn distortion([r1, r2, r3]: [f64; 3], [t1, t2]: [f64; 2]) -> Distortion {
    if [r1, r2, r3, t1, t2] == [0.0; 5] {
        return Distortion::None;
    }
    Distortion::Brown(Brown::new([r1, r2, t1, t2, r3, 0.0, 0.0, 0.0]))
}

/// The three numbers that a line consists of.
fn triple((line, text): (u64, &str), name: &str) -> Result<DVec3, Fault> {
    let mut fields = Fields::new(line, text, EXPORT);
    let triple = fields.triple(name)?;
    match fields.rest() {
        "" => Ok(triple),
        _ => Err(fields.fault(format!("{name} has more than three numbers"))),
    }
}
