//! Places that are typed.

use glam::DVec2;

use crate::formats::typed_places;

/// What to do where places are on the Earth, and the flight does not say where it is.
pub(in crate::cli) const ON_EARTH_REMEDY: &str =
    "give x and y in the flight's world, a place a line; or world.crs in flight.toml";

/// One place, `x,y`.
pub(in crate::cli) fn place(text: &str) -> Result<DVec2, String> {
    match typed_places(text).map_err(|fault| fault.to_string())?[..] {
        [place] => Ok(place),
        _ => Err("give one place: x,y".to_owned()),
    }
}
