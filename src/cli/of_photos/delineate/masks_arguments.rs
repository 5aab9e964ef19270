//! `--masks`: outlines that another tool made, or a person with it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::fault::first_names;
use crate::flight::Flight;
use crate::opening::OutlinesOfOthers;
use crate::scale::ImageKind;

/// `--masks`.
#[derive(Debug, Clone, Args)]
pub(super) struct MasksArguments {
    /// Outlines of another tool in place of an engine's: label images (PNG, TIFF), COCO, LabelMe, CVAT for images 1.1 or
    /// GeoJSON in pixels. A file, or a folder of files named as the photos (NAME.png, NAME_labels.png, NAME_mask.png,
    /// NAME_pred.tif, NAME.json, NAME.geojson, ...). Where they overlap, the smaller lies on top; what nobody outlined is
    /// fines, all of it; nothing smaller than the smallest outline is claimed.
    #[arg(long, value_name = "PATH", conflicts_with = "engine")]
    pub(super) masks: Option<PathBuf>,
    /// Which photo they were outlined in; without it, fragscale's own files are of the undistorted photo and all others of
    /// the original one.
    #[arg(long, value_enum, value_name = "PHOTO", requires = "masks")]
    masks_of: Option<MasksOf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MasksOf {
    /// The photo as the camera took it.
    Original,
    /// The photo without its lens, as fragscale exports it.
    Undistorted,
}

impl From<MasksOf> for ImageKind {
    fn from(of: MasksOf) -> Self {
        match of {
            MasksOf::Original => Self::AsShot,
            MasksOf::Undistorted => Self::Undistorted,
        }
    }
}

impl MasksArguments {
    /// Makes them ready, where there are any.
    ///
    /// # Errors
    /// Where the file or folder cannot be taken.
    pub(super) fn open(&self) -> Result<Option<OutlinesOfOthers>, String> {
        let of = self.masks_of.map(ImageKind::from);
        let opened = self
            .masks
            .as_ref()
            .map(|path| OutlinesOfOthers::open(path, of));
        opened.transpose().map_err(|error| error.to_string())
    }
}

/// Which of a flight's photos have outlines, where several are asked for; what of both has no part in it is said, a sentence
/// each. All of them where none has: why is said of each.
pub(super) fn with_outlines(
    others: &OutlinesOfOthers,
    chosen: Vec<usize>,
    flight: &Flight,
) -> (Vec<usize>, Vec<String>) {
    let photos = flight.parts().photos.iter();
    let names: Vec<&str> = photos.map(|photo| photo.name.as_str()).collect();
    let (with, without): (Vec<usize>, Vec<usize>) = chosen
        .iter()
        .partition(|index| others.is_of(names[**index], &names));
    let mut said = Vec::new();
    if !with.is_empty() && !without.is_empty() {
        said.push(format!(
            "{} of {} photos have no outlines among those of --masks, and are left out: {}",
            without.len(),
            chosen.len(),
            first_names(without.iter().map(|index| names[*index]))
        ));
    }
    let of_none = others.of_no_photo(&names);
    if !of_none.is_empty() {
        let are = if of_none.len() == 1 { "is" } else { "are" };
        said.push(format!(
            "{} of --masks {are} of no photo of the flight: {}; name outlines as their photos",
            of_none.len(),
            first_names(&of_none)
        ));
    }
    (if with.is_empty() { chosen } else { with }, said)
}
