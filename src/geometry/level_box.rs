//! A box that stands level and may be turned about the vertical.

use glam::{DVec2, DVec3};

use super::{Bounds, Ray};

/// A level box. Its axes are those of the world, turned about the vertical through `pivot`: with no turn
/// its limits are x, y and z of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelBox {
    /// What x and y are turned about, in the world.
    pub pivot: DVec2,
    /// Turn, radians counter-clockwise seen from above.
    pub turn: f64,
    /// The lower limits along its axes.
    pub low: DVec3,
    /// The upper limits.
    pub high: DVec3,
}

impl LevelBox {
    /// The box with the axes of the world.
    pub fn of(bounds: &Bounds) -> Self {
        Self {
            pivot: bounds.center().truncate(),
            turn: 0.0,
            low: bounds.min,
            high: bounds.max,
        }
    }

    /// A direction of the world along the box's axes.
    fn along(&self, direction: DVec3) -> DVec3 {
        let turned = DVec2::from_angle(-self.turn).rotate(direction.truncate());
        turned.extend(direction.z)
    }

    /// A point of the world in the coordinates that the limits count in.
    pub fn from_world(&self, point: DVec3) -> DVec3 {
        let pivot = self.pivot.extend(0.0);
        pivot + self.along(point - pivot)
    }

    /// The other way.
    pub fn to_world(&self, point: DVec3) -> DVec3 {
        let off = DVec2::from_angle(self.turn).rotate(point.truncate() - self.pivot);
        (self.pivot + off).extend(point.z)
    }

    /// Its middle, in the world.
    pub fn middle(&self) -> DVec3 {
        self.to_world((self.low + self.high) * 0.5)
    }

    /// Half of its edges.
    pub fn half(&self) -> DVec3 {
        (self.high - self.low) * 0.5
    }

    /// The same box turned to another angle about its own middle; its limits count along the new axes.
    #[must_use]
    pub fn turned_to(&self, turn: f64) -> Self {
        let (middle, half) = (self.middle(), self.half());
        let turned = Self { turn, ..*self };
        let middle = turned.from_world(middle);
        Self {
            low: middle - half,
            high: middle + half,
            ..turned
        }
    }

    /// The smallest box of this turn and pivot around points; itself where there are none.
    #[must_use]
    pub fn around(&self, points: &[DVec3]) -> Self {
        let along: Vec<DVec3> = points.iter().map(|&point| self.from_world(point)).collect();
        Bounds::of(&along).map_or(*self, |bounds| Self {
            low: bounds.min,
            high: bounds.max,
            ..*self
        })
    }

    /// Whether its limits are in their order and finite.
    pub fn is_box(&self) -> bool {
        let finite = self.low.is_finite() && self.high.is_finite() && self.turn.is_finite();
        finite && self.low.cmplt(self.high).all()
    }

    /// Whether a point of the world lies in it or on its sides.
    pub fn contains(&self, point: DVec3) -> bool {
        let point = self.from_world(point);
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }

    /// Where a ray is inside: from and to which t, both at least 0. `None` where it passes by.
    pub fn inside(&self, ray: &Ray) -> Option<[f64; 2]> {
        let origin = self.from_world(ray.origin);
        let direction = self.along(ray.direction);
        let mut span = [0.0_f64, f64::INFINITY];
        for axis in 0..3 {
            let (from, way) = (origin[axis], direction[axis]);
            let (low, high) = (self.low[axis], self.high[axis]);
            if way == 0.0 {
                if from < low || from > high {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low - from) / way, (high - from) / way);
            span = [span[0].max(a.min(b)), span[1].min(a.max(b))];
        }
        (span[0] <= span[1]).then_some(span)
    }

    /// The ends of its twelve edges, in the world.
    pub fn edges(&self) -> [[DVec3; 2]; 12] {
        let corner = |place: usize| {
            let pick = |axis: usize| match place >> axis & 1 {
                0 => self.low[axis],
                _ => self.high[axis],
            };
            self.to_world(DVec3::new(pick(0), pick(1), pick(2)))
        };
        // From each corner along each axis along which it is the lower one.
        let starts: [(usize, usize); 12] = [
            (0, 0),
            (2, 0),
            (4, 0),
            (6, 0),
            (0, 1),
            (1, 1),
            (4, 1),
            (5, 1),
            (0, 2),
            (1, 2),
            (2, 2),
            (3, 2),
        ];
        starts.map(|(start, axis)| [corner(start), corner(start | 1 << axis)])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::*;

    const UTM: DVec3 = DVec3::new(500_000.0, 5_000_000.0, 100.0);

    fn unit() -> LevelBox {
        LevelBox::of(&Bounds {
            min: UTM - 1.0,
            max: UTM + 1.0,
        })
    }

    #[test]
    fn with_no_turn_limits_are_those_of_the_world() {
        let level = unit();
        assert_eq!(level.from_world(UTM + 0.25), UTM + 0.25);
        assert!(level.contains(UTM + 1.0) && !level.contains(UTM + DVec3::X * 1.001));
        assert_eq!(level.middle(), UTM);
    }

    /// A square of side 2 turned by 45 degrees reaches sqrt(2) along x, and 1 along the diagonal.
    #[test]
    fn a_turned_box_reaches_along_its_diagonal() {
        let turned = unit().turned_to(FRAC_PI_4);
        let diagonal = DVec3::new(1.0, 1.0, 0.0).normalize();
        for (way, reach) in [(DVec3::X, 2_f64.sqrt()), (diagonal, 1.0), (DVec3::Z, 1.0)] {
            assert!(turned.contains(UTM + way * (reach - 1e-6)), "{way}");
            assert!(!turned.contains(UTM + way * (reach + 1e-6)), "{way}");
            let ray = Ray {
                origin: UTM - way * 5.0,
                direction: way,
            };
            let [from, to] = turned.inside(&ray).unwrap();
            assert!((from - (5.0 - reach)).abs() < 1e-6 && (to - (5.0 + reach)).abs() < 1e-6);
        }
        // And back to where it was, about its own middle.
        let moved = LevelBox {
            high: UTM + 3.0,
            ..unit()
        };
        let back = moved.turned_to(0.7).turned_to(0.0);
        assert!(back.low.distance(moved.low) < 1e-6 && back.high.distance(moved.high) < 1e-6);
        assert!(moved.turned_to(0.7).middle().distance(moved.middle()) < 1e-6);
    }

    #[test]
    fn rays_pass_by_begin_inside_or_end_before() {
        let at = |x: f64, y: f64| UTM + DVec3::new(x, y, 0.0);
        let ray = |origin, direction| Ray { origin, direction };
        let level = unit();
        assert_eq!(level.inside(&ray(at(-5.0, 1.5), DVec3::X)), None);
        assert_eq!(level.inside(&ray(at(5.0, 0.0), DVec3::X)), None);
        let [from, to] = level.inside(&ray(at(0.5, 0.0), DVec3::X)).unwrap();
        assert!(from == 0.0 && (to - 0.5).abs() < 1e-9);
    }

    /// Each edge is as long as its axis, and each corner ends three of them.
    #[test]
    fn twelve_edges_meet_in_eight_corners() {
        let turned = unit().turned_to(0.3);
        let edges = turned.edges();
        assert!(
            edges
                .iter()
                .all(|[a, b]| (a.distance(*b) - 2.0).abs() < 1e-6)
        );
        let ends: Vec<DVec3> = edges.into_iter().flatten().collect();
        for end in &ends {
            let same = ends.iter().filter(|other| other.distance(*end) < 1e-6);
            assert_eq!(same.count(), 3);
        }
        let found = turned.around(&ends);
        assert!(found.low.distance(turned.low) < 1e-6 && found.high.distance(turned.high) < 1e-6);
    }
}
