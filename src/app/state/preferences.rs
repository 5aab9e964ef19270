//! What the program remembers from one day to the next: the engineer's ways, never a flight's data.
//! eframe keeps it in the user's own configuration folder.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::flight::Limits;
use crate::photo_view::PhotoOverlays;
use crate::state::layers::Layers;
use crate::units::LengthUnit;

/// How many recent flights are kept.
const RECENT: usize = 10;

/// Settings of the person, not of the flight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// The flights opened last, the newest first; absolute paths.
    pub recent: Vec<PathBuf>,
    /// The symbol of the unit that scales are shown in.
    unit: String,
    /// When to doubt a photo.
    pub limits: Limits,
    /// What the viewport shows.
    pub layers: Layers,
    /// Light, dark, or as the system has it.
    pub theme: Theme,
    /// Whether the log is open.
    pub log_open: bool,
    /// Whether the panel at the left is shown: the table of photos, or what was added.
    pub left_open: bool,
    /// Whether the panel at the right is shown: photo and settings, or results.
    pub right_open: bool,
    /// Whether the strip of the flight's health is shown.
    pub health_open: bool,
    /// Whether the selected photo is tinted by its scale.
    pub tint: bool,
    /// Whether the corners are shown enlarged.
    pub loupe_open: bool,
    /// What lies over the photo in the photo view.
    pub photo_overlays: PhotoOverlays,
    /// Whether an export has the rectified photos, too.
    pub export_rectified: bool,
}

/// Light or dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Theme {
    /// As the system has it.
    #[default]
    System,
    /// Light.
    Light,
    /// Dark.
    Dark,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            // Split-Desktop's dialogs are in centimetres as often as not, as the command is.
            unit: LengthUnit::Centimetre.symbol().to_owned(),
            limits: Limits::default(),
            layers: Layers::default(),
            theme: Theme::System,
            log_open: false,
            left_open: true,
            right_open: true,
            health_open: true,
            tint: false,
            loupe_open: false,
            photo_overlays: PhotoOverlays::default(),
            export_rectified: false,
        }
    }
}

impl Preferences {
    /// The unit that scales are shown in.
    pub fn unit(&self) -> LengthUnit {
        // A symbol that an older or newer version wrote may be unknown here.
        self.unit.parse().unwrap_or(LengthUnit::Centimetre)
    }

    /// Chooses the unit that scales are shown in.
    pub fn set_unit(&mut self, unit: LengthUnit) {
        unit.symbol().clone_into(&mut self.unit);
    }

    /// Puts a flight in front of the recent ones.
    pub fn remember(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent
            .retain(|known| flight_of(known) != flight_of(&path));
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }
}

/// The folder of a flight.toml, which opens the same flight; else the path itself.
fn flight_of(path: &Path) -> &Path {
    let folder = path.parent().filter(|_| path.ends_with("flight.toml"));
    folder.unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recent_flights_come_newest_first_and_once() {
        let mut preferences = Preferences::default();
        for name in ["/a", "/b", "/a"] {
            preferences.remember(Path::new(name));
        }
        assert_eq!(preferences.recent, [PathBuf::from("/a"), "/b".into()]);
        // A folder and its flight.toml are one.
        preferences.remember(Path::new("/b/flight.toml"));
        assert_eq!(
            preferences.recent,
            [PathBuf::from("/b/flight.toml"), "/a".into()]
        );
        for number in 0..50 {
            preferences.remember(Path::new(&format!("/{number}")));
        }
        assert_eq!(preferences.recent.len(), RECENT);
    }

    #[test]
    fn an_unknown_unit_is_centimetres() {
        let mut preferences = Preferences::default();
        preferences.set_unit(LengthUnit::Inch);
        assert_eq!(preferences.unit(), LengthUnit::Inch);
        preferences.unit = "furlong".to_owned();
        assert_eq!(preferences.unit(), LengthUnit::Centimetre);
    }
}
