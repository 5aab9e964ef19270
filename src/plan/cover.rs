//! How well photos cover an area: how much they share, and the widest gap that they leave.
//!
//! Photos of a survey lie over those for scales without filling their gaps: each kind is counted by itself.
//!
//! Counted on the terrain's pixels: a pixel is in a photo where its point lies inside the image. What hides behind
//! other ground counts as seen, for photos look down on it; the forecasts say what they really show.

use glam::DVec2;
use rayon::prelude::*;

use super::patterns::STRAIGHT_DOWN;
use super::terrain::Terrain;
use super::{PlannedPhoto, Purpose};
use crate::camera::Camera;
use crate::survey::Polygon;

/// In so many photos a place has to be to be found surely by a reconstruction: two see it, a third holds them to it.
const TO_RECONSTRUCT: u32 = 3;

/// How photos cover an area.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cover {
    /// The share of the area that some photo shows, of photos for scales, where there are some; what lies beside the
    /// surface nobody shows.
    pub covered: f64,
    /// The share of the area that at least three photos of the survey show; `None` without a survey.
    pub surveyed: Option<f64>,
    /// The share of the area that lies beside the surface or in holes of it.
    pub off_surface: f64,
    /// The diameter of the largest circle inside the area that none of these shows, world units.
    pub widest_gap: f64,
    /// Where its middle lies.
    pub gap_at: Option<DVec2>,
    /// How much photos of the survey that look straight down share with the next where the ground of the area comes nearest to
    /// them: their overlap is wished for at one height, and over what is higher each shows less. Below 0 where
    /// they leave gaps there; `None` without such photos.
    pub least_overlap: Option<f64>,
    /// Of each photo: the share of what it shows that others with its purpose show, too.
    pub shared: Vec<f64>,
}

impl Cover {
    /// Of photos of one camera; those of a survey lie with this overlap, 0 to under 1, at their distance.
    pub fn of(
        (photos, survey_overlap): (&[PlannedPhoto], f64),
        camera: &Camera,
        area: &Polygon,
        terrain: &Terrain,
    ) -> Self {
        let raster = terrain.raster();
        let (columns, rows) = (raster.columns as usize, raster.rows as usize);
        let seen: Vec<Vec<usize>> = photos
            .par_iter()
            .map(|photo| seen_by(photo, camera, terrain))
            .collect();
        let counted = |purpose: Purpose| {
            let mut counts = vec![0_u32; columns * rows];
            let own = photos.iter().zip(&seen);
            let own = own.filter(|(photo, _)| photo.purpose == purpose);
            for place in own.flat_map(|(_, seen)| seen) {
                counts[*place] += 1;
            }
            counts
        };
        let has = |purpose: Purpose| photos.iter().any(|photo| photo.purpose == purpose);
        let [for_scales, of_survey] = [Purpose::Scale, Purpose::Survey].map(counted);
        let shared = photos.iter().zip(&seen).map(|(photo, seen)| {
            let counts = match photo.purpose {
                Purpose::Scale => &for_scales,
                Purpose::Survey => &of_survey,
            };
            let others = seen.iter().filter(|place| counts[**place] > 1).count();
            others as f64 / seen.len().max(1) as f64
        });
        let shared = shared.collect();
        let pixels = terrain.is_in(area);
        let inside: Vec<bool> = pixels.iter().map(|pixel| *pixel == (true, true)).collect();
        let in_area = inside.iter().filter(|inside| **inside).count();
        // Of middles against middles: the pixels of a small area may have more than its own area together. The raster
        // ends with the surface, the area need not.
        let on_raster = (area.area_inside(raster.bounds()) / area.area()).min(1.0);
        let of_area = pixels.iter().filter(|(is_inside, _)| *is_inside).count();
        let share = |pixels: usize| on_raster * pixels as f64 / of_area.max(1) as f64;
        let surveyed = has(Purpose::Survey).then(|| {
            let often = inside.iter().zip(&of_survey);
            share(
                often
                    .filter(|(inside, count)| **inside && **count >= TO_RECONSTRUCT)
                    .count(),
            )
        });
        // What a photo shows grows with its depth, and what lies between two does not.
        let nearest = photos.iter().zip(&seen).filter_map(|(photo, seen)| {
            if photo.purpose != Purpose::Survey || photo.tilt < STRAIGHT_DOWN {
                return None;
            }
            let heights = seen.iter().filter(|place| inside[**place]);
            let highest = heights.map(|place| terrain.heights()[*place]);
            let depth = photo.pose.center.z - highest.reduce(f64::max)?;
            Some(1.0 - (1.0 - survey_overlap) * photo.distance / depth.max(f64::MIN_POSITIVE))
        });
        let least_overlap = nearest.reduce(f64::min);
        let counts = match has(Purpose::Scale) {
            true => &for_scales,
            false => &of_survey,
        };
        let is_gap: Vec<bool> = (inside.iter().zip(counts))
            .map(|(inside, count)| *inside && *count == 0)
            .collect();
        let in_gaps = is_gap.iter().filter(|gap| **gap).count();
        let depths = squared_distances_to_edge(&is_gap, columns);
        let deepest = (depths.iter().zip(0..)).max_by(|a, b| a.0.total_cmp(b.0));
        let (deepest, place) = deepest.map_or((0.0, 0_usize), |(depth, place)| (*depth, place));
        let middle = DVec2::new((place % columns) as f64, (place / columns) as f64) + 0.5;
        Self {
            covered: share(in_area - in_gaps),
            surveyed,
            off_surface: (1.0 - share(in_area)).max(0.0),
            widest_gap: 2.0 * deepest.sqrt() * raster.pixel,
            gap_at: (deepest > 0.0).then(|| raster.world_from_pixel(middle)),
            least_overlap,
            shared,
        }
    }
}

/// The terrain's pixels that lie inside a photo.
pub(super) fn seen_by(photo: &PlannedPhoto, camera: &Camera, terrain: &Terrain) -> Vec<usize> {
    let raster = terrain.raster();
    let columns = raster.columns as usize;
    let place = |point: DVec2| {
        let at = raster.pixel_from_world(point);
        at.y as usize * columns + at.x as usize
    };
    let seen = photo.sees(camera, terrain);
    seen.map(|(point, _)| place(point.truncate())).collect()
}

/// Of each place that is in, the squared distance to the nearest that is not, in pixels; 0 for the others. What
/// lies beyond the raster is in no gap. (Felzenszwalb & Huttenlocher 2012, along columns and then rows.)
fn squared_distances_to_edge(is_in: &[bool], columns: usize) -> Vec<f64> {
    let rows = is_in.len() / columns.max(1);
    // The distance along the column first.
    let mut distances = vec![0.0_f64; is_in.len()];
    for column in 0..columns {
        let place = |row: usize| row * columns + column;
        let mut run = 0.0;
        for row in 0..rows {
            run = if is_in[place(row)] { run + 1.0 } else { 0.0 };
            distances[place(row)] = run;
        }
        run = 0.0;
        for row in (0..rows).rev() {
            run = if is_in[place(row)] { run + 1.0 } else { 0.0 };
            distances[place(row)] = distances[place(row)].min(run);
        }
    }
    let nearest_in_row = |row: &[f64]| -> Vec<f64> {
        let least = |column: usize| {
            let mut least = row[column].powi(2);
            // Nothing farther away along the row can be nearer.
            for step in 1.. {
                if (step as f64).powi(2) >= least {
                    break;
                }
                let beside = [column.checked_sub(step), Some(column + step)];
                for beside in beside {
                    let down = beside.and_then(|beside| row.get(beside)).copied();
                    least = least.min(down.unwrap_or(0.0).powi(2) + (step as f64).powi(2));
                }
            }
            least
        };
        (0..row.len()).map(least).collect()
    };
    distances
        .par_chunks(columns.max(1))
        .flat_map_iter(nearest_in_row)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against every place with every other.
    #[test]
    fn distances_are_those_of_all_pairs() {
        let columns = 9;
        let is_in: Vec<bool> = (0..columns * 8).map(|i| (i * 31) % 11 > 1).collect();
        let found = squared_distances_to_edge(&is_in, columns);
        let at = |place: usize| [(place % columns) as f64, (place / columns) as f64];
        for (place, own) in found.iter().enumerate() {
            let [x, y] = at(place);
            let outside = |x: f64, y: f64| x < 0.0 || y < 0.0 || x >= 9.0 || y >= 8.0;
            let mut least = f64::MAX;
            for dx in -9..=9 {
                for dy in -8..=8 {
                    let (there_x, there_y) = (x + f64::from(dx), y + f64::from(dy));
                    let is_out = outside(there_x, there_y)
                        || !is_in[there_y as usize * columns + there_x as usize];
                    if is_out {
                        least = least.min(f64::from(dx * dx + dy * dy));
                    }
                }
            }
            assert_eq!(*own, least, "{place}");
        }
    }
}
