//! Real flights as packages solved them, brought to the world by what others state of them.

use super::*;

/// One scene as two packages solved it: the camera centres of COLMAP as the "positions" of
/// VisualSFM's. The two agree to their own accuracy, and so do the points that both have.
#[test]
fn sceaux_in_two_frames() {
    let (Some(nvm), Some(colmap)) = (
        shared_data("sceaux-nvm/VisualSFM_example.nvm"),
        shared_data("sceaux-colmap/bin"),
    ) else {
        return;
    };
    let progress = Progress::default();
    let other = read_project(&colmap, &progress).unwrap().reconstruction;
    let mut text = "photo,x,y,z\n".to_owned();
    for photo in &other.photos {
        let c = photo.pose.center;
        writeln!(text, "{},{},{},{}", photo.name, c.x, c.y, c.z).unwrap();
    }
    let list = List::new(&text);
    let request = GeoreferenceRequest {
        positions: Some(list.path()),
        ..GeoreferenceRequest::default()
    };
    let found = georeference(&nvm, &request, &progress).unwrap();
    assert_eq!(found.positions.len(), 11);
    // The same eleven centres by NumPy: their least-squares scale and RMS (the cameras span 11 units).
    assert_eq!(found.used(), 11, "{found:?}");
    assert!(
        (found.similarity.scale - 0.998_477).abs() < 1e-5,
        "{found:?}"
    );
    assert!((found.rms.unwrap() - 0.021_221).abs() < 1e-5, "{found:?}");
    assert_eq!(found.residual_in_words(0.021_221), "0.021");
    assert_eq!(found.residual_in_words(-0.000_4), "0.000");
    let table = Georeferenced {
        rms: Some(0.000_42),
        ..found
    };
    assert_eq!(table.residual_in_words(0.000_42), "0.00042");
    let exact = Georeferenced {
        rms: Some(1e-12),
        ..table
    };
    assert_eq!(exact.residual_in_words(1e-12), "0.000");
    // The camera axes were not given, and turn into the other's.
    let mut own = read_project(&nvm, &progress).unwrap().reconstruction;
    own.transform(&found.similarity);
    let last = |name: &str| name.rsplit('/').next().unwrap().to_owned();
    for photo in &own.photos {
        let same = other
            .photos
            .iter()
            .find(|p| last(&p.name) == last(&photo.name))
            .unwrap();
        let off = photo
            .pose
            .rotation
            .z_axis
            .angle_between(same.pose.rotation.z_axis);
        assert!(
            off.to_degrees() < 1.0,
            "{}: {}",
            photo.name,
            off.to_degrees()
        );
    }
}

/// The project's cameras and points in a frame of their own.
fn brighton_of_its_own(stated: &Reconstruction) -> Reconstruction {
    let mut own = stated.clone();
    own.crs = None;
    own.measured_positions.clear();
    own.transform(&Similarity::new(
        0.02,
        DMat3::from_euler(EulerRot::XYZ, 1.0, 2.0, 3.0),
        DVec3::new(-9_000.0, -100_000.0, 30.0),
    ));
    own
}

/// The positions in four of its photos (EXIF of a consumer's drone), against NumPy and PROJ: the scale
/// of least squares, its standard error by the formula of `georeference::fit`, and that of the turn.
#[test]
fn brighton_by_four_receivers() {
    let Some(folder) = shared_data("odm-brighton-0") else {
        return;
    };
    let project = read_project(&folder, &Progress::default()).unwrap();
    let own = brighton_of_its_own(&project.reconstruction);
    let request = GeoreferenceRequest {
        photos: Some(folder.join("images")),
        ..GeoreferenceRequest::default()
    };
    let found = georeference_model(&folder, &own, &request).unwrap();
    assert_eq!(found.crs.as_deref(), Some("EPSG:32615"));
    assert_eq!((found.used(), found.positions.len()), (4, 4));
    let scale = found.similarity.scale * 0.02;
    assert!((scale - 1.041_871).abs() < 1e-4, "{scale}");
    let error = found.scale_error.unwrap();
    // 0.013945 by the noise of each direction alone.
    assert!((error - 0.012_360).abs() < 1e-5, "{error}");
    let target = std::env::temp_dir().join("flight.toml");
    let text = found.flight_text(&target, &folder, None, None).unwrap();
    let percent = FlightFile::parse(&text).unwrap().errors().world_scale;
    // Five degrees of freedom: 2.5706 of them (Student's table) are half a 95 % interval.
    let stated = 1.2360 * 2.5706 / 1.959_96;
    assert!(percent.is_some_and(|percent| (percent - stated).abs() < 0.015));
    let turn = found.rotation_error_degrees.unwrap();
    assert!((turn - 1.219).abs() < 0.02, "{turn}");
    assert!(
        found
            .warnings
            .iter()
            .any(|w| w.contains("nearly on a line"))
    );
    assert!(
        found.warnings.iter().any(|w| w.contains("4 of 7 photos")),
        "{:?}",
        found.warnings
    );
}

/// OpenSfM's frame and what shots.geojson of the same project states of the photos.
#[test]
fn brighton_by_its_shots() {
    let Some(folder) = shared_data("odm-brighton-0") else {
        return;
    };
    let project = read_project(&folder, &Progress::default()).unwrap();
    let stated = project.reconstruction;
    let mut own = brighton_of_its_own(&stated);
    let shots: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("odm_report/shots.geojson")).unwrap())
            .unwrap();
    let mut text = "photo,longitude,latitude,height\n".to_owned();
    for feature in shots["features"].as_array().unwrap() {
        let at = &feature["geometry"]["coordinates"];
        let name = feature["properties"]["filename"].as_str().unwrap();
        writeln!(text, "{name},{},{},{}", at[0], at[1], at[2]).unwrap();
    }
    let list = List::new(&text);
    let request = GeoreferenceRequest {
        positions: Some(list.path()),
        ..GeoreferenceRequest::default()
    };
    let found = georeference_model(&folder, &own, &request).unwrap();
    assert_eq!(found.crs.as_deref(), Some("EPSG:32615"));
    assert_eq!(found.used(), stated.photos.len());
    // OpenDroneMap's projection squeezes the plane by 0.9996 and leaves heights: centimetres here.
    assert!(found.rms.unwrap() < 0.05, "{:?}", found.rms);
    own.transform(&found.similarity);
    for (a, b) in own.photos.iter().zip(&stated.photos) {
        assert!(a.pose.center.distance(b.pose.center) < 0.1);
        assert!(a.pose.rotation.z_axis.angle_between(b.pose.rotation.z_axis) < 1e-3);
    }
}
