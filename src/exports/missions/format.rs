//! The formats of missions, and how many stops each takes.

use std::path::Path;

use fragscale_core::plan::Drone;

use crate::fault::Fault;

/// For whom a mission is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MissionFormat {
    /// DJI's Pilot 2 and FlightHub 2: WPML in a .kmz.
    DjiWpml,
    /// QGroundControl's .plan, for ArduPilot.
    QGroundControl,
    /// Mission Planner's .waypoints, for ArduPilot.
    Waypoints,
    /// Litchi's CSV.
    Litchi,
    /// KML 2.2, to look at.
    Kml,
    /// GeoJSON, to look at and to be read again.
    GeoJson,
}

/// DJI's indices of waypoints are [0, 65535] (Cloud API, "waylines.wpml", `wpml:index`).
const MOST_DJI_STOPS: usize = 65_536;

/// A Pixhawk keeps "700 waypoints", that is commands, and one more is not there when it flies (ArduPilot
/// issue 2391; 750 are refused, issue 7254).
const MOST_COMMANDS: usize = 700;

/// DJI's SDK below Litchi takes 2 to 99 waypoints (Litchi's forum, "DJI SDK Limits"); newer Litchis chain
/// several such missions, for which the drone must be in reach.
const MOST_LITCHI_STOPS: usize = 99;

/// What is wrong with a mission for DJI that names no drone.
pub(super) fn no_drone() -> Fault {
    let what = "DJI's files need the drone, and the mission does not say it";
    Fault::new(
        what,
        "choose it (--drone NAME; in the window, under Camera)",
    )
}

impl MissionFormat {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::DjiWpml,
        Self::QGroundControl,
        Self::Waypoints,
        Self::Litchi,
        Self::Kml,
        Self::GeoJson,
    ];

    /// That of a file's name.
    ///
    /// # Errors
    /// Where its ending is none of theirs.
    pub fn of(path: &Path) -> Result<Self, Fault> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let ending = ending.to_ascii_lowercase();
        let mut all = Self::ALL.into_iter();
        all.find(|format| format.ending() == ending).ok_or_else(|| {
            let remedy = "let its name end in .kmz (DJI), .plan (QGroundControl), .waypoints (Mission Planner), .csv (Litchi), .kml or .geojson";
            Fault::new("its name does not say what ground station it is for", remedy)
        })
    }

    /// Whether its files can name the drone that is to fly: DJI's have to, by DJI's own numbers.
    ///
    /// # Errors
    /// Where they have to, and it is not said or has no number.
    pub fn check_drone(self, drone: Option<&Drone>) -> Result<(), Fault> {
        match (self, drone) {
            (Self::DjiWpml, None) => Err(no_drone()),
            (Self::DjiWpml, Some(drone)) if drone.codes.is_none() => {
                let what = format!(
                    "DJI's files of missions have no number for the {}",
                    drone.title
                );
                let remedy = "write a file of another ground station for it, such as Litchi's .csv";
                Err(Fault::new(what, remedy))
            }
            _ => Ok(()),
        }
    }

    /// How the names of its files end, without the point.
    pub fn ending(self) -> &'static str {
        match self {
            Self::DjiWpml => "kmz",
            Self::QGroundControl => "plan",
            Self::Waypoints => "waypoints",
            Self::Litchi => "csv",
            Self::Kml => "kml",
            Self::GeoJson => "geojson",
        }
    }

    /// Who takes it.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::DjiWpml => "DJI's app",
            Self::QGroundControl | Self::Waypoints => "ArduPilot",
            Self::Litchi => "Litchi",
            Self::Kml => "KML",
            Self::GeoJson => "GeoJSON",
        }
    }

    /// What its files are called.
    pub(super) fn file_in_words(self) -> &'static str {
        match self {
            Self::DjiWpml => "a .kmz",
            Self::QGroundControl => "a .plan",
            Self::Waypoints => "a .waypoints",
            Self::Litchi => "Litchi's CSV",
            Self::Kml => "KML",
            Self::GeoJson => "GeoJSON",
        }
    }

    /// How many units of [`parts`](super::parts::parts) a file takes: stops, or of MAVLink's commands.
    pub(super) fn most(self) -> usize {
        match self {
            Self::DjiWpml => MOST_DJI_STOPS,
            Self::QGroundControl | Self::Waypoints => MOST_COMMANDS,
            Self::Litchi => MOST_LITCHI_STOPS,
            Self::Kml | Self::GeoJson => usize::MAX,
        }
    }

    /// The same, for people.
    pub(super) fn limit_in_words(self) -> String {
        let unit = match self {
            Self::QGroundControl | Self::Waypoints => "commands",
            _ => "stops",
        };
        format!("{} {unit} at once", self.most())
    }

    /// Whether its files say what the drone does where the radio is lost; KML is to look at alone.
    pub(super) fn says_lost_signal(self) -> bool {
        matches!(self, Self::DjiWpml | Self::GeoJson | Self::Kml)
    }

    pub(super) fn has_fences(self) -> bool {
        matches!(self, Self::QGroundControl | Self::Kml | Self::GeoJson)
    }
}
