//! Bytes that were changed at random: an error or a label image of the photo's size, never a panic, never for long.

use super::of_bytes;
use fragscale_core::split_mix::SplitMix;

const FILES: [&str; 4] = [
    r#"{"images":[{"id":7,"file_name":"IMG_0005.jpg","width":4,"height":3}],"categories":[{"id":1,"name":"rock"}],"annotations":[{"id":5,"image_id":7,"category_id":1,"segmentation":{"size":[3,4],"counts":"321O30"},"iscrowd":0},{"id":6,"image_id":7,"segmentation":{"size":[3,4],"counts":[3,2,1,1,4,1]}},{"id":7,"image_id":7,"segmentation":[[1,0,3,0,3,2,1,2]]}]}"#,
    r#"{"shapes":[{"label":"rock","points":[[0.0,0.0],[1.0,0.0],[1.0,1.0]],"group_id":4,"shape_type":"polygon"},{"label":"r","points":[[3.5,0.5],[3.9,0.5]],"shape_type":"circle"},{"label":"m","points":[[1,1],[2,2]],"shape_type":"mask","mask":"iVBORw0KGgo="}],"imageHeight":3,"imageWidth":4}"#,
    r#"<?xml version="1.0"?><annotations><image id="1" name="IMG_0005.jpg" width="4" height="3"><polygon label="r" points="0.00,0.00;1.00,0.00;1.00,1.00"/><mask label="s" rle="1, 1, 1, 1" left="1" top="1" width="2" height="2"/><ellipse label="r" cx="0.5" cy="2.5" rx="0.2" ry="0.4" rotation="7"/></image></annotations>"#,
    r#"{"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"MultiPolygon","coordinates":[[[[0,0],[1,0,5],[1,1],[0,1]]],[[[3,2],[4,2],[4,3],[3,3]]]]},"properties":{"class":"x"}}]}"#,
];

#[test]
fn changed_bytes_never_panic() {
    let mut random = SplitMix(18);
    let tiff = super::label_images::TIFFS[1].0;
    let tiff = super::label_images::bytes_of(tiff);
    let png = super::label_images::gray_16([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 65_535]);
    let texts = FILES.map(|text| text.as_bytes().to_vec());
    for whole in texts.into_iter().chain([tiff, png]) {
        assert!(of_bytes(&whole).is_ok());
        for _ in 0..3000 {
            let mut bytes = whole.clone();
            for _ in 0..1 + random.next() % 4 {
                let at = (random.next() % bytes.len() as u64) as usize;
                // Numbers become larger ones as often as nonsense.
                bytes[at] = match random.next() % 3 {
                    0 => b'0' + (random.next() % 10) as u8,
                    1 => b"-e.,[]{}\"<>/"[(random.next() % 12) as usize],
                    _ => random.next() as u8,
                };
            }
            if random.next().is_multiple_of(8) {
                bytes.truncate((random.next() % bytes.len() as u64) as usize);
            }
            if let Ok(masks) = of_bytes(&bytes) {
                assert_eq!(masks.labels.labels.len(), 12);
                assert!(masks.labels.fragments() < 65_535);
            }
        }
    }
}

/// What would take for ever ends at once.
#[test]
fn covering_too_often_is_refused() {
    let one = r#"{"image_id":7,"segmentation":[[0,0,4,0,4,3,0,3]]}"#;
    let many = vec![one; 200].join(",");
    let text = FILES[0]
        .split("\"annotations\":[")
        .next()
        .unwrap_or_default();
    let text = format!("{text}\"annotations\":[{many}]}}");
    let fault = of_bytes(text.as_bytes()).unwrap_err();
    assert_eq!(
        fault.what,
        "its outlines cover the photo more than 100 times"
    );
    let deep = format!("{{\"shapes\":[{{\"points\":{}", "[".repeat(100_000));
    assert!(of_bytes(deep.as_bytes()).is_err());
}
