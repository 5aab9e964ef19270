//! The camera of this room's tests.

use crate::camera::{Brown, Camera, Distortion};

/// A camera with everything that a place of a pixel can hang on: no square pixels, no principal point in the middle,
/// axes that are skew.
pub(super) fn camera(distortion: Distortion) -> Camera {
    Camera {
        name: String::new(),
        width: 4000,
        height: 3000,
        fx: 3000.0,
        fy: 3010.0,
        cx: 1990.0,
        cy: 1510.0,
        skew: 0.5,
        distortion,
    }
}

/// A lens that bends as a drone's does.
pub(super) fn brown() -> Distortion {
    Distortion::Brown(Brown::new([-0.12, 0.04, 1e-3, -5e-4, 0.0, 0.0, 0.0, 0.0]))
}
