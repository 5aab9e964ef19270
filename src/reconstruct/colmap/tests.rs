//! The engine with a script in COLMAP's place, which prints and writes what COLMAP 3.8 does. Real photos
//! through the real program: README, "Which engine".

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
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
    [ -e "$(dirname "$0")/broken" ] && { echo 'ERROR: no good initial image pair' >&2; echo 'bye'; exit 1; }
    models=$(after --output_path "$@")
    mkdir -p "$models/0" "$models/1"
    printf 12 > "$models/0/images.bin"
    printf 12345 > "$models/1/images.bin";;
model_converter)
    to=$(after --output_path "$@")
    echo "# of $(after --input_path "$@")" > "$to/cameras.txt"
    printf '# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D\n1 1 0 0 0 0 0 0 1 a.jpg\n0 0 -1\n2 1 0 0 0 1 0 0 1 c.jpg\n\n' > "$to/images.txt"
    : > "$to/points3D.txt";;
esac
"##;

fn colmap(folder: &Path) -> Colmap {
    let path = folder.join("colmap");
    fs::write(&path, SCRIPT).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    Colmap {
        program: Program::at(&path).unwrap(),
    }
}

fn photos() -> PhotoSet {
    let photo = |(name, camera): (&str, usize)| SurveyPhoto {
        name: name.to_owned(),
        path: Path::new("/photos").join(name),
        camera,
        place: None,
        looks: None,
    };
    let camera = Camera {
        name: "drone".to_owned(),
        width: 4000,
        height: 3000,
        fx: 3000.5,
        fy: 3000.5,
        cx: 2000.0,
        cy: 1500.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let stated = |focal_error| SurveyCamera {
        camera: camera.clone(),
        focal_error,
    };
    PhotoSet {
        photos: [("a.jpg", 0), ("c.jpg", 0), ("d.jpg", 1)].map(photo).into(),
        cameras: vec![stated(Some(0.02)), stated(None)],
        left_out: Vec::new(),
        origin: glam::DVec3::ZERO,
        count: 3,
    }
}

#[test]
fn the_largest_model_is_what_comes_out() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    assert_eq!(engine.name(), "COLMAP 3.8");
    let work = folder.path().join("work");
    fs::create_dir(&work).unwrap();
    let progress = Progress::default();
    let sparse = engine.reconstruct(&photos(), &[[0, 1], [1, 2]], &work, &progress);
    let sparse = sparse.unwrap();
    let cameras = String::from_utf8(sparse.files[0].1.clone()).unwrap();
    assert!(cameras.trim_end().ends_with("models/1"), "{cameras}");
    let left_out: Vec<&str> = sparse
        .left_out
        .iter()
        .map(|left| left.photo.as_str())
        .collect();
    assert_eq!(left_out, ["d.jpg"]);
    let read = |name: &str| fs::read_to_string(work.join(name)).unwrap();
    assert_eq!(read("pairs.txt"), "a.jpg c.jpg\nc.jpg d.jpg\n");
    assert_eq!(read("camera-0.txt"), "a.jpg\nc.jpg\n");
    assert_eq!(read("camera-1.txt"), "d.jpg\n");
    let called = fs::read_to_string(folder.path().join("called.txt")).unwrap();
    let runs: Vec<&str> = called
        .lines()
        .filter(|line| line.starts_with("feature_extractor --"))
        .collect();
    // The camera whose photos state a focal length begins with it, the other does not.
    assert!(runs[0].contains("--ImageReader.camera_params 3000.5,3000.5,2000,1500,0,0,0,0"));
    assert!(!runs[1].contains("camera_params"));
    assert!(
        runs.iter()
            .all(|run| run.contains("--SiftExtraction.use_gpu 0"))
    );
}

#[test]
fn what_it_says_last_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    fs::write(folder.path().join("broken"), "").unwrap();
    let progress = Progress::default();
    let error = engine.reconstruct(&photos(), &[[0, 1]], folder.path(), &progress);
    let said = error.unwrap_err().to_string();
    assert!(said.contains("COLMAP's mapper failed"), "{said}");
    assert!(said.contains("no good initial image pair"), "{said}");
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
        let work = || engine.reconstruct(&photos(), &[[0, 1]], folder.path(), &progress);
        let work = scope.spawn(work);
        let started = || fs::read_to_string(&child).is_ok_and(|text| text.ends_with('\n'));
        while !started() {
            std::thread::sleep(Duration::from_millis(5));
        }
        let asked = Instant::now();
        progress.cancel();
        (work.join().unwrap(), asked)
    });
    assert!(ended.unwrap_err().to_string().contains("cancelled"));
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

/// Its list of pairs has blanks between the two names.
#[test]
fn names_with_blanks_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let engine = colmap(folder.path());
    let mut photos = photos();
    photos.photos[1].name = "c d.jpg".to_owned();
    let progress = Progress::default();
    let error = engine.reconstruct(&photos, &[[0, 1]], folder.path(), &progress);
    assert!(error.unwrap_err().to_string().contains("'c d.jpg'"));
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
