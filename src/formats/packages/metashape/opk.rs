//! Metashape's "Omega Phi Kappa" text, from its File > Export > Export Cameras:
//!
//! ```text
//! # Cameras (108)
//! # PhotoID, X, Y, Z, Omega, Phi, Kappa, r11, r12, r13, r21, r22, r23, r31, r32, r33
//! DJI_0002.JPG <tab> -64.71 <tab> 18.38 <tab> 66.2 ...
//! ```
//!
//! - Tabs separate the fields; names may hold spaces. Old versions leave r11 ... r33 out.
//! - X Y Z is the camera centre in the coordinate system of the export, which the file does not
//!   name. Where every X is within 180 and every Y within 90, and the photos lie within 0.2 units but
//!   not around the origin, it can only be longitude and latitude: no flight is that small in
//!   metres. Other numbers are taken as the world's, and so is a photo alone.
//! - Omega, phi, kappa are the contract's (degrees). r is the inverse of that rotation, row by row:
//!   in `shared/data/metashape-xml-potree` they agree to 1e-15. They are compared, because a
//!   program that has another order of angles would write another r.
//! - There are no intrinsics: a flight.toml names a camera.

use std::collections::HashMap;

use glam::{DMat3, DVec2, DVec3};

use crate::camera::{HALF_TURN_ABOUT_X, Pose};
use crate::fault::Fault;
use crate::geometry::Bounds;
use crate::poses::poses_csv::{PoseLine, PosesFile};
use crate::scale::PoseErrors;
use crate::text::fields::{Fields, shown};
use crate::text::separated::{Separator, unquoted};

const EXPORT: &str = "export it from Metashape again (Export Cameras, Omega Phi Kappa)";

/// How far r may be from the rotation of the angles.
const SAME_ROTATION: f64 = 1e-5;

/// How far, in degrees, the photos of a flight may lie apart: 20 km.
const ONE_FLIGHT: f64 = 0.2;

/// Whether a text begins as this one does: with comments that name its columns.
pub(crate) fn is_opk(start: &str) -> bool {
    let lines = start.trim_start_matches('\u{feff}').lines();
    lines
        .map(|line| line.trim().trim_matches('"'))
        .take_while(|line| line.is_empty() || line.starts_with('#'))
        .any(|line| {
            let line: String = line.to_ascii_lowercase().split_whitespace().collect();
            line.starts_with("#photoid,x,y,z,omega,phi,kappa")
        })
}

/// Reads the poses of the photos.
///
/// # Errors
/// With the line: a field that is missing or no number, angles and rotation that disagree, a photo
/// that is named twice, no photo at all.
pub(crate) fn read(text: &str) -> Result<PosesFile, Fault> {
    let mut file = PosesFile::default();
    let mut stated: Option<usize> = None;
    let mut seen: HashMap<String, u64> = HashMap::new();
    for (number, line) in (1..).zip(text.lines()) {
        if let Some(comment) = line.trim().trim_matches('"').strip_prefix('#') {
            let count = comment.trim().strip_prefix("Cameras (");
            stated = stated.or(count.and_then(|rest| rest.split(')').next()?.parse().ok()));
            continue;
        }
        if line.trim().is_empty() {
            continue;
        }
        let pose = read_line(number, line.trim_end())?;
        if let Some(first) = seen.insert(pose.photo.clone(), number) {
            let what = format!("'{}' stands on line {first} already", pose.photo);
            return Err(Fault::at(number, what, "keep one line a photo"));
        }
        file.lines.push(pose);
    }
    if file.lines.is_empty() {
        return Err(Fault::new("it has no photos", EXPORT));
    }
    if let Some(stated) = stated
        && stated != file.lines.len()
    {
        let found = file.lines.len();
        let warning = format!("its first line states {stated} cameras, it has {found}");
        file.warnings.push(warning);
    }
    if are_degrees(&file.lines) {
        file.crs = Some("EPSG:4326".to_owned());
        file.warnings.push(
            "its X and Y can only be degrees: they are taken as longitude and latitude on WGS 84"
                .to_owned(),
        );
    }
    Ok(file)
}

fn read_line(number: u64, line: &str) -> Result<PoseLine, Fault> {
    let (photo, rest) = split_name(line).ok_or_else(|| {
        let what = "a line is a photo's name and 6 or 15 numbers, this one is shorter";
        Fault::at(number, what, EXPORT)
    })?;
    let rest = rest.replace(',', " ");
    let mut fields = Fields::new(number, &rest, EXPORT);
    let center = fields.triple("X, Y, Z")?;
    let [omega, phi, kappa] = fields.triple("omega, phi, kappa")?.to_array();
    let pose = Pose::from_omega_phi_kappa(center, [omega, phi, kappa]);
    if !fields.rest().is_empty() {
        let mut r = [0.0; 9];
        for part in &mut r {
            *part = fields.number("a number of r11 to r33")?;
        }
        if !fields.rest().is_empty() {
            let rest = shown(fields.rest());
            return Err(fields.fault(format!("'{rest}' where the line should end")));
        }
        let to_camera = DMat3::from_cols_array(&r).transpose();
        let off = (pose.rotation * HALF_TURN_ABOUT_X).transpose() - to_camera;
        let off = off
            .to_cols_array()
            .into_iter()
            .fold(0.0, |worst: f64, d| worst.max(d.abs()));
        if off > SAME_ROTATION {
            return Err(fields.fault(format!(
                "the angles and r11 to r33 of '{}' differ by {off:.1e}: they are not Metashape's",
                shown(&photo)
            )));
        }
    }
    Ok(PoseLine {
        photo,
        camera: None,
        pose,
        errors: PoseErrors::default(),
        line: number,
    })
}

/// The name and what is behind it: up to the first tab, or comma, or as many numbers from the end as
/// there are.
fn split_name(line: &str) -> Option<(String, &str)> {
    let by = |sign: char| {
        let (name, rest) = Separator::Sign(sign).first(line);
        Some((name, rest.strip_prefix(sign)?))
    };
    let found = by('\t').or_else(|| by(',')).or_else(|| {
        let numbers = line.split_whitespace().rev();
        let count = numbers
            .take_while(|word| word.parse::<f64>().is_ok())
            .count();
        let count = if count >= 15 { 15 } else { 6 };
        let mut name = line;
        for _ in 0..count {
            name = name.rsplit_once(char::is_whitespace)?.0.trim_end();
        }
        Some((unquoted(name), line.get(name.len()..)?))
    });
    found.filter(|(name, rest)| !name.is_empty() && !rest.trim().is_empty())
}

/// Whether the centres can only be longitude and latitude.
fn are_degrees(lines: &[PoseLine]) -> bool {
    let centers: Vec<DVec3> = lines.iter().map(|line| line.pose.center).collect();
    let Some(bounds) = Bounds::of(&centers).filter(|_| lines.len() > 1) else {
        return false;
    };
    let (low, high) = (bounds.min.truncate(), bounds.max.truncate());
    let farthest = low.abs().max(high.abs());
    let around_origin = low.cmple(DVec2::ZERO).all() && high.cmpge(DVec2::ZERO).all();
    farthest.cmple(DVec2::new(180.0, 90.0)).all()
        && (high - low).max_element() <= ONE_FLIGHT
        && !around_origin
}

#[cfg(test)]
mod tests {
    use super::*;
    use fragscale_test_data::shared_data;

    const HEAD: &str = "#Cameras (2)\r\n#PhotoID, X, Y, Z, Omega, Phi, Kappa\r\n";

    #[test]
    fn an_old_file_without_rotations() {
        let text = format!(
            "{HEAD}my photo 1.JPG\t500000.25\t5000000.5\t120\t0\t0\t0\r\nb.JPG\t1\t2\t3\t30\t0\t0\r\n"
        );
        assert!(is_opk(&text));
        let file = read(&text).unwrap();
        assert_eq!(file.lines[0].photo, "my photo 1.JPG");
        assert_eq!(
            file.lines[0].pose.center,
            DVec3::new(500_000.25, 5_000_000.5, 120.0)
        );
        assert!((file.lines[0].pose.rotation.z_axis - DVec3::NEG_Z).length() < 1e-15);
        assert_eq!((file.lines[1].line, file.crs), (4, None));
        assert!(file.warnings.is_empty());
    }

    #[test]
    fn other_separators() {
        let line = |line: &str| read_line(1, line).unwrap();
        for text in [
            "\"a b.JPG\",1,2,3,0,0,0",
            "a b.JPG 1 2 3 0 0 0",
            "a b.JPG\t1 \t 2\t3\t0\t0\t0",
        ] {
            assert_eq!(line(text).photo, "a b.JPG", "{text}");
            assert_eq!(line(text).pose.center, DVec3::new(1.0, 2.0, 3.0));
        }
        assert_eq!(line("7 8 9 10 1 2 3 0 0 0").photo, "7 8 9 10");
    }

    #[test]
    fn degrees_are_told_from_metres() {
        let crs = |a: &str, b: &str| {
            let line = |name, at: &str| format!("{name}\t{at}\t50\t0\t0\t0\n");
            read(&format!("{HEAD}{}{}", line("a", a), line("b", b)))
                .unwrap()
                .crs
        };
        assert_eq!(
            crs("-64.71\t18.38", "-64.72\t18.39").as_deref(),
            Some("EPSG:4326")
        );
        assert_eq!(crs("4.5\t3.5", "6.5\t3.5"), None);
        assert_eq!(crs("-0.1\t-0.1", "0.1\t0.1"), None);
        assert_eq!(crs("500000.1\t4000000", "500000.2\t4000000"), None);
        assert_eq!(crs("120.1\t95", "120.2\t95"), None);
    }

    #[test]
    fn mistakes_have_their_line() {
        let fault = |line: &str| read(&format!("{HEAD}{line}\n")).unwrap_err();
        for (line, what) in [
            ("a\t1\t2\t3\t0\t0", "the line ends where"),
            ("a\t1\t2\tnan\t0\t0\t0", "'nan', not finite"),
            ("a\t1\t2\t3\t0\t0\t0\t1\t0", "the line ends where"),
            ("a", "shorter"),
            ("\t1\t2\t3\t0\t0\t0", "shorter"),
            (
                "a\t1\t2\t3\t0\t0\t90\t1\t0\t0\t0\t1\t0\t0\t0\t1",
                "not Metashape's",
            ),
            (
                "a\t1\t2\t3\t0\t0\t0\t1\t0\t0\t0\t1\t0\t0\t0\t1\t9",
                "should end",
            ),
        ] {
            let fault = fault(line);
            assert!(fault.what.contains(what), "{line}: {fault}");
            assert_eq!(fault.line, Some(3));
        }
        let twice = fault("a\t1\t2\t3\t0\t0\t0\na\t1\t2\t3\t0\t0\t0");
        assert!(twice.line == Some(4) && twice.what.contains("line 3"));
        assert!(fault("").what.contains("no photos"));
        let few = read(&format!("{HEAD}a\t1\t2\t3\t0\t0\t0\n")).unwrap();
        assert!(few.warnings[0].contains("states 2 cameras, it has 1"));
        assert!(!is_opk("# PhotoID\n") && !is_opk("a\t# PhotoID, X, Y, Z, Omega, Phi, Kappa"));
    }

    /// Angles and rotations of the real file agree line by line, or reading would fail.
    #[test]
    fn the_steele_flight() {
        let Some(path) = shared_data("metashape-xml-potree/steele_opk.txt") else {
            return;
        };
        let text = crate::read_text(&path).unwrap();
        assert!(is_opk(&text));
        let file = read(&text).unwrap();
        assert_eq!(
            (file.lines.len(), file.crs.as_deref()),
            (108, Some("EPSG:4326"))
        );
        // A flight with a slanted camera: no photo looks up, and x points level in all.
        for line in &file.lines {
            let axes = line.pose.rotation;
            assert!(
                axes.z_axis.z < 0.05 && axes.x_axis.z.abs() < 0.1,
                "{}",
                line.photo
            );
        }
    }
}
