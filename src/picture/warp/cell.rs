//! Where places of a picture come from, cell by cell: between the corners of a cell where that is good
//! enough, because a lens is slow.

use glam::DVec2;

/// Pixels along the side of a cell within which the mapping is interpolated.
pub(in crate::picture) const CELL: u32 = 16;

/// How far, in pixels of the photo, a bilinear mapping may be off in the checked points of a cell;
/// cells where it is further off are mapped exactly, pixel by pixel.
const TOLERANCE_PX: f64 = 0.02;

/// How a cell of [`CELL`] pixels a side is mapped.
pub(in crate::picture) enum Cell {
    /// Between the sources of its corners: top left, top right, bottom left, bottom right.
    Smooth([DVec2; 4]),
    /// Pixel by pixel from its top left corner.
    Exact(DVec2),
}

impl Cell {
    /// The cell whose top left corner is there: smooth where the mapping is bilinear at the middles
    /// of its sides and of itself.
    pub(in crate::picture) fn at(origin: DVec2, source: impl Fn(DVec2) -> Option<DVec2>) -> Self {
        let place = |share: DVec2| source(origin + share * f64::from(CELL));
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(place);
        let [Some(a), Some(b), Some(c), Some(d)] = corners else {
            return Self::Exact(origin);
        };
        let corners = [a, b, c, d];
        let checked = [(0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (1.0, 0.5), (0.5, 1.0)];
        let is_smooth = checked.into_iter().map(DVec2::from).all(|share| {
            let off = |source: DVec2| (source - bilinear(&corners, share)).length();
            place(share).is_some_and(|source| off(source) < TOLERANCE_PX)
        });
        if is_smooth {
            Self::Smooth(corners)
        } else {
            Self::Exact(origin)
        }
    }
}

/// Between four corners, in the order of [`Cell::Smooth`].
pub(in crate::picture) fn bilinear([a, b, c, d]: &[DVec2; 4], share: DVec2) -> DVec2 {
    a.lerp(*b, share.x).lerp(c.lerp(*d, share.x), share.y)
}
