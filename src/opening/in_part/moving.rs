//! The way of a cloud's points to the world: the same steps that a cloud in memory takes.

use glam::DVec3;

use crate::fault::Fault;
use crate::geometry::Similarity;
use crate::surface::UpAxis;
use crate::world::WorldFrame;

/// What is done with each point, in this order.
#[derive(Debug, Clone, Default)]
pub(crate) struct Moving {
    /// Its z is brought up.
    pub(crate) up: UpAxis,
    /// A package's frame is brought to the world.
    pub(crate) package: Option<Similarity>,
    /// One coordinate system is brought to another.
    pub(crate) frames: Option<(WorldFrame, WorldFrame)>,
    /// The flight is placed by control points.
    pub(crate) placed: Option<Similarity>,
}

impl Moving {
    /// Whether it leaves everything where it is, to the last bit.
    pub(super) fn is_none(&self) -> bool {
        let frames = self.frames.as_ref();
        self.up == UpAxis::Z
            && self.package.is_none()
            && frames.is_none_or(|(from, to)| from.to(to).is_none())
            && self.placed.is_none()
    }

    /// Moves points.
    ///
    /// # Errors
    /// Where one lies outside of what a coordinate system covers.
    pub(super) fn points(&self, points: &mut [DVec3]) -> Result<(), Fault> {
        if self.up != UpAxis::Z {
            points
                .iter_mut()
                .for_each(|point| *point = self.up.to_z_up(*point));
        }
        if let Some(similarity) = &self.package {
            points
                .iter_mut()
                .for_each(|point| *point = similarity.apply(*point));
        }
        if let Some((from, to)) = &self.frames {
            from.to(to).points(points)?;
        }
        if let Some(similarity) = &self.placed {
            points
                .iter_mut()
                .for_each(|point| *point = similarity.apply(*point));
        }
        Ok(())
    }
}
