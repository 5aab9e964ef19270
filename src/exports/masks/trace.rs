//! Outlines along the sides of pixels.

use std::ops::Range;

use crate::delineation::LabelImage;

/// Pixels of one label that touch by their sides, and no others of that label do.
#[derive(Debug)]
pub(crate) struct Part {
    pub(crate) label: u32,
    /// Its outline, clockwise as the photo is seen, then its holes, counterclockwise; corners of pixels, each where the
    /// line turns. An outline may touch itself at a corner, where two pixels do.
    pub(crate) rings: Vec<Vec<[u32; 2]>>,
}

/// All parts of a label image, by their first pixels row by row; and of each pixel its part.
pub(crate) fn parts(image: &LabelImage) -> (Vec<Part>, Vec<u32>) {
    let (part_of, labels) = image.parts();
    let without_rings = |label| Part {
        label,
        rings: Vec::new(),
    };
    let mut parts: Vec<Part> = labels.into_iter().map(without_rings).collect();
    let grid = Grid {
        width: image.width,
        height: image.height,
        part_of: &part_of,
    };
    // Upper sides that a ring goes along.
    let mut is_walked = vec![false; part_of.len()];
    for (at, part) in part_of.iter().enumerate() {
        let (x, y) = (at % image.width, at / image.width);
        let is_side = y == 0 || part_of[at - image.width] != *part;
        if is_side && !is_walked[at] {
            let ring = grid.ring([x, y], *part, &mut is_walked);
            parts[*part as usize].rings.push(ring);
        }
    }
    (parts, part_of)
}

struct Grid<'a> {
    width: usize,
    height: usize,
    part_of: &'a [u32],
}

/// Right, down, left, up.
const STEPS: [[i64; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

impl Grid<'_> {
    /// Whether a pixel, perhaps outside the image, belongs to a part.
    fn is_of(&self, [x, y]: [i64; 2], part: u32) -> bool {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else {
            return false;
        };
        x < self.width && y < self.height && self.part_of[y * self.width + x] == part
    }

    /// The ring that goes along the upper side of a pixel to the right, with the part on its right hand.
    fn ring(&self, [x, y]: [usize; 2], part: u32, is_walked: &mut [bool]) -> Vec<[u32; 2]> {
        // The sides of photos are in u32.
        let start = [x, y].map(|place| i64::from(place as u32));
        let (mut at, mut way) = (start, 0_usize);
        let mut corners = Vec::new();
        loop {
            if way == 0 {
                is_walked[at[1] as usize * self.width + at[0] as usize] = true;
            }
            let [dx, dy] = STEPS[way];
            at = [at[0] + dx, at[1] + dy];
            // The pixels ahead on the right and on the left, by the corner that they share.
            let ahead = |way: usize| {
                let [ax, ay] = [STEPS[way], STEPS[(way + 1) % 4]]
                    .iter()
                    .fold([0, 0], |sum, step| [sum[0] + step[0], sum[1] + step[1]]);
                [at[0] + (ax - 1) / 2, at[1] + (ay - 1) / 2]
            };
            let (right, left) = (ahead(way), ahead((way + 3) % 4));
            // Pixels that touch at a corner alone are apart.
            let turned = match (self.is_of(right, part), self.is_of(left, part)) {
                (false, _) => (way + 1) % 4,
                (true, false) => way,
                (true, true) => (way + 3) % 4,
            };
            if turned != way {
                // Corners lie within the image, whose sides are in u32.
                corners.push(at.map(|place| place as u32));
            }
            way = turned;
            if at == start && way == 0 {
                return corners;
            }
        }
    }
}

/// The runs of equal labels in a row: the label and its columns.
pub(super) fn runs(row: &[u32]) -> impl Iterator<Item = (u32, Range<usize>)> {
    let mut at = 0;
    row.chunk_by(|a, b| a == b).map(move |run| {
        let begin = at;
        at += run.len();
        (run[0], begin..at)
    })
}
