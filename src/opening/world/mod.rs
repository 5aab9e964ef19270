//! One frame for a flight: what a package wrote and what lies in the surface's file are brought to
//! the world's coordinate system before any ray is cast.

mod choice;
mod frame;
mod not_on_map;
mod unstated_surface;
mod way;

pub(crate) use choice::{Known, NoWorld, place_of_flight};
pub(crate) use frame::{WorldFrame, is_one_ellipsoidal};
pub(crate) use not_on_map::not_on_its_map;
pub(crate) use unstated_surface::taken_to_be_in;
pub(crate) use way::Way;
