//! What is dragged of a plan in the viewport, and how corners are typed.

use glam::DVec2;

use crate::plan::{AskedPlan, Edit};

/// What can be dragged in the viewport.
#[derive(Debug, Clone, PartialEq)]
pub enum Handle {
    /// The middle of what the photo of this name shows.
    Photo(String),
    /// A corner of the area.
    Area(usize),
    /// A corner of an area to keep out of.
    KeepOut(usize, usize),
    /// The take-off.
    TakeOff,
}

/// What is asked for with something dragged to another place; `area` is the one that was found, where none was
/// drawn.
pub(super) fn dragged(before: &AskedPlan, handle: &Handle, to: DVec2, area: &[DVec2]) -> AskedPlan {
    let mut asked = before.clone();
    match handle {
        Handle::Photo(name) => {
            // One move of a photo is enough.
            if let Some(Edit::Move(last, _)) = asked.edits.last()
                && last == name
            {
                asked.edits.pop();
            }
            asked.edits.push(Edit::Move(name.clone(), to));
        }
        Handle::TakeOff => asked.take_off = Some(to),
        Handle::Area(corner) => {
            let corners = asked.area.get_or_insert_with(|| area.to_vec());
            if let Some(corner) = corners.get_mut(*corner) {
                *corner = to;
            }
        }
        Handle::KeepOut(area, corner) => {
            let corner = asked
                .keep_out
                .get_mut(*area)
                .and_then(|area| area.get_mut(*corner));
            if let Some(corner) = corner {
                *corner = to;
            }
        }
    }
    asked.instead_of(before)
}

/// Corners as they are typed.
pub fn typed_corners(corners: &[DVec2]) -> String {
    let corners = corners.iter();
    let corners: Vec<String> = corners
        .map(|corner| format!("{:.3},{:.3}", corner.x, corner.y))
        .collect();
    corners.join(";")
}
