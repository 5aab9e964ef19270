//! The contents of a figure as shapes: on paper and in pixels the same ones.

use super::layout::{Entry, EntryOf, Layout, PlotArea, TEXT, TITLE};
use super::{Band, Dash, FigureContents, Marker, Panel, Series, SizeAxis};
use crate::drawing::{Anchor, Colour, Pen, Shape};

const INK: Colour = [34, 34, 34];
const LEVEL: Colour = [110, 110, 110];
const DECADE: Colour = [196, 196, 196];
const GRID: Colour = [226, 226, 226];

/// Half the width of a marker.
const MARKER: f64 = 4.6;
const CURVE: f64 = 2.0;
const THIN: f64 = 1.0;
/// Bands lie over each other, those with outlines below: they need less.
const SHADE: f64 = 0.2;
const OUTLINED_SHADE: f64 = 0.08;

/// Everything, from the back to the front.
pub(super) fn drawn(contents: &FigureContents, layout: &Layout) -> Vec<Shape> {
    let pen = &mut Pen::default();
    let frame = layout.passing;
    let middle = (frame.left + frame.right) / 2.0;
    if !contents.title.is_empty() {
        pen.text(
            [middle, layout.title],
            TITLE,
            &contents.title,
            Anchor::Middle,
            INK,
        );
    }
    let sizes = &contents.sizes;
    draw_panel(&contents.passing, sizes, &frame, pen);
    let mut lowest = &frame;
    if let (Some(residuals), Some(frame)) = (&contents.residuals, &layout.residuals) {
        draw_panel(residuals, sizes, frame, pen);
        lowest = frame;
    }
    for tick in &sizes.ticks {
        if let Some(x) = lowest.x(sizes, tick.size) {
            let at = [x, lowest.bottom + 0.95 * TEXT];
            pen.text(at, TEXT, &tick.label, Anchor::Middle, INK);
        }
    }
    pen.text(
        [middle, layout.size_title],
        TEXT,
        &sizes.title,
        Anchor::Middle,
        INK,
    );
    for entry in &layout.legend {
        draw_entry(&contents.passing, entry, pen);
    }
    std::mem::take(&mut pen.shapes)
}

fn draw_panel(panel: &Panel, sizes: &SizeAxis, frame: &PlotArea, pen: &mut Pen) {
    draw_grid(panel, sizes, frame, pen);
    for band in &panel.bands {
        let edges = [&band.edges[0], &band.edges[1]].map(|e| frame.edge(sizes, panel.range, e));
        let outline: Vec<[f64; 2]> = edges[0]
            .iter()
            .chain(edges[1].iter().rev())
            .copied()
            .collect();
        pen.area(&outline, band.style.colour, shade(band));
    }
    // The outlines over all the shades.
    for band in panel.bands.iter().filter(|band| band.outlined) {
        for edge in &band.edges {
            let edge = frame.line(sizes, panel.range, edge);
            pen.line(&edge, band.style.colour, 1.2, Dash::Short);
        }
    }
    for level in &panel.levels {
        let y = frame.y(panel.range, *level);
        pen.line(
            &[[frame.left, y], [frame.right, y]],
            LEVEL,
            1.2,
            Dash::Short,
        );
    }
    for series in &panel.series {
        for mark in frame.line(sizes, panel.range, &series.marks) {
            let drop = [mark, [mark[0], frame.bottom]];
            pen.line(&drop, series.style.colour, THIN, Dash::Short);
        }
    }
    let middle = (frame.left + frame.right) / 2.0;
    // From the middle of a side: all four corners are joints.
    let border = [
        [middle, frame.top],
        [frame.right, frame.top],
        [frame.right, frame.bottom],
        [frame.left, frame.bottom],
        [frame.left, frame.top],
        [middle, frame.top],
    ];
    pen.line(&border, INK, 1.25, Dash::Solid);
    for series in &panel.series {
        let line = frame.line(sizes, panel.range, &series.line);
        pen.line(&line, series.style.colour, CURVE, series.style.dash);
    }
    for series in &panel.series {
        draw_points(series, panel.range, sizes, frame, pen);
    }
}

fn draw_grid(panel: &Panel, sizes: &SizeAxis, frame: &PlotArea, pen: &mut Pen) {
    for tick in &panel.ticks {
        let y = frame.y(panel.range, *tick);
        pen.line(
            &[[frame.left, y], [frame.right, y]],
            GRID,
            THIN,
            Dash::Solid,
        );
        let at = [frame.left - 0.5 * TEXT, y];
        pen.text(at, TEXT, &signed(*tick, panel.range), Anchor::Right, INK);
    }
    for tick in &sizes.ticks {
        let Some(x) = frame.x(sizes, tick.size) else {
            continue;
        };
        let colour = if tick.decade { DECADE } else { GRID };
        pen.line(
            &[[x, frame.top], [x, frame.bottom]],
            colour,
            THIN,
            Dash::Solid,
        );
    }
    let middle = [1.4 * TEXT, (frame.top + frame.bottom) / 2.0];
    pen.text_upwards(middle, TEXT, &panel.axis_title, INK);
}

/// The points of a series. A value beyond the range is an arrow at its end, with the value.
fn draw_points(
    series: &Series,
    range: [f64; 2],
    sizes: &SizeAxis,
    frame: &PlotArea,
    pen: &mut Pen,
) {
    let colour = series.style.colour;
    for &[size, value] in series.points.iter().filter(|point| point[1].is_finite()) {
        let Some(x) = frame.x(sizes, size) else {
            continue;
        };
        let y = frame.y(range, value);
        let (arrow, inwards) = match value {
            v if v > range[1] => (Marker::Triangle, 1.0),
            v if v < range[0] => (Marker::TriangleDown, -1.0),
            _ => {
                pen.marker([x, y], series.style.marker, MARKER, colour);
                continue;
            }
        };
        pen.marker([x, y + inwards * 1.6 * MARKER], arrow, MARKER, colour);
        let at = [x, y + inwards * (3.2 * MARKER + 0.4 * TEXT)];
        pen.text(
            at,
            0.85 * TEXT,
            &signed(value.round(), range),
            Anchor::Middle,
            colour,
        );
    }
}

fn draw_entry(panel: &Panel, entry: &Entry, pen: &mut Pen) {
    let ([x, y], half) = entry.sample();
    match entry.of {
        EntryOf::Series(index) => {
            if let Some(series) = panel.series.get(index) {
                let style = series.style;
                if !series.line.is_empty() {
                    pen.line(
                        &[[x - half, y], [x + half, y]],
                        style.colour,
                        CURVE,
                        style.dash,
                    );
                }
                if !series.points.is_empty() {
                    pen.marker([x, y], style.marker, MARKER, style.colour);
                }
            }
        }
        EntryOf::Band(index) => {
            if let Some(band) = panel.bands.get(index) {
                draw_swatch(band, [x - half, y - 7.0], [x + half, y + 7.0], pen);
            }
        }
        EntryOf::Others => {}
    }
    pen.text(entry.text_at(), TEXT, &entry.text, Anchor::Left, INK);
}

fn draw_swatch(band: &Band, [left, top]: [f64; 2], [right, bottom]: [f64; 2], pen: &mut Pen) {
    let colour = band.style.colour;
    let outline = [[left, top], [right, top], [right, bottom], [left, bottom]];
    pen.area(&outline, colour, shade(band));
    if band.outlined {
        pen.line(&[[left, top], [right, top]], colour, 1.2, Dash::Short);
        pen.line(&[[left, bottom], [right, bottom]], colour, 1.2, Dash::Short);
    }
}

fn shade(band: &Band) -> f64 {
    match band.outlined {
        true => OUTLINED_SHADE,
        false => SHADE,
    }
}

/// A value at an axis; with its sign where the axis has both, the minus as long as the plus.
fn signed(value: f64, range: [f64; 2]) -> String {
    match value {
        v if v < 0.0 => format!("\u{2212}{}", -v),
        v if v > 0.0 && range[0] < 0.0 => format!("+{v}"),
        v => v.abs().to_string(),
    }
}
