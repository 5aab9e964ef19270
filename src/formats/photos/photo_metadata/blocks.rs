//! Where an image file keeps its EXIF and XMP. Only headers are read, the pixels are jumped over.
//!
//! - JPEG (ITU-T T.81, annex B; XMP part 3, 1.1.3): segments up to the start of the scan. APP1 that
//!   begins with "Exif\0\0" holds a TIFF; with `http://ns.adobe.com/xap/1.0/\0` an XMP packet; with
//!   `http://ns.adobe.com/xmp/extension/\0` a part of an extended one: 32 letters of a name, its
//!   whole length and the part's place (4 bytes each, big-endian), the part. A segment has 65 533
//!   bytes at most. The start of a frame (SOF0 to SOF15) holds the image's size.
//! - PNG (W3C PNG 3, 11.3): chunk eXIf holds a TIFF; iTXt "XML:com.adobe.xmp" an XMP packet, which
//!   may not be compressed.
//!
//! TIFF files keep both anywhere between their pixels; they are not looked into.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, BufRead, Read, Seek, SeekFrom};

/// The longest PNG chunk and the longest extended XMP that are read, in bytes. Cameras write 64 kB.
const LONGEST: u64 = 8 << 20;

/// Letters in the name of an extended XMP.
const NAME: usize = 32;

/// The blocks that were found.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Blocks {
    /// Width and height of the image, where its header says so.
    pub(super) size: Option<(u32, u32)>,
    /// A TIFF with the EXIF directories.
    pub(super) exif: Option<Vec<u8>>,
    /// XMP packets; the standard one first.
    pub(super) xmp: Vec<Vec<u8>>,
    /// What could not be read.
    pub(super) warnings: Vec<String>,
}

/// Looks through the file's header.
pub(super) fn read(mut input: impl BufRead + Seek) -> Blocks {
    let mut blocks = Blocks::default();
    let mut start = [0; 8];
    if input.read_exact(&mut start).is_err() {
        return blocks;
    }
    let outcome = if start.starts_with(b"\xff\xd8") {
        input
            .seek(SeekFrom::Start(2))
            .and_then(|_| jpeg(&mut input, &mut blocks))
    } else if &start == b"\x89PNG\r\n\x1a\n" {
        png(&mut input, &mut blocks)
    } else {
        Ok(())
    };
    if let Err(error) = outcome {
        let warning = match error.kind() {
            io::ErrorKind::UnexpectedEof => "the image file ends in its header".to_owned(),
            _ => format!("the image's header cannot be read ({error})"),
        };
        blocks.warnings.push(warning);
    }
    blocks
}

fn byte(input: &mut impl Read) -> io::Result<u8> {
    let mut byte = [0];
    input.read_exact(&mut byte)?;
    let [byte] = byte;
    Ok(byte)
}

/// So many bytes; the memory grows with what is there, not with what is claimed.
fn bytes(input: &mut impl Read, count: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    input.by_ref().take(count).read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < count {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(bytes)
}

fn jpeg(input: &mut (impl BufRead + Seek), blocks: &mut Blocks) -> io::Result<()> {
    // Parts by the name of their packet and their place in it.
    let mut extended: BTreeMap<(Vec<u8>, u32), Vec<u8>> = BTreeMap::new();
    let mut extended_length = 0;
    loop {
        if byte(input)? != 0xff {
            blocks
                .warnings
                .push("the JPEG's segments do not follow one another".to_owned());
            break;
        }
        let mut marker = byte(input)?;
        while marker == 0xff {
            marker = byte(input)?;
        }
        match marker {
            // Start of the scan, end of the image.
            0xda | 0xd9 => break,
            // Markers that stand alone.
            0x01 | 0xd0..=0xd8 => continue,
            _ => {}
        }
        let length = u16::from_be_bytes([byte(input)?, byte(input)?]);
        let Some(length) = length.checked_sub(2) else {
            blocks
                .warnings
                .push("a JPEG segment claims less than its own length".to_owned());
            break;
        };
        // The start of a frame: the precision, then height and width.
        if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            let frame = bytes(input, u64::from(length))?;
            if let Some(&[_, h1, h0, w1, w0]) = frame.first_chunk() {
                let [height, width] = [[h1, h0], [w1, w0]].map(u16::from_be_bytes);
                blocks.size =
                    (width > 0 && height > 0).then_some((u32::from(width), u32::from(height)));
            }
            continue;
        }
        if marker != 0xe1 {
            input.seek_relative(i64::from(length))?;
            continue;
        }
        let segment = bytes(input, u64::from(length))?;
        if let Some(tiff) = segment.strip_prefix(b"Exif\0\0") {
            blocks.exif.get_or_insert_with(|| tiff.to_vec());
        } else if let Some(packet) = segment.strip_prefix(b"http://ns.adobe.com/xap/1.0/\0") {
            blocks.xmp.push(packet.to_vec());
        } else if let Some(part) = segment.strip_prefix(b"http://ns.adobe.com/xmp/extension/\0")
            && let (Some(name), Some(&[a, b, c, d]), Some(part)) =
                (part.get(..NAME), part.get(36..40), part.get(40..))
        {
            extended_length += part.len() as u64;
            if extended_length <= LONGEST {
                let place = u32::from_be_bytes([a, b, c, d]);
                extended.insert((name.to_vec(), place), part.to_vec());
            }
        }
    }
    join_extended(extended, blocks);
    Ok(())
}

/// Adds the extended packet that the standard one names.
fn join_extended(parts: BTreeMap<(Vec<u8>, u32), Vec<u8>>, blocks: &mut Blocks) {
    let names: BTreeSet<&[u8]> = parts.keys().map(|(name, _)| name.as_slice()).collect();
    // A file may hold any number of names: each place of a packet is looked at once.
    let mut places = blocks.xmp.iter().flat_map(|packet| packet.windows(NAME));
    let Some(&name) = places.find_map(|place| names.get(place)) else {
        return;
    };
    let mut packet: Vec<u8> = Vec::new();
    for ((other, place), part) in &parts {
        if other != name {
            continue;
        }
        if *place as usize != packet.len() {
            blocks
                .warnings
                .push("a part of the extended XMP is missing".to_owned());
            return;
        }
        packet.extend_from_slice(part);
    }
    blocks.xmp.push(packet);
}

fn png(input: &mut (impl BufRead + Seek), blocks: &mut Blocks) -> io::Result<()> {
    loop {
        let length = bytes(input, 4)?;
        let length = length.iter().fold(0, |n, &b| n << 8 | u64::from(b));
        let kind = bytes(input, 4)?;
        match kind.as_slice() {
            b"IEND" => return Ok(()),
            b"IHDR" if length >= 8 => {
                let header = bytes(input, length)?;
                let number = |at: usize| {
                    let number = header.get(at..at + 4).unwrap_or_default();
                    number.iter().fold(0, |n, &b| n << 8 | u32::from(b))
                };
                blocks.size = (number(0) > 0 && number(4) > 0).then(|| (number(0), number(4)));
            }
            b"eXIf" | b"iTXt" if length <= LONGEST => {
                let chunk = bytes(input, length)?;
                if kind == b"eXIf" {
                    blocks.exif.get_or_insert(chunk);
                } else if let Some(text) = chunk.strip_prefix(b"XML:com.adobe.xmp\0") {
                    international_text(text, blocks);
                }
            }
            _ => {
                input.seek_relative(i64::try_from(length).unwrap_or(i64::MAX))?;
            }
        }
        // The checksum.
        input.seek_relative(4)?;
    }
}

/// Behind the keyword: whether it is compressed, how, a language, a translated keyword, the text.
fn international_text(text: &[u8], blocks: &mut Blocks) {
    let Some((&[compressed, _], rest)) = text.split_first_chunk::<2>() else {
        return;
    };
    if compressed != 0 {
        blocks
            .warnings
            .push("its XMP is compressed and is not read".to_owned());
        return;
    }
    if let Some(packet) = rest.splitn(3, |&byte| byte == 0).nth(2) {
        blocks.xmp.push(packet.to_vec());
    }
}
