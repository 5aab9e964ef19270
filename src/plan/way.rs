//! The way through photos in their order, and which climbs keep the drone off the ground between them.
//!
//! The way begins and ends at the take-off, and goes up to a safe height before the first photo and behind the last: as
//! stops of their own, for some ground stations know no such height, and fly straight. Where one battery does not
//! last, or a mission's file does not take all of it, the way is parted: each part goes out from the take-off and back to
//! it. A leg that comes too near to the ground goes up first, over, and down: straight up and down is free, for the ground
//! has one height at each place. A leg that would lead over an area to keep out of goes around it. A leg that climbs or
//! falls more steeply than is wished ([`Pace::steepest`]) is flown in two, one straight up or down and one level, on the
//! higher side: multirotors may climb upright, and no slanted leg passes along a face.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::keep_out::KeepOut;
use super::terrain::ground_at;
use super::{Plan, elsewhere};
use crate::fault::Fault;
use crate::surface::Surface;

/// A place that the drone flies to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayPoint {
    /// In the world.
    pub place: DVec3,
    /// The photo that is taken there, by its place in the plan.
    pub photo: Option<usize>,
}

/// The way through all photos.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Where the drone takes off and lands, on the ground.
    pub take_off: DVec3,
    /// The height in the world at which it begins and ends: above all on its first and last leg.
    pub safe_height: f64,
    /// In order; take-off and landing are not among them.
    pub points: Vec<WayPoint>,
    /// The length of all of it, world units, with climb and descent at take-off.
    pub length: f64,
}

/// Seconds for turning, the gimbal's way and the shot, beside the wait.
const SHOT: f64 = 2.0;
/// How hard a drone brakes and starts, metres a second squared.
const PULL: f64 = 2.0;
/// Metres a second between photos.
pub const USUAL_SPEED: f64 = 4.0;
/// No drone for photos flies faster, metres a second.
pub const MOST_SPEED: f64 = 25.0;
/// Seconds that a drone waits at a photo, for the gimbal to settle.
pub const USUAL_SETTLE: f64 = 2.0;
/// Metres a second upwards: what DJI's page "Specs" of the Phantom 4 RTK has, the slowest of the drones that are known.
pub const USUAL_CLIMB: f64 = 5.0;
/// Metres a second downwards, of the same.
pub const USUAL_DESCENT: f64 = 3.0;
/// A leg that rises by less than this part of its length is level, and one that is so near to upright is that.
const LEVEL: f64 = 1e-6;

/// How a drone is flown from photo to photo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flying {
    /// Metres a second between photos.
    pub speed: f64,
    /// Seconds that it waits at a photo, for the gimbal to settle.
    pub settle: f64,
    /// Minutes in the air that a battery lasts; `None` where nobody asks.
    pub battery: Option<f64>,
    /// Metres a second upwards, at most.
    pub climb: f64,
    /// Metres a second downwards, at most.
    pub descent: f64,
    /// How steeply a slanted leg may climb or fall, degrees; `None` is as it comes.
    pub steepest: Option<f64>,
}

impl Default for Flying {
    /// What is usual.
    fn default() -> Self {
        Self {
            speed: USUAL_SPEED,
            settle: USUAL_SETTLE,
            battery: None,
            climb: USUAL_CLIMB,
            descent: USUAL_DESCENT,
            steepest: None,
        }
    }
}

/// What a battery has to last for, and how legs are flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// World units a second.
    pub speed: f64,
    /// Seconds that the drone stands still for a photo.
    pub stop: f64,
    /// Seconds in the air that a battery lasts; `None` where nobody asks.
    pub battery: Option<f64>,
    /// World units a second upwards, at most.
    pub climb: f64,
    /// World units a second downwards, at most.
    pub descent: f64,
    /// How steeply a slanted leg may climb or fall, degrees; `None` is as it comes.
    pub steepest: Option<f64>,
}

impl Pace {
    /// Of a drone that is flown so, in a world whose unit has so many metres.
    pub fn of(flying: &Flying, unit_metres: f64) -> Self {
        Self {
            speed: flying.speed / unit_metres,
            // Braking and starting again take as long as the speed at an even pull.
            stop: flying.settle + SHOT + flying.speed / PULL,
            battery: flying.battery.map(|minutes| minutes * 60.0),
            climb: flying.climb / unit_metres,
            descent: flying.descent / unit_metres,
            steepest: flying.steepest,
        }
    }

    /// Seconds for a straight leg.
    pub fn seconds(&self, from: DVec3, to: DVec3) -> f64 {
        let rise = to.z - from.z;
        let upright = match rise > 0.0 {
            true => rise / self.climb,
            false => -rise / self.descent,
        };
        (from.distance(to) / self.speed).max(upright)
    }

    /// Whether a leg is slanted, and more steeply than is wished.
    pub fn is_too_steep(&self, from: DVec3, to: DVec3) -> bool {
        let (level, rise) = (
            from.truncate().distance(to.truncate()),
            (to.z - from.z).abs(),
        );
        let is_slanted = level > LEVEL * rise && rise > LEVEL * level;
        is_slanted
            && self
                .steepest
                .is_some_and(|steepest| rise.atan2(level).to_degrees() > steepest)
    }
}

impl Way {
    /// The ways through the photos of a plan, from a place of its surface and back: as many as batteries are needed.
    ///
    /// # Errors
    /// Where the place is not on the surface, a battery does not last for a single photo, or no way leads around what is
    /// kept out of.
    pub fn through(
        plan: &Plan,
        surface: &Surface,
        take_off: DVec2,
        pace: &Pace,
    ) -> Result<Vec<Self>, Fault> {
        let ground = ground_at(surface, take_off).ok_or_else(|| {
            let what = "the take-off does not lie on the surface";
            elsewhere(what, take_off, surface)
        })?;
        let fits_anywhere = |_: &Self| true;
        Pilot::new(plan, take_off.extend(ground), pace, &fits_anywhere)?.ways()
    }

    /// The photos of ways parted anew: by battery, and so that each way fits what takes so many stops only, as the file of a
    /// mission. Each goes out from the take-off and back to it.
    ///
    /// # Errors
    /// As [`Way::through`], and where the way to a single photo does not fit.
    pub fn parted(
        plan: &Plan,
        ways: &[Self],
        pace: &Pace,
        fits: &dyn Fn(&Self) -> bool,
    ) -> Result<Vec<Self>, Fault> {
        match ways.first() {
            None => Ok(Vec::new()),
            Some(way) => Pilot::new(plan, way.take_off, pace, fits)?.ways(),
        }
    }

    /// Seconds in the air.
    pub fn seconds(&self, pace: &Pace) -> f64 {
        let legs = self.corners();
        let legs = legs.windows(2).map(|leg| pace.seconds(leg[0], leg[1]));
        legs.sum::<f64>() + pace.stop * self.photos() as f64
    }

    /// Seconds in the air until a photo of the plan is taken; `None` where this way does not lead there.
    pub fn seconds_to(&self, photo: usize, pace: &Pace) -> Option<f64> {
        let mut last = self.above_take_off();
        let mut seconds = pace.seconds(self.take_off, last);
        for point in &self.points {
            seconds += pace.seconds(last, point.place);
            last = point.place;
            seconds += point.photo.map_or(0.0, |_| pace.stop);
            if point.photo == Some(photo) {
                return Some(seconds);
            }
        }
        None
    }

    /// All of it from the ground to the ground, corner by corner.
    pub fn corners(&self) -> Vec<DVec3> {
        let up = self.above_take_off();
        let points = self.points.iter().map(|point| point.place);
        let out = [self.take_off, up].into_iter().chain(points);
        out.chain([up, self.take_off]).collect()
    }

    /// Over the take-off, at the safe height.
    fn above_take_off(&self) -> DVec3 {
        self.take_off.truncate().extend(self.safe_height)
    }

    /// How many photos are taken.
    pub fn photos(&self) -> usize {
        self.points
            .iter()
            .filter(|point| point.photo.is_some())
            .count()
    }
}

/// Who flies the photos of a plan.
struct Pilot<'a> {
    plan: &'a Plan,
    /// On the ground.
    take_off: DVec3,
    keep_out: KeepOut<'a>,
    pace: &'a Pace,
    /// Whether a way does not have too many stops.
    fits: &'a dyn Fn(&Way) -> bool,
}

impl<'a> Pilot<'a> {
    /// Who takes off from a place on the ground.
    ///
    /// # Errors
    /// Where nobody takes off from there.
    fn new(
        plan: &'a Plan,
        take_off: DVec3,
        pace: &'a Pace,
        fits: &'a dyn Fn(&Way) -> bool,
    ) -> Result<Self, Fault> {
        let keep_out = KeepOut::new(&plan.wish.keep_out, plan.wish.clearance)?;
        if keep_out.holds(take_off.truncate()) {
            let what = "the take-off lies in an area to keep out of, or too near to it";
            return Err(Fault::new(what, "take off elsewhere"));
        }
        Ok(Self {
            plan,
            take_off,
            keep_out,
            pace,
            fits,
        })
    }
}

impl Pilot<'_> {
    /// The ways through all photos, as few as there may be.
    fn ways(&self) -> Result<Vec<Way>, Fault> {
        let (mut first, end) = (0, self.plan.photos.len());
        let mut ways = Vec::new();
        while first < end {
            let Some((reached, way)) = self.longest(first)? else {
                let name = &self.plan.photos[first].name;
                let alone = self.over(first..first + 1)?;
                let what = match self.lasts(&alone) {
                    false => format!("a battery does not last to photo {name} and back"),
                    true => format!(
                        "the way to photo {name} and back has more stops than a mission takes"
                    ),
                };
                let remedy = "take off nearer, fly faster, or leave it out of the area";
                return Err(Fault::new(what, remedy));
            };
            ways.push(way);
            first = reached;
        }
        Ok(ways)
    }

    /// Whether a battery lasts for a way.
    fn lasts(&self, way: &Way) -> bool {
        let battery = self.pace.battery;
        battery.is_none_or(|battery| way.seconds(self.pace) <= battery)
    }

    /// The way from a photo on through as many as a battery lasts for and as fit, and behind which it ends; `None` where that
    /// is not one.
    fn longest(&self, first: usize) -> Result<Option<(usize, Way)>, Fault> {
        let end = self.plan.photos.len();
        let flown = |end: usize| -> Result<Option<(usize, Way)>, Fault> {
            let way = self.over(first..end)?;
            let is_one = self.lasts(&way) && (self.fits)(&way);
            Ok(is_one.then_some((end, way)))
        };
        if let Some(all) = flown(end)? {
            return Ok(Some(all));
        }
        // One photo more always takes longer, and more stops.
        let (mut reached, mut too_far, mut longest) = (first, end, None);
        while too_far - reached > 1 {
            let middle = (reached + too_far) / 2;
            match flown(middle)? {
                Some(found) => (reached, longest) = (middle, Some(found)),
                None => too_far = middle,
            }
        }
        Ok(longest)
    }

    /// Over which places one flies from one to the other: both ends, and what lies between.
    fn course(&self, from: DVec3, to: DVec3) -> Result<Vec<DVec2>, Fault> {
        let course = self.keep_out.course(from.truncate(), to.truncate());
        course.ok_or_else(|| {
            let what = format!(
                "no way leads to ({:.1}, {:.1}) around the areas to keep out of",
                to.x, to.y
            );
            Fault::new(what, "take off elsewhere, or leave that place out")
        })
    }

    /// The least height that keeps the clearance all along a course.
    fn height_over(&self, course: &[DVec2]) -> f64 {
        let clearance = self.plan.wish.clearance;
        let highest = course.windows(2).filter_map(|leg| {
            let terrain = &self.plan.terrain;
            terrain.highest_along(leg[0], leg[1], clearance)
        });
        highest.fold(f64::MIN, f64::max) + clearance
    }

    /// Through these photos of the plan, one at least.
    fn over(&self, photos: Range<usize>) -> Result<Way, Fault> {
        let Self { plan, take_off, .. } = *self;
        let place_of = |photo: usize| plan.photos[photo].pose.center;
        let clearance = plan.wish.clearance;
        let ends = [photos.start, photos.end - 1].map(place_of);
        let out = self.course(take_off, ends[0])?;
        let home = self.course(ends[1], take_off)?;
        let safe_height = [take_off.z + clearance, ends[0].z, ends[1].z]
            .into_iter()
            .chain([&out, &home].map(|course| self.height_over(course)))
            .fold(f64::MIN, f64::max);
        let mut points: Vec<WayPoint> = Vec::new();
        let by = |place: DVec3| WayPoint { place, photo: None };
        let at_height = |height: f64| move |place: &DVec2| by(place.extend(height));
        points.extend(out[1..].iter().map(at_height(safe_height)));
        // Where the photo is taken from there anyway.
        points.pop_if(|above| above.place == ends[0]);
        for photo in photos {
            let to = place_of(photo);
            if let Some(last) = points.last().copied()
                && last.photo.is_some()
            {
                let course = self.course(last.place, to)?;
                let is_near = |leg: &[DVec3]| plan.terrain.is_leg_near(leg[0], leg[1], clearance);
                let bend = self.pace.is_too_steep(last.place, to).then(|| {
                    // On the higher side, for there it is farther from the ground.
                    match to.z > last.place.z {
                        true => last.place.truncate().extend(to.z),
                        false => to.truncate().extend(last.place.z),
                    }
                });
                let direct: Vec<DVec3> = [Some(last.place), bend, Some(to)]
                    .into_iter()
                    .flatten()
                    .collect();
                if course.len() == 2 && !direct.windows(2).any(is_near) {
                    points.extend(bend.map(by));
                } else {
                    let height = self.height_over(&course).max(last.place.z).max(to.z);
                    let over = course.iter().map(at_height(height));
                    points.extend(over.filter(|over| over.place != last.place && over.place != to));
                }
            }
            points.push(WayPoint {
                place: to,
                photo: Some(photo),
            });
        }
        let back = home[..home.len() - 1].iter().map(at_height(safe_height));
        points.extend(back.filter(|above| above.place != ends[1]));
        let mut way = Way {
            take_off,
            safe_height,
            points,
            length: 0.0,
        };
        let legs = way.corners();
        way.length = legs.windows(2).map(|leg| leg[0].distance(leg[1])).sum();
        Ok(way)
    }
}
