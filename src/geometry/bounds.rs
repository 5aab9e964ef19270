//! The axis-aligned box around points.

use glam::DVec3;

/// An axis-aligned box, `min` <= `max` in every coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The smallest coordinates.
    pub min: DVec3,
    /// The largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box around `points`, or `None` where there are none.
    pub fn of(points: &[DVec3]) -> Option<Self> {
        let (&first, rest) = points.split_first()?;
        let mut bounds = Self {
            min: first,
            max: first,
        };
        for &point in rest {
            bounds.min = bounds.min.min(point);
            bounds.max = bounds.max.max(point);
        }
        Some(bounds)
    }

    /// Its middle.
    pub fn center(&self) -> DVec3 {
        // Halved first: the sum of two coordinates near the largest f64 would overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Its eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|corner| {
            let side = |axis: usize| match corner >> axis & 1 {
                0 => self.min[axis],
                _ => self.max[axis],
            };
            DVec3::new(side(0), side(1), side(2))
        })
    }

    /// Whether a point is inside, or on its sides.
    pub fn contains(&self, point: DVec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }

    /// The box whose sides are so far outside of its own.
    #[must_use]
    pub fn widened(&self, by: f64) -> Self {
        Self {
            min: self.min - by,
            max: self.max + by,
        }
    }

    /// Its edge lengths.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_points() {
        assert_eq!(Bounds::of(&[]), None);
        let bounds = Bounds::of(&[DVec3::new(1.0, -2.0, 3.0), DVec3::new(-1.0, 5.0, 3.0)]);
        let bounds = bounds.unwrap();
        assert_eq!(bounds.min, DVec3::new(-1.0, -2.0, 3.0));
        assert_eq!(bounds.size(), DVec3::new(2.0, 7.0, 0.0));
        assert_eq!(bounds.center(), DVec3::new(0.0, 1.5, 3.0));
        let (corner, outside) = (DVec3::new(-1.0, -2.0, 3.0), DVec3::new(-1.0, -2.0, 3.1));
        assert!(bounds.contains(corner) && !bounds.contains(outside));
        assert!(bounds.widened(0.1).contains(outside));
    }
}
