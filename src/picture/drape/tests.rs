use image::{Rgb, RgbImage};

use super::*;
use crate::camera::Distortion;

/// 200 x 200 pixels, f = 100 px: at 10 m it shows 20 m x 20 m.
fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 200,
        height: 200,
        fx: 100.0,
        fy: 100.0,
        cx: 100.0,
        cy: 100.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}

const EVERYWHERE: [DVec2; 2] = [DVec2::splat(-100.0), DVec2::splat(100.0)];

fn raster() -> MapRaster {
    MapRaster::over([DVec2::splat(-10.0), DVec2::splat(10.0)], 0.1, 1_000_000).unwrap()
}

fn place(raster: &MapRaster, at: DVec2) -> usize {
    let pixel = raster.pixel_from_world(at);
    pixel.y as usize * raster.columns as usize + pixel.x as usize
}

/// Of two photos that look straight down onto a level place, that whose camera is nearer along the cosine over
/// the squared distance: beside each other at one height, the border is the line in the middle.
#[test]
fn the_nearest_that_looks_down_colours_a_place() {
    let (camera, raster) = (camera(), raster());
    let heights = vec![0.0; (raster.columns * raster.rows) as usize];
    let poses = [-4.0, 4.0].map(|x| Pose::from_tilt_pan(DVec3::new(x, 0.0, 10.0), [90.0, 0.0]));
    let photos = poses.each_ref().map(|pose| {
        Some(PhotoAbove {
            camera: &camera,
            pose,
            shows: EVERYWHERE,
        })
    });
    let draping = Draping::new(&raster, &heights, &photos, &Progress::default()).unwrap();
    for (at, photo) in [
        ((-0.3, 2.0), 0),
        ((0.3, 2.0), 1),
        ((-9.0, -8.0), 0),
        ((5.0, 0.0), 1),
    ] {
        assert_eq!(draping.chosen[place(&raster, at.into())], photo, "{at:?}");
    }
    assert_eq!(draping.photos(), [0, 1]);
    // One of 20 m height counts a quarter.
    let higher = Pose::from_tilt_pan(DVec3::new(4.0, 0.0, 20.0), [90.0, 0.0]);
    let photos = [&poses[0], &higher].map(|pose| {
        Some(PhotoAbove {
            camera: &camera,
            pose,
            shows: EVERYWHERE,
        })
    });
    let draping = Draping::new(&raster, &heights, &photos, &Progress::default()).unwrap();
    // At x = 3: (49 + 100)^-1.5 * 10 over (1 + 400)^-1.5 * 20 is 2.2.
    assert_eq!(draping.chosen[place(&raster, DVec2::new(3.0, 0.0))], 0);
}

/// The colour of a place is that of the pixel that shows it, and a wall of 5 m hides what lies behind it: from
/// 10 m height, 6 m beside it, as far as 6 m.
#[test]
fn colours_are_those_of_the_photo_and_walls_hide() {
    let (camera, raster) = (camera(), raster());
    let mut heights = vec![0.0; (raster.columns * raster.rows) as usize];
    for row in 0..raster.rows {
        let at = raster.pixel_from_world(DVec2::new(2.05, 0.0)).x as usize;
        heights[row as usize * raster.columns as usize + at] = 5.0;
    }
    let pose = Pose::from_tilt_pan(DVec3::new(-4.0, 0.0, 10.0), [90.0, 0.0]);
    let photo = PhotoAbove {
        camera: &camera,
        pose: &pose,
        shows: EVERYWHERE,
    };
    let draping = Draping::new(&raster, &heights, &[Some(photo)], &Progress::default()).unwrap();
    // Red is the column, green the row.
    let picture = RgbImage::from_fn(200, 200, |x, y| Rgb([x as u8, y as u8, 7]));
    let colours = draping.colours(0, &photo, &picture).unwrap();
    let of = |at: (f64, f64)| {
        let place = place(&raster, at.into());
        colours.iter().find(|(p, _)| *p == place).map(|(_, c)| *c)
    };
    // The middle of a pixel 3 m to the east and 2 m to the north: 10 px to a metre.
    let [red, green, blue] = of((-0.95, 2.05)).unwrap();
    let near = |value: u8, known: f64| (f64::from(value) - known).abs() <= 1.0;
    assert!(
        near(red, 130.0) && near(green, 79.0) && blue == 7,
        "{red} {green}"
    );
    assert!(of((1.0, 0.05)).is_some());
    for x in [2.5, 5.0, 5.9] {
        assert_eq!(of((x, 0.05)), None, "{x} m is behind the wall");
    }
    let small = RgbImage::new(100, 100);
    assert!(draping.colours(0, &photo, &small).is_err());
}
