//! Which way is up where nobody says it: across the points, towards the cameras, as over every pile that a drone
//! has flown over.

use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, Vector3};

/// How often the farthest points are dropped: masts, and points that no photo shows rightly.
const DROPS: usize = 3;
/// Standard deviations from the plane beyond which a point is dropped.
const FARTHEST: f64 = 2.5;
/// Points of a plane are off it by rounding, in parts of how far they spread along it.
const ROUNDING: f64 = 1e-9;

/// The least turn that brings up the side of the points on which the cameras are: along the normal of their plane,
/// by least squares, from which the farthest points are dropped. Points and cameras (their centres) are of one
/// frame, in any unit.
///
/// `None` where there are fewer than three points, or one is not finite.
pub fn levelled(mut points: Vec<DVec3>, cameras: &[DVec3]) -> Option<DMat3> {
    let mut up = DVec3::Z;
    for drop in 0..=DROPS {
        if points.len() < 3 {
            return None;
        }
        let count = points.len() as f64;
        let mean = points.iter().sum::<DVec3>() / count;
        let spread = points.iter().fold(Matrix3::zeros(), |sum, point| {
            let off = Vector3::from((*point - mean).to_array());
            sum + off * off.transpose()
        });
        if !spread.iter().all(|number: &f64| number.is_finite()) {
            return None;
        }
        let axes = spread.symmetric_eigen();
        let least = axes.eigenvalues.imin();
        up = DVec3::from_slice(axes.eigenvectors.column(least).as_slice()).try_normalize()?;
        let towards: DVec3 = cameras.iter().map(|center| *center - mean).sum();
        if towards.dot(up) < 0.0 {
            up = -up;
        }
        if drop < DROPS {
            let deviation = |squares: f64| (squares.max(0.0) / count).sqrt();
            let across = deviation(axes.eigenvalues[least]);
            let most = FARTHEST * across + ROUNDING * deviation(axes.eigenvalues.max());
            points.retain(|point| (*point - mean).dot(up).abs() <= most);
        }
    }
    Some(DMat3::from_quat(DQuat::from_rotation_arc(up, DVec3::Z)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane that falls by 3 on 4 towards y, far from the origin, with three masts at one end of it: the turn is the
    /// one about x of which sine and cosine are 0.6 and 0.8; seen from below, its other side is up.
    #[test]
    fn a_slope_is_turned_level() {
        let middle = DVec3::new(500.0, -200.0, 40.0);
        let (across, normal) = (DVec3::new(0.0, 0.8, -0.6), DVec3::new(0.0, 0.6, 0.8));
        let mut points: Vec<DVec3> = (0..400)
            .map(|number| (f64::from(number % 20), f64::from(number / 20)))
            .map(|(x, y)| middle + DVec3::X * (x - 9.5) + across * (y - 9.5))
            .collect();
        for x in [-1.0, 0.0, 1.0] {
            points.push(middle + DVec3::X * x + across * 9.0 + normal * 50.0);
        }
        let sides = [
            (
                30.0,
                [
                    DVec3::X,
                    DVec3::new(0.0, 0.8, 0.6),
                    DVec3::new(0.0, -0.6, 0.8),
                ],
            ),
            (
                -30.0,
                [
                    DVec3::X,
                    DVec3::new(0.0, -0.8, -0.6),
                    DVec3::new(0.0, 0.6, -0.8),
                ],
            ),
        ];
        for (height, [x, y, z]) in sides {
            let cameras = [-5.0, 5.0].map(|x| middle + DVec3::X * x + normal * height);
            let turn = levelled(points.clone(), &cameras).unwrap();
            let answer = DMat3::from_cols(x, y, z);
            assert!(turn.abs_diff_eq(answer, 1e-9), "{turn} is not {answer}");
        }
    }

    #[test]
    fn without_a_plane_there_is_no_turn() {
        assert_eq!(levelled(vec![DVec3::ZERO, DVec3::X], &[DVec3::Z]), None);
        let endless = vec![DVec3::ZERO, DVec3::X, DVec3::splat(f64::INFINITY)];
        assert_eq!(levelled(endless, &[DVec3::Z]), None);
    }
}
