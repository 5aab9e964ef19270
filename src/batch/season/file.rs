//! SEASON.toml.
//!
//! ```toml
//! format = 1
//! name = "North pit 2026"                  # optional
//! to = "results"                           # optional: the folder of the results; else --to
//! unit = "cm"                              # optional: mm, cm (if left out), m, in, ft
//! steps = ["scales", "delineate", "psd"]   # optional: these are scales and check if left out
//!
//! [delineate]                              # optional: what can be said of a step, as on the command line
//! engine = "classical"
//! # masks = "masks"                        # in place of engine: below the folder of each flight
//!
//! [psd]
//! reference = "sieves.csv"                 # of all flights
//!
//! [[flight]]                               # as many as there are
//! path = "flights/2026-05-*"               # a flight, a folder above flights, or a pattern
//!
//! [[flight]]
//! path = "late/blast-31"
//! name = "B-31"                            # optional: of the blast, and of the folder of its results
//! date = 2026-06-02                        # optional: without it the day of its first photo
//! surface = "late/31.laz"                  # optional, as --surface
//! photos = "late/photos"                   # optional, as --photo-folder
//! reference = "late/sieve-31.csv"          # optional, in place of that of [psd]
//! ```
//!
//! Paths are relative to the file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Value;
use toml::de::DeTable;

use super::{Season, Source};
use crate::asked::{Asked, OptionKind, Step};
use crate::fault::Fault;
use crate::flight::Date;
use crate::toml_text::{key_line, nth_key_line, refuse_unknown_keys, toml_fault};

/// Every table with the keys that it may have.
const KNOWN_KEYS: [(&str, &[&str]); 6] = [
    (
        "",
        &[
            "format",
            "name",
            "to",
            "unit",
            "steps",
            "flight",
            "export",
            "scale-map",
            "delineate",
            "psd",
        ],
    ),
    (
        "flight",
        &["path", "name", "date", "surface", "photos", "reference"],
    ),
    ("export", &["photos", "rectified"]),
    ("scale-map", &["layers"]),
    (
        "delineate",
        &[
            "engine", "shape", "also", "masks", "steps", "porosity", "tail",
        ],
    ),
    ("psd", &["reference", "model", "merge"]),
];

/// What is asked for where the file does not say it.
const STEPS: [Step; 2] = [Step::Scales, Step::Check];

#[derive(Debug, Deserialize)]
struct Text {
    format: u32,
    name: Option<String>,
    to: Option<String>,
    unit: Option<String>,
    steps: Option<Vec<String>>,
    #[serde(default)]
    flight: Vec<FlightText>,
    /// What is said of steps.
    #[serde(flatten)]
    rest: BTreeMap<String, Value>,
}

#[derive(Debug, Deserialize)]
struct FlightText {
    path: String,
    name: Option<String>,
    date: Option<Value>,
    surface: Option<String>,
    photos: Option<String>,
    reference: Option<String>,
}

/// The season in the text of a file, which lies at `path`.
pub(super) fn parse(text: &str, path: &Path) -> Result<Season, Fault> {
    let fault = |error: toml::de::Error| {
        let remedy = match error.message() {
            "missing field `format`" => "write format = 1 above everything else",
            _ => "see docs/season.md",
        };
        toml_fault(text, &error, remedy)
    };
    let table = DeTable::parse(text).map_err(fault)?;
    refuse_unknown_keys(&KNOWN_KEYS, text, table.get_ref())?;
    let read: Text = toml::from_str(text).map_err(fault)?;
    let at = |table: &str, key: &str, what: String, remedy: &str| {
        Fault::at(key_line(text, table, key), what, remedy)
    };
    if read.format != 1 {
        let what = format!("format {} is not known", read.format);
        let remedy = "write format = 1, or use a newer fragscale";
        return Err(at("", "format", what, remedy));
    }
    let mut steps = STEPS.to_vec();
    if let Some(names) = &read.steps {
        let named: Result<Vec<Step>, String> = names.iter().map(|name| name.parse()).collect();
        let remedy = "correct or remove it";
        steps = named.map_err(|what| at("", "steps", what, remedy))?;
    }
    // What is said of a step is looked at also where the step is not asked for now.
    let mut asked = Asked::of(&Step::ALL);
    if let Some(unit) = read.unit {
        asked.unit = unit;
        let wrong = |what| at("", "unit", what, "name one of them");
        asked.length_unit().map_err(wrong)?;
    }
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let below = |name: &str| folder.join(name);
    for (name, options) in &read.rest {
        // Keys that are no steps were refused.
        let (Ok(step), Value::Table(options)) = (name.parse::<Step>(), options) else {
            let what = format!("'{name}' is no table");
            return Err(at("", name, what, "say what is to be said of a step in it"));
        };
        for (key, value) in options {
            let wrong = |what: String| at(name, key, what, "correct or remove it");
            let option = step.options().iter().find(|option| option.key == key);
            let is = |kind: OptionKind| option.is_some_and(|option| option.kind == kind);
            // A share is written as a number, all else as text.
            let number = matches!(value, Value::Float(_) | Value::Integer(_));
            let number = (number && is(OptionKind::Share)).then(|| vec![value.to_string()]);
            let mut values = number.or_else(|| texts(value)).ok_or_else(|| {
                wrong(format!(
                    "{name}.{key} is neither a text nor a list of texts"
                ))
            })?;
            if is(OptionKind::File) {
                let is_word = |value: &String| {
                    option.is_some_and(|option| option.values.contains(&value.as_str()))
                };
                for value in values.iter_mut().filter(|value| !is_word(value)) {
                    *value = below(value).to_string_lossy().into_owned();
                }
            }
            asked.set(step, key, values).map_err(wrong)?;
        }
    }
    // Also of steps that are not asked for now.
    asked.check_options().map_err(|misfit| {
        let (table, what) = (misfit.step.as_str(), misfit.what);
        at(
            table,
            misfit.key,
            format!("{table}.{what}"),
            "correct or remove it",
        )
    })?;
    asked.set_steps(&steps);
    let mut sources = Vec::new();
    for (number, flight) in read.flight.iter().enumerate() {
        let line = |key: &str| nth_key_line(text, "flight", number, key);
        let date = flight.date.as_ref().map(date_of).transpose();
        let date = date.map_err(|what| {
            let what = format!("flight.date {what}");
            Fault::at(line("date"), what, "write it as 2026-05-31")
        })?;
        let texts = [
            ("path", Some(&flight.path)),
            ("name", flight.name.as_ref()),
            ("surface", flight.surface.as_ref()),
            ("photos", flight.photos.as_ref()),
            ("reference", flight.reference.as_ref()),
        ];
        for (key, value) in texts {
            if value.is_some_and(|value| value.trim().is_empty()) {
                let what = format!("flight.{key} is empty");
                return Err(Fault::at(line(key), what, "name one, or remove the key"));
            }
        }
        let maybe = |name: &Option<String>| name.as_deref().map(below);
        sources.push(Source {
            line: Some(line("path")),
            is_watched: false,
            path: below(&flight.path),
            name: flight.name.clone(),
            date,
            surface: maybe(&flight.surface),
            photos: maybe(&flight.photos),
            reference: maybe(&flight.reference),
        });
    }
    if sources.is_empty() {
        let what = "it names no flight";
        return Err(Fault::new(what, "add a [[flight]] table with a path"));
    }
    asked
        .check()
        .map_err(|what| at("", "steps", what, "correct steps and unit"))?;
    let reference_waits = reference_waits(path, &asked, &sources);
    let stem = || {
        path.file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    Ok(Season {
        name: read.name.unwrap_or_else(stem),
        asked,
        to: read.to.as_deref().map(below).map(tidy),
        sources,
        reference_waits,
    })
}

/// That a reference is named and no step holds sizes against it, with the steps that would.
fn reference_waits(path: &Path, asked: &Asked, sources: &[Source]) -> Option<String> {
    let of = match asked.names_reference() {
        true => "[psd]",
        false if sources.iter().any(|source| source.reference.is_some()) => "[[flight]]",
        false => return None,
    };
    if asked.has(Step::Psd) {
        return None;
    }
    let is_asked = |step: &Step| asked.has(*step) || [Step::Delineate, Step::Psd].contains(step);
    let steps = Step::ALL.into_iter().filter(is_asked).map(Step::as_str);
    let steps: Vec<&str> = steps.collect();
    Some(format!(
        "{}: {of} names a reference, but psd is not among the steps, so no sizes are held against it: write steps = {steps:?}, or \
         give --steps {}",
        path.display(),
        steps.join(",")
    ))
}

/// A text or a list of texts.
fn texts(value: &Value) -> Option<Vec<String>> {
    match value {
        Value::String(text) => Some(vec![text.clone()]),
        Value::Array(values) => {
            let texts = values.iter().map(|value| value.as_str().map(str::to_owned));
            texts.collect()
        }
        _ => None,
    }
}

/// A date of TOML, or one in quotes.
fn date_of(value: &Value) -> Result<Date, String> {
    let text = match value {
        Value::String(text) => text.clone(),
        Value::Datetime(date) => date.to_string(),
        other => other.to_string(),
    };
    text.parse()
}

/// "./results" as "results".
fn tidy(path: PathBuf) -> PathBuf {
    path.components().collect()
}
