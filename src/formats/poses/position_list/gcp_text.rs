//! Writing control points as a `gcp_list.txt`, which OpenDroneMap reads; see `gcp_list` for what it cannot hold.

use std::fmt::Write as _;

use glam::DVec2;

use super::gcp_list::{CORNER, NO_CRS, OWN};
use crate::control::{ControlList, ControlPoint};
use crate::files::FLIGHT_MARK;

/// The text of a list. `name_of` says how a photo is called in it.
pub fn control_list_text(list: &ControlList, name_of: impl Fn(&str) -> String) -> String {
    let mut text = String::new();
    text += list.crs.as_deref().unwrap_or(NO_CRS).trim();
    text.push('\n');
    text += FLIGHT_MARK;
    for point in &list.points {
        // Writing to a String cannot fail.
        let _ = write_point(&mut text, point, &name_of);
    }
    for bar in list.bars.iter().filter(|bar| bar.is_known()) {
        let [from, to] = &bar.ends;
        let (length, unit) = (bar.length, bar.unit);
        let _ = writeln!(text, "{OWN}bar\t{from}\t{to}\t{length}\t{unit}");
    }
    text
}

fn write_point(
    text: &mut String,
    point: &ControlPoint,
    name_of: &impl Fn(&str) -> String,
) -> std::fmt::Result {
    let name = &point.name;
    let Some(position) = point.position else {
        writeln!(text, "{OWN}point\t{name}")?;
        for (photo, pixel) in &point.marks {
            let DVec2 { x, y } = *pixel - CORNER;
            writeln!(text, "{OWN}mark\t{x}\t{y}\t{}\t{name}", name_of(photo))?;
        }
        return Ok(());
    };
    let [x, y, z] = position.to_array();
    if point.marks.is_empty() {
        return writeln!(text, "{name}\t{x}\t{y}\t{z}");
    }
    for (photo, pixel) in &point.marks {
        let (u, v) = (pixel.x - CORNER, pixel.y - CORNER);
        writeln!(text, "{x}\t{y}\t{z}\t{u}\t{v}\t{}\t{name}", name_of(photo))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::ScaleBar;
    use crate::poses::position_list::control_points_from_text;
    use crate::units::LengthUnit;
    use glam::DVec3;

    /// What is written is read again to the bit: points with and without a survey and marks, names with
    /// blanks, scale bars; and what OpenDroneMap takes of it are the surveyed marks alone.
    #[test]
    fn what_is_written_reads_back() {
        let marks = |x: f64| {
            vec![
                ("IMG 1.JPG".to_owned(), DVec2::new(x, 0.25)),
                ("frame_2".to_owned(), DVec2::new(1024.31, x / 3.0)),
            ]
        };
        let point = |name: &str, position, marks| ControlPoint {
            name: name.to_owned(),
            position,
            marks,
        };
        for crs in [Some("EPSG:32632".to_owned()), None] {
            let list = ControlList {
                crs,
                points: vec![
                    point(
                        "P 1",
                        Some(DVec3::new(435_205.125, 6_201_303.1, 411.0)),
                        marks(7.77),
                    ),
                    point("staff top", None, marks(100.0 / 3.0)),
                    point(
                        "2",
                        Some(DVec3::new(435_206.0, 6_201_304.0, 410.0)),
                        Vec::new(),
                    ),
                    point("staff foot", None, Vec::new()),
                ],
                bars: vec![ScaleBar {
                    ends: ["staff top".to_owned(), "staff foot".to_owned()],
                    length: 16.4,
                    unit: LengthUnit::Foot,
                }],
            };
            let text = control_list_text(&list, str::to_owned);
            let read = control_points_from_text(&text).unwrap();
            assert_eq!(read.list, list, "{text}");
            assert!(read.warnings.is_empty());
            // opendm/gcp.py: lines behind the first that are not empty and begin with no #, six parts and more.
            let theirs = text.lines().skip(1).filter(|line| {
                !line.is_empty() && !line.starts_with('#') && line.split_whitespace().count() >= 6
            });
            assert_eq!(theirs.count(), 2, "{text}");
        }
    }

    #[test]
    fn a_line_of_ours_that_is_spoilt_is_refused() {
        for line in [
            "bar\ta\tb\t0\tm",
            "bar\ta\tb\t2\tell",
            "mark\t1\tx\ta.jpg\tp",
            "flag\ta",
        ] {
            let text = format!("local\n# x\n{OWN}{line}\n");
            let fault = control_points_from_text(&text).unwrap_err();
            assert_eq!(fault.line, Some(3), "{fault}");
        }
    }
}
