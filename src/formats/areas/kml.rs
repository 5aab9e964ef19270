//! KML 2.2 (OGC 07-147r2): every `Polygon`, wherever it stands; its `coordinates` are tuples of longitude, latitude and
//! perhaps height, with white space between tuples and none in them.

use roxmltree::Node;

use super::ring::ring;
use super::{MapAreas, no_polygon};
use crate::fault::Fault;
use crate::geodesy::Geographic;
use crate::text::fields::shown;
use crate::text::xml_document::{child, children, line_of, parse, text};

const EXPORT: &str = "save it again as KML";

/// The polygons of a text.
///
/// # Errors
/// As [`super::read_areas`].
pub(super) fn read(xml: &str) -> Result<MapAreas, Fault> {
    let document = parse(xml)?;
    let root = document.root_element();
    if !root.has_tag_name("kml") {
        let what = format!(
            "XML that begins with <{}> is no KML",
            shown(root.tag_name().name())
        );
        return Err(Fault::new(what, super::KNOWN));
    }
    let named = |name: &'static str| {
        root.descendants()
            .filter(move |node| node.has_tag_name(name))
    };
    let polygons: Vec<Node<'_, '_>> = named("Polygon").collect();
    // A ring may also stand for itself.
    let is_free = |ring: &Node<'_, '_>| !ring.ancestors().any(|node| node.has_tag_name("Polygon"));
    let rings = named("LinearRing").filter(is_free);
    let (points, lines) = (
        named("Point").count(),
        named("LineString").count() + rings.count(),
    );
    if polygons.is_empty() {
        return Err(no_polygon(points, lines));
    }
    let mut found = MapAreas {
        polygons: Vec::new(),
        holes: Vec::new(),
        first_hole: None,
        points,
        lines,
    };
    for (node, number) in polygons.into_iter().zip(1..) {
        polygon(node, number, &mut found)?;
    }
    Ok(found)
}

fn polygon(node: Node<'_, '_>, number: usize, found: &mut MapAreas) -> Result<(), Fault> {
    // As its owner called it.
    let placemark = node.ancestors().find(|node| node.has_tag_name("Placemark"));
    let name = placemark
        .and_then(|placemark| child(placemark, "name"))
        .map(text);
    let at = match name.filter(|name| !name.is_empty()) {
        Some(name) => format!("polygon {number} ('{}')", shown(name)),
        None => format!("polygon {number}"),
    };
    let line = line_of(node);
    let outer = child(node, "outerBoundaryIs").and_then(|outer| child(outer, "LinearRing"));
    found.polygons.push(corners(outer, &at, line)?);
    let mut number = 0;
    for inner in children(node, "innerBoundaryIs") {
        let what = format!("{at} has a hole");
        let remedy = "draw it without, or as two polygons";
        let fault = || Fault::at(line, what, remedy);
        found.first_hole.get_or_insert_with(fault);
        // Of one without coordinates there is nothing to draw.
        if !inner
            .descendants()
            .any(|node| node.has_tag_name("coordinates"))
        {
            continue;
        }
        // The schema has one ring a boundary, and a boundary a hole; some writers put all holes into one.
        let mut rings = children(inner, "LinearRing").peekable();
        if rings.peek().is_none() {
            let at = format!("{at}, hole {}", number + 1);
            return Err(no_coordinates(&at, line));
        }
        for ring in rings {
            number += 1;
            let at = format!("{at}, hole {number}");
            found.holes.push(corners(Some(ring), &at, line)?);
        }
    }
    Ok(())
}

fn no_coordinates(at: &str, line: u64) -> Fault {
    Fault::at(line, format!("{at} has no coordinates"), EXPORT)
}

/// The corners of a ring; `line` is that of its polygon.
fn corners(outline: Option<Node<'_, '_>>, at: &str, line: u64) -> Result<Vec<Geographic>, Fault> {
    let coordinates = outline.and_then(|ring| child(ring, "coordinates"));
    let coordinates = coordinates.ok_or_else(|| no_coordinates(at, line))?;
    let mut positions = Vec::new();
    for (tuple, number) in text(coordinates).split_whitespace().zip(1..) {
        let mut numbers = tuple.split(',').map(|word| word.parse::<f64>().ok());
        let mut next = || numbers.next().flatten().filter(|number| number.is_finite());
        let (Some(longitude), Some(latitude)) = (next(), next()) else {
            let what = format!(
                "{at}, corner {number}: '{}' is no longitude,latitude",
                shown(tuple)
            );
            let remedy = "write both with a comma and no space between them";
            return Err(Fault::at(line_of(coordinates), what, remedy));
        };
        positions.push([longitude, latitude]);
    }
    ring(&positions, at, Some(line_of(coordinates)))
}
