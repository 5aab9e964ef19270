//! Whether a JPEG is whole: its compressed data are walked from code to code (ITU-T T.81, sequential
//! and progressive with Huffman codes) beside the decoder, which shows what it got and is silent.
//!
//! Whole is: every code exists, every block has its 64 numbers, the blocks are as many as the size
//! asks for and the data end there, restart markers come in their order, no block's mean leaves what
//! pixels can be. Allowed is what cameras and editors write: bytes behind the end marker, no end
//! marker behind complete data, padding of ones or zeros, fill bytes in front of markers.
//!
//! How much it finds: see the numbers in the module's header.

use super::codes::{Bits, Codes, Damage};
use super::scan::{Component, Part, Place, Scan};
use crate::fault::Fault;

const REMEDY: &str = "copy the photo again from the camera or its backup";

/// The quantisation and Huffman tables as they stand where a scan begins.
#[derive(Default)]
struct Tables {
    /// The step of the blocks' means.
    steps: [i32; 4],
    dc: [Option<Codes>; 4],
    ac: [Option<Codes>; 4],
    restart: u32,
}

#[derive(Default)]
struct Frame {
    progressive: bool,
    components: Vec<Component>,
    mcus: (u32, u32),
}

/// Walks the JPEG; whether an end marker stands behind its data. Kinds that are not known here (arithmetic codes, lossless, 12 bits) pass: the
/// decoder refuses them by name.
///
/// # Errors
/// Where it is damaged or cut off, with how far it is whole.
pub(super) fn check(bytes: &[u8]) -> Result<bool, Fault> {
    let mut tables = Tables::default();
    let mut frame: Option<Frame> = None;
    let mut at = 2;
    loop {
        // Fill bytes.
        while let Some([0xff, 0xff, ..]) = bytes.get(at..) {
            at += 1;
        }
        let (marker, segment) = match bytes.get(at..) {
            Some([0xff, 0xd9, ..]) => return finished(frame.as_ref(), true),
            // A restart marker behind the last interval, and what has no length.
            Some([0xff, 0..=1 | 0xd0..=0xd8, ..]) => {
                at += 2;
                continue;
            }
            Some([0xff, marker, high, low, ..]) => {
                let length = usize::from(u16::from_be_bytes([*high, *low]));
                match bytes.get(at + 4..at + 2 + length) {
                    Some(segment) if length >= 2 => (*marker, segment),
                    _ => return finished(frame.as_ref(), false),
                }
            }
            Some([0xff] | []) | None => return finished(frame.as_ref(), false),
            // Bytes between segments, as libjpeg passes them.
            Some(_) => {
                at += 1;
                continue;
            }
        };
        at += 4 + segment.len();
        match marker {
            0xdb => quantisation(segment, &mut tables),
            0xc4 => huffman(segment, &mut tables).ok_or_else(|| broken_header(at))?,
            0xdd => tables.restart = read_u16(segment, 0).unwrap_or(0),
            0xc0..=0xc2 => match start_of_frame(segment, marker == 0xc2) {
                Some(new) if frame.is_none() => frame = Some(new),
                // 12 bits, or what the decoder will refuse.
                _ => return Ok(true),
            },
            0xc3 | 0xc5..=0xcf => return Ok(true),
            0xda => {
                let frame = frame.as_mut().ok_or_else(|| broken_header(at))?;
                let scan = start_of_scan(segment, frame, &tables);
                let scan = scan.ok_or_else(|| broken_header(at))?;
                let mut bits = Bits::new(bytes, at);
                let walked = scan.walk(&mut frame.components, &mut bits);
                let is_end = bytes.len() - bits.at().min(bytes.len()) < 2;
                walked.map_err(|(damage, place)| damaged(damage, is_end, place))?;
                note(&scan, &mut frame.components);
                at = bits.at();
            }
            _ => {}
        }
    }
}

/// At the end marker, or at the end of a file that has none; which of these it is.
fn finished(frame: Option<&Frame>, has_marker: bool) -> Result<bool, Fault> {
    let Some(frame) = frame else {
        return Err(Fault::new("the JPEG ends within its header", REMEDY));
    };
    // With an end marker, what was never stored was left out on purpose, except the means.
    let is_whole = |component: &Component| match has_marker {
        true => component.stored.first().is_some_and(Option::is_some),
        false => component.is_whole(),
    };
    match frame.components.iter().all(is_whole) {
        true => Ok(has_marker),
        false => Err(Fault::new(
            "the JPEG is cut off: it ends before its picture does",
            REMEDY,
        )),
    }
}

/// Of a scan; `is_end` where the file ends there.
fn damaged(damage: Damage, is_end: bool, (done, all): Place) -> Fault {
    let percent = 100 * done / all.max(1);
    let what = match (damage, is_end) {
        (Damage::Early, true) => format!("the JPEG is cut off at {percent} % of its picture"),
        _ => format!(
            "the JPEG is damaged, noticed at {percent} % of its picture: {}",
            damage.in_words()
        ),
    };
    Fault::new(what, REMEDY)
}

fn broken_header(at: usize) -> Fault {
    Fault::new(
        format!("the JPEG is damaged: its header is broken before byte {at}"),
        REMEDY,
    )
}

fn read_u16(bytes: &[u8], at: usize) -> Option<u32> {
    let &[high, low] = bytes.get(at..at + 2)?.first_chunk()?;
    Some(u16::from_be_bytes([high, low]).into())
}

/// B.2.4.1. Of each table only the first step is used here.
fn quantisation(mut segment: &[u8], tables: &mut Tables) {
    while let [head, rest @ ..] = segment {
        let wide = head >> 4 != 0;
        let step = match (wide, rest) {
            (true, [high, low, ..]) => i32::from(u16::from_be_bytes([*high, *low])),
            (false, [step, ..]) => i32::from(*step),
            _ => return,
        };
        tables.steps[usize::from(head & 3)] = step;
        segment = rest.get(if wide { 128 } else { 64 }..).unwrap_or_default();
    }
}

/// B.2.4.2.
fn huffman(mut segment: &[u8], tables: &mut Tables) -> Option<()> {
    while let [head, rest @ ..] = segment {
        let counts = rest.first_chunk::<16>()?;
        let all: usize = counts.iter().map(|&count| usize::from(count)).sum();
        let codes = Codes::new(counts, rest.get(16..16 + all)?)?;
        let tables = match head >> 4 {
            0 => &mut tables.dc,
            _ => &mut tables.ac,
        };
        tables[usize::from(head & 3)] = Some(codes);
        segment = &rest[16 + all..];
    }
    Some(())
}

/// B.2.2; `None` where it is no frame of 8 bits.
fn start_of_frame(segment: &[u8], progressive: bool) -> Option<Frame> {
    let (height, width) = (read_u16(segment, 1)?, read_u16(segment, 3)?);
    let [8, .., count] = *segment.first_chunk::<6>()? else {
        return None;
    };
    let entries = segment.get(6..)?.as_chunks::<3>().0;
    let entries = entries
        .get(..usize::from(count))
        .filter(|e| !e.is_empty())?;
    let sampling =
        |[_, sampling, _]: &[u8; 3]| (u32::from(sampling >> 4), u32::from(sampling & 15));
    let across_most = entries.iter().map(|entry| sampling(entry).0).max()?;
    let down_most = entries.iter().map(|entry| sampling(entry).1).max()?;
    let valid = entries.iter().map(sampling);
    if width == 0
        || height == 0
        || !valid
            .clone()
            .all(|(h, v)| (1..=4).contains(&h) && (1..=4).contains(&v))
    {
        return None;
    }
    let mcus = (
        width.div_ceil(8 * across_most),
        height.div_ceil(8 * down_most),
    );
    let component = |entry: &[u8; 3]| {
        let (across, down) = sampling(entry);
        let padded = (mcus.0 * across, mcus.1 * down);
        let blocks = padded.0 as usize * padded.1 as usize;
        Component {
            id: entry[0],
            across,
            down,
            table: usize::from(entry[2] & 3),
            own: (
                (width * across).div_ceil(across_most).div_ceil(8),
                (height * down).div_ceil(down_most).div_ceil(8),
            ),
            padded,
            set: if progressive {
                vec![0; blocks]
            } else {
                Vec::new()
            },
            stored: vec![None; 64],
        }
    };
    Some(Frame {
        progressive,
        components: entries.iter().map(component).collect(),
        mcus,
    })
}

/// B.2.3.
fn start_of_scan<'a>(segment: &[u8], frame: &Frame, tables: &'a Tables) -> Option<Scan<'a>> {
    let (&count, rest) = segment.split_first()?;
    let count = usize::from(count);
    let (entries, rest) = rest.split_at_checked(2 * count)?;
    let &[first, last, bits] = rest.first_chunk()?;
    let part = |&[id, chosen]: &[u8; 2]| {
        let component = frame.components.iter().position(|c| c.id == id)?;
        let of = &frame.components[component];
        // A sequential component comes once.
        if !frame.progressive && of.stored.first().is_some_and(Option::is_some) {
            return None;
        }
        Some(Part {
            component,
            dc: tables.dc[usize::from(chosen >> 4 & 3)].as_ref(),
            ac: tables.ac[usize::from(chosen & 3)].as_ref(),
            step: tables.steps[of.table],
        })
    };
    let parts: Option<Vec<Part<'a>>> = entries.as_chunks::<2>().0.iter().map(part).collect();
    let parts = parts.filter(|parts| (1..=4).contains(&parts.len()))?;
    let (first, last, high, low) = match frame.progressive {
        true => (usize::from(first), usize::from(last), bits >> 4, bits & 15),
        false => (0, 63, 0, 0),
    };
    let band_fits = last < 64 && first <= last && low < 14;
    let means_alone = first > 0 || last == 0 || !frame.progressive;
    let numbers_alone = first == 0 || parts.len() == 1;
    (band_fits && means_alone && numbers_alone).then_some(Scan {
        parts,
        progressive: frame.progressive,
        first,
        last,
        high,
        low,
        restart: tables.restart,
        mcus: frame.mcus,
    })
}

/// Which bits of which numbers are there now.
fn note(scan: &Scan<'_>, components: &mut [Component]) {
    for part in &scan.parts {
        if let Some(component) = components.get_mut(part.component) {
            for stored in component
                .stored
                .iter_mut()
                .take(scan.last + 1)
                .skip(scan.first)
            {
                *stored = Some(scan.low);
            }
        }
    }
}
