//! The corner loupe: what each corner lies on, and going there.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use fragscale::scale::CornerName;
use glam::{DVec2, DVec3};

use crate::desk::{Desk, Screen, flight};

fn point(desk: &Desk, corner: usize) -> DVec3 {
    let open = desk.open();
    let scale = open.scale(open.selected.unwrap()).expect("a scale");
    scale.corners[corner].point().expect("a point")
}

#[test]
fn a_corners_row_goes_to_it() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.harness.set_size(vec2(1280.0, 1200.0));
    desk.press(Modifiers::NONE, Key::B);
    for (index, name) in ["top left", "top right", "bottom right", "bottom left"]
        .into_iter()
        .enumerate()
    {
        let name = format!("Go to the corner {name}");
        desk.click(Role::Link, &name);
        let orbit = desk.open().looking.orbit;
        assert_eq!(orbit.target, point(&desk, index));
        // The photo view has it in the middle, one to one.
        let placing = desk.open().photo_view.placing;
        let corner = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y][index];
        assert_eq!((placing.zoom, placing.middle), (Some(1.0), corner));
    }
}

#[test]
fn a_click_on_a_corner_goes_to_it() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let small = format!("Photo {} with its scale", desk.selected());
    let frame = desk.node(Role::Image, &small).rect();
    desk.click_at(frame.right_bottom() - vec2(7.0, 7.0));
    assert_eq!(desk.open().looking.orbit.target, point(&desk, 2));
    desk.press(Modifiers::NONE, Key::P);
    let name = format!("Photo view {}", desk.selected());
    let frame = desk.node(Role::Image, &name).rect();
    // In its middle now.
    let before = desk.open().looking.orbit.target;
    desk.press(Modifiers::NONE, Key::T);
    desk.click_at(frame.center());
    assert_eq!(desk.open().looking.orbit.target, before);
    assert_eq!(desk.open().photo_view.placing.middle, DVec2::ONE);
}

/// The triangles are those that the corner rays met, found in another way.
#[test]
fn the_loupe_says_which_triangle_a_corner_lies_on() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    assert!(desk.open().corners.is_none(), "nobody has asked");
    desk.click(Role::Button, "Corner loupe");
    for row in 0..3 {
        let open = desk.open();
        let photo = open.selected.unwrap();
        let facts = open.corners.as_ref().expect("looked at");
        let met = open.view(photo).expect("footprints").triangle_edges;
        let scale = open.scale(photo).expect("a scale");
        let mut named = Vec::new();
        for (index, name) in CornerName::ALL.into_iter().enumerate() {
            let corner = scale.corners[index];
            let (Some(point), Some(triangle)) = (corner.point(), facts.triangles[index]) else {
                continue;
            };
            let name = name.as_str().replace('_', " ");
            if let Some(edge) = met[index] {
                assert!(
                    (triangle.longest_edge() - edge).abs() < 1e-9,
                    "row {row}: {name}"
                );
                assert!(triangle.off < 1e-6);
                named.push(format!("{edge:.3}"));
            } else {
                // Off the surface: no vertex of the triangle is nearer than it.
                let nearest = triangle.corners.map(|at| at.distance(point));
                assert!(triangle.off <= nearest.into_iter().fold(f64::INFINITY, f64::min));
                named.push(format!("{:.3}", triangle.off));
            }
        }
        assert!(!named.is_empty());
        for number in named {
            assert!(desk.says(&number), "{number}");
        }
        desk.press(Modifiers::NONE, Key::ArrowDown);
    }
    // Off again nothing is looked for.
    desk.click(Role::Button, "Corner loupe");
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert!(desk.open().corners.is_none());
}

/// The surface is drawn beside the photo, and a click on a crop goes there.
#[test]
fn the_surface_is_drawn_beside_the_photo() {
    let screen = Screen {
        size: [1024.0, 700.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    let mut desk = Desk::drawn(Some(&flight("assets/sample")), &screen);
    desk.click(Role::Button, "Corner loupe");
    let label = {
        let nodes = desk.harness.query_all_by_role(Role::Button);
        let mut labels = nodes.filter_map(|node| node.accesskit_node().label());
        labels
            .find(|label| label.starts_with("Loupe top left"))
            .expect("a crop")
    };
    desk.node(Role::Button, &label).scroll_to_me();
    desk.settle();
    let place = desk.node(Role::Button, &label).rect();
    let picture = desk.harness.render().expect("a picture");
    let right = place.right() - place.width() / 4.0;
    // Rock has many shades, an empty place one.
    let shades = |x: f32| {
        let mut seen = std::collections::BTreeSet::new();
        for step in -25..25_i32 {
            for across in -25..25_i32 {
                let (u, v) = (x + across as f32, place.center().y + step as f32);
                if v > 2.0 && v < 670.0 {
                    seen.insert(picture.get_pixel(u as u32, v as u32).0);
                }
            }
        }
        seen.len()
    };
    assert!(shades(right) > 100, "{}", shades(right));
    assert!(shades(place.left() + place.width() / 4.0) > 100);
    desk.click(Role::Button, &label);
    assert_eq!(desk.open().looking.orbit.target, point(&desk, 0));
}
