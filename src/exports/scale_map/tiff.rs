//! The numbers of a scale map: a TIFF with one page of 32-bit floats a layer.

use std::borrow::Cow;

use glam::DVec3;
use rayon::prelude::*;

use super::description::description;
use super::{MapLayer, ScaleMap};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::ScaleField;
use crate::tiff_pages::{Page, Pixels, tiff_of};

/// The most values that a file may hold, all layers together: 2 GB of them.
const MOST_VALUES: u64 = 500_000_000;

/// The bytes of the TIFF. Coordinates are counted from a whole-numbered point near the photo's middle,
/// which each page of them names: so 32 bits lose nothing that a survey knows.
///
/// # Errors
/// Where it would hold more than 500 million values, no layer is asked for, or the work was cancelled.
pub fn scale_map_tiff(
    map: &ScaleMap<'_>,
    layers: &[MapLayer],
    progress: &Progress,
) -> Result<Vec<u8>, Fault> {
    let field = map.field;
    let values = field.grid.len() as u64 * layers.len() as u64;
    if values > MOST_VALUES {
        let (most, has) = (MOST_VALUES / 1_000_000, values / 1_000_000);
        return Err(Fault::new(
            format!("the map would have {has} million values, more than {most} million"),
            "ask for fewer layers, one file each",
        ));
    }
    if layers.is_empty() {
        return Err(Fault::new("no layer is asked for", "name one, as scale"));
    }
    let origin = origin(field);
    tiff_of(layers.iter().enumerate().map(|(done, &layer)| {
        progress.advance(done as u64, layers.len() as u64)?;
        Ok(Page {
            width: field.grid.columns,
            height: field.grid.rows,
            pixels: Pixels::Values(Cow::Owned(values_of(map, layer, origin))),
            description: description(map, layer, origin.to_array()),
            resolution: None,
            georeference: None,
        })
    }))
}

/// A whole-numbered point near what the middle of the photo shows, or, where it shows nothing, near the
/// camera.
fn origin(field: &ScaleField) -> DVec3 {
    let grid = field.grid;
    let middle = field.at(grid.columns / 2, grid.rows / 2);
    middle.map_or(field.pose().center, |met| met.point).round()
}

/// Row by row.
fn values_of(map: &ScaleMap<'_>, layer: MapLayer, origin: DVec3) -> Vec<f32> {
    let (field, factor) = (map.field, map.factor());
    let columns = field.grid.columns as usize;
    let mut values = vec![f32::NAN; field.grid.len()];
    let rows = values.par_chunks_mut(columns.max(1)).enumerate();
    rows.for_each(|(row, values)| {
        for (column, value) in values.iter_mut().enumerate() {
            // Both are below the grid's u32.
            let (column, row) = (column as u32, row as u32);
            let found = match layer {
                MapLayer::Scale => field.scale_at(column, row).map(|scale| scale * factor),
                MapLayer::Depth => field.depth_at(column, row),
                MapLayer::X => field.at(column, row).map(|met| met.point.x - origin.x),
                MapLayer::Y => field.at(column, row).map(|met| met.point.y - origin.y),
                MapLayer::Z => field.at(column, row).map(|met| met.point.z - origin.z),
            };
            if let Some(found) = found {
                *value = found as f32;
            }
        }
    });
    values
}
