//! Where a camera's poses come from, of all that a recording publishes.
//!
//! Poses lead to the camera where what they move is the camera's frame, or carries it:
//! - tf, where the camera's frame hangs, through however many others, on one that moves: its pose is
//!   the one in the topmost frame (map above odom above base: map);
//! - a topic that names the moving frame (`nav_msgs/Odometry`, `geometry_msgs/TransformStamped`),
//!   where that is the camera's, or carries it by tf's frames.
//!
//! Of several that do, the densest is taken: the one with most poses while the images were taken,
//! half a second before and after included, over which poses are interpolated. Through several moving
//! frames the sparsest counts. Of equals tf goes first, then the topic that comes up first. Which was
//! taken is said with the others, and how far from it they are: two estimates of one flight may
//! differ by more than a scale allows. The user may choose by name instead.
//!
//! Where none leads to the camera, the only topic that does not name what moves (`PoseStamped`,
//! `PoseWithCovarianceStamped`) is taken for the topmost of the fixed frames that carry the camera, or
//! for the camera itself where tf does not know it. That is an assumption, and is said. Several of
//! these are not chosen between, because nothing tells a camera's poses from a goal's.

use super::frames::{Link, Way};
use super::recording::{PoseTopic, Recording};
use crate::fault::Fault;
use crate::poses::trajectory::{Stamp, Track};

/// A camera's poses over time.
#[derive(Debug, Clone)]
pub(super) struct PoseSource {
    pub(super) way: Way,
    /// What had to be assumed or chosen, one sentence each.
    pub(super) said: Vec<String>,
}

/// What poses are looked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted<'a> {
    /// The camera's frame; empty where none is known.
    pub(super) frame: &'a str,
    /// When the images were taken.
    pub(super) stamps: &'a [Stamp],
    /// The topic that the user chose.
    pub(super) topic: Option<&'a str>,
}

/// Poses that lead to the camera.
struct Candidate {
    topic: String,
    way: Way,
    assumption: Option<String>,
}

/// Finds the poses of a camera.
///
/// # Errors
/// Where nothing moves it, or the chosen topic does not, with the topics that there are.
pub(super) fn pose_source(recording: &Recording, wanted: Wanted<'_>) -> Result<PoseSource, Fault> {
    let way = recording.frames.way_up(wanted.frame)?;
    if let Some(topic) = wanted.topic {
        let Candidate {
            way, assumption, ..
        } = chosen(recording, wanted.frame, way, topic)?;
        let said = assumption.into_iter().collect();
        return Ok(PoseSource { way, said });
    }
    let mut candidates = leading(recording, &way);
    let span = wanted.stamps.iter().min().zip(wanted.stamps.iter().max());
    let poses = |way: &Way| way.poses_around(span.map(|(first, last)| (*first, *last)));
    // The first of the densest: tf, then the topics in the recording's order.
    let densest = candidates
        .iter()
        .enumerate()
        .rev()
        .max_by_key(|(_, candidate)| poses(&candidate.way))
        .map(|(index, _)| index);
    if let Some(densest) = densest {
        let taken = candidates.remove(densest);
        let mut said = Vec::new();
        let others: Vec<String> = candidates
            .iter()
            .map(|other| {
                let (topic, count) = (&other.topic, poses(&other.way));
                format!(
                    "{topic} has {count} {}",
                    apart(&taken.way, &other.way, wanted.stamps)
                )
            })
            .collect();
        let strangers = not_leading(recording, &way);
        if !others.is_empty() || !strangers.is_empty() {
            let mut sentence = format!(
                "the camera's poses are those of {} ({} while the images were taken",
                taken.topic,
                poses(&taken.way)
            );
            if others.is_empty() {
                sentence += ")";
            } else {
                sentence += &format!(", the most; {})", others.join(", "));
            }
            if !strangers.is_empty() {
                sentence += &format!(
                    "; {} not lead to the camera",
                    match strangers.as_slice() {
                        [one] => format!("{one} does"),
                        several => format!("{} do", several.join(", ")),
                    }
                );
            }
            said.push(sentence + "; --topic, or topic in flight.toml's [photos], takes another");
        }
        return Ok(PoseSource {
            way: taken.way,
            said,
        });
    }
    let mut nameless = usable(recording).filter(|(_, topic)| topic.child.is_none());
    if let (Some((index, topic)), None) = (nameless.next(), nameless.next()) {
        let Candidate {
            way, assumption, ..
        } = of_nameless(recording.name_of(index), topic, &way);
        let said = assumption.into_iter().collect();
        return Ok(PoseSource { way, said });
    }
    Err(nothing(recording, wanted.frame))
}

/// The topics of poses that are always of the same two frames.
fn usable(recording: &Recording) -> impl Iterator<Item = (usize, &PoseTopic)> {
    let topics = recording.poses.iter().filter(|(_, topic)| !topic.mixed);
    topics.map(|(&index, topic)| (index, topic))
}

/// All poses that lead to the camera: tf's, then the topics' in the recording's order.
fn leading(recording: &Recording, way: &Way) -> Vec<Candidate> {
    let tf = way.moves().then(|| Candidate {
        topic: recording.tf_name(),
        way: way.clone(),
        assumption: None,
    });
    let topics = usable(recording).filter_map(|(index, topic)| {
        let child = topic.child.as_deref()?;
        let below = way.below(child)?;
        Some(Candidate {
            topic: recording.name_of(index).to_owned(),
            way: above(topic, child, &below),
            assumption: None,
        })
    });
    tf.into_iter().chain(topics).collect()
}

/// The names of the topics whose poses do not lead to the camera.
fn not_leading<'a>(recording: &'a Recording, way: &Way) -> Vec<&'a str> {
    let topics = recording.poses.iter().filter(|(_, topic)| {
        let child = topic.child.as_deref();
        topic.mixed || child.is_none_or(|child| way.below(child).is_none())
    });
    topics.map(|(&index, _)| recording.name_of(index)).collect()
}

/// A topic that does not say what it moves.
fn of_nameless(name: &str, topic: &PoseTopic, way: &Way) -> Candidate {
    let (root, fixed) = way.fixed_part();
    let moving = if fixed.is_empty() {
        "the camera itself (x right, y down, z forward)".to_owned()
    } else {
        format!("the frame '{root}', which carries the camera")
    };
    Candidate {
        topic: name.to_owned(),
        way: above(topic, root, fixed),
        assumption: Some(format!(
            "{name} does not say what moves: it is taken for {moving}"
        )),
    }
}

/// The poses of the topic that the user names.
fn chosen(recording: &Recording, frame: &str, way: Way, wanted: &str) -> Result<Candidate, Fault> {
    let is_wanted = |index: usize| {
        let name = recording.name_of(index);
        name.trim_start_matches('/') == wanted.trim_start_matches('/')
    };
    let refuse = |what: String| {
        let there = recording.topics_of_poses();
        let there = match there.as_slice() {
            [] => "no topic does".to_owned(),
            topics => format!("those that do are {}", topics.join(", ")),
        };
        Fault::new(format!("{what}; {there}"), "name one of these topics")
    };
    if recording.tf.iter().any(|&index| is_wanted(index)) {
        if way.moves() {
            let topic = recording.tf_name();
            let assumption = None;
            return Ok(Candidate {
                topic,
                way,
                assumption,
            });
        }
        return Err(refuse(format!(
            "the topic '{wanted}' gives no poses of the camera's frame '{frame}'"
        )));
    }
    let topic = recording.poses.iter().find(|(index, _)| is_wanted(**index));
    let Some((&index, topic)) = topic else {
        let known = recording.topics.iter().enumerate();
        let mut known = known.filter(|(index, _)| is_wanted(*index));
        return Err(refuse(match known.next() {
            Some((_, topic)) => {
                format!("the topic '{wanted}' ({}) gives no poses", topic.type_name)
            }
            None => format!("there is no topic '{wanted}' that gives poses"),
        }));
    };
    if topic.mixed {
        return Err(refuse(format!(
            "the topic '{wanted}' gives poses of changing frames"
        )));
    }
    let name = recording.name_of(index);
    let Some(child) = &topic.child else {
        return Ok(of_nameless(name, topic, &way));
    };
    // Without a camera in the recording, the user says by the choice what it is.
    let (below, assumption) = if frame.is_empty() {
        let assumption = format!(
            "{name} gives the poses of '{child}': it is taken for the camera itself (x right, y down, z forward)"
        );
        (Some(Vec::new()), Some(assumption))
    } else {
        (way.below(child), None)
    };
    let Some(below) = below else {
        return Err(refuse(format!(
            "the topic '{wanted}' gives the poses of '{child}', which does not carry the camera's frame '{frame}'"
        )));
    };
    Ok(Candidate {
        topic: name.to_owned(),
        way: above(topic, child, &below),
        assumption,
    })
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

/// How far other poses are from those that were taken, at the images, in words.
fn apart(taken: &Way, other: &Way, stamps: &[Stamp]) -> String {
    if taken.root != other.root {
        return format!("in '{}' instead of '{}'", other.root, taken.root);
    }
    let both = stamps
        .iter()
        .filter_map(|stamp| taken.at(*stamp).ok().zip(other.at(*stamp).ok()));
    let worst = both
        .map(|(a, b)| {
            let turn = (a.rotation.transpose() * b.rotation).to_cols_array();
            let cosine = (turn.iter().step_by(4).sum::<f64>() - 1.0) / 2.0;
            let degrees = cosine.clamp(-1.0, 1.0).acos().to_degrees();
            (a.center.distance(b.center), degrees)
        })
        .reduce(|(a, b), (c, d)| (a.max(c), b.max(d)));
    match worst {
        None => "and none at an image".to_owned(),
        Some((metres, degrees)) => {
            format!("and is up to {metres:.3} m and {degrees:.2} degrees from it")
        }
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
        "record /tf and /tf_static, or choose the one topic of the camera's poses (--topic)",
    )
}
