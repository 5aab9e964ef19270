//! What the engineer wants to see in the viewport; remembered from day to day.

use serde::{Deserialize, Serialize};

use crate::render::{ColorBy, Scope, Show};

/// The switches of the panel "Layers".
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Layers {
    /// The cloud's points.
    pub cloud: bool,
    /// 1 closes the gaps between neighbouring points.
    pub point_size: f64,
    /// The surface's triangles.
    pub mesh: bool,
    /// Their edges.
    pub wireframe: bool,
    /// What the colours mean.
    pub color_by: ColorBy,
    /// Relief from depth.
    pub eye_dome: bool,
    /// The cameras.
    pub frusta: Scope,
    /// The photos on their image planes.
    pub images: Scope,
    /// The corner rays.
    pub corner_rays: Scope,
    /// The footprints' outlines.
    pub outlines: Scope,
    /// The footprints' insides.
    pub fills: Scope,
    /// A line through the camera centres.
    pub flight_line: bool,
    /// A grid at the ground's elevation.
    pub ground: bool,
    /// The directions of the world's axes.
    pub axes: bool,
    /// A bar of known length.
    pub scale_bar: bool,
    /// The selected photo laid on the surface.
    pub project_photo: bool,
    /// Parallel lines of sight.
    pub orthographic: bool,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            cloud: false,
            point_size: 1.0,
            mesh: true,
            wireframe: false,
            color_by: ColorBy::Rgb,
            eye_dome: true,
            frusta: Scope::All,
            images: Scope::All,
            corner_rays: Scope::Selected,
            outlines: Scope::All,
            fills: Scope::Selected,
            flight_line: true,
            ground: false,
            axes: true,
            scale_bar: true,
            project_photo: false,
            orthographic: false,
        }
    }
}

impl Layers {
    /// The paper's figure of corner rays: all cameras with all their rays and footprints, nothing
    /// else.
    pub fn corner_ray_figure(self) -> Self {
        Self {
            frusta: Scope::All,
            images: Scope::None,
            corner_rays: Scope::All,
            outlines: Scope::All,
            fills: Scope::None,
            flight_line: false,
            ground: false,
            project_photo: false,
            wireframe: false,
            color_by: match self.color_by {
                // The scale is that of one photo; the figure is of all.
                ColorBy::Scale => ColorBy::Rgb,
                other => other,
            },
            ..self
        }
    }

    /// For the renderer; the rest of `Show` belongs to the moment.
    pub fn show(&self, ground: Option<f64>) -> Show {
        Show {
            cloud: self.cloud,
            point_size: self.point_size,
            mesh: self.mesh,
            wireframe: self.wireframe,
            color_by: self.color_by,
            eye_dome: self.eye_dome,
            frusta: self.frusta,
            images: self.images,
            corner_rays: self.corner_rays,
            outlines: self.outlines,
            fills: self.fills,
            flight_line: self.flight_line,
            ground: ground.filter(|_| self.ground),
            axes: self.axes,
            scale_bar: self.scale_bar,
            project_photo: self.project_photo,
            ..Show::default()
        }
    }
}
