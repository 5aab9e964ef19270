//! The parts of a photo that a network sees one after the other.

/// How a photo is cut into parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Parts {
    /// The most that the network sees at once: columns and rows.
    pub(crate) part: [usize; 2],
    /// How much of a part is thrown away where the photo goes on, because the network knows nothing of that.
    pub(crate) margin: usize,
    /// Sides are multiples of this.
    pub(crate) step: usize,
    /// Whether every part has all columns and rows, however small the photo is.
    pub(crate) is_fixed: bool,
}

/// A part: what is kept of it, and what the network sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Part {
    /// The first column and row that are kept.
    pub(crate) left: usize,
    pub(crate) top: usize,
    /// Those behind the last.
    pub(crate) right: usize,
    pub(crate) bottom: usize,
    /// The first column and row that the network sees.
    pub(crate) first: usize,
    pub(crate) above: usize,
    /// How many it sees; those beyond the photo are its mirror.
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Parts {
    /// Those of a photo of this size, row by row; what is kept of them is each pixel once.
    pub(crate) fn of(&self, width: usize, height: usize) -> Vec<Part> {
        let inner = self.part.map(|side| (side - 2 * self.margin).max(1));
        let corners = (0..height)
            .step_by(inner[1])
            .flat_map(|top| (0..width).step_by(inner[0]).map(move |left| (left, top)));
        corners
            .map(|(left, top)| {
                let (right, bottom) = ((left + inner[0]).min(width), (top + inner[1]).min(height));
                // Where the photo goes on, the part does.
                let (first, above) = (
                    left.saturating_sub(self.margin),
                    top.saturating_sub(self.margin),
                );
                let [columns, rows] = match self.is_fixed {
                    true => self.part,
                    false => [
                        (right + self.margin).min(width) - first,
                        (bottom + self.margin).min(height) - above,
                    ]
                    .map(|side| side.next_multiple_of(self.step)),
                };
                Part {
                    left,
                    top,
                    right,
                    bottom,
                    first,
                    above,
                    columns,
                    rows,
                }
            })
            .collect()
    }
}

/// A place that lies on the photo, by reflection at its far edge.
pub(crate) fn mirrored(place: usize, size: usize) -> usize {
    let last = size.saturating_sub(1);
    if place <= last {
        place
    } else {
        (2 * last).saturating_sub(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pixel is kept once, of a part that sees the margin about it or up to the photo's edge.
    #[test]
    fn every_pixel_once() {
        for (is_fixed, width, height) in [
            (false, 203, 97),
            (true, 203, 97),
            (false, 5, 3),
            (true, 5, 3),
        ] {
            let parts = Parts {
                part: [64, 48],
                margin: 8,
                step: 16,
                is_fixed,
            };
            let mut kept = vec![0; width * height];
            for part in parts.of(width, height) {
                assert!(part.columns <= 64 && part.rows <= 48, "{part:?}");
                assert_eq!((part.columns % 16, part.rows % 16), (0, 0));
                assert!(part.left == 0 || part.left - part.first == 8);
                let seen = (part.first + part.columns, part.above + part.rows);
                assert!(seen.0 >= (part.right + 8).min(width));
                assert!(seen.1 >= (part.bottom + 8).min(height));
                for y in part.top..part.bottom {
                    for x in part.left..part.right {
                        kept[y * width + x] += 1;
                    }
                }
            }
            assert!(kept.iter().all(|times| *times == 1));
        }
    }

    #[test]
    fn beyond_the_edge_is_its_mirror() {
        let places: Vec<usize> = (0..8).map(|place| mirrored(place, 4)).collect();
        assert_eq!(places, [0, 1, 2, 3, 2, 1, 0, 0]);
        assert_eq!(mirrored(9, 1), 0);
    }
}
