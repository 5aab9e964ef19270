//! In how many pieces fragments lie: what is partly behind others has several, and so has a number that fragments share.

use std::collections::BTreeSet;

use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::text::notes::Notes;

/// A piece smaller than this share of a fragment's largest is a crumb of its edge.
const CRUMB: f64 = 0.1;
/// What hides the middle of a fragment is seldom larger than this share of its largest piece.
const HIDDEN: f64 = 0.5;
/// Pixels: specks that are closer are no matter.
const CLOSE: usize = 8;

/// The regions of fragments, numbered from 1, what is none with its own number; and how many they are.
pub(super) fn regions(labels: &LabelImage) -> (Vec<u32>, u32) {
    let (part_of, label_of) = labels.parts();
    let mut count = 0;
    let number = |label: &u32| match *label {
        FINES | NOT_ROCK => *label,
        _ => {
            count += 1;
            count
        }
    };
    let numbers: Vec<u32> = label_of.iter().map(number).collect();
    let found = part_of.iter().map(|part| numbers[*part as usize]);
    (found.collect(), count)
}

/// The box around the pixels of a piece, and how many they are.
#[derive(Debug, Clone, Copy)]
struct Piece {
    label: u32,
    from: [usize; 2],
    to: [usize; 2],
    area: usize,
}

impl Piece {
    /// Its longer side.
    fn side(&self) -> usize {
        (self.to[0] - self.from[0]).max(self.to[1] - self.from[1]) + 1
    }

    /// How far the boxes are apart, along the axis on which they are farther.
    fn gap(&self, other: &Self) -> usize {
        let along = |axis: usize| {
            let begin = self.from[axis].max(other.from[axis]);
            begin.saturating_sub(self.to[axis].min(other.to[axis]) + 1)
        };
        along(0).max(along(1))
    }
}

/// Takes off what reaches all four edges of the photo in one piece, and says so: what lies behind the stones has a number in some
/// programs' label images, and an outline of its own in others' files. A stone that is larger than the photo could not be measured
/// either.
pub(super) fn take_off_behind(labels: &mut LabelImage, notes: &mut Notes) {
    let (part_of, label_of) = labels.parts();
    let (width, height) = (labels.width, labels.height);
    let mut reached = vec![[false; 4]; label_of.len()];
    for (place, part) in part_of.iter().enumerate() {
        let (column, row) = (place % width, place / width);
        let at = [
            row == 0,
            row + 1 == height,
            column == 0,
            column + 1 == width,
        ];
        let of_part = &mut reached[*part as usize];
        *of_part = std::array::from_fn(|edge| of_part[edge] || at[edge]);
    }
    let reached = label_of
        .iter()
        .zip(&reached)
        .filter(|(_, edges)| **edges == [true; 4]);
    let behind: BTreeSet<u32> = reached.map(|(label, _)| *label).collect();
    for number in behind
        .into_iter()
        .filter(|label| *label != FINES && *label != NOT_ROCK)
    {
        let pixels = labels.labels.iter_mut().filter(|label| **label == number);
        let count = pixels.map(|label| *label = FINES).count();
        let share = 100.0 * count as f64 / (width * height) as f64;
        notes.say(format!(
            "fragment {number} reaches all four edges of the photo, over {share:.0} % of it: it is taken for what lies between the others, and for none"
        ));
    }
}

/// How many fragments lie in pieces that are farther apart than half their size: whoever meant several fragments gets one
/// that is larger than all of them.
pub(super) fn far_apart(labels: &LabelImage) -> usize {
    let (part_of, label_of) = labels.parts();
    let mut pieces: Vec<Option<Piece>> = vec![None; label_of.len()];
    for (place, (part, label)) in part_of.iter().zip(&labels.labels).enumerate() {
        if *label == FINES || *label == NOT_ROCK {
            continue;
        }
        let at = [place % labels.width, place / labels.width];
        let piece = pieces[*part as usize].get_or_insert(Piece {
            label: *label,
            from: at,
            to: at,
            area: 0,
        });
        piece.from = std::array::from_fn(|axis| piece.from[axis].min(at[axis]));
        piece.to = std::array::from_fn(|axis| piece.to[axis].max(at[axis]));
        piece.area += 1;
    }
    let mut pieces: Vec<Piece> = pieces.into_iter().flatten().collect();
    // Of each fragment the largest first.
    pieces.sort_by_key(|piece| (piece.label, std::cmp::Reverse(piece.area)));
    let fragments = pieces.chunk_by(|a, b| a.label == b.label);
    let is_apart = |pieces: &&[Piece]| {
        pieces.split_first().is_some_and(|(largest, others)| {
            others.iter().any(|piece| {
                piece.area as f64 >= CRUMB * largest.area as f64
                    && largest.gap(piece) > CLOSE
                    && largest.gap(piece) as f64 > HIDDEN * largest.side() as f64
            })
        })
    };
    fragments.filter(is_apart).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of digits, each the fragment of 4 x 4 pixels.
    fn apart(rows: &[&str]) -> usize {
        let row = |row: &str| -> Vec<u32> {
            let digits = row.bytes().map(|digit| u32::from(digit - b'0'));
            let row: Vec<u32> = digits.flat_map(|digit| [digit; 4]).collect();
            row.repeat(4)
        };
        far_apart(&LabelImage {
            width: 4 * rows[0].len(),
            height: 4 * rows.len(),
            labels: rows.iter().flat_map(|text| row(text)).collect(),
        })
    }

    #[test]
    fn pieces_of_one_number_far_from_each_other_are_counted() {
        // A stone behind a narrow one, and one with a crumb far off.
        assert_eq!(apart(&["11112111", "11112111", "11112111"]), 0);
        assert_eq!(apart(&["11110000000", "11110000001", "11110000000"]), 0);
        assert_eq!(apart(&["1100011", "1100011"]), 1);
        assert_eq!(
            apart(&[
                "1100022", "1100022", "0000000", "0000000", "2200011", "2200011"
            ]),
            2
        );
    }
}
