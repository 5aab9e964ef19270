//! Outlines of other tools in place of an engine's, as a user gives them.

use std::fs;
use std::path::Path;

use crate::common::{error_of, fragscale, stdout_of};

fn sample() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    folder.to_string_lossy().into_owned()
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
    // By other steps than an engine's, and which photo they are of is said.
    assert!(
        text.ends_with("steps to the mass (masks): edges, pores and fines\n"),
        "{text}"
    );
    let to_again = path("said");
    let said = arguments(&path("coco.json"), &to_again);
    let said = fragscale(&said.iter().map(String::as_str).collect::<Vec<_>>());
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(
        said.contains("taken as outlines of the photo as shot"),
        "{said}"
    );
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
    // A folder has files named as the photos; photos and files without each other are said.
    let folder_of = path("masks");
    fs::create_dir(&folder_of).expect("a folder");
    fs::copy(
        Path::new(&to).join("IMG_0005_labels.png"),
        Path::new(&folder_of).join("IMG_0005_mask.png"),
    )
    .expect("a copy");
    fs::copy(
        Path::new(&to).join("IMG_0005_labels.png"),
        Path::new(&folder_of).join("IMG_0099_mask.png"),
    )
    .expect("a copy");
    let all = path("all");
    let done = fragscale(&["delineate", &flight, "--to", &all, "--masks", &folder_of]);
    assert!(done.status.success());
    let said = String::from_utf8_lossy(&done.stderr);
    for wanted in [
        "8 of 9 photos have no outlines among those of --masks, and are left out: IMG_0001.jpg",
        "1 of --masks is of no photo of the flight: IMG_0099_mask.png",
    ] {
        assert!(said.contains(wanted), "{said}");
    }
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

/// The columns of a table by their heads.
fn columns(path: &Path, heads: &[&str]) -> Vec<Vec<String>> {
    let mut table = csv::Reader::from_path(path).expect("a table");
    let of_table = table.headers().expect("heads").clone();
    let place = |head: &&str| {
        of_table
            .iter()
            .position(|own| own == *head)
            .expect("a column")
    };
    let places: Vec<usize> = heads.iter().map(place).collect();
    let rows = table.records().map(|row| row.expect("a row"));
    rows.map(|row| places.iter().map(|at| row[*at].to_owned()).collect())
        .collect()
}

/// A photo of the bundled flight, delineated.
fn delineated(photo: &str, to: &str, rest: &[&str]) -> std::process::Output {
    let flight = sample();
    let own = ["delineate", &flight, "--photo", photo, "--to", to];
    fragscale(&[&own[..], rest].concat())
}

/// The same by outlines of another tool.
fn measured(photo: &str, masks: &str, to: &str, rest: &[&str]) -> std::process::Output {
    delineated(photo, to, &[&["--masks", masks], rest].concat())
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

/// Discs that are alike in the photo: nothing is claimed below the smallest of them and all above it, and P20, P50 and P80 are
/// those of the list of fragments, gone through here one by one. As a newcomer found, whose discs were hidden by a limit of
/// another measure.
#[test]
fn the_limit_is_the_smallest_outline() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let mut labels = image::ImageBuffer::<image::Luma<u16>, Vec<u16>>::new(1280, 720);
    let places = (0..240u32).map(|of| [40 + of % 20 * 62, 35 + of / 20 * 58]);
    for (number, [x, y]) in (1..).zip(places) {
        for (column, row) in (0..45 * 45).map(|at| (x + at % 45, y + at / 45)) {
            let off = |at: u32, middle: u32| f64::from(at) - f64::from(middle) - 22.0;
            if off(column, x).hypot(off(row, y)) <= 22.0 && column < 1280 && row < 720 {
                labels.put_pixel(column, row, image::Luma([number]));
            }
        }
    }
    labels.save(path("IMG_0005_labels.png")).expect("a picture");
    let to = path("out");
    let [masks, to_text] =
        [path("IMG_0005_labels.png"), to.clone()].map(|path| path.to_string_lossy().into_owned());
    let run = |steps: &str| {
        let rest = [
            "--masks-of",
            "undistorted",
            "--unit",
            "mm",
            "--steps",
            steps,
        ];
        measured("IMG_0005.jpg", &masks, &to_text, &rest)
    };
    assert!(run("none").status.success());
    let mut fragments: Vec<[f64; 2]> = columns(
        &to.join("fragments.csv"),
        &["cut", "sieve_size_mm", "area_mm2"],
    )
    .into_iter()
    .filter(|row| row[0] == "no")
    .map(|row| [number(&row[1]), number(&row[2])])
    .collect();
    fragments.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert!(fragments.len() > 200, "{}", fragments.len());
    let total: f64 = fragments.iter().map(|of| of[1]).sum();
    let curve = columns(
        &to.join("distribution.csv"),
        &["size_mm", "percent_passing"],
    );
    assert_eq!(number(&curve[0][0]), fragments[0][0]);
    for row in &curve {
        let [size, percent] = [&row[0], &row[1]].map(|text| number(text));
        let passing = fragments.iter().filter(|of| of[0] <= size).map(|of| of[1]);
        assert!(
            (100.0 * passing.sum::<f64>() / total - percent).abs() < 1e-6,
            "{size}"
        );
    }
    let sizes = columns(&to.join("sizes.csv"), &["percent_passing", "size_mm"]);
    for row in &sizes {
        let mut passed = 0.0;
        let reached = fragments.iter().position(|of| {
            passed += of[1];
            100.0 * passed / total >= number(&row[0])
        });
        let reached = reached.expect("it is reached");
        let between = fragments[reached - 1][0]..=fragments[reached][0];
        assert!(
            between.contains(&number(&row[1])),
            "P{}: {}, not {between:?}",
            row[0],
            row[1]
        );
    }
    // With half of the photo as fines P20 is below what is outlined: that is said, and so it is of the fit.
    let done = run("edges,fines");
    let text = String::from_utf8_lossy(&done.stdout);
    assert!(
        done.status.success() && text.contains("-: below what the photos show"),
        "{text}"
    );
    let fit = stdout_of(&["psd", "fit", &to.join("distribution.csv").to_string_lossy()]);
    assert!(fit.contains("P10, P20, P50 and what is computed"), "{fit}");
}

/// An empty label image is refused before anything is written, and what another run left in the folder is said.
#[test]
fn nothing_outlined_and_left_over() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let [empty, one] = [path("empty.png"), path("one.png")];
    let mut labels = image::GrayImage::new(1280, 720);
    labels.save(&empty).expect("a picture");
    for (x, y) in (0..10_000).map(|at| (600 + at % 100, 300 + at / 100)) {
        labels.put_pixel(x, y, image::Luma([1]));
    }
    labels.save(&one).expect("a picture");
    let to = path("out");
    let run = |photo: &str, masks: &str| measured(photo, masks, &to, &["--also", "coco"]);
    let done = run("IMG_0005.jpg", &empty);
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(1));
    assert_eq!(said.matches("error: ").count(), 1, "{said}");
    let words = "no fragment of IMG_0005.jpg is outlined in it, only fines or background";
    assert!(said.contains(words), "{said}");
    assert!(!Path::new(&to).exists());
    assert!(run("IMG_0004.jpg", &one).status.success());
    let done = run("IMG_0005.jpg", &one);
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    for wanted in ["3 files in ", "IMG_0004_labels.png", "are of another run"] {
        assert!(said.contains(wanted), "{wanted} in {said}");
    }
}

/// Outlines of a folder are read: they are not written over, though fragscale wrote them. Options that would have no effect are
/// refused, and a file that is named as another photo's outlines is said.
#[test]
fn what_is_read_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let flight = sample();
    let mut labels = image::GrayImage::new(1280, 720);
    // Two stones and a speck, which is too small to say what is seen.
    let stones = (0..10_000).map(|at| (600 + at % 100, 300 + at / 100, 1));
    let stones = stones.chain((0..2500).map(|at| (200 + at % 50, 300 + at / 50, 2)));
    for (x, y, number) in stones.chain([(100, 100, 3)]) {
        labels.put_pixel(x, y, image::Luma([number]));
    }
    labels.save(path("IMG_0004_labels.png")).expect("a picture");
    let to = path("out");
    let run = |photo: &str, masks: &str, rest: &[&str]| measured(photo, masks, &to, rest);
    let done = run(
        "IMG_0005.jpg",
        &path("IMG_0004_labels.png"),
        &["--unit", "mm"],
    );
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    for wanted in [
        "IMG_0004_labels.png is named as the outlines of IMG_0004.jpg",
        "1 outline of less than 10 pixels across: too small to be measured, and below the limit",
    ] {
        assert!(said.contains(wanted), "{said}");
    }
    let sizes = columns(
        &Path::new(&to).join("fragments.csv"),
        &["pixels", "sieve_size_mm"],
    );
    let of_second = sizes
        .iter()
        .find(|row| (2000.0..3000.0).contains(&number(&row[0])));
    let curve = columns(&Path::new(&to).join("distribution.csv"), &["size_mm"]);
    assert_eq!(curve[0][0], of_second.expect("the second stone")[1]);

    let before = fs::read(Path::new(&to).join("IMG_0005_labels.png")).expect("labels");
    let refused = |rest: &[&str], wanted: &str| {
        let done = run("IMG_0005.jpg", &to, rest);
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(!done.status.success() && said.contains(wanted), "{said}");
    };
    refused(&[], "IMG_0005_labels.png");
    refused(
        &["--steps", "edges", "--porosity", "0.3"],
        "--porosity is for the step pores",
    );
    refused(
        &["--steps", "none", "--tail", "swebrec"],
        "--tail is of the fines",
    );
    let after = fs::read(Path::new(&to).join("IMG_0005_labels.png")).expect("labels");
    assert!(before == after);
    // No outlines are saved beside the bundled flight.
    let error = error_of(&[
        "delineate",
        &flight,
        "--engine",
        "saved",
        "--to",
        &path("saved"),
    ]);
    assert!(
        error.contains("no outlines of these photos are saved"),
        "{error}"
    );
}

/// Two cards with a photo of one name on each, as cameras begin a folder anew: each photo has the outlines of its own folder, and one
/// whose folder has none is left out.
#[test]
fn photos_of_one_name_on_two_cards() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let words = |name: &str| path(name).to_string_lossy().into_owned();
    let of_sample = |name: &str| Path::new(&sample()).join(name);
    for name in ["flight.toml", "pile.ply", "ost.yaml"] {
        fs::copy(of_sample(name), path(name)).expect("a copy");
    }
    let mut poses = fs::read_to_string(of_sample("poses.csv")).expect("poses");
    for (card, photo) in [("100MEDIA", "IMG_0005.jpg"), ("101MEDIA", "IMG_0004.jpg")] {
        let name = format!("{card}/DJI_0001.jpg");
        fs::create_dir_all(path("photos").join(card)).expect("a folder");
        let to = path("photos").join(&name);
        fs::copy(of_sample("photos").join(photo), to).expect("a copy");
        poses = poses.replace(photo, &name);
    }
    let is_of_card = |line: &&str| line.starts_with("photo,") || line.contains("MEDIA/");
    let poses: Vec<&str> = poses.lines().filter(is_of_card).collect();
    fs::write(path("poses.csv"), poses.join("\n") + "\n").expect("poses");
    let write = |card: &str, side: u32| {
        let mut labels = image::GrayImage::new(1280, 720);
        for (x, y) in (0..side * side).map(|at| (600 + at % side, 300 + at / side)) {
            labels.put_pixel(x, y, image::Luma([1]));
        }
        let to = path("masks").join(card);
        fs::create_dir_all(&to).expect("a folder");
        labels.save(to.join("DJI_0001_labels.png")).expect("labels");
    };
    let run = |to: &str| {
        let [flight, masks, to] = ["flight.toml", "masks", to].map(words);
        let own = ["delineate", &flight, "--to", &to, "--masks", &masks];
        fragscale(&[&own[..], &["--masks-of", "undistorted"]].concat())
    };
    let pixels = |to: &str, card: &str| {
        let labels = path(to).join(format!("{card}_DJI_0001_labels.png"));
        let labels = image::open(labels).expect("labels").into_luma16();
        labels.pixels().filter(|pixel| pixel.0 == [1]).count()
    };
    write("100MEDIA", 100);
    let done = run("one");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    let left_out = "1 of 2 photos have no outlines among those of --masks, and are left out: \
                    101MEDIA/DJI_0001.jpg";
    assert!(said.contains(left_out), "{said}");
    assert_eq!(pixels("one", "100MEDIA"), 10_000);
    write("101MEDIA", 60);
    let done = run("both");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert_eq!(pixels("both", "100MEDIA"), 10_000);
    assert_eq!(pixels("both", "101MEDIA"), 3600);
}

/// A photo in which nothing is outlined does not count in all photos together, and that is said.
#[test]
fn an_empty_photo_is_no_fines() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let mut labels = image::GrayImage::new(1280, 720);
    labels.save(path("IMG_0004_labels.png")).expect("a picture");
    for (number, left) in (1..).zip([100, 300, 500, 800]) {
        let side = 30 + 20 * u32::from(number);
        for (x, y) in (0..side * side).map(|at| (left + at % side, 200 + at / side)) {
            labels.put_pixel(x, y, image::Luma([number]));
        }
    }
    labels.save(path("IMG_0005_labels.png")).expect("a picture");
    let [masks, to] =
        [folder.path().to_owned(), path("out")].map(|path| path.to_string_lossy().into_owned());
    let done = fragscale(&["delineate", &sample(), "--masks", &masks, "--to", &to]);
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(
        said.contains(
            "IMG_0004.jpg: no size distribution, and it does not count in that of all photos"
        ),
        "{said}"
    );
    let sizes = columns(
        &path("out").join("sizes.csv"),
        &["photo", "percent_passing", "size_cm"],
    );
    let of = |photo: &str| -> Vec<[String; 2]> {
        let rows = sizes.iter().filter(|row| row[0] == photo);
        rows.map(|row| [row[1].clone(), row[2].clone()]).collect()
    };
    assert_eq!(of("all photos"), of("IMG_0005.jpg"));
    assert!(!of("IMG_0005.jpg").is_empty() && of("IMG_0004.jpg").is_empty());
}

/// The learned engine's sizes are taken 1.01 times smaller, all of them, and the limit with them; the list of fragments has them
/// as they are outlined.
#[test]
fn the_step_engine_from_end_to_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |name: &str, steps: &str| {
        let to = folder.path().join(name);
        let rest = ["--engine", "learned", "--steps", steps];
        let done = delineated("IMG_0001.jpg", &to.to_string_lossy(), &rest);
        assert!(done.status.success());
        let curve = columns(
            &to.join("distribution.csv"),
            &["size_cm", "percent_passing"],
        );
        let sizes = columns(&to.join("fragments.csv"), &["sieve_size_cm"]);
        // The limit is where the curve begins.
        for limit in columns(&to.join("sizes.csv"), &["limit_cm"]) {
            assert_eq!(limit[0], curve[0][0]);
        }
        // The ball of these photos, which no scale object traces.
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(
            said.contains("IMG_0001.jpg: its largest fragment is a circle"),
            "{said}"
        );
        (
            number(&curve[0][0]),
            number(&curve[curve.len() - 1][0]),
            sizes,
        )
    };
    let (limit, largest, fragments) = run("without", "edges,fines");
    let (limit_with, largest_with, fragments_with) = run("with", "edges,engine,fines");
    assert!((limit / limit_with - 1.01).abs() < 1e-9);
    assert!((largest / largest_with - 1.01).abs() < 1e-9);
    assert_eq!(fragments, fragments_with);
}
