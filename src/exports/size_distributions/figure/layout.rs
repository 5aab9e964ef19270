//! Where the parts of a figure are. Lengths are units of the figure, which is `WIDTH` wide: a CSS
//! pixel on a screen; x to the right, y down.

use super::{FigureContents, Panel, SizeAxis};

/// Of the whole figure.
pub(super) const WIDTH: f64 = 900.0;
/// The height of letters with their line.
pub(super) const TEXT: f64 = 15.0;
/// The same, of the title.
pub(super) const TITLE: f64 = 18.0;

const LEFT: f64 = 76.0;
const RIGHT: f64 = 28.0;
const PASSING_HEIGHT: f64 = 430.0;
const RESIDUALS_HEIGHT: f64 = 200.0;
const GAP: f64 = 22.0;
const ROW: f64 = 24.0;
const SAMPLE: f64 = 46.0;
/// More entries than these are counted only, so that the figure stays on one page.
const MOST_ENTRIES: usize = 24;
/// Longer names are cut.
const LONGEST_NAME: usize = 90;
/// Who shows an SVG has a font of their own, which may be wider than the one measured here.
const SLACK: f64 = 1.12;

/// The places of everything.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) height: f64,
    /// The middle of the title's line.
    pub(super) title: f64,
    pub(super) passing: PlotArea,
    pub(super) residuals: Option<PlotArea>,
    /// The middle of the line of the size axis's title.
    pub(super) size_title: f64,
    pub(super) legend: Vec<Entry>,
}

/// The rectangle that values are drawn in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotArea {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

/// A line of the legend.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) of: EntryOf,
    pub(super) text: String,
    /// The left end of the sample, in the middle of its line.
    pub(super) at: [f64; 2],
}

/// What an entry of the legend is for, by its index in the panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum EntryOf {
    Series(usize),
    Band(usize),
    /// For those that have no place.
    Others,
}

impl Layout {
    /// `text_width` measures a text of the legend.
    pub(super) fn new(contents: &FigureContents, text_width: impl Fn(&str) -> f64) -> Self {
        let top = if contents.title.is_empty() {
            18.0
        } else {
            52.0
        };
        let frame = |top, height| PlotArea {
            left: LEFT,
            right: WIDTH - RIGHT,
            top,
            bottom: top + height,
        };
        let passing = frame(top, PASSING_HEIGHT);
        let residuals = contents
            .residuals
            .as_ref()
            .map(|_| frame(passing.bottom + GAP, RESIDUALS_HEIGHT));
        let size_title = residuals.as_ref().unwrap_or(&passing).bottom + 2.9 * TEXT;
        let names = entries(&contents.passing);
        let widths: Vec<f64> = names
            .iter()
            .map(|(_, name)| SAMPLE + SLACK * text_width(name) + GAP)
            .collect();
        let rows = legend_rows(&widths);
        let first = size_title + 2.2 * TEXT;
        let mut left = LEFT;
        let mut legend = Vec::new();
        for (names, widths) in names.chunks(rows).zip(widths.chunks(rows)) {
            for (row, (of, text)) in names.iter().enumerate() {
                let at = [left, first + row as f64 * ROW];
                let text = text.clone();
                legend.push(Entry { of: *of, text, at });
            }
            left += widths.iter().copied().fold(0.0, f64::max);
        }
        Self {
            height: first + rows as f64 * ROW,
            title: 26.0,
            passing,
            residuals,
            size_title,
            legend,
        }
    }
}

/// How many entries a column of the legend has, so that it is as low as it can be. They go down the
/// columns: those that belong together stay together.
fn legend_rows(widths: &[f64]) -> usize {
    let all = widths.len().max(1);
    let width_of = |rows: usize| -> f64 {
        let columns = widths.chunks(rows);
        columns
            .map(|column| column.iter().copied().fold(0.0, f64::max))
            .sum()
    };
    (all.div_ceil(3)..all)
        .find(|rows| width_of(*rows) <= WIDTH - LEFT)
        .unwrap_or(all)
}

/// The series before the bands: the order in which they are looked for.
fn entries(panel: &Panel) -> Vec<(EntryOf, String)> {
    let series = panel.series.iter().enumerate();
    let series = series.map(|(index, series)| (EntryOf::Series(index), &series.name));
    let bands = panel.bands.iter().enumerate();
    let bands = bands.map(|(index, band)| (EntryOf::Band(index), &band.name));
    let mut named: Vec<(EntryOf, String)> = series
        .chain(bands)
        .filter(|(_, name)| !name.is_empty())
        .map(|(of, name)| (of, shortened(name)))
        .collect();
    if named.len() > MOST_ENTRIES {
        let others = named.len() - (MOST_ENTRIES - 1);
        named.truncate(MOST_ENTRIES - 1);
        named.push((EntryOf::Others, format!("and {others} more")));
    }
    named
}

fn shortened(name: &str) -> String {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", name.get(..end).unwrap_or_default()),
        None => name.to_owned(),
    }
}

impl Entry {
    /// The middle and the half of the sample's width.
    pub(super) fn sample(&self) -> ([f64; 2], f64) {
        let half = (SAMPLE - 10.0) / 2.0;
        ([self.at[0] + half, self.at[1]], half)
    }

    pub(super) fn text_at(&self) -> [f64; 2] {
        [self.at[0] + SAMPLE, self.at[1]]
    }
}

impl PlotArea {
    /// Where a size is; `None` off the axis.
    pub(super) fn x(&self, sizes: &SizeAxis, size: f64) -> Option<f64> {
        let share = sizes.share(size);
        // Of a size on the frame the logarithm may be a rounding beyond it.
        let inside = (-1e-9..=1.0 + 1e-9).contains(&share);
        inside.then_some(self.left + share * (self.right - self.left))
    }

    /// Where a value is; beyond the range, at its end.
    pub(super) fn y(&self, range: [f64; 2], value: f64) -> f64 {
        let share = ((value - range[0]) / (range[1] - range[0])).clamp(0.0, 1.0);
        self.bottom - share * (self.bottom - self.top)
    }

    /// The finite points, [size, value] to [x, y], of what is on the axis of sizes: where a line leaves
    /// it, up to the frame.
    pub(super) fn line(
        &self,
        sizes: &SizeAxis,
        range: [f64; 2],
        points: &[[f64; 2]],
    ) -> Vec<[f64; 2]> {
        let points = cut_at_ends(sizes, points);
        points
            .into_iter()
            .filter_map(|[size, value]| Some([self.x(sizes, size)?, self.y(range, value)]))
            .collect()
    }

    /// The same for the edge of an area: what is off the axis of sizes is moved to the frame.
    pub(super) fn edge(
        &self,
        sizes: &SizeAxis,
        range: [f64; 2],
        points: &[[f64; 2]],
    ) -> Vec<[f64; 2]> {
        let mut points = cut_at_ends(sizes, points);
        for point in &mut points {
            point[0] = point[0].clamp(sizes.low, sizes.high);
        }
        self.line(sizes, range, &points)
    }
}

/// The finite points, and where the lines between them cross the ends of the axis.
fn cut_at_ends(sizes: &SizeAxis, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut cut: Vec<[f64; 2]> = Vec::with_capacity(points.len() + 2);
    let finite = |point: &&[f64; 2]| point[0] > 0.0 && point.iter().all(|c| c.is_finite());
    for &point in points.iter().filter(finite) {
        if let Some(&before) = cut.last() {
            for end in [sizes.low, sizes.high] {
                if before[0] < end && end < point[0] {
                    let share = (end / before[0]).ln() / (point[0] / before[0]).ln();
                    cut.push([end, before[1] + share * (point[1] - before[1])]);
                }
            }
        }
        cut.push(point);
    }
    cut
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: PlotArea = PlotArea {
        left: 100.0,
        right: 300.0,
        top: 0.0,
        bottom: 100.0,
    };

    fn sizes() -> SizeAxis {
        SizeAxis {
            title: String::new(),
            low: 10.0,
            high: 1000.0,
            ticks: Vec::new(),
        }
    }

    /// From (1, 0) to (100, 100) the line crosses 10 at 50; 100 is the middle of the axis.
    #[test]
    fn a_line_ends_at_the_frame() {
        let near = |a: &[[f64; 2]], b: &[[f64; 2]]| {
            assert_eq!(a.len(), b.len(), "{a:?}");
            for (a, b) in a.iter().zip(b) {
                assert!(
                    (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9,
                    "{a:?} {b:?}"
                );
            }
        };
        let points = [[1.0, 0.0], [f64::NAN, 3.0], [100.0, 100.0], [1e5, 100.0]];
        let range = [0.0, 100.0];
        let line = FRAME.line(&sizes(), range, &points);
        near(&line, &[[100.0, 50.0], [200.0, 0.0], [300.0, 0.0]]);
        let edge = FRAME.edge(&sizes(), range, &points);
        near(
            &edge,
            &[
                [100.0, 100.0],
                [100.0, 50.0],
                [200.0, 0.0],
                [300.0, 0.0],
                [300.0, 0.0],
            ],
        );
        assert!(
            FRAME
                .line(&sizes(), range, &[[1.0, f64::INFINITY], [0.0, 1.0]])
                .is_empty()
        );
    }

    #[test]
    fn the_legend_is_as_low_as_it_can_be() {
        assert_eq!(legend_rows(&[500.0, 500.0, 500.0, 300.0, 300.0, 300.0]), 3);
        assert_eq!(legend_rows(&[500.0, 500.0, 500.0, 500.0]), 4);
        assert_eq!(legend_rows(&[200.0; 6]), 2);
        assert_eq!(legend_rows(&[]), 1);
        assert_eq!(
            shortened(&"ü".repeat(1000)).chars().count(),
            LONGEST_NAME + 1
        );
    }
}
