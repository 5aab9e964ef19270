//! The page of the fragments: those of the selected photo, outlined by an engine, corrected by hand, measured.
//!
//! ```text
//! command        what she does on the page
//! applying       does that
//! engine_choice  which engine outlines next
//! network        a network of hers, read as a job
//! outlining      an engine's work, as a job
//! measured       what the outlines come to
//! measuring      measures them, as a job whenever they change
//! outlined       the photos that are outlined, as a job takes them along
//! all_photos     measures all of them together, as a job that she starts
//! files          saved beside flight.toml, and read from there
//! exporting      tables, report and outlines, as the command `delineate` writes them
//! ```
//!
//! Outlines are of the undistorted photo at its full size. A change is made at once and can be undone without
//! limit; measuring follows behind. Outlines of a photo stay in memory until the flight is closed: four bytes a
//! pixel, and what engines leave for coarser and finer of the photo that was outlined last.

mod all_photos;
mod applying;
mod command;
mod engine_choice;
mod exporting;
pub(crate) mod files;
mod measured;
mod measuring;
mod network;
mod outlined;
mod outlining;

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

pub use command::{FragmentStep, FragmentTool};
pub use engine_choice::{EngineChoice, Network};
pub use measured::{AllMeasured, MeasuredFragments};

use crate::delineation::{Outliner, Regions};
use crate::fault::Fault;
use crate::labels::{Change, Editing, FINES, LabelImage, Outlines};
use crate::scale::ScaleField;

/// A photo's outlines on the screen.
#[derive(Debug)]
pub struct PhotoOutlines {
    /// With all that was changed by hand.
    pub editing: Editing,
    /// The number of the last change that made them what they are, 0 before the first: what was made of another one is told
    /// from what is of now, and a change that is undone and made again is the same one.
    pub revision: u64,
    /// Which revision the files hold.
    pub saved: Option<u64>,
    /// Those that nobody looked at, the most doubtful first, with how sure they are; without those that lie on scale objects.
    pub doubtful: Vec<(u32, f64)>,
    /// What they come to; of which revision.
    pub measured: Option<(u64, Arc<MeasuredFragments>)>,
    /// The fragments that lie on scale objects, by number, as they were measured last; and which outlining gave the numbers.
    on_objects: (u64, BTreeSet<u32>),
    /// The numbers of the changes that were made, and of those that were undone, the last one last.
    made: Vec<u64>,
    undone: Vec<u64>,
    /// How many changes there ever were.
    changes: u64,
    /// What outlined them: of the first ones (0), and of those changes that were an outlining.
    by: BTreeMap<u64, Outliner>,
    /// What was said of those that were taken from files, by the same numbers.
    notes: BTreeMap<u64, Vec<String>>,
    /// Whether nothing was outlined before the first change.
    from_nothing: bool,
}

impl PhotoOutlines {
    /// What a file beside the flight has.
    pub fn saved(outlines: Outlines, by: Outliner) -> Self {
        Self::begun(outlines, by, Some(0), false)
    }

    /// What outlined a photo of which nothing was outlined, with what is to be said of it; undo leads back to nothing.
    pub fn first(outlines: &Outlines, by: Outliner, notes: Vec<String>) -> Self {
        let labels = outlines.labels();
        let nothing = LabelImage {
            labels: vec![FINES; labels.labels.len()],
            ..*labels
        };
        let nothing = Outlines::new(nothing, BTreeMap::new());
        let mut first = Self::begun(nothing, Outliner::default(), None, true);
        first.outline_anew(outlines, by, notes);
        first
    }

    fn begun(outlines: Outlines, by: Outliner, saved: Option<u64>, from_nothing: bool) -> Self {
        Self {
            doubtful: outlines.doubtful(),
            editing: Editing::new(outlines),
            revision: 0,
            saved,
            measured: None,
            on_objects: (0, BTreeSet::new()),
            made: Vec::new(),
            undone: Vec::new(),
            changes: 0,
            by: BTreeMap::from([(0, by)]),
            notes: BTreeMap::new(),
            from_nothing,
        }
    }

    /// What outlined those of now.
    pub fn by(&self) -> &Outliner {
        // The first is always there.
        self.by.get(&self.outlined()).unwrap_or(&NOBODY)
    }

    /// What is to be said of the outlines that were taken from a file, as long as they are there.
    pub fn notes(&self) -> &[String] {
        let notes = self.notes.get(&self.outlined());
        notes.map_or(&[][..], Vec::as_slice)
    }

    /// The number of the last change that was an outlining, 0 where none was.
    fn outlined(&self) -> u64 {
        let mut made = self.made.iter().rev();
        let last = made.find(|made| self.by.contains_key(made));
        last.copied().unwrap_or(0)
    }

    /// Whether all that was outlined is undone.
    pub fn is_nothing(&self) -> bool {
        self.from_nothing && self.made.is_empty()
    }

    /// They become these, of which that is to be said.
    pub(crate) fn outline_anew(&mut self, outlines: &Outlines, by: Outliner, notes: Vec<String>) {
        let change = self.now().become_these(outlines);
        self.make(change);
        // Where nothing has changed it is that of now all the same.
        self.by.insert(self.revision, by);
        self.notes.insert(self.revision, notes);
        self.list_doubtful();
    }

    /// As they are now.
    pub fn now(&self) -> &Outlines {
        self.editing.now()
    }

    /// Whether they are what a file had when they were read.
    fn is_as_read(&self) -> bool {
        self.revision == 0 && !self.from_nothing
    }

    /// Whether no file holds them.
    pub fn is_changed(&self) -> bool {
        match self.is_nothing() {
            // Files hold what is undone.
            true => self.saved.is_some(),
            false => self.saved != Some(self.revision),
        }
    }

    /// What they come to, if that is known of those of now.
    pub fn measured(&self) -> Option<&MeasuredFragments> {
        let (revision, measured) = self.measured.as_ref()?;
        (*revision == self.revision).then_some(&**measured)
    }

    fn make(&mut self, change: Change) {
        if !change.is_nothing() {
            self.editing.make(change);
            self.changes += 1;
            self.made.push(self.changes);
            self.undone.clear();
            self.changed();
        }
    }

    /// Takes the last change back.
    fn undo(&mut self) {
        if self.editing.undo() {
            self.undone.extend(self.made.pop());
            self.changed();
        }
    }

    /// Makes the change again that was undone last.
    fn redo(&mut self) {
        if self.editing.redo() {
            self.made.extend(self.undone.pop());
            self.changed();
        }
    }

    fn changed(&mut self) {
        self.revision = self.made.last().copied().unwrap_or(0);
        self.list_doubtful();
    }

    /// Takes what those of a revision come to.
    fn take_measured(&mut self, revision: u64, measured: MeasuredFragments) {
        if revision == self.revision {
            self.on_objects = (self.outlined(), measured.on_objects.clone());
            self.list_doubtful();
        }
        self.measured = Some((revision, Arc::new(measured)));
    }

    /// The fragments that lie on scale objects, by number, as far as that is known: they are no rock, and none to be looked at.
    pub fn on_objects(&self) -> Option<&BTreeSet<u32>> {
        let (outlined, on_objects) = &self.on_objects;
        (*outlined == self.outlined()).then_some(on_objects)
    }

    fn list_doubtful(&mut self) {
        let mut doubtful = self.now().doubtful();
        if let Some(on_objects) = self.on_objects() {
            doubtful.retain(|(number, _)| !on_objects.contains(number));
        }
        self.doubtful = doubtful;
    }
}

/// Who outlined what nobody has.
static NOBODY: Outliner = Outliner {
    engine: String::new(),
    habits: None,
    spread: None,
};

/// The page of the fragments.
#[derive(Default)]
pub struct Fragments {
    /// The engine that outlines next.
    pub engine: EngineChoice,
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
    /// What all of them came to when they were measured last.
    pub all: Option<AllMeasured>,
    /// By photo.
    photos: BTreeMap<usize, PhotoOutlines>,
    /// All regions of the photo that was outlined last.
    regions: Option<(usize, Arc<Regions>)>,
    /// The scale of every pixel of the photo that was measured last.
    field: Option<(usize, Arc<ScaleField>)>,
    /// Photos whose files were looked for, and read where there are any.
    sought: Vec<usize>,
    /// The photo whose files were read last, or are.
    reading: Option<usize>,
    /// The photo that is outlined now, while one is, and those whose turn comes after it.
    outlining: Option<usize>,
    waiting: VecDeque<usize>,
    /// Whether all are outlined, and not the selected one alone.
    outlines_all: bool,
    /// Why outlines of another tool were not taken.
    pub(crate) masks_refused: Option<String>,
}

/// The brush where nobody chose another, pixels.
const USUAL_BRUSH: f64 = 12.0;

impl Fragments {
    /// The outlines of a photo, if there are any.
    pub fn of(&self, photo: usize) -> Option<&PhotoOutlines> {
        self.photos.get(&photo).filter(|of| !of.is_nothing())
    }

    /// Whether any photo's outlines are on the screen.
    pub fn is_any(&self) -> bool {
        self.photos.values().any(|of| !of.is_nothing())
    }

    /// How many photos are outlined before this one, the one of now among them; `None` where it does not wait.
    pub fn before(&self, photo: usize) -> Option<usize> {
        if self.outlining == Some(photo) {
            return Some(0);
        }
        let place = self.waiting.iter().position(|waiting| *waiting == photo);
        place.map(|place| place + 1)
    }

    /// How many photos wait for their outlining.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Whether outlines are not saved.
    pub fn is_changed(&self) -> bool {
        self.photos.values().any(PhotoOutlines::is_changed)
    }

    /// Photos with outlines on the screen, and their revisions.
    pub(crate) fn revisions(&self) -> Vec<(usize, u64)> {
        let photos = self.photos.iter().filter(|(_, of)| !of.is_nothing());
        photos.map(|(photo, of)| (*photo, of.revision)).collect()
    }

    /// Half the width of the brush, pixels of the photo.
    pub fn brush_radius(&self) -> f64 {
        match self.brush {
            0.0 => USUAL_BRUSH,
            brush => brush,
        }
    }

    /// The same of a flight whose photos have other places now; and the photos that are in it no more, with outlines that no file
    /// has.
    pub(crate) fn moved(mut self, now_at: impl Fn(usize) -> Option<usize>) -> (Self, Vec<usize>) {
        let mut gone = Vec::new();
        let photos = std::mem::take(&mut self.photos);
        for (photo, of) in photos {
            match now_at(photo) {
                Some(now) => {
                    self.photos.insert(now, of);
                }
                None if of.is_changed() => gone.push(photo),
                None => {}
            }
        }
        self.regions = self
            .regions
            .and_then(|(photo, of)| Some((now_at(photo)?, of)));
        self.sought = self.sought.into_iter().filter_map(&now_at).collect();
        self.reading = None;
        self.outlining = self.outlining.and_then(&now_at);
        self.waiting = self.waiting.into_iter().filter_map(&now_at).collect();
        (self, gone)
    }

    /// The same of the flight that was read again: fields of scales may be others, and so all measures.
    pub(crate) fn of_another_surface(mut self) -> Self {
        self.field = None;
        self.all = None;
        for of in self.photos.values_mut() {
            of.measured = None;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whose_turn_it_is() {
        let fragments = Fragments {
            outlining: Some(4),
            waiting: VecDeque::from([2, 7]),
            ..Fragments::default()
        };
        let before = [4, 2, 7, 1].map(|photo| fragments.before(photo));
        assert_eq!(before, [Some(0), Some(1), Some(2), None]);
    }
}
