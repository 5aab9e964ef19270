//! Reasons not to trust a photo's scale, as sentences that an engineer reads.

pub(crate) mod kind;
mod words;

use crate::scale::{CornerName, PointNoise};
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
    /// Too little of the photo shows the surface for a best line, which is what goes to Split-Desktop.
    NoFit {
        /// The share of the photo that shows the surface.
        covered: f64,
    },
    /// The best line falls to 0 within the photo: that is no scale.
    NoLine,
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
        /// Of both; `None` where nobody states it.
        unit: Option<LengthUnit>,
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
        /// Of both; `None` where nobody states it.
        unit: Option<LengthUnit>,
    },
    /// The scale of the photo's pixels is far from the best line.
    OffLine {
        /// Root mean square, percent.
        percent: f64,
        /// Percent.
        limit: f64,
    },
    /// The interval of a scale that goes to Split-Desktop is wide.
    WideInterval {
        /// Its width, percent of its middle; `None` where it cannot be said, because rays of drawn errors leave the surface.
        percent: Option<f64>,
        /// Percent.
        limit: f64,
    },
    /// Points of one place lie apart by more than reconstructions leave.
    NoisyPoints {
        /// How far (standard deviation).
        noise: PointNoise,
        /// Of its height; `None` where nobody states it.
        unit: Option<LengthUnit>,
    },
    /// A cloud's points stand on a wall, over which they are triangulated from above.
    Wall {
        /// How steep, degrees from level.
        steepness: f64,
        /// Degrees.
        limit: f64,
    },
    /// Nobody says what unit the world counts in.
    UnitUnknown,
    /// The world's coordinate system counts in another unit than is said of the world.
    UnitNotSystems {
        /// As is said.
        unit: LengthUnit,
        /// The system's name.
        system: String,
        /// What the system counts in, in words.
        counted: String,
    },
    /// The photo shows so much from side to side as none of a blast does: the world counts in another unit than is said of it.
    StrangeSize {
        /// Metres, as the unit is said.
        across: f64,
    },
    /// All angles of the poses are so small that they may be radians.
    SmallAngles {
        /// The largest, without its sign, as the file has it.
        largest: f64,
        /// Of so many photos.
        photos: usize,
    },
    /// A quaternion of the poses is no rotation's: a column may be wrong.
    NoRotation {
        /// The first such line, from 1.
        line: u64,
        /// The quaternion's length.
        length: f64,
    },
    /// The points of the surface are rounded too coarsely for what the photo shows.
    RoundedPoints {
        /// Their coordinates are off by as much at most, world units.
        rounding: f64,
        /// The width of the photo's footprint, world units.
        footprint: f64,
        /// Of both; `None` where nobody states it.
        unit: Option<LengthUnit>,
    },
    /// The photo's file is missing, so that the photo's size is not known.
    FileMissing {
        /// The image that the scale is for, pixels.
        size: (u32, u32),
    },
    /// The flight names no folder of photo files, so that the photo's size is not known.
    NoPhotoFolder {
        /// The image that the scale is for, pixels.
        size: (u32, u32),
    },
    /// The photo's file is not there, and there is reason to believe that the model was solved on a
    /// reduced copy of it.
    ReducedPhotos {
        /// The image that the scale is for, pixels.
        size: (u32, u32),
        /// The photo's own size where the package names it; `None` where the package is only known to
        /// reduce.
        original: Option<(u32, u32)>,
    },
    /// The photo's file cannot be read, with the reason.
    FileUnreadable(String),
    /// The photo's file has another size than its camera.
    FileSize {
        /// Of the file.
        file: (u32, u32),
        /// Of the camera.
        camera: (u32, u32),
    },
    /// The image points that the package found are not those of a photo of this size.
    SolvedOnOther {
        /// Of the photo, pixels.
        size: (u32, u32),
        /// Over how much of a photo the points reach, pixels, around its middle.
        reach: (u32, u32),
    },
    /// The package's points do not project to where its image points say that the photo shows them.
    OffItsPoints {
        /// The median distance, pixels.
        pixels: f64,
        /// Pixels.
        limit: f64,
        /// Of so many.
        points: usize,
    },
    /// The photo's file is another photo's, too.
    SameFile {
        /// The other one, as the flight calls it.
        other: String,
    },
    /// The photo's file was taken somewhere else than the pose says.
    OtherPlace {
        /// Metres from there, less what all are off.
        distance: f64,
        /// The median of those that fit, metres; `None` where hardly any does.
        usual: Option<f64>,
    },
    /// The photos were taken nearer together or farther apart than their poses are: the length of the flight is another.
    OtherLength {
        /// Of the poses' distances over those of the receivers.
        ratio: f64,
        /// How well the receivers tell it, as a share (95 %).
        error: f64,
    },
    /// The heights of the poses and those of the surface count from different levels.
    OtherHeights {
        /// What the poses' count from.
        poses: String,
        /// What the surface's count from.
        surface: String,
    },
    /// The photo's file has fewer pixels than its camera was calibrated for: made smaller as a whole, or cropped.
    SmallerPhotos {
        /// Of the file, pixels.
        size: (u32, u32),
        /// Of the calibration, pixels.
        calibrated: (u32, u32),
    },
    /// The camera is so far from the surface that the two are in different coordinate systems.
    FarFromSurface {
        /// World units.
        distance: f64,
        /// The surface's extent, world units.
        extent: f64,
        /// Of both.
        unit: Option<LengthUnit>,
    },
    /// No photo sees the surface as they stand, and all do where the poses count in another unit than it.
    OtherUnit {
        /// Of the poses, likely.
        poses: LengthUnit,
        /// Of the surface, likely.
        surface: LengthUnit,
    },
    /// The camera stands under the surface.
    UnderSurface,
    /// It sees the faces of a mesh from behind.
    FromBehind,
    /// The mesh was turned over because it looked away, and nothing else says that it is to be.
    TurnedMesh,
    /// Its camera's intrinsics are none that a lens has.
    StrangeCamera {
        /// What the flight calls the camera.
        camera: String,
        /// In words.
        why: String,
    },
    /// Its camera stands for photos of several devices.
    SeveralDevices {
        /// What the flight calls the camera.
        camera: String,
        /// The models.
        devices: Vec<String>,
    },
    /// Its camera is named after another device than the one that took it.
    OtherDevice {
        /// What the flight calls the camera.
        camera: String,
        /// Make and model in the photo's metadata.
        device: String,
    },
    /// The camera's focal length is not the metadata's.
    FocalLength {
        /// What the flight calls the camera.
        camera: String,
        /// Of the camera, pixels.
        focal: f64,
        /// Over what the metadata say.
        ratio: f64,
        /// Where the metadata say it, in words.
        source: &'static str,
        /// How far the metadata may be off, as a share.
        error: f64,
    },
    /// The cameras fly at another height than their metadata say (medians over the flight).
    FlyingHeight {
        /// Above the surface below them, metres.
        above: f64,
        /// Above the take-off, as the metadata say, metres.
        stated: f64,
    },
    /// The surface is not where the drone's laser measured it (medians over the flight).
    LaserRange {
        /// To the surface in the middle of the photos, metres.
        distance: f64,
        /// As the laser measured it, metres.
        stated: f64,
    },
    /// The photo's colours are not those of the surface.
    OtherColours {
        /// Pearson's correlation of the brightness.
        correlation: f64,
        /// Of so many points.
        points: usize,
    },
    /// The photo and one beside it see the surface nearer or farther than it is.
    OtherDistance {
        /// The name of the photo beside it.
        other: String,
        /// At so many times its distance.
        factor: f64,
        /// The mean correlation of the photos' patches there.
        there: f64,
        /// Their mean correlation where the surface is.
        here: f64,
    },
    /// The photo and one beside it see the surface in its place only in a part of what both show.
    PartlyThere {
        /// The name of the photo beside it.
        other: String,
        /// In this share.
        share: f64,
    },
    /// The photo is like those beside it at no distance of the surface.
    MatchesNowhere {
        /// The name of one of them.
        other: String,
    },
    /// Whether it sees the surface in its place it does not tell; photos of the flight that do see it elsewhere, all of them.
    OthersElsewhere {
        /// So many.
        photos: usize,
        /// At so many times its distance, their median.
        factor: f64,
    },
    /// Whether it sees the surface in its place it does not tell, nor does any photo of the flight that was compared with those beside it.
    OthersNowhere {
        /// So many were.
        photos: usize,
    },
    /// The photo's colours match those of the surface when it is turned over.
    Flipped {
        /// Pearson's correlation as the photo is.
        correlation: f64,
        /// Pearson's correlation after turning it.
        flipped: f64,
        /// Of so many points.
        points: usize,
        /// How it was turned, in words.
        how: &'static str,
    },
}

impl Doubt {
    /// Whether the numbers of the scale are not those of the photo that the engineer has, for a reason
    /// that no look at the flight can dispel.
    pub fn is_of_the_number(&self) -> bool {
        matches!(
            self,
            Self::UnitUnknown
                | Self::UnitNotSystems { .. }
                | Self::ReducedPhotos { .. }
                | Self::SolvedOnOther { .. }
        )
    }

    /// Whether the photo does not stand where one of this surface can, or does not show it: its scale
    /// may be that of something else.
    pub fn is_of_the_pile(&self) -> bool {
        let is_of_its_place = matches!(
            self,
            Self::FarFromSurface { .. }
                | Self::OtherUnit { .. }
                | Self::UnderSurface
                | Self::FromBehind
                | Self::TurnedMesh
                | Self::OthersElsewhere { .. }
                | Self::OthersNowhere { .. }
        );
        is_of_its_place || self.is_of_pixels()
    }

    /// Whether the photo's colours say it.
    pub fn is_of_colours(&self) -> bool {
        matches!(self, Self::OtherColours { .. } | Self::Flipped { .. })
    }

    /// Whether what the photo shows says it: its colours, or its stones.
    pub fn is_of_pixels(&self) -> bool {
        self.is_of_colours()
            || matches!(
                self,
                Self::OtherDistance { .. } | Self::PartlyThere { .. } | Self::MatchesNowhere { .. }
            )
    }
}
