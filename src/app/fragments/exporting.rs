//! Results of all photos that are outlined, as a job: what the command `delineate` writes of outlines that are there.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::FragmentStep;
use crate::command::{Command, Destination};
use crate::delineation::mass::WantedSteps;
use crate::delineation::measures::SieveShape;
use crate::delineation::{OutlinedBy, Outliner, photo};
use crate::exports::{
    self, FRAGMENT_TABLES, FragmentSizes, FragmentTables, MapPlaces, MassWay, MeasuredPhoto,
    PhotoOutlined,
};
use crate::fault::{Fault, by_cause};
use crate::files::{self, FileError, Inputs, Kind};
use crate::flight::{Flight, FlightSettings, LookedUp};
use crate::formats::read_bytes;
use crate::jobs::Progress;
use crate::labels::LabelImage;
use crate::open_flight::OpenFlight;
use crate::opening::{apart_from_photos, read_outlines, saved_outlines};
use crate::picture::edge_spread;
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::tasks::photos::read_photo;
use crate::units::LengthUnit;

impl Task {
    /// Writing the results of fragments.
    pub const EXPORT_FRAGMENTS: Self = Self::new("Exporting fragments").writing();
}

/// Where a photo's outlines are.
enum Outlines {
    /// On the screen: as they are now, and what outlined them first.
    Now(LabelImage, Outliner),
    /// In files beside flight.toml.
    Saved([PathBuf; 2]),
}

/// A photo that is outlined.
struct Outlined {
    index: usize,
    name: String,
    stem: String,
    file: Option<PathBuf>,
    outlines: Outlines,
}

impl Outlined {
    /// Why nothing came of it.
    fn failed(&self, fault: &Fault) -> String {
        format!("photo '{}': {fault}", self.name)
    }
}

/// What was written, in words.
struct Written {
    sentence: String,
    warnings: Vec<String>,
}

impl OpenFlight {
    /// Those of the photos that are outlined, on the screen or in files.
    fn outlined(&self, photos: &[usize]) -> Vec<Outlined> {
        let own = self.files.origin.flight_file();
        let stems = exports::photo_file_stems(self.flight());
        let stems = stems.into_iter().enumerate();
        stems
            .filter(|(index, _)| photos.contains(index))
            .filter_map(|(index, stem)| {
                let outlines = match self.fragments.of(index) {
                    Some(of) => Outlines::Now(of.now().labels().clone(), of.by().clone()),
                    None => Outlines::Saved(saved_outlines(own?, &stem)?),
                };
                let file = self.files.photo_files.get(index).cloned();
                Some(Outlined {
                    index,
                    name: self.name(index).to_owned(),
                    stem,
                    file: file.unwrap_or_default().path,
                    outlines,
                })
            })
            .collect()
    }
}

impl State {
    /// Writes the results of all photos that are outlined; asks before files are replaced.
    pub(super) fn export_fragments(&mut self, to: Destination) {
        self.asking = None;
        if self.is_busy(Task::EXPORT_FRAGMENTS) {
            return;
        }
        let Some(open) = &self.open else {
            return;
        };
        let parts = open.flight().parts();
        let all: Vec<usize> = (0..parts.photos.len()).collect();
        let decisions = open.settings().decisions;
        let (photos, left_out) = match open.flight().without_left_out(all, &decisions) {
            Ok(found) => found,
            Err(fault) => {
                self.say(Severity::Error, &fault.to_string());
                return;
            }
        };
        let count = photos.len();
        let outlined = open.outlined(&photos);
        let refused = match (parts.unit_known, outlined.is_empty()) {
            (false, _) => Some(
                "the model is in a frame of its own, whose unit nobody states: georeference it first".to_owned(),
            ),
            (_, true) => Some("no photo is outlined yet: outline one or more first".to_owned()),
            _ => apart_from_photos(&to.path, &open.files.photo_files)
                .err()
                .map(|error| error.to_string()),
        };
        if let Some(refused) = refused {
            self.say(Severity::Error, &refused);
            return;
        }
        let folder = to.path.clone();
        let photos = outlined.iter();
        let photos = photos.flat_map(|of| exports::outlined_files(&folder, &of.stem));
        let tables = FRAGMENT_TABLES.map(|name| folder.join(name));
        let paths: Vec<PathBuf> = photos.chain(tables).collect();
        let mut warnings: Vec<String> = left_out.into_iter().collect();
        if outlined.len() < count {
            warnings.push(format!(
                "{} of {count} photos are not outlined, and are left out",
                count - outlined.len()
            ));
        }
        let those: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
        warnings.extend(exports::left_over(&folder, &those));
        let export = Export {
            folder,
            replace: to.replace,
            read: self.read(),
            outlined,
            flight: open.flight().clone(),
            crs: open.files.crs.clone(),
            looked_up: open.review.looked_up().clone(),
            settings: open.settings(),
            unit: self.preferences.unit(),
            warnings,
        };
        let command = |to| Command::Fragments(FragmentStep::Export(to));
        if !self.may_write_all(&to, &paths, Kind::Result, &export.read.clone(), command) {
            return;
        }
        let work = move |progress: &Progress| export.write(progress);
        self.start(
            Task::EXPORT_FRAGMENTS,
            work,
            |state, written| match written {
                Ok(written) => {
                    for warning in &written.warnings {
                        state.say(Severity::Warning, warning);
                    }
                    state.say(Severity::Note, &written.sentence);
                }
                Err(message) => state.say(Severity::Error, &message),
            },
        );
    }
}

/// All that the job needs.
struct Export {
    folder: PathBuf,
    /// Whether files may be replaced.
    replace: bool,
    read: Inputs,
    outlined: Vec<Outlined>,
    flight: Arc<Flight>,
    crs: Option<String>,
    looked_up: LookedUp,
    settings: FlightSettings,
    /// Of what is written.
    unit: LengthUnit,
    warnings: Vec<String>,
}

impl Export {
    /// Measures photo by photo and writes what the command writes.
    fn write(self, progress: &Progress) -> Result<Written, String> {
        let parts = self.flight.parts();
        let world = parts.unit;
        let units = [world, self.unit];
        let in_words = |fault: Fault| fault.to_string();
        let places = MapPlaces::new(self.crs.as_deref(), world);
        let mut warnings = self.warnings.clone();
        warnings.extend(places.fault().map(|fault| fault.to_string()));
        files::make_folder(&self.folder).map_err(|error| error.to_string())?;
        let mut measured = Vec::new();
        let mut said: Vec<(&str, String)> = Vec::new();
        let count = self.outlined.len() as u64;
        for (done, of) in self.outlined.iter().enumerate() {
            progress.stage(format!("measuring the fragments of {}", of.name));
            progress.advance(done as u64, count).map_err(in_words)?;
            let (photo, notes) = self.photo(of, &places, units, progress)?;
            said.extend(notes.into_iter().map(|note| (of.name.as_str(), note)));
            measured.push(photo);
        }
        warnings.extend(by_cause(said, "photos"));
        let way = MassWay {
            steps: WantedSteps::default(),
            tail: None,
        };
        let sizes = FragmentSizes::of(&measured, &way, &self.flight, &self.looked_up, progress);
        let sizes = sizes.map_err(in_words)?;
        warnings.extend(sizes.warnings());
        let of_tables = FragmentTables {
            flight: &parts.name,
            units,
            tail: None,
            warnings: &warnings,
        };
        let picture = |name: &str| read_bytes(&self.folder.join(name)).map_err(|error| error.fault);
        let tables = exports::fragment_tables(&of_tables, &measured, &sizes, picture);
        for (name, bytes) in FRAGMENT_TABLES.iter().zip(tables.map_err(in_words)?) {
            self.write_file(&self.folder.join(name), &bytes)?;
        }
        let photos = if measured.len() == 1 {
            "photo"
        } else {
            "photos"
        };
        Ok(Written {
            sentence: format!(
                "{}: fragments of {} {photos} written",
                self.folder.display(),
                measured.len()
            ),
            warnings,
        })
    }

    /// Measures a photo and writes its files; with what was mended in its outlines.
    fn photo<'a>(
        &'a self,
        of: &'a Outlined,
        places: &MapPlaces,
        units: [LengthUnit; 2],
        progress: &Progress,
    ) -> Result<(MeasuredPhoto<'a>, Vec<String>), String> {
        let failed = |fault: Fault| of.failed(&fault);
        let posed = &self.flight.parts().photos[of.index];
        let camera = self.flight.camera(posed);
        let missing = || format!("the file of photo '{}' is not there", of.name);
        let pixels = read_photo(of.file.as_deref().ok_or_else(missing)?)?;
        let pixels = photo::undistorted(&pixels, camera).map_err(failed)?;
        let (mut labels, by, mut notes) = match &of.outlines {
            Outlines::Now(labels, by) => (labels.clone(), by.clone(), Vec::new()),
            Outlines::Saved(files) => {
                let read = read_outlines(files, &of.name, camera, of.file.as_deref())
                    .map_err(|error| error.to_string())?;
                (read.outlines.into_labels(), read.by, read.notes)
            }
        };
        notes.extend(photo::take_off_objects(
            &mut labels,
            &self.settings,
            posed,
            camera,
        ));
        // Of outlines of other tools nobody has measured it yet.
        let spread = by.spread.or_else(|| edge_spread(&pixels));
        let outlined = OutlinedBy::Saved(by.habits);
        let written = PhotoOutlined {
            flight: &self.flight,
            index: of.index,
            pixels: &pixels,
            labels: &labels,
            by: outlined,
            spread,
            shape: SieveShape::Calibrated,
        };
        let made = written.measured(places, units, progress).map_err(failed)?;
        notes.extend(made.notes);
        let paths = exports::outlined_files(&self.folder, &of.stem);
        for (path, bytes) in paths.iter().zip(made.bytes) {
            self.write_file(path, &bytes)?;
        }
        let measured = MeasuredPhoto {
            photo: &of.name,
            fragments: made.fragments,
            outlined,
            spread,
            index: of.index,
            stem: &of.stem,
        };
        Ok((measured, notes))
    }

    fn write_file(&self, path: &Path, bytes: &[u8]) -> Result<(), String> {
        files::write(path, bytes, Kind::Result, &self.read, self.replace)
            .map_err(|fault| FileError::new(path, fault).to_string())
    }
}
