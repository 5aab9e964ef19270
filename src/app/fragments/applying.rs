//! Does what a step on the page of the fragments says.

use std::path::PathBuf;

use glam::DVec2;

use super::{FragmentStep, FragmentTool, Fragments};
use crate::fault::Fault;
use crate::labels::{Change, Outlines};
use crate::open_flight::OpenFlight;
use crate::photo_view::PhotoCommand;
use crate::scale::ImageKind;
use crate::size_distributions::Page;
use crate::state::State;

/// The widest brush, half of it, pixels.
const WIDEST: f64 = 400.0;

impl State {
    pub(crate) fn fragment_step(&mut self, step: FragmentStep) {
        if step.changes_outlines() && self.changes_would_be_lost() {
            return;
        }
        match step {
            FragmentStep::Outline => self.outline_photo(),
            FragmentStep::OutlineAll => self.outline_all(),
            FragmentStep::Masks { path, of } => self.read_masks(path, of),
            FragmentStep::Network(path) => self.read_network(path),
            FragmentStep::TakeDistribution => self.take_fragments_distribution(),
            FragmentStep::MeasureAll => self.measure_all_fragments(),
            FragmentStep::TakeAllDistributions => self.take_all_distributions(),
            FragmentStep::Export(to) => self.export_fragments(to),
            step => {
                let Some(open) = &mut self.open else {
                    return;
                };
                let shown = open.fragments.selected;
                if let Some(photo) = open.selected {
                    open.fragments.step(photo, step.clone());
                }
                let goes_on = matches!(
                    step,
                    FragmentStep::IsRight | FragmentStep::NextDoubtful | FragmentStep::Show(_)
                );
                if goes_on && open.fragments.selected != shown {
                    self.go_to_fragment();
                }
            }
        }
        self.measure_fragments();
    }

    /// Shows the page: the photo as fragments are outlined in it, and what files have of them.
    pub(crate) fn begin_fragments(&mut self) {
        if self.page != Page::Fragments || self.open.is_none() {
            return;
        }
        self.apply_to_photo(PhotoCommand::Image(ImageKind::Undistorted));
        self.read_outlines();
        self.measure_fragments();
    }

    /// Undo and redo of the selected photo's outlines.
    pub(crate) fn undo_fragments(&mut self, redo: bool) {
        if self.changes_would_be_lost() {
            return;
        }
        let Some(open) = &mut self.open else {
            return;
        };
        let photo = open.selected;
        let fragments = &mut open.fragments;
        fragments.drawing.clear();
        fragments.refused = None;
        if let Some(of) = photo.and_then(|photo| fragments.photos.get_mut(&photo)) {
            match redo {
                true => of.redo(),
                false => of.undo(),
            }
        }
        fragments.forget_gone(photo);
        self.measure_fragments();
    }

    /// Brings the selected fragment into the middle.
    fn go_to_fragment(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let middle = open.selected.and_then(|photo| {
            let of = open.fragments.of(photo)?;
            let number = open.fragments.selected?;
            middle_of(of.now(), number)
        });
        if let Some(middle) = middle {
            self.apply_to_photo(PhotoCommand::GoTo(middle));
        }
    }
}

/// Endings of files of outlines.
const MASKS: [&str; 6] = ["png", "tif", "tiff", "json", "geojson", "xml"];

impl State {
    /// Whether what was dropped is the selected photo's outlines: one file of such a kind, on the page of the fragments.
    pub(crate) fn may_be_masks(&self, paths: &[PathBuf]) -> bool {
        let [path] = paths else {
            return false;
        };
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let is_selected = self
            .open
            .as_ref()
            .is_some_and(|open| open.selected.is_some());
        self.page == Page::Fragments && is_selected && MASKS.iter().any(|known| ending == *known)
    }
}

/// The mean place of a fragment's pixels.
fn middle_of(outlines: &Outlines, number: u32) -> Option<DVec2> {
    let labels = outlines.labels();
    let (mut sum, mut count) = (DVec2::ZERO, 0.0);
    for (place, _) in labels
        .labels
        .iter()
        .enumerate()
        .filter(|(_, label)| **label == number)
    {
        sum += DVec2::new((place % labels.width) as f64, (place / labels.width) as f64);
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count + 0.5)
}

impl Fragments {
    fn step(&mut self, photo: usize, step: FragmentStep) {
        self.refused = None;
        match step {
            FragmentStep::Engine(engine) => self.engine = engine,
            FragmentStep::Tool(tool) => {
                self.drawing.clear();
                self.tool = tool;
            }
            FragmentStep::Brush(radius) => self.brush = radius.clamp(0.5, WIDEST),
            FragmentStep::Stroke(stroke) => self.stroke(photo, &stroke),
            FragmentStep::Click(at) => self.click(photo, at),
            FragmentStep::Finish => {
                let corners = std::mem::take(&mut self.drawing);
                self.stroke(photo, &corners);
            }
            FragmentStep::RemoveCorner => {
                self.drawing.pop();
            }
            FragmentStep::RemoveCorners => self.drawing.clear(),
            FragmentStep::Select(number) => self.selected = number,
            FragmentStep::Show(number) => self.selected = Some(number),
            FragmentStep::Delete => {
                if let Some(number) = self.selected.take() {
                    self.change(photo, |now| Ok(now.delete(number)));
                }
            }
            FragmentStep::NoRock => {
                if let Some(number) = self.selected.take() {
                    self.change(photo, |now| Ok(now.no_rock(number)));
                }
            }
            FragmentStep::IsRight => {
                let next = self.next_doubtful(photo);
                if let Some(number) = self.selected {
                    self.change(photo, |now| Ok(now.is_right(number)));
                }
                self.selected = next;
            }
            FragmentStep::NextDoubtful => self.selected = self.next_doubtful(photo),
            FragmentStep::Coarser(at) => {
                self.by_regions(photo, |regions, now| regions.coarser(now, at))
            }
            FragmentStep::Finer(at) => {
                self.by_regions(photo, |regions, now| regions.finer(now, at))
            }
            FragmentStep::Network(_)
            | FragmentStep::Outline
            | FragmentStep::OutlineAll
            | FragmentStep::Masks { .. }
            | FragmentStep::Export(_)
            | FragmentStep::MeasureAll
            | FragmentStep::TakeAllDistributions
            | FragmentStep::TakeDistribution => {}
        }
        self.forget_gone(Some(photo));
    }

    fn click(&mut self, photo: usize, at: DVec2) {
        match self.tool {
            FragmentTool::Grow => self.by_regions(photo, |regions, now| regions.grown(now, at)),
            FragmentTool::Brush => self.stroke(photo, &[at]),
            tool if tool.outlines() => {
                // A double click ends the outline where its first click put a corner.
                if self.drawing.last() != Some(&at) {
                    self.drawing.push(at);
                }
            }
            _ => self.selected = self.of(photo).and_then(|of| of.now().fragment_at(at)),
        }
    }

    fn stroke(&mut self, photo: usize, stroke: &[DVec2]) {
        self.drawing.clear();
        let selected = self.selected;
        let radius = self.brush_radius();
        let tool = self.tool;
        self.change(photo, |now| match tool {
            FragmentTool::Select | FragmentTool::Grow => Ok(now.nothing()),
            FragmentTool::Split => now.split(stroke),
            FragmentTool::Merge => now.merge(stroke),
            FragmentTool::Outline => now.outline(None, stroke),
            FragmentTool::Redraw => match selected {
                Some(number) => now.outline(Some(number), stroke),
                None => Err(Fault::new(
                    "no fragment is selected",
                    "click one (V), then redraw it",
                )),
            },
            FragmentTool::Brush => now.brush(stroke, radius),
            FragmentTool::Exclude => now.exclude(stroke, false),
            FragmentTool::Include => now.exclude(stroke, true),
        });
    }

    fn change(&mut self, photo: usize, change: impl FnOnce(&Outlines) -> Result<Change, Fault>) {
        let of = self.photos.get_mut(&photo);
        let Some(of) = of.filter(|of| !of.is_nothing()) else {
            let what = "nothing is outlined in this photo yet";
            self.refused = Some(Fault::new(what, "press 'Outline this photo' first"));
            return;
        };
        match change(of.now()) {
            Ok(change) => of.make(change),
            Err(fault) => self.refused = Some(fault),
        }
    }

    fn by_regions(
        &mut self,
        photo: usize,
        change: impl FnOnce(&crate::delineation::Regions, &Outlines) -> Result<Change, Fault>,
    ) {
        let regions = self.regions.as_ref().filter(|(of, _)| *of == photo);
        let Some(regions) = regions.map(|(_, regions)| regions.clone()) else {
            let what = "the regions of this photo are not known any more";
            self.refused = Some(Fault::new(what, "outline it anew; undo brings this back"));
            return;
        };
        self.change(photo, |now| change(&regions, now));
    }

    /// The most doubtful fragment behind the selected one; behind the last one the first.
    fn next_doubtful(&self, photo: usize) -> Option<u32> {
        let doubtful = &self.of(photo)?.doubtful;
        let selected = self.selected;
        let place = doubtful
            .iter()
            .position(|(number, _)| Some(*number) == selected);
        let next = place.map_or(0, |place| place + 1);
        let next = doubtful.get(next).or_else(|| doubtful.first());
        let next = next.map(|(number, _)| *number);
        next.filter(|next| Some(*next) != selected)
    }

    /// A fragment that is not there any more is not selected.
    fn forget_gone(&mut self, photo: Option<usize>) {
        let of = photo.and_then(|photo| self.of(photo));
        let is_there =
            |number: &u32| of.is_some_and(|of| of.now().labels().labels.contains(number));
        self.selected = self.selected.filter(is_there);
    }
}

impl OpenFlight {
    /// Whether a change of the selected photo's outlines can be undone, and made again.
    pub fn can_undo_fragments(&self) -> [bool; 2] {
        let of = self
            .selected
            .and_then(|photo| self.fragments.photos.get(&photo));
        of.map_or([false; 2], |of| of.editing.can())
    }

    /// Another photo is looked at.
    pub(crate) fn leave_fragments(&mut self) {
        self.fragments.selected = None;
        self.fragments.drawing.clear();
        self.fragments.refused = None;
        self.fragments.masks_refused = None;
    }
}
