//! How sure a photo's scale is (contract, section 8): standard errors, 95 % intervals, and the parts
//! that pose, lens, surface and world have in them.
//!
//! Four corners hang on four places of a rough surface, so their rays are cast again under drawn errors
//! (`corners`); thousands of pixels behind the best line see the pile as a whole, of which derivatives
//! tell all (`line`); where the surface ends inside the photo, what is not seen of it is drawn from what
//! is (`holes`), and where triangles bridge what no photo saw, it is deeper (`bridges`, for corners, too); one pixel hangs on
//! one place as well (`pixels`). What the surface adds comes from the cloud itself (`surface_error`), and more where
//! the deep between fragments has no points (`unseen`), or points of one place do not agree (`point_noise`). Draws follow from one seed: the same on every run.

mod bridges;
mod corners;
mod draws;
mod holes;
mod line;
mod moved;
mod pixels;
mod point_noise;
mod stratified;
mod surface_error;
mod unseen;

use self::bridges::{Bridged, Bridges};
use self::corners::CornerDraws;
pub use self::draws::Draws;
use self::line::LineErrors;
pub use self::pixels::PixelErrors;
pub use self::point_noise::PointNoise;
use self::surface_error::{DepthErrors, plane_of, without_flying};
use self::unseen::Unseen;
use super::field::ScaleField;
use super::{EdgeScales, FittedScale, PhotoScale, PoseErrors, ScalePair, StatedErrors};
use crate::surface::Surface;

/// With fewer points nothing is known of a photo's surface.
const LEAST_POINTS: usize = 30;

/// How sure one scale is, pixels per world unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// One standard deviation.
    pub standard_error: f64,
    /// The lower end of the 95 % interval.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

impl Interval {
    /// How wide it is, in percent of its middle.
    pub fn width_percent(self) -> f64 {
        (self.high - self.low) / ((self.high + self.low) / 2.0).abs() * 100.0
    }

    /// The same times `factor`.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            standard_error: self.standard_error * factor,
            low: self.low * factor,
            high: self.high * factor,
        }
    }
}

/// What has a part in a scale's error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ErrorSource {
    /// Where the camera stands and where it looks.
    Pose,
    /// Its focal length.
    Lens,
    /// The cloud, and what lies between its points.
    Surface,
    /// The length of the world's unit.
    World,
}

impl ErrorSource {
    /// All, in the order of exports.
    pub const ALL: [Self; 4] = [Self::Pose, Self::Lens, Self::Surface, Self::World];

    /// Its name in exports.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Lens => "lens",
            Self::Surface => "surface",
            Self::World => "world",
        }
    }
}

/// How sure the scales of one photo are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Uncertainty {
    /// Of the edges; `None` where the edge has no scale.
    pub top: Option<Interval>,
    /// Of the bottom edge.
    pub bottom: Option<Interval>,
    /// Of the left edge.
    pub left: Option<Interval>,
    /// Of the right edge.
    pub right: Option<Interval>,
    /// Of the best line's top; `None` where there is no line.
    pub fitted_top: Option<Interval>,
    /// Of its bottom.
    pub fitted_bottom: Option<Interval>,
    /// The standard error that each source alone would leave in the line, percent (root mean square of
    /// top and bottom), in the order of [`ErrorSource::ALL`]; `None` where nobody states it, so that it
    /// is not counted, and where there is no line.
    pub line_parts_percent: [Option<f64>; 4],
    /// The same of the corners' top and bottom.
    pub corner_parts_percent: [Option<f64>; 4],
    /// Whether the top's or the bottom's corners are so unsure that the rays of many draws leave the surface: then nothing can be said
    /// of how sure that edge is, and it is not sure.
    pub leaves_surface: bool,
    /// What is stated of the pose, where that is only one half of it: the other counts as without error.
    pub half_a_pose: Option<HalfAPose>,
    /// Which sources somebody states, or the cloud shows, in the order of [`ErrorSource::ALL`].
    pub known: [bool; 4],
    /// How far points of one place lie apart; of a surface that came with its faces nothing is known of it.
    pub noise: PointNoise,
    /// How steep the plane stands that lies best through what the photo shows of a cloud, degrees from level; 0 of a surface that
    /// came with its faces.
    pub steepness: f64,
}

/// What the uncertainty of a photo follows from.
#[derive(Debug, Clone, Copy)]
pub struct UncertainPhoto<'a> {
    /// Its field on the grid of the fit.
    pub field: &'a ScaleField,
    /// The line through it.
    pub fitted: Option<&'a FittedScale>,
    /// Its corners.
    pub scale: &'a PhotoScale,
    /// How sure somebody is of what both are computed from.
    pub errors: StatedErrors,
}

impl Uncertainty {
    /// How sure the scales of a photo are. `None` where nothing is known of
    /// any source: that is not the same as no error.
    pub fn compute(photo: &UncertainPhoto<'_>, surface: &Surface) -> Option<Self> {
        let plane = plane_of(photo.field)?;
        let errors = DepthErrors::of(photo.field, plane, surface);
        let quiet = errors.without_noise();
        let unseen = Unseen::of(&quiet);
        // Triangles that came with a mesh are what they are.
        let bridges = (surface.is_cloud()).then(|| Bridges::in_field(photo.field, plane));
        let between = (unseen, bridges.as_ref());
        let corners = CornerDraws::new(photo, plane, (&errors.each, between), surface);
        let line = photo.fitted.map(|fitted| {
            let bridged = bridges.as_ref().map_or_else(Bridged::default, |bridges| {
                bridges.on_line([fitted.top, fitted.bottom])
            });
            LineErrors::new(
                photo,
                fitted,
                plane,
                &without_flying(&quiet.each),
                (unseen, bridged, errors.noise),
            )
        });
        let line_parts = line.as_ref().map(LineErrors::parts_percent);
        let line_parts_percent = line_parts.unwrap_or_default();
        let corner_parts_percent = corners.parts_percent();
        // Where nothing is counted there is nothing to say.
        let mut counted = line_parts_percent.iter().chain(&corner_parts_percent);
        counted.find(|part| part.is_some())?;
        let EdgeScales {
            top,
            right,
            bottom,
            left,
        } = photo.scale.scale;
        let fitted = |of: fn(&LineErrors) -> Interval| line.as_ref().map(of);
        Some(Self {
            top: corners.interval(0, top),
            right: corners.interval(1, right),
            bottom: corners.interval(2, bottom),
            left: corners.interval(3, left),
            fitted_top: fitted(LineErrors::top),
            fitted_bottom: fitted(LineErrors::bottom),
            line_parts_percent,
            corner_parts_percent,
            leaves_surface: corners.leaves_surface,
            half_a_pose: HalfAPose::of(photo.errors.pose),
            known: corners.known,
            noise: errors.noise,
            steepness: match surface.is_cloud() {
                true => steepness(photo.field, plane),
                false => 0.0,
            },
        })
    }

    /// The same with its scales times `factor`.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let times = |interval: Option<Interval>| interval.map(|interval| interval.times(factor));
        Self {
            top: times(self.top),
            bottom: times(self.bottom),
            left: times(self.left),
            right: times(self.right),
            fitted_top: times(self.fitted_top),
            fitted_bottom: times(self.fitted_bottom),
            ..*self
        }
    }

    /// The standard error that each source alone would leave in the scales that go to Split-Desktop,
    /// percent, in the order of [`ErrorSource::ALL`]; `None` where it is not counted.
    pub fn parts_percent(&self, pair: ScalePair) -> [Option<f64>; 4] {
        match pair {
            ScalePair::Fitted if self.fitted_top.is_some() => self.line_parts_percent,
            _ => self.corner_parts_percent,
        }
    }

    /// What is not counted, because nobody states it.
    pub fn not_counted(&self, pair: ScalePair) -> impl Iterator<Item = ErrorSource> {
        let is_corners = pair == ScalePair::Corners || self.fitted_top.is_none();
        // A part whose draws have left the surface is known to be large, and no number.
        let is_large = self.leaves_surface && is_corners;
        let parts = ErrorSource::ALL.into_iter().zip(self.parts_percent(pair));
        let parts = parts.zip(self.known);
        parts
            .filter(move |((_, part), is_known)| part.is_none() && !(is_large && *is_known))
            .map(|((source, _), _)| source)
    }

    /// What is not counted of the scales that go to Split-Desktop, in words.
    pub fn not_counted_in_words(&self, pair: ScalePair) -> Vec<&'static str> {
        let half = self.half_a_pose.map(|half| match half {
            HalfAPose::Position => "the angles of poses",
            HalfAPose::Angle => "the positions of poses",
        });
        let of_sources = self.not_counted(pair).map(ErrorSource::as_str);
        half.into_iter().chain(of_sources).collect()
    }
}

/// What is stated of a pose where it is not all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HalfAPose {
    /// How sure its position is.
    Position,
    /// How sure its angles are.
    Angle,
}

impl HalfAPose {
    fn of(stated: PoseErrors) -> Option<Self> {
        match (stated.position, stated.angle) {
            (Some(_), None) => Some(Self::Position),
            (None, Some(_)) => Some(Self::Angle),
            (Some(_), Some(_)) | (None, None) => None,
        }
    }

    /// The other half, as its key is called in flight.toml.
    pub fn lacks(self) -> &'static str {
        match self {
            Self::Position => "angle",
            Self::Angle => "position",
        }
    }
}

/// How steep a photo's plane stands, degrees from level.
fn steepness(field: &ScaleField, plane: glam::DVec3) -> f64 {
    let normal = (field.pose().rotation * plane).normalize_or_zero();
    normal.z.abs().min(1.0).acos().to_degrees()
}

#[cfg(test)]
mod tests;
