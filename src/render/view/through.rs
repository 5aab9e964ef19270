//! The look through the camera of a photo.

use crate::camera::{Camera, Pose};
use crate::geometry::median;
use crate::scale::{CornerOutcome, PhotoScale, ViewFacts};
use crate::view::View;

impl View {
    /// What an undistorted photo of a flight shows. Its scale bar is true at the median distance of
    /// the footprint; at `otherwise`, world units, where it has none.
    pub fn through(
        camera: &Camera,
        pose: &Pose,
        scale: Option<&PhotoScale>,
        facts: Option<&ViewFacts>,
        otherwise: f64,
    ) -> Self {
        let grid = facts.iter().flat_map(|facts| &facts.footprint.grid);
        let corners = scale.iter().flat_map(|scale| &scale.corners);
        let outcomes = grid
            .map(|sample| &sample.outcome)
            .chain(corners.map(|corner| &corner.outcome));
        let mut distances: Vec<f64> = outcomes.filter_map(distance).collect();
        let focus = median(&mut distances).unwrap_or(otherwise);
        Self::of_photo(camera, pose, focus)
    }
}

fn distance(outcome: &CornerOutcome) -> Option<f64> {
    match *outcome {
        CornerOutcome::OnSurface { distance, .. } | CornerOutcome::OnGround { distance, .. } => {
            Some(distance)
        }
        CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Distortion;
    use crate::scale::{Corner, CornerName, EdgeScales};
    use glam::{DVec2, DVec3};

    /// Corners 10, 20 and 90 away, and one that meets nothing.
    #[test]
    fn the_bar_is_true_at_the_median_distance() {
        let away = [Some(10.0), Some(90.0), None, Some(20.0)];
        let mut away = away.into_iter();
        let corners = CornerName::ALL.map(|name| Corner {
            name,
            pixel: DVec2::ZERO,
            direction: None,
            outcome: match away.next().flatten() {
                Some(distance) => CornerOutcome::OnGround {
                    point: DVec3::ZERO,
                    distance,
                },
                None => CornerOutcome::Nowhere,
            },
        });
        let scale = PhotoScale {
            corners,
            scale: EdgeScales::default(),
            ground: None,
        };
        let camera = Camera {
            name: String::new(),
            width: 400,
            height: 300,
            fx: 300.0,
            fy: 300.0,
            cx: 200.0,
            cy: 150.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let pose = Pose::from_tilt_pan(DVec3::ZERO, [90.0, 0.0]);
        let view = View::through(&camera, &pose, Some(&scale), None, 7.0);
        assert_eq!(view.focus, 20.0);
        assert_eq!(View::through(&camera, &pose, None, None, 7.0).focus, 7.0);
    }
}
