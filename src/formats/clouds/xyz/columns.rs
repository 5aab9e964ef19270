//! Which columns of a line are x, y, z and colours: by their names, or by their numbers.

use glam::DVec3;

use crate::units::LengthUnit;

/// A column's name without quotes, and without the unit of `X [m]` and `x(m)`.
pub(super) fn plain_name(name: &str) -> &str {
    let name = name.trim_matches(['"', '\'']);
    name.split(['[', '(']).next().unwrap_or_default().trim()
}

/// The unit that the names of x, y and z have in brackets; `None` where one has none.
///
/// # Errors
/// What is wrong where they are not alike.
pub(super) fn unit_of(names: &[&str; 3]) -> Result<Option<LengthUnit>, String> {
    let unit = |name: &str| -> Option<LengthUnit> {
        let (_, behind) = name.split_once(['[', '('])?;
        behind.split([']', ')']).next()?.trim().parse().ok()
    };
    match names.map(unit) {
        [Some(x), Some(y), Some(z)] if x == y && y == z => Ok(Some(x)),
        [Some(x), Some(y), Some(z)] => Err(format!("x is in {x}, y in {y} and z in {z}")),
        _ => Ok(None),
    }
}

/// Where on a line the coordinates and colours stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Columns {
    pub(super) position: [usize; 3],
    color: Option<[usize; 3]>,
    /// Colours from 0 to 1.
    fractions: bool,
    /// The angles of a camera: where they are named, words are photos' names, and this is no cloud.
    angles: bool,
}

impl Columns {
    pub(super) fn of_names(names: &[&str]) -> Option<Self> {
        let names: Vec<&str> = names.iter().map(|name| plain_name(name)).collect();
        // The first alias that stands there: "x" before "e" of a line that has both.
        let find = |aliases: &[&str]| {
            let place = |alias: &&str| {
                names
                    .iter()
                    .position(|name| name.eq_ignore_ascii_case(alias))
            };
            aliases.iter().find_map(place)
        };
        let position = [
            find(&["x", "easting", "east", "e"])?,
            find(&["y", "northing", "north", "n"])?,
            find(&["z", "elevation", "height", "altitude", "elev", "alt", "h"])?,
        ];
        let color = |aliases: [&[&str]; 3]| {
            let [red, green, blue] = aliases.map(find);
            Some([red?, green?, blue?])
        };
        let fractions = color([&["rf"], &["gf"], &["bf"]]);
        let whole = color([&["red", "r"], &["green", "g"], &["blue", "b"]]);
        Some(Self {
            position,
            color: fractions.or(whole),
            fractions: fractions.is_some(),
            angles: find(&["omega", "yaw", "heading", "pitch"]).is_some(),
        })
    }

    /// Those of COLMAP's points3D.txt without its comment: POINT3D_ID X Y Z R G B ERROR, then IMAGE_ID POINT2D_IDX of each photo.
    pub(super) fn of_colmap(first: &[f64]) -> Option<Self> {
        let is_count = |value: &f64| value.fract() == 0.0 && *value >= 0.0;
        let [id, x, y, z, colors @ .., error] = first.get(..8)? else {
            return None;
        };
        // Two photos at least show each; laser scanners write up to three whole numbers behind a time.
        let track = first.get(8..).filter(|track| track.len() >= 4)?;
        let is_one = is_count(id)
            && [x, y, z].iter().any(|value| value.fract() != 0.0)
            && colors
                .iter()
                .all(|value| is_count(value) && *value <= 255.0)
            && error.fract() != 0.0
            && (0.0..100.0).contains(error)
            && track.len() % 2 == 0
            && track.iter().all(is_count);
        is_one.then_some(Self {
            position: [1, 2, 3],
            color: Some([4, 5, 6]),
            fractions: false,
            angles: false,
        })
    }

    pub(super) fn of_numbers(first: &[f64]) -> Self {
        let is_channel = |n: &f64| n.fract() == 0.0 && (0.0..=255.0).contains(n);
        let colors = first
            .get(3..6)
            .is_some_and(|three| three.iter().all(is_channel));
        Self {
            position: [0, 1, 2],
            color: colors.then_some([3, 4, 5]),
            fractions: false,
            angles: false,
        }
    }

    pub(super) fn reads(&self, column: usize) -> bool {
        let angles = self.angles;
        angles
            || self.position.contains(&column)
            || self.color.is_some_and(|three| three.contains(&column))
    }

    pub(super) fn pick(&self, fields: &[f64]) -> Option<(DVec3, Option<[u8; 3]>)> {
        let three = |columns: [usize; 3]| {
            let [a, b, c] = columns.map(|column| fields.get(column).copied());
            Some([a?, b?, c?])
        };
        let position = DVec3::from_array(three(self.position)?);
        let color = match self.color {
            Some(columns) => {
                let factor = if self.fractions { 255.0 } else { 1.0 };
                // `as` saturates.
                Some(three(columns)?.map(|channel| (channel * factor).round() as u8))
            }
            None => None,
        };
        Some((position, color))
    }
}
