use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use ::las::{Builder, Color, Point, Transform, Vector, Writer};
use glam::DVec3;

use super::*;
use crate::CloudFormat;
use crate::Kind;
use crate::detect;
use crate::read_cloud;

const HEADER_JSON: &str = r#"{"bounds": [0, 0, 0, 8, 8, 8], "boundsConforming": [0, 0, 0, 8, 8, 8],
    "dataType": "laszip", "hierarchyType": "json", "points": 6, "span": 128, "version": "1.0.0",
    "schema": [{"name": "X", "offset": 500000, "scale": 0.001, "size": 4, "type": "signed"}],
    "srs": {"authority": "EPSG", "horizontal": "32633", "wkt": "PROJCS[\"x\"]"}}"#;

/// A LAZ tile of these points, red by their x.
fn tile(points: &[[f64; 3]]) -> Vec<u8> {
    let mut builder = Builder::from((1, 2));
    builder.point_format = ::las::point::Format::new(2).unwrap();
    builder.point_format.is_compressed = true;
    let axis = |offset| Transform {
        scale: 0.001,
        offset,
    };
    builder.transforms = Vector {
        x: axis(500_000.0),
        y: axis(5_000_000.0),
        z: axis(0.0),
    };
    let mut writer = Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
    for [x, y, z] in points {
        writer
            .write_point(Point {
                x: 500_000.0 + x,
                y: 5_000_000.0 + y,
                z: *z,
                color: Some(Color::new(256 * (*x as u16), 65_535, 0)),
                ..Point::default()
            })
            .unwrap();
    }
    writer.into_inner().unwrap().into_inner()
}

/// Six points in three tiles; the deepest is named in a hierarchy file of its own.
fn files() -> HashMap<String, Vec<u8>> {
    let text = |text: &str| text.as_bytes().to_vec();
    HashMap::from(
        [
            (
                "ept-hierarchy/0-0-0-0.json",
                text(r#"{"0-0-0-0": 3, "1-0-0-0": 2, "1-1-0-0": 0, "2-1-1-1": -1}"#),
            ),
            ("ept-hierarchy/2-1-1-1.json", text(r#"{"2-1-1-1": 1}"#)),
            (
                "ept-data/0-0-0-0.laz",
                tile(&[[1.0, 2.0, 3.0], [7.0, 7.0, 7.0], [0.125, 0.25, 0.5]]),
            ),
            (
                "ept-data/1-0-0-0.laz",
                tile(&[[2.0, 2.0, 2.0], [3.0, 3.0, 3.0]]),
            ),
            ("ept-data/2-1-1-1.laz", tile(&[[3.5, 3.5, 3.5]])),
        ]
        .map(|(name, bytes)| (name.to_owned(), bytes)),
    )
}

fn read_from(header: &str, files: &HashMap<String, Vec<u8>>) -> Result<CloudFile, Fault> {
    let beside = |name: &str| {
        let bytes = files.get(name).cloned();
        bytes.ok_or_else(|| Fault::new("there is no such file", ""))
    };
    read(header.as_bytes(), &beside, &Progress::default())
}

#[test]
fn all_tiles_are_one_cloud() {
    let found = read_from(HEADER_JSON, &files()).unwrap();
    let expected = [
        [1.0, 2.0, 3.0],
        [7.0, 7.0, 7.0],
        [0.125, 0.25, 0.5],
        [2.0, 2.0, 2.0],
        [3.0, 3.0, 3.0],
        [3.5, 3.5, 3.5],
    ];
    assert_eq!(found.cloud.points.len(), 6);
    for (point, [x, y, z]) in found.cloud.points.iter().zip(expected) {
        let expected = DVec3::new(500_000.0 + x, 5_000_000.0 + y, z);
        assert!((*point - expected).length() < 1e-8, "{point}");
    }
    assert_eq!(found.cloud.colors[1], [7, 255, 0]);
    assert_eq!(found.crs.as_deref(), Some("EPSG:32633"));
    assert_eq!(found.warnings, [""; 0]);
}

#[test]
fn what_is_wrong_is_named() {
    let with = |from: &str, to: &str| {
        assert!(HEADER_JSON.contains(from), "{from}");
        read_from(&HEADER_JSON.replace(from, to), &files())
    };
    for data_type in ["binary", "zstandard"] {
        let header = HEADER_JSON.replace("laszip", data_type);
        let fault = read_from(&header, &files()).unwrap_err();
        assert!(fault.what.contains(data_type), "{fault}");
        assert!(refusal(header.as_bytes()).unwrap().contains(data_type));
    }
    assert_eq!(refusal(HEADER_JSON.as_bytes()), None);
    assert!(refusal(b"{").is_some());
    assert!(
        with("\"json\"", "\"gzip\"")
            .unwrap_err()
            .what
            .contains("gzip")
    );
    let wrong = with("\"points\": 6", "\"points\": 7").unwrap();
    assert!(wrong.warnings[0].contains("promises 7 points"));
    let of_wkt = with("\"horizontal\": \"32633\", ", "").unwrap();
    assert_eq!(of_wkt.crs.as_deref(), Some("PROJCS[\"x\"]"));
    for name in ["ept-data/1-0-0-0.laz", "ept-hierarchy/2-1-1-1.json"] {
        let mut less = files();
        less.remove(name);
        let fault = read_from(HEADER_JSON, &less).unwrap_err();
        assert!(fault.what.starts_with(name), "{fault}");
    }
    let mut files = files();
    for key in ["../x", "1-1-1", "a-b-c-d", "0-0-0-+1", "0-0-0-0-0"] {
        let json = format!("{{\"{key}\": 1}}");
        files.insert("ept-hierarchy/0-0-0-0.json".to_owned(), json.into_bytes());
        let fault = read_from(HEADER_JSON, &files).unwrap_err();
        assert!(fault.what.contains("no key of a tile"), "{fault}");
    }
    files.insert(
        "ept-hierarchy/0-0-0-0.json".to_owned(),
        br#"{"0-0-0-0": -1, "1-0-0-0": -1}"#.to_vec(),
    );
    files.insert(
        "ept-hierarchy/1-0-0-0.json".to_owned(),
        br#"{"0-0-0-0": -1, "1-0-0-0": 0}"#.to_vec(),
    );
    assert!(read_from(HEADER_JSON, &files).is_err());
}

/// Writes a whole EPT into a folder.
pub(crate) fn write(folder: &Path) {
    for (name, bytes) in files() {
        let file = folder.join(name);
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(file, bytes).unwrap();
    }
    std::fs::write(folder.join("ept.json"), HEADER_JSON).unwrap();
}

#[test]
fn it_is_opened_as_a_surface() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    let path = folder.path().join("ept.json");
    assert_eq!(detect(&path), Ok(Kind::Cloud(CloudFormat::Ept)));
    let found = read_cloud(&path, &Progress::default()).unwrap();
    assert_eq!(found.cloud.points.len(), 6);
    let folder_error = detect(folder.path()).unwrap_err().to_string();
    assert!(
        folder_error.ends_with("open its ept.json"),
        "{folder_error}"
    );
    // Under another name it is told by its keys.
    let other = folder.path().join("pile.json");
    std::fs::rename(&path, &other).unwrap();
    assert_eq!(detect(&other), Ok(Kind::Cloud(CloudFormat::Ept)));
    std::fs::remove_file(folder.path().join("ept-data/0-0-0-0.laz")).unwrap();
    let error = read_cloud(&other, &Progress::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("pile.json: ept-data/0-0-0-0.laz"), "{error}");
    assert!(!error.contains('\n'));
}
