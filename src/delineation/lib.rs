//! The fragments of a photo, outlined.
//!
//! The common form is a [`LabelImage`]: every pixel of the undistorted photo belongs to a fragment, to
//! fines, or to what is no rock. It comes about in three steps:
//!
//! 1. An [`Engine`] says of every pixel how much it looks like a border between fragments
//!    ([`Evidence`]): [`Classical`] from edges and shadows, [`Learned`] by a small network.
//! 2. [`tree`]: a watershed cuts the photo into many small regions, which are joined one seam after
//!    another, the weakest first. All regions that ever were make a tree, and nearly every fragment is
//!    one of its nodes; which one, no single strength of seams tells.
//! 3. [`choice`]: every node gets a score, how likely it is a whole fragment (its seams against those
//!    within it, its shape), and the best nodes that do not overlap are taken.

pub mod choice;
mod classical;
mod delineating;
mod engine;
mod evidence;
mod hull;
mod labels;
mod learned;
pub mod mass;
pub mod measures;
pub mod overlap;
mod smoothing;
pub mod tree;

pub use classical::Classical;
pub use delineating::{delineate, least_across};
pub use engine::Engine;
pub use evidence::Evidence;
pub use labels::{FINES, LabelImage, NOT_ROCK};
pub use learned::Learned;
