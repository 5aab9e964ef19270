//! The fragments of a photo, outlined.
//!
//! The common form is a [`LabelImage`]: every pixel of the undistorted photo belongs to a fragment, to
//! fines, or to what is no rock. It comes about in three steps:
//!
//! 1. An [`Engine`] says of every pixel how much it looks like a border between fragments
//!    ([`Evidence`]): [`Classical`] from edges and shadows, [`Learned`] by a small network, [`NamedModel`] by a network
//!    that the user names, which may give fragments one by one instead.
//! 2. [`tree`]: a watershed cuts the photo into many small regions, which are joined one seam after
//!    another, the weakest first. All regions that ever were make a tree, and nearly every fragment is
//!    one of its nodes; which one, no single strength of seams tells.
//! 3. [`choice`]: every node gets a score, how likely it is a whole fragment (its seams against those
//!    within it, its shape, what its pixels vote for), and the best nodes that do not overlap are taken.
//!
//! [`Regions`] keeps the tree for who looks for another node by hand; `photo` leads from a flight's photo here and
//! on to its fragments, [`measures`] and [`mass`].

mod bare;
pub mod choice;
mod classical;
mod delineating;
mod engine;
mod engines;
mod evidence;
mod hull;
mod kept;
mod learned;
pub mod mass;
pub mod measures;
mod named;
mod network;
mod outlined_by;
pub mod overlap;
pub mod photo;
mod regions;
pub mod saved;
mod smoothing;
mod transposed;
pub mod tree;
mod votes;

pub use classical::Classical;
pub use delineating::{Delineated, LeftOut, delineate, delineated, leave_out};
pub use engine::{Engine, Habits, Outlined};
pub use engines::{ENGINES, engine_called};
pub use evidence::Evidence;
pub use fragscale_core::labels;
pub use fragscale_core::labels::{FINES, LabelImage, NOT_ROCK};
pub use learned::Learned;
pub use mass::{intervals, tail};
pub use named::{Description, NamedModel, ReadyEngine};
pub use outlined_by::{OutlinedBy, Outliner};
pub use regions::Regions;
pub use votes::{VoteSums, Votes};
