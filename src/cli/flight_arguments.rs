//! Which flight, with which surface and photos: what every command that opens a flight understands.

use std::path::PathBuf;

use clap::Args;

use crate::fault::Fault;
use crate::formats::FileError;
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::opening::{
    self, FlightOfMission, Memory, OpenOptions, Opened, half_of_the_machines, memory_size,
};
use crate::surface::UpAxis;

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
    /// The axis of the surface's file that points up, where it is not z and no flight.toml says it: x or y.
    #[arg(long, value_name = "AXIS", value_parser = up_axis)]
    up: Option<UpAxis>,
    /// Of a ROS recording, take the poses of this topic; else the densest that lead to the camera.
    #[arg(long, value_name = "NAME")]
    topic: Option<String>,
}

impl FlightArguments {
    /// A flight with its surface and its photos, where they are named.
    pub(super) fn new(
        flight: PathBuf,
        surface: Option<PathBuf>,
        photo_folder: Option<PathBuf>,
    ) -> Self {
        Self {
            flight,
            surface,
            photo_folder,
            up: None,
            topic: None,
        }
    }

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

    /// The flight that was opened, to be held against a mission.
    pub(super) fn of_mission<'a>(&'a self, opened: &'a Opened) -> FlightOfMission<'a> {
        FlightOfMission {
            file: &self.flight,
            flight: &opened.flight,
            crs: opened.crs.as_deref(),
        }
    }

    /// The coordinate system of the places: the one `stated`, else the opened flight's. `remedy` is for where there is none.
    pub(super) fn crs_of(
        &self,
        stated: Option<&str>,
        opened: &Opened,
        remedy: &str,
    ) -> Result<Crs, String> {
        let stated = stated.or(opened.crs.as_deref()).ok_or_else(|| {
            let what = "nobody says in which coordinate system its places are";
            self.wrong(Fault::new(what, remedy))
        });
        Crs::understand(stated?).map_err(|fault| self.wrong(fault))
    }

    /// What is wrong with it, in a line.
    pub(super) fn wrong(&self, fault: Fault) -> String {
        FileError::new(&self.flight, fault).to_string()
    }

    fn open_with(&self, may_lack_photos: bool, progress: &Progress) -> Result<Opened, String> {
        let options = self.options(may_lack_photos);
        opening::open_flight(&self.flight, &options, progress).map_err(|error| error.to_string())
    }

    fn options(&self, may_lack_photos: bool) -> OpenOptions {
        OpenOptions {
            surface: self.surface.clone(),
            photos: self.photo_folder.clone(),
            topic: self.topic.clone(),
            settings: None,
            surface_up: self.up,
            may_lack_photos,
        }
    }
}

fn up_axis(text: &str) -> Result<UpAxis, String> {
    text.parse()
        .map_err(|what| format!("{what}; give x, y or z"))
}

/// How much memory the flight's cloud may take.
#[derive(Debug, Args)]
pub(super) struct MemoryArguments {
    /// The most memory that the points of a cloud may take, as 8GB or 500MB; half of the machine's without it. Of a
    /// larger LAS, LAZ, COPC or EPT only what is needed is read, with the same numbers.
    #[arg(long, value_name = "SIZE", value_parser = memory_size)]
    memory: Option<u64>,
    /// Read a cloud in part that would fit, too. For tests.
    #[arg(long, hide = true)]
    in_part: bool,
}

impl MemoryArguments {
    /// Opens a flight within the memory, and does something that reads its surface: see [`opening::with_flight`].
    pub(super) fn with_flight<T>(
        &self,
        flight: &FlightArguments,
        may_lack_photos: bool,
        progress: &Progress,
        work: impl FnMut(&Opened) -> Result<T, String>,
    ) -> Result<(Opened, T), String> {
        let memory = Memory {
            most: self.memory.unwrap_or_else(half_of_the_machines),
            always_in_part: self.in_part,
        };
        let options = flight.options(may_lack_photos);
        opening::with_flight(&flight.flight, &options, memory, progress, work)
    }
}
