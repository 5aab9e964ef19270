//! From the frame of a chunk to the world: `<transform>` of the chunk and of its components, and the
//! coordinate system in `<reference>`.
//!
//! - A `<transform>` is `<rotation>` (9 numbers, row by row), `<translation>`, `<scale>`, each the
//!   identity where it is left out, or in old files 16 numbers, row by row: chunk to world. world =
//!   scale R X + t.
//! - Where `<reference>` is a geographic, projected or compound coordinate system, the world is its
//!   geocentric (ECEF) frame; where it is LOCAL_CS, that local frame, in the unit that it states.
//!   Without a transform the chunk's own frame is all there is, and has no unit.
//! - Since Metashape 1.5 cameras belong to `<components>`, parts of the chunk that were aligned on
//!   their own. Each has its transform; the chunk's is that of the active one. A component without
//!   one is in a frame of its own, so it goes with no other.

use std::collections::HashMap;

use glam::DVec3;
use roxmltree::Node;

use super::xml::{child, children, line, numbers, text};
use crate::camera::Pose;
use crate::fault::Fault;
use crate::geodesy::{Crs, CrsKind, stated_unit_metres};
use crate::geometry::Similarity;
use crate::units::LengthUnit;

/// Semi-major axis in metres and inverse flattening of WGS 84.
const WGS84: [f64; 2] = [6_378_137.0, 298.257_223_563];

/// The coordinate system of a chunk.
#[derive(Debug)]
pub(super) enum Reference {
    /// None, or a local one, with the unit that it states.
    Local { unit: Option<LengthUnit> },
    /// One on the Earth; `understood` is that, or why it is not.
    Earth {
        understood: Result<Box<Crs>, Fault>,
        /// The ellipsoid of another datum than WGS 84, to which "ECEF" belongs.
        other_ellipsoid: Option<String>,
    },
}

impl Reference {
    /// Of the text in `<reference>`: WKT.
    pub(super) fn of_chunk(chunk: Node<'_, '_>) -> Self {
        let wkt = child(chunk, "reference").map_or("", text);
        let keyword = wkt.split(['[', '(']).next().unwrap_or_default().trim();
        let keyword = keyword.to_ascii_uppercase();
        let compound_of_local = keyword == "COMPD_CS" && wkt.contains("LOCAL_CS[");
        let local = ["", "LOCAL_CS", "ENGCRS", "ENGINEERINGCRS"];
        if local.contains(&keyword.as_str()) || compound_of_local {
            let unit = stated_unit_metres(wkt).and_then(LengthUnit::of_metres);
            return Self::Local { unit };
        }
        Self::Earth {
            understood: Crs::understand(wkt).map(Box::new),
            other_ellipsoid: other_ellipsoid(wkt),
        }
    }

    /// The map projection that the engineer chose, for a target to bring the photos to.
    pub(super) fn projected(&self) -> Option<&str> {
        let crs = self.understood()?;
        (crs.kind() == CrsKind::Projected).then(|| crs.name())
    }

    /// The coordinate system, where there is one and it is understood.
    pub(super) fn understood(&self) -> Option<&Crs> {
        match self {
            Self::Earth { understood, .. } => understood.as_deref().ok(),
            Self::Local { .. } => None,
        }
    }

    /// What is to say of a world that is geocentric.
    pub(super) fn warnings(&self) -> Vec<String> {
        let Self::Earth {
            understood,
            other_ellipsoid,
        } = self
        else {
            return Vec::new();
        };
        let not_understood = understood.as_ref().err().map(|fault| {
            format!("its coordinate system is not understood ({}); the photos are in its geocentric frame", fault.what)
        });
        let on_other = other_ellipsoid.as_ref().map(|name| {
            format!("its geocentric frame is on the ellipsoid {name}, not WGS 84: as ECEF it may be off by hundreds of metres")
        });
        not_understood.into_iter().chain(on_other).collect()
    }
}

/// The name of the ellipsoid of a WKT, where it is not that of WGS 84.
fn other_ellipsoid(wkt: &str) -> Option<String> {
    let start = wkt.find("SPHEROID[").or_else(|| wkt.find("ELLIPSOID["))?;
    let mut parts = wkt.get(start..)?.split('[').nth(1)?.split(',');
    let name = parts.next()?.trim().trim_matches('"');
    let mut number = || parts.next()?.trim_matches([' ', ']']).parse::<f64>().ok();
    let [axis, flattening] = [number()?, number()?];
    // GRS 80 and WGS 84 differ by 0.1 mm at the poles.
    let same = (axis - WGS84[0]).abs() < 1e-3 && (flattening - WGS84[1]).abs() < 1e-4;
    (!same).then(|| name.to_owned())
}

/// Where the parts of a chunk lie in the world.
#[derive(Debug, Default)]
pub(super) struct Placing<'a> {
    /// Of cameras that name no component.
    chunk: Option<Similarity>,
    /// By id; `None` for a component in a frame of its own.
    components: HashMap<&'a str, Option<Similarity>>,
    /// The id of the component that `chunk` belongs to.
    active: Option<&'a str>,
}

impl<'a> Placing<'a> {
    /// Reads the transforms of a chunk.
    ///
    /// # Errors
    /// Where one is no similarity.
    pub(super) fn of_chunk(chunk: Node<'a, '_>) -> Result<Self, Fault> {
        let mut placing = Self {
            chunk: similarity_of(chunk)?,
            ..Self::default()
        };
        let Some(list) = child(chunk, "components") else {
            return Ok(placing);
        };
        for component in children(list, "component") {
            let id = component.attribute("id").unwrap_or_default();
            placing.components.insert(id, similarity_of(component)?);
        }
        placing.active = list.attribute("active_id");
        let active = match placing.components.len() {
            1 => placing.components.values_mut().next(),
            _ => placing.active.and_then(|id| placing.components.get_mut(id)),
        };
        match active {
            Some(active) if active.is_none() => *active = placing.chunk,
            Some(active) => placing.chunk = placing.chunk.or(*active),
            None => {}
        }
        Ok(placing)
    }

    /// Which of the components' photos share the frame that is read, given how many photos each
    /// component has: all that have a transform, or else one alone.
    pub(super) fn kept<'c>(&self, counts: &HashMap<Option<&'c str>, usize>) -> Kept<'c> {
        if counts.keys().any(|&component| self.of(component).is_some()) {
            return Kept::Placed;
        }
        let active = self.active;
        let best = counts.iter().max_by_key(|&(&component, &count)| {
            // The active one wins; between equals the first id, so that the answer is always one.
            (
                component.is_some() && component == active,
                count,
                std::cmp::Reverse(component),
            )
        });
        Kept::Alone(best.and_then(|(component, _)| *component))
    }

    /// The transform of a camera of this component.
    pub(super) fn of(&self, component: Option<&str>) -> Option<Similarity> {
        let listed = component.and_then(|id| self.components.get(id));
        listed.map_or(self.chunk, |similarity| *similarity)
    }
}

/// Which components are read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kept<'a> {
    /// Those with a transform.
    Placed,
    /// This one, in its own frame.
    Alone(Option<&'a str>),
}

/// The `<transform>` of a chunk or component.
fn similarity_of(parent: Node<'_, '_>) -> Result<Option<Similarity>, Fault> {
    let Some(transform) = child(parent, "transform") else {
        return Ok(None);
    };
    let has_parts = transform.children().any(|child| child.is_element());
    if !has_parts && text(transform).is_empty() {
        return Ok(None);
    }
    let matrix = if has_parts {
        let r: [f64; 9] = child(transform, "rotation")
            .map_or(Ok([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]), numbers)?;
        let [x, y, z] = child(transform, "translation").map_or(Ok([0.0; 3]), numbers)?;
        let [s] = child(transform, "scale").map_or(Ok([1.0]), numbers)?;
        let r = r.map(|number| number * s);
        [
            r[0], r[1], r[2], x, r[3], r[4], r[5], y, r[6], r[7], r[8], z, 0.0, 0.0, 0.0, 1.0,
        ]
    } else {
        numbers::<16>(transform)?
    };
    let similarity = Similarity::from_row_major(&matrix)
        .map_err(|error| Fault::at(line(transform), error.to_string(), super::xml::EXPORT))?;
    Ok(Some(similarity))
}

/// The pose of a camera's `<transform>`: 16 numbers, row by row, camera (x right, y down, z forward)
/// to chunk.
pub(super) fn pose_of(transform: Node<'_, '_>) -> Result<Pose, Fault> {
    let at = |what: String| Fault::at(line(transform), what, super::xml::EXPORT);
    let [a, b, c, x, d, e, f, y, g, h, i, z, last @ ..] = numbers::<16>(transform)?;
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err(at(
            "the last row of a camera's transform is not 0 0 0 1".into()
        ));
    }
    Pose::from_row_major(DVec3::new(x, y, z), [a, b, c, d, e, f, g, h, i])
        .map_err(|error| at(format!("a camera's transform: {error}")))
}

/// A pose seen from another frame.
pub(super) fn moved(similarity: &Similarity, pose: &Pose) -> Pose {
    Pose {
        rotation: similarity.rotation * pose.rotation,
        center: similarity.apply(pose.center),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packages::metashape::xml::parse;

    fn reference(wkt: &str) -> Reference {
        let wkt = wkt.replace('"', "&quot;");
        let text = format!("<chunk><reference>\n{wkt} </reference></chunk>");
        Reference::of_chunk(parse(&text).unwrap().root_element())
    }

    #[test]
    fn coordinate_systems_are_told_apart() {
        let geographic = r#"GEOGCS["WGS 84",DATUM["World Geodetic System 1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0],UNIT["degree",0.01745329251994328],AUTHORITY["EPSG","4326"]]"#;
        let kind = |wkt: &str| reference(wkt).understood().map(Crs::kind);
        assert_eq!(kind(geographic), Some(CrsKind::Geographic));
        assert_eq!(reference(geographic).projected(), None);
        assert!(reference(geographic).warnings().is_empty());
        let projected = format!(
            r#"PROJCS["WGS 84 / UTM zone 15N",{geographic},PROJECTION["Transverse_Mercator",AUTHORITY["EPSG","9807"]],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",-93],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],AUTHORITY["EPSG","32615"]]"#
        );
        assert_eq!(reference(&projected).projected(), Some("EPSG:32615"));
        let nowhere = r#"PROJCS["mine grid",GEOGCS["g",DATUM["d",SPHEROID["s",6377397.155,299.1528128]]],PROJECTION["Mine_Grid"],UNIT["metre",1]]"#;
        let warnings = reference(nowhere).warnings();
        assert!(warnings[0].contains("not understood"), "{warnings:?}");
        let bessel = geographic.replace("6378137,298.257223563", "6377397.155,299.1528128");
        assert!(
            reference(&bessel)
                .warnings()
                .iter()
                .any(|w| w.contains("ellipsoid WGS 84, not"))
        );
        let grs80 = geographic.replace("298.257223563", "298.257222101");
        assert!(reference(&grs80).warnings().is_empty());
        let local =
            r#"LOCAL_CS["Local Coordinates (m)",LOCAL_DATUM["Local Datum",0],UNIT["metre",1]]"#;
        for (text, stated) in [
            ("", None),
            (local, Some(LengthUnit::Metre)),
            (
                &local.replace("\"metre\",1", "\"foot\",0.3048"),
                Some(LengthUnit::Foot),
            ),
            (r#"LOCAL_CS["a",LOCAL_DATUM["b",0]]"#, None),
        ] {
            assert!(matches!(reference(text), Reference::Local { unit } if unit == stated));
        }
        for broken in [
            "PROJCS",
            "PROJCS[",
            "SPHEROID[",
            "GEOGCS[]]],",
            "COMPD_CS[\"é",
        ] {
            assert!(!reference(broken).warnings().is_empty(), "{broken}");
        }
    }
}
