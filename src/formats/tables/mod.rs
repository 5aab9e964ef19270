//! Tables: size distributions, groups of values, time effort.

pub(crate) mod effort_table;
pub(crate) mod grouped_values;
pub mod size_distributions;
pub(crate) mod table;
