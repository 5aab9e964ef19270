//! The sizes of photos whose fragments were outlined: their distributions, how sure they are, and the words for both.

use crate::camera::Camera;
use crate::delineation::intervals::{Doubts, SizeInterval, intervals};
use crate::delineation::mass::{ByMass, PhotoFragments, Steps, by_mass};
use crate::delineation::{Engine, least_across, photo};
use crate::exports::PhotoOfSizes;
use crate::fault::Fault;
use crate::flight::{Limits, Review};
use crate::jobs::Progress;
use crate::numbers::{significant_digits, with_interval};
use crate::opening::Opened;
use crate::units::LengthUnit;

/// What the last row is called.
const ALL: &str = "all photos";

/// What outlined a photo's fragments.
#[derive(Clone, Copy)]
pub(super) enum OutlinedBy {
    /// This one, just now.
    Engine(&'static dyn Engine),
    /// This one, and then a person in the window; `None` where it is not known any more.
    Saved(Option<&'static dyn Engine>),
    /// Another tool.
    Masks,
}

impl OutlinedBy {
    fn engine(self) -> Option<&'static dyn Engine> {
        match self {
            Self::Engine(engine) => Some(engine),
            Self::Saved(engine) => engine,
            Self::Masks => None,
        }
    }

    /// As it is named in files.
    pub(super) fn method(self) -> &'static str {
        match self {
            Self::Engine(engine) => engine.name(),
            Self::Saved(_) => "saved",
            Self::Masks => "masks",
        }
    }

    /// Nothing narrower is claimed, pixels.
    pub(super) fn least_across(self, camera: &Camera) -> f64 {
        let engine = self.engine();
        engine.map_or(0.0, |engine| {
            least_across(engine, camera.width, camera.height)
        })
    }
}

/// A photo whose fragments were outlined and measured.
pub(super) struct Done<'a> {
    /// Its place in the flight.
    pub(super) index: usize,
    /// As the flight names it.
    pub(super) photo: &'a str,
    /// What was measured.
    pub(super) fragments: PhotoFragments,
    /// What outlined them.
    pub(super) outlined: OutlinedBy,
}

/// A distribution, and how sure it is.
struct Row<'a> {
    photo: &'a str,
    by_mass: ByMass,
    intervals: Vec<SizeInterval>,
}

/// The distributions of photos, and of all of them together.
pub(super) struct Sizes<'a> {
    photos: Vec<Row<'a>>,
    all: Option<Row<'a>>,
    /// Photos without a distribution, a sentence each.
    pub(super) without: Vec<String>,
}

impl<'a> Sizes<'a> {
    /// Of photos that were measured.
    ///
    /// # Errors
    /// On cancel.
    pub(super) fn of(
        done: &'a [Done<'a>],
        opened: &Opened,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let looked_up = opened.looked_up.clone();
        let flight = opened.flight.clone();
        let mut review = Review::of_scales(flight, looked_up, &Limits::default(), progress)?;
        review.compute_fields(progress)?;
        let scale_error = |of: &Done<'_>| photo::scale_error(&review.photo(of.index)?);
        let mut sizes = Self {
            photos: Vec::new(),
            all: None,
            without: Vec::new(),
        };
        for of in done {
            match row(of.photo, &[of], scale_error(of)) {
                Ok(row) => sizes.photos.push(row),
                Err(fault) => {
                    let text = format!("{}: no size distribution: {fault}", of.photo);
                    sizes.without.push(text);
                }
            }
        }
        let every: Vec<&Done<'_>> = done.iter().collect();
        // The surface is one: errors of the photos' scales go together, and the largest stands for all.
        let worst = done
            .iter()
            .filter_map(scale_error)
            .fold(None, |most: Option<f64>, error| {
                Some(most.map_or(error, |most| most.max(error)))
            });
        sizes.all = row(ALL, &every, worst).ok();
        Ok(sizes)
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
        })
        .collect()
    }

    /// A line of each photo, and one of all.
    pub(super) fn words(&self, world: LengthUnit, unit: LengthUnit) -> String {
        let factor = world.in_units_of(unit);
        let symbol = unit.symbol();
        let heads = [20, 50, 80].map(|percent| format!("P{percent} {symbol}"));
        let mut table: Vec<[String; 8]> = Vec::new();
        let [p20, p50, p80] = heads;
        table.push([
            "photo".to_owned(),
            "fragments".to_owned(),
            "cut".to_owned(),
            "not outlined %".to_owned(),
            p20,
            p50,
            p80,
            "nothing below".to_owned(),
        ]);
        for row in self.photos.iter().chain(&self.all) {
            let size = |percent: f64| {
                let Some(size) = row.by_mass.curve.size_at(percent) else {
                    return "-".to_owned();
                };
                let interval = row.intervals.iter().find(|of| of.percent == percent);
                let ends = interval.and_then(|of| Some((of.low? * factor, of.high? * factor)));
                ends.map_or_else(
                    || significant_digits(size * factor, 2),
                    |(low, high)| with_interval(size * factor, low, high),
                )
            };
            let [p20, p50, p80] = SizeInterval::PERCENTS.map(size);
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
        in_columns(&table)
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

/// The distribution of photos together.
fn row<'a>(name: &'a str, done: &[&Done<'_>], scale: Option<f64>) -> Result<Row<'a>, Fault> {
    // What a person or another tool left without an outline is not there to be found; of several engines the mean.
    let fines = |of: &&Done<'_>| of.outlined.engine().map_or(1.0, Engine::fines_of_unfound);
    let steps = Steps {
        fines: done.iter().map(fines).sum::<f64>() / done.len().max(1) as f64,
        ..Steps::default()
    };
    let doubts = done
        .iter()
        .map(|of| Doubts::of(of.outlined.engine(), scale));
    let doubts = doubts
        .reduce(Doubts::or_greater)
        .unwrap_or_else(|| Doubts::of(None, scale));
    let photos: Vec<&PhotoFragments> = done.iter().map(|of| &of.fragments).collect();
    Ok(Row {
        photo: name,
        by_mass: by_mass(photos.iter().copied(), steps)?,
        intervals: intervals(&photos, steps, doubts, &SizeInterval::PERCENTS)?,
    })
}
