//! The scale alone, from known distances.

use super::fit::LARGEST_SCALE_ERROR;
use super::student::t95;
use crate::fault::Fault;
use crate::numbers::TO_95_PERCENT;

/// A distance that is known in the world, too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownLength {
    /// In the reconstruction.
    pub found: f64,
    /// The standard deviation of that; `None` where its ends are no marks in photos.
    pub deviation: Option<f64>,
    /// In the world.
    pub known: f64,
}

/// A scale from known distances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthsFit {
    /// Units of the world to one of the reconstruction.
    pub scale: f64,
    /// Its standard error, relative to it: by how far the distances disagree, or by how well their ends are marked, whichever
    /// is more. `None` with one distance between points that nobody marked.
    pub scale_error: Option<f64>,
    /// Half the width of its 95 % interval, relative to it.
    pub scale_interval: Option<f64>,
}

/// Fits the known lengths d to `scale` times the lengths l in the reconstruction by least squares through the origin:
/// s = sum(l d) / sum(l²), with the variance sum((d - s l)²) / (n - 1) / sum(l²), or with s² sum(l² e²) / sum(l²)² of
/// deviations e of the lengths l: few distances agree by chance better than their ends are known, and one agrees
/// with itself.
///
/// # Errors
/// No length, one that is not above 0, or lengths that contradict each other.
pub fn scale_of_lengths(lengths: &[KnownLength]) -> Result<LengthsFit, Fault> {
    let is_length = |length: f64| length > 0.0 && length.is_finite();
    let are_lengths = |of: &KnownLength| is_length(of.found) && is_length(of.known);
    if lengths.is_empty() || !lengths.iter().all(are_lengths) {
        let at_one = |of: &KnownLength| is_length(of.known) && of.found == 0.0;
        let what = match lengths.iter().any(at_one) {
            true => "the ends of a known distance are one point",
            false => "a known distance is not above 0",
        };
        return Err(Fault::new(
            what,
            "give two different points and their distance",
        ));
    }
    let sum = |of: &dyn Fn(&KnownLength) -> f64| lengths.iter().map(of).sum::<f64>();
    let squares = sum(&|of| of.found.powi(2));
    let scale = sum(&|of| of.found * of.known) / squares;
    let free = lengths.len() - 1;
    let off = sum(&|of| (of.known - scale * of.found).powi(2));
    let by_distances = (free > 0).then(|| (off / free as f64 / squares).sqrt() / scale);
    let marks: Option<Vec<f64>> = (lengths.iter())
        .map(|of| Some((of.found * of.deviation?).powi(2)))
        .collect();
    let by_marks = marks.map(|marks| marks.iter().sum::<f64>().sqrt() / squares);
    // Greater of numbers that are there.
    let greater = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(f64::max);
    let scale_error = greater(by_distances, by_marks);
    if let Some(error) = scale_error.filter(|error| *error > LARGEST_SCALE_ERROR) {
        return Err(Fault::new(
            format!(
                "the known distances{} give the scale to {:.0} % only",
                if by_distances == scale_error {
                    " contradict each other: together they"
                } else {
                    ", by how well their ends are marked,"
                },
                error * 100.0
            ),
            "look which one is of other points or was measured wrongly, and mark ends in more photos, or longer distances",
        ));
    }
    Ok(LengthsFit {
        scale,
        scale_error,
        scale_interval: greater(
            by_distances.map(|error| error * t95(free)),
            by_marks.map(|error| error * TO_95_PERCENT),
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(found: f64, known: f64) -> KnownLength {
        KnownLength {
            found,
            deviation: None,
            known,
        }
    }

    /// NIST Dataplot's NoInt1 (StRD, linear regression without intercept): x 60 to 70, y 130 to 140.
    #[test]
    fn certified_regression() {
        let lengths = (0..11).map(|i| known(60.0 + f64::from(i), 130.0 + f64::from(i)));
        let found = scale_of_lengths(&lengths.collect::<Vec<_>>()).unwrap();
        assert!((found.scale - 2.074_380_165_289_26).abs() < 1e-13);
        let error = found.scale_error.unwrap() * found.scale;
        assert!((error - 0.165_289_256_198_347e-1).abs() < 1e-13, "{error}");
    }

    #[test]
    fn one_length_and_none() {
        let one = scale_of_lengths(&[known(2.0, 5.0)]).unwrap();
        assert_eq!((one.scale, one.scale_error), (2.5, None));
        assert!(scale_of_lengths(&[]).is_err());
        assert!(scale_of_lengths(&[known(0.0, 5.0)]).is_err());
        assert!(scale_of_lengths(&[known(1.0, f64::NAN)]).is_err());
        // 20 m and 90 m of nearly the same length: the scale is 5.5 and 64 % off for each.
        let fault = scale_of_lengths(&[known(10.0, 20.0), known(10.2, 90.0)]).unwrap_err();
        assert!(fault.what.contains("contradict each other"), "{fault}");
    }

    /// By hand: of one length of 2 ± 0.01 a half of a percent; of 3 and 4 ± 0.03 and 0.05, which agree to the digit, the root of
    /// 0.09² + 0.2² over 25.
    #[test]
    fn ends_that_are_marked() {
        let marked = |found: f64, deviation: f64, of: f64| KnownLength {
            deviation: Some(deviation),
            ..known(found, of)
        };
        let one = scale_of_lengths(&[marked(2.0, 0.01, 5.0)]).unwrap();
        assert!((one.scale_error.unwrap() - 0.005).abs() < 1e-12);
        assert!((one.scale_interval.unwrap() - 0.005 * 1.959_964).abs() < 1e-8);
        let two = [marked(3.0, 0.03, 6.0), marked(4.0, 0.05, 8.0)];
        let both = scale_of_lengths(&two).unwrap().scale_error.unwrap();
        assert!((both - (0.0081_f64 + 0.04).sqrt() / 25.0).abs() < 1e-12);
        // Where one is no mark nobody knows.
        let some = scale_of_lengths(&[marked(3.0, 0.03, 6.0), known(4.0, 8.0)]).unwrap();
        assert_eq!(some.scale_error, Some(0.0));
        // Distances that disagree by more count as before.
        let apart = scale_of_lengths(&[marked(3.0, 0.001, 6.0), marked(4.0, 0.001, 8.4)]).unwrap();
        let before = scale_of_lengths(&[known(3.0, 6.0), known(4.0, 8.4)]).unwrap();
        assert_eq!(apart, before);
        let fault = scale_of_lengths(&[marked(2.0, 0.5, 5.0)]).unwrap_err();
        assert!(
            fault.what.contains("by how well their ends are marked"),
            "{fault}"
        );
    }
}
