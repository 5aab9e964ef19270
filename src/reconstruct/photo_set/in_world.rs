//! The photos' own positions as places in one world: near its origin, in metres of its grid.

use glam::DVec3;

use crate::fault::Fault;
use crate::formats::photos::photo_metadata::PhotoMetadata;
use crate::geodesy::{Crs, CrsKind, Geographic};
use crate::geometry::median;

/// The world that the photos lie in.
pub(crate) struct World {
    crs: Crs,
    /// Whole hundreds of metres near the place in the middle: what coordinates are counted from.
    pub(crate) origin: DVec3,
}

impl World {
    /// Of the photo in the middle of those with a place, for the first may have strayed; `None` where none has one. `asked` is what the user wants, else it
    /// is the zone of UTM.
    ///
    /// # Errors
    /// Where `asked` is no projected coordinate system that the place lies in.
    pub(crate) fn of<'a>(
        asked: Option<&str>,
        photos: impl Iterator<Item = &'a PhotoMetadata>,
    ) -> Result<Option<Self>, Fault> {
        let asked = asked.map(Crs::understand).transpose()?;
        if let Some(crs) = asked
            .as_ref()
            .filter(|crs| crs.kind() != CrsKind::Projected)
        {
            let what = format!("{} is no projected coordinate system", crs.name());
            let remedy = "give a projected one such as EPSG:32633, or none for UTM";
            return Err(Fault::new(what, remedy));
        }
        let places = photos.filter_map(|photo| photo.place.filter(|place| place.height.is_some()));
        let places: Vec<Geographic> = places.map(|place| place.place).collect();
        let Some(middle) = middle(&places) else {
            return Ok(None);
        };
        let crs = asked.unwrap_or_else(|| Crs::utm_at(middle));
        let Some(center) = in_metres(&crs, middle) else {
            let what = format!("the photos do not lie where {} is defined", crs.name());
            return Err(Fault::new(
                what,
                "give another coordinate system, or none for UTM",
            ));
        };
        // Found at the end it would have cost the hours before.
        crs.check_lengths(middle)?;
        let origin = (center / 100.0).round() * 100.0;
        Ok(Some(Self { crs, origin }))
    }

    /// Where a photo was taken, from the origin; `None` where it does not say where and how high.
    pub(crate) fn place(&self, photo: &PhotoMetadata) -> Option<DVec3> {
        let place = photo.place.filter(|place| place.height.is_some())?;
        let center = in_metres(&self.crs, place.place)? - self.origin;
        // A receiver's lapse to another continent helps nobody.
        (center.length() < 100_000.0).then_some(center)
    }
}

/// The place nearest to the medians of all.
fn middle(places: &[Geographic]) -> Option<Geographic> {
    let median_of =
        |of: fn(&Geographic) -> f64| median(&mut places.iter().map(of).collect::<Vec<_>>());
    let latitude = median_of(|place| place.latitude)?;
    let longitude = median_of(|place| place.longitude)?;
    let off = |place: &Geographic| (place.latitude - latitude).hypot(place.longitude - longitude);
    let nearest = places.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.copied()
}

/// The point of a place on the grid, in metres whatever the system counts in: so are accuracies, and what the adjustment takes
/// for usual. The unit comes back when the model is fitted to the positions in the system itself.
fn in_metres(crs: &Crs, place: Geographic) -> Option<DVec3> {
    let point = crs.from_geographic(place)?;
    let level = point.truncate() * crs.unit_metres();
    Some(level.extend(point.z * crs.vertical_unit_metres()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::photos::photo_metadata::{HeightReference, MeasuredPlace};

    /// Feet in a system's plan or of its heights change nothing.
    #[test]
    fn places_are_in_metres() {
        let photo = |latitude: f64, height: f64| PhotoMetadata {
            make: None,
            model: None,
            serial: None,
            lens: None,
            time: None,
            size: (1, 1),
            shown: 1,
            place: Some(MeasuredPlace {
                place: Geographic {
                    latitude,
                    longitude: 9.0,
                    height,
                },
                height: Some(HeightReference::Ellipsoid),
                fix: None,
                deviation: None,
            }),
            relative_altitude: None,
            laser_range: None,
            orientation: None,
            unknown_angles: Vec::new(),
            focal: Vec::new(),
            warnings: Vec::new(),
        };
        let photos = [photo(48.0, 300.0), photo(48.001, 337.5)];
        for system in [
            "EPSG:32632",
            "EPSG:32632+6360",
            "+proj=utm +zone=32 +datum=WGS84 +units=us-ft +no_defs",
        ] {
            let world = World::of(Some(system), photos.iter()).unwrap().unwrap();
            let [first, second] = photos.each_ref().map(|photo| world.place(photo).unwrap());
            let off = second - first;
            // A thousandth of a degree of the meridian at 48 degrees north, times 0.9996.
            assert!((off.y - 111.152).abs() < 0.01, "{system}: {off}");
            assert!((off.z - 37.5).abs() < 1e-6, "{system}: {off}");
            assert!(off.x.abs() < 1e-6, "{system}: {off}");
        }
        // Made for 9 degrees farther west.
        let far = World::of(Some("EPSG:32628"), photos.iter()).map(|_| ());
        assert!(far.unwrap_err().what.contains("on the ground there"));
    }

    /// One that strayed, in whatever place, is not what the others are counted from.
    #[test]
    fn the_middle_is_none_that_strayed() {
        let at = |latitude: f64, longitude: f64| Geographic {
            latitude,
            longitude,
            height: 300.0,
        };
        let away = at(0.0, 0.0);
        let places = [away, at(48.001, 9.0), at(48.002, 9.002), at(48.003, 9.001)];
        let found = middle(&places).unwrap();
        assert!(found.latitude > 48.0 && found.longitude >= 9.0);
        assert!(middle(&[away]).is_some() && middle(&[]).is_none());
    }
}
