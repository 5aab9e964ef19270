//! The clipboard, between the real window and another program: on a screen of Xvfb that nobody sees,
//! with xdotool's keys and xclip as the other program. Left out, and said, where one of them is
//! missing; `tests/run` installs them.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// The longest that the window may take for an answer on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// After that the keys were pressed too early, and are pressed again.
const ANSWER: Duration = Duration::from_secs(5);

/// Between two looks.
const PAUSE: Duration = Duration::from_millis(100);

/// A screen with the window on it; both end with it.
struct Screen {
    server: Child,
    window: Option<Child>,
    /// `:7`.
    name: String,
    /// What the window remembers goes here, not to the tester's own folder.
    home: TempDir,
}

impl Drop for Screen {
    fn drop(&mut self) {
        for child in self.window.iter_mut().chain([&mut self.server]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

impl Screen {
    /// A free screen; `None` where a program for it is missing.
    fn new() -> Option<Self> {
        for program in ["Xvfb", "xdotool", "xclip"] {
            let found = Command::new(program)
                .arg("-version")
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .status();
            if found.is_err() {
                println!("left out: no {program}");
                return None;
            }
        }
        // The server itself looks for a free number, and says it when it is ready.
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24"])
            .args(["-nolisten", "tcp", "-noreset"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        let output = server.stdout.take().expect("a pipe");
        let read = BufReader::new(output).read_line(&mut number);
        let screen = Self {
            server,
            window: None,
            name: format!(":{}", number.trim()),
            home: TempDir::new().expect("a folder"),
        };
        assert!(read.is_ok() && screen.name.len() > 1, "Xvfb is not ready");
        Some(screen)
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command
            .env("DISPLAY", &self.name)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env_remove("XAUTHORITY")
            .env("HOME", self.home.path())
            .env("XDG_DATA_HOME", self.home.path())
            .env("XDG_CONFIG_HOME", self.home.path())
            .env("XDG_RUNTIME_DIR", self.home.path());
        command
    }

    /// Opens the window with this file, and gives it the keys.
    fn open(&mut self, file: &Path) {
        let mut window = self.command(env!("CARGO_BIN_EXE_fragscale"));
        let window = window.arg(file).stdin(Stdio::null()).spawn();
        self.window = Some(window.expect("the window starts"));
        self.until("the window is there", Self::focus);
    }

    /// Whether there is a window, which has the keys then.
    fn focus(&mut self) -> bool {
        let window = self.window.as_mut().expect("a window");
        let ended = window.try_wait().expect("its state");
        assert_eq!(ended, None, "the window has closed itself");
        let search = ["search", "--onlyvisible", "--name", "fragscale"];
        let found = self.said_by("xdotool", &search);
        let Some(id) = found.lines().next() else {
            return false;
        };
        // Without a window manager nobody else gives it the keys.
        self.runs("xdotool", &["windowfocus", "--sync", id])
    }

    /// Presses these keys in the window.
    fn press(&mut self, keys: &str) {
        self.until("the window has the keys", Self::focus);
        assert!(self.runs("xdotool", &["key", "--clearmodifiers", keys]));
    }

    fn runs(&self, program: &str, arguments: &[&str]) -> bool {
        let ran = self.command(program).args(arguments).output();
        ran.expect("it starts").status.success()
    }

    fn said_by(&self, program: &str, arguments: &[&str]) -> String {
        let output = self.command(program).args(arguments).output();
        let output = output.expect("it starts");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// What another program gets when it pastes.
    fn pasted_elsewhere(&self) -> String {
        self.said_by("xclip", &["-o", "-selection", "clipboard"])
    }

    /// Another program copies this.
    fn copy_elsewhere(&mut self, text: &str) {
        // xclip goes to the background and answers from there: it must not hold a pipe of ours.
        let mut clip = self
            .command("xclip")
            .args(["-i", "-selection", "clipboard"])
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("xclip starts");
        let mut input = clip.stdin.take().expect("a pipe");
        input.write_all(text.as_bytes()).expect("taken");
        drop(input);
        assert!(clip.wait().expect("it ends").success());
        self.until("another program has copied", |screen| {
            screen.pasted_elsewhere() == text
        });
    }

    fn until(&mut self, what: &str, mut is_so: impl FnMut(&mut Self) -> bool) {
        let start = Instant::now();
        while !is_so(self) {
            assert!(start.elapsed() < PATIENCE, "not in time: {what}");
            std::thread::sleep(PAUSE);
        }
    }
}

fn sample() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample"))
}

#[test]
fn a_copied_scale_reaches_another_program() {
    let Some(mut screen) = Screen::new() else {
        return;
    };
    // What the command line says of the first photo, which the window selects.
    let flight = sample().join("flight.toml");
    let told = crate::common::scales_json(&flight, &[]);
    let photo = &told["photos"][0];
    // The pair that goes to Split-Desktop.
    let edges = ["top", "bottom"].map(|edge| photo["fitted"][edge].as_f64().expect("a scale"));
    screen.open(&flight);
    screen.until("a scale is copied", |screen| {
        screen.press("ctrl+shift+c");
        let copied = screen.pasted_elsewhere();
        let numbers: Vec<f64> = copied
            .split('\t')
            .filter_map(|number| number.parse().ok())
            .collect();
        if numbers.len() != 2 {
            return false;
        }
        // Six digits are copied.
        for (number, edge) in numbers.iter().zip(edges) {
            assert!((number / edge - 1.0).abs() < 1e-5, "{copied} for {edges:?}");
        }
        true
    });
}

#[test]
fn a_table_of_another_program_is_pasted() {
    let Some(mut screen) = Screen::new() else {
        return;
    };
    let table = "size_mm\tpercent_passing\n16\t12.5\n31.5\t40\n63\t100\n";
    screen.open(&sample().join("distributions.csv"));
    // What comes back has a letter more, so that it can only come from the window.
    let typed_on = format!("{table}x");
    screen.until("the table is in the window", |screen| {
        screen.copy_elsewhere(table);
        // Onto the page first, which opens the small window for tables; then again over what its
        // field holds, which comes to the same.
        for keys in ["ctrl+v", "ctrl+a", "ctrl+v", "x", "ctrl+a", "ctrl+c"] {
            screen.press(keys);
        }
        let start = Instant::now();
        while start.elapsed() < ANSWER {
            if screen.pasted_elsewhere() == typed_on {
                return true;
            }
            std::thread::sleep(PAUSE);
        }
        // The page was not there yet.
        false
    });
}
