//! Units of sizes as people write them, in the languages that laboratories write in.

use crate::units::LengthUnit;

/// A unit of sizes: `factor` of `unit` are one of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SizeUnit {
    pub(super) unit: LengthUnit,
    /// 1 but for units that are none of ours, as micrometres, which are 0.001 mm.
    pub(super) factor: f64,
}

/// The units that are ours, and their words in English, German, Spanish, French, Italian, Portuguese, Polish, Swedish, Turkish and
/// Russian; in small letters, without a point at the end.
const WORDS: [(LengthUnit, &[&str]); 5] = [
    (
        LengthUnit::Millimetre,
        &[
            "mm",
            "мм",
            "millimetre",
            "millimetres",
            "millimeter",
            "millimeters",
            "milímetro",
            "milímetros",
            "milimetro",
            "milimetros",
            "millimètre",
            "millimètres",
            "millimetro",
            "millimetri",
            "milimetr",
            "milimetry",
            "milimetre",
            "миллиметр",
            "миллиметры",
        ],
    ),
    (
        LengthUnit::Centimetre,
        &[
            "cm",
            "см",
            "centimetre",
            "centimetres",
            "centimeter",
            "centimeters",
            "zentimeter",
            "centímetro",
            "centímetros",
            "centimetro",
            "centimetros",
            "centimètre",
            "centimètres",
            "centimetri",
            "centymetr",
            "centymetry",
            "santimetre",
            "сантиметр",
            "сантиметры",
        ],
    ),
    (
        LengthUnit::Metre,
        &[
            "m",
            "м",
            "metre",
            "metres",
            "meter",
            "meters",
            "metro",
            "metros",
            "mètre",
            "mètres",
            "metri",
            "metr",
            "metry",
            "метр",
            "метры",
        ],
    ),
    (
        LengthUnit::Inch,
        &[
            "in",
            "inch",
            "inches",
            "\"",
            "″",
            "''",
            "zoll",
            "pulgada",
            "pulgadas",
            "pulg",
            "plg",
            "pouce",
            "pouces",
            "po",
            "pollice",
            "pollici",
            "polegada",
            "polegadas",
            "pol",
            "cal",
            "cale",
            "tum",
            "inç",
            "дюйм",
            "дюймы",
        ],
    ),
    (
        LengthUnit::Foot,
        &[
            "ft", "foot", "feet", "'", "′", "fuß", "fuss", "pie", "pies", "pied", "pieds", "piede",
            "piedi", "pé", "pés", "fot", "stopa", "stopy", "фут", "футы",
        ],
    ),
];

/// Units that are none of ours: the words, what they are called in a sentence, and what they are.
const OTHERS: [(&[&str], &str, SizeUnit); 5] = [
    (
        // The micro sign and the Greek letter.
        &[
            "um",
            "µm",
            "μm",
            "µ",
            "μ",
            "micron",
            "microns",
            "micrometre",
            "micrometres",
            "micrometer",
            "micrometers",
            "mikrometer",
            "mikron",
            "mikrometr",
            "mikrometry",
            "mikrony",
            "mikrometre",
            "micra",
            "micras",
            "micrón",
            "micrones",
            "micrómetro",
            "micrómetros",
            "micrômetro",
            "micrômetros",
            "micrometro",
            "micrometros",
            "micromètre",
            "micromètres",
            "micrometri",
            "мкм",
            "микрон",
            "микроны",
        ],
        "micrometres",
        SizeUnit {
            unit: LengthUnit::Millimetre,
            factor: 0.001,
        },
    ),
    (
        &["nm", "nanometre", "nanometres", "nanometer", "nanometers"],
        "nanometres",
        SizeUnit {
            unit: LengthUnit::Millimetre,
            factor: 1e-6,
        },
    ),
    (
        &[
            "dm",
            "decimetre",
            "decimetres",
            "decimeter",
            "decimeters",
            "dezimeter",
            "decímetros",
            "дм",
        ],
        "decimetres",
        SizeUnit {
            unit: LengthUnit::Centimetre,
            factor: 10.0,
        },
    ),
    (
        &["mil", "mils", "thou"],
        "thousandths of an inch",
        SizeUnit {
            unit: LengthUnit::Inch,
            factor: 0.001,
        },
    ),
    (
        &["yd", "yds", "yard", "yards"],
        "yards",
        SizeUnit {
            unit: LengthUnit::Foot,
            factor: 3.0,
        },
    ),
];

impl SizeUnit {
    /// One of our units.
    pub(super) fn plain(unit: LengthUnit) -> Self {
        Self { unit, factor: 1.0 }
    }

    /// The unit of a word: "mm", "inches", "Zoll", "µm".
    pub(super) fn of(word: &str) -> Option<Self> {
        let word = word.trim().trim_end_matches('.').to_lowercase();
        let word = word.as_str();
        if word == "us-ft" {
            return Some(Self::plain(LengthUnit::UsSurveyFoot));
        }
        let ours = WORDS.iter().find(|(_, words)| words.contains(&word));
        let other = || OTHERS.iter().find(|(words, ..)| words.contains(&word));
        ours.map(|(unit, _)| Self::plain(*unit))
            .or_else(|| other().map(|(_, _, unit)| *unit))
    }

    /// What a unit that is none of ours is called; `None` of ours.
    pub(super) fn called(self) -> Option<&'static str> {
        let found = OTHERS.iter().find(|(_, _, unit)| *unit == self);
        found.map(|(_, called, _)| *called)
    }
}

/// Whether a word that is a unit may as well be another word or an initial: "in", "m", "pie". Among others it is a unit only where that is
/// said, or in brackets alone.
pub(super) fn is_also_a_word(word: &str) -> bool {
    let short = ["mm", "cm", "dm", "ft", "um", "µm", "μm", "мм", "см"];
    let others = [
        "mil", "pie", "pol", "cal", "tum", "fot", "metro", "thou", "mils",
    ];
    word.chars().count() < 3 && !short.contains(&word) || others.contains(&word)
}

/// What stands in the brackets of a name.
pub(super) fn in_brackets(name: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = name;
    while let Some(open) = rest.find(['(', '[', '{']) {
        let (_, behind) = rest.split_at(open);
        let inside = behind.get(1..).unwrap_or_default();
        let close = inside.find([')', ']', '}']).unwrap_or(inside.len());
        let (text, after) = inside.split_at(close);
        found.push(text.trim());
        rest = after;
    }
    found
}

/// What no length is, of words in the name of sizes: an area or a volume, pixels, and what is half of a size.
pub(super) fn no_length(words: &[String]) -> Option<&'static str> {
    let any = |is: &dyn Fn(&str) -> bool| words.iter().any(|word| is(word));
    let is_unit = |side: Option<&str>| side.is_some_and(|side| SizeUnit::of(side).is_some());
    let pixels = [
        "px", "pix", "pixel", "pixels", "píxel", "píxeles", "pixeles",
    ];
    let halves = [
        "radius",
        "radii",
        "radio",
        "rayon",
        "raggio",
        "raio",
        "promień",
        "радиус",
    ];
    if any(&|word| pixels.contains(&word)) {
        return Some("is in pixels, which are no lengths");
    }
    if any(&|word| is_unit(word.strip_suffix(['2', '²']).or(word.strip_prefix("sq")))) {
        return Some("is an area, no size");
    }
    if any(&|word| is_unit(word.strip_suffix(['3', '³']))) {
        return Some("is a volume, no size");
    }
    any(&|word| halves.contains(&word)).then_some("is a radius, half of a size")
}

/// What stands in brackets in the name of sizes, and may be a unit that nobody knows here: "(cubits)". Numbers, and words of what was
/// sieved with and how, are none.
pub(super) fn unknown_unit(name: &str) -> Option<String> {
    let known = [
        "astm", "e11", "iso", "en", "din", "us", "uss", "tyler", "bs", "square", "round", "hole",
        "holes", "opening", "openings", "aperture", "nominal", "sieve", "sieves", "screen", "mesh",
        "no", "number", "nr", "x", "d", "p", "f", "v", "size", "sizes", "diameter", "log", "scale",
        "passing", "old", "new",
    ];
    let is_unknown = |text: &&str| {
        let mut words = text
            .split(|c: char| !c.is_alphanumeric() && c != '²' && c != '³')
            .filter(|word| !word.is_empty())
            .map(str::to_lowercase);
        let is_known = |word: String| {
            known.contains(&word.as_str()) || word.starts_with(|c: char| c.is_ascii_digit())
        };
        !text.is_empty() && !words.all(is_known) && SizeUnit::of(text).is_none()
    };
    let found = in_brackets(name).into_iter().find(is_unknown);
    found.map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One unit, one meaning: no word is of two.
    #[test]
    fn no_word_is_of_two_units() {
        let ours = WORDS.iter().flat_map(|(_, words)| words.iter());
        let others = OTHERS.iter().flat_map(|(words, ..)| words.iter());
        let mut all: Vec<&&str> = ours.chain(others).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
    }

    #[test]
    fn what_brackets_may_mean() {
        for (name, wanted) in [
            ("Size (cubits)", Some("cubits")),
            ("Size [Linien] (x)", Some("Linien")),
            ("Sieve (ASTM E11)", None),
            ("Sieve size (square opening)", None),
            ("d(0.1)", None),
            ("size", None),
            ("Size (", None),
        ] {
            assert_eq!(unknown_unit(name).as_deref(), wanted, "{name}");
        }
    }
}
