//! `fragscale delineate`: the fragments of photos outlined, measured where they lie, and their size
//! distribution.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use image::RgbImage;

use super::chosen_photos::{ChosenPhotos, Doing};
use super::outlines_of_others::{MasksArguments, OutlinesOfOthers};
use super::sizes::{Done, OutlinedBy, Sizes};
use super::written_outlines::{OtherForm, WrittenOutlines};
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::{Force, Outputs};
use crate::cli::{Answer, OutputUnit};
use crate::delineation::mass::PhotoFragments;
use crate::delineation::measures::SieveShape;
use crate::delineation::{
    Classical, Engine, LabelImage, Learned, NOT_ROCK, delineate as outline, engine_called, photo,
};
use crate::exports::{self, PhotoOfFragments};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{Opened, outline_files, read_outlines};
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(in crate::cli) struct DelineateArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// One photo, as the flight names it; without it all photos.
    #[arg(long, value_name = "NAME")]
    photo: Option<String>,
    /// The folder to write to: of each photo its label image and its outlines, then fragments.csv, distribution.csv and
    /// sizes.csv (P20, P50 and P80 with their 95 % intervals).
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// What finds the borders of fragments. Without it, outlines that were saved in the window are taken where there are
    /// any (fragments/NAME.png beside flight.toml), and else the learned engine.
    #[arg(long, value_enum)]
    engine: Option<EngineName>,
    #[command(flatten)]
    masks: MasksArguments,
    /// Outlines for other tools, too, beside the label images, all of the undistorted photos; several with commas.
    #[arg(long, value_enum, value_name = "FORMS", value_delimiter = ',')]
    also: Vec<OtherForm>,
    /// How the sieve size of a fragment follows from its outline.
    #[arg(long, value_enum, default_value = "calibrated")]
    shape: Shape,
    /// Sizes are in this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    #[command(flatten)]
    force: Force,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum EngineName {
    /// A small network that was trained on simulated piles.
    Learned,
    /// Edges and shadows at several scales; no weights.
    Classical,
}

impl EngineName {
    fn engine(self) -> &'static dyn Engine {
        match self {
            Self::Classical => &Classical,
            Self::Learned => &Learned,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Shape {
    /// As the fragments of simulated piles pass their sieves.
    Calibrated,
    /// The shorter side of the least rectangle about it.
    Breadth,
    /// The diameter of the circle of its area.
    Circle,
}

impl From<Shape> for SieveShape {
    fn from(shape: Shape) -> Self {
        match shape {
            Shape::Calibrated => Self::Calibrated,
            Shape::Breadth => Self::Breadth,
            Shape::Circle => Self::Circle,
        }
    }
}

pub(in crate::cli) fn delineate(
    arguments: &DelineateArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let inputs = arguments.flight.files().cloned();
    let mut outputs = Outputs::new(arguments.force, inputs.chain(arguments.masks.masks.clone()));
    let others = OutlinesOfOthers::open(&arguments.masks)?;
    let opened = arguments.flight.open(progress)?;
    outputs.read(&opened.read)?;
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let flight = &opened.flight;
    let photos = ChosenPhotos::one_or_all(arguments.photo.clone());
    let chosen = photos.of(flight).map_err(in_flight)?;
    let stems = exports::photo_file_stems(flight);
    let to = &arguments.to;
    let pictures = |index: usize| {
        ["labels", "outlines"].map(|kind| to.join(format!("{}_{kind}.png", stems[index])))
    };
    let planned: Vec<[PathBuf; 2]> = chosen.iter().map(|index| pictures(*index)).collect();
    let tables = ["fragments.csv", "distribution.csv", "sizes.csv"].map(|name| to.join(name));
    let mut written = WrittenOutlines::new(to, &arguments.also);
    let for_others = written.paths(chosen.iter().map(|index| stems[*index].as_str()));
    let files = planned.iter().flatten().chain(&tables).chain(&for_others);
    outputs.check_all(files.map(PathBuf::as_path))?;
    let maker = Maker {
        arguments,
        opened: &opened,
        others: others.as_ref(),
        is_only: chosen.len() == 1,
        stems: &stems,
        progress,
    };
    let mut warnings = opened.all_warnings();
    let doing = Doing {
        doing: "outlining the fragments of",
        not_done: "not delineated",
    };
    let name = |index: &usize| flight.parts().photos[*index].name.as_str();
    let mut done: Vec<Done<'_>> = Vec::new();
    let mut said: Vec<String> = Vec::new();
    let names = chosen.iter().map(name);
    let failed = photos.make_each(names, &doing, path, progress, |place| {
        let index = chosen[place];
        let made = maker.make(index)?;
        let files = written.add(name(&index), &stems[index], &made.labels)?;
        outputs.make_folder(to)?;
        let pictures = planned[place].iter().cloned().zip(made.pictures);
        for (path, bytes) in pictures.chain(files) {
            outputs.write(&path, &bytes, Kind::Result)?;
        }
        said.extend(
            made.notes
                .iter()
                .map(|note| format!("{}: {note}", name(&index))),
        );
        done.push(Done {
            index,
            photo: name(&chosen[place]),
            fragments: made.fragments,
            outlined: made.outlined,
        });
        Ok(())
    })?;
    let not_all = doing.not_all(failed.len(), chosen.len()).map(in_flight);
    warnings.extend(said);
    warnings.extend(failed);
    let world = flight.parts().unit;
    let unit: LengthUnit = arguments.unit.into();
    let report =
        |error: Box<dyn std::error::Error>| in_flight(Fault::new(error.to_string(), "report this"));
    let mut text = String::new();
    if !done.is_empty() {
        let rows: Vec<PhotoOfFragments<'_>> = done
            .iter()
            .map(|of| PhotoOfFragments {
                photo: of.photo,
                fragments: &of.fragments.fragments,
            })
            .collect();
        let bytes =
            exports::fragments_csv(&rows, world, unit).map_err(|error| report(error.into()))?;
        outputs.write(&tables[0], bytes.as_bytes(), Kind::Result)?;
        written.finish(&outputs)?;
        let sizes = Sizes::of(&done, &opened, progress).map_err(in_flight)?;
        let method = format!("fragscale ({})", method_of(&done));
        let curves = sizes.curves();
        let bytes = exports::curves_csv(&method, &curves, world, unit)
            .map_err(|error| report(error.into()))?;
        outputs.write(&tables[1], bytes.as_bytes(), Kind::Result)?;
        let bytes =
            exports::sizes_csv(&sizes.rows(), world, unit).map_err(|error| report(error.into()))?;
        outputs.write(&tables[2], bytes.as_bytes(), Kind::Result)?;
        text = sizes.words(world, unit);
        warnings.extend(sizes.without);
    }
    Ok(Answer {
        text,
        warnings,
        failed: not_all,
    })
}

/// What outlined them, in a word or two.
fn method_of(done: &[Done<'_>]) -> &'static str {
    let mut found = done.iter().map(|of| of.outlined.method());
    let first = found.next().unwrap_or_default();
    match found.all(|other| other == first) {
        true => first,
        false => "saved and learned",
    }
}

/// What all photos of a flight are outlined by.
struct Maker<'a> {
    arguments: &'a DelineateArguments,
    opened: &'a Opened,
    /// Outlines in place of an engine's.
    others: Option<&'a OutlinesOfOthers>,
    /// Whether one photo alone is asked for.
    is_only: bool,
    /// What the files of each photo are called.
    stems: &'a [String],
    progress: &'a Progress,
}

/// A photo's files and fragments.
struct Made {
    pictures: [Vec<u8>; 2],
    labels: LabelImage,
    fragments: PhotoFragments,
    outlined: OutlinedBy,
    /// What was mended or left out.
    notes: Vec<String>,
}

/// A photo's outlines, before they are measured.
struct Outlined {
    labels: LabelImage,
    by: OutlinedBy,
    /// Nothing narrower is claimed, pixels.
    least_across: f64,
    notes: Vec<String>,
}

impl Maker<'_> {
    fn make(&self, index: usize) -> Result<Made, Fault> {
        let flight = &self.opened.flight;
        let photo = &flight.parts().photos[index];
        let camera = flight.camera(photo);
        let image = photo::undistorted(&self.opened.pixels_of(index)?, camera)?;
        let left_out = photo::left_out(&self.opened.settings, photo, camera);
        let Outlined {
            labels,
            by,
            least_across,
            notes,
        } = self.outlined(index, &image, &left_out)?;
        let field = photo::field(flight, photo, self.progress)?;
        let shape = self.arguments.shape.into();
        let fragments = photo::fragments(&labels, &field, shape, least_across);
        // By number, of which other tools leave some out.
        let mut is_cut = vec![false; labels.fragments()];
        for fragment in fragments
            .fragments
            .iter()
            .filter(|fragment| fragment.is_cut)
        {
            if let Some(is_cut) = is_cut.get_mut(fragment.number as usize - 1) {
                *is_cut = true;
            }
        }
        Ok(Made {
            pictures: [
                exports::labels_png(&labels)?,
                exports::outlines_png(&image, &labels, &is_cut)?,
            ],
            fragments,
            labels,
            outlined: by,
            notes,
        })
    }

    fn outlined(
        &self,
        index: usize,
        image: &RgbImage,
        left_out: &[bool],
    ) -> Result<Outlined, Fault> {
        let flight = &self.opened.flight;
        let photo = &flight.parts().photos[index];
        let camera = flight.camera(photo);
        if let Some(others) = self.others {
            let mut masks = others.of_photo(&photo.name, camera, self.is_only)?;
            let labels = masks.labels.labels.iter_mut().zip(left_out);
            for (label, _) in labels.filter(|(_, is_left_out)| **is_left_out) {
                *label = NOT_ROCK;
            }
            return Ok(Outlined {
                least_across: narrowest(&masks.labels),
                labels: masks.labels,
                by: OutlinedBy::Masks,
                notes: masks.notes,
            });
        }
        let saved = self
            .saved_of(index)
            .filter(|[picture, _]| picture.is_file());
        if let Some(files) = saved {
            let read = read_outlines(&files, &photo.name, camera);
            let read =
                read.map_err(|error| Fault::new(error.to_string(), "or say --engine learned"))?;
            let by = OutlinedBy::Saved(engine_called(&read.engine));
            return Ok(Outlined {
                least_across: by.least_across(camera),
                labels: read.outlines.into_labels(),
                by,
                notes: read.notes,
            });
        }
        let engine = self
            .arguments
            .engine
            .unwrap_or(EngineName::Learned)
            .engine();
        let by = OutlinedBy::Engine(engine);
        Ok(Outlined {
            labels: outline(engine, image, left_out, self.progress)?,
            least_across: by.least_across(camera),
            by,
            notes: Vec::new(),
        })
    }

    /// The files of a photo's saved outlines, where those are to be taken.
    fn saved_of(&self, index: usize) -> Option<[PathBuf; 2]> {
        if self.arguments.engine.is_some() {
            return None;
        }
        let (flight_file, _) = self.opened.file.as_ref()?;
        Some(outline_files(flight_file, self.stems.get(index)?))
    }
}

/// The diameter of the circle of as many pixels as the smallest fragment has: nothing is claimed of what is smaller.
fn narrowest(labels: &LabelImage) -> f64 {
    let areas = labels.areas();
    let least = areas.iter().skip(1).filter(|area| **area > 0).min();
    least.map_or(0.0, |pixels| {
        (4.0 / std::f64::consts::PI * *pixels as f64).sqrt()
    })
}
