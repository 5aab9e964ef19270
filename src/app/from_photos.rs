//! A new flight from photos: what its small window holds.

use std::collections::VecDeque;
use std::fmt;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use crate::fault::Fault;
use crate::node_odm::Address;
use crate::opening_preview::OpeningPreview;
use crate::reconstruct::{EngineName, Growth, PhotoSet, Quality, Reconstructed};

/// A step of making a flight from photos.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FromPhotosStep {
    /// Opens its small window, with this folder of photos.
    Ask(Option<PathBuf>),
    /// Says which COLMAP is installed.
    Colmap(InstalledColmap),
    /// Types into it.
    Fill(FromPhotosForm),
    /// Reconstructs.
    Start,
    /// Lets the run wait, or go on.
    Pause(bool),
    /// Opens the flight that came out while another one was looked at.
    Open,
}

/// A field of the small window that names a folder, or a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FolderField {
    /// The folder of the photos.
    Photos,
    /// The folder to make.
    To,
    /// The file of a calibration.
    Calibration,
}

/// What is typed and chosen in the small window.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FromPhotosForm {
    /// The folder of the photos.
    pub photos: String,
    /// The folder to make; empty for the one that is proposed.
    pub to: String,
    /// The coordinate system of the world, if it is not the zone of UTM.
    pub crs: String,
    /// The file of the calibration that is kept; empty where the lens is found from the photos.
    pub calibration: String,
    /// How much time the cloud may take.
    pub quality: Quality,
    /// What finds the poses.
    pub engine: EngineName,
    /// Whether the processor is to do all, also where there is a graphics card.
    pub processor_only: bool,
    /// A node that reconstructs in the computer's stead.
    pub node: NodeForm,
}

/// What is typed of a node.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct NodeForm {
    /// Whether it is to reconstruct.
    pub chosen: bool,
    /// Where it answers.
    pub address: String,
    /// What opens it; it is sent, and neither kept nor written.
    pub token: Secret,
    /// What OpenDroneMap is asked for, "name=value" apart by blanks.
    pub options: String,
    /// Whether photos and token may cross the network unencrypted.
    pub insecure: bool,
}

impl NodeForm {
    /// The address; an error is one line.
    ///
    /// # Errors
    /// Where it is none.
    pub fn typed(&self) -> Result<Address, Fault> {
        Address::parse(&self.address)
    }

    /// Whether the address is one that is only reached where somebody says that it may be unencrypted.
    pub fn is_open_to_all(&self) -> bool {
        self.typed()
            .is_ok_and(|address| !address.is_encrypted() && !address.is_here())
    }
}

/// A text that is not shown.
#[derive(Clone, PartialEq, Eq, Default)]
pub struct Secret(pub String);

impl fmt::Debug for Secret {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("***")
    }
}

/// What a run on a node tells while it works, and after it was cancelled.
#[derive(Debug, Default)]
pub(crate) struct FromNode {
    /// The node's last messages.
    pub(crate) messages: VecDeque<String>,
    /// What came of calling the task off, once that is known.
    pub(crate) called_off: Option<String>,
}

/// So many messages of a node are kept to look at.
const MESSAGES: usize = 200;

impl FromNode {
    /// Takes a message.
    pub(crate) fn hear(&mut self, message: &str) {
        if self.messages.len() >= MESSAGES {
            self.messages.pop_front();
        }
        self.messages.push_back(message.to_owned());
    }
}

/// Its name and version ("COLMAP 3.8"), or why it cannot be taken: one line.
pub type InstalledColmap = Result<String, String>;

/// What was found in the folder of the photos.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundPhotos {
    /// The photos; an error is one line.
    pub photos: Result<PhotoSet, String>,
    /// The folder that is proposed for their flight.
    pub proposed: PathBuf,
    /// About how long the embedded engine takes here, in the order of [`Quality::ALL`]; empty without photos.
    pub takes: Vec<String>,
}

/// What the last run came to.
#[derive(Debug, Clone, PartialEq)]
pub enum Ended {
    /// She cancelled it.
    Cancelled,
    /// It failed: one line.
    Failed(String),
    /// A flight came out.
    Made(Box<Reconstructed>),
}

/// What the small window holds.
#[derive(Debug, Default)]
pub struct FromPhotos {
    /// What is typed.
    pub form: FromPhotosForm,
    /// What lies in the folder that is typed; `None` until it has been looked at.
    pub found: Option<FoundPhotos>,
    /// Whether the run begins once that was looked at: Start was clicked right behind a field.
    pub(crate) starts_then: bool,
    /// Which COLMAP is installed; `None` until it has been looked for.
    pub colmap: Option<InstalledColmap>,
    /// What the last run came to, until another folder is named.
    pub ended: Option<Ended>,
    /// Whether the run that failed last can go on where it was: nothing was wrong with the photos.
    pub(crate) goes_on: bool,
    /// Photos that could not be opened as a flight: they can be reconstructed.
    pub offered: Option<PathBuf>,
    /// The model of the run, while it grows and is looked at.
    pub growing: Option<OpeningPreview>,
    /// Where the run puts the model as it is now, if nobody is about to take the one before.
    pub(crate) grown: Arc<Mutex<Option<Growth>>>,
    /// What the last run on a node tells; `None` where it was none.
    pub(crate) node: Option<Arc<Mutex<FromNode>>>,
    /// Held by the run that writes: a cancelled one stops at its next look, and the next one waits for that.
    pub(crate) writing: Arc<Mutex<()>>,
}

impl FromPhotos {
    /// The photos that were found.
    pub fn photos(&self) -> Option<&PhotoSet> {
        self.found.as_ref()?.photos.as_ref().ok()
    }
}
