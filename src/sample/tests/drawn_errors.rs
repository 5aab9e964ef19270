//! Flights with errors drawn into what is written: the truth stays, and what is stated is what was
//! drawn.

use super::*;
use crate::flight::FlightFile;
use crate::formats::read_poses;
use crate::scale::{PoseErrors, StatedErrors};

const ALL: DrawnErrors = DrawnErrors {
    pose: Some(PoseNoise {
        position: 0.02,
        angle: 0.3,
    }),
    lens: Some(0.5),
    world: Some(1.0),
};

/// A folder with those errors, in UTM coordinates.
fn made_with(errors: DrawnErrors) -> tempfile::TempDir {
    let options = SampleOptions {
        preset: Preset::Muckpile,
        errors,
        ..options()
    };
    let mut recipe = small(&options);
    // Fewer fragments: what lies there is not the matter here.
    recipe.pile.smallest *= 2.0;
    made(&options, &recipe)
}

fn opened(folder: &Path) -> opening::Opened {
    open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap()
}

/// Without the keys of what was written.
fn only_true(mut truth: Value) -> Value {
    truth.as_object_mut().unwrap().remove("written");
    for photo in truth["photos"].as_array_mut().unwrap() {
        photo.as_object_mut().unwrap().remove("written");
    }
    truth
}

#[test]
fn the_truth_does_not_move() {
    let (plain, noisy) = (made_with(DrawnErrors::default()), made_with(ALL));
    let (true_of_plain, true_of_noisy) = (truth_of(plain.path()), truth_of(noisy.path()));
    assert_ne!(true_of_plain, true_of_noisy);
    assert_eq!(only_true(true_of_plain.clone()), true_of_plain);
    assert_eq!(only_true(true_of_noisy), true_of_plain);
    let bytes = |folder: &Path, name: &str| fs::read(folder.join(name)).unwrap();
    for name in ["flight.toml", "poses.csv", "ost.yaml", "pile.ply"] {
        assert_ne!(
            bytes(plain.path(), name),
            bytes(noisy.path(), name),
            "{name}"
        );
    }
    let name = "reference.csv";
    assert_eq!(bytes(plain.path(), name), bytes(noisy.path(), name));
}

/// Each error moves what it is of, and nothing else.
#[test]
fn each_error_moves_its_own_files() {
    let plain = made_with(DrawnErrors::default());
    let none = DrawnErrors::default();
    let (pose, lens, world) = (ALL.pose, ALL.lens, ALL.world);
    for (errors, moved) in [
        (
            DrawnErrors { pose, ..none },
            &["poses.csv", "truth.json"][..],
        ),
        (
            DrawnErrors { lens, ..none },
            &["flight.toml", "ost.yaml", "truth.json"],
        ),
        (
            DrawnErrors { world, ..none },
            &["flight.toml", "pile.ply", "poses.csv", "truth.json"],
        ),
    ] {
        let folder = made_with(errors);
        let mut differ = Vec::new();
        for entry in fs::read_dir(plain.path()).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let [before, after] =
                [plain.path(), folder.path()].map(|folder| fs::read(folder.join(&name)).unwrap());
            if before != after {
                differ.push(name);
            }
        }
        differ.sort();
        assert_eq!(differ, moved);
    }
}

#[test]
fn what_was_drawn_is_stated_and_reads_back() {
    let folder = made_with(ALL);
    let text = fs::read_to_string(folder.path().join("flight.toml")).unwrap();
    let stated = StatedErrors {
        focal: Some(0.5),
        world_scale: Some(1.0),
        ..StatedErrors::default()
    };
    assert_eq!(FlightFile::parse(&text).unwrap().errors(), stated);
    let pose = PoseErrors {
        position: Some(DVec3::splat(0.02)),
        angle: Some(DVec3::splat(0.3)),
    };
    let poses = read_poses(&folder.path().join("poses.csv")).unwrap();
    assert!(poses.lines.iter().all(|line| line.errors == pose));

    let truth = truth_of(folder.path());
    let opened = opened(folder.path());
    let parts = opened.flight.parts();
    assert_eq!(parts.photos.len(), 2);
    for (index, photo) in parts.photos.iter().enumerate() {
        assert_eq!(opened.flight.errors(photo), StatedErrors { pose, ..stated });
        let written = &truth["photos"][index]["written"];
        let number = |value: &Value| value.as_f64().unwrap();
        for axis in 0..3 {
            assert_eq!(photo.pose.center[axis], number(&written["center"][axis]));
            for column in 0..3 {
                let expected = number(&written["rotation"][axis * 3 + column]);
                let found = photo.pose.rotation.col(column)[axis];
                assert!((found - expected).abs() < 1e-15);
            }
        }
        // No more than six deviations from where it was (the world is scaled about the origin, 30 m
        // away at most).
        let actual = &truth["photos"][index]["actual"]["center"];
        let off = photo.pose.center - DVec3::from_array([0, 1, 2].map(|i| number(&actual[i])));
        assert!(
            off.length() > 1e-3 && off.length() < 6.0 * (0.02 + 0.01 * 60.0),
            "{off}"
        );
    }
    let factor = truth["written"]["focal_factor"].as_f64().unwrap();
    let camera = small(&options()).camera;
    assert_eq!(parts.cameras[0].fx, camera.fx * factor);
    assert_eq!(parts.cameras[0].fy, camera.fy * factor);
    assert!((factor - 1.0).abs() > 1e-6 && (factor - 1.0).abs() < 0.03);
}

/// A world that is written too long by a factor, poses and surface alike, has its scales divided by it.
#[test]
fn the_world_is_scaled_as_one() {
    let world = Some(20.0);
    let folder = made_with(DrawnErrors {
        world,
        ..DrawnErrors::default()
    });
    let truth = truth_of(folder.path());
    let factor = truth["written"]["world_factor"].as_f64().unwrap();
    assert!((factor - 1.0).abs() > 0.01);
    let mut expected = true_scales(folder.path(), "undistorted");
    for scales in &mut expected {
        for edge in [
            &mut scales.top,
            &mut scales.right,
            &mut scales.bottom,
            &mut scales.left,
        ] {
            *edge = edge.map(|scale| scale / factor);
        }
    }
    assert_same(&scales(folder.path()), &expected, 1e-9);
    // About the recipe's origin: the pile is still where it was in UTM.
    let bounds = opened(folder.path()).flight.parts().surface.bounds();
    let middle = (bounds.min + bounds.max) / 2.0;
    assert!((middle - DVec3::new(452_310.0, 5_411_860.0, 312.0)).length() < 60.0);
}
