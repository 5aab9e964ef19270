//! A run: a task that is gone on with or begun, watched, fetched, and called off where the user cancels.

use std::path::{Path, PathBuf};

use crate::NodeRequest;
use crate::answers::{NodeInfo, State};
use crate::client::Client;
use crate::fault::Fault;
use crate::files::FileError;
use crate::jobs::Progress;
use crate::options::{Known, to_send};
use crate::outputs::outputs;
use crate::patience::{patiently, wait};
use crate::place::{ARCHIVE, Log, ODM, Place, Remembered};
use crate::reconstruct::{Reconstructed, name_of};
use crate::results;
use crate::sent::Sent;
use crate::task::{Outcome, call_off, has_results, info, init, send, stays, watch};
use crate::trouble::Trouble;
use crate::unzip::unzip;

/// How often a task is begun whose photos do not arrive.
const UPLOADS: u32 = 3;
/// How often results are fetched that break off.
const DOWNLOADS: u32 = 4;

/// A run.
pub(crate) struct Run<'a> {
    pub(crate) request: &'a NodeRequest,
    pub(crate) client: Client<'a>,
    pub(crate) sent: Sent,
    pub(crate) heard: &'a dyn Fn(&str),
    pub(crate) progress: &'a Progress,
}

impl Run<'_> {
    /// Asks the node what it is, and holds against it what is to be done. Returns the options to send.
    pub(crate) fn greet(&self) -> Result<String, Trouble> {
        self.progress
            .stage(format!("asking {} what it is", self.request.node));
        let info: NodeInfo = self.client.get("/info", "")?;
        let no_odm = |what: String| Trouble::Final(Fault::new(what, "name a node of OpenDroneMap"));
        if info.version.is_none() {
            return Err(no_odm(
                "it is no NodeODM and no ClusterODM: it states no version".to_owned(),
            ));
        }
        if let Some(engine) = info
            .engine
            .filter(|engine| engine != "odm" && engine != "?")
        {
            return Err(no_odm(format!("its engine is {engine}, not OpenDroneMap")));
        }
        let photos = self.sent.photos();
        if info.most_photos.is_some_and(|most| most < photos as f64) {
            let most = info.most_photos.unwrap_or_default();
            let what = format!("it takes {most} photos at most, and these are {photos}");
            return Err(Trouble::Final(Fault::new(
                what,
                "take fewer, or another node",
            )));
        }
        let known: Vec<Known> = patiently(&self.request.limits, self.progress, || {
            self.client.get("/options", "")
        })?;
        to_send(&self.request.options, &known).map_err(Trouble::Final)
    }

    /// Goes on with a task, or begins one; to the flight.
    pub(crate) fn to_the_end(
        &self,
        place: &Place,
        before: Option<Remembered>,
        options: &str,
        warnings: &mut Vec<String>,
    ) -> Result<Reconstructed, Trouble> {
        let limits = &self.request.limits;
        let mut log = Log::begin(place).map_err(Trouble::Here)?;
        let mut uuid = match before {
            Some(task) => self.goes_on(&task, place)?,
            None => None,
        };
        for attempt in 1.. {
            let task = match uuid.take() {
                Some(uuid) => uuid,
                None => self.begin(place, options)?,
            };
            let to = (&mut log, self.heard);
            let outcome = match watch(&self.client, &task, &self.sent, to, limits, self.progress) {
                Err(Trouble::Unknown) => {
                    // It has nothing to go on with.
                    place.forget();
                    return Err(Trouble::Unknown);
                }
                Err(Trouble::Passing(fault)) => {
                    let remedy =
                        "when it answers again, start it once more: it goes on with the task";
                    return Err(Trouble::Final(Fault::new(fault.what, remedy)));
                }
                outcome => outcome?,
            };
            match outcome {
                Outcome::Completed => return self.fetch(&task, options, place, warnings),
                Outcome::Failed(fault) => {
                    self.remove(&task, place, warnings);
                    return Err(Trouble::Final(fault));
                }
                Outcome::Incomplete { arrived, sent } => {
                    self.remove(&task, place, warnings);
                    let what = format!("{arrived} files have arrived where {sent} were sent");
                    if attempt >= UPLOADS {
                        let what = format!("{what}, {UPLOADS} times");
                        let remedy = "check the network and the node, then start it once more";
                        return Err(Trouble::Final(Fault::new(what, remedy)));
                    }
                    warnings.push(format!("{what}: the task was begun anew"));
                }
            }
        }
        Err(Trouble::Unknown)
    }

    /// The task of a run before, if the node still has it and it is worth going on with.
    fn goes_on(&self, task: &Remembered, place: &Place) -> Result<Option<String>, Trouble> {
        let limits = &self.request.limits;
        let uuid = &task.uuid;
        let info = patiently(limits, self.progress, || info(&self.client, uuid));
        let is_over = match info {
            Ok(info) => matches!(info.state(), Some(State::Failed | State::Cancelled)),
            // As long as it was not told to begin, a node keeps files, and knows no task.
            Err(Trouble::Unknown) if !task.committed => {
                return match self.hand_over(uuid, place) {
                    Ok(()) => Ok(Some(uuid.clone())),
                    Err(Trouble::Unknown) => Ok(None),
                    Err(trouble) => Err(trouble),
                };
            }
            Err(Trouble::Unknown) => {
                place.forget();
                return Ok(None);
            }
            Err(trouble) => return Err(trouble),
        };
        if !is_over {
            self.remember(uuid, true, place)?;
            return Ok(Some(uuid.clone()));
        }
        self.remove(uuid, place, &mut Vec::new());
        Ok(None)
    }

    /// Begins a task and sends it everything.
    fn begin(&self, place: &Place, options: &str) -> Result<String, Trouble> {
        let limits = &self.request.limits;
        self.progress.stage("beginning a task on the node");
        let name = name_of(&self.request.photos);
        let uuid = init(&self.client, &name, options, limits, self.progress)?;
        // What has arrived of another is nothing of this one.
        place.forget();
        self.remember(&uuid, false, place)?;
        self.hand_over(&uuid, place).map(|()| uuid)
    }

    fn remember(&self, uuid: &str, committed: bool, place: &Place) -> Result<(), Trouble> {
        let task = Remembered {
            node: self.request.node.to_string(),
            uuid: uuid.to_owned(),
            committed,
        };
        place.remember(&task).map_err(Trouble::Here)
    }

    /// Sends what a task lacks and lets the node begin. It stays remembered where a second run may go on with it.
    fn hand_over(&self, uuid: &str, place: &Place) -> Result<(), Trouble> {
        let limits = &self.request.limits;
        let arrived = place.arrived().map_err(Trouble::Here)?;
        let what = (&self.sent, &arrived);
        match send(&self.client, uuid, what, limits, self.progress) {
            Ok(()) => self.remember(uuid, true, place),
            Err(Trouble::Passing(fault)) => {
                let remedy = format!(
                    "when it answers again, start it once more: it goes on with what the node has (what that is lies in {})",
                    place.work.display()
                );
                Err(Trouble::Final(Fault::new(fault.what, remedy)))
            }
            // Whoever looks at the trouble calls it off; what lies here may be mended.
            Err(trouble @ (Trouble::Cancelled | Trouble::Here(_))) => Err(trouble),
            Err(trouble) => {
                // It said no for good.
                let _ = call_off(
                    &self.request.node,
                    self.request.token.as_ref(),
                    uuid,
                    limits,
                );
                place.forget();
                Err(trouble)
            }
        }
    }

    /// Removes a task from the node and forgets it.
    fn remove(&self, uuid: &str, place: &Place, warnings: &mut Vec<String>) {
        let removed = self.client.name_task("/task/remove", uuid);
        place.forget();
        if let Err(trouble) = removed
            && trouble != Trouble::Unknown
        {
            let why = trouble.at(&self.request.node).fault.what;
            warnings.push(format!(
                "the task {uuid} could not be removed from the node ({why}): remove it on its page"
            ));
        }
    }

    /// A task of other photos that was begun in the folder: removed where its node is the one that was typed.
    pub(crate) fn remove_foreign(&self, task: &Remembered) -> Option<String> {
        let Remembered { node, uuid, .. } = task;
        if *node == self.request.node.to_string() {
            let removed = call_off(
                &self.request.node,
                self.request.token.as_ref(),
                uuid,
                &self.request.limits,
            );
            return removed.err();
        }
        Some(format!(
            "the folder was of a task of {node}, which was not asked any more: remove the task {uuid} on its page"
        ))
    }

    /// Fetches the results of a task, and makes the flight of them.
    fn fetch(
        &self,
        uuid: &str,
        options: &str,
        place: &Place,
        warnings: &mut Vec<String>,
    ) -> Result<Reconstructed, Trouble> {
        let made = self.flight(uuid, options, place);
        let made = made.map_err(|trouble| {
            // They are fetched from their beginning, whatever they were.
            place.throw_away(ARCHIVE);
            place.throw_away(ODM);
            match trouble {
                Trouble::Worthless(fault) => {
                    let remedy = format!(
                        "{}; to begin anew, remove {} and the task {uuid} on the node",
                        fault.remedy,
                        place.work.display()
                    );
                    Trouble::Final(Fault::new(fault.what, remedy))
                }
                other => other,
            }
        })?;
        // It is one that can be read: nobody needs the node's any more.
        self.remove(uuid, place, warnings);
        Ok(made)
    }

    /// The flight that a task's results are, on the disk.
    fn flight(&self, uuid: &str, options: &str, place: &Place) -> Result<Reconstructed, Trouble> {
        let archive = self.download(uuid, place)?;
        let odm = place.fresh(ODM).map_err(Trouble::Here)?;
        let limits = &self.request.limits;
        unzip(&archive, &odm, &outputs(options), limits, self.progress)?;
        let made = results::flight(place, &self.sent, &self.request.photos, self.progress);
        made.map_err(|trouble| match self.progress.is_cancelled() {
            true => Trouble::Cancelled,
            false => trouble,
        })
    }

    /// Fetches the archive, from its beginning where it broke off: nodes take no notice of ranges.
    fn download(&self, uuid: &str, place: &Place) -> Result<PathBuf, Trouble> {
        let limits = &self.request.limits;
        let path = format!("/task/{uuid}/download/all.zip");
        let mut pause = limits.shortest_pause;
        let mut attempt = 0;
        loop {
            attempt += 1;
            self.progress.stage("fetching the results");
            let (mut file, archive) = place.create(ARCHIVE).map_err(Trouble::Here)?;
            let moved = |came: u64, of: Option<u64>| {
                // (The line looks by itself whether it is wanted.)
                let _ = self.progress.advance(came, of.unwrap_or(u64::MAX));
            };
            let to = (&mut file, archive.as_path());
            match self.client.download(&path, to, limits.download, moved) {
                Ok(_) => return Ok(archive),
                // A node says "not ready" for a moment after it is.
                Err(Trouble::Passing(_) | Trouble::Refused(_)) if attempt < DOWNLOADS => {}
                Err(trouble) => return Err(trouble),
            }
            wait(pause, self.progress)?;
            pause = (pause * 2).min(limits.longest_pause);
        }
    }

    /// What is told of a run that has come to nothing; a task whose run was cancelled is called off.
    pub(crate) fn ended(&self, trouble: Trouble, place: &Place) -> FileError {
        let node = &self.request.node;
        if trouble != Trouble::Cancelled {
            return trouble.at(node);
        }
        let Some(task) = place.remembered() else {
            return trouble.at(node);
        };
        self.progress.stage("cancelling the task on the node");
        let (token, limits) = (self.request.token.as_ref(), &self.request.limits);
        let called_off = match has_results(node, token, &task.uuid, limits) {
            Ok(true) => {
                // Hours of somebody's computer.
                let what = "the task has ended on the node, which keeps its results";
                let fault = Fault::new(what, "start it once more: it fetches them");
                return FileError::new(Path::new(&node.to_string()), fault);
            }
            Ok(false) | Err(Trouble::Unknown) => call_off(node, token, &task.uuid, limits),
            Err(trouble) => Err(stays(trouble, &task.uuid, node)),
        };
        let fault = match called_off {
            Ok(said) => {
                place.forget();
                place.forget_log();
                Fault::new(said, "start it again when you want it")
            }
            Err(said) => Fault::new(said, "start it once more: it goes on with that task"),
        };
        FileError::new(Path::new(&node.to_string()), fault)
    }
}
