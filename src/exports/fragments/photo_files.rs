//! The files of a photo whose fragments are outlined.

use image::RgbImage;

use super::{WorldOutlines, labels_png, outlines_png, world_geojson};
use crate::delineation::LabelImage;
use crate::delineation::mass::PhotoFragments;
use crate::fault::Fault;
use crate::map_places::MapPlaces;
use crate::scale::ScaleField;
use crate::units::LengthUnit;

/// How they end behind the photo's name: its label image, its outlines over it, and those in the world.
pub const OUTLINED_ENDINGS: [&str; 3] = ["_labels.png", "_outlines.png", "_world.geojson"];

/// A photo with what is outlined in it.
#[derive(Debug)]
pub struct PhotoOutlined<'a> {
    /// As the flight names it.
    pub name: &'a str,
    /// Undistorted, at its full size.
    pub pixels: &'a RgbImage,
    /// Of the same pixels.
    pub labels: &'a LabelImage,
    /// Of all of them.
    pub field: &'a ScaleField,
    /// What was measured.
    pub fragments: &'a PhotoFragments,
}

impl PhotoOutlined<'_> {
    /// The bytes of its files, in the order of [`OUTLINED_ENDINGS`]. Units of the world, and of what is written.
    ///
    /// # Errors
    /// Where a picture cannot be written.
    pub fn files(
        &self,
        places: &MapPlaces,
        [world, unit]: [LengthUnit; 2],
    ) -> Result<[Vec<u8>; 3], Fault> {
        let fragments = &self.fragments.fragments;
        // By number, of which other tools leave some out.
        let mut is_cut = vec![false; self.labels.fragments()];
        for fragment in fragments.iter().filter(|fragment| fragment.is_cut) {
            if let Some(is_cut) = is_cut.get_mut(fragment.number as usize - 1) {
                *is_cut = true;
            }
        }
        let outlines = WorldOutlines {
            photo: self.name,
            labels: self.labels,
            field: self.field,
            fragments,
        };
        Ok([
            labels_png(self.labels)?,
            outlines_png(self.pixels, self.labels, &is_cut)?,
            world_geojson(&outlines, places, world, unit).into_bytes(),
        ])
    }
}
