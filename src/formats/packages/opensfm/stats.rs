//! OpenSfM's `stats/stats.json`, which OpenDroneMap copies to `odm_report/stats.json`: how well the
//! cameras agree with their receivers, and how sure the world's scale is by that.
//!
//! Written from OpenSfM's `opensfm/stats.py` (`_gps_errors`, `_gps_gcp_errors_stats`). `gps_errors` is
//! the mean, the standard deviation and the root mean square, along x, y, z in metres, of the camera
//! centres less the receivers' positions.
//!
//! These are residuals: no standard deviation of a pose. Where nothing but the receivers gave the world
//! its scale (`has_gps`, no `has_gcp`) they tell its standard error, in the same way as `georeference`
//! finds it (core, `georeference/fit.rs`): with deviations s and the sum S of the squares of the
//! centres from their mean, along each axis,
//!
//! ```text
//! var(scale) = 3n / (3n - 7) · sum(s² S) / (sum S)²
//! ```
//!
//! It supposes, as there, that the receivers' errors are independent; those of one that drifts are not,
//! and then the true error is larger. `gcp_errors` are residuals of points whose number and places the
//! file does not say, `3d_errors` those of other points: nothing is taken from them.

use glam::DVec3;
use serde::Deserialize;

use crate::fault::Fault;
use crate::text::json::parse;

/// Parameters of a similarity.
const FITTED: f64 = 7.0;

#[derive(Deserialize)]
struct Stats {
    #[serde(default)]
    reconstruction_statistics: Sources,
    #[serde(default)]
    gps_errors: Errors,
}

#[derive(Deserialize, Default)]
struct Sources {
    #[serde(default)]
    has_gps: bool,
    #[serde(default)]
    has_gcp: bool,
}

#[derive(Deserialize, Default)]
struct Errors {
    std: Option<Axes>,
}

#[derive(Deserialize)]
struct Axes {
    x: f64,
    y: f64,
    z: f64,
}

/// The standard error of all lengths in percent, given the camera centres; `None` where it cannot be
/// told.
///
/// # Errors
/// Where it is no JSON of that shape, or a deviation is negative.
pub(crate) fn world_scale_error(json: &[u8], centers: &[DVec3]) -> Result<Option<f64>, Fault> {
    let stats: Stats = parse(json)?;
    let sources = stats.reconstruction_statistics;
    let (true, false, Some(Axes { x, y, z })) =
        (sources.has_gps, sources.has_gcp, stats.gps_errors.std)
    else {
        return Ok(None);
    };
    let deviations = DVec3::new(x, y, z);
    if deviations.min_element() < 0.0 {
        let what = format!("gps_errors.std is {x}, {y}, {z}: a standard deviation is not negative");
        return Err(Fault::new(what, "let OpenSfM compute its statistics again"));
    }
    let count = centers.len() as f64;
    let mean = centers.iter().sum::<DVec3>() / count;
    let squares = centers.iter().map(|c| (*c - mean) * (*c - mean));
    let squares: DVec3 = squares.sum();
    let spread = squares.element_sum();
    if centers.len() < 3 || spread <= 0.0 {
        return Ok(None);
    }
    let free = 3.0 * count / (3.0 * count - FITTED);
    let variance = free * (deviations * deviations).dot(squares) / spread.powi(2);
    Ok(Some(100.0 * variance.sqrt()).filter(|percent| percent.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fragscale_core::georeference::{Pair, fit};

    /// The numbers of a real one (OpenDroneMap, 76 photos with a Sony DSC-WX220, no ground control).
    const REAL: &str = r#"{"reconstruction_statistics": {"has_gps": true, "has_gcp": false,
        "reconstructed_shots_count": 76}, "gps_errors": {"mean": {"x": 0.006601, "y": -0.030014,
        "z": -0.141993}, "std": {"x": 0.4110024, "y": 0.4110321, "z": 0.798799}, "error": {"x":
        0.411055, "y": 0.412126, "z": 0.811321}, "average_error": 0.853616}, "gcp_errors": {}}"#;

    /// Over a square of four by four positions 20 m apart at one height, S = 16 · 500 m2 along x and y:
    /// var = 48/41 · 0.41102² · 16 000 / 16 000², so 0.3516 %.
    #[test]
    fn by_hand() {
        let centers =
            (0..16).map(|i| DVec3::new(20.0 * f64::from(i % 4), 20.0 * f64::from(i / 4), 90.0));
        let centers: Vec<DVec3> = centers.collect();
        let percent = world_scale_error(REAL.as_bytes(), &centers)
            .unwrap()
            .unwrap();
        assert!((percent - 0.3516).abs() < 5e-5, "{percent}");
    }

    /// A flight over uneven ground whose receiver errs by 1 and 2 m: what `georeference` finds for the
    /// same positions from the residuals themselves.
    #[test]
    fn as_georeference_finds_it() {
        let noise = |i: u32, prime: u32| f64::from(i * prime % 97) / 97.0 - 0.5;
        let centers = (0..60_u32).map(|i| {
            let across = DVec3::new(15.0 * f64::from(i % 10), 18.0 * f64::from(i / 10), 0.0);
            across + DVec3::new(noise(i, 31), noise(i, 53), 12.0 * noise(i, 71))
        });
        let centers: Vec<DVec3> = centers.collect();
        let errors =
            (0..60_u32).map(|i| DVec3::new(noise(i, 37), noise(i, 59), 2.0 * noise(i, 83)));
        let pairs: Vec<Pair> = centers
            .iter()
            .zip(errors)
            .map(|(center, error)| Pair {
                source: *center,
                target: *center + error,
                accuracy: None,
            })
            .collect();
        let found = fit(&pairs).unwrap();
        assert_eq!(found.count(), 60);
        // What OpenSfM writes once it has brought its centres to the positions.
        let fitted: Vec<DVec3> = centers.iter().map(|c| found.similarity.apply(*c)).collect();
        let count = 60.0;
        let mean = found.residuals.iter().sum::<DVec3>() / count;
        let squares = found.residuals.iter().map(|r| (*r - mean) * (*r - mean));
        let std = (squares.sum::<DVec3>() / count).map(f64::sqrt);
        let json = format!(
            r#"{{"reconstruction_statistics": {{"has_gps": true}},
                "gps_errors": {{"std": {{"x": {}, "y": {}, "z": {}}}}}}}"#,
            std.x, std.y, std.z
        );
        let percent = world_scale_error(json.as_bytes(), &fitted)
            .unwrap()
            .unwrap();
        // They differ by what the residuals of different axes have in common.
        let ratio = percent / (100.0 * found.scale_error);
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }

    #[test]
    fn what_cannot_be_told_is_not() {
        let three = [DVec3::ZERO, DVec3::X * 50.0, DVec3::Y * 50.0];
        let of = |json: &str, centers: &[DVec3]| world_scale_error(json.as_bytes(), centers);
        assert!(of(REAL, &three).unwrap().is_some());
        for other in [
            REAL.replace("\"has_gcp\": false", "\"has_gcp\": true"),
            REAL.replace("\"has_gps\": true", "\"has_gps\": false"),
            REAL.replace("\"std\"", "\"other\""),
            "{}".to_owned(),
        ] {
            assert_eq!(of(&other, &three), Ok(None), "{other}");
        }
        assert_eq!(of(REAL, &three[..2]), Ok(None));
        assert_eq!(of(REAL, &[DVec3::ONE; 5]), Ok(None));
        assert!(of(&REAL.replace("0.798799", "-0.798799"), &three).is_err());
        assert!(of("[", &three).is_err());
    }
}
