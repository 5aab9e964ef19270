//! What a small error of a pose does to the line through a photo's field.
//!
//! A camera that is moved by v and turned by ω (both in its axes) sees each point of the surface elsewhere: the
//! point at the ray d = (x, y, 1) with the inverse depth w moves in the image by
//!
//! ```text
//! ẋ = w (x v_z - v_x) - (ω × d)_x + x (ω × d)_z      and likewise ẏ,
//! ```
//!
//! and its inverse depth grows by w² v_z + w (ω × d)_z (the equations of optical flow, Longuet-Higgins & Prazdny
//! 1980). At a pixel, another point is seen then: its inverse depth changes by that less w_x ẋ + w_y ẏ. A plane
//! alone would miss what a crest does: where the pile falls away on both sides, a camera that is a little
//! further on sees the near edge nearer and the far edge farther, and the line tilts. (By the plane, intervals
//! over simulated heaps held 87 % of the lines instead of 95.) Slopes are those of the plane, and of what the
//! field's neighbours lie off it.

use glam::{DMat2, DVec2, DVec3};

use super::holes::Line;
use crate::scale::field::{FieldGrid, ScaleField};
use crate::scale::{FittedScale, ImageKind};

/// What moves and turns do to one end of the line, shares of its scale: a unit of the world along each axis of the
/// camera, and a radian about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moved {
    pub(super) by_position: DVec3,
    pub(super) by_angle: DVec3,
}

/// Of top and bottom of the line through a field with this plane (`surface_error::plane_of`).
pub(super) fn of_moves(field: &ScaleField, fitted: &FittedScale, plane: DVec3) -> [Moved; 2] {
    let FieldGrid { columns, rows } = field.grid;
    let camera = field.camera();
    let focal = (camera.fx * camera.fy).sqrt();
    let off_plane = OffPlane { field, plane };
    let mut lines = [Line::default(); 6];
    for row in 0..rows {
        let down = (f64::from(row) + 0.5) / f64::from(rows);
        for column in 0..columns {
            let place = (column, row);
            let (Some(d), Some(depth)) =
                (field.direction_at(column, row), field.depth_at(column, row))
            else {
                continue;
            };
            let lens = match field.image() {
                ImageKind::Undistorted => 1.0,
                ImageKind::AsShot => camera.lens_area(d).map_or(0.0, f64::sqrt),
            };
            let slope = plane.truncate() + off_plane.slope(place);
            for (line, change) in lines.iter_mut().zip(changes(d, depth.recip(), slope)) {
                line.add(down, focal * lens * change);
            }
        }
    }
    let ends = lines.map(Line::ends);
    let [top, bottom] = [(0, fitted.top), (1, fitted.bottom)].map(|(end, scale)| {
        let share = |number: usize| ends[number][end] / scale;
        Moved {
            by_position: DVec3::new(share(0), share(1), share(2)),
            by_angle: DVec3::new(share(3), share(4), share(5)),
        }
    });
    [top, bottom]
}

/// How the inverse depth w at the ray d changes, where it has the slope (w_x, w_y): by a unit along each axis,
/// then by a radian about it.
fn changes(d: DVec3, w: f64, slope: DVec2) -> [f64; 6] {
    let change = |flow: DVec2, along: f64| along - slope.dot(flow);
    let [x, y, z] = DVec3::AXES.map(|v| {
        let flow = (d.truncate() * v.z - v.truncate()) * w;
        change(flow, w * w * v.z)
    });
    let [about_x, about_y, about_z] = DVec3::AXES.map(|turn| {
        let turned = turn.cross(d);
        let flow = d.truncate() * turned.z - turned.truncate();
        change(flow, w * turned.z)
    });
    [x, y, z, about_x, about_y, about_z]
}

/// What of the inverse depth is not the plane's.
struct OffPlane<'a> {
    field: &'a ScaleField,
    plane: DVec3,
}

impl OffPlane<'_> {
    /// By x and y of the ray at a place, from its neighbours; 0 where it has none on a side.
    fn slope(&self, place: (u32, u32)) -> DVec2 {
        let FieldGrid { columns, rows } = self.field.grid;
        let (column, row) = place;
        let across = self.between((column.saturating_sub(1), row), place)
            + self.between(place, ((column + 1).min(columns - 1), row));
        let along = self.between((column, row.saturating_sub(1)), place)
            + self.between(place, (column, (row + 1).min(rows - 1)));
        // Steps of the ray as rows, so that their product with the slope is the step of what is off.
        let rays = DMat2::from_cols(across.ray, along.ray).transpose();
        let slope = rays.inverse() * DVec2::new(across.off, along.off);
        match slope.is_finite() {
            true => slope,
            false => DVec2::ZERO,
        }
    }

    /// From a place to the next.
    fn between(&self, from: (u32, u32), to: (u32, u32)) -> Step {
        let at = |(column, row): (u32, u32)| {
            let d = self.field.direction_at(column, row)?;
            let off = self.field.depth_at(column, row)?.recip() - self.plane.dot(d);
            Some((d.truncate(), off))
        };
        match (at(from), at(to)) {
            (Some((before, was)), Some((after, is))) => Step {
                ray: after - before,
                off: is - was,
            },
            _ => Step::default(),
        }
    }
}

/// How the ray and what is off the plane change.
#[derive(Clone, Copy, Default)]
struct Step {
    ray: DVec2,
    off: f64,
}

impl std::ops::Add for Step {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            ray: self.ray + other.ray,
            off: self.off + other.off,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over the plane m·X = 1 the inverse depth at d is m·d, and that of a camera turned by ω and moved by v
    /// is (m + m × ω + m (m·v))·d.
    #[test]
    fn over_a_plane_changes_are_known() {
        let plane = DVec3::new(0.02, -0.03, 0.1);
        let d = DVec3::new(0.4, -0.2, 1.0);
        let found = changes(d, plane.dot(d), plane.truncate());
        for (axis, way) in DVec3::AXES.into_iter().enumerate() {
            let moved = (plane * plane.dot(way)).dot(d);
            let turned = plane.cross(way).dot(d);
            assert!((found[axis] - moved).abs() < 1e-15, "{axis}");
            assert!((found[axis + 3] - turned).abs() < 1e-15, "{axis}");
        }
    }
}
