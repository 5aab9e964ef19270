//! Fragments of the bundled flight, as a user asks for them.

use std::fs;
use std::path::Path;

use crate::common::{error_of, stdout_of};

fn sample() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    folder.to_string_lossy().into_owned()
}

/// Label image, outlines, measures and curve of one photo agree with each other, and about with what the lab is
/// made of; a second run writes the same, and writes over its own files alone.
#[test]
fn a_photo_of_the_bundled_flight() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("out");
    let to_text = to.to_string_lossy().into_owned();
    let flight = sample();
    let arguments = [
        "delineate",
        &flight,
        "--photo",
        "IMG_0005.jpg",
        "--to",
        &to_text,
        "--unit",
        "mm",
        "--engine",
        "classical",
    ];
    let text = stdout_of(&arguments);
    assert!(
        text.starts_with("photo ") && text.contains("P50 mm") && text.contains("all photos"),
        "{text}"
    );

    let labels = image::open(to.join("IMG_0005_labels.png"))
        .expect("a label image")
        .into_luma16();
    assert_eq!(labels.dimensions(), (1280, 720));
    let mut pixels = vec![0usize; 65536];
    for label in labels.pixels() {
        pixels[usize::from(label.0[0])] += 1;
    }
    let mut table = csv::Reader::from_path(to.join("fragments.csv")).expect("a table");
    let heads = table.headers().expect("heads").clone();
    let column = |name: &str| {
        heads
            .iter()
            .position(|head| head == name)
            .expect("a column")
    };
    let (own, scale, area) = (
        column("pixels"),
        column("scale_px_per_mm"),
        column("area_mm2"),
    );
    let mut count = 0;
    for row in table.records() {
        let row = row.expect("a row");
        let number: usize = row[1].parse().expect("a number");
        count += 1;
        assert_eq!(number, count);
        assert_eq!(row[own].parse::<usize>().expect("pixels"), pixels[number]);
        if row[area].is_empty() {
            continue;
        }
        let [scale, area]: [f64; 2] = [scale, area].map(|at| row[at].parse().expect("a number"));
        // A lab seen from half a metre: 2 pixels per mm, about.
        assert!((1.0..4.0).contains(&scale), "{scale}");
        assert!((pixels[number] as f64 / scale.powi(2) / area - 1.0).abs() < 0.2);
    }
    assert!(count > 150, "{count}");
    assert!(pixels[count] > 0 && pixels[count + 1..65535].iter().all(|pixels| *pixels == 0));

    let curve = fs::read_to_string(to.join("distribution.csv")).expect("a curve");
    assert!(
        curve.starts_with(
            "method,photo,size_mm,percent_passing,area\nfragscale (classical),IMG_0005.jpg,"
        ),
        "{curve}"
    );
    // It goes straight into the fits.
    let fit = stdout_of(&["psd", "fit", &to.join("distribution.csv").to_string_lossy()]);
    assert!(fit.contains("Swebrec") || fit.contains("swebrec"), "{fit}");
    let outlines = image::open(to.join("IMG_0005_outlines.png"))
        .expect("outlines")
        .into_rgb8();
    assert!(
        outlines
            .pixels()
            .filter(|pixel| pixel.0 == [255, 220, 0])
            .count()
            > 10_000
    );

    let before: Vec<Vec<u8>> = ["IMG_0005_labels.png", "fragments.csv"]
        .map(|name| fs::read(to.join(name)).expect("it"))
        .into();
    assert_eq!(stdout_of(&arguments), text);
    let after: Vec<Vec<u8>> = ["IMG_0005_labels.png", "fragments.csv"]
        .map(|name| fs::read(to.join(name)).expect("it"))
        .into();
    assert_eq!(before, after);
    fs::write(to.join("fragments.csv"), "notes").expect("a file of somebody");
    let error = error_of(&arguments);
    assert!(
        error.contains("fragments.csv") && error.contains("--force"),
        "{error}"
    );
}

#[test]
fn what_cannot_be_outlined_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("out").to_string_lossy().into_owned();
    let flight = sample();
    let error = error_of(&["delineate", &flight, "--photo", "IMG_9999.jpg", "--to", &to]);
    assert!(error.contains("IMG_9999.jpg"), "{error}");
    assert!(!Path::new(&to).exists());
}
