//! Sending a task's files: several at once, each again where the line failed, never more of a file in memory than a
//! buffer. A node is given up when for so long as the user allows it every file has failed, however often that was: a
//! success of any of them begins the time anew. What has arrived is written down, and not sent by a run that goes on.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::client::Client;
use crate::fault::Fault;
use crate::files::FileError;
use crate::jobs::Progress;
use crate::limits::Limits;
use crate::multipart::Multipart;
use crate::patience::wait;
use crate::place::ArrivedFiles;
use crate::sent::{Origin, Sent, SentFile};
use crate::trouble::Trouble;

/// Sends all files of a task that have not `arrived`.
///
/// # Errors
/// Where a file cannot be sent, or the user cancelled; what others were being sent is called off. Where the line or
/// the node failed in passing, for longer than the limits allow, it is [`Trouble::Passing`].
pub(crate) fn upload(
    client: &Client<'_>,
    uuid: &str,
    (sent, arrived): (&Sent, &ArrivedFiles),
    limits: &Limits,
    progress: &Progress,
) -> Result<(), Trouble> {
    let (there, missing): (Vec<_>, Vec<_>) =
        (sent.files.iter()).partition(|file| arrived.has(&file.name));
    let bytes_there = there.iter().map(|file| file.size).sum();
    let under_way = UnderWay {
        client,
        path: format!("/task/new/upload/{uuid}"),
        missing,
        arrived,
        limits,
        progress,
        next: AtomicUsize::new(0),
        done: AtomicUsize::new(there.len()),
        bytes: AtomicU64::new(bytes_there),
        failing: Mutex::new(None),
        failed: Mutex::new(None),
        stops: AtomicBool::new(false),
    };
    let size = sent.size();
    std::thread::scope(|scope| {
        let count = limits.at_once.clamp(1, under_way.missing.len().max(1));
        let workers: Vec<_> = (0..count)
            .map(|_| scope.spawn(|| under_way.work()))
            .collect();
        while workers.iter().any(|worker| !worker.is_finished()) {
            let (done, bytes) = (
                under_way.done.load(Ordering::Relaxed),
                under_way.bytes.load(Ordering::Relaxed),
            );
            let mut sentence = format!(
                "sending: {done} of {} files, {} of {} MB",
                sent.files.len(),
                bytes >> 20,
                size >> 20
            );
            if let Some(failing) = &*under_way.failing() {
                sentence += &format!("; {}, sending again", failing.why);
            }
            progress.stage(sentence);
            // The lines look by themselves whether they are wanted.
            let _ = progress.advance(bytes, size);
            std::thread::sleep(Duration::from_millis(50));
        }
    });
    match under_way
        .failed
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner)
    {
        None => Ok(()),
        Some(_) if progress.is_cancelled() => Err(Trouble::Cancelled),
        Some(trouble) => Err(trouble),
    }
}

struct UnderWay<'a> {
    client: &'a Client<'a>,
    path: String,
    missing: Vec<&'a SentFile>,
    arrived: &'a ArrivedFiles,
    limits: &'a Limits,
    progress: &'a Progress,
    next: AtomicUsize,
    done: AtomicUsize,
    bytes: AtomicU64,
    failing: Mutex<Option<Failing>>,
    failed: Mutex<Option<Trouble>>,
    stops: AtomicBool,
}

/// That no file has arrived and some have failed.
struct Failing {
    since: Instant,
    /// The last of them.
    why: String,
}

impl UnderWay<'_> {
    /// Sends one file after the other, as long as there are some.
    fn work(&self) {
        while !self.stops.load(Ordering::Relaxed) {
            let next = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(file) = self.missing.get(next) else {
                return;
            };
            match self.send(file) {
                Ok(()) => {
                    self.arrived.add(&file.name);
                    *self.failing() = None;
                    self.done.fetch_add(1, Ordering::Relaxed);
                }
                Err(trouble) => {
                    // Before the others are called off, whose trouble is only that.
                    let mut failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
                    failed.get_or_insert(trouble);
                    self.stops.store(true, Ordering::Relaxed);
                    return;
                }
            }
        }
    }

    fn failing(&self) -> MutexGuard<'_, Option<Failing>> {
        self.failing.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// For how long nothing has arrived, now that something has failed.
    fn failing_for(&self, why: &str) -> Duration {
        let mut failing = self.failing();
        let since = failing
            .as_ref()
            .map_or_else(Instant::now, |failing| failing.since);
        *failing = Some(Failing {
            since,
            why: why.to_owned(),
        });
        since.elapsed()
    }

    fn send(&self, file: &SentFile) -> Result<(), Trouble> {
        let mut pause = self.limits.shortest_pause;
        loop {
            let form = Multipart::new();
            let form = match &file.from {
                Origin::Bytes(bytes) => form.file_of("images", &file.name, file.kind, bytes),
                Origin::Path(path) => {
                    let opened = form.file("images", &file.name, file.kind, path);
                    opened.map_err(|error| {
                        let what = format!("it cannot be read any more ({error})");
                        Trouble::Here(FileError::new(
                            path,
                            Fault::new(what, "check the disk, then start it once more"),
                        ))
                    })?
                }
            };
            let mut went = 0;
            let sent = self.client.post::<Value>(&self.path, form, |bytes| {
                went += bytes;
                self.bytes.fetch_add(bytes, Ordering::Relaxed);
            });
            let Err(trouble) = sent else {
                return Ok(());
            };
            self.bytes.fetch_sub(went, Ordering::Relaxed);
            match trouble {
                Trouble::Passing(fault) => {
                    let failing = self.failing_for(&fault.what);
                    if failing >= self.limits.give_up {
                        let what = format!(
                            "{} could not be sent for {}: {}",
                            file.name,
                            in_words(failing),
                            fault.what
                        );
                        return Err(Trouble::Passing(Fault::new(what, fault.remedy)));
                    }
                }
                other => return Err(other),
            }
            if self.stops.load(Ordering::Relaxed) {
                return Err(Trouble::Cancelled);
            }
            wait(pause, self.progress)?;
            pause = (pause * 2).min(self.limits.longest_pause);
        }
    }
}

/// A time that somebody has waited.
fn in_words(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..120 => format!("{seconds} s"),
        seconds => format!("{} minutes", seconds / 60),
    }
}
