//! An outline in plan, without crossings, cut into triangles.

use glam::DVec2;
use robust::{Coord, orient2d};

use super::SurveyError;
use crate::geometry::{surrounds, twice_signed_area};

/// The most corners of a polygon: every side is compared with every other.
pub const MOST_CORNERS: usize = 2000;

/// An outline in plan that does not cross itself, counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    corners: Vec<DVec2>,
}

impl Polygon {
    /// The polygon with these corners (x, y in the world), in either direction; a corner that is said
    /// twice in a row, or again at the end, counts once.
    ///
    /// # Errors
    /// Where it has no area, crosses itself, or has too many corners.
    pub fn new(corners: &[DVec2]) -> Result<Self, SurveyError> {
        if let Some(place) = corners.iter().position(|corner| !corner.is_finite()) {
            return Err(SurveyError::NotFinite(place + 1));
        }
        let mut corners = corners.to_vec();
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        let count = corners.len();
        if count < 3 {
            return Err(SurveyError::TooFewCorners(count));
        }
        if count > MOST_CORNERS {
            return Err(SurveyError::TooManyCorners(count));
        }
        if corners
            .iter()
            .all(|&c| side(corners[0], corners[1], c) == 0.0)
        {
            return Err(SurveyError::NoArea);
        }
        let ends = |side: usize| (corners[side], corners[(side + 1) % count]);
        for first in 0..count {
            for second in first + 1..count {
                let neighbours = second == first + 1 || (first == 0 && second == count - 1);
                let (a, b) = ends(first);
                let (c, d) = ends(second);
                let meet = match neighbours {
                    // They share a corner; more than that where one turns back over the other.
                    true => {
                        let (before, corner, behind) = if second == first + 1 {
                            (a, b, d)
                        } else {
                            (c, d, b)
                        };
                        side(before, corner, behind) == 0.0
                            && (before - corner).dot(behind - corner) > 0.0
                    }
                    false => touch(a, b, c, d),
                };
                if meet {
                    return Err(SurveyError::CrossesItself(first + 1, second + 1));
                }
            }
        }
        let mut polygon = Self { corners };
        if polygon.twice_signed_area() < 0.0 {
            polygon.corners.reverse();
        }
        if polygon.area() > 0.0 {
            Ok(polygon)
        } else {
            Err(SurveyError::NoArea)
        }
    }

    /// Its corners in the world, counter-clockwise seen from above.
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// Its area in plan, square world units.
    pub fn area(&self) -> f64 {
        self.twice_signed_area() / 2.0
    }

    /// How far the straight leg between two places stays from it in plan, world units: 0 where it leads over it.
    pub fn distance_to_leg(&self, from: DVec2, to: DVec2) -> f64 {
        let sides = || self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        let meets = surrounds(&self.corners, from) || sides().any(|(a, b)| touch(from, to, *a, *b));
        if meets {
            return 0.0;
        }
        // Of two that do not meet, the nearest places are an end of one of them and a place of the other.
        let distances = sides().flat_map(|(a, b)| {
            [
                to_segment(from, [*a, *b]),
                to_segment(to, [*a, *b]),
                to_segment(*a, [from, to]),
            ]
        });
        distances.fold(f64::MAX, f64::min)
    }

    /// How much of its area lies inside a box of the map (least and greatest x and y), square world units: cut off along
    /// one side of the box after the other (Sutherland & Hodgman 1974). What that leaves of a polygon with bays may hang
    /// together by threads, which have no area.
    pub fn area_inside(&self, [min, max]: [DVec2; 2]) -> f64 {
        let mut left = self.corners.clone();
        for (normal, most) in [
            (DVec2::X, max.x),
            (DVec2::Y, max.y),
            (DVec2::NEG_X, -min.x),
            (DVec2::NEG_Y, -min.y),
        ] {
            let beyond = |corner: DVec2| normal.dot(corner) - most;
            let mut kept = Vec::with_capacity(left.len() + 1);
            for (place, &from) in left.iter().enumerate() {
                let to = left[(place + 1) % left.len()];
                let (start, end) = (beyond(from), beyond(to));
                if start <= 0.0 {
                    kept.push(from);
                }
                if (start <= 0.0) != (end <= 0.0) {
                    kept.push(from + (to - from) * (start / (start - end)));
                }
            }
            left = kept;
        }
        twice_signed_area(&left).max(0.0) / 2.0
    }

    fn twice_signed_area(&self) -> f64 {
        twice_signed_area(&self.corners)
    }

    /// It in triangles that do not overlap, counter-clockwise, less `origin`.
    pub(super) fn triangles(&self, origin: DVec2) -> Vec<[DVec2; 3]> {
        let mut left: Vec<DVec2> = self.corners.iter().map(|&c| c - origin).collect();
        let mut triangles = Vec::new();
        while left.len() > 3 {
            let count = left.len();
            let around = |place: usize| {
                let before = left[(place + count - 1) % count];
                (before, left[place], left[(place + 1) % count])
            };
            let flat = (0..count).find(|&place| {
                let (a, b, c) = around(place);
                side(a, b, c) == 0.0
            });
            let ear = flat.or_else(|| (0..count).find(|&place| is_ear(&left, around(place))));
            // Every polygon without crossings has two ears (Meisters 1975).
            let Some(ear) = ear else {
                break;
            };
            let (a, b, c) = around(ear);
            if flat.is_none() {
                triangles.push([a, b, c]);
            }
            left.remove(ear);
        }
        if let [a, b, c] = left[..]
            && side(a, b, c) > 0.0
        {
            triangles.push([a, b, c]);
        }
        triangles
    }
}

/// Whether no other corner lies in the triangle at a corner that is no bay.
fn is_ear(corners: &[DVec2], (a, b, c): (DVec2, DVec2, DVec2)) -> bool {
    let inside = |p: DVec2| {
        p != a
            && p != b
            && p != c
            && side(a, b, p) >= 0.0
            && side(b, c, p) >= 0.0
            && side(c, a, p) >= 0.0
    };
    side(a, b, c) > 0.0 && !corners.iter().any(|&corner| inside(corner))
}

/// Over 0 where `c` lies left of the way from `a` to `b`: exact.
fn side(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// How far a place is from the nearest of a straight piece.
fn to_segment(place: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let leg = to - from;
    let length = leg.length_squared();
    let share = if length > 0.0 {
        (place - from).dot(leg) / length
    } else {
        0.0
    };
    place.distance(from + leg * share.clamp(0.0, 1.0))
}

/// Whether two sides have a point in common.
fn touch(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    if apart {
        return false;
    }
    let crosses =
        |one: f64, other: f64| (one >= 0.0 && other <= 0.0) || (one <= 0.0 && other >= 0.0);
    crosses(side(a, b, c), side(a, b, d)) && crosses(side(c, d, a), side(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An L of three squares of side 10, far from the origin: what boxes leave of it, counted by hand.
    #[test]
    fn what_lies_inside_a_box() {
        let corners = [(0, 0), (20, 0), (20, 10), (10, 10), (10, 20), (0, 20)];
        let world =
            |(x, y): (i32, i32)| DVec2::new(f64::from(x) + 500_000.0, f64::from(y) + 5_000_000.0);
        let polygon = Polygon::new(&corners.map(world)).unwrap();
        for (min, max, expected) in [
            ((-5, -5), (25, 25), 300.0),
            ((5, 5), (15, 15), 75.0),
            // Two parts of it, over the bay.
            ((5, 15), (25, 18), 15.0),
            ((12, 12), (30, 30), 0.0),
            ((30, 0), (40, 10), 0.0),
        ] {
            let found = polygon.area_inside([world(min), world(max)]);
            assert!((found - expected).abs() < 1e-6, "{min:?} {max:?}: {found}");
        }
    }

    /// Of a square of side 2 about the origin, turned by 45 degrees: half its diagonal is the root of 2.
    #[test]
    fn legs_keep_their_distance() {
        let half = 2.0_f64.sqrt();
        let corners = [(half, 0.0), (0.0, half), (-half, 0.0), (0.0, -half)].map(DVec2::from);
        let square = Polygon::new(&corners).unwrap();
        for (from, to, expected) in [
            // Beside a corner, along a side, off an end, over it, inside of it, along its side.
            ((3.0, -9.0), (3.0, 9.0), 3.0 - half),
            ((0.0, 3.0), (3.0, 0.0), 3.0 / half - 1.0),
            ((4.0, 0.0), (9.0, 1.0), 4.0 - half),
            ((-9.0, 0.1), (9.0, 0.1), 0.0),
            ((0.1, 0.1), (0.2, 0.1), 0.0),
            ((half, 0.0), (0.0, half), 0.0),
            // No leg, but a place: nearest to a side.
            ((2.0, 2.0), (2.0, 2.0), 4.0 / half - 1.0),
        ] {
            let found = square.distance_to_leg(from.into(), to.into());
            assert!((found - expected).abs() < 1e-12, "{from:?} {to:?}: {found}");
        }
    }
}
