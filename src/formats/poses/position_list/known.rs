//! Whether a file that may be anything is a list of known places, and of which.
//!
//! Such lists have columns as a cloud has, and DJI's have no name that tells. What is certain is what the text itself
//! says: a first line with a coordinate system, a week in brackets (`Shape`), or a header that names a column of names
//! in which stand names, or whose own name is one of photos or control points.

use std::path::Path;

use super::table::SaysSo;
use super::{
    ControlPoints, NamedPosition, PositionList, Shape, control_points_from_text, gcp_list,
    positions_from_text, table,
};
use crate::fault::Fault;
use crate::files::{read_small, text_from_bytes};
use crate::photos::image_names::{Ending, is_called};

/// A list of known places, whichever it is.
#[derive(Debug, Clone, PartialEq)]
pub enum KnownPlaces {
    /// Of ground control points.
    ControlPoints(ControlPoints),
    /// Where photos were taken.
    OfPhotos(PositionList),
}

/// Reads a list of known places, with what is wrong with one that is certainly one; `None` of what says nothing like it. What it is
/// asked of may be anything: a film, a cloud.
pub fn read_known_places(path: &Path) -> Option<Result<KnownPlaces, Fault>> {
    const MOST: u64 = 16 << 20;
    let bytes = read_small(path, MOST, "list of places", "").ok()?;
    let text = text_from_bytes(&bytes).ok()?;
    let shape = Shape::of(text).ok()?;
    let is_certain = match shape {
        Shape::Table => matches!(table::says_so(text)?, SaysSo::ByItsHeader),
        Shape::Mrk | Shape::Crs(_) | Shape::Marks => true,
    };
    let points = control_points_from_text(text);
    if let Ok(list) = points.as_ref()
        && !are_of_photos(list)
    {
        return Some(points.map(KnownPlaces::ControlPoints));
    }
    let positions = positions_from_text(text);
    if let Ok(list) = positions.as_ref()
        && list.positions.iter().all(is_named)
    {
        return Some(positions.map(KnownPlaces::OfPhotos));
    }
    // Whose fault is told is what its first line would be of.
    let is_of_points = match shape {
        Shape::Crs(_) => gcp_list::begins_with_numbers(text),
        Shape::Marks => true,
        Shape::Mrk | Shape::Table => false,
    };
    match is_of_points {
        true => points.err(),
        false => positions.err(),
    }
    .filter(|_| is_certain)
    .map(Err)
}

/// Coordinates and pixels without a name begin with a number that is none's.
fn is_named(of: &NamedPosition) -> bool {
    !(of.name.contains('.') && of.name.parse::<f64>().is_ok())
}

/// Whether the points of a list are called as images are: then they are places of photos, whose columns a list of points has, too.
fn are_of_photos(list: &ControlPoints) -> bool {
    let points = &list.list.points;
    !points.is_empty()
        && points
            .iter()
            .all(|point| is_called(&point.name, Ending::Raw))
}
