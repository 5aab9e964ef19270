//! The surface from straight above: the height of each pixel's middle, and whether the camera sees it.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::raster::{MOST_PIXELS, PlaneRaster, around};
use crate::camera::{Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::scale::{FieldError, FieldGrid, ImageKind, ScaleField};
use crate::surface::Surface;

/// Rows of the picture that one thread works on at a time.
const BAND: u32 = 64;

/// How much farther than what is seen beside it a point may be and still be seen, in pixels' widths at its
/// distance: in a crease all that is seen beside a point is nearer.
const SLACK: f64 = 2.0;

/// How much larger, each way, than the photo the image may be in which sight is judged: beyond it a wide
/// lens sees that nothing hides nothing.
const LARGEST: f64 = 2.0;

/// Heights of pixels that a camera sees.
#[derive(Debug)]
pub(super) struct Heights {
    columns: u32,
    /// World z, row by row; NaN where there is no surface or the camera does not see it.
    heights: Vec<f64>,
}

impl Heights {
    /// Of a horizontal raster.
    pub(super) fn new(
        raster: &PlaneRaster,
        field: &ScaleField,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        progress.stage("looking at the surface from above");
        let mut heights = heights(raster, surface, progress)?;
        progress.stage("finding what the camera sees");
        let sight = Sight::new(field, surface, progress)?;
        let columns = raster.columns as usize;
        let rows = heights.par_chunks_mut(columns.max(1)).enumerate();
        rows.for_each(|(row, heights)| {
            for (column, height) in heights.iter_mut().enumerate() {
                let middle = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let point = raster.world_from_picture(middle).with_z(*height);
                if !sight.sees(point) {
                    *height = f64::NAN;
                }
            }
        });
        Ok(Self {
            columns: raster.columns,
            heights,
        })
    }

    /// The height of the pixel that a place of the picture lies in, where the camera sees it.
    pub(super) fn seen_at(&self, place: DVec2) -> Option<f64> {
        if !(place.x >= 0.0 && place.y >= 0.0 && place.x < f64::from(self.columns)) {
            return None;
        }
        let index = place.y as usize * self.columns as usize + place.x as usize;
        let height = self.heights.get(index).copied();
        height.filter(|height| !height.is_nan())
    }
}

/// The highest of the surface at each pixel's middle; NaN where there is none.
fn heights(
    raster: &PlaneRaster,
    surface: &Surface,
    progress: &Progress,
) -> Result<Vec<f64>, Fault> {
    let frame = surface.frame();
    let origin = frame.local_from_world(raster.world_from_picture(DVec2::ZERO));
    // A place of the picture, of a point of the surface's frame.
    let place = |point: DVec3| DVec2::new(point.x - origin.x, origin.y - point.y) / raster.pixel;
    let columns = raster.columns;
    let end = DVec2::new(f64::from(columns), f64::from(raster.rows));
    let misses = |bounds: &Bounds| {
        let (a, b) = (place(bounds.min), place(bounds.max));
        b.y > end.y || a.y < 0.0 || b.x < 0.0 || a.x > end.x
    };
    let patches = surface.patches().seen(misses);
    let patches =
        patches.map_err(|error| Fault::new(error.to_string(), "check the surface file"))?;
    let bands: Vec<u32> = (0..raster.rows).step_by(BAND as usize).collect();
    let bands = bands.into_par_iter().map(|first| {
        let rows = first..(first + BAND).min(raster.rows);
        let mut highest = vec![f64::NAN; columns as usize * rows.len()];
        let (top, bottom) = (f64::from(rows.start), f64::from(rows.end));
        for patch in &patches {
            let (a, b) = (place(patch.bounds.min), place(patch.bounds.max));
            if b.y > bottom || a.y < top || b.x < 0.0 || a.x > f64::from(columns) {
                continue;
            }
            if progress.is_cancelled() {
                return Err(Fault::new("cancelled", "start it again when you want it"));
            }
            for corners in patch.triangles() {
                let on_picture = corners.map(place);
                let Some([min, max]) = around(on_picture.into_iter()) else {
                    continue;
                };
                // Middles at + 0.5; `as` saturates.
                let range = |min: f64, max: f64, from: u32, to: u32| {
                    let first = ((min - 0.5).ceil() as u32).max(from);
                    first..(((max - 0.5).floor() + 1.0) as u32).min(to)
                };
                for row in range(min.y, max.y, rows.start, rows.end) {
                    for column in range(min.x, max.x, 0, columns) {
                        let middle = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                        let Some(shares) = shares(&on_picture, middle) else {
                            continue;
                        };
                        let z: f64 = (0..3).map(|i| corners[i].z * shares[i]).sum();
                        let z = z + frame.origin().z;
                        let index =
                            (row - rows.start) as usize * columns as usize + column as usize;
                        // NaN gives way.
                        highest[index] = highest[index].max(z);
                    }
                }
            }
        }
        Ok(highest)
    });
    let bands: Result<Vec<Vec<f64>>, Fault> = bands.collect();
    Ok(bands?.concat())
}

/// How much of each corner is in a place inside a triangle, edges included; `None` outside.
fn shares([a, b, c]: &[DVec2; 3], place: DVec2) -> Option<[f64; 3]> {
    let whole = (*b - *a).perp_dot(*c - *a);
    let share = |from: DVec2, to: DVec2| (to - from).perp_dot(place - from) / whole;
    let shares = [share(*b, *c), share(*c, *a), share(*a, *b)];
    // Edges belong to both sides; NaN, of a triangle that is seen edge-on, to none.
    shares.iter().all(|share| *share >= -1e-9).then_some(shares)
}

/// What the camera sees: depths in an image without a lens that shows all that the photo shows.
struct Sight {
    field: ScaleField,
    camera: Camera,
    pose: Pose,
}

impl Sight {
    fn new(of: &ScaleField, surface: &Surface, progress: &Progress) -> Result<Self, Fault> {
        let camera = without_lens(of.camera());
        let grid = FieldGrid::of_pixels(&camera);
        let kind = ImageKind::Undistorted;
        let field = ScaleField::compute(&camera, of.pose(), kind, grid, surface, progress);
        let field = field.map_err(|error| match error {
            FieldError::Cancelled => Fault::new("cancelled", "start it again when you want it"),
            FieldError::Surface(error) => Fault::new(error.to_string(), "check the surface file"),
        })?;
        Ok(Self {
            camera,
            pose: *of.pose(),
            field,
        })
    }

    /// Whether nothing lies in front of a world point. The four pixels around it are looked at, and the
    /// farthest decides: at the rim of a stone it is what lies behind.
    fn sees(&self, point: DVec3) -> bool {
        let in_camera = self.pose.camera_from_world(point);
        let Some(pixel) = self.camera.pixel_undistorted(in_camera) else {
            return false;
        };
        let first = (pixel - 0.5).floor();
        let slack = in_camera.z * SLACK / self.camera.fx.min(self.camera.fy);
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let place = first + DVec2::new(x, y);
            if !(place.x >= 0.0 && place.y >= 0.0) || place.x >= f64::from(self.camera.width) {
                continue;
            }
            match self.field.depth_at(place.x as u32, place.y as u32) {
                // The ray beside it meets nothing: so nothing hides the point there.
                None => return true,
                Some(depth) if in_camera.z <= depth + slack => return true,
                Some(_) => {}
            }
        }
        false
    }
}

/// A camera without a lens whose image holds all that the photo as shot shows, as far as it is not too
/// large.
fn without_lens(camera: &Camera) -> Camera {
    let bare = Camera {
        distortion: Distortion::None,
        ..camera.clone()
    };
    if camera.distortion == Distortion::None {
        return bare;
    }
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let shares = (0..=64).map(|place| f64::from(place) / 64.0);
    let outline = shares.flat_map(|share| {
        [(share, 0.0), (share, 1.0), (0.0, share), (1.0, share)].map(DVec2::from)
    });
    let pixels = outline.filter_map(|share| {
        let direction = camera.direction_as_shot(share * size).ok()?;
        bare.pixel_undistorted(direction)
    });
    let [min, max] = around(pixels.chain([DVec2::ZERO, size])).unwrap_or([DVec2::ZERO, size]);
    let room = size * LARGEST;
    let (min, max) = (min.max(-room).floor(), max.min(size + room).ceil());
    let whole = max - min;
    if whole.x * whole.y > MOST_PIXELS as f64 {
        return bare;
    }
    Camera {
        // At most five times u32's photos, less than MOST_PIXELS in all.
        width: whole.x as u32,
        height: whole.y as u32,
        cx: bare.cx - min.x,
        cy: bare.cy - min.y,
        ..bare
    }
}
