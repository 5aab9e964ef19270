//! Points that are picked on the surface, with names: a list to copy and to save.

use glam::DVec3;

use crate::open_flight::{Measure, OpenFlight};
use crate::state::history::History;

/// A point on the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct PickedPoint {
    /// What it is called.
    pub name: String,
    /// In the world.
    pub point: DVec3,
}

/// Something to do with them.
#[derive(Debug, Clone, PartialEq)]
pub enum PickStep {
    /// Takes the tool, or puts it away; the points stay.
    Toggle,
    /// Calls the point at this place of the list so.
    Rename(usize, String),
    /// Takes it from the list.
    Remove(usize),
    /// Empties the list.
    RemoveAll,
    /// Brings it into the middle of the view, from nearby.
    GoTo(usize),
    /// The list was copied.
    Copied,
}

/// The points that were picked.
#[derive(Debug)]
pub struct PickedPoints {
    /// Whether clicks pick.
    pub is_on: bool,
    /// The list of now, with those before: what undo goes back over while the tool is taken.
    pub history: History<Vec<PickedPoint>>,
    /// The list as it was copied or written last.
    kept: Vec<PickedPoint>,
}

impl Default for PickedPoints {
    fn default() -> Self {
        Self {
            is_on: false,
            history: History::new(Vec::new()),
            kept: Vec::new(),
        }
    }
}

impl PickedPoints {
    /// The list of now, the first picked first.
    pub fn list(&self) -> &[PickedPoint] {
        self.history.now()
    }

    /// Whether there are points that nobody copied or wrote.
    pub fn is_lost(&self) -> bool {
        !self.list().is_empty() && self.list() != self.kept
    }

    /// Takes that the list of now was copied or written.
    pub(crate) fn keep(&mut self) {
        self.kept = self.list().to_vec();
    }

    /// Adds a point: P and the number after the largest that such a name has.
    pub(crate) fn pick(&mut self, point: DVec3) {
        let number = |point: &PickedPoint| point.name.strip_prefix('P')?.parse::<u64>().ok();
        let last = self.list().iter().filter_map(number).max().unwrap_or(0);
        let name = format!("P{}", last.saturating_add(1));
        self.change(|list| list.push(PickedPoint { name, point }));
    }

    fn change(&mut self, change: impl FnOnce(&mut Vec<PickedPoint>)) {
        let mut next = self.list().to_vec();
        change(&mut next);
        self.history.set(next);
    }
}

impl OpenFlight {
    /// Does something with the picked points.
    pub(crate) fn pick_step(&mut self, step: PickStep) {
        let picked = &mut self.pointer.picked;
        match step {
            PickStep::Toggle => {
                picked.is_on ^= true;
                if picked.is_on {
                    self.pointer.measure = Measure::Off;
                    self.put_drawing_away();
                }
            }
            PickStep::Rename(place, name) => {
                let name = name.trim();
                if !name.is_empty() {
                    picked.change(|list| {
                        if let Some(point) = list.get_mut(place) {
                            name.clone_into(&mut point.name);
                        }
                    });
                }
            }
            PickStep::Remove(place) => picked.change(|list| {
                if place < list.len() {
                    list.remove(place);
                }
            }),
            PickStep::RemoveAll => picked.change(Vec::clear),
            PickStep::Copied => picked.keep(),
            PickStep::GoTo(place) => {
                if let Some(point) = picked.list().get(place).map(|picked| picked.point) {
                    self.fly_to(point);
                }
            }
        }
    }

    /// Brings a point into the middle, in the same direction, from no farther than shows its surroundings.
    fn fly_to(&mut self, point: DVec3) {
        let near = self.extent.bulk.size().length() * 0.25;
        let looking = &mut self.looking;
        (looking.through, looking.turned) = (None, true);
        looking.orbit.center_on(point);
        looking.orbit.distance = looking.orbit.distance.min(near.max(f64::MIN_POSITIVE));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(points: &PickedPoints) -> Vec<&str> {
        let list = points.list().iter();
        list.map(|point| point.name.as_str()).collect()
    }

    #[test]
    fn names_count_on_after_the_largest() {
        let mut points = PickedPoints::default();
        points.pick(DVec3::ZERO);
        points.pick(DVec3::X);
        points.change(|list| "toe".clone_into(&mut list[0].name));
        points.pick(DVec3::Y);
        assert_eq!(names(&points), ["toe", "P2", "P3"]);
        points.change(|list| drop(list.remove(2)));
        points.pick(DVec3::Z);
        assert_eq!(names(&points), ["toe", "P2", "P3"]);
        assert!(points.history.undo() && points.history.undo());
        assert_eq!(points.list()[2].point, DVec3::Y);
    }
}
