//! Edits by hand: split, merge, outline, delete, brush, exclude. Each is a [`Change`] of the outlines as they
//! are; nothing is done to them here. Places are in pixels of the undistorted photo, (0, 0) at the outer corner
//! of the top left one.

use std::collections::{BTreeSet, VecDeque};

use glam::DVec2;

use super::{Change, FINES, LabelImage, NOT_ROCK, Outlines, Painting, spans_within};
use crate::fault::Fault;
use crate::geometry::{extent, twice_signed_area};

/// Pieces of fewer pixels than this are the stroke's own raggedness.
const LEAST_PIECE: usize = 8;

/// Half the width of a bridge between two fragments, pixels.
const BRIDGE: f64 = 1.0;

/// An outline narrower than this in the mean, pixels, is a line.
const LEAST_WIDTH: f64 = 1.0;

/// The area within an outline over how far its corners reach, pixels.
fn mean_width(corners: &[DVec2]) -> f64 {
    let [low, high] = extent(corners);
    twice_signed_area(corners).abs() / 2.0 / low.distance(high).max(f64::MIN_POSITIVE)
}

impl Outlines {
    /// Fragments that a stroke crosses from side to side become two or more. The largest piece keeps the number.
    ///
    /// # Errors
    /// Where it crosses none.
    pub fn split(&self, stroke: &[DVec2]) -> Result<Change, Fault> {
        let labels = self.labels();
        let under = labels.under(stroke);
        let mut painting = Painting::on(labels);
        let mut next = self.next_number();
        let mut shaped = Vec::new();
        for number in fragments_of(labels, &under) {
            let cut = Cut::through(labels, number, &under);
            if cut.pieces.len() < 2 {
                continue;
            }
            shaped.push(number);
            let numbers = cut.numbers(number, &mut next);
            shaped.extend(&numbers);
            for (place, piece) in cut.grown() {
                painting.paint(place, numbers[piece]);
            }
        }
        if shaped.is_empty() {
            let what = "the stroke crosses no fragment from side to side";
            return Err(Fault::new(what, "begin and end it outside of the fragment"));
        }
        Ok(self.painted(painting, &shaped))
    }

    /// All fragments that a stroke touches become one, with the number of the first; what lies between them on
    /// the stroke becomes a bridge.
    ///
    /// # Errors
    /// Where it touches fewer than two.
    pub fn merge(&self, stroke: &[DVec2]) -> Result<Change, Fault> {
        let labels = self.labels();
        let under = labels.under(stroke);
        let touched = fragments_of(labels, &under);
        let [first, others @ ..] = &touched[..] else {
            return Err(one_alone());
        };
        if others.is_empty() {
            return Err(one_alone());
        }
        let mut painting = Painting::on(labels);
        for (place, label) in labels.labels.iter().enumerate() {
            if others.contains(label) {
                painting.paint(place, *first);
            }
        }
        let is_fragment = |place: &usize| touched.contains(&labels.labels[*place]);
        let from = under.iter().position(is_fragment).unwrap_or(0);
        let to = under.iter().rposition(is_fragment).unwrap_or(0);
        let middle = |place: &usize| {
            let (x, y) = (place % labels.width, place / labels.width);
            DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
        };
        let between = under[from..=to].iter();
        let between = between.filter(|place| labels.labels[**place] == FINES);
        let gaps: Vec<DVec2> = between.map(middle).collect();
        if !gaps.is_empty() {
            for place in labels.brushed(&gaps, BRIDGE) {
                if labels.labels[place] == FINES {
                    painting.paint(place, *first);
                }
            }
        }
        Ok(self.painted(painting, &touched))
    }

    /// A fragment within an outline: a new one, or another outline of the one with that number. What else lies
    /// there gives way; what the fragment leaves becomes fines.
    ///
    /// # Errors
    /// Where no pixel lies within the outline.
    pub fn outline(&self, number: Option<u32>, corners: &[DVec2]) -> Result<Change, Fault> {
        let labels = self.labels();
        let mut painting = Painting::on(labels);
        if let Some(number) = number {
            self.paint_over(&mut painting, number, FINES);
        }
        let number = number.unwrap_or_else(|| self.next_number());
        fill(labels, corners, &mut painting, number)?;
        Ok(self.painted(painting, &[number]))
    }

    /// A fragment is none: its pixels become fines.
    pub fn delete(&self, number: u32) -> Change {
        self.becomes(number, FINES)
    }

    /// A fragment is no rock: a ball, a machine.
    pub fn no_rock(&self, number: u32) -> Change {
        self.becomes(number, NOT_ROCK)
    }

    fn becomes(&self, number: u32, label: u32) -> Change {
        let mut painting = Painting::on(self.labels());
        self.paint_over(&mut painting, number, label);
        self.painted(painting, &[number])
    }

    /// What a brush of that radius passes over is fines. A fragment that it parts becomes two.
    ///
    /// # Errors
    /// Where it passes over no fragment.
    pub fn brush(&self, stroke: &[DVec2], radius: f64) -> Result<Change, Fault> {
        let labels = self.labels();
        let brushed = labels.brushed(stroke, radius);
        let mut painting = Painting::on(labels);
        let mut next = self.next_number();
        let touched = fragments_of(labels, &brushed);
        if touched.is_empty() {
            let what = "the brush passed over no fragment";
            return Err(Fault::new(
                what,
                "brush over what is fines and not a fragment",
            ));
        }
        let mut shaped = touched.clone();
        for number in touched {
            let cut = Cut::through(labels, number, &brushed);
            let numbers = cut.numbers(number, &mut next);
            shaped.extend(&numbers);
            for (place, piece) in cut.own() {
                painting.paint(place, piece.map_or(FINES, |piece| numbers[piece]));
            }
        }
        Ok(self.painted(painting, &shaped))
    }

    /// What lies within an outline is no rock, or, with `back`, may be rock again: fines.
    ///
    /// # Errors
    /// Where no pixel lies within the outline, or it is a mere line, which would part fragments and hide nothing.
    pub fn exclude(&self, corners: &[DVec2], back: bool) -> Result<Change, Fault> {
        if mean_width(corners) < LEAST_WIDTH {
            let what = "the line encloses nothing";
            return Err(Fault::new(
                what,
                "draw around what is meant, back to where you began",
            ));
        }
        let labels = self.labels();
        let mut painting = Painting::on(labels);
        if back {
            let (width, height) = (labels.width as u32, labels.height as u32);
            spans_within(corners, width, height, |row, columns| {
                for column in columns {
                    let place = row as usize * labels.width + column as usize;
                    if labels.labels[place] == NOT_ROCK {
                        painting.paint(place, FINES);
                    }
                }
            });
        } else {
            fill(labels, corners, &mut painting, NOT_ROCK)?;
            self.remains(corners, |place| painting.paint(place, NOT_ROCK));
        }
        Ok(self.painted(painting, &[]))
    }

    /// Every pixel outside of an outline whose fragment has more of its pixels within: of a ball that is drawn about a little too
    /// narrowly no rim is left, which would be measured as a fragment as wide as the ball.
    fn remains(&self, corners: &[DVec2], mut found: impl FnMut(usize)) {
        let labels = self.labels();
        let (width, height) = (labels.width as u32, labels.height as u32);
        let areas = labels.areas();
        let mut within = vec![0usize; areas.len()];
        spans_within(corners, width, height, |row, columns| {
            for column in columns {
                let label = labels.labels[row as usize * labels.width + column as usize];
                if let Some(within) = within.get_mut(label as usize) {
                    *within += 1;
                }
            }
        });
        let is_gone = |label: u32| {
            let place = label as usize;
            label != FINES && within.get(place).is_some_and(|own| 2 * own > areas[place])
        };
        for (place, label) in labels.labels.iter().enumerate() {
            if is_gone(*label) {
                found(place);
            }
        }
    }

    /// A fragment is right as it is: nobody needs to look at it again.
    pub fn is_right(&self, number: u32) -> Change {
        self.painted(Painting::on(self.labels()), &[number])
    }

    /// What makes these outlines those others of the same photo.
    pub fn become_these(&self, other: &Self) -> Change {
        let numbers = self.all_sure().keys().chain(other.all_sure().keys());
        let numbers: BTreeSet<u32> = numbers.copied().collect();
        let sure = numbers.into_iter();
        let sure = sure.map(|number| (number, self.sure(number), other.sure(number)));
        Change::between(self.labels(), other.labels(), sure.collect())
    }

    /// No change.
    pub fn nothing(&self) -> Change {
        self.painted(Painting::on(self.labels()), &[])
    }

    /// What a painting changes, `shaped` being the fragments that a person looked at.
    pub fn painted(&self, painting: Painting<'_>, shaped: &[u32]) -> Change {
        painting.done(shaped, |number| self.sure(number))
    }

    /// A number that no fragment has.
    pub fn next_number(&self) -> u32 {
        let greatest = self.labels().fragments() as u32;
        greatest + 1
    }

    fn paint_over(&self, painting: &mut Painting<'_>, number: u32, label: u32) {
        let places = self.labels().labels.iter().enumerate();
        for (place, _) in places.filter(|(_, own)| **own == number) {
            painting.paint(place, label);
        }
    }
}

fn one_alone() -> Fault {
    let what = "the stroke touches fewer than two fragments";
    Fault::new(what, "draw it from one fragment to the other")
}

/// The fragments at places, each once, in the order of the places.
fn fragments_of(labels: &LabelImage, places: &[usize]) -> Vec<u32> {
    let mut found = Vec::new();
    for place in places {
        let label = labels.labels[*place];
        // Neighbours mostly are of the same one.
        if found.last() == Some(&label) {
            continue;
        }
        if label != FINES && label != NOT_ROCK && !found.contains(&label) {
            found.push(label);
        }
    }
    found
}

fn fill(
    labels: &LabelImage,
    corners: &[DVec2],
    painting: &mut Painting<'_>,
    label: u32,
) -> Result<(), Fault> {
    let (width, height) = (labels.width as u32, labels.height as u32);
    let mut any = false;
    spans_within(corners, width, height, |row, columns| {
        for column in columns {
            any = true;
            painting.paint(row as usize * labels.width + column as usize, label);
        }
    });
    if any {
        return Ok(());
    }
    let what = "no pixel lies within the outline";
    Err(Fault::new(what, "draw it about what you mean"))
}

/// A pixel of a [`Cut`] that is not the fragment's.
const OUTSIDE: u32 = u32::MAX;
/// One that is, and that no piece has yet.
const FREE: u32 = u32::MAX - 1;

/// A fragment with some of its pixels taken away, in pieces.
struct Cut {
    /// Left, top, width and height of what is looked at, and the image's width.
    frame: [usize; 4],
    stride: usize,
    /// Row by row of the frame: a piece, [`FREE`] or [`OUTSIDE`].
    piece_of: Vec<u32>,
    /// Pixels of each piece.
    pieces: Vec<usize>,
}

impl Cut {
    /// Takes the pixels at `places` away from a fragment. Pixels with a side in common are of one piece. Pieces
    /// that do not touch what was taken away count as part of the largest one, as they did before.
    fn through(labels: &LabelImage, number: u32, places: &[usize]) -> Self {
        let frame = frame_of(labels, number);
        let [left, top, width, height] = frame;
        let mut piece_of = vec![OUTSIDE; width * height];
        for y in 0..height {
            let row = (top + y) * labels.width + left;
            let own = labels.labels[row..row + width].iter();
            for (piece, label) in piece_of[y * width..].iter_mut().zip(own) {
                if *label == number {
                    *piece = FREE;
                }
            }
        }
        let mut is_taken = vec![false; piece_of.len()];
        for place in places {
            let (x, y) = (place % labels.width, place / labels.width);
            if (left..left + width).contains(&x) && (top..top + height).contains(&y) {
                is_taken[(y - top) * width + x - left] = true;
            }
        }
        let mut cut = Self {
            frame,
            stride: labels.width,
            piece_of,
            pieces: Vec::new(),
        };
        let mut far = Vec::new();
        let mut open = Vec::new();
        for start in 0..is_taken.len() {
            if cut.piece_of[start] != FREE || is_taken[start] {
                continue;
            }
            let piece = cut.pieces.len() as u32;
            let (mut places, mut touches) = (Vec::new(), false);
            cut.piece_of[start] = piece;
            open.push(start);
            while let Some(place) = open.pop() {
                places.push(place);
                for other in cut.beside(place) {
                    if cut.piece_of[other] != FREE {
                        continue;
                    }
                    if is_taken[other] {
                        touches = true;
                    } else {
                        cut.piece_of[other] = piece;
                        open.push(other);
                    }
                }
            }
            if !touches {
                far.extend(places);
            } else if places.len() < LEAST_PIECE {
                for place in places {
                    cut.piece_of[place] = FREE;
                    // Not again.
                    is_taken[place] = true;
                }
            } else {
                cut.pieces.push(places.len());
                continue;
            }
            // The number of this one is free again: it is given to the next.
        }
        if cut.pieces.is_empty() && !far.is_empty() {
            cut.pieces.push(far.len());
        }
        let largest = cut.largest().map_or(FREE, |piece| piece as u32);
        for place in far {
            cut.piece_of[place] = largest;
        }
        cut
    }

    fn largest(&self) -> Option<usize> {
        let pieces = self.pieces.iter().enumerate();
        let largest = pieces.max_by_key(|(place, area)| (**area, usize::MAX - place));
        largest.map(|(piece, _)| piece)
    }

    /// A number for each piece: the largest has the fragment's own, the others follow on `next`.
    fn numbers(&self, own: u32, next: &mut u32) -> Vec<u32> {
        let largest = self.largest();
        let number = |piece| {
            if largest == Some(piece) {
                return own;
            }
            *next += 1;
            *next - 1
        };
        (0..self.pieces.len()).map(number).collect()
    }

    /// Neighbours of a place of the frame at its sides.
    fn beside(&self, place: usize) -> impl Iterator<Item = usize> + use<> {
        let [_, _, width, height] = self.frame;
        let (x, y) = (place % width, place / width);
        let before = (x > 0).then(|| place - 1);
        let behind = (x + 1 < width).then(|| place + 1);
        let above = (y > 0).then(|| place - width);
        let below = (y + 1 < height).then(|| place + width);
        [before, behind, above, below].into_iter().flatten()
    }

    /// The fragment's pixels as places of the image, with their pieces; those taken away have none.
    fn own(&self) -> impl Iterator<Item = (usize, Option<usize>)> + '_ {
        let [left, top, width, _] = self.frame;
        let pixels = self.piece_of.iter().enumerate();
        pixels
            .filter(|(_, piece)| **piece != OUTSIDE)
            .map(move |(place, piece)| {
                let at = (top + place / width) * self.stride + left + place % width;
                (at, (*piece != FREE).then_some(*piece as usize))
            })
    }

    /// The same, those taken away given to the nearest pieces.
    fn grown(mut self) -> impl Iterator<Item = (usize, usize)> {
        let is_piece = |piece: u32| piece != FREE && piece != OUTSIDE;
        let places = (0..self.piece_of.len()).filter(|place| is_piece(self.piece_of[*place]));
        let mut open: VecDeque<usize> = places.collect();
        while let Some(place) = open.pop_front() {
            for other in self.beside(place) {
                if self.piece_of[other] == FREE {
                    self.piece_of[other] = self.piece_of[place];
                    open.push_back(other);
                }
            }
        }
        let own: Vec<_> = self.own().collect();
        // What touches no piece by a side (a corner that the stroke cut off) stays as it is.
        own.into_iter()
            .filter_map(|(place, piece)| Some((place, piece?)))
    }
}

/// The columns and rows that a fragment lies in: left, top, width, height.
fn frame_of(labels: &LabelImage, number: u32) -> [usize; 4] {
    let (mut left, mut right, mut top, mut bottom) = (usize::MAX, 0, usize::MAX, 0);
    for (y, row) in labels.labels.chunks_exact(labels.width.max(1)).enumerate() {
        let Some(first) = row.iter().position(|label| *label == number) else {
            continue;
        };
        let last = row.iter().rposition(|label| *label == number);
        left = left.min(first);
        right = right.max(last.unwrap_or(first) + 1);
        top = top.min(y);
        bottom = y + 1;
    }
    if top == usize::MAX {
        return [0; 4];
    }
    [left, top, right - left, bottom - top]
}
