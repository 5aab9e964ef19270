//! Patches of a photo, laid on the surface.

use glam::DVec3;

use super::SmallPhoto;
use crate::scale::{FieldGrid, ScaleField};

/// A patch's side, pixels of the small photo.
pub(super) const SIDE: usize = 7;

/// The pixels of a patch.
pub(super) const PIXELS: usize = SIDE * SIDE;

/// From patch to patch, pixels: side by side, denser ones would hardly say more.
const STEP: u32 = 7;

/// The least deviation of a patch's brightness, of 255: sky and burnt-out white match anything.
const LEAST_TEXTURE: f32 = 2.0;

/// A patch of a photo.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    /// Where its pixels lie on the surface, world coordinates, row by row.
    pub(super) points: [DVec3; PIXELS],
    /// Their brightness less its mean, over its root sum of squares.
    pub(super) shades: [f32; PIXELS],
}

/// The patches of a photo that lie on the surface and are no plain colour.
#[derive(Debug, Clone, Default)]
pub struct Patches {
    pub(super) patches: Vec<Patch>,
    /// The camera's centre, world coordinates.
    pub(super) eye: DVec3,
}

impl Patches {
    /// The grid that [`Self::of`] asks for: a point to every second pixel of the small photo, and what is between lies between.
    pub fn grid(photo: &SmallPhoto) -> FieldGrid {
        let [columns, rows] = photo.size().map(|side| side.div_ceil(2));
        FieldGrid { columns, rows }
    }

    /// Of a photo with its field on [`Self::grid`].
    pub fn of(photo: &SmallPhoto, field: &ScaleField) -> Self {
        let [width, height] = photo.size();
        let half = SIDE as u32 / 2;
        let along = |length: u32| (half..length.saturating_sub(half)).step_by(STEP as usize);
        let places = along(height).flat_map(|row| along(width).map(move |column| (column, row)));
        let patch = |(column, row): (u32, u32)| {
            let (left, top) = (column - half, row - half);
            let shades = shades(photo, left, top)?;
            let mut points = [DVec3::ZERO; PIXELS];
            for (at, point) in (0_u32..).zip(&mut points) {
                let side = SIDE as u32;
                *point = point_between(field, photo, [left + at % side, top + at / side])?;
            }
            Some(Patch { points, shades })
        };
        Self {
            patches: places.filter_map(patch).collect(),
            eye: field.pose().center,
        }
    }
}

/// Where a pixel of the small photo lies on the surface, between the four points of the field around it; `None` where one of them
/// is not on it.
fn point_between(field: &ScaleField, photo: &SmallPhoto, [column, row]: [u32; 2]) -> Option<DVec3> {
    // Centres of pixels and of the grid's cells both lie half of one in.
    let along = |place: u32, pixels: u32, cells: u32| {
        let at = (f64::from(place) + 0.5) * f64::from(cells) / f64::from(pixels) - 0.5;
        let first = at.floor().clamp(0.0, f64::from(cells.saturating_sub(2)));
        (first as u32, at - first)
    };
    let [width, height] = photo.size();
    let (left, x) = along(column, width, field.grid.columns);
    let (top, y) = along(row, height, field.grid.rows);
    let point = |right: u32, down: u32| Some(field.at(left + right, top + down)?.point);
    let above = point(0, 0)?.lerp(point(1, 0)?, x);
    let below = point(0, 1)?.lerp(point(1, 1)?, x);
    Some(above.lerp(below, y))
}

/// The brightness of a patch's pixels less its mean, as long as 1; `None` where the photo shows nothing or one colour.
fn shades(photo: &SmallPhoto, left: u32, top: u32) -> Option<[f32; PIXELS]> {
    let mut shades = [0.0; PIXELS];
    for (at, shade) in (0_u32..).zip(&mut shades) {
        let side = SIDE as u32;
        *shade = photo.pixel(left + at % side, top + at / side)?;
    }
    normalised(&mut shades).then_some(shades)
}

/// Takes the mean off and makes them as long as 1; whether they vary enough for it.
pub(super) fn normalised(shades: &mut [f32; PIXELS]) -> bool {
    let mean = dot(shades, &[1.0; PIXELS]) / PIXELS as f32;
    shades.iter_mut().for_each(|shade| *shade -= mean);
    let length = dot(shades, shades).sqrt();
    if length < LEAST_TEXTURE * SIDE as f32 {
        return false;
    }
    shades.iter_mut().for_each(|shade| *shade /= length);
    true
}

/// The sum of products, in eight sums side by side: one after the other each would wait for the last.
pub(super) fn dot(a: &[f32; PIXELS], b: &[f32; PIXELS]) -> f32 {
    let (a, a_rest) = a.as_chunks::<8>();
    let (b, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f32>() + rest
}
