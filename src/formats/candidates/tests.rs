use std::fs;

use fragscale_test_data::jpeg;

use super::*;
use crate::Kind;
use crate::read_project;
use crate::{candidates, detect};

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    add(dir.path(), files);
    dir
}

fn add(folder: &Path, files: &[(&str, &str)]) {
    for (name, content) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, content).unwrap();
    }
}

/// A COLMAP model of as many photos.
fn colmap_model(folder: &Path, place: &str, photos: usize) {
    let lines: Vec<String> = (1..=photos)
        .map(|i| format!("{i} 1 0 0 0 0 0 {i} 1 {i}.jpg\n\n"))
        .collect();
    let images = lines.concat();
    add(
        folder,
        &[
            (
                &format!("{place}/cameras.txt"),
                "1 PINHOLE 40 30 40 40 20 15\n",
            ),
            (&format!("{place}/images.txt"), &images),
            (&format!("{place}/points3D.txt"), ""),
        ],
    );
}

fn nvm(photos: usize) -> String {
    let lines: Vec<String> = (0..photos)
        .map(|i| format!("{i}.jpg 40 1 0 0 0 {i} 0 0 0 0\n"))
        .collect();
    format!("NVM_V3\n\n{photos}\n{}\n0\n0\n", lines.concat())
}

fn opensfm(photos: usize) -> String {
    let shots: Vec<String> = (0..photos)
        .map(|i| {
            format!(
                r#""{i}.jpg": {{"camera": "c", "rotation": [0, 0, 0], "translation": [{i}, 0, 0]}}"#
            )
        })
        .collect();
    let camera = r#"{"c": {"focal": 1, "width": 40, "height": 30}}"#;
    format!(
        r#"[{{"cameras": {camera}, "shots": {{{}}}}}]"#,
        shots.join(", ")
    )
}

/// What opening the folder says, which is one line.
fn refused(folder: &Path) -> String {
    let error = detect(folder).unwrap_err().to_string();
    assert!(!error.contains('\n'), "{error}");
    let start = format!("{}: ", folder.display());
    error.strip_prefix(&start).unwrap().to_owned()
}

/// The list of candidates, as in an error.
fn listed(folder: &Path) -> Vec<String> {
    let found = candidates(folder);
    found.iter().map(|one| one.in_words(folder)).collect()
}

#[test]
fn folders_are_told_by_what_lies_in_them() {
    for (file, package) in [
        ("opensfm/reconstruction.json", Package::OpenSfm),
        ("reconstruction.json", Package::OpenSfm),
        ("reconstruction_example.json", Package::OpenSfm),
        ("bundle/bundle.out", Package::Bundler),
        ("transforms.json", Package::Nerfstudio),
        ("cameras.sfm", Package::Meshroom),
        ("templeR_par.txt", Package::Middlebury),
        (
            "submodels/submodel_0000/odm_report/shots.geojson",
            Package::OpenDroneMap,
        ),
    ] {
        let dir = folder(&[(file, "[")]);
        let found = Contents::of(dir.path());
        let packages: Vec<Package> = found.meant.iter().map(|(package, _)| *package).collect();
        assert_eq!(packages, [package], "{file}");
        assert_eq!(found.sources, [], "{file}");
    }
    let dir = folder(&[]);
    assert_eq!(Contents::of(dir.path()), Contents::default());
    // Under another name it is still the only one in the folder; of two neither is meant.
    let dir = folder(&[("model.nvm", "NVM_V3"), ("notes.txt", "1 2 3")]);
    let model = dir.path().join("model.nvm");
    assert_eq!(
        detect(dir.path()),
        Ok(Kind::Reconstruction(Package::VisualSfm, model))
    );
}

#[test]
fn of_two_models_neither_is_taken() {
    let dir = folder(&[]);
    colmap_model(dir.path(), "sparse/0", 26);
    let only = detect(dir.path()).unwrap();
    assert_eq!(
        only,
        Kind::Reconstruction(Package::Colmap, dir.path().join("sparse/0"))
    );
    colmap_model(dir.path(), "sparse/1", 4);
    assert_eq!(
        refused(dir.path()),
        "several reconstructions (sparse/0: COLMAP, 26 photos; sparse/1: COLMAP, 4 photos); \
         open one of them by its path"
    );
    let found = candidates(dir.path());
    assert_eq!(found.len(), 2);
    assert_eq!(found[1].package, Some(Package::Colmap));
    assert_eq!(found[1].path, dir.path().join("sparse/1"));
    assert_eq!(found[1].photos, Some(4));
    // Each of them opens by its path, and so it is said from the folder that holds both.
    for (model, photos) in [("sparse/0", 26), ("sparse/1", 4)] {
        let project = read_project(&dir.path().join(model), &Progress::default()).unwrap();
        assert_eq!(project.reconstruction.photos.len(), photos);
        assert_eq!(candidates(&dir.path().join(model))[0].photos, Some(photos));
    }
    let said = refused(&dir.path().join("sparse"));
    assert!(
        said.contains("(0: COLMAP, 26 photos; 1: COLMAP, 4 photos)"),
        "{said}"
    );
}

#[test]
fn of_two_packages_neither_is_taken() {
    for (name, content, words) in [
        ("model.nvm", nvm(3), "model.nvm: VisualSFM, 3 photos"),
        (
            "reconstruction.json",
            opensfm(5),
            "reconstruction.json: OpenSfM, 5 photos",
        ),
        ("cameras.sfm", "{}".to_owned(), "cameras.sfm: Meshroom"),
    ] {
        let dir = folder(&[(name, &content)]);
        assert_eq!(listed(dir.path()), [words]);
        colmap_model(dir.path(), "sparse/0", 2);
        let both = [words.to_owned(), "sparse/0: COLMAP, 2 photos".to_owned()];
        assert_eq!(listed(dir.path()), both);
        let said = refused(dir.path());
        assert!(said.contains(&both.join("; ")), "{said}");
    }
    // Two recordings, and two bags of which one is a folder.
    let dir = folder(&[("a.bag", "#ROSBAG V2.0\n"), ("b.bag", "#ROSBAG V2.0\n")]);
    assert!(refused(dir.path()).contains("(a.bag: ROS; b.bag: ROS)"));
    let metadata = "rosbag2_bagfile_information:\n";
    let dir = folder(&[
        ("metadata.yaml", metadata),
        ("x_0.db3", "SQLite format 3\0"),
        ("a.bag", "#ROSBAG V2.0\n"),
    ]);
    assert!(refused(dir.path()).contains("(.: ROS; a.bag: ROS)"));
    fs::remove_file(dir.path().join("a.bag")).unwrap();
    let whole = Kind::Reconstruction(Package::Ros, dir.path().to_owned());
    assert_eq!(detect(dir.path()), Ok(whole));
}

#[test]
fn what_the_whole_was_made_of_is_no_choice_and_is_said() {
    let shots = r#"{"features": [{"properties": {"filename": "a.jpg", "translation": [0, 0, 9],
        "rotation": [0, 0, 0]}}]}"#;
    let camera = r#"{"c": {"projection_type": "brown", "focal_x": 1, "focal_y": 1, "width": 40, "height": 30}}"#;
    let sparse = opensfm(1);
    let dir = folder(&[
        ("cameras.json", camera),
        ("odm_report/shots.geojson", shots),
        ("opensfm/reconstruction.json", &sparse),
        ("bundle/bundle.out", "# Bundle file v0.3\n"),
    ]);
    assert_eq!(listed(dir.path()), [".: OpenDroneMap, 1 photo"]);
    let project = read_project(dir.path(), &Progress::default()).unwrap();
    let said = project.reconstruction.warnings.join("\n");
    for named in [
        "opensfm/reconstruction.json (OpenSfM)",
        "bundle/bundle.out (Bundler)",
    ] {
        assert!(said.contains(named), "{said}");
    }
    assert_eq!(project.reconstruction.package, "opendronemap");
    // Another package's is no part of it.
    add(dir.path(), &[("model.nvm", &nvm(2))]);
    assert!(
        refused(dir.path()).contains(".: OpenDroneMap, 1 photo; model.nvm: VisualSFM, 2 photos")
    );

    for (files, taken, source) in [
        (
            ["reconstruction.json", "reconstruction.meshed.json"],
            "OpenSfM",
            1,
        ),
        (
            ["transforms.json", "transforms_train.json"],
            "nerfstudio",
            1,
        ),
        (["bundle.out", "bundle.rd.out"], "Bundler", 1),
        (["cameras.sfm", "sfm.abc"], "Meshroom", 1),
        (
            ["reconstruction.json", "reconstruction_old.json"],
            "OpenSfM",
            0,
        ),
    ] {
        let content = match files[0] {
            "reconstruction.json" => sparse.as_str(),
            "transforms.json" => r#"{"frames": []}"#,
            _ => "x",
        };
        let dir = folder(&files.map(|name| (name, content)));
        let found = Contents::of(dir.path());
        assert_eq!(found.sources.len(), source, "{files:?}");
        assert_eq!(found.meant.len(), 2 - source, "{files:?}");
        assert_eq!(
            found.meant[0],
            (found.meant[0].0, dir.path().join(files[0]))
        );
        assert_eq!(found.meant[0].0.name(), taken);
        let said = found.sources_in_words(dir.path());
        assert_eq!(
            said.is_some_and(|said| said.contains(files[1])),
            source == 1
        );
    }
}

#[test]
fn a_folder_above_names_the_projects_inside() {
    let dir = folder(&[
        ("flights/may/model.nvm", &nvm(3)),
        ("photos/a.jpg", "x"),
        ("too/far/down/model.nvm", &nvm(3)),
        ("readme.txt", "1 2 3"),
    ]);
    colmap_model(dir.path(), "june/sparse/0", 7);
    colmap_model(dir.path(), "june/sparse/1", 2);
    add(dir.path(), &[("sample/flight.toml", "format = 1\n")]);
    let expected = [
        "june/sparse/0: COLMAP, 7 photos",
        "june/sparse/1: COLMAP, 2 photos",
        "sample/flight.toml: fragscale",
        "flights/may/model.nvm: VisualSFM, 3 photos",
    ];
    assert_eq!(listed(dir.path()), expected);
    let said = refused(dir.path());
    assert!(
        said.contains(&format!("({})", expected.join("; "))),
        "{said}"
    );
    assert!(said.ends_with("open one of them by its path"), "{said}");
    // Photos alone only where there is nothing else.
    let dir = folder(&[("DCIM/100MEDIA/a.jpg", "x"), ("DCIM/101MEDIA/b.jpg", "x")]);
    let expected = [
        "DCIM/100MEDIA: photos alone, 1 photo",
        "DCIM/101MEDIA: photos alone, 1 photo",
    ];
    assert_eq!(listed(dir.path()), expected);
    // Nothing at all, as before.
    let dir = folder(&[("a/b/c.txt", "1 2 3")]);
    assert!(
        refused(dir.path())
            .starts_with("a folder with no flight.toml and no reconstruction in it; ")
    );
    assert_eq!(candidates(dir.path()), []);
}

/// Screenshots and sketches above a flight are no flight themselves; photos that say where they were taken are.
#[test]
fn loose_pictures_above_a_flight_are_not_meant() {
    let dir = folder(&[
        ("Screenshot 1.png", "x"),
        ("sketch.jpg", "x"),
        ("may/flight.toml", "format = 1\n"),
        // A level deeper, likewise.
        ("june/plan.png", "x"),
        ("june/pit/model.nvm", &nvm(3)),
    ]);
    let flights = [
        "may/flight.toml: fragscale",
        "june/pit/model.nvm: VisualSFM, 3 photos",
    ];
    assert_eq!(listed(dir.path()), flights);
    let said = refused(dir.path());
    assert!(said.contains("no reconstruction in it"), "{said}");
    assert!(said.contains(&flights.join("; ")), "{said}");
    let down = r#"<rdf:Description drone-dji:GimbalYawDegree="+0.00" drone-dji:GimbalPitchDegree="-90.00" drone-dji:GimbalRollDegree="+0.00"/>"#;
    let exif = [jpeg::gps(), vec![jpeg::text(exif::Tag::Make, "DJI")]].concat();
    let photo = jpeg::jpeg((40, 30), &exif, &[&jpeg::packet(down)]);
    fs::write(dir.path().join("sketch.jpg"), photo).unwrap();
    assert_eq!(
        detect(dir.path()),
        Ok(Kind::Reconstruction(Package::Photos, dir.path().to_owned()))
    );
    // Alone they are photos that say too little.
    let dir = folder(&[("Screenshot 1.png", "x"), ("photos/a.jpg", "x")]);
    assert_eq!(listed(dir.path()), [".: photos alone, 1 photo"]);
}

#[test]
fn looking_is_bounded() {
    let dir = folder(&[]);
    for i in 0..300 {
        add(dir.path(), &[(&format!("{i:03}/model.nvm"), "NVM_V3")]);
    }
    let found = candidates(dir.path());
    assert_eq!(found.len(), MOST_FOLDERS);
    let said = refused(dir.path());
    assert!(said.contains("; 192 more)"), "{said}");
    // A large file is not read to be counted.
    let dir = folder(&[]);
    let large = dir.path().join("large.nvm");
    fs::write(&large, "NVM_V3").unwrap();
    let file = fs::OpenOptions::new().write(true).open(&large).unwrap();
    file.set_len(COUNTED_BYTES + 1).unwrap();
    assert_eq!(listed(dir.path()), ["large.nvm: VisualSFM"]);
}

#[test]
fn one_file_is_its_own_candidate() {
    let dir = folder(&[
        ("a.nvm", &nvm(3)),
        ("b.nvm", &nvm(1)),
        ("notes.txt", "1 2 3"),
    ]);
    let path = dir.path().join("b.nvm");
    let only = Candidate {
        package: Some(Package::VisualSfm),
        path: path.clone(),
        photos: Some(1),
    };
    assert_eq!(candidates(&path), [only]);
    assert_eq!(candidates(&dir.path().join("notes.txt")), []);
    assert_eq!(candidates(&dir.path().join("none")), []);
}

/// A list of images alone is no cloud, though its rows are numbers: the model lacks its cameras.
#[test]
fn a_part_of_a_colmap_model_says_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let images = folder.path().join("images.txt");
    let text = "# Image list with two lines of data per image:\n1 1 0 0 0 0 0 0 1 a.jpg\n\n";
    fs::write(&images, text).unwrap();
    for path in [images.as_path(), folder.path()] {
        let said = detect(path).unwrap_err().to_string();
        assert!(
            said.contains("without cameras.bin or cameras.txt"),
            "{said}"
        );
    }
}
