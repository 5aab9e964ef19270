//! Results that are whole files and yet no flight, or more of one than was needed.

use super::*;

fn shot(photo: &str) -> String {
    format!(
        r#"{{"properties": {{"filename": "{photo}", "camera": "lens", "translation": [0, 0, 30], "rotation": [3.14, 0, 0]}}}}"#
    )
}

/// A desk whose results are of these shots, with something more.
fn desk_of(shots: &[String], more: (&str, &[u8])) -> Desk {
    let shots = format!(r#"{{"features": [{}]}}"#, shots.join(","));
    Desk::new(Served {
        results: zipped(&[
            ("cameras.json", CAMERAS.as_bytes()),
            ("odm_report/shots.geojson", shots.as_bytes()),
            more,
        ]),
        ..Served::default()
    })
}

/// One line, and the task with its results stays where it is; here nothing of them does.
#[test]
fn what_is_no_flight_is_refused_and_stays_on_the_node() {
    let one = [shot("IMG_1.JPG")];
    for (shots, more, said) in [
        (
            &one[..],
            ("images.json", b"[]".to_vec()),
            "the node's results hold no points, neither a dense cloud nor sparse ones",
        ),
        (
            &one,
            (CLOUD, cloud(0)),
            "the node's cloud holds no point (odm_georeferencing/odm_georeferenced_model.laz)",
        ),
        (
            &one,
            (CLOUD, b"LASF".to_vec()),
            "the node's results cannot be read: odm_georeferencing/odm_georeferenced_model.laz: ",
        ),
        (
            &one,
            (CLOUD, cloud(9)[..300].to_vec()),
            "the node's results cannot be read: odm_georeferencing/odm_georeferenced_model.laz: ",
        ),
        (&[], (CLOUD, cloud(5)), "the node's results"),
        (
            &[shot("x.jpg")],
            (CLOUD, cloud(5)),
            "the node's results place none of the photos",
        ),
    ] {
        let desk = desk_of(shots, (more.0, &more.1));
        let error = desk.error();
        assert!(error.contains(said), "{error}");
        let remedy = format!(
            "to begin anew, remove {} and the task fda57596-9d93-48f0-8e5b-000000000001 on the node",
            desk.to().join("unfinished").display()
        );
        assert!(error.ends_with(&remedy), "{error}");
        let task = &desk.server.tasks()[0];
        assert!(!task.removed && !task.cancelled);
        for name in ["all.zip", "odm"] {
            assert!(!desk.to().join("unfinished").join(name).exists());
        }
    }
}

/// Photos of others are said, and so is a cloud that is none but the sparse one.
#[test]
fn what_the_results_lack_is_said() {
    let two = [shot("IMG_1.JPG"), shot("x.jpg")];
    let made = desk_of(&two, (CLOUD, &cloud(5))).run().unwrap();
    assert_eq!(made.registered, 1);
    let said = "1 of the 2 photos in the node's results were not sent (x.jpg)";
    let says = |warning: &String| warning.contains(said);
    assert!(made.warnings.iter().any(says), "{:?}", made.warnings);
    let sparse = format!(
        r#"[{{"cameras": {CAMERAS}, "shots": {{"IMG_1.JPG": {{"camera": "lens", "rotation": [0, 0, 0], "translation": [0, 0, 0]}}}},
            "points": {{"0": {{"coordinates": [0, 0, -9], "color": [1, 2, 3]}}}}}}]"#
    );
    let sparse = ("opensfm/reconstruction.json", sparse.as_bytes());
    // In the frame of its points.
    let there = two[0].replace("[0, 0, 30]", "[0, 0, 0]");
    let there = there.replace("[3.14, 0, 0]", "[0, 0, 0]");
    let made = desk_of(&[there], sparse).run().unwrap();
    let says = |warning: &String| warning.contains("no dense cloud");
    assert!(made.warnings.iter().any(says), "{:?}", made.warnings);
    assert_eq!(made.points, 1);
    // What went into the project is a part of it, of which nobody has to be told.
    let says = |warning: &String| warning.contains("is taken");
    assert!(!made.warnings.iter().any(says), "{:?}", made.warnings);
}

/// What an option makes is asked for, and lies beside the rest.
#[test]
fn what_options_make_comes_back() {
    let desk = Desk::faulty(ServerFault::None);
    let request = NodeRequest {
        options: vec![
            Asked::parse("dsm").unwrap(),
            Asked::parse("skip-orthophoto=false").unwrap(),
        ],
        ..desk.request()
    };
    desk.run_request(&request).unwrap();
    let asked = &desk.server.tasks()[0].fields["outputs"];
    for output in ["odm_dem/dsm.tif", "odm_orthophoto/odm_orthophoto.tif"] {
        assert!(asked.contains(output), "{asked}");
        assert!(desk.to().join("odm").join(output).is_file());
    }
    assert!(!desk.to().join("odm/task_output.txt").exists());
}
