//! The bytes of a tile or strip, taken apart.

use std::io::Read;

use flate2::read::ZlibDecoder;
use weezl::{BitOrder, LzwStatus, decode::Configuration};

use crate::fault::Fault;

/// The tag `Compression`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compression {
    /// 1.
    None,
    /// 5, of TIFF 6.0: codes from the highest bit, each width one code early.
    Lzw,
    /// 8 and 32946.
    Deflate,
    /// 32773.
    PackBits,
    /// 50000.
    Zstd,
    /// 7: each chunk is a JPEG; the tables that they share are in the tag `JPEGTables`.
    Jpeg,
    /// What is not read, by its number.
    Other(u16),
}

impl Compression {
    pub(super) fn of(number: u16) -> Self {
        match number {
            1 => Self::None,
            5 => Self::Lzw,
            7 => Self::Jpeg,
            8 | 32_946 => Self::Deflate,
            32_773 => Self::PackBits,
            50_000 => Self::Zstd,
            other => Self::Other(other),
        }
    }

    /// libtiff knows the tag `Predictor` with these alone, and so do the writers that use it.
    pub(super) fn has_predictor(self) -> bool {
        matches!(self, Self::Lzw | Self::Deflate | Self::Zstd)
    }

    /// What people call it.
    pub fn name(self) -> String {
        let name = match self {
            Self::None => "none",
            Self::Lzw => "LZW",
            Self::Deflate => "deflate",
            Self::PackBits => "PackBits",
            Self::Zstd => "zstd",
            Self::Jpeg => "JPEG",
            Self::Other(number) => match number {
                2 => "CCITT RLE",
                3 => "CCITT fax group 3",
                4 => "CCITT fax group 4",
                6 => "old-style JPEG",
                32_771 => "CCITT RLE in words",
                32_809 => "ThunderScan",
                32_908 => "Pixar film",
                32_909 => "Pixar log",
                33_003..=33_005 | 34_712 => "JPEG 2000",
                34_661 => "JBIG",
                34_676 | 34_677 => "SGI log",
                34_887 => "LERC",
                34_892 => "lossy JPEG of DNG",
                34_925 => "LZMA",
                50_001 => "WebP",
                50_002 | 52_546 => "JPEG XL",
                _ => "unknown",
            },
        };
        match self {
            Self::Other(number) => format!("{name} ({number})"),
            _ => name.to_owned(),
        }
    }

    /// The most bytes that a stored byte stands for; a header that claims more lies.
    fn most_a_byte(self) -> usize {
        match self {
            Self::None => 1,
            // Two bytes for 128 equal ones.
            Self::PackBits => 64,
            // 258 bytes in two bits.
            Self::Deflate => 1100,
            // All 3838 strings of one table, from 2 bytes to 3839, in codes of 9 to 12 bits.
            Self::Lzw => 1400,
            // Blocks of 128 KiB in 4 bytes.
            Self::Zstd => 1 << 15,
            Self::Jpeg | Self::Other(_) => 0,
        }
    }

    /// Exactly `expected` bytes.
    pub(super) fn unpacked(self, stored: Vec<u8>, expected: usize) -> Result<Vec<u8>, Fault> {
        let broken = |what: String| Fault::new(what, super::REMEDY);
        if let Self::Jpeg | Self::Other(_) = self {
            return Err(broken(format!(
                "it is compressed with {}, which is not supported",
                self.name()
            )));
        }
        if stored.len().saturating_mul(self.most_a_byte()) < expected {
            return Err(broken(format!(
                "it is too short, {} bytes for {expected}",
                stored.len()
            )));
        }
        let mut bytes = match self {
            Self::Lzw => lzw(&stored, expected)?,
            Self::PackBits => pack_bits(&stored, expected),
            Self::Deflate => read(ZlibDecoder::new(&stored[..]), expected)?,
            #[cfg(not(feature = "zstd"))]
            Self::Zstd => {
                return Err(Fault::new(
                    "this fragscale was built without zstd",
                    "build it with its default features, or export the file with deflate",
                ));
            }
            #[cfg(feature = "zstd")]
            Self::Zstd => {
                let decoder = zstd::stream::read::Decoder::new(&stored[..]);
                let decoder = decoder.map_err(|e| broken(format!("its zstd is broken ({e})")))?;
                read(decoder, expected)?
            }
            Self::None | Self::Jpeg | Self::Other(_) => stored,
        };
        if bytes.len() < expected {
            return Err(broken(format!(
                "it is too short, {} bytes instead of {expected}",
                bytes.len()
            )));
        }
        bytes.truncate(expected);
        Ok(bytes)
    }
}

/// One byte more than is expected is asked for: so the stream's end, with its checksum, is read too.
fn read(decoder: impl Read, expected: usize) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    let most = expected as u64 + 1;
    match decoder.take(most).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(e) => Err(Fault::new(
            format!("its data are broken ({e})"),
            super::REMEDY,
        )),
    }
}

/// The end code may be missing: what counts are the bytes.
fn lzw(stored: &[u8], expected: usize) -> Result<Vec<u8>, Fault> {
    // The clear code with which all data begin, from the lowest bit: before TIFF 6.0.
    if matches!(stored, [0, second, ..] if second & 1 == 1) {
        let what =
            "it is compressed with old-style LZW (from before TIFF 6.0), which is not supported";
        return Err(Fault::new(what, super::REMEDY));
    }
    let mut decoder = Configuration::with_tiff_size_switch(BitOrder::Msb, 8).build();
    let mut bytes = vec![0; expected];
    let (mut read, mut written) = (0, 0);
    while written < expected {
        let result = decoder.decode_bytes(&stored[read..], &mut bytes[written..]);
        read += result.consumed_in;
        written += result.consumed_out;
        match result.status {
            Ok(LzwStatus::Ok) => {}
            Ok(LzwStatus::Done | LzwStatus::NoProgress) => break,
            Err(e) => {
                return Err(Fault::new(
                    format!("its LZW data are broken ({e})"),
                    super::REMEDY,
                ));
            }
        }
    }
    bytes.truncate(written);
    Ok(bytes)
}

/// TIFF 6.0, section 9.
fn pack_bits(stored: &[u8], expected: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut rest = stored;
    while let (true, Some((&head, behind))) = (bytes.len() < expected, rest.split_first()) {
        rest = match usize::from(head) {
            count @ 0..128 => {
                let (literal, behind) = behind.split_at(behind.len().min(count + 1));
                bytes.extend_from_slice(literal);
                behind
            }
            128 => behind,
            count => match behind.split_first() {
                Some((&byte, behind)) => {
                    bytes.resize(bytes.len() + 257 - count, byte);
                    behind
                }
                None => behind,
            },
        };
    }
    bytes
}
