//! The red spheres of the sample flight, whose places the simulator knows: traced, they give the scale
//! that they should.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fragscale::camera::Camera;
use fragscale::flight::{ComparedObject, Flight, Limits, Photo, Review, ScaleObject};
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, open_flight};
use fragscale::scale::{ImageKind, ScaleObjectKind, Traced};
use glam::{DVec2, DVec3};
use image::RgbImage;

/// Of every sphere in the sample, metres.
const DIAMETER: f64 = 0.06;

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample")
}

/// The flight with its scales, and the centres of its spheres.
fn flight() -> (Arc<Flight>, Review, Vec<DVec3>) {
    let progress = Progress::default();
    let opened = open_flight(&sample(), &OpenOptions::default(), &progress).expect("opens");
    let limits = Limits::default();
    let review = Review::of_scales(opened.flight.clone(), opened.looked_up, &limits, &progress);
    let mut review = review.expect("scales");
    review.compute_fields(&progress).expect("fields");
    let truth = fs::read_to_string(sample().join("truth.json")).expect("truth");
    let truth: serde_json::Value = serde_json::from_str(&truth).expect("JSON");
    let spheres = truth["spheres"].as_array().expect("spheres").iter();
    let centers = spheres.map(|sphere| {
        assert_eq!(sphere["diameter"], DIAMETER);
        let at = |axis: usize| sphere["center"][axis].as_f64().expect("a number");
        DVec3::new(at(0), at(1), at(2))
    });
    (opened.flight, review, centers.collect())
}

/// The sphere nearest to the middle of a photo, in camera axes.
fn sphere_of(photo: &Photo, camera: &Camera, centers: &[DVec3]) -> DVec3 {
    let middle = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
    let seen = centers.iter().filter_map(|center| {
        let center = photo.pose.camera_from_world(*center);
        Some(((camera.pixel_as_shot(center)? - middle).length(), center))
    });
    let nearest = seen.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.expect("a sphere").1
}

/// The circle where tangents from the camera touch the sphere, through the lens.
fn true_outline(camera: &Camera, center: DVec3, points: u32) -> Vec<DVec2> {
    let share = (DIAMETER / 2.0).powi(2) / center.length_squared();
    let (along, across) = center.normalize().any_orthonormal_pair();
    let radius = DIAMETER / 2.0 * (1.0 - share).sqrt();
    let point = |point: u32| {
        let turn = std::f64::consts::TAU * f64::from(point) / f64::from(points);
        let way = (along * turn.cos() + across * turn.sin()) * radius;
        camera
            .pixel_as_shot(center * (1.0 - share) + way)
            .expect("in the photo")
    };
    (0..points).map(point).collect()
}

fn compared(review: &Review, photo: &Photo, outline: Vec<DVec2>) -> ComparedObject {
    let object = ScaleObject {
        photo: photo.name.clone(),
        kind: ScaleObjectKind::Sphere,
        size: DIAMETER,
        outline,
        mask: true,
    };
    let compared = review.compare_objects(&[object]).expect("a surface");
    compared.into_iter().next().expect("one")
}

/// Focal length over the true depth, to 1e-9; and on which side of it the point cloud's scales lie.
#[test]
fn a_traced_sphere_gives_the_true_scale_at_its_place() {
    let (flight, review, centers) = flight();
    for photo in &flight.parts().photos {
        let camera = flight.camera(photo);
        let center = sphere_of(photo, camera, &centers);
        let outline = true_outline(camera, center, 11);
        let compared = compared(&review, photo, outline);
        let Ok(Traced::Sphere(sphere)) = &compared.traced else {
            panic!("{}: {compared:?}", photo.name);
        };
        assert!((sphere.center - center).length() / center.length() < 1e-9);
        let scale = compared.scale.expect("a scale");
        assert!((scale * center.z / camera.fx - 1.0).abs() < 1e-9);
        // The cloud shows the sphere: the ray to its centre meets its near side, or, where points are
        // few, what lies between it and the ground; 2 % for the cloud's noise.
        let near = camera.fx / (center.z * (1.0 - DIAMETER / 2.0 / center.length()));
        let under = compared.place.on_surface.expect("a scale");
        assert!(
            (scale..near * 1.02).contains(&under),
            "{}: {under} for {near}",
            photo.name
        );
        // The spheres lie on the pile, so the rock around them and at its edges is further away than
        // their centres: with their scale fragments would come out too small in every photo.
        let around = compared.beyond_surroundings().expect("a scale");
        assert!((0.0..0.2).contains(&around), "{}: {around}", photo.name);
        let off = compared.beyond_edges().expect("a scale");
        assert!((0.0..0.3).contains(&off), "{}: {off}", photo.name);
        println!(
            "{}: object {scale:.1} px/m, row {:+.2} %, around it {:+.2} %, under it {:+.2} %",
            photo.name,
            off * 100.0,
            around * 100.0,
            compared.beyond_surface().expect("a scale") * 100.0
        );
    }
}

/// The photos themselves: the edge of what is red, found pixel by pixel, is an outline as a careful
/// hand traces it. Fines hide the sphere's foot, and pixels are mixed at the edge.
#[test]
fn the_spheres_in_the_photos_are_where_the_simulator_put_them() {
    let (flight, review, centers) = flight();
    for photo in &flight.parts().photos {
        let camera = flight.camera(photo);
        let center = sphere_of(photo, camera, &centers);
        let image = image::open(sample().join("photos").join(&photo.name)).expect("a photo");
        let outline = red_edge(
            &image.to_rgb8(),
            camera.pixel_as_shot(center).expect("seen"),
        );
        let compared = compared(&review, photo, outline);
        let Ok(Traced::Sphere(sphere)) = &compared.traced else {
            panic!("{}: {compared:?}", photo.name);
        };
        let off = compared.scale.expect("a scale") * center.z / camera.fx - 1.0;
        println!(
            "{}: {:+.2} %, {:.2} px off",
            photo.name,
            off * 100.0,
            sphere.rms
        );
        assert!(off.abs() < 0.02, "{}: {off}", photo.name);
    }
}

/// From the middle outwards in 24 directions: where red ends for good. Of these the two thirds that
/// reach furthest, because what hides the sphere brings its edge nearer.
fn red_edge(image: &RgbImage, middle: DVec2) -> Vec<DVec2> {
    let is_red = |place: DVec2| {
        let [r, g, b] = image
            .get_pixel(place.x as u32, place.y as u32)
            .0
            .map(f64::from);
        r > 2.0 * g && r > 2.0 * b && r > 50.0
    };
    let mut edges: Vec<(f64, DVec2)> = (0..24)
        .map(|i| {
            let way = DVec2::from_angle(f64::from(i) / 24.0 * std::f64::consts::TAU);
            let steps = (0..1000).map(|step| f64::from(step) * 0.1);
            let last = steps.rev().find(|&far| is_red(middle + way * far));
            let far = last.expect("red") + 0.05;
            (far, middle + way * far)
        })
        .collect();
    edges.sort_by(|a, b| b.0.total_cmp(&a.0));
    edges.truncate(16);
    edges.into_iter().map(|(_, place)| place).collect()
}

/// As shot and undistorted the sphere is the same, and each image has its own scale there.
#[test]
fn the_scale_is_that_of_the_image_asked_for() {
    let (flight, _, centers) = flight();
    let photo = &flight.parts().photos[0];
    let camera = flight.camera(photo);
    let center = sphere_of(photo, camera, &centers);
    let outline = true_outline(camera, center, 8);
    let traced = Traced::new(camera, ScaleObjectKind::Sphere, DIAMETER, &outline).expect("fits");
    for image in [ImageKind::Undistorted, ImageKind::AsShot] {
        // Two points a millimetre apart, seen in the image.
        let step = DVec3::X * 0.0005;
        let pixels = [center - step, center + step].map(|p| image.pixel(camera, p).expect("seen"));
        let measured = (pixels[1] - pixels[0]).length() / 0.001;
        let scale = traced.scale(camera, image).expect("a scale");
        assert!(
            (scale / measured - 1.0).abs() < 1e-5,
            "{scale} for {measured}"
        );
    }
}

/// The command says the same of a flight.toml with a scale object, in the unit that is asked for.
#[test]
fn the_command_has_scale_objects_beside_the_scales() {
    let (flight, _, centers) = flight();
    let photo = &flight.parts().photos[1];
    let camera = flight.camera(photo);
    let center = sphere_of(photo, camera, &centers);
    let outline: Vec<[f64; 2]> = true_outline(camera, center, 9)
        .iter()
        .map(DVec2::to_array)
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["flight.toml", "pile.ply", "ost.yaml", "poses.csv"] {
        fs::copy(sample().join(name), folder.path().join(name)).expect("a copy");
    }
    let toml = folder.path().join("flight.toml");
    // The photos stay where they are.
    let text = fs::read_to_string(&toml).expect("the flight");
    fs::write(&toml, text.replace("folder = \"photos\"\n", "")).expect("written");
    let plain = crate::common::scales_json(folder.path(), &["--unit", "in"]);
    let text = fs::read_to_string(&toml).expect("the flight");
    let object = format!(
        "\n[[scale_object]]\nphoto = \"{}\"\nkind = \"sphere\"\nsize = {DIAMETER}\noutline = {outline:?}\n",
        photo.name
    );
    fs::write(&toml, text + &object).expect("written");
    let mut with = crate::common::scales_json(folder.path(), &["--unit", "in"]);
    let found = with["photos"][1]["scale_objects"][0].take();
    let scale = found["scale"].as_f64().expect("a scale");
    // 0.0254 m are an inch.
    assert!((scale * center.z / camera.fx / 0.0254 - 1.0).abs() < 1e-9);
    assert_eq!(found["kind"], "sphere");
    assert!(found["rms_px"].as_f64().expect("a number") < 1e-6);
    // What goes to Split-Desktop is the line's.
    let edge = |name: &str| {
        plain["photos"][1]["fitted"][name]
            .as_f64()
            .expect("a scale")
    };
    let share = camera.pixel_undistorted(center).expect("seen").y / 720.0;
    let on_row = edge("top") + (edge("bottom") - edge("top")) * share;
    let found_on_row = found["point_cloud"]["on_row"].as_f64().expect("a scale");
    assert!((found_on_row / on_row - 1.0).abs() < 1e-9);
    // Nothing else is another than without it.
    for photo in with["photos"].as_array_mut().expect("photos") {
        photo
            .as_object_mut()
            .expect("a photo")
            .remove("scale_objects");
    }
    assert_eq!(with, plain);
}

/// On its row an object is held against the scales that go to Split-Desktop: here the best line's, linear from edge to edge.
#[test]
fn the_row_is_that_of_the_pair_in_use() {
    let (flight, review, centers) = flight();
    let photo = &flight.parts().photos[4];
    let camera = flight.camera(photo);
    let outline = true_outline(camera, sphere_of(photo, camera, &centers), 12);
    let found = compared(&review, photo, outline).place.between_edges;
    let line = review
        .photo(4)
        .expect("a photo")
        .field
        .and_then(|field| field.fitted);
    let line = line.expect("a line");
    let of_corners = review.outcomes()[4].scale().expect("a scale").scale;
    let found = found.expect("a scale");
    let share = (found - line.top) / (line.bottom - line.top);
    assert!((0.0..1.0).contains(&share), "{share}");
    // The corners' line is another one.
    let corners = [of_corners.top, of_corners.bottom].map(|scale| scale.expect("a scale"));
    let of_corners = corners[0] + (corners[1] - corners[0]) * share;
    assert!(
        (of_corners / found - 1.0).abs() > 0.02,
        "{of_corners} {found}"
    );
    // The middle of the outline, rows from the top edge.
    let row = found_row(camera, sphere_of(photo, camera, &centers));
    let expected = line.top + (line.bottom - line.top) * row / f64::from(camera.height);
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
}

/// The row of the image without distortion in which the middle of a sphere lies.
fn found_row(camera: &Camera, center: DVec3) -> f64 {
    camera.cy + camera.fy * center.y / center.z
}
