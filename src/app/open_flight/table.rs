//! Which photos the table shows, and in which order.

use std::cmp::Ordering;

use crate::flight::{Judged, Outcome, Photo, Verdict, compare_names};
use crate::scale::{PhotoScale, ViewFacts};

/// What the table can be sorted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Column {
    /// The order of the flight.
    Flight,
    /// Whether the photo is chosen for export.
    Export,
    /// The photo's name, numbers in it by value.
    Name,
    /// The scale at the top edge.
    Top,
    /// The scale at the bottom edge.
    Bottom,
    /// Height above the surface.
    Height,
    /// Tilt of the optical axis.
    Tilt,
    /// How many corners are on the surface.
    Corners,
    /// The verdict, best first.
    Verdict,
}

/// How the table is sorted and filtered.
#[derive(Debug, Clone, PartialEq)]
pub struct TableOrder {
    /// Sorted by.
    pub by: Column,
    /// Largest first.
    pub descending: bool,
    /// Only photos whose name or doubts hold this text, in whatever case.
    pub text: String,
    /// Only photos with this verdict.
    pub verdict: Option<Verdict>,
}

impl Default for TableOrder {
    fn default() -> Self {
        Self {
            by: Column::Flight,
            descending: false,
            text: String::new(),
            verdict: None,
        }
    }
}

/// What the table knows of one photo.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    /// The photo.
    pub photo: &'a Photo,
    /// Its scale.
    pub outcome: &'a Outcome,
    /// How it looks at the surface, once that is known.
    pub view: Option<&'a ViewFacts>,
    /// Its verdict.
    pub judged: &'a Judged,
    /// Its verdict once everything was looked at.
    pub verdict: Option<Verdict>,
    /// Whether it is chosen for export.
    pub chosen: bool,
}

impl Row<'_> {
    /// The scale at the top edge, pixels per world unit.
    pub fn top(&self) -> Option<f64> {
        self.outcome.scale()?.scale.top
    }

    /// The scale at the bottom edge, pixels per world unit.
    pub fn bottom(&self) -> Option<f64> {
        self.outcome.scale()?.scale.bottom
    }

    /// How many corners are on the surface.
    pub fn corners(&self) -> Option<usize> {
        self.outcome.scale().map(PhotoScale::corners_on_surface)
    }

    fn height(&self) -> Option<f64> {
        self.view.and_then(|view| view.height)
    }
}

impl TableOrder {
    /// The places of the rows to show, in order. Equal rows keep the flight's order; a value that is
    /// missing comes last whichever way it is sorted.
    pub fn shown(&self, rows: &[Row<'_>]) -> Vec<usize> {
        let wanted = self.text.trim().to_lowercase();
        let mut shown: Vec<usize> = (0..rows.len())
            .filter(|&place| {
                let row = &rows[place];
                self.verdict.is_none_or(|v| Some(v) == row.verdict)
                    && (wanted.is_empty()
                        || row.photo.name.to_lowercase().contains(&wanted)
                        || row
                            .judged
                            .doubts
                            .iter()
                            .any(|doubt| doubt.to_string().to_lowercase().contains(&wanted)))
            })
            .collect();
        shown.sort_by(|&a, &b| self.compare(&rows[a], &rows[b]));
        if self.by == Column::Flight && self.descending {
            shown.reverse();
        }
        shown
    }

    fn compare(&self, a: &Row<'_>, b: &Row<'_>) -> Ordering {
        let turn = |order: Ordering| {
            if self.descending {
                order.reverse()
            } else {
                order
            }
        };
        let number = |of: fn(&Row<'_>) -> Option<f64>| match (of(a), of(b)) {
            (Some(a), Some(b)) => turn(a.total_cmp(&b)),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (None, None) => Ordering::Equal,
        };
        match self.by {
            Column::Flight => Ordering::Equal,
            Column::Export => turn(b.chosen.cmp(&a.chosen)),
            Column::Name => turn(compare_names(&a.photo.name, &b.photo.name)),
            Column::Top => number(|row| row.top()),
            Column::Bottom => number(|row| row.bottom()),
            Column::Height => number(|row| row.height()),
            Column::Tilt => number(|row| row.view.map(|view| view.tilt)),
            Column::Corners => number(|row| row.corners().map(|count| count as f64)),
            Column::Verdict => turn(a.judged.verdict.cmp(&b.judged.verdict)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Pose;
    use crate::flight::Doubt;
    use glam::DVec3;

    fn rows_of(names: &[&str]) -> Vec<(Photo, Outcome, Judged)> {
        names
            .iter()
            .map(|name| {
                let trouble = format!("trouble of {name}");
                let photo = Photo {
                    name: (*name).to_owned(),
                    camera: 0,
                    pose: Pose::from_tilt_pan(DVec3::Z, [90.0, 0.0]),
                    trouble: None,
                };
                let judged = Judged {
                    verdict: Verdict::NoScale,
                    doubts: vec![Doubt::NoScale(trouble.clone())],
                };
                (photo, Outcome::Trouble(trouble), judged)
            })
            .collect()
    }

    fn shown(names: &[&str], order: &TableOrder) -> Vec<usize> {
        let owned = rows_of(names);
        let rows: Vec<Row<'_>> = owned
            .iter()
            .map(|(photo, outcome, judged)| Row {
                photo,
                outcome,
                view: None,
                judged,
                verdict: Some(judged.verdict),
                chosen: false,
            })
            .collect();
        order.shown(&rows)
    }

    #[test]
    fn names_sort_by_the_numbers_in_them() {
        let order = TableOrder {
            by: Column::Name,
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
                by: Column::Top,
                descending,
                ..TableOrder::default()
            };
            assert_eq!(shown(&["b", "a", "c"], &order), [0, 1, 2]);
        }
    }
}
