//! The page of the fragments: those of the selected photo, outlined by an engine, corrected by hand, measured.
//!
//! ```text
//! command    what she does on the page
//! applying   does that
//! outlining  an engine's work, as a job
//! measured   what the outlines come to
//! measuring  measures them, as a job whenever they change
//! files      saved beside flight.toml, and read from there
//! ```
//!
//! Outlines are of the undistorted photo at its full size. A change is made at once and can be undone without
//! limit; measuring follows behind. Outlines of a photo stay in memory until the flight is closed: four bytes a
//! pixel, and what engines leave for coarser and finer of the photo that was outlined last.

mod applying;
mod command;
pub(crate) mod files;
mod measured;
mod measuring;
mod outlining;

use std::collections::BTreeMap;
use std::sync::Arc;

pub use command::{FragmentStep, FragmentTool};
pub use measured::MeasuredFragments;

use crate::delineation::Regions;
use crate::fault::Fault;
use crate::labels::{Change, Editing, Outlines};
use crate::scale::ScaleField;

/// A photo's outlines on the screen.
#[derive(Debug)]
pub struct PhotoOutlines {
    /// With all that was changed by hand.
    pub editing: Editing,
    /// What outlined them first, as it is named in files.
    pub engine: String,
    /// Counted up with each change, so that what was made of an earlier one is told from what is of now.
    pub revision: u64,
    /// Which revision the files hold.
    pub saved: Option<u64>,
    /// Those that nobody looked at, the most doubtful first, with how sure they are.
    pub doubtful: Vec<(u32, f64)>,
    /// What they come to; of which revision.
    pub measured: Option<(u64, Arc<MeasuredFragments>)>,
}

impl PhotoOutlines {
    /// What an engine or a file gave. `saved` where a file holds the same.
    pub fn new(outlines: Outlines, engine: String, saved: bool) -> Self {
        Self {
            doubtful: outlines.doubtful(),
            editing: Editing::new(outlines),
            engine,
            revision: 0,
            saved: saved.then_some(0),
            measured: None,
        }
    }

    /// As they are now.
    pub fn now(&self) -> &Outlines {
        self.editing.now()
    }

    /// Whether no file holds them.
    pub fn is_changed(&self) -> bool {
        self.saved != Some(self.revision)
    }

    /// What they come to, if that is known of those of now.
    pub fn measured(&self) -> Option<&MeasuredFragments> {
        let (revision, measured) = self.measured.as_ref()?;
        (*revision == self.revision).then_some(&**measured)
    }

    fn make(&mut self, change: Change) {
        if !change.is_nothing() {
            self.editing.make(change);
            self.changed();
        }
    }

    fn changed(&mut self) {
        self.revision += 1;
        self.doubtful = self.now().doubtful();
    }
}

/// The page of the fragments.
#[derive(Default)]
pub struct Fragments {
    /// By its place in `ENGINES`: the one that outlines next.
    pub engine: usize,
    /// What the mouse does in the photo.
    pub tool: FragmentTool,
    /// Half the width of the brush, pixels of the photo; 0 is the usual one.
    pub brush: f64,
    /// The corners of an outline that were clicked so far.
    pub drawing: Vec<glam::DVec2>,
    /// The fragment that is looked at, by its number.
    pub selected: Option<u32>,
    /// Why nothing came of the last step.
    pub refused: Option<Fault>,
    /// By photo.
    photos: BTreeMap<usize, PhotoOutlines>,
    /// All regions of the photo that was outlined last.
    regions: Option<(usize, Arc<Regions>)>,
    /// The scale of every pixel of the photo that was measured last.
    field: Option<(usize, Arc<ScaleField>)>,
    /// Photos whose files were looked for.
    sought: Vec<usize>,
}

/// The brush where nobody chose another, pixels.
const USUAL_BRUSH: f64 = 12.0;

impl Fragments {
    /// The outlines of a photo, if there are any.
    pub fn of(&self, photo: usize) -> Option<&PhotoOutlines> {
        self.photos.get(&photo)
    }

    /// Whether outlines are not saved.
    pub fn is_changed(&self) -> bool {
        self.photos.values().any(PhotoOutlines::is_changed)
    }

    /// Whether coarser, finer and growing know the regions of a photo.
    pub fn has_regions(&self, photo: usize) -> bool {
        self.regions.as_ref().is_some_and(|(of, _)| *of == photo)
    }

    /// Half the width of the brush, pixels of the photo.
    pub fn brush_radius(&self) -> f64 {
        match self.brush {
            0.0 => USUAL_BRUSH,
            brush => brush,
        }
    }

    /// The same of the flight that was read again: fields of scales may be others, and so all measures.
    pub(crate) fn of_another_surface(mut self) -> Self {
        self.field = None;
        for of in self.photos.values_mut() {
            of.measured = None;
        }
        self
    }
}
