//! A mission beside the flight that came of it, as lines of the picture.

use glam::DVec3;

use super::plan_lines::{GOOD, KEEP_OUT, TROUBLED, WAY, pyramid};
use crate::camera::Camera;
use crate::geometry::Bounds;
use crate::plan::{Drone, Flown, PlannedPose};
use crate::show::PlannedLine;

/// The side of a camera, in the size of the flight.
const CAMERA: f64 = 0.025;

/// The planned and the flown path, every photo with its way from the plan, and those that were not taken.
///
/// `places` are where the photos of the flight were taken. A flight without a camera is drawn with that of the first
/// drone: its pyramids say where a photo looks, not what it shows.
pub fn flown_lines(
    poses: &[PlannedPose],
    places: &[DVec3],
    flown: &Flown,
    camera: Option<&Camera>,
) -> Vec<PlannedLine> {
    let any = Drone::ALL[0].camera();
    let camera = camera.unwrap_or(&any);
    let planned: Vec<DVec3> = (poses.iter()).map(|plan| plan.pose.center).collect();
    let all: Vec<DVec3> = planned.iter().chain(places).copied().collect();
    let size = Bounds::of(&all).map_or(1.0, |bounds| bounds.size().length());
    let line = |points: Vec<DVec3>, color: [u8; 3], width: f64| PlannedLine {
        points,
        color,
        width,
    };
    let mut lines = vec![line(planned, WAY[1], 1.5), line(places.to_vec(), GOOD, 1.5)];
    for (plan, residual) in poses.iter().zip(&flown.residuals) {
        let taken = residual.and_then(|residual| places.get(residual.photo));
        let color = match taken {
            Some(_) => WAY[1],
            None => KEEP_OUT,
        };
        lines.push(line(pyramid(camera, &plan.pose, CAMERA * size), color, 1.4));
        if let Some(taken) = taken {
            lines.push(line(vec![plan.pose.center, *taken], TROUBLED, 2.5));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Pose;
    use crate::plan::Residual;

    /// Of three planned photos the second was not taken, the others lie beside their plan.
    #[test]
    fn what_was_not_taken_is_red_and_the_others_lead_to_their_photo() {
        let poses: Vec<PlannedPose> = [0.0, 40.0, 80.0]
            .map(|x| PlannedPose {
                name: format!("P{x}"),
                pose: Pose::from_tilt_pan(DVec3::new(x, 0.0, 20.0), [90.0, 0.0]),
            })
            .into();
        let places = [DVec3::new(80.0, 1.0, 20.0), DVec3::new(0.5, 0.0, 20.0)];
        let taken_as = |photo: usize| Residual {
            photo,
            offset: DVec3::ZERO,
            tilt: 0.0,
            pan: 0.0,
            turn: 0.0,
            shared: None,
        };
        let flown = Flown {
            residuals: vec![Some(taken_as(1)), None, Some(taken_as(0))],
            unplanned: Vec::new(),
        };
        let lines = flown_lines(&poses, &places, &flown, None);
        let of = |color: [u8; 3]| lines.iter().filter(move |line| line.color == color);
        assert_eq!(of(KEEP_OUT).count(), 1);
        assert!(of(KEEP_OUT).all(|line| line.points.contains(&poses[1].pose.center)));
        let off: Vec<[DVec3; 2]> = of(TROUBLED)
            .map(|line| [line.points[0], line.points[1]])
            .collect();
        let expected = [0, 2].map(|planned| poses[planned].pose.center);
        assert_eq!(off, [[expected[0], places[1]], [expected[1], places[0]]]);
    }
}
