//! Reasons not to trust a photo's scale, as sentences that an engineer reads.

pub(crate) mod kind;

use std::fmt;

use crate::numbers::to_digits;
use crate::scale::{CornerName, LEAST_COVERED, PointNoise};
use crate::units::{LengthUnit, in_words};

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
        /// Its width, percent of its middle.
        percent: f64,
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
    /// The photo's file was taken somewhere else than the pose says, while others fit theirs.
    OtherPlace {
        /// Metres from there.
        distance: f64,
        /// The median of those that fit, metres.
        usual: f64,
    },
    /// The camera is so far from the surface that the two are in different coordinate systems.
    FarFromSurface {
        /// World units.
        distance: f64,
        /// The surface's extent, world units.
        extent: f64,
        /// Of both.
        unit: LengthUnit,
    },
    /// The camera stands under the surface.
    UnderSurface,
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
    /// is that of something else.
    pub fn is_of_the_pile(&self) -> bool {
        matches!(self, Self::FarFromSurface { .. } | Self::UnderSurface) || self.is_of_colours()
    }

    /// Whether the photo's colours say it.
    pub fn is_of_colours(&self) -> bool {
        matches!(self, Self::OtherColours { .. } | Self::Flipped { .. })
    }
}

/// How much more `is` than `stated`, in percent.
fn percent_off(is: f64, stated: f64) -> f64 {
    (is / stated - 1.0) * 100.0
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
            Self::NoLine => f.write_str(
                "no fitted scale: the best line through the scales of its pixels falls to 0 within the photo, whose near and far parts are too \
                 different for a line; what the corners say stands beside it",
            ),
            Self::NoFit { covered } => {
                let (covered, least) = apart(covered * 100.0, LEAST_COVERED * 100.0, 0);
                write!(
                    f,
                    "no fitted scale: only {covered} % of the photo shows the surface, of the {least} % that a line needs; what the corners say stands beside it"
                )
            }
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
                let unit = in_words(*unit);
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
                let unit = in_words(*unit);
                write!(
                    f,
                    "not flat between the corners: the surface is {distance} {unit} (root mean square) off their plane, more than {limit} {unit}"
                )
            }
            Self::OffLine { percent, limit } => {
                let (percent, limit) = apart(*percent, *limit, 1);
                write!(
                    f,
                    "the scale of the photo's pixels is {percent} % (rms) off the best line, more than {limit} %"
                )
            }
            Self::WideInterval { percent, limit } => {
                let (percent, limit) = apart(*percent, *limit, 1);
                write!(
                    f,
                    "the 95 % interval of its scale is {percent} % wide, more than {limit} %"
                )
            }
            Self::NoisyPoints { noise, unit } => write!(
                f,
                "points of one place lie {} {} apart in height (standard deviation), {} % of their distance: a noisy cloud, or layers that do not fit; its scale may be too large by as much: clean or realign the cloud",
                to_digits(noise.height, 2),
                in_words(*unit),
                to_digits(noise.relative * 100.0, 2)
            ),
            Self::Wall { steepness, limit } => {
                let (steepness, limit) = apart(*steepness, *limit, 0);
                write!(
                    f,
                    "what it shows stands at {steepness}° to the level, more than {limit}°: a cloud is triangulated from above, where points of a wall are not beside those that they \
                     are beside on it; give the surface as a mesh"
                )
            }
            Self::UnitUnknown => f.write_str(
                "not a scale: the model is in a frame of its own, whose unit nobody states; georeference it, or set its unit",
            ),
            Self::UnitNotSystems {
                unit,
                system,
                counted,
            } => write!(
                f,
                "the world is said to count in {unit}, and its coordinate system ({system}) counts in {counted}: scales are off by as much"
            ),
            Self::SmallAngles { largest, photos } => write!(
                f,
                "all angles of its {photos} photos lie between -{largest} and {largest}: they are read as degrees, and look like radians",
                largest = to_digits(*largest, 4)
            ),
            Self::NoRotation { line, length } => write!(
                f,
                "the quaternion on line {line} has the length {}, where one of a rotation has 1: it is taken as its direction; a column may be wrong",
                to_digits(*length, 3)
            ),
            Self::RoundedPoints {
                rounding,
                footprint,
                unit,
            } => {
                let unit = in_words(*unit);
                write!(
                    f,
                    "the points of the surface are 32-bit floats, rounded by up to {} {unit}, and the photo shows {} {unit} of it: export doubles, or subtract an offset",
                    to_digits(*rounding, 2),
                    to_digits(*footprint, 2)
                )
            }
            Self::FileMissing { size: (w, h) } => write!(
                f,
                "the photo file is missing: the scale is for images of {w} x {h} px"
            ),
            Self::NoPhotoFolder { size: (w, h) } => write!(
                f,
                "no photo files are known: the scale is for images of {w} x {h} px"
            ),
            Self::ReducedPhotos { size: (w, _), original: Some((ow, oh)) } => write!(
                f,
                "for images of {w} px width, not for the photos, which have {ow} x {oh} px: add the photos"
            ),
            Self::ReducedPhotos { size: (w, _), original: None } => write!(
                f,
                "for images of {w} px width, not for the photos: the package often solves on reduced photos, and the photo file is not there to compare; add the photos"
            ),
            Self::FileUnreadable(reason) => write!(f, "the photo file cannot be read: {reason}"),
            Self::FileSize { file, camera } => write!(
                f,
                "the photo file has {} x {} pixels, its camera {} x {}",
                file.0, file.1, camera.0, camera.1
            ),
            Self::SolvedOnOther {
                size: (w, h),
                reach: (rw, rh),
            } => write!(
                f,
                "the package's image points reach over {rw} x {rh} px, and the photo has {w} x {h}: the model was solved on photos of another size, for which its scale is"
            ),
            Self::OffItsPoints {
                pixels,
                limit,
                points,
            } => {
                let (pixels, limit) = apart(*pixels, *limit, 1);
                write!(
                    f,
                    "the package's points lie {pixels} px (median of {points}, more than {limit}) off where it says that the photo shows them: its pose, focal length or lens is not the one that was solved"
                )
            }
            Self::SameFile { other } => write!(
                f,
                "its file is that of {other}, too: a folder of one of them is missing, or a name stands twice"
            ),
            Self::OtherPlace { distance, usual } => write!(
                f,
                "its file says that it was taken {distance:.0} m from where its pose stands, and the others fit theirs to {usual:.1} m: check whether it is this photo"
            ),
            Self::FarFromSurface {
                distance,
                extent,
                unit,
            } => write!(
                f,
                "taken {distance:.0} {unit} from the surface, which is {extent:.0} {unit} wide: the poses and the surface are in two coordinate systems"
            ),
            Self::UnderSurface => f.write_str(
                "taken from under the surface: check which axis is up, the heights' datum and the poses' convention",
            ),
            Self::StrangeCamera { camera, why } => write!(f, "{camera}: {why}"),
            Self::SeveralDevices { camera, devices } => write!(
                f,
                "{camera} stands for photos of {} devices ({}): give each its own calibration",
                devices.len(),
                devices.join(", ")
            ),
            Self::OtherDevice { camera, device } => write!(
                f,
                "{camera} is used for photos that were taken with a {device}: check that the calibration is theirs"
            ),
            Self::FocalLength {
                camera,
                focal,
                ratio,
                source,
                error,
            } => write!(
                f,
                "{camera} has a focal length of {focal:.1} px, {:+.1} % from the {:.1} px of the photos' metadata ({source}, {:.1} % of error expected): check that the calibration is theirs",
                (ratio - 1.0) * 100.0,
                focal / ratio,
                error * 100.0
            ),
            Self::FlyingHeight { above, stated } => write!(
                f,
                "the cameras are {above:.1} m above the surface below them, but their photos say {stated:.1} m above the take-off ({:+.1} %): the scale, the unit or the heights are wrong, unless the take-off was {:.1} m {} the surface",
                percent_off(*above, *stated),
                (above - stated).abs(),
                if above > stated { "above" } else { "below" }
            ),
            Self::LaserRange { distance, stated } => write!(
                f,
                "the surface in the middle of the photos is {distance:.1} m away, but the drone's laser measured {stated:.1} m ({:+.1} %): the scale, the unit or the poses are wrong",
                percent_off(*distance, *stated)
            ),
            Self::OtherColours { correlation, points } => write!(
                f,
                "its colours do not match those of the surface where its pose says (r = {correlation:.2} at {points} points; a right pose gives about 0.5 and more): check its pose, its camera, whether it is this photo and this surface"
            ),
            Self::Flipped {
                correlation,
                flipped,
                points,
                how,
            } => write!(
                f,
                "its colours match those of the surface (r = {flipped:.2} at {points} points, else {correlation:.2}) after {how}: an axis of its pose is flipped"
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
        let no_fit = |covered| Doubt::NoFit { covered }.to_string();
        assert!(no_fit(0.31).starts_with("no fitted scale: only 31 % of the photo"));
        assert!(
            no_fit(0.4997).contains("only 49.97 % of the photo shows the surface, of the 50.00 %")
        );
        let (value, limit) = apart(2_f64.next_up(), 2.0, 2);
        assert_ne!(value, limit);
    }
}
