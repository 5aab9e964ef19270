//! `fragscale delineate`: the fragments of photos outlined, measured where they lie, and their size
//! distribution.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec2;

use super::chosen_photos::ChosenPhotos;
use super::chosen_photos::Doing;
use crate::camera::Camera;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::{Force, Outputs};
use crate::cli::{Answer, OutputUnit};
use crate::delineation::mass::{ByMass, PhotoFragments, Steps, by_mass};
use crate::delineation::measures::{Fragment, SieveShape, measured};
use crate::delineation::{
    Classical, Engine, FINES, LabelImage, Learned, delineate as outline, least_across,
};
use crate::exports::{self, PhotoOfFragments};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::numbers::significant_digits;
use crate::opening::Opened;
use crate::picture;
use crate::scale::{FieldGrid, ImageKind, ScaleField};
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(in crate::cli) struct DelineateArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// One photo, as the flight names it; without it all photos.
    #[arg(long, value_name = "NAME")]
    photo: Option<String>,
    /// The folder to write to: of each photo its label image and its outlines, then fragments.csv and
    /// distribution.csv.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// What finds the borders of fragments.
    #[arg(long, value_enum, default_value = "learned")]
    engine: EngineName,
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
    let mut outputs = Outputs::new(arguments.force, arguments.flight.files());
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
    let tables = ["fragments.csv", "distribution.csv"].map(|name| to.join(name));
    let files = planned.iter().flatten().chain(&tables);
    outputs.check_all(files.map(PathBuf::as_path))?;
    let maker = Maker {
        arguments,
        opened: &opened,
        progress,
    };
    let mut warnings = opened.all_warnings();
    let doing = Doing {
        doing: "outlining the fragments of",
        not_done: "not delineated",
    };
    let name = |index: &usize| flight.parts().photos[*index].name.as_str();
    let mut done: Vec<(&str, PhotoFragments)> = Vec::new();
    let names = chosen.iter().map(name);
    let failed = photos.make_each(names, &doing, path, progress, |place| {
        let made = maker.make(chosen[place])?;
        outputs.make_folder(to)?;
        for (path, bytes) in planned[place].iter().zip(&made.pictures) {
            outputs.write(path, bytes, Kind::Result)?;
        }
        done.push((name(&chosen[place]), made.fragments));
        Ok(())
    })?;
    let failures = failed.len();
    warnings.extend(failed);
    let world = flight.parts().unit;
    let unit: LengthUnit = arguments.unit.into();
    let report =
        |error: Box<dyn std::error::Error>| in_flight(Fault::new(error.to_string(), "report this"));
    let mut text = String::new();
    if !done.is_empty() {
        let rows: Vec<PhotoOfFragments<'_>> = done
            .iter()
            .map(|(photo, of)| PhotoOfFragments {
                photo,
                fragments: &of.fragments,
            })
            .collect();
        let bytes =
            exports::fragments_csv(&rows, world, unit).map_err(|error| report(error.into()))?;
        outputs.write(&tables[0], bytes.as_bytes(), Kind::Result)?;
        let steps = Steps {
            fines: arguments.engine.engine().fines_of_unfound(),
            ..Steps::default()
        };
        let mut curves: Vec<(&str, ByMass)> = Vec::new();
        for (photo, of) in &done {
            match by_mass(std::slice::from_ref(of), steps) {
                Ok(curve) => curves.push((photo, curve)),
                Err(fault) => warnings.push(format!("{photo}: no size distribution: {fault}")),
            }
        }
        let method = format!("fragscale ({})", arguments.engine.engine().name());
        let borrowed: Vec<(&str, &ByMass)> = curves
            .iter()
            .map(|(photo, curve)| (*photo, curve))
            .collect();
        let bytes = exports::curves_csv(&method, &borrowed, world, unit)
            .map_err(|error| report(error.into()))?;
        outputs.write(&tables[1], bytes.as_bytes(), Kind::Result)?;
        let all: Vec<PhotoFragments> = done.iter().map(|(_, of)| of.clone()).collect();
        let all = by_mass(&all, steps);
        text = words(&borrowed, all.as_ref().ok(), world, unit);
    }
    let failed = (failures > 0).then(|| {
        let what = format!("{failures} of {} photos are not delineated", chosen.len());
        in_flight(Fault::new(what, "see the warnings above"))
    });
    Ok(Answer {
        text,
        warnings,
        failed,
    })
}

/// A line of each photo, and one of all.
fn words(
    curves: &[(&str, &ByMass)],
    all: Option<&ByMass>,
    world: LengthUnit,
    unit: LengthUnit,
) -> String {
    let factor = world.in_units_of(unit);
    let widest = curves.iter().map(|(photo, _)| photo.chars().count()).max();
    let widest = widest.unwrap_or(0).max("all photos".len());
    let symbol = unit.symbol();
    let mut text = format!(
        "{:widest$}  fragments   cut  not outlined %  {:>9} {:>9} {:>9}  nothing below\n",
        "photo",
        format!("P20 {symbol}"),
        format!("P50 {symbol}"),
        format!("P80 {symbol}"),
    );
    let all = all.map(|all| ("all photos", all));
    for (photo, curve) in curves.iter().copied().chain(all) {
        let size = |percent: f64| {
            let size = curve.curve.size_at(percent);
            size.map_or_else(
                || "-".to_owned(),
                |size| significant_digits(size * factor, 3),
            )
        };
        text += &format!(
            "{photo:widest$}  {:9} {:5}  {:14.1}  {:>9} {:>9} {:>9}  {} {symbol}\n",
            curve.whole,
            curve.cut,
            100.0 * curve.unfound,
            size(20.0),
            size(50.0),
            size(80.0),
            significant_digits(curve.limit * factor, 2),
        );
    }
    text
}

/// What all photos of a flight are outlined by.
struct Maker<'a> {
    arguments: &'a DelineateArguments,
    opened: &'a Opened,
    progress: &'a Progress,
}

/// A photo's files and fragments.
struct Made {
    pictures: [Vec<u8>; 2],
    fragments: PhotoFragments,
}

impl Maker<'_> {
    fn make(&self, index: usize) -> Result<Made, Fault> {
        let flight = &self.opened.flight;
        let photo = &flight.parts().photos[index];
        let camera = flight.camera(photo);
        let image = self.opened.pixels_of(index)?;
        if image.dimensions() != (camera.width, camera.height) {
            let (width, height) = image.dimensions();
            return Err(Fault::new(
                format!(
                    "the photo is {width} x {height}, its camera {} x {}",
                    camera.width, camera.height
                ),
                "give the photo that the camera was calibrated for",
            ));
        }
        let left_out = self.left_out(&photo.name, camera);
        let image = picture::undistorted(&image, camera, u32::MAX);
        let engine = self.arguments.engine.engine();
        let labels = outline(engine, &image, &left_out, self.progress)?;
        let grid = FieldGrid::of_pixels(camera);
        let field = flight.field(photo, ImageKind::Undistorted, grid, self.progress)?;
        let fragments = measured(&labels, &field, self.arguments.shape.into());
        let is_cut: Vec<bool> = fragments.iter().map(|fragment| fragment.is_cut).collect();
        Ok(Made {
            pictures: [
                exports::labels_png(&labels)?,
                exports::outlines_png(&image, &labels, &is_cut)?,
            ],
            fragments: of_photo(
                &labels,
                &field,
                fragments,
                least_across(engine, camera.width, camera.height),
            ),
        })
    }
}

impl Maker<'_> {
    /// Of each pixel of the undistorted photo whether it is no rock: a scale object that the flight masks.
    fn left_out(&self, photo: &str, camera: &Camera) -> Vec<bool> {
        let objects = self.opened.settings.scale_objects.iter();
        let regions: Vec<_> = objects
            .filter(|object| object.photo == photo)
            .map(|object| object.left_out(camera, ImageKind::Undistorted))
            .filter(|region| !region.is_empty())
            .collect();
        if regions.is_empty() {
            return Vec::new();
        }
        let mask = picture::mask_of_regions(camera.width, camera.height, &regions);
        mask.pixels().map(|pixel| pixel.0 == [0; 3]).collect()
    }
}

/// What a photo contributes to the distribution.
fn of_photo(
    labels: &LabelImage,
    field: &ScaleField,
    fragments: Vec<Fragment>,
    least_across: f64,
) -> PhotoFragments {
    let (mut fines, mut area, mut pixels) = (0.0, 0.0, 0.0);
    for (place, label) in labels.labels.iter().enumerate() {
        let (column, row) = (place % labels.width, place / labels.width);
        let Some(scale) = field.scale_at(column as u32, row as u32) else {
            continue;
        };
        let own = 1.0 / (scale * scale);
        pixels += 1.0;
        area += own;
        if *label == FINES {
            fines += own;
        }
    }
    let scale = (pixels / area).sqrt();
    PhotoFragments {
        fragments,
        frame: DVec2::new(labels.width as f64, labels.height as f64),
        fines,
        limit: least_across / scale,
    }
}
