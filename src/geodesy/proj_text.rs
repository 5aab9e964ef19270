//! A PROJ string, word by word: "+proj=utm +zone=17 +datum=WGS84".

use super::heights::Heights;
use crate::units::LengthUnit;

/// The words of a PROJ string.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ProjText {
    words: Vec<(String, Option<String>)>,
}

impl ProjText {
    /// Takes it apart. Words that say nothing about the system (`no_defs`, `type`) go.
    pub(super) fn parse(text: &str) -> Self {
        let mut words: Vec<(String, Option<String>)> = Vec::new();
        for word in text.split_whitespace() {
            let word = word.strip_prefix('+').unwrap_or(word);
            let (key, value) = match word.split_once('=') {
                Some((key, value)) => (key, Some(value)),
                None => (word, None),
            };
            // proj4rs knows `k` and `k0` only, EPSG's table writes `k_0` as well.
            let key = if key == "k_0" { "k" } else { key };
            // PyProj writes flags as `+no_defs=True`.
            let value = value.filter(|v| !v.eq_ignore_ascii_case("true"));
            let idle = ["no_defs", "type", "wktext", "title", ""];
            // The first of two counts, as in PROJ.
            if !idle.contains(&key) && !words.iter().any(|(known, _)| known == key) {
                words.push((key.to_owned(), value.map(str::to_owned)));
            }
        }
        Self { words }
    }

    /// The value behind a key.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        let word = self.words.iter().find(|(known, _)| known == key)?;
        word.1.as_deref()
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.words.iter().any(|(known, _)| known == key)
    }

    pub(super) fn number(&self, key: &str) -> Option<f64> {
        self.get(key)?.parse().ok()
    }

    pub(super) fn set(&mut self, key: &str, value: String) {
        self.words.retain(|(known, _)| known != key);
        self.words.push((key.to_owned(), Some(value)));
    }

    /// The zone of UTM on WGS 84 in metres, and whether it is a southern one; `None` for what is
    /// anything else.
    pub(super) fn utm_wgs84(&self) -> Option<(u32, bool)> {
        let known = [
            "proj", "zone", "south", "north", "datum", "ellps", "towgs84", "units", "lat_0",
            "lon_0", "k", "x_0", "y_0", "a", "rf",
        ];
        if !self
            .words
            .iter()
            .all(|(key, _)| known.contains(&key.as_str()))
        {
            return None;
        }
        if self.get("units").is_some_and(|unit| unit != "m") || self.has_shift() {
            return None;
        }
        let by_name = [self.get("datum"), self.get("ellps")].contains(&Some("WGS84"));
        let by_size =
            self.number("a") == Some(6_378_137.0) && self.number("rf") == Some(298.257_223_563);
        if !by_name && !by_size {
            return None;
        }
        let zone = match self.get("proj")? {
            "utm" => return Some((self.get("zone")?.parse().ok()?, self.has("south"))),
            "tmerc" => (self.number("lon_0")? + 183.0) / 6.0,
            _ => return None,
        };
        let is = |key: &str, value: f64| self.number(key).unwrap_or(0.0) == value;
        let is_utm = is("lat_0", 0.0) && is("k", 0.9996) && is("x_0", 500_000.0);
        let south = is("y_0", 10_000_000.0);
        let is_zone = (1.0..=60.0).contains(&zone) && zone.fract() == 0.0;
        (is_utm && is_zone && (south || is("y_0", 0.0))).then_some((zone as u32, south))
    }

    /// Whether numbers shift the datum against WGS 84.
    pub(super) fn has_shift(&self) -> bool {
        let shift = self.get("towgs84").unwrap_or_default();
        let mut numbers = shift.split(',').filter(|number| !number.is_empty());
        numbers.any(|number| number.parse() != Ok(0.0_f64))
    }

    /// Whether how it relates to WGS 84 is known: without that it is hundreds of metres off.
    pub(super) fn has_known_datum(&self) -> bool {
        if let Some(grids) = self.get("nadgrids") {
            return grids == "@null";
        }
        // Those of proj4rs that go through numbers.
        let datums = [
            "WGS84",
            "NAD83",
            "GGRS87",
            "potsdam",
            "carthage",
            "hermannskogel",
            "ire65",
            "nzgd49",
            "OSGB36",
        ];
        let near = |key, value: f64| self.number(key).is_some_and(|x| (x - value).abs() < 2e-6);
        self.has("towgs84")
            || self.get("datum").is_some_and(|name| datums.contains(&name))
            || self
                .get("ellps")
                .is_some_and(|name| ["GRS80", "WGS84"].contains(&name))
            || near("a", 6_378_137.0) && near("rf", 298.257_222_5)
    }

    /// Degrees of its central meridian east of its prime meridian; 0 where none is told.
    pub(super) fn central_meridian(&self) -> f64 {
        match self.number("zone") {
            Some(zone) => zone * 6.0 - 183.0,
            None => self.number("lon_0").or(self.number("lonc")).unwrap_or(0.0),
        }
    }

    /// What its heights count from.
    pub(super) fn heights(&self) -> Heights {
        let unit = |key: &str, factor: &str| match self.get(key) {
            Some(name) => length_of(name),
            None => self.number(factor),
        };
        Heights {
            name: (self.get("geoidgrids")).map(|grids| format!("the geoid of {grids}")),
            code: None,
            unit_metres: unit("vunits", "vto_meter"),
        }
    }

    /// Degrees of its prime meridian east of Greenwich; `None` where it has a name that is not known.
    pub(super) fn prime_meridian(&self) -> Option<f64> {
        let Some(name) = self.get("pm") else {
            return Some(0.0);
        };
        // EPSG dataset v11, prime meridians.
        Some(match name.to_ascii_lowercase().as_str() {
            "greenwich" => 0.0,
            "lisbon" => -(9.0 + 7.0 / 60.0 + 54.862 / 3600.0),
            "paris" => 2.0 + 20.0 / 60.0 + 14.025 / 3600.0,
            "bogota" => -(74.0 + 4.0 / 60.0 + 51.3 / 3600.0),
            "madrid" => -(3.0 + 41.0 / 60.0 + 14.55 / 3600.0),
            "rome" => 12.0 + 27.0 / 60.0 + 8.4 / 3600.0,
            "bern" => 7.0 + 26.0 / 60.0 + 22.5 / 3600.0,
            "jakarta" => 106.0 + 48.0 / 60.0 + 27.79 / 3600.0,
            "ferro" => -(17.0 + 40.0 / 60.0),
            "brussels" => 4.0 + 22.0 / 60.0 + 4.71 / 3600.0,
            "stockholm" => 18.0 + 3.0 / 60.0 + 29.8 / 3600.0,
            "athens" => 23.0 + 42.0 / 60.0 + 58.815 / 3600.0,
            "oslo" => 10.0 + 43.0 / 60.0 + 22.5 / 3600.0,
            number => number.parse().ok()?,
        })
    }

    /// Has the central meridian of a projection count from Greenwich; `None` where its prime meridian
    /// is not known. proj4rs 0.1.10 cannot do it: it adds the degrees to radians.
    pub(super) fn count_from_greenwich(&mut self) -> Option<()> {
        let prime_meridian = self.prime_meridian()?;
        if prime_meridian != 0.0 {
            let own = self
                .get("lon_0")
                .map_or(Some(0.0), |text| text.parse().ok())?;
            self.set("lon_0", format!("{}", own + prime_meridian));
        }
        self.words.retain(|(key, _)| key != "pm");
        Some(())
    }

    /// The text for proj4rs: without what [`Crs`](super::Crs) does itself, and
    /// with the axes east, north where the definition has north first.
    pub(super) fn for_proj4rs(&self) -> String {
        let mut text = String::new();
        for (key, value) in &self.words {
            let own = ["pm", "vunits", "vto_meter", "geoidgrids"].contains(&key.as_str());
            let north_first = key == "axis" && value.as_deref() == Some("neu");
            if own || north_first {
                continue;
            }
            text.push_str(if text.is_empty() { "+" } else { " +" });
            text.push_str(key);
            if let Some(value) = value {
                text.push('=');
                text.push_str(value);
            }
        }
        text
    }
}

/// The length in metres of a unit that PROJ names.
fn length_of(name: &str) -> Option<f64> {
    Some(match name {
        "m" => 1.0,
        "us-ft" => LengthUnit::UsSurveyFoot.metres(),
        "ft" => LengthUnit::Foot.metres(),
        _ => return None,
    })
}
