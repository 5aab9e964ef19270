//! The ends of an interval, read off draws that a normal error moves further, all of them likewise.
//!
//! Of that error nothing has to be drawn: the share of all that lies below a value is the mean of what each draw, spread by it,
//! has below. So an end goes steadily with the draws, and has no chance of the error in it.

use statrs::distribution::{ContinuousCDF, Normal};

/// How many deviations the normal error reaches: beyond lies nothing that counts, 1e-23.
const REACH: f64 = 10.0;

/// Halvings of the range in which an end lies: 1e-12 of it.
const HALVINGS: u32 = 40;

/// Below which value this share of the draws lies, 0 to 1, where each may be off by a normal error of this deviation.
///
/// Draws may be infinite both ways; so is the value where as many are. Of no draws it is negatively infinite.
pub(crate) fn at_share(mut draws: Vec<f64>, deviation: f64, share: f64) -> f64 {
    draws.sort_unstable_by(f64::total_cmp);
    let below_all = draws.partition_point(|draw| *draw == f64::NEG_INFINITY);
    let above_all = draws.partition_point(|draw| *draw < f64::INFINITY);
    let finite = &draws[below_all..above_all];
    let wanted = share * draws.len() as f64 - below_all as f64;
    let (Some(first), Some(last)) = (finite.first(), finite.last()) else {
        return match wanted > 0.0 {
            true => f64::INFINITY,
            false => f64::NEG_INFINITY,
        };
    };
    if wanted <= 0.0 {
        return f64::NEG_INFINITY;
    }
    if wanted >= finite.len() as f64 {
        return f64::INFINITY;
    }
    if deviation == 0.0 {
        return between(finite, wanted - 0.5);
    }
    let normal = Normal::standard();
    let (mut low, mut high) = (first - REACH * deviation, last + REACH * deviation);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        let below = finite
            .iter()
            .map(|draw| normal.cdf((middle - draw) / deviation));
        if below.sum::<f64>() < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// The value at a place of a sorted list, between two of them in proportion; the nearest at its ends.
fn between(sorted: &[f64], place: f64) -> f64 {
    let last = sorted.len() - 1;
    let place = place.clamp(0.0, last as f64);
    let below = place as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * place.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAIL: f64 = 0.025;

    /// Of one draw it is the normal error alone, of table 1.959964; of draws that are as good as normal the root of both variances.
    #[test]
    fn normal_errors_add_up() {
        let one = at_share(vec![3.0], 0.1, 1.0 - TAIL);
        assert!((one - 3.195_996_4).abs() < 1e-6, "{one}");
        let normal = Normal::standard();
        let draws: Vec<f64> = (0..2000)
            .map(|part| 0.3 * normal.inverse_cdf((f64::from(part) + 0.5) / 2000.0))
            .collect();
        for (deviation, wanted) in [(0.0, 0.3), (0.4, 0.5)] {
            for (share, sign) in [(TAIL, -1.0), (1.0 - TAIL, 1.0)] {
                let found = at_share(draws.clone(), deviation, share);
                assert!(
                    (found - sign * 1.959_964 * wanted).abs() < 1e-3,
                    "{found} {deviation}"
                );
            }
        }
    }

    #[test]
    fn without_an_error_it_lies_between_two_draws() {
        let draws: Vec<f64> = (0..1000).rev().map(f64::from).collect();
        assert_eq!(at_share(draws.clone(), 0.0, TAIL), 24.5);
        assert_eq!(at_share(draws.clone(), 0.0, 0.5), 499.5);
        assert_eq!(at_share(draws, 0.0, 1e-9), 0.0);
        assert_eq!(at_share(vec![2.0; 7], 0.0, TAIL), 2.0);
    }

    /// As many draws below all, or above all, as lie beyond an end: it is there, too.
    #[test]
    fn what_has_no_end() {
        let (below, above) = (f64::NEG_INFINITY, f64::INFINITY);
        for deviation in [0.0, 0.1] {
            let mut draws = vec![1.0; 100];
            draws[40..43].fill(below);
            assert_eq!(at_share(draws.clone(), deviation, TAIL), below);
            assert!(at_share(draws.clone(), deviation, 1.0 - TAIL) < 1.3);
            draws[7..10].fill(above);
            assert_eq!(at_share(draws.clone(), deviation, 1.0 - TAIL), above);
            draws[10] = below;
            assert!((at_share(draws, deviation, 0.5) - 1.0).abs() < 0.01);
            assert_eq!(at_share(vec![above; 3], deviation, TAIL), above);
            assert_eq!(at_share(vec![below; 3], deviation, 1.0 - TAIL), below);
            assert_eq!(at_share(Vec::new(), deviation, TAIL), below);
        }
    }
}
