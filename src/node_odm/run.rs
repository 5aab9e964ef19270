//! A run: a task that is gone on with or begun, watched, fetched, and called off where the user cancels.

use std::path::{Path, PathBuf};

use crate::NodeRequest;
use crate::answers::{NodeInfo, State};
use crate::client::Client;
use crate::fault::Fault;
use crate::files::FileError;
use crate::jobs::Progress;
use crate::options::{Known, to_send};
use crate::patience::{patiently, wait};
use crate::place::{Log, Place, Remembered};
use crate::reconstruct::{Reconstructed, name_of};
use crate::results;
use crate::sent::Sent;
use crate::task::{Outcome, call_off, info, init, send, watch};
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
            Some(task) => self.goes_on(&task.uuid, place)?,
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
                Outcome::Completed => return self.fetch(&task, place, warnings),
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
    fn goes_on(&self, uuid: &str, place: &Place) -> Result<Option<String>, Trouble> {
        let limits = &self.request.limits;
        let info = patiently(limits, self.progress, || info(&self.client, uuid));
        let is_over = match info {
            Ok(info) => matches!(info.state(), Some(State::Failed | State::Cancelled)),
            Err(Trouble::Unknown) => {
                place.forget();
                return Ok(None);
            }
            Err(trouble) => return Err(trouble),
        };
        if !is_over {
            return Ok(Some(uuid.to_owned()));
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
        let task = Remembered {
            node: self.request.node.to_string(),
            uuid: uuid.clone(),
        };
        place.remember(&task).map_err(Trouble::Here)?;
        match send(&self.client, &uuid, &self.sent, limits, self.progress) {
            Ok(()) => Ok(uuid),
            // It is called off by whoever looks at the trouble.
            Err(Trouble::Cancelled) => Err(Trouble::Cancelled),
            Err(trouble) => {
                // Half of the photos are nothing to go on with.
                let _ = call_off(
                    &self.request.node,
                    self.request.token.as_ref(),
                    &uuid,
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
        let Remembered { node, uuid } = task;
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
        place: &Place,
        warnings: &mut Vec<String>,
    ) -> Result<Reconstructed, Trouble> {
        let archive = self.download(uuid, place)?;
        let odm = place.fresh("odm").map_err(Trouble::Here)?;
        unzip(&archive, &odm, &self.request.limits, self.progress)?;
        let made = results::flight(place, &self.sent, &self.request.photos, self.progress);
        let made = made.map_err(|error| match self.progress.is_cancelled() {
            true => Trouble::Cancelled,
            false => Trouble::Here(error),
        })?;
        self.remove(uuid, place, warnings);
        Ok(made)
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
            let (mut file, archive) = place.create("all.zip").map_err(Trouble::Here)?;
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
        let called_off = call_off(
            node,
            self.request.token.as_ref(),
            &task.uuid,
            &self.request.limits,
        );
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
