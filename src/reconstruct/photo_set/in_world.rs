//! The photos' own positions as places in one world: near its origin, in metres of its grid.

use glam::DVec3;

use crate::fault::Fault;
use crate::formats::photos::photo_metadata::PhotoMetadata;
use crate::geodesy::{Crs, CrsKind};

/// The world that the photos lie in.
pub(crate) struct World {
    crs: Crs,
    /// Whole hundreds of metres near the first place: what coordinates are counted from.
    pub(crate) origin: DVec3,
}

impl World {
    /// Of the first photo with a place; `None` where none has one. `asked` is what the user wants, else it
    /// is the zone of UTM.
    ///
    /// # Errors
    /// Where `asked` is no projected coordinate system that the place lies in.
    pub(crate) fn of<'a>(
        asked: Option<&str>,
        mut photos: impl Iterator<Item = &'a PhotoMetadata>,
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
        let first = photos.find_map(|photo| photo.place.filter(|place| place.height.is_some()));
        let Some(first) = first else {
            return Ok(None);
        };
        let crs = asked.unwrap_or_else(|| Crs::utm_at(first.place));
        let Some(center) = crs.from_geographic(first.place) else {
            let what = format!("the photos do not lie where {} is defined", crs.name());
            return Err(Fault::new(
                what,
                "give another coordinate system, or none for UTM",
            ));
        };
        let origin = (center / 100.0).round() * 100.0;
        Ok(Some(Self { crs, origin }))
    }

    /// Where a photo was taken, from the origin; `None` where it does not say where and how high.
    pub(crate) fn place(&self, photo: &PhotoMetadata) -> Option<DVec3> {
        let place = photo.place.filter(|place| place.height.is_some())?;
        let center = self.crs.from_geographic(place.place)? - self.origin;
        // A receiver's lapse to another continent helps nobody.
        (center.length() < 100_000.0).then_some(center)
    }
}
