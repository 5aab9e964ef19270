//! The panels of the flight plan: what is asked for at the left, what the photos will show at the right.
//!
//! ```text
//! asked   fields of what is asked for
//! flown   a mission against the flight that came of it
//! found   what the plan comes to, and what it lacks; why there is none
//! places  areas, take-off, photos by hand
//! photos  the planned photos, and the one that is looked at
//! ```

mod asked;
mod flown;
mod found;
mod photos;
mod places;

pub use asked::asked_of_plan;
pub use photos::planned_photos;
