//! How long the window's frames take, for whoever wants to know: with `FRAGSCALE_FRAME_TIMES=FILE`
//! the window writes a line of CSV for each frame. Otherwise nothing is measured.
//!
//! ```text
//! start_s   when the frame began, since the window opened
//! logic     shortcuts, results of jobs                    wall and CPU time, milliseconds
//! panels    everything but the viewport's picture
//! upload    what is new, to the graphics device
//! draw      recording the viewport's picture and handing it to the device
//! commands  applying what the engineer did
//! rest_cpu  until the next frame: egui's own shapes, drawing and showing them; without waiting
//! ```
//!
//! CPU time is that of the window's thread, from Linux, which counts it in ticks of 1 to 4 ms; empty
//! elsewhere.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use crate::files::{Inputs, Kind, may_write};

/// A part of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Shortcuts, results of jobs.
    Logic,
    /// Everything but the viewport's picture.
    Panels,
    /// What is new, to the graphics device.
    Upload,
    /// The viewport's picture.
    Draw,
    /// What the engineer did.
    Commands,
}

const PHASES: usize = 5;

/// A stopwatch that is mostly off.
#[derive(Debug, Default)]
pub struct FrameTimes(Option<Watch>);

#[derive(Debug)]
struct Watch {
    file: File,
    opened: Instant,
    /// When the frame began, seconds.
    start: Option<f64>,
    /// Wall and CPU time of each phase, milliseconds.
    spent: [[f64; 2]; PHASES],
    /// When the last phase ended: the time, and the thread's CPU time in milliseconds.
    last: (Instant, Option<f64>),
}

impl FrameTimes {
    /// Measures into this file; `None` measures nothing.
    ///
    /// # Errors
    /// Where the file cannot be written, or is one of somebody else's.
    pub fn into_file(path: Option<&Path>) -> std::io::Result<Self> {
        let Some(path) = path else {
            return Ok(Self(None));
        };
        let none = Inputs::default();
        may_write(path, Kind::Result, &none, false).map_err(std::io::Error::other)?;
        let mut file = File::create(path)?;
        writeln!(
            file,
            "start_s,logic,panels,upload,draw,commands,logic_cpu,panels_cpu,upload_cpu,draw_cpu,commands_cpu,rest_cpu"
        )?;
        let now = Instant::now();
        Ok(Self(Some(Watch {
            file,
            opened: now,
            start: None,
            spent: [[0.0; 2]; PHASES],
            last: (now, None),
        })))
    }

    /// A frame begins: writes the line of the one before.
    pub fn begin(&mut self) {
        let Some(watch) = &mut self.0 else {
            return;
        };
        let now = (Instant::now(), thread_milliseconds());
        if let Some(start) = watch.start {
            let wall = watch.spent.map(|[wall, _]| format!("{wall:.2}"));
            let rest = now.1.zip(watch.last.1).map(|(now, last)| now - last);
            let cpu = watch.spent.map(|[_, cpu]| cpu);
            let cpu = cpu.into_iter().map(Some).chain([rest]);
            let cpu: Vec<String> = cpu
                .map(|cpu| cpu.map_or_else(String::new, |cpu| format!("{cpu:.2}")))
                .collect();
            let line = format!("{start:.3},{},{}\n", wall.join(","), cpu.join(","));
            // A measurement that cannot be written is no reason to stop working.
            let _ = watch.file.write_all(line.as_bytes());
        }
        watch.spent = [[0.0; 2]; PHASES];
        watch.start = Some((now.0 - watch.opened).as_secs_f64());
        watch.last = now;
    }

    /// What was done since the last call belongs to this phase.
    pub fn end(&mut self, phase: Phase) {
        let Some(watch) = &mut self.0 else {
            return;
        };
        let now = (Instant::now(), thread_milliseconds());
        let [wall, cpu] = &mut watch.spent[phase as usize];
        *wall += (now.0 - watch.last.0).as_secs_f64() * 1000.0;
        *cpu += now
            .1
            .zip(watch.last.1)
            .map_or(0.0, |(now, last)| now - last);
        watch.last = now;
    }
}

/// How long this thread has run, milliseconds; where Linux tells.
fn thread_milliseconds() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two frames make one line: the second is not over yet.
    #[test]
    fn a_frame_is_a_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("times.csv");
        let mut times = FrameTimes::into_file(Some(&path)).unwrap();
        for _ in 0..2 {
            times.begin();
            std::thread::sleep(std::time::Duration::from_millis(5));
            times.end(Phase::Upload);
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0].len(), lines[1].len());
        let of = |name: &str| {
            let column = lines[0].iter().position(|own| *own == name).unwrap();
            lines[1][column].parse::<f64>().unwrap()
        };
        assert!(of("upload") >= 5.0);
        assert!(of("draw") < f64::EPSILON);
    }
}
