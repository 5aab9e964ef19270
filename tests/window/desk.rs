//! An engineer at the window: finds things by their names, clicks, types, waits for jobs.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, OutputCommand, Pos2, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use fragscale::app::App;
use fragscale::app::open_flight::OpenFlight;
use fragscale::render::Gpu;
use tempfile::TempDir;

/// A text as it is drawn, not as it is called.
pub struct Written {
    pub text: String,
    /// The text as it is broken into lines.
    pub rows: Vec<String>,
    /// Where its letters are.
    pub place: Rect,
    /// What of the window it may be drawn in.
    pub seen_in: Rect,
}

/// The longest that a job of these small flights may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// The window with somebody before it.
pub struct Desk {
    pub harness: Harness<'static, App>,
}

/// How the window is, where it is drawn.
pub struct Screen {
    pub size: [f32; 2],
    pub pixels_per_point: f32,
    pub theme: egui::Theme,
}

impl Desk {
    /// Without a graphics device: everything but the viewport's picture is there.
    pub fn new(path: Option<&Path>) -> Self {
        let path = path.map(Path::to_owned);
        let harness = Harness::builder()
            .with_size([1280.0, 720.0])
            .with_step_dt(1.0 / 60.0)
            .with_max_steps(30)
            .build_eframe(|context| App::new(context, path.into_iter().collect()));
        let mut desk = Self { harness };
        desk.settle();
        desk
    }

    /// Drawn by the processor.
    pub fn drawn(path: Option<&Path>, screen: &Screen) -> Self {
        // The fault names the package to install.
        drop(Gpu::headless().unwrap_or_else(|fault| panic!("{fault}")));
        let path = path.map(Path::to_owned);
        let harness = Harness::builder()
            .with_size(screen.size)
            .with_pixels_per_point(screen.pixels_per_point)
            .with_theme(screen.theme)
            .with_step_dt(1.0 / 60.0)
            .with_max_steps(30)
            .with_render_cursor(false)
            .wgpu()
            .build_eframe(|context| App::new(context, path.into_iter().collect()));
        let mut desk = Self { harness };
        desk.settle();
        desk
    }

    /// The flight on the screen.
    pub fn open(&self) -> &OpenFlight {
        self.harness
            .state()
            .state()
            .open
            .as_ref()
            .expect("a flight")
    }

    /// Waits until every job has ended and what it brought is on the screen.
    pub fn settle(&mut self) {
        let start = Instant::now();
        let mut quiet = 0;
        while quiet < 3 {
            self.harness.step();
            if self.harness.state().state().is_idle() {
                quiet += 1;
            } else {
                quiet = 0;
                assert!(start.elapsed() < PATIENCE, "a job does not end");
                std::thread::sleep(Duration::from_millis(2));
            }
        }
        self.harness.run();
    }

    /// Clicks what has this role and name, and lets the window answer.
    #[track_caller]
    pub fn click(&mut self, role: Role, name: &str) {
        self.bring_into_sight(role, name);
        self.node(role, name).click();
        self.settle();
    }

    /// Scrolls to a part that lies below the window's foot.
    #[track_caller]
    fn bring_into_sight(&mut self, role: Role, name: &str) {
        let node = self.node(role, name);
        // The status bar is under everything.
        let foot = self.harness.ctx.content_rect().bottom() - 30.0;
        if node.rect().bottom() > foot {
            node.scroll_to_me();
            self.harness.run();
        }
    }

    /// The one part of the window with this role and name.
    #[track_caller]
    pub fn node<'a>(&'a self, role: Role, name: &'a str) -> egui_kittest::Node<'a> {
        let mut found: Vec<_> = self
            .harness
            .query_all_by_role_and_label(role, name)
            .collect();
        let names = || -> Vec<Option<String>> {
            let all = self.harness.query_all_by_role(role);
            all.map(|node| node.accesskit_node().label()).collect()
        };
        assert_eq!(found.len(), 1, "{role:?} '{name}' among {:?}", names());
        found.remove(0)
    }

    /// Whether there is such a part.
    pub fn shows(&self, role: Role, name: &str) -> bool {
        self.harness
            .query_all_by_role_and_label(role, name)
            .next()
            .is_some()
    }

    /// Whether a text with these words is on the screen, with blanks that break or do not.
    pub fn says(&self, words: &str) -> bool {
        let words = words.replace('\u{a0}', " ");
        let texts = self.texts().into_iter();
        let mut texts = texts.map(|(text, _)| text.replace('\u{a0}', " "));
        texts.any(|text| text.contains(&words))
    }

    /// Every text on the screen, with its place.
    pub fn texts(&self) -> Vec<(String, Rect)> {
        let labels = self.harness.query_all_by_role(Role::Label);
        labels
            .map(|node| {
                let text = node.accesskit_node().value().unwrap_or_default();
                (text, node.rect())
            })
            .collect()
    }

    /// Every text that the last frame drew.
    pub fn written(&self) -> Vec<Written> {
        fn take(shape: &egui::Shape, seen_in: Rect, all: &mut Vec<Written>) {
            match shape {
                egui::Shape::Vec(shapes) => {
                    for shape in shapes {
                        take(shape, seen_in, all);
                    }
                }
                egui::Shape::Text(text) => all.push(Written {
                    text: text.galley.text().to_owned(),
                    rows: text.galley.rows.iter().map(|row| row.text()).collect(),
                    place: text.galley.mesh_bounds.translate(text.pos.to_vec2()),
                    seen_in,
                }),
                _ => {}
            }
        }
        let mut all = Vec::new();
        for clipped in &self.harness.output().shapes {
            take(&clipped.shape, clipped.clip_rect, &mut all);
        }
        all
    }

    /// The photos in the rows of the table, from above, with the texts of their cells.
    pub fn rows(&self) -> Vec<(String, Vec<String>)> {
        self.rows_of("Photo")
    }

    /// The same of the table whose rows are called like this.
    pub fn rows_of(&self, kind: &str) -> Vec<(String, Vec<String>)> {
        let rows = self.harness.query_all_by_role(Role::Row);
        let mut rows: Vec<(String, Rect)> = rows
            .map(|node| (node.accesskit_node().label().expect("a name"), node.rect()))
            .collect();
        rows.sort_by(|a, b| a.1.top().total_cmp(&b.1.top()));
        let texts = self.texts();
        let cells = |row: Rect| {
            let mut cells: Vec<&(String, Rect)> = texts
                .iter()
                .filter(|(_, place)| row.contains(place.center()))
                .collect();
            cells.sort_by(|a, b| a.1.left().total_cmp(&b.1.left()));
            cells.into_iter().map(|(text, _)| text.clone()).collect()
        };
        let cells_of = |(name, place): (String, Rect)| {
            let photo = name.strip_prefix(kind)?.trim_start();
            Some((photo.to_owned(), cells(place)))
        };
        rows.into_iter().filter_map(cells_of).collect()
    }

    /// The names of the photos in the table, from above.
    pub fn photos(&self) -> Vec<String> {
        self.rows().into_iter().map(|(photo, _)| photo).collect()
    }

    /// The name of the selected photo.
    pub fn selected(&self) -> &str {
        self.open().name(self.open().selected.expect("a photo"))
    }

    /// Presses keys, and lets the window answer.
    pub fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.settle();
    }

    /// Replaces what is in a field, and presses Enter.
    #[track_caller]
    pub fn fill(&mut self, name: &str, text: &str) {
        self.type_into(name, text);
        self.press(Modifiers::NONE, Key::Enter);
    }

    /// Replaces what is in a field, and leaves it without Enter, which may begin something.
    #[track_caller]
    pub fn fill_and_leave(&mut self, name: &str, text: &str) {
        self.type_into(name, text);
        self.harness.ctx.memory_mut(|memory| {
            if let Some(field) = memory.focused() {
                memory.surrender_focus(field);
            }
        });
        self.settle();
    }

    #[track_caller]
    fn type_into(&mut self, name: &str, text: &str) {
        self.bring_into_sight(Role::TextInput, name);
        self.node(Role::TextInput, name).click();
        self.harness.run();
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.key_press(Key::Backspace);
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.run();
    }

    /// Types a path into the small window that asks for one.
    pub fn type_path(&mut self, path: &Path) {
        let text = path.to_str().expect("a UTF-8 path");
        self.node(Role::TextInput, "Path").click();
        self.harness.run();
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.run();
    }

    /// One frame with these events in it; returns what went to the clipboard.
    pub fn frame(&mut self, events: impl IntoIterator<Item = Event>) -> Option<String> {
        self.harness.input_mut().events.extend(events);
        self.harness.step();
        self.copied()
    }

    /// What went to the clipboard in the last frame.
    pub fn copied(&self) -> Option<String> {
        let commands = &self.harness.output().platform_output.commands;
        commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    }

    /// What the window asked of the desktop in the last frame: its title, to close, ...
    pub fn asked(&self) -> Vec<egui::ViewportCommand> {
        self.harness.output().viewport_output[&egui::ViewportId::ROOT]
            .commands
            .clone()
    }

    /// Where the viewport is.
    pub fn viewport(&self) -> Rect {
        self.node(Role::Image, "Viewport").rect()
    }

    /// Clicks a place.
    pub fn click_at(&mut self, place: Pos2) {
        self.harness.hover_at(place);
        self.harness.drag_at(place);
        self.harness.drop_at(place);
        self.settle();
    }

    /// Whether the log has a line with these words.
    pub fn logged(&self, words: &str) -> bool {
        let log = &self.harness.state().state().log;
        log.iter().any(|line| line.text.contains(words))
    }
}

/// A flight of the sources.
pub fn flight(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A copy of a flight to change: its files without the photos.
pub fn copy(path: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    copy_files(path, folder.path());
    folder
}

/// Copies the files of a folder of the sources.
pub fn copy_files(path: &str, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(flight(path)).expect("the flight") {
        let from = entry.expect("an entry").path();
        if from.is_file() {
            let name = from.file_name().expect("a name");
            fs::copy(&from, to.join(name)).expect("a copy");
        }
    }
}
