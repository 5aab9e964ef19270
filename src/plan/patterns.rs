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

use glam::{DMat2, DVec2, DVec3};

use super::footprint;
use super::forecast::{Forecast, bulk_of};
use super::keep_out::KeepOut;
use super::photo::{PlannedPhoto, Refused};
use super::steadiness::interval;
use super::terrain::{GroundPlane, Terrain, ground_at};
use super::wish::{Size, Wish};
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::{extent, surrounds};
use crate::jobs::Progress;
use crate::surface::Surface;
use crate::survey::Polygon;

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
/// How many steps an edge of a footprint is walked in, along the ground.
const STEPS: f64 = 8.0;
/// The tilt of the survey's photos that look aslant, degrees below the horizon.
const ASLANT: f64 = 50.0;
/// The most photos: more is a mistake of units.
pub(super) const MOST: usize = 20_000;

/// How often the distance of a photo is set so that its scales lie around the wished one.
const ROUNDS: usize = 3;

/// What the patterns work on.
pub(super) struct Ground<'a> {
    camera: &'a Camera,
    area: &'a Polygon,
    terrain: &'a Terrain,
    wish: &'a Wish,
    /// The highest that the surface is at a corner of the area.
    highest_corner: Option<f64>,
    /// The distance along the axis, world units.
    distance: f64,
}

/// A frame of the map: its origin, and the directions along and across the strips.
struct Strips {
    origin: DVec2,
    along: DVec2,
}

impl Strips {
    fn place(&self, along: f64, across: f64) -> DVec2 {
        self.origin + self.along * along - self.along.perp() * across
    }

    fn strips_from_world(&self, place: DVec2) -> DVec2 {
        let off = place - self.origin;
        DVec2::new(off.dot(self.along), -off.dot(self.along.perp()))
    }
}

impl<'a> Ground<'a> {
    pub(super) fn new(
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
    pub(super) fn photo_of(
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

    /// Moves a photo of the slope pattern along its axis until the middle of the bulk of its scales is the wished one,
    /// by the terrain's raster.
    pub(super) fn set_distance(&self, photo: &mut PlannedPhoto) {
        let (Pattern::Slope, Size::Scale { pixels, .. }) = (self.wish.pattern, self.wish.size)
        else {
            return;
        };
        let focal = (self.camera.fx * self.camera.fy).sqrt();
        let away = (photo.pose.center - photo.target) / photo.distance;
        for _ in 0..ROUNDS {
            let seen = photo.sees(self.camera, self.terrain);
            let mut scales: Vec<f64> = seen.map(|(_, in_camera)| focal / in_camera.z).collect();
            let Some([least, greatest]) = bulk_of(&mut scales) else {
                return;
            };
            // Both ends move alike, nearly: a few rounds do.
            let middle = (least + greatest) / 2.0;
            photo.distance *= middle / pixels;
            photo.pose.center = photo.target + away * photo.distance;
        }
    }

    /// Why the drone does not go to where a photo is to be taken from, one clause; `None` where it does.
    pub(super) fn not_flown(&self, photo: &PlannedPhoto, keep_out: &KeepOut<'_>) -> Option<String> {
        let from = photo.pose.center;
        if self.terrain.is_near(from, self.wish.clearance) {
            let why = "the drone would come nearer to the ground than the clearance";
            return Some(why.to_owned());
        }
        let why = "the drone would stand over an area to keep out of, or too near to it";
        keep_out.holds(from.truncate()).then(|| why.to_owned())
    }

    /// Says what a photo will show, and how sure its scale is.
    pub(super) fn foresee(
        &self,
        photo: &mut PlannedPhoto,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<(), Fault> {
        let foreseen = Forecast::of(self.camera, &photo.pose, surface, progress)?;
        photo.outline.clear();
        photo.forecast = foreseen.map(|(forecast, outline)| {
            photo.outline = outline;
            forecast
        });
        photo.interval = interval(photo, self.camera, self.terrain, &self.wish.errors);
        Ok(())
    }

    /// A photo's width and height on a plane across its axis, at the distance.
    fn footprint(&self) -> DVec2 {
        footprint(self.camera, self.distance)
    }

    pub(super) fn photos(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
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

    /// A photo that looks at the ground squarely.
    fn square_to_ground(&self, place: DVec2, along: DVec2) -> Result<PlannedPhoto, String> {
        let side = self.footprint().max_element();
        let ground = self.terrain.plane(place, side);
        let ground = ground.ok_or(NO_GROUND)?;
        let normal = ground.normal;
        // The normal's part in the upright plane of the strip.
        let sideways = along.perp().extend(0.0);
        let in_strip = (normal - sideways * normal.dot(sideways)).normalize();
        let axis = match in_strip.angle_between(normal).to_degrees() <= self.wish.off_normal {
            true => -in_strip,
            false => -normal,
        };
        let level = axis.truncate();
        // Uphill; straight down any direction does, so that of the strip.
        let looks = if level.length() < 1e-9 { along } else { level };
        let pitch = axis.z.clamp(-1.0, 1.0).asin().to_degrees();
        let [lowest, highest] = self.wish.gimbal;
        if pitch < lowest || pitch > highest {
            return Err(format!(
                "the gimbal would have to pitch to {pitch:.0} degrees, and goes from {lowest:.0} to {highest:.0}"
            ));
        }
        Ok(self.looking_at(ground.point, [-pitch, azimuth(looks)], ground))
    }

    /// The photo whose middle shows a point from the distance, by tilt and pan in degrees.
    fn looking_at(&self, target: DVec3, angles: [f64; 2], ground: GroundPlane) -> PlannedPhoto {
        let camera = self.camera;
        // A height above all is one: aslant the way to it is longer.
        let distance = match (self.wish.size, self.wish.pattern) {
            (Size::Distance(height), Pattern::Paper | Pattern::Survey) => {
                height / angles[0].to_radians().sin()
            }
            _ => self.distance,
        };
        let middle = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
        let direction = camera.direction_undistorted(middle);
        let direction = direction / direction.z;
        let level = Pose::from_tilt_pan(DVec3::ZERO, angles);
        let center = target - level.rotation * direction * distance;
        let axis = level.rotation * DVec3::Z;
        PlannedPhoto {
            name: String::new(),
            pose: Pose { center, ..level },
            tilt: angles[0],
            pan: angles[1].rem_euclid(360.0),
            target,
            distance,
            off_normal: (-axis).angle_between(ground.normal).to_degrees(),
            // Aslant footprints are longer.
            reach: self.footprint().length() / axis.z.abs().max(0.3),
            forecast: None,
            outline: Vec::new(),
            interval: None,
        }
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

    /// The direction in which the ground rises most in the mean; of level ground that of the longest side.
    fn strips(&self) -> Strips {
        let side = self.footprint().max_element();
        let [min, max] = extent(self.area.corners());
        let mut sum = DMat2::ZERO;
        let mut count = 0_u32;
        let step = ((max - min) / (side / 2.0))
            .ceil()
            .clamp(DVec2::splat(4.0), DVec2::splat(100.0));
        for i in 0..step.x as u32 {
            for j in 0..step.y as u32 {
                let share = (DVec2::new(f64::from(i), f64::from(j)) + 0.5) / step;
                let place = min + (max - min) * share;
                if !surrounds(self.area.corners(), place) {
                    continue;
                }
                if let Some(plane) = self.terrain.plane(place, side) {
                    let slope = -plane.normal.truncate() / plane.normal.z;
                    sum += DMat2::from_cols(slope * slope.x, slope * slope.y);
                    count += 1;
                }
            }
        }
        let longest = self.longest_side();
        let [xx, xy, yy] = [sum.x_axis.x, sum.x_axis.y, sum.y_axis.y];
        // A slope of a few degrees in the mean is level ground.
        if (xx + yy) / f64::from(count.max(1)) < 0.05_f64.powi(2) {
            return longest;
        }
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        Strips {
            along: DVec2::from_angle(angle),
            ..longest
        }
    }

    /// Along the longest side of the area, from its middle.
    fn longest_side(&self) -> Strips {
        let corners = self.area.corners();
        let ends = corners.iter().zip(corners.iter().cycle().skip(1));
        let longest = ends
            .map(|(a, b)| *b - *a)
            .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let sum: DVec2 = corners.iter().map(|c| *c - corners[0]).sum();
        Strips {
            origin: corners[0] + sum / corners.len() as f64,
            along: longest.unwrap_or(DVec2::X).normalize_or(DVec2::X),
        }
    }

    /// From where to where the area lies in a strip of this width; `None` where it does not.
    fn in_strip(&self, strips: &Strips, across: f64, width: f64) -> Option<(f64, f64)> {
        let corners: Vec<DVec2> = (self.area.corners().iter())
            .map(|&c| strips.strips_from_world(c))
            .collect();
        let (low, high) = (across - width / 2.0, across + width / 2.0);
        let mut range: Option<(f64, f64)> = None;
        let mut add = |along: f64| {
            range = Some(range.map_or((along, along), |(from, to)| {
                (from.min(along), to.max(along))
            }));
        };
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            if (low..=high).contains(&a.y) {
                add(a.x);
            }
            for edge in [low, high] {
                if (a.y > edge) != (b.y > edge) {
                    add(a.x + (edge - a.y) / (b.y - a.y) * (b.x - a.x));
                }
            }
        }
        range
    }

    /// Places along a line of the map that are `step` apart along the ground, smoothed over a footprint; the first
    /// and the last reach beyond the range by the same.
    fn walk(&self, range: (f64, f64), step: f64, line: impl Fn(f64) -> DVec2) -> Vec<f64> {
        let side = self.footprint().max_element();
        // Metres along the ground of a metre of the map.
        let stretch = |at: f64| {
            let direction = (line(at + 1.0) - line(at)).normalize();
            let Some(plane) = self.terrain.plane(line(at), side) else {
                return 1.0;
            };
            let slope = -plane.normal.truncate() / plane.normal.z;
            1.0_f64.hypot(slope.dot(direction))
        };
        // Lengths along the ground from the beginning, at steps of the map.
        let small = step / STEPS;
        let mut lengths = vec![0.0];
        let count = ((range.1 - range.0) / small).ceil().clamp(1.0, 1e6);
        let at = |index: f64| range.0 + (range.1 - range.0) * index / count;
        for index in 0..count as u32 {
            let length = (at(1.0) - at(0.0)) * stretch(at(f64::from(index) + 0.5));
            lengths.push(lengths.last().copied().unwrap_or_default() + length);
        }
        let whole = lengths.last().copied().unwrap_or_default();
        let on_map = |length: f64| {
            let next = lengths.partition_point(|known| *known <= length);
            let next = next.clamp(1, lengths.len() - 1);
            let (a, b) = (lengths[next - 1], lengths[next]);
            at((next - 1) as f64 + (length - a) / (b - a))
        };
        evenly((0.0, whole), step).into_iter().map(on_map).collect()
    }
}

/// The middles of so few pieces of this length that they cover a range, and reach beyond both its ends by the same.
fn evenly((from, to): (f64, f64), step: f64) -> Vec<f64> {
    // A range that is a whole number of steps to rounding is that.
    let count = ((to - from) / step - 1e-9).ceil().clamp(1.0, MOST as f64);
    let begin = (from + to) / 2.0 - step * (count - 1.0) / 2.0;
    (0..count as u32)
        .map(|index| begin + step * f64::from(index))
        .collect()
}

fn range_of(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::MAX, f64::MIN), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Degrees clockwise from world +y.
fn azimuth(direction: DVec2) -> f64 {
    direction.x.atan2(direction.y).to_degrees()
}
