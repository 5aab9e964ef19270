//! Planned against flown: which photo is which planned one.

use super::*;
use crate::camera::Pose;

/// A place of the surface's middle.
fn at_corner(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(499_940.0 + x, 4_999_940.0 + y, z)
}

/// Rows straight down, and at each end two stops 0.3 apart that look aslant two ways, as a ring's corners have; all photos are
/// off by 1 and 0.5, and 48 higher, as heights above the ellipsoid are. With the camera's own names, with one photo that was
/// not taken and one more; in disorder, too, and named as DJI adds names.
#[test]
fn what_all_photos_are_off_does_not_count() {
    let (camera, surface) = (camera(), surface(|_| 5.0));
    let mut planned = Vec::new();
    for row in 0..4 {
        for at in 0..6 {
            let y = 40.0 + 4.0 * f64::from(at);
            let center = at_corner(40.0 + 6.0 * f64::from(row), y, 25.0);
            planned.push(Pose::from_tilt_pan(
                center,
                [90.0, 180.0 * f64::from(row % 2)],
            ));
        }
        for turn in 0..2 {
            let center = at_corner(
                30.0 + 0.3 * f64::from(turn),
                30.0 + 6.0 * f64::from(row),
                20.0,
            );
            planned.push(Pose::from_tilt_pan(
                center,
                [55.0, 30.0 + 25.0 * f64::from(turn)],
            ));
        }
    }
    let planned: Vec<PlannedPose> = (planned.into_iter().zip(1..))
        .map(|(pose, number)| PlannedPose {
            name: format!("S{number:03}"),
            pose,
        })
        .collect();
    let missing = 9;
    let flown = |off: DVec3| -> Vec<Pose> {
        let poses = planned
            .iter()
            .enumerate()
            .filter(|(number, _)| *number != missing);
        let moved = poses.map(|(_, plan)| Pose {
            center: plan.pose.center + off,
            ..plan.pose
        });
        let more = Pose::from_tilt_pan(at_corner(100.0, 100.0, 30.0) + off, [10.0, 0.0]);
        moved.chain([more]).collect()
    };
    let paired = |poses: &[Pose], names: &[String]| {
        let taken: Vec<Taken<'_>> = (poses.iter().zip(names))
            .map(|(pose, name)| Taken {
                name,
                pose,
                camera: &camera,
            })
            .collect();
        let found = Flown::compare(&planned, &taken, &surface, &Progress::default()).unwrap();
        let photos = found.residuals.iter().map(|own| own.map(|own| own.photo));
        photos.collect::<Vec<_>>()
    };
    let wanted: Vec<Option<usize>> = (0..planned.len())
        .map(|number| match number.cmp(&missing) {
            std::cmp::Ordering::Less => Some(number),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(number - 1),
        })
        .collect();
    let count = planned.len();
    // Without leading zeros: 2 comes before 10.
    let in_order: Vec<String> = (0..count).map(|n| format!("DJI_{}.JPG", n + 1)).collect();
    let in_disorder: Vec<String> = (0..count)
        .map(|n| format!("{}.JPG", n * 13 % count))
        .collect();
    for off in [
        DVec3::ZERO,
        DVec3::new(1.0, 0.5, 0.0),
        DVec3::new(1.0, 0.5, 48.3),
    ] {
        let poses = flown(off);
        assert_eq!(paired(&poses, &in_order), wanted, "{off}");
        assert_eq!(paired(&poses, &in_disorder), wanted, "{off}");
    }
    // By names, wherever they are: the mission's behind DJI's own, of those that were taken.
    let poses = flown(DVec3::new(9.0, 9.0, 9.0));
    let named: Vec<String> = (wanted.iter().enumerate())
        .filter(|(_, photo)| photo.is_some())
        .map(|(number, _)| format!("DJI_20260601_0001_{}.JPG", planned[number].name))
        .collect();
    assert_eq!(paired(&poses[..count - 1], &named), wanted);
}

/// Photos in a row nearer together than each is off by itself: their order tells which is which, and one that was
/// taken again at the end is of the plan that has none.
#[test]
fn an_order_decides_between_photos_that_are_alike() {
    let (camera, surface) = (camera(), surface(|_| 5.0));
    let planned: Vec<PlannedPose> = (0..20)
        .map(|number| PlannedPose {
            name: format!("S{number:03}"),
            pose: Pose::from_tilt_pan(at_corner(40.0 + f64::from(number), 60.0, 25.0), [90.0, 0.0]),
        })
        .collect();
    // Off by up to 1.4 along the row, in a pattern that has no order.
    let poses: Vec<Pose> = (planned.iter().zip(0_u32..))
        .map(|(plan, number)| {
            let off = f64::from(number * 7 % 10) * 0.28 - 1.26;
            Pose {
                center: plan.pose.center + DVec3::new(off, 0.0, 0.0),
                ..plan.pose
            }
        })
        .collect();
    let names: Vec<String> = (1..=20)
        .map(|number| format!("DJI_{number:04}.JPG"))
        .collect();
    let paired = |poses: &[Pose]| -> Vec<usize> {
        let taken = poses.iter().zip(&names).map(|(pose, name)| Taken {
            name,
            pose,
            camera: &camera,
        });
        let taken: Vec<Taken<'_>> = taken.collect();
        let found = Flown::compare(&planned, &taken, &surface, &Progress::default()).unwrap();
        let found = found.residuals.iter().flatten();
        found.map(|own| own.photo).collect()
    };
    assert_eq!(paired(&poses), (0..20).collect::<Vec<_>>());
    // The sixth was taken last: those between are not moved on by one.
    let mut late: Vec<Pose> = planned.iter().map(|plan| plan.pose).collect();
    let sixth = late.remove(5);
    late.push(sixth);
    let wanted: Vec<usize> = (0..5).chain([19]).chain(5..19).collect();
    assert_eq!(paired(&late), wanted);
}

/// A number from -1 to 1 that has no order, for each photo and axis.
fn noise(number: usize, axis: usize) -> f64 {
    (number as f64 * 7.31 + axis as f64 * 3.7 + 1.0).sin()
}

fn straight_down(center: DVec3) -> Pose {
    Pose::from_tilt_pan(center, [90.0, 0.0])
}

/// Which photo each planned one is found to be.
fn found(
    surface: &Surface,
    planned: &[DVec3],
    flown: &[DVec3],
    name: fn(usize) -> String,
) -> Vec<Option<usize>> {
    let camera = camera();
    let planned: Vec<PlannedPose> = (planned.iter().zip(1..))
        .map(|(center, number)| PlannedPose {
            name: format!("S{number:03}"),
            pose: straight_down(*center),
        })
        .collect();
    let poses: Vec<Pose> = flown.iter().copied().map(straight_down).collect();
    let names: Vec<String> = (0..flown.len()).map(name).collect();
    let taken: Vec<Taken<'_>> = (poses.iter().zip(&names))
        .map(|(pose, name)| Taken {
            name,
            pose,
            camera: &camera,
        })
        .collect();
    let found = Flown::compare(&planned, &taken, surface, &Progress::default()).unwrap();
    let photos = found.residuals.iter().map(|own| own.map(|own| own.photo));
    photos.collect()
}

fn in_order(number: usize) -> String {
    format!("DJI_{:04}.JPG", number + 1)
}

/// 2 m and 3 m apart rows to and fro; every photo is off by the same, more than half of that, and a little by itself. Also where
/// names have no order, and where one photo was not taken. The same rows 300 m away are none of them.
#[test]
fn what_all_are_off_may_be_more_than_half_a_spacing() {
    let surface = surface(|_| 5.0);
    let mut planned = Vec::new();
    for row in 0..5 {
        for at in 0..10 {
            let at = if row % 2 == 0 { at } else { 9 - at };
            planned.push(at_corner(
                50.0 + 2.0 * f64::from(at),
                50.0 + 3.0 * f64::from(row),
                35.0,
            ));
        }
    }
    let flown = |off: DVec3| -> Vec<DVec3> {
        let places = planned.iter().enumerate();
        let own = |number| DVec3::from_array([0, 1, 2].map(|axis| 0.2 * noise(number, axis)));
        places
            .map(|(number, place)| *place + off + own(number))
            .collect()
    };
    let disorder = |number: usize| format!("{}.JPG", number * 13 % 50);
    let all: Vec<Option<usize>> = (0..50).map(Some).collect();
    for off in [
        (1.5, 0.0, 0.0),
        (1.2, 0.6, 0.5),
        (0.0, 2.0, 0.0),
        (-1.5, 1.8, 48.3),
    ] {
        let places = flown(off.into());
        assert_eq!(found(&surface, &planned, &places, in_order), all, "{off:?}");
        assert_eq!(found(&surface, &planned, &places, disorder), all, "{off:?}");
        let mut fewer = places;
        fewer.remove(17);
        let wanted: Vec<Option<usize>> = (0..17)
            .map(Some)
            .chain([None])
            .chain((17..49).map(Some))
            .collect();
        assert_eq!(
            found(&surface, &planned, &fewer, in_order),
            wanted,
            "{off:?}"
        );
    }
    let elsewhere = flown(DVec3::new(300.0, 0.0, 0.0));
    assert_eq!(
        found(&surface, &planned, &elsewhere, in_order),
        vec![None; 50]
    );
}

/// A mission that flies over the same places at two heights, of which all, one or one and a part were flown: each photo is of its own
/// height, whichever is first in the mission.
#[test]
fn a_height_is_not_taken_for_another() {
    let surface = surface(|_| 5.0);
    let at_height = |z: f64| -> Vec<DVec3> {
        let places = (0..24_u32).map(|n| {
            at_corner(
                30.0 + 12.0 * f64::from(n % 6),
                30.0 + 10.0 * f64::from(n / 6),
                z,
            )
        });
        places.collect()
    };
    let (low, high) = (at_height(27.0), at_height(47.0));
    for [first, second] in [[&low, &high], [&high, &low]] {
        let planned = [&first[..], second].concat();
        for taken in [0..24, 24..48, 0..48, 18..48, 0..30] {
            let flown: Vec<DVec3> = (taken.clone())
                .map(|number| {
                    planned[number]
                        + DVec3::from_array([0, 1, 2].map(|axis| 0.7 * noise(number, axis)))
                })
                .collect();
            let wanted: Vec<Option<usize>> = (0..48)
                .map(|number| taken.contains(&number).then(|| number - taken.start))
                .collect();
            assert_eq!(
                found(&surface, &planned, &flown, in_order),
                wanted,
                "{taken:?}"
            );
        }
    }
}

/// Of more stops at one place than are looked at for each photo every one has its own.
#[test]
fn many_stops_at_one_place_have_a_photo_each() {
    let surface = surface(|_| 5.0);
    let planned = vec![at_corner(60.0, 60.0, 25.0); 20];
    let mut found = found(&surface, &planned, &planned, |number| {
        format!("{}.JPG", number * 7 % 20)
    });
    found.sort_unstable();
    assert_eq!(found, (0..20).map(Some).collect::<Vec<_>>());
}
