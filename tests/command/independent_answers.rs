//! Flights with answers from outside this code: each folder of `tests/fixtures` holds a flight and
//! the scales that an independent implementation (Python, from the contract alone; SciPy's Qhull for
//! the triangulation, OpenCV for checks of the lenses) computed for it.

use std::path::Path;

use crate::common::scales_json;
use serde_json::Value;

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
            let (keys_a, keys_b): (Vec<_>, Vec<_>) = (a.keys().collect(), b.keys().collect());
            assert_eq!(keys_a, keys_b, "{place}");
            for (key, a) in a {
                let (tolerance, size) = match key.as_str() {
                    // The contract's bound.
                    "scale" => (1e-7, 0.0),
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
