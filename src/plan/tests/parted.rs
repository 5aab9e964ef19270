//! Ways that are parted because a mission's file takes so many stops.

use super::*;

fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(500_000.0 + x, 5_000_000.0 + y)
}

/// A tower of 60 and an area to keep out of between the take-off and the field: each part of at most so many stops is a flight of
/// its own, out and home around the area and over the tower, and all of them take each photo once, in the one order.
#[test]
fn each_part_goes_out_and_comes_home() {
    let tower = DVec2::new(-70.0, 30.0);
    let surface = surface(|place| match place.distance(tower) < 1.5 {
        true => 60.0,
        false => 0.0,
    });
    let corners = [(-80.0, -30.0), (-65.0, -30.0), (-65.0, 15.0), (-80.0, 15.0)];
    let keep_out = Polygon::new(&corners.map(|(x, y)| at(x, y))).unwrap();
    let take_off = at(-100.0, 10.0);
    let wish = Wish {
        keep_out: vec![keep_out.clone()],
        take_off: Some(take_off),
        ..wish(Pattern::Slope)
    };
    let plan = plan(&surface, 50.0, wish);
    let whole = ways((&plan, &surface), take_off, None).unwrap();
    assert_eq!(whole.len(), 1);
    let pace = pace();
    let parts = Way::parted(&plan, &whole, &pace, &|way| way.points.len() <= 14).unwrap();
    assert!(parts.len() > 2, "{}", parts.len());
    let photos = |ways: &[Way]| -> Vec<usize> {
        let points = ways.iter().flat_map(|way| &way.points);
        points.filter_map(|point| point.photo).collect()
    };
    assert_eq!(photos(&parts), photos(&whole));
    for way in &parts {
        assert!(way.points.len() <= 14 && way.take_off == whole[0].take_off);
        let ends = [way.points.first(), way.points.last()].map(Option::unwrap);
        for end in ends {
            assert_eq!(end.place.z, way.safe_height);
        }
        let corners = way.corners();
        for leg in corners.windows(2) {
            let [from, to] = [leg[0], leg[1]].map(DVec3::truncate);
            assert!(keep_out.distance_to_leg(from, to) >= 5.0 - 1e-9, "{leg:?}");
            // Over the tower, or beside it.
            let top = (at(0.0, 0.0) + tower).extend(60.0);
            let steps = leg[0].distance(leg[1]).ceil().max(1.0) as u32;
            for step in 0..=steps {
                let place = leg[0].lerp(leg[1], f64::from(step) / f64::from(steps));
                let beside = place.truncate().distance(top.truncate());
                assert!(beside > 5.0 || place.z >= 65.0 - 1e-6, "{place}");
            }
        }
        // Its own length, and time: all legs at 4 a second, and 3 s a photo.
        let length: f64 = corners.windows(2).map(|leg| leg[0].distance(leg[1])).sum();
        assert!((way.length - length).abs() < 1e-9);
        let seconds = length / 4.0 + 3.0 * way.photos() as f64;
        assert!((way.seconds(&pace) - seconds).abs() < 1e-6);
    }
    // Where all stops fit the battery parts it as ever.
    let half = Pace {
        battery: Some(whole[0].seconds(&pace) / 2.0),
        ..pace
    };
    let by_battery = Way::parted(&plan, &whole, &half, &|_| true).unwrap();
    assert!(by_battery.len() > 1);
    let through = ways((&plan, &surface), take_off, half.battery).unwrap();
    assert_eq!(by_battery, through);
    let none = Way::parted(&plan, &whole, &pace, &|way| way.points.len() < 2).unwrap_err();
    assert!(
        none.what.contains("more stops than a mission takes"),
        "{none}"
    );
}
