//! Where photos are taken from: the patterns.
//!
//! - **paper**: rows at one height, one tilt for all, no overlap (Bamford, Esmaeili & Schoellig 2017, section III).
//! - **slope**: each photo looks along the normal of the ground, smoothed over a footprint, from the distance that
//!   gives the scale. Photos lie edge to edge in strips that run up and down the slopes, measured along the ground:
//!   the direction in which the ground rises most, in the mean, is that of the strips. A drone's camera has no roll
//!   of its own, so that a photo's up is uphill: where the ground falls along its strip, to [`Wish::off_normal`]
//!   degrees, the photo lies square in it; else it is turned, and shares more with its neighbours.
//! - **survey**: rows straight down, with overlap both ways, and a row on each side that looks aslant at the middle:
//!   what a reconstruction needs.
//!
//! ```text
//! one_photo  where it is taken from, whether the drone may go there, what it will show
//! strips     in which photos lie, and places along the ground
//! ```

mod one_photo;
mod strips;

use glam::DVec2;

use super::footprint;
use super::photo::{PlannedPhoto, Refused};
use super::terrain::{Terrain, ground_at};
use super::wish::{Size, Wish};
use crate::camera::Camera;
use crate::geometry::surrounds;
use crate::surface::Surface;
use crate::survey::Polygon;
use one_photo::azimuth;
use strips::{evenly, range_of};

/// How photos lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Pattern {
    /// Rows at one height, one tilt for all.
    Paper,
    /// Each photo looks along the normal of the ground.
    #[default]
    Slope,
    /// With overlap, for a reconstruction.
    Survey,
}

impl Pattern {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Slope, Self::Paper, Self::Survey];

    /// Its name on the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Slope => "slope",
            Self::Survey => "survey",
        }
    }

    /// Its name in the window.
    pub fn title(self) -> &'static str {
        match self {
            Self::Paper => "Rows",
            Self::Slope => "Along the slope",
            Self::Survey => "Survey",
        }
    }

    /// The overlap that is usual of it, 0 to under 1.
    pub fn usual_overlap(self) -> f64 {
        match self {
            Self::Paper | Self::Slope => 0.0,
            Self::Survey => SURVEY_OVERLAP,
        }
    }

    /// What speaks for it.
    pub fn explained(self) -> &'static str {
        match self {
            Self::Paper => "Rows at one height, the camera tilted alike in all, without overlap",
            Self::Slope => {
                "Each photo looks along the normal of the ground from the distance that gives the scale"
            }
            Self::Survey => {
                "Overlapping rows straight down and a row aslant on each side, for a reconstruction"
            }
        }
    }
}

/// Overlap of the survey where nobody says it.
const SURVEY_OVERLAP: f64 = 0.7;
/// Why there is no plane of the ground.
const NO_GROUND: &str = "most of the photo would look beyond the surface, or into a hole of it";
/// The tilt of the survey's photos that look aslant, degrees below the horizon.
const ASLANT: f64 = 50.0;
/// The most photos: more is a mistake of units.
pub(in crate::plan) const MOST: usize = 20_000;

/// What the patterns work on.
pub(in crate::plan) struct Ground<'a> {
    camera: &'a Camera,
    area: &'a Polygon,
    terrain: &'a Terrain,
    wish: &'a Wish,
    /// The highest that the surface is at a corner of the area.
    highest_corner: Option<f64>,
    /// The distance along the axis, world units.
    distance: f64,
}

impl<'a> Ground<'a> {
    pub(in crate::plan) fn new(
        (surface, terrain): (&Surface, &'a Terrain),
        camera: &'a Camera,
        area: &'a Polygon,
        wish: &'a Wish,
        distance: f64,
    ) -> Self {
        // Pixels of the terrain are looked at in their middles; the highest place of a slope is at a corner.
        let corners = area.corners().iter();
        let highest = corners.filter_map(|corner| ground_at(surface, *corner));
        Self {
            highest_corner: highest.reduce(f64::max),
            camera,
            area,
            terrain,
            wish,
            distance,
        }
    }

    /// A photo of a place, as the pattern has it; of photos of one tilt it looks as another one does.
    pub(in crate::plan) fn photo_of(
        &self,
        place: DVec2,
        like: &PlannedPhoto,
    ) -> Result<PlannedPhoto, String> {
        match self.wish.pattern {
            Pattern::Slope => self.square_to_ground(place, self.strips().along),
            Pattern::Paper | Pattern::Survey => {
                let side = self.footprint().max_element();
                let ground = self.terrain.plane(place, side).ok_or(NO_GROUND)?;
                let target = place.extend(self.level());
                Ok(self.looking_at(target, [like.tilt, like.pan], ground))
            }
        }
    }

    /// A photo's width and height on a plane across its axis, at the distance.
    fn footprint(&self) -> DVec2 {
        footprint(self.camera, self.distance)
    }

    pub(in crate::plan) fn photos(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        match self.wish.pattern {
            Pattern::Slope => self.slope(),
            Pattern::Paper => self.rows(self.wish.tilt),
            Pattern::Survey => self.survey(),
        }
    }

    fn slope(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        let strips = self.strips();
        let footprint = self.footprint();
        let step = footprint * (1.0 - self.wish.overlap);
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

    /// Rows at one height over the area, all of one tilt, every second row flown backwards.
    fn rows(&self, tilt: f64) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        let sine = tilt.to_radians().sin();
        let footprint = self.footprint() * DVec2::new(1.0, 1.0 / sine);
        let strips = self.longest_side();
        let step = footprint * (1.0 - self.wish.overlap);
        let corners = || {
            self.area
                .corners()
                .iter()
                .map(|&c| strips.strips_from_world(c))
        };
        let across = range_of(corners().map(|c| c.y));
        let level = self.level();
        let (mut photos, mut refused) = (Vec::new(), Vec::new());
        for (row, across) in evenly(across, step.x).into_iter().enumerate() {
            let Some(range) = self.in_strip(&strips, across, footprint.x) else {
                continue;
            };
            let mut places = evenly(range, step.y);
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
                    let why = NO_GROUND.to_owned();
                    refused.push(Refused { place, why });
                    continue;
                };
                let target = place.extend(level);
                photos.push(self.looking_at(target, [tilt, azimuth(looks)], ground));
            }
        }
        (photos, refused)
    }

    fn survey(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        let (mut photos, refused) = self.rows(90.0);
        let strips = self.longest_side();
        let corners = || {
            self.area
                .corners()
                .iter()
                .map(|&c| strips.strips_from_world(c))
        };
        let (along, across) = (
            range_of(corners().map(|c| c.x)),
            range_of(corners().map(|c| c.y)),
        );
        let middle = DVec2::new(along.0 + along.1, across.0 + across.1) / 2.0;
        let half = DVec2::new(along.1 - along.0, across.1 - across.0) / 2.0;
        let step = self.footprint().x * (1.0 - self.wish.overlap);
        for (looks, reach) in [
            (strips.along, half.y),
            (-strips.along, half.y),
            (strips.along.perp(), half.x),
            (-strips.along.perp(), half.x),
        ] {
            let center = strips.place(middle.x, middle.y);
            for beside in evenly((-reach, reach), step) {
                let place = center + looks.perp() * beside;
                let side = self.footprint().max_element();
                if let Some(ground) = self.terrain.plane(place, side) {
                    let target = place.extend(self.level());
                    photos.push(self.looking_at(target, [ASLANT, azimuth(looks)], ground));
                }
            }
        }
        (photos, refused)
    }

    /// The height that photos of one height look at: the area's mean, where the scale is to be right; the highest
    /// of it, where the height above is said.
    fn level(&self) -> f64 {
        let inside = (self.terrain.points())
            .filter(|point| surrounds(self.area.corners(), point.truncate()));
        let heights: Vec<f64> = inside.map(|point| point.z).collect();
        match self.wish.size {
            Size::Scale { .. } => heights.iter().sum::<f64>() / heights.len().max(1) as f64,
            Size::Distance(_) => {
                (heights.iter().copied()).fold(self.highest_corner.unwrap_or(f64::MIN), f64::max)
            }
        }
    }
}
