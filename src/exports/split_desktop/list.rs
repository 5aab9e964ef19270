//! The list of an export's files, `export.json`: what is ours in its folder, and of which flight it is.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::whose::FlightOfExport;

/// The list's file.
pub(super) const LIST: &str = "export.json";

/// `export.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct List {
    /// Says that the list is ours.
    pub(super) program: String,
    /// Which flight it is of; lists of earlier versions do not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) flight: Option<FlightOfExport>,
    /// By path below the folder, with slashes.
    pub(super) files: BTreeMap<String, Entry>,
}

/// A file of ours.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Entry {
    /// Of its contents, when it is written.
    pub(super) sha256: String,
    /// Of the contents that it is about to replace; both are ours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) replaces: Option<String>,
    /// What it was made from; see [`ExportFolder::is_done`](super::folder::ExportFolder::is_done).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) made_from: Option<String>,
}

pub(super) const PROGRAM: &str = "fragscale export for Split-Desktop, format 1";

/// The flight that a folder has an export of, where it is another one than that of `name` in `file`.
pub fn other_flight_in(folder: &Path, name: &str, file: &Path) -> Option<String> {
    let found = flight_of(folder)?;
    let own = FlightOfExport::new(name, file, folder);
    (!found.is(&own)).then(|| found.in_words())
}

/// The flight that the list in a folder is of, if it has one that says so.
fn flight_of(folder: &Path) -> Option<FlightOfExport> {
    let bytes = fs::read(folder.join(LIST)).ok()?;
    let list: List = serde_json::from_slice(&bytes).ok()?;
    list.flight.filter(|_| list.program == PROGRAM)
}
