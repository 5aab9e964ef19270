use std::fs;

use exif::{Field, Tag};

use super::*;
use crate::Kind;
use crate::Package;
use crate::camera::Pose;
use crate::detect;
use crate::poses::position_list::positions_of_photos;
use fragscale_test_data::jpeg::{gps, jpeg, packet, short, text};
use fragscale_test_data::shared_data;

fn exif() -> Vec<Field> {
    let camera = [
        text(Tag::Make, "DJI"),
        text(Tag::Model, "FC1"),
        short(Tag::FocalLengthIn35mmFilm, 24),
    ];
    [gps(), camera.to_vec()].concat()
}

const DOWN: &str = r#"<rdf:Description drone-dji:GimbalYawDegree="+90.00" drone-dji:GimbalPitchDegree="-90.00" drone-dji:GimbalRollDegree="+0.00" drone-dji:RelativeAltitude="+50.0"/>"#;

fn read_ok(path: &Path) -> Reconstruction {
    read(path, &Progress::default()).unwrap().reconstruction
}

fn said(reconstruction: &Reconstruction, words: &str) -> bool {
    reconstruction.warnings.iter().any(|w| w.contains(words))
}

#[test]
fn a_folder_of_photos_is_a_reconstruction() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: Vec<u8>| fs::write(folder.path().join(name), bytes).unwrap();
    let down = packet(DOWN);
    write("a_0001.JPG", jpeg((4000, 3000), &exif(), &[&down]));
    write("a_0002.JPG", jpeg((4000, 3000), &exif(), &[&down]));
    write("b.jpg", jpeg((3000, 2000), &exif(), &[&down]));
    write("level.jpg", jpeg((4000, 3000), &exif(), &[]));
    write("nowhere.jpg", jpeg((4000, 3000), &[], &[&down]));
    write("broken.jpg", b"no image".to_vec());
    write("notes.txt", b"no photo".to_vec());
    assert_eq!(
        detect(folder.path()).unwrap(),
        Kind::Reconstruction(Package::Photos, folder.path().to_owned())
    );
    let found = read_ok(folder.path());
    assert_eq!(
        (found.package, found.crs.as_deref()),
        ("photos", Some("EPSG:4326"))
    );
    let names: Vec<&str> = found.photos.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["a_0001.JPG", "a_0002.JPG", "b.jpg"]);
    let cameras: Vec<usize> = found.photos.iter().map(|p| p.camera).collect();
    assert_eq!(cameras, [0, 0, 1]);
    assert_eq!(found.cameras[0].name, "DJI FC1");
    // 24 mm on 43.2666 mm at a diagonal of 5000 px.
    assert!((found.cameras[0].fx - 24.0 / 1872.0_f64.sqrt() * 5000.0).abs() < 1e-9);
    let pose = found.photos[0].pose;
    assert_eq!(
        pose,
        Pose::from_yaw_pitch_roll(pose.center, [90.0, -90.0, 0.0])
    );
    assert!((pose.center - DVec3::new(-16.25005, 47.5001, 200.5)).length() < 1e-12);
    // The one that does not say which way it looks still has a measured position.
    let measured: Vec<&str> = found
        .measured_positions
        .iter()
        .map(|p| p.photo.as_str())
        .collect();
    assert_eq!(measured, ["a_0001.JPG", "a_0002.JPG", "b.jpg", "level.jpg"]);
    for words in [
        "1 of 6 photos are left out, because they have no position (nowhere.jpg)",
        "which way the camera looked (level.jpg)",
        "cannot be read (broken.jpg: it cannot be read as an image",
        "3 photos come from the barometer",
        "50.0 to 50.0 m above the take-off",
        "expect 5.1 % of error",
    ] {
        assert!(said(&found, words), "{words}: {:#?}", found.warnings);
    }
    let list = positions_of_photos(folder.path()).unwrap();
    assert_eq!(list.positions.len(), 4);
    assert_eq!(list.crs.as_deref(), Some("EPSG:4326"));

    let one = folder.path().join("a_0002.JPG");
    assert_eq!(
        detect(&one).unwrap(),
        Kind::Reconstruction(Package::Photos, one.clone())
    );
    assert_eq!(read_ok(&one).photos.len(), 1);
}

#[test]
fn photos_that_say_nothing_are_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.jpg"), jpeg((40, 30), &[], &[])).unwrap();
    let error = read(folder.path(), &Progress::default()).unwrap_err();
    let error = error.fault.to_string();
    assert!(error.contains("1 of 1 have no position (a.jpg)"), "{error}");
    let error = positions_of_photos(folder.path())
        .unwrap_err()
        .fault
        .to_string();
    assert!(error.contains("none of its 1 photos"), "{error}");
}

/// As Parrot's Disco writes them: the aircraft's angles, under Pix4D's prefix in nobody's namespace.
#[test]
fn angles_that_are_not_understood_give_no_pose_and_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let disco = r#"<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description xmlns:Camera="Camera/" Camera:Yaw="18.5" Camera:Pitch="2.25" Camera:Roll="-2.5"/></rdf:RDF></x:xmpmeta>"#;
    let bytes = jpeg((1920, 1088), &exif(), &[disco]);
    fs::write(folder.path().join("disco.jpg"), bytes).unwrap();
    let error = read(folder.path(), &Progress::default()).unwrap_err();
    let what = "1 of 1 have angles in the XMP namespace 'Camera/', of which it is not known whether they are the camera's and how they count (disco.jpg)";
    assert!(error.fault.what.contains(what), "{}", error.fault.what);
    // Beside a photo with a pose it is left out, and still a measured position.
    let bytes = jpeg((4000, 3000), &exif(), &[&packet(DOWN)]);
    fs::write(folder.path().join("down.jpg"), bytes).unwrap();
    let found = read_ok(folder.path());
    assert_eq!(found.photos.len(), 1);
    assert_eq!(found.measured_positions.len(), 2);
    let said =
        "1 of 2 photos are left out, because they have angles in the XMP namespace 'Camera/'";
    assert!(self::said(&found, said), "{:#?}", found.warnings);
}

#[test]
fn an_mrk_corrects_the_photos_it_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let down = packet(DOWN);
    for name in ["f_0001.JPG", "f_0002.JPG", "f_0003.JPG"] {
        let bytes = jpeg((4000, 3000), &exif(), &[&down]);
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    // The second is a metre off, the third far away.
    let mrk = "1\t1.0\t[2211]\t 3,N\t 0,E\t 75,V\t47.5001,Lat\t-16.25005,Lon\t250.0,Ellh\t0.01, 0.02, 0.03\t50,Q\n\
               2\t2.0\t[2211]\t 3,N\t 0,E\t 75,V\t47.500109,Lat\t-16.25005,Lon\t251.5,Ellh\t0.01, 0.02, 0.03\t34,Q\n\
               3\t3.0\t[2211]\t 3,N\t 0,E\t 75,V\t48.5001,Lat\t-16.25005,Lon\t252.0,Ellh\t0.01, 0.02, 0.03\t50,Q\n";
    fs::write(folder.path().join("f_Timestamp.MRK"), mrk).unwrap();
    let found = read_ok(folder.path());
    let heights: Vec<f64> = found.photos.iter().map(|p| p.pose.center.z).collect();
    assert_eq!(heights, [250.0, 251.5, 200.5]);
    for words in [
        "2 of 3 photos are those of f_Timestamp.MRK",
        "20 m from where 1 photos",
        "1 photos are RTK fixed",
        "1 photos are RTK float",
    ] {
        assert!(said(&found, words), "{words}: {:#?}", found.warnings);
    }
    assert_eq!(found.measured_positions[1].position.latitude, 47.500109);
    // An .MRK counts north, east, up; poses east, north, up.
    let stated: Vec<_> = found
        .pose_errors
        .iter()
        .map(|e| e.errors().position)
        .collect();
    let of_mrk = Some(DVec3::new(0.02, 0.01, 0.03));
    // The third is EXIF's, of a receiver without corrections.
    // Heights of the barometer, which was set at take-off.
    let usual = Some(DVec3::new(2.0, 2.0, 20.0));
    assert_eq!(stated, [of_mrk, of_mrk, usual]);
    // Of 35 mm film: 3 % for what that means, and half of a millimetre of 24.
    let percent = found.errors.focal.unwrap();
    assert!((percent - (3.0 + 50.0 / 24.0)).abs() < 1e-9, "{percent}");
}

#[test]
fn brighton_photos_against_opendronemaps_solution() {
    let Some(folder) = shared_data("odm-brighton-0") else {
        return;
    };
    let photos = read_ok(&folder.join("images"));
    let shots = fs::read(folder.join("odm_report/shots.geojson")).unwrap();
    let shots: serde_json::Value = serde_json::from_slice(&shots).unwrap();
    let mut compared = 0;
    for shot in shots["features"].as_array().unwrap() {
        let name = shot["properties"]["filename"].as_str().unwrap();
        let Some(photo) = photos.photos.iter().find(|photo| photo.name == name) else {
            continue;
        };
        let numbers = |value: &serde_json::Value| -> DVec3 {
            let of = |index: usize| value[index].as_f64().unwrap();
            DVec3::new(of(0), of(1), of(2))
        };
        let solved = numbers(&shot["geometry"]["coordinates"]);
        // Metres on the ground at 46.84 degrees: 111.2 km a degree.
        let metres = (photo.pose.center - solved)
            * DVec3::new(111_200.0 * 46.84_f64.to_radians().cos(), 111_200.0, 1.0);
        let solved_pose = Pose::from_rotation_vector_of_camera_from_world(
            DVec3::ZERO,
            numbers(&shot["properties"]["rotation"]),
        );
        let forward = photo
            .pose
            .rotation
            .z_axis
            .angle_between(solved_pose.rotation.z_axis);
        let turned = photo
            .pose
            .rotation
            .x_axis
            .angle_between(solved_pose.rotation.x_axis);
        assert!(
            metres.truncate().length() < 5.0 && metres.z.abs() < 5.0,
            "{metres}"
        );
        assert!(forward.to_degrees() < 3.0, "{forward}");
        // Three of the four photos were turned upside down in Windows Photo Viewer after the flight
        // (EXIF Software; the fourth still names the drone's firmware), and kept the drone's angles.
        let expected = if name == "DJI_0030.JPG" { 0.0 } else { 180.0 };
        assert!((turned.to_degrees() - expected).abs() < 3.0, "{name}");
        compared += 1;
    }
    assert_eq!(compared, 4);
    assert!(
        said(
            &photos,
            "3 photos (DJI_0027.JPG, DJI_0028.JPG, DJI_0029.JPG): it was last written by 'Microsoft Windows Photo Viewer"
        ),
        "{:#?}",
        photos.warnings
    );
    // OpenDroneMap's focal length, normalised by the width of 4000 px.
    let focal = photos.cameras[0].fx / (0.555_544_371_882_769_7 * 4000.0) - 1.0;
    assert!(focal.abs() < 0.1, "{focal}");
}
