//! Where a camera's poses come from, of all that a recording publishes.
//!
//! In this order, and never by guessing between equals:
//! 1. tf: where the camera's frame hangs, through however many others, on one that moves, its pose is
//!    the one in the topmost frame (map above odom above base: map).
//! 2. A topic that names the moving frame (`nav_msgs/Odometry`, `geometry_msgs/TransformStamped`),
//!    where that frame is the camera's or carries it by tf's fixed frames. If several do: refused.
//! 3. The only topic of those that do not name it (`PoseStamped`, `PoseWithCovarianceStamped`): taken
//!    for the topmost of the fixed frames that carry the camera, or for the camera itself where tf does
//!    not know it. That is an assumption, and is said.

use super::frames::{Link, Way};
use super::recording::{PoseTopic, Recording};
use crate::fault::Fault;
use crate::formats::trajectory::Track;

/// A camera's poses over time.
#[derive(Debug, Clone)]
pub(super) struct PoseSource {
    pub(super) way: Way,
    /// What had to be assumed.
    pub(super) assumption: Option<String>,
}

/// Finds the poses of the camera in `frame`.
///
/// # Errors
/// Where nothing or more than one thing moves it, with the topics that there are.
pub(super) fn pose_source(recording: &Recording, frame: &str) -> Result<PoseSource, Fault> {
    let way = recording.frames.way_up(frame)?;
    if way.moves() {
        let assumption = None;
        return Ok(PoseSource { way, assumption });
    }
    let topics = || recording.poses.iter().filter(|(_, topic)| !topic.mixed);
    let carriers = topics().filter_map(|(&index, topic)| {
        let below = way.below(topic.child.as_deref()?)?;
        Some((index, topic, below))
    });
    let carriers: Vec<_> = carriers.collect();
    match &carriers[..] {
        [(_, topic, below)] => {
            let assumption = None;
            let way = above(topic, topic.child.as_deref().unwrap_or_default(), below);
            return Ok(PoseSource { way, assumption });
        }
        [] => {}
        several => {
            let names: Vec<&str> = several
                .iter()
                .map(|(index, ..)| recording.name_of(*index))
                .collect();
            return Err(Fault::new(
                format!(
                    "several topics move the camera's frame '{frame}': {}",
                    names.join(", ")
                ),
                "keep the one that holds, with rosbag filter or ros2 bag convert",
            ));
        }
    }
    let mut nameless = topics().filter(|(_, topic)| topic.child.is_none());
    if let (Some((&index, topic)), None) = (nameless.next(), nameless.next()) {
        let name = recording.name_of(index);
        let moving = if way.links.is_empty() {
            "the camera itself (x right, y down, z forward)".to_owned()
        } else {
            format!("the frame '{}', which carries the camera", way.root)
        };
        let assumption = format!("{name} does not say what moves: it is taken for {moving}");
        return Ok(PoseSource {
            way: above(topic, &way.root, &way.links),
            assumption: Some(assumption),
        });
    }
    Err(nothing(recording, frame))
}

/// The way from a topic's parent frame down to the camera.
fn above(topic: &PoseTopic, child: &str, below: &[(String, Link)]) -> Way {
    let moving = Link::Moving(Track::new(topic.samples.clone()));
    let mut links = vec![(child.to_owned(), moving)];
    links.extend_from_slice(below);
    Way {
        root: topic.parent.clone(),
        links,
    }
}

fn nothing(recording: &Recording, frame: &str) -> Fault {
    let topics = recording.poses.iter().map(|(&index, topic)| {
        let name = recording.name_of(index);
        match &topic.child {
            _ if topic.mixed => format!("{name} (of changing frames)"),
            Some(child) => format!("{name} ('{child}' in '{}')", topic.parent),
            None => format!("{name} (something in '{}')", topic.parent),
        }
    });
    let frames = recording
        .frames
        .moving()
        .map(|(parent, child, _)| format!("tf ('{child}' in '{parent}')"));
    let all: Vec<String> = topics.chain(frames).collect();
    let of = match frame {
        "" => "no frame is named as the camera's, and ".to_owned(),
        frame => format!("nothing leads from the camera's frame '{frame}' to the world: "),
    };
    let there = if all.is_empty() {
        "there are no poses".to_owned()
    } else {
        format!("there are {}", all.join(", "))
    };
    Fault::new(
        format!("{of}{there}"),
        "record /tf and /tf_static, or keep the one topic of the camera's poses",
    )
}
