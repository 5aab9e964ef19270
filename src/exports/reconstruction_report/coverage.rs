//! In how many photos the points of the pile were found, as a map.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::ReconstructionReport;
use crate::drawing::{Anchor, Colour, Dash, Pen, svg};
use crate::geometry::Bounds;
use crate::plan::{Grid, MapFrame};
use crate::surface::bulk_of;

/// CSS pixels.
const WIDTH: f64 = 720.0;
const MOST_HIGH: f64 = 640.0;
const MARGIN: f64 = 24.0;
const LEGEND: f64 = 34.0;
const LABEL: f64 = 11.5;
/// Cells along the map's longer side.
const CELLS: f64 = 64.0;
const INK: Colour = [34; 3];
const GRID: Colour = [190; 3];

/// From so many photos on, the colour: lightness falls, so that grey prints tell them apart.
const CLASSES: [(f64, &str, Colour); 5] = [
    (0.0, "under 3", [253, 208, 120]),
    (3.0, "3 to 5", [161, 218, 180]),
    (5.0, "5 to 8", [65, 182, 196]),
    (8.0, "8 to 12", [44, 127, 184]),
    (12.0, "12 and more", [37, 52, 148]),
];

/// As SVG; `None` without points.
pub(super) fn map(report: &ReconstructionReport<'_>) -> Option<String> {
    let points: Vec<DVec3> = report.points.iter().map(|seen| seen.point).collect();
    let cameras = report.photos.iter().map(|photo| photo.center);
    let pile = bulk_of(&points)?;
    let all = cameras.clone().fold(pile, |all, at| {
        let at = at.extend(pile.min.z);
        Bounds {
            min: all.min.min(at),
            max: all.max.max(at),
        }
    });
    let (min, max) = (all.min.truncate(), all.max.truncate());
    let size = (max - min).max(DVec2::splat(1e-9));
    let room = [WIDTH - 2.0 * MARGIN, MOST_HIGH - 2.0 * MARGIN - LEGEND];
    // A tenth is left around.
    let scale = (room[0] / size.x).min(room[1] / size.y) / 1.1;
    let high = (size.y * scale * 1.1).max(60.0);
    let frame = MapFrame::around((min + max) / 2.0, [MARGIN; 2], [room[0], high], scale);
    let cell = size.max_element() / CELLS;
    let mut pen = Pen::default();
    for ((column, row), mean) in cells(report, min, cell) {
        let corner = min + DVec2::new(f64::from(column), f64::from(row)) * cell;
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let outline = corners.map(|way| frame.place(corner + way * cell));
        if outline.iter().all(|at| is_inside(*at, &frame)) {
            pen.area(&outline, colour(mean), 1.0);
        }
    }
    let grid = Grid::of(&frame);
    let ([left, top], [wide, _]) = (frame.at, frame.size);
    let (right, bottom) = (left + wide, top + high);
    for line in &grid.across {
        let [x, _] = frame.place(DVec2::new(line.at, 0.0));
        pen.line(&[[x, top], [x, bottom]], GRID, 0.7, Dash::Solid);
        let at = [x, bottom + 4.0 + LABEL / 2.0];
        pen.text(at, LABEL, &line.label, Anchor::Middle, INK);
    }
    for line in &grid.up {
        let [_, y] = frame.place(DVec2::new(0.0, line.at));
        pen.line(&[[left, y], [right, y]], GRID, 0.7, Dash::Solid);
        pen.text_upwards([left - 4.0 - LABEL / 2.0, y], LABEL, &line.label, INK);
    }
    for at in cameras.map(|center| frame.place(center)) {
        let [x, y] = at;
        for (half, colour) in [(6.2, [255; 3]), (5.0, INK)] {
            let outline = [[0.0, 1.2], [-1.15, -0.8], [1.15, -0.8]];
            let outline = outline.map(|[right, down]| [x + right * half, y + down * half]);
            pen.area(&outline, colour, 1.0);
        }
    }
    let mut x = left;
    let y = bottom + LABEL + 22.0;
    for (_, words, colour) in CLASSES {
        pen.area(
            &[
                [x, y - 6.0],
                [x + 18.0, y - 6.0],
                [x + 18.0, y + 6.0],
                [x, y + 6.0],
            ],
            colour,
            1.0,
        );
        pen.text([x + 23.0, y], LABEL + 1.0, words, Anchor::Left, INK);
        x += 118.0;
    }
    let page = [WIDTH, bottom + LABEL + LEGEND];
    // Only pictures can fail, and there is none.
    svg::document(
        &pen.shapes,
        page,
        "Photos in which the points of each part of the pile were found",
    )
    .ok()
}

fn is_inside([x, y]: [f64; 2], frame: &MapFrame) -> bool {
    let ([left, top], [wide, high]) = (frame.at, frame.size);
    (left..=left + wide).contains(&x) && (top..=top + high).contains(&y)
}

/// The mean number of photos in which the points of each cell were found, by column and row from the south-west.
fn cells(report: &ReconstructionReport<'_>, min: DVec2, cell: f64) -> BTreeMap<(i32, i32), f64> {
    let mut sums: BTreeMap<(i32, i32), (usize, usize)> = BTreeMap::new();
    for seen in &report.points {
        let place = ((seen.point.truncate() - min) / cell).floor();
        if place.abs().max_element() < 1e6 {
            let (points, photos) = sums.entry((place.x as i32, place.y as i32)).or_default();
            *points += 1;
            *photos += seen.photos;
        }
    }
    let mean = |(points, photos): (usize, usize)| photos as f64 / points as f64;
    sums.into_iter()
        .map(|(place, sum)| (place, mean(sum)))
        .collect()
}

fn colour(mean: f64) -> Colour {
    let class = CLASSES.iter().rev().find(|(from, ..)| mean >= *from);
    class.map_or(CLASSES[0].2, |(.., colour)| *colour)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_begin_where_they_say() {
        assert_eq!(colour(2.9), CLASSES[0].2);
        assert_eq!(colour(3.0), CLASSES[1].2);
        assert_eq!(colour(40.0), CLASSES[4].2);
    }
}
