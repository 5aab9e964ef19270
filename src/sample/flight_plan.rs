//! The flight over the pile: planned poses, and where the UAV really was.

use glam::{DVec2, DVec3};

use super::random::Random;
use crate::camera::Pose;

/// A flight of photos in rows, and optionally a ring of overlapping ones around the pile.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightPlan {
    /// Height of the camera above the floor, metres.
    pub height: f64,
    /// Camera axis below the horizon, degrees (paper, III-B: 83).
    pub tilt: f64,
    /// Distance of neighbouring photos, metres, across and along the rows.
    pub spacing: DVec2,
    /// Photos in a row, rows.
    pub count: [u32; 2],
    /// Standard deviation of the UAV's position about its plan, metres, each axis.
    pub position_error: f64,
    /// Standard deviation of tilt and pan about the plan, degrees.
    pub angle_error: f64,
}

/// A photo's planned and actual pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// The file's name.
    pub name: String,
    /// As planned: centre, tilt and pan (metres, degrees).
    pub planned: (DVec3, [f64; 2]),
    /// As flown.
    pub actual: (DVec3, [f64; 2]),
}

impl Shot {
    /// The pose that the photo was taken from.
    pub fn pose(&self) -> Pose {
        Pose::from_tilt_pan(self.actual.0, self.actual.1)
    }
}

impl FlightPlan {
    /// The photos in the order of the flight, a lawn-mower's: every second row backwards.
    pub fn fly(&self, random: &mut Random) -> Vec<Shot> {
        let [columns, rows] = self.count;
        let mut shots = Vec::new();
        for row in 0..rows {
            for step in 0..columns {
                let back = row % 2 == 1;
                let column = if back { columns - 1 - step } else { step };
                let at = |index: u32, count: u32| f64::from(index) - f64::from(count - 1) / 2.0;
                let place = DVec2::new(at(column, columns), at(row, rows)) * self.spacing;
                let pan = if back { 180.0 } else { 0.0 };
                shots.push(self.shot(
                    format!("IMG_{:04}.jpg", shots.len() + 1),
                    place.extend(self.height),
                    [self.tilt, pan],
                    random,
                ));
            }
        }
        shots
    }

    /// `count` photos on a ring around the pile, looking at its middle, for a reconstruction: each
    /// sees most of what its neighbours see.
    pub fn ring(&self, count: u32, random: &mut Random) -> Vec<Shot> {
        let radius = self.spacing.length() * 1.1;
        (0..count)
            .map(|index| {
                let pan = 360.0 * f64::from(index) / f64::from(count);
                // The camera stands opposite to where it looks.
                let (sin, cos) = pan.to_radians().sin_cos();
                let place = DVec2::new(-sin, -cos) * radius;
                let tilt = (self.height * 1.3).atan2(radius).to_degrees();
                self.shot(
                    format!("RING_{:04}.jpg", index + 1),
                    place.extend(self.height * 1.3),
                    [tilt, pan],
                    random,
                )
            })
            .collect()
    }

    /// Overlapping photos for a reconstruction as a mapping flight takes them: rows straight down, 65 % over
    /// the neighbouring row and 70 % along it, from half as high again as the flight, then a row on
    /// each side that looks aslant at the middle. `view` is the width and height of a photo in parts of the
    /// distance.
    pub fn survey(&self, view: DVec2, random: &mut Random) -> Vec<Shot> {
        let height = self.height * 1.5;
        let step = view * height * DVec2::new(0.35, 0.3);
        let [columns, rows] = self.count.map(|count| f64::from(count.saturating_sub(1)));
        // As far as the flight's photos show.
        let extent = DVec2::new(columns, rows) * self.spacing + view * self.height;
        let count = (extent / step).ceil().as_uvec2() + 1;
        let mut shots = Vec::new();
        let mut add = |place: DVec3, angles: [f64; 2]| {
            let name = format!("SUR_{:04}.jpg", shots.len() + 1);
            shots.push(self.shot(name, place, angles, random));
        };
        for row in 0..count.y {
            for along in 0..count.x {
                let column = if row % 2 == 1 {
                    count.x - 1 - along
                } else {
                    along
                };
                let at =
                    DVec2::new(f64::from(column), f64::from(row)) - (count.as_dvec2() - 1.0) / 2.0;
                add((at * step).extend(height), [90.0, 0.0]);
            }
        }
        let (aslant, photos) = (50.0_f64, 6);
        for pan in [0.0_f64, 90.0, 180.0, 270.0] {
            let (east, north) = pan.to_radians().sin_cos();
            let looks = DVec2::new(east, north);
            let across = (looks.perp().abs() * extent).element_sum();
            for along in 0..photos {
                let share = f64::from(along) / f64::from(photos - 1) - 0.5;
                let back = looks * (height / aslant.to_radians().tan());
                let place = looks.perp() * (share * across) - back;
                add(place.extend(height), [aslant, pan]);
            }
        }
        shots
    }

    fn shot(&self, name: String, center: DVec3, angles: [f64; 2], random: &mut Random) -> Shot {
        let drift = DVec3::new(random.normal(), random.normal(), random.normal());
        let [tilt, pan] = angles;
        // As a log file writes them: tenths of a millimetre in the lab, hundredths of a degree.
        let digits = |x: f64, digits: f64| (x * digits).round() / digits;
        let center_flown = (center + drift * self.position_error).to_array();
        let angles_flown = [
            tilt + random.normal() * self.angle_error,
            pan + random.normal() * self.angle_error,
        ];
        Shot {
            name,
            planned: (center, angles),
            actual: (
                DVec3::from_array(center_flown.map(|x| digits(x, 1e4))),
                angles_flown.map(|x| digits(x, 1e2)),
            ),
        }
    }
}
