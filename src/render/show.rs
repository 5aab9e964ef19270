//! What is shown, and how.

use std::sync::Arc;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::geometry::LevelBox;
use crate::units::LengthUnit;

/// Which photos something is drawn for. Hidden photos ([`PhotoLook::visible`]) have nothing drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Scope {
    /// None.
    #[default]
    None,
    /// The selected one, and the one that the mouse is over.
    Selected,
    /// All.
    All,
}

/// What the colours of cloud and mesh mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ColorBy {
    /// Their own, as read; grey where the file has none.
    #[default]
    Rgb,
    /// Height, world units.
    Elevation,
    /// Angle to the horizontal, degrees from 0 to 90. Grey on a cloud without normals.
    Slope,
    /// Pixels of the selected photo per world unit; grey where it does not look.
    Scale,
}

/// What is behind everything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Background {
    /// One colour: red, green, blue.
    Color([u8; 3]),
    /// Nothing; the picture has alpha.
    Transparent,
}

/// What is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Show {
    /// The cloud's points.
    pub cloud: bool,
    /// Size of a point: 1 closes the gaps between neighbours.
    pub point_size: f64,
    /// How many points at most: a fair sample of those in sight is drawn, and it stands for the mesh
    /// too where that has more than twice as many triangles in sight. `None` draws all.
    pub max_points: Option<usize>,
    /// The surface's triangles.
    pub mesh: bool,
    /// Their edges.
    pub wireframe: bool,
    /// What the colours of both mean.
    pub color_by: ColorBy,
    /// The values at the colour map's ends, in world units, degrees or pixels per world unit; `None` is
    /// where the values themselves end.
    pub color_limits: Option<[f64; 2]>,
    /// Relief: darker where a neighbouring pixel is nearer.
    pub eye_dome: bool,
    /// The cameras.
    pub frusta: Scope,
    /// The photos on the image planes of the cameras.
    pub images: Scope,
    /// Size of cameras: 1 suits the flight.
    pub frustum_size: f64,
    /// The rays of the image corners with their corner points.
    pub corner_rays: Scope,
    /// The outlines of the images on the surface.
    pub outlines: Scope,
    /// The footprints' insides, translucent.
    pub fills: Scope,
    /// A line through the camera centres, in the order of [`super::Renderer::set_flight_line`].
    pub flight_line: bool,
    /// A grid at this elevation, world units.
    pub ground: Option<f64>,
    /// The directions of x, y (north) and z in a corner.
    pub axes: bool,
    /// A bar of known length.
    pub scale_bar: bool,
    /// The unit of the world, for the scale bar's text.
    pub unit: LengthUnit,
    /// What is written beside lengths in the world (`FlightParts::unit_of_lengths`).
    pub lengths_in: &'static str,
    /// The unit that the legend says scales in; `None` is the world's.
    pub scale_unit: Option<LengthUnit>,
    /// The points of the distance tool, in the world: one is marked, between two the distance is told
    /// with its level and its upright part.
    pub measured: Vec<DVec3>,
    /// The clouds beside the surface ([`super::Renderer::set_beside`]).
    pub beside: bool,
    /// Of surface and points nothing is drawn outside of this box, whose edges are drawn.
    pub clip: Option<LevelBox>,
    /// Points that were picked, with their names.
    pub picked: Vec<(String, DVec3)>,
    /// Lines that are drawn on the surface, in the world.
    pub drawn_lines: Vec<Vec<DVec3>>,
    /// Their points, which are marked.
    pub drawn_points: Vec<DVec3>,
    /// Lines in the air and on the ground, each of its own colour: a flight that is planned.
    pub planned_lines: Arc<Vec<PlannedLine>>,
    /// The selected photo laid on the surface that it sees ([`super::Renderer::set_projected_photo`]).
    pub project_photo: bool,
    /// How much of the photo lies over the view that looks through its camera, 0 to 1.
    pub photo_blend: f64,
    /// Index of the selected photo.
    pub selected: Option<usize>,
    /// Index of the photo that the mouse is over.
    pub hovered: Option<usize>,
    /// What is behind everything.
    pub background: Background,
    /// Screen pixels per point of the user interface: how thick lines are, 1 to 2.
    pub pixels_per_point: f64,
}

impl Default for Show {
    /// The paper's figure of corner rays: the surface, the cameras, their corner rays and
    /// footprints.
    fn default() -> Self {
        Self {
            cloud: false,
            point_size: 1.0,
            max_points: None,
            mesh: true,
            wireframe: false,
            color_by: ColorBy::Rgb,
            color_limits: None,
            eye_dome: true,
            frusta: Scope::All,
            images: Scope::None,
            frustum_size: 1.0,
            corner_rays: Scope::All,
            outlines: Scope::All,
            fills: Scope::Selected,
            flight_line: false,
            ground: None,
            axes: true,
            scale_bar: true,
            unit: LengthUnit::Metre,
            lengths_in: "m",
            scale_unit: None,
            measured: Vec::new(),
            beside: false,
            clip: None,
            picked: Vec::new(),
            drawn_lines: Vec::new(),
            drawn_points: Vec::new(),
            planned_lines: Arc::default(),
            project_photo: false,
            photo_blend: 0.0,
            selected: None,
            hovered: None,
            background: Background::Color([24, 26, 30]),
            pixels_per_point: 1.0,
        }
    }
}

impl Show {
    /// The same without what is measured and drawn on the surface.
    pub(crate) fn without_marks(&self) -> Self {
        Self {
            measured: Vec::new(),
            picked: Vec::new(),
            clip: None,
            drawn_lines: Vec::new(),
            drawn_points: Vec::new(),
            planned_lines: Arc::default(),
            ..self.clone()
        }
    }
}

/// A line of a planned flight.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLine {
    /// In the world.
    pub points: Vec<DVec3>,
    /// Red, green, blue.
    pub color: [u8; 3],
    /// Points of the user interface.
    pub width: f64,
}

/// How one photo looks; cheap to change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PhotoLook {
    /// Whether anything is drawn for it.
    pub visible: bool,
    /// Of its camera, rays and outline: red, green, blue.
    pub color: [u8; 3],
}

impl Default for PhotoLook {
    fn default() -> Self {
        Self {
            visible: true,
            color: [44, 132, 232],
        }
    }
}

impl Scope {
    /// Whether it takes in a photo.
    pub(super) fn holds(self, index: usize, show: &Show) -> bool {
        match self {
            Self::None => false,
            Self::Selected => show.selected == Some(index) || show.hovered == Some(index),
            Self::All => true,
        }
    }
}
