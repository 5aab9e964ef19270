//! What to know before trusting a fit, a sentence each.

use std::cmp::Ordering;

use super::coordinates::{Coordinates, Optimum};
use super::family::Family;
use super::points::Points;
use super::{FitOptions, FittedParameter, NotDetermined};
use crate::distribution::as_typed;
use crate::{Curve, PERCENTILES};

/// Other optima with a sum of at most this many times the least are told.
const NEARLY: f64 = 1.01;

/// Percents that differ by less are the same.
const ROUNDING: f64 = 1e-9;

/// What the notes are made of.
pub(super) struct Told<'a> {
    pub(super) family: &'a Family,
    pub(super) best: &'a Optimum,
    pub(super) points: &'a Points,
    pub(super) options: &'a FitOptions,
    pub(super) parameters: &'a [FittedParameter],
    /// Sum and function of the other places where the search came to rest.
    pub(super) others: &'a [(f64, Curve)],
    /// How many parameters were fitted.
    pub(super) fitted: usize,
    /// How many points say something of them.
    pub(super) telling: usize,
    /// Whether there are standard errors.
    pub(super) known: bool,
}

/// Which coordinates a small change is learnt from: neither fixed nor at a bound, and with a meaning.
pub(super) fn free(family: &Family, best: &Optimum) -> Vec<usize> {
    let bounds = family.bounds();
    (0..bounds.len())
        .filter(|&index| {
            let at = best.at[index];
            let [low, high] = bounds[index];
            let inside = low < high && !near(at, low, high) && !near(at, high, low);
            inside && has_meaning(family, &best.at, index)
        })
        .collect()
}

/// b means nothing where a is 0, c where a is 1.
fn has_meaning(family: &Family, at: &Coordinates, index: usize) -> bool {
    let [low, high] = family.bounds()[3];
    !(family.is_extended() && (index == 2 && at[3] <= low || index == 4 && at[3] >= high))
}

/// Whether a coordinate lies at a bound, as far as can be told.
fn near(at: f64, bound: f64, other: f64) -> bool {
    (at - bound).abs() <= 1e-9 * (other - bound).abs()
}

pub(super) fn notes(told: &Told, not_determined: &[NotDetermined]) -> Vec<String> {
    let mut notes: Vec<String> = nothing_left(told).into_iter().collect();
    notes.extend(not_determined.iter().map(|of| of.why.clone()));
    let coordinates = &told.best.at;
    match told.family {
        Family::Swebrec(_) => swebrec(told, coordinates, &mut notes),
        Family::RosinRammler(_) => {}
        Family::GatesGaudinSchuhmann(_) => gates_gaudin_schuhmann(told, coordinates, &mut notes),
    }
    exponents(told, coordinates, &mut notes);
    if told.telling > told.fitted && !told.known {
        notes.push(
            "the points cannot tell the parameters apart: there are no standard errors".to_owned(),
        );
    }
    another_optimum(told, &mut notes);
    notes.extend(beyond(told.points));
    notes
}

/// That no point is left over to learn from how well the parameters are known.
fn nothing_left(told: &Told) -> Option<String> {
    let others = "where everything passed the function says 100 % whatever they are";
    let few = match told.telling.cmp(&told.fitted) {
        Ordering::Greater => return None,
        Ordering::Equal if told.telling == told.points.points.len() => {
            "as many parameters as points: the function goes through all of them as well as it can"
                .to_owned()
        }
        Ordering::Equal => format!(
            "as many parameters as points that say anything of them ({others}): the function goes \
             through these as well as it can"
        ),
        Ordering::Less => format!(
            "more parameters than points that say anything of them ({others}): other functions go \
             through these as well"
        ),
    };
    Some(format!(
        "{few}, and nothing is left over to say how far it can be trusted"
    ))
}

/// Which of the usual percentiles nothing was measured at.
fn beyond(points: &Points) -> Option<String> {
    let [first, last] = [points.points.first()?, points.points.last()?].map(|of| of.percent);
    // Percents that were added up from what stayed on the sieves are off by rounding.
    let measured = first - ROUNDING..=last + ROUNDING;
    let beyond = PERCENTILES
        .iter()
        .filter(|percent| !measured.contains(*percent));
    let beyond: Vec<String> = beyond.map(|percent| format!("P{percent}")).collect();
    let what = beyond.join(", ");
    (!beyond.is_empty()).then(|| {
        format!(
            "the points go from {} % to {} % passing: {what} and what is computed from them are the function's \
             word; no point that it was fitted to is there",
            one_decimal(first),
            one_decimal(last)
        )
    })
}

fn one_decimal(percent: f64) -> f64 {
    (percent * 10.0).round() / 10.0
}

/// Which parameters' values mean nothing, and why.
pub(super) fn not_determined(told: &Told) -> Vec<NotDetermined> {
    let at = &told.best.at;
    let [low, high] = told.family.bounds()[0];
    let is_fitted = told.options.xmax.is_none();
    let of = |parameters: &[&'static str], why: &str| NotDetermined {
        parameters: parameters.to_vec(),
        why: why.to_owned(),
    };
    let mut found = Vec::new();
    match told.family {
        Family::Swebrec(_) if is_fitted && near(at[0], low, high) => found.push(of(
            &["xmax", "b"],
            "the data do not say a largest size: xmax ran to its bound, its value means nothing, nor \
             does that of b, which grows with it; give the largest size if it is known",
        )),
        Family::GatesGaudinSchuhmann(_) if is_fitted && near(at[0], high, low) => found.push(of(
            &["xmax"],
            "the data do not say a largest size: xmax ran to its bound, its value means nothing",
        )),
        _ => {}
    }
    if !has_meaning(told.family, at, 2) {
        found.push(of(
            &["b"],
            "a ended at 0: only the term of the fines is left, and b means nothing",
        ));
    } else if !has_meaning(told.family, at, 4) {
        found.push(of(
            &["c"],
            "a ended at 1: it is the Swebrec function, and c means nothing",
        ));
    }
    found
}

fn swebrec(told: &Told, at: &Coordinates, notes: &mut Vec<String>) {
    let bounds = told.family.bounds();
    let [low, high] = bounds[0];
    let is_at_bound = near(at[0], low, high);
    if told.options.xmax.is_none() && !is_at_bound && near(at[0], high, low) {
        notes.push(format!(
            "xmax ended at the largest size that not everything passed, {}: the data ask for a smaller \
             one, which cannot be",
            as_typed(told.points.retained)
        ));
    }
    if !told.family.is_extended() {
        return;
    }
    let are_both_there = has_meaning(told.family, at, 2) && has_meaning(told.family, at, 4);
    if are_both_there && at[3].abs() > 7.0 {
        // A share of 0.001.
        notes.push(
            "a is next to 0 or 1: the smaller term bends the curve at the smallest sizes only, which \
             few points can bear out"
                .to_owned(),
        );
    }
}

fn gates_gaudin_schuhmann(told: &Told, at: &Coordinates, notes: &mut Vec<String>) {
    let [low, high] = told.family.bounds()[0];
    if told.options.xmax.is_none() && !near(at[0], high, low) && at[0] < 0.0 {
        notes.push(format!(
            "xmax lies below {}, which not everything passed: it is where the straight line reaches \
             100 %, not the largest fragment",
            as_typed(told.points.retained)
        ));
    }
}

/// Exponents at their bounds.
fn exponents(told: &Told, at: &Coordinates, notes: &mut Vec<String>) {
    let bounds = told.family.bounds();
    for (index, parameter) in told.parameters.iter().enumerate() {
        let [low, high] = bounds[index];
        let exponent = ["b", "c", "n", "m"].contains(&parameter.name);
        let meant = has_meaning(told.family, at, index);
        if exponent
            && meant
            && low < high
            && (near(at[index], low, high) || near(at[index], high, low))
        {
            notes.push(format!(
                "{} ran to its bound: the data ask for a curve that is {} than any of use",
                parameter.name,
                if near(at[index], low, high) {
                    "flatter"
                } else {
                    "steeper"
                }
            ));
        }
    }
}

/// Another place with nearly the same sum and other parameters.
fn another_optimum(told: &Told, notes: &mut Vec<String>) {
    let best = told.best.sum;
    // Where all residuals are rounding, their ratio means nothing.
    if best < 1e-12 {
        return;
    }
    for (sum, curve) in told.others {
        if *sum > NEARLY * best {
            break;
        }
        let parameters = curve.parameters();
        let differ = told
            .parameters
            .iter()
            .zip(&parameters)
            .any(|(a, b)| (a.value - b).abs() > 0.05 * a.value.abs().max(b.abs()));
        if differ {
            let names = told.parameters.iter().map(|parameter| parameter.name);
            let values: Vec<String> = names
                .zip(&parameters)
                .map(|(name, value)| match value.abs() {
                    // At its bound xmax has a hundred digits.
                    1e-3..1e6 => format!("{name} {value:.4}"),
                    _ => format!("{name} {value:.3e}"),
                })
                .collect();
            notes.push(format!(
                "other parameters fit nearly as well ({}; residual sum {:.2} % above)",
                values.join(", "),
                100.0 * (sum / best - 1.0)
            ));
            return;
        }
    }
}
