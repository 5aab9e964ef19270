//! What a raster's bytes mean as a number.

use crate::fault::Fault;
use crate::raster::{Layout, NumberKind};

/// The numbers of a raster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    U8,
    U16,
    U32,
    U64,
    I8,
    I16,
    I32,
    I64,
    F32,
    F64,
}

impl Number {
    /// Of a raster.
    ///
    /// # Errors
    /// Where its numbers are of none of these kinds.
    pub(crate) fn of(layout: &Layout) -> Result<Self, Fault> {
        let (kind, bits) = (layout.kind, layout.bits);
        let name = match (kind, bits) {
            // Undefined is what old writers say of whole numbers.
            (NumberKind::Unsigned | NumberKind::Other(4), 8) => return Ok(Self::U8),
            (NumberKind::Unsigned | NumberKind::Other(4), 16) => return Ok(Self::U16),
            (NumberKind::Unsigned | NumberKind::Other(4), 32) => return Ok(Self::U32),
            (NumberKind::Unsigned | NumberKind::Other(4), 64) => return Ok(Self::U64),
            (NumberKind::Signed, 8) => return Ok(Self::I8),
            (NumberKind::Signed, 16) => return Ok(Self::I16),
            (NumberKind::Signed, 32) => return Ok(Self::I32),
            (NumberKind::Signed, 64) => return Ok(Self::I64),
            (NumberKind::Float, 32) => return Ok(Self::F32),
            (NumberKind::Float, 64) => return Ok(Self::F64),
            (NumberKind::Float, _) => "floating-point numbers",
            (NumberKind::Other(5 | 6), _) => "complex numbers",
            (NumberKind::Unsigned | NumberKind::Signed | NumberKind::Other(4), _) => {
                "whole numbers"
            }
            (NumberKind::Other(_), _) => "numbers of an unknown kind",
        };
        Err(Fault::new(
            format!("it holds {name} of {bits} bits, which is not supported"),
            "export it with 16-bit whole numbers or 32-bit floating point",
        ))
    }

    /// Bytes of a number.
    pub(crate) fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    /// The number at the begin of little-endian bytes; `None` where they are too few. Of 64-bit whole
    /// numbers beyond 2^53 the nearest f64.
    pub(crate) fn read(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Self::U8 => f64::from(*bytes.first()?),
            Self::I8 => f64::from(i8::from_le_bytes(*bytes.first_chunk()?)),
            Self::U16 => f64::from(u16::from_le_bytes(*bytes.first_chunk()?)),
            Self::I16 => f64::from(i16::from_le_bytes(*bytes.first_chunk()?)),
            Self::U32 => f64::from(u32::from_le_bytes(*bytes.first_chunk()?)),
            Self::I32 => f64::from(i32::from_le_bytes(*bytes.first_chunk()?)),
            Self::U64 => u64::from_le_bytes(*bytes.first_chunk()?) as f64,
            Self::I64 => i64::from_le_bytes(*bytes.first_chunk()?) as f64,
            Self::F32 => f64::from(f32::from_le_bytes(*bytes.first_chunk()?)),
            Self::F64 => f64::from_le_bytes(*bytes.first_chunk()?),
        })
    }
}
