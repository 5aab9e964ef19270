//! Fragments of the bundled flight, as a user asks for them.

use std::fs;
use std::path::Path;

use crate::common::{error_of, fragscale, stdout_of};

fn sample() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    folder.to_string_lossy().into_owned()
}

/// What the review leaves out counts in no sizes; named, it is taken all the same.
#[test]
fn photos_that_are_left_out_count_nowhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let from = Path::new(&sample()).to_owned();
    let mut text = fs::read_to_string(from.join("flight.toml")).expect("the flight");
    for number in 1..=8 {
        text +=
            &format!("\n[[review]]\nphoto = \"IMG_000{number}.jpg\"\ndecision = \"left-out\"\n");
    }
    for name in ["poses.csv", "pile.ply", "ost.yaml"] {
        fs::copy(from.join(name), folder.path().join(name)).expect("a copy");
    }
    fs::create_dir(folder.path().join("photos")).expect("a folder");
    for number in 1..=9 {
        let name = format!("photos/IMG_000{number}.jpg");
        fs::copy(from.join(&name), folder.path().join(&name)).expect("a copy");
    }
    let flight = folder.path().join("flight.toml");
    fs::write(&flight, text).expect("written");
    let outlined = |more: &[&str], name: &str| -> Vec<String> {
        let to = folder.path().join(name);
        let [flight, to_text] = [&flight, &to].map(|path| path.to_str().expect("UTF-8"));
        let arguments = [
            "delineate",
            flight,
            "--engine",
            "classical",
            "--to",
            to_text,
        ];
        let output = crate::common::fragscale(&[&arguments, more].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(
            said.contains("the review leaves 8 out of 9"),
            more.is_empty(),
            "{said}"
        );
        let sizes = fs::read_to_string(to.join("sizes.csv")).expect("sizes");
        let photos = sizes.lines().skip(1).filter(|line| line.starts_with("IMG"));
        // A line a percentile.
        let mut photos: Vec<String> = photos.map(|line| line.chars().take(12).collect()).collect();
        photos.dedup();
        photos
    };
    assert_eq!(outlined(&[], "all"), ["IMG_0009.jpg"]);
    assert_eq!(
        outlined(&["--photo", "IMG_0004.jpg"], "one"),
        ["IMG_0004.jpg"]
    );
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
    assert!(
        text.ends_with("steps to the mass (classical): edges and fines\n"),
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
            "method,photo,size_mm,percent_passing,area_mm2\nfragscale (classical),IMG_0005.jpg,"
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
    let steps = ["--to", &to, "--steps", "none,edges"];
    let error = error_of(&[&["delineate", &flight][..], &steps].concat());
    assert!(
        error.contains("--steps: none goes with no other"),
        "{error}"
    );
    // Pictures beside photos are taken for photos the next time.
    let photos = "assets/sample/photos";
    for command in [
        &["delineate", &flight, "--to", photos][..],
        &["rectify", &flight, "--all", "--to", photos],
        &["scale-map", &flight, "--all", "-o", photos],
    ] {
        let error = error_of(command);
        assert!(error.contains("the flight's photos lie in it"), "{error}");
    }
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

/// A folder with the bundled flight's first two photos.
fn two_photos(folder: &Path) -> String {
    let from = sample();
    let from = Path::new(&from);
    for file in ["flight.toml", "pile.ply", "ost.yaml"] {
        fs::copy(from.join(file), folder.join(file)).expect("a copy");
    }
    let poses = fs::read_to_string(from.join("poses.csv")).expect("poses");
    let is_kept = |line: &&str| {
        !line.starts_with("IMG_") || line.starts_with("IMG_0001") || line.starts_with("IMG_0002")
    };
    let poses: Vec<&str> = poses.lines().filter(is_kept).collect();
    fs::write(folder.join("poses.csv"), poses.join("\n") + "\n").expect("poses");
    fs::create_dir(folder.join("photos")).expect("a folder");
    for photo in ["IMG_0001.jpg", "IMG_0002.jpg"] {
        let photo = Path::new("photos").join(photo);
        fs::copy(from.join(&photo), folder.join(&photo)).expect("a copy");
    }
    folder.join("flight.toml").to_string_lossy().into_owned()
}

/// All files of a folder, by name.
fn files_of(folder: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder");
    let files = entries.map(|entry| {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        (name, fs::read(&path).expect("a file"))
    });
    files.collect()
}

/// What was stopped goes on with the photos that are not done, and ends with the same bytes as what was not; a photo or an
/// option that changed meanwhile is done anew.
#[test]
fn what_was_stopped_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight_of = tempfile::tempdir().expect("a folder");
    let flight = two_photos(flight_of.path());
    let second = flight_of.path().join("photos/IMG_0002.jpg");
    let away = flight_of.path().join("away.jpg");
    let arguments = |to: &Path, shape: &str| -> Vec<String> {
        let to = to.to_string_lossy();
        let own = ["delineate", &flight, "--to", &to, "--shape", shape];
        let rest = [
            "--engine",
            "classical",
            "--also",
            "coco,tiff",
            "--steps",
            "edges,pores,fines",
        ];
        own.into_iter().chain(rest).map(str::to_owned).collect()
    };
    let go = |to: &Path, shape: &str| {
        let arguments = arguments(to, shape);
        stdout_of(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let stop = |to: &Path, shape: &str| {
        let arguments = arguments(to, shape);
        error_of(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let whole = folder.path().join("whole");
    let text = go(&whole, "calibrated");
    let stopped = folder.path().join("stopped");
    fs::rename(&second, &away).expect("moved");
    let error = stop(&stopped, "calibrated");
    assert!(
        error.contains("1 of 2 photos are not delineated"),
        "{error}"
    );
    let kept = stopped.join("unfinished/IMG_0001.json");
    assert!(kept.is_file());
    // So that it is seen whether the first one is made again.
    let label = stopped.join("IMG_0001_labels.png");
    let written = |path: &Path| {
        fs::metadata(path)
            .expect("a file")
            .modified()
            .expect("a time")
    };
    let before = written(&label);
    fs::rename(&away, &second).expect("moved back");
    assert_eq!(go(&stopped, "calibrated"), text);
    assert_eq!(written(&label), before);
    assert!(!stopped.join("unfinished").exists());
    let (one, other) = (files_of(&whole), files_of(&stopped));
    assert_eq!(
        one.keys().collect::<Vec<_>>(),
        other.keys().collect::<Vec<_>>()
    );
    for (name, bytes) in &one {
        assert!(other[name] == *bytes, "{name}");
    }
    let names: Vec<&str> = one.keys().map(String::as_str).collect();
    for wanted in [
        "report.html",
        "IMG_0001_world.geojson",
        "fragments_coco.json",
        "IMG_0002_labels.tif",
    ] {
        assert!(names.contains(&wanted), "{names:?}");
    }
    // Another shape of sieves is another result: nothing of it is taken.
    fs::rename(&second, &away).expect("moved");
    stop(&stopped, "circle");
    fs::rename(&away, &second).expect("moved back");
    go(&stopped, "calibrated");
    for (name, bytes) in files_of(&stopped) {
        assert!(one[&name] == bytes, "{name}");
    }
    let html = String::from_utf8(one["report.html"].clone()).expect("text");
    for wanted in [
        "From fragments to mass",
        "pores: ",
        "IMG_0002.jpg",
        "data:image/jpeg;base64,",
        "<svg",
    ] {
        assert!(html.contains(wanted), "{wanted}");
    }
}

/// Outlines in the world are where the fragments of the table are, and as large; the lab has coordinates of its own.
#[test]
fn outlines_in_the_world() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("out");
    let to_text = to.to_string_lossy().into_owned();
    let flight = sample();
    stdout_of(&[
        "delineate",
        &flight,
        "--photo",
        "IMG_0005.jpg",
        "--to",
        &to_text,
        "--unit",
        "m",
        "--engine",
        "classical",
        "--tail",
        "swebrec",
    ]);
    let text = fs::read(to.join("IMG_0005_world.geojson")).expect("outlines");
    let value: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(value["coordinates"], "local, in m");
    let features = value["features"].as_array().expect("features");
    assert!(features.len() > 150);
    let (mut off, mut within) = (Vec::new(), 0);
    for feature in features
        .iter()
        .filter(|of| of["geometry"]["type"] == "Polygon")
    {
        let number = |of: &serde_json::Value| of.as_f64().expect("a number");
        let own = &feature["properties"];
        let ring = feature["geometry"]["coordinates"][0]
            .as_array()
            .expect("a ring");
        let places: Vec<[f64; 2]> = ring
            .iter()
            .map(|of| [number(&of[0]), number(&of[1])])
            .collect();
        let area: f64 = places
            .windows(2)
            .map(|pair| pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1])
            .sum();
        assert!(area > 0.0);
        let width = number(&own["feret_max_m"]);
        let [x, y] = [number(&own["x_m"]), number(&own["y_m"])];
        let far = places
            .iter()
            .map(|[px, py]| (px - x).hypot(py - y))
            .fold(0.0, f64::max);
        within += usize::from(far < 1.1 * width);
        // Seen from nearly straight above.
        off.push(0.5 * area / number(&own["area_m2"]));
    }
    // An outline that joins pixels of two heights lies on both.
    assert!(within * 20 > off.len() * 19, "{within} of {}", off.len());
    off.sort_by(f64::total_cmp);
    let median = off[off.len() / 2];
    assert!((0.9..1.05).contains(&median), "{median}");
    // They are no pixels.
    let world = to
        .join("IMG_0005_world.geojson")
        .to_string_lossy()
        .into_owned();
    let error = error_of(&[
        "delineate",
        &flight,
        "--photo",
        "IMG_0005.jpg",
        "--to",
        &to_text,
        "--masks",
        &world,
    ]);
    assert!(error.contains("its places are local, in m"), "{error}");
    // The law goes on below what was seen.
    let curve = fs::read_to_string(to.join("distribution.csv")).expect("a curve");
    let rows: Vec<[f64; 2]> = curve
        .lines()
        .skip(1)
        .map(|row| {
            let number = |place| row.split(',').nth(place).and_then(|text| text.parse().ok());
            [number(2), number(3)].map(|of: Option<f64>| of.expect("a number"))
        })
        .collect();
    // Three decades below it, in steps of a tenth of a decade, each with less of the mass.
    let limit = rows[30];
    let [size, percent] = rows[0];
    assert!((size * 1000.0 / limit[0] - 1.0).abs() < 1e-9, "{rows:?}");
    assert!(percent < 0.2 * limit[1], "{rows:?}");
    assert!(rows[..=30].is_sorted_by(|a, b| a[0] < b[0] && a[1] < b[1]));
}

/// A network of the user's: our own one, described as if it were a stranger's, outlines nearly the same. (Its maps are the
/// same to the bit, which a test of the engine holds; its votes are not taken.)
#[test]
fn a_network_of_the_users() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let flight = sample();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::copy(
        root.join("assets/delineation/fragments.onnx"),
        path("theirs.onnx"),
    )
    .expect("a copy");
    let described = "model = 'theirs.onnx'\n[input]\nnormalize = 'photo'\ntile = 1152\nmargin = 64\nmultiple = 32\nsizes = [1, 2, 4]\n\
        [[output]]\nis = 'border'\n[[output]]\nis = 'inside'\nchannel = 1\n[[output]]\nis = 'middle'\nchannel = 2\n";
    fs::write(path("theirs.toml"), described).expect("a description");
    let run = |engine: &str, to: &str| {
        stdout_of(&[
            "delineate",
            &flight,
            "--photo",
            "IMG_0002.jpg",
            "--to",
            to,
            "--engine",
            engine,
        ])
    };
    run(&path("theirs.toml"), &path("theirs"));
    run("learned", &path("ours"));
    let [theirs, ours] = ["theirs", "ours"]
        .map(|to| fs::read(Path::new(&path(to)).join("IMG_0002_labels.png")).expect("labels"));
    let of_rock = |bytes: &[u8]| -> Vec<bool> {
        let image = image::load_from_memory(bytes).expect("an image");
        let labels = image.into_luma16().into_raw();
        labels
            .iter()
            .map(|label| (1..u16::MAX).contains(label))
            .collect()
    };
    let pairs = of_rock(&theirs).into_iter().zip(of_rock(&ours));
    let (both, either) = pairs.fold((0, 0), |(both, either), (one, other)| {
        (
            both + u32::from(one && other),
            either + u32::from(one || other),
        )
    });
    assert!(both > 300_000, "{both}");
    assert!(
        f64::from(both) > 0.85 * f64::from(either),
        "{both} {either}"
    );
    let curve =
        fs::read_to_string(Path::new(&path("theirs")).join("distribution.csv")).expect("a curve");
    assert!(
        curve.contains("\nfragscale (theirs),IMG_0002.jpg,"),
        "{curve}"
    );
    let refused = |engine: &str| {
        let refused = fragscale(&[
            "delineate",
            &flight,
            "--to",
            &path("none"),
            "--engine",
            engine,
        ]);
        assert!(!refused.status.success());
        String::from_utf8_lossy(&refused.stderr).into_owned()
    };
    assert!(refused(&path("theirs.onnx")).contains("a model needs a description"));
    assert!(refused(&path("none.toml")).contains("none.toml: there is no such file"));
    assert!(refused("sam").contains("learned, classical, saved, or a TOML file"));
    fs::write(
        path("no_model.toml"),
        described.replace("theirs.onnx", "gone.onnx"),
    )
    .expect("a description");
    assert!(refused(&path("no_model.toml")).contains("gone.onnx: there is no such file"));
    fs::write(path("broken.onnx"), &ours).expect("no model");
    fs::write(
        path("broken.toml"),
        described.replace("theirs.onnx", "broken.onnx"),
    )
    .expect("a description");
    let error = refused(&path("broken.toml"));
    assert!(
        error.contains("broken.onnx: this model cannot be run")
            && error.trim_end().lines().count() == 1,
        "{error}"
    );
    assert!(!Path::new(&path("none")).exists());
}
