//! What is written reads back as the very same label image, for random ones with holes, parts, pinches and gaps in their
//! numbers.

use fragscale_formats::{MaskFile, OutlinedPhoto};

use super::*;
use crate::delineation::{FINES, LabelImage, NOT_ROCK};
use fragscale_core::split_mix::SplitMix;

/// Blocks of random size, painted one over the other, then single pixels.
fn random_image(random: &mut SplitMix) -> LabelImage {
    let mut below = |most: usize| (random.next() % most as u64) as usize;
    let (width, height) = (1 + below(24), 1 + below(18));
    let label = |number: usize| match number {
        0 | 1 => FINES,
        2 => NOT_ROCK,
        number => (number * number) as u32,
    };
    let mut labels = vec![FINES; width * height];
    for _ in 0..below(14) {
        let (left, top) = (below(width), below(height));
        let (wide, high) = (1 + below(width - left), 1 + below(height - top));
        let of = label(below(9));
        for row in top..top + high {
            labels[row * width + left..][..wide].fill(of);
        }
    }
    for _ in 0..below(width * height / 2 + 1) {
        let at = below(width * height);
        labels[at] = label(below(9));
    }
    LabelImage {
        width,
        height,
        labels,
    }
}

/// Named as no JSON and no XML likes it.
const NAME: &str = "day \"1\"/<IMG & 5>.jpg";

#[test]
fn every_form_reads_back_to_the_pixel() {
    let mut random = SplitMix(2026);
    for round in 0..400 {
        let labels = random_image(&mut random);
        let mut coco = CocoFile::default();
        let mut cvat = CvatFile::default();
        for photo in ["other.jpg", NAME] {
            coco.add(photo, &labels);
            cvat.add(photo, &labels);
        }
        let files = [
            coco.text().unwrap().into_bytes(),
            cvat.text().into_bytes(),
            labelme_json(NAME, &labels).into_bytes(),
            fragments_geojson(NAME, &labels).into_bytes(),
            labels_tiff(&labels).unwrap(),
            crate::fragments::labels_png(&labels).unwrap(),
        ];
        let photo = OutlinedPhoto {
            name: NAME,
            width: labels.width as u32,
            height: labels.height as u32,
        };
        for (form, bytes) in ["coco", "cvat", "labelme", "geojson", "tiff", "png"]
            .iter()
            .zip(files)
        {
            let text = String::from_utf8_lossy(&bytes).into_owned();
            let file = MaskFile::from_bytes(bytes).unwrap();
            assert!(file.is_own(), "{form}");
            let read = file.of_photo(&photo).unwrap();
            assert_eq!(read.labels, labels, "{form}, round {round}: {text}");
            let notes: Vec<&String> = read
                .notes
                .iter()
                .filter(|note| !note.starts_with("no fragment"))
                .collect();
            assert!(notes.is_empty(), "{form}, round {round}: {notes:?}");
        }
    }
}

/// Rings of two parts that touch at a corner, one with a hole: clockwise outside, counterclockwise about the hole.
#[test]
fn outlines_go_along_the_sides_of_pixels() {
    let labels = [
        [5, 5, 5, 0, 0], //
        [5, 0, 5, 0, 0],
        [5, 5, 5, 0, 0],
        [0, 0, 0, 5, 5],
    ];
    let image = LabelImage {
        width: 5,
        height: 4,
        labels: labels.concat(),
    };
    let (parts, _) = trace::parts(&image);
    let rings: Vec<_> = parts
        .iter()
        .filter(|part| part.label == 5)
        .map(|part| part.rings.clone())
        .collect();
    assert_eq!(
        rings,
        [
            vec![
                vec![[3, 0], [3, 3], [0, 3], [0, 0]],
                vec![[2, 2], [2, 1], [1, 1], [1, 2]],
            ],
            vec![vec![[5, 3], [5, 4], [3, 4], [3, 3]]],
        ]
    );
}

/// `pycocotools.mask.encode` of [1 1 1], [1 0 1], [1 1 1] in the middle of 5 x 5 gives this text.
#[test]
fn runs_are_packed_as_pycocotools_does() {
    let mut labels = vec![FINES; 25];
    for at in [6, 7, 8, 11, 13, 16, 17, 18] {
        labels[at] = 1;
    }
    let image = LabelImage {
        width: 5,
        height: 5,
        labels,
    };
    let mut coco = CocoFile::default();
    coco.add("a.jpg", &image);
    let text = coco.text().unwrap();
    assert!(
        text.contains(
            r#""area":8,"bbox":[1,1,3,3],"segmentation":{"size":[5,5],"counts":"632NO0124"}"#
        ),
        "{text}"
    );
}
