//! Poses and positions in lists.

mod odd_angles;
pub(crate) mod poses_csv;
pub(crate) mod poses_opk;
pub mod position_list;
pub(crate) mod rounded_rotation;
pub mod trajectory;
