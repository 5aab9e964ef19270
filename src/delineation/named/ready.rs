//! An engine of the program or the user's, ready to look at photos.

use std::sync::Arc;

use super::NamedModel;
use crate::engine::Engine;

/// An engine that is ready.
#[derive(Clone)]
pub enum ReadyEngine {
    /// One that the program brings along.
    BroughtAlong(&'static dyn Engine),
    /// The user's.
    Named(Arc<NamedModel>),
}

impl ReadyEngine {
    /// The engine itself.
    pub fn engine(&self) -> &dyn Engine {
        match self {
            Self::BroughtAlong(engine) => *engine,
            Self::Named(model) => &**model,
        }
    }
}
