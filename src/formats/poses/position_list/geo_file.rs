//! OpenDroneMap's image geolocation file, `geo.txt` (docs.opendronemap.org, "Image Geolocation
//! Files"; `opendm/geo.py`).
//!
//! The first line names the coordinate system ("EPSG:4326", a PROJ string, "WGS84 UTM 16N"), then a
//! line a photo, separated by spaces or tabs:
//!
//! ```text
//! image_name x y [z] [yaw] [pitch] [roll] [horizontal accuracy] [vertical accuracy] [extras...]
//! ```
//!
//! x is the easting or the longitude, y the northing or the latitude, whatever order the authority
//! of the system prefers. Accuracies are in metres. The angles serve radiometric calibration and are
//! passed over. Lines that begin with # are comments.

use glam::DVec3;

use super::{NamedPosition, PositionList, check_degrees, is_geographic};
use crate::fault::Fault;
use crate::text::fields::Fields;

/// Reads a geo.txt whose first line says `crs`.
pub(super) fn read(text: &str, crs: Option<String>) -> Result<PositionList, Fault> {
    let mut list = PositionList::default();
    let geographic = is_geographic(crs.as_deref());
    let mut without_height = 0_usize;
    for (line, number) in content(text) {
        let mut fields = Fields::new(
            number,
            line,
            "a line of a geo.txt is 'image x y z', behind a first line with the coordinate system",
        );
        let name = fields.word("the image's name")?;
        let (x, y) = (fields.number("x")?, fields.number("y")?);
        if fields.rest().is_empty() {
            without_height += 1;
            continue;
        }
        let z = fields.number("z")?;
        let position = DVec3::new(x, y, z);
        if geographic {
            check_degrees(number, position)?;
        }
        // Behind the three angles; extras may follow anywhere, and are no fault.
        let rest: Vec<&str> = fields.rest().split_whitespace().collect();
        let accuracy = rest.get(3..5).and_then(|pair| match pair {
            [horizontal, vertical] => {
                let (h, v): (f64, f64) = (horizontal.parse().ok()?, vertical.parse().ok()?);
                (h.is_finite() && v.is_finite() && h > 0.0 && v > 0.0)
                    .then_some(DVec3::new(h, h, v))
            }
            _ => None,
        });
        list.positions.push(NamedPosition {
            name: name.to_owned(),
            position,
            accuracy,
            looks: None,
        });
    }
    leave_out_without_height(&mut list, without_height)?;
    list.crs = crs;
    Ok(list)
}

/// The lines behind the first one that are no comments, with their numbers.
pub(super) fn content(text: &str) -> impl Iterator<Item = (&str, u64)> {
    let lines = text
        .lines()
        .zip(1..)
        .map(|(line, number)| (line.trim(), number));
    let lines = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    lines.skip(1)
}

/// Says how many positions were left out because they have no height: a place in the world has three
/// coordinates, and a height of 0 in place of an unknown one would tilt and scale what is fitted to it.
pub(super) fn leave_out_without_height(
    list: &mut PositionList,
    without: usize,
) -> Result<(), Fault> {
    let all = list.positions.len() + without;
    if without > 0 && list.positions.is_empty() {
        return Err(Fault::new(
            format!("none of its {all} positions has a height"),
            "add the heights",
        ));
    }
    if without > 0 {
        list.warnings.push(format!(
            "{without} of {all} positions have no height and are left out"
        ));
    }
    Ok(())
}
