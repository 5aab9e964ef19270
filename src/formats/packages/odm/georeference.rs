//! How OpenDroneMap's frames hang together: from OpenSfM's to the georeferenced one.
//!
//! Written from ODM's `opendm/location.py` (`parse_srs_header`), `opendm/types.py` (`ODM_GeoRef`),
//! `stages/run_opensfm.py`, `stages/odm_georeferencing.py` and OpenSfM's
//! `opensfm/actions/export_geocoords.py`.
//!
//! - `opensfm/geocoords_transformation.txt` (ODM up to February 2021): a row-major 4x4 matrix, from
//!   the topocentric frame of `opensfm/reconstruction.json` to the projected one. Its columns are
//!   finite differences of a map projection, so it is NO similarity: horizontal lengths carry the
//!   projection's scale factor (0.9996 to 1.001 in UTM), heights do not. Points and camera centres
//!   take the matrix as it is; camera axes turn by the rotation nearest to it, as ODM computes
//!   `shots.geojson` (OpenCV's `Rodrigues` of R A^-1).
//! - `odm_georeferencing/coords.txt`: line 1 the coordinate system ("WGS84 UTM 15N", a PROJ string or
//!   "EPSG:n"), line 2 an offset "east north". In newer versions `opensfm/reconstruction.json` is in
//!   the projected frame less that offset.
//! - `odm_georeferencing/alignment_matrix.json` (since December 2022, option `--align`): a 4x4 matrix
//!   as nested lists, which acts in the georeferenced frame.
//! - `odm_georeferencing/proj.txt`: the coordinate system as a PROJ string.
//!
//! Which of the frames `reconstruction.json` is in depends on ODM's version. Where `shots.geojson`
//! states the camera centres, the map that leads to them is the right one. Else the transformation
//! file counts; else the offset, where `opensfm/reconstruction.topocentric.json` or
//! `opensfm/exported_geocoords.txt` tells that this version writes projected coordinates, or the
//! photos' GPS positions do (opensfm/frame).

use std::path::Path;

use glam::{DMat3, DVec2, DVec3};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::files::{FileError, read_bytes, text_from_bytes};
use crate::poses::rounded_rotation::nearest_rotation;
use crate::text::json::parse;

/// How far, in metres, a camera centre may lie from where `shots.geojson` states it. The right map
/// agrees to rounding (1e-8 m), wrong ones are metres off.
const SAME_CENTER: f64 = 1e-3;

/// How far the columns of a matrix may deviate from equal lengths and right angles: ten times what
/// UTM does at the edge of its zones.
const MOST_DEVIATION: f64 = 0.01;

/// What a project folder says about its frames.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frames {
    /// The georeferenced frame's coordinate system.
    pub(super) crs: Option<String>,
    transform: Option<Georeference>,
    offset: Option<Georeference>,
    alignment: Option<Georeference>,
    /// Whether `reconstruction.json` is known to be in projected coordinates less the offset.
    is_projected: bool,
}

impl Frames {
    /// Reads what there is of the files named above.
    pub(super) fn read(dir: &Path) -> Result<Self, FileError> {
        let (coords, offset) = optional(&dir.join("odm_georeferencing/coords.txt"), |bytes| {
            Ok(parse_coords(text_from_bytes(bytes)?))
        })?
        .unwrap_or_default();
        let proj = optional(&dir.join("odm_georeferencing/proj.txt"), |bytes| {
            Ok(crs_from_text(text_from_bytes(bytes)?))
        })?;
        Ok(Self {
            crs: proj.flatten().or(coords),
            transform: optional(&dir.join("opensfm/geocoords_transformation.txt"), |bytes| {
                Georeference::from_text(text_from_bytes(bytes)?)
            })?,
            offset: offset.map(Georeference::offset),
            alignment: optional(
                &dir.join("odm_georeferencing/alignment_matrix.json"),
                Georeference::from_json,
            )?,
            is_projected: dir
                .join("opensfm/reconstruction.topocentric.json")
                .is_file()
                || dir.join("opensfm/exported_geocoords.txt").is_file(),
        })
    }

    /// Takes it as known that `reconstruction.json` is in projected coordinates less the offset.
    pub(super) fn set_projected(&mut self) {
        self.is_projected = true;
    }

    /// Whether the cloud and the centres were moved onto another data set.
    pub(super) fn is_aligned(&self) -> bool {
        self.alignment.is_some()
    }

    /// The map from the frame of `reconstruction.json` to the georeferenced one that takes the first
    /// centre of every pair to the second one; `None` where none does, or there is no pair.
    pub(super) fn world_from_sparse_by_centers(
        &self,
        pairs: &[(DVec3, DVec3)],
    ) -> Option<Georeference> {
        let fits = |map: &Georeference| {
            let near = |&(sparse, world)| map.apply(sparse).distance(world) <= SAME_CENTER;
            !pairs.is_empty() && pairs.iter().all(near)
        };
        [self.transform, self.offset, Some(Georeference::IDENTITY)]
            .into_iter()
            .flatten()
            .map(|map| self.aligned(map))
            .find(fits)
    }

    /// The same map as the files state it.
    pub(super) fn world_from_sparse(&self) -> Option<Georeference> {
        let map = self
            .transform
            .or(self.offset.filter(|_| self.is_projected))?;
        Some(self.aligned(map))
    }

    fn aligned(&self, map: Georeference) -> Georeference {
        self.alignment
            .map_or(map, |alignment| alignment.after(&map))
    }
}

/// What a file holds, or `None` where there is no such file.
pub(super) fn optional<T>(
    path: &Path,
    read: impl FnOnce(&[u8]) -> Result<T, Fault>,
) -> Result<Option<T>, FileError> {
    if !path.is_file() {
        return Ok(None);
    }
    let value = read(&read_bytes(path)?).map_err(|fault| FileError::new(path, fault))?;
    Ok(Some(value))
}

/// An affine map that is nearly a similarity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Georeference {
    linear: DMat3,
    translation: DVec3,
    /// The rotation nearest to `linear`.
    rotation: DMat3,
}

impl Georeference {
    pub(super) const IDENTITY: Self = Self {
        linear: DMat3::IDENTITY,
        translation: DVec3::ZERO,
        rotation: DMat3::IDENTITY,
    };

    /// Adds an offset to x and y.
    fn offset(offset: DVec2) -> Self {
        Self {
            translation: offset.extend(0.0),
            ..Self::IDENTITY
        }
    }

    /// From sixteen numbers, row by row, as text.
    fn from_text(text: &str) -> Result<Self, Fault> {
        let mut m = [0.0; 16];
        let mut words = text.split_whitespace();
        for number in &mut m {
            let word = words.next().unwrap_or_default();
            *number = word.parse().map_err(|_| {
                let what = format!("the 4x4 transform has \"{word}\" where a number is needed");
                Fault::new(what, "run the georeferencing of OpenDroneMap again")
            })?;
        }
        if words.next().is_some() {
            return Err(unusable("it has more than 16 numbers"));
        }
        Self::from_row_major(m)
    }

    /// From nested lists in JSON, row by row.
    fn from_json(json: &[u8]) -> Result<Self, Fault> {
        let rows: [[f64; 4]; 4] = parse(json)?;
        let mut m = [0.0; 16];
        for (number, value) in m.iter_mut().zip(rows.as_flattened()) {
            *number = *value;
        }
        Self::from_row_major(m)
    }

    fn from_row_major(m: [f64; 16]) -> Result<Self, Fault> {
        if m.iter().any(|x| !x.is_finite()) {
            return Err(unusable("a number of it is not finite"));
        }
        let [a, b, c, x, d, e, f, y, g, h, i, z, last @ ..] = m;
        if last != [0.0, 0.0, 0.0, 1.0] {
            return Err(unusable("its last row is not 0 0 0 1"));
        }
        let linear = DMat3::from_cols_array(&[a, d, g, b, e, h, c, f, i]);
        let determinant = linear.determinant();
        if determinant <= 0.0 || !determinant.is_finite() {
            return Err(unusable("it mirrors or flattens"));
        }
        let unscaled = linear * (1.0 / determinant.cbrt());
        let square = unscaled.transpose() * unscaled - DMat3::IDENTITY;
        let deviation = square
            .to_cols_array()
            .into_iter()
            .fold(0.0, |worst: f64, d| worst.max(d.abs()));
        // Squared lengths deviate twice as much as lengths.
        if deviation.is_nan() || deviation > 2.0 * MOST_DEVIATION {
            return Err(unusable("it shears or stretches by more than 1 %"));
        }
        Ok(Self {
            linear,
            translation: DVec3::new(x, y, z),
            rotation: nearest_rotation(unscaled),
        })
    }

    /// First `inner`, then this.
    fn after(&self, inner: &Self) -> Self {
        let linear = self.linear * inner.linear;
        Self {
            linear,
            translation: self.apply(inner.translation),
            rotation: nearest_rotation(linear * (1.0 / linear.determinant().cbrt())),
        }
    }

    pub(super) fn apply(&self, point: DVec3) -> DVec3 {
        self.linear * point + self.translation
    }

    pub(super) fn apply_to_pose(&self, pose: &Pose) -> Pose {
        Pose {
            rotation: self.rotation * pose.rotation,
            center: self.apply(pose.center),
        }
    }
}

fn unusable(why: &str) -> Fault {
    Fault::new(
        format!("the 4x4 transform cannot be used: {why}"),
        "run the georeferencing of OpenDroneMap again",
    )
}

/// The coordinate system and the offset of a `coords.txt`, where it holds them.
fn parse_coords(text: &str) -> (Option<String>, Option<DVec2>) {
    let mut lines = text.lines();
    let crs = lines.next().and_then(crs_from_text);
    let offset = lines.next().and_then(|line| {
        let mut numbers = line.split_whitespace().map(|word| word.parse::<f64>().ok());
        let offset = DVec2::new(numbers.next()??, numbers.next()??);
        (offset.is_finite() && numbers.next().is_none()).then_some(offset)
    });
    (crs, offset)
}

/// "EPSG:n" where the text is that already or says UTM on WGS 84, else the text itself; `None` where
/// it is empty.
pub(crate) fn crs_from_text(text: &str) -> Option<String> {
    let text = text.lines().next()?.trim().trim_matches('\'').trim();
    if text.is_empty() {
        return None;
    }
    if let Some((authority, code)) = text.split_once(':')
        && authority.eq_ignore_ascii_case("epsg")
        && code.trim().parse::<u32>().is_ok()
    {
        return Some(format!("EPSG:{}", code.trim()));
    }
    let zone = utm_of_header(text).or_else(|| utm_of_proj(text));
    Some(match zone {
        Some((zone @ 1..=60, south)) => format!("EPSG:{}{zone:02}", if south { 327 } else { 326 }),
        _ => text.to_owned(),
    })
}

/// Zone and whether it is a southern one, of "WGS84 UTM 15N".
fn utm_of_header(text: &str) -> Option<(u8, bool)> {
    let mut words = text.split_whitespace();
    if (words.next()?, words.next()?) != ("WGS84", "UTM") {
        return None;
    }
    let zone = words.next()?;
    let south = match zone.chars().next_back()? {
        'n' | 'N' => false,
        's' | 'S' => true,
        _ => return None,
    };
    let number = zone.get(..zone.len().checked_sub(1)?)?.parse().ok()?;
    words.next().is_none().then_some((number, south))
}

/// The same of "+proj=utm +zone=15 +datum=WGS84 +units=m +no_defs", if nothing in it says otherwise.
fn utm_of_proj(text: &str) -> Option<(u8, bool)> {
    let (mut utm, mut wgs84, mut zone, mut south) = (false, false, None, false);
    for word in text.split_whitespace() {
        match word.trim_end_matches("=True") {
            "+proj=utm" => utm = true,
            "+datum=WGS84" | "+ellps=WGS84" => wgs84 = true,
            "+south" => south = true,
            "+north"
            | "+units=m"
            | "+no_defs"
            | "+type=crs"
            | "+towgs84=0,0,0"
            | "+towgs84=0,0,0,0,0,0,0" => {}
            other => zone = Some(other.strip_prefix("+zone=")?.parse().ok()?),
        }
    }
    (utm && wgs84).then_some((zone?, south))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utm_has_its_epsg_code() {
        for (text, crs) in [
            ("WGS84 UTM 15N", "EPSG:32615"),
            (" WGS84 UTM 7S \nrest", "EPSG:32707"),
            (
                "+proj=utm +zone=15 +datum=WGS84 +units=m +no_defs +type=crs",
                "EPSG:32615",
            ),
            (
                "'+proj=utm +zone=23 +south +ellps=WGS84 +units=m'",
                "EPSG:32723",
            ),
            (
                "+proj=utm +zone=1 +datum=WGS84 +units=m +no_defs=True +south=True",
                "EPSG:32701",
            ),
            ("epsg:25832", "EPSG:25832"),
            ("WGS84 UTM 61N", "WGS84 UTM 61N"),
            ("WGS84 UTM \u{e9}", "WGS84 UTM \u{e9}"),
            (
                "+proj=utm +zone=15 +datum=WGS84 +units=us-ft",
                "+proj=utm +zone=15 +datum=WGS84 +units=us-ft",
            ),
            (
                "+proj=utm +zone=32 +ellps=GRS80",
                "+proj=utm +zone=32 +ellps=GRS80",
            ),
            ("EPSG:x", "EPSG:x"),
        ] {
            assert_eq!(crs_from_text(text).as_deref(), Some(crs));
        }
        assert_eq!(crs_from_text(""), None);
        assert_eq!(crs_from_text(" \nWGS84 UTM 15N"), None);
    }

    #[test]
    fn the_offset_is_the_second_line() {
        let (crs, offset) = parse_coords("WGS84 UTM 15N\n576684 5188159.5\n1 2 3\n");
        assert_eq!(crs.as_deref(), Some("EPSG:32615"));
        assert_eq!(offset, Some(DVec2::new(576_684.0, 5_188_159.5)));
        for text in [
            "",
            "WGS84 UTM 15N",
            "a\n1",
            "a\n1 x",
            "a\n1 nan",
            "a\n1 2 3",
        ] {
            assert_eq!(parse_coords(text).1, None, "{text}");
        }
    }

    /// A quarter turn with 0.1 % more horizontally: points are stretched, axes only turned.
    #[test]
    fn a_projection_stretches_points_and_turns_axes() {
        let map =
            Georeference::from_text("0 -1.001 0 500000 1.001 0 0 5000000 0 0 1 7 0 0 0 1").unwrap();
        let pose = map.apply_to_pose(&Pose {
            rotation: DMat3::IDENTITY,
            center: DVec3::new(10.0, 20.0, 30.0),
        });
        assert!((pose.center - DVec3::new(499_979.98, 5_000_010.01, 37.0)).length() < 1e-9);
        let turned = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
        assert!(pose.rotation.abs_diff_eq(turned, 1e-15));
    }

    #[test]
    fn maps_follow_one_another() {
        let json = b"[[0, -2, 0, 1], [2, 0, 0, 2], [0, 0, 2, 3], [0, 0, 0, 1]]";
        let outer = Georeference::from_json(json).unwrap();
        let both = outer.after(&Georeference::offset(DVec2::new(10.0, 20.0)));
        assert_eq!(both.apply(DVec3::ZERO), DVec3::new(-39.0, 22.0, 3.0));
        let turned = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
        assert!(both.rotation.abs_diff_eq(turned, 1e-15));
    }

    #[test]
    fn what_is_no_georeference_is_refused() {
        for text in [
            "",
            "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0",
            "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5",
            "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2",
            "1 0 0 nan 0 1 0 0 0 0 1 0 0 0 0 1",
            "1 0 0 x 0 1 0 0 0 0 1 0 0 0 0 1",
            "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
            "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1",
            "1.05 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
            "1 0.05 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
            "1e300 0 0 0 0 1e300 0 0 0 0 1e300 0 0 0 0 1",
        ] {
            assert!(Georeference::from_text(text).is_err(), "{text}");
        }
        assert!(Georeference::from_json(b"[[1, 0, 0, 0]]").is_err());
    }
}
