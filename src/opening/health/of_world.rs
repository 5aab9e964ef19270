//! How a flight's world is: its unit, its coordinate system, which way is up.

use super::doubted::{doubted, share};
use super::{Health, HealthFinding, HealthItem, Remedy, StatedOfFlight, of};
use crate::flight::{Doubt, Review};
use crate::open::FlightReconstruction;

pub(super) fn unit(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let parts = review.flight().parts();
    let doubt = parts.unit_doubt();
    if let Some(reason @ Doubt::UnitNotSystems { counted, .. }) = &doubt {
        let says = format!("{}: {reason}.", share(review.count(), review));
        let short = format!("{}, not {counted}", parts.unit);
        return of(HealthItem::Unit, Health::Bad, short, says).with(Remedy::SetUnit);
    }
    match parts.unit_known {
        true => {
            let says = format!("The world counts in {}.", parts.unit);
            of(HealthItem::Unit, Health::Good, parts.unit.symbol(), says)
        }
        false => {
            let says =
                "Nobody states the unit of cloud and poses: no number is a scale.".to_owned();
            let remedy = match stated.reconstruction {
                Some(_) => Remedy::Georeference,
                None => Remedy::SetUnit,
            };
            of(HealthItem::Unit, Health::Bad, "unknown", says).with(remedy)
        }
    }
}

pub(super) fn coordinates(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let item = HealthItem::CoordinateSystem;
    if let Some(doubted) = doubted(review, item) {
        let short = match doubted.first {
            Doubt::OtherHeights { .. } => "two heights",
            _ => "two systems",
        };
        return of(item, Health::Bad, short, doubted.says(review)).with(Remedy::AddSurface);
    }
    if let Some(crs) = stated.crs {
        // WKT is a page.
        let is_code = crs.len() <= 16 && !crs.contains('[');
        let (short, says) = match is_code {
            true => (crs.to_owned(), format!("Surface and photos are in {crs}.")),
            false => (
                "stated".to_owned(),
                "Surface and photos are in the system that their files state in full.".to_owned(),
            ),
        };
        return of(item, Health::Good, short, says);
    }
    match stated.reconstruction {
        Some(FlightReconstruction { in_world: None, .. }) => {
            let says = "The reconstruction is in a frame of its own: its directions and its size mean nothing \
                        until it is georeferenced."
                .to_owned();
            of(item, Health::Bad, "own frame", says).with(Remedy::Georeference)
        }
        Some(FlightReconstruction {
            in_world: Some(by), ..
        }) => {
            let says =
                format!("The reconstruction is in the world: {by}. No coordinate system is named.");
            of(item, Health::Good, "local", says)
        }
        None => {
            let says = "No coordinate system is named: scales need none, maps do.".to_owned();
            of(item, Health::Unknown, "local", says)
        }
    }
}

pub(super) fn up(review: &Review, stated: &StatedOfFlight<'_>) -> HealthFinding {
    let item = HealthItem::UpAxis;
    if let Some(doubted) = doubted(review, item) {
        return of(item, Health::Bad, "?", doubted.says(review));
    }
    match stated.doubtful_up {
        Some(axis) => {
            let name = axis.name();
            let says = format!(
                "The surface looks as if {name} were up in its file (a steep wall looks the same)."
            );
            of(item, Health::Bad, format!("{name}?"), says).with(Remedy::TurnUp(axis))
        }
        None if matches!(
            stated.reconstruction,
            Some(FlightReconstruction { in_world: None, .. })
        ) =>
        {
            let says = "The reconstruction is in a frame of its own: which way is up was taken from its cameras and \
                        points, or from the gimbals' angles."
                .to_owned();
            of(item, Health::Unknown, "taken", says)
        }
        None if review.count() == 0 => {
            let says = "z is taken to be up: there are no cameras to say otherwise.".to_owned();
            of(item, Health::Unknown, "z", says)
        }
        None => {
            let says = "z is up: every camera is above or beside the surface.".to_owned();
            of(item, Health::Good, "z", says)
        }
    }
}
