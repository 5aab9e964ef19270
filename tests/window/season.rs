//! A season of blasts in the window: its flights are listed, done, and opened.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command as Process;

use egui::accesskit::Role;
use fragscale::app::command::{Asking, Command};
use fragscale::app::season::{FlightState, SeasonStep};
use fragscale::app::tasks::work::Task;
use fragscale::batch::Outcome;
use tempfile::TempDir;

use crate::desk::{Desk, Screen};

const PROGRAM: &str = env!("CARGO_BIN_EXE_fragscale");

/// The bundled flight without photo files.
fn sample(folder: &Path) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    fs::create_dir_all(folder).expect("a folder");
    for name in ["ost.yaml", "pile.ply", "poses.csv"] {
        fs::copy(sample.join(name), folder.join(name)).expect("a copy");
    }
    let text = fs::read_to_string(sample.join("flight.toml")).expect("a flight");
    let lines = text.lines().filter(|line| !line.starts_with("folder"));
    let text: String = lines.flat_map(|line| [line, "\n"]).collect();
    fs::write(folder.join("flight.toml"), text).expect("written");
}

/// Two flights that can be done, and one that cannot.
fn season() -> (TempDir, PathBuf) {
    let root = tempfile::tempdir().expect("a folder");
    let flights = root.path().join("2026");
    for name in ["05-01", "05-08"] {
        sample(&flights.join(name));
    }
    fs::create_dir_all(flights.join("05-15")).expect("a folder");
    fs::write(flights.join("05-15/flight.toml"), "format = 1\nwrold = 3\n").expect("written");
    (root, flights)
}

/// The small window, with this folder in it.
fn with_season(desk: &mut Desk, flights: &Path) {
    let program = SeasonStep::Program(PathBuf::from(PROGRAM));
    desk.harness.state_mut().apply(Command::Season(program));
    desk.harness
        .state_mut()
        .apply(Command::Season(SeasonStep::Ask));
    desk.settle();
    let text = flights.to_str().expect("UTF-8");
    desk.fill("SEASON.toml or folder of flights", text);
}

fn states(desk: &Desk) -> Vec<&'static str> {
    let season = &desk.harness.state().state().season;
    season.states.iter().map(FlightState::in_words).collect()
}

#[test]
fn a_season_is_listed_done_and_opened() {
    let (root, flights) = season();
    let mut desk = Desk::new(None);
    with_season(&mut desk, &flights);
    assert_eq!(states(&desk), ["waiting"; 3]);
    assert!(desk.says("05-08"));
    // Without colours of photos: there are no photos.
    desk.click(Role::CheckBox, "Step check");
    desk.click(Role::Button, "Start season");
    assert_eq!(states(&desk), ["done", "done", "failed"]);
    assert!(desk.says("2 done, 0 as before, 1 failed"));
    let results = root.path().join("2026 results");
    assert!(results.join("season.html").is_file());
    assert!(results.join("05-01/scales.csv").is_file());
    assert!(!results.join("05-01/check.txt").exists());
    // The same files as those of the command; it finds them done.
    let again = Process::new(PROGRAM)
        .arg("batch")
        .arg(&flights)
        .args(["--steps", "scales", "--to"])
        .arg(&results)
        .output()
        .expect("it starts");
    let said = String::from_utf8_lossy(&again.stderr).into_owned();
    assert_eq!(said.matches("as before  05").count(), 2, "{said}");

    // The one that failed says why.
    desk.click(Role::Row, "Flight 05-15, failed");
    assert!(desk.says("unknown key 'wrold'"));
    // Again: what is done is not done again.
    desk.click(Role::Button, "Start season");
    assert_eq!(states(&desk), ["as before", "as before", "failed"]);
    // In a new window what was done earlier is seen at once.
    let mut desk = Desk::new(None);
    with_season(&mut desk, &flights);
    assert_eq!(states(&desk), ["done earlier", "done earlier", "waiting"]);
    desk.click(Role::Row, "Flight 05-08, done earlier");
    desk.click(Role::Button, "Open the selected flight");
    let open = desk.open();
    assert_eq!(open.review.count(), 9);
    assert_eq!(desk.harness.state().state().asking, None);
}

/// What `fragscale batch` says of these flights, with these steps.
fn batch(flights: &Path, steps: &str, to: &Path) -> String {
    let ended = Process::new(PROGRAM)
        .arg("batch")
        .arg(flights)
        .args(["--steps", steps, "--to"])
        .arg(to)
        .output()
        .expect("it starts");
    String::from_utf8_lossy(&ended.stderr).into_owned()
}

/// What an earlier run wrote and this one does not is gone, which the small window says in the words of the command.
#[test]
fn what_a_season_takes_away_is_said() {
    let (root, flights) = season();
    let to = root.path().join("2026 results");
    let by_command = root.path().join("by command");
    for folder in [&to, &by_command] {
        batch(&flights, "scales,check", folder);
        assert!(folder.join("05-01/check.txt").is_file());
    }
    let mut desk = Desk::new(None);
    with_season(&mut desk, &flights);
    desk.click(Role::CheckBox, "Step check");
    desk.click(Role::Button, "Start season");
    assert!(!to.join("05-01/check.txt").exists());
    let away = &desk.harness.state().state().season.taken_away;
    let said: Vec<String> = away.lines().collect();
    assert!(!said.is_empty());
    let of_command = batch(&flights, "scales", &by_command);
    let of_command: Vec<&str> = of_command
        .lines()
        .filter(|line| line.contains("taken away: "))
        .collect();
    assert_eq!(said.len(), of_command.len(), "{of_command:?}");
    for (line, of_command) in said.iter().zip(of_command) {
        assert!(of_command.ends_with(line), "{line} | {of_command}");
        assert!(desk.says(line) && desk.logged(line), "{:?}", desk.texts());
    }
    // Nothing is taken away twice.
    desk.click(Role::Button, "Start season");
    assert!(!desk.says("taken away: "));
}

/// Whether the box of psd says these words once the mouse rests on it.
fn psd_says(desk: &mut Desk, words: &str) -> bool {
    let place = desk.node(Role::CheckBox, "Step psd").rect().center();
    // What was clicked or typed on is left first.
    desk.harness.hover_at(place - egui::vec2(2.0, 0.0));
    desk.harness.step();
    desk.harness.hover_at(place);
    for _ in 0..60 {
        desk.harness.step();
    }
    desk.says(words)
}

/// A reference is named in SEASON.toml alone: where no flight has one, nobody chooses psd unwarned.
#[test]
fn the_box_of_psd_says_where_no_flight_has_a_reference() {
    let (root, flights) = season();
    let mut desk = Desk::new(None);
    with_season(&mut desk, &flights);
    let said = "No flight found has a reference";
    assert!(psd_says(&mut desk, said), "{:?}", desk.texts());
    let file = root.path().join("season.toml");
    let text = "format = 1\n[[flight]]\npath = \"2026/05-01\"\nreference = \"sieve.csv\"\n";
    fs::write(&file, text).expect("written");
    desk.fill(
        "SEASON.toml or folder of flights",
        file.to_str().expect("UTF-8"),
    );
    assert_eq!(states(&desk), ["waiting"]);
    assert!(psd_says(&mut desk, "held against a reference"));
    assert!(!desk.says(said));
}

#[test]
fn what_is_no_season_is_said() {
    let (root, _flights) = season();
    let mut desk = Desk::new(None);
    with_season(&mut desk, &root.path().join("nowhere"));
    assert!(desk.says("There is no such file or folder"));
    let file = root.path().join("season.toml");
    fs::write(
        &file,
        "format = 1\n[[flight]]\npath = \"2026\"\nnmae = \"x\"\n",
    )
    .expect("written");
    desk.fill(
        "SEASON.toml or folder of flights",
        file.to_str().expect("UTF-8"),
    );
    assert!(desk.says("unknown key 'nmae'"));
    fs::write(
        &file,
        "format = 1\nto = \"out\"\nsteps = [\"scales\"]\n[[flight]]\npath = \"2026\"\n",
    )
    .expect("written");
    desk.fill("SEASON.toml or folder of flights", "");
    desk.fill(
        "SEASON.toml or folder of flights",
        file.to_str().expect("UTF-8"),
    );
    let season = &desk.harness.state().state().season;
    assert_eq!(
        season.season().expect("a season").to,
        root.path().join("out")
    );
    assert_eq!(states(&desk).len(), 3);
    // Results do not go among files of others.
    let full = root.path().join("full");
    fs::create_dir_all(&full).expect("a folder");
    fs::write(full.join("mine.txt"), "x").expect("written");
    desk.fill("Folder of the results", full.to_str().expect("UTF-8"));
    desk.click(Role::Button, "Start season");
    assert!(
        desk.says("it is not empty"),
        "{:?}",
        desk.harness.state().state().season.ended
    );
    assert_eq!(desk.harness.state().state().asking, Some(Asking::Season));
}

/// Cancelled, the window is free at once; the next run goes on.
#[test]
fn a_season_is_cancelled_and_goes_on() {
    let (_root, flights) = season();
    let mut desk = Desk::new(None);
    with_season(&mut desk, &flights);
    desk.node(Role::Button, "Start season").click();
    desk.harness.run_steps(2);
    assert!(desk.harness.state().state().work.is_running(Task::SEASON));
    desk.harness
        .state_mut()
        .apply(Command::Cancel(Task::SEASON));
    desk.harness.run_steps(2);
    assert!(!desk.harness.state().state().work.is_running(Task::SEASON));
    assert!(desk.says("Cancelled. What is done stays"));
    desk.click(Role::Button, "Start season");
    let season = &desk.harness.state().state().season;
    let ended = |state: &FlightState| matches!(state, FlightState::Ended(outcome, _) if *outcome != Outcome::Failed);
    assert_eq!(
        season.states.iter().filter(|state| ended(state)).count(),
        2,
        "{:?}",
        season.ended
    );
}

/// To be looked at: `SEASON_PICTURES=DIR cargo test -p fragscale --test window season_pictures -- --ignored`.
#[test]
#[ignore = "draws pictures to be looked at"]
fn season_pictures() {
    let folder = PathBuf::from(std::env::var("SEASON_PICTURES").expect("a folder"));
    let (_root, flights) = season();
    for (name, size, pixels_per_point, theme) in [
        ("light", [1280.0, 800.0], 1.0, egui::Theme::Light),
        ("dark", [1280.0, 800.0], 1.0, egui::Theme::Dark),
        ("small", [800.0, 600.0], 1.0, egui::Theme::Light),
        ("double", [1000.0, 700.0], 2.0, egui::Theme::Dark),
    ] {
        let screen = Screen {
            size,
            pixels_per_point,
            theme,
        };
        let mut desk = Desk::drawn(None, &screen);
        with_season(&mut desk, &flights);
        desk.click(Role::Button, "Start season");
        desk.click(Role::Row, "Flight 05-15, failed");
        let picture = desk.harness.render().expect("a picture");
        picture
            .save(folder.join(format!("{name}.png")))
            .expect("saved");
    }
}
