//! Sending a task's files: several at once, each again where the line failed, never more of a file in memory than a
//! buffer.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use serde_json::Value;

use crate::client::Client;
use crate::fault::Fault;
use crate::files::FileError;
use crate::jobs::Progress;
use crate::limits::Limits;
use crate::multipart::Multipart;
use crate::patience::wait;
use crate::sent::{Origin, Sent, SentFile};
use crate::trouble::Trouble;

/// How often a file is sent where the line fails.
const TRIES: u32 = 5;

/// Sends all files of a task.
///
/// # Errors
/// Where a file cannot be sent, or the user cancelled; what others were being sent is called off.
pub(crate) fn upload(
    client: &Client<'_>,
    uuid: &str,
    sent: &Sent,
    limits: &Limits,
    progress: &Progress,
) -> Result<(), Trouble> {
    let under_way = UnderWay {
        client,
        path: format!("/task/new/upload/{uuid}"),
        sent,
        limits,
        progress,
        next: AtomicUsize::new(0),
        done: AtomicUsize::new(0),
        bytes: AtomicU64::new(0),
        failed: Mutex::new(None),
        stops: AtomicBool::new(false),
    };
    let size = sent.size();
    std::thread::scope(|scope| {
        let count = limits.at_once.clamp(1, sent.files.len().max(1));
        let workers: Vec<_> = (0..count)
            .map(|_| scope.spawn(|| under_way.work()))
            .collect();
        while workers.iter().any(|worker| !worker.is_finished()) {
            let (done, bytes) = (
                under_way.done.load(Ordering::Relaxed),
                under_way.bytes.load(Ordering::Relaxed),
            );
            progress.stage(format!(
                "sending: {done} of {} files, {} of {} MB",
                sent.files.len(),
                bytes >> 20,
                size >> 20
            ));
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
    sent: &'a Sent,
    limits: &'a Limits,
    progress: &'a Progress,
    next: AtomicUsize,
    done: AtomicUsize,
    bytes: AtomicU64,
    failed: Mutex<Option<Trouble>>,
    stops: AtomicBool,
}

impl UnderWay<'_> {
    /// Sends one file after the other, as long as there are some.
    fn work(&self) {
        while !self.stops.load(Ordering::Relaxed) {
            let Some(file) = self
                .sent
                .files
                .get(self.next.fetch_add(1, Ordering::Relaxed))
            else {
                return;
            };
            match self.send(file) {
                Ok(()) => {
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

    fn send(&self, file: &SentFile) -> Result<(), Trouble> {
        let mut pause = self.limits.shortest_pause;
        for attempt in 1.. {
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
                Trouble::Passing(fault) if attempt >= TRIES => {
                    let what = format!(
                        "{} could not be sent, {TRIES} times: {}",
                        file.name, fault.what
                    );
                    let remedy = "check the network and the node, then start it once more";
                    return Err(Trouble::Final(Fault::new(what, remedy)));
                }
                Trouble::Passing(_) => {}
                other => return Err(other),
            }
            if self.stops.load(Ordering::Relaxed) {
                return Err(Trouble::Cancelled);
            }
            wait(pause, self.progress)?;
            pause = (pause * 2).min(self.limits.longest_pause);
        }
        Ok(())
    }
}
