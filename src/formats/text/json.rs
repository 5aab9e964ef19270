//! JSON (RFC 8259) into serde types: faults with their line, objects in the order of the file.
//!
//! serde_json keeps three promises that the readers rest on: numbers are finite (NaN is no JSON, and
//! 1e999 is refused), nesting deeper than 128 is refused in what is read, and what is skipped is
//! skipped without recursion. The tests below hold it to them.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, DeserializeOwned, Deserializer, Error, MapAccess, Visitor};

use crate::fault::Fault;

/// Reads the whole of a JSON text; a byte order mark in front is skipped.
///
/// # Errors
/// Where it is no JSON or not of the shape of `T`, with the line.
pub(crate) fn parse<T: DeserializeOwned>(json: &[u8]) -> Result<T, Fault> {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    serde_json::from_slice(json).map_err(|e| {
        // serde_json ends its sentence with the place, which a fault says in its own way.
        let place = format!(" at line {} column {}", e.line(), e.column());
        let what = e.to_string();
        let what = what.strip_suffix(&place).unwrap_or(&what);
        let remedy = if e.is_data() {
            "check that it is the right file, or export it again"
        } else {
            "the file is cut off or damaged: export it again"
        };
        Fault::at(e.line() as u64, what, remedy)
    })
}

/// A JSON object as a list, in the order of the file. A key that stands twice is an error.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Object<T>(pub(crate) Vec<(String, T)>);

impl<T> Default for Object<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ObjectVisitor(PhantomData))
    }
}

struct ObjectVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ObjectVisitor<T> {
    type Value = Object<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of named entries")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        let mut names: Vec<&str> = entries
            .iter()
            .map(|(name, _): &(String, T)| &**name)
            .collect();
        names.sort_unstable();
        for pair in names.windows(2) {
            if let [a, b] = pair
                && a == b
            {
                return Err(A::Error::custom(format_args!(
                    "the key \"{a}\" stands twice"
                )));
            }
        }
        Ok(Object(entries))
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Deserialize)]
    struct Sample {
        a: f64,
    }

    #[test]
    fn keeps_the_order_of_the_file() {
        let object: Object<i32> = parse(b"\xef\xbb\xbf{\"z\": 1, \"a\": 2, \"m\": 3}").unwrap();
        let expected = [("z", 1), ("a", 2), ("m", 3)].map(|(k, v)| (k.to_owned(), v));
        assert_eq!(object.0, expected);
    }

    #[test]
    fn faults_have_their_line() {
        let twice = parse::<Object<i32>>(b"{\"z\": 1,\n\"z\": 2\n}").unwrap_err();
        assert_eq!(twice.what, "the key \"z\" stands twice");
        assert_eq!(twice.line, Some(3));
        let missing = parse::<Object<Sample>>(b"{\"s\":\n{\"b\": 2}\n}").unwrap_err();
        assert_eq!(missing.what, "missing field `a`");
        assert_eq!(missing.line, Some(2));
        assert!(parse::<Sample>(b"{\"a\": 1} x").is_err());
        assert!(parse::<Object<i32>>(b"[1]").is_err());
    }

    #[test]
    fn numbers_are_finite() {
        for bad in [
            "NaN",
            "Infinity",
            "-Infinity",
            "1e999",
            "-1e999",
            "\"1\"",
            "null",
        ] {
            assert!(
                parse::<Sample>(format!("{{\"a\": {bad}}}").as_bytes()).is_err(),
                "{bad}"
            );
        }
        assert_eq!(parse::<Sample>(b"{\"a\": 7}").unwrap().a, 7.0);
    }

    #[test]
    fn deep_nesting_does_not_overflow_the_stack() {
        let deep = "[".repeat(1_000_000);
        assert!(parse::<serde_json::Value>(deep.as_bytes()).is_err());
        let closed = format!("{}{}", "[".repeat(200), "]".repeat(200));
        assert!(parse::<serde_json::Value>(closed.as_bytes()).is_err());
        // The same in a key that nobody reads.
        assert!(parse::<Sample>(format!("{{\"x\": {deep}").as_bytes()).is_err());
    }
}
