//! Values of JSON as AliceVision writes them: boost's property tree knows only text, so numbers stand
//! in quotes, and an empty list or object is "". Other programs write plain JSON; both read.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// A finite number, in quotes or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number(pub(super) f64);

/// What something is called by: a number, in quotes or not, or any text.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Id(pub(super) String);

/// A list, "" where it is empty.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct List<T>(pub(super) Vec<T>);

/// One number or a list of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Numbers(pub(super) Vec<f64>);

/// The entries of an object whose keys begin with "GPS:", as text; "" where there are none.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct GpsTags(pub(super) Vec<(String, String)>);

impl Id {
    /// Whether it stands for no id: AliceVision's `UndefinedIndexT`.
    pub(super) fn is_undefined(&self) -> bool {
        self.0 == "4294967295" || self.0.is_empty()
    }

    /// Whether it reads as yes: flags are written as numbers or words.
    pub(super) fn is_true(&self) -> bool {
        self.0 == "1" || self.0 == "true"
    }
}

impl<T> Default for List<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Copy, const N: usize> TryFrom<&List<T>> for [T; N] {
    type Error = ();

    fn try_from(list: &List<T>) -> Result<Self, ()> {
        <[T; N]>::try_from(list.0.as_slice()).map_err(|_| ())
    }
}

struct NumberVisitor;

impl Visitor<'_> for NumberVisitor {
    type Value = Number;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a finite number, in quotes or not")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
        Ok(Number(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
        Ok(Number(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Number, E> {
        Ok(Number(value as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Number, E> {
        let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
        let unexpected = || E::invalid_value(serde::de::Unexpected::Str(text), &self);
        number.map(Number).ok_or_else(unexpected)
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberVisitor)
    }
}

struct IdVisitor;

impl Visitor<'_> for IdVisitor {
    type Value = Id;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a text")
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Id, E> {
        Ok(Id(value.to_string()))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Id, E> {
        Ok(Id(value.to_string()))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Id, E> {
        Ok(Id(value.to_string()))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Id, E> {
        Ok(Id(value.to_string()))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Id, E> {
        Ok(Id(text.trim().to_owned()))
    }
}

impl<'de> Deserialize<'de> for Id {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(IdVisitor)
    }
}

struct ListVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for ListVisitor<T> {
    type Value = List<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list, or \"\" for an empty one")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<List<T>, E> {
        match text {
            "" => Ok(List::default()),
            _ => Err(E::invalid_type(serde::de::Unexpected::Str(text), &self)),
        }
    }

    fn visit_unit<E: Error>(self) -> Result<List<T>, E> {
        Ok(List::default())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<List<T>, A::Error> {
        let mut list = Vec::new();
        while let Some(element) = seq.next_element()? {
            list.push(element);
        }
        Ok(List(list))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for List<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ListVisitor(PhantomData))
    }
}

struct NumbersVisitor;

impl<'de> Visitor<'de> for NumbersVisitor {
    type Value = Numbers;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a list of numbers")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Numbers, E> {
        Ok(Numbers(vec![value]))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Numbers, E> {
        Ok(Numbers(vec![value as f64]))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Numbers, E> {
        Ok(Numbers(vec![value as f64]))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Numbers, E> {
        if text.is_empty() {
            return Ok(Numbers(Vec::new()));
        }
        NumberVisitor
            .visit_str(text)
            .map(|number| Numbers(vec![number.0]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Numbers, A::Error> {
        let mut list = Vec::new();
        while let Some(Number(number)) = seq.next_element()? {
            list.push(number);
        }
        Ok(Numbers(list))
    }
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumbersVisitor)
    }
}

struct GpsVisitor;

impl<'de> Visitor<'de> for GpsVisitor {
    type Value = GpsTags;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object, or \"\" for an empty one")
    }

    fn visit_str<E: Error>(self, _text: &str) -> Result<GpsTags, E> {
        Ok(GpsTags::default())
    }

    fn visit_unit<E: Error>(self) -> Result<GpsTags, E> {
        Ok(GpsTags::default())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<GpsTags, A::Error> {
        let mut tags = Vec::new();
        while let Some(key) = map.next_key::<String>()? {
            if key.starts_with("GPS:") {
                tags.push((key, map.next_value::<Id>()?.0));
            } else {
                map.next_value::<IgnoredAny>()?;
            }
        }
        Ok(GpsTags(tags))
    }
}

impl<'de> Deserialize<'de> for GpsTags {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(GpsVisitor)
    }
}

#[cfg(test)]
mod tests {
    use serde::de::DeserializeOwned;

    use super::*;
    use crate::text::json::parse;

    fn of<T: DeserializeOwned>(json: &str) -> Option<T> {
        parse(json.as_bytes()).ok()
    }

    #[test]
    fn quoted_and_plain_values_are_the_same() {
        for json in ["7", "7.0", "\"7\"", "\" 7.0e0 \""] {
            assert_eq!(of(json), Some(Number(7.0)), "{json}");
        }
        for bad in [
            "\"\"",
            "\"nan\"",
            "\"inf\"",
            "\"1e999\"",
            "true",
            "[]",
            "null",
            "\"1,5\"",
        ] {
            assert_eq!(of::<Number>(bad), None, "{bad}");
        }
        assert_eq!(of::<Id>("4294967294"), of("\"4294967294\""));
        assert!(of::<Id>("4294967295").is_some_and(|id| id.is_undefined()));
        assert!(of::<Id>("true").is_some_and(|id| id.is_true()));
        assert!(of::<Id>("\"0\"").is_some_and(|id| !id.is_true()));
    }

    #[test]
    fn empty_text_is_an_empty_list() {
        assert_eq!(of("\"\""), Some(List::<Number>(Vec::new())));
        assert_eq!(of("[1, \"2\"]"), Some(List(vec![Number(1.0), Number(2.0)])));
        assert_eq!(of::<List<Number>>("\"1\""), None);
        assert_eq!(of("\"3.5\""), Some(Numbers(vec![3.5])));
        assert_eq!(of("[\"1000\", 2000]"), Some(Numbers(vec![1000.0, 2000.0])));
        assert_eq!(of("\"\""), Some(Numbers(Vec::new())));
        assert_eq!(of("\"\""), Some(GpsTags::default()));
        let tags =
            of::<GpsTags>(r#"{"Make": {"x": 1}, "GPS:Altitude": 93.4, "GPS:LatitudeRef": "N"}"#);
        let expected = [("GPS:Altitude", "93.4"), ("GPS:LatitudeRef", "N")];
        assert_eq!(
            tags.unwrap().0,
            expected.map(|(k, v)| (k.to_owned(), v.to_owned()))
        );
    }
}
