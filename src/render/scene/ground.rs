//! How high the ground is drawn.

use crate::flight::Outcome;
use crate::geometry::{Bounds, median};
use crate::scale::Ground;

/// The elevation of the drawn ground: as set; else the median of what the photos that needed it found
/// under them; else under everything.
pub fn drawn_ground(ground: Ground, outcomes: &[Outcome], surface: &Bounds) -> f64 {
    match ground {
        Ground::At(z) => z,
        Ground::Auto => {
            let scales = outcomes.iter().filter_map(Outcome::scale);
            let mut found: Vec<f64> = scales.filter_map(|scale| scale.ground).collect();
            median(&mut found).unwrap_or(surface.min.z)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::{Corner, CornerName, CornerOutcome, EdgeScales, PhotoScale};
    use glam::{DVec2, DVec3};

    /// A photo that found its ground at this elevation.
    fn found(ground: Option<f64>) -> Outcome {
        let corners = CornerName::ALL.map(|name| Corner {
            name,
            pixel: DVec2::ZERO,
            direction: None,
            outcome: CornerOutcome::Nowhere,
        });
        Outcome::Scale(Box::new(PhotoScale {
            corners,
            scale: EdgeScales::default(),
            ground,
        }))
    }

    #[test]
    fn the_median_of_what_was_found() {
        let bounds = Bounds {
            min: DVec3::splat(-5.0),
            max: DVec3::splat(5.0),
        };
        let outcomes = [Some(10.0), None, Some(3.0), Some(4.0)].map(found);
        assert_eq!(drawn_ground(Ground::Auto, &outcomes, &bounds), 4.0);
        assert_eq!(drawn_ground(Ground::At(7.0), &outcomes, &bounds), 7.0);
        assert_eq!(drawn_ground(Ground::Auto, &[found(None)], &bounds), -5.0);
    }
}
