//! PTS and PTX, the texts of Leica Cyclone; the descriptions are Leica's "PTX file format" and
//! "PTS", as quoted by PDAL's `PtxReader` and CloudCompare's `AsciiFilter`.
//!
//! PTS: blocks of a number of points, alone on its line, and as many lines `x y z`,
//! `x y z intensity`, `x y z r g b` or `x y z intensity r g b`, in the world. Some programs leave
//! the number out. Points behind the promised ones are left out, with a warning.
//!
//! PTX: scans, each a grid:
//! - columns and rows, one number a line;
//! - four lines for people, the scanner's position and axes, which the matrix below repeats;
//! - four lines of a 4x4 matrix for row vectors, so that the translation stands in the fourth line:
//!   (x y z 1) · M is the point in the world;
//! - columns x rows lines `x y z intensity [r g b]` in the scanner's own frame, where 0 0 0 is a
//!   direction without a return; those are left out and counted.
//!
//! Intensities are not used.

use std::io::BufRead;

use glam::{DMat4, DVec3, DVec4};

use crate::clouds::cloud_file::CloudFile;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::text::fields::Fields;
use crate::text::text_lines::TextLines;

const REMEDY: &str = "copy or export it again";

/// Reads a PTS file of `size` bytes (for the progress).
///
/// # Errors
/// Where a line is no point, or a block has fewer points than it promises.
pub(crate) fn read_pts(
    input: impl BufRead,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut lines = TextLines::new(input);
    let mut file = CloudFile::default();
    // How many points the block still has, where it says so, and how many follow those.
    let mut rest: Option<u64> = None;
    let mut more = 0_u64;
    loop {
        if lines.line().is_multiple_of(65_536) {
            progress.advance(lines.bytes(), size)?;
        }
        let number = lines.line() + 1;
        let Some(line) = lines.next_line()? else {
            break;
        };
        let mut fields = Fields::new(number, line, REMEDY);
        match fields.rest().split_ascii_whitespace().count() {
            0 => {}
            1 => {
                if let Some(missing @ 1..) = rest {
                    return Err(fields.fault(format!("{missing} points are missing here")));
                }
                rest = Some(fields.whole("the number of points")?);
            }
            columns => {
                let (point, color) = point(&mut fields, columns)?;
                if rest == Some(0) {
                    more += 1;
                    continue;
                }
                rest = rest.map(|rest| rest - 1);
                file.push(point, color);
            }
        }
    }
    if let Some(missing @ 1..) = rest {
        let what = format!("it ends {missing} points before what it promises");
        return Err(lines.fault(what, REMEDY));
    }
    if more > 0 {
        file.warnings.push(format!(
            "{more} points follow those that it promises; they are left out"
        ));
    }
    file.expect_points()?;
    Ok(file)
}

/// The position and the colour on a line of so many columns.
fn point(fields: &mut Fields<'_>, columns: usize) -> Result<(DVec3, Option<[u8; 3]>), Fault> {
    if columns < 3 {
        return Err(fields.fault(format!("a point has {columns} values")));
    }
    let position = fields.triple("a coordinate")?;
    if columns == 4 || columns >= 7 {
        fields.number("the intensity")?;
    }
    let color = (columns >= 6).then(|| fields.color()).transpose()?;
    Ok((position, color))
}

/// Reads a PTX file of `size` bytes (for the progress).
///
/// # Errors
/// Where a header is malformed, a scan is cut off, or no direction has a return.
pub(crate) fn read_ptx(
    input: impl BufRead,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut lines = TextLines::new(input);
    let mut file = CloudFile::default();
    let (mut cells, mut without_return) = (0_u64, 0_u64);
    // Empty lines between scans and at the end are nothing.
    while let Some(first) = next_filled(&mut lines)? {
        let header = Header::read(&first, &mut lines)?;
        for _ in 0..header.cells {
            if lines.line().is_multiple_of(65_536) {
                progress.advance(lines.bytes(), size)?;
            }
            let number = lines.line() + 1;
            let Some(line) = lines.next_line()? else {
                let what = format!("it ends inside a scan of {} points", header.cells);
                return Err(lines.fault(what, REMEDY));
            };
            let mut fields = Fields::new(number, line, REMEDY);
            let columns = fields.rest().split_ascii_whitespace().count();
            let (own, color) = point(&mut fields, columns)?;
            cells += 1;
            if own == DVec3::ZERO {
                without_return += 1;
                continue;
            }
            let point = header.world_from_scan.transform_point3(own);
            if !point.is_finite() {
                return Err(fields.fault("the scan's matrix takes a point to infinity"));
            }
            file.push(point, color);
        }
    }
    file.expect_points()?;
    if without_return > 0 {
        file.warnings.push(format!(
            "{without_return} of {cells} directions have no return; they are left out"
        ));
    }
    Ok(file)
}

/// The next line that is not empty, with its number.
fn next_filled<R: BufRead>(lines: &mut TextLines<R>) -> Result<Option<(u64, String)>, Fault> {
    loop {
        let number = lines.line() + 1;
        match lines.next_line()? {
            None => return Ok(None),
            Some(line) if line.trim().is_empty() => {}
            Some(line) => return Ok(Some((number, line.to_owned()))),
        }
    }
}

/// The ten lines before a scan's points.
struct Header {
    cells: u64,
    world_from_scan: DMat4,
}

impl Header {
    fn read<R: BufRead>(first: &(u64, String), lines: &mut TextLines<R>) -> Result<Self, Fault> {
        let columns: u64 = Fields::new(first.0, &first.1, REMEDY).whole("the number of columns")?;
        let mut next = || {
            next_filled(lines)?.ok_or_else(|| Fault::new("it ends inside a scan's header", REMEDY))
        };
        let (number, text) = next()?;
        let rows: u64 = Fields::new(number, &text, REMEDY).whole("the number of rows")?;
        for name in ["the position", "an axis", "an axis", "an axis"] {
            let (number, text) = next()?;
            Fields::new(number, &text, REMEDY).triple(name)?;
        }
        // Their rows are the columns of a matrix for column vectors.
        let mut axes = [DVec4::ZERO; 4];
        let mut last = 0;
        for axis in &mut axes {
            let (number, text) = next()?;
            let mut fields = Fields::new(number, &text, REMEDY);
            let name = "the matrix";
            *axis = fields.triple(name)?.extend(fields.number(name)?);
            last = number;
        }
        let [x, y, z, translation] = axes;
        let affine = [x.w, y.w, z.w] == [0.0; 3] && translation.w == 1.0;
        if !affine {
            return Err(Fault::at(
                last,
                "the last column of the scan's matrix is not 0 0 0 1",
                "export it with a rotation and a translation",
            ));
        }
        Ok(Self {
            cells: columns.saturating_mul(rows),
            world_from_scan: DMat4::from_cols(x, y, z, translation),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::geometry::Bounds;
    use fragscale_test_data::shared_data;

    fn pts(text: &str) -> Result<CloudFile, Fault> {
        read_pts(text.as_bytes(), text.len() as u64, &Progress::default())
    }

    fn ptx(text: &str) -> Result<CloudFile, Fault> {
        read_ptx(text.as_bytes(), text.len() as u64, &Progress::default())
    }

    #[test]
    fn blocks_of_points() {
        let file = pts("2\n1 2 3 -100 10 20 30\r\n4 5 6 7 40 50 60\n1\n7 8 9 0 1 2 3\n\n").unwrap();
        assert_eq!(file.cloud.points[2], DVec3::new(7.0, 8.0, 9.0));
        assert_eq!(file.cloud.colors, [[10, 20, 30], [40, 50, 60], [1, 2, 3]]);
        for (line, colors) in [("1 2 3", 0), ("1 2 3 0.5", 0), ("1 2 3 4 5 6", 1)] {
            let file = pts(line).unwrap();
            assert_eq!(file.cloud.points, [DVec3::new(1.0, 2.0, 3.0)]);
            assert_eq!(file.cloud.colors.len(), colors, "{line}");
        }
    }

    /// As PDAL reads such files.
    #[test]
    fn points_behind_the_promised_ones_are_left_out() {
        let file = pts("1\n1 2 3\n4 5 6\n7 8 9\n").unwrap();
        assert_eq!(file.cloud.points, [DVec3::new(1.0, 2.0, 3.0)]);
        assert!(file.warnings.concat().starts_with("2 points follow"));
    }

    #[test]
    fn pts_that_do_not_keep_their_promise() {
        for (text, line) in [
            ("3\n1 2 3\n", 3),
            ("1\n1 2 3\n4 5\n", 3),
            ("2\n1 2 3\n1\n4 5 6\n", 3),
            ("1\n1 2\n", 2),
            ("1\n1 2 x\n", 2),
            ("1\n1 2 3 4 256 0 0\n", 2),
            ("-1\n1 2 3\n", 1),
        ] {
            assert_eq!(pts(text).unwrap_err().line, Some(line), "{text}");
        }
        assert!(pts("").is_err());
        assert!(pts("0\n").is_err());
    }

    /// A quarter turn about z (x becomes y) and a translation, as PTX writes it.
    const TURNED: &str = "2\n1\n500000 5000000 100\n0 1 0\n-1 0 0\n0 0 1\n\
                          0 1 0 0\n-1 0 0 0\n0 0 1 0\n500000 5000000 100 1\n";
    const PLAIN: &str = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

    #[test]
    fn scans_are_brought_to_the_world() {
        let text = format!("{TURNED}1 2 3 0.25 9 8 7\n0 0 0 0.5 0 0 0\n{PLAIN}4 5 6 0.5 1 2 3\n");
        let file = ptx(&text).unwrap();
        assert_eq!(
            file.cloud.points,
            [
                DVec3::new(499_998.0, 5_000_001.0, 103.0),
                DVec3::new(4.0, 5.0, 6.0)
            ]
        );
        assert_eq!(file.cloud.colors, [[9, 8, 7], [1, 2, 3]]);
        assert_eq!(
            file.warnings,
            ["1 of 3 directions have no return; they are left out"]
        );
    }

    #[test]
    fn ptx_that_is_cut_or_bent_is_refused() {
        let whole = format!("{TURNED}1 2 3 0.25\n4 5 6 0.5\n");
        let cuts: Vec<usize> = whole.match_indices('\n').map(|(at, _)| at + 1).collect();
        for &end in &cuts[..cuts.len() - 1] {
            assert!(ptx(&whole[..end]).is_err(), "cut at {end}");
        }
        assert!(ptx(&whole.replace("100 1\n", "100 2\n")).is_err());
        assert!(ptx(&whole.replace("2\n1\n", "4000000000\n4000000000\n")).is_err());
        assert!(ptx(&whole.replace("1 2 3 0.25", "nan 2 3 0.25")).is_err());
        assert!(ptx("").is_err());
    }

    #[test]
    fn real_files() {
        let Some(folder) = shared_data("pointclouds-pdal") else {
            return;
        };
        let file = pts(&fs::read_to_string(folder.join("pts/test.pts")).unwrap()).unwrap();
        assert_eq!(file.cloud.points.len(), 19);
        assert_eq!(file.cloud.colors[0], [97, 59, 38]);
        // The same points as 1.2-with-color.las, of which the README says that it has 1065.
        let text = fs::read_to_string(folder.join("ptx/1.2-with-color.ptx")).unwrap();
        let file = ptx(&text).unwrap();
        assert_eq!(file.cloud.points.len(), 1065);
        assert_eq!(file.cloud.colors[0], [68, 77, 88]);
        let bounds = Bounds::of(&file.cloud.points).unwrap();
        assert!((bounds.max.z - 586.38).abs() < 0.005, "{bounds:?}");
    }
}
