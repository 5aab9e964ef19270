//! What the name of a column says that it holds.

use super::size_unit::{SizeUnit, in_brackets, is_also_a_word, no_length};
use super::vocabulary::{
    EACH_NAMES, MASS_NAMES, METHOD_NAMES, PASSING_NAMES, PERCENT_NAMES, PHOTO_NAMES, SIZE_NAMES,
    SIZE_WORDS, TRIAL_NAMES, is_retained, says_cumulative, says_mass, says_percent, says_retained,
    words,
};
use crate::fragmentation::{Weighting, names_sieve, names_sieving};
use crate::tables::table::key;
use crate::units::LengthUnit;

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
        let each = any(EACH_NAMES);
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

/// Takes the unit that a name ends with off its words.
pub(super) fn take_unit(words: &mut Vec<String>) -> Option<SizeUnit> {
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

/// Takes the unit that the name of a column of sizes states off its words: at their end, else the only one among them, as in
/// "Sieve size (inches) - square opening".
pub(super) fn take_unit_of_size(name: &str, words: &mut Vec<String>) -> Option<SizeUnit> {
    if let Some(unit) = take_unit(words) {
        return Some(unit);
    }
    let alone: Vec<String> = in_brackets(name)
        .iter()
        .map(|text| text.to_lowercase())
        .collect();
    let unit_of = |word: &String| {
        let is_said = alone.iter().any(|text| text.trim_end_matches('.') == word);
        SizeUnit::of(word).filter(|_| is_said || !is_also_a_word(word))
    };
    let unit = words.iter().find_map(unit_of)?;
    if words.iter().filter_map(unit_of).any(|other| other != unit) {
        return None;
    }
    let place = words.iter().position(|word| unit_of(word).is_some())?;
    words.retain(|word| unit_of(word).is_none());
    // "size in mm, nominal"
    let before = place.checked_sub(1);
    if let Some(before) =
        before.filter(|before| words.get(*before).is_some_and(|word| word == "in"))
    {
        words.remove(before);
    }
    Some(unit)
}

/// The unit that the name of a column of sizes states.
pub(super) fn unit_of_size(name: &str) -> Option<SizeUnit> {
    take_unit_of_size(name, &mut words(name))
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
        "sieb",
        "siebe",
        "siebweite",
        "siebgröße",
        "siebgrösse",
        "siebgroesse",
        "sieböffnung",
        "maschenweite",
        "ouverture",
        "abertura",
        "tamis",
        "tamiz",
        "malla",
        "durchmesser",
        "setaccio",
        "vaglio",
        "peneira",
        "maskvidd",
        "kornstorlek",
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

/// Whether a name is made of words for sizes alone ("Korngröße"), and is not the bare word for a sieve.
pub(super) fn is_called_size(name: &str) -> bool {
    let words = words(name);
    let is_size = |word: &String| SIZE_NAMES.contains(&word.as_str());
    !words.is_empty() && words.iter().all(is_size) && !names_sieve(name)
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
    if words.iter().any(is_logarithm) || name.contains(['φ', 'Φ', 'ϕ']) {
        return Some("may be logarithms of sizes");
    }
    if let Some(what) = no_length(&words) {
        return Some(what);
    }
    let unit = take_unit_of_size(name, &mut words);
    let is_unit = |word: &String| word.len() > 1 && word != "in" && SizeUnit::of(word).is_some();
    let or = ["or", "and", "oder", "und", "ou", "o"];
    let is_inch_or = |two: &[String]| two[0] == "in" && or.contains(&two[1].as_str());
    let others = words.iter().filter(|word| is_unit(word)).count();
    if others > usize::from(unit.is_none()) || unit.is_some() && words.windows(2).any(is_inch_or) {
        return Some("has two units");
    }
    unit?;
    let is_number = |word: &String| word.trim_start_matches('x').parse::<f64>().is_ok();
    words
        .iter()
        .any(is_number)
        .then_some("has a number beside its unit")
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
            || [PERCENT_NAMES, EACH_NAMES, &of_sieves]
                .iter()
                .any(|list| list.contains(&word.as_str()))
            || says_retained(&word)
            || says_mass(std::slice::from_ref(&word))
    };
    let separators = |c: char| c.is_whitespace() || matches!(c, '_' | '(' | ')' | '[' | ']' | ',');
    let left = name.split(separators).filter(|word| !known(word));
    left.collect::<Vec<_>>()
        .join(" ")
        .trim_matches(['-', ':', '/', ' '])
        .to_owned()
}

/// Whether a name says that it counts fragments, and does not weigh them.
pub(super) fn counts_fragments(name: &str) -> bool {
    let counted = [
        "number", "numbers", "count", "anzahl", "número", "nombre", "numero",
    ];
    words(name)
        .iter()
        .any(|word| counted.contains(&word.as_str()))
}

/// Whether a name says that it is of percents.
pub(super) fn names_percent(name: &str) -> bool {
    says_percent(&words(name))
}

/// What the name of a set of percentiles says beside percents and passing.
pub(super) fn without_passing(name: &str) -> String {
    let is_known = |word: &String| {
        says_percent(std::slice::from_ref(word))
            || says_cumulative(word)
            || PASSING_NAMES.iter().any(|part| word.contains(part))
    };
    let left = words(name).into_iter().filter(|word| !is_known(word));
    left.collect::<Vec<_>>().join(" ")
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
    let is_mass = words.iter().any(|word| is(MASS_NAMES, word));
    !is_share && (ends_as_mass || (is_mass && words.len() <= 2))
}

/// What the name of a column says.
pub(super) fn role(name: &str) -> Role {
    // It counts the lines.
    if name.trim() == "#" {
        return Role::Statistic;
    }
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
    let of_size = (within(SIZE_NAMES) || any(SIZE_WORDS)) && !within(&["undersize", "oversize"]);
    if of_size && !percent {
        let mut without = words.clone();
        if let Some(unit) = unit.or_else(|| take_unit_of_size(name, &mut without)) {
            return of_size_role(&without, Some(unit));
        }
    }
    if is_retained(&words) {
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
    // Malvern's "Volume Cumulative (%)", Coulter's "Cum. < Volume %" and Sympatec's "% Volume Under".
    let is_volume_below = percent
        && any(&["volume", "vol", "number"])
        && (words.iter().any(|word| says_cumulative(word)) || any(&["under", "below"]))
        && !any(&["over", "above", "larger"])
        && !name.contains('>');
    // "Przesiewanie" is sieving, "przesiew" what passes.
    let is_sieving = name.split('/').next().is_some_and(names_sieving);
    if within(PASSING_NAMES) && !is_sieving
        || any(&["pass", "pasa", "through"])
        || cumulative.contains(&joined.as_str())
        || is_volume_below
    {
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
    // "Sieve No. (ASTM)"
    let series = ["astm", "e11", "us", "uss", "standard"];
    let plain = words.iter().filter(|word| !series.contains(&word.as_str()));
    let plain: String = plain.map(String::as_str).collect();
    if ["sieveno", "sievenumber", "sievemesh", "screenno"].contains(&plain.as_str()) {
        return Role::PerhapsSize(unit);
    }
    match joined.as_str() {
        "sieve" | "sieves" | "screen" | "screens" | "x" | "d" | "mesh" | "sievemesh" | "usmesh"
        | "tylermesh" | "meshus" | "meshastm" | "astmmesh" | "ussieve" | "ussieveno"
        | "ussievenumber" | "astmsieve" | "astmsieveno" | "sieveno" | "sievenumber"
        | "screenno" | "screennumber" => Role::PerhapsSize(unit),
        name if METHOD_NAMES.contains(&name) => Role::Method,
        name if TRIAL_NAMES.contains(&name) => Role::Trial,
        name => match PHOTO_NAMES.iter().position(|photo| *photo == name) {
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

/// Whether such a column's numbers are those of ASTM E11, the sieves of the United States. (A Tyler mesh of the same number is another
/// opening: mesh 10 is 1.70 mm, No. 10 is 2.00 mm.)
pub(super) fn holds_astm_numbers(name: &str) -> bool {
    let words = words(name);
    let any = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    any(&["us", "uss", "astm", "e11"]) && !any(&["tyler"])
}
