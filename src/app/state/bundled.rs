//! The flight that comes with the program.

use std::path::{Path, PathBuf};

/// The bundled flight: beside the program's sources, or beside the installed program.
pub fn sample_flight() -> Option<PathBuf> {
    let beside = std::env::current_exe().ok();
    let beside = beside.as_deref().and_then(Path::parent);
    let places = [
        Some(PathBuf::from(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../assets/sample"
        ))),
        beside.map(|folder| folder.join("assets/sample")),
        beside.map(|folder| folder.join("../share/fragscale/sample")),
    ];
    places
        .into_iter()
        .flatten()
        .find(|folder| folder.join("flight.toml").is_file())
}
