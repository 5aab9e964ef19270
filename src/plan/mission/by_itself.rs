//! What a drone does by itself: behind the last stop, and where the radio is lost.

/// What happens behind the last stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Finish {
    /// Back to the place of take-off, and land.
    ReturnHome,
    /// Stay at the last stop, until somebody takes over.
    #[default]
    Hover,
    /// Land below the last stop.
    Land,
    /// Back to the first stop, and stay there.
    FirstStop,
}

impl Finish {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::ReturnHome, Self::Hover, Self::Land, Self::FirstStop];

    /// As missions of ours are written (GeoJSON).
    pub fn as_str(self) -> &'static str {
        match self {
            Self::ReturnHome => "return home",
            Self::Hover => "hover",
            Self::Land => "land",
            Self::FirstStop => "first stop",
        }
    }

    /// In words that follow "at the end:".
    pub fn in_words(self) -> &'static str {
        match self {
            Self::ReturnHome => "returns home",
            Self::Hover => "hovers",
            Self::Land => "lands",
            Self::FirstStop => "flies to the first stop and hovers",
        }
    }
}

/// What the drone does where the radio is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LostSignal {
    /// Straight back to the place of take-off, at the height to return home at, and land.
    ReturnHome,
    /// Stay where it is. A low battery brings drones home even so.
    Hover,
    /// Land where it is.
    Land,
    /// Fly the mission to its end.
    GoOn,
}

impl LostSignal {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::ReturnHome, Self::Hover, Self::Land, Self::GoOn];

    /// As missions of ours are written (GeoJSON).
    pub fn as_str(self) -> &'static str {
        match self {
            Self::ReturnHome => "return home",
            Self::Hover => "hover",
            Self::Land => "land",
            Self::GoOn => "go on",
        }
    }

    /// In words that follow "where the radio is lost:".
    pub fn in_words(self) -> &'static str {
        match self {
            Self::ReturnHome => "returns home",
            Self::Hover => "hovers",
            Self::Land => "lands",
            Self::GoOn => "goes on",
        }
    }
}
