//! Lists of numbers in JSON, nested as deep as a format wants them, in as little memory as their kind needs.

use std::fmt;

use glam::DVec2;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};

/// Numbers in lists.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) enum Numbers {
    /// `null`.
    #[default]
    Nothing,
    Number(f64),
    /// Of two or three numbers the first two: a place, whose height does not count.
    Pair(DVec2),
    /// More or fewer numbers, or none.
    Flat(Vec<f64>),
    Lists(Vec<Numbers>),
}

impl Numbers {
    /// Of a list of lists these; else nothing.
    pub(super) fn lists(&self) -> &[Self] {
        match self {
            Self::Lists(lists) => lists,
            _ => &[],
        }
    }

    /// The corners of an outline: pairs, or numbers in pairs; `None` where it is neither.
    pub(super) fn corners(&self) -> Option<Vec<DVec2>> {
        match self {
            Self::Pair(corner) => Some(vec![*corner]),
            Self::Flat(numbers) => {
                let (pairs, rest) = numbers.as_chunks::<2>();
                let corners = pairs.iter().map(|pair| DVec2::from(*pair)).collect();
                rest.is_empty().then_some(corners)
            }
            Self::Lists(lists) => lists
                .iter()
                .map(|list| match list {
                    Self::Pair(corner) => Some(*corner),
                    _ => None,
                })
                .collect(),
            Self::Nothing | Self::Number(_) => None,
        }
    }
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumbersVisitor)
    }
}

struct NumbersVisitor;

impl<'de> Visitor<'de> for NumbersVisitor {
    type Value = Numbers;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("numbers in lists")
    }

    fn visit_unit<E: Error>(self) -> Result<Numbers, E> {
        Ok(Numbers::Nothing)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Numbers, E> {
        Ok(Numbers::Number(number))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Numbers, E> {
        Ok(Numbers::Number(number as f64))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Numbers, E> {
        Ok(Numbers::Number(number as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Numbers, A::Error> {
        let mut flat: Vec<f64> = Vec::new();
        let mut lists: Vec<Numbers> = Vec::new();
        while let Some(next) = list.next_element()? {
            match next {
                Numbers::Number(number) => flat.push(number),
                nested => lists.push(nested),
            }
            if !flat.is_empty() && !lists.is_empty() {
                return Err(A::Error::custom("a list holds numbers and lists"));
            }
        }
        Ok(match flat[..] {
            _ if !lists.is_empty() => Numbers::Lists(lists),
            [x, y] | [x, y, _] => Numbers::Pair(DVec2::new(x, y)),
            _ => Numbers::Flat(flat),
        })
    }
}
