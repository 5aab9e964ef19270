//! The geoid EGM96, which drones and their ground stations call mean sea level.

/// Metres that the geoid EGM96 lies above the ellipsoid WGS 84 at a place (degrees, WGS 84): from -107 to 85.
/// Height above the ellipsoid = height above the geoid + this.
///
/// The harmonics to degree 360 are summed, which takes about a millisecond.
pub fn geoid_height(latitude: f64, longitude: f64) -> f64 {
    egm96::egm96_compute_altitude_offset(latitude, longitude)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places and answers that NGA gives with its program F477 (INPUT.DAT and OUTF477.DAT of EGM96), in
    /// single precision: the second one is 3 mm off.
    #[test]
    fn the_answers_of_nga() {
        for (latitude, longitude, expected) in [
            (38.628_155, 269.779_155, -31.628),
            (-14.621_217, 305.021_114, -2.969),
            (46.874_319, 102.448_729, -43.575),
            (-23.617_446, 133.874_712, 15.871),
            (38.625_473, 359.999_5, 50.066),
            (-0.466_744, 0.002_3, 17.329),
        ] {
            let found = geoid_height(latitude, longitude);
            assert!((found - expected).abs() < 4e-3, "{found} {expected}");
            let west = geoid_height(latitude, longitude - 360.0);
            assert!((west - found).abs() < 1e-6, "{west} {found}");
        }
    }
}
