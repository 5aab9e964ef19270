//! Results of all photos that are outlined, as a job: what the command `delineate` writes of outlines that are there.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::FragmentStep;
use super::outlined::{AllOutlined, Outlined, measured_each, sizes_of};
use crate::command::{Command, Destination};
use crate::delineation::OutlinedBy;
use crate::delineation::measures::SieveShape;
use crate::exports::{
    self, FRAGMENT_TABLES, FragmentTables, MapPlaces, MeasuredPhoto, PhotoOutlined,
};
use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind};
use crate::flight::{Flight, FlightSettings, LookedUp};
use crate::formats::read_bytes;
use crate::jobs::Progress;
use crate::opening::apart_from_photos;
use crate::picture::edge_spread;
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::units::LengthUnit;

impl Task {
    /// Writing the results of fragments.
    pub const EXPORT_FRAGMENTS: Self = Self::new("Exporting fragments").writing();
}

/// What was written, in words.
struct Written {
    sentence: String,
    warnings: Vec<String>,
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
        let gathered = open.all_outlined().and_then(|all| {
            apart_from_photos(&to.path, &open.files.photo_files)
                .map_err(|error| error.to_string())?;
            Ok(all)
        });
        let AllOutlined {
            outlined,
            mut warnings,
            ..
        } = match gathered {
            Ok(gathered) => gathered,
            Err(refused) => {
                self.say(Severity::Error, &refused);
                return;
            }
        };
        let folder = to.path.clone();
        let photos = outlined.iter();
        let photos = photos.flat_map(|of| exports::outlined_files(&folder, &of.stem));
        let tables = FRAGMENT_TABLES.map(|name| folder.join(name));
        let paths: Vec<PathBuf> = photos.chain(tables).collect();
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
        let photo = |of| self.photo(of, &places, units, progress);
        let (measured, said) = measured_each(&self.outlined, progress, photo)?;
        warnings.extend(said);
        let sizes = sizes_of(&measured, &self.flight, &self.looked_up, progress)?;
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
        let pixels = of.pixels(camera)?;
        let (labels, by, mut notes) = of.labels(&self.settings, posed, camera)?;
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
