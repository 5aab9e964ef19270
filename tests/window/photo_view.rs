//! The photo in the middle of the window: its pixels, the wheel, keys, what lies over it.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelUnit, Pos2, Rect, Theme, vec2};
use fragscale::app::Command;
use fragscale::app::photo_view::{Middle, PhotoCommand, PhotoOverlays};
use fragscale::scale::ImageKind;
use glam::DVec2;

use crate::desk::{Desk, Screen, copy, flight};

fn place(desk: &Desk) -> Rect {
    let name = format!("Photo view {}", desk.selected());
    desk.node(Role::Image, &name).rect()
}

/// Where the photo has no room for the mark of a corner, the window lives on: at 500 x 350, below a tall log, at 200 %.
#[test]
fn a_photo_without_room_is_no_end() {
    for (key, zoom) in [(Key::B, 1.0), (Key::P, 1.0), (Key::B, 2.0), (Key::P, 2.0)] {
        let mut desk = Desk::new(Some(&flight("assets/sample")));
        desk.harness.ctx.set_zoom_factor(zoom);
        desk.press(Modifiers::NONE, key);
        desk.press(Modifiers::COMMAND, Key::L);
        let sizes = [(900, 600), (500, 350), (450, 300), (400, 250), (320, 200)];
        for (width, height) in sizes {
            desk.harness
                .set_size(vec2(width as f32, height as f32) / zoom);
            desk.settle();
        }
        desk.harness.set_size(vec2(1280.0, 720.0));
        desk.settle();
        assert!(place(&desk).width() > 100.0);
    }
}

/// The pixel of the image that is under a place of the screen, one pixel a point.
fn pixel_under(desk: &Desk, at: Pos2) -> DVec2 {
    let frame = place(desk);
    let size = DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
    let open = desk.open();
    let camera = open
        .flight()
        .camera(&open.flight().parts().photos[open.selected.unwrap()]);
    let image = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let view = open.photo_view.placing;
    let zoom = view.zoom.unwrap_or_else(|| (size / image).min_element());
    let off = at - frame.center();
    view.middle * image + DVec2::new(f64::from(off.x), f64::from(off.y)) / zoom
}

/// Turns the wheel at a place, until all is drawn.
pub fn wheel(desk: &mut Desk, at: Pos2, up: f32) {
    desk.harness.hover_at(at);
    desk.harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, up),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    desk.settle();
}

fn says(desk: &Desk, words: &str) -> bool {
    desk.written().iter().any(|text| text.text.contains(words))
}

#[test]
fn keys_put_the_photo_into_the_middle_or_beside_the_pile() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    assert!(
        desk.open().photo_view.full.is_none(),
        "nothing is read before it is wanted"
    );
    desk.press(Modifiers::NONE, Key::P);
    assert!(!desk.shows(Role::Image, "Viewport"));
    assert!(place(&desk).width() > 300.0);
    assert!(desk.open().photo_view.tiles.there().count() > 0);
    desk.press(Modifiers::NONE, Key::B);
    let (pile, photo) = (desk.viewport(), place(&desk));
    // Below each other where there is more height than width.
    let apart = pile.right() <= photo.left() || pile.bottom() <= photo.top();
    assert!(
        apart && pile.area() > 3e4 && photo.area() > 3e4,
        "{pile} {photo}"
    );
    // The inspector's small photo stays.
    let small = format!("Photo {} with its scale", desk.selected());
    assert!(desk.shows(Role::Image, &small));
    desk.press(Modifiers::NONE, Key::B);
    assert!(
        desk.open().photo_view.full.is_none(),
        "hundreds of megabytes are let go"
    );
    desk.click(Role::Button, "Photo in the middle");
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(desk.shows(Role::Image, "Viewport"));
}

#[test]
fn the_wheel_zooms_to_the_cursor_and_a_drag_moves() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.press(Modifiers::NONE, Key::P);
    let at = place(&desk).center() + vec2(90.0, -40.0);
    let before = pixel_under(&desk, at);
    wheel(&mut desk, at, 300.0);
    assert!(desk.open().photo_view.placing.zoom.is_some());
    let after = pixel_under(&desk, at);
    assert!(after.distance(before) < 0.01, "{before} is {after}");
    desk.harness.drag_at(at);
    desk.harness.hover_at(at + vec2(-30.0, 20.0));
    desk.harness.drop_at(at + vec2(-30.0, 20.0));
    desk.settle();
    let moved = pixel_under(&desk, at + vec2(-30.0, 20.0));
    assert!(moved.distance(before) < 0.01, "{before} is {moved}");
    desk.press(Modifiers::SHIFT, Key::Z);
    assert_eq!(desk.open().photo_view.placing.zoom, None);
    desk.press(Modifiers::NONE, Key::Z);
    assert_eq!(desk.open().photo_view.placing.zoom, Some(1.0));
    // The arrows go on to the next photo, which is read.
    for (key, photo) in [
        (Key::ArrowRight, 1),
        (Key::ArrowDown, 2),
        (Key::ArrowLeft, 1),
    ] {
        desk.press(Modifiers::NONE, key);
        assert_eq!(desk.open().selected, Some(photo));
        assert!(desk.open().photo_view.full_of(photo).is_some());
    }
}

/// One to one and as shot, the screen shows the pixels of the file, whichever tiles they are in.
#[test]
fn one_to_one_shows_the_pixels_of_the_file() {
    let screen = Screen {
        size: [1000.0, 600.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    let mut desk = Desk::drawn(Some(&flight("assets/sample")), &screen);
    desk.press(Modifiers::NONE, Key::P);
    desk.click(Role::RadioButton, "As shot");
    let none = PhotoOverlays {
        edges: false,
        bars: false,
        grid: false,
        corners: false,
        isolines: false,
    };
    for command in [
        PhotoCommand::Overlays(none),
        PhotoCommand::OneToOne,
        // Where four tiles meet.
        PhotoCommand::GoTo(DVec2::new(510.0, 510.0)),
    ] {
        desk.harness.state_mut().apply(Command::Photo(command));
    }
    desk.harness.remove_cursor();
    desk.settle();
    let frame = place(&desk);
    let shown = desk.harness.render().expect("a picture");
    let name = desk.selected().to_owned();
    let open = desk.open();
    let path = open.files.photo_files[open.selected.unwrap()].path.clone();
    let file = image::open(path.unwrap()).expect("a photo").to_rgb8();
    let (mut worst, mut sum) = (0, 0_u64);
    for (x, y) in (-60..60).flat_map(|x| (-60..60).map(move |y| (x, y))) {
        let at = frame.center() + vec2(x as f32 + 0.5, y as f32 + 0.5);
        let pixel = pixel_under(&desk, Pos2::new(at.x.floor() + 0.5, at.y.floor() + 0.5));
        let [u, v] = [pixel.x, pixel.y].map(|at| at.floor() as u32);
        let there = shown.get_pixel(at.x as u32, at.y as u32);
        // Half a pixel off, where the frame has an odd width, is between two of the file.
        let near = (0..2)
            .flat_map(|i| (0..2).map(move |j| (i, j)))
            .map(|(i, j)| {
                let own = file.get_pixel(u + i, v + j);
                (0..3).map(|c| own[c].abs_diff(there[c])).max().unwrap()
            });
        let off = near.min().unwrap();
        worst = worst.max(off);
        sum += u64::from(off);
    }
    assert!(
        sum < 120 * 120 * 6,
        "{name}: {} on average, {worst} at most",
        sum / 14_400
    );
}

#[test]
fn corners_say_what_they_lie_on_in_either_image() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::P);
    let outcomes: Vec<&str> = {
        let open = desk.open();
        let scale = open.scale(open.selected.unwrap()).expect("a scale");
        let on = |is: bool| if is { "surface" } else { "ground" };
        let corners = scale.corners.iter();
        corners
            .map(|corner| on(corner.outcome.is_on_surface()))
            .collect()
    };
    for (name, on) in ["top left", "top right", "bottom right", "bottom left"]
        .iter()
        .zip(&outcomes)
    {
        assert!(says(&desk, &format!("{name}: {on}")), "{name}");
    }
    assert!(says(&desk, "TOP"));
    desk.click(Role::Button, "Overlays ⏷");
    desk.click(Role::CheckBox, "Corners");
    assert!(!says(&desk, "top left: "));
    desk.harness
        .state_mut()
        .apply(Command::Photo(PhotoCommand::Middle(Middle::Pile)));
    desk.settle();
    assert!(!says(&desk, "TOP") || desk.shows(Role::Image, "Viewport"));
}

/// Two photos of the same flight: one is missing, one is no photo.
#[test]
fn a_photo_that_is_missing_or_damaged_says_so() {
    let folder = copy("assets/sample");
    crate::desk::copy_files("assets/sample/photos", &folder.path().join("photos"));
    let desk = Desk::new(Some(&folder.path().join("flight.toml")));
    let photos = desk.photos();
    drop(desk);
    let path = |name: &str| folder.path().join("photos").join(name);
    std::fs::remove_file(path(&photos[0])).expect("a photo");
    let whole = std::fs::read(path(&photos[1])).expect("a photo");
    std::fs::write(path(&photos[1]), &whole[..whole.len() / 3]).expect("a file");
    let mut desk = Desk::new(Some(&folder.path().join("flight.toml")));
    desk.press(Modifiers::NONE, Key::P);
    desk.click(Role::Row, &format!("Photo {}", photos[0]));
    assert!(says(&desk, "is not there"), "{:?}", desk.texts());
    desk.click(Role::Row, &format!("Photo {}", photos[1]));
    let full = desk.open().photo_view.full.as_ref().expect("looked at");
    let why = full.pixels.as_ref().expect_err("damaged").clone();
    assert!(says(&desk, &why));
    desk.click(Role::Row, &format!("Photo {}", photos[2]));
    assert!(desk.open().photo_view.tiles.there().count() > 0);
    assert!(
        desk.open()
            .photo_view
            .full_of(2)
            .is_some_and(|full| full.pixels.is_ok())
    );
}

#[test]
fn the_other_image_is_shown_at_once() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.press(Modifiers::NONE, Key::P);
    let scales = desk.open().flight().parts().image;
    assert_eq!(
        desk.open().photo_view.image_for(scales),
        ImageKind::Undistorted
    );
    desk.click(Role::RadioButton, "As shot");
    assert_eq!(desk.open().photo_view.image, Some(ImageKind::AsShot));
    assert!(!desk.open().photo_view.tiles.is_waiting());
    // The scales are for the same image as before.
    assert_eq!(desk.open().flight().parts().image, scales);
}
