//! What the name of a column says that it holds.

use crate::fragmentation::{SieveSeries, Weighting};
use crate::tables::table::{key, split_number};
use crate::units::LengthUnit;

/// A unit of sizes: `factor` of `unit` are one of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SizeUnit {
    pub(super) unit: LengthUnit,
    /// 1 but for micrometres, which are 0.001 mm.
    pub(super) factor: f64,
}

impl SizeUnit {
    /// The unit of a word: "mm", "inches", "µm".
    pub(super) fn of(word: &str) -> Option<Self> {
        let word = word.trim().trim_end_matches('.').to_lowercase();
        let unit = match word.as_str() {
            "mm" | "millimetre" | "millimetres" | "millimeter" | "millimeters" => {
                LengthUnit::Millimetre
            }
            "cm" | "centimetre" | "centimetres" | "centimeter" | "centimeters" => {
                LengthUnit::Centimetre
            }
            "m" | "metre" | "metres" | "meter" | "meters" => LengthUnit::Metre,
            "in" | "inch" | "inches" | "\"" | "″" => LengthUnit::Inch,
            "ft" | "foot" | "feet" | "'" | "′" => LengthUnit::Foot,
            "us-ft" => LengthUnit::UsSurveyFoot,
            // The micro sign and the Greek letter.
            "um" | "µm" | "μm" | "micron" | "microns" | "micrometre" | "micrometres"
            | "micrometer" | "micrometers" => {
                return Some(Self {
                    unit: LengthUnit::Millimetre,
                    factor: 0.001,
                });
            }
            _ => return None,
        };
        Some(Self { unit, factor: 1.0 })
    }
}

/// Which area or mass a curve stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Role {
    /// Cumulative percent passing.
    Passing,
    /// Mass that passes: nobody says of how much.
    PassingMass,
    /// What stays on sieves.
    Retained(RetainedName),
    /// Percent of each class of sizes.
    NotCumulative,
    /// Sizes, in a unit where the name states one.
    Size(Option<SizeUnit>),
    /// Sizes where no other column is called so: "sieve", "x".
    PerhapsSize(Option<SizeUnit>),
    /// How it was measured.
    Method,
    /// Which repetition.
    Trial,
    /// Which photo; the smaller the number, the surer.
    Photo(usize),
    /// Area or mass.
    Weight,
    /// How often, or how sure: no curve.
    Statistic,
    /// Anything else.
    Other,
}

/// What the name of a column says of what stays on sieves, by what is to be chosen first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum RetainedName {
    /// Percent on a sieve and all coarser ones.
    CumulativePercent,
    /// Percent on each sieve.
    EachPercent,
    /// Percent, of one sieve or of all down to it.
    Percent,
    /// Mass on each sieve, said so.
    EachMass,
    /// Mass, of one sieve or of all down to it.
    Mass,
    /// Mass on a sieve and all coarser ones.
    CumulativeMass,
    /// Percent or mass: it says neither.
    Unsaid,
}

impl RetainedName {
    fn of(words: &[String]) -> Self {
        let any = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
        let percent = says_percent(words);
        let mass = says_mass(words);
        let cumulative = words.iter().any(|word| says_cumulative(word));
        let each = any(&EACH_NAMES);
        match (percent, mass, cumulative) {
            (true, _, true) => Self::CumulativePercent,
            (true, _, false) if each => Self::EachPercent,
            (true, _, false) => Self::Percent,
            (false, true, false) if each => Self::EachMass,
            (false, true, false) => Self::Mass,
            (false, true, true) => Self::CumulativeMass,
            (false, false, _) => Self::Unsaid,
        }
    }
}

/// What masses are called; here and below also in German, French and Spanish.
const MASS_NAMES: [&str; 10] = [
    "mass", "masses", "weight", "weights", "wt", "masse", "gewicht", "poids", "masa", "peso",
];

/// What percents are called.
const PERCENT_NAMES: [&str; 4] = ["percent", "pct", "percentage", "prozent"];

/// What says that each sieve's share is meant, not the sum down to it.
const EACH_NAMES: [&str; 6] = [
    "each",
    "individual",
    "incremental",
    "differential",
    "partial",
    "parcial",
];

/// What is within the name of a size of sieves or fragments.
const SIZE_NAMES: [&str; 16] = [
    "size",
    "opening",
    "aperture",
    "diameter",
    "siebweite",
    "maschenweite",
    "korngröße",
    "korngrösse",
    "korngroesse",
    "ouverture",
    "tamis",
    "abertura",
    "apertura",
    "tamiz",
    "tamaño",
    "malla",
];

/// What is within the name of what passes.
pub(super) const PASSING_NAMES: [&str; 7] = [
    "passing",
    "passed",
    "finer",
    "undersize",
    "durchgang",
    "passant",
    "pasante",
];

/// What is within the name of what stays on sieves.
const RETAINED_NAMES: [&str; 8] = [
    "retained",
    "oversize",
    "coarser",
    "residue",
    "rückstand",
    "rueckstand",
    "refus",
    "retenido",
];

/// Whether a word says that percents or masses are cumulative.
fn says_cumulative(word: &str) -> bool {
    ["cum", "kum", "acum"]
        .iter()
        .any(|start| word.starts_with(start))
}

/// Whether words speak of mass.
fn says_mass(words: &[String]) -> bool {
    let units = ["g", "kg", "t", "gram", "grams", "tonnes", "lb", "lbs"];
    let is_mass = |word: &str| MASS_NAMES.contains(&word) || units.contains(&word);
    words.iter().any(|word| is_mass(word))
}

/// Whether words speak of percents.
fn says_percent(words: &[String]) -> bool {
    words
        .iter()
        .any(|word| PERCENT_NAMES.contains(&word.as_str()))
}

/// The words of a name in small letters: "PercentPassing", "percent_passing" and "% passing" are the
/// same; a quotation mark is inches.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut after_small = false;
    for c in name.chars() {
        let sign = match c {
            '%' => "percent",
            '"' | '″' => "in",
            _ => "",
        };
        if !sign.is_empty() {
            words.extend([sign.to_owned(), String::new()]);
        } else if c.is_alphanumeric() {
            if c.is_uppercase() && after_small {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.extend(c.to_lowercase());
            }
        } else {
            words.push(String::new());
        }
        after_small = c.is_lowercase();
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Takes the unit that a name ends with off its words.
fn take_unit(words: &mut Vec<String>) -> Option<SizeUnit> {
    let mut unit = SizeUnit::of(words.last()?)?;
    words.pop();
    if unit.unit == LengthUnit::Foot && words.last().is_some_and(|word| word == "us") {
        unit.unit = LengthUnit::UsSurveyFoot;
        words.pop();
    }
    // "size in mm"
    words.pop_if(|word| word == "in");
    Some(unit)
}

/// A column called a size: of sieves or fragments, or, like a sample's or an image's, of something else.
fn of_size_role(words: &[String], unit: Option<SizeUnit>) -> Role {
    let known = [
        "size",
        "sizes",
        "opening",
        "openings",
        "aperture",
        "apertures",
        "diameter",
        "diameters",
        "sieve",
        "sieves",
        "screen",
        "particle",
        "grain",
        "fragment",
        "rock",
        "block",
        "stone",
        "nominal",
        "siebweite",
        "maschenweite",
        "ouverture",
        "abertura",
        "tamis",
        "tamiz",
        "malla",
        "sievesize",
        "screensize",
        "grainsize",
        "particlesize",
        "fragmentsize",
        "square",
        "hole",
        "passing",
        "of",
        "the",
        "min",
        "max",
        "lower",
        "upper",
    ];
    match words.iter().all(|word| known.contains(&word.as_str())) {
        true => Role::Size(unit),
        false => Role::PerhapsSize(unit),
    }
}

/// How many square metres or kilograms are one of what the name of a column of areas or masses says; 1 where it says no unit. Tables
/// that are joined need not count in the same.
pub(super) fn weight_factor(name: &str) -> f64 {
    let words = words(name);
    let Some((last, before)) = words.split_last() else {
        return 1.0;
    };
    // "ft2", "ft²", "sqft", "sq ft"
    let is_square = before.last().is_some_and(|word| word == "sq");
    let side = last.strip_suffix(['2', '²']).or(last.strip_prefix("sq"));
    if let Some(side) = side.or(is_square.then_some(last)).and_then(SizeUnit::of) {
        return (side.factor * side.unit.metres()).powi(2);
    }
    match last.as_str() {
        "g" | "gram" | "grams" => 1e-3,
        "t" | "tonne" | "tonnes" => 1e3,
        "lb" | "lbs" => 0.453_592_37,
        _ => 1.0,
    }
}

/// Whether the name of a column of weights says that they are areas or masses.
pub(super) fn weight_of(name: &str) -> Option<Weighting> {
    let all = words(name);
    let is_square = |word: &str| {
        let side = word.strip_suffix(['2', '²']).or(word.strip_prefix("sq"));
        side.is_some_and(|side| SizeUnit::of(side).is_some())
    };
    let is_area = |word: &String| word.starts_with("area") || is_square(word);
    match all.iter().any(is_area) {
        true => Some(Weighting::Area),
        false => says_mass(&all).then_some(Weighting::Mass),
    }
}

/// What is wrong with the name of a column of sizes: a factor beside its unit, two units, or logarithms, of which no size is taken.
pub(super) fn size_trouble(name: &str) -> Option<&'static str> {
    let mut words = words(name);
    let is_logarithm =
        |word: &String| matches!(word.as_str(), "log" | "log10" | "ln" | "phi" | "psi");
    if words.iter().any(is_logarithm) {
        return Some("may be logarithms of sizes");
    }
    take_unit(&mut words)?;
    let is_number = |word: &String| word.trim_start_matches('x').parse::<f64>().is_ok();
    if words.iter().any(is_number) {
        return Some("has a number beside its unit");
    }
    let is_unit = |word: &String| word.len() > 1 && word != "in" && SizeUnit::of(word).is_some();
    words.iter().any(is_unit).then_some("has two units")
}

/// Whether a text is a unit of what is on sieves or passes them: percent or a mass.
pub(super) fn is_unit_of_amounts(text: &str) -> bool {
    let words = words(text);
    matches!(&words[..], [_]) && (says_percent(&words) || says_mass(&words))
}

/// The name of the sample in the name of a column of what stays on its sieves: what is left without the words for that.
pub(super) fn sample_of(name: &str) -> String {
    let known = |word: &str| {
        let word = key(word);
        let of_sieves = ["on", "sieve"];
        word.is_empty()
            || says_cumulative(&word)
            || [&RETAINED_NAMES[..], &PERCENT_NAMES, &EACH_NAMES, &of_sieves]
                .iter()
                .any(|list| list.contains(&word.as_str()))
            || says_mass(std::slice::from_ref(&word))
    };
    let separators = |c: char| c.is_whitespace() || matches!(c, '_' | '(' | ')' | '[' | ']' | ',');
    let left = name.split(separators).filter(|word| !known(word));
    left.collect::<Vec<_>>()
        .join(" ")
        .trim_matches(['-', ':', '/', ' '])
        .to_owned()
}

/// Whether a column among curves is a mass, and no percent of it.
pub(super) fn is_amount(name: &str) -> bool {
    let words = words(name);
    let is = |list: &[&str], word: &String| list.contains(&word.as_str());
    let is_share = says_percent(&words)
        || words
            .iter()
            .any(|word| is(&["share", "passing", "by"], word));
    let ends_as_mass = words
        .last()
        .is_some_and(|word| is(&["g", "kg", "lb", "lbs"], word));
    let is_mass = words.iter().any(|word| is(&MASS_NAMES, word));
    !is_share && (ends_as_mass || (is_mass && words.len() <= 2))
}

/// What the name of a column says.
pub(super) fn role(name: &str) -> Role {
    let mut words = words(name);
    let percent = words.iter().any(|word| word == "percent");
    let unit = match percent {
        true => None,
        false => take_unit(&mut words),
    };
    let joined = words.concat();
    let any = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    let within = |list: &[&str]| list.iter().any(|part| joined.contains(part));
    // A unit alone. (M may be a method.)
    if words.is_empty() && unit.is_some() && name.trim().len() > 1 {
        return Role::PerhapsSize(unit);
    }
    let statistics = [
        "n",
        "count",
        "counts",
        "sd",
        "std",
        "stddev",
        "stdev",
        "stderror",
        "standarddeviation",
        "standarderror",
        "cv",
        "error",
        "relerror",
        "relativeerror",
        "errorpercent",
        "relerrorpercent",
        "relativeerrorpercent",
    ];
    if statistics.contains(&joined.as_str()) {
        return Role::Statistic;
    }
    let of_size = within(&SIZE_NAMES) && !within(&["undersize", "oversize"]);
    if of_size && unit.is_some() {
        return of_size_role(&words, unit);
    }
    if within(&RETAINED_NAMES) {
        return Role::Retained(RetainedName::of(&words));
    }
    let single = [
        "individual",
        "incremental",
        "differential",
        "frequency",
        "density",
        "histogram",
        "perclass",
        "inclass",
    ];
    if within(&single) {
        return Role::NotCumulative;
    }
    let cumulative = [
        "p",
        "px",
        "ppercent",
        "pxpercent",
        "fx",
        "cdf",
        "cum",
        "cumulative",
        "cumpercent",
        "cumulativepercent",
        "percentcumulative",
        "percentcum",
    ];
    if within(&PASSING_NAMES) || any(&["pass", "pasa"]) || cumulative.contains(&joined.as_str()) {
        return match !percent && says_mass(&words) {
            true => Role::PassingMass,
            false => Role::Passing,
        };
    }
    if within(&["fraction"]) {
        return Role::NotCumulative;
    }
    if of_size {
        return of_size_role(&words, unit);
    }
    let photos = [
        "photo",
        "photos",
        "photoname",
        "photofile",
        "image",
        "images",
        "imagename",
        "imagefile",
        "picture",
        "file",
        "filename",
        "label",
        "sample",
        "samplename",
        "name",
    ];
    match joined.as_str() {
        "sieve" | "sieves" | "screen" | "screens" | "x" | "d" | "mesh" | "sievemesh" | "usmesh"
        | "tylermesh" | "sieveno" | "sievenumber" | "screenno" | "screennumber" => {
            Role::PerhapsSize(unit)
        }
        "method" | "methods" | "technique" | "source" => Role::Method,
        "trial" | "trials" | "trialnumber" | "trialno" | "run" | "repetition" | "replicate"
        | "repeat" | "test" => Role::Trial,
        name => match photos.iter().position(|photo| *photo == name) {
            Some(place) => Role::Photo(place),
            None if any(&["area", "areas", "mass", "masses", "weight", "weights"]) => Role::Weight,
            None => Role::Other,
        },
    }
}

/// Whether a column of sizes is called a mesh's or a sieve's number: bare numbers in it are names, no sizes.
pub(super) fn holds_sieve_numbers(name: &str) -> bool {
    let numbers = ["mesh", "no", "number", "nr"];
    name.contains('#')
        || words(name)
            .iter()
            .any(|word| numbers.contains(&word.as_str()))
}

/// A column of sizes that a percent passes: "D50", "P80 (mm)", "x50".
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PercentileColumn {
    /// 0 to 100, neither included at 0.
    pub(super) percent: f64,
    pub(super) unit: Option<SizeUnit>,
    /// What the columns of one set have in common: the letter and what follows the number.
    pub(super) set: String,
}

impl PercentileColumn {
    pub(super) fn of(name: &str) -> Option<Self> {
        let name = name.trim().to_lowercase();
        let letter = name.chars().next().filter(|c| "dpxk".contains(*c))?;
        let rest = name.get(1..)?.trim_start_matches([' ', '_', '(']);
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.');
        let (number, suffix) = rest.split_at_checked(digits.unwrap_or(rest.len()))?;
        let percent: f64 = number.parse().ok()?;
        if !(percent > 0.0 && percent <= 100.0) {
            return None;
        }
        let mut words = words(suffix);
        let unit = take_unit(&mut words);
        Some(Self {
            percent,
            unit,
            set: format!("{letter} {}", words.join(" ")),
        })
    }

    /// Whether its sizes are logarithms, on geologists' psi or phi scale.
    pub(super) fn is_logarithm(&self) -> bool {
        self.set
            .split(' ')
            .any(|word| matches!(word, "psi" | "phi"))
    }
}

/// A size as the name of a column or as a cell: "10 mm", "0.5", "No. 4".
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SizeText {
    /// The number with the unit behind it.
    pub(super) number: Option<(f64, Option<SizeUnit>)>,
    /// The opening, mm, of the sieve of ASTM E11 that is called so.
    pub(super) sieve_mm: Option<f64>,
}

impl SizeText {
    /// The size that the name of a column is; its decimal sign may be a comma.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        let (number, rest) = split_number(name.trim());
        let unit = SizeUnit::of(rest);
        let number = number.replace(',', ".").parse::<f64>().ok();
        let number = number.filter(|n| n.is_finite() && (unit.is_some() || rest.trim().is_empty()));
        let sieve_mm = sieve_mm(name);
        let found = number.is_some() || sieve_mm.is_some();
        found.then_some(Self {
            number: number.map(|number| (number, unit)),
            sieve_mm,
        })
    }
}

/// The opening of the sieve of ASTM E11 with that designation: "No. 4", "#4", "3/8 in.", "3/8\"". One that is called by
/// a fraction is of inches, whatever else the table is of.
pub(super) fn sieve_mm(name: &str) -> Option<f64> {
    let in_inches = || name.contains('/').then(|| format!("{name} in"));
    named_sieve_mm(name).or_else(|| named_sieve_mm(&in_inches()?))
}

/// As [`sieve_mm`], with the inches said.
fn named_sieve_mm(name: &str) -> Option<f64> {
    let squeezed = |text: &str| -> String {
        let text = text.to_lowercase().replace('#', "no");
        let text = text.replace(['"', '″'], "in").replace("inch", "in");
        text.chars()
            .filter(|c| c.is_alphanumeric() || *c == '/')
            .collect()
    };
    let name = name.trim();
    let is_named =
        name.starts_with(['N', 'n', '#']) || name.to_lowercase().contains(['i', '"', '″']);
    if !is_named {
        return None;
    }
    let wanted = squeezed(name);
    let sieves = SieveSeries::AstmE11.sieves();
    let sieve = sieves
        .iter()
        .find(|sieve| squeezed(sieve.designation) == wanted);
    sieve.map(|sieve| sieve.opening_mm)
}
