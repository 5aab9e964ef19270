//! Where the mouse clicked. A frame that takes long gets all that was clicked meanwhile, and egui says where the mouse is by then.
//! (Where that is outside of the part, egui gives all clicks of the frame to another one: they are lost.)

use egui::{Event, PointerButton, Pos2};

/// Where a part of the window was clicked since the last frame, one after the other: where the button was pressed. Where that was in
/// a frame before, it is where the button was let go, which is near it.
pub(crate) fn clicked_places(ui: &egui::Ui, response: &egui::Response) -> Vec<Pos2> {
    if !response.clicked_by(PointerButton::Primary) {
        return Vec::new();
    }
    let reach = ui
        .ctx()
        .options(|options| options.input_options.max_click_dist);
    let ends_drag = response.drag_stopped();
    let mut clicks = ui.input(|input| places(&input.events, reach, ends_drag));
    // What floats over it has its own.
    let is_its = |place: Pos2| {
        let layer = ui.ctx().layer_id_at(place);
        response.interact_rect.contains(place) && layer == Some(response.layer_id)
    };
    clicks.retain(|place| is_its(*place));
    clicks
}

/// The first ones of places that lie within `reach` of each other: for what a click sets where the next one would find it, and does not
/// before the next frame.
pub(crate) fn apart(places: Vec<Pos2>, reach: f32) -> Vec<Pos2> {
    let mut kept: Vec<Pos2> = Vec::new();
    for place in places {
        if kept.iter().all(|before| before.distance(place) > reach) {
            kept.push(place);
        }
    }
    kept
}

/// The places of all clicks among these events. `ends_drag`: what is let go first was dragged before.
fn places(events: &[Event], reach: f32, ends_drag: bool) -> Vec<Pos2> {
    let mut places = Vec::new();
    // Where it was pressed in this frame, and whether it may still become a click.
    let mut pressed: Option<Pos2> = None;
    let mut is_click = !ends_drag;
    for event in events {
        match *event {
            Event::PointerMoved(to) => {
                is_click &= pressed.is_none_or(|from| from.distance(to) <= reach);
            }
            Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed: true,
                ..
            } => {
                pressed = Some(pos);
                is_click = true;
            }
            Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed: false,
                ..
            } => {
                if is_click {
                    places.push(pressed.unwrap_or(pos));
                }
                pressed = None;
                is_click = false;
            }
            _ => {}
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, pos2};

    use super::*;

    fn button(pos: Pos2, pressed: bool) -> Event {
        Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    #[test]
    fn clicks_are_where_the_button_was_pressed() {
        let [a, b, c] = [pos2(10.0, 10.0), pos2(50.0, 20.0), pos2(90.0, 40.0)];
        let found = |events: &[Event]| places(events, 6.0, false);
        let click = |at: Pos2| [Event::PointerMoved(at), button(at, true), button(at, false)];
        // Two in one frame, and the mouse is elsewhere by then.
        let gone = [Event::PointerMoved(c)];
        let two = [&click(a)[..], &click(b), &gone].concat();
        assert_eq!(found(&two), [a, b]);
        // A double click is two: the first of them is a corner, and the second one ends the line.
        let double = [&click(a)[..], &click(a), &click(b)].concat();
        assert_eq!(found(&double), [a, a, b]);
        assert_eq!(apart(found(&double), 6.0), [a, b]);
        // A drag is none, though it ends where it began.
        let dragged = [
            button(a, true),
            Event::PointerMoved(b),
            Event::PointerMoved(a),
            button(a, false),
        ];
        assert!(found(&dragged).is_empty());
        assert_eq!(found(&[&dragged[..], &click(c)].concat()), [c]);
        // Pressed in a frame before.
        let let_go = [button(b, false), Event::PointerMoved(c)];
        assert_eq!(found(&let_go), [b]);
        assert!(places(&let_go, 6.0, true).is_empty());
    }
}
