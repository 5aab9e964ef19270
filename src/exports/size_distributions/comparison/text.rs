//! A comparison as text for people.

use std::fmt::Write as _;

use crate::fragmentation::{
    Comparison, MethodComparison, MethodCurve, PERCENT_ERROR, SCALE_WARNING,
};
use crate::numbers::counted;
use crate::size_distributions::fit::NOT_DETERMINED;
use crate::size_distributions::text_table::{aligned, or_dash, signed, significant, trimmed};
use crate::size_distributions::{comparison_notes, star};

/// The curves, then the percent errors, the norms and the percentiles of every method.
pub fn comparison_text(comparison: &Comparison) -> String {
    let mut text = String::new();
    curve_text(
        &mut text,
        &comparison.reference,
        comparison,
        ", the reference",
    );
    for method in &comparison.methods {
        curve_text(&mut text, &method.curve, comparison, "");
    }
    // Writing into a text does not fail.
    let _ = writeln!(text, "{PERCENT_ERROR}");
    for method in &comparison.methods {
        residual_text(&mut text, method, comparison);
    }
    norm_text(&mut text, comparison);
    for method in &comparison.methods {
        shift_text(&mut text, method, comparison);
    }
    let _ = writeln!(text, "{SCALE_WARNING}");
    for note in comparison_notes(comparison) {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

fn curve_text(text: &mut String, curve: &MethodCurve, comparison: &Comparison, role: &str) {
    let fit = &curve.fit;
    let parameters: Vec<String> = fit
        .parameters
        .iter()
        .map(|parameter| match fit.determines(parameter.name) {
            true => format!("{} {}", parameter.name, significant(parameter.value, 5)),
            false => format!("{} {NOT_DETERMINED}", parameter.name),
        })
        .collect();
    let trials = counted(curve.trials.len(), "trial");
    let _ = writeln!(
        text,
        "{}{role}: {trials}; {}: {}; R squared {}, RMSE {} percentage points",
        curve.method,
        fit.model.name(),
        parameters.join(", "),
        significant(fit.r_squared, 5),
        significant(fit.rmse, 3)
    );
    let mut rows = vec![head(&[
        &format!("size {}", comparison.unit),
        "% passing, mean",
        "standard deviation",
        "trials",
    ])];
    for point in &curve.points {
        rows.push(vec![
            trimmed(point.size, 6),
            format!("{:.2}", point.mean),
            or_dash(point.standard_deviation, |deviation| {
                format!("{deviation:.2}")
            }),
            point.trials.to_string(),
        ]);
    }
    *text += &aligned(&rows);
    text.push('\n');
}

fn residual_text(text: &mut String, method: &MethodComparison, comparison: &Comparison) {
    let within = format!("within {} %", comparison.options.envelope_percent);
    let mut rows = vec![head(&[
        &format!("size {}", comparison.unit),
        &comparison.reference.method,
        &method.curve.method,
        "difference",
        "% error",
        &within,
    ])];
    let star = star(method);
    for residual in &method.residuals {
        // Without a star a blank, so that decimals stay below each other.
        let mark = match (&star, residual.interpolated) {
            (None, _) => "",
            (Some(_), false) => " ",
            (Some(_), true) => "*",
        };
        let passing = or_dash(residual.passing, |passing| format!("{passing:.2}"));
        rows.push(vec![
            trimmed(residual.size, 6),
            format!("{:.2}", residual.reference),
            passing + mark,
            or_dash(residual.difference, |difference| signed(difference, 2)),
            or_dash(residual.percent_error, |error| signed(error, 1)),
            residual.within.map_or("-", yes).to_owned(),
        ]);
    }
    *text += &aligned(&rows);
    if let Some(star) = star {
        let _ = writeln!(text, "{star}");
    }
    text.push('\n');
}

fn norm_text(text: &mut String, comparison: &Comparison) {
    let span = comparison.span;
    let _ = writeln!(
        text,
        "2-norm of fitted curves, evenly in the logarithm of the size from {} (P1 of the reference) to \
         {} {} (its {})",
        significant(span.from, 4),
        significant(span.to, 4),
        comparison.unit,
        match span.to_percent {
            100.0 => "topsize".to_owned(),
            percent => format!("P{percent}"),
        }
    );
    let mut rows = vec![head(&["method", "RMS difference", "relative %"])];
    for method in &comparison.methods {
        rows.push(vec![
            method.curve.method.clone(),
            significant(method.norm.rms_difference, 4),
            significant(method.norm.relative_percent, 4),
        ]);
    }
    *text += &aligned(&rows);
    for improvement in &comparison.improvements {
        // Each pair is there twice; the one that improves says it.
        let Some(percent) = improvement.percent.filter(|percent| *percent > 0.0) else {
            continue;
        };
        let _ = writeln!(
            text,
            "{} is {percent:.1} % nearer to the reference than {} (100 (norm of {} - norm of {}) / norm \
             of {})",
            improvement.method,
            improvement.over,
            improvement.over,
            improvement.method,
            improvement.over
        );
    }
    text.push('\n');
}

fn shift_text(text: &mut String, method: &MethodComparison, comparison: &Comparison) {
    let unit = comparison.unit;
    let envelope = comparison.options.envelope_percent;
    let mut rows = vec![head(&[
        "percentile",
        &format!("{} {unit}", comparison.reference.method),
        &format!("{} {unit}", method.curve.method),
        "shift %",
        &format!("-{envelope} %"),
        &format!("+{envelope} %"),
        "inside",
    ])];
    for percentile in &method.shift.percentiles {
        rows.push(vec![
            format!("P{}", percentile.percent),
            significant(percentile.reference, 4),
            significant(percentile.size, 4),
            signed(percentile.shift_percent, 1),
            significant(percentile.envelope[0], 4),
            significant(percentile.envelope[1], 4),
            yes(percentile.inside).to_owned(),
        ]);
    }
    *text += &aligned(&rows);
    let _ = writeln!(
        text,
        "mean shift {} %, spread {}\n",
        signed(method.shift.mean_percent, 1),
        or_dash(method.shift.spread_percent, |spread| format!(
            "{spread:.1} %"
        ))
    );
}

fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::size_distributions::comparison::test_comparison::comparison;

    #[test]
    fn everything_is_said() {
        let text = comparison_text(&comparison());
        for line in [
            "sieve, the reference: 1 trial; Swebrec: xmax 150.00, x50 40.000, b 2.0000; R squared \
             0.99900, RMSE 0.500 percentage points",
            "point cloud: 2 trials; Swebrec",
            "size mm  % passing, mean  standard deviation  trials\n\
             10                  0.00                   -       1\n\
             100                80.00                   -       1\n",
            "size mm  sieve  point cloud  difference  % error  within 30 %\n\
             10        0.00         5.00       +5.00        -            -\n\
             100      80.00        88.00       +8.00    +10.0          yes\n",
            PERCENT_ERROR,
            "from 0.5000 (P1 of the reference) to 150.0 mm (its topsize)\n\
             method        RMS difference  relative %\n\
             point cloud            4.000       9.400\n\
             scale object           4.000       10.00\n\
             point cloud is 6.0 % nearer to the reference than scale object",
            "percentile  sieve mm  point cloud mm  shift %  -30 %  +30 %  inside\n\
             P50            40.00           36.00    -10.0  28.00  52.00     yes\n\
             mean shift -10.0 %, spread -\n",
            SCALE_WARNING,
            "note: beyond what was measured\nnote: look twice\n",
        ] {
            assert!(text.contains(line), "{line}\nis not in\n{text}");
        }
        assert!(!text.contains("scale object is"), "said once");
        assert!(!text.contains('*'), "{text}");
    }

    /// A passing that nobody measured is told from the others, whose decimals stay below each other.
    #[test]
    fn what_is_interpolated_has_a_star() {
        let mut comparison = comparison();
        comparison.methods[0].residuals[1].interpolated = true;
        let text = comparison_text(&comparison);
        let table = "size mm  sieve  point cloud  difference  % error  within 30 %\n\
             10        0.00        5.00        +5.00        -            -\n\
             100      80.00       88.00*       +8.00    +10.0          yes\n\
             * interpolated between the sizes beside it: not every trial of 'point cloud' was measured at this one\n\n";
        assert!(text.contains(table), "{text}");
        assert_eq!(text.matches('*').count(), 2, "{text}");
        comparison.methods[0].curve.trials.truncate(1);
        let text = comparison_text(&comparison);
        assert!(
            text.contains(": 'point cloud' was not measured at this one\n"),
            "{text}"
        );
    }
}
