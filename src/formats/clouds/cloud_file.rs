//! What a cloud reader hands over.

use std::fmt;

use glam::DVec3;

use crate::fault::Fault;
use crate::geodesy::{Crs, CrsKind};
use crate::geometry::Bounds;
use crate::surface::{Cloud, CloudFacts};

/// A cloud as its file has it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CloudFile {
    /// Points, colours, faces, in the file's own coordinates.
    pub cloud: Cloud,
    /// The coordinate system that the file states: "EPSG:n" or WKT.
    pub crs: Option<String>,
    /// Whether the file says that x and y are degrees: they are brought to a map before a surface is made of them.
    pub geographic: bool,
    /// What the reader had to assume, one sentence each.
    pub warnings: Vec<String>,
    /// How far its coordinates may be off because they are 32-bit floats; 0 where that is nothing beside its size.
    pub rounding: f64,
    /// Of octrees: what their file says of the whole cloud, so that a surface of all of it is that which a part of
    /// it belongs to. In the file's coordinates: gone where the points were moved.
    pub facts: Option<CloudFacts>,
}

impl CloudFile {
    /// Adds a point. Where only some points have colours, the others are grey.
    pub(crate) fn push(&mut self, point: DVec3, color: Option<[u8; 3]>) {
        let colors = &mut self.cloud.colors;
        if color.is_some() && colors.is_empty() {
            colors.resize(self.cloud.points.len(), GREY);
        }
        if color.is_some() || !colors.is_empty() {
            colors.push(color.unwrap_or(GREY));
        }
        self.cloud.points.push(point);
    }

    /// Leaves out points with a coordinate that is NaN: organised clouds mark missing points so. Only of a cloud without faces.
    pub(crate) fn leave_out_missing(&mut self) {
        let Cloud { points, colors, .. } = &mut self.cloud;
        let all = points.len();
        let mut is_there = points.iter().map(|point| !point.is_nan());
        colors.retain(|_| is_there.next().unwrap_or(true));
        points.retain(|point| !point.is_nan());
        let left_out = all - points.len();
        self.say_missing(left_out as u64, all as u64);
    }

    /// Says how many points were marked as missing ones.
    pub(crate) fn say_missing(&mut self, left_out: u64, all: u64) {
        if left_out > 0 {
            self.warnings.push(format!(
                "{left_out} of {all} points are not finite, which marks missing ones; they are left out"
            ));
        }
    }

    /// Warns where coordinates that were stored as f32 are too large for the cloud's own extent:
    /// UTM northings in f32 are rounded to half a metre.
    pub(crate) fn warn_if_rounded(&mut self) {
        if let Some(rounded) = Rounded::of(&self.cloud.points) {
            self.take_rounded(rounded, rounded.to_string());
        }
    }

    /// Takes it that some of its points are rounded, and says so in these words, once.
    pub(crate) fn take_rounded(&mut self, rounded: Rounded, warning: String) {
        self.rounding = self.rounding.max(rounded.by);
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    /// Notes a coordinate system as the file states it, and whether it is one of degrees.
    pub(crate) fn set_crs(&mut self, crs: &str) {
        let crs = crs.trim_matches(|c: char| c == '\0' || c.is_whitespace());
        if crs.is_empty() {
            return;
        }
        self.crs = Some(crs.to_owned());
        self.set_geographic(counts_degrees(crs));
    }

    /// Notes whether the coordinates are degrees, and says it.
    pub(crate) fn set_geographic(&mut self, geographic: bool) {
        self.geographic = geographic;
        if geographic {
            self.warnings.push("its coordinates are degrees".to_owned());
        }
    }

    /// Refuses a file of which nothing was left.
    pub(crate) fn expect_points(&self) -> Result<(), Fault> {
        if self.cloud.points.is_empty() {
            return Err(Fault::new(
                "it has no points",
                "export points with x, y and z",
            ));
        }
        Ok(())
    }
}

/// Whether coordinates in a system are degrees: as it is understood, else by its first word.
pub(crate) fn counts_degrees(crs: &str) -> bool {
    if let Ok(crs) = Crs::understand(crs) {
        return crs.kind() == CrsKind::Geographic;
    }
    let text: String = crs.split_whitespace().collect();
    let text = text.to_ascii_uppercase();
    let starts = |words: &[&str]| words.iter().any(|word| text.starts_with(word));
    // A geodetic system of WKT 2 may count from the Earth's centre.
    starts(&["GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"])
        || (starts(&["GEODCRS", "GEODETICCRS"]) && !text.contains("CS[CARTESIAN"))
}

/// The colour of points without one among points with colours.
const GREY: [u8; 3] = [128; 3];

/// Coordinates that were stored as f32, which has rounded them noticeably. Prints as a sentence.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rounded {
    /// They are off by so much at most.
    by: f64,
    /// The largest of them.
    largest: f64,
}

impl Rounded {
    /// Of these points, if any.
    pub(crate) fn of(points: &[DVec3]) -> Option<Self> {
        let bounds = Bounds::of(points)?;
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let by = largest * f64::from(f32::EPSILON) / 2.0;
        let size = bounds.size().max_element();
        // A single place has no size to compare with.
        (size > 0.0 && by > size * 1e-5).then_some(Self { by, largest })
    }
}

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { by, largest } = self;
        let digits = if *by < 0.005 { 6 } else { 2 };
        write!(
            f,
            "its coordinates are 32-bit floats of up to {largest:.0}, which rounds them to about {by:.digits$}; export doubles, or subtract an offset"
        )
    }
}

/// The index, from 0, of the first point with a coordinate that is not a finite number.
pub(crate) fn first_not_finite(points: &[DVec3]) -> Option<usize> {
    points.iter().position(|point| !point.is_finite())
}
