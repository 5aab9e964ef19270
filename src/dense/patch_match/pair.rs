//! Two pinholes: where the one sees what the other sees at a pixel and an inverse depth.

use glam::{DMat3, DVec3};

use crate::camera::{Camera, Pose};

/// The map from the pixels of one view to those of another, and back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pair {
    /// Columns of A, then b; see the header of `patch_match`.
    pub(crate) there: [[f32; 3]; 4],
    /// The same from the other view back.
    pub(crate) back: [[f32; 3]; 4],
}

/// A camera's matrix K.
pub(crate) fn matrix(camera: &Camera) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(camera.fx, 0.0, 0.0),
        DVec3::new(camera.skew, camera.fy, 0.0),
        DVec3::new(camera.cx, camera.cy, 1.0),
    )
}

/// The same camera for an image that was halved so many times.
pub(crate) fn reduced(camera: &Camera, halvings: u32) -> Camera {
    let mut camera = camera.clone();
    for _ in 0..halvings {
        camera.width = camera.width.div_ceil(2);
        camera.height = camera.height.div_ceil(2);
        for number in [
            &mut camera.fx,
            &mut camera.fy,
            &mut camera.cx,
            &mut camera.cy,
            &mut camera.skew,
        ] {
            *number *= 0.5;
        }
    }
    camera
}

/// A and b in f64.
pub(crate) fn exact(from: (&Camera, &Pose), to: (&Camera, &Pose)) -> (DMat3, DVec3) {
    let into = to.1.rotation.transpose();
    let k = matrix(to.0);
    (
        k * into * from.1.rotation * matrix(from.0).inverse(),
        k * (into * (from.1.center - to.1.center)),
    )
}

impl Pair {
    pub(crate) fn of(from: (&Camera, &Pose), to: (&Camera, &Pose)) -> Self {
        let columns = |(a, b): (DMat3, DVec3)| {
            [a.x_axis, a.y_axis, a.z_axis, b].map(|column| column.as_vec3().to_array())
        };
        Self {
            there: columns(exact(from, to)),
            back: columns(exact(to, from)),
        }
    }
}

/// m for a pixel and an inverse depth.
#[inline(always)]
pub(crate) fn project(columns: &[[f32; 3]; 4], [u, v]: [f32; 2], inverse_depth: f32) -> [f32; 3] {
    let [x, y, one, b] = columns;
    // Written out: closures are not inlined into code for another kind of processor.
    [
        x[0] * u + y[0] * v + one[0] + b[0] * inverse_depth,
        x[1] * u + y[1] * v + one[1] + b[1] * inverse_depth,
        x[2] * u + y[2] * v + one[2] + b[2] * inverse_depth,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Distortion;
    use glam::DVec2;

    /// Against the core's own projection.
    #[test]
    fn as_the_cameras_project() {
        let camera = Camera {
            name: String::new(),
            width: 1280,
            height: 720,
            fx: 1000.0,
            fy: 990.0,
            cx: 645.5,
            cy: 350.25,
            skew: 3.0,
            distortion: Distortion::None,
        };
        let pose = |x: f64, yaw: f64| {
            Pose::from_yaw_pitch_roll(DVec3::new(x, 5.0, 60.0), [yaw, -80.0, 3.0])
        };
        let (from, to) = (pose(400_000.0, 10.0), pose(400_009.0, 17.0));
        let (a, b) = exact((&camera, &from), (&camera, &to));
        let pair = Pair::of((&camera, &from), (&camera, &to));
        let (pixel, depth) = (DVec2::new(300.5, 600.5), 57.0);
        let point = from.center + from.rotation * camera.direction_undistorted(pixel) * depth;
        let truth = camera
            .pixel_undistorted(to.rotation.transpose() * (point - to.center))
            .unwrap();
        let m = a * pixel.extend(1.0) + b / depth;
        assert!((m.truncate() / m.z - truth).length() < 1e-6);
        let there = project(&pair.there, [300.5, 600.5], 1.0 / 57.0);
        let (u, v) = (there[0] / there[2], there[1] / there[2]);
        assert!((f64::from(u) - truth.x).abs() < 1e-3 && (f64::from(v) - truth.y).abs() < 1e-3);
        // m.z is the ratio of the depths.
        let back = project(&pair.back, [u, v], there[2].recip() / 57.0);
        assert!((back[0] / back[2] - 300.5).abs() < 2e-3);
        // A halved image has its pixels at half the numbers.
        let half = reduced(&camera, 1);
        let seen = half.pixel_undistorted(DVec3::new(0.1, 0.2, 1.0)).unwrap();
        let full = camera.pixel_undistorted(DVec3::new(0.1, 0.2, 1.0)).unwrap();
        assert!((seen * 2.0 - full).length() < 1e-9);
        assert_eq!((half.width, half.height), (640, 360));
    }
}
