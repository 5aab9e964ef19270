//! Which image a calibration in a photo's metadata is for, by where it has its optical centre.
//!
//! A calibration is written without the image size that it holds for, and a drone that is set to 16:9
//! photos writes that of its whole 4:3 or 3:2 sensor into them: Skydio's 4056 x 2282 photos have the
//! centre at 2029, 1520, the middle of 4056 x 3040 (`skydio-catilina.jpg` of OpenAthena's examples).
//! The centre lies near the middle of the calibrated image, so twice the centre is about its size:
//!
//! 1. It is the photo's size: the calibration is the photo's.
//! 2. One side is the photo's and the other longer, and the whole has the shape of a sensor, 4:3 or
//!    3:2: the photo is the middle of it (DJI's and Skydio's photos are cut evenly at both sides). The
//!    focal length in pixels stays, and the centre moves by half of what was cut.
//! 3. It has the photo's shape and another size: everything is scaled.
//! 4. Else the calibration is of another camera or another cut, and is not used.
//!
//! A designed centre is the middle exactly. A measured one is off it by up to some hundred pixels:
//! the whole's size is then the sensor's shape at the photo's width or height, and a scale (3) is off
//! as the centre is.

/// The shapes of sensors, long side to short.
const SENSORS: [f64; 2] = [4.0 / 3.0, 3.0 / 2.0];

/// How a stated centre was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Centre {
    /// By the lens's design: the middle.
    Designed,
    /// By a calibration: near the middle.
    Measured,
}

impl Centre {
    /// How far, as a part, twice the centre may be off the size.
    fn tolerance(self) -> f64 {
        match self {
            Self::Designed => 0.02,
            Self::Measured => 0.05,
        }
    }
}

/// How a calibration becomes the photo's: its pixels times `scale`, less `cut`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    pub(super) scale: f64,
    /// What the photo lacks at the left and at the top.
    pub(super) cut: (f64, f64),
    /// The size of the whole image, where it is not the photo's.
    pub(super) whole: Option<(f64, f64)>,
}

impl Fit {
    pub(super) const SAME: Self = Self {
        scale: 1.0,
        cut: (0.0, 0.0),
        whole: None,
    };

    /// Whether the pixels are of another size.
    pub(super) fn is_scaled(&self) -> bool {
        self.scale != 1.0
    }

    /// What is to be said of a calibration that is not the photo's own.
    pub(super) fn sentence(&self, (width, height): (f64, f64)) -> Option<String> {
        let (whole_width, whole_height) = self.whole?;
        let what = if self.is_scaled() {
            "has the same shape, so it is scaled".to_owned()
        } else {
            let (left, top) = self.cut;
            format!(
                "is taken for the middle of that: focal lengths in pixels stay, and the optical centre moves by {:.0} px",
                left.max(top)
            )
        };
        Some(format!(
            "the calibration in its XMP is for {whole_width:.0} x {whole_height:.0}; the photo, {width} x {height}, {what}"
        ))
    }
}

/// Fits a calibration with its centre there to a photo of that size; `None` where it is of another
/// image.
pub(super) fn fit(
    (cx, cy): (f64, f64),
    centre: Centre,
    (width, height): (f64, f64),
) -> Option<Fit> {
    let (across, down) = (2.0 * cx / width, 2.0 * cy / height);
    let is_one = |ratio: f64, tolerance: f64| (ratio - 1.0).abs() <= tolerance;
    let tolerance = centre.tolerance();
    if is_one(across, tolerance) && is_one(down, tolerance) {
        return Some(Fit::SAME);
    }
    let whole_side = |kept: f64, twice_centre: f64, photo: f64| {
        let (long, short) = (kept.max(twice_centre), kept.min(twice_centre));
        let shape = SENSORS
            .into_iter()
            .find(|shape| is_one(long / short / shape, tolerance))?;
        let of_shape = if kept >= twice_centre {
            kept / shape
        } else {
            kept * shape
        };
        let whole = match centre {
            Centre::Designed => twice_centre,
            Centre::Measured => of_shape,
        };
        (whole > photo).then_some(whole)
    };
    if is_one(across, tolerance)
        && let Some(whole) = whole_side(width, 2.0 * cy, height)
    {
        return Some(Fit {
            cut: (0.0, (whole - height) / 2.0),
            whole: Some((width, whole)),
            ..Fit::SAME
        });
    }
    if is_one(down, tolerance)
        && let Some(whole) = whole_side(height, 2.0 * cx, width)
    {
        return Some(Fit {
            cut: ((whole - width) / 2.0, 0.0),
            whole: Some((whole, height)),
            ..Fit::SAME
        });
    }
    // As far off the middle as lenses are mounted.
    if is_one(across, 0.1) && is_one(down, 0.1) {
        return Some(Fit::SAME);
    }
    is_one(across / down, tolerance / 2.0).then(|| Fit {
        scale: 1.0 / across,
        cut: (0.0, 0.0),
        whole: Some((2.0 * cx, 2.0 * cy)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_16_to_9_photo_is_the_middle_of_the_sensor() {
        for (whole, height) in [
            ((5472.0, 3648.0), 3078.0),
            ((4000.0, 3000.0), 2250.0),
            ((5280.0, 3956.0), 2970.0),
        ] {
            let (width, whole_height) = whole;
            let middle = (width / 2.0, whole_height / 2.0);
            let found = fit(middle, Centre::Designed, (width, height)).unwrap();
            assert_eq!(found.scale, 1.0);
            assert_eq!(found.cut, (0.0, (whole_height - height) / 2.0));
            assert_eq!(found.whole, Some(whole));
        }
        // A Phantom 4's 4:3 photo of its 3:2 sensor, cut at the sides.
        let found = fit((2736.0, 1824.0), Centre::Designed, (4864.0, 3648.0)).unwrap();
        assert_eq!(found.cut, (304.0, 0.0));
    }

    #[test]
    fn a_measured_centre_says_the_shape_and_not_the_size() {
        // Skydio's, with the first pixel's centre at 0.5: 4056 x 3042 is the 4:3 of 4056.
        let found = fit((2029.67, 1520.77), Centre::Measured, (4056.0, 2282.0)).unwrap();
        assert_eq!((found.scale, found.cut), (1.0, (0.0, 380.0)));
        let same = fit((2029.67, 1520.77), Centre::Measured, (4056.0, 3040.0));
        assert_eq!(same, Some(Fit::SAME));
    }

    #[test]
    fn another_size_is_scaled_and_another_shape_refused() {
        let half = fit((2736.0, 1824.0), Centre::Designed, (2736.0, 1824.0)).unwrap();
        assert_eq!((half.scale, half.cut), (0.5, (0.0, 0.0)));
        // The colour camera's in a thermal photo, and a cut that no sensor's shape explains.
        assert_eq!(
            fit((1989.8, 1444.3), Centre::Measured, (640.0, 512.0)),
            None
        );
        assert_eq!(
            fit((2000.0, 2000.0), Centre::Designed, (4000.0, 2250.0)),
            None
        );
        assert_eq!(
            fit((2736.0, 1824.0), Centre::Designed, (2000.0, 2000.0)),
            None
        );
    }
}
