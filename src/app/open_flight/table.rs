//! Which photos the table shows, and in which order.

use crate::exports::{ColumnValue, PhotoColumn, PhotoLine};
use crate::flight::{Along, PhotoReview, Review, Verdict};

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
}

impl Counts {
    pub(crate) fn new(review: &Review) -> Self {
        let of = |is: &dyn Fn(&PhotoReview<'_>) -> bool| review.photos().filter(|p| is(p)).count();
        Self {
            verdicts: Verdict::ALL
                .into_iter()
                .map(|verdict| (verdict, review.count_of(verdict)))
                .collect(),
            chosen: of(&|photo| photo.goes_along(Along::Trusted)),
            waiting: of(&|photo| photo.waits_for_decision()),
        }
    }

    /// Those with this verdict; see [`PhotoReview::settled`].
    pub fn of(&self, verdict: Verdict) -> usize {
        let mut verdicts = self.verdicts.iter();
        let found = verdicts.find(|(other, _)| *other == verdict);
        found.map_or(0, |(_, count)| *count)
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
    use crate::exports::PHOTO_COLUMNS;
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
