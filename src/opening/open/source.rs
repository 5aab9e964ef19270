//! What a flight is made of while it is opened: every step adds to it or takes from it.

use std::path::{Path, PathBuf};

use super::{FlightReconstruction, OpenOptions};
use crate::camera::Camera;
use crate::flight::{Doubt, FlightFile, FlightSettings, Photo};
use crate::formats::{CloudFile, PoseCovariance};
use crate::geodesy::Crs;
use crate::geometry::Similarity;
use crate::in_part::Moving;
use crate::scale::StatedErrors;
use crate::surface::UpAxis;
use crate::units::LengthUnit;
use crate::world::WorldFrame;

/// What a flight is made of, as far as it is read.
pub(super) struct Source {
    /// What errors of the whole are blamed on.
    pub(super) file: PathBuf,
    pub(super) name: String,
    pub(super) settings: FlightSettings,
    /// Whether somebody says the unit of the world, in `settings`.
    pub(super) unit_is_stated: bool,
    /// The flight.toml, where there is one.
    pub(super) flight_file: Option<FlightFile>,
    /// The system of the world that flight.toml names.
    pub(super) named_crs: Option<Crs>,
    /// Where the poses are from, if from a reconstruction.
    pub(super) reconstruction: Option<FlightReconstruction>,
    /// The frame of the poses and of the reconstruction's points.
    pub(super) poses_frame: WorldFrame,
    /// The system that the reconstruction's package works in, where its poses are in another.
    pub(super) preferred_crs: Option<Crs>,
    pub(super) inputs: Vec<PathBuf>,
    /// The surface's file; `None` for the reconstruction's own points.
    pub(super) surface: Option<PathBuf>,
    /// What the surface's triangles say is up, where that is not z.
    pub(super) doubtful_up: Option<UpAxis>,
    /// Whether `surface` is what the package left, not what somebody named.
    pub(super) surface_is_packages: bool,
    /// What its package's reader says about the surface.
    pub(super) surface_note: Option<String>,
    /// The way of the package's frame to the world, where flight.toml says it.
    pub(super) package_surface_to_world: Option<Similarity>,
    /// Whether its package may have turned the mesh (turned_mesh.rs).
    pub(super) may_turn_meshes: bool,
    /// What is to be done with the points of a cloud that is read in part.
    pub(super) moving: Option<Moving>,
    pub(super) reconstruction_cloud: CloudFile,
    pub(super) photo_folder: Option<PathBuf>,
    /// Who named that folder as the photos'.
    pub(super) photo_folder_named: Named,
    /// The size that the package names for each photo, and whether it may have been reduced; empty
    /// without a reconstruction.
    pub(super) named_sizes: Vec<Option<(u32, u32)>>,
    pub(super) may_be_reduced: bool,
    /// The unit that the package states for its own frame.
    pub(super) package_unit: Option<LengthUnit>,
    /// How sure the package is of what all photos share.
    pub(super) package_errors: StatedErrors,
    /// How sure it is of each photo's pose, in the frame of the poses; parallel to `photos` or empty.
    pub(super) pose_errors: Vec<PoseCovariance>,
    /// The topic of a recording whose poses are taken.
    pub(super) topic: Option<String>,
    pub(super) cameras: Vec<Camera>,
    pub(super) photos: Vec<Photo>,
    pub(super) warnings: Vec<String>,
    /// What speaks against all photos.
    pub(super) doubts: Vec<Doubt>,
    /// What speaks against single ones, by their index.
    pub(super) photo_doubts: Vec<(usize, Doubt)>,
}

/// Who named the folder of the photos.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Named {
    /// Nobody but a package, whose folder may be another machine's.
    ByPackage,
    /// A flight.toml, perhaps long ago: its disk may be elsewhere today, and the flight is worth seeing all the same.
    InFlight,
    /// Whoever opens the flight: what is no folder of its photos is a slip.
    Now,
}

impl Source {
    /// Nothing is read yet but what the user says beside the flight.
    pub(super) fn new(file: &Path, settings: FlightSettings, options: &OpenOptions) -> Self {
        Self {
            file: file.to_owned(),
            name: name_of(file),
            settings: FlightSettings {
                surface_up: options.surface_up.unwrap_or(settings.surface_up),
                ..settings
            },
            unit_is_stated: true,
            flight_file: None,
            named_crs: None,
            reconstruction: None,
            poses_frame: WorldFrame::AsIs(None),
            preferred_crs: None,
            inputs: Vec::new(),
            surface: options.surface.clone(),
            doubtful_up: None,
            surface_is_packages: false,
            surface_note: None,
            package_surface_to_world: None,
            may_turn_meshes: false,
            moving: None,
            reconstruction_cloud: CloudFile::default(),
            photo_folder: options.photos.clone(),
            photo_folder_named: match options.photos {
                Some(_) => Named::Now,
                None => Named::ByPackage,
            },
            named_sizes: Vec::new(),
            may_be_reduced: false,
            package_unit: None,
            package_errors: StatedErrors::default(),
            pose_errors: Vec::new(),
            topic: options.topic.clone(),
            cameras: Vec::new(),
            photos: Vec::new(),
            warnings: Vec::new(),
            doubts: Vec::new(),
            photo_doubts: Vec::new(),
        }
    }

    /// What errors of the surface are blamed on.
    pub(super) fn surface_file(&self) -> PathBuf {
        self.surface.clone().unwrap_or_else(|| self.file.clone())
    }

    /// Says something of a file.
    pub(super) fn warn(&mut self, path: &Path, warnings: &[String]) {
        let path = path.display();
        self.warnings
            .extend(warnings.iter().map(|warning| format!("{path}: {warning}")));
    }
}

/// The name of a flight that says none: that of its folder, or of its file without extension.
pub(super) fn name_of(path: &Path) -> String {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let name = if path.file_name().is_some_and(|name| name == "flight.toml") {
        path.parent().and_then(Path::file_name)
    } else if path.is_dir() {
        path.file_name()
    } else {
        path.file_stem()
    };
    name.map_or_else(
        || "flight".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}
