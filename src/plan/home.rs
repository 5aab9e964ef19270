//! The way home that the drone flies by itself: straight from where it is, when the pilot calls it, the radio is lost or the
//! battery is low. It knows a height to rise to first, and nothing of areas to keep out of.

use glam::DVec2;

use super::keep_out::KeepOut;
use super::{LostSignal, Plan, Way};

/// The height in the world from which the drone comes straight home from anywhere on its way, also from between two stops,
/// rising to it where it is, and keeps the clearance: never below the safe height of the ways. `None` without a way.
pub fn return_height(plan: &Plan, ways: &[Way]) -> Option<f64> {
    let clearance = plan.wish.clearance;
    let over = ways.iter().flat_map(|way| {
        let home = way.take_off.truncate();
        let corners = way.corners();
        let tops = corners.windows(2).filter_map(|leg| {
            let triangle = [leg[0].truncate(), leg[1].truncate(), home];
            plan.terrain.highest_in(triangle, clearance)
        });
        let highest = tops.reduce(f64::max);
        [Some(way.safe_height), highest.map(|top| top + clearance)]
    });
    over.flatten().reduce(f64::max)
}

/// A height to come home at as it is set at a drone: rounded up to a whole unit. A rounding error above a whole one is that one.
pub fn set_height(height: f64) -> f64 {
    (height - 1e-6).ceil()
}

/// How many stops of the ways have a place on the leg that leads to them from which the straight way home leads over an area
/// to keep out of, or nearer to one than the clearance.
pub fn homes_over_keep_out(plan: &Plan, ways: &[Way]) -> usize {
    // Of areas with too many corners there is no plan.
    let Ok(keep_out) = KeepOut::new(&plan.wish.keep_out, plan.wish.clearance) else {
        return 0;
    };
    let stops = ways.iter().map(|way| {
        let home = way.take_off.truncate();
        let places: Vec<DVec2> = std::iter::once(home)
            .chain(way.points.iter().map(|point| point.place.truncate()))
            .collect();
        let legs = places.windows(2);
        legs.filter(|leg| keep_out.lies_between([leg[0], leg[1]], home))
            .count()
    });
    stops.sum()
}

/// What missions of a plan tell the drone to do where the radio is lost: to come home, where no way home leads over an area to
/// keep out of; else to stay where it is, for the pilot to go there, and not to fly over people or a misfire.
pub fn lost_signal(plan: &Plan, ways: &[Way]) -> LostSignal {
    match homes_over_keep_out(plan, ways) {
        0 => LostSignal::ReturnHome,
        _ => LostSignal::Hover,
    }
}
