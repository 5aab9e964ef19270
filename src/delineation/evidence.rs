//! What an engine says of a photo, and what the tree is grown from.

/// What an engine says of every pixel of a photo, row by row from the top left, each 0 to 255.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Evidence {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// How sure it is a border: of two fragments, or of a fragment and what is none.
    pub border: Vec<u8>,
    /// How sure it is a fragment rather than fines or anything else; 255 where the engine cannot tell.
    pub rock: Vec<u8>,
    /// How far within a fragment: 0 at its border, 255 in its middle; 0 where the engine cannot tell.
    pub middle: Vec<u8>,
    /// How bright the photo is.
    pub gray: Vec<u8>,
}
