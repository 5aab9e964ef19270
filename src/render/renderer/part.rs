//! Parts of a picture that is larger than a texture.

use glam::{DMat4, DVec2, DVec4};

/// A part of a picture, in pixels of the whole.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    /// Its top left pixel in the whole.
    pub(crate) origin: [u32; 2],
    pub(crate) size: [u32; 2],
    /// The whole's size.
    pub(crate) of: [u32; 2],
}

impl Part {
    pub(crate) fn whole(size: [u32; 2]) -> Self {
        Self {
            origin: [0, 0],
            size,
            of: size,
        }
    }

    /// Clip space of the whole to that of the part.
    pub(crate) fn crop(&self) -> DMat4 {
        let of = pair(self.of) / pair(self.size);
        let shift = pair(self.origin) * 2.0 / pair(self.size);
        DMat4::from_cols(
            DVec4::new(of.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, of.y, 0.0, 0.0),
            DVec4::Z,
            DVec4::new(of.x - shift.x - 1.0, 1.0 - of.y + shift.y, 0.0, 1.0),
        )
    }
}

/// How much of the surface is drawn in one call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Most {
    /// All that there is, and what of a streamed cloud is missing is brought before: for files.
    All,
    /// About so many triangles or points, where an earlier picture can stand in; what is missing comes
    /// later.
    Portion(usize),
    /// All that is there, of a picture beside the main one; what is missing comes later.
    Aside,
}

pub(crate) fn pair([x, y]: [u32; 2]) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}
