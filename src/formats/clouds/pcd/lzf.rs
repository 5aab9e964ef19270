//! LZF, the compression of binary PCD: Marc Lehmann's liblzf, `lzf_d.c`.
//!
//! A control byte below 32 is followed by as many bytes plus one to take as they are. Any other
//! repeats what came before: its three high bits are the length less 2 (7: one more byte is added),
//! its five low bits and the next byte the distance less 1.

/// The most bytes that a byte of compressed data can stand for: a repetition of 264 takes three.
pub(super) const MOST_PER_BYTE: usize = 88;

/// What `data` stands for: `length` bytes, or `None` where the data is damaged.
pub(super) fn decompress(data: &[u8], length: usize) -> Option<Vec<u8>> {
    if length > data.len().saturating_mul(MOST_PER_BYTE) {
        return None;
    }
    let mut out = Vec::with_capacity(length);
    let mut bytes = data.iter().copied();
    while let Some(control) = bytes.next() {
        if control < 32 {
            for _ in 0..=control {
                out.push(bytes.next()?);
            }
        } else {
            let mut count = usize::from(control >> 5) + 2;
            if control >> 5 == 7 {
                count += usize::from(bytes.next()?);
            }
            let distance = (usize::from(control & 31) << 8 | usize::from(bytes.next()?)) + 1;
            let from = out.len().checked_sub(distance)?;
            // What is repeated may be what is just being written.
            for place in from..from + count {
                out.push(*out.get(place)?);
            }
        }
        if out.len() > length {
            return None;
        }
    }
    (out.len() == length).then_some(out)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn literals_and_repetitions() {
        // "abc", then 3 bytes from 3 back, then 9 + 1 bytes from 1 back.
        let data = [2, b'a', b'b', b'c', 0x20, 2, 0xe0, 1, 0];
        assert_eq!(decompress(&data, 16).unwrap(), b"abcabccccccccccc");
        assert_eq!(decompress(&data, 15), None);
        assert_eq!(decompress(&data, 17), None);
        assert_eq!(decompress(&[0x20, 0], 3), None);
        assert_eq!(decompress(&[5, 1], 6), None);
        assert_eq!(decompress(&[], 0), Some(Vec::new()));
    }

    proptest! {
        #[test]
        fn no_data_panics(data in prop::collection::vec(any::<u8>(), 0..60), length in 0..6000_usize) {
            if let Some(out) = decompress(&data, length) {
                prop_assert_eq!(out.len(), length);
            }
        }
    }
}
