//! A task on a node: begun, watched until it has ended, called off.
//!
//! What a task comes to is in its status alone: its progress is 100 after a failure, too. An upload that broke off
//! stays on a node as half a photo, and the next try gets another name; so the photos that have arrived are counted
//! once the node has looked at them, and where they are not as many as were sent the task is begun anew.

use std::time::Instant;

use serde_json::Value;

use crate::address::{Address, Token};
use crate::answers::{Arrived, Named, State, TaskInfo};
use crate::client::Client;
use crate::fault::{Fault, one_line};
use crate::jobs::Progress;
use crate::limits::Limits;
use crate::multipart::Multipart;
use crate::outputs::outputs;
use crate::patience::{patiently, wait};
use crate::place::{ArrivedFiles, Log};
use crate::sent::Sent;
use crate::trouble::{FREE_SPACE, Trouble, disk_is_full};
use crate::upload::upload;

/// Begins a task: nothing is computed before [`send`]. Returns its name on the node.
pub(crate) fn init(
    client: &Client<'_>,
    name: &str,
    options: &str,
    limits: &Limits,
    progress: &Progress,
) -> Result<String, Trouble> {
    let outputs = Value::from(outputs(options)).to_string();
    let call = || {
        let form = Multipart::new()
            .field("name", name)
            .field("options", options)
            // Tiles for looking at in a browser.
            .field("skipPostProcessing", "true")
            .field("outputs", &outputs);
        client.post::<Named>("/task/new/init", form, |_| {})
    };
    let uuid = patiently(limits, progress, call)?.uuid;
    // It becomes a part of paths.
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
    match !uuid.is_empty() && uuid.len() <= 64 && uuid.chars().all(is_plain) {
        true => Ok(uuid),
        false => {
            let what = "it is no NodeODM: the task that it begins has no UUID";
            Err(Trouble::Final(Fault::new(what, "check address and port")))
        }
    }
}

/// Sends everything that has not arrived and lets the node begin.
///
/// # Errors
/// [`Trouble::Unknown`] where the node has forgotten what it was sent, [`Trouble::Passing`] where it has not answered
/// for as long as the limits allow: the same call goes on then.
pub(crate) fn send(
    client: &Client<'_>,
    uuid: &str,
    (sent, arrived): (&Sent, &ArrivedFiles),
    limits: &Limits,
    progress: &Progress,
) -> Result<(), Trouble> {
    // A run before may have ended in the middle of that call.
    let was_told = sent.files.iter().all(|file| arrived.has(&file.name));
    upload(client, uuid, (sent, arrived), limits, progress)?;
    commit(client, uuid, was_told, limits, progress)
}

/// Lets the node begin, however often that takes: the call may be lost, or its answer. A task that is known was
/// committed; one that is not, and that nothing is left of to commit, may still be on its way into its place, where
/// the node `was_told` before.
fn commit(
    client: &Client<'_>,
    uuid: &str,
    mut was_told: bool,
    limits: &Limits,
    progress: &Progress,
) -> Result<(), Trouble> {
    let path = format!("/task/new/commit/{uuid}");
    let began = Instant::now();
    let mut pause = limits.shortest_pause;
    loop {
        progress.stage("the node puts the photos in their place");
        let trouble = match client.commit::<Named>(&path) {
            Ok(_) => return Ok(()),
            Err(Trouble::Cancelled) => return Err(Trouble::Cancelled),
            Err(trouble) => trouble,
        };
        was_told |= matches!(trouble, Trouble::Passing(_));
        let known = match info(client, uuid) {
            Ok(_) => return Ok(()),
            Err(known) => known,
        };
        let is_waited_for = match (&trouble, &known) {
            (_, Trouble::Cancelled) => return Err(Trouble::Cancelled),
            (Trouble::Passing(_), Trouble::Passing(_) | Trouble::Unknown) => true,
            // (What is left of a call that is at work yet is refused in the words of the node's system.)
            (Trouble::Unknown | Trouble::Refused(_), _) => was_told,
            _ => false,
        };
        if !is_waited_for || began.elapsed() >= limits.give_up {
            return Err(trouble);
        }
        wait(pause, progress)?;
        pause = (pause * 2).min(limits.longest_pause);
    }
}

/// How a task is.
pub(crate) fn info(client: &Client<'_>, uuid: &str) -> Result<TaskInfo, Trouble> {
    client.get(&format!("/task/{uuid}/info"), "")
}

/// What a task came to.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// Its results are there.
    Completed,
    /// Not as many photos have arrived as were sent.
    Incomplete {
        /// So many were counted.
        arrived: f64,
        /// Of so many.
        sent: usize,
    },
    /// It failed, or somebody else cancelled it.
    Failed(Fault),
}

/// Watches a task to its end; its messages go into the log, and to `heard`.
pub(crate) fn watch(
    client: &Client<'_>,
    uuid: &str,
    sent: &Sent,
    (log, heard): (&mut Log, &dyn Fn(&str)),
    limits: &Limits,
    progress: &Progress,
) -> Result<Outcome, Trouble> {
    let mut messages = Messages::default();
    let mut pause = limits.shortest_pause;
    let mut lost_since: Option<Instant> = None;
    loop {
        let info = match patiently(limits, progress, || info(client, uuid)) {
            // Between a cluster's list and the node's it may be in neither for a moment.
            Err(Trouble::Unknown) if lost_since.is_none() => {
                lost_since = Some(Instant::now());
                wait(limits.shortest_pause, progress)?;
                continue;
            }
            info => info?,
        };
        lost_since = None;
        let heard_of_it = messages.take(client, uuid, &info, (log, heard));
        match heard_of_it {
            Ok(())
            | Err(
                Trouble::Passing(_)
                | Trouble::Unknown
                | Trouble::Refused(_)
                | Trouble::Final(_)
                | Trouble::Worthless(_),
            ) => {}
            Err(trouble) => return Err(trouble),
        }
        if let Some(state) = info.state()
            && state != State::Failed
            && state != State::Cancelled
            && let Some((arrived, sent)) = differing(&info, sent)
        {
            return Ok(Outcome::Incomplete { arrived, sent });
        }
        let last = log.last.last().map(String::as_str).unwrap_or_default();
        match info.state() {
            Some(State::Completed) => return Ok(Outcome::Completed),
            Some(State::Failed) => {
                let fault = failed(
                    info.status
                        .error
                        .as_deref()
                        .map(|words| client.hidden(words))
                        .as_deref(),
                    log,
                );
                return Ok(Outcome::Failed(fault));
            }
            Some(State::Cancelled) => {
                let what = "the task was cancelled on the node";
                return Ok(Outcome::Failed(Fault::new(
                    what,
                    "start it once more: the photos are sent again",
                )));
            }
            Some(State::Queued) => progress.stage("waiting in the node's queue"),
            Some(State::Running) | None => {
                let mut sentence = "the node reconstructs".to_owned();
                if !last.is_empty() {
                    sentence += &format!(": {}", clipped(last));
                }
                progress.stage(sentence);
                let percent = info.progress.unwrap_or_default().clamp(0.0, 100.0);
                // (`as` saturates. A fault is that it was cancelled, which `wait` finds.)
                let _ = progress.advance((percent * 100.0) as u64, 10_000);
            }
        }
        wait(pause, progress)?;
        // The longer it takes, the less often it is asked.
        pause = pause.mul_f64(1.5).min(limits.longest_pause);
    }
}

/// A message as it fits beside a bar.
fn clipped(message: &str) -> String {
    let line = one_line(message);
    match line.char_indices().nth(80) {
        Some((end, _)) => format!("{}…", line.get(..end).unwrap_or_default()),
        None => line,
    }
}

/// How many have arrived and were sent, where the two differ.
fn differing(info: &TaskInfo, sent: &Sent) -> Option<(f64, usize)> {
    let (arrived, all) = match info.arrived()? {
        Arrived::Files(arrived) => (arrived, sent.files.len()),
        Arrived::Photos(arrived) => (arrived, sent.photos()),
    };
    (arrived != all as f64).then_some((arrived, all))
}

/// The messages that have been taken.
#[derive(Default)]
struct Messages {
    taken: usize,
    /// Whether they were a cluster's, that has not handed the task on.
    of_cluster: bool,
}

impl Messages {
    fn take(
        &mut self,
        client: &Client<'_>,
        uuid: &str,
        info: &TaskInfo,
        (log, heard): (&mut Log, &dyn Fn(&str)),
    ) -> Result<(), Trouble> {
        let of_cluster = info.progress.is_none();
        if self.of_cluster && !of_cluster {
            // The node counts from the first again.
            self.taken = 0;
        }
        self.of_cluster = of_cluster;
        let query = format!("line={}", self.taken);
        let lines: Value = client.get(&format!("/task/{uuid}/output"), &query)?;
        let lines = lines.as_array().map(Vec::as_slice).unwrap_or_default();
        self.taken += lines.len();
        for line in lines.iter().filter_map(Value::as_str) {
            let line = one_line(&client.hidden(line));
            if !line.is_empty() {
                log.add(&line).map_err(Trouble::Here)?;
                heard(&line);
            }
        }
        Ok(())
    }
}

/// Why a task failed, and what to do about it. `words` is what the node says; the exit statuses behind them are those
/// of NodeODM's `libs/Task.js`.
fn failed(words: Option<&str>, log: &Log) -> Fault {
    let last: Vec<&str> = log.last.iter().map(String::as_str).collect();
    let see = format!("the node's messages are in {}", log.path().display());
    let words = words.map(one_line).unwrap_or_default();
    if let Some(line) = std::iter::once(words.as_str())
        .chain(last.iter().copied())
        .find(|line| disk_is_full(line))
    {
        let what = format!("the node's disk is full (\"{}\")", clipped(line));
        return Fault::new(what, FREE_SPACE);
    }
    let lower = words.to_ascii_lowercase();
    if lower.contains("memory") || lower.contains("137") {
        let what = "the node had not enough memory (exit status 137)";
        let remedy = format!(
            "give it more, take fewer photos, or ask for less: --option feature-quality=medium --option pc-quality=low; {see}"
        );
        return Fault::new(what, remedy);
    }
    if lower.contains("unsupported cpu") || lower.contains("132") {
        let what = "the node's processor lacks what its OpenDroneMap needs (exit status 132)";
        return Fault::new(what, "use another node");
    }
    if lower.contains("installation") {
        let what = "the node's OpenDroneMap is not installed properly (exit status 3)";
        return Fault::new(what, "ask whoever runs the node");
    }
    let last = last.last().map_or_else(String::new, |line| {
        format!("; its last message: \"{}\"", clipped(line))
    });
    if words.is_empty() {
        return Fault::new(format!("the task failed on the node{last}"), see);
    }
    if lower.contains("cannot process dataset") || lower.contains("code 1") {
        let what = format!(
            "OpenDroneMap could not reconstruct the photos (\"{words}\", exit status 1){last}"
        );
        let remedy = format!("most often they overlap too little or are blurred; {see}");
        return Fault::new(what, remedy);
    }
    Fault::new(
        format!("the task failed on the node (\"{words}\"){last}"),
        see,
    )
}

/// Calls to a node that nobody calls off, and that take a few seconds at most: the line of the call that was called
/// off is no good any more.
fn last_calls<'a>(address: &'a Address, token: Option<&'a Token>, limits: &Limits) -> Client<'a> {
    let quick = Limits {
        idle: limits.idle.min(std::time::Duration::from_secs(5)),
        ..*limits
    };
    Client::new(address, token, &quick, None)
}

/// Whether a task has ended well, so that its results are there; asked within a few seconds.
pub(crate) fn has_results(
    address: &Address,
    token: Option<&Token>,
    uuid: &str,
    limits: &Limits,
) -> Result<bool, Trouble> {
    let info = info(&last_calls(address, token, limits), uuid)?;
    Ok(info.state() == Some(State::Completed))
}

/// That a task stays on its node, and why.
pub(crate) fn stays(trouble: Trouble, uuid: &str, address: &Address) -> String {
    let why = trouble.at(address).fault.what;
    format!("the task {uuid} could not be removed from the node ({why}), which may go on with it")
}

/// Cancels a task and removes it from its node, within a few seconds; says what came of that.
pub(crate) fn call_off(
    address: &Address,
    token: Option<&Token>,
    uuid: &str,
    limits: &Limits,
) -> Result<String, String> {
    let client = last_calls(address, token, limits);
    let cancelled = client.name_task("/task/cancel", uuid);
    let removed = client.name_task("/task/remove", uuid);
    match (cancelled, removed) {
        (_, Ok(())) => Ok("the task on the node was cancelled and removed".to_owned()),
        (Err(Trouble::Unknown), Err(Trouble::Unknown)) => {
            Ok("the node had not begun; what was sent it throws away by itself".to_owned())
        }
        // Somebody else removed it between the two.
        (Ok(()), Err(Trouble::Unknown)) => {
            Ok("the task on the node was cancelled and removed".to_owned())
        }
        (_, Err(trouble)) => Err(stays(trouble, uuid, address)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::Place;

    fn failed_with(words: Option<&str>, messages: &[&str]) -> String {
        let folder = tempfile::tempdir().unwrap();
        let (place, ..) = Place::take(&folder.path().join("to"), folder.path(), "x").unwrap();
        let mut log = Log::begin(&place).unwrap();
        for message in messages {
            log.add(message).unwrap();
        }
        failed(words, &log).to_string()
    }

    /// NodeODM's own words (`libs/Task.js`), those of older versions, and none.
    #[test]
    fn failures_are_said_with_what_to_do() {
        for (words, messages, said) in [
            (
                Some("Cannot process dataset"),
                &["a", "too few matches"][..],
                "exit status 1); its last message: \"too few matches\"; most often they overlap too little",
            ),
            (Some("Process exited with code 1"), &[], "exit status 1)"),
            (
                Some("Not enough memory"),
                &[],
                "not enough memory (exit status 137)",
            ),
            (
                Some("Process exited with code 137"),
                &[],
                "not enough memory (exit status 137)",
            ),
            (Some("Unsupported CPU"), &[], "exit status 132"),
            (Some("Installation issue"), &[], "exit status 3"),
            (
                Some("Processing failed (99)"),
                &[],
                "failed on the node (\"Processing failed (99)\")",
            ),
            (
                Some("Cannot process dataset"),
                &["OSError: [Errno 28] No space left on device"],
                "the node's disk is full",
            ),
            (
                None,
                &["Failed to forward task to processing node after 5 attempts"],
                "failed on the node; its last message: \"Failed to forward",
            ),
            (
                None,
                &[],
                "the task failed on the node; the node's messages are in",
            ),
        ] {
            let found = failed_with(words, messages);
            assert!(found.contains(said), "{found}");
        }
    }
}
