//! Recordings of ROS written byte by byte from the specifications: what a reader makes of them is
//! known from here, not from the reader.

#![expect(
    clippy::unwrap_used,
    reason = "a test file that cannot be made fails the test"
)]

use glam::{DMat3, DVec3};

/// How a message is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Little-endian, without padding.
    Ros1,
    /// CDR, little-endian.
    Little,
    /// CDR, big-endian.
    Big,
}

/// A message on its way out.
pub struct Out {
    style: Style,
    bytes: Vec<u8>,
}

impl Out {
    /// Nothing yet, but for the header of CDR.
    pub fn new(style: Style) -> Self {
        let bytes = match style {
            Style::Ros1 => vec![],
            Style::Little => vec![0, 1, 0, 0],
            Style::Big => vec![0, 0, 0, 0],
        };
        Self { style, bytes }
    }

    fn number<const N: usize>(mut self, mut little: [u8; N]) -> Self {
        if self.style != Style::Ros1 {
            while !(self.bytes.len() - 4).is_multiple_of(N) {
                self.bytes.push(0);
            }
        }
        if self.style == Style::Big {
            little.reverse();
        }
        self.bytes.extend(little);
        self
    }

    /// A byte.
    pub fn byte(self, n: u8) -> Self {
        self.number([n])
    }

    /// A number of two bytes.
    pub fn u16(self, n: u16) -> Self {
        self.number(n.to_le_bytes())
    }

    /// A number of four bytes.
    pub fn u32(self, n: u32) -> Self {
        self.number(n.to_le_bytes())
    }

    /// Numbers of eight bytes, without their count.
    pub fn f64s(self, numbers: &[f64]) -> Self {
        numbers
            .iter()
            .fold(self, |out, n| out.number(n.to_le_bytes()))
    }

    /// A text with its length.
    pub fn text(mut self, text: &str) -> Self {
        let end: &[u8] = if self.style == Style::Ros1 {
            b""
        } else {
            b"\0"
        };
        self = self.u32((text.len() + end.len()) as u32);
        self.bytes.extend(text.bytes());
        self.bytes.extend(end);
        self
    }

    /// std_msgs/Header, milliseconds after the recording's first second.
    pub fn header(mut self, ms: u32, frame: &str) -> Self {
        if self.style == Style::Ros1 {
            self = self.u32(99);
        }
        self.u32(1_700_000_000 + ms / 1000)
            .u32(ms % 1000 * 1_000_000)
            .text(frame)
    }

    /// The bytes.
    pub fn done(self) -> Vec<u8> {
        self.bytes
    }
}

/// A message of a topic.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Where it was published.
    pub topic: &'static str,
    /// As ROS 1 has it.
    pub kind: &'static str,
    /// The message's bytes.
    pub data: Vec<u8>,
}

fn field(name: &str, value: &[u8]) -> Vec<u8> {
    let mut out = ((name.len() + 1 + value.len()) as u32)
        .to_le_bytes()
        .to_vec();
    out.extend(name.bytes());
    out.push(b'=');
    out.extend(value);
    out
}

fn record(header: &[Vec<u8>], data: &[u8]) -> Vec<u8> {
    let header = header.concat();
    let mut out = (header.len() as u32).to_le_bytes().to_vec();
    out.extend(header);
    out.extend((data.len() as u32).to_le_bytes());
    out.extend(data);
    out
}

/// The topics in the order in which they come up.
pub fn topics(entries: &[Entry]) -> Vec<(&'static str, &'static str)> {
    let mut topics: Vec<(&str, &str)> = Vec::new();
    for entry in entries {
        if !topics.contains(&(entry.topic, entry.kind)) {
            topics.push((entry.topic, entry.kind));
        }
    }
    topics
}

/// A bag of version 2.0 with one chunk as it is.
pub fn bag(entries: &[Entry]) -> Vec<u8> {
    packed_bag(entries, "none", <[u8]>::to_vec)
}

/// A bag of version 2.0 with one chunk that is packed as the bag says.
pub fn packed_bag(
    entries: &[Entry],
    compression: &str,
    pack: impl Fn(&[u8]) -> Vec<u8>,
) -> Vec<u8> {
    let mut chunk = Vec::new();
    let topics = topics(entries);
    for (id, (topic, kind)) in topics.iter().enumerate() {
        let head = [
            field("op", &[7]),
            field("conn", &(id as u32).to_le_bytes()),
            field("topic", topic.as_bytes()),
        ];
        let data = [
            field("topic", topic.as_bytes()),
            field("type", kind.as_bytes()),
            field("md5sum", b"*"),
            field("message_definition", b""),
        ];
        chunk.extend(record(&head, &data.concat()));
    }
    for entry in entries {
        let id = topics
            .iter()
            .position(|t| *t == (entry.topic, entry.kind))
            .unwrap();
        let mut time = 1_700_000_000_u32.to_le_bytes().to_vec();
        time.extend([0; 4]);
        let head = [
            field("op", &[2]),
            field("conn", &(id as u32).to_le_bytes()),
            field("time", &time),
        ];
        chunk.extend(record(&head, &entry.data));
    }
    let packed = pack(&chunk);
    let mut out = b"#ROSBAG V2.0\n".to_vec();
    let head = [
        field("op", &[3]),
        field("index_pos", &[0; 8]),
        field("conn_count", &[0; 4]),
        field("chunk_count", &[0; 4]),
    ];
    out.extend(record(&head, &[b' '; 40]));
    let head = [
        field("op", &[5]),
        field("compression", compression.as_bytes()),
        field("size", &(chunk.len() as u32).to_le_bytes()),
    ];
    out.extend(record(&head, &packed));
    // Index data: passed over.
    out.extend(record(
        &[field("op", &[4]), field("ver", &[1, 0, 0, 0])],
        &[7; 12],
    ));
    out
}

/// A message under its topic and type.
pub fn entry(topic: &'static str, kind: &'static str, out: Out) -> Entry {
    let data = out.done();
    Entry { topic, kind, data }
}

/// x y z and a turn about z, as messages write poses.
pub fn turned(out: Out, center: [f64; 3], degrees: f64) -> Out {
    let half = degrees.to_radians() / 2.0;
    out.f64s(&center).f64s(&[0.0, 0.0, half.sin(), half.cos()])
}

/// The camera looks down, its top forward: half a turn about (1, -1, 0).
pub fn mount(style: Style) -> Entry {
    let s = 0.5_f64.sqrt();
    let out = Out::new(style)
        .u32(1)
        .header(0, "base_link")
        .text("cam_optical");
    let out = out.f64s(&[0.1, 0.0, -0.2, s, -s, 0.0, 0.0]);
    entry("/tf_static", "tf2_msgs/TFMessage", out)
}

/// The distortion that [`camera_info`] states.
pub const D: [f64; 5] = [-0.2, 0.1, 0.001, -0.002, 0.03];

/// A camera of 640 x 480 pixels, its centre counted from the centre of the first pixel.
pub fn camera_info(style: Style) -> Entry {
    let out = Out::new(style)
        .header(100, "cam_optical")
        .u32(480)
        .u32(640)
        .text("plumb_bob");
    let out = out
        .u32(5)
        .f64s(&D)
        .f64s(&[500.0, 0.0, 319.5, 0.0, 510.0, 239.5, 0.0, 0.0, 1.0]);
    let out = out.f64s(&[7.0; 21]).u32(0).u32(0);
    let out = out.u32(0).u32(0).u32(0).u32(0).byte(0);
    entry("/cam/camera_info", "sensor_msgs/CameraInfo", out)
}

/// An image of a topic; its three bytes are not its pixels.
pub fn image_of(
    style: Style,
    topic: &'static str,
    ms: u32,
    encoding: &str,
    size: [u32; 2],
) -> Entry {
    let out = Out::new(style)
        .header(ms, "cam_optical")
        .u32(size[1])
        .u32(size[0]);
    let out = out
        .text(encoding)
        .byte(0)
        .u32(3)
        .u32(3)
        .byte(1)
        .byte(2)
        .byte(3);
    entry(topic, "sensor_msgs/Image", out)
}

/// An image of the camera's own topic.
pub fn image(style: Style, ms: u32) -> Entry {
    image_of(style, "/cam/image_raw", ms, "rgb8", [640, 480])
}

/// Where the camera is at a time, worked out by hand.
///
/// The camera's axes and its place.
pub fn expected(t: f64) -> (DMat3, DVec3) {
    let turn = DMat3::from_rotation_z((100.0 * t).to_radians());
    let base = DVec3::new(1000.0 + 2.0 * t, 2000.0, 0.0);
    // Right is the base's -y, down its -x, forward its -z.
    let axes = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_X, DVec3::NEG_Z);
    (turn * axes, base + turn * DVec3::new(0.1, 0.0, -0.2))
}

/// The flight of [`expected`], `off` metres beside it along the world's y.
pub fn odometry(topic: &'static str, ms: u32, frames: [&str; 2], off: f64) -> Entry {
    let t = f64::from(ms) / 1000.0;
    let [parent, child] = frames;
    let out = Out::new(Style::Ros1).header(ms, parent).text(child);
    let out = turned(out, [1000.0 + 2.0 * t, 2000.0 + off, 0.0], 100.0 * t);
    entry(topic, "nav_msgs/Odometry", out.f64s(&[0.0; 78]))
}

/// Messages every so many milliseconds.
pub fn every(step: usize, to: u32, of: impl Fn(u32) -> Entry) -> Vec<Entry> {
    (0..=to).step_by(step).map(of).collect()
}

/// The world's frame and the vehicle's.
pub const BASE: [&str; 2] = ["map", "base_link"];

/// Two estimates of the base: /slow of 3 poses 0.5 m off and /fast of 9, of images at 0.2 and 0.6 s.
pub fn two() -> Vec<Entry> {
    let mut entries = vec![mount(Style::Ros1), camera_info(Style::Ros1)];
    entries.extend(every(400, 800, |ms| odometry("/slow", ms, BASE, 0.5)));
    entries.extend(every(100, 800, |ms| odometry("/fast", ms, BASE, 0.0)));
    entries.extend([image(Style::Ros1, 200), image(Style::Ros1, 600)]);
    entries
}
