//! The pixels of a rectified picture: where each lies on the plane.

use glam::{DMat2, DVec2, DVec3};

use super::plane::PlaneFrame;
use crate::camera::Camera;
use crate::fault::Fault;
use crate::numbers::round_near;
use crate::scale::ScaleField;

/// The most pixels of a picture.
pub(super) const MOST_PIXELS: u64 = 200_000_000;

/// Rays along each side of the image whose meetings with the plane the picture holds.
const OUTLINE: u32 = 64;

/// How far beyond the foot of what is seen a picture reaches, in its size: rays near the horizon meet
/// the plane far away.
const FARTHEST: f64 = 0.5;

/// A picture of a plane: square pixels of one size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneRaster {
    /// The plane.
    pub frame: PlaneFrame,
    /// The outer corner of its top left pixel on the plane, world units.
    pub corner: DVec2,
    /// The side of a pixel, world units.
    pub pixel: f64,
    /// Pixels to the right.
    pub columns: u32,
    /// Pixels down.
    pub rows: u32,
}

impl PlaneRaster {
    /// Pixels of this size over a box of the plane, from a whole number of them.
    ///
    /// # Errors
    /// Where they are more than 200 million.
    pub(super) fn over(
        frame: PlaneFrame,
        [min, max]: [DVec2; 2],
        pixel: f64,
    ) -> Result<Self, Fault> {
        let (first, last) = ((min / pixel).floor(), (max / pixel).ceil());
        let size = (last - first).max(DVec2::ONE);
        // NaN is no size.
        let pixels = size.x * size.y;
        if pixels.is_nan() || pixels > MOST_PIXELS as f64 {
            return Err(Fault::new(
                format!(
                    "the picture would have {:.0} x {:.0} pixels, more than {} million",
                    size.x,
                    size.y,
                    MOST_PIXELS / 1_000_000
                ),
                "give larger pixels (rectify --pixel), or a photo that does not look at the horizon",
            ));
        }
        Ok(Self {
            frame,
            corner: first * pixel,
            pixel,
            // At most MOST_PIXELS.
            columns: size.x as u32,
            rows: size.y as u32,
        })
    }

    /// A place on the picture (pixels, (0, 0) at the outer corner of the first) on the plane.
    pub fn plane_from_picture(&self, place: DVec2) -> DVec2 {
        self.corner + place * self.pixel
    }

    /// The same in the world.
    pub fn world_from_picture(&self, place: DVec2) -> DVec3 {
        self.frame.world_from_plane(self.plane_from_picture(place))
    }
}

/// The box on the plane that holds what the photo's rays that meet the surface meet of it. Rays that meet
/// it farther outside of what they show than half of its size do not count; the second value says whether
/// there were such.
pub(super) fn extent(frame: &PlaneFrame, field: &ScaleField) -> Option<([DVec2; 2], bool)> {
    let (camera, pose, grid) = (field.camera(), field.pose(), field.grid);
    let feet = field.points();
    let feet = around(feet.iter().map(|point| frame.plane_from_world(*point)))?;
    let room = (feet[1] - feet[0]) * FARTHEST;
    let allowed = [feet[0] - room, feet[1] + room];
    let all = grid.cells();
    let seen = all.filter_map(|(column, row)| {
        field.depth_at(column, row)?;
        frame.meet(pose, field.direction_at(column, row)?)
    });
    let side = (0..OUTLINE).map(|place| f64::from(place) / f64::from(OUTLINE));
    let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let outline = (0..4).flat_map(|i| {
        let (from, to) = (corners[i], corners[(i + 1) % 4]);
        side.clone().map(move |share| from.lerp(to, share))
    });
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let outline = outline.filter_map(|share| {
        let direction = camera.direction_as_shot(share * size).ok()?;
        frame.meet(pose, direction)
    });
    let inside = |place: &DVec2| place.cmpge(allowed[0]).all() && place.cmple(allowed[1]).all();
    let mut cut = false;
    let seen = seen.filter(|place| {
        cut |= !inside(place);
        inside(place)
    });
    let seen: Vec<DVec2> = seen.collect();
    let found = around(seen.into_iter().chain(outline.filter(inside)))?;
    Some((found, cut))
}

pub(super) fn around(places: impl Iterator<Item = DVec2>) -> Option<[DVec2; 2]> {
    places.fold(None, |found: Option<[DVec2; 2]>, place| {
        let [min, max] = found.unwrap_or([place; 2]);
        Some([min.min(place), max.max(place)])
    })
}

/// The finest that the photo shows at a world point: how many world units of the plane one of its pixels
/// covers in the direction in which it covers least.
pub(super) fn finest_sampling(frame: &PlaneFrame, field: &ScaleField, at: DVec2) -> Option<f64> {
    let (camera, pose) = (field.camera(), field.pose());
    let shown = |place: DVec2| {
        shown_at(
            camera,
            pose.camera_from_world(frame.world_from_plane(place)),
        )
    };
    let step = 1e-4 * (frame.world_from_plane(at) - pose.center).length();
    let along = |axis: DVec2| {
        let off = axis * step;
        Some((shown(at + off)? - shown(at - off)?) / (2.0 * step))
    };
    let pixels = DMat2::from_cols(along(DVec2::X)?, along(DVec2::Y)?);
    // The larger singular value.
    let squares = pixels.transpose() * pixels;
    let (half_trace, det) = (
        (squares.x_axis.x + squares.y_axis.y) / 2.0,
        squares.determinant(),
    );
    let largest = half_trace + (half_trace * half_trace - det).max(0.0).sqrt();
    (largest > 0.0 && largest.is_finite()).then(|| 1.0 / largest.sqrt())
}

/// The pixel of the photo as shot of a point in camera axes, where it has one.
pub(super) fn shown_at(camera: &Camera, point: DVec3) -> Option<DVec2> {
    let front = point.z > 0.0;
    camera
        .pixel_as_shot(point)
        .filter(|pixel| front && camera.contains(*pixel))
}

/// The size of a pixel: what is asked for, or the finest sampling at the photo's middle to a round number
/// of `unit` (in world units).
pub(super) fn pixel_size(
    frame: &PlaneFrame,
    field: &ScaleField,
    asked: Option<f64>,
    unit: f64,
) -> Result<f64, Fault> {
    if let Some(asked) = asked {
        return match asked > 0.0 && asked.is_finite() {
            true => Ok(asked),
            false => Err(Fault::new(
                "the pixel size is no positive length",
                "give one, as 2mm",
            )),
        };
    }
    let camera = field.camera();
    let middle = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
    let middle = camera.direction_as_shot(middle).ok();
    let middle = middle.and_then(|direction| frame.meet(field.pose(), direction));
    let mean = || {
        let points = field.points();
        let count = points.len().max(1) as f64;
        let feet = points.iter().map(|point| frame.plane_from_world(*point));
        feet.sum::<DVec2>() / count
    };
    let finest = middle.and_then(|at| finest_sampling(frame, field, at));
    finest
        .or_else(|| finest_sampling(frame, field, mean()))
        .and_then(|finest| Some(round_near(finest / unit)? * unit))
        .ok_or_else(|| {
            let what =
                "the photo's middle does not show the plane, so that no pixel size follows from it";
            Fault::new(what, "give one, as --pixel 2mm")
        })
}
