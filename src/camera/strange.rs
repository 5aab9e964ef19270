//! Intrinsics that no lens has: columns swapped, offsets from the middle in place of pixels from the corner, a focal length in
//! another unit than the other.

use super::Camera;
use crate::numbers::significant_digits;

/// How far the principal point of a lens may lie off the image's middle, a share of its width and height: cameras are made to
/// have it there, to a few hundredths.
const OFF_MIDDLE: f64 = 0.25;

/// How far the two focal lengths may be from each other: pixels of sensors are squares, but those of films may not be.
const NOT_SQUARE: f64 = 0.1;

impl Camera {
    /// What is strange about its intrinsics, in words; `None` of those that a lens may have.
    pub fn strange(&self) -> Option<String> {
        let size = [self.width, self.height].map(f64::from);
        let middle = size.map(|size| size / 2.0);
        let off = [
            (self.cx - middle[0]) / size[0],
            (self.cy - middle[1]) / size[1],
        ];
        if off.iter().any(|off| off.abs() > OFF_MIDDLE) {
            return Some(format!(
                "its principal point ({}, {}) is far from the middle ({}, {}) of its image: cx and cy are pixels from the image's corner, in \
                 this order",
                significant_digits(self.cx, 5),
                significant_digits(self.cy, 5),
                middle[0],
                middle[1]
            ));
        }
        let ratio = self.fy / self.fx;
        ((ratio - 1.0).abs() > NOT_SQUARE).then(|| {
            format!(
                "fy is {} times fx, though pixels are squares: both are in pixels of the same image",
                significant_digits(ratio, 3)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Distortion;

    #[test]
    fn what_no_lens_has() {
        let of = |cx: f64, cy: f64, fy: f64| {
            let camera = Camera {
                name: String::new(),
                width: 1280,
                height: 720,
                fx: 1000.0,
                fy,
                cx,
                cy,
                skew: 0.0,
                distortion: Distortion::None,
            };
            camera.strange().unwrap_or_default()
        };
        assert_eq!(of(637.0, 370.5, 1003.0), "");
        assert_eq!(of(560.0, 330.0, 960.0), "");
        // Offsets from the middle; the two swapped; the image's corner.
        for (cx, cy) in [(-2.75, 1.75), (360.0, 640.0), (0.0, 0.0)] {
            let said = of(cx, cy, 1000.0);
            assert!(said.contains("far from the middle (640, 360)"), "{said}");
        }
        assert!(
            of(640.0, 360.0, 2000.0).starts_with("fy is 2.00 times fx"),
            "{}",
            of(640.0, 360.0, 2000.0)
        );
    }
}
