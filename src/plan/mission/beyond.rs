//! What of a plan lies beyond the surface: nobody knows the ground there, and no clearance from it is kept.
//!
//! A place is beyond where nothing of the surface, no triangle and no point, lies in the pixel of the terrain below it.

use glam::DVec3;

use crate::plan::terrain::{Terrain, along};
use crate::plan::{Plan, Way};

/// How much of the flight over a plan's photos leads beyond the surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Beyond {
    /// How many stops of the ways lie there; without ways, how many photos are taken from there.
    pub stops: usize,
    /// Of so many.
    pub of_stops: usize,
    /// How many legs of the ways lead there; upright ones count, too.
    pub legs: usize,
    /// Of so many, without those up and down at the take-off; 0 without ways.
    pub of_legs: usize,
    /// How far from the surface that is at most, level, world units.
    pub farthest: f64,
}

impl Beyond {
    /// Of a plan and the ways through its photos, where there are some.
    pub fn of(plan: &Plan, ways: &[Way]) -> Self {
        let terrain = &plan.terrain;
        let mut beyond = Self::default();
        if ways.is_empty() {
            for photo in &plan.photos {
                beyond.add_stop(photo.pose.center, terrain);
            }
        }
        for way in ways {
            for point in &way.points {
                beyond.add_stop(point.place, terrain);
            }
        }
        for way in ways {
            let corners = way.corners();
            let aloft = corners.get(1..corners.len() - 1).unwrap_or_default();
            for leg in aloft.windows(2) {
                beyond.add_leg(leg[0], leg[1], plan);
            }
        }
        beyond
    }

    /// Whether all of it lies over the surface.
    pub fn is_none(&self) -> bool {
        self.stops + self.legs == 0
    }

    fn add_stop(&mut self, place: DVec3, terrain: &Terrain) {
        let off = terrain.distance_beyond(place.truncate());
        self.of_stops += 1;
        // Distances are to corners of pixels: beside one it may be none.
        self.stops += usize::from(!terrain.is_over_surface(place.truncate()));
        self.farthest = self.farthest.max(off);
    }

    fn add_leg(&mut self, from: DVec3, to: DVec3, plan: &Plan) {
        let terrain = &plan.terrain;
        let pixel = terrain.raster().pixel;
        self.of_legs += 1;
        if along(from, to, pixel).all(|place| terrain.is_over_surface(place.truncate())) {
            return;
        }
        self.legs += 1;
        // A place on is farther by as much at most: what cannot be the farthest is passed over.
        let (length, step) = (from.distance(to), pixel.max(plan.wish.clearance / 8.0));
        let mut at = 0.0;
        while at < length {
            let off = terrain.distance_beyond(from.lerp(to, at / length).truncate());
            self.farthest = self.farthest.max(off);
            at += (self.farthest - off).max(step);
        }
    }
}
