//! Pieces of binary files whose lengths are not to be believed.

use std::io::{self, Read};

use super::compression::LARGEST;
use crate::fault::Fault;

/// Bytes from left to right.
#[derive(Debug)]
pub(super) struct Parts<'a>(&'a [u8]);

impl<'a> Parts<'a> {
    pub(super) fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn rest(&self) -> &'a [u8] {
        self.0
    }

    pub(super) fn bytes(&mut self, count: u64) -> Option<&'a [u8]> {
        let (part, rest) = self.0.split_at_checked(usize::try_from(count).ok()?)?;
        self.0 = rest;
        Some(part)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (part, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*part)
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.array().map(|[byte]| byte)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// A text with a u32 length in front.
    pub(super) fn text(&mut self) -> Option<&'a str> {
        let length = self.u32()?;
        std::str::from_utf8(self.bytes(length.into())?).ok()
    }
}

/// Where a file ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cut {
    /// In front of what was to be read.
    End,
    /// In the middle of it.
    Inside,
}

fn unreadable(error: &io::Error) -> Fault {
    Fault::new(
        format!("it cannot be read to its end ({error})"),
        "check the disk",
    )
}

/// `N` bytes of a file.
pub(super) fn read_array<const N: usize>(
    input: &mut impl Read,
) -> Result<Result<[u8; N], Cut>, Fault> {
    let bytes = read_bytes(input, N as u64)?;
    Ok(bytes.and_then(|bytes| bytes.try_into().map_err(|_| Cut::Inside)))
}

/// `count` bytes of a file.
///
/// # Errors
/// Where it cannot be read, or more than [`LARGEST`] are asked for.
pub(super) fn read_bytes(input: &mut impl Read, count: u64) -> Result<Result<Vec<u8>, Cut>, Fault> {
    if count > LARGEST {
        return Err(Fault::new(
            format!("a record of {count} bytes, over the {LARGEST} that are read at once"),
            "check that the file is not damaged",
        ));
    }
    let mut bytes = Vec::new();
    let read = input.take(count).read_to_end(&mut bytes);
    let read = read.map_err(|error| unreadable(&error))? as u64;
    Ok(match read {
        _ if read == count => Ok(bytes),
        0 => Err(Cut::End),
        _ => Err(Cut::Inside),
    })
}

/// Passes over `count` bytes of a file.
pub(super) fn skip_bytes(input: &mut impl Read, count: u64) -> Result<Result<(), Cut>, Fault> {
    let skipped = io::copy(&mut input.take(count), &mut io::sink());
    let skipped = skipped.map_err(|error| unreadable(&error))?;
    Ok(if skipped == count {
        Ok(())
    } else {
        Err(Cut::Inside)
    })
}
