#![no_main]
//! Outlines of other tools: PNG, TIFF, COCO, LabelMe, GeoJSON and CVAT, told by their bytes. The photo is that of the
//! corpus: 4 x 3 pixels.

use fragscale::formats::{MaskFile, OutlinedPhoto};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let photo = OutlinedPhoto {
        name: "IMG_0005.jpg",
        width: 4,
        height: 3,
    };
    if let Ok(file) = MaskFile::from_bytes(bytes.to_vec()) {
        let _ = file.of_photo(&photo);
    }
});
