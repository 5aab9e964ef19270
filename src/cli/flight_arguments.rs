//! Which flight, with which surface and photos: what every command that opens a flight understands.

use std::path::PathBuf;

use clap::Args;

use crate::jobs::Progress;
use crate::opening::{self, OpenOptions, Opened};

#[derive(Debug, Args)]
pub(super) struct FlightArguments {
    /// A flight.toml, a file or folder that a photogrammetry package wrote, or a folder of photos with
    /// positions and angles in them.
    pub(super) flight: PathBuf,
    /// Use this cloud or mesh instead of the flight's surface.
    #[arg(long, value_name = "FILE")]
    surface: Option<PathBuf>,
    /// The folder of the image files, where the flight does not name it.
    #[arg(long, value_name = "DIR")]
    photo_folder: Option<PathBuf>,
    /// Of a ROS recording, take the poses of this topic; else the densest that lead to the camera.
    #[arg(long, value_name = "NAME")]
    topic: Option<String>,
}

impl FlightArguments {
    /// The files that are named. What a folder is, and what of it is read, is known when it is open.
    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let named = std::iter::once(&self.flight).chain(&self.surface);
        named.filter(|path| path.is_file())
    }

    /// Opens it; an error is one line.
    pub(super) fn open(&self, progress: &Progress) -> Result<Opened, String> {
        // There is no scale without photos.
        self.open_with(false, progress)
    }

    /// The same, but a cloud without photos does too: what is measured on the surface needs none.
    pub(super) fn open_to_measure(&self, progress: &Progress) -> Result<Opened, String> {
        self.open_with(true, progress)
    }

    fn open_with(&self, may_lack_photos: bool, progress: &Progress) -> Result<Opened, String> {
        let options = OpenOptions {
            surface: self.surface.clone(),
            photos: self.photo_folder.clone(),
            topic: self.topic.clone(),
            settings: None,
            may_lack_photos,
        };
        opening::open_flight(&self.flight, &options, progress).map_err(|error| error.to_string())
    }
}
