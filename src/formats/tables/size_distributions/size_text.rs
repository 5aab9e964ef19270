//! A size as people write it: a number with or without its unit, a fraction of inches, the name of a sieve.

use super::size_unit::SizeUnit;
use crate::fragmentation::SieveSeries;
use crate::tables::table::number_and_unit;
use crate::units::LengthUnit;

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
        let number = match fraction_of_unit(name) {
            Some((number, Some(unit))) => Some((number, Some(unit))),
            _ => number_of_name(name),
        };
        let sieve_mm = sieve_mm(name);
        let found = number.is_some() || sieve_mm.is_some();
        found.then_some(Self { number, sieve_mm })
    }

    /// A number that no sieve is called.
    pub(super) fn of_number(number: f64, unit: Option<SizeUnit>) -> Self {
        Self {
            number: Some((number, unit)),
            sieve_mm: None,
        }
    }

    /// What a cell may be that has a fraction, the likeliest first: inches, or of the unit that is stated elsewhere or behind it.
    pub(super) fn of_fraction(cell: &str) -> Vec<Self> {
        let inch = SizeUnit::plain(LengthUnit::Inch);
        let inches = fraction_of_inches(cell).map(|number| Self {
            number: Some((number, Some(inch))),
            sieve_mm: sieve_mm(cell),
        });
        let of_unit = fraction_of_unit(cell).map(|(number, unit)| Self::of_number(number, unit));
        inches.into_iter().chain(of_unit).collect()
    }
}

/// The number that the name of a column is, with its unit.
fn number_of_name(name: &str) -> Option<(f64, Option<SizeUnit>)> {
    let (number, _, rest) = number_and_unit(name.trim())?;
    let unit = SizeUnit::of(rest);
    (unit.is_some() || rest.trim().is_empty()).then_some((number, unit))
}

/// Fractions that are one character.
const FRACTIONS: [(char, &str); 7] = [
    ('½', "1/2"),
    ('¼', "1/4"),
    ('¾', "3/4"),
    ('⅛', "1/8"),
    ('⅜', "3/8"),
    ('⅝', "5/8"),
    ('⅞', "7/8"),
];

/// A size whose fraction is one character as two numbers: "1½" is "1 1/2". Others as they are.
fn spelt_out(cell: &str) -> String {
    let spelt = FRACTIONS.iter().fold(cell.to_owned(), |text, (one, two)| {
        text.replace(*one, &format!(" {two}"))
    });
    spelt.trim().to_owned()
}

/// Inches with a fraction, as no sieve of ASTM E11 may be called: "15 3/4", "3-5/8 in.", "1½". Only halves, quarters and so on down to
/// sixty-fourths are fractions of inches.
pub(super) fn fraction_of_inches(cell: &str) -> Option<f64> {
    let (whole, [above, below], unit) = fraction_and_unit(cell)?;
    let inch = SizeUnit::plain(LengthUnit::Inch);
    let is_of_inches = unit.is_none_or(|unit| unit == inch)
        && below.is_power_of_two()
        && (2..=64).contains(&below)
        && (1..below).contains(&above);
    is_of_inches.then(|| f64::from(whole) + f64::from(above) / f64::from(below))
}

/// A fraction of any other unit, which stands behind it or else is what is stated of sizes: "1 1/2", "2/3 ft", "½".
pub(super) fn fraction_of_unit(cell: &str) -> Option<(f64, Option<SizeUnit>)> {
    let (whole, [above, below], unit) = fraction_and_unit(cell)?;
    let inch = SizeUnit::plain(LengthUnit::Inch);
    let is_fraction = unit != Some(inch) && (1..below).contains(&above);
    is_fraction.then(|| {
        let number = f64::from(whole) + f64::from(above) / f64::from(below);
        (number, unit)
    })
}

/// The whole, what stands above and below the line, and the unit behind it.
fn fraction_and_unit(cell: &str) -> Option<(u32, [u32; 2], Option<SizeUnit>)> {
    let text = spelt_out(cell);
    let end = text.find(|c: char| !c.is_ascii_digit() && !" -/".contains(c));
    let (number, unit) = text.split_at_checked(end.unwrap_or(text.len()))?;
    let unit = match unit {
        "" => None,
        unit => Some(SizeUnit::of(unit)?),
    };
    let (whole, parts) = parts_of_fraction(number)?;
    Some((whole, parts, unit))
}

/// The whole, and what stands above and below the line.
fn parts_of_fraction(number: &str) -> Option<(u32, [u32; 2])> {
    let (rest, below) = number.trim().split_once('/')?;
    let (whole, above) = match rest.trim().rsplit_once([' ', '-']) {
        Some((whole, above)) => (whole.trim().parse().ok()?, above),
        None => (0, rest.trim()),
    };
    Some((whole, [above.parse().ok()?, below.trim().parse().ok()?]))
}

/// The opening of the sieve of ASTM E11 with that designation: "No. 4", "#4", "3/8 in.", "3/8\"". One that is called by
/// a fraction is of inches, whatever else the table is of.
pub(super) fn sieve_mm(name: &str) -> Option<f64> {
    let name = &spelt_out(name);
    let in_inches = || name.contains('/').then(|| format!("{name} in"));
    named_sieve_mm(name).or_else(|| named_sieve_mm(&in_inches()?))
}

/// As [`sieve_mm`], with the inches said.
fn named_sieve_mm(name: &str) -> Option<f64> {
    let squeezed = |text: &str| -> String {
        // "N° 4" and "N.º 4" in Spanish, Portuguese and French.
        let text = text
            .to_lowercase()
            .replace('#', "no")
            .replace(['°', 'º'], "o");
        let text = text.replace(['"', '″'], "in").replace("inch", "in");
        let mut squeezed = String::new();
        let mut chars = text.chars().peekable();
        while let Some(c) = chars.next() {
            let is_between_digits = squeezed.ends_with(|c: char| c.is_ascii_digit())
                && chars.peek().is_some_and(char::is_ascii_digit);
            match c {
                // "10.6 in" is not 1.06 in.
                '.' | ',' if is_between_digits => squeezed.push('.'),
                '/' => squeezed.push(c),
                _ if c.is_alphanumeric() => squeezed.push(c),
                _ => {}
            }
        }
        squeezed
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions() {
        for (cell, wanted) in [
            ("15 3/4", Some(15.75)),
            ("5-1/2", Some(5.5)),
            ("1½", Some(1.5)),
            ("¾ in.", Some(0.75)),
            ("19 5/16\"", Some(19.3125)),
            ("3/7", None),
            ("1/2 mm", None),
            ("15", None),
            ("3/2", None),
        ] {
            assert_eq!(fraction_of_inches(cell), wanted, "{cell}");
        }
        let foot = Some(SizeUnit::plain(LengthUnit::Foot));
        for (cell, wanted) in [
            ("1 1/2", Some((1.5, None))),
            ("½", Some((0.5, None))),
            ("2/3", Some((2.0 / 3.0, None))),
            ("2 1/2 ft", Some((2.5, foot))),
            ("1/2 in", None),
            ("1/2 dozen", None),
            ("3/2", None),
        ] {
            assert_eq!(fraction_of_unit(cell), wanted, "{cell}");
        }
    }

    /// ASTM E11, table 1: 1.06 in. is 26.5 mm; no sieve is called 10.6 in.
    #[test]
    fn a_point_in_a_name_counts() {
        for name in ["1.06 in.", "1,06 in", "1.06\""] {
            assert_eq!(sieve_mm(name), Some(26.5), "{name}");
        }
        for name in ["10.6 in", "106 in", "21.2 in", "42.4\""] {
            assert_eq!(sieve_mm(name), None, "{name}");
        }
        assert_eq!(sieve_mm("No. 4"), Some(4.75));
    }
}
