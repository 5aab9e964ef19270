//! Changes that are not saved are kept aside: a machine that loses its power takes half a minute's corrections along, and not an hour's.
//!
//! ```text
//! folder    where they lie, and whether their window is gone
//! applying  when they are kept, when they go, and what she does with what was left behind
//! keeping   writes them, as a job
//! ```
//!
//! They lie where the preferences are, in a folder `unsaved`: a flight.toml with what saving writes beside it. Saved or
//! discarded, they go. What a window left behind that ended badly is offered by the next one (`panels/strips/kept_aside.rs`): opened it is a
//! flight with changes, which is saved where it was.

mod applying;
mod folder;
mod keeping;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use chrono::{DateTime, Local};

use self::folder::KeptFolder;
pub use self::folder::KeptOf;
use crate::flight::FlightSettings;

/// After a change it is kept aside so much later, with all that came meanwhile.
const AFTER: Duration = Duration::from_secs(30);

/// What is kept aside, and what was found that windows before this one had kept.
#[derive(Debug)]
pub struct KeptAside {
    /// Where; `None` keeps nothing.
    root: Option<PathBuf>,
    /// How long after a change.
    after: Duration,
    /// What windows that ended badly left.
    left: Vec<Left>,
    /// This window's folder, once there is something in it.
    own: Option<Arc<KeptFolder>>,
    /// What it holds.
    kept: Option<Kept>,
    /// Whether anything was done since.
    is_touched: bool,
    /// When it is written.
    due: Option<Instant>,
    /// Whether it was said that it cannot be.
    has_failed: bool,
}

/// What of a flight is kept: another one of these is other changes.
#[derive(Debug, Clone, PartialEq)]
struct Kept {
    /// Which flight on the screen.
    flight: u64,
    settings: FlightSettings,
    /// Photos whose outlines are on the screen, with their revisions.
    outlines: Vec<(usize, u64)>,
}

/// Changes that another window left behind.
#[derive(Debug)]
struct Left {
    folder: KeptFolder,
    of: KeptOf,
    /// When they were kept.
    at: String,
    /// As which flight on the screen they were opened.
    opened: Option<u64>,
    /// Whether they are saved, and only the folder is still there.
    is_withdrawn: bool,
    /// Whether she wants to see nothing of them now.
    is_put_off: bool,
}

impl Left {
    /// Offers them no more, once.
    fn withdraw(&mut self) {
        if !std::mem::replace(&mut self.is_withdrawn, true) {
            self.folder.withdraw();
        }
    }
}

/// A step with what was left behind, by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeptStep {
    /// Opens it.
    Open(usize),
    /// Hides it until the program starts again.
    PutOff(usize),
}

impl Default for KeptAside {
    fn default() -> Self {
        Self {
            root: None,
            after: AFTER,
            left: Vec::new(),
            own: None,
            kept: None,
            is_touched: false,
            due: None,
            has_failed: false,
        }
    }
}

impl KeptAside {
    /// Keeps changes in `root`, and finds what was left there.
    pub fn in_folder(root: PathBuf, after: Option<Duration>) -> Self {
        let left = KeptFolder::left_behind(&root).into_iter();
        let left = left.filter_map(|folder| {
            let at = DateTime::<Local>::from(folder.written()?);
            Some(Left {
                of: folder.whose()?,
                at: at.format("%Y-%m-%d %H:%M").to_string(),
                folder,
                opened: None,
                is_withdrawn: false,
                is_put_off: false,
            })
        });
        Self {
            left: left.collect(),
            root: Some(root),
            after: after.unwrap_or(AFTER),
            ..Self::default()
        }
    }

    /// What is offered: by its place whose it is, and when it was kept.
    pub fn offered(&self) -> impl Iterator<Item = (usize, &KeptOf, &str)> {
        let left = self.left.iter().enumerate();
        let offered = left.filter(|(_, left)| left.opened.is_none() && !left.is_put_off);
        offered.map(|(place, left)| (place, &left.of, left.at.as_str()))
    }

    /// Something may have been changed.
    pub(crate) fn touch(&mut self) {
        self.is_touched = true;
    }

    /// Nothing is unsaved any more.
    fn forget(&mut self) {
        (self.kept, self.due) = (None, None);
        if let Some(own) = self.own.take() {
            own.remove();
        }
    }

    /// The window is closed, and she was asked about what was not saved.
    pub(crate) fn end(&mut self) {
        self.forget();
        for left in self.left.drain(..).filter(|left| left.opened.is_some()) {
            left.folder.remove();
        }
    }
}
