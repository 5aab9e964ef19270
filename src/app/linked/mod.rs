//! The linked cursor: a place of the surface that the mouse points at, in the pile or on a photo, with
//! everything that is shown of it elsewhere.

use glam::DVec3;

use crate::flight::Flight;
use crate::scale::{Sighting, sighting};
use crate::surface::{Caster, Surface};

/// The radius of the ring, metres.
const RING: f64 = 0.1;

/// Where nobody knows the unit: its radius as a share of what a photo shows across.
const RING_OF_FOOTPRINT: f64 = 0.01;

/// What of the window the mouse points from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointFrom {
    /// The viewport.
    Pile,
    /// The photo view.
    Photo,
    /// The inspector's small photo.
    Inspector,
}

/// A place of the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkedPoint {
    /// In the world.
    pub point: DVec3,
    /// The chords of a ring around it that lies on the rock, in the world.
    pub ring: Vec<[DVec3; 2]>,
    /// Of the ring, world units.
    pub radius: f64,
    /// Whether that is ten centimetres; else, where nobody knows the unit, a hundredth of what a photo
    /// shows across.
    pub is_ten_centimetres: bool,
    /// The photos that see it, by their indices, in the flight's order.
    pub seen: Vec<(usize, Sighting)>,
}

impl LinkedPoint {
    /// Looks who sees a point, on the picker's thread: a projection for each photo, and one ray for those
    /// that have it in their frame.
    pub fn new(point: DVec3, flight: &Flight, surface: &Surface, caster: &mut Caster<'_>) -> Self {
        let parts = flight.parts();
        let photos = parts.photos.iter().enumerate();
        let seen: Vec<(usize, Sighting)> = photos
            .filter_map(|(index, photo)| {
                let camera = flight.camera(photo);
                let seen = sighting(camera, &photo.pose, parts.image, point, surface, caster)?;
                Some((index, seen))
            })
            .collect();
        let across = seen.first().map(|(index, seen)| {
            let camera = flight.camera(&parts.photos[*index]);
            f64::from(camera.width) / seen.scale
        });
        let radius = match parts.unit_known {
            true => RING / parts.unit.metres(),
            false => across.unwrap_or_default() * RING_OF_FOOTPRINT,
        };
        Self {
            point,
            // A surface that cannot be triangulated there has no ring; opening the flight has said so.
            ring: surface.ring(point, radius).unwrap_or_default(),
            radius,
            is_ten_centimetres: parts.unit_known,
            seen,
        }
    }

    /// Where a photo shows it.
    pub fn in_photo(&self, photo: usize) -> Option<Sighting> {
        let seen = self.seen.iter().find(|(index, _)| *index == photo);
        seen.map(|(_, sighting)| *sighting)
    }

    /// The coordinates, as they are copied: full precision, with tabs between them.
    pub fn coordinates(&self) -> String {
        let [x, y, z] = self.point.to_array();
        format!("{x}\t{y}\t{z}")
    }
}
