//! Fragments and their curves as CSV.

use crate::delineation::intervals::SizeInterval;
use crate::delineation::mass::ByMass;
use crate::delineation::measures::Fragment;
use crate::measured::csv_of;
use crate::numbers::significant_digits;
use crate::season::size_between;
use crate::units::LengthUnit;

/// The fragments of a photo.
#[derive(Debug, Clone, Copy)]
pub(super) struct PhotoOfFragments<'a> {
    /// As the flight names it.
    pub photo: &'a str,
    /// Of its label image.
    pub fragments: &'a [Fragment],
}

/// A line a fragment: places in pixels of the undistorted photo and in the world, lengths in `unit` and areas in
/// its square, which are empty where too little of it lies on the surface. Numbers read back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub(super) fn fragments_csv(
    photos: &[PhotoOfFragments<'_>],
    world: LengthUnit,
    unit: LengthUnit,
) -> Result<String, csv::Error> {
    let heads = heads(world, unit);
    let mut rows = vec![heads.to_vec()];
    for photo in photos {
        for fragment in photo.fragments {
            let cut = if fragment.is_cut { "yes" } else { "no" };
            let mut row = vec![
                photo.photo.to_owned(),
                fragment.number.to_string(),
                fragment.middle.x.to_string(),
                fragment.middle.y.to_string(),
                fragment.pixels.to_string(),
                cut.to_owned(),
            ];
            match numbers(fragment, world.in_units_of(unit)) {
                None => row.resize(heads.len(), String::new()),
                Some(numbers) => row.extend(numbers.map(|number| match number.is_nan() {
                    true => String::new(),
                    false => number.to_string(),
                })),
            }
            rows.push(row);
        }
    }
    csv_of(rows)
}

/// What is said of a fragment: its photo and pixels, then [`numbers`].
pub(super) fn heads(world: LengthUnit, unit: LengthUnit) -> [String; 21] {
    let (u, w) = (unit.symbol(), world.symbol());
    [
        "photo".to_owned(),
        "fragment".to_owned(),
        "column_px".to_owned(),
        "row_px".to_owned(),
        "pixels".to_owned(),
        "cut".to_owned(),
        format!("x_{w}"),
        format!("y_{w}"),
        format!("z_{w}"),
        format!("scale_px_per_{u}"),
        format!("area_{u}2"),
        format!("surface_area_{u}2"),
        format!("diameter_{u}"),
        format!("length_{u}"),
        format!("breadth_{u}"),
        format!("feret_max_{u}"),
        format!("feret_min_{u}"),
        format!("inscribed_{u}"),
        "roundness".to_owned(),
        format!("height_{u}"),
        format!("sieve_size_{u}"),
    ]
}

/// The last 15 of [`heads`], NaN where one is not known; `None` where too little of it lies on the surface. `factor`: units in
/// one of the world.
pub(super) fn numbers(fragment: &Fragment, factor: f64) -> Option<[f64; 15]> {
    let world = fragment.world?;
    Some([
        world.place.x,
        world.place.y,
        world.place.z,
        world.scale / factor,
        world.area * factor * factor,
        world.surface_area * factor * factor,
        world.diameter * factor,
        world.rectangle[0] * factor,
        world.rectangle[1] * factor,
        world.widths[1] * factor,
        world.widths[0] * factor,
        world.inscribed * factor,
        world.roundness,
        world.height.map_or(f64::NAN, |height| height * factor),
        world.sieve_size * factor,
    ])
}

/// Curves in the form that `fragscale psd` and the window's size distributions read: one of each photo, named, and
/// its area.
///
/// # Errors
/// Where memory runs out.
pub fn curves_csv(
    method: &str,
    curves: &[(&str, &ByMass)],
    world: LengthUnit,
    unit: LengthUnit,
) -> Result<String, csv::Error> {
    let factor = world.in_units_of(unit);
    let size = format!("size_{}", unit.symbol());
    // Files of two units may be joined by it.
    let area = format!("area_{}2", unit.symbol());
    let heads = ["method", "photo", &size, "percent_passing", &area];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for (photo, curve) in curves {
        for [size, percent] in curve.curve.points() {
            let numbers = [size * factor, *percent, curve.area * factor * factor];
            let mut row = vec![method.to_owned(), (*photo).to_owned()];
            row.extend(numbers.map(|number| number.to_string()));
            rows.push(row);
        }
    }
    csv_of(rows)
}

/// A photo's sizes with their intervals, or those of all photos together.
#[derive(Debug, Clone, Copy)]
pub struct PhotoOfSizes<'a> {
    /// As the flight names it, or "all photos".
    pub photo: &'a str,
    /// Its distribution.
    pub by_mass: &'a ByMass,
    /// How sure its sizes are.
    pub intervals: &'a [SizeInterval],
    /// The mean scale of the photo, pixels per unit of the world; `None` of several photos.
    pub scale: Option<f64>,
}

impl PhotoOfSizes<'_> {
    /// The size that this percent passes, `factor` times, with its interval as far as it is known and `unit` behind them (" cm",
    /// or nothing); `None` below what the photo shows.
    pub fn size_in_words(&self, percent: f64, factor: f64, unit: &str) -> Option<String> {
        let size = factor * self.by_mass.curve.size_at(percent)?;
        let interval = self.intervals.iter().find(|of| of.percent == percent);
        let ends = interval.map_or([None; 2], |of| {
            [of.low, of.high].map(|end| Some(end? * factor))
        });
        // Nothing else is said below the limit.
        let is_law = size < factor * self.by_mass.limit;
        Some(match is_law {
            true => format!("{}{unit} by the law", significant_digits(size, 2)),
            false => size_between(size, ends, unit),
        })
    }
}

/// A line a percent: the size that it passes, its 95 % interval, and the size below which the photo shows nothing. Without a law's
/// tail a size below that is empty; an end of an interval below it always.
///
/// # Errors
/// Where memory runs out.
pub(super) fn sizes_csv(
    photos: &[PhotoOfSizes<'_>],
    world: LengthUnit,
    unit: LengthUnit,
) -> Result<String, csv::Error> {
    let (u, factor) = (unit.symbol(), world.in_units_of(unit));
    let heads = [
        "photo".to_owned(),
        "percent_passing".to_owned(),
        format!("size_{u}"),
        format!("low_{u}"),
        format!("high_{u}"),
        format!("limit_{u}"),
    ];
    let mut rows = vec![heads.to_vec()];
    for of in photos {
        for interval in of.intervals {
            let size = of.by_mass.curve.size_at(interval.percent);
            let sizes = [size, interval.low, interval.high];
            let mut row = vec![of.photo.to_owned(), interval.percent.to_string()];
            row.extend(
                sizes.map(|size| size.map_or_else(String::new, |size| (size * factor).to_string())),
            );
            row.push((of.by_mass.limit * factor).to_string());
            rows.push(row);
        }
    }
    csv_of(rows)
}
