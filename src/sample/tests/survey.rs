//! The photos of a mapping flight, and where their receiver says that they were taken.

use glam::DVec2;

use super::*;

/// What the receiver says is off by its standard deviations along each axis, without a bias; RTK states them.
#[test]
fn receivers_err_as_they_state() {
    let recipe = Preset::Muckpile.recipe(Lens::Brown).unwrap();
    let shot = &recipe.flight.fly(&mut Random::new(1))[0];
    let crs = Crs::understand("EPSG:32632").unwrap();
    for (receiver, expected) in [
        (Receiver::Gps, [1.5, 1.5, 3.0]),
        (Receiver::Rtk, [0.015, 0.015, 0.025]),
    ] {
        let mut random = Random::new(2);
        let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
        let draws = 2000;
        for _ in 0..draws {
            let said = metadata(&recipe, shot, Some(receiver), &mut random).unwrap();
            assert_eq!(said.rtk, (receiver == Receiver::Rtk).then_some(expected));
            let gps = said.gps.unwrap();
            let place = geodesy::Geographic {
                longitude: gps.longitude,
                latitude: gps.latitude,
                height: gps.altitude,
            };
            let off = crs.from_geographic(place).unwrap() - recipe.origin - shot.actual.0;
            sum += off;
            squares += off * off;
        }
        let n = f64::from(draws);
        for (axis, expected) in expected.into_iter().enumerate() {
            let deviation = (squares[axis] / n).sqrt();
            // The standard error of a standard deviation is 1 / sqrt(2 n) of it: 1.6 %.
            assert!(
                (deviation / expected - 1.0).abs() < 0.07,
                "{receiver:?} {deviation}"
            );
            assert!((sum[axis] / n).abs() < 4.5 * expected / n.sqrt());
        }
    }
}

/// Every place of the ground that the flight shows is seen straight down by six photos at least.
#[test]
fn a_survey_overlaps() {
    let recipe = Preset::Muckpile.recipe(Lens::None).unwrap();
    let flight = &recipe.flight;
    let shots = flight.survey(view(&recipe.camera), &mut Random::new(3));
    let reach = (flight.spacing + view(&recipe.camera) * flight.height) / 2.0;
    let sees = |shot: &&Shot, at: DVec3| {
        let pixel = recipe
            .camera
            .pixel_undistorted(shot.pose().camera_from_world(at));
        shot.planned.1[0] == 90.0 && pixel.is_some_and(|pixel| recipe.camera.contains(pixel))
    };
    for (x, y) in [
        (-1.0, -1.0),
        (-0.4, 0.7),
        (0.0, 0.0),
        (0.9, -0.2),
        (1.0, 1.0),
    ] {
        let at = (DVec2::new(x, y) * reach).extend(0.0);
        let count = shots.iter().filter(|shot| sees(shot, at)).count();
        assert!(count >= 6, "{at}: {count} of {}", shots.len());
    }
    assert!(shots.iter().filter(|shot| shot.planned.1[0] < 90.0).count() == 24);
}
