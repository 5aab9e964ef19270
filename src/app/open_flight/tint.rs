//! The scale field of the selected photo, which tints it in the inspector.

use glam::DVec2;

use crate::camera::Camera;
use crate::scale::{FieldGrid, PixelErrors, ScaleEstimate, ScaleField};

/// Along the photo's width: fine enough for the eye, and quick on any surface.
const COLUMNS: u32 = 320;

/// The share of the photo below the first colour, and above the last: one triangle that bridges a hole may
/// not take all colours from the pile.
const BEYOND: f64 = 0.02;

/// The scale field of a photo, for the eye.
#[derive(Debug)]
pub struct PhotoTint {
    /// Which photo.
    pub photo: usize,
    /// Its scale at each place of the grid.
    pub field: ScaleField,
    /// How sure its scale is at each place; `None` where nothing is known of it.
    pub errors: Option<PixelErrors>,
    /// The scales of the first colour and the last, pixels per world unit: 2 % of the places lie below
    /// the one, 2 % above the other. `None` where no place has a scale.
    pub range: Option<[f64; 2]>,
    /// Counted, so that textures know a new one.
    pub number: u64,
}

impl PhotoTint {
    /// The grid of a photo with this camera: square cells, as far as they go into its height.
    pub fn grid(camera: &Camera) -> FieldGrid {
        let (w, h) = (u64::from(camera.width.max(1)), u64::from(camera.height));
        let rows = (2 * u64::from(COLUMNS) * h + w) / (2 * w);
        FieldGrid {
            columns: COLUMNS,
            // A scanner's line of a photo is no reason for millions of rows.
            rows: u32::try_from(rows)
                .unwrap_or(u32::MAX)
                .clamp(1, COLUMNS * 8),
        }
    }

    /// Of a field of the photo at this place.
    pub fn new(photo: usize, field: ScaleField, errors: Option<PixelErrors>, number: u64) -> Self {
        let places = field.grid.cells();
        let scales = places.filter_map(|(column, row)| field.scale_at(column, row));
        let mut scales: Vec<f64> = scales.collect();
        let range = scales.len().checked_sub(1).map(|last| {
            // `as` cuts; the product is under `last`.
            let beyond = (last as f64 * BEYOND) as usize;
            [beyond, last - beyond]
                .map(|place| *scales.select_nth_unstable_by(place, f64::total_cmp).1)
        });
        Self {
            photo,
            field,
            errors,
            range,
            number,
        }
    }

    /// The scale at a pixel of the image, that of the grid's cell that it lies in, and how sure it is:
    /// pixels per world unit. `None` beside the image, and where the pixel's ray misses the surface.
    pub fn at(&self, pixel: DVec2) -> Option<ScaleEstimate> {
        let camera = self.field.camera();
        if !camera.contains(pixel) {
            return None;
        }
        let FieldGrid { columns, rows } = self.field.grid;
        let place = |at: f64, size: u32, count: u32| {
            let place = at / f64::from(size) * f64::from(count);
            (place as u32).min(count - 1)
        };
        let column = place(pixel.x, camera.width, columns);
        let row = place(pixel.y, camera.height, rows);
        let errors = self.errors.as_ref();
        Some(ScaleEstimate {
            value: self.field.scale_at(column, row)?,
            interval: errors.and_then(|errors| errors.at(&self.field, column, row)),
        })
    }
}
