//! Reasons for doubt in words: a sentence each, without a full stop.

use std::fmt;

use super::Doubt;
use crate::numbers::{apart, significant_digits, to_digits};
use crate::scale::{CornerName, LEAST_COVERED};
use crate::units::{LengthUnit, in_words};

/// A unit of many.
fn many(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::Millimetre => "millimetres",
        LengthUnit::Centimetre => "centimetres",
        LengthUnit::Metre => "metres",
        LengthUnit::Inch => "inches",
        LengthUnit::Foot => "feet",
        LengthUnit::UsSurveyFoot => "US survey feet",
    }
}

/// How much more `is` than `stated`, in percent.
fn percent_off(is: f64, stated: f64) -> f64 {
    (is / stated - 1.0) * 100.0
}

/// Where a surface at so many times its distance is seen, and what a scale on it is too much of.
fn farther(factor: f64) -> (String, &'static str) {
    let percent = (factor - 1.0).abs() * 100.0;
    match factor > 1.0 {
        true => (format!("{percent:.1} % farther away"), "large"),
        false => (format!("{percent:.1} % nearer"), "small"),
    }
}

fn names(corners: &[CornerName]) -> String {
    let names: Vec<String> = corners
        .iter()
        .map(|corner| corner.as_str().replace('_', " "))
        .collect();
    names.join(", ")
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
            Self::WideInterval { percent: None, .. } => f.write_str(
                "how sure its scale is cannot be said: with the errors that are stated, rays of its corners leave the surface",
            ),
            Self::WideInterval {
                percent: Some(percent),
                limit,
            } => {
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
                "no scale and no length: the model is in a frame of its own, whose unit nobody states; georeference it, or set its unit",
            ),
            Self::UnitNotSystems {
                unit,
                system,
                counted,
            } => write!(
                f,
                "the world is said to count in {unit}, and its coordinate system ({system}) counts in {counted}: scales are off by as much"
            ),
            Self::StrangeSize { across } => {
                let (number, unit) = match *across {
                    across if across < 1.0 => (across * 1000.0, "mm"),
                    across => (across / 1000.0, "km"),
                };
                write!(
                    f,
                    "it shows {} {unit} from side to side, as no photo of a blast does: the unit of the flight is likely another than is stated",
                    significant_digits(number, 2)
                )
            }
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
            Self::OtherPlace {
                distance,
                usual: Some(usual),
            } => write!(
                f,
                "its file says that it was taken {distance:.0} m from where its pose stands, and the others fit theirs to {usual:.1} m: check whether it is this photo"
            ),
            Self::OtherPlace {
                distance,
                usual: None,
            } => write!(
                f,
                "the photos' files say that they were taken elsewhere than their poses stand ({distance:.0} m, the median): check whether they are called as they were when the poses were found"
            ),
            Self::OtherLength { ratio, error } => write!(
                f,
                "the poses are {ratio:.3} times as far apart as the photos' files say that they were taken (to {:.1} %): the unit or the scale of the model is wrong",
                error * 100.0
            ),
            Self::OtherHeights { poses, surface } => write!(
                f,
                "the poses' heights count from {poses}, the surface's from {surface}, which may be tens of metres apart: export both with the same heights"
            ),
            Self::SmallerPhotos {
                size: (w, h),
                calibrated: (cw, ch),
            } => write!(
                f,
                "its file has {w} x {h} px and its camera was calibrated for {cw} x {ch}: the scale is right if the photo was made smaller as a whole, and wrong if it was cropped"
            ),
            Self::FarFromSurface {
                distance,
                extent,
                unit,
            } => {
                let unit = in_words(*unit);
                write!(
                    f,
                    "taken {distance:.0} {unit} from the surface, which is {extent:.0} {unit} wide: the poses and the surface are in two coordinate systems"
                )
            }
            Self::OtherUnit { poses, surface } => {
                let factor = poses.in_units_of(*surface);
                let (factor, off) = match factor > 1.0 {
                    true => (factor, "large"),
                    false => (factor.recip(), "small"),
                };
                // Feet are 3.28 to a metre.
                let decimals = if factor < 10.0 { 2 } else { 0 };
                write!(
                    f,
                    "no photo sees the surface, which is about {factor:.decimals$} times too {off} for the poses: are the poses in {} and the \
                     surface in {}? If not, check the coordinate systems, which axis is up and the heights' datum",
                    many(*poses),
                    many(*surface)
                )
            }
            Self::UnderSurface => f.write_str(
                "taken from under the surface: check which axis is up, the heights' datum and the poses' convention",
            ),
            Self::FromBehind => f.write_str(
                "taken from behind the faces of the mesh: it is turned over, mirrored or inside out against the poses (scales are \
                 right in the last case only: turn its faces round to make sure)",
            ),
            Self::TurnedMesh => f.write_str(
                "the mesh looked away from the photos and was turned by 180 degrees about x for that alone, as Meshroom turns meshes since \
                 2023; one that is only inside out was right as it was, and its scale is wrong now: look at the photo over the mesh",
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
                "{camera} has a focal length of {focal:.1} px, {:+.1} % from the {:.1} px of the photos' metadata ({source}, {:.1} % of error expected): check that the calibration is theirs or, where it was found from these photos, add some that look obliquely",
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
            Self::OtherDistance {
                other,
                factor,
                there,
                here,
            } => {
                let (place, wrong) = farther(*factor);
                write!(
                    f,
                    "it and {other} see the surface {place} than it is (their pictures match there with r = {there:.2}, on the surface with {here:.2}), and its scale is too {wrong} by about as much: look whether surface, poses, heights and focal length are of one flight and one day"
                )
            }
            Self::PartlyThere { other, share } => write!(
                f,
                "it and {other} see the surface where it is in {:.0} % of what both show, and the rest elsewhere or not at all: look whether the surface is of the same day as the photos, and whole",
                share * 100.0
            ),
            Self::MatchesNowhere { other } => write!(
                f,
                "by their poses it and {other} show the same rock, and their pictures are alike at no distance of it: look whether it is this photo (renamed, turned, of another flight) and its pose; leaves and water do so, too"
            ),
            Self::OthersElsewhere { photos, factor } => {
                let (place, wrong) = farther(*factor);
                let who = match photos {
                    1 => "the one photo of the flight that does sees".to_owned(),
                    n => format!("the {n} photos of the flight that do see"),
                };
                write!(
                    f,
                    "it does not show by itself where the surface is, and {who} it {place} than it is, none in its place: its scale, too, may be too {wrong} by about as much; look whether surface, poses, heights and focal length are of one flight and one day"
                )
            }
            Self::OthersNowhere { photos } => write!(
                f,
                "it does not show by itself where the surface is, and none of the {photos} photos of the flight that were compared with those beside them does: look whether photos, poses and surface are of one flight"
            ),
            Self::Flipped {
                correlation,
                flipped,
                points,
                how,
            } => write!(
                f,
                "its colours match those of the surface (r = {flipped:.2} at {points} points, else {correlation:.2}) after {how}: an axis of its pose is flipped, or the picture was turned"
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
