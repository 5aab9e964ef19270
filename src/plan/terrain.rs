//! The surface as a drone's pilot needs it: heights on a raster, the plane that the ground is near a place, and how
//! near a point in the air is to it.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::tiles::Tiles;
use crate::fault::Fault;
use crate::geometry::{Ray, surrounds};
use crate::jobs::Progress;
use crate::surface::{MapRaster, Surface};
use crate::survey::Polygon;

/// The most pixels of the raster: 32 MB.
const MOST: f64 = 4e6;
/// The least share of a window that has heights, or it says nothing of the ground.
const LEAST_COVERED: f64 = 0.3;

/// Heights of a surface on a raster of the map.
#[derive(Debug, Clone)]
pub struct Terrain {
    raster: MapRaster,
    /// World z at the pixels' middles, row by row; NaN where there is no surface.
    heights: Arc<[f64]>,
    /// The highest in each pixel, for what must not be flown into may be thinner: poles, wires, walls.
    tops: Arc<[f64]>,
    /// A height near all others, so that sums of differences lose nothing.
    base: f64,
    /// What was looked at for it.
    tiles: Arc<Tiles>,
}

/// The plane that lies best through the surface around a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPlane {
    /// On it, at the place.
    pub point: DVec3,
    /// Its normal, upwards, of length 1.
    pub normal: DVec3,
}

/// The height of the plane that lies best through points (least squares in z) over a place, and its growth along x and y
/// over one of these sizes; the height is from that of the place. And how many points there are. `None` where
/// they are fewer than three, or on one line.
pub(super) fn plane_through(
    points: impl Iterator<Item = DVec3>,
    from: DVec3,
    size: DVec2,
) -> Option<(DVec3, usize)> {
    let (mut square, mut right) = (DMat3::ZERO, DVec3::ZERO);
    let mut count = 0_usize;
    for point in points {
        // From the place, in sizes: sums stay near 1.
        let off = (point - from).truncate() / size;
        let row = DVec3::new(1.0, off.x, off.y);
        square += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
        right += row * (point.z - from.z);
        count += 1;
    }
    let is_plane = count >= 3 && square.determinant().abs() >= 1e-9 * (count as f64).powi(3);
    is_plane.then(|| (square.inverse() * right, count))
}

/// The surface's height at a place, to the last digit: the highest there. `None` where there is none.
pub fn ground_at(surface: &Surface, place: DVec2) -> Option<f64> {
    let bounds = surface.bounds();
    let down = Ray {
        origin: place.extend(bounds.max.z + bounds.size().max_element().max(1.0)),
        direction: DVec3::NEG_Z,
    };
    Some(surface.caster().ok()?.cast(&down)?.point.z)
}

impl Terrain {
    /// The surface inside a box of the map (least and greatest x and y). Its pixels are of side `pixel`, or larger
    /// where they would be more than four million. What `known` knows of it is not looked at again; the answer is the same
    /// to the last digit.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn of(
        surface: &Surface,
        [min, max]: [DVec2; 2],
        pixel: f64,
        known: Option<&Self>,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let size = max - min;
        let pixel = pixel.max((size.x * size.y / MOST).sqrt() * 1.01);
        let raster = MapRaster::over([min, max], pixel, MOST as u64 * 2)?;
        let tiles = Tiles::over(&raster, surface, known.map(|known| &*known.tiles), progress)?;
        let heights = tiles.heights(&raster);
        let first = heights.iter().copied().find(|height| !height.is_nan());
        Ok(Self {
            base: first.unwrap_or(0.0),
            heights: heights.into(),
            tops: tiles.tops(&raster).into(),
            tiles: Arc::new(tiles),
            raster,
        })
    }

    /// Its raster.
    pub fn raster(&self) -> &MapRaster {
        &self.raster
    }

    /// World z row by row; NaN where there is no surface.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// The middle of a pixel in the world, on the surface; `None` where there is none.
    pub fn point(&self, column: u32, row: u32) -> Option<DVec3> {
        self.point_of(&self.heights, [column, row])
    }

    fn point_of(&self, heights: &[f64], [column, row]: [u32; 2]) -> Option<DVec3> {
        let place = row as usize * self.raster.columns as usize + column as usize;
        let height = heights.get(place).copied()?;
        let middle = DVec2::new(f64::from(column), f64::from(row)) + 0.5;
        let place = self.raster.world_from_pixel(middle);
        (!height.is_nan()).then(|| place.extend(height))
    }

    /// The points of all pixels that have heights.
    pub fn points(&self) -> impl Iterator<Item = DVec3> {
        let columns = self.raster.columns;
        let places = (0..self.raster.rows).flat_map(move |row| (0..columns).map(move |c| (c, row)));
        places.filter_map(|(column, row)| self.point(column, row))
    }

    /// Of each pixel, row by row, whether its middle lies in an area, and whether it has a height.
    pub(super) fn is_in(&self, area: &Polygon) -> Vec<(bool, bool)> {
        let columns = self.raster.columns as usize;
        let is_in = |place: usize| {
            let middle = DVec2::new((place % columns) as f64, (place / columns) as f64) + 0.5;
            let middle = self.raster.world_from_pixel(middle);
            let is_ground = !self.heights[place].is_nan();
            (surrounds(area.corners(), middle), is_ground)
        };
        (0..self.heights.len()).into_par_iter().map(is_in).collect()
    }

    /// The pixels with heights whose middles lie at most `reach` from a place along both axes.
    pub(super) fn around(&self, place: DVec2, reach: f64) -> impl Iterator<Item = DVec3> {
        let places = self.pixels_around(place, reach);
        places.filter_map(|[column, row]| self.point(column, row))
    }

    /// The tops of pixels whose middles lie at most `reach` from a place along both axes.
    fn tops_around(&self, place: DVec2, reach: f64) -> impl Iterator<Item = DVec3> {
        let places = self.pixels_around(place, reach);
        places.filter_map(|place| self.point_of(&self.tops, place))
    }

    fn pixels_around(&self, place: DVec2, reach: f64) -> impl Iterator<Item = [u32; 2]> + use<> {
        let corner = |sign: f64| {
            let at = self
                .raster
                .pixel_from_world(place + DVec2::new(sign, -sign) * reach);
            [at.x, at.y]
        };
        let (from, to) = (corner(-1.0), corner(1.0));
        // `as` saturates.
        let range = |i: usize, count: u32| {
            let first = (from[i] - 0.5).ceil().max(0.0) as u32;
            first..((to[i] - 0.5).floor() + 1.0).clamp(0.0, f64::from(count)) as u32
        };
        let (columns, rows) = (range(0, self.raster.columns), range(1, self.raster.rows));
        rows.flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }

    /// The plane through the surface around a place, by least squares in z over a square window of this side: what
    /// is smaller than the window is smoothed away. `None` where too little of the window has heights.
    pub fn plane(&self, place: DVec2, side: f64) -> Option<GroundPlane> {
        let (plane, count) = plane_through(
            self.around(place, side / 2.0),
            place.extend(self.base),
            DVec2::splat(side),
        )?;
        let whole = (side / self.raster.pixel).powi(2);
        if (count as f64) < LEAST_COVERED * whole {
            return None;
        }
        let [z, east, north] = plane.to_array();
        Some(GroundPlane {
            point: place.extend(z + self.base),
            normal: DVec3::new(-east / side, -north / side, 1.0).normalize(),
        })
    }

    /// The pixel that a place lies in; `None` off the raster.
    fn pixel_at(&self, place: DVec2) -> Option<[u32; 2]> {
        let at = self.raster.pixel_from_world(place).floor();
        let inside = at.cmpge(DVec2::ZERO).all()
            && at.x < f64::from(self.raster.columns)
            && at.y < f64::from(self.raster.rows);
        // `as` is exact: it lies inside.
        inside.then_some([at.x as u32, at.y as u32])
    }

    /// The height of the pixel that a place lies in; `None` where there is none.
    pub fn height(&self, place: DVec2) -> Option<f64> {
        Some(self.point_of(&self.heights, self.pixel_at(place)?)?.z)
    }

    /// How far a point in the air is from the ground, where that is nearer than `within`; else that. The ground is solid
    /// from the highest of each pixel downwards, so that the face of a wall between two pixels is as near as the wall; pixels
    /// count as near as their nearest corner.
    pub fn clearance(&self, point: DVec3, within: f64) -> f64 {
        self.tops_beside(point.truncate(), within)
            .map(|(beside, top)| beside.hypot((point.z - top).max(0.0)))
            .fold(within, f64::min)
    }

    /// How far a place of the map is from the nearest of the surface; 0 where some lies under it.
    pub(super) fn distance_beyond(&self, place: DVec2) -> f64 {
        if self.is_over_surface(place) {
            return 0.0;
        }
        let [min, max] = self.raster.bounds();
        // Nothing of it is farther.
        let most = place.distance(min).max(place.distance(max)) + min.distance(max);
        let mut reach = 4.0 * self.raster.pixel;
        loop {
            let beside = self.tops_beside(place, reach).map(|(beside, _)| beside);
            let nearest = beside.fold(most, f64::min);
            // What is nearer than the reach is among what was looked at.
            if nearest <= reach || reach >= most {
                return nearest;
            }
            reach *= 2.0;
        }
    }

    /// Whether some of the surface lies in the pixel of a place.
    pub(super) fn is_over_surface(&self, place: DVec2) -> bool {
        let pixel = self.pixel_at(place);
        pixel.is_some_and(|pixel| self.point_of(&self.tops, pixel).is_some())
    }

    /// How far, level, tops around a place are from it, and how high they are: all that are nearer than `within`, and some more.
    fn tops_beside(&self, place: DVec2, within: f64) -> impl Iterator<Item = (f64, f64)> {
        let corner = self.raster.pixel * FRAC_1_SQRT_2;
        self.tops_around(place, within + corner).map(move |top| {
            let beside = (top.truncate().distance(place) - corner).max(0.0);
            (beside, top.z)
        })
    }

    /// Whether a point in the air is nearer than `clearance` to the ground, or in it.
    pub fn is_near(&self, point: DVec3, clearance: f64) -> bool {
        self.clearance(point, clearance) < clearance
    }

    /// Whether the ground stands between one of its points and the sun in this direction, of length 1. Nothing of it is
    /// higher than `highest`. A pixel does not shade itself.
    pub(super) fn is_shadowed(&self, point: DVec3, toward: DVec3, highest: f64) -> bool {
        let level = toward.truncate().length();
        if toward.z <= 0.0 {
            return true;
        }
        if level == 0.0 {
            return false;
        }
        // A pixel on with each step.
        let step = toward / level * self.raster.pixel;
        let [min, max] = self.raster.bounds();
        let mut at = point + step;
        while at.z < highest && at.truncate().cmpge(min).all() && at.truncate().cmple(max).all() {
            if self
                .height(at.truncate())
                .is_some_and(|height| height > at.z)
            {
                return true;
            }
            at += step;
        }
        false
    }

    /// The highest of the surface within `reach` of the line between two places; `None` where there is none.
    pub fn highest_along(&self, from: DVec2, to: DVec2, reach: f64) -> Option<f64> {
        self.highest_in([from, to, to], reach)
    }

    /// The highest of the surface within `reach` of a triangle of the map, along both axes; `None` where there is none. It looks
    /// at each pixel once, row by row: between home and the legs of a survey lie many triangles.
    pub(super) fn highest_in(&self, triangle: [DVec2; 3], reach: f64) -> Option<f64> {
        let corners = triangle.map(|corner| self.raster.pixel_from_world(corner));
        let reach = reach / self.raster.pixel + FRAC_1_SQRT_2;
        // Pixels whose middles lie in a range; `as` saturates.
        let pixels = |[least, most]: [f64; 2], count: u32| {
            let first = (least - reach - 0.5).ceil().max(0.0) as u32;
            first..((most + reach - 0.5).floor() + 1.0).clamp(0.0, f64::from(count)) as u32
        };
        let range = |numbers: &mut dyn Iterator<Item = f64>| {
            numbers.fold([f64::MAX, f64::MIN], |[least, most], number| {
                [least.min(number), most.max(number)]
            })
        };
        let rows = pixels(
            range(&mut corners.iter().map(|corner| corner.y)),
            self.raster.rows,
        );
        let tops = rows.flat_map(|row| {
            let [low, high] = [-reach, reach].map(|off| f64::from(row) + 0.5 + off);
            // Where the sides are that near to the row: what of the triangle is, lies between them.
            let mut ends = (0..3).flat_map(|side| {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                let is_near = from.y.min(to.y) <= high && from.y.max(to.y) >= low;
                let x_at = move |end: DVec2| {
                    let y = end.y.clamp(low, high);
                    match y == end.y {
                        true => end.x,
                        false => from.x + (y - from.y) / (to.y - from.y) * (to.x - from.x),
                    }
                };
                is_near
                    .then(|| [x_at(from), x_at(to)])
                    .into_iter()
                    .flatten()
            });
            let columns = pixels(range(&mut ends), self.raster.columns);
            columns.filter_map(move |column| Some(self.point_of(&self.tops, [column, row])?.z))
        });
        tops.reduce(f64::max)
    }

    /// Whether a straight leg is nearer than `clearance` to the surface anywhere.
    pub fn is_leg_near(&self, from: DVec3, to: DVec3, clearance: f64) -> bool {
        // A pole midway between two looks that just do not see it is nearer to the leg by a 512th of the clearance, which
        // the corners of pixels are good for.
        along(from, to, (clearance / 8.0).max(self.raster.pixel))
            .any(|place| self.is_near(place, clearance))
    }
}

/// Places from one to the other, at most so far apart.
pub(super) fn along(from: DVec3, to: DVec3, step: f64) -> impl Iterator<Item = DVec3> {
    let count = (from.distance(to) / step).ceil().max(1.0);
    // `as` saturates; legs are kilometres at most.
    (0..=count as u64).map(move |step| from.lerp(to, step as f64 / count))
}
