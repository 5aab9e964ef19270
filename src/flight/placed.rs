//! A flight that was brought to the world as a whole, poses and surface together.

use glam::DVec3;

use crate::geometry::Similarity;
use crate::scale::PoseErrors;

/// The way of a flight, as its files give it, to the world.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// The row-major 4x4 of a similarity: it moves poses and surface.
    pub transform: Box<[f64; 16]>,
    /// The coordinate system that it leads to; `None` where that is the files' own, or a local one.
    pub crs: Option<String>,
}

impl Placed {
    /// The similarity; `None` where the sixteen numbers are none.
    pub fn similarity(&self) -> Option<Similarity> {
        Similarity::from_row_major(&self.transform).ok()
    }

    /// The way that goes on by another similarity behind this one, if there is one before.
    #[must_use]
    pub fn then(before: Option<&Self>, next: &Similarity, crs: Option<String>) -> Self {
        let transform = match before.and_then(Self::similarity) {
            None => *next,
            Some(before) => next.after(&before),
        };
        Self {
            transform: Box::new(transform.to_row_major()),
            crs,
        }
    }
}

/// How sure a pose is once it was moved by a similarity. Rotations are about the camera's own axes and stay.
pub fn moved_errors(errors: PoseErrors, by: &Similarity) -> PoseErrors {
    let moved = |deviation: DVec3| {
        let variance = deviation * deviation;
        let row = |row: DVec3| (row * row).dot(variance).sqrt() * by.scale;
        let rows = by.rotation.transpose();
        DVec3::new(row(rows.x_axis), row(rows.y_axis), row(rows.z_axis))
    };
    PoseErrors {
        position: errors.position.map(moved),
        angle: errors.angle,
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;

    #[test]
    fn two_ways_make_one() {
        let turn = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(-1.1);
        let first = Similarity::new(3.0, turn, DVec3::new(5.0, -6.0, 7.0));
        let second = Similarity::new(0.5, DMat3::from_rotation_y(0.7), DVec3::new(1e5, 2e6, 3.0));
        let once = Placed::then(None, &first, None);
        let twice = Placed::then(Some(&once), &second, Some("EPSG:32632".to_owned()));
        let point = DVec3::new(1.5, 2.5, -3.5);
        let there = second.apply(first.apply(point));
        assert!(twice.similarity().unwrap().apply(point).distance(there) < 1e-8);
    }

    /// A quarter turn about z brings x to y; twice as large.
    #[test]
    fn deviations_turn_and_grow() {
        let quarter = DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let by = Similarity::new(2.0, quarter, DVec3::ONE);
        let errors = PoseErrors {
            position: Some(DVec3::new(0.1, 0.2, 0.3)),
            angle: Some(DVec3::ONE),
        };
        let moved = moved_errors(errors, &by);
        let expected = DVec3::new(0.4, 0.2, 0.6);
        assert!(
            moved.position.unwrap().distance(expected) < 1e-12,
            "{moved:?}"
        );
        assert_eq!(moved.angle, errors.angle);
    }
}
