//! From what stays on sieves to what passes them: the protocol of a laboratory.
//!
//! - Cumulative percent retained: 100 less it passes.
//! - Percent or mass of each sieve: what is on no sieve of that opening or a larger one passes, over the sum of all
//!   sieves and the pan. Where no line says what is in the pan, percents leave it by what is missing to 100, and masses by
//!   what is missing to the line of the total; where there is none, nobody knows how much passed the last sieve.
//! - Cumulative mass retained: the same over the total, which is the pan's number or the total's.
//! - "% retained" that says neither is of each sieve where all and the pan are 100 %, and cumulative where the pan's is 100 %, or
//!   where it never falls towards finer sieves and all are more than 100 %. Else it is refused.

use super::curves::RawCurve;
use super::names::{RetainedName, SizeText};
use crate::fault::Fault;

/// How far a sum of percents may be off 100: each is rounded to a tenth, and there are ten sieves.
const SUM_ROUNDING: f64 = 0.5;

/// By how much a sample may be lighter or heavier after sieving than before (ASTM C136/C136M), a share of what it was before.
const LOST: f64 = 0.003;

/// What stays on sieves, beside the points of its curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct OnSieves {
    what: RetainedName,
    /// In the line of the pan.
    pub(super) pan: Option<f64>,
    /// In the line of the total.
    pub(super) total: Option<f64>,
}

/// What the numbers are, once that is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Each,
    Cumulative,
}

impl OnSieves {
    /// Of a column with such a name.
    pub(super) fn new(what: RetainedName) -> Self {
        Self {
            what,
            pan: None,
            total: None,
        }
    }

    /// Makes percents passing of the points of a curve, finest last. `said` is what stands in front of a message, and takes
    /// what is to be said.
    ///
    /// # Errors
    /// Where the whole is not known or is not what it must be, and where it cannot be told what the numbers are.
    pub(super) fn to_passing(
        self,
        curve: &mut RawCurve,
        size_of: &impl Fn(&SizeText) -> f64,
        (name, said): (&str, &mut Vec<String>),
    ) -> Result<(), Fault> {
        let line = curve.line;
        let fault =
            |what: String, remedy: &str| Err(Fault::at(line, format!("{name}{what}"), remedy));
        let size = |point: &super::curves::RawPoint| size_of(&point.size);
        curve.points.sort_by(|a, b| size(b).total_cmp(&size(a)));
        if let Some(below) = curve.points.iter().find(|point| point.percent < 0.0) {
            let what = format!("{name}{} is retained, less than nothing", below.percent);
            return Err(Fault::at(below.line, what, "correct it"));
        }
        let amounts: Vec<f64> = curve.points.iter().map(|point| point.percent).collect();
        let on_sieves: f64 = amounts.iter().sum();
        let percents = matches!(
            self.what,
            RetainedName::CumulativePercent | RetainedName::EachPercent | RetainedName::Percent
        ) || curve.points.iter().any(|point| point.percent_sign);
        if self.what == RetainedName::Unsaid && !percents {
            return fault(
                "what is retained is percent or mass, which its column does not say".to_owned(),
                "call the column 'retained %', 'cumulative retained %' or 'retained g'",
            );
        }
        let kind = match self.what {
            RetainedName::CumulativePercent | RetainedName::CumulativeMass => Kind::Cumulative,
            RetainedName::EachPercent | RetainedName::Mass => Kind::Each,
            RetainedName::Percent | RetainedName::Unsaid => match self.kind_of_percents(&amounts) {
                Some(kind) => kind,
                None => {
                    return fault(
                        format!(
                            "percent retained is of each sieve (they add up to {} %) or cumulative, which nothing says",
                            rounded(on_sieves + self.pan.unwrap_or(0.0))
                        ),
                        "call the column 'cumulative retained %', or give the line of the pan",
                    );
                }
            },
        };
        let whole = match (percents, kind) {
            (true, Kind::Cumulative) => 100.0,
            (true, Kind::Each) => match self.pan {
                None => 100.0,
                Some(pan) if (on_sieves + pan - 100.0).abs() <= SUM_ROUNDING => on_sieves + pan,
                Some(pan) => {
                    return fault(
                        format!(
                            "percents retained and the pan's add up to {} %, not 100",
                            rounded(on_sieves + pan)
                        ),
                        "correct them",
                    );
                }
            },
            (false, Kind::Each) => match (self.pan, self.total) {
                (Some(pan), _) => on_sieves + pan,
                (None, Some(total)) => total,
                (None, None) => {
                    return fault(
                        "nothing says how much passed the finest sieve".to_owned(),
                        "give what is in the pan in a line 'pan' (0 where nothing is), or the sum of all in a line 'total'",
                    );
                }
            },
            (false, Kind::Cumulative) => match self.pan.or(self.total) {
                Some(whole) => whole,
                None => {
                    return fault(
                        "nothing says how much there was in all".to_owned(),
                        "give the sum of all in a line 'pan' or 'total'",
                    );
                }
            },
        };
        if whole.is_nan() || whole <= 0.0 {
            return fault(
                "nothing was sieved: all masses are 0".to_owned(),
                "correct them",
            );
        }
        if let (false, Some(total), true) = (percents, self.total, self.pan.is_some())
            && (total - whole).abs() > LOST * total
        {
            said.push(format!(
                "{name}sieves and pan add up to {}, the total says {}: they are off by more than 0.3 % (ASTM C136); shares are of the sum",
                rounded(whole),
                rounded(total)
            ));
        }
        let mut coarser = 0.0;
        for point in &mut curve.points {
            coarser = match kind {
                Kind::Each => coarser + point.percent,
                Kind::Cumulative => point.percent,
            };
            let passing = 100.0 * ((whole - coarser) / whole);
            if passing < -SUM_ROUNDING {
                let what = format!(
                    "{name}{} is retained down to this sieve, of {} in all",
                    rounded(coarser),
                    rounded(whole)
                );
                return Err(Fault::at(point.line, what, "correct it"));
            }
            point.percent = passing.max(0.0);
            // It is no share of 1, however small.
            point.percent_sign = true;
        }
        Ok(())
    }

    /// What percents are, of sieves from the coarsest on; `None` where they may be both.
    fn kind_of_percents(self, amounts: &[f64]) -> Option<Kind> {
        let sum: f64 = amounts.iter().sum();
        let falls = amounts.windows(2).any(|pair| pair[1] < pair[0]);
        let is_whole = |sum: f64| (sum - 100.0).abs() <= SUM_ROUNDING;
        match self.pan {
            Some(pan) if is_whole(sum + pan) => Some(Kind::Each),
            Some(pan) if is_whole(pan) && !falls => Some(Kind::Cumulative),
            Some(_) => None,
            None if falls => Some(Kind::Each),
            None if sum > 100.0 + SUM_ROUNDING => Some(Kind::Cumulative),
            None => None,
        }
    }
}

/// A sum for a message: what adding leaves behind the fourth decimal tells nobody anything.
fn rounded(sum: f64) -> f64 {
    (sum * 1e4).round() / 1e4
}
