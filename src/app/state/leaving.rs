//! What the flight on the screen is left for, and a flight that waits to take its place.

use std::path::PathBuf;

use crate::files;
use crate::flight::FlightSettings;
use crate::open_flight::OpenFlight;
use crate::open_flight::loading::Loaded;

/// How something was named that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// To be opened; a surface alone is for the flight that could not be opened last, or that is on the screen.
    ToOpen,
    /// As the surface or the photos of the flight on the screen.
    Added,
    /// A cloud, to be looked at by itself.
    Alone,
    /// The flight on the screen once more, with the surface and the photos that were added to it.
    Again,
}

/// What the flight on the screen is left for.
#[derive(Debug)]
pub enum Leaving {
    /// A flight that is read from here: it may be none, so the one on the screen stays until it is there.
    Read {
        /// What was named.
        paths: Vec<PathBuf>,
        /// How.
        named: Named,
    },
    /// The bundled flight.
    Sample,
    /// A flight that was read.
    Take(Box<Arrived>),
    /// The start page.
    Close,
    /// Leaving the program.
    Quit,
}

impl Leaving {
    /// Whether the same flight comes back, with what is shown and measured of it.
    pub(crate) fn comes_back(&self) -> bool {
        matches!(
            self,
            Self::Read {
                named: Named::Again,
                ..
            }
        )
    }

    /// Whether the flight on the screen goes, and does not come back. While another one is read it stays.
    pub(crate) fn ends_flight(&self) -> bool {
        matches!(self, Self::Take(_) | Self::Close | Self::Quit)
    }
}

/// A flight that was read while another may be on the screen, with what was named.
#[derive(Debug)]
pub struct Arrived {
    /// What was read.
    pub(crate) loaded: Loaded,
    /// What was named.
    pub(crate) paths: Vec<PathBuf>,
    /// How.
    pub(crate) named: Named,
    /// What was on the screen when it was read, and the settings in its file.
    pub(crate) beside: Option<(PathBuf, FlightSettings)>,
}

impl Arrived {
    /// The flight's name.
    pub fn name(&self) -> &str {
        &self.loaded.opened.flight.parts().name
    }

    /// Whether it is the flight on the screen, as it was before that was saved.
    pub(crate) fn is_of_old(&self, open: &OpenFlight) -> bool {
        let Some((path, saved)) = &self.beside else {
            return false;
        };
        let own = self.loaded.opened.origin.flight_file();
        let both = own.zip(open.files.origin.flight_file());
        let is_same_file = |(own, other)| files::is_same_file(own, other);
        *saved != open.files.saved && (self.loaded.path == *path || both.is_some_and(is_same_file))
    }
}
