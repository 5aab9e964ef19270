//! A photo seen squarely: which of its pixels shows which place of a plane or of the surface from above.
//!
//! ```text
//! plane      the planes
//! raster     the pixels of the picture on a plane
//! heights    the surface from above, and what of it a camera sees
//! ```

mod heights;
mod plane;
mod raster;

use glam::DVec2;

pub use self::plane::PlaneFrame;
pub use self::raster::PlaneRaster;

use self::heights::Heights;
use self::raster::{around, extent, pixel_size, shown_at};
use super::ScaleField;
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::surface::Surface;

/// What a photo is seen squarely onto.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Onto {
    /// The plane that lies best through what the photo shows.
    FittedPlane,
    /// The horizontal plane at the mean height of what the photo shows.
    HorizontalPlane,
    /// The surface, looked at straight from above.
    Surface,
}

impl Onto {
    /// As files name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::FittedPlane => "fit",
            Self::HorizontalPlane => "horizontal",
            Self::Surface => "surface",
        }
    }
}

/// How large the pixels of a rectified picture are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelSize {
    /// World units; `None` for the finest that the photo shows at its middle, rounded.
    pub asked: Option<f64>,
    /// What a rounded size is a round number of, in world units.
    pub round_in: f64,
}

/// A rectified picture without its colours.
#[derive(Debug)]
pub struct Rectification {
    /// Where its pixels lie.
    pub raster: PlaneRaster,
    /// Root mean square distance of what the photo shows from the plane, world units; `None` over the
    /// surface, which is met itself.
    pub off_plane: Option<f64>,
    /// Whether rays that meet the surface meet the plane outside of the picture, near the horizon.
    pub is_cut: bool,
    camera: Camera,
    pose: Pose,
    heights: Option<Heights>,
}

impl Rectification {
    /// Of the photo of `field` (its grid should be fine enough to know what the photo shows: that of the
    /// fit is). `surface` is what the field is of.
    ///
    /// # Errors
    /// Where the photo shows too little of the surface, the camera looks along the plane or stands below
    /// it, the picture would have more than 200 million pixels, or the work was cancelled.
    pub fn new(
        field: &ScaleField,
        onto: Onto,
        size: PixelSize,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let frame = match onto {
            Onto::FittedPlane => PlaneFrame::fitted(field)?,
            Onto::HorizontalPlane | Onto::Surface => PlaneFrame::horizontal(field)?,
        };
        let pixel = pixel_size(&frame, field, size.asked, size.round_in)?;
        let points = field.points();
        let mut rectification = Self {
            raster: PlaneRaster::over(frame, [DVec2::ZERO; 2], pixel)?,
            off_plane: None,
            is_cut: false,
            camera: field.camera().clone(),
            pose: *field.pose(),
            heights: None,
        };
        if onto == Onto::Surface {
            let feet = points.iter().map(|point| frame.plane_from_world(*point));
            let [min, max] = around(feet).unwrap_or_default();
            // What lies between the outermost rays of the grid and the image's edge.
            let cells = DVec2::new(f64::from(field.grid.columns), f64::from(field.grid.rows));
            let room = (max - min) / cells.max(DVec2::splat(2.0));
            rectification.raster = PlaneRaster::over(frame, [min - room, max + room], pixel)?;
            let heights = Heights::new(&rectification.raster, field, surface, progress)?;
            rectification.heights = Some(heights);
            return Ok(rectification);
        }
        let (extent, is_cut) = extent(&frame, field).ok_or_else(|| {
            let what = "the photo's rays meet the plane far outside of what they show";
            Fault::new(what, "choose another plane (--plane fit or horizontal)")
        })?;
        let normal = frame.normal();
        let off = points
            .iter()
            .map(|point| normal.dot(*point - frame.origin).powi(2));
        rectification.off_plane = Some((off.sum::<f64>() / points.len().max(1) as f64).sqrt());
        rectification.raster = PlaneRaster::over(frame, extent, pixel)?;
        rectification.is_cut = is_cut;
        Ok(rectification)
    }

    /// What should be said of the picture before anybody measures on it.
    pub fn doubt(&self) -> Option<&'static str> {
        self.is_cut.then_some(
            "it is cut: rays near the horizon meet the plane far outside of what they show",
        )
    }

    /// The camera of the photo as shot.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Whether neighbouring places of the picture come from neighbouring pixels of the photo everywhere.
    pub fn is_smooth(&self) -> bool {
        self.heights.is_none()
    }

    /// The pixel of the photo as shot that shows a place of the picture, both with (0, 0) at the outer
    /// corner of the first pixel; `None` where the photo does not show it. Over the surface a pixel of the
    /// picture is level, at the height of its middle.
    pub fn source(&self, place: DVec2) -> Option<DVec2> {
        let mut point = self.raster.world_from_picture(place);
        if let Some(heights) = &self.heights {
            point.z = heights.seen_at(place)?;
        }
        shown_at(&self.camera, self.pose.camera_from_world(point))
    }
}

#[cfg(test)]
mod tests;
