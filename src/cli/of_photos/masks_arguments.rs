//! `--masks`: outlines that another tool made, or a person with it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

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
