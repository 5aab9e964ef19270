//! The scale alone, from known distances, in a frame that stays the package's own or is turned level.

use glam::{DMat3, DVec3};

use super::marks::{MarkedPoint, mark_error_px};
use super::{GeoreferenceRequest, Georeferenced, KnownDistance, KnownEnds, LengthResidual};
use crate::control::{Located, ScaleBar};
use crate::fault::Fault;
use crate::formats::Reconstruction;
use crate::geometry::Similarity;
use crate::georeference::{KnownLength, levelled, scale_of_lengths};
use crate::scale::StatedErrors;
use crate::units::LengthUnit;

/// Fits the scale to `distances`; `warnings` are what was said before.
pub(super) fn by_distances(
    reconstruction: &Reconstruction,
    request: &GeoreferenceRequest,
    distances: &[KnownDistance],
    marked: &[MarkedPoint],
    mut warnings: Vec<String>,
) -> Result<Georeferenced, Fault> {
    if let Some(crs) = &request.crs {
        return Err(Fault::new(
            format!("distances give a scale, but no place in {crs}"),
            "leave the coordinate system out, or give positions",
        ));
    }
    let point = |name: &String| {
        let found = marked.iter().find(|point| point.name == *name);
        found.map(|point| &point.found).ok_or_else(|| {
            Fault::new(
                format!("there is no triangulated control point '{name}' for a known distance"),
                "give its marks in two photos (--gcp), or the point as x,y,z",
            )
        })
    };
    let pixel = mark_error_px(marked);
    let mut lengths = Vec::new();
    for distance in distances {
        let known = distance.metres;
        lengths.push(match &distance.ends {
            KnownEnds::Points(a, b) => {
                let shown = |p: &DVec3| format!("{},{},{}", p.x, p.y, p.z);
                let length = KnownLength {
                    found: a.distance(*b),
                    deviation: None,
                    known,
                };
                (format!("{} to {}", shown(a), shown(b)), length)
            }
            KnownEnds::Names(a, b) => (
                format!("{a} to {b}"),
                between(point(a)?, point(b)?, pixel, known),
            ),
        });
    }
    let numbers: Vec<KnownLength> = lengths.iter().map(|(_, length)| *length).collect();
    let found = scale_of_lengths(&numbers)?;
    let rotation = match request.level {
        true => {
            let cameras = reconstruction.photos.iter();
            let cameras: Vec<DVec3> = cameras.map(|photo| photo.pose.center).collect();
            levelled(reconstruction.cloud.points.clone(), &cameras).ok_or_else(|| {
                Fault::new(
                    "the reconstruction has no plane of points to level by",
                    "leave the axes as they are (no --level), or give positions",
                )
            })?
        }
        false => DMat3::IDENTITY,
    };
    warnings.push(
        if request.level {
            "the scale is known, not the place: up is across the plane of the reconstruction's points, and north is not known"
        } else {
            "the scale is known, not the place: the axes stay as the package left them, and z may not be up (the ground can level it: --level, in the window \"Level by the ground\")"
        }
        .to_owned(),
    );
    Ok(Georeferenced {
        similarity: Similarity::new(found.scale, rotation, DVec3::ZERO),
        crs: None,
        unit: LengthUnit::Metre,
        heights: None,
        positions: Vec::new(),
        lengths: (lengths.into_iter())
            .map(|(name, length)| LengthResidual {
                name,
                known: length.known,
                fitted: length.found * found.scale,
            })
            .collect(),
        rms: None,
        scale_error: found.scale_error,
        scale_interval: found.scale_interval,
        rotation_error_degrees: None,
        errors: StatedErrors::default(),
        warnings,
    })
}

/// A known distance between two points that are marked, `pixel` off in photos.
fn between(a: &Located, b: &Located, pixel: f64, known: f64) -> KnownLength {
    let apart = b.point - a.point;
    let along = apart.normalize_or_zero();
    let variance = along.dot((a.covariance + b.covariance) * along);
    KnownLength {
        found: apart.length(),
        deviation: Some(pixel * variance.max(0.0).sqrt()),
        known,
    }
}

/// The scale bars whose two ends were found, as known distances; the others are said in `warnings`.
pub(super) fn of_bars(
    bars: &[ScaleBar],
    marked: &[MarkedPoint],
    warnings: &mut Vec<String>,
) -> Vec<KnownDistance> {
    let is_found = |name: &String| marked.iter().any(|point| point.name == *name);
    let mut known = Vec::new();
    for bar in bars {
        let [from, to] = &bar.ends;
        match bar.ends.iter().find(|end| !is_found(end)) {
            None if !bar.is_known() => warnings.push(format!(
                "the scale bar from '{from}' to '{to}' is left out: nobody has said how long it is"
            )),
            None => known.push(KnownDistance {
                ends: KnownEnds::Names(from.clone(), to.clone()),
                metres: bar.metres(),
            }),
            Some(end) => warnings.push(format!(
                "the scale bar from '{from}' to '{to}' is left out: '{end}' is not marked in two photos"
            )),
        }
    }
    known
}

/// How long scale bars are in a fitted world, `metres` to a unit of the reconstruction.
pub(super) fn compared(
    bars: &[KnownDistance],
    marked: &[MarkedPoint],
    metres: f64,
) -> Vec<LengthResidual> {
    let point = |name: &String| {
        let found = marked.iter().find(|point| point.name == *name);
        found.map(|point| point.found.point)
    };
    let compared = bars.iter().filter_map(|bar| {
        let KnownEnds::Names(from, to) = &bar.ends else {
            return None;
        };
        Some(LengthResidual {
            name: format!("{from} to {to}"),
            known: bar.metres,
            fitted: point(from)?.distance(point(to)?) * metres,
        })
    });
    compared.collect()
}
