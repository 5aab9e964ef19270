//! Poses over time, and the pose at a time in between.
//!
//! The position is interpolated linearly, the rotation along the shortest turn at constant speed
//! (slerp). Nothing is ever extrapolated, and no gap of more than [`LONGEST_GAP`] is bridged: in half
//! a second a UAV turns by more than a photo's scale forgives. A stamp within [`ROUNDING`] of a
//! sample gets the sample as it is, also at the ends: files round their stamps.

use std::fmt;

use glam::{DMat3, DQuat};

use super::stamp::Stamp;
use crate::camera::Pose;

/// The longest time between two samples that a pose is interpolated over, in nanoseconds.
pub(crate) const LONGEST_GAP: u64 = 500_000_000;

/// How far rounding may move a stamp, in nanoseconds: TUM's files have four decimals.
pub(crate) const ROUNDING: u64 = 100_000;

/// Samples of a moving frame, in order of time.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Track {
    samples: Vec<(Stamp, Pose)>,
}

/// Why there is no pose at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum NoPose {
    /// There is no sample at all.
    Empty,
    /// The first sample is later.
    Before(Stamp),
    /// The last sample is earlier.
    After(Stamp),
    /// The samples around it are this many nanoseconds apart.
    Gap(u64),
}

impl fmt::Display for NoPose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "there are no poses"),
            Self::Before(first) => write!(f, "it is older than the first pose ({first} s)"),
            Self::After(last) => write!(f, "it is younger than the last pose ({last} s)"),
            Self::Gap(gap) => write!(
                f,
                "the poses around it are {} s apart (over {} s nothing is interpolated)",
                *gap as f64 / 1e9,
                LONGEST_GAP as f64 / 1e9
            ),
        }
    }
}

impl Track {
    /// Sorts the samples; of those with one stamp the first stays.
    pub(crate) fn new(mut samples: Vec<(Stamp, Pose)>) -> Self {
        samples.sort_by_key(|(stamp, _)| *stamp);
        samples.dedup_by_key(|(stamp, _)| *stamp);
        Self { samples }
    }

    /// The times of the first and of the last sample.
    pub(crate) fn span(&self) -> Option<(Stamp, Stamp)> {
        Some((self.samples.first()?.0, self.samples.last()?.0))
    }

    /// How many samples can count between two times: from half a second, over which they are
    /// interpolated, before the first to as long after the last. All of them without times.
    pub(crate) fn samples_around(&self, span: Option<(Stamp, Stamp)>) -> usize {
        let Some((first, last)) = span else {
            return self.samples.len();
        };
        let counts = |stamp: Stamp| {
            let reach = |end: Stamp| stamp.apart(end) <= LONGEST_GAP;
            (first <= stamp && stamp <= last) || reach(first) || reach(last)
        };
        self.samples.iter().filter(|(s, _)| counts(*s)).count()
    }

    /// The pose at a time.
    ///
    /// # Errors
    /// Outside the samples, and in a gap that is too long.
    pub(crate) fn at(&self, stamp: Stamp) -> Result<Pose, NoPose> {
        let next = self.samples.partition_point(|(other, _)| *other < stamp);
        let before = next.checked_sub(1).and_then(|i| self.samples.get(i));
        let after = self.samples.get(next);
        let nearest = [before, after]
            .into_iter()
            .flatten()
            .min_by_key(|(other, _)| other.apart(stamp))
            .ok_or(NoPose::Empty)?;
        if nearest.0.apart(stamp) <= ROUNDING {
            return Ok(nearest.1);
        }
        match (before, after) {
            (Some((from, a)), Some((to, b))) => {
                let gap = from.apart(*to);
                if gap > LONGEST_GAP {
                    return Err(NoPose::Gap(gap));
                }
                // Both are at most half a second in nanoseconds: exact.
                let share = from.apart(stamp) as f64 / gap as f64;
                Ok(between(a, b, share))
            }
            (None, _) => Err(NoPose::Before(nearest.0)),
            (_, None) => Err(NoPose::After(nearest.0)),
        }
    }
}

/// The pose a share (0 to 1) of the way from `a` to `b`.
fn between(a: &Pose, b: &Pose, share: f64) -> Pose {
    let mut turn = DQuat::from_mat3(&(a.rotation.transpose() * b.rotation)).normalize();
    if turn.w < 0.0 {
        turn = -turn;
    }
    let part = DQuat::from_scaled_axis(turn.to_scaled_axis() * share);
    Pose {
        rotation: a.rotation * DMat3::from_quat(part),
        center: a.center + (b.center - a.center) * share,
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn pose(degrees: f64, x: f64) -> Pose {
        Pose {
            rotation: DMat3::from_rotation_z(degrees.to_radians()),
            center: DVec3::new(x, 5_429_380.172_093_272, 0.0),
        }
    }

    fn track() -> Track {
        // Given out of order, and the stamp 0 twice.
        let at = |ms: i64| Stamp(ms * 1_000_000);
        Track::new(vec![
            (at(1400), pose(-170.0, 8.0)),
            (at(0), pose(0.0, 0.0)),
            (at(400), pose(80.0, 4.0)),
            (at(0), pose(50.0, 9.0)),
            (at(1000), pose(170.0, 6.0)),
        ])
    }

    #[test]
    fn turns_at_constant_speed_the_shorter_way() {
        let track = track();
        for (ms, degrees, x) in [
            (0, 0.0, 0.0),
            (100, 20.0, 1.0),
            (300, 60.0, 3.0),
            (1300, 185.0, 7.5),
        ] {
            let found = track.at(Stamp(ms * 1_000_000)).unwrap();
            let expected = pose(degrees, x);
            assert!(found.rotation.abs_diff_eq(expected.rotation, 1e-14), "{ms}");
            assert_eq!(found.center, expected.center, "{ms}");
        }
        // A sample is given back to the last bit.
        assert_eq!(track.at(Stamp(400_000_000)).unwrap(), pose(80.0, 4.0));
    }

    #[test]
    fn a_small_turn_is_interpolated_as_well() {
        let track = Track::new(vec![
            (Stamp(0), pose(0.0, 0.0)),
            (Stamp(400_000_000), pose(1e-3, 0.0)),
        ]);
        let found = track.at(Stamp(100_000_000)).unwrap();
        assert!(
            found
                .rotation
                .abs_diff_eq(pose(0.25e-3, 0.0).rotation, 1e-16)
        );
    }

    #[test]
    fn nothing_is_extrapolated_and_no_long_gap_bridged() {
        let track = track();
        assert_eq!(track.at(Stamp(700_000_000)), Err(NoPose::Gap(600_000_000)));
        assert_eq!(track.at(Stamp(-100_001)), Err(NoPose::Before(Stamp(0))));
        assert_eq!(
            track.at(Stamp(1_400_100_001)),
            Err(NoPose::After(Stamp(1_400_000_000)))
        );
        assert_eq!(Track::default().at(Stamp(0)), Err(NoPose::Empty));
        // Rounding of stamps is forgiven, at the ends as well.
        assert_eq!(track.at(Stamp(-100_000)), Ok(pose(0.0, 0.0)));
        assert_eq!(track.at(Stamp(1_400_100_000)), Ok(pose(-170.0, 8.0)));
        assert!(track.at(Stamp(i64::MIN)).is_err() && track.at(Stamp(i64::MAX)).is_err());
        let said = NoPose::Gap(600_000_000).to_string();
        assert!(said.contains("0.6 s apart (over 0.5 s"), "{said}");
    }

    #[test]
    fn frames_are_chained_from_the_outside() {
        let outer = Pose {
            rotation: DMat3::from_rotation_z(90_f64.to_radians()),
            center: DVec3::new(1.0, 2.0, 3.0),
        };
        let inner = Pose {
            rotation: DMat3::from_rotation_x(90_f64.to_radians()),
            center: DVec3::new(10.0, 0.0, 1.0),
        };
        let both = outer.carrying(&inner);
        // The inner frame's origin lies 10 along the outer's x, which is the parent's y.
        assert!((both.center - DVec3::new(1.0, 12.0, 4.0)).length() < 1e-12);
        // Its y is the outer's z, its x the parent's y.
        assert!((both.rotation * DVec3::Y - DVec3::Z).length() < 1e-12);
        assert!((both.rotation * DVec3::X - DVec3::Y).length() < 1e-12);
    }
}
