//! The unit of sizes, where a line above the names of the columns states it: a title, a comment, "Units: inches".
//!
//! It counts where the line says that it is the sizes' ("Units: cm", "all sizes in inches"). A unit that stands there otherwise is
//! neither taken nor passed over: the user is asked.

use super::size_unit::{SizeUnit, is_also_a_word};
use super::vocabulary::says_size;
use crate::fault::Fault;
use crate::text::fields::shown;

/// How many lines above the names are looked at.
const MOST_LINES: usize = 100;

/// What is said above a table of its unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Above {
    /// Nothing.
    Nothing,
    /// The unit, in the word that is there, and its line.
    Stated(SizeUnit, String, u64),
    /// Something that may be it.
    Unclear(Fault),
}

impl Above {
    /// Of the lines of a text above its line `header`, from 1.
    pub(super) fn of(text: &str, header: u64) -> Self {
        let above = usize::try_from(header.saturating_sub(1)).unwrap_or(usize::MAX);
        let lines = (1..).zip(text.lines().take(above.min(MOST_LINES)));
        let (mut stated, mut perhaps): (Option<Found>, Option<Found>) = (None, None);
        for (line, text) in lines {
            let words = words(text);
            for at in 0..words.len() {
                let Some((unit, word)) = unit_at(&words, at) else {
                    continue;
                };
                let found = (unit, word.to_owned(), line);
                if !is_stated(&words, at) {
                    perhaps.get_or_insert(found);
                    continue;
                }
                match &stated {
                    Some((known, ..)) if *known != unit => return Self::Unclear(asked(&found)),
                    Some(_) => {}
                    None => stated = Some(found),
                }
            }
        }
        match (stated, perhaps) {
            (Some((unit, ..)), Some(other)) if other.0 != unit => Self::Unclear(asked(&other)),
            (Some((unit, word, line)), _) => Self::Stated(unit, word, line),
            (None, Some(perhaps)) => Self::Unclear(asked(&perhaps)),
            (None, None) => Self::Nothing,
        }
    }
}

/// A unit, in the word that is there, and its line.
type Found = (SizeUnit, String, u64);

fn asked((_, word, line): &Found) -> Fault {
    let what = format!(
        "sizes have no unit, and '{}' in this line above them may be it or not",
        shown(word)
    );
    let remedy = "state it in the name of their column ('size (cm)'), or by --size-unit";
    Fault::at(*line, what, remedy)
}

/// Between what brackets, commas and semicolons part.
const BREAK: &str = "|";

/// The words of a line in small letters, with the inches' sign, colons and equals signs as words, and [`BREAK`]s.
fn words(text: &str) -> Vec<String> {
    let small = text.to_lowercase().replace([':', '='], " : ");
    let breaks = ['(', ')', '[', ']', ',', ';', '|'];
    let small = small.replace(breaks, &format!(" {BREAK} "));
    let parts = small.split(|c: char| !(c.is_alphanumeric() || "\"″':²³%.-|".contains(c)));
    let words = parts.map(|word| word.trim_matches(['.', '-']));
    words
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Words that say that what follows is in a unit.
const IN: [&str; 7] = ["in", "en", "em", "w", "i", "в", "als"];

/// What is called a unit.
const UNITS: [&str; 14] = [
    "unit",
    "units",
    "einheit",
    "einheiten",
    "unidad",
    "unidades",
    "unidade",
    "unité",
    "unités",
    "unità",
    "jednostka",
    "enhet",
    "birim",
    "единицы",
];

/// The unit that the word there is. What stands behind a number is a measure ("bench 12 m"), and a short word another word, but where
/// it is said to be a unit.
fn unit_at(words: &[String], at: usize) -> Option<(SizeUnit, &str)> {
    let word = words.get(at)?.as_str();
    let unit = SizeUnit::of(word)?;
    let before = at.checked_sub(1).and_then(|before| words.get(before));
    let is_measure = before.is_some_and(|before| before.ends_with(|c: char| c.is_ascii_digit()));
    let counts = !is_measure && (!is_also_a_word(word) || is_stated(words, at));
    counts.then_some((unit, word))
}

/// Whether the line says that the word there is the sizes' unit: "unit: cm", "units of size are cm", "all sizes in cm". A unit of something
/// else ("Hole diameter in inches: 6.5", "Pile size in m") is not.
fn is_stated(words: &[String], at: usize) -> bool {
    let fill = [
        "of",
        "the",
        "is",
        "are",
        "all",
        "alle",
        "todos",
        "todas",
        "given",
        "length",
        "lengths",
        "fragment",
        "fragments",
        "particle",
        "particles",
        "grain",
        "rock",
        ":",
        "der",
        "die",
        "de",
        "los",
        "las",
        "sind",
        "ist",
        "measured",
        "angegeben",
    ];
    // "all dimensions in mm"
    let of_all = [
        "dimensions",
        "measures",
        "measurements",
        "lengths",
        "maße",
        "medidas",
        "mesures",
        "misure",
    ];
    let before = words.iter().take(at).rev().map(String::as_str);
    let (mut through_in, mut through_colon, mut says) = (false, false, false);
    for word in before.take_while(|word| *word != BREAK) {
        if UNITS.contains(&word) {
            return true;
        }
        let is_of_all = of_all.contains(&word);
        let is_size = (through_in || through_colon) && (says_size(word) || is_of_all);
        says |= is_size;
        through_in |= IN.contains(&word);
        through_colon |= word == ":";
        if !(is_size || says_size(word) || fill.contains(&word) || IN.contains(&word)) {
            says = false;
            break;
        }
    }
    let behind = words.iter().skip(at + 1).find(|word| *word != ":");
    let is_measure = behind.is_some_and(|word| word.starts_with(|c: char| c.is_ascii_digit()));
    // "Units,inches" is in two cells.
    let first = words
        .iter()
        .take(at)
        .find(|word| *word != BREAK && *word != ":");
    let is_named = first.is_some_and(|word| UNITS.contains(&word.as_str()))
        && words.iter().take(at).filter(|word| *word != BREAK).count() <= 2;
    says && !is_measure || is_named
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::LengthUnit;

    #[test]
    fn stated_asked_or_not_there() {
        let cm = LengthUnit::Centimetre;
        let inch = LengthUnit::Inch;
        for (text, wanted) in [
            ("Units: inches", Some(inch)),
            ("# unit: cm", Some(cm)),
            ("unit = in", Some(inch)),
            ("Units,inches,", Some(inch)),
            ("Sieve analysis blast 14 (sizes in cm)", Some(cm)),
            ("Sieve analysis, all sizes in inches", Some(inch)),
            ("Sizes are given in mm", Some(LengthUnit::Millimetre)),
            ("Einheit der Siebweite: Zoll", Some(inch)),
            ("Tamaños en pulgadas", Some(inch)),
            ("All dimensions in mm", Some(LengthUnit::Millimetre)),
            ("bench 12 m, sample of 30 cm, in the north pit", None),
            ("Laboratory of Dr. May, in Cali", None),
            ("", None),
        ] {
            let found = Above::of(&format!("{text}\nsize,passing\n"), 2);
            match (found, wanted) {
                (Above::Stated(unit, _, 1), Some(wanted)) => {
                    assert_eq!(unit.unit, wanted, "{text}")
                }
                (Above::Nothing, None) => {}
                (found, _) => panic!("{text}: {found:?}"),
            }
        }
        for text in [
            "Sieve analysis (cm)",
            "Units: cm\nall sizes in inches",
            "Units: cm\nplotted in mm",
            "Hole diameter in inches: 6.5",
            "Blast hole diameter in inches",
            "Bohrlochdurchmesser in Zoll: 3.5",
            "Pixel size in cm: 0.21",
            "Scale object diameter in cm: 25",
            "Burden and spacing measurements in ft",
            "Top size: cm 80",
        ] {
            let header = 1 + text.lines().count() as u64;
            let found = Above::of(&format!("{text}\nsize\n"), header);
            assert!(matches!(found, Above::Unclear(_)), "{text}: {found:?}");
        }
        // What stands below the names is of another table.
        assert_eq!(Above::of("size,passing\nunits: cm\n", 1), Above::Nothing);
    }
}
