use std::io::Cursor;

use tiff::encoder::colortype::{Gray8, Gray16};
use tiff::encoder::{Compression as Written, TiffEncoder};

use super::*;

/// 5 x 4 numbers in strips of two rows.
fn written(compression: Written) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut bytes).unwrap();
    let mut encoder = encoder.with_compression(compression);
    let mut image = encoder.new_image::<Gray16>(5, 4).unwrap();
    image.rows_per_strip(2).unwrap();
    let numbers: Vec<u16> = (0..20).map(|n| 1000 * n).collect();
    image.write_data(&numbers).unwrap();
    bytes.into_inner()
}

type Opened<'a> = (TiffFile<Cursor<&'a [u8]>>, Layout);

fn open(bytes: &[u8]) -> Result<Opened<'_>, Fault> {
    let mut file = TiffFile::open(Cursor::new(bytes), bytes.len() as u64)?;
    let layout = file.layout()?;
    Ok((file, layout))
}

/// The value of a tag's entry in a little-endian classic file, replaced.
fn with_tag(bytes: &[u8], tag: u16, value: u32) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let directory = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let count = usize::from(u16::from_le_bytes([bytes[directory], bytes[directory + 1]]));
    for entry in (0..count).map(|n| directory + 2 + 12 * n) {
        if bytes[entry..entry + 2] == tag.to_le_bytes() {
            bytes[entry + 8..entry + 12].copy_from_slice(&value.to_le_bytes());
            return bytes;
        }
    }
    panic!("no tag {tag}");
}

#[test]
fn strips_of_each_compression() {
    for compression in [
        Written::Uncompressed,
        Written::Lzw,
        Written::Deflate(Default::default()),
        Written::Packbits,
    ] {
        let bytes = written(compression);
        let (mut file, layout) = open(&bytes).unwrap();
        assert_eq!((layout.width, layout.height, layout.chunk), (5, 4, (5, 2)));
        let second = file.chunk(&layout, 1).unwrap().unwrap();
        let numbers: Vec<u16> = (10..20).map(|n| 1000 * n).collect();
        let expected: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        assert_eq!(second, expected, "compression {:?}", layout.compression);
        assert!(file.chunk(&layout, 2).is_err());
    }
}

/// TIFF 6.0, section 9: the example of Apple's PackBits.
#[test]
fn pack_bits_of_the_specification() {
    let packed = [
        0xfe, 0xaa, 0x02, 0x80, 0x00, 0x2a, 0xfd, 0xaa, 0x03, 0x80, 0x00, 0x2a, 0x22, 0xf7, 0xaa,
    ];
    let unpacked = [
        0xaa, 0xaa, 0xaa, 0x80, 0x00, 0x2a, 0xaa, 0xaa, 0xaa, 0xaa, 0x80, 0x00, 0x2a, 0x22, 0xaa,
        0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa,
    ];
    let read = Compression::PackBits.unpacked(packed.to_vec(), 24);
    assert_eq!(read.unwrap(), unpacked);
    for end in 0..packed.len() {
        assert!(
            Compression::PackBits
                .unpacked(packed[..end].to_vec(), 24)
                .is_err()
        );
    }
}

/// An LZW stream from which the end code was taken: clear, 7, 8, 9 in nine bits each, padded.
#[test]
fn lzw_needs_no_end_code() {
    let mut bits = String::new();
    for code in [256, 7, 8, 9] {
        bits += &format!("{code:09b}");
    }
    bits += "0000";
    let stored = bits.as_bytes().chunks(8);
    let stored: Vec<u8> = stored
        .map(|byte| u8::from_str_radix(std::str::from_utf8(byte).unwrap(), 2).unwrap())
        .collect();
    let read = Compression::Lzw.unpacked(stored.clone(), 3);
    assert_eq!(read.unwrap(), [7, 8, 9]);
    let fault = Compression::Lzw.unpacked(vec![0, 1, 2, 3], 3).unwrap_err();
    assert!(fault.what.contains("old-style LZW"), "{fault}");
}

#[test]
fn predictors() {
    let mut row = [250, 1, 10, 2, 0xff, 3];
    predictor::undo_horizontal(&mut row, 2, 1);
    assert_eq!(row, [250, 1, 4, 3, 3, 6]);
    let numbers = [0x0001_ffff_u32, 0xffff_fff0, 0x0000_0020];
    let mut row: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    predictor::undo_horizontal(&mut row, 1, 4);
    let sums = [0x0001_ffff_u32, 0x0001_ffef, 0x0002_000f];
    let sums: Vec<u8> = sums.iter().flat_map(|n| n.to_le_bytes()).collect();
    assert_eq!(row, sums);
    // Technical Note 3: the bytes 01 02 | 03 04 by weight are 01 03 02 04, their differences 1 2 -1 2.
    let mut row = [1, 2, 255, 2];
    predictor::undo_floating_point(&mut row, 1, 2);
    assert_eq!(row, [2, 1, 4, 3]);
}

#[test]
fn what_is_not_read_is_named() {
    let bytes = written(Written::Uncompressed);
    for (number, name) in [
        (6, "old-style JPEG (6)"),
        (34_887, "LERC (34887)"),
        (60_000, "unknown"),
    ] {
        let named = with_tag(&bytes, 259, number);
        let (mut file, layout) = open(&named).unwrap();
        let fault = file.chunk(&layout, 0).unwrap_err();
        assert!(fault.what.contains(name), "{fault}");
    }
}

#[test]
fn lying_headers_take_no_memory() {
    let bytes = written(Written::Deflate(Default::default()));
    // 4 000 000 000 columns in two strips of some bytes.
    let wide = with_tag(&bytes, 256, 4_000_000_000);
    let (mut file, layout) = open(&wide).unwrap();
    assert!(file.chunk(&layout, 0).is_err());
    let wide = with_tag(&bytes, 256, 100_000_000);
    let (mut file, layout) = open(&wide).unwrap();
    let fault = file.chunk(&layout, 0).unwrap_err();
    assert!(fault.what.contains("too short"), "{fault}");
}

#[test]
fn damage_and_truncation_are_errors_or_the_same() {
    for compression in [
        Written::Lzw,
        Written::Deflate(Default::default()),
        Written::Packbits,
    ] {
        let whole = written(compression);
        for at in 0..whole.len() {
            for value in [0, 0x7f, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] = value;
                if let Ok((mut file, layout)) = open(&bytes) {
                    let _ = file.chunk(&layout, 0);
                    let _ = file.mask(&layout);
                }
            }
            if let Ok((mut file, layout)) = open(&whole[..at]) {
                assert!(file.chunk(&layout, 1).is_err() || at > whole.len() / 2);
            }
        }
    }
}

/// The first directory is an overview, as some writers have it.
#[test]
fn the_image_is_the_first_that_is_no_overview() {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    for (side, kind) in [(2, 1_u32), (6, 0), (3, 1), (6, 4)] {
        let mut image = encoder.new_image::<Gray8>(side, side).unwrap();
        image
            .encoder()
            .write_tag(Tag::NewSubfileType, kind)
            .unwrap();
        image.write_data(&vec![7; (side * side) as usize]).unwrap();
    }
    let bytes = bytes.into_inner();
    let (mut file, layout) = open(&bytes).unwrap();
    assert_eq!((layout.width, layout.height), (6, 6));
    let mask = file.mask(&layout).unwrap();
    assert_eq!((mask.width, mask.bits), (6, 8));
}
