//! Measures on planes, where all is known.

use std::f64::consts::PI;

use fragscale_core::camera::{Camera, Distortion, Pose};
use fragscale_core::jobs::Progress;
use fragscale_core::scale::{FieldGrid, ImageKind};
use fragscale_core::surface::{Cloud, Surface};
use fragscale_core::units::LengthUnit;

use super::*;
use crate::mass::PhotoFragments;

const SIDE: u32 = 400;

/// A photo from 4 above the plane z = slope * x, straight down, 500 pixels of focal length: 125 pixels per unit on
/// the level plane.
fn field(slope: f64) -> ScaleField {
    let points = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]];
    field_of(points.map(|[x, y]| DVec3::new(x, y, slope * x)).to_vec())
}

fn field_of(points: Vec<DVec3>) -> ScaleField {
    let cloud = Cloud {
        points,
        ..Cloud::default()
    };
    let camera = Camera {
        name: String::new(),
        width: SIDE,
        height: SIDE,
        fx: 500.0,
        fy: 500.0,
        cx: 200.0,
        cy: 200.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 4.0), [90.0, 0.0]);
    let surface = Surface::new(cloud).unwrap();
    let grid = FieldGrid::of_pixels(&camera);
    ScaleField::compute(
        &camera,
        &pose,
        ImageKind::Undistorted,
        grid,
        &surface,
        &Progress::default(),
    )
    .unwrap()
}

fn drawn(is_in: impl Fn(f64, f64) -> u32) -> LabelImage {
    let side = SIDE as usize;
    let label = |place: usize| is_in((place % side) as f64 + 0.5, (place / side) as f64 + 0.5);
    LabelImage {
        width: side,
        height: side,
        labels: (0..side * side).map(label).collect(),
    }
}

fn close(found: f64, wanted: f64, share: f64) {
    assert!(
        (found / wanted - 1.0).abs() < share,
        "{found}, not {wanted}"
    );
}

/// A disc of 50 pixels radius and a rectangle of 80 by 30 that the edge cuts, on a level plane.
#[test]
fn a_disc_and_a_rectangle() {
    let labels = drawn(|x, y| {
        let disc = (x - 220.0).hypot(y - 210.0) < 50.0;
        let rectangle = x < 80.0 && (300.0..330.0).contains(&y);
        u32::from(disc) + 2 * u32::from(rectangle)
    });
    let found = measured(&labels, &field(0.0), SieveShape::Circle);
    let [disc, rectangle] = found.as_slice() else {
        panic!("two fragments");
    };
    assert!(!disc.is_cut && rectangle.is_cut);
    assert!((disc.middle - DVec2::new(220.0, 210.0)).length() < 0.05);
    let of = disc.world.unwrap();
    close(of.scale, 125.0, 1e-9);
    close(of.diameter, 0.8, 2e-3);
    close(of.area, PI * 0.16, 4e-3);
    close(of.surface_area, of.area, 1e-6);
    close(of.widths[0], 0.8, 0.02);
    close(of.widths[1], 0.8, 0.02);
    close(of.inscribed, 0.8, 0.025);
    close(of.roundness, 1.0, 0.03);
    assert_eq!(of.sieve_size, of.diameter);
    assert!(of.height.unwrap().abs() < 1e-9);
    // 20 pixels right of the axis and 10 below it, seen from above with y up: x 0.16, y -0.08.
    assert!(
        (of.place - DVec3::new(0.16, -0.08, 0.0)).length() < 1e-3,
        "{}",
        of.place
    );
    let of = rectangle.world.unwrap();
    close(of.rectangle[0], 80.0 / 125.0, 1e-6);
    close(of.rectangle[1], 30.0 / 125.0, 1e-6);
    close(of.widths[1], 80f64.hypot(30.0) / 125.0, 1e-6);
}

/// On a plane that rises by 1 in 1 the surface is sqrt(2) times what lies level below it.
#[test]
fn a_slope_has_more_surface() {
    let labels = drawn(|x, y| u32::from((x - 200.0).abs() < 10.0 && (y - 200.0).abs() < 10.0));
    let found = measured(&labels, &field(1.0), SieveShape::Breadth);
    let of = found[0].world.unwrap();
    close(of.surface_area / of.area, 2f64.sqrt(), 0.01);
    assert!(of.height.unwrap().abs() < 1e-6, "{of:?}");
}

/// Where a slope faces an oblique ray its surface is less than a plane across the axis: of 30 by 20 pixels on z = 0.3 x, the
/// four corners' rays meet the plane in a quadrilateral of that area.
#[test]
fn a_slope_that_faces_the_camera_has_less_surface() {
    let labels =
        drawn(|x, y| u32::from((360.0..390.0).contains(&x) && (190.0..210.0).contains(&y)));
    let corner = |u: f64, v: f64| {
        let ray = DVec3::new((u - 200.0) / 500.0, (200.0 - v) / 500.0, -1.0);
        DVec3::new(0.0, 0.0, 4.0) + ray * (4.0 / (1.0 + 0.3 * ray.x))
    };
    let [a, b] = [corner(360.0, 190.0), corner(390.0, 190.0)];
    let [c, d] = [corner(390.0, 210.0), corner(360.0, 210.0)];
    let exact = (c - a).cross(d - b).length() / 2.0;
    let of = measured(&labels, &field(0.3), SieveShape::Circle)[0].world;
    let of = of.unwrap();
    close(of.surface_area, exact, 1e-6);
    assert!(of.surface_area < 0.96 * of.area, "{of:?}");
}

/// From 4 above z = x the rays of the columns 200 and 325 meet it at the depths t = 4 and 3.2, at x = 0 and 0.8, as
/// 4 - t = x = t (u - 200) / 500, and those of the rows 150 and 250 at y = ± t / 10: seen from above a trapezium 0.8 long between sides
/// of 0.8 and 0.64, of 0.576, and of 0.576 sqrt(2) on the slope.
#[test]
fn a_slope_under_perspective_has_its_whole_surface() {
    let surface = |slope: f64, columns: [f64; 2], rows: [f64; 2]| {
        let labels = drawn(|x, y| {
            let is_in = (columns[0]..columns[1]).contains(&x) && (rows[0]..rows[1]).contains(&y);
            u32::from(is_in)
        });
        let found = measured(&labels, &field(slope), SieveShape::Circle);
        found[0].world.unwrap().surface_area
    };
    let exact = 0.576 * 2f64.sqrt();
    close(surface(1.0, [200.0, 325.0], [150.0, 250.0]), exact, 1e-6);
    // Mirrored, and with rows of twice the height.
    close(surface(-1.0, [75.0, 200.0], [150.0, 250.0]), exact, 1e-6);
    close(
        surface(1.0, [200.0, 325.0], [100.0, 300.0]),
        2.0 * exact,
        1e-6,
    );
}

/// A ridge z = -|x| / 5 over a square from -a to a: its outline lies at -a / 5 on two sides and at -a / 10 in the mean on
/// the others, so its plane is level at -3 a / 20, and the ridge stands that high above it; 95 of 100 of its pixels are at least
/// 5 % of the way down at each side, a / 100 lower.
#[test]
fn a_ridge_stands_out_of_its_outline() {
    let points =
        [-9.0, 0.0, 9.0].map(|x: f64| [-9.0, 9.0].map(|y| DVec3::new(x, y, -x.abs() / 5.0)));
    let labels = drawn(|x, y| u32::from((x - 200.0).abs() < 100.0 && (y - 200.0).abs() < 100.0));
    let found = measured(&labels, &field_of(points.concat()), SieveShape::Circle);
    let height = found[0].world.unwrap().height.unwrap();
    // 100 pixels are 0.8 at the ridge and a little more at the lower sides.
    close(height, (3.0 / 20.0 - 1.0 / 100.0) * 0.82, 0.03);
}

/// A line of pixels has no plane through its outline, and one pixel has none: nothing is said of how they stand out.
#[test]
fn a_line_does_not_stand_out() {
    for wide in [20.0, 0.5] {
        let labels = drawn(|x, y| u32::from((x - 200.5).abs() <= wide && (y - 200.5).abs() < 0.6));
        let found = measured(&labels, &field(0.0), SieveShape::Circle);
        assert_eq!(found[0].world.unwrap().height, None, "{found:?}");
    }
}

/// The photo's edge, what was left out, both, and nothing: only the edge tells of the coarse end of a pile.
#[test]
fn what_cuts_a_fragment() {
    let labels = drawn(|x, y| {
        let is_in = |middle: [f64; 2]| (x - middle[0]).abs() < 20.0 && (y - middle[1]).abs() < 20.0;
        match (x, y) {
            _ if is_in([10.0, 100.0]) => 1,
            _ if is_in([200.0, 100.0]) => 2,
            _ if is_in([10.0, 300.0]) => 3,
            _ if is_in([300.0, 200.0]) => 4,
            // A bar below the second, and one below the third.
            (180.0..220.0, 120.0..130.0) | (0.0..30.0, 320.0..330.0) => NOT_ROCK,
            _ => FINES,
        }
    });
    let found = measured(&labels, &field(0.0), SieveShape::Circle);
    let cut: Vec<[bool; 2]> = found.iter().map(|of| [of.is_cut, of.is_at_edge]).collect();
    assert_eq!(
        cut,
        [[true, true], [true, false], [true, true], [false, false]]
    );
}

/// What people or another tool outlined.
fn of_others(labels: &LabelImage, field: &ScaleField) -> PhotoFragments {
    let (shape, unit) = (SieveShape::Circle, LengthUnit::Metre);
    crate::photo::fragments(labels, field, shape, None, None, unit)
}

/// Of people and other tools nothing is claimed below the smallest outline of ten pixels' width, and below that width where there is
/// none; a line of many pixels is none, either.
#[test]
fn the_limit_of_others_is_as_wide_as_an_engines() {
    let said = |square: f64| {
        let labels = drawn(|x, y| {
            let is_in = |at: [f64; 2], half: [f64; 2]| {
                (x - at[0]).abs() < half[0] && (y - at[1]).abs() < half[1]
            };
            u32::from(is_in([100.0, 100.0], [square / 2.0, square / 2.0]))
                + 2 * u32::from(is_in([200.0, 300.5], [55.0, 0.6]))
                + 3 * u32::from(is_in([300.0, 100.0], [2.0, 2.0]))
        });
        let photo = of_others(&labels, &field(0.0));
        (photo.limit, photo.notes(&labels, false))
    };
    let (limit, notes) = said(30.0);
    close(limit, (4.0 / PI).sqrt() * 30.0 / 125.0, 1e-6);
    // The line's circle is as large as that of ten pixels: below the limit, but not the limit.
    assert!(
        notes[0].starts_with("2 outlines of less than 10 pixels across"),
        "{notes:?}"
    );
    let (limit, notes) = said(8.0);
    close(limit, 10.0 / 125.0, 1e-6);
    assert!(
        notes[0].starts_with("2 outlines of less than 10 pixels across"),
        "{notes:?}"
    );
}

/// What lies over a hole of the surface is said.
#[test]
fn what_is_beside_the_surface_is_said() {
    let points = [[-9.0, -9.0], [0.0, -9.0], [0.0, 9.0], [-9.0, 9.0]];
    let field = field_of(points.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec());
    let labels = drawn(|x, y| {
        let at = |middle: f64| (x - middle).abs() < 20.0 && (y - 200.0).abs() < 20.0;
        u32::from(at(100.0)) + 2 * u32::from(at(300.0))
    });
    let photo = of_others(&labels, &field);
    let notes = photo.notes(&labels, false);
    assert!(
        notes[0].starts_with("1 outline of which too little lies on the surface"),
        "{notes:?}"
    );
}

/// A spike of one point, a metre high, over three of a hundred parts of a level square: the square stands out by nothing.
#[test]
fn one_stray_point_does_not_make_a_fragment_high() {
    let far = [-9.0, 9.0].map(|x: f64| [-9.0, 9.0].map(|y| DVec3::new(x, y, 0.0)));
    let near = [-0.12, 0.12].map(|x: f64| [-0.12, 0.12].map(|y| DVec3::new(x, y, 0.0)));
    let mut points = [far.concat(), near.concat()].concat();
    points.push(DVec3::new(0.001, 0.002, 1.0));
    let labels = drawn(|x, y| u32::from((x - 200.0).abs() < 100.0 && (y - 200.0).abs() < 100.0));
    let found = measured(&labels, &field_of(points), SieveShape::Circle);
    let height = found[0].world.unwrap().height.unwrap();
    assert!(height.abs() < 0.01, "{height}");
}
