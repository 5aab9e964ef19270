//! The length by known distances: alone, with positions that give the place, and of what has one.

use super::*;

/// A plane of points with some high above it, in a frame that stands on its head.
#[test]
fn a_distance_and_level() {
    let mut reconstruction = reconstruction();
    let back = truth().rotation.transpose();
    for i in 0..400 {
        let high = if i % 20 == 0 {
            9.0
        } else {
            0.02 * f64::from(i % 3)
        };
        let world = DVec3::new(f64::from(i % 20), f64::from(i / 20), high - 6.0);
        reconstruction.cloud.points.push(back * world);
    }
    let request = GeoreferenceRequest {
        distances: vec![
            "0,0,0 0,0,2 15".parse().unwrap(),
            "0,0,0 0,4,0 30.3".parse().unwrap(),
        ],
        level: true,
        ..GeoreferenceRequest::default()
    };
    let found = georeference_model(Path::new("model"), &reconstruction, &request).unwrap();
    // By hand: (2 * 15 + 4 * 30.3) / (4 + 16).
    assert!((found.similarity.scale - 7.56).abs() < 1e-12);
    assert!(found.scale_error.unwrap() > 0.0);
    let up = found.similarity.rotation * (back * DVec3::Z);
    assert!(up.distance(DVec3::Z) < 0.01, "{up}");
    assert_eq!(found.crs, None);
    for text in [
        "1,2,3 4,5,6",
        "1,2,3 a 5",
        "1,2,3 4,5,6 0",
        "1,2,3 4,5,6 x",
        "a b -1",
    ] {
        assert!(text.parse::<KnownDistance>().is_err(), "{text}");
    }
}

/// Twelve receivers half a metre too far north and south in turn, on a flight that is 0.4 % larger than it was: they place it, and
/// a distance gives its length, about the middle of theirs.
#[test]
fn a_distance_gives_the_length_and_positions_the_place() {
    let middle = centers().iter().sum::<DVec3>() / 12.0;
    let list = |off: f64| {
        let mut list = "EPSG:32632\n".to_owned();
        for (i, center) in centers().into_iter().enumerate() {
            let north = if i % 2 == 0 { off } else { -off };
            let at = middle + (center - middle) * (1.0 + off / 125.0) + DVec3::Y * north;
            writeln!(list, "IMG_{i:04}.JPG {} {} {}", at.x, at.y, at.z).unwrap();
        }
        List::new(&list)
    };
    let receivers = list(0.5);
    let one = || vec!["0,0,0 0,0,1 7.5".parse().unwrap()];
    let request = GeoreferenceRequest {
        positions: Some(receivers.path()),
        distances: one(),
        ..GeoreferenceRequest::default()
    };
    let found = run(&request).unwrap();
    assert!((found.similarity.scale - 7.5).abs() < 1e-12);
    assert_eq!(
        (found.crs.as_deref(), found.used()),
        (Some("EPSG:32632"), 12)
    );
    let off: DVec3 = found
        .positions
        .iter()
        .map(|position| position.residual)
        .sum();
    assert!(off.length() < 1e-6, "{off}");
    let at = found.similarity.apply(photo(5, centers()[5]).pose.center);
    assert!(at.distance(centers()[5]) < 0.5, "{at}");
    assert!((0.4..0.55).contains(&found.rms.unwrap()), "{found:?}");
    let said = found.warnings.join("; ");
    assert!(said.contains("shorter than the positions (± "), "{said}");
    assert!(
        said.contains("which place it") && !said.contains("contradict"),
        "{said}"
    );
    assert_eq!(found.scale_error, None);
    // One in feet is none in metres.
    let feet = GeoreferenceRequest {
        distances: vec!["0,0,0 0,0,1 24.606".parse().unwrap()],
        ..request.clone()
    };
    let found = run(&feet).unwrap();
    let said = found.warnings.join("; ");
    assert!(
        said.contains("they contradict each other") && said.contains("lengths are stated to ± 69"),
        "{said}"
    );
    // Both are within what is stated: 24.606 is typed where receivers say 1.004 times 7.5.
    let interval = found.scale_interval.unwrap();
    assert!(
        (interval - (1.0 - 7.53 / 24.606)).abs() < 0.001,
        "{interval}"
    );
    assert_eq!(found.scale_error, Some(interval / 1.959_963_984_540_054));
    // So it is with two that agree.
    let short = GeoreferenceRequest {
        distances: vec![
            "0,0,0 0,0,1 7.2".parse().unwrap(),
            "0,0,0 0,1,0 7.2".parse().unwrap(),
        ],
        ..request.clone()
    };
    let found = run(&short).unwrap();
    let interval = found.scale_interval.unwrap();
    assert!((interval - (7.53 / 7.2 - 1.0)).abs() < 0.001, "{interval}");

    // Good receivers know the length better than distances that do not agree.
    let exact = list(0.0);
    let request = GeoreferenceRequest {
        positions: Some(exact.path()),
        distances: vec![
            "0,0,0 0,0,1 7.5".parse().unwrap(),
            "0,0,0 0,1,0 7.7".parse().unwrap(),
        ],
        ..request
    };
    let found = run(&request).unwrap();
    assert_is_truth(&found.similarity, 1e-6);
    assert!(
        found.warnings.join("; ").contains("which are surer"),
        "{found:?}"
    );
    assert!((found.lengths[1].fitted - 7.5).abs() < 1e-4, "{found:?}");
    // Nor does one distance, of which nobody says how sure it is, beat receivers that tell the length to a thousandth.
    let request = GeoreferenceRequest {
        distances: vec!["0,0,0 0,0,1 8.1".parse().unwrap()],
        ..request
    };
    let found = run(&request).unwrap();
    assert_is_truth(&found.similarity, 1e-6);
    let said = found.warnings.join("; ");
    assert!(
        said.contains("which are surer") && said.contains("contradict each other"),
        "{said}"
    );

    // The same distance twice, from either end, is one; two that agree to the digit are as sure as tapes are.
    let of = |distances: [&str; 2]| {
        let request = GeoreferenceRequest {
            distances: distances.map(|text| text.parse().unwrap()).to_vec(),
            ..GeoreferenceRequest::default()
        };
        georeference_model(Path::new("model"), &reconstruction(), &request).unwrap()
    };
    assert_eq!(of(["0,0,0 0,0,1 7.6", "0,0,1 0,0,0 7.6"]).scale_error, None);
    let two = of(["0,0,0 0,0,1 7.6", "0,0,0 0,1,0 7.6"])
        .scale_interval
        .unwrap();
    assert!((two - 0.005 / 2.0_f64.sqrt()).abs() < 1e-9, "{two}");

    // What the package kept places it as well, unless it is to be level; on a line it does not, which is said.
    let utm = Crs::understand("EPSG:32632").unwrap();
    let mut model = reconstruction();
    let kept = |at: &dyn Fn(DVec3) -> DVec3| -> Vec<MeasuredPosition> {
        let photos = reconstruction().photos.into_iter().zip(centers());
        photos
            .map(|(photo, center)| MeasuredPosition {
                photo: photo.name,
                position: utm.to_geographic(at(center)).unwrap(),
            })
            .collect()
    };
    model.measured_positions = kept(&|center| center);
    let request = GeoreferenceRequest {
        distances: one(),
        ..GeoreferenceRequest::default()
    };
    let placed = georeference_model(Path::new("model"), &model, &request).unwrap();
    assert_is_truth(&placed.similarity, 1e-6);
    assert_eq!(placed.crs.as_deref(), Some("EPSG:32632"));
    model.measured_positions = kept(&|center| center.with_x(435_200.0).with_z(460.0));
    let alone = georeference_model(Path::new("model"), &model, &request).unwrap();
    assert_eq!((alone.crs, alone.similarity.scale), (None, 7.5));
    let said = alone.warnings.join("; ");
    assert!(said.contains("positions do not place it: "), "{said}");
}

/// What stands in a system of feet stays there, about the middle of its cameras, and in feet: 10 of them are 3.048 m, and were
/// measured as 3.1.
#[test]
fn a_distance_lengthens_what_has_a_place() {
    let model = Reconstruction {
        crs: Some("EPSG:2277".to_owned()),
        unit: Some(LengthUnit::Foot),
        ..reconstruction()
    };
    let request = GeoreferenceRequest {
        distances: vec!["0,0,0 0,0,10 3.1".parse().unwrap()],
        crs: model.crs.clone(),
        ..GeoreferenceRequest::default()
    };
    let found = georeference_model(Path::new("model"), &model, &request).unwrap();
    assert!((found.similarity.scale - 3.1 / 3.048).abs() < 1e-12);
    assert_eq!(found.similarity.rotation, DMat3::IDENTITY);
    assert_eq!(
        (found.crs.as_deref(), found.unit),
        (Some("EPSG:2277"), LengthUnit::Foot)
    );
    let centers = || model.photos.iter().map(|photo| photo.pose.center);
    let middle = centers().sum::<DVec3>() / 12.0;
    let moved = centers()
        .map(|center| found.similarity.apply(center))
        .sum::<DVec3>()
        / 12.0;
    assert!(moved.distance(middle) < 1e-9, "{moved}");
    assert!((found.lengths[0].fitted - 3.1).abs() < 1e-12);
    let said = found.warnings.join("; ");
    assert!(
        said.contains("1.7 % longer; it stays where it is"),
        "{said}"
    );
}

/// Lengths of 1 that are 2 and 2.02 m: the scale is 2.01, and 0.01 m its standard deviation from two
/// numbers and its standard error from two lengths of 1: sqrt(2 · 0.01² / 1 / 2) / 2.01 = 0.4975 %. With one degree of
/// freedom half its 95 % interval is 12.7062 of them (Student's table), which a normal deviation of 12.7062 / 1.95996 has.
/// One length says nothing of it.
#[test]
fn the_flight_says_how_sure_the_scale_is() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("model.nvm");
    fs::write(&model, "NVM_V3\n").unwrap();
    let stated = |distances: &[&str]| {
        let distances = distances.iter().map(|text| text.parse().unwrap());
        let request = GeoreferenceRequest {
            distances: distances.collect(),
            ..GeoreferenceRequest::default()
        };
        let target = folder.path().join("flight.toml");
        let text = run(&request)
            .unwrap()
            .flight_text(&target, &model, None, None);
        FlightFile::parse(&text.unwrap()).unwrap().errors()
    };
    let both = stated(&["0,0,0 1,0,0 2", "0,0,0 0,1,0 2.02"]);
    assert_eq!(both.world_scale, Some(3.225));
    assert_eq!(stated(&["0,0,0 1,0,0 2"]), Default::default());
}

/// What has a unit has a place, also in the mine's own grid: it is scaled about the middle of its cameras.
#[test]
fn a_flight_in_the_mines_own_grid_stays_where_it_is() {
    let model = Reconstruction {
        unit: Some(LengthUnit::Metre),
        ..reconstruction()
    };
    let request = |level: bool| GeoreferenceRequest {
        distances: vec!["0,0,0 0,0,10 10.5".parse().unwrap()],
        level,
        ..GeoreferenceRequest::default()
    };
    let found = georeference_model(Path::new("model"), &model, &request(false)).unwrap();
    let centers = || model.photos.iter().map(|photo| photo.pose.center);
    let middle = centers().sum::<DVec3>() / 12.0;
    assert!(middle.length() > 1.0);
    assert!(found.similarity.apply(middle).distance(middle) < 1e-9);
    assert!((found.similarity.scale - 1.05).abs() < 1e-12);
    let said = found.warnings.join("; ");
    assert!(said.contains("5.0 % longer; it stays"), "{said}");
    // Who asks for it to be levelled moves it.
    let error = georeference_model(Path::new("model"), &model, &request(true)).unwrap_err();
    assert!(error.fault.what.contains("no plane of points"), "{error}");
}

/// Bars between surveyed points, as long as they are apart and in feet; and points that are too few.
#[test]
fn bars_against_surveyed_points_are_said() {
    let apart = POINTS[0].1.distance(POINTS[1].1);
    let said = |points: &[(&str, DVec3)], unit: &str| {
        let list =
            marks(points, "EPSG:32632") + &format!("#fragscale bar\tp1\tp2\t{apart}\t{unit}\n");
        let list = List::new(&list);
        let request = GeoreferenceRequest {
            control_points: Some(list.path()),
            ..GeoreferenceRequest::default()
        };
        run(&request).unwrap().warnings.join("; ")
    };
    let right = said(&POINTS, "m");
    assert!(
        !right.contains("contradict") && !right.contains("too few"),
        "{right}"
    );
    let feet = said(&POINTS, "ft");
    assert!(feet.contains("scale bar p1 to p2 is 28.1"), "{feet}");
    assert!(
        feet.contains("8.5900 m is typed") && feet.contains("contradict each other"),
        "{feet}"
    );
    let two = said(&POINTS[..2], "m");
    assert!(two.contains("2 surveyed points are too few"), "{two}");
}

/// Marks 8 pixels left and right of where they should be, in photos of 4000, are careless and taken; 60 are others.
#[test]
fn careless_marks_are_taken() {
    let right = marks(&POINTS, "EPSG:32632");
    let fitted = |off: f64| {
        let moved = right.lines().enumerate().map(|(number, line)| {
            let mut fields: Vec<String> = line.split(' ').map(str::to_owned).collect();
            if number > 0 {
                let sign = if number % 2 == 0 { off } else { -off };
                let x: f64 = fields[3].parse().unwrap();
                fields[3] = (x + sign).clamp(0.0, 3999.0).to_string();
            }
            fields.join(" ") + "\n"
        });
        let list = List::new(&moved.collect::<String>());
        run(&GeoreferenceRequest {
            control_points: Some(list.path()),
            ..GeoreferenceRequest::default()
        })
    };
    let careless = fitted(8.0).unwrap();
    assert!(
        (careless.similarity.scale / 7.5 - 1.0).abs() < 0.02,
        "{careless:?}"
    );
    let error = fitted(60.0).unwrap_err();
    assert!(
        error.fault.what.contains("photos of another size"),
        "{error}"
    );
}

/// A distance that decides alone is held against the surveyed points of the list that it names, as it is against positions; one
/// that a tape tells no better is no contradiction.
#[test]
fn a_distance_is_held_against_surveyed_points() {
    let list = List::new(&marks(&POINTS, "EPSG:32632"));
    let apart = POINTS[0].1.distance(POINTS[1].1);
    let said = |longer: f64| {
        let request = GeoreferenceRequest {
            control_points: Some(list.path()),
            distances: vec![format!("p1 p2 {}", apart * longer).parse().unwrap()],
            ..GeoreferenceRequest::default()
        };
        run(&request).unwrap().warnings.join("; ")
    };
    // As 70 for 68.03 m.
    let wrong = said(1.029);
    assert!(
        wrong.contains("the known distance p1 to p2 is") && wrong.contains("contradict"),
        "{wrong}"
    );
    let typed = format!("{:.4} m is typed", apart * 1.029);
    assert!(wrong.contains(&typed), "{wrong}");
    let right = said(1.0);
    assert!(
        right.contains("the surveyed control points are not used") && !right.contains("contradict"),
        "{right}"
    );
}

/// Positions to a tenth of a millimetre, and a distance of 7.5 m that is half a millimetre off: no tape tells that. A centimetre
/// it does.
#[test]
fn what_no_tape_tells_is_no_contradiction() {
    let mut list = "EPSG:32632\n".to_owned();
    for (i, center) in centers().into_iter().enumerate() {
        writeln!(
            list,
            "IMG_{i:04}.JPG {:.4} {:.4} {:.4}",
            center.x, center.y, center.z
        )
        .unwrap();
    }
    let list = List::new(&list);
    let said = |metres: f64| {
        let request = GeoreferenceRequest {
            positions: Some(list.path()),
            distances: vec![format!("0,0,0 0,0,1 {metres}").parse().unwrap()],
            ..GeoreferenceRequest::default()
        };
        run(&request).unwrap().warnings.join("; ")
    };
    assert!(!said(7.5005).contains("contradict"), "{}", said(7.5005));
    assert!(said(7.51).contains("contradict"), "{}", said(7.51));
}

/// Half the pixels: marks of photos of half the size.
#[test]
fn marks_of_photos_of_another_size_are_refused() {
    let right = marks(&POINTS, "EPSG:32632");
    let halved = right.lines().enumerate().map(|(number, line)| {
        let mut fields: Vec<String> = line.split(' ').map(str::to_owned).collect();
        if number > 0 {
            for pixel in &mut fields[3..5] {
                *pixel = (pixel.parse::<f64>().unwrap() / 2.0).to_string();
            }
        }
        fields.join(" ") + "\n"
    });
    let list = List::new(&halved.collect::<String>());
    let request = GeoreferenceRequest {
        control_points: Some(list.path()),
        ..GeoreferenceRequest::default()
    };
    let error = run(&request).unwrap_err();
    assert!(
        error.fault.what.contains("photos of another size"),
        "{error}"
    );
    assert!(error.fault.remedy.contains("--photos"), "{error}");
}
