//! The surface from straight above: the height of each pixel's middle, and whether the camera sees it.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::raster::{MOST_PIXELS, PlaneRaster, around};
use crate::camera::{Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{FieldError, FieldGrid, ImageKind, ScaleField};
use crate::surface::{MapRaster, Surface};

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
        let mut heights = surface.heights_from_above(&map_raster(raster), progress)?;
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

/// A horizontal raster, as the map has it.
fn map_raster(raster: &PlaneRaster) -> MapRaster {
    MapRaster {
        corner: raster.world_from_picture(DVec2::ZERO).truncate(),
        pixel: raster.pixel,
        columns: raster.columns,
        rows: raster.rows,
    }
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
