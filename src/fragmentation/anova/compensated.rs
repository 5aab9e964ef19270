//! Sums whose rounding errors are carried along.

/// The sum of values by Neumaier, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher
/// Summen", Zeitschrift für Angewandte Mathematik und Mechanik 54 (1974) 39-51: what every addition
/// rounds away is collected and added at the end.
pub(super) fn compensated_sum(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0_f64, 0.0);
    for value in values {
        let next = sum + value;
        lost += if sum.abs() >= value.abs() {
            (sum - next) + value
        } else {
            (value - next) + sum
        };
        sum = next;
    }
    if sum.is_finite() {
        sum + lost
    } else {
        // What was lost on the way to infinity is no number.
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plain addition gives 0 here.
    #[test]
    fn small_values_survive_large_ones() {
        assert_eq!(compensated_sum([1.0, 1e100, 1.0, -1e100]), 2.0);
        assert_eq!(compensated_sum([]), 0.0);
        assert_eq!(compensated_sum([1e308, 1e308]), f64::INFINITY);
    }
}
