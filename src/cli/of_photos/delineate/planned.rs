//! Which photos are outlined, and the files that are written of them: all that is known before the first is begun.

use std::path::{Path, PathBuf};

use super::DelineateArguments;
use super::chosen_engine::ChosenEngine;
use super::maker::saved_files;
use super::masks_arguments::with_outlines;
use super::outliners::Outliners;
use super::written_outlines::WrittenOutlines;
use crate::cli::of_photos::chosen_photos::ChosenPhotos;
use crate::cli::outputs::Outputs;
use crate::exports::{self, FRAGMENT_TABLES};
use crate::fault::Fault;
use crate::opening::{Opened, apart_from_photos};

/// The photos and their files.
pub(super) struct Planned {
    pub(super) photos: ChosenPhotos,
    /// The photos, as places in the flight.
    pub(super) chosen: Vec<usize>,
    /// Of each: label image, outlines over the photo and in the world.
    pub(super) own: Vec<[PathBuf; 3]>,
    /// What the files of each photo of the flight are called.
    pub(super) stems: Vec<String>,
    /// The files of all photos together.
    pub(super) tables: [PathBuf; FRAGMENT_TABLES.len()],
    /// What of the photos and the folder she should know.
    pub(super) warnings: Vec<String>,
}

impl Planned {
    /// What is asked for.
    ///
    /// # Errors
    /// Where there is no such photo, or a file may not be written.
    pub(super) fn of(
        arguments: &DelineateArguments,
        outliners: &Outliners,
        opened: &Opened,
        written: &WrittenOutlines<'_>,
        outputs: &Outputs<'_>,
    ) -> Result<Self, String> {
        let to = &arguments.to;
        apart_from_photos(to, &opened.photo_files).map_err(|error| error.to_string())?;
        let flight = &opened.flight;
        let in_flight = |fault| arguments.flight.wrong(fault);
        let photos = ChosenPhotos::named_or_all(arguments.photo.clone());
        let mut chosen = photos.of(flight).map_err(in_flight)?;
        let mut warnings = Vec::new();
        if photos.are_all() {
            let decisions = &opened.settings.decisions;
            let (with, said) = flight
                .without_left_out(chosen, decisions)
                .map_err(in_flight)?;
            chosen = with;
            warnings.extend(said);
        }
        if let (Some(others), true) = (&outliners.others, photos.are_all()) {
            let (with, said) = with_outlines(others, chosen, flight);
            chosen = with;
            warnings.extend(said);
        }
        let stems = exports::photo_file_stems(flight);
        if arguments.engine == Some(ChosenEngine::Saved) {
            let (with, said) = with_saved(opened, chosen, &stems).map_err(in_flight)?;
            chosen = with;
            warnings.extend(said);
        }
        let of_photo = |index: &usize| exports::outlined_files(to, &stems[*index]);
        let own: Vec<[PathBuf; 3]> = chosen.iter().map(of_photo).collect();
        let tables = FRAGMENT_TABLES.map(|name| to.join(name));
        let for_others = written.paths(chosen.iter().map(|index| stems[*index].as_str()));
        let files = own.iter().flatten().chain(&tables).chain(&for_others);
        let files: Vec<&Path> = files.map(PathBuf::as_path).collect();
        outputs.check_all(files.iter().copied())?;
        warnings.extend(exports::left_over(to, &files));
        Ok(Self {
            photos,
            chosen,
            own,
            stems,
            tables,
            warnings,
        })
    }

    /// What the files of the chosen photos are called.
    pub(super) fn chosen_stems(&self) -> impl Iterator<Item = &str> {
        self.chosen.iter().map(|index| self.stems[*index].as_str())
    }
}

/// Those of the photos whose outlines are saved, and that the others are left out.
fn with_saved(
    opened: &Opened,
    chosen: Vec<usize>,
    stems: &[String],
) -> Result<(Vec<usize>, Option<String>), Fault> {
    let count = chosen.len();
    let is_saved = |index: &usize| saved_files(opened, &stems[*index]).is_some();
    let with: Vec<usize> = chosen.into_iter().filter(is_saved).collect();
    if with.is_empty() {
        let what = "no outlines of these photos are saved beside the flight";
        return Err(Fault::new(
            what,
            "save some in the window, or take another --engine",
        ));
    }
    let without = count - with.len();
    let said = (without > 0)
        .then(|| format!("{without} of {count} photos have no saved outlines, and are left out"));
    Ok((with, said))
}
