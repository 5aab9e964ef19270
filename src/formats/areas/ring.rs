//! The outline of a polygon, from longitude and latitude.

use super::KNOWN;
use crate::fault::Fault;
use crate::geodesy::Geographic;

/// More corners are no area that somebody drew.
const MOST: usize = 100_000;

/// The corners of an outline that may end where it began. `at` is the place in the file, in words that a corner's number
/// follows ("polygon 2"), `line` that in a text, where it has one.
///
/// # Errors
/// Where a corner is no place on the Earth, or they are fewer than three.
pub(super) fn ring(
    positions: &[[f64; 2]],
    at: &str,
    line: Option<u64>,
) -> Result<Vec<Geographic>, Fault> {
    let fault = |what: String, remedy: &str| Fault {
        line,
        ..Fault::new(what, remedy)
    };
    if positions.len() > MOST {
        let what = format!("{at} has {} corners, more than {MOST}", positions.len());
        return Err(fault(what, "draw it with fewer"));
    }
    for (&[longitude, latitude], number) in positions.iter().zip(1..) {
        let what = format!("{at}, corner {number}: {longitude}, {latitude}");
        let is_latitude = |degrees: f64| degrees.abs() <= 90.0;
        let is_longitude = |degrees: f64| degrees.abs() <= 180.0;
        if is_longitude(longitude) && is_latitude(latitude) {
            continue;
        }
        return Err(if is_latitude(longitude) && is_longitude(latitude) {
            let what = format!("{what}: there is no latitude of {latitude} degrees");
            fault(what, "write the longitude first, then the latitude")
        } else {
            fault(format!("{what} are no degrees"), KNOWN)
        });
    }
    let mut corners = positions.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 3 {
        let what = format!("{at} has {} corners, no area", corners.len());
        return Err(fault(what, "draw it with three corners at least"));
    }
    Ok(corners
        .into_iter()
        .map(|[longitude, latitude]| Geographic {
            longitude,
            latitude,
            height: 0.0,
        })
        .collect())
}
