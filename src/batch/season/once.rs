//! A flight that is found in several ways is done once: as it is named by itself, for there more is said of it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::{SeasonFlight, naming};
use crate::fault::Fault;
use crate::files::FileError;

/// Flights in their order, each once.
#[derive(Debug, Default)]
pub(super) struct Once {
    flights: Vec<SeasonFlight>,
    /// Where each is among them, and whether it was named by itself.
    known: HashMap<PathBuf, (usize, bool)>,
}

impl Once {
    /// One more; whether the season names it by itself, and did not find it below a folder or by a pattern.
    ///
    /// # Errors
    /// Where it was named by itself before.
    pub(super) fn add(&mut self, flight: SeasonFlight, is_named: bool) -> Result<(), FileError> {
        let place = place_of(&flight.path);
        match self.known.get_mut(&place) {
            None => {
                self.known.insert(place, (self.flights.len(), is_named));
                self.flights.push(flight);
            }
            Some((_, true)) if is_named => {
                let fault = Fault::new("it is named twice", "name it once");
                return Err(FileError::new(&flight.path, fault));
            }
            Some((at, was_named)) if is_named => {
                *was_named = true;
                self.flights[*at] = flight;
            }
            Some(_) => {}
        }
        Ok(())
    }

    /// All of them.
    pub(super) fn flights(self) -> Vec<SeasonFlight> {
        self.flights
    }
}

/// Where a flight is, however it is named.
fn place_of(path: &Path) -> PathBuf {
    let path = match naming::meant(path) {
        here if here.as_os_str().is_empty() => Path::new("."),
        path => path,
    };
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
