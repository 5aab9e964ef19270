//! Ground that the drone must not fly over, at any height: misfires, people, machines. And the way around it.
//!
//! A course around such areas goes over places on circles about their corners (the corners of octagons around those
//! circles, so that it keeps its distance on the sides, too), the shortest by A* (Hart, Nilsson & Raphael 1968).

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use glam::DVec2;

use crate::fault::Fault;
use crate::survey::Polygon;

/// Places around a corner.
const AROUND: u32 = 8;
/// The most corners of all areas together: each course looks at every one of them from every place that it may take.
const MOST_CORNERS: usize = 200;
/// A course keeps so much more than the distance, in parts of it: it is on the right side of what is checked.
const MORE: f64 = 1e-6;

/// Areas that are kept out of, and the distance that is kept from them.
#[derive(Debug, Clone)]
pub(super) struct KeepOut<'a> {
    areas: &'a [Polygon],
    distance: f64,
    /// Places that courses go over.
    places: Vec<DVec2>,
}

impl<'a> KeepOut<'a> {
    /// Areas to keep so far from.
    ///
    /// # Errors
    /// Where they have more corners than courses are looked for around.
    pub(super) fn new(areas: &'a [Polygon], distance: f64) -> Result<Self, Fault> {
        let corners = || areas.iter().flat_map(|area| area.corners());
        if corners().count() > MOST_CORNERS {
            let what = format!("the areas to keep out of have more than {MOST_CORNERS} corners");
            return Err(Fault::new(what, "draw them with fewer"));
        }
        let radius = distance * (1.0 + MORE) / (PI / f64::from(AROUND)).cos();
        let around = corners().flat_map(|corner| {
            let angle = |at: u32| 2.0 * PI * (f64::from(at) + 0.5) / f64::from(AROUND);
            (0..AROUND).map(move |at| *corner + DVec2::from_angle(angle(at)) * radius)
        });
        let mut keep_out = Self {
            areas,
            distance,
            places: Vec::new(),
        };
        keep_out.places = around.filter(|place| !keep_out.holds(*place)).collect();
        Ok(keep_out)
    }

    /// Whether a place is inside an area, or nearer to one than the distance.
    pub(super) fn holds(&self, place: DVec2) -> bool {
        self.crosses(place, place)
    }

    /// Whether a straight leg leads over an area, or nearer to one than the distance.
    pub(super) fn crosses(&self, from: DVec2, to: DVec2) -> bool {
        (self.areas.iter()).any(|area| area.distance_to_leg(from, to) < self.distance)
    }

    /// Whether an area lies, or comes nearer than the distance, between a leg and a place: on a straight way there from
    /// anywhere on the leg.
    pub(super) fn lies_between(&self, leg: [DVec2; 2], to: DVec2) -> bool {
        let triangle = [leg[0], leg[1], to];
        let sides = [0, 1, 2].map(|at| triangle[(at + 1) % 3] - triangle[at]);
        // The same side of all three: an area that no side crosses is inside with all of it, or with nothing.
        let is_inside = |place: DVec2| {
            let turns = [0, 1, 2].map(|at| sides[at].perp_dot(place - triangle[at]));
            turns.iter().all(|turn| *turn > 0.0) || turns.iter().all(|turn| *turn < 0.0)
        };
        self.crosses(leg[0], to)
            || self.crosses(leg[1], to)
            || (self.areas.iter()).any(|area| {
                area.corners()
                    .first()
                    .is_some_and(|corner| is_inside(*corner))
            })
    }

    /// The shortest course from a place to another that keeps out: both, and the places between. `None` where there is
    /// none: one of them lies in an area, or areas surround it.
    pub(super) fn course(&self, from: DVec2, to: DVec2) -> Option<Vec<DVec2>> {
        if !self.crosses(from, to) {
            return Some(vec![from, to]);
        }
        if self.holds(from) || self.holds(to) {
            return None;
        }
        // The places, and the end behind them.
        let end = self.places.len();
        let place = |index: usize| self.places.get(index).copied().unwrap_or(to);
        let mut reached: Vec<Option<(f64, Option<usize>)>> = vec![None; end + 1];
        let mut done = vec![false; end + 1];
        // By the length of the way and the straight rest; lengths are positive, so that their bits are in order.
        let mut open = BinaryHeap::new();
        let reach = |before: Option<usize>,
                     length: f64,
                     open: &mut BinaryHeap<_>,
                     reached: &mut Vec<Option<(f64, Option<usize>)>>,
                     done: &[bool]| {
            let at = before.map_or(from, place);
            for next in 0..=end {
                let leg = at.distance(place(next));
                let is_shorter = reached[next].is_none_or(|(known, _)| length + leg < known);
                if !done[next] && is_shorter && !self.crosses(at, place(next)) {
                    reached[next] = Some((length + leg, before));
                    let rest = place(next).distance(to);
                    open.push(Reverse(((length + leg + rest).to_bits(), next)));
                }
            }
        };
        reach(None, 0.0, &mut open, &mut reached, &done);
        while let Some(Reverse((_, next))) = open.pop() {
            if next == end {
                break;
            }
            let Some((length, _)) = reached[next].filter(|_| !done[next]) else {
                continue;
            };
            done[next] = true;
            reach(Some(next), length, &mut open, &mut reached, &done);
        }
        let (_, mut before) = reached[end]?;
        let mut course = vec![to];
        while let Some(index) = before {
            course.push(place(index));
            before = reached[index].and_then(|(_, before)| before);
        }
        course.push(from);
        course.reverse();
        Some(course)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[(f64, f64)]) -> Polygon {
        let corners: Vec<DVec2> = corners.iter().map(|&corner| corner.into()).collect();
        Polygon::new(&corners).unwrap()
    }

    fn length(course: &[DVec2]) -> f64 {
        course.windows(2).map(|leg| leg[0].distance(leg[1])).sum()
    }

    /// Around a square of side 10 from the middle of one side to that of the other: the string around it, whose arcs are
    /// cut short by the octagon at most to its own length.
    #[test]
    fn a_course_is_the_string_around_the_area() {
        let areas = [area(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)])];
        let keep_out = KeepOut::new(&areas, 2.0).unwrap();
        let (from, to) = (DVec2::new(-20.0, 5.0), DVec2::new(30.0, 5.0));
        let course = keep_out.course(from, to).unwrap();
        assert!(
            !course
                .windows(2)
                .any(|leg| keep_out.crosses(leg[0], leg[1]))
        );
        // From (-20, 5) to the tangent of a circle of radius 2 about (0, 0) [or (0, 10)], its arc, the side, and the same again.
        let away = DVec2::new(20.0, 5.0).length();
        let straight = (away * away - 4.0).sqrt();
        // The tangent's direction above that to the centre, and the side's direction is along x.
        let turned = (5.0_f64 / 20.0).atan() + (2.0 / away).asin();
        let string = 2.0 * (straight + 2.0 * turned) + 10.0;
        let found = length(&course);
        assert!(
            found >= string - 1e-6 && found < string * 1.01,
            "{found} {string}"
        );
    }

    #[test]
    fn a_bay_is_left_and_a_ring_is_not() {
        // A U that is open to the north, and a place in it.
        let corners = [
            (0.0, 0.0),
            (30.0, 0.0),
            (30.0, 30.0),
            (25.0, 30.0),
            (25.0, 5.0),
            (5.0, 5.0),
            (5.0, 30.0),
            (0.0, 30.0),
        ];
        let areas = [area(&corners)];
        let keep_out = KeepOut::new(&areas, 3.0).unwrap();
        let (inside, below) = (DVec2::new(15.0, 15.0), DVec2::new(15.0, -20.0));
        let course = keep_out.course(inside, below).unwrap();
        assert!(
            course.len() > 3 && course.iter().any(|place| place.y > 33.0),
            "{course:?}"
        );
        assert!(
            !course
                .windows(2)
                .any(|leg| keep_out.crosses(leg[0], leg[1]))
        );
        // Wider than the bay.
        let keep_out = KeepOut::new(&areas, 12.0).unwrap();
        assert_eq!(keep_out.course(inside, below), None);
        assert!(keep_out.holds(DVec2::new(2.0, 2.0)) && keep_out.holds(DVec2::new(-11.0, 2.0)));
        assert!(!keep_out.holds(DVec2::new(-12.1, 2.0)));
    }
}
