//! The colours of the surface's points on a raster of the map.

use super::MapRaster;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::surface::Surface;

/// How far colours are carried to pixels in which no point lies, pixels.
const FARTHEST: usize = 48;

/// How many points are looked at before somebody may have cancelled.
const CHUNK: usize = 1 << 20;

impl Surface {
    /// The colour of the highest point in each pixel of a raster, row by row; where none lies in it, the mean
    /// of its neighbours', from as many as 48 pixels away. `None` where there is no surface (`heights` is NaN)
    /// or no point near, and everywhere where the surface has no colours.
    ///
    /// # Errors
    /// Where the work was cancelled.
    pub fn colours_from_above(
        &self,
        raster: &MapRaster,
        heights: &[f64],
        progress: &Progress,
    ) -> Result<Vec<Option<[u8; 3]>>, Fault> {
        let (columns, rows) = (raster.columns as usize, raster.rows as usize);
        let mut highest = vec![f64::NEG_INFINITY; heights.len()];
        let mut colours: Vec<Option<[u8; 3]>> = vec![None; heights.len()];
        let points = self.vertices().zip(self.colors());
        for (count, (point, colour)) in points.enumerate() {
            if count % CHUNK == 0 {
                progress.advance(count as u64, self.colors().len() as u64)?;
            }
            let at = raster.pixel_from_world(point.truncate()).floor();
            if at.x < 0.0 || at.y < 0.0 || at.x >= columns as f64 || at.y >= rows as f64 {
                continue;
            }
            let place = at.y as usize * columns + at.x as usize;
            if point.z > highest[place] {
                highest[place] = point.z;
                colours[place] = Some(*colour);
            }
        }
        // Pixels without a colour beside one that has it: those of the next ring.
        let neighbours = |place: usize| {
            let (column, row) = (place % columns, place / columns);
            let left = (column > 0).then(|| place - 1);
            let right = (column + 1 < columns).then(|| place + 1);
            let up = (row > 0).then(|| place - columns);
            let down = (row + 1 < rows).then(|| place + columns);
            [left, right, up, down].into_iter().flatten()
        };
        let coloured = (0..colours.len()).filter(|place| colours[*place].is_some());
        let mut edge: Vec<usize> = coloured.collect();
        for _ in 0..FARTHEST {
            let beside = edge.iter().flat_map(|place| neighbours(*place));
            let mut next: Vec<usize> = beside
                .filter(|place| colours[*place].is_none() && !heights[*place].is_nan())
                .collect();
            if next.is_empty() {
                break;
            }
            progress.advance(0, 1)?;
            next.sort_unstable();
            next.dedup();
            let mixed: Vec<_> = next
                .iter()
                .map(|&place| mean(&colours, neighbours(place)))
                .collect();
            for (place, colour) in next.iter().zip(mixed) {
                colours[*place] = colour;
            }
            edge = next;
        }
        Ok(colours)
    }
}

fn mean(colours: &[Option<[u8; 3]>], places: impl Iterator<Item = usize>) -> Option<[u8; 3]> {
    let mut sum = [0_u32; 3];
    let mut count = 0;
    for colour in places.filter_map(|place| colours[place]) {
        for (sum, value) in sum.iter_mut().zip(colour) {
            *sum += u32::from(value);
        }
        count += 1;
    }
    // A mean of bytes is one.
    (count > 0).then(|| sum.map(|sum| (sum / count) as u8))
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::surface::Cloud;

    /// Two points over each other: the upper one's colour; between points of two colours each pixel has that of
    /// the nearer.
    #[test]
    fn the_highest_point_colours_a_pixel() {
        let point = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let cloud = Cloud {
            points: vec![
                point(0.5, 0.5, 0.0),
                point(0.6, 0.5, 1.0),
                point(9.5, 0.5, 0.0),
                point(0.5, 9.5, 0.0),
            ],
            colors: vec![[1, 2, 3], [200, 0, 0], [0, 200, 0], [200, 0, 0]],
            ..Cloud::default()
        };
        let surface = Surface::new(cloud).unwrap();
        let raster = MapRaster::over([DVec2::ZERO, DVec2::splat(10.0)], 1.0, 1000).unwrap();
        let mut heights = vec![0.0; 100];
        heights[5] = f64::NAN;
        let progress = Progress::default();
        let colours = surface
            .colours_from_above(&raster, &heights, &progress)
            .unwrap();
        let at = |column: usize, row: usize| colours[row * 10 + column];
        assert_eq!(at(0, 9), Some([200, 0, 0]));
        assert_eq!(at(9, 9), Some([0, 200, 0]));
        assert_eq!(at(2, 9), Some([200, 0, 0]));
        assert_eq!(at(8, 8), Some([0, 200, 0]));
        assert_eq!(at(5, 0), None, "no surface");
        let bare = Surface::new(Cloud {
            points: vec![
                point(0.5, 0.5, 0.0),
                point(9.0, 1.0, 0.0),
                point(3.0, 8.0, 0.0),
            ],
            ..Cloud::default()
        });
        let none = bare
            .unwrap()
            .colours_from_above(&raster, &heights, &progress)
            .unwrap();
        assert!(none.iter().all(Option::is_none));
    }
}
