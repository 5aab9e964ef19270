//! A photo straight down onto a tilted plane, whose footprint, light and places are known by formulas; the
//! files are read by the `tiff` crate and roxmltree.

use std::io::Cursor;
use std::path::Path;

use glam::DVec3;
use roxmltree::{Document, Node};
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use super::ground::{DARKEST, LIGHT};
use super::page::Page;
use super::*;
use crate::camera::{Camera, Distortion, Pose};
use crate::flight::{Flight, FlightParts, Limits, LookedUp, Photo};
use crate::scale::{Ground, ImageKind};
use crate::surface::{Cloud, Surface};

pub(super) const MIDDLE: DVec2 = DVec2::new(500_000.0, 5_000_000.0);

/// The surface rises to the east by one in two over a square of 40 m; a second photo looks beside it.
fn review(slope: f64) -> Review {
    let corners = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)];
    let point = |(x, y)| (MIDDLE + DVec2::new(x, y)).extend(100.0 + slope * x);
    let cloud = Cloud {
        points: corners.map(point).to_vec(),
        ..Cloud::default()
    };
    let camera = Camera {
        name: String::new(),
        width: 160,
        height: 90,
        fx: 100.0,
        fy: 100.0,
        cx: 80.0,
        cy: 45.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let photo = |name: &str, off: DVec3| Photo {
        name: name.to_owned(),
        camera: 0,
        pose: Pose::from_tilt_pan(MIDDLE.extend(110.0) + off, [90.0, 0.0]),
        errors: Default::default(),
        package_errors: Default::default(),
        trouble: None,
    };
    let flight = Flight::new(FlightParts {
        name: "Bench 7 < east".to_owned(),
        unit: LengthUnit::Metre,
        unit_known: true,
        ground: Ground::Auto,
        image: ImageKind::Undistorted,
        pair: Default::default(),
        errors: Default::default(),
        package_errors: Default::default(),
        surface: Arc::new(Surface::new(cloud).unwrap()),
        cameras: vec![camera],
        as_read: Default::default(),
        photos: vec![
            photo("a.jpg", DVec3::ZERO),
            photo("b.jpg", DVec3::new(0.0, 8.0, 0.0)),
        ],
    })
    .unwrap();
    let progress = Progress::default();
    let looked_up = LookedUp::default();
    let review = Review::of_scales(Arc::new(flight), looked_up, &Limits::default(), &progress);
    let mut review = review.unwrap();
    review.look(&progress).unwrap();
    review.compute_fields(&progress).unwrap();
    review
}

pub(super) fn plan(slope: f64, crs: Option<&str>) -> Plan {
    let request = PlanRequest {
        pixel: Some(0.1),
        crs,
        taken: Some("2026-05-04"),
        ..PlanRequest::default()
    };
    Plan::new(&review(slope), request, &|_| None, &Progress::default()).unwrap()
}

/// Over the level surface, 10 m below, the image of 160 x 90 pixels with 100 pixels focal length is 16 m x
/// 9 m.
#[test]
fn a_footprint_lies_where_it_is() {
    let plan = plan(0.0, None);
    let [a, b] = &plan.photos[..] else {
        panic!("two photos")
    };
    let min = a.outline.iter().copied().reduce(DVec2::min).unwrap();
    let max = a.outline.iter().copied().reduce(DVec2::max).unwrap();
    let half = DVec2::new(8.0, 4.5);
    assert!((min - (MIDDLE - half)).length() < 1e-6, "{min}");
    assert!((max - (MIDDLE + half)).length() < 1e-6, "{max}");
    assert!((a.middle.unwrap() - MIDDLE).length() < 1e-6);
    assert!((b.camera - MIDDLE - DVec2::new(0.0, 8.0)).length() < 1e-9);
    // The surface with a fiftieth of its side around it.
    let room = DVec2::splat(20.0 + 0.8);
    assert!((plan.extent[0] - (MIDDLE - room)).length() < 1e-6);
    assert!((plan.extent[1] - (MIDDLE + room)).length() < 1e-6);
    assert!(!plan.is_on_map());
}

/// Light from the north-west, 45 degrees high, on a plane that falls to the west with slope s: the cosine is
/// (1 + s / sqrt 2) / sqrt 2 / sqrt(1 + s²).
#[test]
fn the_ground_is_as_light_as_the_formula_says() {
    let slope = 0.5_f64;
    let plan = plan(slope, None);
    let known = (1.0 + slope / 2_f64.sqrt()) / 2_f64.sqrt() / slope.hypot(1.0);
    let grey = (DARKEST + LIGHT * known).round() as u8;
    let at = plan.raster.pixel_from_world(MIDDLE + DVec2::new(3.0, -7.0));
    let pixel = plan.ground.get_pixel(at.x as u32, at.y as u32);
    assert_eq!(pixel.0, [grey, grey, grey, 255]);
    assert_eq!(plan.ground.get_pixel(0, 0).0[3], 0, "beside the surface");
}

/// What GIS programs read: the world point of a pixel by the tags, and there the footprint's corner.
#[test]
fn pixels_of_the_geotiff_lie_at_their_world_points() {
    let plan = plan(0.0, Some("EPSG:32633"));
    assert!(plan.is_on_map());
    let bytes = PlanFormat::GeoTiff.bytes(&plan, LengthUnit::Metre).unwrap();
    let mut decoder = Decoder::new(Cursor::new(&bytes)).unwrap();
    let (width, height) = decoder.dimensions().unwrap();
    // 41.6 m of 0.1 m.
    assert_eq!((width, height), (416, 416));
    let mut numbers = |tag| {
        decoder
            .find_tag(tag)
            .unwrap()
            .unwrap()
            .into_f64_vec()
            .unwrap()
    };
    let scale = numbers(Tag::ModelPixelScaleTag);
    let tie = numbers(Tag::ModelTiepointTag);
    assert_eq!(scale, [0.1, 0.1, 0.0]);
    assert_eq!(tie[..3], [0.0; 3]);
    let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap();
    assert_eq!(
        keys,
        [1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32633]
    );
    let mut image = DecodingResult::U8(Vec::new());
    decoder.read_image_to_buffer(&mut image).unwrap();
    let DecodingResult::U8(image) = image else {
        panic!("not bytes");
    };
    // OGC 19-008r4, 7.3: x = X + scale (column - I), y = Y - scale (row - J).
    let pixel = |point: DVec2| {
        let column = ((point.x - tie[3]) / scale[0]) as usize;
        let row = ((tie[4] - point.y) / scale[1]) as usize;
        let first = (row * width as usize + column) * 4;
        <[u8; 4]>::try_from(&image[first..first + 4]).unwrap()
    };
    let at = |x: f64, y: f64| pixel(MIDDLE + DVec2::new(x, y));
    // Level ground: cos 45 degrees.
    let grey = (DARKEST + LIGHT * 0.5_f64.sqrt()).round() as u8;
    assert_eq!(at(-16.3, -11.7), [grey, grey, grey, 255]);
    assert_eq!(at(-20.5, 0.3)[3], 0);
    // The line of the footprint of 16 x 9 m is dashed: over half of its pixels, and none half a metre outside.
    let is_line = |[r, g, b, _]: [u8; 4]| r.abs_diff(g).max(g.abs_diff(b)) > 25;
    let lines = |x: &dyn Fn(f64) -> f64, y: &dyn Fn(f64) -> f64| {
        let places = (0..70).map(|step| f64::from(step) * 0.1 - 4.0);
        places
            .filter(|along| is_line(at(x(*along), y(*along))))
            .count()
    };
    assert!(lines(&|_| -8.0, &|along| along) > 35, "the west side");
    assert!(
        lines(&|along| along - 3.0, &|_| -4.5) > 35,
        "the south side"
    );
    assert_eq!(lines(&|_| -8.5, &|along| along), 0);
    assert_eq!(lines(&|along| along - 3.0, &|_| -5.0), 0);
}

#[test]
fn a_frame_of_its_own_is_said_to_be_one() {
    let keys = |crs: Option<&str>| {
        let bytes = PlanFormat::GeoTiff
            .bytes(&plan(0.0, crs), LengthUnit::Metre)
            .unwrap();
        let mut decoder = Decoder::new(Cursor::new(&bytes)).unwrap();
        let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap();
        (
            keys,
            decoder
                .get_tag_ascii_string(Tag::GeoAsciiParamsTag)
                .unwrap(),
        )
    };
    let (own, text) = keys(None);
    assert_eq!(text, "own frame, no coordinate system is stated|");
    assert_eq!(own[3], 4);
    assert_eq!(own[4..8], [1024, 0, 1, 32767]);
    assert_eq!(own[16..20], [3076, 0, 1, 9001]);
    let wkt = r#"PROJCS["Mine grid",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",14.7],PARAMETER["scale_factor",1],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]"#;
    let (mine, text) = keys(Some(wkt));
    assert_eq!(text, format!("ESRI PE String = {wkt}|"));
    assert_eq!(mine[12..16], [3072, 0, 1, 32767]);
    // GDAL reads WKT there only of a model that keys do not describe.
    assert_eq!(mine[4..8], [1024, 0, 1, 32767]);
    // What is no WKT is not written as WKT.
    let (proj, text) = keys(Some(
        "+proj=tmerc +lat_0=0 +lon_0=14.7 +k=1 +x_0=500000 +y_0=0 +datum=WGS84 +units=m +no_defs",
    ));
    assert!(!text.contains("PE String"), "{text}");
    assert_eq!(proj[4..8], [1024, 0, 1, 32767]);
}

fn number(node: Node<'_, '_>, attribute: &str) -> f64 {
    let text = node.attribute(attribute).expect(attribute);
    text.parse().expect(attribute)
}

/// 41.6 m on the page of A4: the map is some 19 cm high, so 1 : 250; a metre is 4 mm, 15.118 CSS pixels.
#[test]
fn the_page_has_everything_at_its_place_to_scale() {
    let plan = plan(0.0, Some("EPSG:32633"));
    let svg = PlanFormat::Svg.bytes(&plan, LengthUnit::Metre).unwrap();
    let svg = String::from_utf8(svg).unwrap();
    let document = Document::parse(&svg).unwrap();
    let page = Page::new(&plan);
    let metre = 4.0 * 96.0 / 25.4;
    assert_eq!(page.denominator, Some(250.0));
    assert!((page.frame.scale - metre).abs() < 1e-9);
    let places = |points: &str| -> Vec<[f64; 2]> {
        let pairs = points.split_whitespace().map(|pair| {
            let (x, y) = pair.split_once(',').expect("a pair");
            [x.parse().expect("x"), y.parse().expect("y")]
        });
        pairs.collect()
    };
    let find = |name: &'static str| {
        let nodes = document.descendants();
        nodes.filter(move |node| node.tag_name().name() == name)
    };
    // The first filled polygon is the footprint of a.jpg, 16 m x 9 m around the middle of the map.
    let footprint = find("polygon").next().unwrap();
    let footprint = places(footprint.attribute("points").unwrap());
    let [left, top] = page.frame.at;
    let middle = [
        left + page.frame.size[0] / 2.0,
        top + page.frame.size[1] / 2.0,
    ];
    for corner in [[-8.0, 4.5], [8.0, 4.5], [8.0, -4.5], [-8.0, -4.5]] {
        let known = [middle[0] + corner[0] * metre, middle[1] - corner[1] * metre];
        let is_there = footprint
            .iter()
            .any(|at| (at[0] - known[0]).hypot(at[1] - known[1]) < 0.02);
        assert!(is_there, "{known:?} in {footprint:?}");
    }
    // The ground lies over its square.
    let ground = find("image").next().unwrap();
    let corner = page.frame.place(plan.raster.corner);
    assert!((number(ground, "x") - corner[0]).abs() < 0.01);
    assert!((number(ground, "width") - 41.6 * metre).abs() < 0.02);
    // Lines every 5 m with their coordinates, and what has to be said.
    let texts: Vec<&str> = find("text").filter_map(|node| node.text()).collect();
    for words in [
        "Bench 7 < east",
        "Coordinates: EPSG:32633, m; photos taken 2026-05-04",
        "500005",
        "5000010",
        "1 : 250 on A4",
        "Grid every 5 m",
        "N",
        "grid north",
        "10 m",
        "a.jpg",
        "b.jpg",
        "camera",
    ] {
        assert!(texts.contains(&words), "{words} in {texts:?}");
    }
    let label = find("text")
        .find(|node| node.text() == Some("500005"))
        .unwrap();
    assert!((number(label, "x") - (middle[0] + 5.0 * metre)).abs() < 0.01);
}

#[test]
fn days_are_told_from_the_first_to_the_last() {
    let words = |times: &[&str]| taken_in_words(times.iter().copied());
    assert_eq!(
        words(&["2024:05:06 07:08:09", "2024:05:06 07:09:00"]).as_deref(),
        Some("2024-05-06")
    );
    assert_eq!(
        words(&["2024:05:07 07:08:09", "2024:05:06 07:09:00"]).as_deref(),
        Some("2024-05-06 to 2024-05-07")
    );
    for unknown in [
        &[][..],
        &["0000:00:00 00:00:00"],
        &["soon"],
        &["2024:02:30 10:00:00"],
    ] {
        assert_eq!(words(unknown), None);
    }
}

#[test]
fn every_format_has_its_ending_and_others_are_refused() {
    let plan = plan(0.0, None);
    for (name, begins) in [
        ("map.tif", &b"II*\0"[..]),
        ("MAP.TIFF", b"II*\0"),
        ("a.svg", b"<svg "),
        ("a.pdf", b"%PDF-1.4"),
        ("a.png", b"\x89PNG"),
    ] {
        let format = PlanFormat::of(Path::new(name)).unwrap();
        let bytes = format.bytes(&plan, LengthUnit::Foot).unwrap();
        assert!(bytes.starts_with(begins), "{name}");
        // What is written again may replace it.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let standing =
            crate::files::standing(&path, crate::files::Kind::Result, &Default::default());
        assert_eq!(standing, crate::files::Standing::Ours, "{name}");
    }
    for name in ["map", "map.jpg", ".tif"] {
        assert!(PlanFormat::of(Path::new(name)).is_err(), "{name}");
    }
}

#[test]
fn what_is_too_large_is_refused() {
    let request = |pixel| PlanRequest {
        pixel: Some(pixel),
        ..PlanRequest::default()
    };
    let review = review(0.0);
    let fault = Plan::new(&review, request(0.001), &|_| None, &Progress::default()).unwrap_err();
    assert!(fault.what.contains("more than 40 million"), "{fault}");
    let large = Plan::new(&review, request(0.01), &|_| None, &Progress::default()).unwrap();
    let fault = PlanFormat::Svg
        .bytes(&large, LengthUnit::Metre)
        .unwrap_err();
    assert!(
        fault
            .what
            .contains("4160 x 4160 pixels, more than the 10 million"),
        "{fault}"
    );
}

/// Of a flight whose unit nobody knows there is no 1 : n, and lengths are said to be the file's.
#[test]
fn an_unknown_unit_has_no_scale() {
    let mut plan = plan(0.0, None);
    plan.unit_known = false;
    assert_eq!(Page::new(&plan).denominator, None);
    let svg = PlanFormat::Svg
        .bytes(&plan, LengthUnit::Centimetre)
        .unwrap();
    let svg = String::from_utf8(svg).unwrap();
    let document = Document::parse(&svg).unwrap();
    let texts: Vec<&str> = document
        .descendants()
        .filter_map(|node| node.text())
        .collect();
    for words in ["Grid every 5 units of the file", "5 units of the file"] {
        assert!(texts.contains(&words), "{words} in {texts:?}");
    }
    assert!(!svg.contains("on A4"));
}

/// 10 m over the level surface a pixel of the photo is 0.1 m: the map's pixel has the colour of the photo's, the
/// one photo's where it reaches, the other's beyond, hillshade beside both. A photo that cannot be read is told.
#[test]
fn the_photos_are_the_ground() {
    let review = review(0.0);
    let request = PlanRequest {
        pixel: Some(0.1),
        ground: PlanGround::Photos,
        ..PlanRequest::default()
    };
    let picture = |photo: usize| {
        let blue = if photo == 0 { 10 } else { 200 };
        image::RgbImage::from_fn(160, 90, |x, y| image::Rgb([x as u8, y as u8, blue]))
    };
    let progress = Progress::default();
    let plan = Plan::new(
        &review,
        request,
        &|photo| Some(Ok(picture(photo))),
        &progress,
    )
    .unwrap();
    let at = |plan: &Plan, x: f64, y: f64| {
        let at = plan.raster.pixel_from_world(MIDDLE + DVec2::new(x, y));
        plan.ground.get_pixel(at.x as u32, at.y as u32).0
    };
    let near = |found: [u8; 4], known: [u8; 4]| {
        assert!(
            found.iter().zip(known).all(|(a, b)| a.abs_diff(b) <= 2),
            "{found:?} {known:?}"
        );
    };
    // Half a pixel beside the middle, as the pixels lie.
    near(at(&plan, 3.05, -2.05), [110, 65, 10, 255]);
    near(at(&plan, -5.05, 9.05), [29, 34, 200, 255]);
    let grey = (DARKEST + LIGHT / 2_f64.sqrt()).round() as u8;
    near(at(&plan, 15.0, -15.0), [grey, grey, grey, 255]);
    assert!(plan.warnings.is_empty());
    let one = |photo: usize| match photo {
        0 => None,
        _ => Some(Ok(picture(photo))),
    };
    let plan = Plan::new(&review, request, &one, &progress).unwrap();
    assert!(plan.warnings[0].contains("1 photos are not on the ground"));
    assert_eq!(at(&plan, 3.05, -2.05)[0], grey, "only the first showed it");
    // Without any file there is no such ground, and without colours not that of the points.
    let none = Plan::new(&review, request, &|_| None, &progress).unwrap_err();
    assert!(none.to_string().contains("no photo's file"), "{none}");
    let request = PlanRequest {
        ground: PlanGround::Colours,
        ..request
    };
    let none = Plan::new(&review, request, &|_| None, &progress).unwrap_err();
    assert!(none.to_string().contains("no colours"), "{none}");
}

/// What was measured is on the page and in the legend.
#[test]
fn measured_polygons_are_on_the_page() {
    let mut plan = plan(0.0, None);
    let svg = |plan: &Plan| {
        let bytes = PlanFormat::Svg.bytes(plan, LengthUnit::Metre).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    assert!(!svg(&plan).contains("measured"));
    let corners = [(-5.0, -5.0), (5.0, -5.0), (0.0, 5.0)];
    plan.measured = vec![MeasuredOutline {
        points: corners.map(|at| MIDDLE + DVec2::from(at)).to_vec(),
        is_polygon: true,
    }];
    let text = svg(&plan);
    assert!(text.contains("measured polygon") && !text.contains("measured line"));
    let page = Page::new(&plan);
    let line = |shape: &crate::drawing::Shape| match shape {
        crate::drawing::Shape::Line { points, width, .. } => {
            let closed = points.len() == 4 && points.first() == points.last();
            let first = page.frame.place(plan.measured[0].points[0]);
            closed && *width == 2.2 && (points[0][0] - first[0]).abs() < 1e-6
        }
        _ => false,
    };
    assert!(page.shapes(&plan, LengthUnit::Metre).iter().any(line));
}

/// A footprint that reaches far beside the surface is on the map whole; the one of a photo that sees the
/// horizon does not make all else small.
#[test]
fn footprints_are_not_cut() {
    use crate::geometry::Bounds;
    let bulk = Bounds {
        min: DVec3::ZERO,
        max: DVec3::new(20.0, 10.0, 1.0),
    };
    let photo = |low: (f64, f64), high: (f64, f64)| PlanPhoto {
        name: String::new(),
        verdict: None,
        outline: vec![
            low.into(),
            (high.0, low.1).into(),
            high.into(),
            (low.0, high.1).into(),
        ],
        middle: None,
        camera: DVec2::ZERO,
    };
    let beside = photo((15.0, 5.0), (45.0, 30.0));
    let usual = photo((0.0, 0.0), (30.0, 20.0));
    let [low, high] = extent::of(&bulk, &[usual.clone(), beside, usual.clone()]);
    assert!(low.cmple(DVec2::ZERO).all() && high.cmpge(DVec2::new(45.0, 30.0)).all());
    assert!(high.x < 50.0 && high.y < 35.0, "{high}");
    let horizon = photo((0.0, 0.0), (9000.0, 4000.0));
    let [_, high] = extent::of(&bulk, &[usual.clone(), horizon, usual]);
    assert!(high.x < 100.0, "{high}");
}
