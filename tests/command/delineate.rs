//! Fragments of the bundled flight, as a user asks for them.

use std::fs;
use std::path::Path;

use crate::common::{error_of, fragscale, stdout_of};

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

/// The bundled lab's sieve curve is known: half of it by mass passes the size that the photo's curve says, by the
/// engine that is the default. What nothing else holds is in it: the weights, the shape, the share of the fines.
#[test]
fn half_passes_what_passes_half_on_the_sieves() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("out");
    let flight = sample();
    let to_text = to.to_string_lossy().into_owned();
    let photo = "IMG_0001.jpg";
    stdout_of(&[
        "delineate",
        &flight,
        "--photo",
        photo,
        "--to",
        &to_text,
        "--unit",
        "mm",
    ]);
    let half = |path: &Path, size: &str, percent: &str| -> f64 {
        let mut table = csv::Reader::from_path(path).expect("a table");
        let heads = table.headers().expect("heads").clone();
        let at = [size, percent].map(|name| {
            heads
                .iter()
                .position(|head| head == name)
                .expect("a column")
        });
        let rows = table.records().map(|row| {
            let row = row.expect("a row");
            at.map(|at| row[at].parse::<f64>().expect("a number"))
        });
        let rows: Vec<[f64; 2]> = rows.collect();
        let pair = rows
            .windows(2)
            .find(|pair| pair[0][1] <= 50.0 && pair[1][1] >= 50.0)
            .expect("half");
        let share = (50.0 - pair[0][1]) / (pair[1][1] - pair[0][1]);
        pair[0][0] * (pair[1][0] / pair[0][0]).powf(share)
    };
    let found = half(&to.join("distribution.csv"), "size_mm", "percent_passing");
    let sieved = half(
        &Path::new(&flight).join("reference.csv"),
        "size_mm",
        "percent_passing",
    );
    // One photo, with its ball: 6 % when it was written.
    assert!((found / sieved - 1.0).abs() < 0.12, "{found}, not {sieved}");
}

/// Outlines of another tool are measured in place of an engine's; what is written for others reads back to the same.
#[test]
fn outlines_of_other_tools() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let flight = sample();
    // Two stones that overlap on 300 pixels, and a hole, in the original photo.
    let coco = r#"{"images":[{"id":1,"file_name":"photos/IMG_0005.jpg","width":1280,"height":720}],
        "categories":[{"id":1,"name":"stone"}],"annotations":[
        {"id":1,"image_id":1,"category_id":1,"segmentation":[[500,300,600,300,600,400,500,400]],"iscrowd":0},
        {"id":2,"image_id":1,"category_id":1,"segmentation":[[590,300,640,300,640,330,590,330]],"iscrowd":0}]}"#;
    fs::write(path("coco.json"), coco).expect("a file");
    let arguments = |masks: &str, to: &str| {
        let rest = [
            "--also",
            "coco,labelme,cvat,geojson,tiff",
            "--photo",
            "IMG_0005.jpg",
        ];
        let own = ["delineate", &flight, "--to", to, "--masks", masks];
        own.iter()
            .chain(&rest)
            .map(|part| (*part).to_owned())
            .collect::<Vec<String>>()
    };
    let run = |masks: &str, to: &str| {
        let arguments = arguments(masks, to);
        stdout_of(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let to = path("out");
    let text = run(&path("coco.json"), &to);
    assert!(text.contains("IMG_0005.jpg"), "{text}");
    let first = fs::read(Path::new(&to).join("IMG_0005_labels.png")).expect("labels");
    let labels = image::open(Path::new(&to).join("IMG_0005_labels.png"))
        .expect("labels")
        .into_luma16();
    let count = |number: u16| labels.pixels().filter(|pixel| pixel.0 == [number]).count();
    // The lens moves edges by some pixels; the smaller one has the shared ones.
    assert!(
        (9000..10_500).contains(&count(1)) && (1400..1600).contains(&count(2)),
        "{} {}",
        count(1),
        count(2)
    );
    let curve = fs::read_to_string(Path::new(&to).join("distribution.csv")).expect("a curve");
    assert!(curve.contains("fragscale (masks),IMG_0005.jpg,"), "{curve}");
    // A second run writes over its own files.
    run(&path("coco.json"), &to);
    for (at, file) in [
        "fragments_coco.json",
        "fragments_cvat.xml",
        "IMG_0005_labelme.json",
        "IMG_0005_fragments.geojson",
        "IMG_0005_labels.tif",
        "IMG_0005_labels.png",
    ]
    .iter()
    .enumerate()
    {
        let again = path(&format!("again {at}"));
        run(&Path::new(&to).join(file).to_string_lossy(), &again);
        let labels = fs::read(Path::new(&again).join("IMG_0005_labels.png")).expect("labels");
        assert_eq!(labels, first, "{file}");
    }
    // A folder has files named as the photos; the others are said.
    let folder_of = path("masks");
    fs::create_dir(&folder_of).expect("a folder");
    fs::copy(
        Path::new(&to).join("IMG_0005_labels.png"),
        Path::new(&folder_of).join("IMG_0005_mask.png"),
    )
    .expect("a copy");
    let error = error_of(&[
        "delineate",
        &flight,
        "--to",
        &path("all"),
        "--masks",
        &folder_of,
    ]);
    assert!(
        error.contains("8 of 9 photos are not delineated"),
        "{error}"
    );
    let of_all = fs::read(Path::new(&path("all")).join("IMG_0005_labels.png")).expect("labels");
    assert_eq!(of_all, first);
}

#[test]
fn outlines_that_cannot_be_taken_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let flight = sample();
    let small = path("small.png");
    image::GrayImage::new(64, 48)
        .save(&small)
        .expect("a picture");
    let to = path("out");
    let error = error_of(&[
        "delineate",
        &flight,
        "--photo",
        "IMG_0005.jpg",
        "--to",
        &to,
        "--masks",
        &small,
    ]);
    assert!(
        error.contains("64 x 48") && error.contains("1280 x 720") && error.contains("small.png"),
        "{error}"
    );
    let both = [
        "delineate",
        &flight,
        "--to",
        &to,
        "--masks",
        &small,
        "--engine",
        "learned",
    ];
    let refused = fragscale(&both);
    let error = String::from_utf8_lossy(&refused.stderr);
    assert!(
        !refused.status.success() && error.contains("cannot be used with"),
        "{error}"
    );
    let error = error_of(&[
        "delineate",
        &flight,
        "--to",
        &to,
        "--masks",
        &path("none.json"),
    ]);
    assert!(error.contains("there is no such file"), "{error}");
}
