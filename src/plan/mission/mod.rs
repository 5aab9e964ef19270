//! A mission: where to fly, where to look, when to shoot. It is what the files of all ground stations say,
//! each in its own way; `formats::missions` reads them, `exports::missions` writes them.
//!
//! ```text
//! beyond     what of its flight lies beyond the surface
//! by_itself  what the drone does behind the last stop, and where the radio is lost
//! near       how far from places on the Earth it is
//! told       the ways of a plan as missions, in degrees and metres above take-off
//! flown      planned against flown
//! paired     which photo is which planned one
//! ```

mod beyond;
mod by_itself;
mod flown;
mod near;
mod paired;
mod told;

pub use beyond::Beyond;
pub use by_itself::{Finish, LostSignal};
pub use flown::{Flown, Residual, planned_poses};
pub use paired::{PlannedPose, Taken};
#[cfg(test)]
pub(super) use told::true_heading;
pub use told::{Told, is_over_ground, missions};

use crate::fault::Fault;
use crate::geodesy::geoid_height;

/// What a drone is told: where to go, where to look, when to shoot.
///
/// The drone climbs to [`safe_height`](Self::safe_height), flies from stop to stop on straight lines,
/// and stops at each: it turns, moves the gimbal, waits, and shoots if the stop has a photo.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mission {
    /// For people; names files, too.
    pub name: String,
    /// DJI's numbers of the drone and its camera, where they are known: DJI's files need them.
    pub drone: Option<DroneCodes>,
    /// Where the drone takes off, where it is known.
    pub take_off: Option<TakeOff>,
    /// Metres per second between stops; `None` where it is left to the ground station.
    pub speed: Option<f64>,
    /// Metres above the place of take-off that the drone climbs to before it flies to the first stop;
    /// `None` where it is left to the ground station.
    pub safe_height: Option<f64>,
    /// Metres above the place of take-off from which the drone comes straight home from anywhere on its way over all that stands there;
    /// `None` where nobody says it.
    pub return_height: Option<f64>,
    /// What happens behind the last stop.
    pub finish: Finish,
    /// What the drone does where the radio is lost; `None` where it is left to its settings.
    pub lost_signal: Option<LostSignal>,
    /// In the order in which they are flown.
    pub stops: Vec<Stop>,
    /// Polygons that the drone stays in or out of.
    pub fences: Vec<Fence>,
}

/// The numbers by which DJI's files name a drone and its camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DroneCodes {
    /// `droneEnumValue`.
    pub drone: u32,
    /// `droneSubEnumValue`.
    pub drone_sub: u32,
    /// The camera; DJI's consumer drones do without.
    pub payload: Option<PayloadCodes>,
}

/// The numbers by which DJI's files name a camera and where it hangs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PayloadCodes {
    /// `payloadEnumValue`.
    pub payload: u32,
    /// `payloadSubEnumValue`.
    pub payload_sub: u32,
    /// `payloadPositionIndex`: 0 the main gimbal (of an M300 or M350 front left), 1 front right, 2 on top.
    pub position: u32,
}

/// Where a drone takes off: "home" in MAVLink's words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TakeOff {
    /// Degrees north, WGS 84.
    pub latitude: f64,
    /// Degrees east, WGS 84.
    pub longitude: f64,
    /// Its elevation, where it is known: never above take-off or ground.
    pub elevation: Option<Height>,
}

/// A place where the drone stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    /// Degrees north, WGS 84.
    pub latitude: f64,
    /// Degrees east, WGS 84.
    pub longitude: f64,
    /// How high.
    pub height: Height,
    /// Where the camera looks, in degrees clockwise from true north, 0 to 360 without the latter; of one that
    /// looks straight down, where the top of its image is. `None` where it is left to the ground station.
    pub heading: Option<f64>,
    /// Degrees: 0 is level, -90 straight down, above 0 up; `None` where the gimbal stays as it is.
    pub gimbal_pitch: Option<f64>,
    /// Seconds that the drone waits when the gimbal has arrived, before it shoots or flies on.
    pub settle: f64,
    /// What is shot here.
    pub photo: Option<PhotoOf>,
}

/// A photo that is shot at a stop.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PhotoOf {
    /// The planned photo's name, where it has one: DJI adds it to the file's.
    pub name: Option<String>,
}

/// A height, and what it counts from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Height {
    /// Metres, up.
    pub metres: f64,
    /// From where.
    pub above: Above,
}

/// What a height counts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Above {
    /// The place of take-off: never the first stop.
    TakeOff,
    /// The ground below, as the drone or its ground station knows it.
    Ground,
    /// The ellipsoid of WGS 84.
    Ellipsoid,
    /// The geoid EGM96, which is what drones call mean sea level.
    Geoid,
    /// An absolute height whose datum nobody said; nothing is written with such heights, for the geoid
    /// lies up to 107 m off the ellipsoid.
    Unknown,
}

/// A polygon that the drone stays in or out of.
#[derive(Debug, Clone, PartialEq)]
pub struct Fence {
    /// Whether it stays inside; else outside.
    pub keep_in: bool,
    /// Latitude and longitude in degrees, WGS 84; at least three, the last not the first again.
    pub corners: Vec<[f64; 2]>,
}

/// An angle as a heading: 0 to 360 degrees without the latter.
pub fn heading(degrees: f64) -> f64 {
    let turned = degrees.rem_euclid(360.0);
    // A negative angle that is almost nothing is turned to 360 itself.
    if turned < 360.0 { turned } else { 0.0 }
}

impl Height {
    /// Metres above the place of take-off.
    pub fn above_take_off(metres: f64) -> Self {
        Self {
            metres,
            above: Above::TakeOff,
        }
    }

    /// Metres above the ellipsoid at a place, of a height in a datum.
    fn above_ellipsoid(self, latitude: f64, longitude: f64) -> Option<f64> {
        match self.above {
            Above::Ellipsoid => Some(self.metres),
            Above::Geoid => Some(self.metres + geoid_height(latitude, longitude)),
            Above::TakeOff | Above::Ground | Above::Unknown => None,
        }
    }
}

impl Above {
    /// In words that follow "metres above".
    pub fn in_words(self) -> &'static str {
        match self {
            Self::TakeOff => "the place of take-off",
            Self::Ground => "the ground",
            Self::Ellipsoid => "the ellipsoid WGS 84",
            Self::Geoid => "the geoid EGM96",
            Self::Unknown => "a datum that is not said",
        }
    }
}

/// A gimbal's pitch beyond these is a mistake of units or signs: DJI's widest goes from -120 to 45.
const GIMBAL_PITCHES: (f64, f64) = (-150.0, 100.0);

/// Nobody flies higher or lower above anything, in metres.
const HIGHEST: f64 = 20_000.0;

/// Nobody waits longer at a stop, in seconds.
const LONGEST_WAIT: f64 = 86_400.0;

/// Nobody flies faster, in metres per second.
const FASTEST: f64 = 300.0;

impl Mission {
    /// Whether a drone could be told this: places on the Earth, finite heights and angles, a speed above
    /// zero. One without stops is none to be flown, but may have been read.
    ///
    /// # Errors
    /// What is not so, with the number of the stop counted from 1.
    pub fn check(&self) -> Result<(), Fault> {
        let remedy = "correct it, or plan the mission again";
        if let Some(take_off) = &self.take_off {
            check_place(take_off.latitude, take_off.longitude)
                .and_then(|()| take_off.elevation.map_or(Ok(()), check_height))
                .map_err(|what| Fault::new(format!("take-off: {what}"), remedy))?;
            if let Some(elevation) = take_off.elevation
                && matches!(elevation.above, Above::TakeOff | Above::Ground)
            {
                let above = elevation.above.in_words();
                let what = format!("the elevation of the take-off counts from {above}");
                let remedy = "give it above the ellipsoid or the geoid, or none";
                return Err(Fault::new(what, remedy));
            }
        }
        if let Some(speed) = self.speed
            && !(speed > 0.0 && speed <= FASTEST)
        {
            let what = format!("the speed is {speed} m/s, not between 0 and {FASTEST}");
            return Err(Fault::new(what, remedy));
        }
        for (name, height) in [
            ("safe height", self.safe_height),
            ("height to return home at", self.return_height),
        ] {
            if let Some(height) = height {
                check_height(Height::above_take_off(height))
                    .map_err(|what| Fault::new(format!("{name}: {what}"), remedy))?;
            }
        }
        for (stop, number) in self.stops.iter().zip(1..) {
            stop.check()
                .map_err(|what| Fault::new(format!("stop {number}: {what}"), remedy))?;
        }
        for (fence, number) in self.fences.iter().zip(1..) {
            let few = (fence.corners.len() < 3).then(|| "fewer than three corners".to_owned());
            let off = fence
                .corners
                .iter()
                .find_map(|&[latitude, longitude]| check_place(latitude, longitude).err());
            if let Some(what) = few.or(off) {
                return Err(Fault::new(format!("fence {number}: {what}"), remedy));
            }
        }
        Ok(())
    }
}

impl Mission {
    /// A height at a place (degrees, WGS 84) counted from the place of take-off, the ellipsoid or the geoid;
    /// `None` where it needs what is not known: the take-off's elevation in a datum, the ground, the datum
    /// itself.
    pub fn height_above(
        &self,
        latitude: f64,
        longitude: f64,
        height: Height,
        above: Above,
    ) -> Option<f64> {
        if height.above == above {
            return Some(height.metres);
        }
        let absolute = height.above_ellipsoid(latitude, longitude);
        let absolute = match height.above {
            Above::TakeOff => height.metres + self.take_off_above_ellipsoid()?,
            _ => absolute?,
        };
        match above {
            Above::Ellipsoid => Some(absolute),
            Above::Geoid => Some(absolute - geoid_height(latitude, longitude)),
            Above::TakeOff => Some(absolute - self.take_off_above_ellipsoid()?),
            Above::Ground | Above::Unknown => None,
        }
    }

    fn take_off_above_ellipsoid(&self) -> Option<f64> {
        let take_off = self.take_off?;
        let elevation = take_off.elevation?;
        elevation.above_ellipsoid(take_off.latitude, take_off.longitude)
    }

    /// Where the gimbal points at each stop, in degrees as [`Stop::gimbal_pitch`]: that of the last stop
    /// that says it.
    pub fn gimbal_pitches(&self) -> Vec<Option<f64>> {
        let stops = self.stops.iter();
        stops
            .scan(None, |last, stop| {
                *last = stop.gimbal_pitch.or(*last);
                Some(*last)
            })
            .collect()
    }
}

impl Stop {
    /// What of it no drone could be told, in words.
    fn check(&self) -> Result<(), String> {
        check_place(self.latitude, self.longitude)?;
        check_height(self.height)?;
        if let Some(heading) = self.heading
            && !(0.0..360.0).contains(&heading)
        {
            return Err(format!("the heading is {heading}, not from 0 to 360"));
        }
        let (lowest, highest) = GIMBAL_PITCHES;
        if let Some(pitch) = self.gimbal_pitch
            && !(lowest..=highest).contains(&pitch)
        {
            return Err(format!(
                "the gimbal's pitch is {pitch}, not from {lowest} to {highest}"
            ));
        }
        if !(0.0..=LONGEST_WAIT).contains(&self.settle) {
            return Err(format!(
                "the drone waits {} s, not from 0 to {LONGEST_WAIT}",
                self.settle
            ));
        }
        Ok(())
    }
}

fn check_place(latitude: f64, longitude: f64) -> Result<(), String> {
    if !(-90.0..=90.0).contains(&latitude) {
        return Err(format!("the latitude is {latitude}, not from -90 to 90"));
    }
    if !(-180.0..=180.0).contains(&longitude) {
        return Err(format!(
            "the longitude is {longitude}, not from -180 to 180"
        ));
    }
    Ok(())
}

fn check_height(height: Height) -> Result<(), String> {
    if (-HIGHEST..=HIGHEST).contains(&height.metres) {
        return Ok(());
    }
    let (metres, above) = (height.metres, height.above.in_words());
    Err(format!(
        "{metres} m above {above}, not from -{HIGHEST} to {HIGHEST}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mission() -> Mission {
        let stop = Stop {
            latitude: 50.0,
            longitude: 7.0,
            height: Height::above_take_off(-12.0),
            heading: Some(359.9),
            gimbal_pitch: Some(-90.0),
            settle: 2.0,
            photo: Some(PhotoOf::default()),
        };
        Mission {
            speed: Some(3.0),
            stops: vec![stop.clone(), stop],
            ..Mission::default()
        }
    }

    #[test]
    fn what_no_drone_can_do_is_refused_with_its_stop() {
        assert_eq!(mission().check(), Ok(()));
        let changes: [fn(&mut Stop); 7] = [
            |stop| stop.latitude = 90.1,
            |stop| stop.longitude = f64::NAN,
            |stop| stop.height.metres = f64::INFINITY,
            |stop| stop.heading = Some(360.0),
            |stop| stop.gimbal_pitch = Some(-200.0),
            |stop| stop.settle = -1.0,
            |stop| stop.settle = f64::NAN,
        ];
        for change in changes {
            let mut bad = mission();
            change(&mut bad.stops[1]);
            let fault = bad.check().unwrap_err();
            assert!(fault.what.starts_with("stop 2: "), "{fault}");
        }
        for speed in [0.0, -1.0, f64::NAN, 1e6] {
            let mut bad = mission();
            bad.speed = Some(speed);
            assert!(bad.check().is_err(), "{speed}");
        }
    }

    #[test]
    fn the_take_off_is_not_above_itself() {
        let mut with = mission();
        for (above, is_good) in [
            (Above::TakeOff, false),
            (Above::Ground, false),
            (Above::Geoid, true),
            (Above::Unknown, true),
        ] {
            with.take_off = Some(TakeOff {
                latitude: 50.0,
                longitude: 7.0,
                elevation: Some(Height {
                    metres: 160.0,
                    above,
                }),
            });
            assert_eq!(with.check().is_ok(), is_good, "{above:?}");
        }
    }

    /// At 38.628155 N 90.220845 W the geoid lies 31.628 m below the ellipsoid (NGA's test of EGM96).
    #[test]
    fn heights_are_counted_from_elsewhere() {
        let (latitude, longitude) = (38.628_155, -90.220_845);
        let mut mission = mission();
        let height = |metres, above| Height { metres, above };
        let of = |mission: &Mission, height, above| {
            mission.height_above(latitude, longitude, height, above)
        };
        let near = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 2e-3;
        let on_geoid = height(100.0, Above::Geoid);
        assert!(near(of(&mission, on_geoid, Above::Ellipsoid), 68.372));
        let on_ellipsoid = height(68.372, Above::Ellipsoid);
        assert!(near(of(&mission, on_ellipsoid, Above::Geoid), 100.0));
        let relative = Height::above_take_off(-12.0);
        assert_eq!(of(&mission, relative, Above::TakeOff), Some(-12.0));
        assert_eq!(of(&mission, relative, Above::Geoid), None);
        mission.take_off = Some(TakeOff {
            latitude,
            longitude,
            elevation: Some(height(90.0, Above::Geoid)),
        });
        assert!(near(of(&mission, relative, Above::Geoid), 78.0));
        assert!(near(of(&mission, on_ellipsoid, Above::TakeOff), 10.0));
        for above in [Above::Ground, Above::Unknown] {
            assert_eq!(of(&mission, height(1.0, above), Above::Geoid), None);
            assert_eq!(of(&mission, on_geoid, above), None);
        }
    }

    #[test]
    fn a_gimbal_stays_where_it_was() {
        let mut mission = mission();
        mission.stops[0].gimbal_pitch = None;
        mission.stops.push(mission.stops[0].clone());
        let expected = [None, Some(-90.0), Some(-90.0)];
        assert_eq!(mission.gimbal_pitches(), expected);
    }
}
