//! Outlines of a photo's fragments, and all that was done to them by hand.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Change, FINES, LabelImage, NOT_ROCK};

/// The fragments of a photo, and how sure each is.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlines {
    labels: LabelImage,
    /// The chance, 0 to 1, that a fragment is a whole one, as the engine that outlined it saw it; those that a
    /// person shaped or looked at are not in it.
    sure: BTreeMap<u32, f64>,
}

impl Outlines {
    /// A label image with how sure its fragments are, by number. Those without are taken for looked at.
    pub fn new(labels: LabelImage, sure: BTreeMap<u32, f64>) -> Self {
        Self { labels, sure }
    }

    /// The label image.
    pub fn labels(&self) -> &LabelImage {
        &self.labels
    }

    /// The label image alone.
    pub fn into_labels(self) -> LabelImage {
        self.labels
    }

    /// How sure the fragments are that nobody looked at, by number.
    pub fn all_sure(&self) -> &BTreeMap<u32, f64> {
        &self.sure
    }

    /// How sure a fragment is, 0 to 1; `None` where a person looked at it.
    pub fn sure(&self, number: u32) -> Option<f64> {
        self.sure.get(&number).copied()
    }

    /// Those that nobody looked at, the most doubtful first.
    pub fn doubtful(&self) -> Vec<(u32, f64)> {
        let areas = self.labels.areas();
        let is_there = |number: u32| areas.get(number as usize).is_some_and(|area| *area > 0);
        let of = self.sure.iter().map(|(number, sure)| (*number, *sure));
        let mut doubtful: Vec<(u32, f64)> = of.filter(|(number, _)| is_there(*number)).collect();
        doubtful.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        doubtful
    }

    /// The label at a place of the photo, pixels from the outer corner of its top left one; `None` outside.
    pub fn at(&self, place: glam::DVec2) -> Option<u32> {
        let place = self.labels.place_of(place)?;
        self.labels.labels.get(place).copied()
    }

    /// The fragment at a place, if there is one.
    pub fn fragment_at(&self, place: glam::DVec2) -> Option<u32> {
        let label = self.at(place)?;
        (label != FINES && label != NOT_ROCK).then_some(label)
    }

    fn change(&mut self, change: &Change, undo: bool) {
        change.onto(&mut self.labels, undo);
        for (number, before, after) in &change.sure {
            match if undo { before } else { after } {
                Some(sure) => self.sure.insert(*number, *sure),
                None => self.sure.remove(number),
            };
        }
    }
}

/// Outlines with every change that was made, so that each can be undone.
#[derive(Debug, Clone, PartialEq)]
pub struct Editing {
    /// A job may look at them while she edits on: then they are copied before they change.
    now: Arc<Outlines>,
    done: Vec<Change>,
    undone: Vec<Change>,
}

impl Editing {
    /// Begins with these.
    pub fn new(outlines: Outlines) -> Self {
        Self {
            now: Arc::new(outlines),
            done: Vec::new(),
            undone: Vec::new(),
        }
    }

    /// As they are now.
    pub fn now(&self) -> &Outlines {
        &self.now
    }

    /// The same, to be looked at while they are changed: label images of many photos are gigabytes.
    pub fn shared(&self) -> Arc<Outlines> {
        self.now.clone()
    }

    /// How many changes made them what they are.
    pub fn changes(&self) -> usize {
        self.done.len()
    }

    /// Makes a change of what is now; what was undone is forgotten. What changes nothing is no step.
    pub fn make(&mut self, change: Change) {
        if !change.is_nothing() {
            Arc::make_mut(&mut self.now).change(&change, false);
            self.done.push(change);
            self.undone.clear();
        }
    }

    /// Takes the last change back; false where there is none.
    pub fn undo(&mut self) -> bool {
        let Some(change) = self.done.pop() else {
            return false;
        };
        Arc::make_mut(&mut self.now).change(&change, true);
        self.undone.push(change);
        true
    }

    /// Makes the change again that was undone last; false where there is none.
    pub fn redo(&mut self) -> bool {
        let Some(change) = self.undone.pop() else {
            return false;
        };
        Arc::make_mut(&mut self.now).change(&change, false);
        self.done.push(change);
        true
    }

    /// Whether there is a change to undo, and one to make again.
    pub fn can(&self) -> [bool; 2] {
        [!self.done.is_empty(), !self.undone.is_empty()]
    }
}
