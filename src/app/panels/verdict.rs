//! How verdicts and missing numbers are shown.

use crate::flight::Verdict;
use crate::numbers::significant_digits;
use crate::state::State;
use crate::tasks::photos::STILL_COMPARING;

/// The colour of a verdict: told apart by brightness too.
pub fn verdict_color(verdict: Verdict, visuals: &egui::Visuals) -> egui::Color32 {
    match (verdict, visuals.dark_mode) {
        (Verdict::Trust, true) => egui::Color32::from_rgb(110, 200, 130),
        (Verdict::Trust, false) => egui::Color32::from_rgb(20, 120, 50),
        (Verdict::Accepted, true) => egui::Color32::from_rgb(90, 200, 220),
        (Verdict::Accepted, false) => egui::Color32::from_rgb(0, 105, 125),
        (Verdict::Check, true) => egui::Color32::from_rgb(255, 190, 80),
        (Verdict::Check, false) => egui::Color32::from_rgb(160, 90, 0),
        (Verdict::LeftOut, true) => egui::Color32::from_rgb(168, 162, 112),
        (Verdict::LeftOut, false) => egui::Color32::from_gray(85),
        (Verdict::NoScale, true) => egui::Color32::from_rgb(255, 110, 110),
        (Verdict::NoScale, false) => egui::Color32::from_rgb(180, 20, 30),
    }
}

/// The colour of a photo's lines in the viewport: on dark rock as on a light page, so neither as dark as
/// letters on it would be nor as light as the page. `None` is not settled yet.
pub fn line_color(verdict: Option<Verdict>, visuals: &egui::Visuals) -> egui::Color32 {
    match (verdict, visuals.dark_mode) {
        (None, true) => visuals.text_color(),
        (Some(verdict), true) => verdict_color(verdict, visuals),
        (None, false) => egui::Color32::from_gray(136),
        (Some(Verdict::Trust), false) => egui::Color32::from_rgb(40, 160, 80),
        (Some(Verdict::Accepted), false) => egui::Color32::from_rgb(0, 145, 170),
        (Some(Verdict::Check), false) => egui::Color32::from_rgb(200, 120, 0),
        (Some(Verdict::LeftOut), false) => egui::Color32::from_rgb(142, 136, 98),
        (Some(Verdict::NoScale), false) => egui::Color32::from_rgb(240, 80, 80),
    }
}

/// A sign before a verdict, so that colour is not all.
pub fn verdict_sign(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Trust => "✔",
        Verdict::Accepted => "☑",
        Verdict::Check => "⚠",
        Verdict::LeftOut => "⊗",
        Verdict::NoScale => "✖",
    }
}

/// In place of a verdict's sign while it is not the last word.
pub(super) const PENDING: &str = "…";

/// The sign and the colour of a verdict as it is now: those of "trust" belong to what is trusted for good.
pub(super) fn verdict_of_now(
    state: &State,
    verdict: Verdict,
    visuals: &egui::Visuals,
) -> (&'static str, egui::Color32) {
    match state.may_still_be_doubted(verdict) {
        true => (PENDING, visuals.weak_text_color()),
        false => (verdict_sign(verdict), verdict_color(verdict, visuals)),
    }
}

/// Why a verdict is not the last word; `None` where it is.
pub(super) fn why_pending(state: &State, verdict: Verdict) -> Option<String> {
    let is_pending = state.may_still_be_doubted(verdict);
    is_pending.then(|| format!("{STILL_COMPARING}: a photo may still be doubted"))
}

/// Draws a photo's verdict beside its name.
pub(super) fn verdict_label(state: &State, verdict: Verdict, ui: &mut egui::Ui) {
    let (sign, color) = verdict_of_now(state, verdict, ui.visuals());
    let label = ui.colored_label(color, format!("{sign} {verdict}"));
    if let Some(why) = why_pending(state, verdict) {
        label.on_hover_text(why);
    }
}

/// A number that may be missing.
pub(super) fn or_dash(value: Option<f64>, digits: u8) -> String {
    value.map_or_else(|| "–".to_owned(), |value| significant_digits(value, digits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::SELECTED;
    use crate::state::preferences::Preferences;
    use crate::tasks::Task;

    /// WCAG 2.2: relative luminance of an sRGB colour.
    fn luminance(color: egui::Color32) -> f64 {
        let [r, g, b, _] = color.to_array().map(|channel| {
            let share = f64::from(channel) / 255.0;
            if share <= 0.04045 {
                share / 12.92
            } else {
                ((share + 0.055) / 1.055).powf(2.4)
            }
        });
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    fn contrast(a: egui::Color32, b: egui::Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// WCAG's contrast for what is no text, 3 to 1, on the light page and on dark rock.
    #[test]
    fn lines_stand_out_from_dark_rock_on_a_light_page() {
        let visuals = egui::Visuals::light();
        let rock = egui::Color32::from_rgb(58, 56, 54);
        for verdict in Verdict::ALL {
            let color = line_color(Some(verdict), &visuals);
            for behind in [visuals.extreme_bg_color, rock] {
                let contrast = contrast(color, behind);
                assert!(contrast >= 3.0, "{verdict} on {behind:?}: {contrast:.2}");
            }
        }
    }

    /// WCAG's contrast for text, 4.5 to 1, on a page and in a field.
    #[test]
    fn warnings_and_errors_are_read_light_and_dark() {
        for visuals in [egui::Visuals::light(), egui::Visuals::dark()] {
            let mut style = egui::Style {
                visuals,
                ..egui::Style::default()
            };
            crate::more_contrast(&mut style);
            let visuals = style.visuals;
            let texts = [
                visuals.warn_fg_color,
                visuals.error_fg_color,
                visuals.text_color(),
            ];
            for color in texts {
                for behind in [visuals.panel_fill, visuals.extreme_bg_color] {
                    let contrast = contrast(color, behind);
                    assert!(contrast >= 4.5, "{color:?} on {behind:?}: {contrast:.2}");
                }
            }
        }
    }

    /// While photos are compared none is trusted for good; whatever speaks against one stays.
    #[test]
    fn trust_is_pending_while_photos_are_compared() {
        let visuals = egui::Visuals::dark();
        let mut state = State::new(egui::Context::default(), Preferences::default());
        let green = (
            verdict_sign(Verdict::Trust),
            verdict_color(Verdict::Trust, &visuals),
        );
        assert_eq!(verdict_of_now(&state, Verdict::Trust, &visuals), green);
        // It counts as running until its end is taken.
        state.start(Task::THUMBNAILS, |_| (), |_, ()| ());
        let pending = (PENDING, visuals.weak_text_color());
        assert_eq!(verdict_of_now(&state, Verdict::Trust, &visuals), pending);
        let why = why_pending(&state, Verdict::Trust).expect("a reason");
        assert!(why.contains("still being compared"), "{why}");
        for verdict in Verdict::ALL {
            let is_trust = verdict == Verdict::Trust;
            assert_eq!(
                why_pending(&state, verdict).is_some(),
                is_trust,
                "{verdict}"
            );
        }
        state.work.cancel(Task::THUMBNAILS);
        assert_eq!(verdict_of_now(&state, Verdict::Trust, &visuals), green);
        assert_eq!(why_pending(&state, Verdict::Trust), None);
    }

    /// The selected photo's lines have another colour than any verdict, above all than "check".
    #[test]
    fn the_selection_is_no_verdict() {
        for visuals in [egui::Visuals::light(), egui::Visuals::dark()] {
            for verdict in Verdict::ALL {
                let [r, g, b, _] = line_color(Some(verdict), &visuals).to_array();
                let apart = [r, g, b].into_iter().zip(SELECTED);
                let apart = apart.map(|(a, b)| u32::from(a.abs_diff(b))).sum::<u32>();
                assert!(apart > 200, "{verdict}: {r} {g} {b}");
            }
        }
    }
}
