//! `fragscale rectify`: photos seen squarely, with one scale everywhere.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::chosen_photos::{ChosenPhotos, Doing};
use super::length::Length;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::{Force, Outputs};
use crate::cli::{Answer, OutputUnit};
use crate::exports::{self, RectifiedFormat, RectifiedPhoto};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{Opened, apart_from_photos};
use crate::scale::{Onto, PixelSize};
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(in crate::cli) struct RectifyArguments {
    #[command(flatten)]
    flight: FlightArguments,
    #[command(flatten)]
    photos: ChosenPhotos,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// The plane that the photo is seen squarely onto: the best one through what it shows of the surface,
    /// or a horizontal one, with north up.
    #[arg(long, value_enum, default_value = "fit")]
    plane: Plane,
    /// Lay the photo over the surface and look straight from above, instead of onto a plane.
    #[arg(long, conflicts_with = "plane")]
    ortho: bool,
    /// The side of a pixel, as 2mm or 0.5in; without it what the photo shows at its middle, rounded.
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pixel: Option<Length>,
    /// Pixel size and bar are said in this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    /// How to write the picture.
    #[arg(long, value_enum, default_value = "png")]
    format: Format,
    #[command(flatten)]
    force: Force,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Plane {
    Fit,
    Horizontal,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    Png,
    Tiff,
}

pub(in crate::cli) fn rectify(
    arguments: &RectifyArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let mut outputs = Outputs::new(arguments.force, arguments.flight.files());
    let opened = arguments.flight.open(progress)?;
    outputs.read(&opened.read)?;
    apart_from_photos(&arguments.to, &opened.photo_files).map_err(|error| error.to_string())?;
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let flight = &opened.flight;
    let chosen = arguments.photos.of(flight).map_err(in_flight)?;
    let format = match arguments.format {
        Format::Png => RectifiedFormat::Png,
        Format::Tiff => RectifiedFormat::Tiff,
    };
    let stems = exports::photo_file_stems(flight);
    let files = |index: usize| {
        format.endings().map(|ending| {
            let kind = if arguments.ortho {
                "ortho"
            } else {
                "rectified"
            };
            arguments
                .to
                .join(format!("{}_{kind}.{ending}", stems[index]))
        })
    };
    let planned: Vec<[PathBuf; 2]> = chosen.iter().map(|&index| files(index)).collect();
    outputs.check_all(planned.iter().flatten().map(PathBuf::as_path))?;
    let maker = Maker {
        arguments,
        opened: &opened,
        format,
        progress,
    };
    let mut warnings = opened.all_warnings();
    let mut text = String::new();
    let doing = Doing {
        doing: "rectifying",
        not_done: "not rectified",
    };
    let name = |index: &usize| flight.parts().photos[*index].name.as_str();
    let names = chosen.iter().map(name);
    let chosen_photos = &arguments.photos;
    let failed = chosen_photos.make_each(names, &doing, path, progress, |place| {
        let made = maker.make(chosen[place])?;
        let [picture, world_file] = &planned[place];
        outputs.make_folder(&arguments.to)?;
        outputs.write(picture, &made.picture, Kind::Result)?;
        outputs.write(world_file, made.world_file.as_bytes(), Kind::Result)?;
        text += &format!("{}: {}\n", picture.display(), made.words);
        let name = name(&chosen[place]);
        warnings.extend(made.warning.map(|warning| format!("{name}: {warning}")));
        Ok(())
    })?;
    let not_all = failed.not_all(chosen.len()).map(in_flight);
    warnings.extend(failed.sentences());
    Ok(Answer {
        text,
        warnings,
        failed: not_all,
    })
}

/// What all pictures of a flight are made from.
struct Maker<'a> {
    arguments: &'a RectifyArguments,
    opened: &'a Opened,
    format: RectifiedFormat,
    progress: &'a Progress,
}

/// A photo's files, and what to say of them.
struct Made {
    picture: Vec<u8>,
    world_file: String,
    words: String,
    warning: Option<&'static str>,
}

impl Maker<'_> {
    fn make(&self, index: usize) -> Result<Made, Fault> {
        let (arguments, flight) = (self.arguments, &self.opened.flight);
        let parts = flight.parts();
        let photo = &parts.photos[index];
        let onto = match (arguments.ortho, arguments.plane) {
            (true, _) => Onto::Surface,
            (_, Plane::Fit) => Onto::FittedPlane,
            (_, Plane::Horizontal) => Onto::HorizontalPlane,
        };
        let unit: LengthUnit = arguments.unit.into();
        let in_world = |length: Length| length.in_units_of(parts.unit);
        let size = PixelSize {
            asked: arguments.pixel.map(in_world),
            round_in: unit.in_units_of(parts.unit),
        };
        let rectification = flight.rectification(photo, onto, size, self.progress)?;
        let rectified = RectifiedPhoto {
            rectification: &rectification,
            onto,
            flight: &parts.name,
            photo: &photo.name,
            unit,
            world_unit: parts.unit,
            crs: self.opened.crs.as_deref(),
        };
        // Read late: whatever is refused is refused without it.
        let image = self.opened.pixels_of(index)?;
        Ok(Made {
            picture: rectified.bytes(&image, self.format)?,
            world_file: rectified.world_file(),
            words: rectified.words(),
            warning: rectification.doubt(),
        })
    }
}
