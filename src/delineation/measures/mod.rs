//! What is measured of each fragment, in the world: each pixel counts with the scale of its own place on the
//! surface, so that neither the tilt of the photo nor the relief of the pile needs a word.
//!
//! Lengths within the image (rectangle, widths, inscribed circle) are measured in pixels and taken to the
//! world by the fragment's own scale, the one by which its pixels have its area. Areas are sums over pixels.

mod feret;
mod inscribed;
mod shape;

use fragscale_core::scale::ScaleField;
use glam::{DVec2, DVec3};

pub(crate) use inscribed::distances as distances_within;
pub use shape::SieveShape;

use crate::hull::hull;
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use feret::{rectangle, widths};

/// The share of a fragment's pixels that are lower than it is said to stand out. The highest are left out, as one stray point
/// of the cloud makes a spike over a few; the top of an ellipsoid is 2.5 % lower by that.
const LOWER: f64 = 0.95;

/// A fragment with less of its pixels on the surface has no measures.
pub const LEAST_ON_SURFACE: f64 = 0.6;

/// A fragment of a photo, in the world's unit where no other is said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fragment {
    /// Its number in the label image.
    pub number: u32,
    /// Its pixels.
    pub pixels: usize,
    /// The mean of their places in the undistorted photo.
    pub middle: DVec2,
    /// Whether the photo's edge, or what was left out, cuts it: its size is not known.
    pub is_cut: bool,
    /// Whether it is the photo's edge that does.
    pub is_at_edge: bool,
    /// Its extent along the photo's columns and rows, pixels.
    pub extent: DVec2,
    /// In the world; `None` where too little of it is on the surface.
    pub world: Option<Measures>,
}

/// What is measured in the world. Lengths in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Its mean place on the surface.
    pub place: DVec3,
    /// Pixels per unit: the root of its pixels over its area.
    pub scale: f64,
    /// On planes parallel to the image, each pixel at its own depth.
    pub area: f64,
    /// On the surface itself.
    pub surface_area: f64,
    /// Of the circle of its area.
    pub diameter: f64,
    /// The sides of the least rectangle about it, the longer first.
    pub rectangle: [f64; 2],
    /// Its least and greatest width between parallels (Feret).
    pub widths: [f64; 2],
    /// The diameter of the largest circle within it.
    pub inscribed: f64,
    /// 4 area / (pi greatest width squared): 1 for a circle (ISO 9276-6, roundness).
    pub roundness: f64,
    /// How high it stands out of a plane through its outline: 95 of 100 of its pixels stand lower. Below 0 where it lies in
    /// a hollow; `None` where its outline is no more than a line.
    pub height: Option<f64>,
    /// The sieve opening that it is taken to pass.
    pub sieve_size: f64,
}

/// The measures of all fragments, in the order of their numbers; numbers that no pixel has are left out. `field` is that of all pixels of the same
/// undistorted photo.
pub fn measured(labels: &LabelImage, field: &ScaleField, shape: SieveShape) -> Vec<Fragment> {
    let mut sums = vec![Sums::default(); labels.fragments()];
    let (width, height) = (labels.width, labels.height);
    let at = |x: usize, y: usize| labels.labels[y * width + x];
    let inside = distances_within(labels);
    for y in 0..height {
        for x in 0..width {
            let label = at(x, y);
            if label == FINES || label == NOT_ROCK {
                continue;
            }
            let of = &mut sums[label as usize - 1];
            let before = (x > 0).then(|| at(x - 1, y));
            let behind = (x + 1 < width).then(|| at(x + 1, y));
            let above = (y > 0).then(|| at(x, y - 1));
            let below = (y + 1 < height).then(|| at(x, y + 1));
            let beside = [before, behind, above, below];
            of.pixels += 1;
            of.places += DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            of.is_cut |= beside
                .iter()
                .any(|other| matches!(other, None | Some(NOT_ROCK)));
            of.is_at_edge |= beside.contains(&None);
            of.deepest = of.deepest.max(inside[y * width + x]);
            for (differs, x) in [(before != Some(label), x), (behind != Some(label), x + 1)] {
                if differs {
                    let (x, y) = (x as f32, y as f32);
                    of.corners.extend([[x, y], [x, y + 1.0]]);
                }
            }
            let Some(met) = field.at(x as u32, y as u32) else {
                continue;
            };
            of.on_surface += 1;
            of.points += met.point;
            of.area += 1.0 / (met.scale * met.scale);
            of.surface_area += on_surface(field, x as u32, y as u32)
                .unwrap_or_else(|| 1.0 / (met.scale * met.scale));
            let is_outline = beside.iter().any(|other| *other != Some(label));
            if is_outline {
                of.outline.push(met.point);
            }
        }
    }
    // How high each stands needs its outline first.
    let towards = -field.pose().rotation.z_axis;
    let planes: Vec<Option<Plane>> = sums
        .iter()
        .map(|of| Plane::through(&of.outline, towards))
        .collect();
    let mut heights: Vec<Vec<f32>> = vec![Vec::new(); sums.len()];
    for y in 0..height {
        for x in 0..width {
            let label = at(x, y);
            if label == FINES || label == NOT_ROCK {
                continue;
            }
            let place = label as usize - 1;
            if let (Some(plane), Some(met)) = (&planes[place], field.at(x as u32, y as u32)) {
                heights[place].push(plane.above(met.point) as f32);
            }
        }
    }
    let all = (1..).zip(sums.iter_mut().zip(heights));
    all.filter(|(_, (of, _))| of.pixels > 0)
        .map(|(number, (of, mut heights))| of.fragment(number, stands_out(&mut heights), shape))
        .collect()
}

/// The height that most pixels do not exceed; `None` of none.
fn stands_out(heights: &mut [f32]) -> Option<f64> {
    let place = (heights.len() as f64 * LOWER) as usize;
    let last = heights.len().checked_sub(1)?;
    let (_, height, _) = heights.select_nth_unstable_by(place.min(last), f32::total_cmp);
    Some(f64::from(*height))
}

/// The diameter of the circle with this area.
pub(crate) fn circle_diameter(area: f64) -> f64 {
    (4.0 * area / std::f64::consts::PI).sqrt()
}

/// The area on the surface that a pixel shows; `None` where its neighbours' rays do not meet the surface, or where it breaks off
/// between them.
///
/// It is that of the quadrilateral in which the rays of the pixel's corners meet the plane through its own point and those of two
/// neighbours: with n the plane's normal, r the ray of depth 1 and w = n·r, all of the pixel's middle, and w + a ± b and w - a ± b at
/// its corners, the area across the axis times |n| / |w| / ((1 - ((a + b) / w)²) (1 - ((a - b) / w)²)). A triangle in a plane at the
/// distance d from the camera has half of |det(P, Q, R)| / d, and depths along a plane go as 1 / w.
fn on_surface(field: &ScaleField, x: u32, y: u32) -> Option<f64> {
    let here = field.at(x, y)?;
    let beside = |ahead: Option<(u32, u32)>, back: Option<(u32, u32)>| -> Option<DVec3> {
        let (other, sign) = ahead
            .and_then(|(x, y)| Some((field.at(x, y)?, 1.0)))
            .or_else(|| back.and_then(|(x, y)| Some((field.at(x, y)?, -1.0))))?;
        Some((other.point - here.point) * sign)
    };
    let (columns, rows) = (field.grid.columns, field.grid.rows);
    let across = beside(
        (x + 1 < columns).then_some((x + 1, y)),
        x.checked_sub(1).map(|x| (x, y)),
    )?;
    let along = beside(
        (y + 1 < rows).then_some((x, y + 1)),
        y.checked_sub(1).map(|y| (x, y)),
    )?;
    let normal = field.pose().rotation.transpose() * across.cross(along);
    let ray = field.direction_at(x, y)?;
    let to_plane = normal.dot(ray);
    let half_way = |other: DVec3| normal.dot(other - ray) / 2.0 / to_plane;
    let right = half_way(field.direction_at(x + 1, y)?);
    let down = half_way(field.direction_at(x, y + 1)?);
    let [one, other] = [right + down, right - down];
    let corners = (1.0 - one * one) * (1.0 - other * other);
    let flat = 1.0 / (here.scale * here.scale);
    let area = flat * normal.length() / to_plane.abs() / corners;
    // Beyond 1 a corner's ray does not meet the plane. Steeper than 80 degrees is a step from one fragment to one behind it.
    let is_met = one.abs() < 1.0 && other.abs() < 1.0;
    (is_met && area < 6.0 * flat).then_some(area)
}

/// What is summed over a fragment's pixels.
#[derive(Debug, Clone, Default)]
struct Sums {
    pixels: usize,
    places: DVec2,
    is_cut: bool,
    is_at_edge: bool,
    deepest: f64,
    corners: Vec<[f32; 2]>,
    on_surface: usize,
    points: DVec3,
    area: f64,
    surface_area: f64,
    outline: Vec<DVec3>,
}

impl Sums {
    fn fragment(&mut self, number: u32, height: Option<f64>, shape: SieveShape) -> Fragment {
        let hull = hull(&mut self.corners);
        let [low, high] = hull.iter().fold(
            [DVec2::INFINITY, DVec2::NEG_INFINITY],
            |[low, high], [x, y]| {
                let corner = DVec2::new(f64::from(*x), f64::from(*y));
                [low.min(corner), high.max(corner)]
            },
        );
        let pixels = self.pixels.max(1) as f64;
        let known = self.on_surface as f64 / pixels;
        let world = (known >= LEAST_ON_SURFACE && self.area > 0.0).then(|| {
            let met = self.on_surface as f64;
            let scale = (met / self.area).sqrt();
            // What is off the surface is as the rest.
            let (area, surface_area) = (self.area / known, self.surface_area / known);
            let diameter = circle_diameter(area);
            let widths = widths(&hull).map(|width| width / scale);
            let rectangle = rectangle(&hull).map(|side| side / scale);
            Measures {
                place: self.points / met,
                scale,
                area,
                surface_area,
                diameter,
                rectangle,
                widths,
                // Of a few pixels it would be wider than they are.
                inscribed: (2.0 * self.deepest / scale).min(widths[0]),
                roundness: (diameter / widths[1]).powi(2),
                height,
                sieve_size: shape.sieve_size(diameter, widths[0], rectangle),
            }
        });
        Fragment {
            number,
            pixels: self.pixels,
            middle: self.places / pixels,
            is_cut: self.is_cut,
            is_at_edge: self.is_at_edge,
            extent: (high - low).max(DVec2::ZERO),
            world,
        }
    }
}

/// A plane through an outline.
struct Plane {
    middle: DVec3,
    normal: DVec3,
}

impl Plane {
    /// By least squares along `towards`, about which its normal lies; `None` of fewer than three points.
    fn through(points: &[DVec3], towards: DVec3) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let (u, v) = towards.any_orthonormal_pair();
        let (mut uu, mut uv, mut vv, mut uh, mut vh) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for point in points {
            let off = *point - middle;
            let (a, b, h) = (off.dot(u), off.dot(v), off.dot(towards));
            uu += a * a;
            uv += a * b;
            vv += b * b;
            uh += a * h;
            vh += b * h;
        }
        let determinant = uu * vv - uv * uv;
        // All on a line.
        if determinant <= 1e-9 * (uu + vv).powi(2) {
            return None;
        }
        let (a, b) = (
            (uh * vv - vh * uv) / determinant,
            (vh * uu - uh * uv) / determinant,
        );
        let normal = (towards - u * a - v * b).normalize();
        Some(Self { middle, normal })
    }

    fn above(&self, point: DVec3) -> f64 {
        (point - self.middle).dot(self.normal)
    }
}

#[cfg(test)]
mod tests;
