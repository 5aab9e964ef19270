//! The export for Split-Desktop: what is written is read back and compared with what it should hold;
//! interrupted, repeated and hindered exports.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use crate::common::{error_of, fragscale, scales_json, stdout_of};
use fragscale::exports::{
    ExportRequest, ExportSummary, Provenance, Replace, export_for_split_desktop,
};
use fragscale::files::FileError;
use fragscale::flight::{Evidence, Limits, LookedUp, Outcome, PhotoFileState, Review, Verdict};
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, Opened, open_flight};
use fragscale::scale::ImageKind;
use fragscale::units::LengthUnit;
use serde_json::Value;
use tempfile::TempDir;

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample")
}

/// A selection.
const FIRST_TWO: [bool; 9] = [true, true, false, false, false, false, false, false, false];

/// A copy of the sample to change.
fn copy_of_sample() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("photos")).expect("a folder");
    for below in ["", "photos"] {
        for entry in fs::read_dir(sample().join(below)).expect("the sample") {
            let path = entry.expect("an entry").path();
            if path.is_file() {
                let name = path.file_name().expect("a name");
                fs::copy(&path, folder.path().join(below).join(name)).expect("a copy");
            }
        }
    }
    folder
}

fn edit(path: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(path).expect("the file");
    assert!(text.contains(from), "no {from:?} in {}", path.display());
    fs::write(path, text.replace(from, to)).expect("written");
}

/// The sample, computed once a test.
struct Computed {
    opened: Opened,
    review: Review,
    photo_files: Vec<Option<PathBuf>>,
    crs: Option<String>,
}

impl Computed {
    fn new(flight: &Path) -> Self {
        let progress = Progress::default();
        let opened = open_flight(flight, &OpenOptions::default(), &progress).expect("opens");
        let (width, height) = (1280, 720);
        let evidence = Evidence {
            file: PhotoFileState::Found { width, height },
            ..Evidence::default()
        };
        let looked_up = LookedUp {
            evidence: vec![evidence; opened.photo_files.len()],
            ..LookedUp::default()
        };
        let (flight, limits) = (opened.flight.clone(), Limits::default());
        let mut review = Review::of_scales(flight, looked_up, &limits, &progress).expect("scales");
        review.look(&progress).expect("views");
        Self {
            photo_files: opened
                .photo_files
                .iter()
                .map(|file| file.path.clone())
                .collect(),
            crs: opened.crs.clone(),
            opened,
            review,
        }
    }

    fn export(
        &self,
        to: &Path,
        selected: &[bool],
        progress: &Progress,
    ) -> Result<ExportSummary, FileError> {
        let request = ExportRequest {
            review: &self.review,
            from: &Provenance {
                file: self.opened.origin.file(),
                inputs: &self.opened.inputs,
                read: &self.opened.read,
                photo_files: &self.photo_files,
                settings: &self.opened.settings,
                crs: self.crs.as_deref(),
                warnings: &self.opened.warnings,
            },
            selected,
            unit: LengthUnit::Centimetre,
            rectified: None,
            replace: Replace::Nothing,
        };
        export_for_split_desktop(to, &request, progress)
    }
}

/// Every file below a folder with its contents.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inside) = folders.pop() {
        for entry in fs::read_dir(inside).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below").to_string_lossy();
                found.insert(name.replace('\\', "/"), fs::read(&path).expect("a file"));
            }
        }
    }
    found
}

fn text<'a>(files: &'a BTreeMap<String, Vec<u8>>, name: &str) -> &'a str {
    std::str::from_utf8(files.get(name).expect(name)).expect("UTF-8")
}

fn exif(bytes: &[u8]) -> Vec<(exif::Tag, exif::In, String)> {
    let exif = exif::Reader::new()
        .read_from_container(&mut Cursor::new(bytes))
        .expect("EXIF");
    let fields = exif
        .fields()
        .map(|field| (field.tag, field.ifd_num, field.display_value().to_string()));
    fields.collect()
}

/// A photo that viewers are told to turn: top and bottom stay those of its pixels, and no viewer turns what is exported.
#[test]
fn a_photo_to_be_turned_is_said_and_exported_as_it_lies() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["flight.toml", "poses.csv", "pile.ply", "ost.yaml"] {
        fs::copy(sample().join(name), folder.path().join(name)).expect("a copy");
    }
    let photos = folder.path().join("photos");
    fs::create_dir(&photos).expect("a folder");
    let shot = image::open(sample().join("photos/IMG_0001.jpg")).expect("a photo");
    let mut writer = exif::experimental::Writer::new();
    let turned = exif::Field {
        tag: exif::Tag::Orientation,
        ifd_num: exif::In::PRIMARY,
        value: exif::Value::Short(vec![3]),
    };
    writer.push_field(&turned);
    let mut header = Cursor::new(Vec::new());
    writer.write(&mut header, false).expect("EXIF");
    let header = header.into_inner();
    let format = fragscale::picture::PhotoFormat::Jpeg;
    let bytes = fragscale::picture::encode(&shot.to_rgb8(), format, 95, Some(&header), None);
    fs::write(photos.join("IMG_0001.jpg"), bytes.expect("a JPEG")).expect("written");
    let to = folder.path().join("export");
    let flight = folder.path().join("flight.toml");
    let [flight, to_text] = [&flight, &to].map(|path| path.to_str().expect("UTF-8"));
    let sample_text = fs::read_to_string(flight).expect("the flight");
    let mut made = Vec::new();
    for image in ["", "\n[scale]\nimage = \"as-shot\"\n"] {
        fs::write(flight, sample_text.clone() + image).expect("written");
        let output = crate::common::fragscale(&["export", flight, "--to", to_text]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains("to show it turned (orientation 3)"), "{said}");
        made = fs::read(to.join("photos/IMG_0001.jpg")).expect("exported");
        let fields = exif(&made);
        let orientation = fields
            .iter()
            .find(|(tag, ..)| *tag == exif::Tag::Orientation);
        assert!(
            orientation.expect("kept").2.contains("row 0 at top"),
            "{fields:?}"
        );
    }
    // As shot it is the file but for that mark.
    let shot = fs::read(photos.join("IMG_0001.jpg")).expect("a photo");
    let differ = shot.iter().zip(&made).filter(|(a, b)| a != b).count();
    assert_eq!((shot.len(), differ), (made.len(), 1));
}

/// The command as a user gives it, and everything that it wrote.
#[test]
fn the_sample_is_exported_and_reads_back() {
    let parent = tempfile::tempdir().expect("a folder");
    let to = parent.path().join("for Split");
    let flight = sample().join("flight.toml");
    let flight = flight.to_str().expect("UTF-8");
    let said = stdout_of(&["export", flight, "--to", to.to_str().expect("UTF-8")]);
    assert!(said.contains("9 photos, pictures of 9 made"), "{said}");
    let files = contents(&to);
    assert_eq!(files.len(), 4 + 3 * 9, "{:?}", files.keys());

    let csv = stdout_of(&["scales", flight, "--format", "csv"]);
    assert_eq!(text(&files, "scales.csv"), csv);

    let scales = crate::common::scales_json(&sample(), &[]);
    let sheet = text(&files, "scales.html");
    let features: Value = serde_json::from_str(text(&files, "footprints.geojson")).expect("JSON");
    assert_eq!(features["coordinates"], "local, in m");
    for (index, photo) in scales["photos"]
        .as_array()
        .expect("photos")
        .iter()
        .enumerate()
    {
        let name = photo["photo"].as_str().expect("a name");
        let shot = fs::read(sample().join("photos").join(name)).expect("the photo");
        let undistorted = &files[&format!("photos/{name}")];
        let image = image::load_from_memory(undistorted).expect("an image");
        assert_eq!((image.width(), image.height()), (1280, 720));
        assert_ne!(
            image.to_rgb8(),
            image::load_from_memory(&shot).expect("an image").to_rgb8()
        );
        assert_eq!(exif(undistorted), exif(&shot), "{name}");
        assert!(exif(&shot).len() > 5);
        let overlay =
            image::load_from_memory(&files[&format!("overlays/{name}")]).expect("an image");
        assert_eq!((overlay.width(), overlay.height()), (1280, 720));
        let small =
            image::load_from_memory(&files[&format!("thumbnails/{name}")]).expect("an image");
        assert_eq!((small.width(), small.height()), (480, 270));

        for edge in ["top", "bottom"] {
            let scale = photo["fitted"][edge].as_f64().expect("a scale");
            let big = sheet.split("<div class=\"big\">").skip(1);
            let mut big = big.filter_map(|rest| rest.split_once('<')?.0.parse::<f64>().ok());
            assert!(
                big.any(|big| (big / scale - 1.0).abs() < 0.01),
                "{name}: {scale}"
            );
        }

        // The outline has 32 points an edge; every 32nd is a corner, counterclockwise from the first.
        let feature = &features["features"][index];
        assert_eq!(feature["properties"]["photo"], name);
        let ring = feature["geometry"]["coordinates"][0]
            .as_array()
            .expect("a ring");
        assert_eq!((ring.len(), &ring[0]), (129, &ring[128]));
        let corners = [0, 96, 64, 32].map(|place| ring[place].clone());
        // Rays that are cast again meet the same triangle, up to rounding.
        let of_scales = photo["corners"].as_array().expect("corners");
        for (corner, of_scale) in corners.iter().zip(of_scales) {
            for axis in 0..3 {
                let [a, b] = [&corner[axis], &of_scale["point"][axis]];
                let off = a.as_f64().expect("a number") - b.as_f64().expect("a number");
                assert!(off.abs() < 1e-12, "{name}: {corner} for {of_scale}");
            }
        }
    }
    // The checksum that another program gives.
    let sum = "7cc6c739bf9950f1228d6a3adc1560a104d689b213b2aa2334ae2786c0fb59f0";
    assert!(sheet.contains(sum), "of pile.ply, by sha256sum");
}

/// The exported photo has the camera's K and pixels: the red sphere's middle is where the simulator's
/// true centre projects. (What the lens does is held by the tests of `picture::undistorted`.)
#[test]
fn the_exported_photo_is_the_pinhole_image() {
    let computed = Computed::new(&sample());
    let to = tempfile::tempdir().expect("a folder");
    computed
        .export(to.path(), &[true; 9], &Progress::default())
        .expect("exports");
    let truth: Value =
        serde_json::from_str(&fs::read_to_string(sample().join("truth.json")).expect("truth"))
            .expect("JSON");
    let numbers = |value: &Value| -> Vec<f64> {
        value
            .as_array()
            .expect("a list")
            .iter()
            .map(|n| n.as_f64().expect("a number"))
            .collect()
    };
    let spheres = truth["spheres"].as_array().expect("spheres").iter();
    let centres: Vec<glam::DVec3> = spheres
        .map(|sphere| glam::DVec3::from_slice(&numbers(&sphere["center"])))
        .collect();
    let flight = &computed.opened.flight;
    for photo in &flight.parts().photos {
        let camera = flight.camera(photo);
        let image = image::open(to.path().join("photos").join(&photo.name))
            .expect("an image")
            .to_rgb8();
        let (mut sum, mut count) = (glam::DVec2::ZERO, 0.0);
        for (x, y, pixel) in image.enumerate_pixels() {
            let [r, g, b] = pixel.0.map(f64::from);
            if r > 2.0 * g && r > 2.0 * b && r > 70.0 {
                sum += glam::DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                count += 1.0;
            }
        }
        assert!(count > 1000.0, "{}: no sphere", photo.name);
        let found = sum / count;
        let seen = centres.iter().filter_map(|centre| {
            let in_camera = photo.pose.rotation.transpose() * (*centre - photo.pose.center);
            Some((camera.pixel_undistorted(in_camera)? - found).length())
        });
        let off = seen.min_by(f64::total_cmp).expect("a sphere");
        // The middle of the picture of a sphere is a little further out than the picture of its
        // middle, and fines hide its foot.
        assert!(off < 1.5, "{}: {off} px", photo.name);
    }
}

#[test]
fn a_second_export_makes_only_what_is_missing() {
    let computed = Computed::new(&sample());
    let to = tempfile::tempdir().expect("a folder");
    let export = |selected: &[bool]| {
        computed
            .export(to.path(), selected, &Progress::default())
            .expect("exports")
    };
    let first = export(&[true; 9]);
    assert_eq!((first.photos, first.made, first.kept), (9, 9, 0));
    let before = contents(to.path());
    let second = export(&[true; 9]);
    assert_eq!((second.made, second.kept), (0, 9));
    assert_eq!(contents(to.path()), before);

    fs::remove_file(to.path().join("overlays/IMG_0004.jpg")).expect("removed");
    let third = export(&[true; 9]);
    assert_eq!((third.made, third.kept), (1, 8));
    assert_eq!(contents(to.path()), before);

    // A smaller selection takes the other photos' own files away and nothing else.
    fs::write(to.path().join("photos/my notes.txt"), "mine").expect("written");
    let mut selected = [true; 9];
    selected[2] = false;
    let fourth = export(&selected);
    assert_eq!((fourth.photos, fourth.made, fourth.kept), (8, 0, 8));
    let files = contents(to.path());
    assert!(
        !files.keys().any(|name| name.contains("IMG_0003")),
        "{:?}",
        files.keys()
    );
    assert_eq!(text(&files, "photos/my notes.txt"), "mine");
    assert_eq!(text(&files, "scales.csv").lines().count(), 9);
    assert!(!text(&files, "scales.html").contains("IMG_0003"));
}

#[test]
fn another_photo_or_setting_is_made_anew() {
    let flight = copy_of_sample();
    let to = tempfile::tempdir().expect("a folder");
    let export = || {
        Computed::new(flight.path())
            .export(to.path(), &FIRST_TWO, &Progress::default())
            .expect("exports")
    };
    export();
    let photo = flight.path().join("photos/IMG_0001.jpg");
    fs::copy(flight.path().join("photos/IMG_0002.jpg"), photo).expect("a copy");
    assert_eq!(export().made, 1);
    let toml = flight.path().join("flight.toml");
    let text = fs::read_to_string(&toml).expect("the flight");
    fs::write(&toml, text + "\n[scale]\nimage = \"as-shot\"\n").expect("written");
    assert_eq!(export().made, 2);
    // As shot: the very files.
    for name in ["IMG_0001.jpg", "IMG_0002.jpg"] {
        let read = |folder: &Path| fs::read(folder.join("photos").join(name)).expect("a photo");
        assert_eq!(read(to.path()), read(flight.path()));
    }
}

/// A circle of 60 px radius around a pixel, as an outline in flight.toml.
fn circle(x: f64, y: f64) -> String {
    let points: Vec<String> = (0..12)
        .map(|i| {
            let turn = f64::from(i) / 12.0 * std::f64::consts::TAU;
            format!("[{}, {}]", x + 60.0 * turn.cos(), y + 60.0 * turn.sin())
        })
        .collect();
    format!("[{}]", points.join(", "))
}

/// A scale object is painted blue, lens and all, and nothing else of the photo changes.
#[test]
fn scale_objects_are_painted_over() {
    let flight = copy_of_sample();
    let to = tempfile::tempdir().expect("a folder");
    let toml = flight.path().join("flight.toml");
    let plain = fs::read_to_string(&toml).expect("the flight");
    let export = |objects: &str, image: &str| {
        fs::write(&toml, plain.clone() + objects + image).expect("written");
        Computed::new(flight.path())
            .export(to.path(), &FIRST_TWO, &Progress::default())
            .expect("exports")
    };
    let object = format!(
        "\n[[scale_object]]\nphoto = \"IMG_0002.jpg\"\nkind = \"sphere\"\nsize = 0.06\noutline = {}\n",
        circle(300.0, 200.0)
    );
    export("", "");
    let before = contents(to.path());
    assert!(!before.contains_key("masks/IMG_0002.png"));
    assert_eq!(export(&object, "").made, 1);
    let after = contents(to.path());
    for name in ["photos/IMG_0001.jpg", "overlays/IMG_0001.jpg", "scales.csv"] {
        assert_eq!(after[name], before[name], "{name}");
    }
    assert!(!after.contains_key("masks/IMG_0001.png"));
    let picture = |bytes: &[u8]| image::load_from_memory(bytes).expect("an image").to_rgb8();
    let mask = picture(&after["masks/IMG_0002.png"]);
    let name = "photos/IMG_0002.jpg";
    let (was, is) = (picture(&before[name]), picture(&after[name]));
    assert_eq!(mask.dimensions(), is.dimensions());
    let computed = Computed::new(flight.path());
    let camera = &computed.opened.flight.parts().cameras[0];
    let centre = glam::DVec2::new(300.0, 200.0);
    let (mut masked, mut blue) = (0.0, 0.0);
    for (x, y, pixel) in mask.enumerate_pixels() {
        let here = glam::DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let shot = camera
            .pixel_as_shot(camera.direction_undistorted(here))
            .expect("seen");
        // 60 px as shot and 4 px of margin; a sphere's outline is no circle there, by 3 %.
        let far = (shot - centre).length();
        assert!(pixel.0 == [0; 3] || far > 61.0, "{here} is not masked");
        assert!(pixel.0 == [255; 3] || far < 67.0, "{here} is masked");
        let [r, g, b] = is.get_pixel(x, y).0;
        if pixel.0 == [0; 3] {
            masked += 1.0;
            blue += f64::from(u8::from(r < 60 && g < 60 && b > 190));
        } else if far > 64.0 + 24.0 {
            // Beyond the blocks of JPEG that the edge lies in.
            assert_eq!([r, g, b], was.get_pixel(x, y).0, "{here}");
        }
    }
    assert!(
        masked > std::f64::consts::PI * 3600.0 && blue / masked > 0.97,
        "{blue} of {masked}"
    );
    let sheet = text(&after, "scales.html");
    assert!(
        sheet.contains("scale object: sphere, diameter 0.06 m: <b>"),
        "{sheet}"
    );
    assert!(sheet.contains("painted blue in the photo"));

    // Nothing new, nothing made; as shot the file is no copy any more, but keeps its EXIF.
    assert_eq!(export(&object, "").made, 0);
    assert_eq!(export(&object, "\n[scale]\nimage = \"as-shot\"\n").made, 2);
    let as_shot = contents(to.path());
    let shot = fs::read(sample().join("photos/IMG_0002.jpg")).expect("the photo");
    assert_ne!(as_shot["photos/IMG_0002.jpg"], shot);
    assert_eq!(exif(&as_shot["photos/IMG_0002.jpg"]), exif(&shot));
    let original = fs::read(sample().join("photos/IMG_0001.jpg")).expect("the photo");
    assert_eq!(as_shot["photos/IMG_0001.jpg"], original);

    // Kept, but not painted over.
    let unmasked = object.clone() + "mask = false\n";
    assert_eq!(export(&unmasked, "").made, 2);
    let files = contents(to.path());
    assert!(!files.contains_key("masks/IMG_0002.png"));
    assert_eq!(files["photos/IMG_0002.jpg"], before["photos/IMG_0002.jpg"]);
    let sheet = text(&files, "scales.html");
    assert!(sheet.contains("scale object: sphere") && !sheet.contains("painted"));

    // What cannot be fitted is said, and leaves the photo as it is.
    let line = "[[1, 1], [2, 2], [3, 3], [400, 400]]";
    let summary = export(&object.replace(&circle(300.0, 200.0), line), "");
    let warned =
        "IMG_0002.jpg: its scale object, a sphere, is not masked: the points lie on a line";
    assert!(
        summary.warnings[0].starts_with(warned),
        "{:?}",
        summary.warnings
    );
    // And one on a photo that is not there, when the flight is opened.
    fs::write(&toml, plain.clone() + &object.replace("0002", "0099")).expect("written");
    let warnings = Computed::new(flight.path()).opened.warnings;
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("on photo 'IMG_0099.jpg'")),
        "{warnings:?}"
    );
}

/// An export that was cancelled after its first photo and before its last; `None` where the watcher
/// came too late on a busy machine.
fn cancelled_midway(computed: &Computed, to: &Path) -> Option<FileError> {
    let progress = Progress::default();
    let result = std::thread::scope(|scope| {
        let watcher = progress.clone();
        scope.spawn(move || {
            loop {
                let (stage, share) = watcher.snapshot();
                if stage != "checking what is there" && share > 0.0 {
                    return watcher.cancel();
                }
                std::thread::yield_now();
            }
        });
        computed.export(to, &[true; 9], &progress)
    });
    let photos = contents(to)
        .keys()
        .filter(|name| name.starts_with("photos/"))
        .count();
    result.err().filter(|_| (1..9).contains(&photos))
}

#[test]
fn a_cancelled_export_leaves_whole_files_and_goes_on() {
    let computed = Computed::new(&sample());
    let (to, error) = (0..20)
        .find_map(|_| {
            let to = tempfile::tempdir().expect("a folder");
            let error = cancelled_midway(&computed, to.path())?;
            Some((to, error))
        })
        .expect("one of 20 cancels comes in time");
    assert_eq!(error.fault.what, "cancelled");
    let files = contents(to.path());
    assert!(!files.contains_key("scales.html") && files.contains_key("export.json"));
    let photos = files
        .keys()
        .filter(|name| name.starts_with("photos/"))
        .count();
    for (name, bytes) in &files {
        assert!(!name.contains(".part"), "{name} is left");
        if name.ends_with(".jpg") {
            image::load_from_memory(bytes).expect("a whole picture");
        }
    }
    let summary = computed
        .export(to.path(), &[true; 9], &Progress::default())
        .expect("goes on");
    assert_eq!((summary.made + summary.kept, summary.kept), (9, photos));
    let whole = tempfile::tempdir().expect("a folder");
    computed
        .export(whole.path(), &[true; 9], &Progress::default())
        .expect("exports");
    assert_eq!(contents(to.path()), contents(whole.path()));
}

#[test]
fn only_trusted_photos_where_asked() {
    let sample = sample();
    let to = tempfile::tempdir().expect("a folder");
    let to = to.path().to_str().expect("UTF-8");
    stdout_of(&[
        "export",
        sample.to_str().expect("UTF-8"),
        "--to",
        to,
        "--photos",
        "trusted",
    ]);
    let trusted = Computed::new(&sample)
        .review
        .photos()
        .filter(|photo| photo.verdict == Verdict::Trust)
        .count();
    assert!(
        (1..9).contains(&trusted),
        "the sample has photos of both kinds"
    );
    assert_eq!(
        text(&contents(Path::new(to)), "scales.csv").lines().count(),
        1 + trusted
    );
    // A folder is needed.
    assert_eq!(fragscale(&["export", "flight.toml"]).status.code(), Some(2));
}

#[test]
fn files_of_others_stop_it_before_it_writes() {
    let to = tempfile::tempdir().expect("a folder");
    fs::create_dir(to.path().join("photos")).expect("a folder");
    fs::write(to.path().join("photos/IMG_0005.jpg"), "mine").expect("written");
    let before = contents(to.path());
    let sample = sample();
    let arguments = [
        "export",
        sample.to_str().expect("UTF-8"),
        "--to",
        to.path().to_str().expect("UTF-8"),
    ];
    let output = fragscale(&arguments);
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    assert!(
        stderr.starts_with("error: ")
            && stderr.contains("photos/IMG_0005.jpg: it is there already"),
        "{stderr}"
    );
    assert_eq!(contents(to.path()), before);
}

#[test]
fn a_missing_or_broken_photo_is_in_the_sheet_with_its_sentence() {
    let flight = copy_of_sample();
    fs::remove_file(flight.path().join("photos/IMG_0001.jpg")).expect("removed");
    let broken = flight.path().join("photos/IMG_0002.jpg");
    let bytes = fs::read(&broken).expect("a photo");
    fs::write(&broken, &bytes[..bytes.len() / 2]).expect("written");
    let to = tempfile::tempdir().expect("a folder");
    let output = fragscale(&[
        "export",
        flight.path().to_str().expect("UTF-8"),
        "--to",
        to.path().to_str().expect("UTF-8"),
        "--unit",
        "in",
    ]);
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    for sentence in [
        "IMG_0001.jpg: no pictures: the photo file is missing",
        "IMG_0002.jpg: no pictures: the JPEG is cut off at ",
        "1 of 9 photos are not exported, because their files are damaged",
    ] {
        assert!(stderr.contains(sentence), "{stderr}");
    }
    let files = contents(to.path());
    assert_eq!(files.len(), 4 + 3 * 7);
    let sheet = text(&files, "scales.html");
    assert!(sheet.contains("IMG_0001.jpg: no pictures: the photo file is missing"));
    assert!(sheet.contains("the photo file is missing</li>") && sheet.contains("px/in</div>"));
    assert!(text(&files, "scales.csv").starts_with("photo,width_px,height_px,top_px_per_in,"));
    assert_eq!(text(&files, "scales.csv").lines().count(), 10);
}

/// In a known system the footprints are in longitude and latitude, and there is KML.
#[test]
fn a_flight_on_the_map_has_kml() {
    let mut computed = Computed::new(&sample());
    // The lab's numbers taken as UTM: on the equator, at the far west of zone 33.
    computed.crs = Some("EPSG:32633".to_owned());
    let to = tempfile::tempdir().expect("a folder");
    // The last one lies over a hole, as the sample's table says.
    let mut first_and_last = [false; 9];
    first_and_last[0] = true;
    first_and_last[8] = true;
    computed
        .export(to.path(), &first_and_last, &Progress::default())
        .expect("exports");
    let files = contents(to.path());
    let features: Value = serde_json::from_str(text(&files, "footprints.geojson")).expect("JSON");
    assert_eq!(features["coordinates"], "WGS 84 longitude, latitude");
    let at = &features["features"][0]["geometry"]["coordinates"][0][0];
    assert_eq!(at.as_array().expect("a position").len(), 2);
    let Outcome::Scale(scale) = &computed.review.outcomes()[0] else {
        panic!("no scale");
    };
    let corner = scale.corners[0].point().expect("a point");
    // EPSG:32633 at (0, 0): 10.5112561156 E, 0 N (PROJ); there a degree is 111 km.
    let lon = at[0].as_f64().expect("a longitude");
    let lat = at[1].as_f64().expect("a latitude");
    assert!(
        (lon - 10.511_256_115_6 - corner.x / 111_300.0).abs() < 1e-7 + corner.x.abs() * 1e-7,
        "{lon}"
    );
    assert!(
        (lat - corner.y / 110_600.0).abs() < 1e-7 + corner.y.abs() * 1e-7,
        "{lat}"
    );
    let kml = roxmltree::Document::parse(text(&files, "footprints.kml")).expect("XML");
    let places = kml
        .descendants()
        .filter(|node| node.has_tag_name("Placemark"));
    assert_eq!(places.count(), 2);
    let ring = kml
        .descendants()
        .find(|node| node.has_tag_name("coordinates"))
        .expect("a ring");
    let first = ring
        .text()
        .expect("positions")
        .split(' ')
        .next()
        .expect("a position");
    assert_eq!(first, format!("{lon},{lat}"));
    let described = kml
        .descendants()
        .filter(|node| node.has_tag_name("description"))
        .filter_map(|node| node.text());
    let why = "; over a hole in the cloud: top right";
    let doubted: Vec<bool> = described.map(|text| text.contains(why)).collect();
    assert_eq!(doubted, [false, true]);

    computed.crs = Some("a mine grid".to_owned());
    let summary = computed
        .export(to.path(), &FIRST_TWO, &Progress::default())
        .expect("exports");
    assert!(
        summary
            .warnings
            .iter()
            .any(|w| w.contains("'a mine grid' is not known")),
        "{summary:?}"
    );
    // The KML of before would now be wrong.
    assert!(!to.path().join("footprints.kml").exists());
}

#[test]
fn names_do_not_leave_the_folder() {
    let flight = copy_of_sample();
    let poses = flight.path().join("poses.csv");
    for folder in ["left", "right"] {
        fs::create_dir(flight.path().join("photos").join(folder)).expect("a folder");
    }
    let photos = flight.path().join("photos");
    fs::rename(photos.join("IMG_0001.jpg"), photos.join("left/1.jpg")).expect("moved");
    fs::rename(photos.join("IMG_0002.jpg"), photos.join("right/1.jpg")).expect("moved");
    fs::rename(photos.join("IMG_0003.jpg"), flight.path().join("<b>&.jpg")).expect("moved");
    edit(&poses, "IMG_0001.jpg", "left/1.jpg");
    edit(&poses, "IMG_0002.jpg", "right/1.jpg");
    edit(&poses, "IMG_0003.jpg", "../<b>&.jpg");
    let parent = tempfile::tempdir().expect("a folder");
    let to = parent.path().join("to");
    let computed = Computed::new(flight.path());
    assert_eq!(computed.opened.settings.image, ImageKind::Undistorted);
    let selected: Vec<bool> = (0..9).map(|index| index < 3).collect();
    let summary = computed
        .export(&to, &selected, &Progress::default())
        .expect("exports");
    assert_eq!(summary.made, 3, "{:?}", summary.warnings);
    assert_eq!(fs::read_dir(parent.path()).expect("a folder").count(), 1);
    let files = contents(&to);
    for name in [
        "photos/left_1.jpg",
        "photos/right_1.jpg",
        "photos/_b_&.jpg",
        "overlays/left_1.jpg",
    ] {
        assert!(files.contains_key(name), "{name} in {:?}", files.keys());
    }
    let sheet = text(&files, "scales.html");
    assert!(sheet.contains("../&lt;b&gt;&amp;.jpg") && !sheet.contains("<b>&"));
    assert!(sheet.contains("src=\"thumbnails/_b_%26.jpg\""));
}

/// The nine photos of a survey that are for Split-Desktop, and not the hundred beside them: those that are named, in the flight's
/// order, with the numbers that they have among all.
#[test]
fn only_photos_that_are_named() {
    let all = scales_json(&sample(), &[]);
    let named = ["--photo", "IMG_0003.jpg", "--photo", "IMG_0001.jpg"];
    let some = scales_json(&sample(), &named);
    let photos = |report: &Value| report["photos"].as_array().expect("photos").clone();
    let all = photos(&all);
    assert_eq!(photos(&some), [all[0].clone(), all[2].clone()]);
    let to = tempfile::tempdir().expect("a folder");
    let folder = to.path().join("split");
    let (flight, folder) = (sample(), folder.to_str().expect("UTF-8").to_owned());
    let flight = flight.to_str().expect("UTF-8");
    stdout_of(&["export", flight, "--to", &folder, "--photo", "IMG_0002.jpg"]);
    let table = fs::read_to_string(Path::new(&folder).join("scales.csv")).expect("a table");
    let rows: Vec<&str> = table.lines().skip(1).collect();
    assert!(
        rows.len() == 1 && rows[0].starts_with("IMG_0002.jpg,"),
        "{table}"
    );
    let photos = fs::read_dir(Path::new(&folder).join("photos")).expect("photos");
    assert_eq!(photos.count(), 1);
    // One that a review leaves out is not exported for being named, and that is said.
    let copy = copy_of_sample();
    let left_out = copy.path().join("flight.toml");
    let text = fs::read_to_string(&left_out).expect("a flight");
    let review = "\n[[review]]\nphoto = \"IMG_0003.jpg\"\ndecision = \"left-out\"\n";
    fs::write(&left_out, text + review).expect("written");
    let to = copy.path().join("split");
    let words = [&left_out, &to].map(|path| path.to_str().expect("UTF-8").to_owned());
    let both = ["--photo", "IMG_0003.jpg", "--photo", "IMG_0002.jpg"];
    let output = fragscale(&[&["export", &words[0], "--to", &words[1]][..], &both].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("photo 'IMG_0003.jpg' is not exported: a [[review]] table leaves it out"),
        "{said}"
    );
    let error = error_of(&["scales", flight, "--photo", "IMG_0033.jpg"]);
    assert!(
        error.contains("there is no photo 'IMG_0033.jpg'"),
        "{error}"
    );
}
