//! Positions that are known in both frames, and the fit to them.

mod exchanged;

use super::list_world::ListWorld;
use super::marks::MarkedPoint;
use super::photo_names::PhotoNames;
use super::{Georeferenced, KnownKind, PositionResidual};
use crate::fault::{Fault, first_names};
use crate::formats::Reconstruction;
use crate::formats::poses::position_list::PositionList;
use crate::georeference::{Pair, fit};
use crate::scale::StatedErrors;
use crate::units::LengthUnit;

pub(super) use self::exchanged::exchanged;

/// A position that is known in both frames.
pub(super) struct Known {
    pub(super) name: String,
    pub(super) kind: KnownKind,
    pub(super) pair: Pair,
    pub(super) marks_px: Option<f64>,
}

impl Known {
    /// `None` of a point that nobody has surveyed.
    pub(super) fn of_point(point: &MarkedPoint, world: &ListWorld) -> Result<Option<Self>, Fault> {
        let Some(position) = point.position else {
            return Ok(None);
        };
        Ok(Some(Self {
            name: point.name.clone(),
            kind: KnownKind::ControlPoint,
            pair: Pair {
                source: point.found.point,
                target: world.of(position)?,
                accuracy: None,
            },
            marks_px: Some(point.found.rms_px()),
        }))
    }
}

/// The listed positions of photos that are in the reconstruction.
pub(super) fn of_photos(
    reconstruction: &Reconstruction,
    list: &PositionList,
    world: &ListWorld,
    warnings: &mut Vec<String>,
) -> Result<Vec<Known>, Fault> {
    let named: Vec<&str> = list.positions.iter().map(|p| p.name.as_str()).collect();
    let names = PhotoNames::new(
        reconstruction.photos.iter().map(|p| p.name.as_str()),
        &named,
    );
    let mut taken = vec![false; reconstruction.photos.len()];
    let mut known = Vec::new();
    for position in &list.positions {
        let Some(index) = names.find(&position.name) else {
            continue;
        };
        let Some(photo) = reconstruction.photos.get(index) else {
            continue;
        };
        if std::mem::replace(&mut taken[index], true) {
            return Err(Fault::new(
                format!("photo '{}' has two positions in the list", photo.name),
                "keep one",
            ));
        }
        known.push(Known {
            name: photo.name.clone(),
            kind: KnownKind::Photo,
            pair: Pair {
                source: photo.pose.center,
                target: world.of(position.position)?,
                accuracy: (position.accuracy)
                    .map(|a| Pair::accuracy_of(a) / world.unit().metres())
                    .filter(|a| *a > 0.0),
            },
            marks_px: None,
        });
    }
    let photos = reconstruction.photos.len();
    if known.is_empty() {
        let first = |name: Option<&str>| name.unwrap_or_default().to_owned();
        return Err(Fault::new(
            format!(
                "none of its names is one of the reconstruction's photos: '{}' there, '{}' here",
                first(reconstruction.photos.first().map(|p| p.name.as_str())),
                first(named.first().copied()),
            ),
            "give the positions of these photos",
        ));
    }
    if known.len() < photos {
        let without = (reconstruction.photos.iter().zip(&taken)).filter(|(_, taken)| !**taken);
        let without: Vec<&str> = without.map(|(photo, _)| photo.name.as_str()).collect();
        warnings.push(format!(
            "{} of {photos} photos have a known position; without: {}",
            known.len(),
            first_names(&without)
        ));
    }
    warnings.extend(names.warning);
    Ok(known)
}

/// Fits to the control points alone where they decide, else to all.
pub(super) fn by_positions(known: &[Known], points_decide: bool) -> Result<Georeferenced, Fault> {
    let decides = |known: &&Known| !points_decide || known.kind == KnownKind::ControlPoint;
    let deciding: Vec<&Known> = known.iter().filter(decides).collect();
    let pairs: Vec<Pair> = deciding.iter().map(|known| known.pair).collect();
    let found = fit(&pairs).map_err(|fault| match exchanged(&deciding) {
        Some([one, other]) => Fault {
            remedy: format!(
                "exchange the coordinates of '{one}' and '{other}', with which they fit"
            ),
            ..fault
        },
        None => fault,
    })?;
    let mut used = found.used.iter();
    let positions = known
        .iter()
        .map(|known| PositionResidual {
            name: known.name.clone(),
            kind: known.kind,
            residual: known.pair.target - found.similarity.apply(known.pair.source),
            used: decides(&known) && used.next().copied().unwrap_or_default(),
            marks_px: known.marks_px,
        })
        .collect();
    Ok(Georeferenced {
        similarity: found.similarity,
        crs: None,
        unit: LengthUnit::Metre,
        heights: None,
        positions,
        lengths: Vec::new(),
        rms: Some(found.rms),
        scale_error: Some(found.scale_error),
        scale_interval: Some(found.scale_interval),
        rotation_error_degrees: Some(found.rotation_error.to_degrees()),
        errors: StatedErrors::default(),
        warnings: Vec::new(),
    })
}
