//! Tables: size distributions, groups of values, time effort, places.

pub(crate) mod effort_table;
pub(crate) mod grouped_values;
pub(crate) mod places;
pub mod size_distributions;
pub(crate) mod table;
