//! A chequerboard on a plane is photographed here by projecting it, and must come back with squares of
//! one size; what the files say is read by other decoders.

use std::collections::BTreeMap;
use std::io::Cursor;

use ::tiff::decoder::{Decoder, DecodingResult};
use ::tiff::tags::Tag;
use glam::{DVec2, DVec3};
use image::{Rgb, RgbaImage};
use serde_json::Value;

use super::*;
use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::jobs::Progress;
use crate::scale::{FieldGrid, ImageKind, PixelSize, ScaleField};
use crate::surface::{Cloud, Surface};

const MIDDLE: DVec3 = DVec3::new(500_000.0, 5_000_000.0, 100.0);

/// The side of a square of the board, world units.
const SQUARE: f64 = 1.0;

fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 640,
        height: 480,
        fx: 530.0,
        fy: 520.0,
        cx: 324.0,
        cy: 237.0,
        skew: 0.0,
        distortion: Distortion::Brown(Brown::new([
            -0.11, 0.03, 0.001, -0.0007, 0.0, 0.0, 0.0, 0.0,
        ])),
    }
}

/// A plane through MIDDLE with two axes that are square to each other.
struct Board {
    right: DVec3,
    up: DVec3,
}

impl Board {
    fn tilted(normal: DVec3) -> Self {
        let normal = normal.normalize();
        let right = DVec3::Y.cross(normal).normalize();
        Self {
            right,
            up: normal.cross(right),
        }
    }

    fn surface(&self) -> Surface {
        let corners = [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)];
        let points = corners.map(|(x, y)| MIDDLE + self.right * x + self.up * y);
        Surface::new(Cloud {
            points: points.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Cloud::default()
        })
        .unwrap()
    }

    /// Its photo: each pixel's ray meets the plane by hand, 8 x 8 times.
    fn photo(&self, camera: &Camera, pose: &Pose) -> RgbImage {
        let normal = self.right.cross(self.up);
        RgbImage::from_fn(camera.width, camera.height, |x, y| {
            let mut light = 0.0;
            for look in 0..64 {
                let (a, b) = (f64::from(look % 8), f64::from(look / 8));
                let pixel = DVec2::new(
                    f64::from(x) + (a + 0.5) / 8.0,
                    f64::from(y) + (b + 0.5) / 8.0,
                );
                let ray = pose.rotation * camera.direction_as_shot(pixel).unwrap();
                let far = normal.dot(MIDDLE - pose.center) / normal.dot(ray);
                let met = pose.center + ray * far - MIDDLE;
                let (u, v) = (self.right.dot(met) / SQUARE, self.up.dot(met) / SQUARE);
                let is_white = (u.floor() + v.floor()).rem_euclid(2.0) < 0.5;
                light += if is_white { 200.0 } else { 40.0 };
            }
            Rgb([(light / 64.0_f64).round() as u8; 3])
        })
    }
}

fn rectification(
    camera: &Camera,
    pose: &Pose,
    surface: &Surface,
    onto: Onto,
    pixel: f64,
) -> Rectification {
    let (grid, progress) = (FieldGrid::of_fit(camera), Progress::default());
    let kind = ImageKind::AsShot;
    let field = ScaleField::compute(camera, pose, kind, grid, surface, &progress).unwrap();
    let size = PixelSize {
        asked: Some(pixel),
        round_in: 0.01,
    };
    Rectification::new(&field, onto, size, surface, &progress).unwrap()
}

fn of<'a>(rectification: &'a Rectification, onto: Onto) -> RectifiedPhoto<'a> {
    RectifiedPhoto {
        rectification,
        onto,
        flight: "flight",
        photo: "a.jpg",
        unit: LengthUnit::Centimetre,
        world_unit: LengthUnit::Metre,
        crs: None,
    }
}

/// Where along a line (values at +0.5) the board changes. Found where grey passes the middle, then told by
/// how much of the light around it lies on which side, which no blur changes.
fn changes(line: &[Option<f64>], around: usize) -> Vec<f64> {
    let crossing = |place: &usize| {
        let (a, b) = (line[*place]?, line[*place + 1]?);
        ((a < 120.0) != (b < 120.0)).then_some(())
    };
    let places = (around..line.len().saturating_sub(around + 1)).filter(|p| crossing(p).is_some());
    let told = |place: usize| {
        let (from, to) = (place + 1 - around, place + 1 + around);
        let window: Option<Vec<f64>> = line[from..to].iter().copied().collect();
        let window = window?;
        let (left, right) = match window[0] > 120.0 {
            true => (200.0, 40.0),
            false => (40.0, 200.0),
        };
        let light: f64 = window.iter().map(|grey| grey - right).sum();
        Some(from as f64 + light / (left - right))
    };
    places.filter_map(told).collect()
}

/// Every edge of every square is where a square of that size has it: each line of the board to 0.1 pixels,
/// each single crossing of it too, but in pixels of the photo where the photo's are larger.
fn assert_squares(picture: &RgbaImage, rectification: &Rectification, board: &Board) {
    let raster = &rectification.raster;
    let grey = |x: u32, y: u32| {
        let pixel = picture.get_pixel(x, y).0;
        (pixel[3] == 255).then(|| f64::from(pixel[0]))
    };
    let around = ((SQUARE / raster.pixel * 0.4) as usize).min(8);
    let axes = [(raster.frame.right, true), (raster.frame.down, false)];
    for (axis, across) in axes {
        // The board's axis along it, and the other one.
        let (along, other) = match axis.dot(board.right).abs() > 0.5 {
            true => (board.right, board.up),
            false => (board.up, board.right),
        };
        assert!(
            axis.dot(along).abs() > 1.0 - 1e-9,
            "the board lies square in the picture"
        );
        let (lines, places) = match across {
            true => (raster.rows, raster.columns),
            false => (raster.columns, raster.rows),
        };
        let mut edges = 0;
        let mut of_board: BTreeMap<i32, Vec<f64>> = BTreeMap::new();
        for line in (lines / 6..lines * 5 / 6).step_by(3) {
            let at = |place: f64| match across {
                true => DVec2::new(place, f64::from(line) + 0.5),
                false => DVec2::new(f64::from(line) + 0.5, place),
            };
            // Not near an edge of the other direction, where both change.
            let beside = other.dot(raster.world_from_picture(at(0.0)) - MIDDLE) / SQUARE;
            if (beside - beside.round()).abs() < 0.15 {
                continue;
            }
            let values: Vec<Option<f64>> = (0..places)
                .map(|place| {
                    if across {
                        grey(place, line)
                    } else {
                        grey(line, place)
                    }
                })
                .collect();
            for change in changes(&values, around) {
                let on_board = along.dot(raster.world_from_picture(at(change)) - MIDDLE) / SQUARE;
                let off = (on_board - on_board.round()) * SQUARE / raster.pixel;
                // In pixels of the photo where those are larger.
                let source = |by: f64| rectification.source(at(change + by)).unwrap();
                let larger = 1.0 / (source(0.5) - source(-0.5)).length();
                let most = 0.1 * larger.max(1.0);
                assert!(off.abs() < most, "{off} px off at {change} of line {line}");
                of_board
                    .entry(on_board.round() as i32)
                    .or_default()
                    .push(off);
                edges += 1;
            }
        }
        assert!(edges > 500, "{edges} edges");
        for (edge, offs) in of_board {
            let mean = offs.iter().sum::<f64>() / offs.len() as f64;
            assert!(mean.abs() < 0.1, "{mean} px off along {edge}");
        }
    }
}

#[test]
fn a_chequerboard_comes_back_square() {
    let camera = camera();
    // A floor from a slant, along the map; a slope, seen up it so that the board lies square; larger
    // pixels than the photo's.
    let floor = Board::tilted(DVec3::Z);
    let slope = Board::tilted(DVec3::new(0.3, 0.0, 1.0));
    let oblique = Pose::from_tilt_pan(MIDDLE + DVec3::new(1.3, -9.0, 16.0), [60.0, 0.0]);
    // The slope falls to the east; the camera's right lies along its contour lines.
    let up_the_slope = Pose::from_tilt_pan(MIDDLE + DVec3::new(12.0, 0.4, 14.0), [58.0, -90.0]);
    let on_floor = [
        (Onto::HorizontalPlane, 0.03),
        (Onto::Surface, 0.03),
        (Onto::HorizontalPlane, 0.08),
        (Onto::FittedPlane, 0.03),
    ];
    let on_slope = [(Onto::FittedPlane, 0.03)];
    for (board, pose, cases) in [
        (&floor, oblique, &on_floor[..]),
        (&slope, up_the_slope, &on_slope),
    ] {
        let photo = board.photo(&camera, &pose);
        for &(onto, pixel) in cases {
            let surface = board.surface();
            let rectification = rectification(&camera, &pose, &surface, onto, pixel);
            let rectified = of(&rectification, onto);
            let bytes = rectified.bytes(&photo, RectifiedFormat::Png).unwrap();
            let picture = image::load_from_memory(&bytes).unwrap().to_rgba8();
            assert_squares(&picture, &rectification, board);
        }
    }
}

fn small() -> (Rectification, RgbImage) {
    let camera = camera();
    let board = Board::tilted(DVec3::Z);
    let pose = Pose::from_tilt_pan(MIDDLE + DVec3::new(0.5, 0.0, 12.0), [80.0, 0.0]);
    let rectification = rectification(
        &camera,
        &pose,
        &board.surface(),
        Onto::HorizontalPlane,
        0.05,
    );
    (
        rectification,
        RgbImage::from_pixel(640, 480, Rgb([90, 80, 70])),
    )
}

/// 5 cm a pixel: 20 pixels a metre, a fifth of a pixel a centimetre.
#[test]
fn a_png_says_how_large_its_pixels_are() {
    let (rectification, photo) = small();
    let rectified = of(&rectification, Onto::HorizontalPlane);
    let bytes = rectified.bytes(&photo, RectifiedFormat::Png).unwrap();
    let find = |kind: &[u8]| bytes.windows(4).position(|window| window == kind).unwrap();
    let at = find(b"pHYs") + 4;
    assert_eq!(bytes[at..at + 9], [0, 0, 0, 20, 0, 0, 0, 20, 1]);
    let exif = image::ImageReader::new(Cursor::new(&bytes))
        .with_guessed_format()
        .unwrap();
    let mut decoder = exif.into_decoder().unwrap();
    let exif = image::ImageDecoder::exif_metadata(&mut decoder)
        .unwrap()
        .unwrap();
    let (fields, _) = exif::parse_exif(&exif).unwrap();
    let field = |tag| fields.iter().find(|field| field.tag == tag).unwrap();
    for tag in [exif::Tag::XResolution, exif::Tag::YResolution] {
        match &field(tag).value {
            exif::Value::Rational(values) => assert_eq!((values[0].num, values[0].denom), (1, 5)),
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(field(exif::Tag::ResolutionUnit).value.get_uint(0), Some(3));
    // The mark by which it is known as ours, and what it says.
    assert!(bytes[33..].starts_with(b"\0\0\0\x12tEXtSoftware\0fragscale"));
    let at = find(b"Desc") + b"Description\0".len();
    let mut said = serde_json::Deserializer::from_slice(&bytes[at..]).into_iter::<Value>();
    let said = said.next().unwrap().unwrap();
    assert_eq!(
        (said["pixel"].as_f64(), said["unit"].as_str()),
        (Some(5.0), Some("cm"))
    );
    assert_eq!(
        said["rows"].as_u64(),
        Some(u64::from(rectification.raster.rows))
    );
    assert_eq!(
        (said["onto"].as_str(), said["photo"].as_str()),
        (Some("horizontal"), Some("a.jpg"))
    );
}

#[test]
fn a_tiff_says_the_same_and_holds_the_same_picture() {
    let (rectification, photo) = small();
    let rectified = RectifiedPhoto {
        crs: Some("EPSG:32632"),
        ..of(&rectification, Onto::HorizontalPlane)
    };
    let png = rectified.bytes(&photo, RectifiedFormat::Png).unwrap();
    let png = image::load_from_memory(&png).unwrap().to_rgba8();
    let bytes = rectified.bytes(&photo, RectifiedFormat::Tiff).unwrap();
    assert!(bytes[8..].starts_with(b"fragscale "));
    let mut decoder = Decoder::new(Cursor::new(&bytes)).unwrap();
    assert_eq!(decoder.dimensions().unwrap(), png.dimensions());
    for tag in [Tag::XResolution, Tag::YResolution] {
        let value = decoder.get_tag(tag).unwrap();
        assert_eq!(value, ::tiff::decoder::ifd::Value::Rational(1, 5));
    }
    assert_eq!(decoder.get_tag_u32(Tag::ResolutionUnit).unwrap(), 3);
    let mut image = DecodingResult::U8(Vec::new());
    decoder.read_image_to_buffer(&mut image).unwrap();
    let DecodingResult::U8(pixels) = image else {
        panic!("not bytes");
    };
    assert!(pixels == *png.as_raw());
    // Where the world file has the middle of the first pixel, GeoTIFF has its corner.
    let sides = decoder.get_tag_f64_vec(Tag::ModelPixelScaleTag).unwrap();
    assert_eq!(sides, [0.05, 0.05, 0.0]);
    let place = decoder.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap();
    let world = rectified.world_file();
    let world: Vec<f64> = world
        .lines()
        .take(6)
        .map(|line| line.parse().unwrap())
        .collect();
    assert_eq!(place[..3], [0.0; 3]);
    assert!((place[3] + 0.025 - world[4]).abs() < 1e-8, "{place:?}");
    assert!((place[4] - 0.025 - world[5]).abs() < 1e-8, "{place:?}");
    let keys = decoder.get_tag_u32_vec(Tag::GeoKeyDirectoryTag).unwrap();
    // ProjectedCRSGeoKey.
    let crs = keys.chunks(4).find(|key| key[0] == 3072).map(|key| key[3]);
    assert_eq!(crs, Some(32_632));
    let on_plane = of(&rectification, Onto::FittedPlane);
    let bytes = on_plane.bytes(&photo, RectifiedFormat::Tiff).unwrap();
    let mut decoder = Decoder::new(Cursor::new(&bytes)).unwrap();
    assert!(decoder.find_tag(Tag::ModelTiepointTag).unwrap().is_none());
    // Corners that the photo does not show are clear and white; its middle is the photo's.
    assert_eq!(png.get_pixel(0, 0).0, [255, 255, 255, 0]);
    let raster = rectification.raster;
    assert_eq!(
        png.get_pixel(raster.columns / 2, raster.rows / 2).0,
        [90, 80, 70, 255]
    );
    assert_eq!(png.get_pixel(0, png.height() - 1).0, [255; 4]);
}

/// The first pixel's middle, by the plane's own numbers; map programs read the first six lines.
#[test]
fn world_files_lie_on_the_map() {
    let (rectification, photo) = small();
    let rectified = of(&rectification, Onto::HorizontalPlane);
    let text = rectified.world_file();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[..4], ["0.05", "0", "0", "-0.05"]);
    let [x, y] = [lines[4], lines[5]].map(|line| line.parse::<f64>().unwrap());
    let first = rectification.raster.world_from_picture(DVec2::splat(0.5));
    assert!((x - first.x).abs() < 1e-9 && (y - first.y).abs() < 1e-9);
    assert!((x - 500_000.0).abs() < 20.0 && (y - 5_000_000.0).abs() < 20.0);
    assert_eq!(lines[6], "fragscale: coordinates of the world");
    assert_eq!(lines.len(), 7);
    let on_plane = of(&rectification, Onto::FittedPlane).world_file();
    assert!(on_plane.contains("fitted plane, not of the world"));
    let wrong = RgbImage::new(320, 240);
    let fault = rectified.bytes(&wrong, RectifiedFormat::Png).unwrap_err();
    assert!(
        fault.what.contains("320 x 240") && fault.what.contains("640 x 480"),
        "{fault}"
    );
    drop(photo);
}
