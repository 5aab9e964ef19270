//! `report.html` of a model: what `exports` writes, gathered.

use super::flight_files::{found_focal, stated};
use crate::Reconstructed;
use crate::exports::{
    OffReceiver, ReconstructionReport, SeenPoint, SolvedCamera, SolvedPhoto, reconstruction_report,
};
use crate::formats::Reconstruction;
use crate::opening::PositionResidual;
use crate::opening::covariance::Deviations;
use crate::photo_set::PhotoSet;
use crate::said::facts;

/// What a report is of.
pub(crate) struct ReportOf<'a> {
    /// The flight's name.
    pub(crate) name: &'a str,
    /// Name and version of the engine.
    pub(crate) engine: &'a str,
    pub(crate) made: &'a Reconstructed,
    /// In the world, if it has one.
    pub(crate) model: &'a Reconstruction,
    pub(crate) photos: &'a PhotoSet,
    pub(crate) sure: Option<&'a Deviations>,
}

/// As HTML.
pub(crate) fn report(of: &ReportOf<'_>) -> String {
    let (made, model) = (of.made, of.model);
    let shown = Shown::of(model);
    let photos = model.photos.iter().zip(&shown.photos).enumerate();
    let photos = photos.map(|(number, (photo, its))| {
        let residuals = made.world.iter().flat_map(|world| &world.positions);
        let residual = { residuals }.find(|residual| residual.name == photo.name);
        SolvedPhoto {
            name: &photo.name,
            camera: photo.camera,
            center: photo.pose.center.truncate(),
            points: its.points,
            reprojection_px: (its.points > 0).then(|| (its.squares / its.points as f64).sqrt()),
            off_receiver: residual.map(|&PositionResidual { residual, used, .. }| OffReceiver {
                off: -residual,
                used,
            }),
            deviation: of.sure.map(|sure| {
                let stated = stated(sure, number);
                (stated.position, stated.angle)
            }),
        }
    });
    let cameras = model.cameras.iter().enumerate().map(|(number, camera)| {
        let expected = of.photos.camera_of(model, number);
        let focal = of
            .sure
            .and_then(|sure| found_focal(&sure.focal, expected, number));
        SolvedCamera {
            camera,
            focal_percent: focal.map(|focal| focal * 100.0),
            stated_focal: expected.and_then(|its| its.focal_error.map(|_| its.camera.fx)),
        }
    });
    let points = model.cloud.points.iter().zip(shown.by);
    reconstruction_report(&ReconstructionReport {
        name: of.name,
        engine: of.engine,
        facts: facts(made),
        warnings: made.warnings.clone(),
        unit: made.world.as_ref().map(|world| world.unit),
        cameras: cameras.collect(),
        photos: photos.collect(),
        left_out: (made.left_out.iter())
            .map(|left| [left.photo.as_str(), left.why.as_str()])
            .collect(),
        points: points
            .map(|(&point, photos)| SeenPoint { point, photos })
            .collect::<Vec<_>>(),
    })
}

/// Who shows what.
struct Shown {
    photos: Vec<Shows>,
    /// By how many photos each point is shown.
    by: Vec<usize>,
}

/// What a photo shows.
#[derive(Clone, Default)]
struct Shows {
    points: usize,
    /// Of how far they lie from where it shows them, pixels.
    squares: f64,
}

impl Shown {
    fn of(model: &Reconstruction) -> Self {
        let mut shown = Self {
            photos: vec![Shows::default(); model.photos.len()],
            by: vec![0; model.cloud.points.len()],
        };
        for seen in &model.observations {
            let photo = shown.photos.get_mut(seen.photo as usize);
            let by = shown.by.get_mut(seen.point as usize);
            if let (Some(photo), Some(by), Some(px)) = (photo, by, model.reprojection_px(seen)) {
                photo.points += 1;
                photo.squares += px * px;
                *by += 1;
            }
        }
        shown
    }
}
