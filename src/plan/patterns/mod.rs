//! Where photos are taken from: the patterns.
//!
//! - **paper**: rows at one height, one tilt for all, no overlap (Bamford, Esmaeili & Schoellig 2017, section III).
//! - **slope**: each photo looks along the normal of the ground, smoothed over a footprint, from the distance that
//!   gives the scale. Photos lie edge to edge in strips that run up and down the slopes, measured along the ground:
//!   the direction in which the ground rises most, in the mean, is that of the strips. A drone's camera has no roll
//!   of its own, so that a photo's up is uphill: where the ground falls along its strip, to [`Wish::off_normal`]
//!   degrees, the photo lies square in it; else it is turned, and shares more with its neighbours.
//! - **survey**: what a reconstruction needs: rows straight down with overlap both ways, the same across, and a ring of
//!   photos around the area that look aslant into it.
//! - **both**: photos for scales in one of the first two, and a survey, in one flight.
//!
//! ```text
//! one_photo  where it is taken from, whether the drone may go there, what it will show
//! ring       aslant, around the area
//! strips     in which photos lie, and places along the ground
//! ```

mod one_photo;
mod ring;
mod strips;

use std::sync::OnceLock;

use glam::DVec2;

use super::photo::{NO_GROUND, PlannedPhoto, Purpose, Refused};
use super::terrain::{Terrain, ground_at};
use super::wish::{Size, Wish};
use super::{distance, footprint};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::geometry::surrounds;
use crate::surface::Surface;
use crate::survey::Polygon;
use one_photo::azimuth;
#[cfg(test)]
pub(super) use ring::{ASLANT, TURN};
use strips::{Strips, evenly, range_of};

/// The tilt of a survey's rows.
pub(in crate::plan) const STRAIGHT_DOWN: f64 = 90.0;
/// The most photos: more is a mistake of units.
pub(in crate::plan) const MOST: usize = 20_000;

/// What the patterns work on: photos for one purpose.
pub(in crate::plan) struct Ground<'a> {
    camera: &'a Camera,
    area: &'a Polygon,
    terrain: &'a Terrain,
    wish: &'a Wish,
    purpose: Purpose,
    /// The highest that the surface is at a corner of the area.
    highest_corner: Option<f64>,
    /// The distance along the axis, world units.
    distance: f64,
    /// [`Ground::level`], once it is known.
    level: OnceLock<f64>,
}

impl<'a> Ground<'a> {
    /// The ground for photos of a wish with a purpose.
    ///
    /// # Errors
    /// Where the wish says no distance.
    pub(in crate::plan) fn new(
        (surface, terrain): (&Surface, &'a Terrain),
        camera: &'a Camera,
        area: &'a Polygon,
        (wish, purpose): (&'a Wish, Purpose),
    ) -> Result<Self, Fault> {
        // Pixels of the terrain are looked at in their middles; the highest place of a slope is at a corner.
        let corners = area.corners().iter();
        let highest = corners.filter_map(|corner| ground_at(surface, *corner));
        Ok(Self {
            highest_corner: highest.reduce(f64::max),
            camera,
            area,
            terrain,
            wish,
            purpose,
            distance: distance(camera, wish.size_of(purpose))?,
            level: OnceLock::new(),
        })
    }

    /// Whether a photo is one of its own.
    pub(in crate::plan) fn is_for(&self, photo: &PlannedPhoto) -> bool {
        photo.purpose == self.purpose
    }

    /// What its photos are of, for people.
    pub(in crate::plan) fn what(&self) -> &'static str {
        match (self.purpose, self.wish.pattern.purposes()) {
            (_, [_]) => "the area",
            (Purpose::Scale, _) => "the area for scales",
            (Purpose::Survey, _) => "the survey",
        }
    }

    /// Whether its photos look along the normal of the ground.
    fn is_square(&self) -> bool {
        self.purpose == Purpose::Scale && self.wish.pattern.is_square()
    }

    fn overlap(&self) -> f64 {
        self.wish.overlap_of(self.purpose)
    }

    /// A photo of a place, as the pattern has it; of photos of one tilt it looks as another one does.
    pub(in crate::plan) fn photo_of(
        &self,
        place: DVec2,
        like: &PlannedPhoto,
    ) -> Result<PlannedPhoto, String> {
        if self.is_square() {
            return self.square_to_ground(place, self.strips().along);
        }
        let side = self.footprint().max_element();
        let ground = self.terrain.plane(place, side).ok_or(NO_GROUND)?;
        let target = place.extend(self.level());
        Ok(self.looking_at(target, [like.tilt, like.pan], ground))
    }

    /// A photo's width and height on a plane across its axis, at the distance.
    fn footprint(&self) -> DVec2 {
        footprint(self.camera, self.distance)
    }

    pub(in crate::plan) fn photos(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        match self.purpose {
            Purpose::Survey => self.survey(),
            Purpose::Scale if self.is_square() => self.slope(),
            Purpose::Scale => self.rows(&self.longest_side(), self.wish.tilt),
        }
    }

    fn slope(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        let strips = self.strips();
        let footprint = self.footprint();
        let step = footprint * (1.0 - self.overlap());
        let corners = self.area.corners().iter();
        let across: Vec<f64> = corners.map(|&c| strips.strips_from_world(c).y).collect();
        let range = range_of(across.iter().copied());
        // Strips are told apart along the ground through the area's middle.
        let middle = |across: f64| strips.place(0.0, across);
        let (mut photos, mut refused) = (Vec::new(), Vec::new());
        for (strip, across) in self.walk(range, step.x, middle).into_iter().enumerate() {
            let Some(range) = self.in_strip(&strips, across, footprint.x) else {
                continue;
            };
            let mut places = self.walk(range, step.y, |along| strips.place(along, across));
            if strip % 2 == 1 {
                places.reverse();
            }
            for along in places {
                if photos.len() + refused.len() >= MOST {
                    break;
                }
                let place = strips.place(along, across);
                match self.square_to_ground(place, strips.along) {
                    Ok(photo) => photos.push(photo),
                    Err(why) => refused.push(Refused { place, why }),
                }
            }
        }
        (photos, refused)
    }

    /// Rows at one height over the area, all of one tilt, every second row flown backwards. Those of a survey begin and end
    /// over its edge or beyond, so that the edge is in as many photos as the middle.
    fn rows(&self, strips: &Strips, tilt: f64) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        let sine = tilt.to_radians().sin();
        let footprint = self.footprint() * DVec2::new(1.0, 1.0 / sine);
        let step = footprint * (1.0 - self.overlap());
        let corners = || {
            self.area
                .corners()
                .iter()
                .map(|&c| strips.strips_from_world(c))
        };
        let across = range_of(corners().map(|c| c.y));
        let beyond = match self.purpose {
            Purpose::Scale => DVec2::ZERO,
            Purpose::Survey => step / 2.0,
        };
        let reaching = |(from, to): (f64, f64), beyond: f64| (from - beyond, to + beyond);
        let level = self.level();
        let (mut photos, mut refused) = (Vec::new(), Vec::new());
        let rows = evenly(reaching(across, beyond.x), step.x);
        for (row, across) in rows.into_iter().enumerate() {
            let Some(range) = self.in_strip(strips, across, footprint.x) else {
                continue;
            };
            let mut places = evenly(reaching(range, beyond.y), step.y);
            let mut looks = strips.along;
            if row % 2 == 1 {
                places.reverse();
                looks = -looks;
            }
            for along in places {
                if photos.len() + refused.len() >= MOST {
                    break;
                }
                let place = strips.place(along, across);
                let side = footprint.max_element();
                let Some(ground) = self.terrain.plane(place, side) else {
                    refused.push(Refused::without_ground(place));
                    continue;
                };
                let target = place.extend(level);
                photos.push(self.looking_at(target, [tilt, azimuth(looks)], ground));
            }
        }
        (photos, refused)
    }

    /// Rows straight down, the same across them, and the ring, as far as they are wished.
    fn survey(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        let strips = self.longest_side();
        let (mut photos, mut refused) = self.rows(&strips, STRAIGHT_DOWN);
        let mut add = |(more, not): (Vec<_>, Vec<_>)| {
            photos.extend(more);
            refused.extend(not);
        };
        if self.wish.survey.cross {
            let across = Strips {
                along: strips.along.perp(),
                ..strips
            };
            add(self.rows(&across, STRAIGHT_DOWN));
        }
        if self.wish.survey.ring {
            add(self.ring());
        }
        (photos, refused)
    }

    /// The height that photos of one height look at: the area's mean, where the scale is to be right; the highest
    /// of it, where the height above is said.
    fn level(&self) -> f64 {
        *self.level.get_or_init(|| self.level_of_area())
    }

    fn level_of_area(&self) -> f64 {
        let inside = (self.terrain.points())
            .filter(|point| surrounds(self.area.corners(), point.truncate()));
        let heights: Vec<f64> = inside.map(|point| point.z).collect();
        match self.wish.size_of(self.purpose) {
            Size::Scale { .. } => heights.iter().sum::<f64>() / heights.len().max(1) as f64,
            Size::Distance(_) => {
                (heights.iter().copied()).fold(self.highest_corner.unwrap_or(f64::MIN), f64::max)
            }
        }
    }
}
