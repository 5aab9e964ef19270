//! What is dragged of a plan in the viewport, and how corners are typed.

use glam::DVec2;

use crate::plan::{AskedPlan, Edit, PhotoAt, Plan};

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

/// A photo of a plan, by its name, as a change by hand says which one it is.
pub(super) fn photo_at(plan: &Plan, name: &str) -> Option<PhotoAt> {
    let photo = plan.photos.iter().find(|photo| photo.name == name)?;
    Some(PhotoAt {
        name: photo.name.clone(),
        at: photo.target.truncate(),
    })
}

/// What is asked for with something dragged to another place; `plan` is what was made of it, where that is there.
pub(super) fn dragged(
    before: &AskedPlan,
    handle: &Handle,
    to: DVec2,
    plan: Option<&Plan>,
) -> AskedPlan {
    let mut asked = before.clone();
    match handle {
        Handle::Photo(name) => {
            // One move of a photo is enough, from where it stood first.
            let moved = match asked.edits.last() {
                Some(Edit::Move(last, _)) if last.name == *name => Some(last.clone()),
                _ => None,
            };
            let photo = match moved {
                Some(photo) => {
                    asked.edits.pop();
                    Some(photo)
                }
                None => plan.and_then(|plan| photo_at(plan, name)),
            };
            asked.edits.extend(photo.map(|photo| Edit::Move(photo, to)));
        }
        Handle::TakeOff => asked.take_off = Some(to),
        Handle::Area(corner) => {
            let found = || plan.map_or_else(Vec::new, |plan| plan.area.corners().to_vec());
            let corners = asked.area.get_or_insert_with(found);
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
