//! The median.

/// The median of `values`, which are reordered; of an even count the mean of the middle two.
/// `None` where there are none. NaN sorts last.
pub fn median(values: &mut [f64]) -> Option<f64> {
    let count = values.len();
    if count == 0 {
        return None;
    }
    let (below, &mut upper, _) = values.select_nth_unstable_by(count / 2, f64::total_cmp);
    if count % 2 == 1 {
        return Some(upper);
    }
    let lower = below.iter().copied().max_by(f64::total_cmp)?;
    Some(lower + (upper - lower) / 2.0)
}

/// The median of `values`, which become their deviations from it, and the median of these without their signs. `None` where there are
/// none.
pub fn median_with_deviation(values: &mut [f64]) -> Option<[f64; 2]> {
    let middle = median(values)?;
    for value in &mut *values {
        *value = (*value - middle).abs();
    }
    Some([middle, median(values)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: deviations 1, 0, 3, 1, 6 from 3.
    #[test]
    fn how_far_from_the_median() {
        assert_eq!(
            median_with_deviation(&mut [2.0, 3.0, 6.0, 4.0, -3.0]),
            Some([3.0, 1.0])
        );
        assert_eq!(median_with_deviation(&mut []), None);
    }

    #[test]
    fn odd_even_and_none() {
        assert_eq!(median(&mut []), None);
        assert_eq!(median(&mut [4.0]), Some(4.0));
        assert_eq!(median(&mut [9.0, 1.0, 4.0]), Some(4.0));
        assert_eq!(median(&mut [9.0, 1.0, 4.0, 5.0]), Some(4.5));
    }
}
