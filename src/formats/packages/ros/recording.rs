//! What a recording holds, message by message.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::RawMessage;
use super::frames::Frames;
use super::message_bytes::{Header, Malformed, Serialization};
use super::messages::{CameraInfo, Message, decode, plain_type};
use crate::camera::Pose;
use crate::geodesy::Geographic;
use crate::poses::trajectory::Stamp;

/// A recording's topics, and the messages that a flight is made of.
#[derive(Debug, Default)]
pub struct Recording {
    /// In the order in which they come up.
    pub topics: Vec<Topic>,
    by_name: HashMap<String, usize>,
    /// Of CameraInfo, by the topic's index, like those below.
    pub(super) cameras: BTreeMap<usize, CameraTopic>,
    pub(super) images: BTreeMap<usize, ImageTopic>,
    pub(super) poses: BTreeMap<usize, PoseTopic>,
    pub(super) fixes: BTreeMap<usize, Vec<(Stamp, Geographic)>>,
    pub(super) frames: Frames,
    /// The topics of tf that hold for a time.
    pub(super) tf: BTreeSet<usize>,
    unstamped: u64,
    /// What was wrong with the files, one sentence each.
    pub(super) file_warnings: Vec<String>,
}

/// A topic of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    pub name: String,
    /// As ROS 1 writes it: `package/Name`.
    pub type_name: String,
    pub messages: u64,
    encoding: String,
    /// How many messages could not be read, and why the first could not.
    malformed: Option<(u64, Malformed)>,
}

/// A camera's calibration, as it is repeated with every image.
#[derive(Debug)]
pub(super) struct CameraTopic {
    pub(super) frame: String,
    pub(super) info: CameraInfo,
    /// Whether other messages said something else.
    pub(super) changes: bool,
}

/// Images without their pixels.
#[derive(Debug)]
pub(super) struct ImageTopic {
    pub(super) frame: String,
    pub(super) encoding: String,
    /// Of the first; `None` where they are compressed.
    pub(super) size: Option<(u32, u32)>,
    /// Stamps, in the order of the recording.
    pub(super) stamps: Vec<Stamp>,
    /// Images of another size than the first.
    pub(super) other_sizes: u64,
}

/// Poses of one frame in another.
#[derive(Debug)]
pub(super) struct PoseTopic {
    pub(super) parent: String,
    /// Where the type of its messages says it.
    pub(super) child: Option<String>,
    pub(super) samples: Vec<(Stamp, Pose)>,
    /// Whether not all messages are of the same two frames.
    pub(super) mixed: bool,
}

impl Recording {
    /// Takes a message in.
    pub(super) fn take(&mut self, raw: &RawMessage<'_>) {
        let index = self.topic_of(raw);
        let Some(topic) = self.topics.get_mut(index) else {
            return;
        };
        topic.messages += 1;
        let Some(serialization) = Serialization::of_name(&topic.encoding) else {
            return;
        };
        match decode(&topic.type_name, raw.data, serialization) {
            None => {}
            Some(Err(why)) => topic.malformed.get_or_insert((0, why)).0 += 1,
            Some(Ok(message)) => {
                let is_static = topic.name.ends_with("tf_static");
                self.sort_in(index, message, raw.time, is_static);
            }
        }
    }

    fn topic_of(&mut self, raw: &RawMessage<'_>) -> usize {
        if let Some(index) = self.by_name.get(raw.topic) {
            return *index;
        }
        let index = self.topics.len();
        self.by_name.insert(raw.topic.to_owned(), index);
        self.topics.push(Topic {
            name: raw.topic.to_owned(),
            type_name: plain_type(raw.type_name),
            messages: 0,
            encoding: raw.encoding.to_owned(),
            malformed: None,
        });
        index
    }

    fn sort_in(&mut self, index: usize, message: Message, recorded: Stamp, is_static: bool) {
        let mut stamp = |header: &Header| {
            if header.stamp != Stamp(0) {
                return header.stamp;
            }
            self.unstamped += 1;
            recorded
        };
        match message {
            Message::Camera(header, info) => {
                let camera = self.cameras.entry(index).or_insert_with(|| CameraTopic {
                    frame: header.frame,
                    info: (*info).clone(),
                    changes: false,
                });
                camera.changes |= camera.info != *info;
            }
            Message::Image(header, head) => {
                let stamp = stamp(&header);
                let image = self.images.entry(index).or_insert_with(|| ImageTopic {
                    frame: header.frame,
                    encoding: head.encoding,
                    size: head.size,
                    stamps: Vec::new(),
                    other_sizes: 0,
                });
                if image.size == head.size {
                    image.stamps.push(stamp);
                } else {
                    image.other_sizes += 1;
                }
            }
            Message::Pose(header, child, pose) => {
                let stamp = stamp(&header);
                let topic = self.poses.entry(index).or_insert_with(|| PoseTopic {
                    parent: header.frame.clone(),
                    child: child.clone().filter(|child| !child.is_empty()),
                    samples: Vec::new(),
                    mixed: false,
                });
                let child = child.as_deref().filter(|child| !child.is_empty());
                topic.mixed |= topic.parent != header.frame || topic.child.as_deref() != child;
                topic.samples.push((stamp, pose));
            }
            Message::Transforms(transforms) => {
                if !is_static && !transforms.is_empty() {
                    self.tf.insert(index);
                }
                for (header, child, pose) in transforms {
                    let stamp = if is_static {
                        header.stamp
                    } else {
                        stamp(&header)
                    };
                    self.frames
                        .add(&header.frame, &child, (stamp, pose), is_static);
                }
            }
            Message::Fix(header, position) => {
                let stamp = stamp(&header);
                let fixes = self.fixes.entry(index).or_default();
                fixes.extend(position.map(|position| (stamp, position)));
            }
        }
    }

    /// The name of a topic by its index.
    pub(super) fn name_of(&self, index: usize) -> &str {
        self.topics.get(index).map_or("", |topic| &topic.name)
    }

    /// What tf is called here.
    pub(super) fn tf_name(&self) -> String {
        let names = self.tf.iter().map(|&index| self.name_of(index));
        names.collect::<Vec<_>>().join(" and ")
    }

    /// The topics that give poses, each with the count of its messages, in the recording's order.
    pub(super) fn topics_of_poses(&self) -> Vec<String> {
        let topics = self.topics.iter().enumerate();
        let of_poses =
            topics.filter(|(index, _)| self.poses.contains_key(index) || self.tf.contains(index));
        of_poses
            .map(|(_, topic)| format!("{} ({} messages)", topic.name, topic.messages))
            .collect()
    }

    /// Whether a topic gives poses.
    pub fn gives_poses(&self, topic: &Topic) -> bool {
        let index = self.by_name.get(&topic.name);
        index.is_some_and(|index| self.poses.contains_key(index) || self.tf.contains(index))
    }

    /// How many messages there are.
    pub fn messages(&self) -> u64 {
        self.topics.iter().map(|topic| topic.messages).sum()
    }

    /// Which topics are encoded in ways that are not read, one sentence each.
    pub(super) fn not_read(&self) -> impl Iterator<Item = String> {
        let topics = self.topics.iter();
        let others = topics.filter(|topic| Serialization::of_name(&topic.encoding).is_none());
        others.map(|topic| {
            format!(
                "{}: its {} messages are encoded as '{}' and not read (only ros1 and cdr are)",
                topic.name, topic.messages, topic.encoding
            )
        })
    }

    /// What is to be said of the recording whatever is made of it.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.file_warnings.clone();
        warnings.extend(self.not_read());
        for topic in &self.topics {
            if let Some((count, why)) = topic.malformed {
                warnings.push(format!(
                    "{}: {count} of {} messages are no {} (the first {why}) and are left out",
                    topic.name, topic.messages, topic.type_name
                ));
            }
        }
        if self.unstamped > 0 {
            warnings.push(format!(
                "{} messages carry no stamp; the time of their recording stands for it",
                self.unstamped
            ));
        }
        warnings
    }

    /// Every pose that the recording holds, by topic or tf frame and stamp, for people to look at.
    pub fn named_poses(&self) -> Vec<(String, Pose)> {
        let of_topics = self.poses.iter().flat_map(|(&index, topic)| {
            let name = self.name_of(index).trim_start_matches('/');
            let samples = topic.samples.iter();
            samples.map(move |(stamp, pose)| (format!("{name}/{}", stamp.0), *pose))
        });
        let of_frames = self.frames.moving().flat_map(|(parent, child, samples)| {
            let samples = samples.iter();
            samples.map(move |(stamp, pose)| (format!("tf:{parent}.{child}/{}", stamp.0), *pose))
        });
        of_topics.chain(of_frames).collect()
    }
}
