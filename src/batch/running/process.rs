//! The process of one flight.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::Sender;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::fault::{Fault, one_line};
use crate::memory;
use crate::told::{FlightDone, FlightTold, SaidLine};

/// The hidden command.
pub const COMMAND: &str = "batch-flight";

/// How long a process has to end by itself. It takes away what is half written.
const GRACE: Duration = Duration::from_secs(3);

/// How much is kept of what a process says before it breaks.
const MOST_SAID: usize = 16 << 10;

/// What is heard of a process.
pub(super) enum Heard {
    /// It said something.
    Line(SaidLine),
    /// It says no more.
    Closed,
}

/// What is started.
pub(super) struct Start<'a> {
    /// The command `fragscale`.
    pub(super) program: &'a Path,
    /// By which the process is known.
    pub(super) number: u64,
    /// The flight's place.
    pub(super) flight: usize,
    /// Bytes, as estimated.
    pub(super) need: u64,
    /// How many run at once, at most.
    pub(super) jobs: usize,
}

/// A process under way. Where this is dropped its standard input closes, and it ends.
pub(super) struct FlightProcess {
    pub(super) number: u64,
    pub(super) flight: usize,
    /// Bytes, as estimated.
    pub(super) need: u64,
    /// What it said last.
    pub(super) done: Option<FlightDone>,
    child: Child,
    input: Option<ChildStdin>,
    errors: Option<JoinHandle<String>>,
}

impl FlightProcess {
    /// Starts the process of a flight, which is told what to do; what it says is handed on.
    pub(super) fn start(
        start: &Start<'_>,
        told: &FlightTold,
        say: Sender<(u64, Heard)>,
    ) -> Result<Self, Fault> {
        let told = serde_json::to_string(told)
            .map_err(|_| Fault::new("its path is not Unicode", "rename it"))?;
        let cannot = |error: std::io::Error| {
            let what = format!("no process can be started for it ({error})");
            Fault::new(what, "close other programs")
        };
        let mut command = Command::new(start.program);
        command.arg(COMMAND);
        let cores = thread::available_parallelism().map_or(1, usize::from);
        // Several at once share the processors.
        command.env("RAYON_NUM_THREADS", (cores / start.jobs).max(1).to_string());
        let pipes = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = pipes.stderr(Stdio::piped()).spawn().map_err(cannot)?;
        let mut input = child.stdin.take();
        if let Some(input) = &mut input {
            // One that has ended already says why on its standard error.
            let _ = writeln!(input, "{told}").and_then(|()| input.flush());
        }
        if let Some(output) = child.stdout.take() {
            let number = start.number;
            let listen = move || {
                for line in BufReader::new(output).lines() {
                    let Ok(line) = line else { break };
                    if let Ok(said) = serde_json::from_str(&line) {
                        let _ = say.send((number, Heard::Line(said)));
                    }
                }
                let _ = say.send((number, Heard::Closed));
            };
            let thread = thread::Builder::new().name("flight's words".to_owned());
            if let Err(error) = thread.spawn(listen) {
                let _ = child.kill();
                let _ = child.wait();
                return Err(cannot(error));
            }
        }
        let errors = child.stderr.take().and_then(|errors| {
            let thread = thread::Builder::new().name("flight's errors".to_owned());
            thread.spawn(move || end_of(errors)).ok()
        });
        Ok(Self {
            number: start.number,
            flight: start.flight,
            need: start.need,
            done: None,
            child,
            input,
            errors,
        })
    }

    /// What it holds, in bytes, where the system tells it.
    pub(super) fn memory(&self) -> Option<u64> {
        memory::of_process(self.child.id())
    }

    /// Asks it to end, by closing its input.
    pub(super) fn ask_to_end(&mut self) {
        self.input = None;
    }

    /// Ends it: asks it to, and does not wait for ever.
    pub(super) fn end(&mut self) {
        self.ask_to_end();
        let begun = Instant::now();
        while begun.elapsed() < GRACE {
            match self.child.try_wait() {
                Ok(None) => thread::sleep(Duration::from_millis(10)),
                _ => return,
            }
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// What came of one that says no more.
    pub(super) fn conclude(mut self) -> Result<FlightDone, Fault> {
        let status = self.child.wait();
        let said = self.errors.take().and_then(|errors| errors.join().ok());
        match (self.done, status) {
            (Some(done), Ok(status)) if status.success() => Ok(done),
            (_, status) => Err(why(&said.unwrap_or_default(), status.ok())),
        }
    }
}

/// The end of what somebody says.
fn end_of(mut errors: impl Read) -> String {
    let mut end = Vec::new();
    let mut piece = [0; 4096];
    while let Ok(length @ 1..) = errors.read(&mut piece) {
        end.extend_from_slice(&piece[..length]);
        if end.len() > 2 * MOST_SAID {
            end.drain(..end.len() - MOST_SAID);
        }
    }
    String::from_utf8_lossy(&end).into_owned()
}

/// Why a process broke.
fn why(said: &str, status: Option<ExitStatus>) -> Fault {
    let mut errors = said.lines().filter_map(|line| line.strip_prefix("error: "));
    if let Some(error) = errors.next_back() {
        return Fault::new(one_line(error), "the others are done without it");
    }
    let room = "give it more room (fewer --jobs, more memory)";
    if said.contains("memory allocation of") {
        return Fault::new("memory ran out", room);
    }
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        if let Some(signal) = status.and_then(|status| status.signal()) {
            let what = match signal {
                9 => "its process was killed, as systems do where memory runs out".to_owned(),
                _ => format!("its process was ended by signal {signal}"),
            };
            return Fault::new(what, room);
        }
    }
    let code = status.and_then(|status| status.code());
    let code = code.map_or_else(String::new, |code| format!(" (status {code})"));
    let what = format!("its process ended without a word{code}");
    Fault::new(
        what,
        "please report it, with the flight that brought it about",
    )
}
