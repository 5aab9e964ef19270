use glam::DMat3;
use proptest::prelude::*;

use super::*;
use fragscale_test_data::shared_data;

/// Half a turn about x: a camera at z = 10 that looks down. The point (5, -2.5, 0) is seen 0.5 right
/// and 0.25 below the axis; with f = 100 and r = 0 that is (50, 25) from the middle.
const FROM_MIDDLE: &str = "NVM_V3 \n\n2\n\
    some\"folder/first.jpg 100 0 1 0 0 0 0 10 0 0\n\
    b c.jpg 200 2 0 0 2 5 6 7 0.25 0\n\n\
    2\n\
    5 -2.5 0 9 8 7 1 0 3 50 25\n\
    -5 2.5 0 1 2 3 1 0 4 -50 -25 \n\n\
    0\n\n# the PLY section\n3\n0 1 2\n";

fn principal_points_from(origin: Origin) -> Sizes {
    Sizes::Unknown {
        unit: ImageUnit::Pixel,
        principal_points_from: origin,
    }
}

#[test]
fn a_small_file_is_read() {
    let model = read(FROM_MIDDLE).unwrap();
    assert_eq!(
        (model.package, model.sizes.are_known()),
        ("visualsfm", false)
    );
    let names: Vec<&str> = model.photos.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["some folder/first.jpg", "b c.jpg"]);
    let camera = &model.cameras[1];
    assert_eq!((camera.name.as_str(), camera.width), ("b c.jpg", 0));
    assert_eq!(
        (camera.fx, camera.fy, camera.cx, camera.cy),
        (200.0, 200.0, 0.0, 0.0)
    );
    assert_eq!(camera.distortion.coefficients(), [0.25]);
    // A quarter turn about z of camera_from_world, given as a quaternion of another length; the
    // centre stands as it is.
    let pose = model.photos[1].pose;
    assert_eq!(pose.center, DVec3::new(5.0, 6.0, 7.0));
    let world_from_camera = DMat3::from_cols(DVec3::NEG_Y, DVec3::X, DVec3::Z);
    assert!(pose.rotation.abs_diff_eq(world_from_camera, 1e-15));
    assert_eq!(model.cloud.colors, [[9, 8, 7], [1, 2, 3]]);
    assert_eq!(model.observed_from, Origin::Middle);
    assert_eq!(model.median_reprojection_px(), Some(0.0));
    assert_eq!(model.warnings, [""; 0]);
}

#[test]
fn sizes_put_the_middle_in_its_place() {
    let mut model = read(FROM_MIDDLE).unwrap();
    model.set_sizes(|_| Some((400, 300)));
    assert_eq!((model.cameras[0].cx, model.cameras[0].cy), (200.0, 150.0));
    assert_eq!(model.median_reprojection_px(), Some(0.0));
}

#[test]
fn measurements_without_a_sign_count_from_the_corner() {
    let text = FROM_MIDDLE
        .replace(" 3 50 25", " 3 250 175")
        .replace("-50 -25", "150 125");
    let mut model = read(&text).unwrap();
    assert_eq!(model.observed_from, Origin::Corner);
    assert_eq!(model.median_reprojection_px(), None);
    model.set_sizes(|_| Some((400, 300)));
    assert_eq!(model.median_reprojection_px(), Some(0.0));
}

/// The principal point (210, 140) is known from the corner, so no size is needed to compare.
#[test]
fn a_fixed_calibration_counts_from_the_corner() {
    let fixed = FROM_MIDDLE.replace("NVM_V3 ", "NVM_V3 FixedK 100 210 101 140 0.125");
    let two = fixed.replace("b c.jpg 200", "b c.jpg 100.0004");
    let from_corner = two
        .replace(" 3 50 25", " 3 260 165.25")
        .replace("-50 -25", "160 114.75")
        .replace("0.125", "");
    let mut model = read(&from_corner).unwrap();
    assert_eq!(model.sizes, principal_points_from(Origin::Corner));
    assert_eq!(model.observed_from, Origin::Corner);
    assert_eq!(model.median_reprojection_px(), Some(0.0));
    model.set_sizes(|_| Some((400, 300)));
    for camera in &model.cameras {
        assert_eq!(
            (camera.fx, camera.fy, camera.cx, camera.cy),
            (100.0, 101.0, 210.0, 140.0)
        );
    }
    assert_eq!(model.median_reprojection_px(), Some(0.0));

    // Measurements around the principal point come out the same.
    let around = two
        .replace(" 3 50 25", " 3 50 25.25")
        .replace("-50 -25", "-50 -25.25")
        .replace("0.125", "");
    assert_eq!(read(&around).unwrap().observations, model.observations);

    assert_eq!(
        read(&two).unwrap().cameras[1].distortion.coefficients(),
        [0.125]
    );
    // The bundle adjustment moved on: f = 200, and the pixels keep their shape.
    let moved = read(&fixed).unwrap();
    assert_eq!((moved.cameras[1].fx, moved.cameras[1].fy), (200.0, 202.0));
    assert!(moved.warnings[0].contains("another focal length"));
}

#[test]
fn a_fixed_calibration_may_count_from_the_middle() {
    let text = FROM_MIDDLE
        .replace("NVM_V3 ", "NVM_V3 FixedK 100 -3 100 4")
        .replace("b c.jpg 200", "b c.jpg 100");
    let mut model = read(&text).unwrap();
    assert_eq!(model.sizes, principal_points_from(Origin::Middle));
    assert_eq!(model.observed_from, Origin::Middle);
    assert_eq!(model.median_reprojection_px(), Some(0.0));
    model.set_sizes(|_| Some((400, 300)));
    assert_eq!((model.cameras[0].cx, model.cameras[0].cy), (197.0, 154.0));
    assert_eq!(model.median_reprojection_px(), Some(0.0));
}

#[test]
fn windows_line_ends_and_a_mark_change_nothing() {
    let windows = format!("\u{feff}{}", FROM_MIDDLE.replace('\n', "\r\n"));
    assert_eq!(read(&windows), read(FROM_MIDDLE));
}

const MODEL: &str = "1\na.jpg 100 1 0 0 0 0 0 0 0 0\n1\n0 0 1 1 1 1 0\n";

#[test]
fn further_models_and_unaligned_photos_are_counted() {
    let unaligned = "2\nx.jpg 0 0 0 0 0 0 0 0 0 0\ny.jpg 100 1 0 0 0 0 0 0 0 0\n0\n";
    let nowhere = "2\nx.jpg 9 1 0 0 0 0 0 0 0 0\ny.jpg 100 1 0 0 0 0 0 0 0 0\n0\n";
    let text = format!("NVM_V3\n{MODEL}{MODEL}{unaligned}0\nnot read");
    let model = read(&text).unwrap();
    assert_eq!((model.photos.len(), model.cloud.points.len()), (1, 1));
    assert_eq!(
        model.warnings,
        [
            "only the first model is read; left out, each in its own frame: 1 photos with 1 points",
            "2 photos were not aligned and are left out"
        ]
    );
    // Where the list of unaligned photos comes first.
    let model = read(&format!("NVM_V3\n{nowhere}{MODEL}")).unwrap();
    assert_eq!(model.photos[0].name, "a.jpg");
    assert_eq!(
        model.warnings,
        ["2 photos were not aligned and are left out"]
    );
    // Poses without points are poses still; the indices of the points skip who is left out.
    let mixed = "3\nx 0 1 0 0 0 1 1 1 0 0\ny 9 1 0 0 0 0 0 0 0 0\nz 9 0 0 1 0 0 0 5 0 0\n";
    let model = read(&format!("NVM_V3\n{mixed}0\n0\n")).unwrap();
    assert_eq!(model.photos.len(), 2);
    let seen = "1\n0 0 1 1 1 1 2 0 5 3 4 2 6 7 8\n";
    let model = read(&format!("NVM_V3\n{mixed}{seen}0\n")).unwrap();
    let only = Observation {
        photo: 1,
        point: 0,
        pixel: DVec2::new(7.0, 8.0),
    };
    assert_eq!(model.observations, [only]);
    // A damaged tail does not cost the first model.
    let model = read(&format!("NVM_V3\n{MODEL}5\nb.jpg")).unwrap();
    assert!(model.warnings[0].contains("line 7"), "{:?}", model.warnings);
    assert!(read(&format!("NVM_V3\n{unaligned}0\n")).is_ok());
    assert!(read(&format!("NVM_V3\n{nowhere}0\n")).is_err());
}

#[test]
fn faults_name_their_line() {
    let photo = "a.jpg 100 1 0 0 0 0 0 0 0 0";
    let file = |photo: &str, point: &str| format!("NVM_V3\n1\n{photo}\n1\n{point}\n0\n");
    let point = "0 0 1 1 1 1 1 0 0 5 5";
    assert!(read(&file(photo, point)).is_ok());
    for (text, line) in [
        (String::new(), 1),
        ("ply\n".to_owned(), 1),
        ("\n\nNVM_V3_R9T\n1".to_owned(), 3),
        ("NVM_V3 FixedQ 1 2 3 4".to_owned(), 1),
        ("NVM_V3 FixedK 1 2 3".to_owned(), 1),
        ("NVM_V3 FixedK 0 2 3 4".to_owned(), 1),
        ("NVM_V3 FixedK 1 2 3 4 5 6".to_owned(), 1),
        ("NVM_V3\nx".to_owned(), 2),
        ("NVM_V3\n1 2".to_owned(), 2),
        ("NVM_V3\n18446744073709551615\n".to_owned(), 2),
        (format!("NVM_V3\n4000000000\n{photo}"), 3),
        (format!("NVM_V3\n1\n{photo}\n"), 3),
        (format!("NVM_V3\n2\n{photo}\n{photo}\n0"), 4),
        (file("a.jpg 100 1 0 0 0 0 0 0 0", point), 3),
        (file("100 1 0 0 0 0 0 0 0 0", point), 3),
        (file("\" 100 1 0 0 0 0 0 0 0 0", point), 3),
        (file("a.jpg 100 1 0 0 0 0 0 nan 0 0", point), 3),
        (file("a.jpg 1e999 1 0 0 0 0 0 0 0 0", point), 3),
        (file("a.jpg 100 1e-9 0 0 0 0 0 0 0 0", point), 3),
        (file("a.jpg 100 1e200 0 0 0 0 0 0 0 0", point), 3),
        (file(photo, "0 0 1 1 1 1"), 5),
        (file(photo, "0 0 1 1 1 300 0"), 5),
        (file(photo, "0 0 1 1 1 1 1 1 0 5 5"), 5),
        (file(photo, "0 0 1 1 1 1 1 -1 0 5 5"), 5),
        (file(photo, "0 0 1 1 1 1 1 0 0 5"), 5),
        (file(photo, "0 0 1 1 1 1 99999999999 0 0 5 5"), 5),
        (file(photo, "0 0 1 1 1 1 0 0 0 5 5"), 5),
        (file(photo, "0 0 inf 1 1 1 0"), 5),
        (format!("NVM_V3\n1\n{photo}\n99999999999\n{point}"), 5),
    ] {
        assert_eq!(read(&text).unwrap_err().line, Some(line), "{text}");
    }
    let r9t = read("NVM_V3_R9T").unwrap_err().to_string();
    assert!(r9t.contains("'NVM_V3_R9T'"), "{r9t}");
    assert!(read("NVM_V3\n0\n").is_err());
}

#[test]
fn cut_off_anywhere_is_no_panic() {
    for end in 0..FROM_MIDDLE.len() {
        let _ = read(&FROM_MIDDLE[..end]);
    }
}

proptest! {
    #[test]
    fn no_text_panics(text in "\\PC*", model in "[0-9 \na.-]*") {
        let _ = read(&text);
        let _ = read(&format!("NVM_V3\n1\n{model}"));
    }

    #[test]
    fn no_mutated_file_panics(
        at in 0..400_usize,
        put in prop_oneof!["\\PC{0,3}", "[0-9 \n.eE#-]{0,4}"],
    ) {
        let mut chars: Vec<char> = FROM_MIDDLE.chars().collect();
        let at = at % chars.len();
        chars.splice(at..=at, put.chars());
        let _ = read(&chars.into_iter().collect::<String>());
    }
}

#[test]
fn a_real_file_reprojects_as_its_readme_says() {
    let Some(file) = shared_data("sceaux-nvm/VisualSFM_example.nvm") else {
        return;
    };
    let mut model = read(&std::fs::read_to_string(file).unwrap()).unwrap();
    assert_eq!((model.photos.len(), model.cameras.len()), (11, 11));
    assert_eq!(model.cloud.points.len(), 7817);
    assert_eq!(model.observations.len(), 36_854);
    assert!(model.observed_from == Origin::Corner && !model.sizes.are_known());
    assert_eq!(model.photos[0].name, "images/100_7103.JPG");
    assert_eq!(model.warnings, [""; 0]);
    // The photos' size, of shared/data/sceaux-images.
    model.set_sizes(|_| Some((2832, 2128)));
    // In the undistorted image, where VisualSFM itself minimises: the README's 0.759 px, these
    // digits from a separate script.
    let median = model.median_reprojection_px().unwrap();
    assert!((median - 0.759_105_307).abs() < 1e-8, "{median}");
}
