use image::{GrayImage, Luma, Rgb, codecs::jpeg::JpegEncoder};

use super::*;

/// Of any kind that libjpeg writes: `tests/fixtures/jpeg`, made by Pillow 12 from one picture of 61 x 45.
const PROGRESSIVE: &[u8] = include_bytes!("../../../tests/fixtures/jpeg/progressive_420.jpg");
const RESTARTS: &[u8] = include_bytes!("../../../tests/fixtures/jpeg/restarts_422.jpg");
const PROGRESSIVE_RESTARTS: &[u8] =
    include_bytes!("../../../tests/fixtures/jpeg/progressive_restarts.jpg");
const GREY: &[u8] = include_bytes!("../../../tests/fixtures/jpeg/grey.jpg");

fn textured() -> RgbImage {
    RgbImage::from_fn(240, 160, |x, y| {
        let level = (x * x / 7 + y * 13 + x * y / 11) as u8;
        Rgb([level, level.wrapping_mul(3), (x + y) as u8])
    })
}

fn written(image: &RgbImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, 90)
        .encode_image(image)
        .unwrap();
    bytes
}

/// Where the first scan's compressed data begin.
fn scan_begin(bytes: &[u8]) -> usize {
    let mut at = 2;
    loop {
        let length = usize::from(u16::from_be_bytes([bytes[at + 2], bytes[at + 3]]));
        let is_scan = bytes[at + 1] == 0xda;
        at += 2 + length;
        if is_scan {
            return at;
        }
    }
}

/// Marsaglia's xorshift64*.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % end
    }
}

#[test]
fn whole_files_of_all_kinds() {
    let mut all = vec![
        PROGRESSIVE.to_vec(),
        RESTARTS.to_vec(),
        PROGRESSIVE_RESTARTS.to_vec(),
        GREY.to_vec(),
        written(&textured()),
    ];
    let grey = GrayImage::from_fn(61, 45, |x, y| Luma([(x * y) as u8]));
    let mut bytes = Vec::new();
    JpegEncoder::new(&mut bytes).encode_image(&grey).unwrap();
    all.push(bytes);
    for (place, whole) in all.iter().enumerate() {
        assert!(decode(whole).is_ok(), "{place}");
        // Cameras append a second picture.
        let longer = [&whole[..], b"\0\0", GREY].concat();
        assert!(decode(&longer).is_ok(), "{place}: appended");
        // The end marker may be missing, the data not.
        let open = &whole[..whole.len() - 2];
        assert!(decode(open).is_ok(), "{place}: no end marker");
        let filled = [open, &[0xff, 0xff, 0xff, 0xd9]].concat();
        assert!(decode(&filled).is_ok(), "{place}: fill bytes");
        // In front of the end marker a block is missing, or the last scan.
        let short = [&whole[..whole.len() - 12], &[0xff, 0xd9]].concat();
        assert!(decode(&short).is_err(), "{place}: too short");
        let cut = decode(&whole[..whole.len() * 3 / 4]);
        let what = cut.err().unwrap().what;
        assert!(what.contains("cut off"), "{place}: {what}");
    }
}

/// T.81, B.1.1.5: what is stored behind the blocks that the frame asks for, or is missing of them.
#[test]
fn another_height_than_the_data_have() {
    let whole = written(&textured());
    let frame = whole
        .windows(2)
        .position(|pair| pair == [0xff, 0xc0])
        .unwrap();
    for (height, said) in [(152, "behind the last block"), (168, "too early")] {
        let mut bytes = whole.clone();
        bytes[frame + 6] = height;
        let what = decode(&bytes).err().unwrap().what;
        assert!(what.contains(said), "{height}: {what}");
    }
}

/// What a card reader's error leaves: bytes in the middle that are others. The share is that of the
/// module's header, on a small picture.
#[test]
fn damage_in_the_middle_is_found() {
    let mut random = Random(7);
    let large = written(&textured());
    for whole in [&large[..], PROGRESSIVE, RESTARTS, PROGRESSIVE_RESTARTS] {
        let begin = scan_begin(whole);
        let length = (whole.len() - begin) / 4;
        let mut missed = 0;
        for _ in 0..200 {
            let mut bytes = whole.to_vec();
            let at = begin + random.below(whole.len() - 2 - begin - length);
            for byte in &mut bytes[at..at + length.min(300)] {
                *byte = random.below(256) as u8;
            }
            missed += usize::from(decode(&bytes).is_ok());
        }
        assert!(missed <= 2, "{missed} of 200 not found");
    }
}

/// A damaged file that the decoder alone shows 100 % of, most of it wrong.
#[test]
fn an_end_marker_in_the_middle() {
    let whole = written(&textured());
    let begin = scan_begin(&whole);
    let mut bytes = whole.clone();
    let middle = begin + (whole.len() - begin) / 3;
    bytes[middle..middle + 2].copy_from_slice(&[0xff, 0xd9]);
    let mut lax = JpegDecoder::new(ZCursor::new(&bytes));
    assert!(lax.decode().is_ok());
    let what = decode(&bytes).err().unwrap().what;
    assert!(what.contains("damaged, noticed at 3"), "{what}");
}

#[test]
fn junk_is_an_error() {
    let whole = written(&textured());
    for end in 0..whole.len().min(700) {
        assert!(decode(&whole[..end]).is_err());
        let mut bytes = whole.clone();
        bytes[end] = 0xff;
        // Some bytes matter to nobody.
        let _ = decode(&bytes);
    }
    for tables in [None, Some(&b""[..]), Some(b"\xff\xd8\xff\xd9")] {
        assert!(decode_part(tables, b"\xff\xd8", Colors::AsStored).is_err());
        assert!(decode_part(tables, b"", Colors::ToRgb).is_err());
    }
}
