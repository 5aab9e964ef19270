//! How verdicts and missing numbers are shown.

use crate::flight::Verdict;
use crate::numbers::significant_digits;

/// The colour of a verdict: told apart by brightness too.
pub fn verdict_color(verdict: Verdict, visuals: &egui::Visuals) -> egui::Color32 {
    match (verdict, visuals.dark_mode) {
        (Verdict::Trust, true) => egui::Color32::from_rgb(110, 200, 130),
        (Verdict::Trust, false) => egui::Color32::from_rgb(20, 120, 50),
        (Verdict::Check, true) => egui::Color32::from_rgb(255, 190, 80),
        (Verdict::Check, false) => egui::Color32::from_rgb(160, 90, 0),
        (Verdict::NoScale, true) => egui::Color32::from_rgb(255, 110, 110),
        (Verdict::NoScale, false) => egui::Color32::from_rgb(180, 20, 30),
    }
}

/// A sign before a verdict, so that colour is not all.
pub fn verdict_sign(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Trust => "✔",
        Verdict::Check => "⚠",
        Verdict::NoScale => "✖",
    }
}

/// A number that may be missing.
pub(super) fn or_dash(value: Option<f64>, digits: u8) -> String {
    value.map_or_else(|| "–".to_owned(), |value| significant_digits(value, digits))
}
