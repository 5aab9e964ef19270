//! Runs of COCO: counts of pixels outside and inside in turns, column by column, as numbers or in a text that packs
//! them as pycocotools does (`maskApi.c`, `rleFrString`): each count, from the third on less the one two before, in
//! digits of five bits, lowest first, as letters from '0'; a sixth bit says that more follow, the highest of the last
//! is its sign.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use super::numbers::Numbers;

/// An annotation's `segmentation`.
#[derive(Debug, Default)]
pub(super) enum Segmentation {
    #[default]
    Nothing,
    Polygons(Numbers),
    /// `size` is height, then width.
    Runs {
        size: Numbers,
        counts: Counts,
    },
}

/// The counts of runs.
#[derive(Debug, Default)]
pub(super) enum Counts {
    #[default]
    Nothing,
    Plain(Vec<u32>),
    Packed(String),
}

impl Counts {
    /// The counts; `None` where the text is damaged.
    pub(super) fn unpacked(self) -> Option<Vec<u32>> {
        match self {
            Self::Nothing => None,
            Self::Plain(counts) => Some(counts),
            Self::Packed(text) => unpacked(&text),
        }
    }
}

fn unpacked(text: &str) -> Option<Vec<u32>> {
    let mut counts: Vec<u32> = Vec::new();
    let mut digits = text.bytes();
    while let Some(first) = digits.next() {
        let (mut number, mut shift, mut byte) = (0_i64, 0, first);
        loop {
            let digit = byte.checked_sub(b'0').filter(|digit| *digit < 64)?;
            // No count has more than 35 bits.
            number |= i64::from(digit & 0x1f)
                .checked_shl(shift)
                .filter(|_| shift <= 30)?;
            shift += 5;
            if digit & 0x20 == 0 {
                if digit & 0x10 != 0 {
                    number -= 1 << shift;
                }
                break;
            }
            byte = digits.next()?;
        }
        if let [.., before, _] = counts[..]
            && counts.len() > 2
        {
            number += i64::from(before);
        }
        counts.push(u32::try_from(number).ok()?);
    }
    Some(counts)
}

impl<'de> Deserialize<'de> for Counts {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(CountsVisitor)
    }
}

struct CountsVisitor;

impl<'de> Visitor<'de> for CountsVisitor {
    type Value = Counts;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the counts of runs")
    }

    fn visit_unit<E: Error>(self) -> Result<Counts, E> {
        Ok(Counts::Nothing)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Counts, E> {
        Ok(Counts::Packed(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Counts, A::Error> {
        let mut counts = Vec::new();
        while let Some(count) = list.next_element()? {
            counts.push(count);
        }
        Ok(Counts::Plain(counts))
    }
}

impl<'de> Deserialize<'de> for Segmentation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SegmentationVisitor)
    }
}

struct SegmentationVisitor;

impl<'de> Visitor<'de> for SegmentationVisitor {
    type Value = Segmentation;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("polygons or runs")
    }

    fn visit_unit<E: Error>(self) -> Result<Segmentation, E> {
        Ok(Segmentation::Nothing)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Segmentation, A::Error> {
        let list = serde::de::value::SeqAccessDeserializer::new(list);
        Numbers::deserialize(list).map(Segmentation::Polygons)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Segmentation, A::Error> {
        let (mut size, mut counts) = (Numbers::Nothing, Counts::Nothing);
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "size" => size = map.next_value()?,
                "counts" => counts = map.next_value()?,
                _ => {
                    map.next_value::<serde::de::IgnoredAny>()?;
                }
            }
        }
        Ok(Segmentation::Runs { size, counts })
    }
}
