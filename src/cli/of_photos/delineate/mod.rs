//! `fragscale delineate`: the fragments of photos outlined, measured where they lie, and their size
//! distribution.

mod chosen_engine;
mod masks_arguments;
mod mass_arguments;
mod unfinished;
mod written_outlines;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use image::RgbImage;

use self::chosen_engine::{ChosenEngine, OpenEngine};
use self::masks_arguments::{MasksArguments, with_outlines};
use self::mass_arguments::MassArguments;
use self::unfinished::{KeptPhoto, Unfinished};
use self::written_outlines::{OtherForm, WrittenOutlines};
use super::chosen_photos::{ChosenPhotos, Doing};
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::{Force, Outputs};
use crate::cli::{Answer, OutputUnit};
use crate::delineation::mass::PhotoFragments;
use crate::delineation::measures::SieveShape;
use crate::delineation::{
    Engine, LabelImage, Learned, NOT_ROCK, OutlinedBy, delineate as outline, engine_called, photo,
};
use crate::exports::{
    self, FRAGMENT_TABLES, FoundSize, FragmentSizes, FragmentTables, MapPlaces, MassWay,
    MeasuredPhoto, PhotoOutlined,
};
use crate::fault::Fault;
use crate::files::{Kind, Recording};
use crate::formats::{FileError, read_bytes};
use crate::jobs::Progress;
use crate::opening::{Opened, OutlinesOfOthers, apart_from_photos, read_outlines, saved_outlines};
use crate::picture::edge_spread;
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(in crate::cli) struct DelineateArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// One photo, as the flight names it; without it all photos.
    #[arg(long, value_name = "NAME")]
    photo: Option<String>,
    /// The folder to write to: of each photo its label image, its outlines over the photo and in the world (GeoJSON), then
    /// fragments.csv, distribution.csv, sizes.csv (P20, P50 and P80 with their 95 % intervals) and report.html. What was
    /// stopped goes on with the photos that are not done when it is started again.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// What finds the borders of fragments: learned (a small network that was trained on simulated piles), classical (edges
    /// and shadows at several scales; no weights), FILE.toml, which describes an ONNX model of yours, or saved: outlines that were
    /// saved in the window alone (fragments/NAME.png beside flight.toml). Without it, these are taken where there are any, and
    /// else the learned engine.
    #[arg(long, value_name = "learned|classical|saved|FILE.toml", value_parser = ChosenEngine::parse)]
    engine: Option<ChosenEngine>,
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
    mass: MassArguments,
    #[command(flatten)]
    force: Force,
}

impl DelineateArguments {
    /// What stays of it where it is stopped.
    pub(in crate::cli) fn kept(&self) -> String {
        let to = self.to.display();
        format!("the photos that are done are kept in {to}; start it again to go on")
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
    let outliners = Outliners::open(arguments)?;
    let opened = arguments.flight.open(progress)?;
    let (answer, _) = delineate_of(arguments, &outliners, &opened, progress)?;
    Ok(answer)
}

/// What outlines the fragments: looked at before the flight is opened, so that what is wrong is said at once.
pub(in crate::cli) struct Outliners {
    engine: Option<OpenEngine>,
    /// The files of the engine.
    of_engine: Vec<PathBuf>,
    /// Outlines in place of an engine's.
    others: Option<OutlinesOfOthers>,
}

impl Outliners {
    /// Those that are asked for.
    pub(in crate::cli) fn open(arguments: &DelineateArguments) -> Result<Self, String> {
        arguments.mass.check()?;
        let recording = Recording::start();
        let chosen = arguments.engine.as_ref().map(ChosenEngine::open);
        let engine = chosen.transpose()?;
        let of_engine = recording.files();
        drop(recording);
        Ok(Self {
            engine,
            of_engine,
            others: arguments.masks.open()?,
        })
    }

    fn engine(&self) -> &dyn Engine {
        self.engine
            .as_ref()
            .map_or(&Learned, |engine| engine.engine())
    }
}

/// The same of a flight that is open, with the sizes of all fragments together in the unit that is asked for.
pub(in crate::cli) fn delineate_of(
    arguments: &DelineateArguments,
    outliners: &Outliners,
    opened: &Opened,
    progress: &Progress,
) -> Result<(Answer, Vec<FoundSize>), String> {
    let inputs = arguments.flight.files().cloned();
    let inputs = inputs.chain(arguments.masks.masks.clone());
    let described = arguments.engine.as_ref().and_then(ChosenEngine::file);
    let inputs = inputs
        .chain(described.cloned())
        .chain(arguments.mass.file());
    // A folder of outlines may be written into, but not over those that are read.
    let outlines = outliners.others.iter().flat_map(OutlinesOfOthers::files);
    let mut outputs = Outputs::new(arguments.force, inputs.chain(outlines.cloned()));
    outputs.read(&opened.read)?;
    apart_from_photos(&arguments.to, &opened.photo_files).map_err(|error| error.to_string())?;
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let flight = &opened.flight;
    let (world, unit): (LengthUnit, LengthUnit) = (flight.parts().unit, arguments.unit.into());
    let tail = arguments.mass.tail(world)?;
    let photos = ChosenPhotos::one_or_all(arguments.photo.clone());
    let mut warnings = opened.all_warnings();
    let mut chosen = photos.of(flight).map_err(in_flight)?;
    if let (Some(others), true) = (&outliners.others, photos.all) {
        let (with, said) = with_outlines(others, chosen, flight);
        chosen = with;
        warnings.extend(said);
    }
    let stems = exports::photo_file_stems(flight);
    if arguments.engine == Some(ChosenEngine::Saved) {
        let (with, said) = with_saved(arguments, opened, chosen, &stems)?;
        chosen = with;
        warnings.extend(said);
    }
    let to = &arguments.to;
    let own_files = |index: &usize| exports::outlined_files(to, &stems[*index]);
    let planned: Vec<[PathBuf; 3]> = chosen.iter().map(own_files).collect();
    let tables = FRAGMENT_TABLES.map(|name| to.join(name));
    let mut written = WrittenOutlines::new(to, &arguments.also);
    let for_others = written.paths(chosen.iter().map(|index| stems[*index].as_str()));
    let files = planned.iter().flatten().chain(&tables).chain(&for_others);
    let files: Vec<&Path> = files.map(PathBuf::as_path).collect();
    outputs.check_all(files.iter().copied())?;
    warnings.extend(exports::left_over(to, &files));
    let places = MapPlaces::new(opened.crs.as_deref(), world);
    let unfinished = match outliners.others {
        // Outlines that stand already are measured in no time.
        Some(_) => Unfinished::nothing(to),
        None => {
            let read: Vec<PathBuf> = opened
                .inputs
                .iter()
                .chain(&outliners.of_engine)
                .cloned()
                .collect();
            let options = format!(
                "{:?} {:?} {:?} {:?}",
                arguments.engine, arguments.shape, arguments.unit, arguments.also
            );
            Unfinished::new(to, &options, &read, progress)
        }
    };
    let maker = Maker {
        arguments,
        engine: outliners.engine(),
        opened,
        others: outliners.others.as_ref(),
        is_only: chosen.len() == 1,
        stems: &stems,
        places: &places,
        units: [world, unit],
        progress,
    };
    if let Some(fault) = places.fault() {
        warnings.push(fault.to_string());
    }
    let doing = Doing {
        doing: "outlining the fragments of",
        not_done: "not delineated",
    };
    let name = |index: &usize| flight.parts().photos[*index].name.as_str();
    let mut done: Vec<MeasuredPhoto<'_>> = Vec::new();
    let mut said: Vec<String> = Vec::new();
    let names = chosen.iter().map(name);
    let failed = photos.make_each(names, &doing, path, progress, |place| {
        let index = chosen[place];
        let (photo, stem) = (name(&chosen[place]), stems[index].as_str());
        let key = unfinished.key(&maker.files_of(index), progress);
        let mut paths = planned[place].to_vec();
        paths.extend(written.of_photo(stem));
        let kept = unfinished.kept(stem, key.as_deref(), &paths, progress);
        let kept = kept.and_then(|kept| Some((maker.outlined_by(&kept)?, kept)));
        let (outlined, kept) = match kept {
            Some((outlined, kept)) => {
                if written.needs_labels() {
                    written.add(photo, stem, &read_own_labels(&planned[place][0])?)?;
                }
                (outlined, kept)
            }
            None => {
                let made = maker.make(index)?;
                let files = written.add(photo, stem, &made.labels)?;
                outputs.make_folder(to)?;
                let own = planned[place].iter().cloned().zip(made.files);
                let files: Vec<(PathBuf, Vec<u8>)> = own.chain(files).collect();
                for (path, bytes) in &files {
                    outputs.write(path, bytes, Kind::Result)?;
                }
                let kept = KeptPhoto {
                    fragments: made.fragments,
                    is_saved: matches!(made.outlined, OutlinedBy::Saved(_)),
                    engine: made
                        .outlined
                        .engine()
                        .map_or_else(String::new, |of| of.name().to_owned()),
                    spread: made.spread,
                    notes: made.notes,
                };
                unfinished.keep(stem, photo, key.as_deref(), &files, &kept, &outputs)?;
                (made.outlined, kept)
            }
        };
        said.extend(kept.notes.iter().map(|note| format!("{photo}: {note}")));
        done.push(MeasuredPhoto {
            photo,
            fragments: kept.fragments,
            outlined,
            spread: kept.spread,
            index,
            stem,
        });
        Ok(())
    })?;
    let mut not_all = doing.not_all(&failed, chosen.len()).map(in_flight);
    let is_whole = failed.is_empty();
    warnings.extend(said);
    warnings.extend(failed);
    let mut text = String::new();
    let mut of_all = Vec::new();
    if !done.is_empty() {
        let way = MassWay {
            steps: arguments.mass.steps(),
            tail: tail.as_ref(),
        };
        let sizes = FragmentSizes::of(&done, &way, flight, &opened.looked_up, progress);
        let sizes = sizes.map_err(in_flight)?;
        if let (Some(first), None) = (sizes.nothing(), &not_all) {
            let what = "no photo has a size distribution";
            not_all = Some(in_flight(Fault::new(what, format!("the first: {first}"))));
        }
        warnings.extend(sizes.without.iter().cloned());
        let law = arguments.mass.tail_in_words();
        let of_tables = FragmentTables {
            flight: &flight.parts().name,
            units: [world, unit],
            tail: law.as_deref(),
            warnings: &warnings,
        };
        let picture = |name: &str| read_bytes(&to.join(name)).map_err(|error| error.fault);
        let bytes = exports::fragment_tables(&of_tables, &done, &sizes, picture);
        for (path, bytes) in tables.iter().zip(bytes.map_err(in_flight)?) {
            outputs.write(path, &bytes, Kind::Result)?;
        }
        written.finish(&outputs)?;
        text = sizes.words(world, unit);
        of_all = sizes.of_all(world.in_units_of(unit));
    }
    // Photos that could not be made are tried again; those that were need not be.
    if is_whole {
        unfinished.remove(chosen.iter().map(|index| stems[*index].as_str()));
    }
    let answer = Answer {
        text,
        warnings,
        failed: not_all,
    };
    Ok((answer, of_all))
}

/// Those of the photos whose outlines are saved, and that the others are left out.
fn with_saved(
    arguments: &DelineateArguments,
    opened: &Opened,
    chosen: Vec<usize>,
    stems: &[String],
) -> Result<(Vec<usize>, Option<String>), String> {
    let count = chosen.len();
    let is_saved = |index: &usize| saved_files(opened, &stems[*index]).is_some();
    let with: Vec<usize> = chosen.into_iter().filter(is_saved).collect();
    if with.is_empty() {
        let what = "no outlines of these photos are saved beside the flight";
        let fault = Fault::new(what, "save some in the window, or take another --engine");
        return Err(FileError::new(&arguments.flight.flight, fault).to_string());
    }
    let without = count - with.len();
    let said = (without > 0)
        .then(|| format!("{without} of {count} photos have no saved outlines, and are left out"));
    Ok((with, said))
}

/// The files of a photo's saved outlines, where there are any.
fn saved_files(opened: &Opened, stem: &str) -> Option<[PathBuf; 2]> {
    let (flight_file, _) = opened.file.as_ref()?;
    saved_outlines(flight_file, stem)
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

/// What all photos of a flight are outlined by.
struct Maker<'a> {
    arguments: &'a DelineateArguments,
    /// Of photos whose outlines are neither saved nor another tool's.
    engine: &'a dyn Engine,
    opened: &'a Opened,
    /// Outlines in place of an engine's.
    others: Option<&'a OutlinesOfOthers>,
    /// Whether one photo alone is asked for.
    is_only: bool,
    /// What the files of each photo are called.
    stems: &'a [String],
    /// How places of the world are written.
    places: &'a MapPlaces,
    /// Of the world, and of what is written.
    units: [LengthUnit; 2],
    progress: &'a Progress,
}

/// A photo's files and fragments.
struct Made<'a> {
    /// Label image, outlines over the photo and in the world.
    files: [Vec<u8>; 3],
    labels: LabelImage,
    fragments: PhotoFragments,
    outlined: OutlinedBy<'a>,
    spread: Option<f64>,
    /// What was mended or left out.
    notes: Vec<String>,
}

/// A photo's outlines, before they are measured.
struct Outlined<'a> {
    labels: LabelImage,
    by: OutlinedBy<'a>,
    /// How far the photo's edges are spread, pixels.
    spread: Option<f64>,
    notes: Vec<String>,
}

impl<'a> Maker<'a> {
    fn make(&self, index: usize) -> Result<Made<'a>, Fault> {
        let flight = &self.opened.flight;
        let photo = &flight.parts().photos[index];
        let camera = flight.camera(photo);
        let image = photo::undistorted(&self.opened.pixels_of(index)?, camera)?;
        let left_out = photo::left_out(&self.opened.settings, photo, camera);
        let Outlined {
            labels,
            by,
            spread,
            mut notes,
        } = self.outlined(index, &image, &left_out)?;
        let of = PhotoOutlined {
            flight,
            index,
            pixels: &image,
            labels: &labels,
            by,
            spread,
            shape: self.arguments.shape.into(),
        };
        let measured = of.measured(self.places, self.units, self.progress)?;
        notes.extend(measured.note);
        Ok(Made {
            files: measured.bytes,
            fragments: measured.fragments,
            labels,
            outlined: by,
            spread,
            notes,
        })
    }

    fn outlined(
        &self,
        index: usize,
        image: &RgbImage,
        left_out: &[bool],
    ) -> Result<Outlined<'a>, Fault> {
        let flight = &self.opened.flight;
        let photo = &flight.parts().photos[index];
        let camera = flight.camera(photo);
        let spread = edge_spread(image);
        if let Some(others) = self.others {
            let masks = others.of_flights_photo(flight, index, left_out, self.is_only)?;
            return Ok(Outlined {
                labels: masks.labels,
                by: OutlinedBy::Masks,
                spread,
                notes: masks.notes,
            });
        }
        if let Some(files) = self.saved_of(index) {
            let read = read_outlines(&files, &photo.name, camera);
            let read =
                read.map_err(|error| Fault::new(error.to_string(), "or say --engine learned"))?;
            let by = OutlinedBy::Saved(engine_called(&read.engine));
            return Ok(Outlined {
                labels: read.outlines.into_labels(),
                by,
                spread,
                notes: read.notes,
            });
        }
        let by = OutlinedBy::Engine(self.engine);
        let labels = outline(self.engine, image, left_out, self.progress)?;
        Ok(Outlined {
            labels,
            by,
            spread,
            notes: Vec::new(),
        })
    }

    /// All that a photo's outlines rest on besides the flight.
    fn files_of(&self, index: usize) -> Vec<PathBuf> {
        let photo = self.opened.photo_files.get(index);
        let photo = photo.and_then(|file| file.path.clone());
        let saved = self.saved_of(index).into_iter().flatten();
        photo.into_iter().chain(saved).collect()
    }

    /// What outlined a photo that was kept; `None` where that is not known any more.
    fn outlined_by(&self, kept: &KeptPhoto) -> Option<OutlinedBy<'_>> {
        match kept.is_saved {
            true => Some(OutlinedBy::Saved(
                engine_called(&kept.engine).map(|engine| engine as _),
            )),
            false => (kept.engine == self.engine.name()).then_some(OutlinedBy::Engine(self.engine)),
        }
    }

    /// The files of a photo's saved outlines, where those are to be taken.
    fn saved_of(&self, index: usize) -> Option<[PathBuf; 2]> {
        match self.arguments.engine {
            None | Some(ChosenEngine::Saved) => saved_files(self.opened, self.stems.get(index)?),
            Some(_) => None,
        }
    }
}
