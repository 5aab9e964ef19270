//! poses.csv (contract, section 4): one line a photo, the columns found by name.
//!
//! `photo`, `x`, `y`, `z` are always there; `camera` where there are several; the orientation is one
//! of `qx,qy,qz,qw`, `omega,phi,kappa`, `yaw,pitch,roll` and `tilt,pan` (see `camera::Pose` for what
//! each means). `s_x,s_y,s_z` (world unit) and `s_angle` (degrees) are standard deviations of the centre
//! and of the rotation about each camera axis (contract, section 8); an empty cell states none. Lines that begin with # are comments. Fields may be quoted; commas separate them, or
//! what else a spreadsheet writes: semicolons, tabs (see `table`). Numbers with a decimal comma are
//! read with a warning. Column names are compared without case and outer spaces; columns of other
//! names are passed over with a warning.

use std::collections::HashMap;

use glam::DVec3;

use super::odd_angles::OddAngles;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::files::text_from_bytes;
use crate::flight::Doubt;
use crate::scale::PoseErrors;
use crate::tables::table::{NumberRepairs, Row, Table};
use crate::text::separated::Separator;

/// One line of a poses.csv.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseLine {
    /// The image file's name.
    pub photo: String,
    /// What the camera is called, where the column is there and filled.
    pub camera: Option<String>,
    /// In the world.
    pub pose: Pose,
    /// How sure it is, where the columns are there and filled.
    pub errors: PoseErrors,
    /// Where it stands, from 1.
    pub line: u64,
}

/// The lines of a poses.csv, in order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PosesFile {
    /// One a photo; the names differ.
    pub lines: Vec<PoseLine>,
    /// The coordinate system of the centres, where the file tells: "EPSG:n", WKT or a PROJ text. Where
    /// it is one of longitude and latitude, centres and rotations are as in a `Reconstruction` with
    /// such a system.
    pub crs: Option<String>,
    /// What was passed over, and `doubts` in words.
    pub warnings: Vec<String>,
    /// What speaks against all of its poses.
    pub doubts: Vec<Doubt>,
}

impl PosesFile {
    /// Says what is odd about its orientations.
    pub(super) fn take_odd(&mut self, odd: &OddAngles) {
        self.doubts = odd.doubts();
        self.warnings
            .extend(self.doubts.iter().map(Doubt::to_string));
    }
}

/// The ways to write an orientation.
const ORIENTATIONS: [&[&str]; 4] = [
    &["qx", "qy", "qz", "qw"],
    &["omega", "phi", "kappa"],
    &["yaw", "pitch", "roll"],
    &["tilt", "pan"],
];

/// The columns of standard deviations.
const POSITION_ERRORS: [&str; 3] = ["s_x", "s_y", "s_z"];
const ANGLE_ERROR: &str = "s_angle";

/// Reads a poses.csv.
///
/// # Errors
/// With line and column: a missing column, a number that is not finite, a photo that is named twice,
/// a quaternion without length, no photo at all.
pub(crate) fn read(bytes: &[u8]) -> Result<PosesFile, Fault> {
    let text = without_comments(text_from_bytes(bytes)?);
    if text.trim().is_empty() {
        let remedy = "give a header line and a line for each photo";
        return Err(Fault::new("it is empty", remedy));
    }
    let table = Table::read_even_empty(&text)?;
    let columns = Columns::find(table.header_line(), table.header())?;
    let mut file = PosesFile {
        warnings: columns.warnings(table.header()),
        ..PosesFile::default()
    };
    let mut seen: HashMap<String, u64> = HashMap::new();
    let mut repairs = NumberRepairs::default();
    let mut odd = OddAngles::default();
    for row in table.rows() {
        let line = columns.line(&table, row, &mut repairs, &mut odd)?;
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
    file.warnings.extend(repairs.warnings());
    file.take_odd(&odd);
    Ok(file)
}

/// Whether the first line that is no comment names a column "photo" and one of an angle: without, they are positions of photos.
pub(crate) fn is_table(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let mut lines = text.trim_start_matches('\u{feff}').lines();
    let header = lines.find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    header.is_some_and(|header| {
        let columns = Separator::of(header).split(header);
        let has = |wanted: &str| columns.iter().any(|name| name.eq_ignore_ascii_case(wanted));
        has("photo") && ORIENTATIONS.into_iter().flatten().any(|name| has(name))
    })
}

/// The text with empty lines in place of comments: here "#4" is one, too.
fn without_comments(text: &str) -> String {
    let lines = text.lines().flat_map(|line| {
        let is_comment = line.starts_with('#');
        [if is_comment { "" } else { line }, "\n"]
    });
    lines.collect()
}

struct Columns {
    photo: usize,
    camera: Option<usize>,
    position: [usize; 3],
    orientation: &'static [&'static str],
    angles: Vec<usize>,
    position_errors: Option<[usize; 3]>,
    angle_error: Option<usize>,
}

impl Columns {
    fn find(line: u64, header: &[String]) -> Result<Self, Fault> {
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
        let [s_x, s_y, s_z] = POSITION_ERRORS;
        let position_errors = match POSITION_ERRORS.into_iter().any(|name| find(name).is_some()) {
            true => Some([needed(s_x)?, needed(s_y)?, needed(s_z)?]),
            false => None,
        };
        Ok(Self {
            photo,
            position_errors,
            angle_error: find(ANGLE_ERROR),
            camera: find("camera"),
            position,
            orientation,
            angles: orientation
                .iter()
                .map(|name| needed(name))
                .collect::<Result<_, _>>()?,
        })
    }

    fn warnings(&self, header: &[String]) -> Vec<String> {
        let unused = header.iter().map(String::as_str);
        let unused: Vec<&str> = unused.filter(|name| !is_known(name)).collect();
        if unused.is_empty() {
            return Vec::new();
        }
        vec![format!("columns that are not used: {}", unused.join(", "))]
    }

    fn line(
        &self,
        table: &Table,
        row: &Row,
        repairs: &mut NumberRepairs,
        odd: &mut OddAngles,
    ) -> Result<PoseLine, Fault> {
        let line = row.line;
        let empty = |name: &str| Fault::at(line, format!("column {name} is empty"), "fill it in");
        let mut number = |column: usize, name: &str| {
            let number = table.number(row, column, repairs)?;
            number.ok_or_else(|| empty(name))
        };
        let [x, y, z] = self.position;
        let center = DVec3::new(number(x, "x")?, number(y, "y")?, number(z, "z")?);
        let angles = self
            .angles
            .iter()
            .zip(self.orientation)
            .map(|(&column, name)| number(column, name))
            .collect::<Result<Vec<f64>, Fault>>()?;
        match self.orientation[0] {
            "qx" => odd.quaternion(line, &angles),
            _ => odd.angles(&angles),
        }
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
        let mut deviation = |column: usize, name: &str| {
            let deviation = table.number(row, column, repairs)?;
            if deviation.is_some_and(|deviation| deviation < 0.0) {
                let what = format!("column {name}: a standard deviation is negative");
                return Err(Fault::at(line, what, "give 0 or more, or leave it empty"));
            }
            Ok(deviation)
        };
        let position = match self.position_errors {
            None => [None; 3],
            Some([x, y, z]) => [
                deviation(x, POSITION_ERRORS[0])?,
                deviation(y, POSITION_ERRORS[1])?,
                deviation(z, POSITION_ERRORS[2])?,
            ],
        };
        let position = match position {
            [Some(x), Some(y), Some(z)] => Some(DVec3::new(x, y, z)),
            [None, None, None] => None,
            _ => {
                let what = "of s_x, s_y, s_z one is there and another is not";
                return Err(Fault::at(line, what, "give all three, or none"));
            }
        };
        let angle = match self.angle_error {
            None => None,
            Some(column) => deviation(column, ANGLE_ERROR)?,
        };
        let errors = PoseErrors {
            position,
            angle: angle.map(DVec3::splat),
        };
        let photo = row.cell(self.photo);
        if photo.is_empty() {
            return Err(empty("photo"));
        }
        let camera = self.camera.map(|column| row.cell(column));
        Ok(PoseLine {
            photo: photo.to_owned(),
            camera: camera.filter(|name| !name.is_empty()).map(str::to_owned),
            pose,
            errors,
            line,
        })
    }
}

fn is_known(name: &str) -> bool {
    ["photo", "camera", "x", "y", "z"]
        .iter()
        .chain(ORIENTATIONS.into_iter().flatten())
        .chain(&POSITION_ERRORS)
        .chain([&ANGLE_ERROR])
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
    fn standard_deviations_are_read() {
        let head = "photo,x,y,z,tilt,pan,s_x,s_y,s_z,s_angle\n";
        let text = format!("{head}a.jpg,1,2,3,90,0,0.01,0.02,0.03,0.5\nb.jpg,1,2,3,90,0,,,,\n");
        let file = read(text.as_bytes()).unwrap();
        assert_eq!(
            file.lines[0].errors,
            PoseErrors {
                position: Some(DVec3::new(0.01, 0.02, 0.03)),
                angle: Some(DVec3::splat(0.5)),
            }
        );
        assert_eq!(file.lines[1].errors, PoseErrors::default());
        assert_eq!(file.warnings, Vec::<String>::new());
        let fault = |cells: &str| {
            let text = format!("{head}a.jpg,1,2,3,90,0,{cells}\n");
            read(text.as_bytes()).unwrap_err().to_string()
        };
        let negative = fault("0.01,-0.02,0.03,0.5");
        assert!(
            negative.contains("column s_y: a standard deviation is negative"),
            "{negative}"
        );
        assert!(fault("0.01,,0.03,0.5").contains("one is there and another is not"));
        let missing = read(b"photo,x,y,z,tilt,pan,s_x\na.jpg,1,2,3,90,0,1\n").unwrap_err();
        assert!(missing.what.contains("no column s_y"), "{missing}");
    }

    #[test]
    fn what_spreadsheets_write() {
        let semicolons =
            "# a\n\"photo\";x;y;z;qx;qy;qz;qw\n\"a;b.jpg\";350123,456;5000000,5;12;1;0;0;0,0\n";
        let tabs =
            "photo\tx\ty\tz\tqx\tqy\tqz\tqw\na;b.jpg\t350123.456\t5000000.5\t12\t1\t0\t0\t0\n";
        let blanks = "photo x y z qx qy qz qw\na;b.jpg 350123.456 5000000.5 12 1 0 0 0\n";
        for (text, repaired) in [(semicolons, 1), (tabs, 0), (blanks, 0)] {
            assert!(is_table(text.as_bytes()), "{text}");
            let file = read(text.as_bytes()).unwrap();
            assert_eq!(file.lines[0].photo, "a;b.jpg");
            let center = DVec3::new(350_123.456, 5_000_000.5, 12.0);
            assert_eq!(file.lines[0].pose.center, center);
            assert_eq!(file.warnings.len(), repaired, "{:?}", file.warnings);
        }
        let said = read(semicolons.as_bytes()).unwrap().warnings.join("");
        assert!(said.contains("decimal commas"), "{said}");
        // 350 or 350 thousand? Nothing in the table tells.
        let unclear = "photo;x;y;z;tilt;pan\na;350,123;1;2;90;0\n";
        let fault = read(unclear.as_bytes()).unwrap_err();
        assert!(fault.what.contains("thousands"), "{fault}");
        assert!(!is_table(b"photo\n") && !is_table(b"x,y,photos\n"));
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
