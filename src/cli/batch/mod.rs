//! `fragscale batch`: many flights, each in a process of its own.
//!
//! ```text
//! arguments  what is asked for
//! all        the season: one line of progress for each flight, the tables, the exit status
//! flight     the process of one flight
//! steps      a step of a flight that is open, by the single command's own function
//! ```
//!
//! Exit status, besides those of all commands: 3 where some flights failed.

mod all;
mod arguments;
mod flight;
mod steps;

pub(super) use all::{batch, kept};
pub(super) use arguments::BatchArguments;
pub(super) use flight::flight;
