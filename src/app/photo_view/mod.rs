//! The photo view: the selected photo in the middle of the window, as large as its file.
//!
//! Memory, of one photo at a time: four bytes a pixel in [`PhotoPyramid`], so 400 MB for 100 megapixels
//! (while it is decoded as much again), and at most [`tiles::MOST_TILES`] tiles of 1 MB as textures. All of
//! it is made by threads; a frame takes a few tiles over, and draws those that are in sight.

mod applying;
pub mod placing;
pub mod tiles;

use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::picture::{PhotoPyramid, TileKey};
use crate::scale::ImageKind;
use placing::Placing;
use tiles::Tiles;

/// What is in the middle of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Middle {
    /// The pile.
    #[default]
    Pile,
    /// The selected photo.
    Photo,
    /// Both, side by side.
    Both,
}

impl Middle {
    /// Whether the pile is among it.
    pub fn has_pile(self) -> bool {
        self != Self::Photo
    }

    /// Whether the photo is among it.
    pub fn has_photo(self) -> bool {
        self != Self::Pile
    }
}

/// What lies over the photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct PhotoOverlays {
    /// The edges of the image that the scale is for.
    pub edges: bool,
    /// Bars of known length at the top and the bottom.
    pub bars: bool,
    /// Eighths of that image.
    pub grid: bool,
    /// Its corners, and what they lie on.
    pub corners: bool,
    /// Lines of equal scale, while the photo is tinted.
    pub isolines: bool,
}

impl Default for PhotoOverlays {
    fn default() -> Self {
        Self {
            edges: true,
            bars: true,
            grid: false,
            corners: true,
            isolines: true,
        }
    }
}

/// What is done in the photo view. Lengths are in pixels of the screen.
#[derive(Debug, Clone, PartialEq)]
pub enum PhotoCommand {
    /// Shows something else in the middle of the window.
    Middle(Middle),
    /// Makes the photo larger (factor > 1) about the cursor.
    Zoom {
        /// Where the mouse is, from the frame's top left corner.
        cursor: DVec2,
        /// Over 1 enlarges.
        factor: f64,
        /// The size of the frame that the photo is shown in.
        frame: DVec2,
    },
    /// Moves the photo by so much.
    Pan {
        /// To the right and down.
        by: DVec2,
        /// The size of the frame.
        frame: DVec2,
    },
    /// A pixel of the photo is one of the screen.
    OneToOne,
    /// All of it is seen.
    Fit,
    /// Brings this pixel of the image that is shown into the middle, at least one to one.
    GoTo(DVec2),
    /// Shows this image of it.
    Image(ImageKind),
    /// Shows these things over it.
    Overlays(PhotoOverlays),
    /// These tiles are in sight, the most wanted first.
    Want(Vec<TileKey>),
}

/// The selected photo at full resolution.
#[derive(Debug)]
pub struct FullPhoto {
    /// Which photo.
    pub photo: usize,
    /// As shot, with its halvings; or why it cannot be shown.
    pub pixels: Result<Arc<PhotoPyramid>, String>,
}

/// The photo view of a flight.
#[derive(Default)]
pub struct PhotoView {
    /// Where the photo is seen.
    pub placing: Placing,
    /// Which image of it; `None` is the one that the scales are for.
    pub image: Option<ImageKind>,
    /// The photo, once it was read.
    pub full: Option<FullPhoto>,
    /// What of it is on the graphics card.
    pub tiles: Tiles,
}

impl PhotoView {
    /// Which image is shown where the scales are for this one.
    pub fn image_for(&self, scales: ImageKind) -> ImageKind {
        self.image.unwrap_or(scales)
    }

    /// The photo, if it is this one.
    pub fn full_of(&self, photo: usize) -> Option<&FullPhoto> {
        self.full.as_ref().filter(|full| full.photo == photo)
    }
}
