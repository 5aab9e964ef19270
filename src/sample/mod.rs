//! The simulated lab: a flight with everything known, to hold what the program computes against.

pub mod files;
