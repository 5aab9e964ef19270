//! Places, turns, gimbal, waits and shots, one after the other, become stops. All ground stations tell a
//! drone such a list; only the words differ.

use fragscale_core::plan::{Height, PhotoOf, Stop};

use super::heading;

/// The list so far.
#[derive(Debug, Default)]
pub(super) struct Route {
    stops: Vec<Stop>,
    /// What has been said at this place since its photo: for another photo here.
    after: Option<After>,
    /// A pitch that was said behind the last photo of a place, or before the first place.
    carried_pitch: Option<f64>,
}

#[derive(Debug, Clone, Copy, Default)]
struct After {
    heading: Option<f64>,
    pitch: Option<f64>,
    settle: f64,
}

impl Route {
    /// The drone flies to a place (degrees, WGS 84).
    pub(super) fn arrive(&mut self, latitude: f64, longitude: f64, height: Height) {
        let pitch = self.after.take().and_then(|after| after.pitch);
        self.carried_pitch = pitch.or(self.carried_pitch);
        self.stops.push(Stop {
            latitude,
            longitude,
            height,
            heading: None,
            gimbal_pitch: self.carried_pitch.take(),
            settle: 0.0,
            photo: None,
        });
    }

    /// The camera looks there from now on, in degrees clockwise from north.
    pub(super) fn turn(&mut self, degrees: f64) {
        let degrees = Some(heading(degrees));
        match (&mut self.after, self.stops.last_mut()) {
            (Some(after), _) => {
                after.heading = degrees;
                after.settle = 0.0;
            }
            (None, Some(stop)) => {
                stop.heading = degrees;
                stop.settle = 0.0;
            }
            (None, None) => {}
        }
    }

    /// The gimbal goes to this pitch, in degrees, -90 straight down.
    pub(super) fn pitch(&mut self, degrees: f64) {
        match (&mut self.after, self.stops.last_mut()) {
            (Some(after), _) => {
                after.pitch = Some(degrees);
                after.settle = 0.0;
            }
            (None, Some(stop)) => {
                stop.gimbal_pitch = Some(degrees);
                stop.settle = 0.0;
            }
            (None, None) => self.carried_pitch = Some(degrees),
        }
    }

    /// The drone waits, in seconds. Only what it waits behind its last turn and the gimbal's counts.
    pub(super) fn wait(&mut self, seconds: f64) {
        match (&mut self.after, self.stops.last_mut()) {
            (Some(after), _) => after.settle += seconds,
            (None, Some(stop)) => stop.settle += seconds,
            (None, None) => {}
        }
    }

    /// A photo here; false where the drone is not anywhere yet.
    pub(super) fn shoot(&mut self, name: Option<String>) -> bool {
        let Some(stop) = self.stops.last_mut() else {
            return false;
        };
        let photo = Some(PhotoOf { name });
        match self.after.replace(After::default()) {
            None => stop.photo = photo,
            Some(after) => {
                let again = Stop {
                    heading: after.heading.or(stop.heading),
                    gimbal_pitch: after.pitch,
                    settle: after.settle,
                    photo,
                    ..stop.clone()
                };
                self.stops.push(again);
            }
        }
        true
    }

    /// The heading that was said last at this place.
    pub(super) fn heading(&self) -> Option<f64> {
        let after = self.after.and_then(|after| after.heading);
        after.or_else(|| self.stops.last().and_then(|stop| stop.heading))
    }

    /// Whether the drone is at a place.
    pub(super) fn has_place(&self) -> bool {
        !self.stops.is_empty()
    }

    /// The stops.
    pub(super) fn stops(self) -> Vec<Stop> {
        self.stops
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_photos_at_a_place_are_two_stops() {
        let mut route = Route::default();
        assert!(!route.shoot(None));
        route.pitch(-30.0);
        route.arrive(50.0, 7.0, Height::above_take_off(12.0));
        route.wait(5.0);
        route.turn(-90.0);
        route.wait(2.0);
        route.wait(1.0);
        assert!(route.shoot(Some("a".to_owned())));
        route.pitch(-60.0);
        route.shoot(None);
        route.pitch(-90.0);
        route.arrive(50.1, 7.0, Height::above_take_off(13.0));
        let stops = route.stops();
        let told: Vec<_> = stops
            .iter()
            .map(|stop| {
                let height = stop.height.metres;
                (height, stop.heading, stop.gimbal_pitch, stop.settle)
            })
            .collect();
        let expected = [
            (12.0, Some(270.0), Some(-30.0), 3.0),
            (12.0, Some(270.0), Some(-60.0), 0.0),
            (13.0, None, Some(-90.0), 0.0),
        ];
        assert_eq!(told, expected);
        assert!(stops[1].photo.is_some() && stops[2].photo.is_none());
    }
}
