//! Wavefront OBJ: "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
//!
//! - `v x y z [w] [r g b]`: a vertex; three or more numbers after z that are six in all are colours
//!   from 0 to 1 (an extension of MeshLab and others; values over 1 are taken as 0 to 255).
//! - `f a b c ...`: a polygon of vertex numbers counted from 1, or from the end with negative ones;
//!   `a/t/n` names texture and normal as well, which are passed over. Polygons become fans.
//! - A backslash at the end of a line continues it. Everything else is passed over.

use std::io::BufRead;

use glam::DVec3;

use crate::clouds::cloud_file::CloudFile;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::text::text_lines::TextLines;

/// Reads an OBJ file of `size` bytes (for the progress).
///
/// # Errors
/// Where a vertex or a face is malformed, or there is no vertex.
pub(crate) fn read(
    input: impl BufRead,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut lines = TextLines::new(input);
    let mut file = CloudFile::default();
    let mut raw_colors: Vec<[f64; 3]> = Vec::new();
    let mut corners = Vec::new();
    let mut statement = String::new();
    loop {
        if lines.line().is_multiple_of(65_536) {
            progress.advance(lines.bytes(), size)?;
        }
        statement.clear();
        if !next_statement(&mut lines, &mut statement)? {
            break;
        }
        let mut words = statement.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let vertex =
                    vertex(words).map_err(|what| lines.fault(what, "export the file again"))?;
                if let Some(color) = vertex.color {
                    raw_colors.push(color);
                }
                file.cloud.points.push(vertex.position);
            }
            Some("f") => {
                corners.clear();
                for word in words {
                    let corner = corner(word, file.cloud.points.len());
                    corners
                        .push(corner.map_err(|what| lines.fault(what, "export the file again"))?);
                }
                if corners.len() < 3 {
                    let what = format!("a face has {} corners", corners.len());
                    return Err(lines.fault(what, "export the file again"));
                }
                file.cloud.add_polygon(&corners);
            }
            _ => {}
        }
    }
    if file.cloud.points.is_empty() {
        return Err(Fault::new(
            "it has no vertex (no line beginning with 'v')",
            "export points",
        ));
    }
    if raw_colors.len() == file.cloud.points.len() {
        let to_255 = if raw_colors.iter().flatten().any(|&c| c > 1.0) {
            1.0
        } else {
            255.0
        };
        // `as` saturates.
        let color = |c: &[f64; 3]| c.map(|channel| (channel * to_255).round() as u8);
        file.cloud.colors = raw_colors.iter().map(color).collect();
    }
    Ok(file)
}

/// Appends the next line with its continuations; false at the end.
fn next_statement<R: BufRead>(
    lines: &mut TextLines<R>,
    statement: &mut String,
) -> Result<bool, Fault> {
    let mut any = false;
    while let Some(line) = lines.next_line()? {
        any = true;
        match line.strip_suffix('\\') {
            // No face has as many corners as 16 MB hold.
            Some(_) if statement.len() > 1 << 24 => {
                return Err(lines.fault("a statement is continued without end", "check the file"));
            }
            Some(part) => {
                statement.push_str(part);
                statement.push(' ');
            }
            None => {
                statement.push_str(line);
                break;
            }
        }
    }
    Ok(any)
}

struct Vertex {
    position: DVec3,
    color: Option<[f64; 3]>,
}

fn vertex<'a>(words: impl Iterator<Item = &'a str>) -> Result<Vertex, String> {
    let mut numbers = [0.0; 7];
    let mut count = 0;
    for (place, word) in numbers.iter_mut().zip(words) {
        *place = word
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite())
            .ok_or_else(|| format!("a vertex has '{word}', not a finite number"))?;
        count += 1;
    }
    let [x, y, z, a, b, c, d] = numbers;
    if count < 3 {
        return Err(format!("a vertex has {count} coordinates"));
    }
    Ok(Vertex {
        position: DVec3::new(x, y, z),
        color: match count {
            6 => Some([a, b, c]),
            // x y z w r g b
            7 => Some([b, c, d]),
            _ => None,
        },
    })
}

fn corner(word: &str, count: usize) -> Result<u32, String> {
    let number = word.split('/').next().unwrap_or_default();
    let index = match number.parse::<i64>() {
        Ok(n) if n > 0 => u32::try_from(n - 1).ok(),
        Ok(n) if n < 0 => i64::try_from(count)
            .ok()
            .and_then(|c| u32::try_from(c + n).ok()),
        _ => None,
    };
    index
        .filter(|&i| (i as usize) < count)
        .ok_or_else(|| format!("a face names vertex '{number}', but {count} stand before it"))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read_text(text: &str) -> Result<CloudFile, Fault> {
        read(text.as_bytes(), text.len() as u64, &Progress::default())
    }

    const SAMPLE: &str = "# by hand\nmtllib x.mtl\nv 500000.123456 5000000.25 1 0 0.5 1\n\
        v 1 0 0 1 1 1\nvn 0 0 1\nv 1 1 0 0 0 0\nv 0 1 0 0 0 0\nf 1/1/1 2//1 3/2 \\\n4\nf -4 -3 -1\n";

    #[test]
    fn vertices_colours_and_polygons() {
        let file = read_text(SAMPLE).unwrap();
        assert_eq!(
            file.cloud.points[0],
            DVec3::new(500_000.123_456, 5_000_000.25, 1.0)
        );
        assert_eq!(file.cloud.colors[0], [0, 128, 255]);
        assert_eq!(file.cloud.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 3]]);
        assert_eq!(read_text(&SAMPLE.replace('\n', "\r\n")), Ok(file));
    }

    #[test]
    fn colours_up_to_255_are_taken_as_they_are() {
        let file = read_text("v 0 0 0 255 0 17\nv 1 0 0 1 2 3\n").unwrap();
        assert_eq!(file.cloud.colors, [[255, 0, 17], [1, 2, 3]]);
    }

    #[test]
    fn mistakes_are_placed() {
        let fault = |text: &str| read_text(text).unwrap_err();
        assert_eq!(fault("v 0 0 0\nv 1 x 0\n").line, Some(2));
        assert_eq!(fault("v 0 0 0\nv 1 nan 0\n").line, Some(2));
        assert_eq!(fault("v 0 0\n").line, Some(1));
        assert_eq!(fault("v 0 0 0\nf 1 1 2\n").line, Some(2));
        assert_eq!(fault("v 0 0 0\nf 1 1 0\n").line, Some(2));
        assert_eq!(fault("v 0 0 0\nf 1 1 -2\n").line, Some(2));
        assert_eq!(fault("v 0 0 0\nf 1 1\n").line, Some(2));
        assert_eq!(fault("v 0 0 0\nf 99999999999999999999 1 1\n").line, Some(2));
        assert!(fault("# nothing\n").what.contains("no vertex"));
        assert!(fault("").what.contains("no vertex"));
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "([vf] [0-9 ./-]{0,20}[\\\\]?\n|\\PC{0,10}\n){0,20}") {
            let _ = read_text(&text);
        }
    }
}
