//! Whether a photo's colours are those of the surface.

use image::RgbImage;

use crate::flight::{ColoursFound, Doubt, Flight};
use crate::picture::{Agreement, Mismatch};

/// Whether a photo's colours are those of the surface.
#[derive(Debug, Clone, PartialEq)]
pub enum Colours {
    /// They were compared.
    Compared(Agreement),
    /// Why they were not, in words.
    Not(String),
    /// The photo's file is damaged or not readable, with the reason.
    Unreadable(String),
}

impl From<&Colours> for ColoursFound {
    fn from(colours: &Colours) -> Self {
        match (colours.doubt(), colours) {
            (Some(doubt), _) => Self::Against(doubt),
            (None, Colours::Compared(_)) => Self::NothingAgainst,
            (None, Colours::Not(_) | Colours::Unreadable(_)) => Self::CannotTell,
        }
    }
}

impl Colours {
    /// What they, or the file that they were to be read from, say against the photo.
    pub fn doubt(&self) -> Option<Doubt> {
        let agreement = match self {
            Self::Compared(agreement) => agreement,
            Self::Unreadable(why) => return Some(Doubt::FileUnreadable(why.clone())),
            Self::Not(_) => return None,
        };
        let Agreement {
            points,
            correlation,
            flipped: (flipped, _),
        } = *agreement;
        Some(match agreement.mismatch()? {
            Mismatch::Flipped(flip) => Doubt::Flipped {
                correlation,
                flipped,
                points,
                how: flip.in_words(),
            },
            Mismatch::Different => Doubt::OtherColours {
                correlation,
                points,
            },
        })
    }

    /// Of one photo of the flight, which is that of [`for_comparing`](crate::picture::for_comparing).
    pub fn of_photo(flight: &Flight, photo: usize, small: Option<&RgbImage>) -> Self {
        let parts = flight.parts();
        let Some(posed) = parts.photos.get(photo) else {
            return Self::Not("there is no such photo".to_owned());
        };
        let camera = flight.camera(posed);
        let photos = parts.photos.len();
        match Agreement::of_photo(&parts.surface, camera, &posed.pose, small, photos) {
            Ok(agreement) => Self::Compared(agreement),
            Err(why) => Self::Not(why.to_string()),
        }
    }
}
