//! The forms, against closed forms and each other.

use proptest::prelude::*;

use super::*;
use fragscale_test_data::shared_data;

/// RealityScan's documentation: with yaw, pitch and roll 0 the camera looks down and its right is
/// east; a yaw of 90 turns it clockwise, a pitch of 90 looks to the horizon.
#[test]
fn realitycaptures_angles_are_its_own() {
    let of = |angles: &str| {
        let text = format!("#cameras 1\n#name,X/Lon,Y/Lat,Z/Alt,{angles}\n");
        assert!(is_table(text.as_bytes()));
        read_table(text.as_bytes(), None).unwrap().lines[0].pose
    };
    let down = of("yaw,pitch,roll\na.jpg,1,2,3,0,0,0");
    assert_eq!(down.center, DVec3::new(1.0, 2.0, 3.0));
    let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-12;
    assert!(near(down.rotation.z_axis, DVec3::NEG_Z) && near(down.rotation.x_axis, DVec3::X));
    assert_eq!(of("omega,phi,kappa\na.jpg,1,2,3,0,0,0"), down);
    let east = of("yaw,pitch,roll\na.jpg,1,2,3,90,90,0");
    assert!(near(east.rotation.z_axis, DVec3::X), "{east:?}");
    let other = "# name, x, y, z, yaw, pitch, roll\na.jpg 1 2 3 4 5 6\n";
    let fault = read_table(other.as_bytes(), None).unwrap_err();
    assert!(fault.what.contains("not omega"), "{fault}");
    assert_eq!(fault.line, Some(1));
    let label = "Label,X,Y,Z,Omega,Phi,Kappa\na.jpg,1,2,3,0,0,0\n";
    assert_eq!(
        read_table(label.as_bytes(), None).unwrap().lines[0].pose,
        down
    );
}

#[test]
fn the_three_shared_forms_agree() {
    let Some(folder) = shared_data("orthority-ngi-opk") else {
        return;
    };
    let read = |name: &str| crate::read_poses(&folder.join(name)).unwrap();
    let (csv, text) = (read("ngi_xyz_opk.csv"), read("camera_pos_ori.txt"));
    let geojson = read("ngi_ext_param.geojson");
    assert_eq!(
        csv.crs.as_deref().map(|crs| &crs[..12]),
        Some("+proj=tmerc ")
    );
    assert!(geojson.crs.unwrap().starts_with("PROJCS"));
    assert_eq!(text.lines.len(), 4);
    assert_eq!(text.lines[0].photo, "3324c_2015_1004_05_0182_RGB");
    assert_eq!(geojson.lines[0].camera.as_deref(), Some("Integraph DMC"));
    for other in [&csv.lines, &geojson.lines] {
        for (one, other) in text.lines.iter().zip(other) {
            assert_eq!(one.photo, other.photo);
            // The table is rounded to 0.001 m and 0.001 degrees.
            assert!((one.pose.center - other.pose.center).length() < 1e-3);
            let turned = one.pose.rotation.z_axis.dot(other.pose.rotation.z_axis);
            assert!(turned > 1.0 - 1e-9, "{turned}");
            // An aerial camera.
            assert!(other.pose.rotation.z_axis.z < -0.999);
        }
    }
}

/// Whoever lost the header of a poses.csv learns what its numbers are taken for.
#[test]
fn columns_that_nobody_names_are_said() {
    let angles = read_table(b"a.jpg,0,0,10,2,-4,3\n", None).unwrap();
    assert!(angles.warnings[0].contains("taken for photo, x, y, z, omega, phi, kappa"));
    let named = read_table(b"name,x,y,z,omega,phi,kappa\na.jpg,0,0,10,2,-4,3\n", None).unwrap();
    assert!(named.warnings.is_empty(), "{:?}", named.warnings);
    let quaternion = b"a.jpg,0,0,10,2,-4,3,1\nb.jpg,0,0,10,0.7071,0.7071,0,0\n";
    let fault = read_table(quaternion, None).unwrap_err();
    assert!(
        fault.line == Some(2) && fault.what.contains("may be a quaternion"),
        "{fault}"
    );
}

/// Closed forms of the drone's angles, in Orthority's three kinds of tables.
#[test]
fn orthoritys_angles_of_the_body() {
    let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-12;
    let of = |angles: &str| {
        let text = format!(
            "'filename' 'latitude' 'longitude' 'altitude' 'roll' 'pitch' 'yaw' 'camera' other\n\
             'a b.tif' 24.68 120.95 186.5 {angles} 'dji \"x\" 0.66' ignored\n"
        );
        assert!(is_table(text.as_bytes()));
        let file = read_table(text.as_bytes(), None).unwrap();
        let line = &file.lines[0];
        assert_eq!(file.crs.as_deref(), Some("EPSG:4979"));
        assert_eq!(line.photo, "a b.tif");
        assert_eq!(line.camera.as_deref(), Some("dji \"x\" 0.66"));
        // Degrees east, degrees north, metres up.
        assert_eq!(line.pose.center, DVec3::new(120.95, 24.68, 186.5));
        line.pose.rotation
    };
    let (half, root) = (0.5, 0.75_f64.sqrt());
    // Straight down, the image's top to the north.
    let level = of("0 0 0");
    assert!(near(level.z_axis, DVec3::NEG_Z) && near(level.y_axis, DVec3::NEG_Y));
    // Nose up by 30 degrees: the camera looks forward, to the north.
    assert!(near(of("0 30 0").z_axis, DVec3::new(0.0, half, -root)));
    // The same after a quarter turn clockwise: to the east.
    assert!(near(of("0 30 90").z_axis, DVec3::new(half, 0.0, -root)));
    // Right wing down by 30 degrees: the camera looks to the left, to the west.
    assert!(near(of("30 0 0").z_axis, DVec3::new(-half, 0.0, -root)));
    // The axes of a photo from Pix4D's rotation R = C_En C_nb C_bB, multiplied out by hand for a
    // yaw of 90 and a roll of 30: right is down into the south.
    assert!(near(of("30 0 90").x_axis, DVec3::new(0.0, -root, -half)));

    let opk = "filename,latitude,longitude,altitude,omega,phi,kappa\na,1,2,3,0,0,0\n";
    assert!(is_table(opk.as_bytes()));
    let fault = read_table(opk.as_bytes(), None).unwrap_err();
    assert!(fault.what.contains("axes of a map"), "{fault}");
    // Whose roll that is nobody says.
    let other = "image,x,y,z,roll,pitch,yaw\na,1,2,3,0,0,0\n";
    assert!(!is_table(other.as_bytes()));
}

/// Two degrees east of a UTM zone's middle, 45 degrees north, the map's north lies
/// 1.4146 degrees east of the true one (the series of the convergence: l sin(b) (1 + l^2 cos^2(b) / 3)).
#[test]
fn on_a_map_true_north_is_not_up() {
    let map = Crs::understand("EPSG:32632").unwrap();
    let place = crate::geodesy::Geographic {
        longitude: 11.0,
        latitude: 45.0,
        height: 100.0,
    };
    let DVec3 { x, y, z } = map.from_geographic(place).unwrap();
    let text = format!("filename;x;y;z;roll;pitch;yaw\na.tif;{x};{y};{z};0;0;0\n");
    assert!(is_table(text.as_bytes()));
    let read = |system| read_table(text.as_bytes(), system).unwrap();
    let top = -read(Some("EPSG:32632")).lines[0].pose.rotation.y_axis;
    let (l, b) = (2_f64.to_radians(), 45_f64.to_radians());
    let convergence = l * b.sin() * (1.0 + l * l * b.cos().powi(2) / 3.0);
    // True north lies to the west of the map's.
    assert!((top.x.atan2(top.y) + convergence).abs() < 1e-6, "{top}");
    let without = read(None);
    assert_eq!(without.lines[0].pose.rotation.y_axis, DVec3::NEG_Y);
    assert!(without.warnings[0].contains("true north"));
}

#[test]
fn quotes_and_decimal_commas() {
    let quoted = "'filename' 'x' 'y' 'z' 'omega' 'phi' 'kappa' 'camera'\n\
        '100_0005_0142' 292710.217 2731048.771 186.446 28.831 0.94 1.782 'dji 1 2'\n";
    assert!(is_table(quoted.as_bytes()));
    let file = read_table(quoted.as_bytes(), None).unwrap();
    assert_eq!(file.lines[0].photo, "100_0005_0142");
    assert_eq!(file.lines[0].camera.as_deref(), Some("dji 1 2"));
    let commas = "\"a;1\";292710,21;2731048,77;186,4;28,5;0,5;0\n";
    assert!(is_table(commas.as_bytes()));
    let file = read_table(commas.as_bytes(), None).unwrap();
    assert_eq!(file.lines[0].photo, "a;1");
    assert_eq!(file.lines[0].pose.center.z, 186.4);
    assert!(
        file.warnings[0].contains("5 numbers"),
        "{:?}",
        file.warnings
    );
}

#[test]
fn columns_in_any_order() {
    let text = "# by hand\r\n#Name;Kappa;Phi;Omega;Northing;Easting;Alt;Camera;x_sigma\r\n\
        a b.tif;0;0;0;2;1;3;left;9\r\n";
    assert!(is_table(text.as_bytes()));
    let file = read_table(text.as_bytes(), None).unwrap();
    let line = &file.lines[0];
    assert_eq!(
        (line.photo.as_str(), line.camera.as_deref()),
        ("a b.tif", Some("left"))
    );
    assert_eq!(line.pose.center, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(line.pose.rotation.y_axis, DVec3::NEG_Y);
    for other in [
        "photo,x,y,z,omega,phi,kappa\n",
        "x y z\n1 2 3\n",
        "1 2 3 4 5 6 7\n",
        "a 1 2 3\n",
        "",
    ] {
        assert!(!is_table(other.as_bytes()), "{other}");
    }
}

#[test]
fn mistakes_are_placed() {
    let fault = |text: &str| read_table(text.as_bytes(), None).unwrap_err();
    assert_eq!(fault("a 1 2 3 4 5 6\nb 1 2 3 4 5\n").line, Some(2));
    assert_eq!(fault("a 1 2 3 4 5 6\na 1 2 3 4 5 6\n").line, Some(2));
    assert!(fault("a 1 2 3 4 5 nan\n").what.contains("kappa is 'nan'"));
    assert!(
        fault("filename,x,y,z,omega,phi,kappa\n")
            .what
            .contains("no photos")
    );
    let geojson = |text: &str| read_geojson(text.as_bytes()).unwrap_err();
    assert!(geojson("{\"features\": []}").what.contains("no photos"));
    let broken =
        "{\"features\": [{\"properties\":\n {\"filename\": \"a\", \"xyz\": [1, 2], \"opk\": []}}]}";
    assert_eq!(geojson(broken).line, Some(2));
}

proptest! {
    #[test]
    fn no_text_panics(text in "((a|b|,|;| |[0-9.e-]{1,5}|\\PC){0,20}\n){0,5}") {
        let _ = is_table(text.as_bytes());
        let _ = read_table(text.as_bytes(), None);
        let _ = read_table(format!("filename,x,y,z,omega,phi,kappa\n{text}").as_bytes(), None);
    }
}
