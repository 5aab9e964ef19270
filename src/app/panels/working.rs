//! The sign that something is being worked on. It turns as often as the window is drawn anyway while jobs run: egui's own
//! spinner asks for a frame after the other, and without a graphics card those take the processor from the work.

use std::f32::consts::TAU;

use egui::{Sense, Shape, Stroke, Ui};

/// Points of its arc.
const POINTS: u8 = 16;

/// Draws it, as high as a line.
pub(super) fn working(ui: &mut Ui) {
    let side = ui.spacing().interact_size.y;
    let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(side), Sense::hover());
    let radius = side / 2.0 - 2.0;
    // Once around in 2 s.
    let start = ui.input(|input| (input.time % 2.0) as f32) / 2.0;
    let arc = (0..=POINTS).map(|point| {
        let turn = start + 0.6 * f32::from(point) / f32::from(POINTS);
        rect.center() + radius * egui::Vec2::angled(TAU * turn)
    });
    let stroke = Stroke::new(2.0, ui.visuals().strong_text_color());
    ui.painter().add(Shape::line(arc.collect(), stroke));
}
