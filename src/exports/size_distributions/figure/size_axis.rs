//! The logarithmic axis of sizes: where it begins and ends, its lines and labels.

/// An axis of sizes, linear in their logarithm.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeAxis {
    /// What the sizes are, with their unit.
    pub title: String,
    /// The smallest size, above 0.
    pub low: f64,
    /// The largest size, above the smallest.
    pub high: f64,
    /// Ascending, within both.
    pub ticks: Vec<SizeTick>,
}

/// A line across the figure at a size.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeTick {
    /// The size: 1, 2 or 5 times a power of ten; on short axes any one digit times that.
    pub size: f64,
    /// Empty where only a line is drawn.
    pub label: String,
    /// Whether it is a power of ten.
    pub decade: bool,
}

/// Powers of ten beyond which nothing is drawn: no rock is so small or so large.
const DECADES: i32 = 30;
/// Axes with more decades than these have no lines at 2 and 5, and none at every decade.
const MOST_DECADES: f64 = 8.0;

impl SizeAxis {
    /// The axis that shows all these sizes, a little more at both ends. Sizes that are no numbers above
    /// 0 do not count; without any it is from 1 to 10.
    pub fn covering(title: impl Into<String>, sizes: impl IntoIterator<Item = f64>) -> Self {
        let (least, most) = (power(1, -DECADES), power(1, DECADES));
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for size in sizes.into_iter().filter(|s| (least..=most).contains(s)) {
            low = low.min(size);
            high = high.max(size);
        }
        if low > high {
            (low, high) = (1.0, 10.0);
        }
        // Markers at the ends stay clear of the frame.
        let (first, last) = (low / 1.03, high * 1.03);
        let steps = || (-DECADES - 1..=DECADES + 1).flat_map(|e| [1, 2, 5].map(|d| power(d, e)));
        let low = steps().take_while(|s| *s <= first).last().unwrap_or(first);
        let high = steps().find(|s| *s >= last).unwrap_or(last);
        Self {
            title: title.into(),
            low,
            high,
            ticks: ticks(low, high),
        }
    }

    /// Where a size is on the axis: 0 at its beginning, 1 at its end.
    pub fn share(&self, size: f64) -> f64 {
        (size / self.low).ln() / (self.high / self.low).ln()
    }

    /// So many sizes from the beginning to the end, evenly in the logarithm.
    pub fn sizes(&self, count: u32) -> impl Iterator<Item = f64> + '_ {
        let last = f64::from(count.max(2) - 1);
        (0..count.max(2)).map(move |i| self.low * (self.high / self.low).powf(f64::from(i) / last))
    }
}

fn ticks(low: f64, high: f64) -> Vec<SizeTick> {
    let decades = (high / low).log10();
    // On an axis of 40 decades a label at every fifth.
    let every = (decades / MOST_DECADES).ceil() as i32;
    let lines: &[i32] = match decades {
        d if d <= 1.01 => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
        d if d <= MOST_DECADES => &[1, 2, 5],
        _ => &[1],
    };
    let labelled = |digit: i32, exponent: i32| match decades {
        d if d <= 4.01 => true,
        d if d <= MOST_DECADES => digit == 1,
        _ => exponent % every == 0,
    };
    let mut ticks = Vec::new();
    for exponent in -DECADES - 1..=DECADES + 1 {
        for &digit in lines {
            let size = power(digit, exponent);
            if (low..=high).contains(&size) {
                let label = match labelled(digit, exponent) {
                    true => label(size),
                    false => String::new(),
                };
                ticks.push(SizeTick {
                    size,
                    label,
                    decade: digit == 1,
                });
            }
        }
    }
    ticks
}

/// `digit` times ten to the `exponent`, rounded once.
fn power(digit: i32, exponent: i32) -> f64 {
    format!("{digit}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// As people write it.
fn label(size: f64) -> String {
    if (1e-4..1e6).contains(&size) {
        size.to_string()
    } else {
        format!("{size:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &SizeAxis) -> Vec<&str> {
        axis.ticks.iter().map(|t| t.label.as_str()).collect()
    }

    #[test]
    fn decades_and_two_and_five() {
        let axis = SizeAxis::covering("", [12.0, 480.0]);
        assert_eq!((axis.low, axis.high), (10.0, 500.0));
        assert_eq!(labels(&axis), ["10", "20", "50", "100", "200", "500"]);
        let decades: Vec<f64> = axis
            .ticks
            .iter()
            .filter(|t| t.decade)
            .map(|t| t.size)
            .collect();
        assert_eq!(decades, [10.0, 100.0]);
        // The middle of 10 to 1000 is 100.
        let axis = SizeAxis::covering("", [11.0, 900.0]);
        assert_eq!((axis.low, axis.high), (10.0, 1000.0));
        assert!((axis.share(100.0) - 0.5).abs() < 1e-15);
        let sizes: Vec<f64> = axis.sizes(3).collect();
        assert!(
            sizes
                .iter()
                .zip([10.0, 100.0, 1000.0])
                .all(|(a, b)| (a / b - 1.0).abs() < 1e-14)
        );
    }

    #[test]
    fn a_size_on_a_line_is_not_on_the_frame() {
        let axis = SizeAxis::covering("", [0.02, 0.5]);
        assert_eq!((axis.low, axis.high), (0.01, 1.0));
        assert_eq!(
            labels(&axis),
            ["0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1"]
        );
    }

    #[test]
    fn one_size_and_none() {
        let axis = SizeAxis::covering("", [50.0]);
        assert_eq!((axis.low, axis.high), (20.0, 100.0));
        assert_eq!(
            labels(&axis),
            ["20", "30", "40", "50", "60", "70", "80", "90", "100"]
        );
        let axis = SizeAxis::covering("", [f64::NAN, 0.0, -1.0, f64::INFINITY]);
        assert_eq!((axis.low, axis.high), (0.5, 20.0));
    }

    #[test]
    fn absurd_spans_have_few_labels() {
        for sizes in [
            [1e-12, 1e12],
            [1e-300, 1e300],
            [1e-30, 1e30],
            [1e-30, 2e-30],
        ] {
            let axis = SizeAxis::covering("", sizes);
            assert!(
                axis.low > 0.0 && axis.high.is_finite() && axis.low < axis.high,
                "{sizes:?}"
            );
            let shown = axis.ticks.iter().filter(|t| !t.label.is_empty()).count();
            assert!((1..=12).contains(&shown), "{sizes:?}: {shown}");
        }
    }
}
