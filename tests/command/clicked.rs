//! Points that are marked in the photos of a simulated flight, whose poses, lens and rock are known.

use std::path::Path;

use fragscale::control::{ControlList, ControlPoint, ScaleBar};
use fragscale::flight::{Flight, FlightFile, FlightSettings, Placed};
use fragscale::geometry::Similarity;
use fragscale::jobs::Progress;
use fragscale::opening::{
    GeoreferenceRequest, OpenOptions, Opened, control_file, control_text, georeference,
    georeference_flight, open_flight,
};
use fragscale::scale::StatedErrors;
use fragscale::units::LengthUnit;
use glam::{DMat3, DVec2, DVec3, EulerRot};
use tempfile::TempDir;

use fragscale_test_data::shared_data;

use crate::common::stdout_of;

/// The lab with twelve photos around the pile, through a lens that bends.
fn simulated() -> (TempDir, Opened) {
    let folder = tempfile::tempdir().expect("a folder");
    let lab = folder.path().join("lab");
    let path = lab.to_str().expect("UTF-8");
    stdout_of(&[
        "sample",
        path,
        "--ring",
        "12",
        "--points",
        "4000",
        "--no-photos",
    ]);
    let opened = open(&lab.join("flight.toml"));
    (folder, opened)
}

fn open(path: &Path) -> Opened {
    open_flight(path, &OpenOptions::default(), &Progress::default()).expect("a flight")
}

/// From the lab, where the flight is, to a place in UTM 32N: turned, and in other units.
fn truth() -> Similarity {
    let rotation = DMat3::from_euler(EulerRot::ZYX, 2.1, 0.2, -0.7);
    Similarity::new(3.25, rotation, DVec3::new(435_250.5, 6_201_333.25, 412.0))
}

/// Where a photo as shot shows a point, inside its edges.
fn shown(flight: &Flight, photo: usize, point: DVec3) -> Option<DVec2> {
    let photo = &flight.parts().photos[photo];
    let camera = flight.camera(photo);
    let pixel = camera.pixel_as_shot(photo.pose.camera_from_world(point))?;
    camera.contains(pixel).then_some(pixel)
}

/// Points of the rock that four photos and more show, far from each other, with their true marks.
fn points(flight: &Flight, count: usize) -> Vec<(DVec3, ControlPoint)> {
    let vertices: Vec<DVec3> = flight.parts().surface.vertices().collect();
    let mut found: Vec<(DVec3, ControlPoint)> = Vec::new();
    let photos = &flight.parts().photos;
    for apart in [0.4, 0.2, 0.1] {
        for point in vertices.iter().step_by(7) {
            if found.len() == count {
                return found;
            }
            let marks: Vec<(String, DVec2)> = (0..photos.len())
                .filter_map(|photo| {
                    Some((photos[photo].name.clone(), shown(flight, photo, *point)?))
                })
                .collect();
            if marks.len() < 4
                || found
                    .iter()
                    .any(|(other, _)| other.distance(*point) < apart)
            {
                continue;
            }
            let name = format!("P{}", found.len() + 1);
            let position = Some(truth().apply(*point));
            found.push((
                *point,
                ControlPoint {
                    name,
                    position,
                    marks,
                },
            ));
        }
    }
    panic!("{} points only", found.len());
}

fn list(crs: Option<&str>, points: &[(DVec3, ControlPoint)]) -> ControlList {
    ControlList {
        crs: crs.map(str::to_owned),
        points: points.iter().map(|(_, point)| point.clone()).collect(),
        bars: Vec::new(),
    }
}

fn request(marked: ControlList) -> GeoreferenceRequest {
    GeoreferenceRequest {
        marked: Some(marked),
        ..GeoreferenceRequest::default()
    }
}

/// True marks give the known similarity back, to the rounding of coordinates of seven digits before the point.
#[test]
fn true_marks_give_the_known_similarity() {
    let (_folder, opened) = simulated();
    let flight = &opened.flight;
    let points = points(flight, 5);
    let file = Path::new("flight.toml");
    let local = truth();
    // In a local system coordinates are small, and so is their rounding.
    let near = Similarity::new(local.scale, local.rotation, DVec3::new(5.0, -6.0, 7.0));
    let mut nearby = points.clone();
    for (point, control) in &mut nearby {
        control.position = Some(near.apply(*point));
    }
    for (truth, list, relative) in [
        (near, list(None, &nearby), 1e-9),
        (local, list(Some("EPSG:32632"), &points), 1e-9),
    ] {
        let found = georeference_flight(file, flight, &request(list)).unwrap();
        let off = (found.similarity.scale / truth.scale - 1.0).abs();
        assert!(off < relative, "scale {off:e}");
        let turned = found.similarity.rotation.transpose() * truth.rotation;
        let angle = (turned - DMat3::IDENTITY).to_cols_array();
        assert!(
            angle.iter().all(|entry| entry.abs() < relative),
            "{angle:?}"
        );
        // The pile is two metres wide.
        let extent = truth.scale * 2.0;
        for (point, _) in &points {
            let off = found.similarity.apply(*point).distance(truth.apply(*point));
            assert!(off < relative * extent, "{off:e}");
        }
        assert_eq!(found.used(), 5);
    }
}

/// A model of a package that does not say how sure its poses are: clicked points bring it to the world with the same errors
/// as a list of where its cameras are does.
#[test]
fn the_errors_of_a_model_are_those_of_the_command() {
    let Some(colmap) = shared_data("sceaux-colmap/bin") else {
        return;
    };
    let opened = open(&colmap);
    let flight = &opened.flight;
    let behind = &opened.reconstruction.as_ref().expect("a model").path;
    let marked = list(Some("EPSG:32632"), &points(flight, 5));
    let mut clicked = georeference_flight(&colmap, flight, &request(marked)).unwrap();
    assert_eq!(clicked.errors_in_words(), None);
    let photos = shared_data("sceaux-images");
    let progress = Progress::default();
    clicked
        .look_up_errors(flight, behind, photos.as_deref(), &progress)
        .unwrap();
    let folder = tempfile::tempdir().expect("a folder");
    let centers = folder.path().join("centers.csv");
    let mut text = "# crs: EPSG:32632\nphoto,x,y,z\n".to_owned();
    for photo in &flight.parts().photos {
        let DVec3 { x, y, z } = truth().apply(photo.pose.center);
        text += &format!("{},{x:?},{y:?},{z:?}\n", photo.name);
    }
    std::fs::write(&centers, text).expect("written");
    let listed = GeoreferenceRequest {
        positions: Some(centers),
        photos,
        ..GeoreferenceRequest::default()
    };
    let listed = georeference(&colmap, &listed, &progress).unwrap();
    let [clicked, listed] = [clicked, listed].map(|found| found.errors);
    let axes = |errors: StatedErrors| {
        let [position, angle] = [errors.pose.position, errors.pose.angle].map(Option::unwrap);
        [position, angle, DVec3::splat(errors.focal.unwrap())]
    };
    for (one, other) in axes(clicked).into_iter().zip(axes(listed)) {
        assert!(
            (one / other - 1.0).abs().max_element() < 1e-3,
            "{one} {other}"
        );
    }
}

/// A mark 50 px off, and the point and the photo are named.
#[test]
fn a_wrong_mark_is_named() {
    let (_folder, opened) = simulated();
    let mut points = points(&opened.flight, 6);
    points[1].1.marks[2].1 += DVec2::new(30.0, -40.0);
    let photo = points[1].1.marks[2].0.clone();
    let list = list(Some("EPSG:32632"), &points);
    let found = georeference_flight(Path::new("f"), &opened.flight, &request(list)).unwrap();
    let named = format!("'P2': its mark in '{photo}' is probably on another thing");
    let said: Vec<&String> = (found.warnings.iter())
        .filter(|warning| warning.contains("another thing"))
        .collect();
    assert!(
        said.len() == 1 && said[0].contains(&named),
        "{:?}",
        found.warnings
    );
    let px = |name: &str| {
        let of = found
            .positions
            .iter()
            .find(|position| position.name == name);
        of.unwrap().marks_px.unwrap()
    };
    assert!(px("P2") > 10.0 && px("P1") < 1e-6 && px("P3") < 1e-6);
}

/// Scale bars alone give the unit and the scale; beside three surveyed points they are compared.
#[test]
fn scale_bars_give_the_scale_alone() {
    let (_folder, opened) = simulated();
    let points = points(&opened.flight, 4);
    let apart = points[0].0.distance(points[1].0) * truth().scale;
    let bar = |from: &str, to: &str, metres: f64| ScaleBar {
        ends: [from.to_owned(), to.to_owned()],
        length: metres / LengthUnit::Foot.metres(),
        unit: LengthUnit::Foot,
    };
    let mut clicked = list(None, &points);
    clicked.bars = vec![bar("P1", "P2", apart), bar("P1", "nobody", 1.0)];
    let both = request(clicked.clone());
    let found = georeference_flight(Path::new("f"), &opened.flight, &both).unwrap();
    assert_eq!((found.used(), found.lengths.len()), (4, 1));
    assert!((found.lengths[0].fitted / apart - 1.0).abs() < 1e-9);
    assert!(
        found
            .warnings
            .iter()
            .any(|warning| warning.contains("'nobody' is not marked"))
    );
    for point in &mut clicked.points[1..] {
        point.position = None;
    }
    let found =
        georeference_flight(Path::new("f"), &opened.flight, &request(clicked.clone())).unwrap();
    assert!((found.similarity.scale / truth().scale - 1.0).abs() < 1e-9);
    assert_eq!(
        (found.similarity.rotation, found.crs),
        (DMat3::IDENTITY, None)
    );
    // One surveyed point and no bar.
    clicked.bars.clear();
    let error = georeference_flight(Path::new("f"), &opened.flight, &request(clicked)).unwrap_err();
    assert!(
        error.fault.what.contains("1 known positions are too few"),
        "{error}"
    );
}

/// A flight that was placed opens in the world, surface and poses together, and reads back from its file.
#[test]
fn a_placed_flight_opens_in_the_world() {
    let (_folder, before) = simulated();
    let placed = Placed::then(None, &truth(), Some("EPSG:32632".to_owned()));
    let settings = FlightSettings {
        placed: Some(placed),
        control: list(Some("EPSG:32632"), &points(&before.flight, 3)),
        ..before.settings.clone()
    };
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("placed.toml");
    let text = before.origin.text_at(&target, &settings).unwrap();
    std::fs::write(&target, &text).unwrap();
    let photos: Vec<&str> = (before.flight.parts().photos.iter())
        .map(|photo| photo.name.as_str())
        .collect();
    std::fs::write(
        control_file(&target),
        control_text(&settings.control, &photos),
    )
    .unwrap();
    let after = open(&target);
    assert_eq!(after.settings, settings);
    assert_eq!(after.crs.as_deref(), Some("EPSG:32632"));
    let (old, new) = (before.flight.parts(), after.flight.parts());
    for (old, new) in old.photos.iter().zip(&new.photos) {
        assert!(truth().apply(old.pose.center).distance(new.pose.center) < 1e-8);
    }
    // Vertices are kept in an order that goes by their places.
    let middle = |flight: &Flight| {
        let vertices = flight.parts().surface.vertices();
        let count = vertices.len() as f64;
        vertices.sum::<DVec3>() / count
    };
    let off = truth()
        .apply(middle(&before.flight))
        .distance(middle(&after.flight));
    assert!(off < 1e-5, "{off}");
    // Taken back in the window, and saved again: as it was.
    let text = after.origin.text_at(&target, &before.settings).unwrap();
    assert_eq!(
        FlightFile::parse(&text).unwrap().settings(),
        before.settings
    );
    assert!(!text.contains("placed ="), "{text}");
}
