//! The scale from known distances: alone, in a frame that stays the package's own or is turned level; of what has a place in
//! the world already, or from positions, about the middle of its cameras, so that it stays there. Receivers place a flight to
//! metres and so tell the length of a metre to a percent; a bar on the ground tells it to a tenth of that, and no place.

use glam::{DMat3, DVec3};

use super::marks::{MarkedPoint, mark_error_px};
use super::{
    GeoreferenceRequest, Georeferenced, Known, KnownDistance, KnownEnds, LengthResidual, percent,
};
use crate::control::{Located, ScaleBar};
use crate::fault::Fault;
use crate::formats::Reconstruction;
use crate::geometry::Similarity;
use crate::georeference::{KnownLength, LengthsFit, levelled, scale_of_lengths};
use crate::numbers::TO_95_PERCENT;
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
    let (lengths, found) = fit_lengths(distances, marked)?;
    // A frame whose unit is known has a place, be it the mine's own grid.
    let stays = reconstruction.crs.is_some() || reconstruction.unit.is_some() && !request.level;
    let unit = match reconstruction.unit {
        Some(unit) if stays => unit,
        _ => LengthUnit::Metre,
    };
    let scale = found.scale / unit.metres();
    let middle = match (&request.crs, stays) {
        (_, true) => Some(middle_of(reconstruction)),
        (None, false) => None,
        (Some(crs), false) => {
            return Err(Fault::new(
                format!("distances give a scale, but no place in {crs}"),
                "leave the coordinate system out, or give positions",
            ));
        }
    };
    let similarity = match middle {
        Some(middle) => {
            warnings.push(format!(
                "the known distances make the flight {}; it stays where it is, the middle of its cameras",
                longer(scale)
            ));
            Similarity::new(scale, DMat3::IDENTITY, middle - middle * scale)
        }
        None => {
            let rotation = turned(reconstruction, request.level)?;
            warnings.push(
                if request.level {
                    "the scale is known, not the place: up is across the plane of the reconstruction's points, and north is not known"
                } else {
                    "the scale is known, not the place: the axes stay as the package left them, and z may not be up (the ground can level it: --level, in the window \"Level by the ground\")"
                }
                .to_owned(),
            );
            Similarity::new(scale, rotation, DVec3::ZERO)
        }
    };
    Ok(Georeferenced {
        similarity,
        crs: reconstruction.crs.clone(),
        unit,
        heights: None,
        positions: Vec::new(),
        lengths: fitted(lengths, found.scale),
        rms: None,
        scale_error: found.scale_error,
        scale_interval: found.scale_interval,
        rotation_error_degrees: None,
        errors: StatedErrors::default(),
        warnings,
    })
}

/// The middle of the cameras: what the positions of receivers, which put them there, leave where it is if the length changes.
fn middle_of(reconstruction: &Reconstruction) -> DVec3 {
    let photos = &reconstruction.photos;
    let sum: DVec3 = photos.iter().map(|photo| photo.pose.center).sum();
    sum / photos.len().max(1) as f64
}

/// A frame's turn to level, where that is asked for.
fn turned(reconstruction: &Reconstruction, level: bool) -> Result<DMat3, Fault> {
    if !level {
        return Ok(DMat3::IDENTITY);
    }
    let cameras = reconstruction.photos.iter();
    let cameras: Vec<DVec3> = cameras.map(|photo| photo.pose.center).collect();
    levelled(reconstruction.cloud.points.clone(), &cameras).ok_or_else(|| {
        Fault::new(
            "the reconstruction has no plane of points to level by",
            "leave the axes as they are (no --level), or give positions",
        )
    })
}

/// Gives a model that positions have placed the length of known distances, where they are surer than the positions, about the
/// middle of what it was placed by; `known` are the positions in the order of `result`.
pub(super) fn lengthen(
    result: &mut Georeferenced,
    known: &[Known],
    distances: &[KnownDistance],
    marked: &[MarkedPoint],
) -> Result<(), Fault> {
    let (lengths, found) = fit_lengths(distances, marked)?;
    let by_positions = (result.similarity, result.scale_interval);
    let scale = found.scale / result.unit.metres();
    let ratio = scale / by_positions.0.scale;
    // One distance between points that nobody marked is what somebody says: as sure as a tape is read.
    let distances_sure = found.scale_interval.unwrap_or(LEAST_CONTRADICTION);
    let is_surer = by_positions
        .1
        .is_none_or(|positions| distances_sure <= positions);
    let sure = |interval: Option<f64>| {
        interval.map_or_else(
            || "nobody knows how surely".to_owned(),
            |interval| format!("± {}", percent(interval)),
        )
    };
    let said = format!(
        "the known distances ({}) make it {} than the positions ({})",
        sure(found.scale_interval),
        longer(ratio),
        sure(by_positions.1)
    );
    let room = [found.scale_interval, by_positions.1].map(Option::unwrap_or_default);
    let room = room[0].hypot(room[1]).max(LEAST_OF_TAPE);
    let apart = (ratio - 1.0).abs();
    let nobody_marked = lengths.iter().any(|(_, length)| length.deviation.is_none());
    // Of two that contradict each other the true one is not known: both are within what is stated.
    let both = (apart > room && is_surer && nobody_marked).then(|| {
        (ratio.recip() - 1.0)
            .abs()
            .max(found.scale_interval.unwrap_or_default())
    });
    let contradict = match (apart > room, both) {
        (false, _) => String::new(),
        (true, None) => format!(": {CONTRADICT}"),
        (true, Some(both)) => format!(
            ": {CONTRADICT}; until then lengths are stated to ± {}",
            percent(both)
        ),
    };
    result.warnings.push(match is_surer {
        true => format!("{said}, which place it{contradict}"),
        false => format!("{said}, which are surer and give it its length{contradict}"),
    });
    if is_surer {
        let used = (known.iter().zip(&result.positions)).filter(|(_, position)| position.used);
        let used: Vec<DVec3> = used.map(|(known, _)| known.pair.source).collect();
        let middle = used.iter().sum::<DVec3>() / used.len().max(1) as f64;
        let Similarity { rotation, .. } = by_positions.0;
        let translation = by_positions.0.apply(middle) - rotation * middle * scale;
        result.similarity = Similarity::new(scale, rotation, translation);
        for (known, position) in known.iter().zip(&mut result.positions) {
            position.residual = known.pair.target - result.similarity.apply(known.pair.source);
        }
        let squares = result.positions.iter().filter(|position| position.used);
        let squares: f64 = squares
            .map(|position| position.residual.length_squared())
            .sum();
        result.rms = Some((squares / used.len().max(1) as f64).sqrt());
        result.scale_error = both.map(|both| both / TO_95_PERCENT).or(found.scale_error);
        result.scale_interval = both.or(found.scale_interval);
    }
    result.lengths = fitted(lengths, result.similarity.scale * result.unit.metres());
    Ok(())
}

/// By how much a scale makes lengths longer, in words.
fn longer(scale: f64) -> String {
    let off = scale - 1.0;
    format!(
        "{} {}",
        percent(off.abs()),
        if off < 0.0 { "shorter" } else { "longer" }
    )
}

/// Known distances as they fit at so many metres to a unit of the reconstruction.
fn fitted(lengths: Vec<(String, KnownLength)>, metres: f64) -> Vec<LengthResidual> {
    let lengths = lengths.into_iter().map(|(name, length)| LengthResidual {
        name,
        known: length.known,
        fitted: length.found * metres,
    });
    lengths.collect()
}

/// Known distances with what they are in the reconstruction and what they are called, and the scale that they give.
fn fit_lengths(
    distances: &[KnownDistance],
    marked: &[MarkedPoint],
) -> Result<(Vec<(String, KnownLength)>, LengthsFit), Fault> {
    let lengths = known_lengths(&each_once(distances), marked)?;
    let numbers: Vec<KnownLength> = lengths.iter().map(|(_, length)| *length).collect();
    let mut found = scale_of_lengths(&numbers)?;
    // Few that nobody marked agree by chance better than a tape is read.
    if numbers.iter().any(|length| length.deviation.is_none()) {
        let least = LEAST_CONTRADICTION / (numbers.len() as f64).sqrt();
        found.scale_interval = found.scale_interval.map(|interval| interval.max(least));
        let least = least / TO_95_PERCENT;
        found.scale_error = found.scale_error.map(|error| error.max(least));
    }
    Ok((lengths, found))
}

/// Without those that stand there twice, from either end: one does not check itself.
fn each_once(distances: &[KnownDistance]) -> Vec<KnownDistance> {
    let turned = |ends: &KnownEnds| match ends.clone() {
        KnownEnds::Points(a, b) => KnownEnds::Points(b, a),
        KnownEnds::Names(a, b) => KnownEnds::Names(b, a),
    };
    let mut kept: Vec<KnownDistance> = Vec::new();
    for distance in distances {
        let is_same = |other: &KnownDistance| {
            other.metres == distance.metres
                && (other.ends == distance.ends || other.ends == turned(&distance.ends))
        };
        if !kept.iter().any(is_same) {
            kept.push(distance.clone());
        }
    }
    kept
}

/// Known distances with what they are in the reconstruction, and what they are called.
fn known_lengths(
    distances: &[KnownDistance],
    marked: &[MarkedPoint],
) -> Result<Vec<(String, KnownLength)>, Fault> {
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
    Ok(lengths)
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

/// How long known distances, which are called so, are in the world that surveyed points gave; those that contradict the
/// points are said.
pub(super) fn compare(
    result: &mut Georeferenced,
    (called, known): (&str, &[KnownDistance]),
    marked: &[MarkedPoint],
) -> Result<(), Fault> {
    let metres = result.similarity.scale * result.unit.metres();
    let lengths = known_lengths(known, marked)?;
    for (name, length) in &lengths {
        let fitted = length.found * metres;
        let by_marks = TO_95_PERCENT * length.deviation.unwrap_or_default() / length.found;
        let allowed = by_marks.hypot(result.scale_interval.unwrap_or_default());
        if (length.known / fitted - 1.0).abs() > allowed.max(LEAST_CONTRADICTION) {
            result.warnings.push(format!(
                "the {called} {name} is {:.4} m long by the surveyed points (± {}), and {:.4} m is typed: {CONTRADICT}",
                fitted,
                percent(allowed),
                length.known
            ));
        }
    }
    result.lengths = fitted(lengths, metres);
    Ok(())
}

/// What is said of two lengths that cannot both be right.
const CONTRADICT: &str = "they contradict each other; look whether it was measured between other points, or in another unit";

/// No tape tells more of a length: a millimetre of a metre, and it sags.
const LEAST_OF_TAPE: f64 = 0.001;

/// Tapes and staffs are read to less.
const LEAST_CONTRADICTION: f64 = 0.005;
