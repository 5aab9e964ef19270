//! How the photos of a plan lie, and what speaks for it.

use crate::plan::photo::Purpose;

/// How photos lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Pattern {
    /// Rows at one height, one tilt for all.
    Paper,
    /// Each photo looks along the normal of the ground.
    #[default]
    Slope,
    /// With overlap, for a reconstruction.
    Survey,
    /// Along the slope, and a survey.
    Both,
    /// The paper's rows, and a survey.
    PaperBoth,
}

impl Pattern {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Slope,
        Self::Paper,
        Self::Survey,
        Self::Both,
        Self::PaperBoth,
    ];

    /// Its name on the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Slope => "slope",
            Self::Survey => "survey",
            Self::Both => "both",
            Self::PaperBoth => "paper-both",
        }
    }

    /// Its name in the window.
    pub fn title(self) -> &'static str {
        match self {
            Self::Paper => "Rows",
            Self::Slope => "Along the slope",
            Self::Survey => "Survey",
            Self::Both => "Along the slope, and a survey",
            Self::PaperBoth => "Rows, and a survey",
        }
    }

    /// What its photos are taken for.
    pub fn purposes(self) -> &'static [Purpose] {
        match self {
            Self::Paper | Self::Slope => &[Purpose::Scale],
            Self::Survey => &[Purpose::Survey],
            Self::Both | Self::PaperBoth => &[Purpose::Scale, Purpose::Survey],
        }
    }

    /// What those are taken for that it is named for.
    pub fn main(self) -> Purpose {
        match self {
            Self::Survey => Purpose::Survey,
            _ => Purpose::Scale,
        }
    }

    /// Whether it has photos that are taken for this.
    pub fn has(self, purpose: Purpose) -> bool {
        self.purposes().contains(&purpose)
    }

    /// Whether its photos for scales look along the normal of the ground.
    pub fn is_square(self) -> bool {
        matches!(self, Self::Slope | Self::Both)
    }

    /// Whether its photos for scales have one height and one tilt.
    pub fn is_level(self) -> bool {
        matches!(self, Self::Paper | Self::PaperBoth)
    }

    /// What speaks for it.
    pub fn explained(self) -> &'static str {
        match self {
            Self::Paper => "Rows at one height, the camera tilted alike in all, without overlap",
            Self::Slope => {
                "Each photo looks along the normal of the ground from the distance that gives the scale"
            }
            Self::Survey => {
                "Overlapping rows straight down and a ring that looks aslant, for a reconstruction"
            }
            Self::Both => "Photos along the slope, and a survey for the cloud, in one flight",
            Self::PaperBoth => "Rows at one height, and a survey for the cloud, in one flight",
        }
    }
}
