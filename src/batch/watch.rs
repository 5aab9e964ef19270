//! Flights that arrive while one looks on: a flight is taken when its files have not changed for a while.
//!
//! What counts as a change is another name, size or time of a file in the flight's folder, or of one in the folder
//! that its file lies in. A flight that is taken, and changes later, is taken again; the checksums of its record say
//! what is done then. Looking is polling, which works on shared disks, too.

use std::collections::HashMap;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::season::SeasonFlight;

/// Files of a flight that are looked at; there is no flight of more.
const MOST_FILES: usize = 200_000;

/// What has arrived.
#[derive(Debug)]
pub struct Arrivals {
    /// How long nothing may have changed.
    settle: Duration,
    known: HashMap<PathBuf, Known>,
}

#[derive(Debug)]
struct Known {
    seen: Seen,
    /// Since when.
    since: Duration,
    is_taken: bool,
}

/// What the files of a flight look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seen(u64);

impl Seen {
    /// Of a flight as it is now.
    pub fn of(flight: &SeasonFlight) -> Self {
        let folder = |path: &Path| match path.is_dir() {
            true => path.to_owned(),
            false => path.parent().map(Path::to_owned).unwrap_or_default(),
        };
        let mut waiting = vec![folder(&flight.path)];
        let more = [&flight.surface, &flight.photos, &flight.reference];
        waiting.extend(more.into_iter().flatten().cloned());
        let mut files: Vec<(PathBuf, u64, Option<Duration>)> = Vec::new();
        while let Some(path) = waiting.pop() {
            let Ok(metadata) = fs::symlink_metadata(&path) else {
                continue;
            };
            if metadata.is_dir() {
                let entries = fs::read_dir(&path).into_iter().flatten().flatten();
                waiting.extend(entries.map(|entry| entry.path()));
            } else if files.len() < MOST_FILES {
                let time = metadata.modified().ok();
                let time = time.and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
                files.push((path, metadata.len(), time));
            }
        }
        files.sort();
        let mut hash = DefaultHasher::new();
        files.hash(&mut hash);
        Self(hash.finish())
    }
}

impl Arrivals {
    /// Nothing has arrived. A flight is taken once it has not changed for `settle`.
    pub fn new(settle: Duration) -> Self {
        Self {
            settle,
            known: HashMap::new(),
        }
    }

    /// Of the flights that are there `now` (since any beginning), with what they look like, those that are to be done:
    /// their places. And whether others are still arriving.
    pub fn look(&mut self, flights: &[(&Path, Seen)], now: Duration) -> (Vec<usize>, bool) {
        let mut taken = Vec::new();
        let mut arriving = false;
        for (place, (path, seen)) in flights.iter().enumerate() {
            let known = self.known.entry(path.to_path_buf()).or_insert(Known {
                seen: *seen,
                since: now,
                is_taken: false,
            });
            if known.seen != *seen {
                *known = Known {
                    seen: *seen,
                    since: now,
                    is_taken: false,
                };
            }
            if known.is_taken {
                continue;
            }
            if now.saturating_sub(known.since) >= self.settle {
                known.is_taken = true;
                taken.push(place);
            } else {
                arriving = true;
            }
        }
        // One that was taken away and comes again is a new one.
        self.known
            .retain(|path, _| flights.iter().any(|(there, _)| there == path));
        (taken, arriving)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_is_taken_when_it_is_quiet() {
        let mut arrivals = Arrivals::new(Duration::from_secs(10));
        let (a, b) = (Path::new("a"), Path::new("b"));
        let mut look = |flights: &[(&Path, u64)], second: u64| {
            let seen: Vec<_> = flights
                .iter()
                .map(|(path, seen)| (*path, Seen(*seen)))
                .collect();
            arrivals.look(&seen, Duration::from_secs(second))
        };
        assert_eq!(look(&[(a, 1)], 0), (vec![], true));
        assert_eq!(look(&[(a, 2)], 9), (vec![], true), "it grows");
        assert_eq!(look(&[(a, 2), (b, 1)], 18), (vec![], true));
        assert_eq!(look(&[(a, 2), (b, 1)], 19), (vec![0], true));
        assert_eq!(look(&[(a, 2), (b, 1)], 28), (vec![1], false), "once");
        assert_eq!(look(&[(a, 2), (b, 3)], 40), (vec![], true), "changed");
        assert_eq!(look(&[(a, 2), (b, 3)], 50), (vec![1], false));
        assert_eq!(look(&[(b, 3)], 60), (vec![], false));
        assert_eq!(look(&[(a, 2), (b, 3)], 70), (vec![], true), "came again");
    }

    #[test]
    fn changes_are_seen() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("photos")).unwrap();
        let flight = SeasonFlight {
            blast: "a".to_owned(),
            date: None,
            path: folder.path().to_owned(),
            surface: None,
            photos: None,
            reference: None,
            results: "a".to_owned(),
        };
        let empty = Seen::of(&flight);
        assert_eq!(Seen::of(&flight), empty);
        let photo = folder.path().join("photos/a.jpg");
        fs::write(&photo, "x").unwrap();
        let one = Seen::of(&flight);
        assert_ne!(one, empty);
        fs::write(&photo, "xy").unwrap();
        assert_ne!(Seen::of(&flight), one);
    }
}
