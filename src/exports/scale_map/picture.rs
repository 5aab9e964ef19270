//! The colours of a scale map, with lines at round values and a legend: for people.

use rayon::prelude::*;

use super::ScaleMap;
use crate::fault::Fault;
use crate::files::marked_png;
use crate::picture::{PhotoFormat, ValueColors, encode, value_picture};

/// The bytes of a PNG with a pixel for each of the field's.
///
/// # Errors
/// Where no pixel has a scale.
pub fn scale_map_png(map: &ScaleMap<'_>) -> Result<Vec<u8>, Fault> {
    let (grid, factor) = (map.field.grid, map.factor());
    let scale = |column, row| map.field.scale_at(column, row).map(|scale| scale * factor);
    let rows = (0..grid.rows).into_par_iter();
    let row = |row| (0..grid.columns).map(move |column| scale(column, row).unwrap_or(f64::NAN));
    let values: Vec<f64> = rows.flat_map_iter(row).collect();
    let colors = ValueColors::of(values.iter().copied()).ok_or_else(|| {
        let what = "no pixel of the photo shows the surface";
        Fault::new(
            what,
            "check its pose, and that the surface is that of this flight",
        )
    })?;
    let unit = format!("px/{}", map.unit);
    let picture = value_picture(&values, grid.columns, &colors, &unit, "no surface");
    encode(&picture, PhotoFormat::Png, 0, None, None).map(marked_png)
}
