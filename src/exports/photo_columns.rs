//! The columns of photos, each once: what the window's table, the table for people, scales.csv
//! (contract, section 5) and the sheet for Split-Desktop show of a photo, in this order. To add a
//! column is to add a row here.

use std::borrow::Cow;
use std::cmp::Ordering;

use super::PhotoLine;
use crate::flight::{Verdict, compare_names};
use crate::numbers::{as_its_interval_allows, significant_digits};
use crate::scale::{self, Uncertainty};
use crate::units::LengthUnit;

/// A column of photos, known by its name.
#[derive(Debug)]
pub struct PhotoColumn {
    /// In the window.
    pub name: &'static str,
    /// What it is, in a few words: for the window.
    pub hover: &'static str,
    /// What its values are.
    pub kind: ColumnKind,
    /// Its width in the window's table, points; more where its numbers or the panel are wider. `None` where
    /// it is not shown there.
    pub width: Option<f32>,
    /// Whether it comes behind the verdict there, where in a narrow window one has to scroll to it.
    pub is_behind: bool,
    /// Its heading in the table for people, where it is one of its columns.
    pub table: Option<&'static str>,
    /// Its name in scales.csv, without the unit; where it is one of its columns.
    pub csv: Option<&'static str>,
    /// Its heading in the sheet, where a scale is typed from it.
    pub sheet: Option<&'static str>,
    /// What it holds of a photo: shown, and sorted by.
    pub value: for<'a> fn(&PhotoLine<'a>) -> ColumnValue<'a>,
}

impl PartialEq for PhotoColumn {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for PhotoColumn {}

/// What a column's values are, and so how they are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// The photo's name.
    Name,
    /// Words.
    Text,
    /// Pixels of its image.
    Pixels,
    /// Pixels per unit.
    Scale,
    /// An end of a scale's interval, pixels per unit; its name in scales.csv has no unit.
    Interval,
    /// In percent.
    Percent,
    /// A share of 1.
    Share,
    /// How many of its four corners.
    OfFour,
    /// In the world's unit.
    Length,
    /// In degrees.
    Angle,
    /// What to do with its scale.
    Verdict,
}

/// What a column holds of a photo.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnValue<'a> {
    /// Words.
    Text(Cow<'a, str>),
    /// A number, where there is one.
    Number(Option<f64>),
    /// A count, where something was computed.
    Count(Option<usize>),
    /// The verdict, and whether it is the last word.
    Verdict(Verdict, bool),
}

use ColumnKind::{Angle, Interval, Length, Name, OfFour, Percent, Pixels, Scale, Share, Text};
use ColumnValue::{Count, Number};

/// A column that is shown nowhere: what a row does not say.
const COLUMN: PhotoColumn = PhotoColumn {
    name: "",
    hover: "",
    kind: Text,
    width: None,
    is_behind: false,
    table: None,
    csv: None,
    sheet: None,
    value: |_| Count(None),
};

/// One of the intervals of a photo.
fn interval(
    line: &PhotoLine<'_>,
    of: fn(&Uncertainty) -> Option<scale::Interval>,
) -> Option<scale::Interval> {
    of(&line.uncertainty()?)
}

/// All columns, in their order.
pub static PHOTO_COLUMNS: [PhotoColumn; 30] = [
    PhotoColumn {
        name: "Photo",
        hover: "Name of the photo's file",
        kind: Name,
        width: Some(128.0),
        table: Some("photo"),
        csv: Some("photo"),
        value: |line| ColumnValue::Text(line.photo.name().into()),
        ..COLUMN
    },
    PhotoColumn {
        name: "Size",
        hover: "Width and height of the image that the scale is for, pixels",
        table: Some("size"),
        value: |line| {
            let camera = line.photo.camera;
            ColumnValue::Text(format!("{} x {}", camera.width, camera.height).into())
        },
        ..COLUMN
    },
    PhotoColumn {
        name: "Width",
        hover: "Width of the image that the scale is for, pixels",
        kind: Pixels,
        csv: Some("width_px"),
        value: |line| Number(Some(f64::from(line.photo.camera.width))),
        ..COLUMN
    },
    PhotoColumn {
        name: "Height of the image",
        hover: "Height of the image that the scale is for, pixels",
        kind: Pixels,
        csv: Some("height_px"),
        value: |line| Number(Some(f64::from(line.photo.camera.height))),
        ..COLUMN
    },
    PhotoColumn {
        name: "Top",
        hover: "Scale at the top edge, from its two corners",
        kind: Scale,
        width: Some(46.0),
        is_behind: true,
        table: Some("top"),
        csv: Some("top"),
        value: |line| Number(line.scale().top),
        ..COLUMN
    },
    PhotoColumn {
        name: "Bottom",
        hover: "Scale at the bottom edge, from its two corners",
        kind: Scale,
        width: Some(46.0),
        is_behind: true,
        table: Some("bottom"),
        csv: Some("bottom"),
        value: |line| Number(line.scale().bottom),
        ..COLUMN
    },
    PhotoColumn {
        name: "Left",
        hover: "Scale at the left edge",
        kind: Scale,
        table: Some("left"),
        csv: Some("left"),
        value: |line| Number(line.scale().left),
        ..COLUMN
    },
    PhotoColumn {
        name: "Right",
        hover: "Scale at the right edge",
        kind: Scale,
        table: Some("right"),
        csv: Some("right"),
        value: |line| Number(line.scale().right),
        ..COLUMN
    },
    PhotoColumn {
        name: "TOP",
        hover: "What goes to Split-Desktop as the scale at the top edge",
        kind: Scale,
        sheet: Some("TOP scale"),
        value: |line| Number(line.pair()[0]),
        ..COLUMN
    },
    PhotoColumn {
        name: "BOTTOM",
        hover: "What goes to Split-Desktop as the scale at the bottom edge",
        kind: Scale,
        sheet: Some("BOTTOM scale"),
        value: |line| Number(line.pair()[1]),
        ..COLUMN
    },
    PhotoColumn {
        name: "Fitted top",
        hover: "Scale at the top edge, of the best line through the scale of all pixels",
        kind: Scale,
        width: Some(46.0),
        table: Some("fitted top"),
        csv: Some("fitted_top"),
        value: |line| Number(line.fitted().map(|fitted| fitted.top)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Fitted bottom",
        hover: "Scale at the bottom edge, of the best line through the scale of all pixels",
        kind: Scale,
        width: Some(46.0),
        table: Some("fitted bottom"),
        csv: Some("fitted_bottom"),
        value: |line| Number(line.fitted().map(|fitted| fitted.bottom)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Off line %",
        hover: "How far the scale of all pixels is from the best line, root mean square",
        kind: Percent,
        width: Some(46.0),
        table: Some("off line"),
        csv: Some("off_line_rms_percent"),
        value: |line| Number(line.fitted().map(|fitted| fitted.rms_percent)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Interval %",
        hover: "How far the farther end of the 95 % interval of what goes to Split-Desktop is, of the less certain edge",
        kind: Percent,
        table: Some("95 % ±"),
        value: |line| Number(line.interval_percent()),
        ..COLUMN
    },
    PhotoColumn {
        name: "Covered",
        hover: "The share of the photo that shows the surface",
        kind: Share,
        csv: Some("covered"),
        value: |line| Number(line.fitted().map(|fitted| fitted.covered)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Top, low",
        hover: "The corners' top scale: lower end of its 95 % interval",
        kind: Interval,
        csv: Some("top_low"),
        value: |line| Number(interval(line, |u| u.top).map(|ends| ends.low)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Top, high",
        hover: "The corners' top scale: upper end of its 95 % interval",
        kind: Interval,
        csv: Some("top_high"),
        value: |line| Number(interval(line, |u| u.top).map(|ends| ends.high)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Bottom, low",
        hover: "The corners' bottom scale: lower end of its 95 % interval",
        kind: Interval,
        csv: Some("bottom_low"),
        value: |line| Number(interval(line, |u| u.bottom).map(|ends| ends.low)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Bottom, high",
        hover: "The corners' bottom scale: upper end of its 95 % interval",
        kind: Interval,
        csv: Some("bottom_high"),
        value: |line| Number(interval(line, |u| u.bottom).map(|ends| ends.high)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Fitted top, low",
        hover: "The best line's top scale: lower end of its 95 % interval",
        kind: Interval,
        csv: Some("fitted_top_low"),
        value: |line| Number(interval(line, |u| u.fitted_top).map(|ends| ends.low)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Fitted top, high",
        hover: "The best line's top scale: upper end of its 95 % interval",
        kind: Interval,
        csv: Some("fitted_top_high"),
        value: |line| Number(interval(line, |u| u.fitted_top).map(|ends| ends.high)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Fitted bottom, low",
        hover: "The best line's bottom scale: lower end of its 95 % interval",
        kind: Interval,
        csv: Some("fitted_bottom_low"),
        value: |line| Number(interval(line, |u| u.fitted_bottom).map(|ends| ends.low)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Fitted bottom, high",
        hover: "The best line's bottom scale: upper end of its 95 % interval",
        kind: Interval,
        csv: Some("fitted_bottom_high"),
        value: |line| Number(interval(line, |u| u.fitted_bottom).map(|ends| ends.high)),
        ..COLUMN
    },
    PhotoColumn {
        name: "On",
        hover: "How many of the four corners are on the surface",
        kind: OfFour,
        width: Some(28.0),
        is_behind: true,
        table: Some("corners"),
        csv: Some("corners_on_surface"),
        value: |line| Count(line.photo.corners_on_surface()),
        ..COLUMN
    },
    PhotoColumn {
        name: "Height",
        hover: "Height of the camera above the surface below it, in the world's unit",
        kind: Length,
        width: Some(54.0),
        is_behind: true,
        value: |line| Number(line.photo.view.and_then(|view| view.height)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Tilt °",
        hover: "Of the optical axis below the horizon; 90 looks straight down",
        kind: Angle,
        width: Some(40.0),
        is_behind: true,
        value: |line| Number(line.photo.view.map(|view| view.tilt)),
        ..COLUMN
    },
    PhotoColumn {
        name: "Verdict",
        hover: "Whether to trust the scale",
        kind: ColumnKind::Verdict,
        width: Some(84.0),
        table: Some("verdict"),
        csv: Some("verdict"),
        value: |line| ColumnValue::Verdict(line.photo.verdict, line.photo.settled().is_some()),
        ..COLUMN
    },
    PhotoColumn {
        name: "Reasons",
        hover: "What speaks against the scale, and what the engineer has decided",
        csv: Some("reasons"),
        value: |line| {
            let all = line.photo.reasons_and_decision();
            ColumnValue::Text(all.join("; ").into())
        },
        ..COLUMN
    },
    PhotoColumn {
        name: "Note",
        hover: "What fell back or failed",
        csv: Some("note"),
        value: |line| ColumnValue::Text(line.photo.notes().join("; ").into()),
        ..COLUMN
    },
    PhotoColumn {
        name: "Noted",
        hover: "Whether something fell back or failed",
        // The notes themselves are too long for it.
        table: Some(""),
        value: |line| {
            let see = match line.photo.notes().is_empty() {
                true => "",
                false => "see below",
            };
            ColumnValue::Text(see.into())
        },
        ..COLUMN
    },
];

impl PhotoColumn {
    /// Its heading in scales.csv, with the unit that scales are per.
    pub fn csv_heading(&self, unit: LengthUnit) -> Option<String> {
        let name = self.csv?;
        Some(match self.kind {
            Scale => format!("{name}_px_per_{unit}"),
            _ => name.to_owned(),
        })
    }

    /// Its value in scales.csv: numbers read back to the same f64, and what is missing is empty.
    pub fn csv_value(&self, line: &PhotoLine<'_>) -> String {
        match (self.value)(line) {
            ColumnValue::Text(text) => text.into_owned(),
            Number(number) => number.map_or_else(String::new, |number| number.to_string()),
            // Where nothing was computed, nothing is on the surface.
            Count(count) => count.unwrap_or(0).to_string(),
            // What nobody has looked at is not called trusted.
            ColumnValue::Verdict(_, false) => String::new(),
            ColumnValue::Verdict(verdict, true) => verdict.to_string(),
        }
    }

    /// Its value in the table for people: scales with six significant digits.
    pub fn table_value(&self, line: &PhotoLine<'_>) -> String {
        match (self.kind, (self.value)(line)) {
            (Scale, Number(scale)) => scale.map_or_else(|| "-".to_owned(), six_digits),
            (Percent, Number(percent)) => {
                percent.map_or_else(|| "-".to_owned(), |p| format!("{p:.1} %"))
            }
            (OfFour, Count(count)) => format!("{} of 4", count.unwrap_or(0)),
            _ => self.csv_value(line),
        }
    }

    /// How sure its scale is; `None` of what is no scale, and where nobody knows.
    pub fn interval_of(&self, line: &PhotoLine<'_>) -> Option<scale::Interval> {
        let of: fn(&Uncertainty) -> Option<scale::Interval> = match self.csv? {
            "top" => |u| u.top,
            "bottom" => |u| u.bottom,
            "left" => |u| u.left,
            "right" => |u| u.right,
            "fitted_top" => |u| u.fitted_top,
            "fitted_bottom" => |u| u.fitted_bottom,
            _ => return None,
        };
        interval(line, of)
    }

    /// Its value in the window's narrow table, a scale with the digits that its interval allows.
    pub fn short_value(&self, line: &PhotoLine<'_>) -> String {
        let dash = || "–".to_owned();
        match (self.kind, (self.value)(line)) {
            (_, ColumnValue::Text(text)) => text.into_owned(),
            (OfFour, Count(count)) => count.map_or_else(dash, |count| format!("{count}/4")),
            (_, Count(count)) => count.map_or_else(dash, |count| count.to_string()),
            (Percent, Number(percent)) => percent.map_or_else(dash, |p| format!("{p:.1}")),
            (Angle, Number(angle)) => angle.map_or_else(dash, |angle| format!("{angle:.1}")),
            (Pixels, Number(pixels)) => pixels.map_or_else(dash, |pixels| pixels.to_string()),
            (_, Number(number)) => number.map_or_else(dash, |n| match self.interval_of(line) {
                Some(ends) => as_its_interval_allows(n, ends.low, ends.high),
                None => significant_digits(n, 4),
            }),
            (_, ColumnValue::Verdict(_, false)) => "…".to_owned(),
            (_, ColumnValue::Verdict(verdict, true)) => verdict.to_string(),
        }
    }
}

impl ColumnValue<'_> {
    /// The order of two values of a column: names by the numbers in them, verdicts best first. What is
    /// missing comes last, whichever way it is sorted.
    pub fn compare(&self, other: &Self, descending: bool) -> Ordering {
        let turn = |order: Ordering| match descending {
            true => order.reverse(),
            false => order,
        };
        match (self, other) {
            (Self::Text(a), Self::Text(b)) => turn(compare_names(a, b)),
            (Number(a), Number(b)) => missing_last(*a, *b, |a, b| turn(a.total_cmp(b))),
            (Count(a), Count(b)) => missing_last(*a, *b, |a, b| turn(a.cmp(b))),
            (Self::Verdict(a, _), Self::Verdict(b, _)) => turn(a.cmp(b)),
            // Of two columns: nobody asks.
            _ => Ordering::Equal,
        }
    }
}

fn missing_last<T>(a: Option<T>, b: Option<T>, compare: impl Fn(&T, &T) -> Ordering) -> Ordering {
    match (a, b) {
        (Some(a), Some(b)) => compare(&a, &b),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => Ordering::Equal,
    }
}

/// A positive number with six significant digits.
fn six_digits(number: f64) -> String {
    let before = number.abs().log10().floor() as i32 + 1;
    if !(-3..=6).contains(&before) {
        return format!("{number:.5e}");
    }
    format!("{number:.*}", usize::try_from(6 - before).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        assert_eq!(six_digits(25.612_345_6), "25.6123");
        assert_eq!(six_digits(0.001_234_567_8), "0.00123457");
        assert_eq!(six_digits(123_456.7), "123457");
        assert_eq!(six_digits(1.0), "1.00000");
        assert_eq!(six_digits(1e9), "1.00000e9");
    }

    #[test]
    fn a_column_is_known_by_its_name() {
        for (place, column) in PHOTO_COLUMNS.iter().enumerate() {
            let first = PHOTO_COLUMNS.iter().position(|other| other == column);
            assert_eq!(first, Some(place), "{}", column.name);
        }
    }

    /// Contract, sections 5, 7 and 8.
    #[test]
    fn the_csv_has_the_columns_of_the_contract() {
        let headings = PHOTO_COLUMNS.iter();
        let headings: Vec<String> = headings
            .filter_map(|column| column.csv_heading(LengthUnit::Centimetre))
            .collect();
        assert_eq!(
            headings.join(","),
            "photo,width_px,height_px,top_px_per_cm,bottom_px_per_cm,left_px_per_cm,right_px_per_cm,fitted_top_px_per_cm,fitted_bottom_px_per_cm,off_line_rms_percent,covered,top_low,top_high,bottom_low,bottom_high,fitted_top_low,fitted_top_high,fitted_bottom_low,fitted_bottom_high,corners_on_surface,verdict,reasons,note"
        );
    }

    #[test]
    fn what_is_missing_comes_last_either_way() {
        let values = |descending: bool| {
            let mut values = [None, Some(1.0), Some(3.0), None, Some(2.0)].map(Number);
            values.sort_by(|a, b| a.compare(b, descending));
            values
        };
        let [one, two, three] = [1.0, 2.0, 3.0].map(|n| Number(Some(n)));
        let none = || Number(None);
        let expected = [one.clone(), two.clone(), three.clone(), none(), none()];
        assert_eq!(values(false), expected);
        assert_eq!(values(true), [three, two, one, none(), none()]);
        let [ten, nine] = ["img_10", "IMG_9"].map(|name| ColumnValue::Text(name.into()));
        assert_eq!(ten.compare(&nine, false), Ordering::Greater);
        assert_eq!(ten.compare(&nine, true), Ordering::Less);
    }
}
