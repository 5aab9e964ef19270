//! A flight's health at a glance: its unit, coordinate system, up axis, colours, distance, metadata, holes, points, photos.
//! Each is good, or says in one sentence what is not and what mends it; every front end shows these words.

mod doubted;
mod item;
mod of_photos;
mod of_surface;
mod of_world;
mod remedy;

pub use self::item::HealthItem;
pub use self::remedy::Remedy;

use self::of_photos::{exif, photos, poses};
use self::of_surface::{colours, distance, holes, points};
use self::of_world::{coordinates, unit, up};
use crate::flight::Review;
use crate::open::FlightReconstruction;
use crate::surface::UpAxis;

/// How it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Health {
    /// Looked at, and good.
    Good,
    /// Nothing is known of it, or it is still being looked at: neither good nor bad.
    Unknown,
    /// Numbers may be wrong for it.
    Bad,
}

/// How one thing is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HealthFinding {
    /// What was looked at.
    pub item: HealthItem,
    /// How it is.
    pub health: Health,
    /// The same in a word or a number: "m", "9 of 9".
    pub short: String,
    /// In one sentence.
    pub says: String,
    /// What mends it, where it is not good and something does.
    pub remedy: Option<Remedy>,
}

/// What is stated of a flight beside its review.
#[derive(Debug, Clone, Copy, Default)]
pub struct StatedOfFlight<'a> {
    /// The coordinate system, "EPSG:n" or WKT.
    pub crs: Option<&'a str>,
    /// The reconstruction that it was made of.
    pub reconstruction: Option<&'a FlightReconstruction>,
    /// The axis that the surface's triangles say is up, where that is not z.
    pub doubtful_up: Option<UpAxis>,
    /// The photos that lie beside the flight's and have no pose in it, in words.
    pub without_pose: Option<&'a str>,
}

/// How a flight is, in the order of [`HealthItem`]; of its poses and points only where something speaks against them, of
/// its distance where photos were compared.
pub fn flight_health(review: &Review, stated: &StatedOfFlight<'_>) -> Vec<HealthFinding> {
    let found = [
        Some(unit(review, stated)),
        Some(coordinates(review, stated)),
        poses(review),
        Some(up(review, stated)),
        Some(colours(review)),
        distance(review),
        Some(exif(review, stated)),
        Some(holes(review)),
        points(review),
        Some(photos(review, stated)),
    ];
    found.into_iter().flatten().collect()
}

fn of(item: HealthItem, health: Health, short: impl Into<String>, says: String) -> HealthFinding {
    HealthFinding {
        item,
        health,
        short: short.into(),
        says,
        remedy: None,
    }
}

impl HealthFinding {
    fn with(self, remedy: Remedy) -> Self {
        Self {
            remedy: Some(remedy),
            ..self
        }
    }
}
