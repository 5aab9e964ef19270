//! The inverse of a function that grows.

/// Where `function` (value and slope), which grows on [`low`, `high`], takes the value `wanted`, to
/// the last bits; the nearer end where it does not take it there. `start` lies in the interval.
/// Newton's method, kept inside by bisection.
pub(super) fn solve_growing(
    function: impl Fn(f64) -> (f64, f64),
    wanted: f64,
    mut low: f64,
    mut high: f64,
    start: f64,
) -> f64 {
    let mut x = start;
    for _ in 0..200 {
        let (value, slope) = function(x);
        if value > wanted {
            high = x;
        } else {
            low = x;
        }
        let newton = x - (value - wanted) / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            low + (high - low) / 2.0
        };
        if next == x {
            break;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_inverses() {
        let cube = |x: f64| (x.powi(3), 3.0 * x * x);
        assert!((solve_growing(cube, 8.0, 0.0, 10.0, 9.0) - 2.0).abs() < 1e-15);
        // From a start where Newton leaves the interval, and to an end where the slope is 0.
        assert!((solve_growing(cube, 1e-3, 0.0, 10.0, 1e-9) - 0.1).abs() < 1e-15);
        let sine = |x: f64| (x.sin(), x.cos());
        let half_turn = std::f64::consts::FRAC_PI_2;
        assert!((solve_growing(sine, 1.0, 0.0, half_turn, 1.0) - half_turn).abs() < 1e-7);
    }
}
