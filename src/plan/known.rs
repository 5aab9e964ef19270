//! Which ground a plan needs, and what a plan before it knows: who drags a corner of the area, or asks for another overlap,
//! does not wait for the whole ground and for all photos to be looked at again.
//!
//! The plan is the same whatever was known before.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::photo::PlannedPhoto;
use super::terrain::Terrain;
use super::wish::Wish;
use super::{Plan, elsewhere, footprint};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::geometry::extent;
use crate::jobs::Progress;
use crate::surface::Surface;
use crate::survey::Polygon;

/// Pixels of the terrain along the shorter side of a footprint.
const FINENESS: f64 = 24.0;

/// The ground that a plan looks at.
pub(super) struct Need {
    /// Least and greatest x and y.
    extent: [DVec2; 2],
    /// The side of its pixels.
    pixel: f64,
}

impl Need {
    /// The ground under an area and around it, as far as photos of it may look from the farthest of the distances, and as far
    /// as the take-off; as fine as those from the nearest need it.
    ///
    /// # Errors
    /// Where none of it is surface.
    pub(super) fn of(
        surface: &Surface,
        camera: &Camera,
        area: &Polygon,
        (wish, [nearest, farthest]): (&Wish, [f64; 2]),
    ) -> Result<Self, Fault> {
        let [min, max] = extent(area.corners());
        let around = footprint(camera, farthest).max_element() + farthest;
        let middle = (min + max) / 2.0;
        let (mut min, mut max) = (min - around, max + around);
        let bounds = surface.bounds();
        let [low, high] = [bounds.min.truncate(), bounds.max.truncate()];
        if !(min.cmplt(high).all() && max.cmpgt(low).all()) {
            return Err(elsewhere(
                "the area does not lie on the surface",
                middle,
                surface,
            ));
        }
        if let Some(place) = wish.take_off {
            min = min.min(place - wish.clearance);
            max = max.max(place + wish.clearance);
        }
        let extent = [min.max(low), max.min(high)];
        let pixel = footprint(camera, nearest).min_element() / FINENESS;
        Ok(Self { extent, pixel })
    }

    /// The terrain.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub(super) fn terrain(
        &self,
        surface: &Surface,
        before: Option<&Plan>,
        progress: &Progress,
    ) -> Result<Terrain, Fault> {
        let known = before.map(|before| &before.terrain);
        Terrain::of(surface, self.extent, self.pixel, known, progress)
    }
}

/// What is known of photos.
pub(super) struct Known<'a>(HashMap<[u64; 3], Vec<&'a PlannedPhoto>>);

impl<'a> Known<'a> {
    /// What a plan knows of photos by this camera, whose errors are these, over this ground.
    pub(super) fn of(
        before: Option<&'a Plan>,
        camera: &Camera,
        wish: &Wish,
        terrain: &Terrain,
    ) -> Self {
        let same = before.filter(|before| {
            before.camera == *camera
                && before.wish.errors == wish.errors
                && before.terrain.raster().pixel == terrain.raster().pixel
        });
        let mut known: HashMap<_, Vec<_>> = HashMap::new();
        for photo in same.iter().flat_map(|before| &before.photos) {
            known.entry(place(photo)).or_default().push(photo);
        }
        Self(known)
    }

    /// Says what a photo from the same pose will show; false where there was none.
    pub(super) fn say(&self, photo: &mut PlannedPhoto) -> bool {
        let same = self.0.get(&place(photo)).and_then(|there| {
            let mut there = there.iter();
            there.find(|known| known.pose == photo.pose && known.target == photo.target)
        });
        let Some(same) = same else {
            return false;
        };
        photo.forecast = same.forecast;
        photo.outline.clone_from(&same.outline);
        photo.interval = same.interval;
        true
    }
}

fn place(photo: &PlannedPhoto) -> [u64; 3] {
    let DVec3 { x, y, z } = photo.pose.center;
    [x, y, z].map(f64::to_bits)
}
