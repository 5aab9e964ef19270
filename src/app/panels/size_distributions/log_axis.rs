//! The axis of sizes: the plot is linear, so it is given the decimal logarithms of the sizes, and
//! this axis says the sizes again.

use egui_plot::{GridInput, GridMark};

use crate::numbers::significant_digits;

/// The grid lines of a logarithmic axis: decades, 2 and 5 between them, and the other digits where
/// there is room.
pub(super) fn marks(input: &GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    // Beyond f64's range there is no size; so few decades that lines lie far apart.
    if !(low > -300.0 && high < 300.0 && high - low < 60.0) {
        return Vec::new();
    }
    let mut marks = Vec::new();
    for decade in low.floor() as i32..=high.ceil() as i32 {
        for digit in 1..10 {
            let value = f64::from(decade) + f64::from(digit).log10();
            // The wider its step, the stronger a line: whole decades stand out.
            let step_size = match digit {
                1 => 1.0,
                2 | 5 => 0.3,
                _ => 0.1,
            };
            if (low..=high).contains(&value) && step_size > input.base_step_size {
                marks.push(GridMark { value, step_size });
            }
        }
    }
    marks
}

/// What stands at a grid line: its size, where `shown` (the range in sight) leaves room.
pub(super) fn label(mark: GridMark, shown: &std::ops::RangeInclusive<f64>) -> String {
    let decades = shown.end() - shown.start();
    let named = match mark.step_size {
        step if step >= 1.0 => true,
        step if step >= 0.2 => decades < 5.0,
        // 3, 4, 6 to 9: only where a decade fills most of the plot.
        _ => decades < 0.8,
    };
    if named {
        size(mark.value)
    } else {
        String::new()
    }
}

/// The size of this logarithm, as short as it can be told.
pub(super) fn size(logarithm: f64) -> String {
    let size = 10_f64.powf(logarithm);
    let text = significant_digits(size, 3);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        let input = GridInput {
            bounds: (low, high),
            base_step_size: 0.01,
        };
        let marks = marks(&input).into_iter();
        let labels = marks.map(|mark| label(mark, &(low..=high)));
        labels.filter(|label| !label.is_empty()).collect()
    }

    #[test]
    fn decades_are_told_as_1_2_5() {
        let expected = ["0.1", "0.2", "0.5", "1", "2", "5", "10", "20", "50", "100"];
        assert_eq!(labels(-1.0, 2.0), expected);
    }

    #[test]
    fn far_out_only_decades_and_near_every_digit() {
        assert_eq!(
            labels(-3.0, 3.0),
            ["0.001", "0.01", "0.1", "1", "10", "100", "1000"]
        );
        assert_eq!(labels(0.25, 0.7), ["2", "3", "4", "5"]);
        assert!(labels(-1e9, 1e9).is_empty());
    }
}
