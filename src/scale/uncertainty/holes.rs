//! What a photo's holes leave open in its line.
//!
//! Where the surface ends inside a photo the line rests on the part that shows it, and the rest of the
//! photo has rock too: beyond the cloud's rim the line goes on by chance. What lies there is taken to be
//! like what is seen: pieces of how far the seen part lies off its line, moved by random shifts, are laid
//! over the whole photo (a moving-block bootstrap, Kuensch 1989: neighbours stay neighbours), and the line
//! through its seen part is compared with the line through all of it. Relief that is larger than what is
//! seen cannot be known from it. Over random waves of a quarter to half of the photo (tests below) lines
//! were off by 0.95 to 1.0 of what is stated where a side was missing, by up to 1.4 with a corner missing
//! and by 1.8 where only one end was seen, which a line follows: there the interval is too narrow. With
//! waves of one length, a quarter, it was 0.8 (too wide) for a side. Nothing is tuned to mend that.

use super::draws::Draws;
use crate::scale::FittedScale;
use crate::scale::field::{FieldGrid, ScaleField};

/// How many times holes are filled: their spread is then known to a twelfth.
const FILLINGS: usize = 80;

/// How many pieces there are across a photo.
const ACROSS: usize = 3;

/// How many shifts are tried for a place, where a shift leads from a hole to a hole.
const SHIFTS: usize = 8;

/// From where the shifts follow.
const SEED: u64 = 7;

/// The standard deviations that the holes of a field leave in the top and the bottom of its line, shares
/// of them; 0 where it has none.
pub(super) fn of_holes(field: &ScaleField, fitted: &FittedScale) -> [f64; 2] {
    let FieldGrid { columns, rows } = field.grid;
    let places = field.grid.cells();
    let off = places.map(|(column, row)| match field.scale_at(column, row) {
        Some(scale) => {
            let down = (f64::from(row) + 0.5) / f64::from(rows);
            Place::Off(scale - (fitted.top + (fitted.bottom - fitted.top) * down))
        }
        // What the lens does not show is no hole.
        None => match field.direction_at(column, row) {
            Some(_) => Place::Hole,
            None => Place::NoPhoto,
        },
    });
    let off: Vec<Place> = off.collect();
    let [top, bottom] = spread(&off, columns as usize, rows as usize);
    [top / fitted.top.abs(), bottom / fitted.bottom.abs()]
}

/// What is known of a place of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// How far its scale lies off the line.
    Off(f64),
    Hole,
    NoPhoto,
}

/// Least squares of lines t·(1 - v) + b·v.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Line {
    tt: f64,
    tb: f64,
    bb: f64,
    t: f64,
    b: f64,
}

impl Line {
    pub(super) fn add(&mut self, down: f64, off: f64) {
        let up = 1.0 - down;
        self.tt += up * up;
        self.tb += up * down;
        self.bb += down * down;
        self.t += up * off;
        self.b += down * off;
    }

    /// Its ends; not finite where fewer than two rows have points.
    pub(super) fn ends(self) -> [f64; 2] {
        let determinant = self.tt * self.bb - self.tb * self.tb;
        [
            (self.t * self.bb - self.b * self.tb) / determinant,
            (self.b * self.tt - self.t * self.tb) / determinant,
        ]
    }

    /// What one more in what is off at a place would do to its ends; not finite where they are not.
    pub(super) fn weights(self, down: f64) -> [f64; 2] {
        let one = Self {
            t: 1.0 - down,
            b: down,
            ..self
        };
        one.ends()
    }
}

/// The standard deviations of the ends of the line, in the unit of what is off it: how far the line of
/// what is seen is from the line of all, where all is made of pieces of what is seen.
fn spread(off: &[Place], columns: usize, rows: usize) -> [f64; 2] {
    if !off.contains(&Place::Hole) {
        return [0.0; 2];
    }
    let side = columns.div_ceil(ACROSS);
    let mut draws = Draws::new(SEED);
    let mut squares = [0.0; 2];
    for _ in 0..FILLINGS {
        let (mut seen, mut all) = (Line::default(), Line::default());
        for (first_row, first_column) in (0..rows)
            .step_by(side)
            .flat_map(|row| (0..columns).step_by(side).map(move |column| (row, column)))
        {
            let shifts: [(usize, usize); SHIFTS] =
                std::array::from_fn(|_| (draws.place(columns), draws.place(rows)));
            for row in first_row..(first_row + side).min(rows) {
                let down = (row as f64 + 0.5) / rows as f64;
                for column in first_column..(first_column + side).min(columns) {
                    let place = off.get(row * columns + column);
                    if matches!(place, None | Some(Place::NoPhoto)) {
                        continue;
                    }
                    let found = shifts.iter().find_map(|&(across, along)| {
                        let from = (row + along) % rows * columns + (column + across) % columns;
                        match off.get(from) {
                            Some(Place::Off(off)) => Some(*off),
                            _ => None,
                        }
                    });
                    let found = found.unwrap_or(0.0);
                    all.add(down, found);
                    if place != Some(&Place::Hole) {
                        seen.add(down, found);
                    }
                }
            }
        }
        for (sum, (of_seen, of_all)) in squares
            .iter_mut()
            .zip(seen.ends().into_iter().zip(all.ends()))
        {
            *sum += (of_seen - of_all).powi(2);
        }
    }
    squares.map(|sum| (sum / FILLINGS as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const COLUMNS: usize = 64;
    const ROWS: usize = 36;

    /// The line through what is off it, by least squares over the places that have it.
    fn line(off: &[Option<f64>]) -> [f64; 2] {
        let (mut normal, mut right) = (glam::DMat2::ZERO, glam::DVec2::ZERO);
        for (index, off) in off.iter().enumerate() {
            let down = ((index / COLUMNS) as f64 + 0.5) / ROWS as f64;
            let ends = glam::DVec2::new(1.0 - down, down);
            if let Some(off) = off {
                normal += glam::DMat2::from_cols(ends * ends.x, ends * ends.y);
                right += ends * *off;
            }
        }
        (normal.inverse() * right).to_array()
    }

    /// What is seen of a whole, off the line of what is seen.
    fn seen(whole: &[f64], shows: impl Fn(usize, usize) -> bool) -> (Vec<Place>, [f64; 2]) {
        let shown: Vec<Option<f64>> = whole
            .iter()
            .enumerate()
            .map(|(index, off)| shows(index % COLUMNS, index / COLUMNS).then_some(*off))
            .collect();
        let [top, bottom] = line(&shown);
        let places = shown.iter().enumerate().map(|(index, off)| {
            let down = ((index / COLUMNS) as f64 + 0.5) / ROWS as f64;
            off.map_or(Place::Hole, |off| {
                Place::Off(off - top - (bottom - top) * down)
            })
        });
        (places.collect(), [top, bottom])
    }

    /// Independent numbers of the deviation 1, of which the lower half is not seen. The line of all is
    /// N⁻¹ Σ e·x with N = Σ e eᵀ, that of the seen S⁻¹ Σ e·x over the seen: they differ by a sum whose
    /// covariance is S⁻¹ - N⁻¹.
    #[test]
    fn of_independent_numbers_it_is_known() {
        let mut draws = Draws::new(3);
        let whole: Vec<f64> = (0..COLUMNS * ROWS).map(|_| draws.normal()).collect();
        let (places, _) = seen(&whole, |_, row| row < ROWS / 2);
        let found = spread(&places, COLUMNS, ROWS);
        let (mut all, mut upper) = (glam::DMat2::ZERO, glam::DMat2::ZERO);
        for row in 0..ROWS {
            let down = (row as f64 + 0.5) / ROWS as f64;
            let ends = glam::DVec2::new(1.0 - down, down);
            let part = glam::DMat2::from_cols(ends * ends.x, ends * ends.y) * COLUMNS as f64;
            all += part;
            if row < ROWS / 2 {
                upper += part;
            }
        }
        let expected = upper.inverse() - all.inverse();
        for (found, variance) in found
            .into_iter()
            .zip([expected.x_axis.x, expected.y_axis.y])
        {
            let ratio = found / variance.sqrt();
            assert!((0.75..1.25).contains(&ratio), "{found} {variance}");
        }
    }

    /// Waves of a quarter to half of the photo, of which the truth is known: over many the line of what is seen
    /// is off that of the whole by about what is stated; the bounds hold what the header says was found.
    #[test]
    fn lines_of_what_is_seen_are_off_by_what_is_stated() {
        for (name, shows) in [
            ("left", (|c, _| c >= 28) as fn(usize, usize) -> bool),
            ("bottom", |_, r| r < 20),
            ("corner", |c, r| c < 40 || r < 14),
        ] {
            let mut draws = Draws::new(11);
            let mut sums = [0.0; 2];
            const TRIALS: usize = 150;
            for _ in 0..TRIALS {
                let waves = (0..12).map(|_| {
                    let way = TAU * draws.normal();
                    let turn = TAU / (16.0 + 8.0 * draws.normal().abs());
                    [
                        turn * way.cos(),
                        turn * way.sin(),
                        way * 7.0,
                        draws.normal(),
                    ]
                });
                let waves: Vec<[f64; 4]> = waves.collect();
                let whole: Vec<f64> = (0..COLUMNS * ROWS)
                    .map(|index| {
                        let (x, y) = ((index % COLUMNS) as f64, (index / COLUMNS) as f64);
                        let wave =
                            |[a, b, phase, size]: &[f64; 4]| size * (a * x + b * y + phase).sin();
                        waves.iter().map(wave).sum()
                    })
                    .collect();
                let (places, of_seen) = seen(&whole, shows);
                let all: Vec<Option<f64>> = whole.into_iter().map(Some).collect();
                let truth = line(&all);
                let stated = spread(&places, COLUMNS, ROWS);
                for end in 0..2 {
                    sums[end] += ((of_seen[end] - truth[end]) / stated[end]).powi(2);
                }
            }
            for sum in sums {
                let ratio = (sum / TRIALS as f64).sqrt();
                assert!((0.7..1.9).contains(&ratio), "{name}: {ratio}");
            }
        }
    }

    #[test]
    fn without_a_hole_nothing_is_open() {
        let (places, _) = seen(&vec![1.0; COLUMNS * ROWS], |_, _| true);
        assert_eq!(spread(&places, COLUMNS, ROWS), [0.0; 2]);
        let mut places = places;
        places[7] = Place::NoPhoto;
        assert_eq!(spread(&places, COLUMNS, ROWS), [0.0; 2]);
    }
}
