//! How sure somebody is of what scales are computed from: standard deviations that an engineer states
//! (contract, section 8) or that her photogrammetry package wrote.
//!
//! What nobody states is not counted, and that is said; nothing here has a value by default.

use glam::DVec3;

use crate::numbers::{TO_95_PERCENT, interval_percent};

/// Standard deviations of one photo's pose; `None` where nobody states it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PoseErrors {
    /// Of the camera centre along the world's x, y, z; world units.
    pub position: Option<DVec3>,
    /// Of the rotation about the camera's x, y, z axes; degrees.
    pub angle: Option<DVec3>,
}

impl PoseErrors {
    /// Whether somebody states any.
    pub fn is_stated(self) -> bool {
        self != Self::default()
    }

    /// These, and where they say nothing, those.
    #[must_use]
    pub fn or(self, those: Self) -> Self {
        Self {
            position: self.position.or(those.position),
            angle: self.angle.or(those.angle),
        }
    }

    /// The variance that they leave in something, of what it gains by a radian about each of the camera's axes and by a
    /// world unit along each of the world's; `None` where nobody states any.
    pub(super) fn variance(self, by_radian: DVec3, by_position: DVec3) -> Option<f64> {
        let of_angle = self.angle.map(|degrees| {
            let radians = degrees.map(f64::to_radians);
            (by_radian * radians).length_squared()
        });
        let of_position = self
            .position
            .map(|far| (by_position * far).length_squared());
        match (of_angle, of_position) {
            (None, None) => None,
            (a, b) => Some(a.unwrap_or(0.0) + b.unwrap_or(0.0)),
        }
    }
}

/// Standard deviations of everything that a scale is computed from; `None` where nobody states it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StatedErrors {
    /// Of each photo's pose.
    pub pose: PoseErrors,
    /// Of fx and fy together, percent.
    pub focal: Option<f64>,
    /// Of a surface point along its ray, world units; what lies between points is estimated besides.
    pub surface: Option<f64>,
    /// Of all lengths, percent.
    pub world_scale: Option<f64>,
}

impl StatedErrors {
    /// These, and where they say nothing, those.
    #[must_use]
    pub fn or(self, those: Self) -> Self {
        Self {
            pose: self.pose.or(those.pose),
            focal: self.focal.or(those.focal),
            surface: self.surface.or(those.surface),
            world_scale: self.world_scale.or(those.world_scale),
        }
    }

    /// Half of the 95 % interval that the world's length alone leaves in every scale, such as "3 %"; `None` where
    /// nobody states an error of it.
    pub fn world_percent(&self) -> Option<String> {
        let half = self.world_scale? / 100.0 * TO_95_PERCENT;
        interval_percent(1.0, 1.0 - half, 1.0 + half)
    }

    /// What [`Self::world_percent`] means for several photos.
    pub fn world_in_words(&self) -> Option<String> {
        let percent = self.world_percent()?;
        Some(format!(
            "± {percent} of it is the length of the flight's unit: all photos are off by that together, and more of \
             them do not make it less"
        ))
    }

    /// The first value that is no standard deviation (negative, or not finite), with its key in
    /// flight.toml.
    pub fn trouble(&self) -> Option<(&'static str, f64)> {
        let axes = |key, axes: Option<DVec3>| {
            let of_axes = axes.into_iter().flat_map(|axes| axes.to_array());
            of_axes.map(move |value| (key, value))
        };
        axes("position", self.pose.position)
            .chain(axes("angle", self.pose.angle))
            .chain(self.focal.map(|value| ("focal", value)))
            .chain(self.surface.map(|value| ("surface", value)))
            .chain(self.world_scale.map(|value| ("world_scale", value)))
            .find(|(_, value)| !(0.0..=MOST).contains(value))
    }
}

/// No error is stated to be more, in whatever unit: such a number is none of an error.
const MOST: f64 = 1e12;

/// Which top and bottom scale go to Split-Desktop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ScalePair {
    /// Of the best line through the scale of all pixels (contract, section 7).
    #[default]
    Fitted,
    /// Of the four corners, as in the paper.
    Corners,
}

impl ScalePair {
    /// Its name in flight.toml and in lists.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Fitted => "fitted",
            Self::Corners => "corners",
        }
    }

    /// The one that stands beside it.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Fitted => Self::Corners,
            Self::Corners => Self::Fitted,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_stated_first_counts() {
        let table = StatedErrors {
            pose: PoseErrors {
                position: None,
                angle: Some(DVec3::splat(0.1)),
            },
            focal: Some(0.2),
            ..StatedErrors::default()
        };
        let package = StatedErrors {
            pose: PoseErrors {
                position: Some(DVec3::X),
                angle: Some(DVec3::Y),
            },
            focal: Some(9.0),
            world_scale: Some(0.0),
            ..StatedErrors::default()
        };
        let both = table.or(package);
        assert_eq!(both.pose.position, Some(DVec3::X));
        assert_eq!(both.pose.angle, Some(DVec3::splat(0.1)));
        assert_eq!((both.focal, both.surface), (Some(0.2), None));
        assert_eq!(both.world_scale, Some(0.0));
    }

    /// 1.959964 standard deviations, rounded as all percentages of intervals are.
    #[test]
    fn what_photos_share_is_told() {
        let of = |world_scale| StatedErrors {
            world_scale,
            ..StatedErrors::default()
        };
        let percent = |world_scale| of(world_scale).world_percent();
        assert_eq!(percent(Some(1.64)).as_deref(), Some("3 %"));
        assert_eq!(percent(Some(0.5)).as_deref(), Some("1.0 %"));
        assert_eq!(percent(Some(0.0)), None);
        assert_eq!(percent(None), None);
        let words = of(Some(1.64)).world_in_words().unwrap();
        assert!(words.starts_with("± 3 % of it is the length"), "{words}");
    }

    #[test]
    fn negative_ones_are_found() {
        let mut errors = StatedErrors {
            surface: Some(0.0),
            ..StatedErrors::default()
        };
        assert_eq!(errors.trouble(), None);
        errors.world_scale = Some(-0.1);
        assert_eq!(errors.trouble(), Some(("world_scale", -0.1)));
        errors.pose.angle = Some(DVec3::new(0.0, f64::INFINITY, 0.0));
        assert_eq!(errors.trouble(), Some(("angle", f64::INFINITY)));
    }
}
