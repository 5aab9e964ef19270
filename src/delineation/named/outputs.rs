//! What a network gives, told by its shape.

use std::collections::BTreeMap;
use std::ops::Range;

use rten::Value;
use rten_tensor::prelude::*;

use super::description::Values;
use crate::network::enlarged_part;

/// Of two boxes more than so much of both together is one fragment's; YOLO's own default.
const SAME_BOX: f32 = 0.7;

/// The most that a part may show.
const MOST_DETECTIONS: usize = 2000;

/// Numbers of a tensor in the order of its sides, the last one fastest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Numbers {
    pub(super) shape: Vec<usize>,
    pub(super) values: Vec<f32>,
}

impl Numbers {
    /// Of a tensor of numbers; `None` of a list of tensors.
    pub(super) fn of(value: &Value) -> Option<Self> {
        let shape = |shape: &[usize]| shape.to_vec();
        Some(match value {
            Value::FloatTensor(of) => Self {
                shape: shape(of.shape()),
                values: of.iter().copied().collect(),
            },
            Value::Int32Tensor(of) => Self {
                shape: shape(of.shape()),
                values: of.iter().map(|value| *value as f32).collect(),
            },
            Value::Int8Tensor(of) => Self {
                shape: shape(of.shape()),
                values: of.iter().map(|value| f32::from(*value)).collect(),
            },
            Value::UInt8Tensor(of) => Self {
                shape: shape(of.shape()),
                values: of.iter().map(|value| f32::from(*value)).collect(),
            },
            _ => return None,
        })
    }

    /// The sides without those of one at the front.
    pub(super) fn sides(&self) -> &[usize] {
        let first = self.shape.iter().position(|side| *side != 1);
        self.shape
            .get(first.unwrap_or(self.shape.len())..)
            .unwrap_or_default()
    }

    /// "1 x 3 x 64 x 64"
    pub(super) fn words(&self) -> String {
        let sides: Vec<String> = self.shape.iter().map(usize::to_string).collect();
        sides.join(" x ")
    }

    /// The pictures that it is made of: how many, their columns and rows, where one of channel, row and column lies, in
    /// steps. Rows and columns must be those of what the network saw, or the same times smaller in both.
    pub(super) fn pictures(&self, is_last: bool, seen: [usize; 2]) -> Option<Pictures> {
        // Of one picture after the other the first.
        let mut sides = self.shape.as_slice();
        while sides.len() > 3 {
            let (first, rest) = sides.split_first()?;
            if *first != 1 {
                // N pictures of one channel.
                let [count, 1, rows, columns] = *sides else {
                    return None;
                };
                return Pictures::new(count, rows, columns, false).filter(|of| of.fit(seen));
            }
            sides = rest;
        }
        let pictures = match (sides, is_last) {
            (&[rows, columns], _) => Pictures::new(1, rows, columns, false),
            (&[count, rows, columns], false) | (&[rows, columns, count], true) => {
                Pictures::new(count, rows, columns, is_last)
            }
            _ => None,
        };
        pictures.filter(|of| of.fit(seen) && of.count * of.rows * of.columns <= self.values.len())
    }

    fn at(&self, of: &Pictures, channel: usize, place: usize) -> f32 {
        let place = match of.is_last {
            true => place * of.count + channel,
            false => channel * of.rows * of.columns + place,
        };
        self.values.get(place).copied().unwrap_or(0.0)
    }

    /// Why one of its pictures cannot be what the description says: what it gives, and what to do.
    pub(super) fn no_chances(
        &self,
        of: &Pictures,
        channel: usize,
        values: Values,
    ) -> Option<(String, &'static str)> {
        let at = |channel: usize, place: usize| self.at(of, channel, place);
        let places = || 0..of.rows * of.columns;
        let is_number = |channel: usize| places().all(|place| at(channel, place).is_finite());
        let channels = match values {
            Values::Softmax => 0..of.count,
            _ => channel..channel + 1,
        };
        if !channels.clone().all(is_number) {
            let what = "values that are no numbers (NaN, or infinite)".to_owned();
            return Some((
                what,
                "look at the model, and at mean, std and white in its description",
            ));
        }
        let most = match values {
            Values::Logits => return None,
            Values::Softmax if of.count == 1 => {
                let what = "one channel alone, over which softmax is 1 everywhere".to_owned();
                return Some((what, "say values = \"logits\" in the description"));
            }
            Values::Softmax => return None,
            Values::Probability => 1.0,
            Values::Bytes => 255.0,
        };
        let extent = places().map(|place| at(channel, place));
        let (low, high) = extent.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        // Rounding, and upsampling by cubics, go a little beyond.
        let beyond = 0.05 * most;
        (low < -beyond || high > most + beyond).then(|| {
            let what = format!("{low:.4} to {high:.4}, and not 0 to {most}");
            (what, "say in the description which values they are: \"logits\", \"softmax\" or \"bytes\"")
        })
    }

    /// One of its pictures, as chances of 0 to 1, row by row.
    pub(super) fn chances(&self, of: &Pictures, channel: usize, values: Values) -> Vec<f32> {
        let at = |channel: usize, place: usize| self.at(of, channel, place);
        let chance = |place: usize| {
            let own = at(channel, place);
            let chance = match values {
                Values::Probability => own,
                Values::Logits => sigmoid(own),
                Values::Bytes => own / 255.0,
                Values::Softmax => {
                    let most = (0..of.count).map(|other| at(other, place));
                    let most = most.fold(f32::NEG_INFINITY, f32::max);
                    let sum: f32 = (0..of.count)
                        .map(|other| (at(other, place) - most).exp())
                        .sum();
                    (own - most).exp() / sum
                }
            };
            // What is no number is no fragment's border, nor anything else.
            if chance.is_nan() {
                0.0
            } else {
                chance.clamp(0.0, 1.0)
            }
        };
        (0..of.rows * of.columns).map(chance).collect()
    }
}

pub(super) fn sigmoid(value: f32) -> f32 {
    1.0 / (1.0 + (-value).exp())
}

/// A fragment in a part, or in a picture of it of other size.
pub(super) struct Mask {
    /// Columns and rows of the picture.
    pub(super) of: [usize; 2],
    /// Those that the mask is of; nothing lies outside.
    pub(super) columns: Range<usize>,
    pub(super) rows: Range<usize>,
    /// Row by row of those: above a half within the fragment.
    pub(super) chances: Vec<f32>,
    /// How sure it is.
    pub(super) score: f64,
}

impl Mask {
    /// At the size of what was seen, where that is a multiple of its picture's.
    pub(super) fn enlarged(self, seen: [usize; 2]) -> Self {
        let by = seen[0] / self.of[0].max(1);
        if by < 2 || self.of.map(|side| side * by) != seen {
            return self;
        }
        let from = (self.columns.len(), self.rows.len());
        let larger = |of: &Range<usize>| of.start * by..of.end * by;
        Self {
            of: seen,
            columns: larger(&self.columns),
            rows: larger(&self.rows),
            chances: enlarged_part(&self.chances, from, (from.0 * by, from.1 * by)),
            score: self.score,
        }
    }
}

/// The fragments of an image of numbers, of which 0 is none.
pub(super) fn of_labels(labels: &Numbers, of: &Pictures, channel: usize) -> Vec<Mask> {
    let mut places: BTreeMap<u32, Vec<[usize; 2]>> = BTreeMap::new();
    for row in 0..of.rows {
        for column in 0..of.columns {
            let number = labels.at(of, channel, row * of.columns + column);
            // What is no number is none's.
            if number >= 0.5 {
                places
                    .entry(number.round() as u32)
                    .or_default()
                    .push([column, row]);
            }
        }
    }
    let masks = places.into_values().map(|places| {
        let extent = |side: usize| {
            let along = places.iter().map(|place| place[side]);
            let first = along.clone().min().unwrap_or(0);
            first..along.max().map_or(0, |last| last + 1)
        };
        let (columns, rows) = (extent(0), extent(1));
        let mut chances = vec![0.0; columns.len() * rows.len()];
        for [column, row] in &places {
            chances[(row - rows.start) * columns.len() + column - columns.start] = 1.0;
        }
        Mask {
            of: [of.columns, of.rows],
            columns,
            rows,
            chances,
            score: 1.0,
        }
    });
    masks.collect()
}

/// YOLO's segmentation (Ultralytics, versions 5 to 11): for each of many places a column of the box's middle, its width and
/// height in pixels, a score for each class and a weight for each prototype; the mask is the sigmoid of the weighted sum
/// of prototypes, within the box. `None` where the shapes are others.
pub(super) fn of_detections<'a>(
    detections: &'a Numbers,
    prototypes: &'a Numbers,
    seen: [usize; 2],
    least: f64,
) -> Option<impl Iterator<Item = Mask> + use<'a>> {
    let pictures = prototypes.pictures(false, seen)?;
    let &[rows, places] = detections.sides() else {
        return None;
    };
    let classes = rows
        .checked_sub(4 + pictures.count)
        .filter(|classes| *classes > 0)?;
    let at = move |row: usize, place: usize| {
        let value = detections.values.get(row * places + place);
        value.copied().unwrap_or(0.0)
    };
    let mut boxes: Vec<(f32, [f32; 4], usize)> = Vec::new();
    for place in 0..places {
        let score = (4..4 + classes).fold(0.0, |most: f32, row| most.max(at(row, place)));
        if f64::from(score) < least {
            continue;
        }
        let [x, y] = [at(0, place), at(1, place)];
        let [across, down] = [at(2, place) / 2.0, at(3, place) / 2.0];
        boxes.push((score, [x - across, y - down, x + across, y + down], place));
    }
    boxes.sort_by(|a, b| b.0.total_cmp(&a.0));
    // Many places see the same fragment: of boxes that share most the best one stays.
    let mut kept: Vec<(f32, [f32; 4], usize)> = Vec::new();
    for one in boxes {
        if kept.len() == MOST_DETECTIONS {
            break;
        }
        if !kept.iter().any(|other| shared(&one.1, &other.1) > SAME_BOX) {
            kept.push(one);
        }
    }
    let scale = pictures.columns as f32 / seen[0] as f32;
    let masks = kept.into_iter().map(move |(score, edges, place)| {
        // A pixel belongs to a box where its middle does; casts of floats end at the limits of their type.
        let [left, top, right, bottom] = edges.map(|edge| (edge * scale).round() as usize);
        let columns = left.min(pictures.columns)..right.min(pictures.columns);
        let rows = top.min(pictures.rows)..bottom.min(pictures.rows);
        let weights: Vec<f32> = (0..pictures.count)
            .map(|kind| at(4 + classes + kind, place))
            .collect();
        let pixels = rows.clone().flat_map(|row| {
            let columns = columns.clone();
            columns.map(move |column| row * pictures.columns + column)
        });
        let chances = pixels.map(|pixel| {
            let of = |(kind, weight): (usize, &f32)| weight * prototypes.at(&pictures, kind, pixel);
            sigmoid(weights.iter().enumerate().map(of).sum())
        });
        Mask {
            of: [pictures.columns, pictures.rows],
            chances: chances.collect(),
            columns,
            rows,
            score: f64::from(score),
        }
    });
    Some(masks)
}

/// What two boxes share, of both together.
fn shared(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let area = |of: &[f32; 4]| (of[2] - of[0]).max(0.0) * (of[3] - of[1]).max(0.0);
    let both = [
        a[0].max(b[0]),
        a[1].max(b[1]),
        a[2].min(b[2]),
        a[3].min(b[3]),
    ];
    let both = area(&both);
    both / (area(a) + area(b) - both).max(f32::MIN_POSITIVE)
}

/// How pictures lie in a tensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pictures {
    pub(super) count: usize,
    pub(super) rows: usize,
    pub(super) columns: usize,
    is_last: bool,
}

impl Pictures {
    fn new(count: usize, rows: usize, columns: usize, is_last: bool) -> Option<Self> {
        (rows > 0 && columns > 0).then_some(Self {
            count,
            rows,
            columns,
            is_last,
        })
    }

    /// Whether they are of what was seen: of its sides, or both the same times smaller or larger.
    fn fit(&self, [columns, rows]: [usize; 2]) -> bool {
        self.columns * rows == self.rows * columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(shape: &[usize]) -> Numbers {
        let count: usize = shape.iter().product();
        Numbers {
            shape: shape.to_vec(),
            values: (0..count).map(|value| value as f32).collect(),
        }
    }

    #[test]
    fn shapes_tell_pictures() {
        let of = |shape: &[usize], is_last| {
            let found = numbers(shape).pictures(is_last, [8, 4])?;
            Some((found.count, found.rows, found.columns))
        };
        assert_eq!(of(&[1, 3, 4, 8], false), Some((3, 4, 8)));
        assert_eq!(of(&[1, 4, 8, 3], true), Some((3, 4, 8)));
        assert_eq!(of(&[7, 1, 2, 4], false), Some((7, 2, 4)));
        assert_eq!(of(&[4, 8], false), Some((1, 4, 8)));
        assert_eq!(of(&[0, 4, 8], false), Some((0, 4, 8)));
        for (shape, is_last) in [
            (&[1, 3, 8, 4][..], false),
            (&[2, 3, 4, 8], false),
            (&[12], false),
            (&[3, 0, 8], false),
            (&[], false),
        ] {
            assert_eq!(of(shape, is_last), None, "{shape:?}");
        }
    }

    /// As a newcomer found: logits that are not said to be some passed for chances, and took P80 half as large again.
    #[test]
    fn what_is_no_chance_is_said() {
        let said = |shape: [usize; 3], values: &[f32], of: Values| {
            let numbers = Numbers {
                shape: shape.to_vec(),
                values: values.to_vec(),
            };
            let pictures = numbers.pictures(false, [2, 1]).unwrap();
            numbers.no_chances(&pictures, 0, of).map(|(what, _)| what)
        };
        let one = |values: [f32; 2], of| said([1, 1, 2], &values, of);
        assert_eq!(one([0.0, 1.0], Values::Probability), None);
        assert_eq!(one([-0.02, 1.01], Values::Probability), None);
        let logits = one([-9.25, 9.5], Values::Probability).unwrap();
        assert_eq!(logits, "-9.2500 to 9.5000, and not 0 to 1");
        assert_eq!(one([-9.25, 9.5], Values::Logits), None);
        assert_eq!(one([0.0, 255.0], Values::Bytes), None);
        assert!(one([0.0, 300.0], Values::Bytes).is_some());
        assert!(
            one([0.5, f32::NAN], Values::Logits)
                .unwrap()
                .contains("NaN")
        );
        assert!(
            one([0.5, 0.5], Values::Softmax)
                .unwrap()
                .contains("1 everywhere")
        );
        assert_eq!(
            said([2, 1, 2], &[1.0, 2.0, 3.0, 4.0], Values::Softmax),
            None
        );
        let other = [1.0, 2.0, f32::INFINITY, 4.0];
        assert!(said([2, 1, 2], &other, Values::Softmax).is_some());
        assert_eq!(said([2, 1, 2], &other, Values::Logits), None);
    }

    #[test]
    fn values_are_chances() {
        let of = Numbers {
            shape: vec![2, 1, 2],
            values: vec![0.0, 2.0, 0.0, f32::NAN],
        };
        let pictures = of.pictures(false, [2, 1]).unwrap();
        let first = |values| of.chances(&pictures, 0, values);
        assert_eq!(first(Values::Probability), [0.0, 1.0]);
        let e2 = 2f32.exp();
        assert!((first(Values::Logits)[1] - e2 / (e2 + 1.0)).abs() < 1e-6);
        assert_eq!(first(Values::Softmax)[0], 0.5);
        assert_eq!(first(Values::Bytes)[1], 2.0 / 255.0);
        assert_eq!(of.chances(&pictures, 1, Values::Logits)[1], 0.0);
    }
}
