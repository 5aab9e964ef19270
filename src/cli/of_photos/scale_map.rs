//! `fragscale scale-map`: the scale of every pixel of a photo, or of all photos, into files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::chosen_photos::{ChosenPhotos, Doing, NotDone};
use crate::cli::flight_arguments::{FlightArguments, MemoryArguments};
use crate::cli::outputs::{Force, Outputs};
use crate::cli::{Answer, OutputUnit};
use crate::exports::{self, MapLayer, ScaleMap};
use crate::fault::Fault;
use crate::files::Kind;
use crate::flight::{Flight, Photo};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{Opened, apart_from_photos};
use crate::picture;
use crate::scale::FieldGrid;

/// Longer side of a picture, in pixels, its legend not counted.
const PICTURE_SIDE: u32 = 2048;

#[derive(Debug, Args)]
pub(in crate::cli) struct ScaleMapArguments {
    #[command(flatten)]
    flight: FlightArguments,
    #[command(flatten)]
    memory: MemoryArguments,
    #[command(flatten)]
    photos: ChosenPhotos,
    /// The file to write: numbers where it ends in .tif, colours with a legend where it ends in .png;
    /// may be given twice. With --all a folder, which gets both for each photo.
    #[arg(short, long, value_name = "FILE|DIR", required = true)]
    output: Vec<PathBuf>,
    /// Scales are in pixels per this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    /// What the TIFF holds, one page each, separated by commas. Depths and coordinates are in the
    /// world's unit.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "scale")]
    layers: Vec<Layer>,
    #[command(flatten)]
    force: Force,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Layer {
    /// Pixels per unit.
    Scale,
    /// Along the optical axis.
    Depth,
    X,
    Y,
    Z,
}

impl From<Layer> for MapLayer {
    fn from(layer: Layer) -> Self {
        match layer {
            Layer::Scale => Self::Scale,
            Layer::Depth => Self::Depth,
            Layer::X => Self::X,
            Layer::Y => Self::Y,
            Layer::Z => Self::Z,
        }
    }
}

impl ScaleMapArguments {
    /// What is written of all photos: more is known when the flight is open.
    pub(in crate::cli) fn outputs(&self) -> Outputs<'_> {
        Outputs::new(self.force, self.flight.files())
    }
}

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum MapFormat {
    Numbers,
    Colours,
}

impl MapFormat {
    /// By the ending of a name.
    fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        match ending.to_lowercase().as_str() {
            "tif" | "tiff" => Ok(Self::Numbers),
            "png" => Ok(Self::Colours),
            _ => {
                let what = "a scale map is written as TIFF (numbers) or PNG (colours)";
                let fault = Fault::new(what, "let its name end in .tif or .png");
                Err(FileError::new(path, fault).to_string())
            }
        }
    }
}

/// A photo with the files that it gets.
struct Planned<'a> {
    photo: &'a Photo,
    files: Vec<(PathBuf, MapFormat)>,
}

pub(in crate::cli) fn scale_map(
    arguments: &ScaleMapArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let mut outputs = arguments.outputs();
    if arguments.photos.is_one() {
        for path in &arguments.output {
            MapFormat::of(path)?;
            outputs = outputs.and(path, Kind::Result)?;
        }
        let mut files = arguments.output.iter();
        if files.all(|path| MapFormat::of(path) == Ok(MapFormat::Colours))
            && arguments.layers.iter().any(|layer| *layer != Layer::Scale)
        {
            let fault = Fault::new(
                "a PNG shows the scale alone, and no other layer",
                "write a TIFF (-o FILE.tif), or leave --layers out",
            );
            return Err(FileError::new(&arguments.output[0], fault).to_string());
        }
    }
    let (flight, memory) = (&arguments.flight, &arguments.memory);
    // Of a cloud that is read in part, the work may begin anew: what is written holds.
    let mut written = BTreeSet::new();
    let (opened, made) = memory.with_flight(flight, false, progress, |opened| {
        outputs.read(&opened.read)?;
        make_maps(arguments, opened, &outputs, &mut written, progress)
    })?;
    Ok(made.answer(arguments, &opened))
}

/// The same of a flight that is open, all of it.
pub(in crate::cli) fn scale_map_of(
    arguments: &ScaleMapArguments,
    mut outputs: Outputs<'_>,
    opened: &Opened,
    progress: &Progress,
) -> Result<Answer, String> {
    outputs.read(&opened.read)?;
    let made = make_maps(arguments, opened, &outputs, &mut BTreeSet::new(), progress)?;
    Ok(made.answer(arguments, opened))
}

/// What came of the maps of a flight.
struct MadeMaps {
    /// Of which photos there is none, and why.
    failed: NotDone,
    /// Whether there is none at all.
    has_none: bool,
}

impl MadeMaps {
    fn answer(self, arguments: &ScaleMapArguments, opened: &Opened) -> Answer {
        let mut warnings = opened.all_warnings();
        warnings.extend(self.failed.sentences());
        let fault = || {
            let fault = Fault::new("none of its photos has a map", "see the warnings above");
            arguments.flight.wrong(fault)
        };
        Answer {
            text: String::new(),
            warnings,
            failed: self.has_none.then(fault),
        }
    }
}

/// Writes the maps of an opened flight that are not written yet.
fn make_maps(
    arguments: &ScaleMapArguments,
    opened: &Opened,
    outputs: &Outputs<'_>,
    written: &mut BTreeSet<usize>,
    progress: &Progress,
) -> Result<MadeMaps, String> {
    let mut layers: Vec<MapLayer> = Vec::new();
    for layer in arguments.layers.iter().copied().map(MapLayer::from) {
        if !layers.contains(&layer) {
            layers.push(layer);
        }
    }
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let flight = &opened.flight;
    let chosen = arguments.photos.of(flight).map_err(in_flight)?;
    let planned = plan(arguments, flight, &chosen)?;
    let waiting = (planned.iter().enumerate()).filter(|(place, _)| !written.contains(place));
    let files = waiting.flat_map(|(_, planned)| &planned.files);
    outputs.check_all(files.map(|(path, _)| path.as_path()))?;
    if !arguments.photos.is_one() {
        apart_from_photos(&arguments.output[0], &opened.photo_files)
            .map_err(|error| error.to_string())?;
        outputs.make_folder(&arguments.output[0])?;
    }
    let maker = Maker {
        flight,
        layers: &layers,
        unit: arguments.unit,
        crs: opened.crs.as_deref(),
        progress,
    };
    let doing = Doing {
        doing: "mapping",
        not_done: "no map",
    };
    let names = planned.iter().map(|planned| planned.photo.name.as_str());
    let chosen_photos = &arguments.photos;
    let failed = chosen_photos.make_each(names, &doing, path, progress, |place| {
        if written.contains(&place) {
            return Ok(());
        }
        let planned = &planned[place];
        let files = planned.files.iter();
        let files = files.map(|(path, format)| Ok((path, maker.bytes(planned.photo, *format)?)));
        let files = files.collect::<Result<Vec<_>, Fault>>()?;
        if opened.is_settled() {
            for (path, bytes) in files {
                outputs.write(path, &bytes, Kind::Result)?;
            }
            written.insert(place);
        }
        Ok(())
    })?;
    let has_none = failed.count() == planned.len();
    Ok(MadeMaps { failed, has_none })
}

/// Which files are written for each photo.
fn plan<'a>(
    arguments: &ScaleMapArguments,
    flight: &'a Flight,
    chosen: &[usize],
) -> Result<Vec<Planned<'a>>, String> {
    let photos = &flight.parts().photos;
    if arguments.photos.is_one() {
        let files = arguments.output.iter();
        let files = files.map(|path| Ok((path.clone(), MapFormat::of(path)?)));
        let files = files.collect::<Result<Vec<_>, String>>()?;
        let one = |&index: &usize| Planned {
            photo: &photos[index],
            files: files.clone(),
        };
        return Ok(chosen.iter().map(one).collect());
    }
    let [folder] = &arguments.output[..] else {
        let fault = Fault::new(
            "maps of several photos go into one folder",
            "give one -o DIR",
        );
        return Err(FileError::new(&arguments.output[0], fault).to_string());
    };
    // Who names a file means one.
    if MapFormat::of(folder).is_ok() && !folder.is_dir() {
        let what = "maps of several photos go into a folder, and this names a file";
        let remedy = "give the folder, or one --photo";
        return Err(FileError::new(folder, Fault::new(what, remedy)).to_string());
    }
    let stems = exports::photo_file_stems(flight);
    let both = |index: usize| Planned {
        photo: &photos[index],
        files: [("tif", MapFormat::Numbers), ("png", MapFormat::Colours)]
            .map(|(ending, format)| {
                let name = format!("{}_scale.{ending}", stems[index]);
                (folder.join(name), format)
            })
            .to_vec(),
    };
    Ok(chosen.iter().map(|&index| both(index)).collect())
}

/// What all maps of a flight are made from.
struct Maker<'a> {
    flight: &'a Flight,
    layers: &'a [MapLayer],
    unit: OutputUnit,
    crs: Option<&'a str>,
    progress: &'a Progress,
}

impl Maker<'_> {
    /// A photo's map as a file.
    fn bytes(&self, photo: &Photo, format: MapFormat) -> Result<Vec<u8>, Fault> {
        let camera = self.flight.camera(photo);
        let grid = match format {
            MapFormat::Numbers => FieldGrid::of_pixels(camera),
            MapFormat::Colours => {
                let [width, height] = [camera.width, camera.height];
                let (columns, rows) = picture::reduced_size(width, height, PICTURE_SIDE);
                FieldGrid { columns, rows }
            }
        };
        let image = self.flight.parts().image;
        let field = self.flight.field(photo, image, grid, self.progress)?;
        let parts = self.flight.parts();
        let map = ScaleMap {
            field: &field,
            flight: &parts.name,
            photo: &photo.name,
            unit: self.unit.into(),
            world_unit: parts.unit,
            crs: self.crs,
        };
        match format {
            MapFormat::Numbers => exports::scale_map_tiff(&map, self.layers, self.progress),
            MapFormat::Colours => exports::scale_map_png(&map),
        }
    }
}
