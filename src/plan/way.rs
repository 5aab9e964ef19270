//! In which order photos are taken, and which climbs keep the drone off the ground between them.
//!
//! The way begins and ends at the take-off, and goes up to a safe height before the first photo and behind the last: as
//! stops of their own, for some ground stations know no such height, and fly straight. Photos are put in a short order
//! when they are planned: as they were laid out, made shorter by 2-opt (Croes 1958) until no two legs are better
//! swapped; deterministic, and a lawn-mower's rows stay rows, for they are short already. Where one battery does not
//! last, the way is cut: each piece goes out from the take-off and back to it. A leg that comes too near to the ground
//! goes up first, over, and down: straight up and down is free, for the ground has one height at each place.

use std::ops::Range;

use glam::DVec3;

use super::Plan;
use crate::fault::Fault;

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

impl Way {
    /// The ways through the photos of a plan, from a place on the ground and back: as many as batteries are needed.
    ///
    /// # Errors
    /// Where a battery does not last for a single photo.
    pub fn through(plan: &Plan, take_off: DVec3, pace: &Pace) -> Result<Vec<Self>, Fault> {
        let (mut first, end) = (0, plan.photos.len());
        let mut ways = Vec::new();
        while first < end {
            let Some((reached, way)) = Self::longest(plan, take_off, first, pace) else {
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

    /// The way from a photo on through as many as a battery lasts for, and behind which it ends; `None` where it does
    /// not last for one.
    fn longest(plan: &Plan, take_off: DVec3, first: usize, pace: &Pace) -> Option<(usize, Self)> {
        let end = plan.photos.len();
        let lasting = |end: usize| {
            let way = Self::over(plan, take_off, first..end);
            let battery = pace.battery;
            let lasts = battery.is_none_or(|battery| way.seconds(pace) <= battery);
            lasts.then_some((end, way))
        };
        if let Some(all) = lasting(end) {
            return Some(all);
        }
        // One photo more always takes longer.
        let (mut reached, mut too_far, mut longest) = (first, end, None);
        while too_far - reached > 1 {
            let middle = (reached + too_far) / 2;
            match lasting(middle) {
                Some(found) => (reached, longest) = (middle, Some(found)),
                None => too_far = middle,
            }
        }
        longest
    }

    /// Seconds in the air.
    pub fn seconds(&self, pace: &Pace) -> f64 {
        self.length / pace.speed + pace.stop * self.photos() as f64
    }

    /// Through these photos of a plan, one at least.
    fn over(plan: &Plan, take_off: DVec3, photos: Range<usize>) -> Self {
        let place_of = |photo: usize| plan.photos[photo].pose.center;
        let ends = [photos.start, photos.end - 1];
        let clearance = plan.wish.clearance;
        let over = |from: DVec3, to: DVec3| {
            let highest = (plan.terrain)
                .highest_along(from.truncate(), to.truncate(), clearance)
                .unwrap_or(f64::MIN);
            (highest + clearance).max(from.z).max(to.z)
        };
        let safe_height = (ends.into_iter())
            .map(|end| over(take_off, place_of(end)))
            .fold(take_off.z + clearance, f64::max);
        let mut points: Vec<WayPoint> = Vec::new();
        // Where the photo is not taken from there anyway.
        let above = |photo: usize| {
            let place = place_of(photo).truncate().extend(safe_height);
            (place != place_of(photo)).then_some(WayPoint { place, photo: None })
        };
        points.extend(above(ends[0]));
        for photo in photos {
            let to = place_of(photo);
            if let Some(last) = points.last()
                && last.photo.is_some()
                && plan.terrain.is_leg_near(last.place, to, clearance)
            {
                let height = over(last.place, to);
                for under in [last.place, to] {
                    let place = under.truncate().extend(height);
                    if place != under {
                        points.push(WayPoint { place, photo: None });
                    }
                }
            }
            let photo = Some(photo);
            points.push(WayPoint { place: to, photo });
        }
        points.extend(above(ends[1]));
        let up = take_off.truncate().extend(safe_height);
        let all: Vec<DVec3> = [take_off, up]
            .into_iter()
            .chain(points.iter().map(|point| point.place))
            .chain([up, take_off])
            .collect();
        Self {
            take_off,
            safe_height,
            points,
            length: all.windows(2).map(|leg| leg[0].distance(leg[1])).sum(),
        }
    }

    /// How many photos are taken.
    pub fn photos(&self) -> usize {
        self.points
            .iter()
            .filter(|point| point.photo.is_some())
            .count()
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
