//! The fitted scale: the line from top to bottom that lies best through the scale of all pixels
//! (contract, section 7). Split-Desktop draws such a line, between two numbers that it is told.

use super::field::ScaleField;

/// The least share of the grid that a line may rest on.
pub const LEAST_COVERED: f64 = 0.5;

/// The best line through a scale field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedScale {
    /// At the image's top edge, pixels per world unit.
    pub top: f64,
    /// At its bottom edge, pixels per world unit.
    pub bottom: f64,
    /// How far the line is from the field, line / field - 1: root mean square, percent.
    pub rms_percent: f64,
    /// The same, the worst, percent.
    pub worst_percent: f64,
    /// The share of the grid's points that have a scale.
    pub covered: f64,
    /// How much the scale grows from the left edge to the right one, percent of its mean, by the best
    /// plane.
    pub left_right_percent: f64,
}

/// A point of the grid: its place across and down the image, 0 to 1, and its scale.
#[derive(Debug, Clone, Copy)]
struct Sample {
    across: f64,
    down: f64,
    scale: f64,
}

impl FittedScale {
    /// The best line through a field; `None` where less than half of it is covered, fewer than two
    /// of its rows have points, or the line falls to 0 within the image: that is no scale.
    pub fn of(field: &ScaleField) -> Option<Self> {
        let grid = field.grid;
        let middle = |place: u32, count: u32| (f64::from(place) + 0.5) / f64::from(count);
        let mut samples = Vec::with_capacity(grid.len());
        let mut rows_with_points = 0;
        for row in 0..grid.rows {
            let before = samples.len();
            samples.extend((0..grid.columns).filter_map(|column| {
                Some(Sample {
                    across: middle(column, grid.columns),
                    down: middle(row, grid.rows),
                    scale: field.scale_at(column, row)?,
                })
            }));
            rows_with_points += u32::from(samples.len() > before);
        }
        let covered = samples.len() as f64 / grid.len() as f64;
        if covered < LEAST_COVERED || rows_with_points < 2 {
            return None;
        }
        Some(Self::through(&samples, covered)).filter(|line| line.top.min(line.bottom) > 0.0)
    }

    /// By least squares around the means, where products lose nothing.
    fn through(samples: &[Sample], covered: f64) -> Self {
        let count = samples.len() as f64;
        let mean = |of: fn(&Sample) -> f64| samples.iter().map(of).sum::<f64>() / count;
        let (across, down, scale) = (mean(|s| s.across), mean(|s| s.down), mean(|s| s.scale));
        let (mut uu, mut uv, mut vv, mut us, mut vs) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for sample in samples {
            let (u, v) = (sample.across - across, sample.down - down);
            let s = sample.scale - scale;
            uu += u * u;
            uv += u * v;
            vv += v * v;
            us += u * s;
            vs += v * s;
        }
        let change = vs / vv;
        let top = scale - change * down;
        let line = |down: f64| top + change * down;
        let off = |sample: &Sample| (line(sample.down) / sample.scale - 1.0) * 100.0;
        let squares: f64 = samples.iter().map(|s| off(s).powi(2)).sum();
        let worst = samples.iter().map(|s| off(s).abs()).fold(0.0, f64::max);
        // Of the plane; more than half of 64 columns is covered, so it is determined.
        let sideways = (us * vv - vs * uv) / (uu * vv - uv * uv);
        Self {
            top,
            bottom: top + change,
            rms_percent: (squares / count).sqrt(),
            worst_percent: worst,
            covered,
            left_right_percent: sideways / scale * 100.0,
        }
    }

    /// The same with its scales times `factor`.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            top: self.top * factor,
            bottom: self.bottom * factor,
            ..self
        }
    }
}
