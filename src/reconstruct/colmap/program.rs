//! The program `colmap`: found on the path, run with what it says, cancelled with all that it started.

use std::collections::VecDeque;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

#[cfg(windows)]
use process_wrap::std::JobObject;
#[cfg(unix)]
use process_wrap::std::ProcessGroup;
use process_wrap::std::{ChildWrapper, CommandWrap};

use super::setting::Setting;
use crate::fault::Fault;
use crate::jobs::Progress;

/// How it is called: on Windows by a script beside the program.
const NAMES: [&str; 3] = ["colmap", "colmap.exe", "COLMAP.bat"];

/// How often cancelling is asked for while it says nothing.
const ASK: Duration = Duration::from_millis(100);

/// Lines of its words that are kept to say why it ended.
const LAST_LINES: usize = 20;

/// An installed COLMAP.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Program {
    path: PathBuf,
    /// "COLMAP 3.8".
    pub(super) version: String,
    /// Whether it was built with CUDA.
    pub(super) has_cuda: bool,
}

impl Program {
    /// The one on the path.
    ///
    /// # Errors
    /// Where there is none, or where it does not start.
    pub(super) fn on_path() -> Result<Self, Fault> {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        let found = std::env::split_paths(&folders)
            .flat_map(|folder| NAMES.map(|name| folder.join(name)))
            .find(|path| path.is_file());
        let found = found.ok_or_else(|| {
            Fault::new(
                "COLMAP is not installed: no folder of PATH has `colmap`",
                "install it (Debian: apt install colmap), or take the embedded engine",
            )
        })?;
        Self::at(&found)
    }

    /// The one at a path.
    ///
    /// # Errors
    /// Where it does not start, or is another program.
    pub(super) fn at(path: &Path) -> Result<Self, Fault> {
        let mut program = Self {
            path: path.to_owned(),
            version: String::new(),
            has_cuda: false,
        };
        let help = program.said_of(&[OsStr::new("help")])?;
        // "COLMAP 3.8 -- Structure-from-Motion and Multi-View Stereo", before 4 with a commit below.
        let version = help.lines().find_map(|line| {
            let from = line.find("COLMAP ")?;
            let words: Vec<&str> = line[from..].split_whitespace().take(2).collect();
            Some(words.join(" "))
        });
        program.version = version.ok_or_else(|| {
            let what = format!("{} is no COLMAP: its help does not say so", path.display());
            Fault::new(what, "take it from PATH, or take the embedded engine")
        })?;
        program.has_cuda = help.contains("with CUDA");
        Ok(program)
    }

    /// What a command says of its options.
    ///
    /// # Errors
    /// Where it does not start.
    pub(super) fn help(&self, command: &str) -> Result<String, Fault> {
        self.said_of(&[OsStr::new(command), OsStr::new("-h")])
    }

    fn said_of(&self, arguments: &[&OsStr]) -> Result<String, Fault> {
        let output = Command::new(&self.path)
            .args(arguments)
            .stdin(Stdio::null())
            .output();
        let output = output.map_err(|error| self.does_not_start(&error))?;
        let both = [output.stdout, output.stderr].concat();
        Ok(String::from_utf8_lossy(&both).into_owned())
    }

    fn does_not_start(&self, error: &std::io::Error) -> Fault {
        let what = format!("{} does not start ({error})", self.path.display());
        Fault::new(what, "install COLMAP anew, or take the embedded engine")
    }

    /// Runs a command to its end; `said` gets each line that it prints.
    ///
    /// # Errors
    /// Where it does not start, where it ends with an error (with its last words), or where the work was
    /// cancelled: it and all that it started have ended then.
    pub(super) fn run(
        &self,
        command: &str,
        settings: &[Setting],
        mut said: impl FnMut(&str),
        progress: &Progress,
    ) -> Result<(), Fault> {
        let mut command_line = CommandWrap::with_new(&self.path, |line| {
            line.arg(command)
                .stdin(Stdio::null())
                .stdout(Stdio::piped())
                .stderr(Stdio::piped());
            for setting in settings {
                line.arg(format!("--{}", setting.option))
                    .arg(&setting.value);
            }
        });
        #[cfg(unix)]
        command_line.wrap(ProcessGroup::leader());
        #[cfg(windows)]
        command_line.wrap(JobObject);
        let child = command_line.spawn();
        let mut child = child.map_err(|error| self.does_not_start(&error))?;
        let (sender, lines) = channel();
        listen(child.stdout().take(), sender.clone());
        listen(child.stderr().take(), sender);
        let mut last = VecDeque::new();
        loop {
            if progress.is_cancelled() {
                ended(&mut *child)?;
                return progress.advance(0, 1);
            }
            match lines.recv_timeout(ASK) {
                Ok(line) => {
                    said(&line);
                    if !line.trim().is_empty() {
                        last.push_back(line);
                    }
                    if last.len() > LAST_LINES {
                        last.pop_front();
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                // Both of its mouths are shut: it ends.
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        let status = child.wait().map_err(|error| self.does_not_start(&error))?;
        match status.success() {
            true => Ok(()),
            false => {
                let what = format!("COLMAP's {command} failed ({status}): {}", why(&last));
                let remedy = "leave out photos of other things, or take the embedded engine";
                Err(Fault::new(what, remedy))
            }
        }
    }
}

/// Sends the lines of a stream from a thread of its own.
fn listen(stream: Option<impl Read + Send + 'static>, sender: Sender<String>) {
    let Some(stream) = stream else { return };
    thread::spawn(move || {
        let mut reader = BufReader::new(stream);
        let mut line = Vec::new();
        while reader.read_until(b'\n', &mut line).is_ok_and(|n| n > 0) {
            let text = String::from_utf8_lossy(&line).trim_end().to_owned();
            if sender.send(text).is_err() {
                return;
            }
            line.clear();
        }
    });
}

/// Ends it with all that it started.
fn ended(child: &mut dyn ChildWrapper) -> Result<(), Fault> {
    let end = child.start_kill().and_then(|()| child.wait());
    end.map(|_| ()).map_err(|error| {
        let what = format!("COLMAP cannot be ended ({error})");
        Fault::new(what, "end it by the system's task manager")
    })
}

/// The line that says why: the last that speaks of an error, or the last.
fn why(last: &VecDeque<String>) -> String {
    let speaks = |line: &&String| {
        let line = line.to_lowercase();
        ["error", "fail", "check failed", "abort"]
            .iter()
            .any(|word| line.contains(word))
    };
    let line = last.iter().rev().find(speaks).or(last.back());
    line.map_or_else(
        || "it says nothing".to_owned(),
        |line| line.trim().to_owned(),
    )
}
