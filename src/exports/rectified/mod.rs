//! A photo seen squarely, with one scale everywhere, as a file: a PNG or TIFF with a bar below it, its
//! pixel size in the tags, and a world file beside it.
//!
//! ```text
//! description   what the file says of itself
//! png           chunks of PNG
//! world_file    where the picture lies
//! ```

mod description;
mod png;
mod world_file;

use std::borrow::Cow;

use glam::DVec2;
use image::RgbImage;

use self::description::description;
use crate::fault::Fault;
use crate::geo_tags::{OnMap, geo_tags};
use crate::numbers::significant_digits;
use crate::picture::{bar_below, warped};
use crate::scale::{Onto, Rectification};
use crate::tiff_pages::{GeoTags, Page, Pixels, fraction, tiff_of};
use crate::units::LengthUnit;

/// A rectification with what has to be said beside it.
#[derive(Debug, Clone, Copy)]
pub struct RectifiedPhoto<'a> {
    /// Which place of the picture comes from which pixel.
    pub rectification: &'a Rectification,
    /// What it is seen onto.
    pub onto: Onto,
    /// The flight's name.
    pub flight: &'a str,
    /// The photo's.
    pub photo: &'a str,
    /// Pixel size and bar are said in this.
    pub unit: LengthUnit,
    /// The unit of the world.
    pub world_unit: LengthUnit,
    /// The coordinate system of the world: "EPSG:n" or WKT.
    pub crs: Option<&'a str>,
}

/// In which format a picture is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RectifiedFormat {
    /// With its pixel size in pHYs and EXIF.
    Png,
    /// With its pixel size in the resolution tags.
    Tiff,
}

impl RectifiedFormat {
    /// The endings of the picture's name and of its world file's, without their dots.
    pub fn endings(self) -> [&'static str; 2] {
        match self {
            Self::Png => ["png", "pgw"],
            Self::Tiff => ["tif", "tfw"],
        }
    }
}

impl RectifiedPhoto<'_> {
    /// The side of a pixel in [`Self::unit`], without the noise of conversions.
    fn pixel(&self) -> f64 {
        let pixel = self.rectification.raster.pixel * self.world_unit.in_units_of(self.unit);
        // A dozen digits are more than any survey has.
        format!("{pixel:.11e}").parse().unwrap_or(pixel)
    }

    /// The picture's file, from the photo as shot.
    ///
    /// # Errors
    /// Where the photo is of another size than its camera, or the picture cannot be encoded.
    pub fn bytes(&self, photo: &RgbImage, format: RectifiedFormat) -> Result<Vec<u8>, Fault> {
        let camera = self.rectification.camera();
        crate::picture::check_size_of(photo, camera)?;
        let raster = &self.rectification.raster;
        let (size, smooth) = (
            [raster.columns, raster.rows],
            self.rectification.is_smooth(),
        );
        let picture = warped(photo, size, smooth, |place| {
            self.rectification.source(place)
        });
        let picture = bar_below(&picture, self.pixel(), self.unit);
        let resolution =
            fraction(1.0 / (self.pixel() * self.unit.in_units_of(LengthUnit::Centimetre)));
        match format {
            RectifiedFormat::Png => png::bytes(&picture, &description(self), resolution),
            RectifiedFormat::Tiff => {
                let (width, height) = picture.dimensions();
                let page = Page {
                    width,
                    height,
                    pixels: Pixels::Colors(Cow::Owned(picture.into_raw())),
                    description: description(self),
                    resolution,
                    georeference: self.georeference(),
                };
                tiff_of(std::iter::once(Ok(page)))
            }
        }
    }

    /// Where it lies on the map; nowhere on a plane that is not level.
    fn georeference(&self) -> Option<GeoTags> {
        let raster = &self.rectification.raster;
        let is_level = matches!(self.onto, Onto::HorizontalPlane | Onto::Surface);
        is_level.then(|| {
            geo_tags(&OnMap {
                crs: self.crs,
                unit: Some(self.world_unit),
                pixel: raster.pixel,
                corner: raster.world_from_picture(DVec2::ZERO).truncate(),
            })
        })
    }

    /// What was made, for people.
    pub fn words(&self) -> String {
        let (raster, unit) = (&self.rectification.raster, self.unit);
        let size = format!(
            "{} x {} pixels of {} {unit}",
            raster.columns,
            raster.rows,
            self.pixel()
        );
        let off = self.rectification.off_plane;
        let off = off.map(|off| off * self.world_unit.in_units_of(unit));
        match (self.onto, off) {
            (Onto::Surface, _) | (_, None) => format!("{size}, from straight above"),
            (Onto::FittedPlane, Some(off)) => format!(
                "{size} on the plane through what it shows, {} {unit} (rms) off it",
                significant_digits(off, 2)
            ),
            (Onto::HorizontalPlane, Some(off)) => format!(
                "{size} on a horizontal plane, what it shows is {} {unit} (rms) off it",
                significant_digits(off, 2)
            ),
        }
    }

    /// The world file: the place of its pixels, in the six lines that map programs read.
    pub fn world_file(&self) -> String {
        world_file::text(&self.rectification.raster, self.onto)
    }
}

#[cfg(test)]
mod tests;
