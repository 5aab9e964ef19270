//! The engines that the program brings along.

use crate::classical::Classical;
use crate::engine::Engine;
use crate::learned::Learned;

/// All engines that the program brings along; the first is the one that measured best.
pub static ENGINES: [&dyn Engine; 2] = [&Learned, &Classical];

/// The engine that is called so in files; `None` for outlines of other tools.
pub fn engine_called(name: &str) -> Option<&'static dyn Engine> {
    ENGINES.into_iter().find(|engine| engine.name() == name)
}
