//! From what stays on sieves to what passes them: the protocol of a laboratory.
//!
//! - Cumulative percent retained: 100 less it passes.
//! - Percent or mass of each sieve: what is on no sieve of that opening or a larger one passes, over the sum of all
//!   sieves and the pan. Where no line says what is in the pan, percents leave it by what is missing to 100, and masses by
//!   what is missing to the line of the total; where there is none, or it is what the sieves add up to (rounded, perhaps), nobody
//!   knows how much passed the last sieve.
//!   What was washed out before counts with the pan.
//! - Cumulative mass retained: the same over the total. A pan's line is the sum of all or its own, as the total says.
//! - Mass that does not say which, and never falls towards finer sieves, is what its total says, else refused.
//! - "% retained" that says neither is of each sieve where all and the pan are 100 %, and cumulative where the pan's is 100 %, or
//!   where it never falls towards finer sieves and all are more than 100 %. Else it is refused.

use super::names::RetainedName;
use super::raw::{OnSieves, RawCurve, RawPoint};
use super::size_text::SizeText;
use crate::fault::Fault;

/// How far a sum of percents may be off 100: each is rounded to a tenth, and there are ten sieves.
const SUM_ROUNDING: f64 = 0.5;

/// By how much a sample may be lighter or heavier after sieving than before (ASTM C136/C136M), a share of what it was before.
const LOST: f64 = 0.003;

/// A sum that is off the total by more is of something else, a share.
const MUCH_LOST: f64 = 0.05;

/// What the pan is called under the sieves.
const PANS: &[&str] = &[
    "pan",
    "receiver",
    "bottom",
    "tray", // German, French, Spanish
    "boden",
    "schale",
    "pfanne",
    "fond",
    "fondo",
    "ciego", // Portuguese, Polish, Swedish, Turkish, Russian
    "fundo",
    "prato",
    "dno",
    "botten",
    "tava",
    "поддон",
    "дно",
];

/// Whether a cell is the name of the pan.
pub(super) fn names_pan(cell: &str) -> bool {
    let small = cell.to_lowercase();
    PANS.iter().any(|pan| small.starts_with(pan))
}

/// Whether a cell of sizes is the pan under the sieves, or what passed the finest of them.
pub(super) fn is_pan(cell: &str) -> bool {
    let small = cell.to_lowercase();
    let passed = ["<", "passing", "finer"];
    names_pan(cell) || passed.iter().any(|start| small.starts_with(start))
}

/// Whether a cell beside an empty one of sizes says that its line is the pan, what was washed out, or the sum of all.
pub(super) fn is_no_sieve(cell: &str) -> bool {
    names_pan(cell) || is_total(cell) || is_washed(cell)
}

/// Whether a cell of sizes is in front of the sum of all.
pub(super) fn is_total(cell: &str) -> bool {
    let small = cell.to_lowercase();
    [
        "total",
        "sum",
        "σ",
        "somme",
        "gesamt",
        "totale",
        "razem",
        "toplam",
        "итого",
        "всего",
    ]
    .iter()
    .any(|total| small.starts_with(total))
}

/// Whether a cell of sizes is the name of a result below the sizes: "F10", "P80", "Topsize (99.95 %)".
pub(super) fn is_result(cell: &str) -> bool {
    let small = cell.to_lowercase();
    let is_percent = |digits: &str| {
        let digits = digits.trim_end_matches([':', '=']).trim_end();
        digits
            .parse::<f64>()
            .is_ok_and(|percent| (0.0..=100.0).contains(&percent))
    };
    let percentile = small.strip_prefix(['f', 'p', 'd', 'x', 'k']);
    percentile.is_some_and(is_percent)
        || small.starts_with("topsize")
        || small.starts_with("top size")
}

/// Whether it is what was washed out before sieving: it passes all sieves, as what is in the pan (ASTM C117, C136).
pub(super) fn is_washed(cell: &str) -> bool {
    cell.to_lowercase().contains("wash")
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
            washed: None,
            total: None,
            total_digit: 0.0,
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
        self.in_percents(curve, (name, said))?
            .percents_to_passing(curve, size_of, (name, said))
    }

    /// The same where percents may be shares of 1: those that end at 1 are, and are taken times 100.
    ///
    /// # Errors
    /// Where they end below: nobody says whether they are shares or percents.
    fn in_percents(
        mut self,
        curve: &mut RawCurve,
        (name, said): (&str, &mut Vec<String>),
    ) -> Result<Self, Fault> {
        let says_percent = matches!(
            self.what,
            RetainedName::CumulativePercent | RetainedName::EachPercent | RetainedName::Percent
        );
        let has_sign = curve.points.iter().any(|point| point.percent_sign);
        if !says_percent || has_sign {
            return Ok(self);
        }
        let amounts = || curve.points.iter().map(|point| point.percent);
        let others = [self.pan, self.washed, self.total].into_iter().flatten();
        let largest = amounts().chain(others).fold(0.0, f64::max);
        let sum = amounts()
            .chain([self.pan, self.washed].into_iter().flatten())
            .sum::<f64>();
        let whole = match self.what {
            RetainedName::EachPercent => sum.max(largest),
            _ => largest,
        };
        let is_one = |of: f64| (of - 1.0).abs() <= SUM_ROUNDING / 100.0;
        if !(is_one(whole) || is_one(sum) && largest <= 1.0) {
            if whole > 0.0 && whole < 1.0 {
                let what = format!(
                    "{name}percents retained end at {}, as shares of 1 do",
                    rounded(whole)
                );
                let remedy = "write % signs behind percents; of shares give the line of the pan, or write them times 100";
                return Err(Fault::at(curve.line, what, remedy));
            }
            return Ok(self);
        }
        said.push(format!(
            "{name}what is retained is given in shares of 1 and taken times 100"
        ));
        // 0.55 times 100 is 55.00000000000001.
        let times_100 = |share: f64| (share * 1e11).round() / 1e9;
        for point in &mut curve.points {
            point.percent = times_100(point.percent);
        }
        for of in [&mut self.pan, &mut self.washed, &mut self.total]
            .into_iter()
            .flatten()
        {
            *of = times_100(*of);
        }
        Ok(self)
    }

    fn percents_to_passing(
        self,
        curve: &mut RawCurve,
        size_of: &impl Fn(&SizeText) -> f64,
        (name, said): (&str, &mut Vec<String>),
    ) -> Result<(), Fault> {
        let line = curve.line;
        let fault =
            |what: String, remedy: &str| Err(Fault::at(line, format!("{name}{what}"), remedy));
        let size = |point: &RawPoint| size_of(&point.size);
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
        let each = on_sieves + self.pan.unwrap_or(0.0) + self.washed.unwrap_or(0.0);
        let kind = match self.what {
            RetainedName::CumulativePercent | RetainedName::CumulativeMass => {
                Some(Kind::Cumulative)
            }
            RetainedName::EachPercent | RetainedName::EachMass => Some(Kind::Each),
            _ if percents => self.kind_of_percents(&amounts),
            _ => self.kind_of_masses(&amounts),
        };
        let Some(kind) = kind else {
            let unit = if percents { " %" } else { "" };
            return fault(
                format!(
                    "what is retained is of each sieve (it adds up to {}{unit}) or cumulative, which nothing says",
                    rounded(each)
                ),
                "say 'each' or 'cumulative' in the name of the column",
            );
        };
        if let (Kind::Cumulative, Some(washed)) = (kind, self.washed) {
            return fault(
                format!("{washed} was washed out, beside what is cumulative"),
                "give what is retained on each sieve",
            );
        }
        let whole = match self.whole(percents, kind, &amounts, each) {
            Ok(whole) => whole,
            Err((what, remedy)) => return fault(what, remedy),
        };
        if whole.is_nan() || whole <= 0.0 {
            return fault(
                "nothing was sieved: all masses are 0".to_owned(),
                "correct them",
            );
        }
        if let (false, Some(total), true) = (percents, self.total, self.pan.is_some())
            && !is_near(whole, total, LOST)
        {
            said.push(format!(
                "{name}sieves and pan add up to {}, the total says {}: they are off by more than 0.3 % (ASTM C136); shares are of the sum",
                rounded(whole),
                rounded(total)
            ));
        }
        let missing = 100.0 - on_sieves;
        let is_of_pan =
            percents && kind == Kind::Each && each == on_sieves && missing > SUM_ROUNDING;
        if is_of_pan {
            said.push(format!(
                "{name}no line says what was in the pan: it is taken to be the {} % that the sieves lack to 100",
                rounded(missing)
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

    /// What all of the sample is, of which `each` is what sieves, pan and washing add up to; else what is wrong, and the remedy.
    fn whole(
        self,
        percents: bool,
        kind: Kind,
        amounts: &[f64],
        each: f64,
    ) -> Result<f64, (String, &'static str)> {
        let correct = |what: String| Err((what, "correct them"));
        let has_fines = self.pan.is_some() || self.washed.is_some();
        match (percents, kind) {
            (true, Kind::Cumulative) => Ok(100.0),
            (true, Kind::Each) if !has_fines => Ok(100.0),
            (true, Kind::Each) if is_near(each, 100.0, SUM_ROUNDING / 100.0) => Ok(each),
            (true, Kind::Each) => correct(format!(
                "percents retained and the pan's add up to {} %, not 100",
                rounded(each)
            )),
            (false, Kind::Each) => match (self.pan, self.total) {
                (Some(_), Some(total)) if !is_near(each, total, MUCH_LOST) => correct(format!(
                    "sieves and pan add up to {}, the total says {}",
                    rounded(each),
                    rounded(total)
                )),
                (Some(_), _) => Ok(each),
                (None, Some(total)) if self.washed.is_none() && self.is_sum(each, total) => Err((
                    "the total is the sum of the sieves alone: nothing says how much passed the finest".to_owned(),
                    "give what is in the pan in a line 'pan' (0 where nothing is)",
                )),
                (None, Some(total)) => Ok(total),
                (None, None) => Err((
                    "nothing says how much passed the finest sieve".to_owned(),
                    "give what is in the pan in a line 'pan' (0 where nothing is), or the sum of all in a line 'total'",
                )),
            },
            (false, Kind::Cumulative) => self.whole_of_cumulative(amounts).ok_or_else(|| {
                (
                    "nothing says for sure how much there was in all".to_owned(),
                    "give the sum of all in a line 'total': a pan's line may be its own mass as well",
                )
            }),
        }
    }

    /// Whether the total is what the sieves add up to, up to the rounding of the last digit that is shown of it.
    fn is_sum(self, each: f64, total: f64) -> bool {
        (each - total).abs() <= 0.5 * self.total_digit + 1e-9 * total.abs()
    }

    /// What percents are, of sieves from the coarsest on; `None` where they may be both.
    fn kind_of_percents(self, amounts: &[f64]) -> Option<Kind> {
        let sum: f64 = amounts.iter().sum();
        let is_whole = |sum: f64| is_near(sum, 100.0, SUM_ROUNDING / 100.0);
        match self.pan {
            Some(pan) if is_whole(sum + pan + self.washed.unwrap_or(0.0)) => Some(Kind::Each),
            Some(pan) if is_whole(pan) && !falls(amounts) => Some(Kind::Cumulative),
            Some(_) => None,
            None if falls(amounts) => Some(Kind::Each),
            None if sum > 100.0 + SUM_ROUNDING => Some(Kind::Cumulative),
            None => None,
        }
    }

    /// What masses are; `None` where they may be both.
    fn kind_of_masses(self, amounts: &[f64]) -> Option<Kind> {
        let (sum, last) = (amounts.iter().sum::<f64>(), amounts.last().copied()?);
        let (pan, washed) = (self.pan.unwrap_or(0.0), self.washed.unwrap_or(0.0));
        let falls_at_last = self.pan.is_some_and(|pan| pan < last) && self.total.is_none();
        if falls(amounts) || falls_at_last {
            return Some(Kind::Each);
        }
        match self.total {
            Some(total) if is_near(sum + pan + washed, total, MUCH_LOST) => Some(Kind::Each),
            Some(total) if self.pan.is_none() => (last > total).then_some(Kind::Each),
            Some(_) => self.whole_of_cumulative(amounts).map(|_| Kind::Cumulative),
            // That the last sieve has all is no protocol: nothing says what passed.
            None => self.pan.is_none().then_some(Kind::Each),
        }
    }

    /// The mass of all, where masses are cumulative: a pan's line has the sum of all, or its own. `None` where that is not sure.
    fn whole_of_cumulative(self, amounts: &[f64]) -> Option<f64> {
        let last = amounts.last().copied()?;
        match (self.pan, self.total) {
            (None, total) => total,
            (Some(pan), Some(total)) => {
                let fits = is_near(pan, total, LOST) || is_near(last + pan, total, LOST);
                fits.then_some(total)
            }
            (Some(pan), None) => (pan < last).then_some(last + pan),
        }
    }
}

/// Whether amounts fall somewhere from coarse to fine.
fn falls(amounts: &[f64]) -> bool {
    amounts.windows(2).any(|pair| pair[1] < pair[0])
}

/// Whether a sum is what it should be, up to that share of it.
fn is_near(sum: f64, wanted: f64, share: f64) -> bool {
    (sum - wanted).abs() <= share * wanted.abs()
}

/// A sum for a message: what adding leaves behind the fourth decimal tells nobody anything.
fn rounded(sum: f64) -> f64 {
    (sum * 1e4).round() / 1e4
}
