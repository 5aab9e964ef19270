//! Planned against flown: where each planned photo was really taken, and which were not.
//!
//! `paired` says which photo is which planned one: none that is farther from its plan than half the way to what it was to show,
//! but for what all photos are off alike.

use std::collections::HashSet;

use glam::{DVec2, DVec3};

use super::paired::{PlannedPose, Taken, pairs};
use super::{Above, Mission, Stop};
use crate::camera::Pose;
use crate::fault::Fault;
use crate::geodesy::{Crs, Geographic};
use crate::jobs::Progress;
use crate::plan::Purpose;
use crate::scale::{FieldGrid, ImageKind, ScaleField};
use crate::surface::Surface;

/// How far a photo is from its plan: flown less planned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Which of the photos that were taken.
    pub photo: usize,
    /// World units.
    pub offset: DVec3,
    /// Of the axis below the horizon, degrees.
    pub tilt: f64,
    /// Degrees clockwise, -180 to 180.
    pub pan: f64,
    /// The angle of the turn between both, degrees.
    pub turn: f64,
    /// The share of what it was to show that it shows; `None` where the plan shows nothing of the surface.
    pub shared: Option<f64>,
}

/// Of each planned photo how far it is from its plan; `None` where it was not taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Flown {
    /// In the order of the plan.
    pub residuals: Vec<Option<Residual>>,
    /// Photos that nobody planned.
    pub unplanned: Vec<usize>,
}

/// The planned photos of a mission in the coordinate system of a surface. `take_off` is where the drone took off in the
/// world, where the mission does not say it; `ground` is the surface's height at a place.
///
/// # Errors
/// Where a stop has no direction, or its height counts from something that the surface does not tell.
pub fn planned_poses(
    mission: &Mission,
    crs: &Crs,
    take_off: Option<DVec2>,
    ground: impl Fn(DVec2) -> Option<f64>,
) -> Result<Vec<PlannedPose>, Fault> {
    let world = |latitude: f64, longitude: f64| {
        let place = Geographic {
            latitude,
            longitude,
            height: 0.0,
        };
        let off = || {
            let what = format!("the mission lies where {} does not hold", crs.name());
            Fault::new(what, "check that it is a mission over this surface")
        };
        Ok::<_, Fault>((place, crs.from_geographic(place).ok_or_else(off)?))
    };
    let off_surface = |what: &str| {
        let what = format!("{what} lies off the surface, so that nobody knows how high it is");
        Fault::new(what, "give a surface that reaches so far: --surface FILE")
    };
    let take_off = match (take_off, mission.take_off) {
        (Some(place), _) => Some(place),
        (None, Some(at)) => Some(world(at.latitude, at.longitude)?.1.truncate()),
        (None, None) => None,
    };
    let unsaid = || {
        let what = "it does not say where the drone takes off, from where its heights count";
        Fault::new(what, "say it: --take-off X,Y")
    };
    // A surface has its heights in the unit of x and y, whatever unit the system states for them.
    let unit = crs.unit_metres();
    let pitches = mission.gimbal_pitches();
    let mut planned = Vec::new();
    for ((stop, pitch), number) in mission.stops.iter().zip(pitches).zip(1..) {
        let Some(photo) = &stop.photo else {
            continue;
        };
        let (place, point) = world(stop.latitude, stop.longitude)?;
        let below =
            match stop.height.above {
                Above::TakeOff => ground(take_off.ok_or_else(unsaid)?)
                    .ok_or_else(|| off_surface("the take-off"))?,
                Above::Ground => ground(point.truncate())
                    .ok_or_else(|| off_surface(&format!("stop {number}")))?,
                above => {
                    let above = above.in_words();
                    let what = format!("the heights of the mission count from {above}");
                    let remedy = "give one whose heights count from the take-off or the ground";
                    return Err(Fault::new(what, remedy));
                }
            };
        let center = point.truncate().extend(below + stop.height.metres / unit);
        planned.push(PlannedPose {
            // As plans call them, for climbs are stops without a photo.
            name: (photo.name.clone())
                .unwrap_or_else(|| Purpose::Scale.photo_name(planned.len() + 1)),
            pose: pose(stop, pitch, center, crs, place).ok_or_else(|| {
                let what = format!("stop {number} does not say where the camera looks");
                Fault::new(what, "give a mission with headings and gimbal pitches")
            })?,
        });
    }
    Ok(planned)
}

fn pose(
    stop: &Stop,
    pitch: Option<f64>,
    center: DVec3,
    crs: &Crs,
    place: Geographic,
) -> Option<Pose> {
    let (sine, cosine) = stop.heading?.to_radians().sin_cos();
    let on_grid = crs.grid_from_enu(place)? * DVec2::new(sine, cosine).extend(0.0);
    let pan = on_grid.x.atan2(on_grid.y).to_degrees();
    Some(Pose::from_tilt_pan(center, [-pitch?, pan]))
}

impl Flown {
    /// Compares planned photos with those that were taken over a surface.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn compare(
        planned: &[PlannedPose],
        taken: &[Taken<'_>],
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let mut fields = Vec::with_capacity(planned.len());
        for (plan, done) in planned.iter().zip(0..) {
            progress.advance(done, planned.len() as u64)?;
            // Of the camera that flew: of one camera, mostly.
            let field = taken.first().map(|taken| {
                let grid = FieldGrid::of_fit(taken.camera);
                let image = ImageKind::Undistorted;
                ScaleField::compute(taken.camera, &plan.pose, image, grid, surface, progress)
            });
            let field = field.transpose();
            fields.push(
                field.map_err(|error| Fault::new(error.to_string(), "check the surface file"))?,
            );
        }
        let farthest = fields.iter().map(|field| {
            let depth = field.as_ref().and_then(middle_depth)?;
            Some(depth / 2.0)
        });
        let chosen = pairs(planned, taken, &farthest.collect::<Vec<_>>());
        let residuals: Vec<Option<Residual>> = (planned.iter().zip(&fields).zip(&chosen))
            .map(|((plan, field), chosen)| {
                let photo = (*chosen)?;
                Some(residual(plan, photo, taken.get(photo)?, field.as_ref()))
            })
            .collect();
        let used: HashSet<usize> = chosen.into_iter().flatten().collect();
        Ok(Self {
            residuals,
            unplanned: (0..taken.len())
                .filter(|photo| !used.contains(photo))
                .collect(),
        })
    }
}

/// The depth of what a photo's middle shows.
fn middle_depth(field: &ScaleField) -> Option<f64> {
    field.depth_at(field.grid.columns / 2, field.grid.rows / 2)
}

fn residual(
    plan: &PlannedPose,
    photo: usize,
    taken: &Taken<'_>,
    field: Option<&ScaleField>,
) -> Residual {
    let [planned, flown] = [&plan.pose, taken.pose].map(tilt_pan);
    let between = plan.pose.rotation.transpose() * taken.pose.rotation;
    let trace = between.x_axis.x + between.y_axis.y + between.z_axis.z;
    let shared = field.and_then(|field| {
        let points = field.points();
        let inside = points.iter().filter(|point| {
            let in_camera = taken.pose.camera_from_world(**point);
            let pixel = taken.camera.pixel_undistorted(in_camera);
            pixel.is_some_and(|pixel| taken.camera.contains(pixel))
        });
        (!points.is_empty()).then(|| inside.count() as f64 / points.len() as f64)
    });
    Residual {
        photo,
        offset: taken.pose.center - plan.pose.center,
        tilt: flown[0] - planned[0],
        pan: (flown[1] - planned[1] + 180.0).rem_euclid(360.0) - 180.0,
        turn: ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees(),
        shared,
    }
}

/// The axis below the horizon, and where the camera's right hand says that it looks: also straight down.
fn tilt_pan(pose: &Pose) -> [f64; 2] {
    let (axis, right) = (pose.rotation.z_axis, pose.rotation.x_axis);
    [
        (-axis.z).clamp(-1.0, 1.0).asin().to_degrees(),
        (-right.y).atan2(right.x).to_degrees(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Distortion};
    use crate::surface::Cloud;

    fn camera() -> Camera {
        Camera {
            name: String::new(),
            width: 400,
            height: 300,
            fx: 400.0,
            fy: 400.0,
            cx: 200.0,
            cy: 150.0,
            skew: 0.0,
            distortion: Distortion::None,
        }
    }

    fn ground() -> Surface {
        let points =
            (0..121 * 121).map(|i| DVec3::new(f64::from(i % 121), f64::from(i / 121), 5.0));
        Surface::new(Cloud {
            points: points.collect(),
            ..Cloud::default()
        })
        .unwrap()
    }

    /// Photos straight down from 20 above the ground show 20 x 15; moved by 5 along x they share 15 of 20.
    #[test]
    fn residuals_are_those_that_were_flown() {
        let (camera, surface) = (camera(), ground());
        let plan = |name: &str, x: f64| PlannedPose {
            name: name.to_owned(),
            pose: Pose::from_tilt_pan(DVec3::new(x, 60.0, 25.0), [90.0, 0.0]),
        };
        let planned = [plan("1", 30.0), plan("2", 60.0), plan("3", 90.0)];
        let flown = [
            Pose::from_tilt_pan(DVec3::new(65.0, 60.0, 25.0), [90.0, 0.0]),
            Pose::from_tilt_pan(DVec3::new(30.5, 59.0, 26.0), [88.0, 350.0]),
            Pose::from_tilt_pan(DVec3::new(90.0, 90.0, 25.0), [90.0, 0.0]),
        ];
        let taken = |pose| Taken {
            name: "DJI.JPG",
            pose,
            camera: &camera,
        };
        let taken: Vec<Taken<'_>> = flown.iter().map(taken).collect();
        let found = Flown::compare(&planned, &taken, &surface, &Progress::default()).unwrap();
        let second = found.residuals[1].unwrap();
        assert_eq!(
            (second.photo, second.offset),
            (0, DVec3::new(5.0, 0.0, 0.0))
        );
        assert!(
            (second.shared.unwrap() - 0.75).abs() < 0.02,
            "{:?}",
            second.shared
        );
        let first = found.residuals[0].unwrap();
        assert_eq!((first.photo, first.offset), (1, DVec3::new(0.5, -1.0, 1.0)));
        assert!((first.tilt + 2.0).abs() < 1e-9 && (first.pan + 10.0).abs() < 1e-6);
        assert!(first.turn > 9.9 && first.turn < 10.4, "{}", first.turn);
        // 30 off is no photo of it.
        assert_eq!((found.residuals[2], found.unplanned), (None, vec![2]));
    }

    /// Where names say which is which, distances do not.
    #[test]
    fn names_come_first() {
        let (camera, surface) = (camera(), ground());
        let at = |x: f64| Pose::from_tilt_pan(DVec3::new(x, 60.0, 25.0), [90.0, 0.0]);
        let planned = [("P001", 30.0), ("P002", 60.0)].map(|(name, x)| PlannedPose {
            name: name.to_owned(),
            pose: at(x),
        });
        let flown = [at(31.0), at(61.0)];
        let taken: Vec<Taken<'_>> = (flown.iter().zip(["p002.jpg", "p001.jpg"]))
            .map(|(pose, name)| Taken {
                name,
                pose,
                camera: &camera,
            })
            .collect();
        let found = Flown::compare(&planned, &taken, &surface, &Progress::default()).unwrap();
        let offsets: Vec<f64> = (found.residuals.iter().flatten())
            .map(|residual| residual.offset.x)
            .collect();
        assert_eq!(offsets, [31.0, -29.0]);
    }
}
