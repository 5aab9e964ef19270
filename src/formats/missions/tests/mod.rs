//! Real files against numbers that were taken from them with Python, bad ones against what must be said,
//! and damaged ones.

mod damaged;
mod dji;
mod mutated;
mod others;

use fragscale_core::plan::{Above, Mission, Stop};

use super::{MissionFile, read_mission};
use fragscale_test_data::{shared_data, written};

/// A file of the shared missions, read.
fn shared(name: &str) -> Option<MissionFile> {
    let path = shared_data(&format!("missions/{name}"))?;
    Some(read_mission(&path).unwrap_or_else(|error| panic!("{error}")))
}

/// Latitude, longitude and height of a stop.
fn place(stop: &Stop) -> (f64, f64, f64) {
    (stop.latitude, stop.longitude, stop.height.metres)
}

fn photos(mission: &Mission) -> Vec<usize> {
    let stops = mission.stops.iter().enumerate();
    let shot = stops.filter(|(_, stop)| stop.photo.is_some());
    shot.map(|(index, _)| index).collect()
}

fn all_above(mission: &Mission, above: Above) -> bool {
    mission.stops.iter().all(|stop| stop.height.above == above)
}

fn said(file: &MissionFile, part: &str) -> bool {
    file.notes.iter().any(|note| note.contains(part))
}

/// What is wrong with a file of this content.
fn refused(name: &str, content: impl AsRef<[u8]>) -> String {
    let (_folder, path) = written(name, content);
    let error = read_mission(&path).expect_err("a fault").to_string();
    assert_eq!(error.lines().count(), 1, "{error}");
    let at = error.find(name).expect("the file's name");
    error[at..].to_owned()
}
