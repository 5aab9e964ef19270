//! From the points that a table gives to distributions: repairs that are said, and faults.

use std::collections::HashMap;

use super::names::{Role, role};
use super::raw::RawCurve;
use super::size_text::SizeText;
use super::size_unit::SizeUnit;
use super::unit_above::Above;
use crate::fault::Fault;
use crate::fragmentation::{DistributionSet, LabelledDistribution, Labels, SizeDistribution};
use crate::tables::table::{NumberRepairs, Table};
use crate::text::fields::shown;
use crate::units::LengthUnit;

/// Percentage points that rounding explains: percents are often written to one decimal.
const ROUNDING: f64 = 0.05 + 1e-9;

/// How often something was mended, and where first.
#[derive(Debug, Clone, Copy, Default)]
struct Count {
    count: usize,
    line: u64,
}

impl Count {
    fn add(&mut self, line: u64) {
        if self.count == 0 || line < self.line {
            self.line = line;
        }
        self.count += 1;
    }

    /// "what is done (12 times, first on line 3)".
    fn say(self, what: &str) -> Option<String> {
        match self.count {
            0 => None,
            1 => Some(format!("{what} (line {})", self.line)),
            count => Some(format!(
                "{what} ({count} times, first on line {})",
                self.line
            )),
        }
    }
}

/// What was mended or passed over.
#[derive(Debug, Clone, Default)]
pub(super) struct Repairs {
    pub(super) numbers: NumberRepairs,
    pans: Count,
    totals: Count,
    results: Count,
    zeros: Count,
    over: Count,
    falls: Count,
    duplicates: Count,
    shared_sizes: Count,
    empty: Count,
    same_names: Count,
    one_size: Count,
    fractions: Count,
    sieve_names: bool,
    /// Whole sentences.
    pub(super) said: Vec<String>,
}

impl Repairs {
    /// A line of a sieve's pan was left out.
    pub(super) fn pan(&mut self, line: u64) {
        self.pans.add(line);
    }

    /// A line of sums was left out.
    pub(super) fn total(&mut self, line: u64) {
        self.totals.add(line);
    }

    /// A line of percentiles or of the top size was left out.
    pub(super) fn result(&mut self, line: u64) {
        self.results.add(line);
    }

    /// A line has the name of an earlier one.
    pub(super) fn same_name(&mut self, line: u64) {
        self.same_names.add(line);
    }

    /// A fraction was taken to be of the unit that is stated.
    pub(super) fn fraction(&mut self, line: u64) {
        self.fractions.add(line);
    }

    /// A line of a curve without a number.
    pub(super) fn empty(&mut self, line: u64) {
        self.empty.add(line);
    }

    fn warnings(self) -> Vec<String> {
        let counted = [
            self.pans.say("the pan under the sieves has no size and is left out"),
            self.totals.say("a line of sums is left out"),
            self.results.say("a line of a percentile or the top size is no point and is left out"),
            self.zeros.say("0 % passing a size of 0 says nothing and is left out"),
            self.empty.say("a line without a number is left out"),
            self.same_names
                .say("a curve with the name of an earlier one is told apart by its line"),
            self.fractions
                .say("a fraction is of the unit that is stated of sizes, not of inches"),
            self.over
                .say("passing a little above 100 %, as rounding gives it, is taken for 100 %"),
            self.falls.say(
                "passing that falls by up to 0.05 %, as rounding gives it, is taken for the percent \
                 before",
            ),
            self.duplicates.say("a size that is there twice with the same percent counts once"),
            self.one_size
                .say("a curve whose percentiles are all one size is left out"),
            self.shared_sizes
                .say("of percentiles of the same size the largest percent is kept"),
        ];
        let mut warnings = self.said;
        if self.sieve_names {
            warnings.push("names of sieves are taken for the openings of ASTM E11".to_owned());
        }
        warnings.extend(self.numbers.warnings());
        warnings.extend(counted.into_iter().flatten());
        warnings
    }
}

/// The curves of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct SizesRead {
    /// The curves.
    pub set: DistributionSet,
    /// How many of the set's units one of the table's lengths is: 0.001 where it is of micrometres and the set of mm.
    pub factor: f64,
    /// What was mended or passed over, a sentence each.
    pub said: Vec<String>,
}

/// How the sizes of a table are to be read.
#[derive(Debug, Clone)]
pub(super) struct SizeReading {
    /// The unit that the name of the column of sizes states.
    pub(super) header: Option<SizeUnit>,
    /// The unit that the user states.
    pub(super) given: Option<LengthUnit>,
    /// What the lines above the names say of it.
    pub(super) above: Above,
    /// What is wrong with a name of sizes that may state a unit which is not known.
    pub(super) unknown: Option<Fault>,
    /// The name of the column of percents, where it says that they are percents.
    pub(super) says_percent: Option<String>,
    /// Whether percents stand in the names of columns and sizes in the cells.
    pub(super) percentiles: bool,
}

/// Makes the set of a table's curves.
///
/// # Errors
/// With the line of the point that cannot be right.
pub(super) fn finish(
    mut curves: Vec<RawCurve>,
    reading: SizeReading,
    mut repairs: Repairs,
) -> Result<SizesRead, Fault> {
    let (of_bare, size_of) = unit_of_sizes(&curves, &reading, &mut repairs)?;
    let unit = of_bare.unit;
    for curve in &mut curves {
        if let Some(sieves) = curve.sieves {
            let what = prefix(&curve.labels);
            sieves.to_passing(curve, &size_of, (&what, &mut repairs.said))?;
        }
    }
    if are_shares(&curves) {
        if let Some(name) = &reading.says_percent {
            refuse_percents_below_1(&curves, name)?;
        }
        repairs
            .said
            .push("passing is given in shares of 1 and taken times 100".to_owned());
        let points = curves.iter_mut().flat_map(|curve| &mut curve.points);
        points.for_each(|point| point.percent *= 100.0);
    }
    let mut set = DistributionSet {
        unit,
        curves: Vec::new(),
    };
    let first_line = curves.first().map_or(1, |curve| curve.line);
    let mut seen: HashMap<Labels, u64> = HashMap::new();
    for curve in curves {
        if let Some(first) = seen.insert(curve.labels.clone(), curve.line) {
            let name = named(&curve.labels, "this curve");
            let what = match first == curve.line {
                true => format!("{name} is there twice"),
                false => format!("{name} is on line {first} already"),
            };
            let remedy = "tell them apart by name, or in a column method, trial or photo";
            return Err(Fault::at(curve.line, what, remedy));
        }
        if reading.percentiles && is_one_size(&curve) {
            repairs.one_size.add(curve.line);
            continue;
        }
        let distribution = distribution(&curve, &size_of, unit, &reading, &mut repairs)?;
        let top = distribution.points().last().map_or(0.0, |point| point[1]);
        let signed = curve.points.iter().any(|point| point.percent_sign);
        if (0.5..=1.0).contains(&top) && !signed {
            // No curve of a whole sample does; and what is made of it would be a hundred times too coarse.
            let name = named(&curve.labels, "the curve");
            let what = format!("{name} ends at {top} %, as a share of 1 does, beside percents");
            let remedy = "write it in percent; if it is percent, with % signs";
            return Err(Fault::at(curve.line, what, remedy));
        }
        set.curves.push(LabelledDistribution {
            labels: curve.labels,
            weight: curve.weight,
            distribution,
        });
    }
    repairs.said.extend(spelt_alike(&set));
    if set.curves.is_empty() {
        let remedy = "give two or more sizes with their percent passing";
        return Err(Fault::at(
            first_line,
            "no curve has more than one size",
            remedy,
        ));
    }
    Ok(SizesRead {
        set,
        factor: of_bare.factor,
        said: repairs.warnings(),
    })
}

/// Which curves' names differ by their spelling alone ("Sieve" and "sieve", trials 1, 1.0 and 01), a sentence each: whether they are one,
/// only people know.
fn spelt_alike(set: &DistributionSet) -> Vec<String> {
    let plain = |name: &str| {
        let name = name.trim().to_lowercase();
        let number = name.replace(',', ".").parse::<f64>();
        number.map_or(name, |number| number.to_string())
    };
    let mut known: HashMap<[String; 3], &Labels> = HashMap::new();
    let mut methods: HashMap<String, &str> = HashMap::new();
    let mut said = Vec::new();
    for labels in set.curves.iter().map(|curve| &curve.labels) {
        let first = *methods
            .entry(plain(&labels.method))
            .or_insert(&labels.method);
        if first != labels.method {
            let [one, other] = [first, &labels.method].map(shown);
            let text = format!(
                "'{one}' and '{other}' are two methods, whose names differ by their spelling alone"
            );
            if !said.contains(&text) {
                said.push(text);
            }
        }
        let key = [&labels.method, &labels.trial, &labels.photo].map(|name| plain(name));
        match known.get(&key) {
            Some(first) => said.push(format!(
                "{} and {} are two curves, whose names differ by their spelling alone",
                named(first, "a curve"),
                named(labels, "another")
            )),
            None => {
                known.insert(key, labels);
            }
        }
    }
    said
}

/// Whether a curve's sizes are all the same text, as percentiles of a photo of one stone are.
fn is_one_size(curve: &RawCurve) -> bool {
    curve
        .points
        .windows(2)
        .all(|pair| pair[0].size == pair[1].size)
}

/// A curve in a message.
fn named(labels: &Labels, without: &str) -> String {
    match labels.to_string() {
        name if name.is_empty() => without.to_owned(),
        name => format!("'{}'", shown(&name)),
    }
}

/// A curve in front of a message; nothing where it has no name.
fn prefix(labels: &Labels) -> String {
    match named(labels, "") {
        name if name.is_empty() => name,
        name => format!("{name}: "),
    }
}

/// Whether all percents of a table are shares of 1: none is above, and the largest is above a half.
fn are_shares(curves: &[RawCurve]) -> bool {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let largest = points().map(|point| point.percent).fold(0.0, f64::max);
    points().count() >= 2
        && largest > 0.5
        && largest <= 1.0 + ROUNDING / 100.0
        && points().all(|point| !point.percent_sign)
}

/// Refuses what may be percents, as the name of their column says, or shares of 1. What ends at 1 is shares: no pile is measured up to
/// what 1 % of it passes, and spreadsheets write cells that show percents so.
fn refuse_percents_below_1(curves: &[RawCurve], name: &str) -> Result<(), Fault> {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let top = points().map(|point| point.percent).fold(0.0, f64::max);
    if top >= 1.0 {
        return Ok(());
    }
    let last = points().max_by(|a, b| a.percent.total_cmp(&b.percent));
    let what = format!("column '{name}' says percent, and ends at {top}, as shares of 1 do");
    let remedy = "write % signs behind percents, or call the column 'passing, share of 1'";
    Err(Fault::at(last.map_or(1, |point| point.line), what, remedy))
}

/// How near to 100 percents of classes add up.
const ROUNDED_SUM: f64 = 0.5;

/// Refuses columns that nobody calls passing, and whose percents add up to 100 as those of classes do.
pub(super) fn refuse_classes_by_sum(table: &Table, curves: &[RawCurve]) -> Result<(), Fault> {
    for curve in curves {
        let percents = curve.points.iter().map(|point| point.percent);
        let (sum, most) = (percents.clone().sum::<f64>(), percents.fold(0.0, f64::max));
        let called = curve.labels.to_string();
        if curve.points.len() > 2
            && (sum - 100.0).abs() <= ROUNDED_SUM
            && most < 100.0 - ROUNDED_SUM
            && role(&called) != Role::Passing
        {
            let of = match called.as_str() {
                "" => String::new(),
                called => format!(" of '{}'", shown(called)),
            };
            let what = format!("the percents{of} add up to 100, as those of classes do");
            let remedy = "give cumulative percent passing; or say in its name what it is: 'percent passing', 'percent retained'";
            return Err(Fault::at(table.header_line(), what, remedy));
        }
    }
    Ok(())
}

/// The unit that a line above the names states, which is said; mm where none does.
fn of_lines_above(above: &Above, repairs: &mut Repairs) -> SizeUnit {
    let Above::Stated(unit, word, line) = above else {
        return SizeUnit::plain(LengthUnit::Millimetre);
    };
    repairs.said.push(format!(
        "the unit of sizes is that of line {line}: {}",
        shown(word)
    ));
    *unit
}

/// The unit of sizes that have none of their own, of which the set's is, and what a size is in the set's.
fn unit_of_sizes(
    curves: &[RawCurve],
    reading: &SizeReading,
    repairs: &mut Repairs,
) -> Result<(SizeUnit, impl Fn(&SizeText) -> f64 + use<>), Fault> {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    // Names that are no numbers make the inches beside them names as well: "2 in." is 50 mm then.
    let by_name = points().any(|point| point.size.number.is_none());
    repairs.sieve_names = by_name;
    let number_of = move |size: &SizeText| match (size.sieve_mm, size.number) {
        (Some(mm), number) if by_name || number.is_none() => {
            let unit = LengthUnit::Millimetre;
            (mm, Some(SizeUnit::plain(unit)))
        }
        (_, number) => number.unwrap_or((f64::NAN, None)),
    };
    let mut with_unit = points().filter_map(|point| number_of(&point.size).1);
    let first_with = with_unit.next();
    let bare = points().find(|point| {
        let (number, unit) = number_of(&point.size);
        unit.is_none() && number != 0.0
    });
    let stated = reading.header.or(reading.given.map(SizeUnit::plain));
    let of_bare = match (stated, first_with, bare) {
        (Some(stated), ..) => stated,
        (None, None, _) | (None, Some(_), Some(_))
            if matches!(reading.above, Above::Stated(..)) =>
        {
            of_lines_above(&reading.above, repairs)
        }
        (None, Some(_), Some(bare)) => {
            let what = "this size has no unit, where others have one";
            let remedy = "give each size its unit, or state one in the name of the column";
            return Err(Fault::at(bare.line, what, remedy));
        }
        (None, Some(first), None) => first,
        (None, None, _) => {
            if let Some(fault) = &reading.unknown {
                return Err(fault.clone());
            }
            if let Above::Unclear(fault) = &reading.above {
                return Err(fault.clone());
            }
            repairs.said.push(
                "no unit is stated: sizes are taken for mm (state it in the name of their column, or by --size-unit)".to_owned(),
            );
            SizeUnit::plain(LengthUnit::Millimetre)
        }
    };
    if let (Some(header), Some(given)) = (reading.header, reading.given)
        && header.unit != given
    {
        repairs.said.push(format!(
            "the column of sizes states its unit, {}: {given} is passed over",
            header.unit
        ));
    }
    if let (None, Some(given), Above::Stated(above, word, line)) =
        (reading.header, reading.given, &reading.above)
        && *above != SizeUnit::plain(given)
    {
        repairs.said.push(format!(
            "line {line} states another unit of sizes, {}: they are taken for {given}, as the user says",
            shown(word)
        ));
    }
    if let Some(called) = of_bare.called() {
        repairs.said.push(format!(
            "sizes in {called} are taken for {} times {}",
            of_bare.unit, of_bare.factor
        ));
    }
    let unit = of_bare.unit;
    let in_unit = move |size: &SizeText| {
        let (number, own) = number_of(size);
        let own = own.unwrap_or(of_bare);
        number * own.factor * own.unit.in_units_of(unit)
    };
    Ok((of_bare, in_unit))
}

/// One curve, mended.
fn distribution(
    curve: &RawCurve,
    size_of: &impl Fn(&SizeText) -> f64,
    unit: LengthUnit,
    reading: &SizeReading,
    repairs: &mut Repairs,
) -> Result<SizeDistribution, Fault> {
    let name = prefix(&curve.labels);
    let mut points: Vec<(f64, f64, u64)> = Vec::new();
    for point in &curve.points {
        let (size, line) = (size_of(&point.size), point.line);
        let mut percent = point.percent;
        if percent > 100.0 && percent <= 100.0 + ROUNDING {
            repairs.over.add(line);
            percent = 100.0;
        }
        if !(0.0..=100.0).contains(&percent) {
            let what =
                format!("{name}{percent} % passing at size {size} {unit} is not in 0 to 100 %");
            let remedy = "give cumulative percent passing";
            return Err(Fault::at(line, what, remedy));
        }
        if size == 0.0 && percent == 0.0 {
            repairs.zeros.add(line);
            continue;
        }
        if !(size > 0.0 && size.is_finite()) {
            let what = format!("{name}size {size} {unit}, which {percent} % pass, is not above 0");
            return Err(Fault::at(
                line,
                what,
                "give the opening of a sieve, above 0",
            ));
        }
        points.push((size, percent, line));
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut kept: Vec<(f64, f64, u64)> = Vec::new();
    for (size, mut percent, line) in points {
        if let Some(&mut (before, ref mut percent_before, line_before)) = kept.last_mut() {
            if size == before && reading.percentiles {
                repairs.shared_sizes.add(line);
                *percent_before = percent;
                continue;
            }
            if size == before && percent == *percent_before {
                repairs.duplicates.add(line);
                continue;
            }
            if size == before {
                let what = match line == line_before {
                    true => format!(
                        "{name}size {size} {unit} is there twice, with {percent_before} % and {percent} %"
                    ),
                    false => format!(
                        "{name}size {size} {unit} is there twice, with {percent_before} % on line \
                         {line_before} and {percent} % on line {line}"
                    ),
                };
                // `psd fit` has no such options.
                let remedy = "keep one, or tell the curves apart in a column method, trial or photo \
                              (psd compare: name it by --method, --trial or --photo)";
                return Err(Fault::at(line.max(line_before), what, remedy));
            }
            let fall = *percent_before - percent;
            if fall > ROUNDING {
                let place = match line == line_before {
                    true => String::new(),
                    false => format!(" (line {line_before})"),
                };
                let what = format!(
                    "{name}passing falls from {percent_before} % at size {before} {unit}{place} to \
                     {percent} % at size {size} {unit}"
                );
                let remedy = match reading.percentiles {
                    true => "correct the percentiles, which grow with the percent",
                    false => {
                        "correct it; percent passing grows with the size, percent retained falls: \
                         give 100 less that"
                    }
                };
                return Err(Fault::at(line, what, remedy));
            }
            if fall > 0.0 {
                repairs.falls.add(line);
                percent = *percent_before;
            }
        }
        kept.push((size, percent, line));
    }
    if kept.len() < 2 {
        let what = match kept.first() {
            Some((size, percent, _)) => {
                format!("{name}a single point, {percent} % at size {size} {unit}")
            }
            None => format!("{name}no points"),
        };
        return Err(Fault::at(
            curve.line,
            what,
            "give two or more sizes with their percent passing",
        ));
    }
    let points = kept.into_iter().map(|(size, percent, _)| [size, percent]);
    let line = curve.line;
    SizeDistribution::new(points.collect()).map_err(|fault| Fault {
        line: Some(line),
        ..fault
    })
}
