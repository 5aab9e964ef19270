//! Which package wrote a file.

use std::fs;

use super::*;

#[test]
fn files_are_told_by_their_beginning_or_name() {
    for (name, start, package) in [
        ("x.out", "# Bundle file v0.3\n", Package::Bundler),
        ("synth_0.out", "drews 1.0\n", Package::Bundler),
        ("cameras.sfm", "{", Package::Meshroom),
        ("sfm.abc", "Ogawa", Package::Meshroom),
        ("dino_par.txt", "16\n", Package::Middlebury),
        ("x.json", r#"[{"shots": {}}]"#, Package::OpenSfm),
        ("x.json", r#"{"views": [], "poses": []}"#, Package::Meshroom),
        (
            "transforms_train.json",
            r#"{"frames": []}"#,
            Package::Nerfstudio,
        ),
        (
            "x.json",
            r#"{"intrinsic": {}, "extrinsic": []}"#,
            Package::Open3d,
        ),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join(name);
        fs::write(&path, start).unwrap();
        let found = of_file(&path, start.as_bytes());
        assert_eq!(found, Some((package, path)), "{name}");
    }
}

#[test]
fn json_is_told_by_its_keys() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("x.json");
    for (json, package) in [
        (r#"[{"x": [1, 2], "shots": {}}, 7]"#, Some(Package::OpenSfm)),
        (
            r#"[{"cameras": {}, "shots": {"a": tr"#,
            Some(Package::OpenSfm),
        ),
        (
            "\u{feff}{\"version\": [], \"views\": []}",
            Some(Package::Meshroom),
        ),
        (r#"{"views": [], "x": 1}"#, None),
        (r#"{"frames": "#, Some(Package::Nerfstudio)),
        (
            r#"{"class_name": "", "parameters": []}"#,
            Some(Package::Open3d),
        ),
        (
            r#"{"intrinsic": {}, "extrinsic": []}"#,
            Some(Package::Open3d),
        ),
        (r#"{"type": "FeatureCollection", "features": []}"#, None),
        (r#"{"a": {"frames": []}}"#, None),
        ("[[{\"shots\": 1}]]", None),
        ("[]", None),
        ("{", None),
        ("7", None),
    ] {
        fs::write(&path, json).unwrap();
        let start = &json.as_bytes()[..json.len().min(4096)];
        let found = of_file(&path, start).map(|(package, _)| package);
        assert_eq!(found, package, "{json}");
    }
}
