//! Drones that are often flown over rock: camera, gimbal, and the numbers by which DJI's files name them.
//!
//! Cameras are nominal: a pinhole of the stated diagonal field of view, the middle of the sensor as its principal
//! point. DJI's own calibrations of such cameras differ from that by one or two percent of the focal length, and so
//! do the planned scales. Fields of view and sizes are from the makers' pages "Specs" of each drone, numbers and
//! pitches from DJI's Cloud API (waylines.wpml: `droneEnumValue`, `payloadEnumValue`, `gimbalPitchRotateAngle`).

use crate::camera::{Camera, Distortion};

use super::{DroneCodes, PayloadCodes};

/// A drone with its camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drone {
    /// On the command line.
    pub name: &'static str,
    /// As its maker writes it.
    pub title: &'static str,
    /// A photo's width and height, pixels.
    pub size: [u32; 2],
    /// From corner to corner, degrees.
    pub field_of_view: f64,
    /// The gimbal's lowest and highest pitch, degrees.
    pub gimbal: [f64; 2],
    /// DJI's numbers, where its files may name it.
    pub codes: Option<DroneCodes>,
}

const fn codes(drone: u32, payload: u32) -> Option<DroneCodes> {
    Some(DroneCodes {
        drone,
        drone_sub: 0,
        payload: Some(PayloadCodes {
            payload,
            payload_sub: 0,
            position: 0,
        }),
    })
}

impl Drone {
    /// All that are known.
    pub const ALL: [Self; 4] = [
        Self {
            name: "mavic-3e",
            title: "DJI Mavic 3 Enterprise, wide camera",
            size: [5280, 3956],
            field_of_view: 84.0,
            gimbal: [-90.0, 35.0],
            codes: codes(77, 66),
        },
        Self {
            name: "matrice-30",
            title: "DJI Matrice 30, wide camera",
            size: [4000, 3000],
            field_of_view: 84.0,
            gimbal: [-120.0, 45.0],
            codes: codes(67, 52),
        },
        Self {
            name: "matrice-3d",
            title: "DJI Matrice 3D, wide camera",
            size: [5280, 3956],
            field_of_view: 84.0,
            gimbal: [-90.0, 30.0],
            codes: codes(91, 80),
        },
        Self {
            name: "phantom-4-rtk",
            title: "DJI Phantom 4 RTK",
            size: [5472, 3648],
            field_of_view: 84.0,
            gimbal: [-90.0, 30.0],
            codes: None,
        },
    ];

    /// By its name on the command line.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|drone| drone.name == name)
    }

    /// Its camera, nominal.
    pub fn camera(&self) -> Camera {
        let [width, height] = self.size;
        let diagonal = f64::from(width).hypot(f64::from(height));
        let focal = diagonal / 2.0 / (self.field_of_view / 2.0).to_radians().tan();
        Camera {
            name: self.title.to_owned(),
            width,
            height,
            fx: focal,
            fy: focal,
            cx: f64::from(width) / 2.0,
            cy: f64::from(height) / 2.0,
            skew: 0.0,
            distortion: Distortion::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// DJI writes 3713.29 px for a Mavic 3 Enterprise (EXIF `DewarpData` of its photos), 24 mm of 43.27 mm for the
    /// equivalent of all four.
    #[test]
    fn nominal_focal_lengths_are_near_the_makers() {
        let focal = Drone::named("mavic-3e").unwrap().camera().fx;
        assert!((focal / 3713.29 - 1.0).abs() < 0.02, "{focal}");
        for drone in Drone::ALL {
            let camera = drone.camera();
            camera.validate().unwrap();
            let diagonal = f64::from(camera.width).hypot(f64::from(camera.height));
            let equivalent = camera.fx / diagonal * 43.27;
            assert!((equivalent - 24.0).abs() < 0.3, "{equivalent}");
        }
    }
}
