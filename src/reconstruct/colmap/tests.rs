//! The engine with a script in COLMAP's place, which prints and writes what COLMAP 3.8 does. Real photos
//! through the real program: `crate::tests`, and the table of engines in docs/reconstruct.md.

use std::fs;
use std::io::ErrorKind;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use super::*;
use crate::camera::Distortion;
use crate::photo_set::SurveyPhoto;

/// What the script does for each command; `$*` is the rest of the command line.
const SCRIPT: &str = r##"#!/bin/sh
echo "$@" >> "$(dirname "$0")/called.txt"
command=$1
shift
if [ "$1" = -h ]; then
    [ "$command" = feature_extractor ] && echo '  --SiftExtraction.use_gpu arg (=1)'
    [ "$command" = matches_importer ] && echo '  --SiftMatching.use_gpu arg (=1)'
    exit 0
fi
after() { # the value of an option
    option=$1; shift
    while [ $# -gt 0 ]; do [ "$1" = "$option" ] && echo "$2"; shift; done
}
case $command in
help)
    echo 'COLMAP 3.8 -- Structure-from-Motion and Multi-View Stereo'
    echo '              (Commit Unknown on Unknown without CUDA)';;
feature_extractor)
    echo 'Processed file [1/2]'; echo 'Processed file [2/2]';;
matches_importer)
    echo 'Matching block [1/1]';;
mapper)
    echo 'Registering image #2 (3)'
    [ -e "$(dirname "$0")/slow" ] && { sleep 1000 & echo $! > "$(dirname "$0")/child.pid"; wait; }
    [ -e "$(dirname "$0")/broken" ] && { echo "ERROR: no memory" >&2; echo bye; exit 1; }
    models=$(after --output_path "$@")
    mkdir -p "$models/0" "$models/1"
    printf 12 > "$models/0/images.bin"
    printf 12345 > "$models/1/images.bin";;
model_converter)
    to=$(after --output_path "$@")
    second=$(cat "$(dirname "$0")/second" 2>/dev/null || echo c.png)
    echo '1 OPENCV 40 30 3001 3001 20 15 0 0 0 0' > "$to/cameras.txt"
    printf '# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D\n7 1 0 0 0 1 0 0 1 %s\n8 9 5\n8 1 0 0 0 0 0 0 1 a.png\n0 0 -1 3 4 5\n' "$second" > "$to/images.txt"
    echo "5 0 0 9 1 2 3 0.1 7 0 8 1" > "$to/points3D.txt";;
esac
"##;

fn colmap(folder: &Path) -> Colmap {
    let path = folder.join("colmap");
    fs::write(&path, SCRIPT).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    // A child that another test starts in this moment has the file open for writing, until it runs something else.
    let is_busy = || {
        let started = Command::new(&path).arg("help").output();
        started.is_err_and(|error| error.kind() == ErrorKind::ExecutableFileBusy)
    };
    while is_busy() {
        thread::sleep(Duration::from_millis(5));
    }
    Colmap {
        program: Program::at(&path).unwrap(),
    }
}

/// Two photos of a camera and one of another, which lie in the folder.
fn photos(folder: &Path) -> PhotoSet {
    let photo = |(name, camera): (&str, usize)| SurveyPhoto {
        name: name.to_owned(),
        path: {
            let path = folder.join(name);
            image::GrayImage::new(40, 30).save(&path).unwrap();
            path
        },
        camera,
        place: None,
        gimbal: None,
    };
    let camera = Camera {
        name: "drone".to_owned(),
        width: 40,
        height: 30,
        fx: 3000.5,
        fy: 3000.5,
        cx: 20.0,
        cy: 15.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let stated = |focal_error| SurveyCamera {
        camera: camera.clone(),
        focal_error,
        is_given: false,
    };
    PhotoSet {
        warnings: Vec::new(),
        photos: [("a.png", 0), ("c.png", 0), ("d.png", 1)].map(photo).into(),
        cameras: vec![stated(Some(0.02)), stated(None)],
        left_out: Vec::new(),
        origin: glam::DVec3::ZERO,
        count: 3,
    }
}

/// COLMAP has its own way to cards.
fn at(folder: &Path) -> Workplace<'_> {
    Workplace { folder, card: None }
}

#[test]
fn the_largest_model_is_what_comes_out() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    assert_eq!(engine.name(), "COLMAP 3.8");
    let work = folder.path().join("work");
    fs::create_dir(&work).unwrap();
    let progress = Progress::default();
    let found = engine.reconstruct(
        &photos(folder.path()),
        &[[0, 1], [1, 2]],
        &at(&work),
        &progress,
    );
    let found = found.unwrap();
    let names: Vec<&str> = (found.model.images())
        .map(|image| image.name.as_str())
        .collect();
    // As in the folder, though COLMAP numbered them otherwise; points are seen by the same.
    assert_eq!(names, ["a.png", "c.png"]);
    let track = &found.model.point3d(5).unwrap().track;
    let seen = |at: usize| {
        let image = found.model.image(track[at].image_id).unwrap();
        let pixel = image.point2d(track[at].point2d_idx).xy;
        (image.name.as_str(), pixel.x, pixel.y)
    };
    assert_eq!(
        (seen(0), seen(1)),
        (("c.png", 8.0, 9.0), ("a.png", 3.0, 4.0))
    );
    assert_eq!(found.model.camera(1).unwrap().params[0], 3001.0);
    let read = |name: &str| fs::read_to_string(work.join(name)).unwrap();
    assert_eq!(read("pairs.txt"), "a.png c.png\nc.png d.png\n");
    assert_eq!(read("camera-0.txt"), "a.png\nc.png\n");
    assert_eq!(read("camera-1.txt"), "d.png\n");
    let called = fs::read_to_string(folder.path().join("called.txt")).unwrap();
    let of = |command: &str| -> Vec<&str> {
        let starts = |line: &&str| line.starts_with(command);
        called.lines().filter(starts).collect()
    };
    let runs = of("feature_extractor --");
    // Both cameras are made first: the one whose photos state a focal length with it, the other without.
    assert!(runs[0].contains("--ImageReader.camera_params 3000.5,3000.5,20,15,0,0,0,0"));
    assert!(!runs[1].contains("camera_params"));
    assert!(runs[2].contains("--ImageReader.existing_camera_id 1"));
    assert!(runs[3].contains("--ImageReader.existing_camera_id 2"));
    assert_eq!(runs.len(), 4);
    assert!(of("model_converter")[0].contains("models/1 "), "{called}");
    assert!(
        runs.iter()
            .all(|run| run.contains("--SiftExtraction.use_gpu 0"))
    );
}

/// A run that goes on makes no camera again; one that was cut off before all were made begins anew.
#[test]
fn cameras_are_made_once() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    let work = folder.path().join("work");
    fs::create_dir(&work).unwrap();
    fs::write(work.join("database.db"), "with one of two cameras").unwrap();
    let called = folder.path().join("called.txt");
    let made = || {
        fs::write(&called, "").unwrap();
        let progress = Progress::default();
        let found = engine.reconstruct(&photos(folder.path()), &[[0, 1]], &at(&work), &progress);
        found.unwrap();
        let called = fs::read_to_string(&called).unwrap();
        called.matches("--ImageReader.single_camera 1").count()
    };
    assert_eq!(made(), 2);
    assert!(!work.join("database.db").exists());
    fs::write(work.join("database.db"), "with both").unwrap();
    assert_eq!(made(), 0);
    assert!(work.join("database.db").exists());
}

/// Lists are short, so that it is known how far it is and little is lost.
#[test]
fn pairs_are_compared_some_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    let pairs = vec![[0, 1]; 2 * PAIRS_AT_ONCE + 1];
    let progress = Progress::default();
    let found = engine.reconstruct(
        &photos(folder.path()),
        &pairs,
        &at(folder.path()),
        &progress,
    );
    found.unwrap();
    let called = fs::read_to_string(folder.path().join("called.txt")).unwrap();
    assert_eq!(called.matches("matches_importer --").count(), 3);
    let last = fs::read_to_string(folder.path().join("pairs.txt")).unwrap();
    assert_eq!(last, "a.png c.png\n");
}

#[test]
fn what_it_says_last_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    fs::write(folder.path().join("broken"), "").unwrap();
    let progress = Progress::default();
    let found = engine.reconstruct(
        &photos(folder.path()),
        &[[0, 1]],
        &at(folder.path()),
        &progress,
    );
    let said = found.err().unwrap().to_string();
    assert!(said.contains("COLMAP's mapper failed"), "{said}");
    assert!(said.contains("no memory"), "{said}");
}

/// Cancelled it ends within a second, with what it had started.
#[test]
fn cancelling_ends_the_whole_group() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    fs::write(folder.path().join("slow"), "").unwrap();
    let child = folder.path().join("child.pid");
    let progress = Progress::default();
    let (ended, asked) = std::thread::scope(|scope| {
        let work = || {
            engine.reconstruct(
                &photos(folder.path()),
                &[[0, 1]],
                &at(folder.path()),
                &progress,
            )
        };
        let work = scope.spawn(work);
        let started = || fs::read_to_string(&child).is_ok_and(|text| text.ends_with('\n'));
        while !started() {
            std::thread::sleep(Duration::from_millis(5));
        }
        let asked = Instant::now();
        progress.cancel();
        (work.join().unwrap(), asked)
    });
    assert!(ended.err().unwrap().to_string().contains("cancelled"));
    // Not a matter of speed: the child would have slept for a quarter of an hour.
    assert!(asked.elapsed() < Duration::from_secs(60));
    let pid = fs::read_to_string(&child).unwrap();
    let stat = format!("/proc/{}/stat", pid.trim());
    // Gone, or dead and not yet buried by init. A signal needs no time but that of the next turn of a busy
    // processor.
    let lives = || fs::read_to_string(&stat).is_ok_and(|stat| !stat.contains(") Z "));
    while lives() && asked.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(!lives());
}

/// Its list of pairs has blanks between the two names: it sees the photos under names without any, the model has their own.
#[test]
fn names_with_blanks() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    let mut photos = photos(folder.path());
    let path = folder.path().join("c d.png");
    fs::rename(folder.path().join("c.png"), &path).unwrap();
    photos.photos[1].name = "c d.png".to_owned();
    photos.photos[1].path = path;
    // The name that it would have is another photo's.
    fs::rename(folder.path().join("d.png"), folder.path().join("c_d.png")).unwrap();
    photos.photos[2].name = "c_d.png".to_owned();
    photos.photos[2].path = folder.path().join("c_d.png");
    fs::write(folder.path().join("second"), "_c_d.png").unwrap();
    let work = folder.path().join("work");
    fs::create_dir(&work).unwrap();
    let progress = Progress::default();
    for _ in 0..2 {
        let found = engine.reconstruct(&photos, &[[0, 1]], &at(&work), &progress);
        let found = found.unwrap();
        let names = found.model.images().map(|image| image.name.clone());
        assert_eq!(names.collect::<Vec<String>>(), ["a.png", "c d.png"]);
    }
    let pairs = fs::read_to_string(work.join("pairs.txt")).unwrap();
    assert_eq!(pairs, "a.png _c_d.png\n");
    let mut linked: Vec<String> = fs::read_dir(work.join("photos"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    linked.sort();
    assert_eq!(linked, ["_c_d.png", "a.png", "c_d.png"]);
    let called = fs::read_to_string(folder.path().join("called.txt")).unwrap();
    let own = format!("--image_path {}", work.join("photos").display());
    let runs = called.lines().filter(|line| line.starts_with("mapper --"));
    assert!(runs.into_iter().all(|line| line.contains(&own)), "{called}");
}

#[test]
fn another_program_is_refused() {
    let error = Program::at(Path::new("/bin/echo")).unwrap_err().to_string();
    assert!(error.contains("is no COLMAP"), "{error}");
    let error = Program::at(Path::new("/none/colmap"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("does not start"), "{error}");
}
