//! The smallest positive root of a polynomial: where a distortion model stops growing.

/// `coefficients[i]` belongs to x^i.
fn evaluate(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The smallest root in (0, `limit`] at which the polynomial changes its sign, to the last bits;
/// `None` where there is none. `coefficients[i]` belongs to x^i and all are finite.
///
/// Between two neighbouring roots of the derivative the polynomial is monotone, so each such piece
/// holds at most one root, which bisection cannot miss; the derivative's roots come by recursion.
pub(super) fn smallest_positive_root(coefficients: &[f64], limit: f64) -> Option<f64> {
    roots(coefficients, limit).into_iter().next()
}

/// The same of even(x^2) - x odd(x^2): where what is left of a lens's growth is no more than its tangential terms can take away.
pub(super) fn smallest_root_of_parts(even: &[f64], odd: &[f64], limit: f64) -> Option<f64> {
    let mut coefficients = vec![0.0; 2 * even.len().max(odd.len())];
    for (power, even) in even.iter().enumerate() {
        coefficients[2 * power] = *even;
    }
    for (power, odd) in odd.iter().enumerate() {
        coefficients[2 * power + 1] = -odd;
    }
    let degree = coefficients.iter().rposition(|c| *c != 0.0);
    smallest_positive_root(
        &coefficients[..degree.map_or(0, |degree| degree + 1)],
        limit,
    )
}

/// All sign-changing roots in (0, limit], ascending.
fn roots(coefficients: &[f64], limit: f64) -> Vec<f64> {
    if coefficients.len() < 2 {
        return Vec::new();
    }
    let derivative: Vec<f64> = coefficients
        .iter()
        .enumerate()
        .skip(1)
        .map(|(power, c)| c * power as f64)
        .collect();
    let mut stops = roots(&derivative, limit);
    stops.push(limit);
    let mut found = Vec::new();
    let mut low = 0.0;
    for high in stops {
        let (at_low, at_high) = (evaluate(coefficients, low), evaluate(coefficients, high));
        if at_low * at_high < 0.0 || (at_high == 0.0 && at_low != 0.0) {
            found.push(bisect(coefficients, low, high, at_low > 0.0));
        }
        low = high;
    }
    found
}

fn bisect(coefficients: &[f64], mut low: f64, mut high: f64, positive_at_low: bool) -> f64 {
    loop {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            return high;
        }
        if (evaluate(coefficients, middle) > 0.0) == positive_at_low {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_roots() {
        // (x - 1)(x - 2)(x + 3)
        let cubic = [6.0, -7.0, 0.0, 1.0];
        assert!((smallest_positive_root(&cubic, 10.0).unwrap() - 1.0).abs() < 1e-15);
        // x^2 + 1
        assert_eq!(smallest_positive_root(&[1.0, 0.0, 1.0], 10.0), None);
        // 1 - 2 x^6 touches zero once, far steeper than its neighbours' scale
        let root = smallest_positive_root(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0], 1e6).unwrap();
        assert!((root - 0.5_f64.powf(1.0 / 6.0)).abs() < 1e-15);
        // beyond the limit
        assert_eq!(smallest_positive_root(&[-5.0, 1.0], 4.0), None);
        assert_eq!(smallest_positive_root(&[3.0], 4.0), None);
        assert_eq!(smallest_positive_root(&[], 4.0), None);
        // 6 - x (7 - x^2) = (x - 1)(x - 2)(x + 3)
        let root = smallest_root_of_parts(&[6.0], &[7.0, -1.0], 10.0).unwrap();
        assert!((root - 1.0).abs() < 1e-15, "{root}");
        assert_eq!(
            smallest_root_of_parts(&[1.0, 0.0, -1.0], &[], 10.0),
            Some(1.0)
        );
    }
}
