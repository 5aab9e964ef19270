//! What the flight on the screen was read from, and where it is saved.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::files::Inputs;
use crate::flight::FlightSettings;
use crate::kept_aside::KeptOf;
use crate::opening::{FlightOrigin, FlightReconstruction, OpenOptions, Opened, PhotoFile};
use crate::state::bundled::sample_flight;
use crate::surface::UpAxis;
use crate::tasks::stood::Stood;

/// The files of a flight.
#[derive(Debug)]
pub struct FlightFiles {
    /// What the user named.
    pub path: PathBuf,
    /// The surface and photos that were named beside it.
    pub options: OpenOptions,
    /// Of each photo.
    pub photo_files: Arc<Vec<PhotoFile>>,
    /// The photos that lie beside them and have no pose, in words.
    pub without_pose: Option<String>,
    /// The world's coordinate system where the files state one.
    pub crs: Option<String>,
    /// What the surface's triangles say is up, where that is not z.
    pub doubtful_up: Option<UpAxis>,
    /// The files read.
    pub inputs: Vec<PathBuf>,
    /// These, the photos and whatever was opened on the way: nothing of it is written over.
    pub read: Inputs,
    /// What was noticed while reading.
    pub warnings: Vec<String>,
    /// The flight.toml that it was opened from: it may be saved there.
    pub opened_file: Option<PathBuf>,
    /// Where it came from, and where it is saved.
    pub origin: FlightOrigin,
    /// Whether somebody named the folder of its photos, beside it or in its flight.toml, and no package led to it: then the folders
    /// in it are its own.
    pub photos_are_named: bool,
    /// The reconstruction that it was made of, if any.
    pub reconstruction: Option<FlightReconstruction>,
    /// Whether it is the flight that comes with the program, which stays as it came.
    pub bundled: bool,
    /// Whose changes it holds, where a window left them behind.
    pub kept: Option<KeptOf>,
    /// The settings in its flight.toml.
    pub saved: FlightSettings,
    /// The files that saving writes, as they were read or saved last.
    pub stood: Stood,
    /// The cloud, the poses and all else that it was made of, as they were read.
    pub read_as: Stood,
    /// Of which it was said that they are not what they were.
    pub said_changed: HashSet<PathBuf>,
}

impl FlightFiles {
    /// Of a flight that was just read.
    pub(crate) fn new(path: PathBuf, options: OpenOptions, opened: Opened) -> Self {
        let mut saved = opened
            .file
            .as_ref()
            .map_or_else(|| opened.settings.clone(), |(_, file)| file.settings());
        let in_file = opened.file.as_ref();
        let in_file = in_file.is_some_and(|(_, file)| file.photo_folder().is_some());
        let photos_are_named = options.photos.is_some() || in_file;
        // They are in a file of their own.
        saved.control.clone_from(&opened.settings.control);
        let bundled = is_bundled(&opened.origin.suggested_file());
        let kept = opened.origin.flight_file().and_then(KeptOf::beside);
        let stays = bundled || kept.is_some();
        let mut stood = Stood::default();
        if let Some(own) = opened.origin.flight_file() {
            stood.note_flight(own);
        }
        let mut read_as = Stood::default();
        // What saving writes is looked at when it is saved.
        let others = opened.inputs.iter().filter(|path| !stood.knows(path));
        for path in others.filter(|path| path.is_file()) {
            read_as.note(path);
        }
        Self {
            path,
            options,
            photo_files: Arc::new(opened.photo_files),
            without_pose: opened.without_pose,
            crs: opened.crs,
            doubtful_up: opened.doubtful_up,
            inputs: opened.inputs,
            read: opened.read,
            warnings: opened.warnings,
            opened_file: opened.file.map(|(path, _)| path).filter(|_| !stays),
            origin: opened.origin,
            photos_are_named,
            reconstruction: opened.reconstruction,
            bundled,
            kept,
            saved,
            stood,
            read_as,
            said_changed: HashSet::new(),
        }
    }
}

impl FlightFiles {
    /// Whether its flight.toml stays as it came: saving asks where to.
    pub fn stays(&self) -> bool {
        self.bundled || self.kept.is_some()
    }

    /// Where something is written if nobody says otherwise: `name` beside the flight's file, without a
    /// name that file. The bundled flight stays as it came: what is made of it goes to where the program
    /// was started.
    pub fn proposed(&self, name: Option<&str>) -> PathBuf {
        let file = match &self.kept {
            Some(kept) => kept.file.clone(),
            None => self.origin.suggested_file(),
        };
        let start = match name {
            _ if self.bundled => PathBuf::from(name.unwrap_or("sample-flight.toml")),
            Some(name) => file.with_file_name(name),
            None => file,
        };
        std::path::absolute(&start).unwrap_or(start)
    }
}

/// Whether a flight.toml is that of the bundled flight, however its path is written.
fn is_bundled(file: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let folder = file.parent().and_then(real);
    folder.is_some() && folder == sample_flight().as_deref().and_then(real)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jobs::Progress;
    use crate::opening::open_flight;

    fn photos_are_named(path: &str, photos: Option<&str>) -> bool {
        let at = |path: &str| fragscale_test_data::repository().join(path);
        let options = OpenOptions {
            photos: photos.map(at),
            ..OpenOptions::default()
        };
        let opened = open_flight(&at(path), &options, &Progress::default()).expect("a flight");
        FlightFiles::new(at(path), options, opened).photos_are_named
    }

    /// Below a folder to which a package leads lie other flights', too.
    #[test]
    fn photos_are_named_by_people_and_their_files() {
        assert!(photos_are_named("assets/sample/flight.toml", None));
        let package = "tests/fixtures/colmap-text-points/sparse/0";
        assert!(!photos_are_named(package, None));
        let package = "tests/fixtures/nvm-points-photos/model.nvm";
        let photos = "tests/fixtures/nvm-points-photos/my photos";
        assert!(photos_are_named(package, Some(photos)));
    }
}
