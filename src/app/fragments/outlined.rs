//! The photos that are outlined, on the screen or in files, as a job takes them along.

use std::path::PathBuf;
use std::sync::Arc;

use image::RgbImage;

use crate::camera::Camera;
use crate::delineation::mass::WantedSteps;
use crate::delineation::{Outliner, photo};
use crate::exports::{self, FragmentSizes, MassWay, MeasuredPhoto};
use crate::fault::{Fault, by_cause};
use crate::flight::{Flight, FlightSettings, LookedUp, Photo};
use crate::jobs::Progress;
use crate::labels::{self, LabelImage};
use crate::open_flight::OpenFlight;
use crate::opening::{read_outlines, saved_outlines};
use crate::size_distributions::MadeOf;
use crate::tasks::photos::read_photo;

/// Where a photo's outlines are.
enum Outlines {
    /// On the screen: as they are now, and what outlined them first.
    Now(Arc<labels::Outlines>, Outliner),
    /// In files beside flight.toml.
    Saved([PathBuf; 2]),
}

/// A photo that is outlined.
pub(super) struct Outlined {
    /// Its place in the flight.
    pub(super) index: usize,
    pub(super) name: String,
    /// What its files are called.
    pub(super) stem: String,
    file: Option<PathBuf>,
    outlines: Outlines,
}

/// All of them.
pub(super) struct AllOutlined {
    /// In the order of the flight, without those that the review leaves out.
    pub(super) outlined: Vec<Outlined>,
    /// How many photos the flight has.
    pub(super) of: usize,
    /// Which are left out, a sentence each.
    pub(super) warnings: Vec<String>,
}

/// Measures photo by photo; with what is to be said of their outlines.
pub(super) fn measured_each<'a>(
    outlined: &'a [Outlined],
    progress: &Progress,
    mut photo: impl FnMut(&'a Outlined) -> Result<(MeasuredPhoto<'a>, Vec<String>), String>,
) -> Result<(Vec<MeasuredPhoto<'a>>, Vec<String>), String> {
    let mut measured = Vec::new();
    let mut said: Vec<(&str, String)> = Vec::new();
    for (done, of) in outlined.iter().enumerate() {
        progress.stage(format!("measuring the fragments of {}", of.name));
        let advanced = progress.advance(done as u64, outlined.len() as u64);
        advanced.map_err(|fault| fault.to_string())?;
        let (photo, notes) = photo(of)?;
        said.extend(notes.into_iter().map(|note| (of.name.as_str(), note)));
        measured.push(photo);
    }
    Ok((measured, by_cause(said, "photos")))
}

/// What they come to, by the usual way to the mass.
pub(super) fn sizes_of<'a>(
    measured: &'a [MeasuredPhoto<'a>],
    flight: &Arc<Flight>,
    looked_up: &LookedUp,
    progress: &Progress,
) -> Result<FragmentSizes<'a>, String> {
    let way = MassWay {
        steps: WantedSteps::default(),
        tail: None,
    };
    let sizes = FragmentSizes::of(measured, &way, flight, looked_up, progress);
    sizes.map_err(|fault| fault.to_string())
}

impl Outlined {
    /// Why nothing came of it.
    pub(super) fn failed(&self, fault: &Fault) -> String {
        format!("photo '{}': {fault}", self.name)
    }

    /// The photo without its lens' distortion, at its full size.
    pub(super) fn pixels(&self, camera: &Camera) -> Result<RgbImage, String> {
        let missing = || format!("the file of photo '{}' is not there", self.name);
        let pixels = read_photo(self.file.as_deref().ok_or_else(missing)?)?;
        photo::undistorted(&pixels, camera).map_err(|fault| self.failed(&fault))
    }

    /// Its outlines without the scale objects, what outlined them, and what is to be said of them.
    pub(super) fn labels(
        &self,
        settings: &FlightSettings,
        posed: &Photo,
        camera: &Camera,
    ) -> Result<(LabelImage, Outliner, Vec<String>), String> {
        let (mut labels, by, mut notes) = match &self.outlines {
            Outlines::Now(now, by) => (now.labels().clone(), by.clone(), Vec::new()),
            Outlines::Saved(files) => {
                let read = read_outlines(files, &self.name, camera, self.file.as_deref())
                    .map_err(|error| error.to_string())?;
                (read.outlines.into_labels(), read.by, read.notes)
            }
        };
        let taken_off = photo::take_off_objects(&mut labels, settings, posed, camera);
        notes.extend(taken_off.note);
        Ok((labels, by, notes))
    }
}

impl OpenFlight {
    /// The photos that are outlined and not left out.
    ///
    /// # Errors
    /// In words: where there is none, all are left out, or nobody states the unit.
    pub(super) fn all_outlined(&self) -> Result<AllOutlined, String> {
        let parts = self.flight().parts();
        if !parts.unit_known {
            let why = "the model is in a frame of its own, whose unit nobody states: georeference it first";
            return Err(why.to_owned());
        }
        let all: Vec<usize> = (0..parts.photos.len()).collect();
        let decisions = self.settings().decisions;
        let (photos, left_out) = self
            .flight()
            .without_left_out(all, &decisions)
            .map_err(|fault| fault.to_string())?;
        let outlined = self.outlined(&photos);
        if outlined.is_empty() {
            return Err("no photo is outlined yet: outline one or more first".to_owned());
        }
        let mut warnings: Vec<String> = left_out.into_iter().collect();
        let not_outlined = photos.len() - outlined.len();
        if not_outlined > 0 {
            warnings.push(format!(
                "{not_outlined} of {} photos are not outlined, and are left out",
                photos.len()
            ));
        }
        Ok(AllOutlined {
            outlined,
            of: parts.photos.len(),
            warnings,
        })
    }

    fn outlined(&self, photos: &[usize]) -> Vec<Outlined> {
        let own = self.files.origin.flight_file();
        let stems = exports::photo_file_stems(self.flight());
        let stems = stems.into_iter().enumerate();
        stems
            .filter(|(index, _)| photos.contains(index))
            .filter_map(|(index, stem)| {
                let outlines = match self.fragments.of(index) {
                    Some(of) => Outlines::Now(of.editing.shared(), of.by().clone()),
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

    /// What the sizes of all fragments would be made of now.
    pub fn fragments_made_of(&self) -> MadeOf {
        let settings = self.settings();
        let revisions = self.fragments.photos.iter();
        let revisions = revisions.filter(|(_, of)| !of.is_as_read());
        let objects = settings.scale_objects.into_iter();
        MadeOf {
            revisions: revisions.map(|(photo, of)| (*photo, of.revision)).collect(),
            objects: objects.filter(|object| object.mask).collect(),
            decisions: settings.decisions,
            unit: self.flight().parts().unit,
        }
    }
}
