//! The upper envelope of pieces of lines: of a mesh that overhangs the highest counts, as of a cloud
//! the highest of points with the same (x, y).

/// A piece of a line, from `from` to a greater `to`: distance and height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
}

impl Piece {
    fn slope(&self) -> f64 {
        (self.to[1] - self.from[1]) / (self.to[0] - self.from[0])
    }

    /// Its height at a distance; exact at its ends.
    fn height(&self, distance: f64) -> f64 {
        if distance == self.from[0] {
            self.from[1]
        } else if distance == self.to[0] {
            self.to[1]
        } else {
            self.from[1] + self.slope() * (distance - self.from[0])
        }
    }
}

/// The pieces that are seen from above, in the order of their distance. Pieces have a length.
pub(super) fn upper_envelope(mut pieces: Vec<Piece>) -> Vec<Piece> {
    pieces.sort_by(|a, b| a.from[0].total_cmp(&b.from[0]));
    let mut places: Vec<f64> = (pieces.iter())
        .flat_map(|piece| [piece.from[0], piece.to[0]])
        .collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut next = 0;
    let mut active: Vec<usize> = Vec::new();
    // Which piece is seen, and between which places.
    let mut seen: Vec<(usize, f64, f64)> = Vec::new();
    for ends in places.windows(2) {
        let &[low, high] = ends else {
            continue;
        };
        active.retain(|&piece| pieces[piece].to[0] >= high);
        while next < pieces.len() && pieces[next].from[0] <= low {
            active.push(next);
            next += 1;
        }
        let mut at = low;
        while at < high {
            let rank = |&piece: &usize| (pieces[piece].height(at), pieces[piece].slope());
            let compare = |a: &usize, b: &usize| {
                let (a, b) = (rank(a), rank(b));
                a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
            };
            let Some(top) = active.iter().copied().max_by(compare) else {
                break;
            };
            // Where a steeper one comes out of it first.
            let (height, slope) = rank(&top);
            let crossing = |&other: &usize| {
                let (below, steeper) = rank(&other);
                let place = at + (height - below) / (steeper - slope);
                (steeper > slope && place > at && place < high).then_some(place)
            };
            let until = active.iter().filter_map(crossing).fold(high, f64::min);
            match seen.last_mut() {
                Some(last) if last.0 == top && last.2 == at => last.2 = until,
                _ => seen.push((top, at, until)),
            }
            at = until;
        }
    }
    let cut = |(piece, low, high): (usize, f64, f64)| Piece {
        from: [low, pieces[piece].height(low)],
        to: [high, pieces[piece].height(high)],
    };
    seen.into_iter().map(cut).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(from: [f64; 2], to: [f64; 2]) -> Piece {
        Piece { from, to }
    }

    /// z = x and z = 2 - x cross at (1, 1); a level piece at 3 hides all from 0.25 to 0.5.
    #[test]
    fn the_highest_is_seen() {
        let pieces = vec![
            piece([0.0, 0.0], [2.0, 2.0]),
            piece([0.25, 3.0], [0.5, 3.0]),
            piece([0.0, 2.0], [2.0, 0.0]),
        ];
        let expected = [
            piece([0.0, 2.0], [0.25, 1.75]),
            piece([0.25, 3.0], [0.5, 3.0]),
            piece([0.5, 1.5], [1.0, 1.0]),
            piece([1.0, 1.0], [2.0, 2.0]),
        ];
        assert_eq!(upper_envelope(pieces), expected);
    }

    #[test]
    fn a_chain_stays_as_it_is() {
        let chain = vec![
            piece([0.0, 0.0], [1.0, 5.0]),
            piece([1.0, 5.0], [1.5, 4.0]),
            piece([2.0, 4.0], [3.0, 4.0]),
        ];
        let mut turned = chain.clone();
        turned.reverse();
        // An edge in the plane is a piece of both of its triangles.
        turned.push(chain[1]);
        assert_eq!(upper_envelope(turned), chain);
        assert!(upper_envelope(Vec::new()).is_empty());
    }
}
