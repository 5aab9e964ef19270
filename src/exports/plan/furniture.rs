//! What stands in and around a map that is printed: grid lines, coordinates, north, scale bar, a round scale.
//!
//! Lengths are CSS pixels, 96 to an inch; x to the right, y down.

use glam::DVec2;

use super::{Grid, MapFrame, Plan, PlanBar, PlanInks};
use crate::drawing::{Anchor, Dash, Pen};
use crate::numbers::round_down;
use crate::units::LengthUnit;

pub(crate) const A_MILLIMETRE: f64 = 96.0 / 25.4;
/// Height of a line of words beside the map.
pub(crate) const TEXT: f64 = 13.5;
/// The same of coordinates at the grid.
pub(crate) const LABEL: f64 = 11.5;

/// The grid lies under everything else.
const GRID_WIDTH: f64 = 0.7;

/// The largest round scale at which no more than `fit` units of the drawing are a unit of the world: its units of
/// the drawing to a unit of the world, and the n of 1 : n. `None` where nothing fits.
pub(crate) fn round_scale(fit: f64, unit: LengthUnit) -> Option<(f64, f64)> {
    // Units of the drawing to a unit of the world, 1 : 1.
    let life = unit.metres() * 1000.0 * A_MILLIMETRE;
    let denominator = round_above(life / fit)?;
    Some((life / denominator, denominator))
}

/// 1, 1.25, 1.5, 2, 2.5, 3, 4, 5 or 7.5 times a power of ten, the least that is no less.
fn round_above(number: f64) -> Option<f64> {
    let below = round_down(number)?;
    let power = 10_f64.powf(below.log10().floor());
    let all = [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5, 10.0];
    let all = all.map(|digits| digits * power);
    let found = all
        .into_iter()
        .find(|round| *round >= number * (1.0 - 1e-12))?;
    // What its text says is rounded once.
    format!("{found:.6e}").parse().ok()
}

fn edges(frame: &MapFrame) -> [f64; 4] {
    let ([left, top], [width, height]) = (frame.at, frame.size);
    [left, top, left + width, top + height]
}

pub(crate) fn grid_lines(frame: &MapFrame, grid: &Grid, inks: &PlanInks, pen: &mut Pen) {
    let [left, top, right, bottom] = edges(frame);
    for line in &grid.across {
        let [x, _] = frame.place(DVec2::new(line.at, 0.0));
        pen.line(&[[x, top], [x, bottom]], inks.grid, GRID_WIDTH, Dash::Solid);
    }
    for line in &grid.up {
        let [_, y] = frame.place(DVec2::new(0.0, line.at));
        pen.line(&[[left, y], [right, y]], inks.grid, GRID_WIDTH, Dash::Solid);
    }
}

/// The frame's edge with the grid's coordinates at it.
pub(crate) fn border(frame: &MapFrame, grid: &Grid, inks: &PlanInks, pen: &mut Pen) {
    let [left, top, right, bottom] = edges(frame);
    let middle = (left + right) / 2.0;
    // From the middle of a side: all four corners are joints.
    let around = [
        [middle, top],
        [right, top],
        [right, bottom],
        [left, bottom],
        [left, top],
        [middle, top],
    ];
    pen.line(&around, inks.ink, 1.2, Dash::Solid);
    for line in &grid.across {
        let [x, _] = frame.place(DVec2::new(line.at, 0.0));
        pen.line(
            &[[x, bottom], [x, bottom + 5.0]],
            inks.ink,
            1.0,
            Dash::Solid,
        );
        let at = [x, bottom + 7.0 + LABEL / 2.0];
        pen.text(at, LABEL, &line.label, Anchor::Middle, inks.ink);
    }
    for line in &grid.up {
        let [_, y] = frame.place(DVec2::new(0.0, line.at));
        pen.line(&[[left - 5.0, y], [left, y]], inks.ink, 1.0, Dash::Solid);
        let at = [left - 7.0 - LABEL / 2.0, y];
        pen.text_upwards(at, LABEL, &line.label, inks.ink);
    }
}

/// A bar from a place to the right, with its length below it.
pub(crate) fn scale_bar(bar: &PlanBar, [x, y]: [f64; 2], inks: &PlanInks, pen: &mut Pen) {
    let long = bar.long;
    // Four parts, every other one filled.
    for part in 0..4_u32 {
        let (from, to) = (f64::from(part) / 4.0, f64::from(part + 1) / 4.0);
        let (from, to) = (x + from * long, x + to * long);
        let outline = [[from, y], [to, y], [to, y + 6.0], [from, y + 6.0]];
        let colour = if part % 2 == 0 { inks.ink } else { inks.paper };
        pen.area(&outline, colour, 1.0);
    }
    let around = [
        [x, y],
        [x + long, y],
        [x + long, y + 6.0],
        [x, y + 6.0],
        [x, y],
    ];
    pen.line(&around, inks.ink, 1.0, Dash::Solid);
    pen.text(
        [x, y + 8.0 + TEXT / 2.0],
        TEXT,
        &bar.words(),
        Anchor::Left,
        inks.ink,
    );
}

/// An arrow to the grid's north; in a frame of its own, along y.
pub(crate) fn north(plan: &Plan, [left, top]: [f64; 2], inks: &PlanInks, pen: &mut Pen) {
    let (letter, words) = match plan.is_on_map() {
        true => ("N", "grid north"),
        false => ("y", "y of the flight's frame"),
    };
    let x = left + 13.0;
    pen.text([x, top + 8.0], TEXT + 3.0, letter, Anchor::Middle, inks.ink);
    let (tip, foot) = (top + 19.0, top + 58.0);
    pen.area(&[[x, tip], [x + 8.0, foot], [x, foot - 8.0]], inks.ink, 1.0);
    let around = [
        [x, tip],
        [x + 8.0, foot],
        [x, foot - 8.0],
        [x - 8.0, foot],
        [x, tip],
    ];
    pen.line(&around, inks.ink, 1.0, Dash::Solid);
    pen.text(
        [left + 34.0, foot - 14.0],
        TEXT,
        words,
        Anchor::Left,
        inks.ink,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round_and_show_everything() {
        for (number, round) in [
            (183.0, 200.0),
            (200.0, 200.0),
            (201.0, 250.0),
            (251.0, 300.0),
            (700.0, 750.0),
            (1.2, 1.25),
            (0.09, 0.1),
            (9999.0, 10_000.0),
        ] {
            assert_eq!(round_above(number), Some(round), "{number}");
        }
        assert_eq!(round_above(f64::NAN), None);
    }
}
