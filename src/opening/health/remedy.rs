//! What mends what is not good.

use crate::flight::Doubt;
use crate::surface::UpAxis;

/// What mends it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remedy {
    /// Bringing the reconstruction to the world by what is known of it.
    Georeference,
    /// Saying in which unit cloud and poses are.
    SetUnit,
    /// Naming the folder of the photos.
    AddPhotos,
    /// Naming another cloud or mesh.
    AddSurface,
    /// Taking another axis of the surface's file for up.
    TurnUp(UpAxis),
}

impl Remedy {
    /// What mends a reason for doubt. Poses of their own have nothing to be georeferenced by.
    pub fn against(doubt: &Doubt, can_georeference: bool) -> Option<Self> {
        match doubt {
            Doubt::UnitUnknown if !can_georeference => Some(Self::SetUnit),
            Doubt::UnitNotSystems { .. } | Doubt::StrangeSize { .. } => Some(Self::SetUnit),
            Doubt::UnitUnknown => Some(Self::Georeference),
            Doubt::OtherLength { .. } | Doubt::FlyingHeight { .. } | Doubt::LaserRange { .. } => {
                can_georeference.then_some(Self::Georeference)
            }
            Doubt::FileMissing { .. }
            | Doubt::NoPhotoFolder { .. }
            | Doubt::ReducedPhotos { .. }
            | Doubt::FileSize { .. }
            | Doubt::SolvedOnOther { .. }
            | Doubt::SmallerPhotos { .. }
            | Doubt::SameFile { .. }
            | Doubt::FileUnreadable(_) => Some(Self::AddPhotos),
            Doubt::FarFromSurface { .. }
            | Doubt::OtherUnit { .. }
            | Doubt::OffSurface(_)
            | Doubt::NoPoint(_)
            | Doubt::NoisyPoints { .. }
            | Doubt::Wall { .. }
            | Doubt::RoundedPoints { .. } => Some(Self::AddSurface),
            Doubt::NoScale(_)
            | Doubt::NoFit { .. }
            | Doubt::NoLine
            | Doubt::Ratio { .. }
            | Doubt::Sideways { .. }
            | Doubt::LongTriangle { .. }
            | Doubt::FlatView { .. }
            | Doubt::NotPlane { .. }
            | Doubt::OffLine { .. }
            | Doubt::WideInterval { .. }
            | Doubt::SmallAngles { .. }
            | Doubt::NoRotation { .. }
            | Doubt::OffItsPoints { .. }
            | Doubt::OtherPlace { .. }
            | Doubt::OtherHeights { .. }
            | Doubt::UnderSurface
            | Doubt::FromBehind
            | Doubt::TurnedMesh
            | Doubt::StrangeCamera { .. }
            | Doubt::SeveralDevices { .. }
            | Doubt::OtherDevice { .. }
            | Doubt::FocalLength { .. }
            | Doubt::OtherColours { .. }
            | Doubt::OtherDistance { .. }
            | Doubt::OthersElsewhere { .. }
            | Doubt::OthersNowhere { .. }
            | Doubt::PartlyThere { .. }
            | Doubt::MatchesNowhere { .. }
            | Doubt::Flipped { .. } => None,
        }
    }
}
