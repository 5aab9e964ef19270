//! The legend of a sheet's map.

use super::FlightSheet;
use super::signs::{DASHES, TAKE_OFF, WAY, area_line, keep_out_area, way_line};
use crate::drawing::{Anchor, Dash, Marker, Pen};
use crate::flight::Verdict;
use crate::plan::PlanInks;
use crate::plan::furniture::TEXT;
use crate::plan::inks::dash;
use crate::plan::photos::{camera_mark, middle_mark, sample};

/// What a line of the legend shows, and its words.
pub(super) struct Row {
    sign: Sign,
    words: String,
}

enum Sign {
    Footprint(Verdict),
    Camera,
    Middle,
    Refused,
    Way(Dash),
    TakeOff,
    Area,
    KeepOut,
}

/// The lines of a sheet's legend: of what its map holds.
pub(super) fn legend(sheet: &FlightSheet<'_>) -> Vec<Row> {
    let report = sheet.report;
    let plan = report.plan;
    let count = plan.photos.len();
    let troubled = (0..count).filter(|n| !plan.troubles(*n).is_empty()).count();
    let row = |sign, words: String| Row { sign, words };
    let mut rows = Vec::new();
    if troubled < count {
        let words = format!("photo as wished: {}", count - troubled);
        rows.push(row(Sign::Footprint(Verdict::Trust), words));
    }
    if troubled > 0 {
        let words = format!("photo with a trouble: {troubled}");
        rows.push(row(Sign::Footprint(Verdict::Check), words));
    }
    rows.push(row(Sign::Camera, "drone at a photo".to_owned()));
    rows.push(row(Sign::Middle, "middle of a photo".to_owned()));
    rows.push(row(Sign::Area, "area".to_owned()));
    if !plan.wish.keep_out.is_empty() {
        rows.push(row(Sign::KeepOut, "keep out, at any height".to_owned()));
    }
    if !plan.refused.is_empty() {
        let words = format!("no photo possible: {}", plan.refused.len());
        rows.push(row(Sign::Refused, words));
    }
    for (number, dash) in (1..=report.ways.len()).zip(DASHES) {
        let again = (number..=report.ways.len()).step_by(DASHES.len());
        let numbers: Vec<String> = again.map(|number| number.to_string()).collect();
        let words = match report.ways.len() {
            1 => "way of the drone".to_owned(),
            _ => {
                let name = report.way_name().to_lowercase();
                format!("way, {name} {}", numbers.join(", "))
            }
        };
        rows.push(row(Sign::Way(dash), words));
    }
    if !report.ways.is_empty() {
        rows.push(row(Sign::TakeOff, "take-off and landing".to_owned()));
    }
    rows
}

impl Row {
    /// Draws it; its left end at half its height is `at`.
    pub(super) fn draw(&self, [left, y]: [f64; 2], pen: &mut Pen) {
        let inks = &PlanInks::PAPER;
        let middle = [left + 13.0, y];
        let ends = [[left, y], [left + 26.0, y]];
        match self.sign {
            Sign::Footprint(verdict) => {
                let (from, to) = ([left, y - 5.0], [left + 26.0, y + 5.0]);
                let verdict = Some(verdict);
                sample(from, to, inks.of(verdict), dash(verdict), pen);
            }
            Sign::Camera => camera_mark(middle, inks, pen),
            Sign::Middle => middle_mark(middle, inks.of(Some(Verdict::Trust)), pen),
            Sign::Refused => middle_mark(middle, inks.of(Some(Verdict::NoScale)), pen),
            Sign::Way(dash) => way_line(&ends, dash, pen),
            Sign::TakeOff => pen.marker(middle, Marker::Diamond, TAKE_OFF, WAY),
            Sign::Area => area_line(&ends, pen),
            Sign::KeepOut => {
                let [right, top, bottom] = [left + 26.0, y - 5.0, y + 5.0];
                let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
                keep_out_area(&corners, pen);
            }
        }
        let at = [left + 34.0, y];
        pen.text(at, TEXT, &self.words, Anchor::Left, inks.ink);
    }
}
