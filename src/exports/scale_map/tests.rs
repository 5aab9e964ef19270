//! Over a floor and a slope every number is known by a formula; the files are read by the `tiff` crate's
//! decoder.

use std::io::Cursor;

use ::tiff::decoder::{Decoder, DecodingResult};
use ::tiff::tags::Tag;
use glam::{DVec2, DVec3};
use serde_json::Value;

use super::*;
use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{FieldGrid, ImageKind};
use crate::surface::{Cloud, Surface};

fn camera(distortion: Distortion) -> Camera {
    Camera {
        name: String::new(),
        width: 160,
        height: 90,
        fx: 125.0,
        fy: 80.0,
        cx: 81.0,
        cy: 44.0,
        skew: 0.0,
        distortion,
    }
}

/// The plane z = slope (y - y0) over a square around the middle; its right half cut off beyond `edge`.
fn plane(slope: f64, edge: f64) -> Surface {
    let corner = |x: f64, y: f64| DVec3::new(500_000.0 + x, 5_000_000.0 + y, 100.0 + slope * y);
    let corners = [(-90.0, -90.0), (edge, -90.0), (edge, 90.0), (-90.0, 90.0)];
    let points = corners.map(|(x, y)| corner(x, y)).to_vec();
    Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap()
}

fn field(camera: &Camera, pose: &Pose, image: ImageKind, surface: &Surface) -> ScaleField {
    let grid = FieldGrid::of_pixels(camera);
    ScaleField::compute(camera, pose, image, grid, surface, &Progress::default()).unwrap()
}

fn map(field: &ScaleField) -> ScaleMap<'_> {
    ScaleMap {
        field,
        flight: "Tr\u{e4}nke",
        photo: "IMG_1.jpg",
        unit: LengthUnit::Centimetre,
        world_unit: LengthUnit::Metre,
        crs: Some("EPSG:32633"),
    }
}

/// The pages of a file: values and description.
fn pages(bytes: &[u8]) -> Vec<(Vec<f32>, Value)> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).unwrap();
    let mut pages = Vec::new();
    loop {
        let mut image = DecodingResult::F32(Vec::new());
        decoder.read_image_to_buffer(&mut image).unwrap();
        let DecodingResult::F32(values) = image else {
            panic!("not 32-bit floats");
        };
        let text = decoder.get_tag_ascii_string(Tag::ImageDescription).unwrap();
        let program = decoder.get_tag_ascii_string(Tag::Software).unwrap();
        assert_eq!(program, concat!("fragscale ", env!("CARGO_PKG_VERSION")));
        let nothing = decoder.get_tag_ascii_string(Tag::GdalNodata).unwrap();
        assert_eq!(nothing, "nan");
        pages.push((values, serde_json::from_str(&text).unwrap()));
        if !decoder.more_images() {
            return pages;
        }
        decoder.next_image().unwrap();
    }
}

/// Straight down over a floor 10 m below: sqrt(125 * 80) / 10 = 10 px/m at every pixel.
#[test]
fn over_a_floor_every_pixel_has_the_scale_of_the_formula() {
    let camera = camera(Distortion::None);
    let center = DVec3::new(500_000.25, 5_000_000.5, 110.0);
    let pose = Pose::from_tilt_pan(center, [90.0, 0.0]);
    // The floor ends 3.25 m east of the camera: where 125 x / 10 + 81 = 121.625.
    let floor = plane(0.0, 3.5);
    let field = field(&camera, &pose, ImageKind::Undistorted, &floor);
    let layers = [
        MapLayer::Scale,
        MapLayer::Depth,
        MapLayer::X,
        MapLayer::Y,
        MapLayer::Z,
    ];
    let bytes = scale_map_tiff(&map(&field), &layers, &Progress::default()).unwrap();
    assert_eq!(
        &bytes[8..18],
        b"fragscale ",
        "the mark that files::marks looks for"
    );
    let pages = pages(&bytes);
    assert_eq!(pages.len(), 5);
    let origin = [500_000.0, 5_000_000.0, 100.0];
    for (layer, (values, description)) in layers.iter().zip(&pages) {
        assert_eq!(description["layer"], layer.name());
        assert_eq!(
            (
                description["width"].as_u64(),
                description["height"].as_u64()
            ),
            (Some(160), Some(90))
        );
        assert_eq!(description["photo"], "IMG_1.jpg");
        assert_eq!(description["flight"], "Tr\u{e4}nke");
        assert_eq!(description["image"], "undistorted");
        assert_eq!(description["world_unit"], "m");
        assert_eq!(description["crs"], "EPSG:32633");
        let is_coordinate = matches!(layer, MapLayer::X | MapLayer::Y | MapLayer::Z);
        assert_eq!(description["origin"].is_null(), !is_coordinate);
        assert_eq!(
            description["unit"],
            if *layer == MapLayer::Scale {
                "px/cm"
            } else {
                "m"
            }
        );
        for (place, value) in values.iter().enumerate() {
            let (u, v) = ((place % 160) as f64 + 0.5, (place / 160) as f64 + 0.5);
            if u > 121.625 {
                assert!(value.is_nan(), "{layer:?} at {u}, {v}: {value}");
                continue;
            }
            // Image down is south.
            let (x, y) = ((u - 81.0) / 125.0 * 10.0, -(v - 44.0) / 80.0 * 10.0);
            let expected = match layer {
                MapLayer::Scale => 0.1,
                MapLayer::Depth => 10.0,
                MapLayer::X => x + 0.25,
                MapLayer::Y => y + 0.5,
                MapLayer::Z => 0.0,
            };
            assert!(
                (f64::from(*value) - expected).abs() < 1e-6,
                "{layer:?} at {u}, {v}: {value}"
            );
        }
    }
    for (page, axis) in pages[2..].iter().zip(0..) {
        assert_eq!(page.1["origin"][axis].as_f64(), Some(origin[axis]));
    }
}

/// Every value is the field's own, rounded once, for the photo as shot too; over the plane n·X = h the
/// scale of the undistorted image is f n·d / h.
#[test]
fn over_a_slope_values_are_the_fields() {
    let lens = Distortion::Brown(Brown::new([-0.05, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    let camera = camera(lens);
    let slope = plane(0.3, 90.0);
    let center = DVec3::new(500_001.0, 5_000_002.0, 112.0);
    let pose = Pose::from_tilt_pan(center, [70.0, 25.0]);
    for image in [ImageKind::Undistorted, ImageKind::AsShot] {
        let field = field(&camera, &pose, image, &slope);
        let layers = [MapLayer::Scale];
        let bytes = scale_map_tiff(&map(&field), &layers, &Progress::default()).unwrap();
        let [(values, description)] = &pages(&bytes)[..] else {
            panic!("one page");
        };
        let said = description["image"].as_str().unwrap();
        let definition = description["definition"].as_str().unwrap();
        let normal = DVec3::new(0.0, -0.3, 1.0);
        let in_camera = pose.rotation.transpose() * normal;
        let h = -normal.dot(center - DVec3::new(500_000.0, 5_000_000.0, 100.0));
        for (place, value) in values.iter().enumerate() {
            let (column, row) = ((place % 160) as u32, (place / 160) as u32);
            let scale = field.scale_at(column, row).unwrap();
            assert_eq!(*value, (scale * 0.01) as f32);
            if image == ImageKind::Undistorted {
                let pixel = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let d = camera.direction_undistorted(pixel);
                let known = 1e4_f64.sqrt() * in_camera.dot(d) / h * 0.01;
                assert!((f64::from(*value) / known - 1.0).abs() < 1e-6);
            }
        }
        match image {
            ImageKind::Undistorted => {
                assert!(said == "undistorted" && !definition.contains("det J"))
            }
            ImageKind::AsShot => assert!(said == "as-shot" && definition.contains("det J")),
        }
    }
}

#[test]
fn no_layer_and_too_much_are_refused() {
    let camera = camera(Distortion::None);
    let pose = Pose::from_tilt_pan(DVec3::new(500_000.0, 5_000_000.0, 110.0), [90.0, 0.0]);
    let field = field(&camera, &pose, ImageKind::Undistorted, &plane(0.0, 90.0));
    let refused = |layers: &[MapLayer]| -> Fault {
        scale_map_tiff(&map(&field), layers, &Progress::default()).unwrap_err()
    };
    assert!(refused(&[]).what.contains("no layer"));
    let fault = refused(&[MapLayer::X; 40_000]);
    assert!(fault.what.contains("more than 500 million"), "{fault}");
}

/// The slope is steep to the north, so scales fall from the image's bottom to its top; in the picture
/// colours do, and the legend names px/cm (which only its width can tell here).
#[test]
fn the_picture_has_the_colours_of_the_scales() {
    let camera = camera(Distortion::None);
    let pose = Pose::from_tilt_pan(DVec3::new(500_000.0, 5_000_000.0, 110.0), [70.0, 0.0]);
    let field = field(&camera, &pose, ImageKind::Undistorted, &plane(0.0, 90.0));
    let bytes = scale_map_png(&map(&field)).unwrap();
    let picture = image::load_from_memory(&bytes).unwrap().to_rgb8();
    assert!(picture.width() > 200 && picture.height() >= 90);
    let [first, last] = [crate::picture::viridis(0.0), crate::picture::viridis(1.0)];
    assert_eq!(picture.get_pixel(80, 0).0, first);
    assert_eq!(picture.get_pixel(80, 89).0, last);
}
