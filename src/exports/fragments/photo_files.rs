//! A photo whose fragments are outlined: measured, and its files.

use std::path::{Path, PathBuf};

use image::RgbImage;

use super::{WorldOutlines, labels_png, outlines_png, world_geojson};
use crate::delineation::mass::PhotoFragments;
use crate::delineation::measures::SieveShape;
use crate::delineation::{LabelImage, OutlinedBy, photo};
use crate::fault::Fault;
use crate::flight::Flight;
use crate::jobs::Progress;
use crate::map_places::MapPlaces;
use crate::scale::ScaleField;
use crate::units::LengthUnit;

/// How they end behind the photo's name: its label image, its outlines over it, and those in the world.
pub(super) const OUTLINED_ENDINGS: [&str; 3] = ["_labels.png", "_outlines.png", "_world.geojson"];

/// The files of a photo in a folder, in the order of [`OutlinedFiles::bytes`]. `stem` is what the photo's files are called.
pub fn outlined_files(folder: &Path, stem: &str) -> [PathBuf; 3] {
    OUTLINED_ENDINGS.map(|ending| folder.join(format!("{stem}{ending}")))
}

/// A photo with what is outlined in it.
pub struct PhotoOutlined<'a> {
    /// Whose photo it is.
    pub flight: &'a Flight,
    /// Its place there.
    pub index: usize,
    /// Undistorted, at its full size.
    pub pixels: &'a RgbImage,
    /// Of the same pixels.
    pub labels: &'a LabelImage,
    /// What outlined them.
    pub by: OutlinedBy<'a>,
    /// How far the photo's edges are spread, pixels.
    pub spread: Option<f64>,
    /// How sieve sizes follow from outlines.
    pub shape: SieveShape,
}

/// What comes of it.
#[derive(Debug)]
pub struct OutlinedFiles {
    /// What was measured.
    pub fragments: PhotoFragments,
    /// Of [`outlined_files`].
    pub bytes: [Vec<u8>; 3],
    /// What is to be said of the outlines.
    pub notes: Vec<String>,
}

impl PhotoOutlined<'_> {
    /// Measures the fragments where they lie. Units of the world, and of what is written.
    ///
    /// # Errors
    /// Where the photo has no scale, a picture cannot be written, or on cancel.
    pub fn measured(
        &self,
        places: &MapPlaces,
        units: [LengthUnit; 2],
        progress: &Progress,
    ) -> Result<OutlinedFiles, Fault> {
        let posed = &self.flight.parts().photos[self.index];
        let field = photo::field(self.flight, posed, progress)?;
        let habits = self.by.habits();
        let fragments = photo::fragments(
            self.labels,
            &field,
            self.shape,
            habits,
            self.spread,
            units[0],
        );
        Ok(OutlinedFiles {
            bytes: self.bytes(&posed.name, &field, &fragments, places, units)?,
            notes: fragments.notes(self.labels, habits.is_some()),
            fragments,
        })
    }

    fn bytes(
        &self,
        name: &str,
        field: &ScaleField,
        measured: &PhotoFragments,
        places: &MapPlaces,
        [world, unit]: [LengthUnit; 2],
    ) -> Result<[Vec<u8>; 3], Fault> {
        let fragments = &measured.fragments;
        // By number, of which other tools leave some out.
        let mut is_cut = vec![false; self.labels.fragments()];
        for fragment in fragments.iter().filter(|fragment| fragment.is_cut) {
            if let Some(is_cut) = is_cut.get_mut(fragment.number as usize - 1) {
                *is_cut = true;
            }
        }
        let outlines = WorldOutlines {
            photo: name,
            labels: self.labels,
            field,
            fragments,
        };
        Ok([
            labels_png(self.labels)?,
            outlines_png(self.pixels, self.labels, &is_cut)?,
            world_geojson(&outlines, places, world, unit).into_bytes(),
        ])
    }
}
