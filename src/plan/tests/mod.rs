//! Plans over surfaces whose answers are known.

mod beyond;
mod flown;
mod legs;
mod missions;
mod parted;
mod random_surfaces;
mod surveys;

use glam::DVec3;

use super::*;
use crate::camera::Distortion;
use crate::geodesy::{Crs, Geographic};
use crate::surface::Cloud;
use crate::units::LengthUnit;

fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 600,
        height: 400,
        fx: 500.0,
        fy: 500.0,
        cx: 310.0,
        cy: 195.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}

fn surface(height: impl Fn(DVec2) -> f64) -> Surface {
    let points = (0..301 * 301).map(|i| {
        let place = DVec2::new(f64::from(i % 301), f64::from(i / 301)) - 150.0;
        (place + DVec2::new(500_000.0, 5_000_000.0)).extend(height(place))
    });
    let cloud = Cloud {
        points: points.collect(),
        ..Cloud::default()
    };
    Surface::new(cloud).unwrap()
}

fn square(half: f64) -> Polygon {
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    let corners = corners.map(|corner| DVec2::from(corner) + DVec2::new(500_000.0, 5_000_000.0));
    Polygon::new(&corners).unwrap()
}

fn wish(pattern: Pattern) -> Wish {
    Wish {
        pattern,
        size: Size::Scale {
            pixels: 25.0,
            within: Some(0.5),
        },
        overlap: 0.0,
        survey: SurveyWish::default(),
        gap: 0.1,
        tilt: 90.0,
        off_normal: 5.0,
        gimbal: [-90.0, 20.0],
        clearance: 5.0,
        keep_out: Vec::new(),
        errors: Positioning::Rtk.errors(1.0),
        take_off: None,
    }
}

fn plan(surface: &Surface, half: f64, wish: Wish) -> Plan {
    Plan::new(surface, &camera(), square(half), wish, &Progress::default()).unwrap()
}

fn ways(
    (plan, surface): (&Plan, &Surface),
    take_off: DVec2,
    battery: Option<f64>,
) -> Result<Vec<Way>, Fault> {
    let pace = Pace { battery, ..pace() };
    Way::through(plan, surface, take_off, &pace)
}

/// What a mission is told over a surface in that unit.
fn told(unit: LengthUnit) -> Told {
    Told {
        name: "pile".to_owned(),
        drone: None,
        unit,
        speed: 4.0,
        settle: 1.0,
        by_battery: true,
    }
}

/// As fast upright as level.
fn pace() -> Pace {
    Pace {
        speed: 4.0,
        stop: 3.0,
        battery: None,
        climb: 4.0,
        descent: 4.0,
        steepest: None,
    }
}

/// Each battery lasts, with one photo more it would not, and every photo is taken once, in the one order.
#[test]
fn a_way_is_cut_where_the_battery_ends() {
    let surface = surface(|_| 0.0);
    let plan = plan(&surface, 60.0, wish(Pattern::Slope));
    let take_off = DVec2::new(500_000.0 - 80.0, 5_000_000.0);
    let whole = ways((&plan, &surface), take_off, None).unwrap();
    let cut = ways((&plan, &surface), take_off, Some(120.0)).unwrap();
    assert!(cut.len() > 2, "{}", cut.len());
    let pace = pace();
    let photos = |ways: &[Way]| -> Vec<usize> {
        let points = ways.iter().flat_map(|way| &way.points);
        points.filter_map(|point| point.photo).collect()
    };
    assert_eq!(photos(&cut), photos(&whole));
    for way in &cut {
        assert!(way.seconds(&pace) <= 120.0);
        // Until the last photo, and home: over it up, level to the take-off, and down. 4 m/s.
        let last = way
            .points
            .iter()
            .rev()
            .find_map(|point| Some((point.photo?, point.place)));
        let (photo, place) = last.unwrap();
        let home = (way.safe_height - place.z)
            + place.truncate().distance(take_off)
            + (way.safe_height - way.take_off.z);
        let seconds = way.seconds_to(photo, &pace).unwrap() + home / 4.0;
        assert!((seconds - way.seconds(&pace)).abs() < 1e-9, "{seconds}");
        let reached = way
            .points
            .iter()
            .filter_map(|point| way.seconds_to(point.photo?, &pace));
        assert!(reached.is_sorted());
        // The level parts, the climb and the photos, by hand.
        let level: Vec<DVec2> = [take_off]
            .into_iter()
            .chain(way.points.iter().map(|point| point.place.truncate()))
            .chain([take_off])
            .collect();
        let level: f64 = level.windows(2).map(|leg| leg[0].distance(leg[1])).sum();
        let expected = (level + 2.0 * 20.0) / 4.0 + 3.0 * way.photos() as f64;
        assert!(
            (way.seconds(&pace) / expected - 1.0).abs() < 0.02,
            "{expected}"
        );
    }
    for way in &cut[..cut.len() - 1] {
        assert!(way.seconds(&pace) > 120.0 - 3.0 - 2.0 * 24.0 / 4.0);
    }
    let error = ways((&plan, &surface), take_off, Some(20.0)).unwrap_err();
    assert!(
        error.what.contains("a battery does not last to photo"),
        "{error}"
    );
}

/// On a plane that falls by 3 in 4 to the north-east every photo looks along the one normal, from the distance
/// f / s = 20, has the wished scale everywhere, and they lie edge to edge.
#[test]
fn an_inclined_plane_is_photographed_squarely() {
    let down = DVec2::new(1.0, 1.0).normalize();
    let surface = surface(|place| 300.0 - 0.75 * place.dot(down));
    let plan = plan(&surface, 40.0, wish(Pattern::Slope));
    assert!(plan.refused.is_empty());
    let normal = (down * 0.6).extend(0.8);
    for (number, photo) in plan.photos.iter().enumerate() {
        let axis = photo.pose.rotation * DVec3::Z;
        assert!(axis.distance(-normal) < 1e-6, "{axis}");
        assert!((photo.tilt - 53.130_102).abs() < 1e-4 && (photo.pan - 225.0).abs() < 1e-4);
        assert!((photo.distance - 20.0).abs() < 1e-4, "{}", photo.distance);
        let forecast = photo.forecast.unwrap();
        assert!((forecast.least - 25.0).abs() < 1e-4 && (forecast.greatest - 25.0).abs() < 1e-4);
        assert_eq!(forecast.covered, 1.0);
        assert_eq!(plan.troubles(number), Vec::<String>::new());
    }
    // Footprints are 24 x 16: strips of 24 across the fall over a square of diagonal 113.1, and 16 down along the
    // ground, which is 1.25 times as long as its map.
    let strips = (113.137_f64 / 24.0).ceil() as usize;
    assert!(plan.photos.len() >= 6400 * 5 / 4 / (24 * 16));
    assert!(plan.photos.len() <= strips * (113.137_f64 * 1.25 / 16.0).ceil() as usize);
    assert!(plan.cover.covered > 0.995, "{:?}", plan.cover.covered);
    assert!(plan.cover.widest_gap < 1.6, "{}", plan.cover.widest_gap);
    let shared = plan.cover.shared.iter().copied().fold(0.0, f64::max);
    assert!(shared < 0.12, "{shared}");
}

/// A ridge: both sides are photographed squarely, and no leg comes near the ground.
#[test]
fn a_ridge_is_photographed_on_both_sides_and_flown_over() {
    let surface = surface(|place| (30.0 - 0.8 * place.x.abs()).max(0.0));
    let take_off = DVec2::new(500_000.0 - 100.0, 5_000_000.0);
    let mut wish = wish(Pattern::Slope);
    wish.take_off = Some(take_off);
    let plan = plan(&surface, 36.0, wish);
    let looks = |pan: f64| {
        plan.photos
            .iter()
            .filter(move |photo| (photo.pan - pan).abs() < 1.0 && photo.tilt < 60.0)
    };
    // Uphill is east on the western side.
    assert!(looks(90.0).count() > 4 && looks(270.0).count() > 4);
    let [way] = &ways((&plan, &surface), take_off, None).unwrap()[..] else {
        panic!("one way");
    };
    assert_eq!(way.photos(), plan.photos.len());
    assert!(way.safe_height >= 5.0);
    // Against the ridge itself, in steps of a decimetre.
    let ground = |place: DVec3| (30.0 - 0.8 * (place.x - 500_000.0).abs()).max(0.0);
    for leg in way.points.windows(2) {
        let (from, to) = (leg[0].place, leg[1].place);
        let count = (from.distance(to) * 10.0).ceil();
        for step in 0..=count as u32 {
            let place = from.lerp(to, f64::from(step) / count);
            // The distance to a flank of slope 0.8.
            let over = (place.z - ground(place)) / 0.8_f64.hypot(1.0);
            assert!(over > 4.6, "{over} at {place}");
        }
    }
}

/// Beside a wall of 40 a photo at half its height is as far from it as along the map, wherever pixels lie.
#[test]
fn a_wall_is_as_near_as_its_face() {
    let surface = surface(|place| if place.x > 40.0 { 40.0 } else { 0.0 });
    let mut wish = wish(Pattern::Paper);
    wish.size = Size::Distance(12.0);
    let plan = plan(&surface, 39.0, wish);
    assert!(
        plan.photos
            .iter()
            .any(|photo| photo.pose.center.x > 500_020.0)
    );
    assert!(
        plan.refused
            .iter()
            .any(|refused| refused.why.contains("clearance"))
    );
    for photo in &plan.photos {
        // The wall rises from 40 to 41.
        let beside = 500_040.0 - photo.pose.center.x;
        assert!(
            beside > 4.9 || photo.pose.center.z > 44.0,
            "{}",
            photo.pose.center
        );
    }
}

/// What of the area lies beside the surface is not photographed.
#[test]
fn an_area_beside_the_surface_is_not_covered() {
    let surface = surface(|_| 0.0);
    let mut wish = wish(Pattern::Slope);
    wish.overlap = 0.1;
    let corners = [(100.0, -50.0), (200.0, -50.0), (200.0, 50.0), (100.0, 50.0)];
    let corners = corners.map(|corner| DVec2::from(corner) + DVec2::new(500_000.0, 5_000_000.0));
    let area = Polygon::new(&corners).unwrap();
    let plan = Plan::new(&surface, &camera(), area, wish, &Progress::default()).unwrap();
    assert!(
        (plan.cover.off_surface - 0.5).abs() < 0.01,
        "{:?}",
        plan.cover.off_surface
    );
    assert!(
        (plan.cover.covered - 0.5).abs() < 0.02,
        "{}",
        plan.cover.covered
    );
}

/// The gimbal of most drones does not look up a wall; those photos are named, not planned.
#[test]
fn what_the_gimbal_cannot_do_is_refused() {
    let surface = surface(|place| (place.x * 1.5).clamp(-30.0, 30.0));
    let mut wish = wish(Pattern::Slope);
    wish.gimbal = [-90.0, -60.0];
    let plan = plan(&surface, 45.0, wish);
    assert!(!plan.refused.is_empty());
    for refused in &plan.refused {
        assert!(refused.why.contains("gimbal"), "{}", refused.why);
    }
}

/// 25.51 of 25 ± 0.5 px/m is off by 2.04 % where 2 % were asked for: nobody reads "2 %, not 2 %".
#[test]
fn a_trouble_is_told_apart_from_its_limit() {
    let surface = surface(|_| 0.0);
    let mut plan = plan(&surface, 20.0, wish(Pattern::Slope));
    assert_eq!(plan.troubles(0), Vec::<String>::new());
    plan.photos[0].forecast.as_mut().unwrap().bulk = [25.0, 25.51];
    let scales = "98 % of its scales are only within 2.04 % of the wished one, not 2.00 %";
    assert_eq!(plan.troubles(0), [scales]);
    plan.photos[0].forecast.as_mut().unwrap().bulk = [24.0, 25.0];
    let scales = "98 % of its scales are only within 4 % of the wished one, not 2 %";
    assert_eq!(plan.troubles(0), [scales]);
    plan.photos[0].off_normal = 5.3;
    assert_eq!(
        plan.troubles(0)[1],
        "its axis is 5.3 degrees off the normal, more than 5.0"
    );
}

/// The paper's rows: one height, one tilt, every second row flown the other way.
#[test]
fn rows_have_one_height() {
    let surface = surface(|place| 0.1 * place.x);
    let mut wish = wish(Pattern::Paper);
    wish.tilt = 83.0;
    wish.size = Size::Distance(20.0);
    let plan = plan(&surface, 40.0, wish);
    let height = plan.photos[0].pose.center.z;
    for photo in &plan.photos {
        assert!((photo.pose.center.z - height).abs() < 1e-9);
        assert!((photo.tilt - 83.0).abs() < 1e-12);
    }
    let pans: std::collections::BTreeSet<i64> = plan
        .photos
        .iter()
        .map(|photo| photo.pan.round() as i64)
        .collect();
    assert_eq!(pans.len(), 2);
    // So high above the highest of the area, 4 at its eastern corners; the image's middle is near the principal point.
    assert!((height - 24.0).abs() < 0.2, "{height}");
}

#[test]
fn no_wish_is_refused() {
    let surface = surface(|_| 0.0);
    let refused = |change: fn(&mut Wish)| {
        let mut wish = wish(Pattern::Slope);
        change(&mut wish);
        let made = Plan::new(
            &surface,
            &camera(),
            square(20.0),
            wish,
            &Progress::default(),
        );
        made.unwrap_err().what
    };
    assert!(refused(|wish| wish.overlap = 1.0).contains("overlap"));
    assert!(refused(|wish| wish.tilt = 0.0).contains("tilt"));
    assert!(refused(|wish| wish.size = Size::Distance(f64::NAN)).contains("positive"));
    let tiny = Size::Scale {
        pixels: 1e5,
        within: None,
    };
    let mut wish = wish(Pattern::Slope);
    wish.size = tiny;
    let made = Plan::new(
        &surface,
        &camera(),
        square(40.0),
        wish,
        &Progress::default(),
    );
    assert!(made.unwrap_err().what.contains("more than"));
}

/// Poles of one point each under legs of a flight without them, and a wall of one row of points, all with ground close
/// around, so that no pixel of the terrain has its middle on one: photos and legs keep the clearance from every point.
#[test]
fn what_is_thin_is_flown_around() {
    let take_off = DVec2::new(500_000.0 - 60.0, 5_000_000.0 - 60.0);
    let flat = surface(|_| 0.0);
    let free = plan(&flat, 60.0, wish(Pattern::Slope));
    let legs = ways((&free, &flat), take_off, None)
        .unwrap()
        .remove(0)
        .corners();
    let middle = |leg: usize, z: f64| legs[leg].midpoint(legs[leg + 1]) + DVec3::new(0.37, 0.21, z);
    let poles = [middle(3, -4.5), middle(5, -1.0), middle(8, 3.0)];
    let foot = middle(10, -2.0);
    let wall = (0..40).map(|i| foot + DVec3::new(0.0, 0.3 * f64::from(i), 0.0));
    let thin: Vec<DVec3> = poles.into_iter().chain(wall).collect();
    let nearest = |corners: &[DVec3]| {
        let legs = corners[1..corners.len() - 1].windows(2);
        let off = legs.flat_map(|leg| {
            thin.iter().map(|point| {
                let along = leg[1] - leg[0];
                let share = (*point - leg[0]).dot(along) / along.length_squared().max(1e-9);
                leg[0].lerp(leg[1], share.clamp(0.0, 1.0)).distance(*point)
            })
        });
        off.fold(f64::INFINITY, f64::min)
    };
    assert!(nearest(&legs) < 2.0);
    let close = thin.iter().flat_map(|point| {
        let off = [(-0.03, 0.0), (0.03, 0.0), (0.0, -0.03), (0.0, 0.03)];
        off.map(|(x, y)| (point.truncate() + DVec2::new(x, y)).extend(0.0))
    });
    let surface = Surface::new(Cloud {
        points: flat
            .vertices()
            .chain(close)
            .chain(thin.iter().copied())
            .collect(),
        ..Cloud::default()
    })
    .unwrap();
    let plan = plan(&surface, 60.0, wish(Pattern::Slope));
    let way = ways((&plan, &surface), take_off, None).unwrap().remove(0);
    assert!(plan.photos.len() > 8, "{}", plan.photos.len());
    let off = nearest(&way.corners());
    assert!(off >= 5.0, "{off}");
}

/// A square across the field, between the take-off and some photos: none is taken above it or near it, no leg leads over
/// it, at safe height neither, and the mission has it as a fence.
#[test]
fn what_is_kept_out_of_is_flown_around() {
    let surface = surface(|_| 0.0);
    let at = |x: f64, y: f64| DVec2::new(500_000.0 + x, 5_000_000.0 + y);
    let corners = [
        at(-30.0, -20.0),
        at(-5.0, -20.0),
        at(-5.0, 20.0),
        at(-30.0, 20.0),
    ];
    let keep_out = Polygon::new(&corners).unwrap();
    let free = plan(&surface, 60.0, wish(Pattern::Slope));
    let wish = Wish {
        keep_out: vec![keep_out.clone()],
        ..wish(Pattern::Slope)
    };
    let plan = plan(&surface, 60.0, wish);
    let is_near = |place: DVec3| keep_out.distance_to_leg(place.truncate(), place.truncate()) < 5.0;
    let near = free
        .photos
        .iter()
        .filter(|photo| is_near(photo.pose.center))
        .count();
    assert!(near > 3, "{near}");
    assert_eq!(plan.refused.len(), near);
    assert!(
        plan.refused[0].why.contains("keep out"),
        "{}",
        plan.refused[0].why
    );
    let ways = ways((&plan, &surface), at(-80.0, 0.0), None).unwrap();
    let take_off = at(-80.0, 0.0).extend(0.0);
    let places = ways[0].points.iter().map(|point| point.place);
    let all: Vec<DVec3> = [take_off]
        .into_iter()
        .chain(places)
        .chain([take_off])
        .collect();
    for leg in all.windows(2) {
        let off = keep_out.distance_to_leg(leg[0].truncate(), leg[1].truncate());
        assert!(off >= 5.0 - 1e-9, "{off}: {leg:?}");
    }
    assert_eq!(ways[0].photos(), plan.photos.len());
    let crs = Crs::understand("EPSG:32632").unwrap();
    let told = told(LengthUnit::Metre);
    let (_, mission) = missions(&plan, &ways, &crs, &told).unwrap().remove(0);
    assert!(!mission.fences[0].keep_in && mission.fences[0].corners.len() == 4);
    // From inside nobody takes off.
    let pace = Pace::of(&Flying::default(), 1.0);
    let inside = Way::through(&plan, &surface, at(-10.0, 0.0), &pace).unwrap_err();
    assert!(inside.what.contains("keep out"), "{inside}");
}

/// On a plane of any slope, the camera along its normal n from the distance d: an error e of the place changes the depth
/// by n e, and turning by a small angle nothing to first order. So the share is sqrt(n' S n) / d.
#[test]
fn the_interval_of_a_scale_is_that_of_its_distance() {
    for slope in [0.0, 0.4] {
        let surface = surface(|place| slope * place.x);
        for pattern in Positioning::ALL {
            let wish = Wish {
                errors: pattern.errors(1.0),
                ..wish(Pattern::Slope)
            };
            let plan = plan(&surface, 40.0, wish.clone());
            let [x, z] = [slope / slope.hypot(1.0), 1.0 / slope.hypot(1.0)];
            let error = (x * wish.errors.level).hypot(z * wish.errors.upright);
            for photo in &plan.photos {
                let expected = 100.0 * 1.96 * error / photo.distance;
                let found = photo.interval.unwrap();
                assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
            }
        }
    }
}

/// A photo that is moved looks squarely at its new place, from where the scale is the wished one; the others stay.
#[test]
fn photos_are_moved_added_and_left_out() {
    let surface = surface(|place| 0.3 * place.y);
    let before = plan(&surface, 60.0, wish(Pattern::Slope));
    let progress = Progress::default();
    let to = DVec2::new(500_000.0 + 13.0, 5_000_000.0 - 7.0);
    let after = before.with_photo_at(2, to, &surface, &progress).unwrap();
    let moved = &after.photos[2];
    assert!(moved.target.truncate().distance(to) < 1e-9);
    assert_eq!(moved.name, before.photos[2].name);
    let forecast = moved.forecast.as_ref().unwrap();
    let [least, greatest] = forecast.bulk;
    assert!(
        ((least + greatest) / 2.0 / 25.0 - 1.0).abs() < 1e-3,
        "{least} {greatest}"
    );
    assert!(moved.off_normal < 1e-6, "{}", moved.off_normal);
    let others = |plan: &Plan| -> Vec<PlannedPhoto> {
        let photos = plan.photos.iter().enumerate();
        photos
            .filter(|(at, _)| *at != 2)
            .map(|(_, photo)| photo.clone())
            .collect()
    };
    assert_eq!(others(&after), others(&before));
    assert!(after.cover.covered < before.cover.covered);
    // Once more beside itself, it shares all that it shows.
    let more = before
        .with_photo(before.photos[4].target.truncate(), &surface, &progress)
        .unwrap();
    assert_eq!(more.photos.len(), before.photos.len() + 1);
    let twins = [4, 5].map(|at| more.cover.shared[at]);
    assert!(twins.iter().all(|shared| *shared > 0.99), "{twins:?}");
    let names: std::collections::HashSet<&str> = more
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect();
    assert_eq!(names.len(), more.photos.len());
    let less = more.without_photo(4);
    assert_eq!(less.photos.len(), before.photos.len());
    // Beyond the surface nothing is photographed.
    let off = before
        .with_photo_at(0, to + 4000.0, &surface, &progress)
        .unwrap_err();
    assert!(off.what.contains("beyond the surface"), "{off}");
}

/// A wall 10 m high along x = 0, the ground behind it as high: the sun in the east at 45 degrees leaves 10 m in front of it in
/// shadow, of 60 m; in the west none; at night all.
#[test]
fn a_wall_throws_its_shadow() {
    let surface = surface(|place| if place.x < 0.0 { 0.0 } else { 10.0 });
    let plan = plan(&surface, 30.0, wish(Pattern::Paper));
    let sun = |x: f64, z: f64| Sun {
        elevation: z.atan2(x.abs()).to_degrees(),
        azimuth: 90.0,
        toward: DVec3::new(x, 0.0, z).normalize(),
    };
    let east = plan.shadows(&sun(1.0, 1.0));
    assert!((east.area - 1.0 / 6.0).abs() < 0.025, "{}", east.area);
    assert_eq!(plan.shadows(&sun(-1.0, 1.0)).area, 0.0);
    assert_eq!(plan.shadows(&sun(1.0, -0.1)).area, 1.0);
    assert_eq!(east.photos.len(), plan.photos.len());
    let [min, max] = [0.0_f64, 1.0].map(|end| {
        (east.photos.iter().copied()).fold(
            1.0 - end,
            |a, b| if end == 0.0 { a.min(b) } else { a.max(b) },
        )
    });
    assert!(min < 0.01 && max > 0.2, "{min} {max}");
}

/// Waves leave gaps between photos that lie edge to edge; filled, none is wider than was wished, but for the photos that are
/// refused, and names are in the order of the flight.
#[test]
fn gaps_are_filled() {
    let surface = surface(|place| 4.0 * (place.x / 9.0).sin() * (place.y / 7.0).cos());
    let before = plan(&surface, 50.0, wish(Pattern::Slope));
    assert!(before.has_wide_gap(), "{}", before.cover.widest_gap);
    let after = before
        .with_gaps_filled(&surface, &Progress::default())
        .unwrap();
    assert!(!after.has_wide_gap(), "{}", after.cover.widest_gap);
    assert!(after.photos.len() > before.photos.len());
    assert!(after.cover.covered > before.cover.covered);
    let names: Vec<&str> = after
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect();
    assert!(names.is_sorted(), "{names:?}");
    // The photos that were there stay as they are.
    let stays = |photo: &PlannedPhoto| after.photos.iter().any(|other| other.pose == photo.pose);
    assert!(before.photos.iter().all(stays));
    // None is wide: nothing is done.
    let again = after
        .with_gaps_filled(&surface, &Progress::default())
        .unwrap();
    assert_eq!(again.photos, after.photos);
}
