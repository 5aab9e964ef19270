//! "CVAT for images 1.1" (docs.cvat.ai, "XML annotation format"), of many photos in one file.
//!
//! - `polygon`, `box`, `ellipse` and `mask` are read, boxes and ellipses with their rotation; other shapes outline nothing
//!   and are left out. Shapes of one group and label are one fragment.
//! - The runs of a mask go row by row through its box, pixels outside first.
//! - `z_order` does not count: as everywhere, the smaller lies on top.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::DVec2;
use roxmltree::Node;

use super::KNOWN;
use super::outline::{Mask, Meaning, OutlinedImage, Piece, Runs};
use crate::fault::Fault;
use crate::text::fields::shown;
use crate::text::xml_document::{Writer, child, children, line_of, parse_of};

/// The runs of a large mask are one attribute.
const CVAT: Writer = Writer {
    name: None,
    if_damaged: "the file is cut off or damaged: export it again",
    if_foreign: "check that it is the right file",
    longest_tag: 64 << 20,
    most_attributes: 200,
    has_namespaces: true,
    most_nodes: u32::MAX,
};

/// The images of a text. `is_own`: the number of a group is that of its fragment.
///
/// # Errors
/// With the line: what is no such XML, and numbers that are none.
pub(super) fn read(text: &str, is_own: bool) -> Result<Vec<OutlinedImage>, Fault> {
    let document = parse_of(text, &CVAT)?;
    let root = document.root_element();
    if !root.has_tag_name("annotations") {
        let what = format!(
            "XML that begins with <{}> is not CVAT's",
            shown(root.tag_name().name())
        );
        return Err(Fault::new(what, KNOWN));
    }
    if child(root, "image").is_none() && child(root, "track").is_some() {
        let what = "it is CVAT for video";
        return Err(Fault::new(what, "export it as \"CVAT for images 1.1\""));
    }
    children(root, "image")
        .map(|node| image(node, is_own))
        .collect()
}

fn image(node: Node<'_, '_>, is_own: bool) -> Result<OutlinedImage, Fault> {
    let size = |name: &str| node.attribute(name).and_then(|text| text.parse().ok());
    let mut image = OutlinedImage {
        name: node.attribute("name").map(str::to_owned),
        size: size("width").zip(size("height")),
        ..OutlinedImage::default()
    };
    let mut groups: HashMap<(&str, &str), usize> = HashMap::new();
    for shape in node.children().filter(Node::is_element) {
        let kind = shape.tag_name().name();
        let line = line_of(shape);
        let place = format!("line {line}");
        let piece = match kind {
            "polygon" => Piece::ring(corners(shape, line)?),
            "box" => {
                let corner = |x: &str, y: &str| {
                    Ok(DVec2::new(number(shape, x, line)?, number(shape, y, line)?))
                };
                Piece::rectangle(
                    corner("xtl", "ytl")?,
                    corner("xbr", "ybr")?,
                    rotation(shape),
                )
            }
            "ellipse" => {
                let pair = |x: &str, y: &str| {
                    Ok(DVec2::new(number(shape, x, line)?, number(shape, y, line)?))
                };
                Piece::ellipse(pair("cx", "cy")?, pair("rx", "ry")?, rotation(shape))
            }
            "mask" => match runs(shape) {
                Some(runs) => Piece::Runs(runs),
                None => {
                    image
                        .notes
                        .at("an outline whose runs are damaged is left out", place);
                    continue;
                }
            },
            "tag" => continue,
            kind => {
                image.notes.at(
                    format!("a {} outlines nothing and is left out", shown(kind)),
                    place,
                );
                continue;
            }
        };
        let label = shape.attribute("label").unwrap_or_default();
        let group = shape.attribute("group_id").filter(|group| *group != "0");
        let mask = Mask {
            meaning: Meaning::of_class(label),
            class: label.to_owned(),
            number: group
                .filter(|_| is_own)
                .and_then(|group| group.parse().ok()),
            place,
            pieces: vec![piece],
        };
        match group.map(|group| groups.entry((label, group))) {
            Some(Entry::Occupied(known)) => image.masks[*known.get()].pieces.extend(mask.pieces),
            Some(Entry::Vacant(new)) => {
                new.insert(image.masks.len());
                image.masks.push(mask);
            }
            None => image.masks.push(mask),
        }
    }
    Ok(image)
}

fn number(shape: Node<'_, '_>, name: &str, line: u64) -> Result<f64, Fault> {
    let text = shape.attribute(name).unwrap_or_default();
    let number = text
        .trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| {
        let what = format!("{name}='{}' is no number", shown(text));
        Fault::at(line, what, "export it again")
    })
}

fn rotation(shape: Node<'_, '_>) -> f64 {
    let degrees = shape
        .attribute("rotation")
        .and_then(|text| text.parse().ok());
    degrees
        .filter(|degrees: &f64| degrees.is_finite())
        .unwrap_or(0.0)
}

/// `x,y;x,y`.
fn corners(shape: Node<'_, '_>, line: u64) -> Result<Vec<DVec2>, Fault> {
    let points = shape.attribute("points").unwrap_or_default();
    let pairs = points.split(';').filter(|pair| !pair.trim().is_empty());
    pairs
        .map(|pair| {
            let number = |text: &str| {
                text.trim()
                    .parse()
                    .ok()
                    .filter(|number: &f64| number.is_finite())
            };
            let corner = pair
                .split_once(',')
                .and_then(|(x, y)| Some(DVec2::new(number(x)?, number(y)?)));
            corner.ok_or_else(|| {
                let what = format!("'{}' is no corner of a polygon", shown(pair));
                Fault::at(line, what, "export it again")
            })
        })
        .collect()
}

/// The runs of a mask; `None` where they are not those of its box.
fn runs(shape: Node<'_, '_>) -> Option<Runs> {
    let whole = |name: &str| shape.attribute(name)?.trim().parse::<i64>().ok();
    let side = |name: &str| u32::try_from(whole(name)?).ok();
    let counts = shape.attribute("rle")?.split(',');
    let counts: Option<Vec<u32>> = counts.map(|count| count.trim().parse().ok()).collect();
    let runs = Runs {
        left: whole("left")?,
        top: whole("top")?,
        width: side("width")?,
        height: side("height")?,
        by_columns: false,
        counts: counts?,
    };
    runs.are_whole().then_some(runs)
}
