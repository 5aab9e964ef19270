//! How far a mission is from places on the Earth, as a sphere: enough to tell one pit from another.

use glam::{DVec2, DVec3};

use super::Mission;

/// Of the sphere, kilometres.
const RADIUS: f64 = 6371.0;

impl Mission {
    /// The farthest that the nearest stop may lie from its take-off, or from where a photo of it was taken, kilometres: nobody sees a
    /// drone there, which its pilot has to in most countries, and photos of one pile are taken within some hundred metres. Who says
    /// otherwise took one number, or one file, for another.
    pub const FARTHEST: f64 = 2.0;

    /// From a place, latitude and longitude in degrees, to the nearest stop, kilometres; `None` where there is no stop.
    pub fn to_nearest_stop(&self, place: DVec2) -> Option<f64> {
        let from = direction(place.x, place.y);
        let stops = self.stops.iter();
        let angles = stops.map(|stop| direction(stop.latitude, stop.longitude).angle_between(from));
        Some(RADIUS * angles.reduce(f64::min)?)
    }

    /// From a place to that of the take-off, likewise; `None` where the mission does not say it.
    pub fn to_take_off(&self, place: DVec2) -> Option<f64> {
        let take_off = self.take_off?;
        let from = direction(place.x, place.y);
        Some(RADIUS * direction(take_off.latitude, take_off.longitude).angle_between(from))
    }
}

/// From the middle of the sphere to a place, degrees; its length is one.
fn direction(latitude: f64, longitude: f64) -> DVec3 {
    let [(sin, cos), (east, north)] =
        [latitude, longitude].map(|angle| angle.to_radians().sin_cos());
    DVec3::new(cos * north, cos * east, sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Height, Stop, TakeOff};

    /// A degree of a great circle is 111.1949 km on a sphere with a radius of 6371 km.
    #[test]
    fn the_nearest_stop_counts() {
        let stop = |latitude| Stop {
            latitude,
            longitude: 7.0,
            height: Height::above_take_off(12.0),
            heading: None,
            gimbal_pitch: None,
            settle: 0.0,
            photo: None,
        };
        let mission = Mission {
            stops: vec![stop(50.0), stop(53.0)],
            take_off: Some(TakeOff {
                latitude: 51.0,
                longitude: 7.0,
                elevation: None,
            }),
            ..Mission::default()
        };
        let to = |latitude, longitude| {
            let place = DVec2::new(latitude, longitude);
            mission.to_nearest_stop(place).unwrap()
        };
        assert!((to(49.0, 7.0) - 111.1949).abs() < 1e-3);
        assert!((to(54.0, 7.0) - 111.1949).abs() < 1e-3);
        assert!(to(50.0, 7.0) < 1e-6);
        assert_eq!(Mission::default().to_nearest_stop(DVec2::ZERO), None);
        let to_take_off = mission.to_take_off(DVec2::new(50.0, 7.0)).unwrap();
        assert!((to_take_off - 111.1949).abs() < 1e-3);
        assert_eq!(Mission::default().to_take_off(DVec2::ZERO), None);
    }
}
