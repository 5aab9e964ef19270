//! Photos become a flight on a NodeODM or a ClusterODM: the engine of OpenDroneMap on a larger machine.
//!
//! ```text
//! address    where a node answers, and the token that opens it
//! limits     how long is waited, how much is taken
//! calls/     calls to a node, and what can go wrong with them
//! options    what is asked of OpenDroneMap, held against what the node knows
//! outputs    which files are asked for, by these options
//! geo_txt    where photos were taken, as OpenDroneMap reads it
//! names      what photos are called there, and back
//! sent       all that is sent
//! upload     several files at once, again where the line fails
//! task       begun, watched, called off
//! place      the folder of a run, and what the next one goes on with
//! unzip      what comes back, of which nothing is trusted
//! results    the flight
//! run        all of that, one after the other
//! ```
//!
//! The order of a run: the node is asked what it is and what it knows, a task is begun, files are sent, the task is
//! committed, watched, its results fetched, unpacked beside, read, moved into place; `flight.toml` is the last file,
//! and then the task is removed from the node. So whatever breaks off, the folder is a flight or says that it is
//! unfinished, and the same run goes on with the task that the node still has.
//!
//! The protocol is NodeODM's (`docs/index.adoc` and `libs/` of OpenDroneMap/NodeODM), as it was measured with
//! NodeODM 2.2.4 and ClusterODM 1.5.8. This room stands on floor 5, beside `reconstruct`, whose photos and folders it
//! shares. Only the address that the user typed is contacted; the token is neither printed nor written.

mod address;
mod calls;
mod geo_txt;
mod limits;
mod names;
mod options;
mod outputs;
mod place;
mod results;
mod run;
mod sent;
mod task;
mod unzip;
mod upload;

#[cfg(test)]
use fragscale_core::geodesy;
use fragscale_core::{fault, files, flight, jobs, units};
use fragscale_formats as formats;
use fragscale_opening as opening;
use fragscale_reconstruct as reconstruct;

use std::path::{Path, PathBuf};

pub use self::address::{Address, Token};
pub use self::limits::Limits;
pub use self::options::Asked;

use self::calls::client::Client;
use self::calls::{answers, client, line, multipart, patience, tls, trouble};
use self::files::FileError;
use self::jobs::Progress;
use self::place::{Place, told};
use self::reconstruct::{Reconstructed, check_new_folder};
use self::run::Run;
use self::sent::Sent;

/// What is to be reconstructed, and where.
#[derive(Debug, Clone)]
pub struct NodeRequest {
    /// The folder of the photos.
    pub photos: PathBuf,
    /// The folder that comes out: new, empty, or one of a run that did not end.
    pub to: PathBuf,
    /// The node.
    pub node: Address,
    /// What opens it.
    pub token: Option<Token>,
    /// Whether photos and token may go unencrypted over a network.
    pub insecure: bool,
    /// What OpenDroneMap is asked for.
    pub options: Vec<Asked>,
    /// Control points; without it the `gcp_list.txt` among the photos, where there is one.
    pub control_points: Option<PathBuf>,
    /// How long is waited, how much is taken.
    pub limits: Limits,
}

/// Reconstructs photos on a node. `heard` is told the node's messages, a line each.
///
/// # Errors
/// With the file, folder or node that is to blame. Where a task of ours is on the node by then, the same request goes
/// on with it. Cancelled, the task is cancelled and removed from the node, and the error's `what` says whether that
/// worked.
pub fn reconstruct_on_node(
    request: &NodeRequest,
    heard: &dyn Fn(&str),
    progress: &Progress,
) -> Result<Reconstructed, FileError> {
    let node = &request.node;
    node.may_be_used(request.insecure)
        .map_err(|fault| FileError::new(Path::new("--node"), fault))?;
    check_new_folder(&request.to, &request.photos)?;
    let sent = Sent::read(&request.photos, request.control_points.as_deref(), progress)?;
    let client = Client::new(
        node,
        request.token.as_ref(),
        &request.limits,
        Some(progress),
    );
    let run = Run {
        request,
        client,
        sent,
        heard,
        progress,
    };
    let options = run.greet().map_err(|trouble| trouble.at(node))?;
    // From here on something is left where it breaks off.
    let told = told(&node.to_string(), &options, &run.sent.told());
    let (place, foreign, ours) = Place::take(&request.to, &request.photos, &told)?;
    let mut warnings = run.sent.warnings.clone();
    warnings.extend(foreign.and_then(|task| run.remove_foreign(&task)));
    match run.to_the_end(&place, ours, &options, &mut warnings) {
        Ok(mut made) => {
            place.finish();
            warnings.append(&mut made.warnings);
            Ok(Reconstructed { warnings, ..made })
        }
        Err(trouble) => {
            let error = run.ended(trouble, &place);
            place.leave();
            Err(error)
        }
    }
}

#[cfg(test)]
mod tests;
