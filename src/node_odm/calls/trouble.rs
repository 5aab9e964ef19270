//! What can go wrong with a call, by what is to be done about it.

use std::path::Path;

use crate::address::Address;
use crate::fault::Fault;
use crate::files::FileError;

/// Why a call brought nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Trouble {
    /// The line or the node failed in passing: the same call may work a moment later.
    Passing(Fault),
    /// The node knows no such task.
    Unknown,
    /// The node said no, in these words of its own.
    Refused(String),
    /// It makes no sense to ask again.
    Final(Fault),
    /// The results are none, however often they are fetched.
    Worthless(Fault),
    /// A file on this computer.
    Here(FileError),
    /// The user cancelled.
    Cancelled,
}

impl Trouble {
    /// As what is told, where nothing better is known.
    pub(crate) fn at(self, node: &Address) -> FileError {
        let fault = match self {
            Self::Here(error) => return error,
            Self::Passing(fault) | Self::Final(fault) | Self::Worthless(fault) => fault,
            Self::Unknown => Fault::new(
                "the node does not know the task any more (it was started anew, or somebody removed the task)",
                "start it once more: the photos are sent again",
            ),
            Self::Refused(words) => refused(&words),
            Self::Cancelled => Fault::new("cancelled", "start it again when you want it"),
        };
        FileError::new(Path::new(&node.to_string()), fault)
    }
}

/// A node's disk that is full: NodeODM hands the system's words on.
pub(crate) fn disk_is_full(words: &str) -> bool {
    words.contains("ENOSPC") || words.to_ascii_lowercase().contains("no space left")
}

/// What to do about a node's disk that is full.
pub(crate) const FREE_SPACE: &str = "free space there (tasks that have ended are removed on the node's own page), then start it once more";

/// The node's own words, with what to do about those that are known.
fn refused(words: &str) -> Fault {
    if disk_is_full(words) {
        return Fault::new(format!("the node's disk is full (\"{words}\")"), FREE_SPACE);
    }
    let remedy = if words.contains("concurrent tasks") || words.contains("slow down") {
        "wait until other tasks have ended, then start it once more"
    } else if words.contains("nodes") {
        "ask whoever runs the cluster, or try again later"
    } else {
        "mend that, or ask whoever runs the node"
    };
    Fault::new(format!("the node refuses: \"{words}\""), remedy)
}
