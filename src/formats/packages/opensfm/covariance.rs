//! The `covariance` of a shot: what OpenSfM's adjustment says of how sure its pose is.
//!
//! Written from OpenSfM's source: `opensfm/io.py` (`shot_to_json`: the matrix as nested lists, `[]`
//! where none was computed), `opensfm/src/bundle/data/pose.h` (the parameters RX RY RZ TX TY TZ of
//! CAM_TO_WORLD) and `opensfm/src/bundle/src/bundle_adjuster.cc` (`ComputeCovariances`).
//!
//! - The parameters are NOT those of the JSON: `annotation_gui_gcp/run_ba.py`, which writes it, asks for
//!   those of the inverse pose (`get_covariance_inv_param`). The first three are the rotation vector of
//!   world_from_camera (minus the shot's `rotation`), the last three the camera's centre in the world.
//! - A step of a rotation vector v turns about the camera's own axes by J(v) times it, with the right
//!   Jacobian of the rotations `J = 1 - (1 - cos a)/a2 [v]x + (a - sin a)/a3 [v]x[v]x`, a = |v| (Chirikjian,
//!   "Stochastic Models, Information Theory, and Lie Groups 2", 2012, eq. 10.86). So the covariance about
//!   the camera's axes is J C J'.
//! - Where Ceres could not compute one, all shots get 1e-5 and 1e-2 on the diagonal: a stand-in, not
//!   taken. Zeros belong to shots that were held fixed.

use glam::{DMat3, DVec3};
use serde_json::Value;

use crate::packages::pose_covariance::{
    NoCovariance, PassedOver, PoseCovariance, Taken, covariance, degrees,
};

/// The variances that stand for "could not be computed".
const STAND_IN: [f64; 6] = [1e-5, 1e-5, 1e-5, 1e-2, 1e-2, 1e-2];

/// The covariance of a shot whose rotation vector of world_from_camera is `rotation`.
pub(super) fn of(value: &Value, rotation: DVec3, passed_over: &mut PassedOver) -> PoseCovariance {
    let Some(matrix) = passed_over.or_count(matrix(value)) else {
        return PoseCovariance::default();
    };
    let block = |first: usize| {
        let mut rows = [0.0; 9];
        for (to, from) in rows.chunks_mut(3).zip(&matrix[first..first + 3]) {
            to.copy_from_slice(&from[first..first + 3]);
        }
        covariance(rows)
    };
    let angle = passed_over.or_count(block(0)).map(|covariance| {
        let jacobian = right_jacobian(rotation);
        degrees(&(jacobian * covariance * jacobian.transpose()))
    });
    PoseCovariance {
        position: passed_over.or_count(block(3)),
        angle,
    }
}

fn matrix(value: &Value) -> Taken<[[f64; 6]; 6]> {
    let rows = match value {
        Value::Null => return Ok(None),
        Value::Array(rows) if rows.is_empty() => return Ok(None),
        Value::Array(rows) if rows.len() == 6 => rows,
        _ => return Err(NoCovariance),
    };
    let mut matrix = [[0.0; 6]; 6];
    for (to, row) in matrix.iter_mut().zip(rows) {
        let numbers = row.as_array().into_iter().flatten().map(Value::as_f64);
        let numbers: Option<Vec<f64>> = numbers.collect();
        let numbers = numbers.and_then(|numbers| numbers.try_into().ok());
        *to = numbers.ok_or(NoCovariance)?;
    }
    let is_stand_in = (matrix.iter().zip(STAND_IN).enumerate()).all(|(i, (row, variance))| {
        (row.iter().enumerate()).all(|(j, &value)| value == if i == j { variance } else { 0.0 })
    });
    Ok((!is_stand_in).then_some(matrix))
}

/// What takes a small step of a rotation vector to the turn about the turned axes.
fn right_jacobian(vector: DVec3) -> DMat3 {
    let angle = vector.length();
    let cross = DMat3::from_cols(
        DVec3::new(0.0, vector.z, -vector.y),
        DVec3::new(-vector.z, 0.0, vector.x),
        DVec3::new(vector.y, -vector.x, 0.0),
    );
    // The limits where there is nothing to divide by; wrong by a^2 / 24 and a^2 / 120.
    let (first, second) = match angle {
        angle if angle < 1e-4 => (0.5, 1.0 / 6.0),
        angle => (
            (1.0 - angle.cos()) / angle.powi(2),
            (angle - angle.sin()) / angle.powi(3),
        ),
    };
    DMat3::IDENTITY - cross * first + cross * cross * second
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::packages::opensfm;

    /// Turns by a quaternion: what the formulas above are not made of.
    fn turn(vector: DVec3) -> DQuat {
        DQuat::from_scaled_axis(vector)
    }

    /// Standard normal numbers from a fixed seed (sums of twelve uniform ones).
    fn normals(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            let mut uniform = || {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            (0..12).map(|_| uniform()).sum::<f64>() - 6.0
        }
    }

    /// 40 000 poses are drawn from a covariance of OpenSfM's parameters; the spread of their turns about
    /// the camera's axes and of their centres is what the file is read as.
    #[test]
    fn the_spread_of_drawn_poses() {
        let rotation = DVec3::new(1.9, -1.1, 0.7);
        // A lower triangle L; the covariance is L L'.
        let lower = [
            [3e-3, 0.0, 0.0, 0.0, 0.0, 0.0],
            [1e-3, 1e-3, 0.0, 0.0, 0.0, 0.0],
            [-2e-3, 5e-4, 4e-3, 0.0, 0.0, 0.0],
            [0.01, 0.0, 0.02, 0.03, 0.0, 0.0],
            [0.0, 0.01, 0.0, 0.01, 0.02, 0.0],
            [0.02, 0.0, 0.01, 0.0, 0.04, 0.05],
        ];
        let entry = |i: usize, j: usize| (0..6).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
        let rows = (0..6).map(|i| (0..6).map(|j| entry(i, j)).collect::<Vec<f64>>());
        let rows: Vec<Vec<f64>> = rows.collect();
        let json = format!(
            r#"[{{"cameras": {{"c": {{"focal": 1, "width": 4, "height": 4}}}}, "shots": {{"a": {{
                "camera": "c", "rotation": [-1.9, 1.1, -0.7], "translation": [1, 2, 3],
                "covariance": {rows:?}}}}}}}]"#
        );
        let found = opensfm::read(json.as_bytes()).unwrap();
        let errors = found.pose_errors[0].errors();
        let mut normal = normals(7);
        let mean = turn(rotation);
        let (mut turned, mut moved) = (DVec3::ZERO, DVec3::ZERO);
        let count = 40_000;
        for _ in 0..count {
            let z = [(); 6].map(|()| normal());
            let step = lower.map(|row| row.iter().zip(z).map(|(l, z)| l * z).sum::<f64>());
            let drawn = turn(rotation + DVec3::new(step[0], step[1], step[2]));
            let about = (mean.inverse() * drawn).to_scaled_axis();
            turned += about * about;
            let by = DVec3::new(step[3], step[4], step[5]);
            moved += by * by;
        }
        let spread = |sum: DVec3| (sum / f64::from(count)).map(f64::sqrt);
        let angles = spread(turned).map(f64::to_degrees) / errors.angle.unwrap();
        let centers = spread(moved) / errors.position.unwrap();
        // The standard error of a standard deviation from so many is 0.35 %.
        assert!((angles - 1.0).abs().max_element() < 0.015, "{angles}");
        assert!((centers - 1.0).abs().max_element() < 0.015, "{centers}");
        // And it does matter which axes they are about.
        assert!((errors.angle.unwrap().x.to_radians() / 3e-3 - 1.0).abs() > 0.1);
    }

    #[test]
    fn the_jacobian_is_that_of_differences() {
        for vector in [
            DVec3::ZERO,
            DVec3::new(3e-5, -2e-5, 1e-5),
            DVec3::new(-0.4, 2.0, 1.5),
        ] {
            let jacobian = right_jacobian(vector);
            for axis in DVec3::AXES {
                let step = 1e-6;
                let ends = [step, -step].map(|step| turn(vector + axis * step));
                let [plus, minus] = ends.map(|end| (turn(vector).inverse() * end).to_scaled_axis());
                let slope = (plus - minus) / (2.0 * step);
                let off = (slope - jacobian * axis).length();
                assert!(off < 1e-8, "{vector} {axis}: {off}");
            }
        }
    }

    #[test]
    fn what_says_nothing_is_not_taken() {
        let shot = |covariance: &str| {
            let mut passed_over = PassedOver::default();
            let value = serde_json::from_str(covariance).unwrap();
            let taken = of(&value, DVec3::X, &mut passed_over);
            (taken, passed_over.warning())
        };
        let diagonal = |variances: [f64; 6]| {
            let row = |i: usize| (0..6).map(move |j| if i == j { variances[i] } else { 0.0 });
            format!(
                "{:?}",
                (0..6)
                    .map(|i| row(i).collect::<Vec<f64>>())
                    .collect::<Vec<_>>()
            )
        };
        let nothing = PoseCovariance::default();
        for silent in ["null", "[]", &diagonal(STAND_IN), &diagonal([0.0; 6])] {
            assert_eq!(shot(silent), (nothing, None), "{silent}");
        }
        for wrong in ["[1]", "[[], [], [], [], [], []]", "\"x\"", "1e-3"] {
            let (taken, warning) = shot(wrong);
            assert!(taken == nothing && warning.is_some(), "{wrong}");
        }
        let (taken, warning) = shot(&diagonal([4e-6, 4e-6, 4e-6, -0.01, 0.04, 0.04]));
        assert_eq!((taken.position, taken.angle.is_some()), (None, true));
        assert!(warning.unwrap().starts_with("1 stated covariances"));
    }
}
