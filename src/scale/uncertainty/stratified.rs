//! Draws of several normal errors at once, spread as evenly as so few can be.
//!
//! Of plain draws the deviation of 400 is off by 3.5 % (one standard deviation), and so would be a standard error that
//! a formula gives exactly. So each error is drawn once from each of as many equally likely parts of its distribution (Latin
//! hypercube: McKay, Beckman & Conover, Technometrics 21 (1979) 239), in an order of its own; then what the orders have in common by
//! chance is taken out (Gram and Schmidt), so that a sum of errors has the deviation that follows from theirs.

use statrs::distribution::{ContinuousCDF, Normal};

use super::draws::Draws;

/// As many draws of `ERRORS` errors: each of mean 0 and standard deviation 1 over the draws, none correlated with another.
///
/// Fewer than `ERRORS` + 2 draws cannot be that: what is over is zero.
pub(super) fn stratified<const ERRORS: usize>(count: usize, seed: u64) -> Vec<[f64; ERRORS]> {
    let mut draws = Draws::new(seed);
    let mut columns: Vec<Vec<f64>> = Vec::with_capacity(ERRORS);
    for _ in 0..ERRORS {
        let mut column = shuffled_normals(count, &mut draws);
        for other in &columns {
            let common = product(&column, other) / count as f64;
            for (value, other) in column.iter_mut().zip(other) {
                *value -= common * other;
            }
        }
        let deviation = (product(&column, &column) / count as f64).sqrt();
        let factor = if deviation > 0.01 {
            deviation.recip()
        } else {
            0.0
        };
        column.iter_mut().for_each(|value| *value *= factor);
        columns.push(column);
    }
    (0..count)
        .map(|draw| std::array::from_fn(|error| columns[error][draw]))
        .collect()
}

/// The middle of each part in an order by chance; their sum is zero to rounding, and stays so where others like it are taken off.
fn shuffled_normals(count: usize, draws: &mut Draws) -> Vec<f64> {
    let mut values: Vec<f64> = (0..count)
        .map(|part| Normal::standard().inverse_cdf((part as f64 + 0.5) / count as f64))
        .collect();
    // Fisher and Yates'.
    for last in (1..count).rev() {
        values.swap(last, draws.place(last + 1));
    }
    values
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of the standard normal distribution, and its quantiles from a table.
    #[test]
    fn sums_are_as_sure_as_their_parts_say() {
        let drawn = stratified::<12>(400, 14);
        let moment = |of: &dyn Fn(&[f64; 12]) -> f64| drawn.iter().map(of).sum::<f64>() / 400.0;
        for error in 0..12 {
            assert!(moment(&|row| row[error]).abs() < 1e-12);
            for other in 0..12 {
                let expected = if error == other { 1.0 } else { 0.0 };
                let found = moment(&|row| row[error] * row[other]);
                assert!((found - expected).abs() < 1e-12, "{error} {other} {found}");
            }
            let fourth = moment(&|row| row[error].powi(4));
            assert!((fourth - 3.0).abs() < 0.3, "{fourth}");
            let beyond = drawn.iter().filter(|row| row[error] > 1.96).count();
            assert!((7..=13).contains(&beyond), "{beyond}");
        }
        // Three errors that add up: the root of 4 + 9 + 36.
        let of_sum = moment(&|row| (2.0 * row[0] - 3.0 * row[5] + 6.0 * row[11]).powi(2));
        assert!((of_sum - 49.0).abs() < 1e-9, "{of_sum}");
    }

    /// The order is by chance: nothing of one error is left in another's square either.
    #[test]
    fn orders_are_of_their_own() {
        let drawn = stratified::<3>(4000, 1);
        let of_squares = |a: usize, b: usize| {
            let sum: f64 = drawn
                .iter()
                .map(|row| row[a].powi(2) * row[b].powi(2))
                .sum();
            sum / 4000.0
        };
        // Independent: 1, with a deviation of (9 - 1)^0.5 / 4000^0.5 = 0.045.
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            assert!((of_squares(a, b) - 1.0).abs() < 0.15);
        }
        assert_ne!(drawn, stratified::<3>(4000, 2));
        assert_eq!(stratified::<3>(0, 1), [[0.0; 3]; 0]);
        assert_eq!(stratified::<2>(1, 1), [[0.0; 2]]);
    }
}
