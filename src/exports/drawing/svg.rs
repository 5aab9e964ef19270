//! Shapes as the elements of an SVG 1.1 document: `polyline`, `polygon`, `text` and `image`.

use std::fmt::Write;

use super::base64::base64;
use super::png::picture_bytes;
use super::shapes::{Anchor, Colour, Shape};
use crate::fault::Fault;
use crate::files::SVG_MARK;
use crate::markup::escaped;

/// Heights of a line to an em.
const LINE: f64 = 1.24;

/// Half the height of capitals in the fonts that viewers take for "sans-serif", in ems.
const HALF_CAPITAL: f64 = 0.36;

/// A document of this size, a CSS pixel a unit; `title` is for those who hear pages.
///
/// # Errors
/// Only where a picture cannot be encoded.
pub(crate) fn document(
    shapes: &[Shape],
    [width, height]: [f64; 2],
    title: &str,
) -> Result<String, Fault> {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"sans-serif\" \
         stroke-linejoin=\"round\">\n{SVG_MARK}<title>{}</title>\n",
        escaped(title)
    );
    svg += &format!("<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n");
    for shape in shapes {
        match shape {
            Shape::Picture { at, size, pixels } => {
                // `href` without a prefix is of SVG 2; with it, of 1.1, all programs know it.
                svg += &format!(
                    "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" \
                     preserveAspectRatio=\"none\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
                     xlink:href=\"data:image/png;base64,{}\"/>\n",
                    short(at[0]),
                    short(at[1]),
                    short(size[0]),
                    short(size[1]),
                    base64(&picture_bytes(pixels)?)
                );
            }
            // Writing to a string does not fail.
            _ => drop(element(&mut svg, shape)),
        }
    }
    Ok(svg + "</svg>\n")
}

fn element(svg: &mut String, shape: &Shape) -> std::fmt::Result {
    match shape {
        Shape::Line {
            points,
            colour,
            width,
            dash,
        } => {
            write!(
                svg,
                "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"",
                hex(*colour),
                short(*width)
            )?;
            let dashes = dash.pattern().iter().map(|length| short(length * width));
            let dashes: Vec<String> = dashes.collect();
            if !dashes.is_empty() {
                write!(svg, " stroke-dasharray=\"{}\"", dashes.join(" "))?;
            }
            writeln!(svg, " points=\"{}\"/>", list(points))
        }
        Shape::Area {
            outline,
            colour,
            opacity,
        } => {
            write!(svg, "<polygon fill=\"{}\"", hex(*colour))?;
            if *opacity < 1.0 {
                write!(svg, " fill-opacity=\"{opacity}\"")?;
            }
            writeln!(svg, " points=\"{}\"/>", list(outline))
        }
        Shape::Text {
            at: [x, y],
            size,
            text,
            anchor,
            upwards,
            colour,
        } => {
            let em = size / LINE;
            let anchor = match anchor {
                Anchor::Left => "start",
                Anchor::Middle => "middle",
                Anchor::Right => "end",
            };
            write!(
                svg,
                "<text x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\" font-size=\"{}\" fill=\"{}\"",
                short(*x),
                short(y + HALF_CAPITAL * em),
                short(em),
                hex(*colour)
            )?;
            if *upwards {
                write!(
                    svg,
                    " transform=\"rotate(-90 {} {})\"",
                    short(*x),
                    short(*y)
                )?;
            }
            writeln!(svg, ">{}</text>", escaped(text))
        }
        // Written by who knows what to do where it fails.
        Shape::Picture { .. } => Ok(()),
    }
}

fn list(points: &[[f64; 2]]) -> String {
    let points = points
        .iter()
        .map(|[x, y]| format!("{},{}", short(*x), short(*y)));
    points.collect::<Vec<_>>().join(" ")
}

/// To a hundredth of a unit.
fn short(length: f64) -> String {
    // + 0.0: no minus zero.
    ((length * 100.0).round() / 100.0 + 0.0).to_string()
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02X}{green:02X}{blue:02X}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Dash;

    /// SVG 1.1, sections 9.6, 9.7, 10.4 and 11.4.
    #[test]
    fn every_shape_is_its_element() {
        let points = vec![[0.0, 1.0], [2.345_6, -0.001]];
        let shapes = [
            Shape::Line {
                points: points.clone(),
                colour: [0, 128, 255],
                width: 2.0,
                dash: Dash::Short,
            },
            Shape::Area {
                outline: points,
                colour: [1, 2, 3],
                opacity: 0.5,
            },
            Shape::Text {
                at: [10.0, 20.0],
                size: 12.4,
                text: "a < b".to_owned(),
                anchor: Anchor::Middle,
                upwards: true,
                colour: [0; 3],
            },
        ];
        let svg = document(&shapes, [30.0, 40.0], "A & B").unwrap();
        for line in [
            "<title>A &amp; B</title>",
            "<polyline fill=\"none\" stroke=\"#0080FF\" stroke-width=\"2\" stroke-dasharray=\"5 5\" \
             points=\"0,1 2.35,0\"/>",
            "<polygon fill=\"#010203\" fill-opacity=\"0.5\" points=\"0,1 2.35,0\"/>",
            "<text x=\"10\" y=\"23.6\" text-anchor=\"middle\" font-size=\"10\" fill=\"#000000\" \
             transform=\"rotate(-90 10 20)\">a &lt; b</text>",
        ] {
            assert!(svg.contains(line), "{line} is not in {svg}");
        }
    }
}
