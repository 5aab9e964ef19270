//! OpenDroneMap's folders, opened.

use std::fs;
use std::path::Path;

use las::{Builder, Point, Transform, Vector, Writer};
use tempfile::TempDir;

use crate::jobs::Progress;
use crate::{OpenOptions, open_flight};

const CAMERAS: (&str, &str) = (
    "cameras.json",
    r#"{"c": {"projection_type": "brown", "focal_x": 0.5, "focal_y": 0.5, "width": 400, "height": 200}}"#,
);
/// Two photos that look straight down, and a point 10 below the first, in a frame that is the
/// world less the offset.
const SPARSE: (&str, &str) = (
    "opensfm/reconstruction.json",
    r#"[{"cameras": {"v2 c": {"projection_type": "brown", "focal_x": 0.5, "focal_y": 0.5, "width": 400, "height": 200}},
    "shots": {
      "a.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [-1, 2, 50]},
      "b.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [-3, 4, 60]}},
    "points": {"7": {"coordinates": [1, 2, 40], "color": [1, 2, 3]}}}]"#,
);
/// The same photos in the world, in another order.
const SHOTS: (&str, &str) = (
    "odm_report/shots.geojson",
    r#"{"features": [
    {"properties": {"filename": "b.jpg", "camera": "v2 c", "focal": 0.5, "width": 400, "height": 200,
      "translation": [500003, 4000004, 60], "rotation": [3.141592653589793, 0, 0]}},
    {"properties": {"filename": "a.jpg", "focal": 0.5, "width": 400, "height": 200,
      "translation": [500001, 4000002, 50], "rotation": [3.141592653589793, 0, 0]}}]}"#,
);
const COORDS: (&str, &str) = (
    "odm_georeferencing/coords.txt",
    "WGS84 UTM 33N\n500000 4000000\n",
);
fn project(files: &[(&str, &str)]) -> TempDir {
    let dir = TempDir::new().unwrap();
    for (name, content) in files {
        let file = dir.path().join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, content).unwrap();
    }
    dir
}

/// Entwine's tiles: six points in the first.
fn write_tiles(folder: &Path) {
    let axis = |offset| Transform {
        scale: 0.001,
        offset,
    };
    let mut builder = Builder::from((1, 2));
    builder.point_format.is_compressed = true;
    builder.transforms = Vector {
        x: axis(500_000.0),
        y: axis(4_000_000.0),
        z: axis(0.0),
    };
    for part in ["ept-data", "ept-hierarchy"] {
        fs::create_dir_all(folder.join(part)).unwrap();
    }
    let tile = folder.join("ept-data/0-0-0-0.laz");
    let mut writer = Writer::from_path(tile, builder.into_header().unwrap()).unwrap();
    for [x, y, z] in [
        [1, 2, 3],
        [7, 7, 7],
        [0, 4, 5],
        [2, 2, 2],
        [3, 3, 3],
        [5, 0, 4],
    ] {
        let point = Point {
            x: 500_000.0 + f64::from(x),
            y: 4_000_000.0 + f64::from(y),
            z: f64::from(z),
            ..Point::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
    let hierarchy = folder.join("ept-hierarchy/0-0-0-0.json");
    fs::write(hierarchy, r#"{"0-0-0-0": 6}"#).unwrap();
    let header = r#"{"bounds": [0, 0, 0, 8, 8, 8], "boundsConforming": [0, 0, 0, 8, 8, 8],
        "dataType": "laszip", "hierarchyType": "json", "points": 6, "span": 128, "version": "1.0.0",
        "schema": [{"name": "X", "offset": 500000, "scale": 0.001, "size": 4, "type": "signed"}],
        "srs": {"authority": "EPSG", "horizontal": "32633", "wkt": "PROJCS[\"x\"]"}}"#;
    fs::write(folder.join("ept.json"), header).unwrap();
}

/// A cloud as tiles alone is the project's surface; where there is none, the error says where it
/// was looked for.
#[test]
fn tiles_are_a_surface_and_none_is_said() {
    let open = |dir: &TempDir| {
        let options = OpenOptions::default();
        open_flight(dir.path(), &options, &Progress::default())
    };
    let no_points = SPARSE.1.replace(
        r#""7": {"coordinates": [1, 2, 40], "color": [1, 2, 3]}"#,
        "",
    );
    let dir = project(&[CAMERAS, (SPARSE.0, &no_points), SHOTS, COORDS]);
    let error = open(&dir).unwrap_err().to_string();
    for name in [
        "odm_georeferenced_model.copc.laz",
        "entwine_pointcloud/ept.json",
        "odm_dem/dsm.tif",
    ] {
        assert!(error.contains(name), "{error}");
    }
    assert!(!error.contains('\n'));
    let tiles = dir.path().join("entwine_pointcloud");
    write_tiles(&tiles);
    let opened = open(&dir).unwrap();
    assert!(opened.inputs.contains(&tiles.join("ept.json")));
    assert_eq!(opened.flight.parts().surface.vertices().count(), 6);
}
