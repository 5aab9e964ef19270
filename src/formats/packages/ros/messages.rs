//! The messages that a flight is made of, of ROS 1 and ROS 2 alike.
//!
//! Written from the definitions of common_interfaces, common_msgs and geometry2 (`msg/*.msg`): these
//! types have the same fields in the same order in both. A type is named as ROS 1 does, without
//! ROS 2's `/msg/`.

use super::message_bytes::{Header, Malformed, MessageBytes, Serialization};
use crate::camera::Pose;
use crate::geodesy::Geographic;

/// What a message says, as far as a flight needs it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Message {
    Camera(Header, Box<CameraInfo>),
    Image(Header, ImageHead),
    /// A moving frame in the header's frame; its name where the type has one.
    Pose(Header, Option<String>, Pose),
    /// Each a child frame in its header's frame.
    Transforms(Vec<(Header, String, Pose)>),
    /// A receiver's position; `None` without a fix.
    Fix(Header, Option<Geographic>),
}

/// sensor_msgs/CameraInfo, as far as the raw image needs it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CameraInfo {
    pub(super) size: (u32, u32),
    pub(super) model: String,
    pub(super) d: Vec<f64>,
    pub(super) k: Vec<f64>,
    /// x, y, width, height.
    pub(super) region: [u32; 4],
}

/// What is known of an image without its pixels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ImageHead {
    /// Width and height, where the message writes them: a compressed one does not.
    pub(super) size: Option<(u32, u32)>,
    /// Of its pixels ("bgr8", "16UC1", ...), or its compression.
    pub(super) encoding: String,
}

/// A type's name without ROS 2's `/msg/`.
pub(super) fn plain_type(name: &str) -> String {
    name.replacen("/msg/", "/", 1)
}

/// Reads a message of one of the types above; `None` for all others. `type_name` is plain.
pub(super) fn decode(
    type_name: &str,
    data: &[u8],
    serialization: Serialization,
) -> Option<Result<Message, Malformed>> {
    let read = match type_name {
        "sensor_msgs/CameraInfo" => camera_info,
        "sensor_msgs/Image" => image,
        "sensor_msgs/CompressedImage" => compressed_image,
        "geometry_msgs/PoseStamped" => pose_stamped,
        "geometry_msgs/PoseWithCovarianceStamped" => pose_with_covariance,
        "geometry_msgs/TransformStamped" => transform_stamped,
        "nav_msgs/Odometry" => odometry,
        "tf2_msgs/TFMessage" | "tf/tfMessage" => transforms,
        "sensor_msgs/NavSatFix" => fix,
        _ => return None,
    };
    let message = MessageBytes::new(data, serialization).and_then(|mut bytes| {
        let message = read(&mut bytes)?;
        bytes.finish()?;
        Ok(message)
    });
    Some(message)
}

fn camera_info(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    let header = bytes.header()?;
    let (height, width) = (bytes.u32()?, bytes.u32()?);
    let model = bytes.text()?;
    let count = bytes.count(8)?;
    let d = bytes.f64s(count)?;
    let k = bytes.f64s(9)?;
    // R and P, then binning_x and binning_y: of what is made of the raw image.
    bytes.f64s(9 + 12)?;
    bytes.u32()?;
    bytes.u32()?;
    let (x, y) = (bytes.u32()?, bytes.u32()?);
    let (region_height, region_width) = (bytes.u32()?, bytes.u32()?);
    bytes.byte()?;
    let info = CameraInfo {
        size: (width, height),
        model,
        d,
        k,
        region: [x, y, region_width, region_height],
    };
    Ok(Message::Camera(header, Box::new(info)))
}

fn image(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    let header = bytes.header()?;
    let (height, width) = (bytes.u32()?, bytes.u32()?);
    let encoding = bytes.text()?;
    // is_bigendian and the bytes of a row.
    bytes.byte()?;
    bytes.u32()?;
    let count = bytes.count(1)?;
    bytes.skip(count)?;
    let size = Some((width, height));
    Ok(Message::Image(header, ImageHead { size, encoding }))
}

fn compressed_image(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    let header = bytes.header()?;
    let encoding = bytes.text()?;
    let count = bytes.count(1)?;
    bytes.skip(count)?;
    let size = None;
    Ok(Message::Image(header, ImageHead { size, encoding }))
}

fn pose_stamped(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    Ok(Message::Pose(bytes.header()?, None, bytes.pose()?))
}

fn pose_with_covariance(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    let message = pose_stamped(bytes)?;
    bytes.f64s(36)?;
    Ok(message)
}

fn transform_stamped(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    let (header, child, pose) = transform(bytes)?;
    Ok(Message::Pose(header, Some(child), pose))
}

fn odometry(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    let message = transform_stamped(bytes)?;
    // The covariance of the pose, the twist and its covariance.
    bytes.f64s(36 + 6 + 36)?;
    Ok(message)
}

fn transform(bytes: &mut MessageBytes<'_>) -> Result<(Header, String, Pose), Malformed> {
    Ok((bytes.header()?, bytes.frame()?, bytes.pose()?))
}

fn transforms(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    // Stamp, two empty names and seven numbers are the least.
    let count = bytes.count(72)?;
    let transforms = (0..count).map(|_| transform(bytes));
    transforms
        .collect::<Result<_, _>>()
        .map(Message::Transforms)
}

fn fix(bytes: &mut MessageBytes<'_>) -> Result<Message, Malformed> {
    let header = bytes.header()?;
    // status is an i8, and -1 without a fix; then the satellite systems.
    let has_fix = bytes.byte()? < 0x80;
    bytes.u16()?;
    let (latitude, longitude, height) = (bytes.f64()?, bytes.f64()?, bytes.f64()?);
    bytes.f64s(9)?;
    bytes.byte()?;
    let is_place = latitude.abs() <= 90.0 && longitude.abs() <= 360.0 && height.is_finite();
    let position = Geographic {
        longitude,
        latitude,
        height,
    };
    Ok(Message::Fix(
        header,
        (has_fix && is_place).then_some(position),
    ))
}
