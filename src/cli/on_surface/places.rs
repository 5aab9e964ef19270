//! Places that are typed.

use glam::DVec2;

use crate::fault::Fault;
use crate::geodesy::Crs;
use crate::geometry::{Bounds, extent};
use crate::survey::Polygon;

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

/// That a polygon in a world lies beside the surface, with both of their places.
pub(super) fn beside(polygon: &Polygon, surface: &Bounds, world: Option<&Crs>) -> Fault {
    let Bounds { min, max } = surface;
    let [low, high] = extent(polygon.corners());
    let middle = (low + high) / 2.0;
    let meets = high.cmpge(min.truncate()).all() && low.cmple(max.truncate()).all();
    let what = match meets {
        true => "the polygon lies over a hole of the surface, or beyond its edge".to_owned(),
        false => format!(
            "the polygon lies beside the surface, around ({:.4}, {:.4}), and that at x {:.1} to {:.1}, y {:.1} to {:.1}",
            middle.x, middle.y, min.x, max.x, min.y, max.y
        ),
    };
    // Degrees of a file are brought to a map: what 'info' shows of it is not where it is then.
    let is_degrees =
        low.cmpge(DVec2::new(-180.0, -180.0)).all() && high.cmple(DVec2::new(180.0, 180.0)).all();
    let remedy = match world {
        Some(crs) if is_degrees && !meets => format!(
            "give corners in the world's coordinates ({}), or degrees in a map's file, GeoJSON or KML",
            crs.name()
        ),
        Some(crs) => format!("give corners in the world's coordinates ({})", crs.name()),
        None => "give corners in its coordinates; 'fragscale info' shows its bounds".to_owned(),
    };
    Fault::new(what, remedy)
}
