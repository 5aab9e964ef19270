//! Flights read in part against the same read whole, to the last bit: COPC, EPT, LAZ and LAS of the bundled pile, by
//! itself (whose photos look over its rim) and laid side by side.

use std::fs;
use std::path::{Path, PathBuf};

use fragscale_test_data::copc::{CopcWriter, Cube, Node, octree};
use fragscale_test_data::repository;
use glam::DVec3;

use super::*;
use crate::fault::Fault;
use crate::formats::read_cloud;
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::{OpenOptions, Opened, open_flight, with_flight};

/// Metres of a step.
const SCALE: f64 = 1e-5;

fn flight() -> PathBuf {
    repository().join("assets/sample/flight.toml")
}

/// The bundled pile `side` times side by side each way, every `every`th point from `seed` on, in steps.
fn pile(side: i32, every: usize, seed: usize) -> Vec<[i32; 3]> {
    let path = repository().join("assets/sample/pile.ply");
    let points = read_cloud(&path, &Progress::default())
        .unwrap()
        .cloud
        .points;
    let size = Bounds::of(&points).unwrap().size();
    let mut all = Vec::new();
    for row in 0..side {
        for column in 0..side {
            let tile = DVec3::new(f64::from(column - side / 2), f64::from(row - side / 2), 0.0);
            let moved = points
                .iter()
                .skip(seed)
                .step_by(every)
                .map(|p| *p + tile * size);
            all.extend(moved.map(|p| (p / SCALE).round().to_array().map(|step| step as i32)));
        }
    }
    // As the writer of an octree wants them: from all over the place.
    let count = all.len();
    (0..count).map(|index| all[index * 7919 % count]).collect()
}

fn world(point: &[i32; 3]) -> DVec3 {
    DVec3::from(point.map(f64::from)) * SCALE
}

fn las(path: &Path, points: &[[i32; 3]]) {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(6).unwrap();
    builder.point_format.is_compressed = path.extension().is_some_and(|ending| ending == "laz");
    let axis = las::Transform {
        scale: SCALE,
        offset: 0.0,
    };
    builder.transforms = las::Vector {
        x: axis,
        y: axis,
        z: axis,
    };
    let mut writer = las::Writer::from_path(path, builder.into_header().unwrap()).unwrap();
    for point in points {
        let DVec3 { x, y, z } = world(point);
        let point = las::Point {
            x,
            y,
            z,
            gps_time: Some(0.0),
            ..las::Point::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
}

fn cube(points: &[[i32; 3]]) -> Cube {
    let places: Vec<DVec3> = points.iter().map(world).collect();
    let bounds = Bounds::of(&places).unwrap();
    Cube {
        low: (bounds.min - 0.01).to_array(),
        side: bounds.size().max_element() + 0.02,
    }
}

fn nodes(points: &[[i32; 3]]) -> Vec<Node> {
    octree(points.to_vec(), SCALE, cube(points), 6000)
}

fn copc(path: &Path, points: &[[i32; 3]]) {
    let mut writer = CopcWriter::create(path, SCALE, cube(points));
    writer.add(&nodes(points));
    writer.finish();
}

/// The path of its `ept.json`.
fn ept(folder: &Path, points: &[[i32; 3]]) -> PathBuf {
    fs::create_dir_all(folder.join("ept-data")).unwrap();
    fs::create_dir_all(folder.join("ept-hierarchy")).unwrap();
    let mut counts = Vec::new();
    for ([level, x, y, z], points) in nodes(points) {
        let key = format!("{level}-{x}-{y}-{z}");
        counts.push(format!("\"{key}\": {}", points.len()));
        las(&folder.join(format!("ept-data/{key}.laz")), &points);
    }
    let hierarchy = format!("{{{}}}", counts.join(","));
    fs::write(folder.join("ept-hierarchy/0-0-0-0.json"), hierarchy).unwrap();
    let Cube { low, side } = cube(points);
    let places: Vec<DVec3> = points.iter().map(world).collect();
    let around = Bounds::of(&places).unwrap();
    let numbers = |min: DVec3, max: DVec3| {
        let all = min.to_array().into_iter().chain(max.to_array());
        all.map(|number| number.to_string())
            .collect::<Vec<_>>()
            .join(",")
    };
    let low = DVec3::from(low);
    let header = format!(
        "{{\"bounds\": [{}], \"boundsConforming\": [{}], \"dataType\": \"laszip\", \"hierarchyType\": \"json\", \"points\": {}, \"version\": \"1.0.0\"}}",
        numbers(low, low + side),
        numbers(around.min, around.max),
        points.len()
    );
    let path = folder.join("ept.json");
    fs::write(&path, header).unwrap();
    path
}

/// All that is computed of a flight's photos, with all digits.
fn numbers(opened: &Opened) -> Result<String, String> {
    let progress = Progress::default();
    let said = |fault: Fault| fault.to_string();
    let flight = &opened.flight;
    let outcomes = flight.scales(&progress).map_err(said)?;
    let views = flight.views(&outcomes, &progress).map_err(said)?;
    let fields = flight.fields(&outcomes, &progress).map_err(said)?;
    Ok(format!(
        "{outcomes:?}\n{views:?}\n{fields:?}\n{:?}\n{:?}",
        flight.placement(),
        opened.looked_up
    ))
}

/// Compares the part with the whole; which of them was in part, and its warnings.
fn compare(surface: &Path) -> Vec<String> {
    let options = OpenOptions {
        surface: Some(surface.to_owned()),
        ..OpenOptions::default()
    };
    let progress = Progress::default();
    let whole = open_flight(&flight(), &options, &progress).unwrap();
    let memory = Memory {
        most: 1 << 40,
        always_in_part: true,
    };
    let mut times = 0;
    let (part, found) = with_flight(&flight(), &options, memory, &progress, |opened| {
        times += 1;
        numbers(opened)
    })
    .unwrap();
    assert!(
        part.flight.parts().surface.is_part() && times < 12,
        "{times} times"
    );
    let expected = numbers(&whole).unwrap();
    assert!(expected.contains("OnSurface"));
    for (found, expected) in found.lines().zip(expected.lines()) {
        let same = found
            .bytes()
            .zip(expected.bytes())
            .take_while(|(a, b)| a == b)
            .count();
        let from = same.saturating_sub(100);
        let around = |text: &str| {
            text.get(from..text.len().min(same + 100))
                .map(str::to_owned)
        };
        assert!(
            found == expected,
            "{}: {:?} and not {:?}",
            surface.display(),
            around(found),
            around(expected)
        );
    }
    assert_eq!(part.warnings, whole.warnings);
    part.warnings
}

#[test]
fn a_pile_whose_rim_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let points = pile(1, 1, 0);
    let path = folder.path().join("pile.laz");
    las(&path, &points);
    compare(&path);
}

#[test]
fn piles_side_by_side_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 0..2 {
        let points = pile(3, 2, seed);
        for name in ["pile.las", "pile.laz"] {
            let path = folder.path().join(name);
            las(&path, &points);
            compare(&path);
        }
        let path = folder.path().join("pile.copc.laz");
        copc(&path, &points);
        compare(&path);
        compare(&ept(&folder.path().join(format!("ept{seed}")), &points));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pile.copc.laz");
    copc(&path, &pile(1, 1, 0));
    let options = OpenOptions {
        surface: Some(path),
        ..OpenOptions::default()
    };
    let memory = Memory {
        most: 1_000_000,
        always_in_part: false,
    };
    let refused = with_flight(&flight(), &options, memory, &Progress::default(), numbers);
    let error = refused.unwrap_err();
    assert!(
        error.contains("pile.copc.laz: what its photos see needs all of its")
            && error.contains("1 MB may be used"),
        "{error}"
    );
    assert!(!error.contains('\n'));
}

/// A header that states too small a box: whoever believed it would get other numbers.
#[test]
fn a_box_that_does_not_hold_the_points_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pile.copc.laz");
    copc(&path, &pile(1, 1, 0));
    let mut bytes = fs::read(&path).unwrap();
    // The greatest x of the header.
    let greatest = f64::from_le_bytes(bytes[179..187].try_into().unwrap());
    bytes[179..187].copy_from_slice(&(greatest - 0.5).to_le_bytes());
    fs::write(&path, bytes).unwrap();
    let options = OpenOptions {
        surface: Some(path),
        ..OpenOptions::default()
    };
    let memory = Memory {
        most: 1 << 40,
        always_in_part: true,
    };
    let refused = with_flight(&flight(), &options, memory, &Progress::default(), numbers);
    assert!(
        refused
            .unwrap_err()
            .contains("outside of the box that it states")
    );
}
