//! poses.csv (contract, section 4): one line a photo, the columns found by name.
//!
//! `photo`, `x`, `y`, `z` are always there; `camera` where there are several; the orientation is one
//! of `qx,qy,qz,qw`, `omega,phi,kappa`, `yaw,pitch,roll` and `tilt,pan` (see `camera::Pose` for what
//! each means). Lines that begin with # are comments. Fields may be quoted. Column names are
//! compared without case and outer spaces; columns of other names are passed over with a warning.

use std::collections::HashMap;

use glam::DVec3;

use super::input::text_from_bytes;
use super::table::{self, without_spaced_quotes};
use crate::camera::Pose;
use crate::fault::Fault;

/// One line of a poses.csv.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseLine {
    /// The image file's name.
    pub photo: String,
    /// What the camera is called, where the column is there and filled.
    pub camera: Option<String>,
    /// In the world.
    pub pose: Pose,
    /// Where it stands, from 1.
    pub line: u64,
}

/// The lines of a poses.csv, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct PosesFile {
    /// One a photo; the names differ.
    pub lines: Vec<PoseLine>,
    /// The coordinate system of the centres, where the file tells: "EPSG:n", WKT or a PROJ text. Where
    /// it is one of longitude and latitude, centres and rotations are as in a `Reconstruction` with
    /// such a system.
    pub crs: Option<String>,
    /// What was passed over.
    pub warnings: Vec<String>,
}

/// The ways to write an orientation.
const ORIENTATIONS: [&[&str]; 4] = [
    &["qx", "qy", "qz", "qw"],
    &["omega", "phi", "kappa"],
    &["yaw", "pitch", "roll"],
    &["tilt", "pan"],
];

/// Reads a poses.csv.
///
/// # Errors
/// With line and column: a missing column, a number that is not finite, a photo that is named twice,
/// a quaternion without length, no photo at all.
pub(super) fn read(bytes: &[u8]) -> Result<PosesFile, Fault> {
    let text = text_from_bytes(bytes)?;
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .has_headers(false)
        .from_reader(text.as_bytes());
    let mut records = reader
        .records()
        .map(|record| record.map(without_spaced_quotes));
    let malformed = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        Fault::at(
            line,
            format!("it is not a CSV table ({error})"),
            "check its quotes",
        )
    };
    let header = records
        .next()
        .transpose()
        .map_err(malformed)?
        .ok_or_else(|| {
            Fault::new(
                "it is empty",
                "give a header line and a line for each photo",
            )
        })?;
    let columns = Columns::find(line_of(text, &header), &header)?;
    let mut file = PosesFile {
        warnings: columns.warnings(&header),
        crs: None,
        lines: Vec::new(),
    };
    let mut seen: HashMap<String, u64> = HashMap::new();
    for record in records {
        let record = record.map_err(malformed)?;
        if record.iter().all(str::is_empty) {
            continue;
        }
        let line = columns.line(line_of(text, &record), &record)?;
        if let Some(first) = seen.insert(line.photo.clone(), line.line) {
            return Err(Fault::at(
                line.line,
                format!(
                    "column photo: '{}' stands on line {first} already",
                    line.photo
                ),
                "keep one line a photo",
            ));
        }
        file.lines.push(line);
    }
    if file.lines.is_empty() {
        return Err(Fault::new("it has no photos", "give a line for each photo"));
    }
    Ok(file)
}

/// The line, from 1, on which a record begins.
fn line_of(text: &str, record: &csv::StringRecord) -> u64 {
    table::line_of(text, record, |line| {
        line.is_empty() || line.starts_with('#')
    })
}

struct Columns {
    count: usize,
    photo: usize,
    camera: Option<usize>,
    position: [usize; 3],
    orientation: &'static [&'static str],
    angles: Vec<usize>,
}

impl Columns {
    fn find(line: u64, header: &csv::StringRecord) -> Result<Self, Fault> {
        let find = |name: &str| {
            header
                .iter()
                .position(|column| column.eq_ignore_ascii_case(name))
        };
        for (index, name) in header.iter().enumerate() {
            if find(name) != Some(index) && is_known(name) {
                return Err(Fault::at(
                    line,
                    format!("column {name} stands twice"),
                    "remove one of the two",
                ));
            }
        }
        let needed = |name: &str| {
            find(name).ok_or_else(|| {
                Fault::at(
                    line,
                    format!("there is no column {name}"),
                    "add it, or correct its name",
                )
            })
        };
        let started: Vec<_> = ORIENTATIONS
            .into_iter()
            .filter(|names| names.iter().any(|name| find(name).is_some()))
            .collect();
        let photo = needed("photo")?;
        let position = [needed("x")?, needed("y")?, needed("z")?];
        let orientation = match started[..] {
            [orientation] => orientation,
            [] => {
                return Err(Fault::at(
                    line,
                    "there are no columns for the orientation",
                    "add qx,qy,qz,qw or omega,phi,kappa or yaw,pitch,roll or tilt,pan",
                ));
            }
            [one, two, ..] => {
                return Err(Fault::at(
                    line,
                    format!(
                        "there are columns of two orientations, {} and {}",
                        one.join(","),
                        two.join(",")
                    ),
                    "keep the one that holds",
                ));
            }
        };
        Ok(Self {
            count: header.len(),
            photo,
            camera: find("camera"),
            position,
            orientation,
            angles: orientation
                .iter()
                .map(|name| needed(name))
                .collect::<Result<_, _>>()?,
        })
    }

    fn warnings(&self, header: &csv::StringRecord) -> Vec<String> {
        let unused: Vec<&str> = header.iter().filter(|name| !is_known(name)).collect();
        if unused.is_empty() {
            return Vec::new();
        }
        vec![format!("columns that are not used: {}", unused.join(", "))]
    }

    fn line(&self, line: u64, record: &csv::StringRecord) -> Result<PoseLine, Fault> {
        // A decimal comma, for one, shifts everything behind it.
        if let Some(extra) = record
            .iter()
            .skip(self.count)
            .find(|field| !field.is_empty())
        {
            return Err(Fault::at(
                line,
                format!(
                    "it has {} fields for {} columns ('{extra}' is too many)",
                    record.len(),
                    self.count
                ),
                "write decimal points, and quote names with commas",
            ));
        }
        let field = |column: usize, name: &str| {
            record
                .get(column)
                .filter(|field| !field.is_empty())
                .ok_or_else(|| Fault::at(line, format!("column {name} is empty"), "fill it in"))
        };
        let number = |column: usize, name: &str| {
            let text = field(column, name)?;
            text.parse::<f64>()
                .ok()
                .filter(|n| n.is_finite())
                .ok_or_else(|| {
                    let what = format!("column {name}: '{text}' is not a finite number");
                    Fault::at(line, what, "correct it")
                })
        };
        let [x, y, z] = self.position;
        let center = DVec3::new(number(x, "x")?, number(y, "y")?, number(z, "z")?);
        let angles = self
            .angles
            .iter()
            .zip(self.orientation)
            .map(|(&column, name)| number(column, name))
            .collect::<Result<Vec<f64>, Fault>>()?;
        let pose = match (self.orientation[0], &angles[..]) {
            ("qx", &[qx, qy, qz, qw]) => {
                Pose::from_quaternion(center, [qx, qy, qz, qw]).map_err(|error| {
                    let what = format!("column qx: {error}");
                    Fault::at(line, what, "give the whole quaternion")
                })?
            }
            ("omega", &[omega, phi, kappa]) => {
                Pose::from_omega_phi_kappa(center, [omega, phi, kappa])
            }
            ("yaw", &[yaw, pitch, roll]) => Pose::from_yaw_pitch_roll(center, [yaw, pitch, roll]),
            (_, &[tilt, pan]) => Pose::from_tilt_pan(center, [tilt, pan]),
            // `angles` has one number for each name of its orientation.
            _ => {
                return Err(Fault::at(
                    line,
                    "the orientation is incomplete",
                    "fill it in",
                ));
            }
        };
        Ok(PoseLine {
            photo: field(self.photo, "photo")?.to_owned(),
            camera: self
                .camera
                .and_then(|column| record.get(column))
                .filter(|name| !name.is_empty())
                .map(str::to_owned),
            pose,
            line,
        })
    }
}

fn is_known(name: &str) -> bool {
    ["photo", "camera", "x", "y", "z"]
        .iter()
        .chain(ORIENTATIONS.into_iter().flatten())
        .any(|known| name.eq_ignore_ascii_case(known))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn every_orientation_straight_down() {
        for (columns, values) in [
            ("qx,qy,qz,qw", "2,0,0,0"),
            ("omega,phi,kappa", "0,0,0"),
            ("yaw,pitch,roll", "0,-90,0"),
            ("tilt,pan", "90,0"),
        ] {
            let text = format!("photo,x,y,z,{columns}\na.jpg,500000.123456,2,3,{values}\n");
            let file = read(text.as_bytes()).unwrap();
            let pose = file.lines[0].pose;
            assert_eq!(pose.center, DVec3::new(500_000.123_456, 2.0, 3.0));
            assert!(
                (pose.rotation.z_axis - DVec3::NEG_Z).length() < 1e-15,
                "{columns}"
            );
            assert!(
                (pose.rotation.y_axis - DVec3::NEG_Y).length() < 1e-15,
                "{columns}"
            );
        }
    }

    #[test]
    fn any_order_comments_quotes_crlf_and_bom() {
        let text = "\u{feff}# flown by hand\r\n z ,Pan,\"photo\",camera,TILT,y,x,battery\r\n\
            \r\n# first\r\n3,10,\"a, b.jpg\", \"left\",80,2,1,99\r\n6,20,c.jpg,,70,5,4,98\r\n";
        let file = read(text.as_bytes()).unwrap();
        assert_eq!(file.lines[0].photo, "a, b.jpg");
        assert_eq!(file.lines[0].camera.as_deref(), Some("left"));
        assert_eq!(file.lines[1].camera, None);
        assert_eq!(file.lines[1].pose.center, DVec3::new(4.0, 5.0, 6.0));
        assert_eq!(file.warnings, ["columns that are not used: battery"]);
    }

    #[test]
    fn mistakes_have_a_line_and_a_column() {
        let head = "photo,x,y,z,qx,qy,qz,qw\n";
        let fault = |text: &str| read(text.as_bytes()).unwrap_err();
        let with = |lines: &str| fault(&format!("{head}{lines}"));
        let twice = with("a,0,0,0,0,0,0,1\nb,0,0,0,0,0,0,1\na,1,1,1,0,0,0,1\n");
        assert_eq!(twice.line, Some(4));
        assert!(twice.what.contains("line 2"), "{twice}");
        let nan = with("# x\na,0,nan,0,0,0,0,1\n");
        assert_eq!(nan.line, Some(3));
        assert!(nan.what.starts_with("column y: 'nan'"), "{nan}");
        let crlf = "\u{feff}# c\r\n\r\nphoto,x,y,z,tilt,pan\r\n\r\n# c\r\na,1,2,3,4,x\r\n";
        assert_eq!(fault(crlf).line, Some(6));
        assert!(with("a,0,0,inf,0,0,0,1\n").what.contains("column z"));
        assert!(with("a,0,0,0,0,0,0\n").what.contains("column qw"));
        assert!(with("a,0,0,0,0,0,0,0\n").what.contains("quaternion"));
        assert!(
            with("a,1,5,0,0,0,0,0,1\n")
                .what
                .contains("9 fields for 8 columns")
        );
        assert!(with(",0,0,0,0,0,0,1\n").what.contains("column photo"));
        assert!(with("").what.contains("no photos"));
        assert!(fault("").what.contains("empty"));
        assert!(
            fault("photo,x,y,qx,qy,qz,qw\n")
                .what
                .contains("no column z")
        );
        assert!(fault("photo,x,y,z\n").what.contains("orientation"));
        assert!(
            fault("photo,x,y,z,qx,qy,qz\n")
                .what
                .contains("no column qw")
        );
        assert!(
            fault("photo,x,y,z,tilt,pan,yaw,pitch,roll\n")
                .what
                .contains("two orientations")
        );
        assert!(
            fault("photo,x,x,y,z,tilt,pan\n")
                .what
                .contains("stands twice")
        );
        assert!(read(b"photo,x\xff").is_err());
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "(photo|x|y|z|tilt|pan|[,\"\n# 0-9.a-z-]){0,60}") {
            let _ = read(text.as_bytes());
            let _ = read(format!("photo,x,y,z,tilt,pan\n{text}").as_bytes());
        }
    }
}
