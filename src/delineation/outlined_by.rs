//! What outlined a photo's fragments.

use crate::engine::Engine;

/// What outlined a photo's fragments.
#[derive(Clone, Copy)]
pub enum OutlinedBy<'a> {
    /// This one, just now.
    Engine(&'a dyn Engine),
    /// This one, and then a person in the window; `None` where it is not known any more.
    Saved(Option<&'a dyn Engine>),
    /// Another tool.
    Masks,
}

impl<'a> OutlinedBy<'a> {
    /// The engine, whose limit, steps and doubts hold; `None` of outlines of people and other tools.
    pub fn engine(self) -> Option<&'a dyn Engine> {
        match self {
            Self::Engine(engine) => Some(engine),
            Self::Saved(engine) => engine,
            Self::Masks => None,
        }
    }

    /// As it is named in files.
    pub fn method(self) -> &'a str {
        match self {
            Self::Engine(engine) => engine.name(),
            Self::Saved(_) => "saved",
            Self::Masks => "masks",
        }
    }
}
