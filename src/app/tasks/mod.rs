//! Long work of the window.

pub mod opening;
pub mod work;
