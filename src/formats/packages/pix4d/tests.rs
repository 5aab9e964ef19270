//! Against the shared project, against numbers that Pix4D wrote into two of its files, and malformed.

use std::fs;

use proptest::prelude::*;

use super::*;
use fragscale_test_data::shared_data;

/// The record of a photo, and the same photo in the external parameters, as Pix4D wrote them for a
/// project over Nanjing (quoted in public code).
const RECORD: &str = "fileName imageWidth imageHeight \ncamera matrix K [3x3]\n\
    radial distortion [3x1]\ntangential distortion [2x1]\ncamera position t [3x1]\n\
    camera rotation R [3x3]\ncamera model m = K [R|-Rt] X\n\nDSC_0157.JPG 7360 4912\n\
    7363.51850023951465118444 0 3686.33719996831450771424\n\
    0 7363.51850023951465118444 2439.04083412635009153746\n0 0 1\n\
    -0.09005921067656787182 0.10773972435740564180 -0.01257054987797603419\n\
    -0.00029570539858373248 -0.00027422056492206067\n\
    114.12600004808672338186 378.81985574952466322429 -2.31159761431545440757\n\
    -0.49632901575943477734 0.86794436424468834890 -0.01816834310427051929\n\
    0.86649900151927328196 0.49400145706385401034 -0.07170802455019638366\n";

/// The third row of R was not quoted; it follows from the first two.
fn record() -> String {
    let x = DVec3::new(
        -0.496_329_015_759_434_8,
        0.867_944_364_244_688_3,
        -0.018_168_343_104_270_52,
    );
    let y = DVec3::new(
        0.866_499_001_519_273_3,
        0.494_001_457_063_854,
        -0.071_708_024_550_196_38,
    );
    let z = x.cross(y);
    format!("{RECORD}{} {} {}\n", z.x, z.y, z.z)
}

const EXTERNAL_LINES: &str = "imageName X Y Z Omega Phi Kappa\n\
    DSC_0157.JPG 332081.126000 3488911.819856 4093.688402 -2.946680 3.053212 119.804001\n";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

#[test]
fn the_shared_project() {
    let Some(path) = shared_data("pix4d-hasu") else {
        return;
    };
    let found = read(&path).unwrap().reconstruction;
    assert_eq!(found.photos.len(), 168);
    assert_eq!(found.cameras.len(), 1);
    let camera = &found.cameras[0];
    assert_eq!((camera.width, camera.height), (5472, 3648));
    assert_eq!(
        (camera.fx, camera.cx),
        (4_470.897_102_766_255, 2_806.803_999_853_511)
    );
    let Distortion::Brown(brown) = camera.distortion else {
        panic!("{:?}", camera.distortion);
    };
    let [_, _, p1, _, k3, ..] = brown.coefficients();
    assert_eq!(
        (p1, k3),
        (-0.002_887_711_421_811_628_4, -0.020_954_376_437_142_17)
    );
    let first = &found.photos[0];
    assert_eq!(first.name, "DJI_0172.JPG");
    let expected = DVec3::new(
        368_109.0 + 15.940_748,
        3_956_043.0 - 29.026_922,
        96.0 + 15.154_226,
    );
    assert!((first.pose.center - expected).length() < 1e-5);
    // A drone that looks down, and no word about pmatrix, which agrees to 0.009 px.
    assert!(found.photos.iter().all(|p| p.pose.rotation.z_axis.z < -0.9));
    assert_eq!(found.warnings.len(), 1, "{:?}", found.warnings);
    assert!(found.warnings[0].contains("_wkt.prj"));
    // Any of its files opens the same.
    for file in [
        "offset.xyz",
        "pmatrix.txt",
        PARAMETERS,
        "pix4d_calibrated_internal_camera_parameters.cam",
    ] {
        let file = path.join(format!("pix4d.origin_{file}"));
        assert_eq!(
            read(&file).unwrap().reconstruction,
            found,
            "{}",
            file.display()
        );
    }
}

use crate::camera::Distortion;

#[test]
fn a_matrix_that_disagrees_is_said_in_pixels() {
    let Some(path) = shared_data("pix4d-hasu") else {
        return;
    };
    let text = |end: &str| fs::read_to_string(path.join(format!("pix4d.origin_{end}"))).unwrap();
    // 4436.465963 X + ... with X 20 units off the offset's: 2 more in the first row's number is
    // 2 X / Z, at 50 units in front of the camera.
    let matrices = text(MATRICES).replace("DJI_0172.JPG 4436.465963", "DJI_0172.JPG 4536.465963");
    let files = folder(&[
        ("a_calibrated_camera_parameters.txt", &text(PARAMETERS)),
        ("a_pmatrix.txt", &matrices),
        ("a_offset.xyz", &text(OFFSET)),
        ("a_wkt.prj", "PROJCS[\"WGS 84 / UTM zone 54N\"]\n"),
    ]);
    let found = read(files.path()).unwrap().reconstruction;
    assert_eq!(
        found.crs.as_deref(),
        Some("PROJCS[\"WGS 84 / UTM zone 54N\"]")
    );
    assert_eq!(found.warnings.len(), 1, "{:?}", found.warnings);
    let said = &found.warnings[0];
    assert!(
        said.contains("for 1 of 168 photos") && said.contains("DJI_0172.JPG"),
        "{said}"
    );
}

#[test]
fn both_files_state_one_pose() {
    let files = folder(&[
        (
            "q_calibrated_camera_parameters.txt",
            &record().replace('\n', "\r\n"),
        ),
        (
            "q_calibrated_external_camera_parameters.txt",
            EXTERNAL_LINES,
        ),
        (
            "q_pix4d_calibrated_internal_camera_parameters.cam",
            "Pix4D camera calibration file 0\n\
             #Focal Length mm assuming a sensor width of 20x10mm\nF 10\n#Principal Point mm\nPx 10.5\n\
             Py 4\n#Symmetrical Lens Distortion Coeffs\nK1 1\nK2 2\nK3 3\n#Tangential\nT1 4\nT2 5\n\n",
        ),
    ]);
    let by_matrix = read(files.path()).unwrap().reconstruction;
    fs::remove_file(files.path().join("q_calibrated_camera_parameters.txt")).unwrap();
    let mut by_angles = read(files.path()).unwrap().reconstruction;
    let [one, other] = [&by_matrix, &by_angles].map(|found| found.photos[0].pose);
    assert!(
        (one.center - other.center).length() < 1e-6,
        "{one:?} {other:?}"
    );
    let turned = one.rotation.transpose() * other.rotation;
    for (axis, unit) in [(turned.x_axis, DVec3::X), (turned.y_axis, DVec3::Y)] {
        assert!((axis - unit).length() < 1e-7, "{turned:?}");
    }
    // The offset came from the difference: whole numbers, as Pix4D makes them.
    let said = &by_matrix.warnings[0];
    assert!(said.contains("331967.000 3488533.000 4096.000"), "{said}");
    assert!(!by_angles.sizes.are_known() && by_angles.warnings[0].contains("one camera"));
    by_angles.set_sizes(|_| Some((4000, 2000)));
    let camera = &by_angles.cameras[0];
    assert_eq!(
        (camera.fx, camera.fy, camera.cx, camera.cy),
        (2000.0, 2000.0, 2100.0, 800.0)
    );
    assert_eq!(camera.distortion, internal_distortion());
}

fn internal_distortion() -> Distortion {
    calibrated::distortion([1.0, 2.0, 3.0], [4.0, 5.0])
}

#[test]
fn without_an_offset_coordinates_are_relative() {
    let files = folder(&[("q_calibrated_camera_parameters.txt", &record())]);
    let found = read(files.path()).unwrap().reconstruction;
    assert!(
        found.warnings[0].contains("coordinates are relative"),
        "{:?}",
        found.warnings
    );
    assert!((found.photos[0].pose.center.x - 114.126).abs() < 1e-6);
}

#[test]
fn another_projects_files_are_not_taken() {
    let files = folder(&[
        ("a_calibrated_camera_parameters.txt", &record()),
        ("b_offset.xyz", "1 2 3"),
        ("b_calibrated_external_camera_parameters_wgs84.txt", "x"),
    ]);
    let found = read(files.path()).unwrap().reconstruction;
    assert!(found.warnings[0].contains("coordinates are relative"));
    let other = "b_calibrated_external_camera_parameters_wgs84.txt";
    let error = read(&files.path().join(other)).unwrap_err();
    assert!(
        error
            .fault
            .what
            .contains("without *_calibrated_camera_parameters.txt")
    );
    // A name without a project's may be anyone's.
    fs::rename(
        files.path().join("b_offset.xyz"),
        files.path().join("offset.xyz"),
    )
    .unwrap();
    let found = read(files.path()).unwrap().reconstruction;
    assert!((found.photos[0].pose.center.x - 115.126).abs() < 1e-6);
}

#[test]
fn fisheyes_and_namesakes_are_counted() {
    let fisheye = "A B.tif 1280 960\n1 2 3\n1 0 0\n0 1 0\n0 0 1\n";
    let text = format!(
        "{}{fisheye}{}",
        record(),
        record().rsplit_once("\n\n").unwrap().1
    );
    let files = folder(&[
        ("calibrated_camera_parameters.txt", &text),
        ("offset.xyz", "1 2 3"),
    ]);
    let found = read(files.path()).unwrap().reconstruction;
    let names: Vec<_> = found.photos.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["DSC_0157.JPG", "DSC_0157.JPG (2)"]);
    assert_eq!(found.cameras.len(), 1);
    let all = found.warnings.join("; ");
    assert!(
        all.contains("1 photos have a fish-eye lens ('A B.tif')"),
        "{all}"
    );
    assert!(all.contains("1 photos have the name of another"), "{all}");
    fs::write(
        files.path().join("calibrated_camera_parameters.txt"),
        fisheye,
    )
    .unwrap();
    let error = read(files.path()).unwrap_err();
    assert!(error.fault.what.contains("fish-eye"), "{error}");
}

#[test]
fn projects_lead_to_their_params() {
    let project = "<?xml version=\"1.0\"?><pix4uav><image path=\"D:\\x\\DSC_0157.JPG\"/>\
        <image path=\"D:/x/DSC_0158.JPG\"/></pix4uav>";
    let files = folder(&[
        ("q.p4d", project),
        (
            "q/1_initial/params/q_calibrated_camera_parameters.txt",
            &record(),
        ),
        ("q/1_initial/params/q_offset.xyz", "1 2 3"),
        (
            "q/2_densification/point_cloud/q_densified_point_cloud.las",
            "",
        ),
    ]);
    let opened = read(&files.path().join("q.p4d")).unwrap();
    let said = opened.reconstruction.warnings.last().unwrap();
    assert_eq!(said, "1 photos were not calibrated and are left out");
    assert!(opened.surface.is_some());
    let folder = read(&files.path().join("q")).unwrap();
    assert_eq!(folder.reconstruction.photos, opened.reconstruction.photos);
    assert!(has_params(&files.path().join("q")) && is_bare_project(files.path()));
}

#[test]
fn a_project_without_calibration_is_refused() {
    let Some(path) = shared_data("pix4d-p4d-snowpeak/snowpea1.p4d") else {
        return;
    };
    let error = read(&path).unwrap_err();
    assert!(
        error
            .fault
            .what
            .starts_with("a Pix4D project without calibration"),
        "{error}"
    );
    assert!(error.fault.remedy.contains("1_initial/params"), "{error}");
}

#[test]
fn mistakes_are_placed() {
    let fault = |text: &str| calibrated::read(text).unwrap_err();
    let good = record();
    assert_eq!(calibrated::read(&good).unwrap().len(), 1);
    for (from, to, line, what) in [
        ("0 0 1\n", "0 0 2\n", 11, "no camera matrix"),
        (
            "7363.51850023951465118444 0 3686",
            "-7363 0 3686",
            10,
            "focal length",
        ),
        ("114.126", "nan 114.126", 15, "not finite"),
        ("114.126", "1 114.126", 15, "more than three"),
        ("-0.4963", "-0.9963", 16, "rotation R"),
        (" 7360 4912", " 0 4912", 10, "image size"),
        ("0 0 1\n", "", 9, "8 lines of numbers"),
    ] {
        let broken = good.replace(from, to);
        assert_ne!(broken, good, "{from}");
        let fault = fault(&broken);
        assert!(fault.what.contains(what), "{fault}");
        assert_eq!(fault.line, Some(line), "{fault}");
    }
    assert!(fault("").what.contains("no calibrated photo"));
    assert!(
        fault(&format!("{good}{}", "1 2 3\n".repeat(100_000)))
            .what
            .contains("more than")
    );
    for bad in [
        "x 1 2 3 4 5\n",
        "imageName X Y\n",
        "",
        "imageName X Y Z O P K\na 1 2 3 4 5 x",
    ] {
        assert!(external::read_poses(bad).is_err(), "{bad}");
    }
    assert!(external::read_offset("1 2").is_err() && external::read_offset("\n").is_err());
    let fisheye = "Pix4D camera calibration file 0\n#assuming a sensor width of 4x3mm\nC 1\n";
    assert!(
        internal::read(fisheye)
            .unwrap_err()
            .what
            .contains("no part of a perspective")
    );
    assert!(
        internal::read("F 1\n")
            .unwrap_err()
            .what
            .contains("sensor's size")
    );
}

/// Every beginning of a file is read or refused.
#[test]
fn truncations_are_no_panic() {
    let good = record();
    for end in 0..good.len() {
        let _ = calibrated::read(&good[..end]);
        let _ = external::read_matrices(&good[..end]);
    }
}

proptest! {
    #[test]
    fn no_text_panics(text in "((a b|a.jpg) [0-9]{1,3} [0-9]{1,3}\n|([0-9.e-]{1,4} ){0,13}\n|\\PC{0,20}\n){0,20}") {
        let _ = calibrated::read(&text);
        let _ = external::read_poses(&text);
        let _ = external::read_matrices(&text);
        let _ = external::read_offset(&text);
        let _ = internal::read(&text);
    }
}

/// The file of errors goes before the columns of the poses' own; a photo that neither names states none.
#[test]
fn standard_deviations_of_poses() {
    let with_columns = EXTERNAL_LINES.replacen(
        "Kappa\n",
        "Kappa X_sigma Y_sigma Z_sigma Omega_sigma Phi_sigma Kappa_sigma\n",
        1,
    );
    let with_columns = format!("{} 0.01 0.02 0.03 0.1 0.2 0.3\n", with_columns.trim_end());
    let errors = "imageName, X_sigma, Y_sigma, Z_sigma\nDSC_0157.JPG, 0.04, 0.05, 0.06\n";
    let record = record();
    let mut files = vec![
        ("p_calibrated_camera_parameters.txt", record.as_str()),
        ("p_calibrated_external_camera_parameters.txt", &with_columns),
    ];
    let found = read(folder(&files).path()).unwrap().reconstruction;
    let stated = found.pose_errors[0].errors();
    assert_eq!(stated.position, Some(DVec3::new(0.01, 0.02, 0.03)));
    // Turning axes keeps the sum of the squares, near enough to straight down.
    let length = stated.angle.unwrap().length();
    assert!((length - 0.14_f64.sqrt()).abs() < 0.01, "{length}");
    files.push(("p_calibrated_external_camera_parameters_error.txt", errors));
    let found = read(folder(&files).path()).unwrap().reconstruction;
    let stated = found.pose_errors[0].errors();
    assert_eq!(stated.position, Some(DVec3::new(0.04, 0.05, 0.06)));
}
