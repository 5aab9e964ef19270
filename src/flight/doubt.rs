//! Reasons not to trust a photo's scale, as sentences that an engineer reads.

use std::fmt;

use crate::scale::CornerName;
use crate::units::LengthUnit;

/// A reason not to trust a photo's scale. Prints as a sentence without a full stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt {
    /// The photo can have no scale at all, for this reason.
    NoScale(String),
    /// These corners were taken on the ground.
    OffSurface(Vec<CornerName>),
    /// These corners have no point, so edges have no scale.
    NoPoint(Vec<CornerName>),
    /// Top and bottom differ too much.
    Ratio {
        /// The larger over the smaller.
        ratio: f64,
        /// [`super::Limits::top_bottom_ratio`].
        limit: f64,
    },
    /// Left and right differ too much.
    Sideways {
        /// The larger over the smaller.
        ratio: f64,
        /// [`super::Limits::left_right_ratio`].
        limit: f64,
    },
    /// A corner lies over a hole of the cloud.
    LongTriangle {
        /// Which corners.
        corners: Vec<CornerName>,
        /// The longest edge, world units.
        edge: f64,
        /// Its limit, world units.
        limit: f64,
        /// Of both.
        unit: LengthUnit,
    },
    /// The view is too flat.
    FlatView {
        /// Degrees.
        angle: f64,
        /// Degrees.
        limit: f64,
    },
    /// The surface is far from the plane through the corners.
    NotPlane {
        /// Root mean square distance, world units.
        distance: f64,
        /// Its limit, world units.
        limit: f64,
        /// Of both.
        unit: LengthUnit,
    },
    /// The photo's file is missing.
    FileMissing,
    /// The photo's file cannot be read, with the reason.
    FileUnreadable(String),
    /// The photo's file has another size than its camera.
    FileSize {
        /// Of the file.
        file: (u32, u32),
        /// Of the camera.
        camera: (u32, u32),
    },
}

fn names(corners: &[CornerName]) -> String {
    let names: Vec<String> = corners
        .iter()
        .map(|corner| corner.as_str().replace('_', " "))
        .collect();
    names.join(", ")
}

/// A value and the limit that it passed, with as many digits as tell them apart, at least `digits`.
fn apart(value: f64, limit: f64, digits: usize) -> (String, String) {
    let at = |digits: usize| (format!("{value:.digits$}"), format!("{limit:.digits$}"));
    (digits..digits + 6)
        .map(at)
        .find(|(value, limit)| value != limit)
        .unwrap_or_else(|| at(17))
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoScale(reason) => write!(f, "no scale: {reason}"),
            Self::OffSurface(corners) => write!(
                f,
                "off the surface, taken on the ground plane: {}",
                names(corners)
            ),
            Self::NoPoint(corners) => write!(
                f,
                "no point on the surface or the ground plane: {}",
                names(corners)
            ),
            Self::Ratio { ratio, limit } => {
                let (ratio, limit) = apart(*ratio, *limit, 2);
                write!(
                    f,
                    "the top and the bottom scale differ by a factor of {ratio}, more than {limit}"
                )
            }
            Self::Sideways { ratio, limit } => {
                let (ratio, limit) = apart(*ratio, *limit, 2);
                write!(
                    f,
                    "the left and the right scale differ by a factor of {ratio}, more than {limit}: a scale from top to bottom does not hold at the sides"
                )
            }
            Self::LongTriangle {
                corners,
                edge,
                limit,
                unit,
            } => {
                let (edge, limit) = apart(*edge, *limit, 3);
                write!(
                    f,
                    "over a hole in the cloud: {} (a triangle edge of {edge} {unit}, more than {limit} {unit})",
                    names(corners)
                )
            }
            Self::FlatView { angle, limit } => {
                let (angle, limit) = apart(*angle, *limit, 1);
                write!(
                    f,
                    "a flat view: a corner's ray comes in at {angle}° to the plane of the corners, less than {limit}°"
                )
            }
            Self::NotPlane {
                distance,
                limit,
                unit,
            } => {
                let (distance, limit) = apart(*distance, *limit, 3);
                write!(
                    f,
                    "not flat between the corners: the surface is {distance} {unit} (root mean square) off their plane, more than {limit} {unit}"
                )
            }
            Self::FileMissing => f.write_str("the photo file is missing"),
            Self::FileUnreadable(reason) => write!(f, "the photo file cannot be read: {reason}"),
            Self::FileSize { file, camera } => write!(
                f,
                "the photo file has {} x {} pixels, its camera {} x {}",
                file.0, file.1, camera.0, camera.1
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nobody reads "2.00, more than 2.00".
    #[test]
    fn a_value_and_its_limit_are_told_apart() {
        let doubt = Doubt::Ratio {
            ratio: 2.0004,
            limit: 2.0,
        };
        assert_eq!(
            doubt.to_string(),
            "the top and the bottom scale differ by a factor of 2.0004, more than 2.0000"
        );
        let doubt = Doubt::FlatView {
            angle: 12.34,
            limit: 30.0,
        };
        assert!(
            doubt
                .to_string()
                .contains("at 12.3° to the plane of the corners, less than 30.0°")
        );
        let (value, limit) = apart(2_f64.next_up(), 2.0, 2);
        assert_ne!(value, limit);
    }
}
