//! What a target's heights count from.

use fragscale_core::plan::{Above, Mission, Stop};

use crate::fault::Fault;

/// The fault of an absolute height that nobody can fly.
pub(super) fn no_datum(whose: &str) -> Fault {
    let what = format!("{whose} is absolute, and nobody says above what");
    let remedy = "say whether it counts from the ellipsoid or from the geoid, up to 107 m apart: --datum of 'fragscale mission'";
    Fault::new(what, remedy)
}

/// The metres of a stop (number from 1) above something else.
///
/// # Errors
/// Where that needs what is not known.
pub(super) fn metres_above(
    mission: &Mission,
    stop: &Stop,
    number: usize,
    above: Above,
) -> Result<f64, Fault> {
    let found = mission.height_above(stop.latitude, stop.longitude, stop.height, above);
    found.ok_or_else(|| {
        let (from, to) = (stop.height.above.in_words(), above.in_words());
        let what =
            format!("the height of stop {number} counts from {from}, and the target's from {to}");
        let remedy = match stop.height.above {
            Above::Ground => "plan heights above the place of take-off",
            _ => "give the elevation of the take-off, and above what: --elevation and --datum of 'fragscale mission'",
        };
        Fault::new(what, remedy)
    })
}
