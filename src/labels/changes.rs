//! What an edit changes: pixels from one label to another, so that it can be undone to the bit.

use super::LabelImage;

/// Pixels next to each other in the order of rows, all of one label before and all of one after.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Run {
    first: usize,
    length: usize,
    before: u32,
    after: u32,
}

/// How sure a fragment is: `None` where a person looked at it.
pub(super) type Sure = Option<f64>;

/// The number of a fragment with how sure it was and is.
type ChangedSure = (u32, Sure, Sure);

/// An edit, made but not yet done.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    runs: Vec<Run>,
    pub(super) sure: Vec<ChangedSure>,
}

impl Change {
    /// Whether it changes nothing.
    pub fn is_nothing(&self) -> bool {
        self.runs.is_empty() && self.sure.iter().all(|(_, before, after)| before == after)
    }

    /// Whether only how sure fragments are changes, and no pixel.
    pub fn is_only_looked(&self) -> bool {
        self.runs.is_empty()
    }

    /// What makes labels others of as many pixels.
    pub(super) fn between(before: &LabelImage, after: &LabelImage, sure: Vec<ChangedSure>) -> Self {
        let mut runs = Runs::default();
        for (place, (before, after)) in before.labels.iter().zip(&after.labels).enumerate() {
            runs.add(place, *before, *after);
        }
        Self { runs: runs.0, sure }
    }

    /// Does it, or undoes it.
    pub(super) fn onto(&self, labels: &mut LabelImage, undo: bool) {
        for run in &self.runs {
            let label = if undo { run.before } else { run.after };
            labels.labels[run.first..run.first + run.length].fill(label);
        }
    }
}

/// Runs that are being made, in the order of places.
#[derive(Debug, Default)]
struct Runs(Vec<Run>);

impl Runs {
    fn add(&mut self, place: usize, before: u32, after: u32) {
        if before == after {
            return;
        }
        match self.0.last_mut() {
            Some(run)
                if run.first + run.length == place
                    && run.before == before
                    && run.after == after =>
            {
                run.length += 1;
            }
            _ => self.0.push(Run {
                first: place,
                length: 1,
                before,
                after,
            }),
        }
    }
}

/// A change that is being made: pixels are painted, the last paint stays.
#[derive(Debug)]
pub struct Painting<'a> {
    labels: &'a LabelImage,
    /// Places in the order of rows, with their new labels.
    painted: Vec<(usize, u32)>,
}

impl<'a> Painting<'a> {
    /// Nothing painted yet.
    pub fn on(labels: &'a LabelImage) -> Self {
        Self {
            labels,
            painted: Vec::new(),
        }
    }

    /// Paints a pixel, by its place in the order of rows.
    pub fn paint(&mut self, place: usize, label: u32) {
        self.painted.push((place, label));
    }

    /// What came of it. `looked_at` are the fragments that a person shaped; `sure` says how sure each was.
    pub fn done(mut self, looked_at: &[u32], sure: impl Fn(u32) -> Option<f64>) -> Change {
        // Stable: of one place the last paint comes last.
        self.painted.sort_by_key(|(place, _)| *place);
        let mut runs = Runs::default();
        for (at, (place, after)) in self.painted.iter().enumerate() {
            let is_last = self.painted.get(at + 1).is_none_or(|next| next.0 != *place);
            if let Some(before) = self.labels.labels.get(*place).filter(|_| is_last) {
                runs.add(*place, *before, *after);
            }
        }
        let looked_at = looked_at
            .iter()
            .map(|number| (*number, sure(*number), None));
        Change {
            runs: runs.0,
            sure: looked_at
                .filter(|(_, before, _)| before.is_some())
                .collect(),
        }
    }
}
