//! Flights with answers from outside this code: each folder of `tests/fixtures` holds a flight and
//! the scales that an independent implementation (Python, from the contract alone; SciPy's Qhull for
//! the triangulation, OpenCV for checks of the lenses) computed for it.

use std::path::Path;

use crate::common::scales_json;
use serde_json::{Map, Value};

/// Of a photo: what is doubted and decided has tests of its own (`trust`, `decisions`).
const DECIDED: [&str; 3] = ["decision", "reasons", "verdict"];

/// Numbers agree to a relative `tolerance` of `size`, everything else is equal.
fn compare(place: &str, computed: &Value, expected: &Value, tolerance: f64, size: f64) {
    match (computed, expected) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().expect("f64"), b.as_f64().expect("f64"));
            let off = (a - b).abs();
            assert!(
                off <= tolerance * size.max(b.abs()),
                "{place}: {a} is not {b}"
            );
        }
        (Value::Array(a), Value::Array(b)) => {
            assert_eq!(a.len(), b.len(), "{place}");
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                compare(&format!("{place}[{index}]"), a, b, tolerance, size);
            }
        }
        (Value::Object(a), Value::Object(b)) => {
            let keys = |object: &Map<String, Value>| -> Vec<String> {
                let keys = object
                    .keys()
                    .filter(|key| !DECIDED.contains(&key.as_str()))
                    .filter(|key| *key != "uncertainty" || expected.get("uncertainty").is_some());
                keys.cloned().collect()
            };
            let (keys_a, keys_b) = (keys(a), keys(b));
            assert_eq!(keys_a, keys_b, "{place}");
            for (key, a) in a {
                if DECIDED.contains(&key.as_str()) {
                    continue;
                }
                if key == "uncertainty" {
                    holds_the_scales(place, computed);
                    if let Some(expected) = expected.get(key) {
                        compare_uncertainty(&format!("{place}.{key}"), a, expected);
                    }
                    continue;
                }
                let (tolerance, size) = match key.as_str() {
                    // The contract's bound.
                    "scale" => (1e-7, 0.0),
                    "fitted" => (1e-6, 0.0),
                    // Near nothing they are what is left of scales that agree.
                    "rms_percent" | "worst_percent" | "left_right_percent" => (1e-6, 1.0),
                    "direction" => (1e-10, 1.0),
                    // Relative to UTM coordinates a micrometre would be lost.
                    "point" => (1e-9, 1e3),
                    "ground" => (1e-12, 1.0),
                    _ => (tolerance, size),
                };
                compare(
                    &format!("{place}.{key}"),
                    a,
                    &expected[key],
                    tolerance,
                    size,
                );
            }
        }
        _ => assert_eq!(computed, expected, "{place}"),
    }
}

/// Every interval of a photo holds its scale and is no narrower than its standard error; what has no
/// scale has no interval, and what has no part is not counted.
fn holds_the_scales(place: &str, photo: &Value) {
    let uncertainty = &photo["uncertainty"];
    if uncertainty.is_null() {
        return;
    }
    let (corners, line) = (&photo["scale"], &photo["fitted"]);
    for (name, scale) in [
        ("top", &corners["top"]),
        ("right", &corners["right"]),
        ("bottom", &corners["bottom"]),
        ("left", &corners["left"]),
        ("fitted_top", &line["top"]),
        ("fitted_bottom", &line["bottom"]),
    ] {
        let interval = &uncertainty[name];
        let [low, high, error] =
            ["low", "high", "standard_error"].map(|key| interval[key].as_f64());
        let (Some(low), Some(high), Some(error)) = (low, high, error) else {
            assert!(interval.is_null(), "{place} {name}: {interval}");
            continue;
        };
        let scale = scale.as_f64().expect("a scale, for it has an interval");
        assert!(low <= scale && scale <= high, "{place} {name}");
        assert!(error >= 0.0 && high - low >= error, "{place} {name}");
    }
    let parts = uncertainty["parts_percent"].as_object().expect("parts");
    let mut missing: Vec<&str> = parts
        .iter()
        .filter(|(_, part)| part.as_f64().is_none_or(|part| part < 0.0))
        .map(|(name, _)| name.as_str())
        .collect();
    let not_counted = uncertainty["not_counted"].as_array().expect("a list");
    let mut said: Vec<&str> = not_counted.iter().filter_map(Value::as_str).collect();
    missing.sort_unstable();
    said.sort_unstable();
    assert_eq!(missing, said, "{place}");
}

/// How sure the scales are, against 20 000 draws. What is counted by derivatives agrees to what those
/// draws tell and what is not linear; of the corners 400 draws tell a standard error to 3.5 % and the end
/// of an interval to a tenth of its half.
fn compare_uncertainty(place: &str, computed: &Value, expected: &Value) {
    let number = |value: &Value, key: &str| {
        let number = value[key].as_f64();
        number.unwrap_or_else(|| panic!("{place}: no {key} in {value}"))
    };
    for (name, of_error, of_end) in [
        ("top", 0.12, 0.25),
        ("right", 0.12, 0.25),
        ("bottom", 0.12, 0.25),
        ("left", 0.12, 0.25),
        ("fitted_top", 0.02, 0.05),
        ("fitted_bottom", 0.02, 0.05),
    ] {
        let (a, b) = (&computed[name], &expected[name]);
        let half = (number(b, "high") - number(b, "low")) / 2.0;
        let ratio = number(a, "standard_error") / number(b, "standard_error");
        assert!((ratio - 1.0).abs() < of_error, "{place} {name}: {ratio}");
        for end in ["low", "high"] {
            let off = (number(a, end) - number(b, end)).abs() / half;
            assert!(off < of_end, "{place} {name}: {end} is {off} halves off");
        }
    }
    let (a, b) = (&computed["parts_percent"], &expected["parts_percent"]);
    for part in ["pose", "lens", "surface", "world"] {
        let off = (number(a, part) - number(b, part)).abs();
        assert!(off < 0.02 * number(b, part) + 1e-9, "{place} {part}: {off}");
    }
    assert_eq!(computed["not_counted"], expected["not_counted"], "{place}");
}

#[test]
fn every_fixture_agrees() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut count = 0;
    for entry in std::fs::read_dir(fixtures).expect("the fixtures") {
        let folder = entry.expect("an entry").path();
        let flight = folder.join("flight.toml");
        if !flight.is_file() {
            continue;
        }
        let expected = std::fs::read_to_string(folder.join("expected.json")).expect("answers");
        let expected: Value = serde_json::from_str(&expected).expect("JSON");
        let computed = scales_json(&flight, &["--unit", "m"]);
        compare(
            &folder.display().to_string(),
            &computed,
            &expected,
            0.0,
            0.0,
        );
        count += 1;
    }
    assert!(count >= 12, "only {count} fixtures were found");
}
