//! The look through the camera of a photo.

use crate::flight::PhotoReview;
use crate::geometry::median;
use crate::scale::{CornerOutcome, PhotoScale, ViewFacts};
use crate::view::View;

impl View {
    /// What an undistorted photo shows. Its scale bar is true at the median distance of the
    /// footprint; at `otherwise`, world units, where it has none.
    pub fn through(photo: &PhotoReview<'_>, otherwise: f64) -> Self {
        let focus = focus(photo.scale(), photo.view).unwrap_or(otherwise);
        Self::of_photo(photo.camera, &photo.photo.pose, focus)
    }
}

/// The median distance of a footprint from its camera.
fn focus(scale: Option<&PhotoScale>, view: Option<&ViewFacts>) -> Option<f64> {
    let grid = view.into_iter().flat_map(|view| &view.footprint.grid);
    let corners = scale.into_iter().flat_map(|scale| &scale.corners);
    let outcomes = grid
        .map(|sample| &sample.outcome)
        .chain(corners.map(|corner| &corner.outcome));
    let mut distances: Vec<f64> = outcomes.filter_map(distance).collect();
    median(&mut distances)
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
        assert_eq!(focus(Some(&scale), None), Some(20.0));
        assert_eq!(focus(None, None), None);
    }
}
