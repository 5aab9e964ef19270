//! Methods against the reference: residuals, norms of fitted curves, envelopes, shifts.
//!
//! ```text
//! method_curve   the mean of a method's trials, its spread, the function fitted to it
//! residuals      percent error of the passing at each size
//! curve_norm     distance of two fitted functions over the whole curve
//! percentiles    shifts of the Pxx and the envelope of the sizes
//! notes          what to know before trusting it
//! ```

mod curve_norm;
mod method_curve;
mod notes;
mod percentiles;
mod residuals;

pub(crate) use method_curve::{MeasuredBy, whole_mean_of};

pub use curve_norm::{CurveNorm, Improvement, MeasuredNorm, Span};
pub use method_curve::{MeanPoint, MethodCurve};
pub use percentiles::{PercentileShift, SCALE_WARNING, Shift};
pub use residuals::{PERCENT_ERROR, PercentError};

use self::notes::{not_as_fitted, not_measured, notes_of_reference, partly_known, partly_measured};
use super::distribution::as_typed;
use super::{DistributionSet, Model, PERCENTILES, SizeDistribution};
use crate::fault::Fault;
use crate::units::LengthUnit;

/// How to compare.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonOptions {
    /// The method that the others are held against: a `Labels::method` of the set.
    pub reference: String,
    /// The function fitted to every method's mean curve.
    pub model: Model,
    /// Half the width of the envelope, percent: 30 after Sanchidrián, Segarra, Ouchterlony and López,
    /// "On the accuracy of fragment size measurement by image analysis in combination with some
    /// distribution functions", Rock Mechanics and Rock Engineering 42 (2009) 95-116.
    pub envelope_percent: f64,
    /// Percents passing whose sizes are compared.
    pub percentiles: Vec<f64>,
}

impl ComparisonOptions {
    /// The usual: Swebrec, 30 %, P10, P20, P50, P80, P90.
    pub fn new(reference: impl Into<String>) -> Self {
        Self {
            reference: reference.into(),
            model: Model::Swebrec,
            envelope_percent: 30.0,
            percentiles: PERCENTILES.to_vec(),
        }
    }

    fn check(&self) -> Result<(), Fault> {
        let inside = |percent: &f64| *percent > 0.0 && *percent < 100.0;
        if !inside(&self.envelope_percent) {
            let what = format!("an envelope of {} %", self.envelope_percent);
            return Err(Fault::new(what, "give one between 0 and 100 %, such as 30"));
        }
        if let Some(bad) = self.percentiles.iter().find(|percent| !inside(percent)) {
            let what = format!("a percentile of {bad} %");
            return Err(Fault::new(what, "give percentiles between 0 and 100 %"));
        }
        if self.percentiles.is_empty() {
            return Err(Fault::new("no percentile is named", "give one or more"));
        }
        Ok(())
    }
}

/// Methods held against one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The unit of all sizes.
    pub unit: LengthUnit,
    /// How it was compared.
    pub options: ComparisonOptions,
    /// The reference's own curve.
    pub reference: MethodCurve,
    /// The sizes that the norms are taken over: the same for all methods.
    pub span: Span,
    /// Every other method, in the order of the set.
    pub methods: Vec<MethodComparison>,
    /// How much nearer to the reference one method is than another: every ordered pair of methods,
    /// empty with fewer than two.
    pub improvements: Vec<Improvement>,
    /// What to know of the reference before trusting the comparison, one sentence each.
    pub notes: Vec<String>,
}

/// One method held against the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodComparison {
    /// Its own curve.
    pub curve: MethodCurve,
    /// At each size of the reference.
    pub residuals: Vec<PercentError>,
    /// Distance of its fitted function from the reference's.
    pub norm: CurveNorm,
    /// The same where both were measured; `None` where that is nowhere in the span.
    pub measured_norm: Option<MeasuredNorm>,
    /// Its Pxx against the reference's.
    pub shift: Shift,
    /// What to know before trusting it, one sentence each.
    pub notes: Vec<String>,
}

impl Comparison {
    /// The envelope [low, high] of the sizes that a percent passes: the size of the reference's fitted
    /// function there, times 1 - 0.3 and 1 + 0.3 (`envelope_percent`).
    pub fn envelope_at(&self, percent: f64) -> [f64; 2] {
        let size = self.reference.fit.curve.size_at(percent);
        percentiles::envelope(size, self.options.envelope_percent)
    }
}

/// Holds every method of a set, whose points were measured one by one, against the reference. A method's trials are the set's curves with its
/// name: photos must have been merged, so one curve a method and trial.
///
/// # Errors
///
/// No such reference, no other method, a trial of many photos, a method that shares no size with the
/// reference or that no function can be fitted to, an envelope or percentiles outside of 0 to 100 %.
pub fn compare(set: &DistributionSet, options: &ComparisonOptions) -> Result<Comparison, Fault> {
    compare_known(set, options, &|_| MeasuredBy::Points(None))
}

/// What the bands of a method's fit rest on.
pub(crate) type Measured<'a> = &'a dyn Fn(&str) -> MeasuredBy;

/// As [`compare`], with what the bands of each method's fit rest on.
///
/// # Errors
/// As [`compare`].
pub(crate) fn compare_known(
    set: &DistributionSet,
    options: &ComparisonOptions,
    measured: Measured<'_>,
) -> Result<Comparison, Fault> {
    options.check()?;
    let (reference, others) = methods_of(set, &options.reference)?;
    let reference = MethodCurve::new(
        &options.reference,
        &reference,
        options.model,
        measured(&options.reference),
    )?;
    let span = Span::of(&reference.fit.curve)?;
    let methods = others
        .iter()
        .map(|(method, trials)| {
            let curve = MethodCurve::new(method, trials, options.model, measured(method))?;
            against(&reference, (span, set.unit), (curve, trials), options)
        })
        .collect::<Result<Vec<_>, Fault>>()?;
    let mut improvements = Vec::new();
    for (at, this) in methods.iter().enumerate() {
        for (_, other) in methods.iter().enumerate().filter(|(i, _)| *i != at) {
            improvements.push(Improvement::of(
                (&this.curve.method, this.norm),
                (&other.curve.method, other.norm),
            ));
        }
    }
    Ok(Comparison {
        unit: set.unit,
        options: options.clone(),
        notes: notes_of_reference(&reference, span, set.unit),
        reference,
        span,
        methods,
        improvements,
    })
}

/// A method's trials, by name.
type Trials<'a> = Vec<(&'a str, &'a SizeDistribution)>;

/// A method's name and trials.
type Method<'a> = (&'a str, Trials<'a>);

/// The trials of the reference, and of the other methods, which are one or more, with their names.
fn methods_of<'a>(
    set: &'a DistributionSet,
    reference: &str,
) -> Result<(Trials<'a>, Vec<Method<'a>>), Fault> {
    let mut methods: Vec<Method<'_>> = Vec::new();
    for curve in &set.curves {
        let (method, trial) = (curve.labels.method.as_str(), curve.labels.trial.as_str());
        let at = methods.iter().position(|(known, _)| *known == method);
        let Some((_, trials)) = at.and_then(|at| methods.get_mut(at)) else {
            methods.push((method, vec![(trial, &curve.distribution)]));
            continue;
        };
        if trials.iter().any(|(known, _)| *known == trial) {
            let what = format!("the method '{method}' has several photos of the trial '{trial}'");
            return Err(Fault::new(what, "merge the photos of each trial first"));
        }
        trials.push((trial, &curve.distribution));
    }
    let names: Vec<String> = methods
        .iter()
        .filter(|(name, _)| !name.is_empty())
        .map(|(name, _)| format!("'{name}'"))
        .collect();
    if names.is_empty() {
        let what = "the distributions have no method";
        return Err(Fault::new(what, "say in a column how each was measured"));
    }
    let names = names.join(", ");
    let Some(at) = methods.iter().position(|(name, _)| *name == reference) else {
        let what = format!("no method is called '{reference}'");
        return Err(Fault::new(
            what,
            format!("as reference name one of {names}"),
        ));
    };
    if methods.len() < 2 {
        let what = format!("{names} is the only method");
        let remedy = "give another one to compare with it, or another name to one of its files (on the command line NAME=FILE)";
        return Err(Fault::new(what, remedy));
    }
    let (_, trials) = methods.remove(at);
    Ok((trials, methods))
}

/// A method (its curve and trials) held against the reference.
fn against(
    reference: &MethodCurve,
    (span, unit): (Span, LengthUnit),
    (curve, trials): (MethodCurve, &Trials<'_>),
    options: &ComparisonOptions,
) -> Result<MethodComparison, Fault> {
    let method = &curve.method;
    if let (Some([from, to]), Some([reference_from, reference_to])) =
        (curve.range(), reference.range())
        && (to < reference_from || from > reference_to)
    {
        let [from, to, reference_from, reference_to] =
            [from, to, reference_from, reference_to].map(as_typed);
        let what = format!(
            "the sizes of '{method}' ({from} to {to}) and of the reference '{}' ({reference_from} to \
             {reference_to}) do not overlap",
            reference.method
        );
        return Err(Fault::new(what, "check the units of the sizes"));
    }
    let shift = Shift::new(
        &curve.fit.curve,
        &reference.fit.curve,
        &options.percentiles,
        options.envelope_percent,
        measured_by_both(&curve, reference),
    )?;
    let functions = [&curve, reference].map(|of| &of.fit.curve);
    let measured_norm = [&curve, reference].map(MethodCurve::range_known_to_all);
    let measured_norm = match measured_norm {
        [Some(own), Some(other)] => {
            MeasuredNorm::between(functions[0], functions[1], span, [own, other])
        }
        _ => None,
    };
    let mut notes = Vec::new();
    notes.extend(partly_known(&curve));
    notes.extend(partly_measured(&curve.method, measured_norm, unit));
    notes.extend(not_measured(&curve, &shift));
    notes.extend(not_as_fitted(&curve, reference, &shift));
    if shift.looks_like_scale {
        notes.push(format!(
            "'{method}': all percentiles are shifted by about {:+.1} % (spread {:.1} %), as an image \
             scale does that is off by as much; check the scale",
            shift.mean_percent,
            shift.spread_percent.unwrap_or_default()
        ));
    }
    let distributions: Vec<&SizeDistribution> = trials.iter().map(|(_, d)| *d).collect();
    let residual = |point| PercentError::new(point, &distributions, options.envelope_percent);
    Ok(MethodComparison {
        residuals: reference.points.iter().map(residual).collect(),
        norm: CurveNorm::between(functions[0], functions[1], span),
        measured_norm,
        shift,
        notes,
        curve,
    })
}

/// The percents between which both were measured; of curves without a common percent an empty range.
fn measured_by_both(curve: &MethodCurve, reference: &MethodCurve) -> [f64; 2] {
    let [own, other] = [curve, reference].map(|of| {
        let percents = of.known_to_all().map(|point| point.mean);
        percents.fold(
            [f64::INFINITY, f64::NEG_INFINITY],
            |[low, high], percent| [low.min(percent), high.max(percent)],
        )
    });
    [own[0].max(other[0]), own[1].min(other[1])]
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::{LabelledDistribution, Labels, Swebrec};

    /// Points of a Swebrec at sieves from 2 to 90 % of its topsize.
    fn curve(method: &str, trial: &str, [x50, xmax, b]: [f64; 3]) -> LabelledDistribution {
        let swebrec = Swebrec::new(x50, xmax, b).expect("a Swebrec");
        let sizes = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9].map(|share| share * xmax);
        let points = sizes.map(|size| [size, 100.0 * swebrec.passing(size)]);
        LabelledDistribution {
            labels: Labels {
                method: method.to_owned(),
                trial: trial.to_owned(),
                photo: String::new(),
            },
            weight: None,
            distribution: SizeDistribution::new(points.to_vec()).expect("a distribution"),
        }
    }

    fn set(curves: Vec<LabelledDistribution>) -> DistributionSet {
        DistributionSet {
            unit: LengthUnit::Millimetre,
            curves,
        }
    }

    const SIEVE: [f64; 3] = [40.0, 150.0, 2.2];

    /// Of photos that show few fines the function goes past P50, which was measured: that is said with what was measured.
    #[test]
    fn what_the_functions_leave_is_said() {
        let points = [
            [10.0, 40.0],
            [20.0, 45.0],
            [30.0, 52.0],
            [60.0, 60.0],
            [100.0, 90.0],
            [150.0, 100.0],
        ];
        let mut photos = curve("photos", "", SIEVE);
        photos.distribution = SizeDistribution::new(points.to_vec()).expect("a distribution");
        let sieve = curve("sieve", "", SIEVE);
        let sieved = sieve.distribution.size_at(50.0).expect("measured");
        // Between 20 and 30 five of seven percents on, in the logarithm.
        let wanted = 100.0 * (20.0 * 1.5f64.powf(5.0 / 7.0) / sieved - 1.0);
        let both = set(vec![photos, sieve]);
        let found = compare(&both, &ComparisonOptions::new("sieve")).expect("a comparison");
        let note = found.methods[0]
            .notes
            .iter()
            .find(|note| note.contains("as measured"));
        let note = note.expect("a note");
        assert!(
            note.contains(&format!("P50 {wanted:+.1} %, not ")),
            "{note} {wanted}"
        );
        // The same function measured at its own sieves needs no word.
        let close = set(vec![curve("cloud", "", SIEVE), curve("sieve", "", SIEVE)]);
        let found = compare(&close, &ComparisonOptions::new("sieve")).expect("a comparison");
        assert!(
            found.methods[0]
                .notes
                .iter()
                .all(|note| !note.contains("as measured"))
        );
    }

    /// The scale of the cloud is 4 % off, that of the object 8 %: known before anything is fitted.
    #[test]
    fn scale_errors_come_back() {
        let scaled = |by: f64| [SIEVE[0] * by, SIEVE[1] * by, SIEVE[2]];
        let set = set(vec![
            curve("cloud", "1", scaled(1.04)),
            curve("sieve", "", SIEVE),
            curve("object", "1", scaled(1.08)),
            curve("cloud", "2", scaled(1.04)),
        ]);
        let found = compare(&set, &ComparisonOptions::new("sieve")).expect("a comparison");
        assert_eq!(found.reference.method, "sieve");
        let names: Vec<&str> = found
            .methods
            .iter()
            .map(|m| m.curve.method.as_str())
            .collect();
        assert_eq!(names, ["cloud", "object"]);
        assert_eq!(found.methods[0].curve.trials, ["1", "2"]);
        for (method, shift) in found.methods.iter().zip([4.0, 8.0]) {
            for percentile in &method.shift.percentiles {
                assert!(
                    (percentile.shift_percent - shift).abs() < 1e-4,
                    "{percentile:?}"
                );
                assert!(percentile.inside);
            }
            assert!(method.shift.looks_like_scale);
            assert!(
                method
                    .notes
                    .iter()
                    .any(|note| note.contains("check the scale"))
            );
            // Coarser: less passes everywhere.
            assert!(
                method
                    .residuals
                    .iter()
                    .all(|r| r.percent_error.is_none_or(|e| e < 0.0))
            );
        }
        // The norm of 8 % from scipy (see curve_norm).
        let norm = found.methods[1].norm;
        assert!((norm.relative_percent - 4.251_163_990_930_406).abs() < 1e-4);
        let [low, high] = found.envelope_at(50.0);
        assert!((low - 28.0).abs() < 1e-4 && (high - 52.0).abs() < 1e-4);
        let improvement = &found.improvements[0];
        assert_eq!(
            (improvement.method.as_str(), improvement.over.as_str()),
            ("cloud", "object")
        );
        let gained = 1.0 - found.methods[0].norm.rms_difference / norm.rms_difference;
        assert!((improvement.percent.expect("a percentage") - 100.0 * gained).abs() < 1e-9);
        assert_eq!(found.improvements.len(), 2);
        // The sieve from 2 to 90 % of 150 mm, the object of 162 mm.
        let measured = found.methods[1].measured_norm.expect("measured");
        assert!((measured.from - 3.24).abs() < 1e-9 && (measured.to - 135.0).abs() < 1e-9);
        assert!(
            found.methods[1]
                .notes
                .iter()
                .any(|note| note.contains("both were measured from 3.24 to 135 mm, 35 % of")),
            "{:?}",
            found.methods[1].notes
        );
        assert!(
            found.notes[0].contains("beyond the sizes 3 to 135 mm"),
            "{:?}",
            found.notes
        );
    }

    #[test]
    fn refuses_in_a_sentence() {
        let both = set(vec![curve("sieve", "", SIEVE), curve("cloud", "1", SIEVE)]);
        let one = set(vec![curve("sieve", "", SIEVE)]);
        let nameless = set(vec![curve("", "1", SIEVE), curve("", "2", SIEVE)]);
        let mut photos = both.clone();
        photos.curves.push(curve("cloud", "1", SIEVE));
        let far = set(vec![
            curve("sieve", "", SIEVE),
            curve("cloud", "1", [4e4, 15e4, 2.2]),
        ]);
        let sieve = ComparisonOptions::new("sieve");
        let wide = ComparisonOptions {
            envelope_percent: 130.0,
            ..sieve.clone()
        };
        let none = ComparisonOptions {
            percentiles: vec![50.0, 100.0],
            ..sieve.clone()
        };
        for (set, options, sentence) in [
            (
                &both,
                &ComparisonOptions::new("sive"),
                "one of 'sieve', 'cloud'",
            ),
            (&one, &sieve, "'sieve' is the only method"),
            (&nameless, &sieve, "have no method"),
            (&photos, &sieve, "several photos of the trial '1'; merge"),
            (&far, &sieve, "do not overlap"),
            (&both, &wide, "an envelope of 130 %"),
            (&both, &none, "a percentile of 100 %"),
        ] {
            let fault = compare(set, options).expect_err(sentence).to_string();
            assert!(fault.contains(sentence), "{fault}");
        }
    }
}
