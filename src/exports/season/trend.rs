//! P50 and P80 over the blasts, with their 95 % intervals.

use super::row::{FoundSize, SeasonReport};
use crate::drawing::{Anchor, Colour, Dash, Marker, Pen, svg};

/// CSS pixels.
const WIDTH: f64 = 760.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 40.0;
const HIGH: f64 = 300.0;
/// Below the axis, for names that read upwards.
const NAMES: f64 = 96.0;
const TEXT: f64 = 12.0;
const INK: Colour = [34; 3];
const GRID: Colour = [205; 3];
/// Names of more blasts than these would run into each other.
const MOST_NAMES: usize = 40;
/// Longer names are cut.
const LONGEST_NAME: usize = 14;

/// The curves: what passes, how it is drawn. Told apart in grey by their markers and dashes.
const CURVES: [(f64, &str, Colour, Marker, Dash); 2] = [
    (80.0, "P80", [190, 80, 20], Marker::Square, Dash::Solid),
    (50.0, "P50", [30, 100, 170], Marker::Circle, Dash::Long),
];

/// As SVG; `None` where no flight has sizes.
pub(super) fn drawing(report: &SeasonReport<'_>) -> Option<String> {
    let rows = &report.rows;
    let ends = rows.iter().flat_map(|row| {
        let sizes = CURVES.map(|(percent, ..)| row.size(percent));
        sizes
            .into_iter()
            .flatten()
            .filter_map(|size| size.high.or(size.size))
    });
    let highest = ends.filter(|end| end.is_finite()).fold(0.0, f64::max);
    if highest <= 0.0 {
        return None;
    }
    let step = round_step(highest);
    let top_value = (highest / step).ceil() * step;
    let place_y = |value: f64| TOP + HIGH * (1.0 - value / top_value);
    let wide = (WIDTH - LEFT - RIGHT) / rows.len().max(1) as f64;
    let place_x = |index: usize| LEFT + (index as f64 + 0.5) * wide;
    let mut pen = Pen::default();
    let count = (top_value / step).round() as usize;
    for number in 0..=count {
        let value = step * number as f64;
        let y = place_y(value);
        pen.line(&[[LEFT, y], [WIDTH - RIGHT, y]], GRID, 0.8, Dash::Solid);
        let label = decimals(value, step);
        pen.text([LEFT - 6.0, y], TEXT, &label, Anchor::Right, INK);
    }
    let title = format!("Size that passes, {}", report.unit.symbol());
    pen.text_upwards([16.0, TOP + HIGH / 2.0], TEXT, &title, INK);
    let every = rows.len().div_ceil(MOST_NAMES).max(1);
    for (index, row) in rows.iter().enumerate().step_by(every) {
        let name = row
            .date
            .map_or_else(|| row.blast.clone(), |date| date.to_string());
        let name = match name.char_indices().nth(LONGEST_NAME) {
            Some((end, _)) => format!("{}…", name.get(..end).unwrap_or_default()),
            None => name,
        };
        let at = [place_x(index), TOP + HIGH + NAMES / 2.0];
        pen.text_upwards(at, TEXT, &name, INK);
    }
    let cap = (wide / 4.0).min(4.0);
    for (number, (percent, name, colour, marker, dash)) in CURVES.into_iter().enumerate() {
        let found = rows.iter().enumerate().map(|(index, row)| {
            let size = row.size(percent);
            (index, size.and_then(|found| Some((found, found.size?))))
        });
        let found: Vec<(usize, Option<(FoundSize, f64)>)> = found.collect();
        // So that their intervals do not lie on each other.
        let aside = (wide / 8.0).min(5.0) * if number == 0 { -1.0 } else { 1.0 };
        // A blast without sizes is a gap.
        for run in found.split(|(_, size)| size.is_none()) {
            let at = |(index, size): &(usize, Option<(FoundSize, f64)>)| {
                size.map(|(_, size)| [place_x(*index) + aside, place_y(size)])
            };
            let points: Vec<[f64; 2]> = run.iter().filter_map(at).collect();
            pen.line(&points, colour, 1.0, dash);
        }
        for (index, size) in &found {
            let Some((found, size)) = size else { continue };
            let x = place_x(*index) + aside;
            if let Some(low) = found.low.map(place_y) {
                // Without an upper end it goes out of the drawing, and has no cap there.
                let high = found.high.map_or(TOP, place_y);
                pen.line(&[[x, low], [x, high]], colour, 1.4, Dash::Solid);
                let caps = [Some(low), found.high.map(place_y)];
                for y in caps.into_iter().flatten() {
                    pen.line(&[[x - cap, y], [x + cap, y]], colour, 1.4, Dash::Solid);
                }
            }
            pen.marker([x, place_y(*size)], marker, 3.6, colour);
        }
        let x = LEFT + 14.0 + 70.0 * number as f64;
        pen.marker([x, 18.0], marker, 4.2, colour);
        pen.text([x + 10.0, 18.0], TEXT + 1.0, name, Anchor::Left, INK);
    }
    let page = [WIDTH, TOP + HIGH + NAMES];
    // Only pictures can fail, and there is none.
    svg::document(
        &pen.shapes,
        page,
        "P50 and P80 of each blast with their 95 % intervals",
    )
    .ok()
}

/// 1, 2 or 5 times a power of ten, so that there are 4 to 10 steps.
fn round_step(highest: f64) -> f64 {
    let power = 10_f64.powf((highest / 4.0).log10().floor());
    let steps = [5.0, 2.0, 1.0].map(|digit| digit * power);
    let fits = steps.into_iter().find(|step| highest / step >= 4.0);
    fits.unwrap_or(power)
}

/// With as many decimals as the step has.
fn decimals(value: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}
