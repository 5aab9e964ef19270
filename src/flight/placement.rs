//! Whether the photos stand where photos of this surface can stand. Poses and surface often come
//! from two exports: in two coordinate systems, or upside down, they still give numbers.

use super::Flight;
use crate::geometry::Ray;

/// A photo is in another coordinate system rather than far away, if its distance to the surface is
/// so many times the surface's extent: a lens that still resolves the rock does not see so little.
const FAR: f64 = 100.0;

/// How many photos a sentence names.
const NAMED: usize = 3;

impl Flight {
    /// What is wrong with where the photos stand, one sentence each, with numbers.
    pub fn placement_warnings(&self) -> Vec<String> {
        let parts = self.parts();
        let bounds = parts.surface.bounds();
        let extent = bounds.size().length();
        let unit = parts.unit;
        let mut warnings = Vec::new();
        let away = |center: glam::DVec3| (center - center.clamp(bounds.min, bounds.max)).length();
        let distances = parts
            .photos
            .iter()
            .map(|photo| (photo, away(photo.pose.center)));
        let far: Vec<_> = distances.filter(|(_, away)| *away > FAR * extent).collect();
        if let Some(nearest) = far.iter().map(|(_, away)| *away).min_by(f64::total_cmp) {
            warnings.push(format!(
                "{} of {} photos ({}) were taken over {nearest:.0} {unit} from the surface, which is {extent:.0} {unit} wide: the poses and the surface are in two coordinate systems",
                far.len(),
                parts.photos.len(),
                names(far.iter().map(|(photo, _)| photo.name.as_str())),
            ));
            return warnings;
        }
        // A surface that cannot be met says so when scales are asked of it.
        let Ok(mut caster) = parts.surface.caster_for(parts.photos.len()) else {
            return warnings;
        };
        let mut hit = |origin, direction| caster.cast(&Ray { origin, direction });
        let under: Vec<&str> = parts
            .photos
            .iter()
            .filter(|photo| {
                // Under a quarry's overhang the surface is above and below.
                let center = photo.pose.center;
                hit(center, glam::DVec3::Z).is_some() && hit(center, glam::DVec3::NEG_Z).is_none()
            })
            .map(|photo| photo.name.as_str())
            .collect();
        if !under.is_empty() {
            warnings.push(format!(
                "{} of {} photos ({}) were taken from under the surface: check which axis is up, the heights' datum and the poses' convention",
                under.len(),
                parts.photos.len(),
                names(under.iter().copied()),
            ));
        }
        warnings
    }
}

/// The first few names.
fn names<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    let dots = if names.len() > NAMED { ", ..." } else { "" };
    format!("{}{dots}", names.take(NAMED).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;

    use crate::camera::{Camera, Distortion, Pose};
    use crate::flight::{Flight, FlightParts, Photo};
    use crate::scale::{Ground, ImageKind};
    use crate::surface::{Cloud, Surface};
    use crate::units::LengthUnit;

    /// Warnings of photos at these places over a square of 10 m at z = 0.
    fn warnings(centers: &[DVec3]) -> Vec<String> {
        let corners = [(0.0, 0.0), (10.0, 0.0), (0.0, 10.0), (10.0, 10.0)];
        let points = corners.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let cloud = Cloud {
            points,
            ..Cloud::default()
        };
        let photo = |(index, center): (usize, &DVec3)| Photo {
            name: format!("{index}.jpg"),
            camera: 0,
            pose: Pose::from_tilt_pan(*center, [90.0, 0.0]),
            trouble: None,
        };
        let camera = Camera {
            name: String::new(),
            width: 100,
            height: 100,
            fx: 100.0,
            fy: 100.0,
            cx: 50.0,
            cy: 50.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let flight = Flight::new(FlightParts {
            name: String::new(),
            unit: LengthUnit::Metre,
            ground: Ground::Auto,
            image: ImageKind::Undistorted,
            surface: Arc::new(Surface::new(cloud).unwrap()),
            cameras: vec![camera],
            photos: centers.iter().enumerate().map(photo).collect(),
        });
        flight.unwrap().placement_warnings()
    }

    #[test]
    fn above_and_beside_the_surface_is_good() {
        let centers = [(5.0, 5.0, 8.0), (-30.0, 5.0, 8.0), (-30.0, 5.0, -2.0)];
        assert_eq!(warnings(&centers.map(DVec3::from)), [] as [&str; 0]);
    }

    #[test]
    fn under_the_surface_is_said() {
        let centers = [(5.0, 5.0, 8.0), (5.0, 5.0, -8.0)];
        let said = warnings(&centers.map(DVec3::from));
        assert!(
            said[0].starts_with("1 of 2 photos (1.jpg) were taken from under"),
            "{said:?}"
        );
    }

    #[test]
    fn another_coordinate_system_is_said_with_its_distance() {
        let centers = [(500_005.0, 5_000_000.0, 8.0); 5];
        let said = warnings(&centers.map(DVec3::from));
        let expected = "5 of 5 photos (0.jpg, 1.jpg, 2.jpg, ...) were taken over 5024927 m from the surface, which is 14 m wide";
        assert!(said[0].starts_with(expected), "{said:?}");
    }
}
