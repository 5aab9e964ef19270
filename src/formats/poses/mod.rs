//! Poses and positions in lists.

pub(crate) mod poses_csv;
pub(crate) mod poses_opk;
pub mod position_list;
pub(crate) mod rounded_rotation;
pub mod trajectory;
