//! What a flight's results were made from: the record of a flight, `flight.json` in the folder of its results.
//!
//! It is written last, and marked as begun before anything of the flight is made again, so that where it stands
//! unmarked all results are there and whole. A flight is done again where the steps or their options are others, the program is
//! another version, a file that was read has another checksum, other files lie in the folders of those (a photo more
//! may be one of the flight), or a result is not there any more as it was written.
//!
//! Paths are those from the folder of the results where the two have more than the root in common, so that a season
//! can be moved with its flights. There is no time in it.

mod left_over;
mod place;

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub(crate) use left_over::write_failed;
pub use left_over::{remove_unfinished_below, remove_what_is_left};

use self::place::Place;
use crate::asked::Asked;
use crate::exports::FlightFindings;
use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind, cannot_be, sha256_of_file};
use crate::jobs::Progress;
use crate::told::FlightTold;

/// The record's file.
pub(crate) const NAME: &str = "flight.json";

/// A record that is larger is none of ours.
const LARGEST: u64 = 256 << 20;

/// The record of a flight that is done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Version of the record, and how one knows it.
    fragscale_batch: u32,
    /// Whether the flight is being made again: then the results are those of before, some of which may stand no more.
    #[serde(default, skip_serializing_if = "is_false")]
    begun: bool,
    /// Of the program.
    program: String,
    /// What was named, but for where.
    told: Named,
    /// The files that were read, with their checksums.
    inputs: BTreeMap<String, String>,
    /// The folders that they lie in, with checksums of the names in them.
    folders: BTreeMap<String, String>,
    /// What was written, by path below the folder of the results, with its checksums.
    results: BTreeMap<String, String>,
    /// What came of it.
    pub findings: FlightFindings,
}

/// What a flight was told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Named {
    flight: String,
    surface: Option<String>,
    photos: Option<String>,
    reference: Option<String>,
    asked: Asked,
}

const FORMAT: u32 = 1;

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn is_false(value: &bool) -> bool {
    !value
}

impl Record {
    /// Of a flight whose steps have all been done: the files that were `read` and `written`, in the folder of the
    /// results or elsewhere. `program` is its version.
    ///
    /// # Errors
    /// Where something that was read or written is not there any more, or the work was cancelled.
    pub fn of(
        told: &FlightTold,
        program: &str,
        read: &[PathBuf],
        written: &[PathBuf],
        findings: FlightFindings,
        progress: &Progress,
    ) -> Result<Self, FileError> {
        let place = Place::of(&told.to)?;
        progress.stage("taking checksums");
        let mut record = Self {
            fragscale_batch: FORMAT,
            begun: false,
            program: program.to_owned(),
            told: place.named(told)?,
            inputs: BTreeMap::new(),
            folders: BTreeMap::new(),
            results: BTreeMap::new(),
            findings,
        };
        let mut folders: BTreeSet<PathBuf> = BTreeSet::new();
        for path in read {
            // A step reads what an earlier one wrote, and finds what earlier runs left.
            let Ok(real) = fs::canonicalize(path) else {
                continue;
            };
            if real.starts_with(&place.to) {
                continue;
            }
            if real.is_dir() {
                folders.insert(real);
                continue;
            }
            let name = place.name(&real)?;
            if let Entry::Vacant(entry) = record.inputs.entry(name) {
                entry.insert(checksum(&real, progress)?);
            }
            folders.extend(real.parent().map(Path::to_owned));
        }
        for folder in folders {
            let sum = place.names_in(&folder)?;
            record.folders.insert(place.name(&folder)?, sum);
        }
        // Where it was begun again, its own record was written, too.
        let results = place.below(written).into_iter();
        for name in results.filter(|name| name != NAME) {
            let sum = checksum(&place.to.join(&name), progress)?;
            record.results.insert(name, sum);
        }
        Ok(record)
    }

    /// Writes it into the folder of the results.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self, to: &Path) -> Result<(), FileError> {
        let path = to.join(NAME);
        let at = |fault: Fault| FileError::new(&path, fault);
        let text = serde_json::to_string_pretty(self)
            .map_err(|error| at(Fault::new(error.to_string(), "report this")))?;
        let nothing = Inputs::default();
        files::write(
            &path,
            (text + "\n").as_bytes(),
            Kind::Result,
            &nothing,
            false,
        )
        .map_err(at)
    }

    /// The record in the folder of a flight's results, where there is one that can be read.
    pub fn in_folder(to: &Path) -> Option<Self> {
        let bytes = files::read_small(&to.join(NAME), LARGEST, "record", "").ok()?;
        let record: Self = serde_json::from_slice(&bytes).ok()?;
        (record.fragscale_batch == FORMAT).then_some(record)
    }

    /// Whether the same would come of it now: see the head of this file.
    ///
    /// # Errors
    /// Where the work was cancelled.
    pub fn still_holds(
        &self,
        told: &FlightTold,
        program: &str,
        progress: &Progress,
    ) -> Result<bool, Fault> {
        let Ok(place) = Place::of(&told.to) else {
            return Ok(false);
        };
        if self.begun
            || self.program != program
            || place.named(told).ok().as_ref() != Some(&self.told)
        {
            return Ok(false);
        }
        progress.stage("comparing checksums");
        let folders = self.folders.iter();
        let mut folders = folders.map(|(name, sum)| (place.to.join(name), sum));
        if folders.any(|(folder, sum)| place.names_in(&folder).ok().as_ref() != Some(sum)) {
            return Ok(false);
        }
        let count = (self.inputs.len() + self.results.len()) as u64;
        let all = self.inputs.iter().chain(&self.results);
        for (number, (name, sum)) in all.enumerate() {
            progress.advance(number as u64, count)?;
            match checksum(&place.to.join(name), progress) {
                Ok(now) if now == *sum => {}
                _ => {
                    // On a cancel it says so.
                    progress.advance(number as u64, count)?;
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// Says that the flight is made again, where there is a record: from now on it is not done. Returns the results of
    /// before.
    ///
    /// # Errors
    /// Where the record cannot be written.
    pub fn begin(to: &Path) -> Result<BTreeMap<String, String>, FileError> {
        let Some(mut record) = Self::in_folder(to) else {
            return Ok(BTreeMap::new());
        };
        if !record.begun {
            record.begun = true;
            record.write(to)?;
        }
        Ok(record.results)
    }
}

fn checksum(path: &Path, progress: &Progress) -> Result<String, FileError> {
    sha256_of_file(path, || progress.is_cancelled())
        .map_err(|error| FileError::new(path, cannot_be("read", &error)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asked::Step;

    /// A flight with results, all of them letters.
    pub(super) struct Flight {
        root: tempfile::TempDir,
        pub(super) told: FlightTold,
    }

    pub(super) fn flight() -> Flight {
        let root = tempfile::tempdir().unwrap();
        let at = |name: &str| root.path().join(name);
        for folder in ["flight/photos", "out/a/maps"] {
            fs::create_dir_all(at(folder)).unwrap();
        }
        for (name, text) in [
            ("flight/flight.toml", "x"),
            ("flight/pile.ply", "points"),
            ("flight/photos/1.jpg", "photo"),
            (
                "out/a/scales.csv",
                "photo,width_px,height_px,top_px_per_cm,note\n",
            ),
            ("out/a/maps/1.tif", "map"),
        ] {
            fs::write(at(name), text).unwrap();
        }
        let told = FlightTold {
            flight: at("flight"),
            surface: None,
            photos: None,
            reference: None,
            to: at("out/a"),
            asked: Asked::default(),
            force: false,
        };
        Flight { root, told }
    }

    impl Flight {
        fn at(&self, name: &str) -> PathBuf {
            self.root.path().join(name)
        }

        pub(super) fn record(&self) {
            let read = [
                "flight/flight.toml",
                "flight/pile.ply",
                "flight/photos/1.jpg",
            ];
            let read = read.map(|name| self.at(name));
            let written = ["out/a/scales.csv", "out/a/maps/1.tif"].map(|name| self.at(name));
            let findings = FlightFindings {
                photos: 1,
                ..FlightFindings::default()
            };
            let progress = Progress::default();
            let record = Record::of(&self.told, "1", &read, &written, findings, &progress);
            record.unwrap().write(&self.told.to).unwrap();
        }

        fn holds(&self) -> bool {
            let record = Record::in_folder(&self.told.to);
            let holds = record.map(|of| of.still_holds(&self.told, "1", &Progress::default()));
            holds.is_some_and(|holds| holds.unwrap())
        }
    }

    type Change = fn(&mut Flight);

    #[test]
    fn a_flight_is_done_until_something_changes() {
        let changes: [(&str, Change); 9] = [
            ("the cloud", |of| {
                fs::write(of.at("flight/pile.ply"), "pointz").unwrap()
            }),
            ("a photo is gone", |of| {
                fs::remove_file(of.at("flight/photos/1.jpg")).unwrap()
            }),
            ("a photo more", |of| {
                fs::write(of.at("flight/photos/2.jpg"), "").unwrap()
            }),
            ("a result is gone", |of| {
                fs::remove_file(of.at("out/a/maps/1.tif")).unwrap()
            }),
            ("a result", |of| {
                fs::write(of.at("out/a/maps/1.tif"), "mao").unwrap()
            }),
            ("the steps", |of| of.told.asked = Asked::of(&[Step::Scales])),
            ("the unit", |of| of.told.asked.unit = "m".to_owned()),
            ("the surface", |of| {
                of.told.surface = Some(of.at("flight/pile.ply"))
            }),
            ("outlines are saved", |of| {
                fs::create_dir(of.at("flight/fragments")).unwrap();
                fs::write(of.at("flight/fragments/1.png"), "").unwrap();
            }),
        ];
        for (what, change) in changes {
            let mut flight = flight();
            assert!(!flight.holds());
            flight.record();
            assert!(flight.holds(), "{what}");
            change(&mut flight);
            assert!(!flight.holds(), "{what}");
        }
        let flight = flight();
        flight.record();
        let record = Record::in_folder(&flight.told.to).unwrap();
        let holds = |program| record.still_holds(&flight.told, program, &Progress::default());
        assert_eq!((holds("1"), holds("2")), (Ok(true), Ok(false)));
        let cancelled = Progress::default();
        cancelled.cancel();
        assert!(record.still_holds(&flight.told, "1", &cancelled).is_err());
        // Times do not count, nor do files that nobody read.
        fs::write(flight.at("flight/pile.ply"), "points").unwrap();
        fs::write(flight.at("out/a/notes.txt"), "mine").unwrap();
        fs::write(flight.at("flight/photos/.DS_Store"), "").unwrap();
        assert!(flight.holds());
        // Nor where all of it lies.
        let text = fs::read_to_string(flight.at("out/a/flight.json")).unwrap();
        assert!(
            !text.contains(&*flight.root.path().to_string_lossy()),
            "{text}"
        );
        assert!(text.contains("\"../../flight/pile.ply\": \""), "{text}");
        assert!(files::is_own_result(text.as_bytes()));
    }

    #[test]
    fn a_begun_flight_is_not_done() {
        let flight = flight();
        flight.record();
        let before = Record::begin(&flight.told.to).unwrap();
        assert_eq!(before.len(), 2);
        assert!(!flight.holds());
        // Killed, and begun again.
        assert_eq!(Record::begin(&flight.told.to).unwrap(), before);
    }
}
