//! How steeply legs climb, and how long they take.

use super::*;

fn flown(plan: &Plan, surface: &Surface, pace: &Pace) -> Way {
    let take_off = DVec2::new(500_000.0 - 100.0, 5_000_000.0);
    Way::through(plan, surface, take_off, pace)
        .unwrap()
        .remove(0)
}

/// Over a ridge of 1 in 1, photos along its flanks: legs up and down the slopes climb at 45 degrees. Where 20 are asked for
/// no slanted leg climbs more, all photos are still taken in their order, every leg keeps its clearance, and the way is
/// longer.
#[test]
fn no_slanted_leg_is_steeper_than_was_asked() {
    let height = |x: f64| (30.0 - x.abs()).max(0.0);
    let surface = surface(|place| height(place.x));
    let plan = plan(&surface, 36.0, wish(Pattern::Slope));
    let slope = |leg: &[DVec3]| {
        let level = leg[0].truncate().distance(leg[1].truncate());
        ((leg[1].z - leg[0].z).abs().atan2(level).to_degrees(), level)
    };
    let free = flown(&plan, &surface, &pace());
    let steep = |way: &Way| {
        let corners = way.corners();
        let legs: Vec<(f64, f64)> = corners.windows(2).map(slope).collect();
        legs.into_iter()
            .filter(|(slope, level)| *level > 1e-3 && *slope > 20.0 + 1e-9)
            .count()
    };
    assert!(steep(&free) > 3, "{}", steep(&free));
    let gentle = Pace {
        steepest: Some(20.0),
        ..pace()
    };
    let way = flown(&plan, &surface, &gentle);
    assert_eq!(steep(&way), 0);
    let photos =
        |way: &Way| -> Vec<usize> { way.points.iter().filter_map(|point| point.photo).collect() };
    assert_eq!(photos(&way), photos(&free));
    assert!(way.length > free.length);
    let corners = way.corners();
    for leg in corners[1..corners.len() - 1].windows(2) {
        let count = (leg[0].distance(leg[1]) * 4.0).ceil().max(1.0);
        for step in 0..=count as u32 {
            let place = leg[0].lerp(leg[1], f64::from(step) / count);
            // To the flank that is nearer, whose top is the crest.
            let off = DVec2::new((place.x - 500_000.0).abs(), place.z - 30.0);
            let down = DVec2::new(1.0, -1.0) / 2.0_f64.sqrt();
            let over = off.distance(down * off.dot(down).max(0.0));
            assert!(over > 4.6, "{over} at {place}");
        }
    }
}

/// Up, down and level at their own speeds; a slanted leg as long as the slower of both needs.
#[test]
fn legs_take_their_time() {
    let pace = Pace::of(
        &Flying {
            speed: 8.0,
            climb: 5.0,
            descent: 2.0,
            ..Flying::default()
        },
        1.0,
    );
    let seconds = |x: f64, z: f64| pace.seconds(DVec3::ZERO, DVec3::new(x, 0.0, z));
    assert_eq!(seconds(40.0, 0.0), 5.0);
    assert_eq!(seconds(0.0, 40.0), 8.0);
    assert_eq!(seconds(0.0, -40.0), 20.0);
    // 3-4-5: 50 at 8 a second, or 30 up at 5, or 30 down at 2.
    assert_eq!(seconds(40.0, 30.0), 6.25);
    assert_eq!(seconds(40.0, -30.0), 15.0);
    // In feet the same numbers are three times as slow.
    let feet = Pace::of(&Flying::default(), 0.3048);
    assert!((feet.seconds(DVec3::ZERO, DVec3::NEG_Z) - 0.3048 / 3.0).abs() < 1e-12);
    // Upright and level legs are no slanted ones.
    let gentle = Pace {
        steepest: Some(10.0),
        ..pace
    };
    let is_steep = |x: f64, z: f64| gentle.is_too_steep(DVec3::ZERO, DVec3::new(x, 0.0, z));
    assert!(is_steep(10.0, 3.0) && is_steep(10.0, -3.0));
    assert!(!is_steep(10.0, 1.7) && !is_steep(0.0, 3.0) && !is_steep(10.0, 0.0));
}
