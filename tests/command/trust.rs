//! No wrong number that looks right: photos whose size nobody knows, models without a unit, photos that
//! were exchanged, files that cannot be read. Every scale here has an answer in closed form: nadir
//! photos of a plane, whose scale is the focal length in pixels over the height.

use crate::own_frame;
use crate::wrong_pile;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{fragscale, scales_json};
use fragscale::flight::{Doubt, Limits, PhotoReview, Review, Verdict};
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, Opened, open_flight};

/// Of the cameras over the plane, metres.
const HEIGHT: f64 = 40.0;

/// Focal length over the image's width.
const FOCAL: f64 = 0.8;

const PHOTOS: [&str; 3] = ["DJI_0025.JPG", "DJI_0026.JPG", "DJI_0027.JPG"];

/// Runs the command, which must end with that status; standard output and standard error.
fn run(status: i32, arguments: &[&str]) -> (String, String) {
    let output = fragscale(arguments);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    let (out, err) = (text(output.stdout), text(output.stderr));
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {err}");
    (out, err)
}

fn text_of(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// OpenSfM's reconstruction.json: three nadir photos over a plane at z = 0, in metres, solved on images
/// of this size.
fn opensfm(folder: &Path, (width, height): (u32, u32), camera: &str) -> PathBuf {
    let mut shots = Vec::new();
    for (i, photo) in PHOTOS.iter().enumerate() {
        // R = diag(1, -1, -1), t = -R c with c = (10 i, 5, HEIGHT).
        let x = 10.0 * i as f64;
        shots.push(format!(
            r#""{photo}": {{"camera": "{camera}", "rotation": [{}, 0, 0], "translation": [{}, 5, {HEIGHT}]}}"#,
            std::f64::consts::PI,
            -x
        ));
    }
    let mut points = Vec::new();
    for i in 0..31 * 31 {
        let (x, y) = (
            f64::from(i % 31) * 4.0 - 50.0,
            f64::from(i / 31) * 4.0 - 55.0,
        );
        points.push(format!(
            r#""{i}": {{"coordinates": [{x}, {y}, 0], "color": [90, 90, 90]}}"#
        ));
    }
    let text = format!(
        r#"[{{"cameras": {{"{camera}": {{"projection_type": "perspective", "width": {width}, "height": {height}, "focal": {FOCAL}, "k1": 0, "k2": 0}}}},
            "shots": {{{}}}, "points": {{{}}},
            "reference_lla": {{"latitude": 47.123456, "longitude": 11.654321, "altitude": 600.25}}}}]"#,
        shots.join(", "),
        points.join(", ")
    );
    let path = folder.join("reconstruction.json");
    fs::write(&path, text).expect("written");
    path
}

/// An image file of that size; its ending does not matter, its first bytes do.
fn image(path: &Path, (width, height): (u32, u32)) {
    fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    let file = fs::File::create(path).expect("made");
    image::RgbImage::new(width, height)
        .write_to(&mut std::io::BufWriter::new(file), image::ImageFormat::Png)
        .expect("written");
}

fn opened(path: &Path, photos: Option<&Path>) -> Result<Opened, String> {
    let options = OpenOptions {
        photos: photos.map(Path::to_owned),
        ..OpenOptions::default()
    };
    open_flight(path, &options, &Progress::default()).map_err(|error| error.to_string())
}

/// The review that the export makes, and the window piece by piece.
fn review(opened: &Opened) -> Review {
    let reviewed = opened.review(&Limits::default(), &Progress::default());
    reviewed.expect("a review")
}

#[test]
fn scales_for_reduced_photos_say_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera = "v2 dji fc6310 400 300 perspective 0.8";
    let model = opensfm(folder.path(), (400, 300), camera);
    let words = "for images of 400 px width, not for the photos";
    let (csv, err) = run(0, &["scales", text_of(&model), "--format", "csv"]);
    assert!(err.contains(words), "{err}");
    // Among the reasons and in the note.
    assert_eq!(csv.matches(words).count(), 2 * PHOTOS.len(), "{csv}");
    let to = folder.path().join("export");
    let (_, err) = run(0, &["export", text_of(&model), "--to", text_of(&to)]);
    assert!(err.contains(words), "{err}");
    let sheet = fs::read_to_string(to.join("scales.html")).expect("the sheet");
    assert!(
        sheet.contains(words) && !sheet.contains(">trust<"),
        "{sheet}"
    );
    assert_eq!(sheet.matches("at 400 px width").count(), 2 * PHOTOS.len());
    // With the photos there it is their scale, ten times as large.
    for photo in PHOTOS {
        image(&folder.path().join("photos").join(photo), (4000, 3000));
    }
    let photos = folder.path().join("photos");
    let report = scales_json(&model, &["--photo-folder", text_of(&photos), "--unit", "m"]);
    for photo in report["photos"].as_array().expect("photos") {
        assert_eq!(photo["width"], 4000);
        let top = crate::common::scale(photo, "top").expect("a scale");
        assert!(
            (top / (FOCAL * 4000.0 / HEIGHT) - 1.0).abs() < 1e-9,
            "{top}"
        );
    }
}

/// Where the camera's name or the package's list of images tells the photos' own size, it is named.
#[test]
fn the_size_that_the_package_names_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera = "v2 dji fc6310 5472 4104 perspective 0.8";
    let opened = opened(&opensfm(folder.path(), (684, 513), camera), None).expect("opens");
    let review = review(&opened);
    let doubt = Doubt::ReducedPhotos {
        size: (684, 513),
        original: Some((5472, 4104)),
    };
    assert!(review.photos().all(|photo| photo.doubts.contains(&doubt)));
    assert!(doubt.to_string().contains("which have 5472 x 4104 px"));
}

/// OpenDroneMap lists the photos as they came in images.json.
#[test]
fn the_size_in_opendronemaps_list_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let below = folder.path().join("opensfm");
    fs::create_dir(&below).expect("made");
    opensfm(&below, (400, 300), "c");
    let camera = r#"{"c": {"projection_type": "perspective", "width": 400, "height": 300, "focal": 0.8, "k1": 0, "k2": 0}}"#;
    fs::write(folder.path().join("cameras.json"), camera).expect("written");
    let listed = PHOTOS.map(|photo| {
        format!(r#"{{"filename": "{photo}", "width": 4000, "height": 3000, "camera_make": "DJI"}}"#)
    });
    let list = format!("[{}]", listed.join(", "));
    fs::write(folder.path().join("images.json"), list).expect("written");
    let found = scales_json(folder.path(), &[]);
    assert_eq!(found["photos"][0]["width"], 400);
    let (csv, _) = run(0, &["scales", text_of(folder.path()), "--format", "csv"]);
    let words = "for images of 400 px width, not for the photos, which have 4000 x 3000 px";
    // Among the reasons and in the note.
    assert_eq!(csv.matches(words).count(), 2 * PHOTOS.len(), "{csv}");
}

/// Named just now it is a slip; in a flight.toml the disk may have gone since, and what can be seen without photos is.
#[test]
fn a_photo_folder_that_cannot_be_is_refused_or_the_flight_opened_without_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = opensfm(folder.path(), (40, 30), "c");
    let other = folder.path().join("other");
    image(&other.join("IMG_1.jpg"), (40, 30));
    image(&folder.path().join("card/north/IMG_2.jpg"), (40, 30));
    for within in ["a", "b"] {
        image(
            &folder.path().join("twice").join(within).join(PHOTOS[0]),
            (40, 30),
        );
    }
    let file = folder.path().join("file.txt");
    fs::write(&file, "x").expect("written");
    let flight = |photos: &str| {
        let text = format!(
            "format = 1\nworld.unit = \"m\"\n[photos]\nreconstruction = \"reconstruction.json\"\nfolder = \"{photos}\"\n"
        );
        let path = folder.path().join("flight.toml");
        fs::write(&path, text).expect("written");
        path
    };
    for (name, words) in [
        ("fotos", "there is no such folder"),
        (
            "file.txt",
            "a file, where the folder of the photos is needed",
        ),
        (
            "other",
            "it holds 1 images (img_1.jpg, ...), but none of the flight's 3 photos (DJI_0025.JPG, DJI_0026.JPG, ...)",
        ),
        (
            "card",
            "it holds no images itself, and in the folders within it (north) none of the flight's 3 photos (DJI_0025.JPG, DJI_0026.JPG, ...)",
        ),
    ] {
        let path = folder.path().join(name);
        let named = ["scales", text_of(&model), "--photo-folder", text_of(&path)];
        let (_, err) = run(1, &named);
        let remedy = "name the folder of the photos";
        assert_eq!(
            err,
            format!("error: {}: {words}; {remedy}\n", path.display())
        );
        let flight = flight(name);
        let (csv, err) = run(0, &["scales", text_of(&flight), "--format", "csv"]);
        let said = format!(
            "warning: {}: {words}, where the flight says that its photos are: it is opened without them, and their sizes are not \
             checked ({remedy})\n",
            path.display()
        );
        assert_eq!(err.matches(&said).count(), 1, "{err}");
        // Once among the reasons, once in the note.
        let missing = "for images of 40 px width, not for the photos: the package often solves on reduced photos, and the photo \
                       file is not there to compare";
        assert_eq!(csv.matches(missing).count(), 2 * PHOTOS.len(), "{csv}");
    }
    let twice = folder.path().join("twice");
    let (_, err) = run(
        1,
        &["scales", text_of(&model), "--photo-folder", text_of(&twice)],
    );
    let words = "several folders within it (a, b) have files called as the flight's photos (DJI_0025.JPG), and nothing says which";
    assert!(err.contains(words), "{err}");
}

/// Folders of an engineer's own below the one that she names: photos are found by their names there, and none whose name two of
/// them have. Solved on images of a tenth, whose scale would be a tenth.
#[test]
fn photos_in_folders_within_the_named_one_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = opensfm(folder.path(), (40, 30), "c");
    let named = folder.path().join("Fotos L\u{f6}ffel");
    for (within, photo) in [("sub1", 0), ("sub2", 1), ("sub1", 2), ("sub2", 2)] {
        image(&named.join(within).join(PHOTOS[photo]), (400, 300));
    }
    let arguments = [
        "scales",
        text_of(&model),
        "--photo-folder",
        text_of(&named),
        "--unit",
        "m",
        "--format",
        "json",
    ];
    let (json, err) = run(0, &arguments);
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let photos = report["photos"].as_array().expect("photos");
    for photo in photos {
        let top = crate::common::scale(photo, "top").expect("a scale");
        assert!((top / (FOCAL * 400.0 / HEIGHT) - 1.0).abs() < 1e-9, "{top}");
    }
    let missing =
        |photo: &serde_json::Value| photo.to_string().contains("the photo file is missing");
    let missing: Vec<bool> = photos.iter().map(missing).collect();
    assert_eq!(missing, [false, false, true], "{json}");
    for words in [
        "1 of 3 image files are missing (DJI_0027.JPG)",
        "several folders within it (sub1, sub2) have files called as the flight's photos (DJI_0027.JPG), and nothing says which of them are meant; name the folder",
        "(sub1/DJI_0027.JPG)",
    ] {
        assert!(err.contains(words), "{err}");
    }
}

/// Numbers that look random and are the same every time (Knuth's MMIX).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len() as u64) as usize]
    }
}

/// A model of a random kind, solved on images of `solved`.
fn random_model(dice: &mut Dice, folder: &Path, solved: (u32, u32)) -> PathBuf {
    let named = dice.of(&[Some(solved), Some((640, 480)), None]);
    let camera = named.map_or("c".to_owned(), |(w, h)| {
        format!("v2 a b {w} {h} perspective 0.8")
    });
    let model = opensfm(folder, solved, &camera);
    if dice.below(2) == 0 {
        return model;
    }
    // The same as a flight of one's own, which knows nothing of packages.
    let mut poses = "photo,x,y,z,tilt,pan\n".to_owned();
    for (i, photo) in PHOTOS.iter().enumerate() {
        writeln!(poses, "{photo},{},5,{HEIGHT},90,0", 10 * i).expect("written");
    }
    fs::write(folder.join("poses.csv"), poses).expect("written");
    let mut plane = String::new();
    for i in 0..31 * 31 {
        writeln!(plane, "{} {} 0", i % 31 * 4 - 50, i / 31 * 4 - 55).expect("written");
    }
    fs::write(folder.join("plane.xyz"), plane).expect("written");
    let ((w, h), f) = (solved, FOCAL * f64::from(solved.0));
    let text = format!(
        "format = 1\nworld.unit = \"m\"\n[surface]\nfile = \"plane.xyz\"\n[[camera]]\nwidth = {w}\nheight = {h}\nfx = {f}\nfy = {f}\ncx = {}\ncy = {}\n[photos]\nposes = \"poses.csv\"\n",
        f64::from(w) / 2.0,
        f64::from(h) / 2.0
    );
    let path = folder.join("flight.toml");
    fs::write(&path, text).expect("written");
    path
}

/// What became of the photos' folder.
const KINDS: [&str; 8] = [
    "there",
    "lower case",
    "other case of the ending",
    "doubled ending",
    "not named",
    "misspelt folder",
    "other photos",
    "only the first",
];

/// Where the file of a photo lies then.
fn file_of(kind: &str, name: &str) -> String {
    match kind {
        "lower case" => format!("Photos/{}", name.to_lowercase()),
        "other case of the ending" => format!("Photos/{}", name.replace("JPG", "jPg")),
        "doubled ending" => format!("Photos/{name}.tif"),
        "misspelt folder" => format!("Fotos/{name}"),
        "other photos" => format!("Photos/{}", name.replace("DJI", "IMG")),
        "only the first" if name != PHOTOS[0] => format!("elsewhere/{name}"),
        _ => format!("Photos/{name}"),
    }
}

/// 200 flights with the photos' folder there, missing, misspelt, in another case, with endings doubled,
/// empty, half there; solved on the photos or on reduced ones. Whatever is said is the photos' scale, or
/// it has its sentence and is not trusted.
#[test]
fn two_hundred_flights_never_give_a_wrong_scale_in_silence() {
    let mut seen = BTreeMap::<&str, usize>::new();
    let mut dice = Dice(12);
    for round in 0..200 {
        let folder = tempfile::tempdir().expect("a folder");
        let photo_size = (640, 480);
        let solved = dice.of(&[(640, 480), (320, 240), (64, 48)]);
        let path = random_model(&mut dice, folder.path(), solved);
        let photos = folder.path().join("Photos");
        let kind = dice.of(&KINDS);
        let is_named = kind != "not named";
        for name in PHOTOS {
            image(&folder.path().join(file_of(kind, name)), photo_size);
        }
        *seen.entry(kind).or_default() += 1;
        let found = opened(&path, is_named.then_some(photos.as_path()));
        let what = format!(
            "round {round}: {kind}, solved on {solved:?}, {}",
            path.display()
        );
        let opened = match (kind, found) {
            ("misspelt folder" | "other photos", Err(error)) => {
                assert!(
                    error.contains("name the folder of the photos"),
                    "{what}: {error}"
                );
                continue;
            }
            (_, found) => found.unwrap_or_else(|error| panic!("{what}: {error}")),
        };
        let review = review(&opened);
        let right = FOCAL * f64::from(photo_size.0) / HEIGHT;
        for (index, photo) in review.photos().enumerate() {
            let top = photo.edges(photo.unit).top.expect("a scale");
            let is_right = (top / right - 1.0).abs() < 1e-9;
            let is_there = is_named && (kind != "only the first" || index == 0);
            if is_there {
                assert!(is_right, "{what}: {top}");
                assert_eq!(photo.verdict, Verdict::Trust, "{what}: {:?}", photo.doubts);
                continue;
            }
            // One photo of a camera tells the size of all, but this one's own is still not known.
            assert_eq!(photo.verdict, Verdict::Check, "{what}");
            let about_size = photo.doubts.iter().any(|doubt| {
                matches!(
                    doubt,
                    Doubt::ReducedPhotos { .. }
                        | Doubt::FileMissing { .. }
                        | Doubt::NoPhotoFolder { .. }
                )
            });
            assert!(about_size, "{what}: {:?}", photo.doubts);
            let said = opened.all_warnings().join("\n");
            assert!(
                said.contains(" px") || said.contains("missing"),
                "{what}: {said}"
            );
        }
    }
    assert_eq!(seen.len(), KINDS.len(), "{seen:?}");
}

/// One photo of nine megapixels that is an empty file does not refuse the other two.
#[test]
fn an_unreadable_photo_is_left_out_of_a_bundler_flight() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut bundle = "# Bundle file v0.3\n3 4\n".to_owned();
    for i in 0..3 {
        // Bundler looks along -z: nadir is R = identity, t = -c.
        writeln!(
            bundle,
            "320 0 0\n1 0 0\n0 1 0\n0 0 1\n{} -5 {}",
            -10 * i,
            -HEIGHT
        )
        .expect("written");
    }
    for [x, y] in [[-200, -200], [200, -200], [-200, 200], [200, 200]] {
        writeln!(bundle, "{x} {y} 0\n9 9 9\n0").expect("written");
    }
    fs::write(folder.path().join("bundle.out"), bundle).expect("written");
    fs::write(folder.path().join("list.txt"), "a.jpg\nb.jpg\nc.jpg\n").expect("written");
    for name in ["a.jpg", "c.jpg"] {
        image(&folder.path().join(name), (400, 300));
    }
    fs::write(folder.path().join("b.jpg"), "").expect("written");
    let model = folder.path().join("bundle.out");
    let (json, err) = run(
        0,
        &["scales", text_of(&model), "--unit", "m", "--format", "json"],
    );
    assert!(err.contains("photo 'b.jpg' is left out"), "{err}");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let photos = report["photos"].as_array().expect("photos");
    let names: Vec<&str> = photos
        .iter()
        .map(|p| p["photo"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, ["a.jpg", "c.jpg"]);
    for photo in photos {
        let top = crate::common::scale(photo, "top").expect("a scale");
        assert!((top / (320.0 / HEIGHT) - 1.0).abs() < 1e-9, "{top}");
    }
}

#[test]
fn a_model_without_a_unit_has_no_scale() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = folder.path().join("model");
    fs::create_dir(&model).expect("made");
    own_frame::model(&model);
    // Only the photos' files are there: their size is known, the unit is not.
    for i in 1..=5 {
        image(&model.join(format!("IMG_{i}.JPG")), (800, 600));
    }
    let folder_of_photos = ["--photo-folder", text_of(&model)];
    let report = scales_json(&model, &folder_of_photos);
    assert_eq!(report["unit_known"], false);
    let words = "whose unit nobody states";
    let arguments = [
        "scales",
        text_of(&model),
        "--photo-folder",
        text_of(&model),
        "--format",
        "csv",
    ];
    let (csv, err) = run(0, &arguments);
    assert!(err.contains(words), "{err}");
    assert_eq!(csv.matches(words).count(), 10, "{csv}");
    let to = folder.path().join("export");
    let mut arguments = vec!["export", text_of(&model), "--to", text_of(&to)];
    arguments.extend(folder_of_photos);
    let (_, err) = run(0, &arguments);
    assert!(err.contains(words), "{err}");
    let sheet = fs::read_to_string(to.join("scales.html")).expect("the sheet");
    assert_eq!(
        sheet
            .matches("<div class=\"big missing\">no scale</div>")
            .count(),
        10
    );
    assert!(!sheet.contains("<div class=\"big\">") && !sheet.contains(">trust<"));
    arguments.extend(["--photos", "trusted"]);
    let (_, err) = run(1, &arguments);
    assert!(err.contains("is without doubt"), "{err}");
    // A flight.toml that states the unit is believed, one that says "unknown" is not.
    for (unit, known) in [("m", true), ("unknown", false)] {
        let text = format!(
            "format = 1\nworld.unit = \"{unit}\"\nphotos.reconstruction = \"model\"\nphotos.folder = \"model\"\n"
        );
        let path = folder.path().join("flight.toml");
        fs::write(&path, text).expect("written");
        let unit_known = &scales_json(&path, &[])["unit_known"];
        assert_eq!(*unit_known == false, !known, "{unit_known}");
        let opened = opened(&path, None).expect("opens");
        // (The cameras look up at the plane: a doubt of its own.)
        for photo in review(&opened).photos() {
            assert_eq!(photo.verdict == Verdict::NoScale, !known, "{photo:?}");
            assert_eq!(photo.doubts.contains(&Doubt::UnitUnknown), !known);
        }
    }
}

/// A photo under the surface has as good a scale as one above: it is not trusted, and every list says
/// why.
#[test]
fn a_photo_from_under_the_surface_is_not_trusted() {
    let folder = tempfile::tempdir().expect("a folder");
    wrong_pile::under_surface(folder.path());
    let [above, under] = wrong_pile::ABOVE_AND_UNDER;
    let review = review(&opened(folder.path(), None).expect("opens"));
    let photos: Vec<PhotoReview<'_>> = review.photos().collect();
    let verdicts: Vec<Verdict> = photos.iter().map(|photo| photo.verdict).collect();
    assert_eq!(verdicts, [Verdict::Trust, Verdict::Check]);
    assert_eq!(photos[1].doubts, [Doubt::UnderSurface]);

    let flight = text_of(folder.path());
    let words = Doubt::UnderSurface.to_string();
    let said = format!("{under}: {words}");
    let (table, err) = run(0, &["scales", flight]);
    let in_table = format!("\n\n{under}: check: {words}\n");
    assert!(table.ends_with(&in_table), "{table}");
    assert!(err.contains(&said), "{err}");
    let csv = ["scales", flight, "--unit", "m", "--format", "csv"];
    let notes_of = |csv: &str| -> Vec<String> {
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let lines = reader.records().map(|line| line.expect("a line"));
        lines.map(|line| line[line.len() - 1].to_owned()).collect()
    };
    assert_eq!(notes_of(&run(0, &csv).0), ["", words.as_str()]);
    // JSON has the contract's keys and no more: the sentence is on standard error.
    let (json, err) = run(0, &["scales", flight, "--unit", "m", "--format", "json"]);
    assert!(err.contains(&said), "{err}");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    for photo in json["photos"].as_array().expect("photos") {
        let keys: Vec<&String> = photo.as_object().expect("an object").keys().collect();
        let mut expected = [
            "photo",
            "width",
            "height",
            "ground",
            "scale",
            "corners",
            "fitted",
            "uncertainty",
            "verdict",
            "reasons",
            "decision",
        ];
        expected.sort_unstable();
        assert_eq!(keys, expected);
        let top = crate::common::scale(photo, "top").expect("a scale");
        assert!((top / wrong_pile::BOTH_SCALES - 1.0).abs() < 1e-9, "{top}");
    }
    let (out, err) = run(0, &["check", flight]);
    assert!(err.contains("taken from under the surface"), "{err}");
    assert!(out.contains("check: taken from under the surface"), "{out}");

    let to = folder.path().join("all");
    let (_, err) = run(0, &["export", flight, "--to", text_of(&to)]);
    assert!(err.contains(&said), "{err}");
    let of_export = |name: &str| fs::read_to_string(to.join(name)).expect("the export");
    let sheet = of_export("scales.html");
    for verdict in ["trust", "check"] {
        let cell = format!("<div class=\"verdict {verdict}\">{verdict}</div>");
        assert_eq!(sheet.matches(&cell).count(), 1, "{sheet}");
    }
    assert_eq!(sheet.matches("<li>taken from under the surface").count(), 1);
    assert_eq!(notes_of(&of_export("scales.csv")), ["", words.as_str()]);
    let footprints: serde_json::Value =
        serde_json::from_str(&of_export("footprints.geojson")).expect("JSON");
    let features = footprints["features"].as_array().expect("features").iter();
    let verdicts: Vec<&serde_json::Value> =
        features.map(|one| &one["properties"]["verdict"]).collect();
    assert_eq!(verdicts, ["trust", "check"]);
    // A map says why, in the words of the table.
    let features = footprints["features"].as_array().expect("features").iter();
    let reasons: Vec<&str> = features
        .map(|one| one["properties"]["reasons"].as_str().expect("reasons"))
        .collect();
    assert_eq!(reasons, ["", words.as_str()]);
    let to = folder.path().join("trusted");
    let trusted = [
        "export",
        flight,
        "--photos",
        "trusted",
        "--to",
        text_of(&to),
    ];
    run(0, &trusted);
    let csv = fs::read_to_string(to.join("scales.csv")).expect("the export");
    assert!(csv.contains(above) && !csv.contains(under), "{csv}");
}

#[test]
fn swapped_photos_are_not_trusted() {
    let of_colours = |photo: &PhotoReview<'_>| photo.doubts.iter().any(Doubt::is_of_colours);
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    let as_flown = review(&opened(&sample, None).expect("opens"));
    let as_flown: Vec<PhotoReview<'_>> = as_flown.photos().collect();
    assert!(!as_flown.iter().any(of_colours), "{as_flown:?}");
    let folder = tempfile::tempdir().expect("a folder");
    wrong_pile::swapped(folder.path());
    let review = review(&opened(folder.path(), None).expect("opens"));
    let swapped = wrong_pile::SWAPPED;
    let trusted = as_flown
        .iter()
        .filter(|photo| photo.verdict == Verdict::Trust);
    // Some of them would be trusted, or this would show nothing.
    assert!(
        swapped
            .iter()
            .any(|&photo| as_flown[photo].verdict == Verdict::Trust)
    );
    let mut still_trusted = trusted.count();
    for (index, (photo, as_flown)) in review.photos().zip(&as_flown).enumerate() {
        let is_swapped = swapped.contains(&index);
        assert_eq!(
            of_colours(&photo),
            is_swapped,
            "photo {index}: {:?}",
            photo.doubts
        );
        let expected = match as_flown.verdict {
            Verdict::Trust if is_swapped => {
                still_trusted -= 1;
                Verdict::Check
            }
            other => other,
        };
        assert_eq!(photo.verdict, expected, "photo {index}");
    }
    // The sheet that is typed from says the same, and so does `check`.
    let to = folder.path().join("export");
    run(0, &["export", text_of(folder.path()), "--to", text_of(&to)]);
    let sheet = fs::read_to_string(to.join("scales.html")).expect("the sheet");
    let trust = "<div class=\"verdict trust\">trust</div>";
    assert_eq!(sheet.matches(trust).count(), still_trusted);
    assert_eq!(sheet.matches("its colours").count(), 4);
    let csv = fs::read_to_string(to.join("scales.csv")).expect("the export");
    assert_eq!(csv.matches("its colours").count(), 8, "{csv}");
    let (_, err) = run(0, &["check", text_of(folder.path())]);
    assert_eq!(err.matches("its colours").count(), 4, "{err}");
    // And `scales`, whose table people take.
    let scales = ["scales", text_of(folder.path()), "--format", "csv"];
    let (csv, _) = run(0, &scales);
    assert_eq!(csv.matches(",trust,").count(), still_trusted, "{csv}");
    assert_eq!(csv.matches("its colours").count(), 8, "{csv}");
}
