//! Whether the photos stand where photos of this surface can stand. Poses and surface often come
//! from two exports: in two coordinate systems, or upside down, they still give numbers.

mod other_unit;

use glam::DVec3;

use super::{Doubt, Flight, FlightParts, Photo};
use crate::fault::first_names;
use crate::geometry::Ray;
use crate::surface::Caster;
use crate::units::{LengthUnit, in_words};

/// A photo is in another coordinate system rather than far away, if its distance to the surface is
/// so many times the surface's extent: a lens that still resolves the rock does not see so little.
const FAR: f64 = 100.0;

/// Along each side of a photo so many of its pixels are looked at, to see whether it shows the surface, and from which side.
const LOOKS: u32 = 5;

/// Lengths that are so many times too large or too small are those of another unit; of less (feet for metres) another datum, or an
/// origin elsewhere, may be as likely.
const SURE_OF_UNIT: f64 = 10.0;

/// Of fewer of them that meet the mesh nothing is said.
const LEAST_LOOKS: usize = 5;

/// So large a share of them meets it from behind where it is turned over; a mesh of faces that look either way has less.
const FROM_BEHIND: f64 = 0.8;

/// Which photos stand where none can, by their index in the flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placement {
    /// Photos that are too far away, with their distances to the surface, world units.
    pub far: Vec<(usize, f64)>,
    /// Photos under the surface.
    pub under: Vec<usize>,
    /// Other photos, which see the faces of a mesh from behind.
    pub behind: Vec<usize>,
    /// The surface's extent, world units.
    pub extent: f64,
    /// The units that poses and surface are likely in, where no photo sees the surface as it stands.
    pub other_unit: Option<[LengthUnit; 2]>,
    /// How many photos there are.
    pub photos: usize,
}

impl Flight {
    /// Looks where the photos stand.
    pub fn placement(&self) -> Placement {
        let parts = self.parts();
        let bounds = parts.surface.bounds();
        let mut placement = Placement {
            extent: bounds.size().length(),
            photos: parts.photos.len(),
            ..Placement::default()
        };
        let away = |center: DVec3| (center - center.clamp(bounds.min, bounds.max)).length();
        let is_mesh = !parts.surface.is_cloud();
        let rays = match is_mesh {
            true => LOOKS as usize * LOOKS as usize + 2,
            false => 2,
        };
        // A surface that cannot be met says so when scales are asked of it.
        let mut caster = parts.surface.caster_for(rays * parts.photos.len()).ok();
        for (index, photo) in parts.photos.iter().enumerate() {
            let origin = photo.pose.center;
            let distance = away(origin);
            if distance > FAR * placement.extent {
                // One that strayed says nothing of the others.
                placement.far.push((index, distance));
                continue;
            }
            let Some(caster) = &mut caster else {
                continue;
            };
            let mut meets = |direction| caster.cast(&Ray { origin, direction }).is_some();
            // Under a quarry's overhang the surface is above and below.
            if meets(DVec3::Z) && !meets(DVec3::NEG_Z) {
                placement.under.push(index);
            } else if is_mesh && self.sees_from_behind(photo, caster) {
                placement.behind.push(index);
            }
        }
        placement.other_unit = caster.as_mut().and_then(|caster| self.other_unit(caster));
        placement
    }

    /// Whether what a photo shows of a mesh shows its back.
    fn sees_from_behind(&self, photo: &Photo, caster: &mut Caster<'_>) -> bool {
        let origin = photo.pose.center;
        let directions = self.looks(photo);
        let hits = directions.filter_map(|direction| caster.cast(&Ray { origin, direction }));
        let hits: Vec<bool> = hits.map(|hit| hit.is_from_behind).collect();
        let behind = hits
            .iter()
            .filter(|is_from_behind| **is_from_behind)
            .count();
        hits.len() >= LEAST_LOOKS && behind as f64 > FROM_BEHIND * hits.len() as f64
    }
}

impl Placement {
    /// What it says against each photo of its flight.
    pub fn doubts(&self, unit: Option<LengthUnit>) -> impl Iterator<Item = (usize, Doubt)> {
        let extent = self.extent;
        let unit_explains_all = self.unit_explains_all();
        let far = self.far.iter().map(move |&(photo, distance)| {
            let doubt = Doubt::FarFromSurface {
                distance,
                extent,
                unit,
            };
            (photo, doubt)
        });
        let under = self.under.iter();
        let behind = self.behind.iter();
        let of_places = far
            .chain(under.map(|&photo| (photo, Doubt::UnderSurface)))
            .chain(behind.map(|&photo| (photo, Doubt::FromBehind)))
            .filter(move |_| !unit_explains_all);
        let of_unit = self.doubt_of_unit().into_iter();
        let of_unit = of_unit.flat_map(move |doubt| {
            let photos = 0..self.photos;
            photos.map(move |photo| (photo, doubt.clone()))
        });
        of_places.chain(of_unit)
    }

    /// That poses and surface are in two units.
    fn doubt_of_unit(&self) -> Option<Doubt> {
        let [poses, surface] = self.other_unit?;
        Some(Doubt::OtherUnit { poses, surface })
    }

    /// Whether the units are so far apart that they alone are why the photos stand where none can: then nothing else is said.
    fn unit_explains_all(&self) -> bool {
        self.other_unit.is_some_and(|[poses, surface]| {
            let factor = poses.in_units_of(surface);
            factor.max(1.0 / factor) > SURE_OF_UNIT
        })
    }

    /// The same of the whole flight, one sentence each, with numbers.
    pub fn warnings(&self, flight: &Flight) -> Vec<String> {
        let of_unit = self.doubt_of_unit().map(|doubt| doubt.to_string());
        if self.unit_explains_all() {
            return of_unit.into_iter().collect();
        }
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
        for (of, doubt) in [
            (&self.under, Doubt::UnderSurface),
            (&self.behind, Doubt::FromBehind),
        ] {
            if !of.is_empty() {
                warnings.push(format!(
                    "{} of {} photos ({}) were {doubt}",
                    of.len(),
                    photos.len(),
                    first_names(of.iter().map(name)),
                ));
            }
        }
        warnings.extend(of_unit);
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
        let flight = flight(centers, 0.0, 1.0);
        flight.placement().warnings(&flight)
    }

    /// Photos at these places over a square of 10 m at this height, which is `factor` times as large and as high.
    fn flight(centers: &[DVec3], height: f64, factor: f64) -> Flight {
        let corners = [(0.0, 0.0), (10.0, 0.0), (0.0, 10.0), (10.0, 10.0)];
        let points = corners.map(|(x, y)| DVec3::new(x, y, height) * factor);
        let points = points.to_vec();
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
        flight.unwrap()
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
    fn one_that_strayed_hides_no_other() {
        let said = warnings(&[DVec3::new(5e6, 5.0, 8.0), DVec3::new(5.0, 5.0, -8.0)]);
        assert!(
            said[0].starts_with("1 of 2 photos (0.jpg) were taken over"),
            "{said:?}"
        );
        assert!(
            said[1].starts_with("1 of 2 photos (1.jpg) were taken from under"),
            "{said:?}"
        );
    }

    #[test]
    fn another_coordinate_system_is_said_with_its_distance() {
        let centers = [(500_005.0, 5_000_000.0, 8.0); 5];
        let said = warnings(&centers.map(DVec3::from));
        let expected = "5 of 5 photos (0.jpg, 1.jpg, 2.jpg, 3.jpg, 4.jpg) were taken over 5024927 m from the surface, which is 14 m wide";
        assert!(said[0].starts_with(expected), "{said:?}");
    }

    /// Four photos 2 m above a square of 10 m, of a footprint of 2 m.
    #[test]
    fn two_units_are_asked_about() {
        let centers = [(2.0, 2.0), (8.0, 2.0), (2.0, 8.0), (8.0, 8.0)];
        let centers = centers.map(|(x, y)| DVec3::new(x, y, 3.0));
        let said = |poses: f64, surface: f64| {
            let flight = flight(&centers.map(|center| center * poses), 1.0, surface);
            let placement = flight.placement();
            let doubts: Vec<_> = placement.doubts(Some(LengthUnit::Metre)).collect();
            let warnings = placement.warnings(&flight);
            // What is asked of all of them is said in one sentence.
            if let Some(of_unit) = warnings.iter().find(|said| said.starts_with("no photo")) {
                assert_eq!(doubts.len(), centers.len() * warnings.len());
                let asked = doubts
                    .iter()
                    .filter(|(_, doubt)| doubt.to_string() == *of_unit);
                let asked: Vec<usize> = asked.map(|(photo, _)| *photo).collect();
                assert_eq!(asked, [0, 1, 2, 3]);
            }
            warnings
        };
        assert_eq!(said(1.0, 1.0), [] as [&str; 0]);
        for (poses, surface, start) in [
            (
                1000.0,
                1.0,
                "no photo sees the surface, which is about 1000 times too small for the poses: \
                 are the poses in millimetres and the surface in metres?",
            ),
            (
                1.0,
                1000.0,
                "no photo sees the surface, which is about 1000 times too large for the poses: \
                 are the poses in metres and the surface in millimetres?",
            ),
            (
                1.0 / 0.0254,
                1.0,
                "no photo sees the surface, which is about 39 times too small for the poses: \
                 are the poses in inches and the surface in metres?",
            ),
        ] {
            let said = said(poses, surface);
            assert!(said.len() == 1 && said[0].starts_with(start), "{said:?}");
        }
        // Feet for metres is little: what else may be the matter is said, too.
        let feet = said(1.0, 1.0 / 0.3048);
        assert!(feet.len() == 2, "{feet:?}");
        assert!(
            feet[0].starts_with("4 of 4 photos (")
                && feet[0].contains("were taken from under the surface"),
            "{feet:?}"
        );
        assert!(
            feet[1].contains("are the poses in metres and the surface in feet?"),
            "{feet:?}"
        );
        // What is no unit is said in other words.
        let said = said(50_000.0, 1.0);
        assert!(said[0].contains("two coordinate systems"), "{said:?}");
    }

    /// Of four photos 2 m above a square of 10 m, in the photos' unit, the first looks at its middle from near the origin, however large
    /// their unit is: what is then a 25th of the photo or more is a small pile, which no look meets.
    #[test]
    fn a_small_pile_is_in_no_other_unit() {
        let centers = [(0.3, 0.3), (8.0, 2.0), (2.0, 8.0), (8.0, 8.0)];
        let said = |poses: f64| {
            let centers = centers.map(|(x, y)| DVec3::new(x, y, 3.0) * poses);
            let flight = flight(&centers, 1.0, 1.0);
            flight.placement().warnings(&flight)
        };
        assert_eq!(said(1.0 / 0.0254), [] as [&str; 0]);
        let millimetres = said(1000.0);
        assert!(
            millimetres.len() == 1 && millimetres[0].contains("are the poses in millimetres"),
            "{millimetres:?}"
        );
    }
}
