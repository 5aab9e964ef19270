//! What to know of a method or of the reference before trusting a comparison, one sentence each.

use super::{MeasuredNorm, MethodCurve, Shift, Span};
use crate::distribution::as_typed;
use crate::units::LengthUnit;

/// Where both were measured over less than this share of the norms' span, it is said: hardly anything is measured over all of it, and
/// of less than half the norm is more the functions' word than what was measured.
const MOSTLY_MEASURED: f64 = 0.5;

/// How much of a norm is of sizes at which not both were measured.
pub(super) fn partly_measured(
    method: &str,
    measured: Option<MeasuredNorm>,
    unit: LengthUnit,
) -> Option<String> {
    let Some(measured) = measured else {
        return Some(format!(
            "'{method}': its norm is of sizes at which not both were measured, and of the functions alone"
        ));
    };
    (measured.share < MOSTLY_MEASURED).then(|| {
        format!(
            "'{method}': both were measured from {} to {} {unit}, {:.0} % of the norms' logarithmic axis; there its 2-norm is {:.2} \
             points, {:.1} %, and beyond it is of the functions alone",
            rounded(measured.from),
            rounded(measured.to),
            100.0 * measured.share,
            measured.norm.rms_difference,
            measured.norm.relative_percent
        )
    })
}

/// Which percentiles are the functions' word.
pub(super) fn not_measured(curve: &MethodCurve, shift: &Shift) -> Option<String> {
    let beyond = shift
        .percentiles
        .iter()
        .filter(|percentile| !percentile.measured);
    let names: Vec<String> = beyond.map(|of| format!("P{}", of.percent)).collect();
    (!names.is_empty()).then(|| {
        format!(
            "'{}': at {} not both were measured; their shifts are of the functions alone, and do not count in the mean shift where \
             others do",
            curve.method,
            names.join(", ")
        )
    })
}

/// By how many percent a shift of the fitted functions may be off that of what was measured without a word: as far as a good fit is.
const WELL_FITTED: f64 = 5.0;

/// Where the fitted functions say another shift than what was measured.
pub(super) fn not_as_fitted(
    curve: &MethodCurve,
    reference: &MethodCurve,
    shift: &Shift,
) -> Option<String> {
    let off = shift.percentiles.iter().filter_map(|of| {
        let size = curve.measured_size_at(of.percent)?;
        let measured = 100.0 * (size / reference.measured_size_at(of.percent)? - 1.0);
        ((measured - of.shift_percent).abs() > WELL_FITTED).then(|| {
            format!(
                "P{} {measured:+.1} %, not {:+.1}",
                of.percent, of.shift_percent
            )
        })
    });
    let off: Vec<String> = off.collect();
    (!off.is_empty()).then(|| {
        format!(
            "'{}': the shifts are of the fitted functions, which leave what was measured; as measured {}",
            curve.method,
            off.join("; ")
        )
    })
}

/// What was left out of a method's fit.
pub(super) fn partly_known(curve: &MethodCurve) -> Option<String> {
    let sizes: Vec<String> = curve.partly_known().map(as_typed).collect();
    (!sizes.is_empty()).then(|| {
        format!(
            "'{}': not every trial is known at the sizes {}; they do not count in its fit",
            curve.method,
            sizes.join(", ")
        )
    })
}

/// What to know of the reference.
pub(super) fn notes_of_reference(
    reference: &MethodCurve,
    span: Span,
    unit: LengthUnit,
) -> Vec<String> {
    let mut notes: Vec<String> = partly_known(reference).into_iter().collect();
    if let Some([from, to]) = reference.range()
        && (span.from < from || span.to > to)
    {
        notes.push(format!(
            "the norms go from {} to {} {unit}, beyond the sizes {} to {} {unit} that '{}' was \
             measured at: there the fitted functions are compared where nothing was measured",
            rounded(span.from),
            rounded(span.to),
            as_typed(from),
            as_typed(to),
            reference.method
        ));
    }
    notes
}

/// A size as a sentence says it: three digits.
fn rounded(size: f64) -> String {
    let digits = (2.0 - size.log10().floor()).clamp(0.0, 9.0);
    format!("{size:.*}", digits as usize)
}
