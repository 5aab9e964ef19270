//! What an engineer meets every day: small windows on a small screen, panels that are put away, Escape,
//! words on the viewport, pictures for a report, a window that is resized while it loads.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Rect, Vec2, vec2};
use egui_kittest::Harness;
use fragscale::app::App;
use fragscale::app::command::{Command, PictureRequest};
use fragscale::app::open_flight::Measure;
use fragscale::app::state::layers::Layers;
use fragscale::flight::DecisionKind;
use fragscale::render::{ColorBy, Scope};
use fragscale::units::LengthUnit;

use crate::desk::{Desk, Screen, Written, copy, copy_files, flight};

/// A window of this size without a graphics device.
fn desk_of_size(size: [f32; 2], path: &str) -> Desk {
    let path = flight(path);
    let harness = Harness::builder()
        .with_size(size)
        .with_max_steps(30)
        .build_eframe(|context| App::new(context, vec![path]));
    Desk { harness }
}

fn screen(size: [f32; 2]) -> Screen {
    Screen {
        size,
        pixels_per_point: 1.0,
        theme: egui::Theme::Dark,
    }
}

/// Whether all of it is inside, but for rounding.
fn holds(outer: Rect, inner: Rect) -> bool {
    outer.expand(0.5).contains_rect(inner)
}

/// The bars of the photo in the inspector, from the first frame that has them.
#[test]
fn the_top_is_above_the_bottom_from_the_first_frame_on() {
    // Of four corners: those are known before anything else, while the photo is read.
    let folder = copy("assets/sample");
    copy_files("assets/sample/photos", &folder.path().join("photos"));
    let toml = folder.path().join("flight.toml");
    let text = std::fs::read_to_string(&toml).expect("the flight");
    std::fs::write(&toml, text + "\n[scale]\nuse = \"corners\"\n").expect("written");
    let path = folder.path().to_owned();
    let harness = Harness::builder()
        .with_size([1280.0, 720.0])
        .build_eframe(|context| App::new(context, vec![path]));
    let mut desk = Desk { harness };
    let mut seen = 0;
    for _ in 0..4000 {
        desk.harness.step();
        let written = desk.written();
        let at = |word: &str| {
            let bar = written.iter().find(|w| w.text.starts_with(word));
            bar.map(|bar| bar.place.center().y)
        };
        if let (Some(top), Some(bottom)) = (at("TOP  "), at("BOTTOM  ")) {
            assert!(top < bottom, "TOP at {top}, BOTTOM at {bottom}");
            seen += 1;
        }
        if seen > 0 && desk.harness.state().state().is_idle() {
            break;
        }
    }
    assert!(seen > 1, "there are bars");
}

/// The list of keys is longer than a small window is high: it scrolls to its last line.
#[test]
fn the_keys_scroll_on_a_small_screen() {
    let mut desk = desk_of_size([900.0, 480.0], "tests/windrow");
    desk.settle();
    desk.press(Modifiers::NONE, Key::F1);
    let whole = desk.harness.ctx.content_rect();
    let shown = |desk: &Desk, text: &str| {
        desk.written()
            .iter()
            .any(|w| w.text == text && holds(whole, w.place) && holds(w.seen_in, w.place))
    };
    assert!(shown(&desk, "Turn the view"));
    assert!(!shown(&desk, "About fragscale"));
    desk.harness.hover_at(whole.center());
    desk.harness.step();
    for _ in 0..40 {
        desk.harness.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, -200.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        desk.harness.step();
    }
    desk.settle();
    assert!(shown(&desk, "Keys and mouse"), "the last key's line");
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(!desk.says("Turn the view"));
}

/// On 1024 x 700 the viewport gets its 500 px as soon as one of the panels is put away.
#[test]
fn panels_are_put_away_and_come_back() {
    let mut desk = desk_of_size([1024.0, 700.0], "tests/windrow");
    desk.settle();
    let before = desk.viewport().width();
    desk.press(Modifiers::NONE, Key::F2);
    assert!(!desk.shows(Role::TextInput, "Filter photos"));
    assert!(desk.viewport().width() >= 500.0, "{}", desk.viewport());
    desk.press(Modifiers::NONE, Key::F2);
    assert!(desk.shows(Role::TextInput, "Filter photos"));
    assert_eq!(desk.viewport().width(), before);
    desk.press(Modifiers::NONE, Key::F3);
    assert!(!desk.shows(Role::Tab, "Flight"));
    assert!(desk.viewport().width() >= 500.0, "{}", desk.viewport());
    desk.press(Modifiers::NONE, Key::F2);
    assert!(desk.viewport().width() >= 1020.0, "{}", desk.viewport());
    // By the menu too.
    desk.harness.query_menu("View").click();
    desk.settle();
    // Where the window is lower than this menu.
    desk.harness.query_menu("Photo and settings").scroll_to_me();
    desk.settle();
    desk.harness.query_menu("Photo and settings").click();
    desk.settle();
    assert!(desk.shows(Role::Tab, "Flight"));
}

/// The menu of most entries, in a low window: all of it stays inside, and what is below is scrolled to.
#[test]
fn a_long_menu_scrolls_in_a_low_window() {
    let mut desk = desk_of_size([900.0, 420.0], "tests/windrow");
    desk.settle();
    desk.harness.query_menu("View").click();
    desk.settle();
    assert!(desk.harness.query_menu("Theme").rect().min.y > 420.0);
    desk.harness.query_menu("Theme").scroll_to_me();
    desk.settle();
    assert!(desk.harness.query_menu("Theme").rect().max.y < 420.0);
    desk.harness.query_menu("Theme").click();
    desk.settle();
    desk.click(Role::RadioButton, "Light");
    desk.settle();
    assert_eq!(
        desk.harness.ctx.options(|options| options.theme_preference),
        egui::ThemePreference::Light
    );
}

/// In a usual window nothing of it is below the edge, and what turns the view is one menu further.
#[test]
fn the_longest_menu_is_whole_in_a_window_of_720_points() {
    let mut desk = desk_of_size([1280.0, 720.0], "tests/windrow");
    desk.settle();
    desk.harness.query_menu("View").click();
    desk.settle();
    // One more is below it.
    let last = desk.harness.query_menu("Theme").rect();
    assert!(last.max.y + last.height() < 720.0, "{last}");
    let before = desk.open().looking.orbit.yaw;
    desk.harness.query_menu("Turn").click();
    desk.settle();
    desk.harness.query_menu("Turn to the left").click();
    desk.settle();
    assert_ne!(desk.open().looking.orbit.yaw, before);
}

/// A button of the menu, whose name has its keys behind it.
trait Menu {
    fn query_menu(&self, name: &str) -> egui_kittest::Node<'_>;
}

impl Menu for Harness<'_, App> {
    fn query_menu(&self, name: &str) -> egui_kittest::Node<'_> {
        use egui_kittest::kittest::{NodeT, Queryable};
        let mut buttons = self.query_all_by_role(Role::Button);
        let found = buttons.find(|node| {
            let label = node.accesskit_node().label().unwrap_or_default();
            label.starts_with(name)
        });
        found.unwrap_or_else(|| panic!("no entry '{name}'"))
    }
}

#[test]
fn escape_leaves_measuring_and_the_camera() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::C);
    desk.press(Modifiers::NONE, Key::M);
    assert_ne!(desk.open().pointer.measure, Measure::Off);
    // A small window over it is closed first.
    desk.press(Modifiers::NONE, Key::F1);
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(!desk.says("Turn the view"));
    assert_ne!(desk.open().pointer.measure, Measure::Off);
    // The innermost first.
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.open().pointer.measure, Measure::Off);
    assert!(desk.open().looking.through.is_some());
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.open().looking.through, None);
}

/// The legend says the scale in the chosen unit, with round values beside the colours, all of it inside
/// the viewport.
#[test]
fn the_legend_has_the_chosen_unit_and_round_values() {
    let mut desk = Desk::drawn(Some(&flight("tests/windrow")), &screen([1000.0, 600.0]));
    let layers = Layers {
        color_by: ColorBy::Scale,
        ..Layers::default()
    };
    desk.harness.state_mut().apply(Command::Layers(layers));
    for (unit, title) in [
        (LengthUnit::Centimetre, "scale (px/cm)"),
        (LengthUnit::Metre, "scale (px/m)"),
        (LengthUnit::Foot, "scale (px/ft)"),
    ] {
        desk.harness.state_mut().apply(Command::Unit(unit));
        desk.settle();
        let viewport = desk.viewport();
        let written = desk.written();
        let head = written.iter().find(|w| w.text == title);
        let head = head.unwrap_or_else(|| panic!("no '{title}'"));
        assert!(holds(viewport, head.place), "{}", head.place);
        // Under the head, at the right edge.
        let mut values: Vec<f64> = written
            .iter()
            .filter(|w| w.place.left() > viewport.right() - 120.0)
            .filter(|w| w.place.top() > head.place.bottom() - 2.0)
            .filter(|w| viewport.contains(w.place.center()))
            .filter_map(|w| {
                let value = w.text.parse().ok()?;
                assert!(holds(viewport, w.place), "{} at {}", w.text, w.place);
                Some(value)
            })
            .collect();
        // A halo writes each several times.
        values.dedup();
        assert!((3..=8).contains(&values.len()), "{title}: {values:?}");
        // Steps are 1, 2 or 5 times a power of ten.
        let step = (values[1] - values[0]).abs();
        let leading = step / 10_f64.powf((step * 1.000_001).log10().floor());
        let round = [1.0, 2.0, 5.0];
        assert!(
            round.iter().any(|r| (leading - r).abs() < 1e-6),
            "{title}: {values:?}"
        );
        // In it lies the scale of the photo's corners.
        let factor = unit.in_units_of(LengthUnit::Metre);
        let photo = desk.open().selected.expect("a photo");
        let top = desk.open().scale(photo).expect("a scale").scale.top;
        let top = top.expect("a top") * factor;
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        assert!(low * 0.5 < top && top < high * 2.0, "{top} in {values:?}");
    }
}

/// A picture for a report, as the window is.
fn picture(desk: &mut Desk, name: &str) -> image::RgbaImage {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join(name);
    let request = PictureRequest {
        to: to.clone().into(),
        size: [640, 400],
        transparent: false,
        corner_rays: false,
    };
    desk.harness.state_mut().apply(Command::Picture(request));
    desk.settle();
    image::open(&to).expect("a PNG").to_rgba8()
}

/// The distance that is measured in the viewport is in its picture, with its points and its number.
#[test]
fn the_measured_distance_is_in_the_picture() {
    let mut desk = Desk::drawn(Some(&flight("tests/windrow")), &screen([1000.0, 600.0]));
    desk.press(Modifiers::NONE, Key::T);
    let bare = picture(&mut desk, "bare.png");
    desk.press(Modifiers::NONE, Key::M);
    let center = desk.viewport().center();
    for to in [vec2(-60.0, 40.0), vec2(70.0, 40.0)] {
        desk.click_at(center + to);
    }
    let Measure::Both(a, b) = desk.open().pointer.measure else {
        panic!("{:?}", desk.open().pointer.measure);
    };
    let number = format!(
        "{} m",
        fragscale::numbers::significant_digits(a.distance(b), 4)
    );
    assert!(
        desk.written().iter().any(|w| w.text == number),
        "{number} is not on the viewport"
    );
    // Its words are on plates: the rock behind them is of any colour.
    let is_on_plate = |words: &Written| {
        let shapes = desk.harness.output().shapes.iter();
        let mut plates = shapes.filter_map(|clipped| match &clipped.shape {
            egui::Shape::Rect(plate) if plate.fill.is_opaque() => Some(plate.rect),
            _ => None,
        });
        let around = words.place.expand(12.0);
        plates.any(|plate| plate.contains_rect(words.place) && around.contains_rect(plate))
    };
    let written = desk.written();
    let words = |begin: &str| {
        let mut found = written.iter().filter(|w| w.text.starts_with(begin));
        found.next().expect("words")
    };
    assert!(is_on_plate(words(&number)) && is_on_plate(words("level ")));
    let measured = picture(&mut desk, "measured.png");
    let changed = measured
        .pixels()
        .zip(bare.pixels())
        .filter(|(a, b)| a != b)
        .count();
    // A line of over 80 pixels, two dots, and letters.
    assert!(changed > 400, "{changed} pixels are different");
    // Where the line's ends are in the picture, it is pink.
    let looking = desk.open().looking;
    let seen = looking.size.expect("drawn");
    let view = looking.orbit.view();
    let size = glam::DVec2::new(640.0, 400.0);
    let view = view.reframed(seen, size);
    for point in [a, b, (a + b) * 0.5] {
        let at = view.project(point, size).expect("before the eye");
        let pixel = measured.get_pixel(at.x as u32, at.y as u32);
        let [r, g, b, _] = pixel.0;
        assert!(r > 150 && g < 140 && b > 100, "{pixel:?} at {at}");
    }
}

/// The photo that is laid over the surface is seen in its own colours: no tint of the selection lies
/// over it.
#[test]
fn the_selection_does_not_tint_the_photo_that_is_laid_over() {
    let mut desk = Desk::drawn(Some(&flight("assets/sample")), &screen([1000.0, 600.0]));
    desk.press(Modifiers::NONE, Key::T);
    let mut with = |fills: Scope, project: bool| {
        let layers = Layers {
            fills,
            project_photo: project,
            frusta: Scope::None,
            images: Scope::None,
            flight_line: false,
            ..Layers::default()
        };
        desk.harness.state_mut().apply(Command::Layers(layers));
        desk.settle();
        picture(&mut desk, "photo.png")
    };
    let untinted = with(Scope::Selected, true) == with(Scope::None, true);
    assert!(untinted);
    // Without a photo the tint says where the selected one looks.
    let tinted = with(Scope::Selected, false) != with(Scope::None, false);
    assert!(tinted);
}

/// Export stays in the first row, whatever verdicts there are.
#[test]
fn the_tool_bar_is_one_row() {
    let out = |photo| Command::Decide(photo, Some((DecisionKind::LeftOut, String::new())));
    for wide in [1130.0, 1280.0, 1366.0] {
        let mut desk = desk_of_size([wide, 800.0], "assets/sample");
        desk.settle();
        let table = desk.node(Role::Row, "Photo IMG_0001.jpg").rect().top();
        let check = desk.open().table.doubtful[0];
        let accepted = Command::Decide(check, Some((DecisionKind::Accepted, String::new())));
        let trusted = (0..).find(|photo| *photo != check).expect("a number");
        for (command, verdict) in [
            (None, "trust"),
            (Some(out(trusted)), "left out"),
            (Some(accepted), "accepted"),
        ] {
            if let Some(command) = command {
                desk.harness.state_mut().apply(command);
                desk.settle();
            }
            let name = format!("Only photos: {verdict}");
            assert!(desk.shows(Role::Button, &name), "{wide}: {verdict}");
            let middle = |name| desk.node(Role::Button, name).rect().center().y;
            let [open, export] = [middle("Open"), middle("Export chosen photos")];
            let said = format!("{wide}, {verdict}: {open} {export}");
            // The two rarer counts have no room in one row of the narrowest.
            if wide > 1200.0 || verdict == "trust" {
                assert!((open - export).abs() < 2.0, "{said}");
                let now = desk.node(Role::Row, "Photo IMG_0001.jpg").rect().top();
                assert!((table - now).abs() < 0.5, "{said}: {table} {now}");
            }
        }
    }
}

/// The units of the tool bar are those of scales: what is measured on the pile is in the unit of its coordinates, which is said.
#[test]
fn a_unit_says_what_is_in_it() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let place = desk.node(Role::RadioButton, "Pixels per in").rect();
    desk.harness.hover_at(place.center());
    for _ in 0..90 {
        desk.harness.step();
    }
    let said = "scales in pixels per in. Lengths and coordinates of the pile stay in m";
    let mut written = desk.written().into_iter();
    assert!(written.any(|written| written.text.contains(said)));
}

/// Where both panels leave nothing between them, the right one is there, and the left one once it is closed.
#[test]
fn a_very_narrow_window_has_one_panel_beside_the_viewport() {
    let mut desk = desk_of_size([450.0, 300.0], "assets/sample");
    desk.settle();
    for page in [Key::Num1, Key::Num3] {
        desk.press(Modifiers::COMMAND, page);
        let width = desk.viewport().width();
        assert!(width >= 180.0, "{width}");
    }
    desk.press(Modifiers::COMMAND, Key::Num1);
    assert!(!desk.says("9 of 9"));
    desk.press(Modifiers::NONE, Key::F3);
    assert!(desk.says("9 of 9"));
    desk.press(Modifiers::NONE, Key::F3);
    desk.harness.set_size(vec2(900.0, 600.0));
    desk.settle();
    assert!(desk.says("9 of 9"));
}

/// Whatever sizes the window has while a flight is read and drawn: no error of the graphics device is
/// told.
#[test]
fn resizing_while_loading_tells_no_error() {
    let path = flight("assets/sample");
    let mut desk = Desk::drawn(None, &screen([800.0, 500.0]));
    for round in 0..3 {
        desk.harness.state_mut().apply(Command::Open(path.clone()));
        for step in 0..120_u16 {
            let wide = f32::from(step * 37 % 700);
            let high = f32::from(step * 53 % 500);
            let size: Vec2 = match step % 10 {
                9 => vec2(1.0, 1.0),
                8 => vec2(640.0, 30.0),
                _ => vec2(400.0 + wide, 200.0 + high),
            };
            desk.harness.set_size(size);
            desk.harness.step();
            if step % 7 == 0 {
                let _ = desk.harness.render();
            }
            let log = &desk.harness.state().state().log;
            let told = log.iter().find(|line| line.text.contains("graphics"));
            assert!(told.is_none(), "round {round}, {size}: {told:?}");
        }
        desk.harness.set_size(vec2(800.0, 500.0));
        desk.settle();
        assert!(!desk.logged("graphics"));
    }
}

/// A sparse cloud has a few points kilometres away: Fit shows the pile, Fit all what is far off too.
#[test]
fn fit_leaves_outliers_out_and_fit_all_takes_them() {
    let folder = copy("tests/windrow");
    let cloud = folder.path().join("pile.ply");
    let text = std::fs::read(&cloud).expect("the cloud");
    let text = String::from_utf8(text).expect("a cloud of text");
    let count: usize = text
        .lines()
        .find_map(|line| line.strip_prefix("element vertex "))
        .and_then(|count| count.trim().parse().ok())
        .expect("a count");
    let more = text.replacen(
        &format!("element vertex {count}"),
        &format!("element vertex {}", count + 2),
        1,
    );
    let row = text.lines().last().expect("a point");
    let rest: Vec<&str> = row.split_whitespace().skip(3).collect();
    let far = |at: &str| format!("{at} {}\n", rest.join(" "));
    let more = more.trim_end().to_owned() + "\n" + &far("900 20 0.1") + &far("-30 700 -400");
    std::fs::write(&cloud, more).expect("written");
    let mut desk = Desk::new(Some(folder.path()));
    let usual = Desk::new(Some(&flight("tests/windrow")));
    let distance = |desk: &Desk| desk.open().looking.orbit.distance;
    let pile = distance(&usual);
    assert!((distance(&desk) / pile - 1.0).abs() < 0.3, "{pile}");
    // The ground is drawn under the pile, not under what lies 400 m deeper.
    assert!((desk.open().ground() - usual.open().ground()).abs() < 0.5);
    desk.click(Role::Button, "Show all points");
    assert!(distance(&desk) > 100.0 * pile);
    let place = desk.viewport();
    let size = glam::DVec2::new(f64::from(place.width()), f64::from(place.height()));
    for point in [
        glam::DVec3::new(900.0, 20.0, 0.1),
        glam::DVec3::new(-30.0, 700.0, -400.0),
    ] {
        let view = desk.open().looking.orbit.view();
        let seen = view.project(point, size).expect("before the eye");
        assert!(seen.cmpge(glam::DVec2::ZERO).all() && seen.cmple(size).all());
    }
    desk.press(Modifiers::NONE, Key::Home);
    assert!((distance(&desk) / pile - 1.0).abs() < 0.3);
    desk.press(Modifiers::SHIFT, Key::Home);
    assert!(distance(&desk) > 100.0 * pile);
    // Where there are no outliers there is no such button.
    assert!(!usual.shows(Role::Button, "Show all points"));
}

/// The flight line goes through the photos as they were taken, whatever order the poses are listed in: by
/// EXIF's time, by their names where the times are equal.
#[test]
fn the_flight_line_goes_by_time_or_name() {
    let folder = copy("assets/sample");
    let photos = folder.path().join("photos");
    copy_files("assets/sample/photos", &photos);
    let poses = folder.path().join("poses.csv");
    let text = std::fs::read_to_string(&poses).expect("the poses");
    let (head, rows) = text.split_once('\n').expect("a head");
    let mut rows: Vec<&str> = rows.lines().collect();
    rows.reverse();
    std::fs::write(&poses, format!("{head}\n{}\n", rows.join("\n"))).expect("written");
    let names = |desk: &Desk| -> Vec<String> {
        let line = desk.open().line.iter();
        line.map(|&photo| desk.open().name(photo).to_owned())
            .collect()
    };
    let desk = Desk::new(Some(folder.path()));
    let by_name: Vec<String> = (1..=9).map(|n| format!("IMG_000{n}.jpg")).collect();
    assert_eq!(names(&desk), by_name);
    // Taken the other way round, and the fifth last.
    let seconds = [9, 8, 7, 6, 59, 5, 4, 3, 2];
    for (name, second) in by_name.iter().zip(seconds) {
        let path = photos.join(name);
        let mut bytes = std::fs::read(&path).expect("a photo");
        let old = b"2017:01:01 12:00:00";
        let at = bytes.windows(old.len()).position(|w| w == old);
        let at = at.expect("its time");
        let new = format!("2017:01:01 12:00:{second:02}");
        bytes[at..at + new.len()].copy_from_slice(new.as_bytes());
        std::fs::write(&path, bytes).expect("written");
    }
    let desk = Desk::new(Some(folder.path()));
    let expected = [9, 8, 7, 6, 4, 3, 2, 1, 5].map(|n| format!("IMG_000{n}.jpg"));
    assert_eq!(names(&desk), expected);
}
