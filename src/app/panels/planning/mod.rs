//! The panels of the flight plan: what is asked for at the left, what the photos will show at the right.
//!
//! ```text
//! asked   fields of what is asked for
//! found   what the plan comes to, and what it lacks
//! photos  the planned photos, and the one that is looked at
//! ```

mod asked;
mod found;
mod photos;

pub use asked::asked_of_plan;
pub use photos::planned_photos;
