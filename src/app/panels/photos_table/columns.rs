//! How wide the table's columns are: numbers as wide as they are, names as wide as there is room, and at rest
//! no column is half in sight.

use crate::exports::{ColumnKind, PHOTO_COLUMNS, PhotoColumn};
use crate::panels::rows::text_width;
use crate::scale::ScalePair;

/// The width of the check box that chooses a photo.
pub(super) const CHECK: f32 = 24.0;

/// The least that names have, so that numbers that matter first are in sight; short names are whole.
const LEAST_NAME: f32 = 60.0;

/// Names up to this width are whole before the scales to type are in sight: so wide may they be in the list of a window of 800
/// points. Longer ones, which are cut in most lists, give way to these scales.
const SHORT_NAME: f32 = 112.0;

/// A name narrower than this has no thumbnail beside it.
const WITH_THUMBNAIL: f32 = 128.0;

/// The columns in their order on the screen, with the widest number seen in each so far, points.
pub(super) struct Columns {
    /// What matters first comes first.
    pub(super) all: Vec<&'static PhotoColumn>,
    /// Of each, the widest name or number that a row in sight had.
    seen: Vec<f32>,
    pair: ScalePair,
    id: egui::Id,
}

/// Whether a column stands behind the others: the scales of the best line take the place of the corners', where these go to
/// Split-Desktop.
fn is_behind(column: &PhotoColumn, pair: ScalePair) -> bool {
    column.is_behind != (pair == ScalePair::Corners && column.kind == ColumnKind::Scale)
}

impl Columns {
    /// Those of the table, the scales that go to Split-Desktop before the others; numbers of another flight or unit, `of`, have
    /// other widths.
    pub(super) fn of(
        of: impl std::hash::Hash + std::fmt::Debug,
        pair: ScalePair,
        ui: &egui::Ui,
    ) -> Self {
        let of = (of, pair == ScalePair::Corners);
        let shown = PHOTO_COLUMNS.iter().filter(|column| column.width.is_some());
        let mut all: Vec<&'static PhotoColumn> = shown.collect();
        all.sort_by_key(|column| is_behind(column, pair));
        let id = ui.scope_id().with(("widths of numbers", of));
        let seen = ui.data(|data| data.get_temp(id));
        let seen = seen.unwrap_or_else(|| vec![0.0; all.len()]);
        Self {
            all,
            seen,
            pair,
            id,
        }
    }

    /// The width of each, with `room` points for them and `gap` between two.
    pub(super) fn widths(&self, room: f32, gap: f32) -> Vec<f32> {
        let wanted = self.all.iter().zip(self.seen.iter());
        let mut widths: Vec<f32> = wanted
            .map(|(column, seen)| match (column.kind, column.width) {
                (ColumnKind::Name, Some(usual)) => usual,
                (_, usual) => usual.unwrap_or_default().max(*seen),
            })
            .collect();
        let Some(name) = self.name() else {
            return widths;
        };
        let least_name = self.seen[name].clamp(LEAST_NAME, widths[name].max(LEAST_NAME));
        let beside_scales = match self.seen[name] > SHORT_NAME {
            true => LEAST_NAME,
            false => least_name,
        };
        let others = |(place, width): (usize, &f32)| (place != name).then_some(width + gap);
        let all: f32 = widths.iter().enumerate().filter_map(others).sum();
        let room = room - CHECK - gap;
        let left = if all + widths[name] <= room {
            room - all
        } else {
            // As many as are wholly in sight beside a name; the name fills the place up to the next one.
            let (mut left, usual) = (room, widths[name]);
            for (place, column) in self.all.iter().enumerate() {
                let least = match (is_behind(column, self.pair), column.kind) {
                    (true, _) => usual,
                    (false, ColumnKind::Scale) => beside_scales,
                    (false, _) => least_name,
                };
                let width = widths[place] + gap;
                if place == name {
                    continue;
                }
                if left - width < least {
                    break;
                }
                left -= width;
            }
            left.max(LEAST_NAME)
        };
        widths[name] = left;
        widths
    }

    /// Whether the column of this kind is wholly in sight of a table that is not moved aside.
    pub(super) fn is_in_sight(&self, kind: ColumnKind, widths: &[f32], ui: &egui::Ui) -> bool {
        let Some(place) = self.all.iter().position(|column| column.kind == kind) else {
            return false;
        };
        let gap = ui.spacing().item_spacing.x;
        let right = CHECK
            + widths
                .iter()
                .take(place + 1)
                .map(|width| gap + width)
                .sum::<f32>();
        right <= ui.available_width() + 0.5
    }

    /// Where the photos' names are.
    fn name(&self) -> Option<usize> {
        let is_name = |column: &&PhotoColumn| column.kind == ColumnKind::Name;
        self.all.iter().position(is_name)
    }

    /// Whether a thumbnail stands beside the names, with so many points for it and its gap: it cuts no name that is whole without it.
    pub(super) fn has_thumbnail(&self, thumbnail: f32, widths: &[f32]) -> bool {
        let Some(name) = self.name() else {
            return false;
        };
        // Long names are cut in any column.
        let usual = self.all[name].width.unwrap_or_default();
        let wanted = self.seen[name].min(usual);
        widths[name] >= WITH_THUMBNAIL && widths[name] - thumbnail >= wanted
    }

    /// Notes what a row in sight has in a column, beside a sign of so many points: a wider name or number makes it wider in the
    /// next frame.
    pub(super) fn note(&mut self, place: usize, text: &str, beside: f32, ui: &egui::Ui) {
        if let Some(seen) = self.seen.get_mut(place) {
            *seen = seen.max((beside + text_width(ui, text)).ceil());
        }
    }

    /// Keeps what was noted in this frame, which had columns of these widths and began with `before` known.
    pub(super) fn keep(self, widths: &[f32], before: &[f32], ui: &egui::Ui) {
        let is_name = |place: usize| Some(place) == self.name();
        let mut all = self.seen.iter().zip(widths).zip(before).enumerate();
        let is_wider = all.any(|(place, ((seen, width), before))| match is_name(place) {
            true => seen > before,
            false => seen > width,
        });
        if is_wider {
            // Nobody sees the frame in which it was too narrow: an idle window draws no second one.
            ui.ctx()
                .request_discard("a name or number is wider than its column");
        }
        ui.data_mut(|data| data.insert_temp(self.id, self.seen));
    }

    /// What was known of names and numbers in sight when this frame began.
    pub(super) fn seen(&self) -> Vec<f32> {
        self.seen.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What goes to Split-Desktop stands in front, and only the scales change their place with it.
    #[test]
    fn the_scales_for_split_desktop_are_in_front() {
        let in_front = |pair: ScalePair| -> Vec<&str> {
            let shown = PHOTO_COLUMNS.iter().filter(|column| column.width.is_some());
            let front = shown.filter(|column| !is_behind(column, pair));
            front.map(|column| column.name).collect()
        };
        let (fitted, corners) = (in_front(ScalePair::Fitted), in_front(ScalePair::Corners));
        let scales = |of: &[&'static str]| -> Vec<&'static str> {
            let is = |name: &&&str| name.ends_with("op") || name.ends_with("ottom");
            of.iter().filter(is).copied().collect()
        };
        assert_eq!(scales(&fitted), ["Fitted top", "Fitted bottom"]);
        assert_eq!(scales(&corners), ["Top", "Bottom"]);
        assert_eq!(fitted.len(), corners.len());
    }
}
