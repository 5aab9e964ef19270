//! The tree of frames that tf publishes, and the way from a camera up to the world.
//!
//! Written from REP 103, REP 105 and geometry2. A transform takes points of its child frame to its
//! parent's: `parent_from_child`. Every frame has one parent; those of `/tf_static` hold for ever,
//! those of `/tf` at their stamps, and are interpolated as `trajectory/track.rs` says.

use std::collections::BTreeMap;

use crate::camera::Pose;
use crate::fault::Fault;
use crate::poses::trajectory::{NoPose, Stamp, Track};

/// All frames by their names.
#[derive(Debug, Default)]
pub(super) struct Frames(BTreeMap<String, Frame>);

/// A frame in its parent.
#[derive(Debug)]
struct Frame {
    parent: String,
    fixed: Option<Pose>,
    samples: Vec<(Stamp, Pose)>,
    /// A parent that other transforms named.
    other_parent: Option<String>,
}

/// The way from a frame up to the one that has no parent.
#[derive(Debug, Clone)]
pub(super) struct Way {
    /// The frame at the top.
    pub(super) root: String,
    /// From the top down: each frame's name and its place in the one above.
    pub(super) links: Vec<(String, Link)>,
}

/// A frame's place in its parent.
#[derive(Debug, Clone)]
pub(super) enum Link {
    Fixed(Pose),
    Moving(Track),
}

impl Link {
    fn at(&self, stamp: Stamp) -> Result<Pose, NoPose> {
        match self {
            Self::Fixed(pose) => Ok(*pose),
            Self::Moving(track) => track.at(stamp),
        }
    }
}

impl Way {
    /// The lowest frame in the topmost one at a time.
    ///
    /// # Errors
    /// Where one of the moving frames has no place then.
    pub(super) fn at(&self, stamp: Stamp) -> Result<Pose, NoPose> {
        let mut place = Pose::from_quaternion(glam::DVec3::ZERO, [0.0, 0.0, 0.0, 1.0])
            .map_err(|_| NoPose::Empty)?;
        for (_, link) in &self.links {
            place = place.carrying(&link.at(stamp)?);
        }
        Ok(place)
    }

    /// Whether any of its frames moves.
    pub(super) fn moves(&self) -> bool {
        self.links
            .iter()
            .any(|(_, link)| matches!(link, Link::Moving(_)))
    }

    /// The time that all of its moving frames have in common.
    pub(super) fn span(&self) -> Option<(Stamp, Stamp)> {
        let spans = self.links.iter().filter_map(|(_, link)| match link {
            Link::Fixed(_) => None,
            Link::Moving(track) => track.span(),
        });
        spans.reduce(|(a, b), (c, d)| (a.max(c), b.min(d)))
    }

    /// The poses that count between two times (see `Track::samples_around`): those of the moving frame
    /// that has fewest.
    pub(super) fn poses_around(&self, span: Option<(Stamp, Stamp)>) -> usize {
        let counts = self.links.iter().filter_map(|(_, link)| match link {
            Link::Fixed(_) => None,
            Link::Moving(track) => Some(track.samples_around(span)),
        });
        counts.min().unwrap_or(0)
    }

    /// The topmost of the frames that are fixed to the lowest, and the way down from it.
    pub(super) fn fixed_part(&self) -> (&str, &[(String, Link)]) {
        let is_moving = |(_, link): &(String, Link)| matches!(link, Link::Moving(_));
        match self.links.iter().rposition(is_moving) {
            Some(at) => {
                let (above, below) = self.links.split_at(at + 1);
                let top = above.last().map_or("", |(name, _)| name.as_str());
                (top, below)
            }
            None => (&self.root, &self.links),
        }
    }

    /// What lies below `frame`, as a way of its own; `None` where it is not on the way.
    pub(super) fn below(&self, frame: &str) -> Option<Vec<(String, Link)>> {
        if frame == self.root {
            return Some(self.links.clone());
        }
        let at = self.links.iter().position(|(name, _)| name == frame)?;
        Some(self.links.get(at + 1..)?.to_vec())
    }
}

impl Frames {
    /// Takes a transform in.
    pub(super) fn add(
        &mut self,
        parent: &str,
        child: &str,
        sample: (Stamp, Pose),
        is_static: bool,
    ) {
        let frame = self.0.entry(child.to_owned()).or_insert_with(|| Frame {
            parent: parent.to_owned(),
            fixed: None,
            samples: Vec::new(),
            other_parent: None,
        });
        if frame.parent != parent {
            frame.other_parent = Some(parent.to_owned());
        } else if is_static {
            frame.fixed = Some(sample.1);
        } else {
            frame.samples.push(sample);
        }
    }

    /// Every frame that moves, with its parent and its samples in the order of the recording.
    pub(super) fn moving(&self) -> impl Iterator<Item = (&str, &str, &[(Stamp, Pose)])> {
        self.0
            .iter()
            .filter(|(_, frame)| !frame.samples.is_empty())
            .map(|(name, frame)| {
                (
                    frame.parent.as_str(),
                    name.as_str(),
                    frame.samples.as_slice(),
                )
            })
    }

    /// The way from `frame` to the top; of a frame that is not known, none at all.
    ///
    /// # Errors
    /// Where the frames go round in a circle, or one on the way has two parents.
    pub(super) fn way_up(&self, frame: &str) -> Result<Way, Fault> {
        const REMEDY: &str = "record a tf tree in which every frame has one parent";
        let mut links = Vec::new();
        let mut name = frame;
        while let Some(found) = self.0.get(name) {
            if let Some(other) = &found.other_parent {
                let what = format!(
                    "the frame '{name}' hangs on both '{}' and '{other}'",
                    found.parent
                );
                return Err(Fault::new(what, REMEDY));
            }
            if links.len() > self.0.len() {
                let what = format!("the frames above '{frame}' go round in a circle");
                return Err(Fault::new(what, REMEDY));
            }
            let link = match found.fixed {
                Some(pose) if found.samples.is_empty() => Link::Fixed(pose),
                _ => Link::Moving(Track::new(found.samples.clone())),
            };
            links.push((name.to_owned(), link));
            name = &found.parent;
        }
        links.reverse();
        Ok(Way {
            root: name.to_owned(),
            links,
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;

    fn pose(degrees: f64, x: f64) -> Pose {
        Pose {
            rotation: DMat3::from_rotation_z(degrees.to_radians()),
            center: DVec3::new(x, 0.0, 0.0),
        }
    }

    const ZERO: Stamp = Stamp(0);
    const LATER: Stamp = Stamp(400_000_000);

    #[test]
    fn the_camera_is_found_in_the_map() {
        let mut frames = Frames::default();
        frames.add("base", "cam", (ZERO, pose(-90.0, 2.0)), true);
        frames.add("odom", "base", (ZERO, pose(0.0, 0.0)), false);
        frames.add("odom", "base", (LATER, pose(90.0, 4.0)), false);
        frames.add("map", "odom", (ZERO, pose(90.0, 10.0)), true);
        frames.add("base", "lidar", (ZERO, pose(0.0, 0.0)), true);
        let way = frames.way_up("cam").unwrap();
        assert_eq!(way.root, "map");
        assert!(way.moves());
        assert_eq!(way.span(), Some((ZERO, LATER)));
        // Half way the base is 2 along odom's x and turned by 45 degrees; odom's x is the map's y.
        let place = way.at(Stamp(200_000_000)).unwrap();
        let along = 2.0 * 45_f64.to_radians().cos();
        assert!((place.center - DVec3::new(10.0 - along, 2.0 + along, 0.0)).length() < 1e-14);
        assert!(place.rotation.abs_diff_eq(pose(45.0, 0.0).rotation, 1e-14));
        assert_eq!(way.at(Stamp(500_000_000)), Err(NoPose::After(LATER)));
        let below = way.below("base").unwrap();
        assert_eq!(below.len(), 1);
        assert!(way.below("lidar").is_none());
        assert_eq!(frames.moving().count(), 1);
    }

    #[test]
    fn a_frame_that_tf_does_not_know_is_its_own_top() {
        let way = Frames::default().way_up("cam").unwrap();
        assert_eq!(
            (way.root.as_str(), way.links.len(), way.moves()),
            ("cam", 0, false)
        );
        assert_eq!(way.at(ZERO).unwrap(), pose(0.0, 0.0));
        assert_eq!(way.span(), None);
    }

    #[test]
    fn circles_and_second_parents_are_refused() {
        let mut frames = Frames::default();
        frames.add("a", "b", (ZERO, pose(0.0, 0.0)), true);
        frames.add("b", "a", (ZERO, pose(0.0, 0.0)), true);
        assert!(frames.way_up("b").unwrap_err().what.contains("circle"));
        frames.add("self", "self", (ZERO, pose(0.0, 0.0)), true);
        assert!(frames.way_up("self").unwrap_err().what.contains("circle"));
        frames.add("c", "b", (ZERO, pose(0.0, 0.0)), true);
        let fault = frames.way_up("b").unwrap_err();
        assert_eq!(fault.what, "the frame 'b' hangs on both 'a' and 'c'");
    }
}
