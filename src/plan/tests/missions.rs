//! Ways as missions: degrees, headings, metres above the take-off.

use super::*;

/// In UTM at the zone's edge north of the grid is not north: headings are from true north, heights from take-off.
#[test]
fn a_mission_is_told_in_degrees() {
    let surface = surface(|place| if place.y < -50.0 { 97.0 } else { 100.0 });
    let plan = plan(&surface, 20.0, wish(Pattern::Slope));
    let way = ways(
        (&plan, &surface),
        DVec2::new(500_000.0, 5_000_000.0 - 60.0),
        None,
    )
    .unwrap()
    .remove(0);
    let crs = Crs::understand("EPSG:32632").unwrap();
    let told = told(LengthUnit::Metre);
    let (_, mission) = missions(&plan, std::slice::from_ref(&way), &crs, &told)
        .unwrap()
        .remove(0);
    assert_eq!(mission.stops.len(), way.points.len());
    // Up before the first photo and behind the last, for every ground station.
    for stop in [mission.stops.first(), mission.stops.last()] {
        let stop = stop.unwrap();
        assert_eq!(Some(stop.height.metres), mission.safe_height);
    }
    for (stop, point) in mission.stops.iter().zip(&way.points) {
        // In the middle of zone 32: 9 degrees east, and 45.15 north by pyproj.
        assert!((stop.longitude - 9.0).abs() < 1e-3 && (stop.latitude - 45.1536).abs() < 1e-3);
        assert!((stop.height.metres - (point.place.z - 97.0)).abs() < 1e-9);
        let Some(photo) = point.photo.map(|photo| &plan.photos[photo]) else {
            continue;
        };
        assert!((stop.gimbal_pitch.unwrap() + photo.tilt).abs() < 1e-12);
        // On the zone's middle meridian, to its convergence 20 m beside.
        let off = (stop.heading.unwrap() - photo.pan + 180.0).rem_euclid(360.0) - 180.0;
        assert!(off.abs() < 1e-3, "{off}");
    }
    // 3 degrees off the middle meridian at 50 degrees north: convergence 3 sin 50 = 2.298 degrees.
    let east = Geographic {
        longitude: 12.0,
        latitude: 50.0,
        height: 0.0,
    };
    let north = mission::true_heading(0.0, &crs, east).unwrap();
    assert!((north - 2.298).abs() < 0.01, "{north}");
}

/// Between one photo and home stands a bank that no leg crosses: straight home leads over it, with the clearance.
#[test]
fn the_way_home_is_over_all_that_stands_there() {
    let surface = surface(|place| {
        if place.x > 40.0 && place.y < 0.0 {
            160.0
        } else {
            100.0
        }
    });
    let mut plan = plan(&surface, 20.0, wish(Pattern::Slope));
    let home = DVec2::new(500_000.0, 5_000_000.0 - 60.0);
    let mut way = ways((&plan, &surface), home, None).unwrap();
    let low = return_height(&plan, &way).unwrap();
    assert_eq!(low, way[0].safe_height, "nothing higher stands there");
    let mut beyond = plan.photos[0].clone();
    beyond.pose.center = DVec3::new(500_100.0, 5_000_000.0 - 60.0, 170.0);
    way[0].points.push(WayPoint {
        place: beyond.pose.center,
        photo: Some(plan.photos.len()),
    });
    plan.photos.push(beyond);
    let high = return_height(&plan, &way).unwrap();
    let wanted = 160.0 + plan.wish.clearance;
    assert!((wanted..wanted + 0.5).contains(&high), "{high} {wanted}");
}

/// A tower between home and the middle of a leg, which no line from a stop to home comes near, from a photo to a place without
/// one: the drone may be called home there. Beside the triangle of leg and home a tower stands in no way.
#[test]
fn the_way_home_from_between_stops_is_over_all_that_stands_there() {
    let home = DVec2::new(500_000.0, 5_000_000.0 - 60.0);
    let at = |x: f64| DVec3::new(500_000.0 + x, 5_000_000.0, 120.0);
    for (tower, stands_in_it) in [
        ((10.0, -10.0), true),
        ((-30.0, -12.0), true),
        ((0.0, 4.0), true),
        ((0.0, 9.0), false),
        ((45.0, -12.0), false),
        ((-20.0, -48.0), false),
    ] {
        let surface = surface(|place| match place == DVec2::from(tower) {
            true => 145.0,
            false => 100.0,
        });
        let mut plan = plan(&surface, 20.0, wish(Pattern::Slope));
        let mut way = ways((&plan, &surface), home, None).unwrap();
        plan.photos.truncate(1);
        plan.photos[0].pose.center = at(-40.0);
        way[0].points = [(-40.0, Some(0)), (40.0, None)]
            .map(|(x, photo)| WayPoint {
                place: at(x),
                photo,
            })
            .to_vec();
        way[0].safe_height = 120.0;
        let height = return_height(&plan, &way).unwrap();
        let wanted = match stands_in_it {
            true => 145.0 + plan.wish.clearance,
            false => 120.0,
        };
        assert!((height - wanted).abs() < 1e-6, "{tower:?}: {height}");
    }
}

/// An area to keep out of between the photos and home: the way goes around it, the straight way home would not, and the drone is
/// told to hover where the radio is lost. Of a take-off on the other side nothing lies between.
#[test]
fn a_lost_radio_does_not_lead_over_what_is_kept_out_of() {
    let surface = surface(|_| 100.0);
    let mut wish = wish(Pattern::Slope);
    let corner = |x: f64, y: f64| DVec2::new(500_000.0 + x, 5_000_000.0 + y);
    let area = [(-30.0, -50.0), (30.0, -50.0), (30.0, -35.0), (-30.0, -35.0)];
    wish.keep_out = vec![Polygon::new(&area.map(|(x, y)| corner(x, y))).unwrap()];
    let plan = plan(&surface, 20.0, wish);
    let crs = Crs::understand("EPSG:32632").unwrap();
    for (y, crosses) in [(-80.0, true), (80.0, false)] {
        let ways = ways((&plan, &surface), corner(0.0, y), None).unwrap();
        let home = ways[0].take_off.truncate();
        // Straight lines from the stops by hand, for the area lies along x: which pass y = -35 nearer to it than the clearance.
        let by_hand = ways[0].points.iter().filter(|point| {
            let from = point.place.truncate();
            let share = (4_999_965.0 - from.y) / (home.y - from.y);
            let x = from.x + share * (home.x - from.x) - 500_000.0;
            (0.0..=1.0).contains(&share) && x.abs() < 30.0
        });
        let least = by_hand.count();
        let found = homes_over_keep_out(&plan, &ways);
        assert!(found >= least && (least > 0) == crosses && (found > 0) == crosses);
        let (_, mission) = missions(&plan, &ways, &crs, &told(LengthUnit::Metre))
            .unwrap()
            .remove(0);
        let wanted = match crosses {
            true => LostSignal::Hover,
            false => LostSignal::ReturnHome,
        };
        assert_eq!(mission.lost_signal, Some(wanted));
    }
}

/// Over a surface in US survey feet a mission's heights are metres.
#[test]
fn a_mission_over_feet_is_told_in_metres() {
    let surface = surface(|_| 100.0);
    let plan = plan(&surface, 20.0, wish(Pattern::Slope));
    let take_off = DVec2::new(500_000.0, 5_000_000.0 - 60.0);
    let way = ways((&plan, &surface), take_off, None).unwrap().remove(0);
    let crs = "+proj=utm +zone=32 +datum=WGS84 +units=us-ft +no_defs";
    let crs = Crs::understand(crs).unwrap();
    let told = told(LengthUnit::UsSurveyFoot);
    let (_, mission) = missions(&plan, std::slice::from_ref(&way), &crs, &told)
        .unwrap()
        .remove(0);
    // A system in metres is not that of the surface.
    let metres = Crs::understand("EPSG:32632").unwrap();
    let refused = missions(&plan, std::slice::from_ref(&way), &metres, &told).unwrap_err();
    assert!(refused.what.contains("us-ft"), "{refused}");
    let foot = 1200.0 / 3937.0;
    for (stop, point) in mission.stops.iter().zip(&way.points) {
        let expected = (point.place.z - 100.0) * foot;
        assert!((stop.height.metres - expected).abs() < 1e-9, "{expected}");
    }
    // Photos from 20 feet, of which one is 0.3048006 m.
    let photo = mission
        .stops
        .iter()
        .find(|stop| stop.photo.is_some())
        .unwrap();
    assert!(
        (photo.height.metres - 6.096_012).abs() < 1e-4,
        "{}",
        photo.height.metres
    );
}

/// A surface has its heights in the unit of x and y, also where its system states feet for them: a mission's metres are those
/// of the surface, and read back its photos are where they were planned.
#[test]
fn a_systems_unit_of_heights_does_not_count() {
    let surface = surface(|_| 100.0);
    let plan = plan(&surface, 20.0, wish(Pattern::Slope));
    let take_off = DVec2::new(500_000.0, 5_000_000.0 - 60.0);
    let way = ways((&plan, &surface), take_off, None).unwrap().remove(0);
    let crs = Crs::understand("EPSG:32632+6360").unwrap();
    assert!((crs.vertical_unit_metres() - 1200.0 / 3937.0).abs() < 1e-12);
    let told = told(LengthUnit::Metre);
    let (_, mission) = missions(&plan, std::slice::from_ref(&way), &crs, &told)
        .unwrap()
        .remove(0);
    for (stop, point) in mission.stops.iter().zip(&way.points) {
        let height = stop.height.metres;
        assert!((height - (point.place.z - 100.0)).abs() < 1e-9, "{height}");
    }
    let back = planned_poses(&mission, &crs, Some(take_off), |_| Some(100.0)).unwrap();
    assert_eq!(back.len(), plan.photos.len());
    for planned in &back {
        let own = plan.photos.iter().find(|photo| photo.name == planned.name);
        let off = own.unwrap().pose.center.distance(planned.pose.center);
        assert!(off < 1e-3, "{}: {off}", planned.name);
    }
}
