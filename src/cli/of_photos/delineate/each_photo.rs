//! All photos, one after the other: what a stopped run has done already is taken, and each is kept as soon as it is done.

use std::path::{Path, PathBuf};

use super::DelineateArguments;
use super::maker::Maker;
use super::outliners::Outliners;
use super::planned::Planned;
use super::unfinished::{KeptPhoto, Unfinished};
use super::written_outlines::WrittenOutlines;
use crate::cli::of_photos::chosen_photos::{Doing, NotMade};
use crate::cli::outputs::Outputs;
use crate::delineation::{LabelImage, NOT_ROCK, OutlinedBy};
use crate::exports::{MapPlaces, MeasuredPhoto};
use crate::fault::{Fault, by_cause};
use crate::files::Kind;
use crate::formats::read_bytes;
use crate::jobs::Progress;
use crate::opening::Opened;

const DOING: Doing = Doing {
    doing: "outlining the fragments of",
    not_done: "not delineated",
};

/// What the work on all photos has.
pub(super) struct EachPhoto<'a> {
    arguments: &'a DelineateArguments,
    planned: &'a Planned,
    maker: Maker<'a>,
    unfinished: Unfinished,
}

/// The photos that are done.
pub(super) struct PhotosDone<'a> {
    pub(super) done: Vec<MeasuredPhoto<'a>>,
    /// What was mended or left out, and the photos that are not done: a sentence for each cause.
    pub(super) said: Vec<String>,
    /// That there are such photos.
    pub(super) not_all: Option<Fault>,
}

impl<'a> EachPhoto<'a> {
    pub(super) fn new(
        arguments: &'a DelineateArguments,
        outliners: &'a Outliners,
        opened: &'a Opened,
        planned: &'a Planned,
        places: &'a MapPlaces,
        progress: &'a Progress,
    ) -> Self {
        let unfinished = match outliners.others {
            // Outlines that stand already are measured in no time.
            Some(_) => Unfinished::nothing(&arguments.to),
            None => {
                let read = opened.inputs.iter().chain(&outliners.of_engine);
                let read: Vec<PathBuf> = read.cloned().collect();
                let options = format!(
                    "{:?} {:?} {:?} {:?}",
                    arguments.engine, arguments.shape, arguments.unit, arguments.also
                );
                Unfinished::new(&arguments.to, &options, &read, progress)
            }
        };
        let maker = Maker {
            arguments,
            engine: outliners.engine(),
            opened,
            others: outliners.others.as_ref(),
            is_only: planned.chosen.len() == 1,
            stems: &planned.stems,
            places,
            units: [opened.flight.parts().unit, arguments.unit.into()],
            progress,
        };
        Self {
            arguments,
            planned,
            maker,
            unfinished,
        }
    }

    /// Outlines and measures all photos, and writes the files of each.
    ///
    /// # Errors
    /// Where a file cannot be written, the one photo cannot be outlined, or the work was cancelled.
    pub(super) fn make(
        &self,
        written: &mut WrittenOutlines<'_>,
        outputs: &Outputs<'_>,
    ) -> Result<PhotosDone<'_>, String> {
        let Planned { photos, chosen, .. } = self.planned;
        let path = &self.arguments.flight.flight;
        let names = chosen.iter().map(|index| self.name(*index));
        let mut done = Vec::new();
        let mut notes: Vec<(&str, String)> = Vec::new();
        let failed = photos.make_each(names, &DOING, path, self.maker.progress, |place| {
            let (of, said) = self.one(place, written, outputs)?;
            notes.extend(said.into_iter().map(|note| (of.photo, note)));
            done.push(of);
            Ok(())
        })?;
        let mut said = by_cause(notes, "photos");
        said.extend(failed.sentences());
        Ok(PhotosDone {
            done,
            said,
            not_all: failed.not_all(chosen.len()),
        })
    }

    fn name(&self, index: usize) -> &'a str {
        &self.maker.opened.flight.parts().photos[index].name
    }

    /// A photo by its place among those that are asked for, and what was mended or left out of it.
    fn one(
        &self,
        place: usize,
        written: &mut WrittenOutlines<'_>,
        outputs: &Outputs<'_>,
    ) -> Result<(MeasuredPhoto<'_>, Vec<String>), NotMade> {
        let (maker, progress) = (&self.maker, self.maker.progress);
        let index = self.planned.chosen[place];
        let (photo, stem) = (self.name(index), self.planned.stems[index].as_str());
        let own = &self.planned.own[place];
        let key = self.unfinished.key(&maker.files_of(index), progress);
        let mut paths = own.to_vec();
        paths.extend(written.of_photo(stem));
        let kept = self.unfinished.kept(stem, key.as_deref(), &paths, progress);
        let kept = kept.and_then(|kept| Some((maker.outlined_by(&kept)?, kept)));
        let (outlined, kept) = match kept {
            Some((outlined, kept)) => {
                if written.needs_labels() {
                    written.add(photo, stem, &read_own_labels(&own[0])?)?;
                }
                (outlined, kept)
            }
            None => {
                let made = maker.make(index)?;
                let for_others = written.add(photo, stem, &made.labels)?;
                outputs.make_folder(&self.arguments.to)?;
                let own = own.iter().cloned().zip(made.files);
                let files: Vec<(PathBuf, Vec<u8>)> = own.chain(for_others).collect();
                for (path, bytes) in &files {
                    outputs.write(path, bytes, Kind::Result)?;
                }
                let kept = KeptPhoto {
                    fragments: made.fragments,
                    is_saved: matches!(made.outlined, OutlinedBy::Saved(_)),
                    engine: made.outlined.method().to_owned(),
                    habits: made.outlined.habits(),
                    spread: made.spread,
                    notes: made.notes,
                };
                self.unfinished
                    .keep(stem, photo, key.as_deref(), &files, &kept, outputs)?;
                (made.outlined, kept)
            }
        };
        let of = MeasuredPhoto {
            photo,
            fragments: kept.fragments,
            outlined,
            spread: kept.spread,
            index,
            stem,
        };
        Ok((of, kept.notes))
    }

    /// All tables are written: what was kept is not needed any more. Photos that could not be made are tried again, and those
    /// that were need not be. Returns what is to be said of what stays.
    pub(super) fn finished(&self, is_whole: bool) -> Option<String> {
        if is_whole {
            self.unfinished.remove(self.planned.chosen_stems())
        } else {
            None
        }
    }
}

/// The label image of a file that this command wrote.
fn read_own_labels(path: &Path) -> Result<LabelImage, Fault> {
    let bytes = read_bytes(path).map_err(|error| error.fault)?;
    let broken = |error: image::ImageError| Fault::new(error.to_string(), "remove the file");
    let image = image::load_from_memory(&bytes)
        .map_err(broken)?
        .into_luma16();
    let labels = image.pixels().map(|pixel| match pixel.0 {
        [u16::MAX] => NOT_ROCK,
        [label] => u32::from(label),
    });
    Ok(LabelImage {
        width: image.width() as usize,
        height: image.height() as usize,
        labels: labels.collect(),
    })
}
