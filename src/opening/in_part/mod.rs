//! Flights whose cloud is larger than the memory: of it is read what the photos see, with the same numbers to the
//! last bit (`surface::part` says why).
//!
//! ```text
//! memory   how much may be used, and what a point takes; memory_size: as people write it
//! moving   the way of the cloud's points to the world
//! looking  what is known of the whole cloud before: the box, the hull, a sample
//! part     the points of the blocks that are needed
//! ```
//!
//! An octree (COPC, EPT) says where its nodes are: of it are read the coarsest, those at the rim of the cloud, which
//! may be corners of its hull, and those that the photos see. (It says its box itself, and is believed: a point
//! outside of it is refused. Read whole, the surface is laid out by the same box.) LAS and LAZ, and octrees whose
//! points have to be moved to the world, are looked through once; then each chunk's place is known, and of those under
//! the photos the points are kept. Where it turns out that more is needed, that is read as well and everything is
//! computed anew.
//!
//! Not done in part: thinning (what stays of a cell hangs on all of its points), and what needs all of the cloud (the
//! ground under a photo that shows no point of it). Not looked at: whether the photos have the cloud's colours, and
//! whether they count in another unit than the cloud, for where they would be then is not where they look.

mod looking;
mod memory;
mod memory_size;
mod moving;
mod part;

pub use self::memory::Memory;
pub use self::memory_size::{half_of_the_machines, memory_in_words, memory_size};
pub(crate) use self::moving::Moving;
pub(crate) use self::part::InPart;

#[cfg(test)]
mod tests;
