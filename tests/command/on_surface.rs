//! Profiles and volumes through the command: on the bundled flight and on a simulated pile whose true
//! mesh is known.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::{fragscale, stdout_of};

fn bundled() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a UTF-8 path")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// A floor of 20 by 20 at 5,000,000 north with a square frustum on it: 10 wide at its foot, 4 on top, 3
/// high, its volume h (a^2 + ab + b^2) / 3 = 156; sides of 45 degrees. `bench` is a file of its points.
fn frustum(folder: &Path, height: f64) -> PathBuf {
    let path = folder.join("pile.xyz");
    let mut points = String::new();
    for (side, z) in [(20.0, 0.0), (10.0, 0.0), (4.0, height)] {
        for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let [x, y] = [x * side / 2.0 + 500_000.0, y * side / 2.0 + 5_000_000.0];
            points += &format!("{x} {y} {z}\n");
        }
    }
    fs::write(&path, points).expect("it is written");
    path
}

#[test]
fn a_profile_over_a_cloud_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let cloud = frustum(folder.path(), 3.0);
    let csv = folder.path().join("profile.csv");
    let line = ["--from", "499992,5000000", "--to", "500008,5000000"];
    let mut arguments = vec!["profile", text(&cloud), "-o", text(&csv)];
    arguments.extend(line);
    let said = stdout_of(&arguments);
    assert!(said.contains("angle of repose before  45.0°"), "{said}");
    assert!(said.contains("3.000 units of the file high"), "{said}");
    let mut reader = csv::Reader::from_path(&csv).expect("it was written");
    let header = reader.headers().expect("a header").clone();
    assert_eq!(
        header.iter().collect::<Vec<_>>(),
        [
            "distance_file_units",
            "x_file_units",
            "y_file_units",
            "height_file_units",
            "part"
        ]
    );
    for record in reader.records() {
        let record = record.expect("a record");
        let at = |column: usize| -> f64 { record[column].parse().expect("a number") };
        // 8 - |x| off the middle: 5 at the foot, 2 on top.
        let off = (at(1) - 500_000.0).abs();
        let height = (5.0 - off).clamp(0.0, 3.0);
        assert!((at(3) - height).abs() < 1e-9, "{record:?}");
        assert!((at(0) - (at(1) - 499_992.0)).abs() < 1e-9);
        assert_eq!((&record[2], &record[4]), ("5000000", "1"));
    }
    arguments.truncate(2);
    arguments.extend(line);
    arguments.extend(["--format", "json"]);
    let found: Value = serde_json::from_str(&stdout_of(&arguments)).expect("JSON");
    let face = &found["faces"][1];
    assert_eq!(face["side"], "after");
    assert!((number(&face["angle_of_repose_degrees"]) - 45.0).abs() < 1e-7);
    assert!((number(&face["toe"]["distance"]) - 13.0).abs() < 1e-9);
    assert!((number(&face["crest"]["distance"]) - 10.0).abs() < 1e-9);
}

/// A line that begins on the bundled pile has a stone at its crest, with a side of 4 mm: no angle of repose. The pile's own slope
/// behind the crest is one.
#[test]
fn a_stone_at_the_crest_is_no_slope() {
    for to in ["12,5", "5,5"] {
        let said = stdout_of(&["profile", text(&bundled()), "--from", "0,0", "--to", to]);
        let line = |name: &str| {
            let found = said.lines().find(|line| line.starts_with(name));
            found.unwrap_or_else(|| panic!("{said}"))
        };
        let doubt = "a stone's side rather than a slope";
        assert!(line("angle of repose before").contains(doubt), "{said}");
        assert!(!line("angle of repose after").contains(doubt), "{said}");
    }
}

#[test]
fn volumes_over_a_level_the_rim_and_a_cloud() {
    let folder = tempfile::tempdir().expect("a folder");
    let cloud = frustum(folder.path(), 3.0);
    let before = folder.path().join("before");
    fs::create_dir(&before).expect("a folder");
    let before = frustum(&before, 1.0);
    let polygon = folder.path().join("polygon.csv");
    let corners = "x,y\n499993,4999994\n500007,4999994\n500007,5000006\n499993,5000006\n";
    fs::write(&polygon, corners).expect("it is written");
    for (base, expected) in [("0", 156.0), ("rim", 156.0), (text(&before), 156.0 - 52.0)] {
        let arguments = [
            "volume",
            text(&cloud),
            "--polygon",
            text(&polygon),
            "--base",
            base,
            "--format",
            "json",
        ];
        let found: Value = serde_json::from_str(&stdout_of(&arguments)).expect("JSON");
        assert!(
            (number(&found["fill"]) - expected).abs() < 1e-6,
            "{base}: {found}"
        );
        assert!(number(&found["cut"]).abs() < 1e-6, "{base}: {found}");
        assert!((number(&found["plan_area"]) - 168.0).abs() < 1e-9);
        // Four sides of 45 degrees over 100 - 16 in plan.
        let sloped = 168.0 + 84.0 * (2_f64.sqrt() - 1.0);
        assert!((number(&found["surface_area"]) - sloped).abs() < 1e-6);
        assert!((number(&found["covered"]) - 1.0).abs() < 1e-9);
    }
    // A base of another place is blamed, not the polygon.
    let elsewhere = folder.path().join("elsewhere.xyz");
    let beside = "500010 5000000 1\n500016 5000000 1\n500010 5000006 1\n500016 5000006 1\n";
    fs::write(&elsewhere, beside).expect("it is written");
    let [cloud_text, polygon_text] = [text(&cloud), text(&polygon)];
    let base = ["--base", text(&elsewhere)];
    let output = fragscale(&[
        "volume",
        cloud_text,
        "--polygon",
        polygon_text,
        base[0],
        base[1],
    ]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("elsewhere.xyz: it lies beside the polygon"),
        "{said}"
    );
    // Half of it lies beside the cloud: that is said, and not counted.
    let output = fragscale(&[
        "volume",
        text(&cloud),
        "--polygon",
        "500000,4999990;500020,4999990;500020,5000010;500000,5000010",
        "--base",
        "0",
    ]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let warned = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("78.0000 cubic units of the file"), "{said}");
    assert!(said.contains("covered by the surface  50.0 %"), "{said}");
    assert!(
        warned.contains("50.0 % of the polygon is a hole of the surface"),
        "{warned}"
    );
}

#[test]
fn what_cannot_be_measured_is_one_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let cloud = frustum(folder.path(), 3.0);
    for (arguments, words) in [
        (
            vec!["profile", "--from", "0,0", "--to", "9,9"],
            "does not meet the surface",
        ),
        (vec!["profile", "--from", "0,0", "--to", "0,0"], "no length"),
        (
            vec!["volume", "--polygon", "0,0;1,0;1,1", "--base", "0"],
            "beside the surface",
        ),
        // Over the plane of a rim, too, of which nothing lies on it.
        (
            vec!["volume", "--polygon", "0,0;1,0;1,1"],
            "beside the surface",
        ),
        (
            vec!["volume", "--polygon", "0,0;2,2;2,0;0,2"],
            "cross or touch",
        ),
        (
            vec!["volume", "--polygon", "0,0;1,x;1,1"],
            "'1,x' is no place",
        ),
        (
            vec!["volume", "--polygon", "no-such-file.csv"],
            "no-such-file.csv",
        ),
    ] {
        let mut all = vec![arguments[0], text(&cloud)];
        all.extend(&arguments[1..]);
        let output = fragscale(&all);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{all:?}: {said}");
        assert!(said.contains(words), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

/// The triangles of a PLY file that fragscale wrote, without its reader: binary, little endian.
fn triangles(path: &Path) -> Vec<[[f64; 3]; 3]> {
    let bytes = fs::read(path).expect("a mesh");
    let end = bytes
        .windows(11)
        .position(|w| w == b"end_header\n")
        .expect("a header")
        + 11;
    let header = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let count = |element: &str| -> usize {
        let line = header
            .lines()
            .find_map(|line| line.strip_prefix(&format!("element {element} ")));
        line.expect("an element").parse().expect("a count")
    };
    let properties = header
        .lines()
        .take_while(|line| !line.starts_with("element face"));
    let kinds: Vec<&str> = (properties.filter_map(|line| line.strip_prefix("property ")))
        .map(|line| line.split(' ').next().expect("a type"))
        .collect();
    let size = |kind: &str| match kind {
        "double" => 8,
        "float" => 4,
        _ => 1,
    };
    let stride: usize = kinds.iter().map(|kind| size(kind)).sum();
    let vertices: Vec<[f64; 3]> = (0..count("vertex"))
        .map(|vertex| {
            let at = end + vertex * stride;
            [0, 1, 2].map(|axis| {
                let at = at + axis * size(kinds[axis]);
                match kinds[axis] {
                    "double" => f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()),
                    _ => f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())),
                }
            })
        })
        .collect();
    let mut at = end + vertices.len() * stride;
    (0..count("face"))
        .map(|_| {
            assert_eq!(bytes[at], 3);
            let corners = [0, 1, 2].map(|corner| {
                let at = at + 1 + corner * 4;
                vertices[u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize]
            });
            at += 13;
            corners
        })
        .collect()
}

/// The simulated pile's true mesh: its volume over the floor by the divergence theorem over the file's
/// own triangles, summed here. It is made of closed bodies, so it is the volume of the rock without the
/// voids between; the bundled cloud is seen from above and has them in it.
#[test]
fn the_simulated_piles_truth() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = folder.path().join("lab");
    stdout_of(&[
        "sample",
        text(&made),
        "--surface",
        "mesh",
        "--no-photos",
        "--no-labels",
    ]);
    let mesh = made.join("pile.ply");
    let triangles = triangles(&mesh);
    assert!(triangles.len() > 1000, "{}", triangles.len());
    let all = || triangles.iter().flatten();
    let low = [0, 1].map(|axis| all().fold(f64::INFINITY, |low, p| low.min(p[axis])));
    let high = [0, 1].map(|axis| all().fold(f64::NEG_INFINITY, |high, p| high.max(p[axis])));
    let base = all().fold(f64::INFINITY, |low, p| low.min(p[2])) - 1.0;
    let (mut volume, mut along) = (0.0, 0.0);
    for [a, b, c] in &triangles {
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|axis| p[axis] - a[axis]));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        volume += normal[2] / 2.0 * ((a[2] + b[2] + c[2]) / 3.0 - base);
        along += normal.iter().map(|n| n * n).sum::<f64>().sqrt() / 2.0;
    }
    let [w, s, e, n] = [low[0] - 1.0, low[1] - 1.0, high[0] + 1.0, high[1] + 1.0];
    let polygon = format!("{w},{s};{e},{s};{e},{n};{w},{n}");
    let base = base.to_string();
    let flight = made.join("flight.toml");
    let measure = |polygon: &str, base: &str, flight: &Path| -> Value {
        let base = format!("--base={base}");
        let polygon = format!("--polygon={polygon}");
        let arguments = ["volume", text(flight), &polygon, &base, "--format", "json"];
        serde_json::from_str(&stdout_of(&arguments)).expect("JSON")
    };
    let found = measure(&polygon, &base, &flight);
    assert_eq!(found["unit"], "m");
    let off = number(&found["fill"]) / volume - 1.0;
    assert!(off.abs() < 1e-6, "{off}: {found}");
    let off = number(&found["surface_area"]) / along - 1.0;
    assert!(off.abs() < 1e-6, "{off}: {found}");
    // The bundled flight's cloud says its unit, its part beside the cloud, and a volume of that order.
    let bundled = bundled().join("flight.toml");
    let square = "-0.6,-0.6;0.6,-0.6;0.6,0.6;-0.6,0.6";
    let cloud = measure(square, "0", &bundled);
    assert_eq!(
        (&cloud["unit"], &cloud["overhang"]),
        (&Value::from("m"), &Value::from(0.0))
    );
    assert!((number(&cloud["covered"]) - 1.0).abs() < 1e-9, "{cloud}");
    let mean = number(&cloud["net"]) / 1.44;
    assert!(mean > 0.0 && mean < number(&cloud["highest"]), "{cloud}");
}
