//! Bringing the reconstruction on the screen to the world: what the small window holds, and its
//! fit.

use std::path::{Path, PathBuf};

use crate::open_flight::OpenFlight;
use crate::opening::Georeferenced;

/// What the reconstruction's place in the world is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KnownFrom {
    /// Positions in the photos' own files.
    #[default]
    Photos,
    /// A list of the photos' positions.
    Positions,
    /// Ground control points that are marked in photos.
    ControlPoints,
    /// Distances between points, for the scale alone.
    Distances,
}

/// A field of the small window that names a file or folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathField {
    /// The folder of the photos.
    Photos,
    /// The list of positions.
    Positions,
    /// The list of control points.
    ControlPoints,
}

/// What is typed in the small window.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct GeoreferenceForm {
    /// Which of the fields count.
    pub from: KnownFrom,
    /// The folder of the photos.
    pub photos: String,
    /// The list of positions.
    pub positions: String,
    /// The list of control points.
    pub control_points: String,
    /// Known distances, one a line.
    pub distances: String,
    /// The length in metres of the distance that was measured on the surface.
    pub length: String,
    /// With distances: whether to turn the plane of the reconstruction's points level.
    pub level: bool,
    /// The coordinate system of the world, if it is not that of the list.
    pub crs: String,
}

impl GeoreferenceForm {
    /// The text of a field that names a file or folder.
    pub fn path(&mut self, field: PathField) -> &mut String {
        match field {
            PathField::Photos => &mut self.photos,
            PathField::Positions => &mut self.positions,
            PathField::ControlPoints => &mut self.control_points,
        }
    }
}

/// What the small window holds.
#[derive(Debug, Default)]
pub struct Georeferencing {
    /// What is typed.
    pub form: GeoreferenceForm,
    /// The last fit, with the folder of photos that was named for it; an error is one line. `None`
    /// once something else is typed.
    pub outcome: Option<(Option<PathBuf>, Result<Georeferenced, String>)>,
}

impl Georeferencing {
    /// Empty, but for the folder of the photos.
    pub fn new(photos: Option<&Path>) -> Self {
        let photos = photos.map(|folder| folder.display().to_string());
        let form = GeoreferenceForm {
            photos: photos.unwrap_or_default(),
            ..GeoreferenceForm::default()
        };
        Self {
            form,
            outcome: None,
        }
    }

    /// The last fit, where it succeeded.
    pub fn fitted(&self) -> Option<&Georeferenced> {
        self.outcome.as_ref()?.1.as_ref().ok()
    }
}

impl OpenFlight {
    /// Whether the coordinates of its surface are those of the reconstruction's own frame, so that a
    /// distance can be measured on the screen.
    pub fn is_in_own_frame(&self) -> bool {
        let reconstruction = self.files.reconstruction.as_ref();
        reconstruction.is_some_and(|known| known.in_world.is_none()) && self.files.crs.is_none()
    }

    /// Where the georeferenced flight is written if nobody says otherwise: beside the reconstruction.
    pub fn proposed_georeferenced(&self) -> PathBuf {
        let file = self.files.origin.suggested_file();
        // Of a flight.toml the name is that of the flight, not "flight".
        let name = if self.files.origin.flight_file().is_some() {
            self.files
                .reconstruction
                .as_ref()
                .and_then(|known| known.path.file_stem())
        } else {
            file.file_stem()
        };
        let name = name.map_or("flight".into(), |name| name.to_string_lossy().into_owned());
        let path = file.with_file_name(format!("{name}-georeferenced.toml"));
        std::path::absolute(&path).unwrap_or(path)
    }
}
