//! The bytes of one ROS message, read field by field.
//!
//! Written from the ROS wiki ("Messages", "Serialization and Deserialization") for ROS 1, and for
//! ROS 2 from OMG's DDSI-RTPS (section 10, "Data Encapsulation") and CDR (CORBA 3.3 part 2, 9.3):
//!
//! | | ROS 1 | ROS 2, CDR |
//! |---|---|---|
//! | in front | | 4 bytes: 0, 0 (big) or 1 (little endian), 2 that say nothing |
//! | numbers | little endian, packed | aligned to their size, counted from behind the 4 bytes |
//! | text | u32 length, bytes | u32 length with the closing 0, bytes, 0 |
//! | list | u32 length, elements | the same |
//! | time | u32 s, u32 ns | i32 s, u32 ns |
//! | std_msgs/Header | u32 seq, time, text | time, text |
//!
//! Other encapsulations (parameter lists, XCDR 2) are refused: rosbag2 records plain CDR.

use glam::DVec3;

use crate::camera::Pose;
use crate::poses::trajectory::Stamp;

/// What is wrong with a message, to stand behind "it".
pub(super) type Malformed = &'static str;

const TOO_SHORT: Malformed = "ends too early";

/// What recordings call the writing of ROS 1.
pub(super) const ROS1: &str = "ros1";

/// How messages are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Serialization {
    /// ROS 1.
    Ros1,
    /// ROS 2; which end comes first, each message says.
    Cdr,
}

impl Serialization {
    /// By the name that recordings give it; `None` for one that is not read.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        match name {
            ROS1 => Some(Self::Ros1),
            "cdr" => Some(Self::Cdr),
            _ => None,
        }
    }
}

/// A message that is being read.
#[derive(Debug)]
pub(super) struct MessageBytes<'a> {
    data: &'a [u8],
    at: usize,
    is_cdr: bool,
    is_big: bool,
}

/// std_msgs/Header.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) stamp: Stamp,
    /// Without the leading slash of early ROS.
    pub(super) frame: String,
}

impl<'a> MessageBytes<'a> {
    pub(super) fn new(data: &'a [u8], serialization: Serialization) -> Result<Self, Malformed> {
        let (data, is_big) = match (serialization, data) {
            (Serialization::Ros1, data) => (data, false),
            (Serialization::Cdr, [0, end @ (0 | 1), _, _, data @ ..]) => (data, *end == 0),
            (Serialization::Cdr, [_, _, _, _, ..]) => {
                return Err("is not encapsulated as plain CDR");
            }
            (Serialization::Cdr, _) => return Err(TOO_SHORT),
        };
        let is_cdr = serialization == Serialization::Cdr;
        Ok(Self {
            data,
            at: 0,
            is_cdr,
            is_big,
        })
    }

    fn bytes(&mut self, count: usize) -> Result<&'a [u8], Malformed> {
        let end = self.at.checked_add(count).ok_or(TOO_SHORT)?;
        let bytes = self.data.get(self.at..end).ok_or(TOO_SHORT)?;
        self.at = end;
        Ok(bytes)
    }

    /// The bytes of a number, little endian.
    fn number<const N: usize>(&mut self) -> Result<[u8; N], Malformed> {
        if self.is_cdr {
            self.at = self.at.checked_next_multiple_of(N).ok_or(TOO_SHORT)?;
        }
        let bytes = self.bytes(N)?;
        let mut number: [u8; N] = bytes.try_into().map_err(|_| TOO_SHORT)?;
        if self.is_big {
            number.reverse();
        }
        Ok(number)
    }

    pub(super) fn byte(&mut self) -> Result<u8, Malformed> {
        let [byte] = self.number()?;
        Ok(byte)
    }

    pub(super) fn u16(&mut self) -> Result<u16, Malformed> {
        self.number().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Result<u32, Malformed> {
        self.number().map(u32::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Result<f64, Malformed> {
        self.number().map(f64::from_le_bytes)
    }

    /// The length of a list whose elements take `least` bytes at least: never more than there are.
    pub(super) fn count(&mut self, least: usize) -> Result<usize, Malformed> {
        let count = self.u32()?;
        let left = self.data.len().saturating_sub(self.at);
        usize::try_from(count)
            .ok()
            .filter(|count| count.checked_mul(least).is_some_and(|bytes| bytes <= left))
            .ok_or("has a list that is longer than the message")
    }

    /// A list of numbers.
    pub(super) fn f64s(&mut self, count: usize) -> Result<Vec<f64>, Malformed> {
        (0..count).map(|_| self.f64()).collect()
    }

    /// Passes over bytes.
    pub(super) fn skip(&mut self, count: usize) -> Result<(), Malformed> {
        self.bytes(count).map(drop)
    }

    pub(super) fn text(&mut self) -> Result<String, Malformed> {
        let count = self.count(1)?;
        let bytes = self.bytes(count)?;
        let bytes = match bytes {
            [text @ .., 0] if self.is_cdr => text,
            other => other,
        };
        String::from_utf8(bytes.to_vec()).map_err(|_| "has a text that is not UTF-8")
    }

    /// The name of a frame.
    pub(super) fn frame(&mut self) -> Result<String, Malformed> {
        let name = self.text()?;
        Ok(name.strip_prefix('/').unwrap_or(&name).to_owned())
    }

    pub(super) fn stamp(&mut self) -> Result<Stamp, Malformed> {
        let seconds = if self.is_cdr {
            i64::from(self.number().map(i32::from_le_bytes)?)
        } else {
            i64::from(self.u32()?)
        };
        // 32 bits of seconds in nanoseconds are within the 64 of i64.
        Ok(Stamp(seconds * 1_000_000_000 + i64::from(self.u32()?)))
    }

    pub(super) fn header(&mut self) -> Result<Header, Malformed> {
        if !self.is_cdr {
            self.u32()?;
        }
        Ok(Header {
            stamp: self.stamp()?,
            frame: self.frame()?,
        })
    }

    /// geometry_msgs/Pose, and Transform, which is written alike: x y z, qx qy qz qw.
    pub(super) fn pose(&mut self) -> Result<Pose, Malformed> {
        let center = DVec3::new(self.f64()?, self.f64()?, self.f64()?);
        let quaternion = [self.f64()?, self.f64()?, self.f64()?, self.f64()?];
        if !center.is_finite() || !quaternion.iter().all(|q| q.is_finite()) {
            return Err("has a pose that is not finite");
        }
        Pose::from_quaternion(center, quaternion).map_err(|_| "has a quaternion without length")
    }

    /// Whether everything has been read: what is left of a message of another layout would show here.
    /// CDR may be filled up to a multiple of 8.
    pub(super) fn finish(self) -> Result<(), Malformed> {
        let left = self.data.len().saturating_sub(self.at);
        if left >= 8 || (left > 0 && !self.is_cdr) {
            return Err("is longer than its type");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cdr_is_aligned_from_behind_its_first_four_bytes() {
        // u8 7, (3 bytes), u32 9, text "ab", (1 byte of 8 behind 15), f64 1.5
        let little = [
            0, 1, 0, 0, 7, 0xaa, 0xaa, 0xaa, 9, 0, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 0xaa, 0, 0, 0,
            0, 0, 0, 0xf8, 0x3f,
        ];
        let big = [
            0, 0, 0, 0, 7, 0xaa, 0xaa, 0xaa, 0, 0, 0, 9, 0, 0, 0, 3, b'a', b'b', 0, 0xaa, 0x3f,
            0xf8, 0, 0, 0, 0, 0, 0,
        ];
        for bytes in [little, big] {
            let mut message = MessageBytes::new(&bytes, Serialization::Cdr).unwrap();
            assert_eq!(message.byte(), Ok(7));
            assert_eq!(message.u32(), Ok(9));
            assert_eq!(message.text().as_deref(), Ok("ab"));
            assert_eq!(message.f64(), Ok(1.5));
            assert_eq!(message.finish(), Ok(()));
        }
        for other in [[0, 2, 0, 0], [0, 7, 0, 0], [1, 1, 0, 0]] {
            assert!(MessageBytes::new(&other, Serialization::Cdr).is_err());
        }
        assert!(MessageBytes::new(&[0, 1], Serialization::Cdr).is_err());
    }

    #[test]
    fn ros_1_is_packed() {
        let bytes = [
            5, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, b'/', b'm', b'a', b'p',
        ];
        let mut message = MessageBytes::new(&bytes, Serialization::Ros1).unwrap();
        let header = message.header().unwrap();
        assert_eq!(
            header,
            Header {
                stamp: Stamp(2_000_000_003),
                frame: "map".into()
            }
        );
        assert_eq!(message.finish(), Ok(()));
    }

    #[test]
    fn no_length_is_believed() {
        let bytes = [0xff; 8];
        let mut message = MessageBytes::new(&bytes, Serialization::Ros1).unwrap();
        assert!(message.text().is_err());
        let mut message = MessageBytes::new(&bytes, Serialization::Ros1).unwrap();
        assert!(message.count(56).is_err());
        let mut message = MessageBytes::new(&bytes, Serialization::Ros1).unwrap();
        assert!(message.f64s(9).is_err());
        let message = MessageBytes::new(&bytes, Serialization::Ros1).unwrap();
        assert!(message.finish().is_err());
    }
}
