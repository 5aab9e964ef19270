//! Which photos the table shows, in which order, and with how many decimals.

use crate::exports::{ColumnKind, ColumnValue, PHOTO_COLUMNS, PhotoColumn, PhotoLine};
use crate::flight::{Along, DecisionKind, PhotoReview, Review, Verdict};
use crate::numbers::{as_its_interval_allows, is_width};

/// What the table can be sorted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SortBy {
    /// The order of the flight.
    Flight,
    /// Whether the photo is chosen for export.
    Export,
    /// A column of photos.
    Column(&'static PhotoColumn),
}

/// How the table is sorted and filtered.
#[derive(Debug, Clone, PartialEq)]
pub struct TableOrder {
    /// Sorted by.
    pub by: SortBy,
    /// Largest first.
    pub descending: bool,
    /// Only photos whose name or doubts hold this text, in whatever case.
    pub text: String,
    /// Only photos with this verdict.
    pub verdict: Option<Verdict>,
    /// Only photos that something speaks against.
    pub doubtful: bool,
}

impl Default for TableOrder {
    fn default() -> Self {
        Self {
            by: SortBy::Flight,
            descending: false,
            text: String::new(),
            verdict: None,
            doubtful: false,
        }
    }
}

/// The table of photos.
#[derive(Debug, Default)]
pub struct PhotosTable {
    /// How it is sorted and filtered.
    pub order: TableOrder,
    /// The rows that follow from it.
    pub shown: Vec<usize>,
    /// The photos that something speaks against, in the flight's order.
    pub doubtful: Vec<usize>,
    /// How many photos are what.
    pub counts: Counts,
    /// What the numbers of the columns are like.
    pub typical: Vec<Typical>,
    /// The photo that the mouse is over.
    pub hovered: Option<usize>,
}

/// How many photos are what, of the review as it was when the table was arranged, which is whenever it changes: no frame counts
/// the photos.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Counts {
    verdicts: Vec<(Verdict, usize)>,
    /// Those that go along into an export.
    pub chosen: usize,
    /// Those that wait for a decision.
    pub waiting: usize,
    /// Those that she has accepted for the reasons of now. Where nothing speaks against one any more its verdict is "trust".
    pub accepted: usize,
    /// How many of these are such.
    pub accepted_and_trusted: usize,
}

impl Counts {
    pub(crate) fn new(review: &Review) -> Self {
        let of = |is: &dyn Fn(&PhotoReview<'_>) -> bool| review.photos().filter(|p| is(p)).count();
        let is_accepted = |photo: &PhotoReview<'_>| {
            photo.decision.is_some_and(|decision| {
                decision.kind == DecisionKind::Accepted && decision.covers(photo.doubts)
            })
        };
        Self {
            verdicts: Verdict::ALL
                .into_iter()
                .map(|verdict| (verdict, review.count_of(verdict)))
                .collect(),
            chosen: of(&|photo| photo.goes_along(Along::Trusted)),
            waiting: of(&|photo| photo.waits_for_decision()),
            accepted: of(&is_accepted),
            accepted_and_trusted: of(&|photo| {
                is_accepted(photo) && photo.settled() == Some(Verdict::Trust)
            }),
        }
    }

    /// Those with this verdict; see [`PhotoReview::settled`].
    pub fn of(&self, verdict: Verdict) -> usize {
        let mut verdicts = self.verdicts.iter();
        let found = verdicts.find(|(other, _)| *other == verdict);
        found.map_or(0, |(_, count)| *count)
    }
}

/// What the numbers of a column are like: all of them have the same decimals, as a column is read from above. Of the review as it
/// was when the table was arranged, as [`Counts`] are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Typical {
    column: &'static PhotoColumn,
    /// The lower median: pixels per world unit of scales, else world units.
    value: f64,
    /// The lower median of half their intervals; `None` where nobody knows any.
    half: Option<f64>,
}

impl Typical {
    /// Of the columns whose numbers have so many digits as they are sure.
    pub(crate) fn of_columns(rows: &[Row<'_>]) -> Vec<Self> {
        let is_one = |column: &&PhotoColumn| {
            let is_rounded = matches!(column.kind, ColumnKind::Scale | ColumnKind::Length);
            column.width.is_some() && is_rounded
        };
        let columns = PHOTO_COLUMNS.iter().filter(is_one);
        columns
            .filter_map(|column| Self::of(column, rows))
            .collect()
    }

    fn of(column: &'static PhotoColumn, rows: &[Row<'_>]) -> Option<Self> {
        let value = lower_median(rows.iter().filter_map(|row| number(column, &row.line)))?;
        let halves = rows.iter().filter_map(|row| half(column, &row.line));
        let half = lower_median(halves.filter(|half| is_width(half / value.abs() * 100.0)));
        Some(Self {
            column,
            value,
            half,
        })
    }

    /// A number of the column with its decimals, `factor` times as large as in the world's unit; `None` where too little would be
    /// left of it: of a photo from ten times as far.
    fn text(&self, number: f64, factor: f64) -> Option<String> {
        let value = self.value.abs() * factor;
        if number.abs() * 10.0 < value {
            return None;
        }
        // Without an interval down to the fourth digit, but none before the point is rounded away.
        let fourth_digit = || 5.0 * 10_f64.powf((value.log10().floor() - 3.0).min(0.0));
        let half = self.half.map_or_else(fourth_digit, |half| half * factor);
        Some(as_its_interval_allows(number, number - half, number + half))
    }
}

/// The number that a column holds of a photo.
fn number(column: &PhotoColumn, line: &PhotoLine<'_>) -> Option<f64> {
    match (column.value)(line) {
        ColumnValue::Number(number) => number.filter(|number| number.is_finite()),
        _ => None,
    }
}

/// Half the interval of a scale.
fn half(column: &PhotoColumn, line: &PhotoLine<'_>) -> Option<f64> {
    let ends = column.interval_of(line)?;
    let half = (ends.high - ends.low) / 2.0;
    half.is_finite().then_some(half)
}

/// The number in the middle, which is one of them; of two in the middle the smaller one, which asks for more decimals.
fn lower_median(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let mut all: Vec<f64> = numbers.collect();
    all.sort_by(f64::total_cmp);
    let last = all.len().checked_sub(1)?;
    all.get(last / 2).copied()
}

impl PhotosTable {
    /// What the list says of a photo in a column of numbers; all digits are in [`PhotoColumn::table_value`].
    pub fn number(&self, column: &PhotoColumn, line: &PhotoLine<'_>) -> String {
        let mut typical = self.typical.iter();
        let typical = typical.find(|typical| typical.column == column);
        let factor = match column.kind {
            ColumnKind::Scale => line.unit.in_units_of(line.photo.unit),
            _ => 1.0,
        };
        let text = || typical?.text(number(column, line)?, factor);
        text().unwrap_or_else(|| column.short_value(line))
    }
}

/// What the table knows of one photo.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    /// The photo with everything that is known of it.
    pub line: PhotoLine<'a>,
}

impl Row<'_> {
    /// Whether it goes along into an export.
    pub fn goes_along(&self) -> bool {
        self.line.photo.goes_along(Along::Trusted)
    }
}

impl TableOrder {
    /// The places of the rows to show, in order. Equal rows keep the flight's order; a value that is
    /// missing comes last whichever way it is sorted.
    pub fn shown(&self, rows: &[Row<'_>]) -> Vec<usize> {
        let wanted = self.text.trim().to_lowercase();
        let mut shown: Vec<usize> = (0..rows.len())
            .filter(|&place| {
                let row = &rows[place].line.photo;
                let doubts = || {
                    row.doubts
                        .iter()
                        .map(|doubt| doubt.to_string().to_lowercase())
                };
                self.verdict.is_none_or(|v| Some(v) == row.settled())
                    && (!self.doubtful || row.is_doubtful())
                    && (wanted.is_empty()
                        || row.name().to_lowercase().contains(&wanted)
                        || doubts().any(|doubt| doubt.contains(&wanted)))
            })
            .collect();
        match self.by {
            SortBy::Flight if self.descending => shown.reverse(),
            SortBy::Flight => {}
            SortBy::Export => shown.sort_by(|&a, &b| {
                let order = rows[b].goes_along().cmp(&rows[a].goes_along());
                if self.descending {
                    order.reverse()
                } else {
                    order
                }
            }),
            SortBy::Column(column) => {
                let values: Vec<ColumnValue<'_>> =
                    rows.iter().map(|row| (column.value)(&row.line)).collect();
                shown.sort_by(|&a, &b| values[a].compare(&values[b], self.descending));
            }
        }
        shown
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;

    use super::*;
    use crate::camera::{Camera, Distortion, Pose};
    use crate::flight::{Flight, FlightParts, Limits, LookedUp, Outcome, Photo};
    use crate::scale::{Ground, ImageKind};
    use crate::surface::{Cloud, Surface};
    use crate::units::LengthUnit;

    /// A review of photos that have no scale, each for its own reason.
    fn review_of(names: &[&str]) -> Review {
        let photo = |name: &&str| Photo {
            name: (*name).to_owned(),
            camera: 0,
            pose: Pose::from_tilt_pan(DVec3::Z, [90.0, 0.0]),
            errors: Default::default(),
            package_errors: Default::default(),
            trouble: Some(format!("trouble of {name}")),
        };
        let camera = Camera {
            name: String::new(),
            width: 100,
            height: 100,
            fx: 100.0,
            fy: 100.0,
            cx: 50.0,
            cy: 50.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let cloud = Cloud {
            points: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            ..Cloud::default()
        };
        let photos: Vec<Photo> = names.iter().map(photo).collect();
        let troubles = photos.iter().filter_map(|photo| photo.trouble.clone());
        let outcomes = troubles.map(Outcome::Trouble).collect();
        let flight = Flight::new(FlightParts {
            name: String::new(),
            unit: LengthUnit::Metre,
            unit_known: true,
            ground: Ground::Auto,
            image: ImageKind::Undistorted,
            pair: Default::default(),
            errors: Default::default(),
            package_errors: Default::default(),
            surface: Arc::new(Surface::new(cloud).unwrap()),
            cameras: vec![camera],
            as_read: Default::default(),
            photos,
        });
        let flight = Arc::new(flight.unwrap());
        Review::new(flight, outcomes, LookedUp::default(), &Limits::default())
    }

    fn shown(names: &[&str], order: &TableOrder) -> Vec<usize> {
        let review = review_of(names);
        let photos = review.photos().enumerate();
        let rows: Vec<Row<'_>> = photos
            .map(|(index, photo)| Row {
                line: PhotoLine::of(photo, index),
            })
            .collect();
        order.shown(&rows)
    }

    fn by(name: &str) -> SortBy {
        let column = PHOTO_COLUMNS.iter().find(|column| column.name == name);
        SortBy::Column(column.expect("a column"))
    }

    /// By hand: the decimals of one number, whatever unit and value.
    #[test]
    fn numbers_of_a_column_have_the_same_decimals() {
        let column = PHOTO_COLUMNS
            .iter()
            .find(|column| column.name == "Fitted top")
            .expect("a column");
        let typical = |half| Typical {
            column,
            value: 2000.0,
            half,
        };
        for (half, factor, texts) in [
            // 0.4 px/cm of 20 allow one decimal, 1.0 px/in of 51 as well.
            (
                Some(40.0),
                0.01,
                [Some("19.9"), Some("48.3"), Some("2.1"), None],
            ),
            (Some(40.0), 0.0254, [Some("19.9"), Some("48.3"), None, None]),
            // Nothing is known: four digits of a usual one.
            (
                None,
                0.01,
                [Some("19.91"), Some("48.33"), Some("2.10"), None],
            ),
            (None, 1.0, [None, None, None, None]),
        ] {
            let numbers = [19.9132, 48.328, 2.1, 1.9];
            let said = numbers.map(|number| typical(half).text(number, factor));
            assert_eq!(said.each_ref().map(Option::as_deref), texts, "{half:?}");
        }
        let whole = typical(None).text(12_345.6, 1.0);
        assert_eq!(whole.as_deref(), Some("12346"));
        assert_eq!(
            lower_median([3.0, 1.0, 2.0, 4.0].into_iter()),
            Some(2.0),
            "the smaller of two"
        );
        assert_eq!(lower_median(std::iter::empty()), None);
    }

    #[test]
    fn names_sort_by_the_numbers_in_them() {
        let order = TableOrder {
            by: by("Photo"),
            ..TableOrder::default()
        };
        assert_eq!(shown(&["b", "img_10", "IMG_9", "a"], &order), [3, 0, 2, 1]);
        // Leading zeros do not count, more digits than a number holds do.
        let names = [
            "n2",
            "n01",
            "n",
            "n100000000000000000000",
            "n99999999999999999999",
        ];
        assert_eq!(shown(&names, &order), [2, 1, 0, 4, 3]);
    }

    #[test]
    fn text_filters_names_and_doubts_in_any_case() {
        let mut order = TableOrder {
            text: "TROUBLE OF B".to_owned(),
            ..TableOrder::default()
        };
        assert_eq!(shown(&["a", "b"], &order), [1]);
        order.text = "a".to_owned();
        order.verdict = Some(Verdict::Trust);
        assert!(shown(&["a", "b"], &order).is_empty());
    }

    #[test]
    fn missing_values_keep_the_order_of_the_flight() {
        for descending in [false, true] {
            let order = TableOrder {
                by: by("Top"),
                descending,
                ..TableOrder::default()
            };
            assert_eq!(shown(&["b", "a", "c"], &order), [0, 1, 2]);
        }
    }
}
