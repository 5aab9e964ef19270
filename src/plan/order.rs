//! In which order photos are taken: as they were laid out, made shorter by 2-opt (Croes 1958) until no two legs are better
//! swapped; deterministic, and a lawn-mower's rows stay rows, for they are short already.
//!
//! A drone that keeps its direction from photo to photo is quicker and steadier than one that turns: a half turn counts
//! as [`HALF_TURN`] footprints of way, a part of it as its share. So photos that look one way come one after the other
//! where the detour is smaller than that.

use glam::{DVec2, DVec3};

use super::photo::PlannedPhoto;

/// A gain of less is rounding.
const GAIN: f64 = 1e-9;
/// Rounds of 2-opt; each goes over all pairs.
const ROUNDS: usize = 40;
/// What a half turn may cost of the way: a photo's longer side on the ground, so the way to the next photo, at most.
const HALF_TURN: f64 = 1.0;

/// A place with the direction of the nose there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stand {
    pub(super) place: DVec3,
    /// Degrees clockwise; `None` where any does.
    pub(super) pan: Option<f64>,
}

impl Stand {
    /// The way to another one, with what turning costs.
    fn cost(self, to: Self, half_turn: f64) -> f64 {
        let turn = match (self.pan, to.pan) {
            (Some(from), Some(to)) => ((to - from + 180.0).rem_euclid(360.0) - 180.0).abs(),
            _ => 0.0,
        };
        self.place.distance(to.place) + half_turn * turn / 180.0
    }
}

/// The order of photos whose footprints have this longer side, on a short way that begins and ends at the take-off; where
/// that is not known, at the first of them.
pub(super) fn order(
    take_off: Option<DVec2>,
    photos: &[PlannedPhoto],
    footprint: f64,
) -> Vec<usize> {
    let stands: Vec<Stand> = (photos.iter())
        .map(|photo| Stand {
            place: photo.pose.center,
            pan: Some(photo.pan),
        })
        .collect();
    let Some(first) = stands.first() else {
        return Vec::new();
    };
    let place = take_off.map_or(first.place, |place| place.extend(first.place.z));
    order_of(Stand { place, pan: None }, &stands, HALF_TURN * footprint)
}

/// The order of places on a short way that begins and ends at `from`.
pub(super) fn order_of(from: Stand, stands: &[Stand], half_turn: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..stands.len()).collect();
    let at = |order: &[usize], place: usize| {
        let before_all = place == 0 || place > order.len();
        if before_all {
            from
        } else {
            stands[order[place - 1]]
        }
    };
    for _ in 0..ROUNDS {
        let mut is_better = false;
        // Legs from `first` to `first + 1` and from `last` to `last + 1`, take-off being 0 and behind the last.
        for first in 0..order.len() {
            for last in first + 1..=order.len() {
                let (a, b) = (at(&order, first), at(&order, first + 1));
                let (c, d) = (at(&order, last), at(&order, last + 1));
                let before = a.cost(b, half_turn) + c.cost(d, half_turn);
                let gain = before - a.cost(c, half_turn) - b.cost(d, half_turn);
                if gain > GAIN * (1.0 + before) {
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

    fn way(order: &[usize], stands: &[Stand]) -> f64 {
        let legs = order.windows(2);
        legs.map(|leg| stands[leg[0]].place.distance(stands[leg[1]].place))
            .sum()
    }

    /// A circle in a shuffled order is flown around, whichever way.
    #[test]
    fn a_ring_is_flown_around() {
        let at = |i: usize| {
            let angle = (i * 7 % 24) as f64 / 24.0 * std::f64::consts::TAU;
            Stand {
                place: DVec3::new(angle.cos(), angle.sin(), 1.0),
                pan: None,
            }
        };
        let stands: Vec<Stand> = (0..24).map(at).collect();
        let from = Stand {
            place: DVec3::new(1.2, 0.0, 1.0),
            pan: None,
        };
        let order = order_of(from, &stands, 0.0);
        let way = way(&order, &stands);
        // 23 of the 24 sides of the polygon.
        let side = 2.0 * (std::f64::consts::PI / 24.0).sin();
        assert!((way / (23.0 * side) - 1.0).abs() < 1e-9, "{way}");
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..24).collect::<Vec<_>>());
    }

    /// Two rows side by side, 1 apart, one looking east and the other west, given in pairs. Where a half turn costs
    /// nothing, pairs are as short as rows; where it costs 3, the rows are flown one after the other, with one turn. The way
    /// of both is the same 19 legs of 1.
    #[test]
    fn the_direction_is_kept_where_that_costs_little() {
        let stands: Vec<Stand> = (0..20)
            .map(|i| {
                let row = (i / 2 + i) % 2;
                Stand {
                    place: DVec3::new(f64::from(i / 2), f64::from(row), 0.0),
                    pan: Some(if row == 0 { 90.0 } else { 270.0 }),
                }
            })
            .collect();
        let from = Stand {
            place: DVec3::new(-1.0, 0.5, 0.0),
            pan: None,
        };
        let turns = |order: &[usize]| {
            let legs = order.windows(2);
            legs.filter(|leg| stands[leg[0]].pan != stands[leg[1]].pan)
                .count()
        };
        let kept = order_of(from, &stands, 3.0);
        assert_eq!(turns(&kept), 1, "{kept:?}");
        assert!((way(&kept, &stands) - 19.0).abs() < 1e-9);
        let before: Vec<usize> = (0..20).collect();
        assert!(turns(&before) > 8);
        // A direction is not kept at any price: rows 50 apart are not crossed again and again.
        let far: Vec<Stand> = (0..6)
            .map(|i| Stand {
                place: DVec3::new(50.0 * f64::from(i), 0.0, 0.0),
                pan: Some(if i % 2 == 0 { 90.0 } else { 270.0 }),
            })
            .collect();
        let order = order_of(far[0], &far, 3.0);
        let last = *order.last().unwrap();
        let home = far[last].place.distance(far[0].place);
        assert!(way(&order, &far) + home <= 500.0 + 1e-9, "{order:?}");
    }
}
