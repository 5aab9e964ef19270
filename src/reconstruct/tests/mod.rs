//! From rendered photos of a known surface to the flight, and from folders in which something is wrong.

mod lens;
mod scene;

use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock};

use fragscale_sample::files::photo::jpeg;
use fragscale_sample::files::photo_metadata::{DjiGimbal, PhotoMetadata};
use glam::DVec3;

use self::scene::{ORIGIN, height, metadata, photo, photos, poses, write};
use super::*;
use crate::formats::read_cloud;
use crate::opening::{OpenOptions, open_flight};

fn request(photos: &Path, to: &Path) -> Request {
    Request {
        photos: photos.to_owned(),
        to: to.to_owned(),
        crs: None,
        camera: None,
        dense: None,
        card: None,
    }
}

/// The flight of [`photos`], found once for all tests: folder and result.
fn found() -> (&'static Path, &'static Reconstructed) {
    static FOUND: OnceLock<(tempfile::TempDir, Reconstructed)> = OnceLock::new();
    let (folder, made) = FOUND.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let request = request(photos(), &folder.path().join("flight"));
        let made = reconstruct(&request, &Embedded::default(), &Progress::default()).unwrap();
        (folder, made)
    });
    (folder.path(), made)
}

/// Three of these four photos were turned in another program, which their headers tell.
#[test]
fn doubts_of_the_headers_are_said() {
    let Some(folder) = fragscale_test_data::shared_data("odm-brighton-0") else {
        return;
    };
    let photos = PhotoSet::read(&folder.join("images"), None, &Progress::default()).unwrap();
    let said = photos.warnings.join("; ");
    let says =
        "3 photos (DJI_0027.JPG, DJI_0028.JPG, DJI_0029.JPG): it was last written by 'Microsoft";
    assert!(said.contains(says), "{said}");
}

/// Stopped after the first photos were looked at, their features are kept for the next run.
#[test]
fn interrupted_features_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("flight");
    let progress = Progress::default();
    let watch = progress.clone();
    let stop = std::thread::spawn(move || {
        let is_going = || {
            let (stage, share) = watch.snapshot();
            stage.starts_with("finding features") && share > 0.0
        };
        while !is_going() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        watch.cancel();
    });
    let stopped = reconstruct(&request(photos(), &to), &Embedded::default(), &progress);
    stop.join().unwrap();
    assert!(stopped.is_err());
    assert!(to.join("unfinished/features.bin").exists());
}

/// Paused while the model grows nothing goes on; then the same comes out to the bit, whoever looks on.
#[test]
fn paused_and_shown_the_same_comes_out() {
    let folder = tempfile::tempdir().unwrap();
    let shown = folder.path().join("shown");
    let alone = found().0.join("flight");
    let progress = Progress::default();
    let grown = Arc::new(Mutex::new(Vec::<Growth>::new()));
    let stood = Arc::new(Mutex::new(Vec::new()));
    let (taken, watched, watch) = (grown.clone(), stood.clone(), progress.clone());
    let on_growth: OnGrowth = Box::new(move |growth| {
        taken.lock().unwrap().push(growth);
        if taken.lock().unwrap().len() > 1 {
            return;
        }
        watch.pause(true);
        let (watch, watched) = (watch.clone(), watched.clone());
        std::thread::spawn(move || {
            for _ in 0..4 {
                std::thread::sleep(std::time::Duration::from_millis(150));
                watched.lock().unwrap().push(watch.snapshot());
            }
            watch.pause(false);
        });
    });
    let engine = Embedded {
        on_growth: Some(on_growth),
    };
    let begun = std::time::Instant::now();
    reconstruct(&request(photos(), &shown), &engine, &progress).unwrap();
    assert!(begun.elapsed() > std::time::Duration::from_millis(600));
    let stood = stood.lock().unwrap();
    assert!(
        stood.len() == 4 && stood.iter().all(|at| *at == stood[0]),
        "{stood:?}"
    );
    for name in [
        "poses.csv",
        "pile.laz",
        "reconstruction/points3D.txt",
        "reconstruction/images.txt",
    ] {
        let read = |folder: &Path| fs::read(folder.join(name)).unwrap();
        assert!(read(&alone) == read(&shown), "{name}");
    }
    // What was shown first are two cameras that look at the same points.
    let grown = grown.lock().unwrap();
    let first = &grown[0];
    assert_eq!((first.cameras.len(), first.points.len()), (2, first.of));
    assert!(first.of > 50);
    assert_eq!(first.colors.len(), first.of);
    // Sand and stone: no point without a photo, and none black.
    assert!(
        first
            .colors
            .iter()
            .all(|color| color.iter().max() > Some(&20))
    );
    for camera in &first.cameras {
        let ahead = |point: &&DVec3| camera.camera_from_world(**point).z > 0.0;
        assert_eq!(first.points.iter().filter(ahead).count(), first.of);
    }
}

/// On a card (here a driver that computes on the processor) the same model comes out to the bit. Where it is lost,
/// the processor goes on to the end, and it is said. Four photos: such a driver takes minutes for the pairs of all.
#[test]
fn a_card_computes_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let few = folder.path().join("photos");
    fs::create_dir(&few).unwrap();
    for name in ["IMG_1.jpg", "IMG_2.jpg", "IMG_4.jpg", "IMG_5.jpg"] {
        fs::copy(photos().join(name), few.join(name)).unwrap();
    }
    let progress = Progress::default();
    let on = |name: &str, card: Option<Card>, dense: Option<DenseOptions>| {
        let to = folder.path().join(name);
        let request = Request {
            dense,
            card,
            ..request(&few, &to)
        };
        let made = reconstruct(&request, &Embedded::default(), &progress).unwrap();
        let points = fs::read(to.join("reconstruction/points3D.txt")).unwrap();
        (made, points)
    };
    let gpu = fragscale_render::Gpu::fastest().unwrap();
    let (processor, points) = on("processor", None, None);
    assert_eq!(processor.computed_on, None);
    let (card, its_points) = on("card", Some(Card::on(gpu.clone())), None);
    assert!(points == its_points);
    let said = summary(&card).join("\n");
    let expected = format!("computed on {}", gpu.name);
    assert!(said.contains(&expected), "{said}");

    gpu.device.destroy();
    let (lost, its_points) = on("lost", Some(Card::on(gpu)), Some(small()));
    assert!(points == its_points);
    assert!(lost.dense.is_some() && lost.computed_on.is_none());
    let said = lost.warnings.join("\n");
    assert!(said.contains("the processor went on"), "{said}");
}

/// Poses, lens, points, standard errors and coordinate system are those that the photos were rendered with; what
/// is none is left out with its reason. Interrupted between two stages and started again, the same comes out.
#[test]
fn rendered_photos_become_their_flight() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("flight");
    let progress = Progress::default();
    let (found, made) = found();
    is_as_rendered(made, "blurred");
    assert_eq!(made.dense, None);
    copy(&found.join("flight"), &to);

    // The same again with a dense cloud, cut off when the features are found, and among the depths.
    let again = folder.path().join("again");
    let dense = Request {
        dense: Some(small()),
        ..request(photos(), &again)
    };
    cut_off(&dense, &Embedded::default(), "comparing", 0.0);
    assert!(again.join("unfinished/features.bin").exists());
    assert!(cut_off(&dense, &Embedded::default(), "refining depths", 0.3) < 1.0);
    assert!(again.join("unfinished/depths/first-8").exists());
    // Its twin keeps the model and finds all depths once more.
    let twin = folder.path().join("twin");
    copy(&again.join("unfinished"), &twin.join("unfinished"));
    fs::remove_dir_all(twin.join("unfinished/depths")).unwrap();
    let second = reconstruct(&dense, &Embedded::default(), &progress).unwrap();
    assert!(!again.join("unfinished").exists());
    assert_eq!(
        (second.registered, second.points),
        (made.registered, made.points)
    );
    let dense = Request {
        to: twin.clone(),
        ..dense
    };
    assert_eq!(
        reconstruct(&dense, &Embedded::default(), &progress)
            .unwrap()
            .dense,
        second.dense
    );
    let read = |folder: &Path, name: &str| fs::read(folder.join(name)).unwrap();
    assert!(read(&again, "poses.csv") == read(&to, "poses.csv"));
    for name in [
        "poses.csv",
        "pile.laz",
        "flight.toml",
        "reconstruction/points3D.txt",
    ] {
        assert!(read(&again, name) == read(&twin, name), "{name}");
    }
    is_dense(&again, second.dense.unwrap());

    // The finished flight gets a dense cloud: the model is not found again, and what was set stays.
    let flight = to.join("flight.toml");
    let text = fs::read_to_string(&flight).unwrap();
    let decided = "[[review]]\nphoto = \"IMG_1.jpg\"\ndecision = \"left-out\"\n";
    fs::write(&flight, format!("{text}\n{decided}")).unwrap();
    let dense = Request {
        dense: Some(small()),
        ..request(photos(), &to)
    };
    let third = reconstruct(&dense, &Embedded::default(), &progress).unwrap();
    assert_eq!(third.dense, second.dense);
    assert_eq!(third.left_out, made.left_out);
    for name in ["poses.csv", "pile.laz", "reconstruction/images.txt"] {
        assert!(read(&to, name) == read(&again, name), "{name}");
    }
    let text = fs::read_to_string(&flight).unwrap();
    assert!(text.contains("decision = \"left-out\""), "{text}");
    let opened = open_flight(&flight, &OpenOptions::default(), &progress).unwrap();
    let twins = open_flight(&second.flight, &OpenOptions::default(), &progress).unwrap();
    let errors = |opened: &crate::opening::Opened| opened.settings.errors;
    assert_eq!(errors(&opened), errors(&twins));
    assert!(errors(&opened).surface.is_some());
    // In another system its settings would mean something else.
    let elsewhere = Request {
        crs: Some("EPSG:32633".to_owned()),
        ..request(photos(), &to)
    };
    let fault = reconstruct(&elsewhere, &Embedded::default(), &progress).unwrap_err();
    let said = fault.to_string();
    assert!(
        said.contains("say other places now, or of another coordinate system (IMG_1.jpg"),
        "{said}"
    );
    assert!(read(&to, "poses.csv") == read(&again, "poses.csv"));
    // Other photos do not take its place.
    let others = folder.path().join("others");
    fs::create_dir(&others).unwrap();
    for name in ["IMG_1.jpg", "IMG_2.jpg", "IMG_3.jpg"] {
        fs::copy(photos().join(name), others.join(name)).unwrap();
    }
    let fault = reconstruct(&request(&others, &to), &Embedded::default(), &progress).unwrap_err();
    assert!(fault.to_string().contains("of other photos"), "{fault}");
}

/// What all engines have to find in the photos. `of_blank` is in the reason that the blank one is left out for.
fn is_as_rendered(made: &Reconstructed, of_blank: &str) {
    let to = made.flight.parent().unwrap();
    let progress = Progress::default();
    assert_eq!((made.registered, made.photos), (9, 14));
    let why = |name: &str| {
        let left = made.left_out.iter().find(|left| left.photo == name);
        left.map(|left| left.why.clone()).unwrap_or_default()
    };
    let said = &made.left_out;
    assert!(why("blank.jpg").contains(of_blank), "{said:?}");
    assert!(why("other.jpg").contains("too little"), "{said:?}");
    assert_eq!(why("empty.jpg"), "it is empty");
    assert!(why("cut.jpg").contains("is cut off at"), "{said:?}");
    assert_eq!(why("copy of 5.jpg"), "it is a copy of IMG_5.jpg");
    // The list beside the model has them all, each once.
    let listed = fs::read_to_string(to.join("reconstruction/left_out.txt")).unwrap();
    let listed = listed.lines().count();
    assert_eq!((said.len(), listed), (5, 5), "{said:?}");
    assert!(made.reprojection_px.unwrap() < 0.5);

    let opened = open_flight(&made.flight, &OpenOptions::default(), &progress).unwrap();
    let parts = opened.flight.parts();
    assert_eq!(opened.crs.as_deref(), Some("EPSG:32632"));
    assert_eq!(parts.photos.len(), 9);
    let ground_pixel = 30.0 / 600.0;
    let mut squares = 0.0;
    for (photo, pose) in parts.photos.iter().zip(poses()) {
        let off = photo.pose.center - ORIGIN - pose.center;
        squares += off.length_squared() / 9.0;
        let turn = photo.pose.rotation.transpose() * pose.rotation;
        let angle = ((turn.x_axis.x + turn.y_axis.y + turn.z_axis.z - 1.0) / 2.0).clamp(-1.0, 1.0);
        assert!(angle.acos().to_degrees() < 0.1, "{}: {angle}", photo.name);
        let stated = opened.flight.errors(photo).pose;
        assert!(
            stated.position.is_some() && stated.angle.is_some(),
            "{}",
            photo.name
        );
    }
    assert!(squares.sqrt() < 0.3 * ground_pixel, "{squares}");
    let focal = parts.cameras[0].fx;
    assert!((focal / 600.0 - 1.0).abs() < 2e-3, "{focal}");
    let cloud = read_cloud(&to.join("pile.laz"), &progress).unwrap().cloud;
    let mut off: Vec<f64> = (cloud.points.iter())
        .map(|point| *point - ORIGIN)
        .map(|point| (point.z - height(point.truncate())).abs())
        .collect();
    assert!(off.len() > 2000, "{}", off.len());
    let median = geometry::median(&mut off).unwrap();
    assert!(median < ground_pixel, "{median}");

    assert_eq!(off.len(), made.points);
    // COLMAP's list of images: a line of the pose, a line of X, Y and the point's number, -1 for none.
    let images = fs::read_to_string(to.join("reconstruction/images.txt")).unwrap();
    let report = fs::read_to_string(to.join("report.html")).unwrap();
    let lines: Vec<&str> = images.lines().filter(|l| !l.starts_with('#')).collect();
    for two in lines.chunks_exact(2) {
        let name = two[0].split(' ').next_back().unwrap();
        let numbers: Vec<&str> = two[1].split_whitespace().skip(2).step_by(3).collect();
        let shown = numbers.iter().filter(|number| **number != "-1").count();
        assert!(report.contains(&format!("<td>{name}</td><td>{shown}</td>")));
    }
    assert_eq!(lines.len(), 18);
    assert!(report.contains("<td>other.jpg</td><td>it shows too little"));
    assert!(report.contains("off the 9 positions that were used"));
}

/// Depth maps of a quarter of the photos' pixels, for the sake of time.
fn small() -> DenseOptions {
    DenseOptions {
        most_pixels: 80_000,
        ..Quality::Normal.dense().unwrap()
    }
}

/// Runs until a stage of which the sentence begins so, and cancels it when so much of it is done; seconds that it
/// took to stop.
fn cut_off(request: &Request, engine: &dyn Engine, stage: &'static str, from: f64) -> f64 {
    let stopped = Progress::default();
    let watched = stopped.clone();
    let watcher = std::thread::spawn(move || {
        let (mut sentence, mut fraction) = watched.snapshot();
        while !(sentence.starts_with(stage) && fraction >= from) {
            std::thread::sleep(std::time::Duration::from_millis(1));
            (sentence, fraction) = watched.snapshot();
        }
        watched.cancel();
        std::time::Instant::now()
    });
    let cut = reconstruct(request, engine, &stopped).unwrap_err();
    let took = watcher.join().unwrap().elapsed();
    assert_eq!(cut.fault.what, "cancelled");
    took.as_secs_f64()
}

/// The real program: cut off among features and among matches it goes on, and finds what the embedded engine does.
#[test]
fn colmap_finds_the_same_flight() {
    if fragscale_test_data::program("colmap").is_none() {
        return;
    }
    let engine = Colmap::on_path().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let request = request(photos(), &folder.path().join("flight"));
    for (stage, from) in [("COLMAP: features", 0.3), ("COLMAP: matches", 0.2)] {
        let took = cut_off(&request, &engine, stage, from);
        // Asked ten times a second; the rest is how busy the processor is.
        assert!(took < 5.0, "{stage}: {took} s");
    }
    let made = reconstruct(&request, &engine, &Progress::default()).unwrap();
    is_as_rendered(&made, "too little");
    // One camera for all, though it was begun twice.
    let cameras = request.to.join("reconstruction/cameras.txt");
    let cameras = fs::read_to_string(cameras).unwrap();
    let cameras = cameras.lines().filter(|line| !line.starts_with('#'));
    assert_eq!(cameras.count(), 1);
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let to = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy(&path, &to),
            false => fs::copy(&path, &to).map(|_| ()).unwrap(),
        }
    }
}

/// Without places a model stands upright: by the gimbals' angles, and without them by its points. The rock's waves
/// are 1.2 m high, and what five photos show of them is 25 m wide: so much is their plane aslant.
#[test]
fn models_without_places_are_upright() {
    let folder = tempfile::tempdir().unwrap();
    for (name, has_gimbal, most) in [("gimbal", true, 0.5), ("nothing", false, 6.0)] {
        let photos = folder.path().join(name);
        fs::create_dir(&photos).unwrap();
        for (number, pose) in (1..6).zip(&poses()) {
            let looks = pose.rotation.z_axis;
            let gimbal = DjiGimbal {
                roll: 0.0,
                yaw: looks.x.atan2(looks.y).to_degrees(),
                pitch: looks.z.asin().to_degrees(),
                relative_altitude: 30.0,
            };
            let said = PhotoMetadata {
                dji: has_gimbal.then_some(gimbal),
                ..metadata(None)
            };
            let bytes = jpeg(&photo(pose, 1), 92, &said).unwrap();
            fs::write(photos.join(format!("IMG_{number}.jpg")), bytes).unwrap();
        }
        let to = folder.path().join(format!("{name} flight"));
        let made = reconstruct(
            &request(&photos, &to),
            &Embedded::default(),
            &Progress::default(),
        )
        .unwrap();
        let said = made.warnings.join("; ");
        let by = match has_gimbal {
            true => "up is where the gimbals' angles say",
            false => "up is taken to be across the points",
        };
        assert!(said.contains(by) && said.contains("no unit"), "{said}");
        // The same command again finds its own flight.
        let again = request(&photos, &to);
        let again = reconstruct(&again, &Embedded::default(), &Progress::default());
        assert_eq!(again.unwrap().registered, made.registered);
        let model = crate::formats::read_project(&to.join("reconstruction"), &Progress::default());
        for photo in &model.unwrap().reconstruction.photos {
            let number = photo.name.as_bytes()[4] - b'1';
            let truth = poses()[usize::from(number)].rotation;
            // Up as this photo sees it, in the model.
            let up = photo.pose.rotation * (truth.transpose() * DVec3::Z);
            let off = up.angle_between(DVec3::Z).to_degrees();
            assert!(off < most, "{name}: {} {off}", photo.name);
        }
    }
}

/// The cloud lies on the rock as closely as the flight states, all over what three photos show.
fn is_dense(flight: &Path, dense: DensePoints) {
    let progress = Progress::default();
    let cloud = read_cloud(&flight.join("pile.laz"), &progress)
        .unwrap()
        .cloud;
    assert_eq!(
        (cloud.points.len(), cloud.colors.len()),
        (dense.count, dense.count)
    );
    // Nine photos of 76 800 pixels; what four show is one point.
    assert!(dense.count > 70_000, "{}", dense.count);
    let above = cloud.points.iter().map(|point| *point - ORIGIN);
    let mut above: Vec<f64> = above
        .map(|point| point.z - height(point.truncate()))
        .collect();
    // How well the world's heights are known is stated apart, by the receivers and the focal length: with one a tenth of a percent
    // too long, as nine photos tell it, all lies 3 cm lower, and scales are the same.
    let all = geometry::median(&mut above).unwrap();
    assert!(all.abs() < 0.05, "{all}");
    let mut off: Vec<f64> = above.iter().map(|above| (above - all).abs()).collect();
    off.sort_by(f64::total_cmp);
    let share = |most: f64| off.partition_point(|off| *off <= most) as f64 / off.len() as f64;
    let deviation = dense.deviation;
    // A pixel of the depth maps is 0.1 m wide: less than half of it along the view.
    assert!((0.005..0.04).contains(&deviation), "{deviation}");
    // A standard deviation holds two thirds, three of them nearly all; a little less, for poses and lens err, too.
    assert!(share(deviation) > 0.55, "{}", share(deviation));
    assert!(share(3.0 * deviation) > 0.95, "{}", share(3.0 * deviation));
    let opened = open_flight(
        &flight.join("flight.toml"),
        &OpenOptions::default(),
        &progress,
    );
    let stated = opened.unwrap().flight.parts().errors.surface.unwrap();
    assert!((stated / deviation - 1.0).abs() < 1e-3, "{stated}");
}

/// One line, and nothing left where nothing was.
#[test]
fn folders_without_photos_that_overlap_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let photos = folder.path().join("photos");
    let to = folder.path().join("flight");
    fs::create_dir(&photos).unwrap();
    let refused_by = |engine: &dyn Engine, what: &str| {
        let error = reconstruct(&request(&photos, &to), engine, &Progress::default());
        let error = error.unwrap_err().to_string();
        assert!(error.contains(what), "{error}");
        assert!(!error.contains('\n'));
    };
    let refused = |what: &str| refused_by(&Embedded::default(), what);
    refused("a reconstruction needs three at least");
    // Which cannot be read is said.
    fs::write(photos.join("empty.jpg"), "").unwrap();
    refused("0 of its 1 photos can be read (empty.jpg: ");
    // As are the folders within that have some.
    fs::create_dir_all(photos.join("day 2")).unwrap();
    fs::rename(photos.join("empty.jpg"), photos.join("day 2/a.jpg")).unwrap();
    refused("name one of its folders that have some: day 2");
    for (number, pose) in (1..4).zip(&poses()) {
        let name = format!("IMG_{number}.jpg");
        // Each of another place.
        write(&photos, &name, &photo(pose, 1000 * number), Some(pose));
    }
    refused("show the same");
    // Another run at work in the folder.
    let work = to.join("unfinished");
    let other = lock_work(&to, &work).unwrap();
    refused("another run works in this folder");
    drop(other);
    let read = |folder: &Path| PhotoSet::read(folder, None, &Progress::default());
    let set = read(&photos).unwrap();
    let said = set.warnings.join("; ");
    assert!(said.contains("not taken (day 2)"), "{said}");
    // Folders that a camera made are one flight, whatever their photos are called; others are asked for.
    let card = folder.path().join("DCIM");
    for within in ["100MEDIA", "101MEDIA"] {
        fs::create_dir_all(card.join(within)).unwrap();
        for (number, pose) in (1..3).zip(&poses()) {
            let number = if within == "100MEDIA" {
                number
            } else {
                number + 10
            };
            let name = format!("DJI_{}.jpg", number % 10);
            write(
                &card.join(within),
                &name,
                &photo(pose, 1000 * number),
                Some(pose),
            );
        }
    }
    let set = read(&card).unwrap();
    let names: Vec<&str> = set.photos.iter().map(|photo| photo.name.as_str()).collect();
    let wanted = [
        "100MEDIA/DJI_1.jpg",
        "100MEDIA/DJI_2.jpg",
        "101MEDIA/DJI_1.jpg",
        "101MEDIA/DJI_2.jpg",
    ];
    assert_eq!((names, set.warnings), (wanted.to_vec(), Vec::new()));
    fs::create_dir_all(card.join("labels")).unwrap();
    fs::copy(&set.photos[0].path, card.join("labels/a.jpg")).unwrap();
    let set = read(&card).unwrap();
    assert_eq!(set.photos.len(), 4);
    assert!(
        set.warnings[0].contains("not taken (labels)"),
        "{:?}",
        set.warnings
    );
    if fragscale_test_data::program("colmap").is_some() {
        refused_by(&Colmap::on_path().unwrap(), "show the same");
    }
    fs::write(to.join("mine.txt"), "mine").unwrap();
    let _ = fs::remove_dir_all(to.join("unfinished"));
    refused("the folder is not empty");
    fs::write(to.join("flight.toml"), "").unwrap();
    refused("there is a flight in it already");
}
