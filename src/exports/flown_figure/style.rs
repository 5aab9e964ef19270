//! What marks and their names have in common.

use crate::drawing::Colour;

/// Height of names, CSS pixels.
pub(super) const NAME: f64 = 12.0;
/// Half the width of a mark.
pub(super) const MARK: f64 = 3.8;
/// Lines and words.
pub(super) const INK: Colour = [34; 3];
