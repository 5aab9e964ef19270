//! What shows a reason for doubt: what is drawn over the photo, and what of the flight is looked at.

use glam::DVec3;

use super::PhotoReview;
use crate::flight::Doubt;
use crate::scale::{Corner, CornerName};

/// How much of the surface around a corner is shown, as a share of the footprint's mean edge: its triangle
/// and what is beside it.
const AROUND: f64 = 0.12;

/// What shows a reason for doubt.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sight {
    /// Over the photo.
    pub on_photo: OnPhoto,
    /// In the view of the flight.
    pub in_view: InView,
}

/// What is drawn over a photo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OnPhoto {
    /// Nothing: the photo itself is meant.
    Nothing,
    /// These corners are marked.
    Corners(Vec<CornerName>),
    /// The bars of the scale at the top and the bottom edge.
    TopBottom,
    /// The bars of the scale at the left and the right edge.
    Sides,
    /// The scale of its pixels, as colours; what shows no surface has none.
    Field,
}

/// What of the flight is looked at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum InView {
    /// Everything.
    Flight,
    /// The photo's footprint.
    Footprint,
    /// The footprint and the camera, level: how high it stands, how flat it looks.
    FromSide,
    /// These corner points, from near.
    Corners(Vec<CornerName>),
    /// Through the camera, with the photo over the surface.
    ThroughCamera,
}

impl Doubt {
    /// What shows it.
    pub fn sight(&self) -> Sight {
        let (on_photo, in_view) = match self {
            Self::OffSurface(corners)
            | Self::NoPoint(corners)
            | Self::LongTriangle { corners, .. } => (
                OnPhoto::Corners(corners.clone()),
                InView::Corners(corners.clone()),
            ),
            Self::NoFit { .. }
            | Self::NoLine
            | Self::NotPlane { .. }
            | Self::OffLine { .. }
            | Self::NoisyPoints { .. }
            | Self::Wall { .. }
            | Self::RoundedPoints { .. } => (OnPhoto::Field, InView::Footprint),
            Self::Ratio { .. } | Self::WideInterval { .. } => {
                (OnPhoto::TopBottom, InView::Footprint)
            }
            Self::Sideways { .. } => (OnPhoto::Sides, InView::Footprint),
            Self::FlatView { .. } => (OnPhoto::TopBottom, InView::FromSide),
            Self::UnderSurface
            | Self::FromBehind
            | Self::TurnedMesh
            | Self::OtherDistance { .. }
            | Self::OthersElsewhere { .. }
            | Self::PartlyThere { .. }
            | Self::OtherHeights { .. }
            | Self::FlyingHeight { .. }
            | Self::LaserRange { .. } => (OnPhoto::Nothing, InView::FromSide),
            Self::OtherColours { .. }
            | Self::Flipped { .. }
            | Self::MatchesNowhere { .. }
            | Self::OthersNowhere { .. } => (OnPhoto::Nothing, InView::ThroughCamera),
            Self::NoScale(_)
            | Self::UnitUnknown
            | Self::UnitNotSystems { .. }
            | Self::StrangeSize { .. }
            | Self::SmallAngles { .. }
            | Self::NoRotation { .. }
            | Self::OtherLength { .. }
            | Self::FarFromSurface { .. }
            | Self::OtherUnit { .. } => (OnPhoto::Nothing, InView::Flight),
            Self::FileMissing { .. }
            | Self::NoPhotoFolder { .. }
            | Self::ReducedPhotos { .. }
            | Self::FileUnreadable(_)
            | Self::FileSize { .. }
            | Self::SolvedOnOther { .. }
            | Self::OffItsPoints { .. }
            | Self::SameFile { .. }
            | Self::OtherPlace { .. }
            | Self::SmallerPhotos { .. }
            | Self::StrangeCamera { .. }
            | Self::SeveralDevices { .. }
            | Self::OtherDevice { .. }
            | Self::FocalLength { .. } => (OnPhoto::Nothing, InView::Footprint),
        };
        Sight { on_photo, in_view }
    }
}

impl PhotoReview<'_> {
    /// The places in the world that are to be in sight, world units. None where all of the flight is; where
    /// a corner has no point, the footprint is shown with the camera.
    pub fn points_in(&self, view: &InView) -> Vec<DVec3> {
        let center = self.photo.pose.center;
        let corners = || self.scale().into_iter().flat_map(|scale| &scale.corners);
        let footprint = || corners().filter_map(Corner::point);
        match view {
            InView::Flight => Vec::new(),
            InView::Footprint if footprint().count() > 1 => footprint().collect(),
            InView::Footprint | InView::FromSide | InView::ThroughCamera => {
                footprint().chain([center]).collect()
            }
            InView::Corners(names) => {
                let meant = corners().filter(|corner| names.contains(&corner.name));
                let around = meant.filter_map(|corner| {
                    let place = corner.point()?;
                    Some(box_around(place, self.reach(corner.name, place)))
                });
                let around: Vec<DVec3> = around.flatten().collect();
                match around.is_empty() {
                    true => self.points_in(&InView::FromSide),
                    false => around,
                }
            }
        }
    }

    /// How far around a corner point there is something to see, world units.
    fn reach(&self, corner: CornerName, place: DVec3) -> f64 {
        let size = self.view.and_then(|view| view.footprint_size);
        // Nobody has looked at the footprint yet: of usual cameras it is about as wide as it is away.
        let size = size.unwrap_or_else(|| place.distance(self.photo.pose.center));
        let at = CornerName::ALL.iter().position(|name| *name == corner);
        let edge = at.and_then(|at| self.view?.triangle_edges[at]);
        (AROUND * size).max(edge.unwrap_or(0.0))
    }
}

/// The corners of a box.
fn box_around(middle: DVec3, reach: f64) -> impl Iterator<Item = DVec3> {
    let sign = move |corner: u8, bit: u8| if corner & bit == 0 { -reach } else { reach };
    (0..8_u8)
        .map(move |corner| middle + DVec3::new(sign(corner, 1), sign(corner, 2), sign(corner, 4)))
}
