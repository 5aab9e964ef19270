//! Strips below the menu: what the flight's health is, and what was kept aside when the program ended badly.

mod health;
mod kept_aside;

pub use health::health;
pub use kept_aside::kept_aside;
