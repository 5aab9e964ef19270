//! The header of a PCD file: its lines up to and with `DATA`.

use crate::fault::Fault;
use crate::text::fields::{Fields, shown};

const REMEDY: &str = "export it again as PCD 0.7";

/// How the points are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Storage {
    /// One line a point.
    Ascii,
    /// One record a point.
    Binary,
    /// LZF of all values of the first field, then all of the second ...
    Compressed,
}

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Float,
    Signed,
    Unsigned,
}

/// A field of every point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    /// Of one value, in bytes: 1, 2, 4 or 8.
    pub(super) size: usize,
    pub(super) kind: Kind,
    /// How many values it has.
    pub(super) count: usize,
}

impl Field {
    /// In a record, in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.size * self.count
    }

    /// The first value of the field, whose bytes begin `bytes`.
    pub(super) fn value(&self, bytes: &[u8]) -> Option<f64> {
        let raw = |size: usize| {
            let mut raw = [0; 8];
            raw.get_mut(..size)?.copy_from_slice(bytes.get(..size)?);
            Some(u64::from_le_bytes(raw))
        };
        Some(match (self.kind, self.size) {
            (Kind::Float, 4) => f64::from(f32::from_bits(raw(4)? as u32)),
            (Kind::Float, 8) => f64::from_bits(raw(8)?),
            (Kind::Unsigned, size @ (1 | 2 | 4 | 8)) => raw(size)? as f64,
            (Kind::Signed, size @ (1 | 2 | 4 | 8)) => {
                // The sign bit moves to the top and comes down again.
                let shift = 64 - 8 * size as u32;
                (raw(size)? << shift).cast_signed().wrapping_shr(shift) as f64
            }
            _ => return None,
        })
    }
}

/// What the header says.
#[derive(Debug, PartialEq)]
pub(super) struct Header {
    pub(super) fields: Vec<Field>,
    pub(super) points: u64,
    pub(super) storage: Storage,
    /// Translation x y z and quaternion w x y z of the sensor.
    pub(super) viewpoint: Option<[f64; 7]>,
}

impl Header {
    /// Collects header lines, given with their numbers; `None` from `next_line` ends them too early.
    ///
    /// # Errors
    /// Where an entry is missing, malformed or contradicts another.
    pub(super) fn read(
        mut next_line: impl FnMut() -> Result<Option<(u64, String)>, Fault>,
    ) -> Result<Self, Fault> {
        let mut names: Vec<String> = Vec::new();
        let mut sizes: Vec<usize> = Vec::new();
        let mut kinds: Vec<Kind> = Vec::new();
        let mut counts: Option<Vec<usize>> = None;
        let (mut width, mut height, mut points) = (None, None, None);
        let mut viewpoint = None;
        let storage = loop {
            let Some((number, line)) = next_line()? else {
                return Err(Fault::new("its header has no DATA line", REMEDY));
            };
            let mut fields = Fields::new(number, &line, REMEDY);
            if fields.rest().is_empty() || fields.rest().starts_with('#') {
                continue;
            }
            match fields.word("a keyword")? {
                // Before 0.6 they were called columns.
                "FIELDS" | "COLUMNS" => {
                    names = fields
                        .rest()
                        .split_whitespace()
                        .map(str::to_owned)
                        .collect();
                }
                "SIZE" => {
                    while !fields.rest().is_empty() {
                        let size = fields.whole("the size")?;
                        if ![1, 2, 4, 8].contains(&size) {
                            return Err(fields.fault(format!("a field has values of {size} bytes")));
                        }
                        sizes.push(size);
                    }
                }
                "TYPE" => {
                    while !fields.rest().is_empty() {
                        kinds.push(match fields.word("the type")? {
                            "F" | "f" => Kind::Float,
                            "I" | "i" => Kind::Signed,
                            "U" | "u" => Kind::Unsigned,
                            other => {
                                let other = shown(other);
                                return Err(fields.fault(format!("a field has the type '{other}'")));
                            }
                        });
                    }
                }
                "COUNT" => {
                    let mut all = Vec::new();
                    while !fields.rest().is_empty() {
                        // A histogram has some hundred.
                        let count: u32 = fields.whole("the count")?;
                        all.push(count.min(1 << 24) as usize);
                    }
                    counts = Some(all);
                }
                "WIDTH" => width = Some(fields.whole::<u64>("the width")?),
                "HEIGHT" => height = Some(fields.whole::<u64>("the height")?),
                "POINTS" => points = Some(fields.whole::<u64>("the number of points")?),
                "VIEWPOINT" => {
                    let mut pose = [0.0; 7];
                    for value in &mut pose {
                        *value = fields.number("the viewpoint")?;
                    }
                    viewpoint = Some(pose);
                }
                "DATA" => match fields.word("the storage")?.to_ascii_lowercase().as_str() {
                    "ascii" => break Storage::Ascii,
                    "binary" => break Storage::Binary,
                    "binary_compressed" => break Storage::Compressed,
                    other => {
                        let other = shown(other);
                        return Err(fields.fault(format!("its data is '{other}'")));
                    }
                },
                // PCL passes over what it does not know, too.
                _ => {}
            }
        };
        let counts = counts.unwrap_or_else(|| vec![1; names.len()]);
        if names.is_empty() {
            return Err(Fault::new("its header has no FIELDS line", REMEDY));
        }
        if [sizes.len(), kinds.len(), counts.len()] != [names.len(); 3] {
            return Err(Fault::new(
                format!(
                    "its header has {} fields, but {} sizes, {} types and {} counts",
                    names.len(),
                    sizes.len(),
                    kinds.len(),
                    counts.len()
                ),
                REMEDY,
            ));
        }
        let of_grid = width.map(|width| width.saturating_mul(height.unwrap_or(1)));
        let points = match (points, of_grid) {
            (Some(points), Some(of_grid)) if points != of_grid => {
                return Err(Fault::new(
                    format!("its header has {points} points, but WIDTH x HEIGHT are {of_grid}"),
                    REMEDY,
                ));
            }
            (Some(points), _) | (None, Some(points)) => points,
            (None, None) => {
                return Err(Fault::new("its header has no number of points", REMEDY));
            }
        };
        let fields = names
            .into_iter()
            .zip(sizes)
            .zip(kinds.into_iter().zip(counts))
            .map(|((name, size), (kind, count))| Field {
                name,
                size,
                kind,
                count,
            })
            .collect();
        Ok(Self {
            fields,
            points,
            storage,
            viewpoint,
        })
    }

    /// Of a record, in bytes.
    pub(super) fn record(&self) -> usize {
        self.fields.iter().map(Field::bytes).sum()
    }
}
