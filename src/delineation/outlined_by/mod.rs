//! What outlined a photo's fragments.

mod outliner;

pub use outliner::Outliner;

use crate::engine::{Engine, Habits};

/// What outlined a photo's fragments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OutlinedBy<'a> {
    /// An engine, just now.
    Engine {
        /// As it is named in files.
        name: &'a str,
        /// How it errs in this photo.
        habits: Habits,
    },
    /// An engine that errs so, and then a person in the window; `None` of people and other tools, or where it is not known
    /// any more.
    Saved(Option<Habits>),
    /// Another tool.
    Masks,
}

impl<'a> OutlinedBy<'a> {
    /// This engine, in a photo of that size.
    pub fn engine(engine: &'a dyn Engine, width: u32, height: u32) -> Self {
        Self::Engine {
            name: engine.name(),
            habits: engine.habits(width, height),
        }
    }

    /// How the engine errs, whose limit, steps and doubts hold; `None` of outlines of people and other tools.
    pub fn habits(self) -> Option<Habits> {
        match self {
            Self::Engine { habits, .. } => Some(habits),
            Self::Saved(habits) => habits,
            Self::Masks => None,
        }
    }

    /// As it is named in files.
    pub fn method(self) -> &'a str {
        match self {
            Self::Engine { name, .. } => name,
            Self::Saved(_) => "saved",
            Self::Masks => "masks",
        }
    }
}
