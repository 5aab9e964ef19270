//! The compressed parts of recordings.

use std::borrow::Cow;
use std::io;
#[cfg(feature = "ros")]
use std::io::Read;

use crate::fault::Fault;

/// The largest part that is taken into memory. Recorders close a chunk at one or a few megabytes, or
/// behind the one message that is larger.
pub(super) const LARGEST: u64 = 512 << 20;

/// What zstd's frames begin with.
const ZSTD: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// A part of a file as it was before `compression` ("", "none", "bz2", "lz4", "zstd"), which its
/// header says to be `size` bytes. No more memory is taken than comes out.
///
/// # Errors
/// Where the part is damaged, of another size, or larger than [`LARGEST`].
pub(super) fn expanded<'a>(
    compression: &str,
    data: &'a [u8],
    size: u64,
) -> Result<Cow<'a, [u8]>, Fault> {
    let damaged = |why: &dyn std::fmt::Display| {
        Fault::new(
            format!("a chunk compressed with {compression} is damaged ({why})"),
            "copy the recording again",
        )
    };
    if size > LARGEST {
        return Err(Fault::new(
            format!("a chunk of {size} bytes, over the {LARGEST} that are read at once"),
            "check that the file is not damaged",
        ));
    }
    let expanded = match compression {
        "" | "none" => return Ok(Cow::Borrowed(data)),
        "bz2" | "lz4" | "zstd" => decoded(compression, data, size)?,
        other => {
            return Err(Fault::new(
                format!("its chunks are compressed with '{other}'"),
                "convert it to one without compression, or with lz4, zstd or (rosbag 1) bz2",
            ));
        }
    }
    .map_err(|error| damaged(&error))?;
    if expanded.len() as u64 != size {
        return Err(damaged(&format!(
            "it is not the {size} bytes long that it says"
        )));
    }
    Ok(Cow::Owned(expanded))
}

/// A message as it was before rosbag2 compressed it, if it did: plain CDR begins with 0.
///
/// # Errors
/// Where it is damaged or larger than [`LARGEST`].
pub(super) fn expanded_message(data: &[u8]) -> io::Result<Cow<'_, [u8]>> {
    if !data.starts_with(&ZSTD) {
        return Ok(Cow::Borrowed(data));
    }
    let expanded = decoded("zstd", data, LARGEST).map_err(io::Error::other)??;
    if expanded.len() as u64 > LARGEST {
        return Err(io::Error::other("too large"));
    }
    Ok(Cow::Owned(expanded))
}

/// `data` decompressed, at most one byte more than `size`.
#[cfg(feature = "ros")]
fn decoded(compression: &str, data: &[u8], size: u64) -> Result<io::Result<Vec<u8>>, Fault> {
    Ok(match compression {
        "bz2" => all_of(bzip2::read::BzDecoder::new(data), size),
        "lz4" => lz4::Decoder::new(data).and_then(|decoder| all_of(decoder, size)),
        _ => zstd::Decoder::with_buffer(data).and_then(|decoder| all_of(decoder, size)),
    })
}

/// Refuses: the libraries were left out.
#[cfg(not(feature = "ros"))]
fn decoded(compression: &str, _: &[u8], _: u64) -> Result<io::Result<Vec<u8>>, Fault> {
    Err(super::left_out(compression))
}

/// What a decoder brings, and of more than `size` bytes the first one too many.
#[cfg(feature = "ros")]
fn all_of(decoder: impl Read, size: u64) -> io::Result<Vec<u8>> {
    let mut expanded = Vec::new();
    decoder.take(size + 1).read_to_end(&mut expanded)?;
    Ok(expanded)
}

#[cfg(test)]
#[cfg(feature = "ros")]
mod tests {
    use std::io::Write;

    use super::*;

    fn packed() -> [(&'static str, Vec<u8>); 3] {
        let text = b"scale ".repeat(1000);
        let mut bz2 = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
        bz2.write_all(&text).unwrap();
        let mut lz4 = lz4::EncoderBuilder::new().build(Vec::new()).unwrap();
        lz4.write_all(&text).unwrap();
        [
            ("bz2", bz2.finish().unwrap()),
            ("lz4", lz4.finish().0),
            ("zstd", zstd::encode_all(&text[..], 3).unwrap()),
        ]
    }

    #[test]
    fn every_compression_there_and_back() {
        for (name, data) in packed() {
            assert_eq!(
                expanded(name, &data, 6000).unwrap(),
                b"scale ".repeat(1000),
                "{name}"
            );
            for size in [0, 5999, 6001, u64::MAX] {
                assert!(expanded(name, &data, size).is_err(), "{name} {size}");
            }
            for end in 0..data.len() - 8 {
                assert!(expanded(name, &data[..end], 6000).is_err(), "{name} {end}");
            }
            assert!(expanded(name, b"scale", 5).is_err());
        }
        assert!(
            expanded("brotli", b"", 0)
                .unwrap_err()
                .what
                .contains("'brotli'")
        );
    }

    #[test]
    fn messages_tell_by_their_first_bytes() {
        let [_, _, (_, data)] = packed();
        assert_eq!(expanded_message(&data).unwrap(), b"scale ".repeat(1000));
        assert_eq!(
            expanded_message(b"\0\x01\0\0").unwrap().as_ref(),
            b"\0\x01\0\0"
        );
        assert!(expanded_message(&data[..20]).is_err());
    }
}
