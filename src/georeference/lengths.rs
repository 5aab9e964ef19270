//! The scale alone, from known distances.

use super::fit::LARGEST_SCALE_ERROR;
use super::student::t95;
use crate::fault::Fault;

/// A scale from known distances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthsFit {
    /// Units of the world to one of the reconstruction.
    pub scale: f64,
    /// Its standard error, relative to it; `None` with one distance, which nothing checks.
    pub scale_error: Option<f64>,
    /// Half the width of its 95 % interval, relative to it.
    pub scale_interval: Option<f64>,
}

/// Fits the known lengths to `scale` times the lengths in the reconstruction, of pairs (length in the
/// reconstruction, known length), by least squares through the origin: s = sum(l d) / sum(l²), with
/// the variance sum((d - s l)²) / (n - 1) / sum(l²).
///
/// # Errors
/// No length, one that is not above 0, or lengths that contradict each other.
pub fn scale_of_lengths(lengths: &[(f64, f64)]) -> Result<LengthsFit, Fault> {
    let is_length = |length: f64| length > 0.0 && length.is_finite();
    if lengths.is_empty() || !lengths.iter().all(|(l, d)| is_length(*l) && is_length(*d)) {
        return Err(Fault::new(
            "a known distance is not above 0",
            "give two different points and their distance",
        ));
    }
    let squares: f64 = lengths.iter().map(|(l, _)| l * l).sum();
    let scale = lengths.iter().map(|(l, d)| l * d).sum::<f64>() / squares;
    let free = lengths.len() - 1;
    let off: f64 = lengths.iter().map(|(l, d)| (d - scale * l).powi(2)).sum();
    let scale_error = (free > 0).then(|| (off / free as f64 / squares).sqrt() / scale);
    if let Some(error) = scale_error.filter(|error| *error > LARGEST_SCALE_ERROR) {
        return Err(Fault::new(
            format!(
                "the known distances contradict each other: together they give the scale to {:.0} % only",
                error * 100.0
            ),
            "look which one is of other points, or was measured wrongly",
        ));
    }
    Ok(LengthsFit {
        scale,
        scale_error,
        scale_interval: scale_error.map(|error| error * t95(free)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NIST Dataplot's NoInt1 (StRD, linear regression without intercept): x 60 to 70, y 130 to 140.
    #[test]
    fn certified_regression() {
        let lengths: Vec<(f64, f64)> = (0..11)
            .map(|i| (60.0 + f64::from(i), 130.0 + f64::from(i)))
            .collect();
        let found = scale_of_lengths(&lengths).unwrap();
        assert!((found.scale - 2.074_380_165_289_26).abs() < 1e-13);
        let error = found.scale_error.unwrap() * found.scale;
        assert!((error - 0.165_289_256_198_347e-1).abs() < 1e-13, "{error}");
    }

    #[test]
    fn one_length_and_none() {
        let one = scale_of_lengths(&[(2.0, 5.0)]).unwrap();
        assert_eq!((one.scale, one.scale_error), (2.5, None));
        assert!(scale_of_lengths(&[]).is_err());
        assert!(scale_of_lengths(&[(0.0, 5.0)]).is_err());
        assert!(scale_of_lengths(&[(1.0, f64::NAN)]).is_err());
        // 20 m and 90 m of nearly the same length: the scale is 5.5 and 64 % off for each.
        let fault = scale_of_lengths(&[(10.0, 20.0), (10.2, 90.0)]).unwrap_err();
        assert!(fault.what.contains("contradict each other"), "{fault}");
    }
}
