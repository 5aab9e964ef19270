//! Places that are typed.

use glam::DVec2;

use crate::formats::typed_places;

/// One place, `x,y`.
pub(in crate::cli) fn place(text: &str) -> Result<DVec2, String> {
    match typed_places(text).map_err(|fault| fault.to_string())?[..] {
        [place] => Ok(place),
        _ => Err("give one place: x,y".to_owned()),
    }
}
