//! The page of the map: what lies under the mouse, moving it, and the files that are made of it.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelUnit, Pos2, Rect, Theme, vec2};
use egui_kittest::Harness;
use fragscale::app::map::MapCommand;
use fragscale::app::size_distributions::Page;
use fragscale::app::{App, Command};
use fragscale::exports::PlanGround;
use glam::DVec2;

use crate::desk::{Desk, Screen, flight};

fn on_map() -> Desk {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.press(Modifiers::COMMAND, Key::Num2);
    desk
}

fn place(desk: &Desk) -> Rect {
    desk.node(Role::Image, "Map").rect()
}

/// The point of the map under a place of the screen.
fn under(desk: &Desk, at: Pos2) -> DVec2 {
    let frame = place(desk);
    let size = DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
    let map = &desk.open().map;
    let (middle, scale) = map
        .looking
        .seen(&map.made.as_ref().expect("a plan").plan, size);
    let off = at - frame.center();
    middle + DVec2::new(f64::from(off.x), -f64::from(off.y)) / scale
}

/// The place on the screen of a point of the map.
fn screen_of(desk: &Desk, point: DVec2) -> Pos2 {
    let center = place(desk).center();
    let (origin, right) = (under(desk, center), under(desk, center + vec2(1.0, 0.0)));
    let off = (point - origin) / (right - origin).length();
    center + vec2(off.x as f32, -off.y as f32)
}

#[test]
fn the_map_shows_every_photo_where_it_lies() {
    let desk = on_map();
    assert_eq!(desk.harness.state().state().page, Page::Map);
    let open = desk.open();
    let made = open.map.made.as_ref().expect("a plan");
    assert_eq!(made.plan.photos.len(), open.review.count());
    assert_eq!(made.revision, open.map.revision);
    assert!(open.map.drawn.is_some());
    for (index, photo) in made.plan.photos.iter().enumerate() {
        let view = open.view(index).expect("a view");
        assert_eq!(photo.outline.len(), view.footprint.outline.len());
        assert_eq!(
            photo.verdict,
            open.review.photo(index).expect("a photo").settled()
        );
    }
    // All of it is in the frame.
    let frame = place(&desk);
    for corner in made.plan.extent {
        assert!(frame.contains(screen_of(&desk, corner)));
    }
    // Table and inspector stay beside it.
    assert_eq!(desk.photos().len(), open.review.count());
}

#[test]
fn a_click_selects_the_photo_and_the_mouse_tells_where_it_is() {
    let mut desk = on_map();
    for photo in [4, 7] {
        let made = desk.open().map.made.as_ref().expect("a plan");
        let (name, middle) = {
            let photo = &made.plan.photos[photo];
            (photo.name.clone(), photo.middle.expect("a middle"))
        };
        let at = screen_of(&desk, middle);
        desk.click_at(at);
        assert_eq!(desk.selected(), name);
        desk.harness.hover_at(at);
        desk.settle();
        let words = desk.written();
        let said = words
            .iter()
            .find(|text| text.text.starts_with("x "))
            .expect("coordinates");
        assert!(said.text.contains(&name), "{}", said.text);
        let numbers: Vec<f64> = said
            .text
            .split_whitespace()
            .filter_map(|word| word.parse().ok())
            .collect();
        let apart = DVec2::new(numbers[0], numbers[1]).distance(middle);
        // A point of the screen, and two decimals.
        assert!(apart < 0.05, "{} is {apart} from {middle}", said.text);
    }
    // The arrows go through the table as beside the pile.
    let before = desk.open().selected;
    desk.press(Modifiers::NONE, Key::ArrowUp);
    assert_ne!(desk.open().selected, before);
}

#[test]
fn the_wheel_zooms_at_the_cursor_a_drag_moves_and_fit_shows_all() {
    let mut desk = on_map();
    let at = place(&desk).center() + vec2(60.0, -40.0);
    let before = under(&desk, at);
    desk.harness.hover_at(at);
    desk.harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 300.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    desk.settle();
    assert!(desk.open().map.looking.at.is_some());
    assert!(under(&desk, at).distance(before) < 1e-6);
    let drawn = desk.open().map.drawn.as_ref().expect("a part");
    let [min, max] = drawn.frame.bounds();
    assert!(before.cmpge(min).all() && before.cmple(max).all());
    let to = at + vec2(-30.0, 20.0);
    desk.harness.drag_at(at);
    desk.harness.hover_at(to);
    desk.harness.drop_at(to);
    desk.settle();
    assert!(under(&desk, to).distance(before) < 1e-6);
    desk.click(Role::Button, "Fit map");
    assert_eq!(desk.open().map.looking.at, None);
}

/// Who zooms out sees all photos at once: of the part before they would be cut at its edges until the next one is drawn.
#[test]
fn photos_are_whole_while_the_next_part_is_drawn() {
    let mut desk = on_map();
    let frame = place(&desk);
    let size = DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
    let zoom = |desk: &mut Desk, factor: f64| {
        desk.harness
            .state_mut()
            .apply(Command::Map(MapCommand::Zoom {
                cursor: size / 2.0,
                factor,
                size,
            }));
    };
    let shown = |desk: &Desk| {
        let map = &desk.open().map;
        let plan = &map.made.as_ref().expect("a plan").plan;
        let (middle, scale) = map.looking.seen(plan, size);
        let half = size / 2.0 / scale;
        let sight = [middle - half, middle + half];
        let shown = map.shown(plan, sight).expect("a part").frame.bounds();
        let drawn = map.drawn.as_ref().expect("a part").frame.bounds();
        let [min, max] = plan.extent;
        let is_whole = shown[0].cmple(min).all() && shown[1].cmpge(max).all();
        (is_whole, shown == drawn)
    };
    zoom(&mut desk, 20.0);
    desk.settle();
    // Near by, the fine one.
    assert_eq!(shown(&desk), (false, true));
    for _ in 0..10 {
        zoom(&mut desk, 0.7);
    }
    // Nothing was drawn since.
    assert_eq!(shown(&desk), (true, false));
    desk.settle();
    assert_eq!(shown(&desk), (true, true));
    // What was drawn before a decision is of before.
    zoom(&mut desk, 20.0);
    desk.harness.state_mut().apply(Command::Decide(
        0,
        Some((fragscale::flight::DecisionKind::LeftOut, String::new())),
    ));
    desk.settle();
    zoom(&mut desk, 0.05);
    assert_eq!(shown(&desk), (false, true));
}

/// A decision changes the verdict on the map; another ground is made only for another surface.
#[test]
fn the_map_follows_the_review() {
    let mut desk = on_map();
    let ground = |desk: &Desk| desk.open().map.made.as_ref().expect("a plan").ground.id();
    let before = ground(&desk);
    let verdict =
        |desk: &Desk| desk.open().map.made.as_ref().expect("a plan").plan.photos[0].verdict;
    let first = verdict(&desk);
    desk.harness.state_mut().apply(Command::Decide(
        0,
        Some((fragscale::flight::DecisionKind::LeftOut, String::new())),
    ));
    desk.settle();
    assert_ne!(verdict(&desk), first);
    assert_eq!(ground(&desk), before);
    let mut settings = desk.open().settings();
    settings.surface.max_edge = Some(0.02);
    desk.harness.state_mut().apply(Command::Set(settings));
    desk.settle();
    assert_ne!(ground(&desk), before);
}

#[test]
fn the_map_is_written_in_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = on_map();
    for (name, begins) in [
        ("map.tif", &b"II*\0"[..]),
        ("map.svg", b"<svg "),
        ("map.pdf", b"%PDF-1.4"),
        ("map.png", b"\x89PNG"),
    ] {
        desk.click(Role::Button, "Export map…");
        let path = folder.path().join(name);
        desk.type_path(&path);
        desk.click(Role::Button, "Write map");
        let bytes = std::fs::read(&path).expect(name);
        assert!(bytes.starts_with(begins), "{name}");
        assert!(desk.logged("written"));
    }
    let svg = std::fs::read_to_string(folder.path().join("map.svg")).expect("an SVG");
    for photo in &desk.open().map.made.as_ref().expect("a plan").plan.photos {
        assert!(
            svg.contains(&format!(">{}</text>", photo.name)),
            "{}",
            photo.name
        );
    }
    let jpg = folder.path().join("map.jpg");
    let save = MapCommand::Save {
        to: jpg.clone().into(),
        pixel: None,
    };
    desk.harness.state_mut().apply(Command::Map(save));
    desk.settle();
    assert!(desk.logged("a map is written as GeoTIFF, SVG, PDF or PNG"));
    assert!(!jpg.exists());
}

/// The same grounds as the command has; the file has the ground of the screen, in pixels of the size that is
/// typed, and what is measured.
#[test]
fn the_ground_is_chosen_and_the_file_has_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = on_map();
    let colourful = |desk: &Desk| {
        let ground = desk
            .open()
            .map
            .made
            .as_ref()
            .expect("a plan")
            .plan
            .ground
            .clone();
        let far = |pixel: &&image::Rgba<u8>| {
            let [red, green, blue, _] = pixel.0;
            red != green || green != blue
        };
        ground.pixels().filter(far).count() as f64 / ground.pixels().len() as f64
    };
    assert_eq!(colourful(&desk), 0.0);
    desk.click(Role::Button, "Ground: photos");
    assert_eq!(
        desk.open().map.of_now().expect("made").plan.ground_kind,
        PlanGround::Photos
    );
    assert!(colourful(&desk) > 0.15, "{}", colourful(&desk));
    desk.click(Role::Button, "Export map…");
    let path = folder.path().join("photos.tif");
    desk.node(Role::SpinButton, "Pixel size of the map").click();
    desk.harness.run();
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Text("2".to_owned()));
    desk.harness.run();
    desk.press(Modifiers::NONE, Key::Enter);
    desk.type_path(&path);
    desk.click(Role::Button, "Write map");
    // 2 cm, the unit of the window.
    let plan = desk.open().map.made.as_ref().expect("a plan").plan.clone();
    let wide = (plan.extent[1] - plan.extent[0]).x / 0.02;
    let picture = image::open(&path).expect("a TIFF");
    assert!(
        (f64::from(picture.width()) - wide).abs() <= 2.0,
        "{} {wide}",
        picture.width()
    );
    desk.click(Role::Button, "Ground: plain");
    assert!(plan.ground.pixels().any(|pixel| pixel.0[3] > 0));
    let plan = desk.open().map.of_now().expect("made").plan.clone();
    assert!(plan.ground.pixels().all(|pixel| pixel.0[3] == 0));
}

/// Coordinates stand beside the map, where they hide nothing.
#[test]
fn labels_of_the_grid_lie_beside_the_map() {
    let desk = on_map();
    let frame = place(&desk);
    let numbers = desk.written().into_iter().filter(|text| {
        let beside =
            text.place.right() <= frame.left() + 0.5 && text.place.left() > frame.left() - 80.0;
        let below = text.place.top() >= frame.bottom() - 0.5;
        (beside || below) && text.text.parse::<f64>().is_ok()
    });
    assert!(numbers.count() >= 4);
    let over = desk.written().into_iter().filter(|text| {
        frame.shrink(1.0).contains(text.place.center()) && text.text.parse::<f64>().is_ok()
    });
    assert_eq!(over.count(), 0);
}

/// Looked at by people: FRAGSCALE_MAP_PICTURES=FOLDER keeps them.
#[test]
fn it_is_drawn_light_and_dark() {
    for (theme, size) in [
        (Theme::Light, [1024.0, 700.0]),
        (Theme::Dark, [1500.0, 950.0]),
    ] {
        let screen = Screen {
            size,
            pixels_per_point: 1.0,
            theme,
        };
        let mut desk = Desk::drawn(Some(&flight("assets/sample")), &screen);
        desk.press(Modifiers::COMMAND, Key::Num2);
        desk.harness.hover_at(place(&desk).center());
        desk.settle();
        let picture = desk.harness.render().expect("a picture");
        if let Some(folder) = std::env::var_os("FRAGSCALE_MAP_PICTURES") {
            let name = format!("map-{}-{}.png", size[0], matches!(theme, Theme::Dark));
            picture
                .save(std::path::Path::new(&folder).join(name))
                .expect("a place");
        }
        // Where the first photo's outline is, there is a colour; the ground is grey.
        let made = desk.open().map.made.as_ref().expect("a plan");
        let colourful = |at: Pos2| {
            let pixel = picture.get_pixel(at.x as u32, at.y as u32).0;
            pixel[..3].iter().max().expect("three") - pixel[..3].iter().min().expect("three") > 40
        };
        let outline = made.plan.photos[3].outline.iter();
        let on_lines = outline
            .filter(|point| colourful(screen_of(&desk, **point)))
            .count();
        assert!(
            on_lines * 3 > made.plan.photos[3].outline.len(),
            "{on_lines}"
        );
    }
}

/// A window that is larger than the textures of its graphics device (2048 pixels a side, where nobody says
/// more) has a map all the same, somewhat coarser; nothing is tried again and again.
#[test]
fn a_map_that_is_larger_than_a_texture_is_drawn() {
    let path = flight("assets/sample");
    let harness = Harness::builder()
        .with_size([1900.0, 1000.0])
        .with_pixels_per_point(2.0)
        .with_max_steps(30)
        .build_eframe(|context| App::new(context, vec![path]));
    let mut desk = Desk { harness };
    desk.settle();
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::F3);
    desk.press(Modifiers::COMMAND, Key::Num2);
    let drawn = desk.open().map.drawn.as_ref().expect("a part");
    let size = place(&desk).size();
    assert!(f64::from(size.x) * 2.0 > 2048.0, "{size:?}");
    // It covers what is in sight, and some more.
    assert!(drawn.frame.size[0] >= f64::from(size.x));
    let [width, height] = drawn.photos.size();
    assert!(width <= 2048 && height <= 2048, "{width} {height}");
    let log = &desk.harness.state().state().log;
    assert!(
        log.iter().all(|line| !line.text.contains("defect")),
        "{log:?}"
    );
}
