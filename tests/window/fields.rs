//! Scale fields in the window: best lines, which pair goes to Split-Desktop, how sure the engineer says
//! she is, and the tinted photo. What is shown is what the command, or the core, computes.

use std::fs;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use fragscale::app::open_flight::tint::PhotoTint;
use fragscale::flight::Outcome;
use fragscale::jobs::Progress;
use fragscale::numbers::{significant_digits, with_interval};
use fragscale::scale::{ImageKind, PixelErrors, ScaleField, ScalePair};
use glam::{DVec2, DVec3};
use serde_json::Value;

use crate::common::scales_json;
use crate::desk::{Desk, copy, flight};

const SAMPLE: &str = "assets/sample";
const WINDROW: &str = "tests/windrow";

/// The photos of a flight as the command has them, pixels per centimetre.
fn from_command(path: &std::path::Path) -> Vec<Value> {
    let json = scales_json(path, &["--unit", "cm"]);
    json["photos"].as_array().expect("photos").clone()
}

/// Whether the number that a text begins with is this one, to the digits that are shown.
#[track_caller]
fn assert_begins_with(text: &str, value: f64) {
    let number = text.split(char::is_whitespace).next().expect("a word");
    let decimals = number.split_once('.').map_or(0, |(_, after)| after.len());
    let shown: f64 = number.parse().unwrap_or_else(|_| panic!("'{text}'"));
    let last = 10_f64.powi(-i32::try_from(decimals).expect("few"));
    assert!(
        (shown - value).abs() <= last * 0.500_001,
        "{text} for {value}"
    );
}

/// The text right of the one that says this, in its row.
#[track_caller]
fn right_of(desk: &Desk, name: &str) -> String {
    let texts = desk.texts();
    let (_, place) = texts
        .iter()
        .find(|(text, _)| text == name)
        .unwrap_or_else(|| panic!("no '{name}'"));
    let beside = texts.iter().filter(|(_, other)| {
        other.left() > place.right() - 1.0 && (other.center().y - place.center().y).abs() < 6.0
    });
    let next = beside.min_by(|a, b| a.1.left().total_cmp(&b.1.left()));
    next.expect("a text beside it").0.clone()
}

/// What follows these words in the text that begins with them.
#[track_caller]
fn after(desk: &Desk, words: &str) -> String {
    let texts = desk.texts().into_iter();
    let mut found = texts.filter_map(|(text, _)| Some(text.strip_prefix(words)?.to_owned()));
    found.next().unwrap_or_else(|| panic!("no '{words}'"))
}

#[test]
fn the_inspector_shows_the_best_line_of_the_command() {
    let mut desk = Desk::new(Some(&flight(SAMPLE)));
    for photo in from_command(&flight(SAMPLE)) {
        let name = photo["photo"].as_str().expect("a name");
        desk.click(Role::Row, &format!("Photo {name}"));
        let of = |key: &str| photo["fitted"][key].as_f64().expect("a number");
        for (words, end, scale) in [
            ("Top, px/cm", "fitted_top", of("top")),
            ("Bottom, px/cm", "fitted_bottom", of("bottom")),
        ] {
            // With the digits that its interval allows.
            let at = |key: &str| photo["uncertainty"][end][key].as_f64().expect("an end");
            let wanted = with_interval(scale, at("low"), at("high"));
            // It stands on one line: with blanks that do not break.
            assert_eq!(right_of(&desk, words).replace('\u{a0}', " "), wanted);
        }
        let not_counted = photo["uncertainty"]["not_counted"]
            .as_array()
            .expect("a list");
        let names: Vec<&str> = not_counted.iter().filter_map(Value::as_str).collect();
        assert!(!names.is_empty(), "nobody states anything of the sample");
        assert!(desk.says(&format!("{} not counted", names.join(", "))));
        let off = after(&desk, "Off the line ");
        assert_begins_with(&off, of("rms_percent"));
        let worst = off.split_once("rms, ").expect("the worst").1;
        assert_begins_with(worst, of("worst_percent"));
        assert_begins_with(&after(&desk, "Covered "), of("covered") * 100.0);
        assert_begins_with(&after(&desk, "Left to right "), of("left_right_percent"));
        // The corners' pair stands beside it.
        let corner = right_of(&desk, "Four corners:");
        let corner = corner.strip_prefix("top\u{a0}").expect("the top");
        assert_begins_with(corner, photo["scale"]["top"].as_f64().expect("a number"));
    }
}

#[test]
fn the_pair_for_split_desktop_is_chosen_and_undone() {
    let folder = copy(WINDROW);
    let mut desk = Desk::new(Some(folder.path()));
    let copied = |desk: &Desk| {
        desk.harness
            .state()
            .state()
            .scales_to_copy()
            .expect("two scales")
    };
    let photo = from_command(folder.path()).remove(0);
    let pair = |of: &str| {
        let end = |edge: &str| significant_digits(photo[of][edge].as_f64().expect("a number"), 6);
        format!("{}\t{}", end("top"), end("bottom"))
    };
    assert_eq!(copied(&desk), pair("fitted"));
    let (outcomes, settled) = (desk.open().review.outcomes().clone(), desk.rows());
    desk.click(Role::Tab, "Flight");
    desk.click(Role::RadioButton, "four corners");
    assert_eq!(copied(&desk), pair("scale"));
    assert_eq!(desk.open().flight().parts().pair, ScalePair::Corners);
    assert!(desk.open().is_changed());
    // Nothing was computed anew for it: the outcomes are not only equal, they are the same ones.
    assert!(std::sync::Arc::ptr_eq(
        desk.open().review.outcomes(),
        &outcomes
    ));
    desk.click(Role::Button, "Save settings");
    let text = fs::read_to_string(folder.path().join("flight.toml")).expect("the flight");
    assert!(text.contains("use = \"corners\""), "{text}");
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(copied(&desk), pair("fitted"));
    assert_eq!(desk.open().flight().parts().pair, ScalePair::Fitted);
    assert_eq!(desk.rows(), settled);
}

#[test]
fn errors_are_typed_saved_and_undone() {
    let folder = copy(WINDROW);
    let mut desk = Desk::new(Some(folder.path()));
    let before = desk.open().review.outcomes().clone();
    desk.click(Role::Tab, "Flight");
    let errors = |desk: &Desk| {
        let of_settings = desk.open().settings().errors;
        assert_eq!(desk.open().flight().parts().errors, of_settings);
        of_settings
    };
    let at_first = errors(&desk);
    desk.fill("Standard deviation of camera positions", "0,02");
    assert_eq!(errors(&desk).pose.position, Some(DVec3::splat(0.02)));
    desk.fill("Standard deviation of camera angles", "0.1 0.1 0.2");
    assert_eq!(errors(&desk).pose.angle, Some(DVec3::new(0.1, 0.1, 0.2)));
    desk.fill("Standard deviation of the world's scale", "0.3");
    desk.fill("Standard deviation of focal lengths", "0.05");
    desk.fill("Standard deviation of the surface", "0.004");
    let all = errors(&desk);
    assert_eq!(
        (all.world_scale, all.focal, all.surface),
        (Some(0.3), Some(0.05), Some(0.004))
    );
    // No scale depends on it; what does has been computed anew.
    assert!(std::sync::Arc::ptr_eq(
        desk.open().review.outcomes(),
        &before
    ));
    assert!(desk.open().review.is_looked_at());
    // 0.3 % of all lengths is half of a 95 % interval of 0.588 %.
    assert!(desk.says("all scales share ± 0.6 %"));
    // What is none is said, and changes nothing.
    desk.fill("Standard deviation of the surface", "-1");
    assert_eq!(errors(&desk), all);
    assert!(desk.logged("Surface: '-1' is no standard deviation"));
    desk.click(Role::Button, "Save settings");
    let text = fs::read_to_string(folder.path().join("flight.toml")).expect("the flight");
    for line in [
        "position = 0.02",
        "angle = [0.1, 0.1, 0.2]",
        "world_scale = 0.3",
        "focal = 0.05",
    ] {
        assert!(text.contains(line), "no {line} in {text}");
    }
    // Emptied, it is not stated.
    desk.fill("Standard deviation of the surface", "");
    assert_eq!(errors(&desk).surface, None);
    for _ in 0..6 {
        desk.press(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(errors(&desk), at_first);
    let outcomes: &[Outcome] = desk.open().review.outcomes();
    assert_eq!(outcomes, &before[..]);
}

/// What the line under the photo says of the place under the mouse.
fn at_cursor(desk: &mut Desk, at: Pos2) -> Option<String> {
    desk.harness.hover_at(at);
    desk.harness.run();
    let texts = desk.texts().into_iter().map(|(text, _)| text);
    let mut found = texts.filter(|text| text.ends_with("at the cursor"));
    found.next()
}

#[test]
fn the_photo_is_tinted_by_its_scale_field() {
    let mut desk = Desk::new(Some(&flight(SAMPLE)));
    let name = desk.selected().to_owned();
    let legend = |desk: &Desk| {
        let images = desk.harness.query_all_by_role(Role::Image);
        let mut names = images.filter_map(|node| node.accesskit_node().label());
        names.find(|name| name.starts_with("Legend"))
    };
    assert!(legend(&desk).is_none() && desk.open().tint.is_none());
    desk.click(Role::Button, "Tint by scale");
    let tint = desk.open().tint.as_ref().expect("a field");
    assert_eq!(tint.photo, 0);
    let flight = desk.open().flight().clone();
    let parts = flight.parts();
    let (photo, camera) = (&parts.photos[0], &parts.cameras[parts.photos[0].camera]);
    let grid = PhotoTint::grid(camera);
    assert_eq!(grid.columns, 320);
    let field = ScaleField::compute(
        camera,
        &photo.pose,
        ImageKind::Undistorted,
        grid,
        &parts.surface,
        &Progress::default(),
    );
    let field = field.expect("a field");
    let errors = PixelErrors::new(&field, &flight.errors(photo), &parts.surface);
    let errors = errors.expect("the cloud says how rough it is");
    let (size, metre) = (
        DVec2::new(f64::from(camera.width), f64::from(camera.height)),
        100.0,
    );
    let frame = desk
        .node(Role::Image, &format!("Photo {name} with its scale"))
        .rect();
    // The photo is fitted into its frame.
    let aspect = (size.x / size.y) as f32;
    let shown = match frame.width() / frame.height() > aspect {
        true => egui::vec2(frame.height() * aspect, frame.height()),
        false => egui::vec2(frame.width(), frame.width() / aspect),
    };
    let place = egui::Rect::from_center_size(frame.center(), shown);
    for (column, row) in [(40, 60), (160, 120), (301, 17), (250, grid.rows - 9)] {
        let pixel = grid.pixel(camera, column, row) / size;
        let at = place.min + egui::vec2(pixel.x as f32, pixel.y as f32) * place.size();
        let wanted = field.scale_at(column, row).expect("a scale") / metre;
        let said = at_cursor(&mut desk, at).expect("a scale");
        let interval = errors.at(&field, column, row).expect("an interval");
        let [low, high] = [interval.low, interval.high].map(|end| end / metre);
        let wanted = with_interval(wanted, low, high);
        assert_eq!(said, format!("{wanted} px/cm at the cursor"));
        // A stone at the cursor is known to some per cents, and that is said.
        assert!(wanted.contains('±') || wanted.contains(" to "), "{wanted}");
    }
    let all = (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (column, row)));
    let mut scales: Vec<f64> = all.filter_map(|(c, r)| field.scale_at(c, r)).collect();
    scales.sort_by(f64::total_cmp);
    // 2 % lie below the first colour, 2 % above the last.
    let beyond = (scales.len() - 1) / 50;
    let ends = [scales[beyond], scales[scales.len() - 1 - beyond]];
    let ends = ends.map(|end| significant_digits(end / metre, 4));
    let wanted = format!("Legend: {} to {} px/cm", ends[0], ends[1]);
    assert_eq!(legend(&desk), Some(wanted));
    // Another photo has another field; the key takes the tint away.
    desk.click(Role::Row, "Photo IMG_0005.jpg");
    assert_eq!(
        desk.open().tint.as_ref().map(|tint| tint.photo),
        desk.open().selected
    );
    desk.press(Modifiers::NONE, Key::I);
    assert!(legend(&desk).is_none());
    assert!(at_cursor(&mut desk, place.center()).is_none());
}
