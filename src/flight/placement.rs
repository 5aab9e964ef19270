//! Whether the photos stand where photos of this surface can stand. Poses and surface often come
//! from two exports: in two coordinate systems, or upside down, they still give numbers.

use super::{Doubt, Flight, FlightParts};
use crate::fault::first_names;
use crate::geometry::Ray;
use crate::units::{LengthUnit, in_words};

/// A photo is in another coordinate system rather than far away, if its distance to the surface is
/// so many times the surface's extent: a lens that still resolves the rock does not see so little.
const FAR: f64 = 100.0;

/// Which photos stand where none can, by their index in the flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placement {
    /// Photos that are too far away, with their distances to the surface, world units.
    pub far: Vec<(usize, f64)>,
    /// Photos under the surface.
    pub under: Vec<usize>,
    /// The surface's extent, world units.
    pub extent: f64,
}

impl Flight {
    /// Looks where the photos stand.
    pub fn placement(&self) -> Placement {
        let parts = self.parts();
        let bounds = parts.surface.bounds();
        let mut placement = Placement {
            extent: bounds.size().length(),
            ..Placement::default()
        };
        let centers = || parts.photos.iter().map(|photo| photo.pose.center);
        let away = |center: glam::DVec3| (center - center.clamp(bounds.min, bounds.max)).length();
        let distances = centers().map(away).enumerate();
        placement.far = distances
            .filter(|(_, away)| *away > FAR * placement.extent)
            .collect();
        if !placement.far.is_empty() {
            return placement;
        }
        // A surface that cannot be met says so when scales are asked of it.
        let Ok(mut caster) = parts.surface.caster_for(parts.photos.len()) else {
            return placement;
        };
        let mut hit = |origin, direction| caster.cast(&Ray { origin, direction });
        placement.under = centers()
            .enumerate()
            .filter(|&(_, center)| {
                // Under a quarry's overhang the surface is above and below.
                hit(center, glam::DVec3::Z).is_some() && hit(center, glam::DVec3::NEG_Z).is_none()
            })
            .map(|(index, _)| index)
            .collect();
        placement
    }
}

impl Placement {
    /// What it says against each photo of its flight.
    pub fn doubts(&self, unit: Option<LengthUnit>) -> impl Iterator<Item = (usize, Doubt)> {
        let extent = self.extent;
        let far = self.far.iter().map(move |&(photo, distance)| {
            let doubt = Doubt::FarFromSurface {
                distance,
                extent,
                unit,
            };
            (photo, doubt)
        });
        let under = self.under.iter();
        far.chain(under.map(|&photo| (photo, Doubt::UnderSurface)))
    }

    /// The same of the whole flight, one sentence each, with numbers.
    pub fn warnings(&self, flight: &Flight) -> Vec<String> {
        let FlightParts { photos, .. } = flight.parts();
        let unit = in_words(flight.parts().unit_known.then_some(flight.parts().unit));
        let name = |photo: &usize| photos.get(*photo).map_or("", |photo| photo.name.as_str());
        let mut warnings = Vec::new();
        let distances = self.far.iter().map(|(_, away)| *away);
        if let Some(nearest) = distances.min_by(f64::total_cmp) {
            warnings.push(format!(
                "{} of {} photos ({}) were taken over {nearest:.0} {unit} from the surface, which is {:.0} {unit} wide: the poses and the surface are in two coordinate systems",
                self.far.len(),
                photos.len(),
                first_names(self.far.iter().map(|(photo, _)| name(photo))),
                self.extent,
            ));
        }
        if !self.under.is_empty() {
            warnings.push(format!(
                "{} of {} photos ({}) were {}",
                self.under.len(),
                photos.len(),
                first_names(self.under.iter().map(name)),
                Doubt::UnderSurface,
            ));
        }
        warnings
    }
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
            errors: Default::default(),
            package_errors: Default::default(),
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
            unit_known: true,
            ground: Ground::Auto,
            image: ImageKind::Undistorted,
            pair: Default::default(),
            errors: Default::default(),
            package_errors: Default::default(),
            surface: Arc::new(Surface::new(cloud).unwrap()),
            cameras: vec![camera],
            as_read: Default::default(),
            photos: centers.iter().enumerate().map(photo).collect(),
        });
        let flight = flight.unwrap();
        flight.placement().warnings(&flight)
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
