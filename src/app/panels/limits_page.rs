//! When a photo's scale is doubted: the limits of the verdict, on one page.

use super::field::number_field;
use crate::command::Command;
use crate::flight::Limits;
use crate::state::State;

/// Draws the page.
pub(super) fn limits_page(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let now = state.preferences.limits;
    let mut next = now;
    ui.label("A photo is to check when one of these holds. Change a limit, and all photos are judged anew.");
    ui.label("They are this window's, for all flights, and are kept on this computer; the command line has the usual ones.");
    if now != Limits::default() {
        let text = egui::RichText::new(
            "⚠ Not the usual limits: 'fragscale scales' and 'check' may judge otherwise.",
        );
        ui.label(text.color(ui.visuals().warn_fg_color));
    }
    ui.add_space(6.0);
    for (value, name, suffix, percent, why) in [
        (
            &mut next.top_bottom_ratio,
            "Top and bottom scale differ more than",
            "times",
            false,
            "Split-Desktop goes from one to the other in a straight line: far apart, the middle is off",
        ),
        (
            &mut next.left_right_ratio,
            "Left and right scale differ more than",
            "times",
            false,
            "A scale that changes only from top to bottom is off at the sides",
        ),
        (
            &mut next.triangle_share,
            "A corner's triangle has an edge over",
            "% of the footprint",
            true,
            "A long triangle bridges a hole in the cloud: the corner lies where nothing was measured",
        ),
        (
            &mut next.flattest_angle,
            "A corner's ray meets the pile at under",
            "degrees",
            false,
            "In a flat view a small error of the pose moves the corner point far",
        ),
        (
            &mut next.plane_share,
            "The surface leaves the corners' plane by over",
            "% of the footprint (rms)",
            true,
            "Four corners on a plane say nothing about a heap between them (only where no line fits)",
        ),
        (
            &mut next.off_line_share,
            "The scale of the pixels is off the best line by over",
            "% (rms)",
            true,
            "Split-Desktop draws a line from top to bottom: what lies off it is measured with a wrong scale",
        ),
        (
            &mut next.interval_share,
            "The 95 % interval of a scale is wider than",
            "% of the scale",
            true,
            "Every size is as unsure as the scale: a difference between two blasts drowns in it",
        ),
    ] {
        ui.strong(name);
        ui.horizontal_wrapped(|ui| {
            let shown = if percent { *value * 100.0 } else { *value };
            if let Some(typed) = number_field(ui, name, why, shown, suffix)
                && typed >= 0.0
            {
                *value = if percent { typed / 100.0 } else { typed };
            }
        });
        ui.weak(why);
        ui.add_space(6.0);
    }
    ui.label("Always to check: a corner off the surface; a photo file that is missing, cannot be read, or has another size than its camera.");
    ui.add_space(6.0);
    let usual = ui.add_enabled(now != Limits::default(), egui::Button::new("Usual limits"));
    if usual
        .on_hover_text("Go back to the limits that fragscale comes with")
        .clicked()
    {
        next = Limits::default();
    }
    if next != now {
        commands.push(Command::Limits(next));
    }
}
