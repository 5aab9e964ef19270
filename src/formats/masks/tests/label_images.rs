//! Label images as others write them, and what is wrong with some.

use std::io::Cursor;

use image::{DynamicImage, GrayImage, ImageBuffer, Luma, Rgb, RgbImage};
use tiff::encoder::TiffEncoder;
use tiff::encoder::colortype::Gray8;
use tiff::tags::Tag;

use super::{of_bytes, png};
use crate::labels::{FINES, NOT_ROCK};
use crate::masks::MaskFile;

pub(super) fn gray_16(numbers: [u16; 12]) -> Vec<u8> {
    png(ImageBuffer::<Luma<u16>, _>::from_raw(4, 3, numbers.to_vec()).unwrap())
}

/// 0 is fines, 65 535 no rock, in our own files and in others'; numbers are left out at will.
#[test]
fn pngs_of_16_bits_are_read() {
    let numbers = [0, 7, 7, 65_535, 0, 300, 7, 65_535, 65_534, 65_534, 0, 0];
    let expected = numbers.map(|n| if n == 65_535 { NOT_ROCK } else { u32::from(n) });
    let bytes = gray_16(numbers);
    let masks = of_bytes(&bytes).unwrap();
    assert_eq!(masks.labels.labels, expected);
    assert_eq!((masks.labels.width, masks.labels.height), (4, 3));
    assert!(masks.notes.is_empty());
    let own = crate::files::marked_png(bytes.clone());
    assert!(MaskFile::from_bytes(own.clone()).unwrap().is_own());
    assert!(!MaskFile::from_bytes(bytes).unwrap().is_own());
    assert_eq!(of_bytes(&own).unwrap(), masks);
}

/// In 8 bits 255 is a fragment's; gray that is stored as colours is gray.
#[test]
fn pngs_of_8_bits_are_read() {
    let numbers = [0, 7, 7, 255, 0, 30, 7, 255, 4, 4, 0, 0];
    let expected = numbers.map(u32::from);
    let gray = GrayImage::from_raw(4, 3, numbers.to_vec()).unwrap();
    let masks = of_bytes(&png(gray.clone())).unwrap();
    assert_eq!(masks.labels.labels, expected);
    let rgb = DynamicImage::from(gray).to_rgb8();
    assert_eq!(of_bytes(&png(rgb)).unwrap(), masks);
    let colors = RgbImage::from_fn(4, 3, |x, y| Rgb([x as u8, y as u8, 9]));
    let fault = of_bytes(&png(colors)).unwrap_err();
    assert_eq!(fault.what, "it is a picture in colours, no label image");
}

/// As Pascal VOC has its masks: what a pixel's colour is says nothing, its number in the palette is the fragment's.
#[test]
fn numbers_of_a_palette_are_fragments() {
    for (bits, depth) in [(8_usize, png::BitDepth::Eight), (4, png::BitDepth::Four)] {
        let numbers = [0, 7, 7, 3, 0, 5, 7, 3, 4, 4, 0, 0];
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 4, 3);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(depth);
        encoder.set_palette(
            (0..16_u8)
                .flat_map(|of| [of * 16, 255 - of, 9])
                .collect::<Vec<u8>>(),
        );
        let rows = numbers.chunks(8 / bits);
        let packed: Vec<u8> = rows
            .map(|pixels| {
                pixels
                    .iter()
                    .fold(0, |byte, number| (byte << (bits % 8)) | number)
            })
            .collect();
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&packed).unwrap();
        writer.finish().unwrap();
        let masks = of_bytes(&bytes).unwrap();
        assert_eq!(masks.labels.labels, numbers.map(u32::from), "{bits}");
        assert_eq!(
            masks.notes,
            ["it has a palette: the numbers of its colours are taken for those of fragments"]
        );
    }
}

/// Pascal VOC draws void, 255, about every object: it was a fragment from edge to edge.
#[test]
fn void_of_a_palette_is_no_fragment() {
    let of = |numbers: [u8; 12]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 4, 3);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(vec![7; 768]);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&numbers).unwrap();
        writer.finish().unwrap();
        of_bytes(&bytes).unwrap()
    };
    let masks = of([1, 255, 2, 2, 1, 255, 255, 2, 0, 0, 255, 255]);
    assert_eq!(masks.labels.labels, [1, 0, 2, 2, 1, 0, 0, 2, 0, 0, 0, 0]);
    assert!(
        masks.notes.iter().any(|note| note.contains("Pascal VOC")),
        "{:?}",
        masks.notes
    );
    // One of very many.
    let masks = of([254, 255, 2, 2, 254, 255, 255, 2, 0, 0, 255, 255]);
    assert!(masks.labels.labels.contains(&255));
}

/// A mask of one number is no single fragment, unless we wrote it.
#[test]
fn regions_of_a_mask_are_fragments() {
    let mask = [9, 9, 0, 0, 0, 0, 9, 0, 9, 0, 9, 9];
    let masks = of_bytes(&gray_16(mask)).unwrap();
    assert_eq!(masks.labels.labels, [1, 1, 0, 0, 0, 0, 2, 0, 3, 0, 2, 2]);
    assert_eq!(
        masks.notes,
        [
            "it has one number alone (9): each of its 3 regions that touch no other is taken for a fragment"
        ]
    );
    let own = of_bytes(&crate::files::marked_png(gray_16(mask))).unwrap();
    assert_eq!(own.labels.labels, mask.map(u32::from));
    let empty = of_bytes(&gray_16([0; 12])).unwrap();
    assert_eq!(empty.notes, ["no fragment is outlined in it"]);
    assert!(empty.labels.labels.iter().all(|label| *label == FINES));
}

/// Some programs give what lies between the stones a number, too: 1 here, and 2 where all stones have the same.
#[test]
fn what_lies_between_is_no_fragment() {
    let between = [1, 1, 1, 1, 1, 5, 6, 1, 1, 1, 1, 1];
    let masks = of_bytes(&gray_16(between)).unwrap();
    assert_eq!(masks.labels.labels, [0, 0, 0, 0, 0, 5, 6, 0, 0, 0, 0, 0]);
    assert!(
        masks.notes[0]
            .starts_with("fragment 1 reaches all four edges of the photo, over 83 % of it"),
        "{:?}",
        masks.notes
    );
    let classes = [2, 2, 2, 2, 1, 2, 1, 2, 2, 2, 2, 2];
    let masks = of_bytes(&gray_16(classes)).unwrap();
    assert_eq!(masks.labels.labels, [0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 0, 0]);
    // Stones at all edges have one number in a mask, and are stones.
    let mask = [9, 0, 9, 9, 0, 0, 0, 0, 9, 9, 0, 9];
    assert_eq!(of_bytes(&gray_16(mask)).unwrap().labels.fragments(), 4);
    // Ours are what they say.
    let own = of_bytes(&crate::files::marked_png(gray_16(between))).unwrap();
    assert_eq!(own.labels.labels, between.map(u32::from));
}

/// Numbers that fragments share, as in 8 bits, are of no fragment; a few pieces behind other stones are.
#[test]
fn numbers_that_many_regions_share_are_refused() {
    // A chequer of 12 x 12 squares of 2 x 2, every third of a square's number the same.
    let shared = |numbers: u32| -> Vec<u8> {
        let image = ImageBuffer::<Luma<u16>, _>::from_fn(24, 24, |x, y| {
            let (column, row) = (x / 2, y / 2);
            let is_square = (column + row) % 2 == 0;
            let number = (row * 12 + column) / 2 % numbers + 1;
            Luma([if is_square { number as u16 } else { 0 }])
        });
        png(image)
    };
    let read = |bytes: Vec<u8>| {
        let photo = crate::masks::OutlinedPhoto {
            width: 24,
            height: 24,
            ..super::PHOTO
        };
        MaskFile::from_bytes(bytes).unwrap().of_photo(&photo)
    };
    assert_eq!(read(shared(72)).unwrap().labels.fragments(), 72);
    assert_eq!(read(shared(36)).unwrap().labels.fragments(), 36);
    let fault = read(shared(20)).unwrap_err();
    assert!(
        fault
            .what
            .starts_with("its 20 numbers lie in 72 separate regions"),
        "{fault}"
    );
}

/// The bytes of hexadecimal digits.
pub(super) fn bytes_of(digits: &str) -> Vec<u8> {
    let pairs = digits.as_bytes().chunks_exact(2);
    let byte = |pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    pairs.map(byte).collect()
}

/// `tifffile.imwrite(f, (np.arange(12).reshape(3, 4) * 3).astype(T), metadata=None, software='')` of tifffile
/// 2026: with the first number 65 535 and zlib, with -1, with 4 294 967 295, and as floats.
pub(super) const TIFFS: [(&str, u32); 5] = [
    (
        "49492a00080000000c000001040001000000040000000101040001000000030000000201030001000000080000000301030001000000010000000601030001000000010000001101040001000000b000000015010300010000000100000016010400010000000300000017010400010000000c0000001a010500010000009e0000001b01050001000000a600000028010300010000000100000000000000010000000100000001000000010000000000000306090c0f1215181b1e21",
        FINES,
    ),
    (
        "49492a00080000000c000001040001000000040000000101040001000000030000000201030001000000100000000301030001000000080000000601030001000000010000001101040001000000b00000001501030001000000010000001601040001000000030000001701040001000000200000001a010500010000009e0000001b01050001000000a600000028010300010000000100000000000000010000000100000001000000010000000000789cfbff9f99818d81938187819f418841944182419a418e41910100359d02c5",
        NOT_ROCK,
    ),
    (
        "49492a00080000000d000001040001000000040000000101040001000000030000000201030001000000200000000301030001000000010000000601030001000000010000001101040001000000c00000001501030001000000010000001601040001000000030000001701040001000000300000001a01050001000000aa0000001b01050001000000b20000002801030001000000010000005301030001000000020000000000000001000000010000000100000001000000000000000000ffffffff0300000006000000090000000c0000000f0000001200000015000000180000001b0000001e00000021000000",
        NOT_ROCK,
    ),
    (
        "49492a00080000000c000001040001000000040000000101040001000000030000000201030001000000200000000301030001000000010000000601030001000000010000001101040001000000b00000001501030001000000010000001601040001000000030000001701040001000000300000001a010500010000009e0000001b01050001000000a600000028010300010000000100000000000000010000000100000001000000010000000000ffffffff0300000006000000090000000c0000000f0000001200000015000000180000001b0000001e00000021000000",
        NOT_ROCK,
    ),
    (
        "49492a00080000000d000001040001000000040000000101040001000000030000000201030001000000200000000301030001000000010000000601030001000000010000001101040001000000c00000001501030001000000010000001601040001000000030000001701040001000000300000001a01050001000000aa0000001b01050001000000b2000000280103000100000001000000530103000100000003000000000000000100000001000000010000000100000000000000000000000000000040400000c040000010410000404100007041000090410000a8410000c0410000d8410000f04100000442",
        FINES,
    ),
];

/// What tifffile and scikit-image write, of any kind of number, is the same label image.
#[test]
fn tiffs_are_read() {
    for (digits, first) in TIFFS {
        let bytes = bytes_of(digits);
        let masks = of_bytes(&bytes).unwrap();
        let expected: Vec<u32> = (0..12)
            .map(|at| if at == 0 { first } else { at * 3 })
            .collect();
        assert_eq!(masks.labels.labels, expected);
        assert!(masks.notes.is_empty(), "{:?}", masks.notes);
        for end in 0..bytes.len() {
            assert!(of_bytes(&bytes[..end]).is_err(), "{end}");
        }
    }
    // 3.5 in place of 3.
    let mut half = bytes_of(TIFFS[4].0);
    let three = half
        .windows(4)
        .rposition(|w| w == 3.0_f32.to_le_bytes())
        .unwrap();
    half[three..three + 4].copy_from_slice(&3.5_f32.to_le_bytes());
    assert_eq!(
        of_bytes(&half).unwrap_err().what,
        "3.5 is no number of a fragment"
    );
}

/// As ImageJ writes a mask of each fragment, of which the first was taken for all. Overviews, masks and pages of another size are
/// no further masks.
#[test]
fn stacks_are_refused() {
    let written = |pages: &[(u32, u32, u32)]| -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        for (width, height, kind) in pages {
            let mut image = encoder.new_image::<Gray8>(*width, *height).unwrap();
            let kind_of = Tag::NewSubfileType;
            image.encoder().write_tag(kind_of, *kind).unwrap();
            let numbers: Vec<u8> = (0..width * height).map(|at| at as u8 * 3).collect();
            image.write_data(&numbers).unwrap();
        }
        bytes.into_inner()
    };
    let one = of_bytes(&written(&[(4, 3, 0), (2, 2, 1), (4, 3, 4), (2, 2, 0)])).unwrap();
    let expected: Vec<u32> = (0..12).map(|at| at * 3).collect();
    assert_eq!(one.labels.labels, expected);
    let said = |bytes: &[u8]| of_bytes(bytes).unwrap_err().what;
    let stack = written(&[(4, 3, 0), (2, 2, 1), (4, 3, 0), (4, 3, 0)]);
    let of_three = "it is a stack of images, 3 of 4 x 3 pixels, where one ";
    assert!(said(&stack).starts_with(of_three), "{}", said(&stack));
    // One with a mask of each of very many fragments.
    let long = said(&written(&[(4, 3, 0); 1001]));
    assert!(long.contains(", 1000 or more of 4 x 3 pixels"), "{long}");
    // A last directory that leads back to the first is no further image, and no way without an end.
    let number = |at: usize| u32::from_le_bytes(stack[at..at + 4].try_into().unwrap());
    let first = number(4);
    let (mut next, mut links) = (first, Vec::new());
    while next != 0 {
        let directory = next as usize;
        let entries = u16::from_le_bytes([stack[directory], stack[directory + 1]]);
        let link = directory + 2 + 12 * usize::from(entries);
        links.push(link);
        next = number(link);
    }
    assert_eq!(links.len(), 4);
    let mut in_circles = stack.clone();
    in_circles[links[3]..links[3] + 4].copy_from_slice(&first.to_le_bytes());
    let circle = said(&in_circles);
    assert!(circle.contains(", 2 of 4 x 3 pixels"), "{circle}");
}

#[test]
fn wrong_files_are_refused_in_words() {
    let small = png(GrayImage::new(4, 2));
    let fault = of_bytes(&small).unwrap_err();
    assert_eq!(
        fault.what,
        "its outlines are of 4 x 2 pixels, the photo IMG_0005.jpg is of 4 x 3"
    );
    assert_eq!(of_bytes(b"").unwrap_err().what, "it is empty");
    assert_eq!(
        of_bytes(b"\xff\xd8\xff").unwrap_err().what,
        "it is no file of outlines"
    );
    let whole = gray_16([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
    for end in 4..whole.len() - 16 {
        assert!(of_bytes(&whole[..end]).is_err(), "{end}");
    }
    // A header that claims 2^31 pixels a side takes no memory.
    let mut lying = whole.clone();
    lying[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    assert!(of_bytes(&lying).is_err());
}
