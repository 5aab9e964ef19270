//! In which order photos are taken, and which climbs keep the drone off the ground between them.
//!
//! The way begins and ends at the take-off, and goes up to a safe height before the first photo and behind the last: as
//! stops of their own, for some ground stations know no such height, and fly straight. Photos are put in a short order
//! when they are planned: as they were laid out, made shorter by 2-opt (Croes 1958) until no two legs are better
//! swapped; deterministic, and a lawn-mower's rows stay rows, for they are short already. Where one battery does not
//! last, the way is cut: each piece goes out from the take-off and back to it. A leg that comes too near to the ground
//! goes up first, over, and down: straight up and down is free, for the ground has one height at each place. A leg that
//! would lead over an area to keep out of goes around it.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::Plan;
use super::keep_out::KeepOut;
use super::terrain::ground_at;
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

/// A gain of less is rounding.
const GAIN: f64 = 1e-9;
/// Rounds of 2-opt; each goes over all pairs.
const ROUNDS: usize = 40;
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

/// What a battery has to last for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// World units a second.
    pub speed: f64,
    /// Seconds that the drone stands still for a photo.
    pub stop: f64,
    /// Seconds in the air that a battery lasts; `None` where nobody asks.
    pub battery: Option<f64>,
}

impl Pace {
    /// Of a drone that flies so many metres a second between photos and waits so many seconds at each, in a world whose
    /// unit has so many metres; a battery lasts so many minutes.
    pub fn of(speed: f64, settle: f64, battery: Option<f64>, unit_metres: f64) -> Self {
        Self {
            speed: speed / unit_metres,
            // Braking and starting again take as long as the speed at an even pull.
            stop: settle + SHOT + speed / PULL,
            battery: battery.map(|minutes| minutes * 60.0),
        }
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
            Fault::new(what, "give a place on it, in its coordinates")
        })?;
        let pilot = Pilot {
            plan,
            take_off: take_off.extend(ground),
            keep_out: KeepOut::new(&plan.wish.keep_out, plan.wish.clearance)?,
            pace,
        };
        if pilot.keep_out.holds(take_off) {
            let what = "the take-off lies in an area to keep out of, or too near to it";
            return Err(Fault::new(what, "take off elsewhere"));
        }
        let (mut first, end) = (0, plan.photos.len());
        let mut ways = Vec::new();
        while first < end {
            let Some((reached, way)) = pilot.longest(first)? else {
                let name = &plan.photos[first].name;
                let what = format!("a battery does not last to photo {name} and back");
                let remedy = "take off nearer, fly faster, or leave it out of the area";
                return Err(Fault::new(what, remedy));
            };
            ways.push(way);
            first = reached;
        }
        Ok(ways)
    }

    /// Seconds in the air.
    pub fn seconds(&self, pace: &Pace) -> f64 {
        self.length / pace.speed + pace.stop * self.photos() as f64
    }

    /// Seconds in the air until a photo of the plan is taken; `None` where this way does not lead there.
    pub fn seconds_to(&self, photo: usize, pace: &Pace) -> Option<f64> {
        let up = self.take_off.truncate().extend(self.safe_height);
        let mut length = self.take_off.distance(up);
        let (mut last, mut photos) = (up, 0_u32);
        for point in &self.points {
            length += last.distance(point.place);
            last = point.place;
            photos += u32::from(point.photo.is_some());
            if point.photo == Some(photo) {
                return Some(length / pace.speed + pace.stop * f64::from(photos));
            }
        }
        None
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
}

impl Pilot<'_> {
    /// The way from a photo on through as many as a battery lasts for, and behind which it ends; `None` where it does
    /// not last for one.
    fn longest(&self, first: usize) -> Result<Option<(usize, Way)>, Fault> {
        let end = self.plan.photos.len();
        let lasting = |end: usize| {
            let way = self.over(first..end)?;
            let battery = self.pace.battery;
            let lasts = battery.is_none_or(|battery| way.seconds(self.pace) <= battery);
            Ok(lasts.then_some((end, way)))
        };
        if let Some(all) = lasting(end)? {
            return Ok(Some(all));
        }
        // One photo more always takes longer.
        let (mut reached, mut too_far, mut longest) = (first, end, None);
        while too_far - reached > 1 {
            let middle = (reached + too_far) / 2;
            match lasting(middle)? {
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
                let is_near = plan.terrain.is_leg_near(last.place, to, clearance);
                if is_near || course.len() > 2 {
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
        let up = take_off.truncate().extend(safe_height);
        let all: Vec<DVec3> = [take_off, up]
            .into_iter()
            .chain(points.iter().map(|point| point.place))
            .chain([up, take_off])
            .collect();
        Ok(Way {
            take_off,
            safe_height,
            points,
            length: all.windows(2).map(|leg| leg[0].distance(leg[1])).sum(),
        })
    }
}

/// The order of places on a short way that begins and ends at `from`.
pub(super) fn order(from: DVec3, places: &[DVec3]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    let at = |order: &[usize], place: usize| {
        let before_all = place == 0 || place > order.len();
        if before_all {
            from
        } else {
            places[order[place - 1]]
        }
    };
    for _ in 0..ROUNDS {
        let mut is_better = false;
        // Legs from `first` to `first + 1` and from `last` to `last + 1`, take-off being 0 and behind the last.
        for first in 0..order.len() {
            for last in first + 1..=order.len() {
                let (a, b) = (at(&order, first), at(&order, first + 1));
                let (c, d) = (at(&order, last), at(&order, last + 1));
                let gain = a.distance(b) + c.distance(d) - a.distance(c) - b.distance(d);
                if gain > GAIN * (1.0 + a.distance(b)) {
                    order[first..last].reverse();
                    is_better = true;
                }
            }
        }
        if !is_better {
            break;
        }
    }
    order
}

/// Where on a way from place to place another one is reached with the least detour.
pub(super) fn cheapest(places: &[DVec3], place: DVec3) -> usize {
    let detour = |at: usize| match (
        at.checked_sub(1).map(|before| places[before]),
        places.get(at),
    ) {
        (Some(before), Some(behind)) => {
            before.distance(place) + place.distance(*behind) - before.distance(*behind)
        }
        (Some(end), None) => end.distance(place),
        (None, end) => end.map_or(0.0, |end| end.distance(place)),
    };
    let all = 0..=places.len();
    all.min_by(|a, b| detour(*a).total_cmp(&detour(*b)))
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle in a shuffled order is flown around, whichever way.
    #[test]
    fn a_ring_is_flown_around() {
        let at = |i: usize| {
            let angle = (i * 7 % 24) as f64 / 24.0 * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), 1.0)
        };
        let places: Vec<DVec3> = (0..24).map(at).collect();
        let order = order(DVec3::new(1.2, 0.0, 1.0), &places);
        let way: f64 = order
            .windows(2)
            .map(|leg| places[leg[0]].distance(places[leg[1]]))
            .sum();
        // 23 of the 24 sides of the polygon.
        let side = 2.0 * (std::f64::consts::PI / 24.0).sin();
        assert!((way / (23.0 * side) - 1.0).abs() < 1e-9, "{way}");
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..24).collect::<Vec<_>>());
    }
}
