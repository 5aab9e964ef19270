//! What is looked up of a flight's photos, outside of the flight's own numbers: their files, and what
//! speaks against their scales. A review is made of it; it is looked up where files can be read.

use std::fmt::Display;

use super::Doubt;

/// What is known about a photo's image file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum PhotoFileState {
    /// The flight names no folder of image files.
    #[default]
    NotNamed,
    /// There is a folder, but not this file in it.
    Missing,
    /// The file cannot be read, with the reason.
    Unreadable(String),
    /// Its size in pixels.
    Found {
        /// Width.
        width: u32,
        /// Height.
        height: u32,
    },
}

/// Whether a photo's colours, compared with those of the surface, speak against it.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum ColoursFound {
    /// Nobody has compared them yet.
    #[default]
    NotCompared,
    /// They cannot be: too few points with a colour are in sight, or no file is there.
    CannotTell,
    /// They were compared: nothing speaks against the photo.
    NothingAgainst,
    /// They, or the file that they were to be read from, speak against it.
    Against(Doubt),
}

/// Whether a photo and those beside it see the surface where it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TogetherFound {
    /// Nobody has compared them yet, or no photo is beside it.
    #[default]
    NotCompared,
    /// They do not tell.
    Unclear,
    /// They do.
    There {
        /// The photo beside it that tells most.
        other: String,
        /// Within this share of its distance from the camera.
        off: f64,
    },
    /// They see it elsewhere.
    Against(Doubt),
}

/// What was looked up of one photo.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Evidence {
    /// Its image file.
    pub file: PhotoFileState,
    /// What its size, its place and its metadata say against it, the gravest first.
    pub doubts: Vec<Doubt>,
    /// What its colours say.
    pub colours: ColoursFound,
    /// What it and the photos beside it see.
    pub together: TogetherFound,
}

impl Evidence {
    /// Whether its pixels were compared with nothing, though its file is there: the surface shows no colours, and no photo is beside it.
    pub fn is_unconfirmed(&self) -> bool {
        let is_there = matches!(self.file, PhotoFileState::Found { .. });
        let nothing = (&self.colours, &self.together);
        is_there && nothing == (&ColoursFound::CannotTell, &TogetherFound::NotCompared)
    }

    /// All that speaks against the photo, the gravest first. A file whose header cannot be read is
    /// doubted for that already, not for its colours once more.
    pub fn against(&self) -> impl Iterator<Item = &Doubt> {
        let of_colours = match (&self.colours, &self.file) {
            (_, PhotoFileState::Unreadable(_)) => None,
            (ColoursFound::Against(doubt), _) => Some(doubt),
            (
                ColoursFound::NotCompared | ColoursFound::CannotTell | ColoursFound::NothingAgainst,
                _,
            ) => None,
        };
        let of_together = match &self.together {
            TogetherFound::Against(doubt) => Some(doubt),
            TogetherFound::NotCompared | TogetherFound::Unclear | TogetherFound::There { .. } => {
                None
            }
        };
        self.doubts.iter().chain(of_colours).chain(of_together)
    }
}

/// Of how many photos the files' metadata were looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MetadataRead {
    /// So many files were read: of a large flight not all.
    pub looked_at: usize,
    /// So many of these name their camera or its focal length.
    pub telling: usize,
    /// So many of these are shown turned by viewers.
    pub turned: usize,
}

/// What was looked up of a flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LookedUp {
    /// Of each photo.
    pub evidence: Vec<Evidence>,
    /// The same of the whole flight, a sentence each.
    pub warnings: Vec<String>,
    /// What the photos' files say of themselves.
    pub metadata: MetadataRead,
}

impl LookedUp {
    /// The warnings with the flight's name or file in front.
    pub fn warnings_of(&self, flight: impl Display) -> impl Iterator<Item = String> {
        let warnings = self.warnings.iter();
        warnings.map(move |warning| format!("{flight}: {warning}"))
    }
}
