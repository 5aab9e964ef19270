//! PCD, the Point Cloud Library's format: "The PCD (Point Cloud Data) file format",
//! pointclouds.org, versions 0.5 to 0.7, and `pcd_io.cpp` where that is silent.
//!
//! - A header of text lines: `FIELDS` with `SIZE`, `TYPE` (F, I, U) and `COUNT` of each, `WIDTH` x
//!   `HEIGHT` = `POINTS`, then `DATA ascii`, `binary` (little-endian records), or
//!   `binary_compressed` (two u32, the compressed and the full length, then LZF of one array a field).
//! - A field called `_` is padding; compressed data has none.
//! - `rgb` and `rgba` pack 0x00RRGGBB into four bytes, which the type F calls a float; `r`, `g`, `b`
//!   (or `red` ...) may stand alone.
//! - Organised clouds mark missing points with NaN: those are left out and counted.
//! - `VIEWPOINT` is where the sensor was. PCL does not move the points by it, and neither is it done
//!   here; a warning says so where it is not the origin.

mod header;
mod lzf;

use std::io::BufRead;

use glam::DVec3;

use crate::clouds::cloud_file::CloudFile;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::text::fields::shown;
use header::{Field, Header, Kind, Storage};

const REMEDY: &str = "copy or export it again";

/// Reads a PCD file of `size` bytes.
///
/// # Errors
/// Where the header is malformed, the points are fewer or more than it says, or there is none.
pub(crate) fn read(
    mut input: impl BufRead,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut line = 0;
    let header = Header::read(|| {
        line += 1;
        Ok(next_line(&mut input, line)?.map(|text| (line, text)))
    })?;
    let layout = Layout::of(&header)?;
    if header.points == 0 {
        return Err(Fault::new("it has no points", "export some"));
    }
    let mut points = Points {
        file: CloudFile::default(),
        left_out: 0,
    };
    match header.storage {
        Storage::Ascii => read_ascii(&mut input, line, &header, &layout, &mut points, progress)?,
        Storage::Binary => {
            let record = header.record();
            expect_room(&header, record, size)?;
            let mut bytes = vec![0; record];
            for index in 0..header.points {
                if index % 65_536 == 0 {
                    progress.advance(index, header.points)?;
                }
                input.read_exact(&mut bytes).map_err(|e| {
                    let what = format!("it ends after {index} of {} points ({e})", header.points);
                    Fault::new(what, REMEDY)
                })?;
                points.add(layout.point(|place| bytes.get(place.offset..)));
            }
        }
        Storage::Compressed => {
            let arrays = decompressed(&mut input, &header)?;
            for index in 0..header.points as usize {
                if index % 65_536 == 0 {
                    progress.advance(index as u64, header.points)?;
                }
                points.add(layout.point(|place| {
                    arrays.get(place.array * header.points as usize + index * place.field.bytes()..)
                }));
            }
        }
    }
    let Points { mut file, left_out } = points;
    file.expect_points()?;
    file.say_missing(left_out, header.points);
    if layout.floats && header.storage != Storage::Ascii {
        file.warn_if_rounded();
    }
    if let Some(pose) = header.viewpoint
        && (pose[..3] != [0.0; 3] || pose[4..] != [0.0; 3])
    {
        let words = pose.map(|value| value.to_string()).join(" ");
        file.warnings.push(format!(
            "its VIEWPOINT ({words}) is not applied to the points, as in PCL"
        ));
    }
    Ok(file)
}

/// A header line; binary data follows the last one, so no more than it is read.
fn next_line(input: &mut impl BufRead, line: u64) -> Result<Option<String>, Fault> {
    use std::io::Read;
    let mut bytes = Vec::new();
    input
        .by_ref()
        .take(1 << 20)
        .read_until(b'\n', &mut bytes)
        .map_err(|e| Fault::at(line, format!("it cannot be read ({e})"), "check the disk"))?;
    if bytes.is_empty() {
        return Ok(None);
    }
    let text = String::from_utf8_lossy(&bytes);
    Ok(Some(text.trim_start_matches('\u{feff}').trim().to_owned()))
}

/// Whether the file can hold what the header promises.
fn expect_room(header: &Header, record: usize, size: u64) -> Result<(), Fault> {
    let needed = u128::from(header.points) * record as u128;
    if needed > u128::from(size) {
        return Err(Fault::new(
            format!(
                "its header promises {} points of {record} bytes, but the file has {size} bytes",
                header.points
            ),
            REMEDY,
        ));
    }
    Ok(())
}

/// The arrays of compressed data, one behind the other.
fn decompressed(input: &mut impl BufRead, header: &Header) -> Result<Vec<u8>, Fault> {
    use std::io::Read;
    let damaged = || Fault::new("its compressed points are damaged or cut off", REMEDY);
    let mut length = || {
        let mut bytes = [0; 4];
        input.read_exact(&mut bytes).map_err(|_| damaged())?;
        Ok(u32::from_le_bytes(bytes))
    };
    let (compressed, full) = (length()?, length()?);
    let padding = |field: &&Field| field.name != "_";
    let record: usize = header.fields.iter().filter(padding).map(Field::bytes).sum();
    if u128::from(header.points) * record as u128 != u128::from(full) {
        return Err(Fault::new(
            format!(
                "its header promises {} points of {record} bytes, but {full} bytes are stored",
                header.points
            ),
            REMEDY,
        ));
    }
    let mut data = Vec::new();
    input
        .take(u64::from(compressed))
        .read_to_end(&mut data)
        .map_err(|_| damaged())?;
    if data.len() != compressed as usize {
        return Err(damaged());
    }
    lzf::decompress(&data, full as usize).ok_or_else(damaged)
}

fn read_ascii(
    input: &mut impl BufRead,
    mut line: u64,
    header: &Header,
    layout: &Layout,
    points: &mut Points,
    progress: &Progress,
) -> Result<(), Fault> {
    let columns: usize = header.fields.iter().map(|field| field.count).sum();
    let mut read = 0;
    while let Some(text) = next_line(input, line + 1)? {
        line += 1;
        if text.is_empty() {
            continue;
        }
        if read == header.points {
            return Err(Fault::at(
                line,
                format!("it goes on behind the {read} points that its header promises"),
                REMEDY,
            ));
        }
        let words: Vec<&str> = text.split_whitespace().collect();
        if words.len() != columns {
            let what = format!("a point has {} values instead of {columns}", words.len());
            return Err(Fault::at(line, what, REMEDY));
        }
        let number = |place: &Place| {
            let word = words.get(place.column).copied().unwrap_or_default();
            word.parse::<f64>().map_err(|_| {
                let what = format!("'{}' is not a number", shown(word));
                Fault::at(line, what, REMEDY)
            })
        };
        let [x, y, z] = &layout.position;
        let position = DVec3::new(number(x)?, number(y)?, number(z)?);
        let color = match &layout.color {
            None => None,
            Some(Color::Packed(place)) => {
                let value = number(place)?;
                Some(unpack(match place.field.kind {
                    Kind::Float => (value as f32).to_bits(),
                    Kind::Signed => (value as i32).cast_unsigned(),
                    Kind::Unsigned => value as u32,
                }))
            }
            Some(Color::Separate([r, g, b])) => Some([
                r.channel(number(r)?),
                g.channel(number(g)?),
                b.channel(number(b)?),
            ]),
        };
        points.add(Some((position, color)));
        read += 1;
        if read % 65_536 == 0 {
            progress.advance(read, header.points)?;
        }
    }
    if read < header.points {
        let what = format!("it ends after {read} of {} points", header.points);
        return Err(Fault::at(line, what, REMEDY));
    }
    Ok(())
}

fn unpack(packed: u32) -> [u8; 3] {
    let [_, r, g, b] = packed.to_be_bytes();
    [r, g, b]
}

/// The points so far.
struct Points {
    file: CloudFile,
    left_out: u64,
}

impl Points {
    fn add(&mut self, point: Option<(DVec3, Option<[u8; 3]>)>) {
        match point {
            Some((position, color)) if position.is_finite() => self.file.push(position, color),
            _ => self.left_out += 1,
        }
    }
}

/// Where a field stands.
struct Place {
    field: Field,
    /// Its first value on a line.
    column: usize,
    /// In a record, in bytes.
    offset: usize,
    /// What precedes its array in compressed data, in bytes a point.
    array: usize,
}

impl Place {
    /// A colour channel: whole numbers from 0 to 255, floats from 0 to 1.
    fn channel(&self, value: f64) -> u8 {
        // `as` saturates.
        match self.field.kind {
            Kind::Float => (value * 255.0).round() as u8,
            Kind::Signed | Kind::Unsigned => value as u8,
        }
    }
}

enum Color {
    Packed(Place),
    Separate([Place; 3]),
}

/// Which fields of a point are what.
struct Layout {
    position: [Place; 3],
    color: Option<Color>,
    /// Whether the coordinates are 32-bit floats.
    floats: bool,
}

impl Layout {
    fn of(header: &Header) -> Result<Self, Fault> {
        let find = |names: &[&str]| {
            let named = |field: &Field| {
                field.count > 0
                    && names
                        .iter()
                        .any(|name| field.name.eq_ignore_ascii_case(name))
            };
            let index = header.fields.iter().position(named)?;
            let before = header.fields.get(..index)?;
            let stored = before.iter().filter(|field| field.name != "_");
            Some(Place {
                field: header.fields.get(index)?.clone(),
                column: before.iter().map(|field| field.count).sum(),
                offset: before.iter().map(Field::bytes).sum(),
                array: stored.map(Field::bytes).sum(),
            })
        };
        let axis = |name: &str| {
            find(&[name]).ok_or_else(|| {
                Fault::new(
                    format!("its points have no field {name}"),
                    "export points with x, y and z",
                )
            })
        };
        let position = [axis("x")?, axis("y")?, axis("z")?];
        let channels = [
            find(&["r", "red"]),
            find(&["g", "green"]),
            find(&["b", "blue"]),
        ];
        let color = match (find(&["rgb", "rgba"]), channels) {
            (Some(place), _) if place.field.size == 4 => Some(Color::Packed(place)),
            (_, [Some(r), Some(g), Some(b)]) => Some(Color::Separate([r, g, b])),
            _ => None,
        };
        let is_float = |place: &Place| (place.field.kind, place.field.size) == (Kind::Float, 4);
        Ok(Self {
            floats: position.iter().any(is_float),
            position,
            color,
        })
    }

    /// A point of binary data; `bytes` gives what begins with a field.
    fn point<'a>(
        &self,
        bytes: impl Fn(&Place) -> Option<&'a [u8]>,
    ) -> Option<(DVec3, Option<[u8; 3]>)> {
        let value = |place: &Place| place.field.value(bytes(place)?);
        let [x, y, z] = &self.position;
        let position = DVec3::new(value(x)?, value(y)?, value(z)?);
        let color = match &self.color {
            None => None,
            Some(Color::Packed(place)) => {
                let packed = bytes(place)?.first_chunk::<4>()?;
                Some(unpack(u32::from_le_bytes(*packed)))
            }
            Some(Color::Separate([r, g, b])) => Some([
                r.channel(value(r)?),
                g.channel(value(g)?),
                b.channel(value(b)?),
            ]),
        };
        Some((position, color))
    }
}

#[cfg(test)]
mod tests;
