//! Over planes, heights and light are known by formulas.

use glam::{DVec2, DVec3};

use super::*;
use crate::surface::Cloud;

const MIDDLE: DVec2 = DVec2::new(500_000.0, 5_000_000.0);

/// A plane that rises by `slope` (east, north) over a square of 20 around [`MIDDLE`], 100 high there.
fn plane(slope: DVec2) -> Surface {
    let corners = [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)];
    let point = |(x, y)| {
        let off = DVec2::new(x, y);
        (MIDDLE + off).extend(100.0 + slope.dot(off))
    };
    Surface::new(Cloud {
        points: corners.map(point).to_vec(),
        ..Cloud::default()
    })
    .unwrap()
}

fn raster(half: f64, pixel: f64) -> MapRaster {
    let half = DVec2::splat(half);
    MapRaster::over([MIDDLE - half, MIDDLE + half], pixel, 1_000_000).unwrap()
}

#[test]
fn heights_are_those_of_the_plane_and_nothing_lies_beside_it() {
    let slope = DVec2::new(0.3, -0.2);
    let raster = raster(12.0, 0.5);
    assert_eq!((raster.columns, raster.rows), (48, 48));
    let heights = plane(slope)
        .heights_from_above(&raster, &Progress::default())
        .unwrap();
    for row in 0..48_u32 {
        for column in 0..48_u32 {
            let place = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let off = raster.world_from_pixel(place) - MIDDLE;
            let height = heights[(row * 48 + column) as usize];
            if off.abs().max_element() > 10.0 {
                assert!(height.is_nan(), "{off}: {height}");
            } else {
                let known = 100.0 + slope.dot(off);
                assert!(
                    (height - known).abs() < 1e-9,
                    "{off}: {height}, not {known}"
                );
            }
        }
    }
}

/// On a plane the highest of a pixel is its corner uphill; a spike or a wall is as high as it is wherever it stands.
#[test]
fn tops_are_those_of_the_corner_uphill_and_of_what_is_thin() {
    let slope = DVec2::new(0.3, -0.2);
    let raster = raster(9.0, 0.5);
    let tops = plane(slope)
        .tops_from_above(&raster, &Progress::default())
        .unwrap();
    for row in 0..36_u32 {
        for column in 0..36_u32 {
            let place = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let off = raster.world_from_pixel(place) - MIDDLE;
            let known = 100.0 + slope.dot(off) + 0.25 * (0.3 + 0.2);
            let top = tops[(row * 36 + column) as usize];
            assert!((top - known).abs() < 1e-9, "{off}: {top}, not {known}");
        }
    }
    // A needle 8 high between the middles, and an upright wall 5 high: two triangles without a width.
    let at = |x: f64, y: f64, z: f64| (MIDDLE + DVec2::new(x, y)).extend(z);
    let mesh = Cloud {
        points: vec![
            at(-9.0, -9.0, 0.0),
            at(9.0, -9.0, 0.0),
            at(0.01, 9.0, 0.0),
            at(3.02, 1.03, 8.0),
            at(3.03, 1.03, 0.0),
            at(3.02, 1.04, 0.0),
            at(-4.0, -3.1, 0.0),
            at(4.0, -3.1, 0.0),
            at(4.0, -3.1, 5.0),
            at(-4.0, -3.1, 5.0),
        ],
        triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8], [6, 8, 9]],
        ..Cloud::default()
    };
    let mesh = Surface::new(mesh).unwrap();
    let progress = Progress::default();
    let middles = mesh.heights_from_above(&raster, &progress).unwrap();
    let highest = |heights: &[f64]| heights.iter().copied().fold(f64::NAN, f64::max);
    assert!(highest(&middles).abs() < 1e-9);
    let tops = mesh.tops_from_above(&raster, &progress).unwrap();
    assert!((highest(&tops) - 8.0).abs() < 1e-9);
    // 16 pixels of half a unit.
    let wall = tops.iter().filter(|top| (**top - 5.0).abs() < 1e-9);
    assert!(
        (16..=18).contains(&wall.clone().count()),
        "{}",
        wall.count()
    );
}

/// Burrough & McDonnell, "Principles of GIS" (1998): cos(zenith) cos(slope) + sin(zenith) sin(slope)
/// cos(azimuth - aspect), with the aspect the direction in which the plane falls.
#[test]
fn the_light_on_a_plane_is_that_of_the_formula() {
    let light = Light::default();
    for (aspect, steep) in [
        (0.0, 0.0),
        (315.0, 30.0),
        (90.0, 40.0),
        (200.0, 10.0),
        (135.0, 60.0),
    ] {
        let (down, steep) = (f64::to_radians(aspect), f64::to_radians(steep));
        // It falls towards the aspect.
        let slope = -DVec2::new(down.sin(), down.cos()) * steep.tan();
        let raster = raster(12.0, 0.25);
        let heights = plane(slope)
            .heights_from_above(&raster, &Progress::default())
            .unwrap();
        let shades = hillshade(&raster, &heights, light);
        let (azimuth, zenith) = (
            light.azimuth.to_radians(),
            (90.0 - light.altitude).to_radians(),
        );
        let known =
            zenith.cos() * steep.cos() + zenith.sin() * steep.sin() * (azimuth - down).cos();
        for (shade, height) in shades.iter().zip(&heights) {
            assert_eq!(shade.is_nan(), height.is_nan());
            if !shade.is_nan() {
                // At the plane's edge as well.
                let off = (shade - known.max(0.0)).abs();
                assert!(off < 1e-9, "{aspect} {steep}: {shade}, not {known}");
            }
        }
    }
}

#[test]
fn places_go_there_and_back_and_rasters_lie_on_each_other() {
    let raster = raster(7.3, 0.2);
    let place = DVec2::new(3.25, 17.5);
    assert!((raster.pixel_from_world(raster.world_from_pixel(place)) - place).length() < 1e-6);
    let corner = raster.corner / 0.2;
    assert!((corner - corner.round()).abs().max_element() < 1e-6);
    let [min, max] = raster.bounds();
    assert!(min.cmple(MIDDLE - 7.3).all() && max.cmpge(MIDDLE + 7.3).all());
}

#[test]
fn what_is_too_large_is_refused_with_its_size() {
    let all = [DVec2::ZERO, DVec2::splat(1000.0)];
    let fault = MapRaster::over(all, 0.01, 40_000_000).unwrap_err();
    assert!(
        fault
            .what
            .contains("100000 x 100000 pixels, more than 40 million"),
        "{fault}"
    );
    for pixel in [0.0, -1.0, f64::NAN] {
        assert!(MapRaster::over(all, pixel, 1000).is_err());
    }
    let wrong = [DVec2::ZERO, DVec2::splat(f64::NAN)];
    assert!(MapRaster::over(wrong, 1.0, 1000).is_err());
}

/// The highest of what lies above each other counts, as one sees it from above.
#[test]
fn of_a_mesh_the_highest_is_seen() {
    let square = |z: f64, half: f64| {
        [(-half, -half), (half, -half), (half, half), (-half, half)]
            .map(|(x, y)| DVec3::new(x, y, z))
    };
    let mesh = Surface::new(Cloud {
        points: [square(0.0, 4.0), square(2.0, 2.0)].concat(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
        ..Cloud::default()
    })
    .unwrap();
    let all = [DVec2::splat(-4.0), DVec2::splat(4.0)];
    let raster = MapRaster::over(all, 1.0, 100).unwrap();
    let heights = mesh
        .heights_from_above(&raster, &Progress::default())
        .unwrap();
    assert_eq!(heights[4 * 8 + 4], 2.0);
    assert_eq!(heights[0], 0.0);
}
