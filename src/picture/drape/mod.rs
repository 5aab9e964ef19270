//! The photos laid over the surface from above: which photo colours which place of a map.
//!
//! A place takes its colour from the photo that shows a level square there with the most pixels, of those that
//! show it at all: that looks down most squarely and from nearest. What stands between a place and a camera
//! is looked for on the map's own heights.

#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};
use image::RgbImage;
use rayon::prelude::*;

use super::reduce::reduced;
use super::resample::cubic;
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::surface::MapRaster;

/// No photo.
const NONE: u32 = u32::MAX;

/// Side of the squares of pixels that are looked at together.
const TILE: u32 = 32;

/// A photo that may colour a map.
#[derive(Debug, Clone, Copy)]
pub struct PhotoAbove<'a> {
    /// Its camera.
    pub camera: &'a Camera,
    /// Where it stood.
    pub pose: &'a Pose,
    /// Least and greatest x and y of what it shows, world units.
    pub shows: [DVec2; 2],
}

impl PhotoAbove<'_> {
    /// Where a point of the world is in the photo as shot, pixels; `None` outside of it.
    fn pixel(&self, point: DVec3) -> Option<DVec2> {
        let pixel = self
            .camera
            .pixel_as_shot(self.pose.camera_from_world(point))?;
        self.camera.contains(pixel).then_some(pixel)
    }

    /// How many pixels it has on a level square of one world unit there, about; 0 from below.
    fn pixels_on(&self, point: DVec3) -> f64 {
        let to = self.pose.center - point;
        let far = to.length();
        self.camera.fx * self.camera.fy * (to.z / far).max(0.0) / (far * far)
    }
}

/// Which photo colours each pixel of a map.
#[derive(Debug)]
pub struct Draping<'a> {
    raster: &'a MapRaster,
    heights: &'a [f64],
    /// Of each pixel, row by row.
    chosen: Vec<u32>,
}

impl<'a> Draping<'a> {
    /// Of a raster with the heights of the surface at its pixels' middles (NaN where there is none).
    ///
    /// # Errors
    /// Where the work was cancelled.
    pub fn new(
        raster: &'a MapRaster,
        heights: &'a [f64],
        photos: &[Option<PhotoAbove<'_>>],
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let mut chosen = vec![NONE; heights.len()];
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let columns = raster.columns as usize;
        let bands = chosen.par_chunks_mut(columns * TILE as usize).enumerate();
        bands.try_for_each(|(band, chosen)| {
            if progress.is_cancelled() {
                return Err(Fault::new("cancelled", "start it again when you want it"));
            }
            let top = band as u32 * TILE;
            let rows = (chosen.len() / columns) as u32;
            for left in (0..raster.columns).step_by(TILE as usize) {
                let wide = TILE.min(raster.columns - left);
                let ends = [[left, top], [left + wide, top + rows]].map(|[column, row]| {
                    raster.world_from_pixel(DVec2::new(f64::from(column), f64::from(row)))
                });
                let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                let near = photos.iter().enumerate().filter_map(|(index, photo)| {
                    let photo = photo.as_ref()?;
                    let [min, max] = photo.shows;
                    let apart = min.cmpgt(high).any() || max.cmplt(low).any();
                    // A review has fewer photos.
                    (!apart).then_some((u32::try_from(index).unwrap_or(NONE), photo))
                });
                let near: Vec<_> = near.collect();
                for row in 0..rows {
                    for column in left..left + wide {
                        let place = row as usize * columns + column as usize;
                        let cell = [column, top + row];
                        let point = point_at(raster, heights, cell);
                        let Some(point) = point.filter(|_| !near.is_empty()) else {
                            continue;
                        };
                        let mut best: Vec<_> = near
                            .iter()
                            .map(|(index, photo)| (photo.pixels_on(point), *index, *photo))
                            .filter(|(pixels, ..)| *pixels > 0.0)
                            .collect();
                        best.sort_by(|a, b| b.0.total_cmp(&a.0));
                        let sees = |photo: &PhotoAbove<'_>| {
                            photo.pixel(point).is_some()
                                && is_open(raster, heights, highest, cell, photo.pose.center)
                        };
                        let found = best.iter().find(|(_, _, photo)| sees(photo));
                        if let Some((_, index, _)) = found {
                            chosen[place] = *index;
                        }
                    }
                }
            }
            Ok(())
        })?;
        Ok(Self {
            raster,
            heights,
            chosen,
        })
    }

    /// Which photos colour something, in their order.
    pub fn photos(&self) -> Vec<usize> {
        let mut photos: Vec<u32> = self.chosen.clone();
        photos.sort_unstable();
        photos.dedup();
        let some = photos.into_iter().filter(|photo| *photo != NONE);
        some.map(|photo| photo as usize).collect()
    }

    /// The colours of the pixels that a photo colours, each with its place in the raster, from the photo as
    /// shot: the mean over about what a pixel of the map covers.
    ///
    /// # Errors
    /// Where the photo is of another size than its camera.
    pub fn colours(
        &self,
        index: usize,
        photo: &PhotoAbove<'_>,
        picture: &RgbImage,
    ) -> Result<Vec<(usize, [u8; 3])>, Fault> {
        let camera = photo.camera;
        if picture.dimensions() != (camera.width, camera.height) {
            return Err(Fault::new(
                "the photo is of another size than its camera",
                "give the photo that the camera was calibrated for",
            ));
        }
        let columns = self.raster.columns as usize;
        let its = self.chosen.iter().enumerate();
        let its = its.filter(|(_, chosen)| **chosen as usize == index);
        let its: Vec<usize> = its.map(|(place, _)| place).collect();
        let point = |place: usize| {
            let cell = [(place % columns) as u32, (place / columns) as u32];
            point_at(self.raster, self.heights, cell)
        };
        // Pixels of the photo along the side of a pixel of the map.
        let points = its.iter().filter_map(|place| point(*place));
        let (sum, count) = points.fold((0.0, 0_u32), |(sum, count), point| {
            (sum + photo.pixels_on(point).sqrt(), count + 1)
        });
        let across = sum / f64::from(count.max(1)) * self.raster.pixel;
        let longest = f64::from(camera.width.max(camera.height));
        // At least one pixel; `as` saturates.
        let side = (longest / across.max(1.0)).ceil().max(1.0) as u32;
        let small = reduced(picture, side);
        let share = DVec2::new(
            f64::from(small.width()) / f64::from(camera.width),
            f64::from(small.height()) / f64::from(camera.height),
        );
        let colour = |place: usize| {
            let pixel = photo.pixel(point(place)?)? * share;
            Some((place, cubic(&small, pixel.x, pixel.y)))
        };
        Ok(its.par_iter().filter_map(|place| colour(*place)).collect())
    }
}

/// The point of the surface at the middle of a pixel.
fn point_at(raster: &MapRaster, heights: &[f64], [column, row]: [u32; 2]) -> Option<DVec3> {
    let z = heights.get(row as usize * raster.columns as usize + column as usize)?;
    let middle = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
    (!z.is_nan()).then(|| raster.world_from_pixel(middle).extend(*z))
}

/// Whether nothing of the raster stands between the middle of a pixel and a camera: steps of a pixel until
/// the line is over everything.
fn is_open(
    raster: &MapRaster,
    heights: &[f64],
    highest: f64,
    cell: [u32; 2],
    camera: DVec3,
) -> bool {
    let Some(point) = point_at(raster, heights, cell) else {
        return false;
    };
    let off =
        raster.pixel_from_world(camera.truncate()) - raster.pixel_from_world(point.truncate());
    let far = off.length();
    if far < 1.0 {
        return true;
    }
    let step = off / far;
    let rise = (camera.z - point.z) / far;
    let from = DVec2::new(f64::from(cell[0]) + 0.5, f64::from(cell[1]) + 0.5);
    let end = DVec2::new(f64::from(raster.columns), f64::from(raster.rows));
    let mut t = 1.0;
    while t < far {
        // A step of the heights within a pixel hides nothing.
        let z = point.z + rise * t + raster.pixel;
        let at = from + step * t;
        if z > highest || at.cmplt(DVec2::ZERO).any() || at.cmpge(end).any() {
            return true;
        }
        let place = at.y as usize * raster.columns as usize + at.x as usize;
        if heights[place] > z {
            return false;
        }
        t += 1.0;
    }
    true
}
