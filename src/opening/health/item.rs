//! What of a flight is looked at: each reason for doubt speaks against one of these.

use crate::flight::Doubt;

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HealthItem {
    /// Of the world.
    Unit,
    /// Of the world.
    CoordinateSystem,
    /// The angles of the poses, and whether photos show points where the poses say. Only where something speaks against them.
    Poses,
    /// Which way the surface is up.
    UpAxis,
    /// Of the surface, and whether those of the photos are the same.
    Colours,
    /// Whether photos see the surface where it is. Only where photos were compared with those beside them.
    Distance,
    /// What the photos' files say of their cameras.
    Exif,
    /// Of the surface, where photos look.
    Holes,
    /// Of the surface: whether they lie on it. Looked for only where something speaks against them.
    Points,
    /// Their files.
    Photos,
}

impl HealthItem {
    /// In one or two words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Unit => "unit",
            Self::CoordinateSystem => "coordinates",
            Self::Poses => "poses",
            Self::UpAxis => "up",
            Self::Colours => "colours",
            Self::Distance => "distance",
            Self::Exif => "EXIF",
            Self::Holes => "holes",
            Self::Points => "points",
            Self::Photos => "photos",
        }
    }

    /// What a reason for doubt speaks against; `None` where it is of one photo's view, and the flight is well.
    pub fn doubted_by(doubt: &Doubt) -> Option<Self> {
        match doubt {
            Doubt::UnitUnknown
            | Doubt::UnitNotSystems { .. }
            | Doubt::StrangeSize { .. }
            | Doubt::OtherUnit { .. } => Some(Self::Unit),
            Doubt::FarFromSurface { .. } | Doubt::OtherHeights { .. } => {
                Some(Self::CoordinateSystem)
            }
            Doubt::SmallAngles { .. } | Doubt::NoRotation { .. } | Doubt::OffItsPoints { .. } => {
                Some(Self::Poses)
            }
            Doubt::UnderSurface | Doubt::FromBehind | Doubt::TurnedMesh => Some(Self::UpAxis),
            Doubt::OtherColours { .. } | Doubt::Flipped { .. } => Some(Self::Colours),
            Doubt::OtherDistance { .. }
            | Doubt::OthersElsewhere { .. }
            | Doubt::OthersNowhere { .. }
            | Doubt::PartlyThere { .. }
            | Doubt::MatchesNowhere { .. } => Some(Self::Distance),
            Doubt::StrangeCamera { .. }
            | Doubt::SeveralDevices { .. }
            | Doubt::OtherDevice { .. }
            | Doubt::FocalLength { .. }
            | Doubt::FlyingHeight { .. }
            | Doubt::LaserRange { .. }
            | Doubt::OtherPlace { .. }
            | Doubt::OtherLength { .. } => Some(Self::Exif),
            Doubt::OffSurface(_)
            | Doubt::NoPoint(_)
            | Doubt::LongTriangle { .. }
            | Doubt::NoFit { .. } => Some(Self::Holes),
            Doubt::NoisyPoints { .. } | Doubt::RoundedPoints { .. } | Doubt::Wall { .. } => {
                Some(Self::Points)
            }
            Doubt::FileMissing { .. }
            | Doubt::NoPhotoFolder { .. }
            | Doubt::ReducedPhotos { .. }
            | Doubt::FileUnreadable(_)
            | Doubt::FileSize { .. }
            | Doubt::SolvedOnOther { .. }
            | Doubt::SmallerPhotos { .. }
            | Doubt::SameFile { .. } => Some(Self::Photos),
            Doubt::NoScale(_)
            | Doubt::NoLine
            | Doubt::Ratio { .. }
            | Doubt::Sideways { .. }
            | Doubt::FlatView { .. }
            | Doubt::NotPlane { .. }
            | Doubt::OffLine { .. }
            | Doubt::WideInterval { .. } => None,
        }
    }
}
