//! The sizes of photos whose fragments were outlined: their distributions, how sure they are, and the words for both.

use std::sync::Arc;

use super::table::PhotoOfSizes;
use crate::delineation::intervals::{Doubts, SizeInterval, coarse_end_not_shown, intervals};
use crate::delineation::mass::{
    ByMass, PhotoFragments, StepTaken, Steps, WantedSteps, by_mass, steps_taken,
};
use crate::delineation::tail::Tail;
use crate::delineation::{OutlinedBy, photo};
use crate::fault::Fault;
use crate::flight::{Flight, LookedUp};
use crate::jobs::Progress;
use crate::numbers::significant_digits;
use crate::season::FoundSize;
use crate::units::LengthUnit;

/// What the last row is called.
const ALL: &str = "all photos";

/// A photo whose fragments were outlined and measured.
pub struct MeasuredPhoto<'a> {
    /// As the flight names it.
    pub photo: &'a str,
    /// What was measured.
    pub fragments: PhotoFragments,
    /// What outlined them.
    pub outlined: OutlinedBy<'a>,
    /// How far the photo's edges are spread, pixels.
    pub spread: Option<f64>,
    /// Its place in the flight.
    pub index: usize,
    /// What its files are called.
    pub stem: &'a str,
}

/// A distribution, and how sure it is.
pub(super) struct Row<'a> {
    pub(super) photo: &'a str,
    /// With the law's tail, where one is asked for.
    pub(super) by_mass: ByMass,
    pub(super) intervals: Vec<SizeInterval>,
    /// How it came about.
    pub(super) taken: Vec<StepTaken>,
    /// Its place among the photos that were measured; `None` of all together.
    pub(super) of: Option<usize>,
    /// The mean scale of the photo's fragments, pixels per unit; `None` of all together.
    scale: Option<f64>,
}

/// The distributions of photos, and of all of them together.
pub struct FragmentSizes<'a> {
    pub(super) photos: Vec<Row<'a>>,
    pub(super) all: Option<Row<'a>>,
    /// Photos without a distribution, a sentence each.
    without: Vec<String>,
}

impl<'a> FragmentSizes<'a> {
    /// Of photos of a flight that were measured.
    ///
    /// # Errors
    /// On cancel.
    pub fn of(
        measured: &'a [MeasuredPhoto<'a>],
        way: &MassWay<'_>,
        flight: &Arc<Flight>,
        looked_up: &LookedUp,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let photos = measured.iter().map(|of| of.index);
        let errors = photo::scale_errors(flight, looked_up, photos, progress)?;
        let mut sizes = Self {
            photos: Vec::new(),
            all: None,
            without: Vec::new(),
        };
        let mut every: Vec<&MeasuredPhoto<'_>> = Vec::new();
        // The surface is one: errors of the photos' scales go together, and the largest stands for all.
        let mut worst: Option<f64> = None;
        for (place, (of, error)) in measured.iter().zip(errors).enumerate() {
            let row = row(of.photo, &[of], error, way);
            match row.map(|row| Row {
                of: Some(place),
                scale: scale_of(&of.fragments),
                ..row
            }) {
                Ok(row) => {
                    sizes.photos.push(row);
                    every.push(of);
                    worst = worst.into_iter().chain(error).reduce(f64::max);
                }
                Err(fault) => {
                    let text = format!(
                        "{}: no size distribution, and it does not count in that of all photos: {fault}",
                        of.photo
                    );
                    sizes.without.push(text);
                }
            }
        }
        sizes.all = row(ALL, &every, worst, way).ok();
        Ok(sizes)
    }

    /// Why no photo has any, of the first of them.
    pub fn nothing(&self) -> Option<&String> {
        self.without.first().filter(|_| self.photos.is_empty())
    }

    /// What is to be said of them, a sentence each: photos without a distribution, and coarse ends that photos do not show.
    pub fn warnings(&self) -> Vec<String> {
        let note = |row: &Row<'_>| coarse_end_not_shown(&row.by_mass, &row.intervals);
        let noted: Vec<(&str, String)> = (self.photos.iter())
            .filter_map(|row| Some((row.photo, note(row)?)))
            .collect();
        let mut said = self.without.clone();
        // Of many photos the first stands for all.
        if let Some((photo, note)) = noted.first() {
            let others = match noted.len() - 1 {
                0 => String::new(),
                1 => " (and another photo likewise)".to_owned(),
                more => format!(" (and {more} other photos likewise)"),
            };
            said.push(format!("{photo}: {note}{others}"));
        }
        let all = self.all.as_ref().filter(|_| self.photos.len() > 1);
        said.extend(all.and_then(|all| Some(format!("{}: {}", all.photo, note(all)?))));
        said
    }

    /// The distribution of all photos together, and how sure its sizes are.
    pub fn into_all(self) -> Option<(ByMass, Vec<SizeInterval>)> {
        self.all.map(|row| (row.by_mass, row.intervals))
    }

    /// The curves of the photos.
    pub(super) fn curves(&self) -> Vec<(&str, &ByMass)> {
        self.photos
            .iter()
            .map(|row| (row.photo, &row.by_mass))
            .collect()
    }

    /// All rows, the one of all photos last.
    pub(super) fn rows(&self) -> Vec<PhotoOfSizes<'_>> {
        let rows = self.photos.iter().chain(&self.all);
        rows.map(|row| PhotoOfSizes {
            photo: row.photo,
            by_mass: &row.by_mass,
            intervals: &row.intervals,
            scale: row.scale,
        })
        .collect()
    }

    /// The sizes of all photos together, times `factor`.
    pub fn of_all(&self, factor: f64) -> Vec<FoundSize> {
        let rows = self.all.iter();
        let sizes = rows.flat_map(|row| row.intervals.iter().map(move |of| (row, of)));
        sizes
            .map(|(row, of)| FoundSize {
                percent: of.percent,
                size: row
                    .by_mass
                    .curve
                    .size_at(of.percent)
                    .map(|size| size * factor),
                low: of.low.map(|low| low * factor),
                high: of.high.map(|high| high * factor),
            })
            .collect()
    }

    /// A line of each photo, and one of all.
    pub fn words(&self, world: LengthUnit, unit: LengthUnit) -> String {
        let factor = world.in_units_of(unit);
        let symbol = unit.symbol();
        let heads = [20, 50, 80].map(|percent| format!("P{percent} {symbol}"));
        let mut table: Vec<[String; 8]> = Vec::new();
        let [p20, p50, p80] = heads;
        table.push([
            "photo".to_owned(),
            "whole".to_owned(),
            "cut".to_owned(),
            "not outlined %".to_owned(),
            p20,
            p50,
            p80,
            "nothing below".to_owned(),
        ]);
        let mut is_hidden = false;
        for row in self.rows() {
            let [p20, p50, p80] = SizeInterval::PERCENTS.map(|percent| {
                let size = row.size_in_words(percent, factor, "");
                is_hidden |= size.is_none();
                size.unwrap_or_else(|| "-".to_owned())
            });
            table.push([
                row.photo.to_owned(),
                row.by_mass.whole.to_string(),
                row.by_mass.cut.to_string(),
                format!("{:.1}", 100.0 * row.by_mass.unfound),
                p20,
                p50,
                p80,
                format!(
                    "{} {symbol}",
                    significant_digits(row.by_mass.limit * factor, 2)
                ),
            ]);
        }
        let mut text = in_columns(&table);
        if is_hidden {
            text += "-: below what the photos show; a law of the fines may say it (--tail)\n";
        }
        text
    }
}

/// Columns as wide as their widest text, the first at the left, all others at the right.
fn in_columns(table: &[[String; 8]]) -> String {
    let width = |column: usize| {
        let texts = table.iter().map(|row| row[column].chars().count());
        texts.max().unwrap_or(0)
    };
    let mut text = String::new();
    for row in table {
        text += &format!("{:<1$}", row[0], width(0));
        for (column, words) in row.iter().enumerate().skip(1) {
            text += &format!("  {words:>0$}", width(column));
        }
        text.push('\n');
    }
    text
}

/// The scale by which a photo's fragments have their area, pixels per unit.
fn scale_of(photo: &PhotoFragments) -> Option<f64> {
    let measured = photo
        .fragments
        .iter()
        .filter_map(|of| Some((of.pixels as f64, of.world?.area)));
    let [pixels, area] = measured.fold([0.0; 2], |[pixels, area], of| [pixels + of.0, area + of.1]);
    (area > 0.0).then(|| (pixels / area).sqrt())
}

/// The way from outlines to the mass.
pub struct MassWay<'a> {
    /// Its steps.
    pub steps: WantedSteps,
    /// The law of the fines.
    pub tail: Option<&'a Tail>,
}

/// The distribution of photos together.
fn row<'a>(
    name: &'a str,
    done: &[&MeasuredPhoto<'_>],
    scale: Option<f64>,
    way: &MassWay<'_>,
) -> Result<Row<'a>, Fault> {
    let doubts = done
        .iter()
        .map(|of| Doubts::of(of.outlined.habits(), scale));
    let doubts = doubts
        .reduce(Doubts::or_greater)
        .unwrap_or_else(|| Doubts::of(None, scale));
    let photos = done.iter();
    let photos = photos.map(|of| (&of.fragments, way.steps.of(of.outlined)));
    let photos: Vec<(&PhotoFragments, Steps)> = photos.collect();
    let mut by_mass = by_mass(photos.iter().copied())?;
    if let Some(tail) = way.tail {
        by_mass.curve = tail.below(&by_mass.curve)?;
    }
    Ok(Row {
        photo: name,
        by_mass,
        intervals: intervals(&photos, doubts, &SizeInterval::PERCENTS)?,
        taken: steps_taken(&photos)?,
        of: None,
        scale: None,
    })
}
