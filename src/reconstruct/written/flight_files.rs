//! What an engineer opens, and other programs read: `poses.csv` with standard deviations, `pile.laz` in the
//! world's coordinate system (`pile.ply` where LAS has no name for it), and the `flight.toml` of both.

use std::borrow::Cow;

use crate::camera::Camera;
use crate::dense_cloud::DenseCloud;
use crate::exports::{PoseRow, StatedDeviations, laz, ply, poses_csv};
use crate::fault::Fault;
use crate::flight::{FlightFile, FlightSettings, PosesFlight};
use crate::formats::Reconstruction;
use crate::jobs::Progress;
use crate::numbers::{four_digits, stated_percent};
use crate::opening::Georeferenced;
use crate::opening::covariance::{Deviations, Known, deviations};
use crate::photo_set::{PhotoSet, SurveyCamera};
use crate::surface::Cloud;

/// The files, by name, `flight.toml` the last.
pub(crate) struct FlightFiles {
    pub(crate) files: Vec<(&'static str, Vec<u8>)>,
    /// What is to be said, one sentence each.
    pub(crate) warnings: Vec<String>,
    /// The model in the world.
    pub(crate) model: Reconstruction,
    /// How sure its poses and lenses are.
    pub(crate) sure: Option<Deviations>,
}

/// What clouds say that they come from.
pub(crate) const SOURCE: &str = "fragscale reconstruct";

/// What a flight is of.
pub(crate) struct FlightOf<'a> {
    pub(crate) name: &'a str,
    /// The photos', from flight.toml.
    pub(crate) folder: &'a str,
    /// The model's way to the world.
    pub(crate) placed: &'a Georeferenced,
    pub(crate) photos: &'a PhotoSet,
}

/// Of a model in its own frame, and its dense cloud if there is one.
///
/// # Errors
/// Where a number is not finite, or where it is cancelled.
pub(crate) fn flight_files(
    of: &FlightOf<'_>,
    mut model: Reconstruction,
    dense: Option<DenseCloud>,
    progress: &Progress,
) -> Result<FlightFiles, Fault> {
    let FlightOf {
        name,
        folder,
        placed,
        photos,
    } = *of;
    let report = |error: String| Fault::new(error, "report this");
    model.transform(&placed.similarity);
    let lens = |(number, camera): (usize, &Camera)| match photos.camera_of(&model, number) {
        Some(known) => known.expected().1,
        None => [camera.fx; 8],
    };
    let known = Known {
        centers: (model.photos.iter())
            .map(|photo| photos.named(&photo.name)?.place?.deviation)
            .collect(),
        lenses: model.cameras.iter().enumerate().map(lens).collect(),
    };
    let sure = deviations(&model, &known, progress)?;
    let mut warnings = Vec::new();
    if sure.is_none() {
        warnings.push(
            "it is not known how sure the poses are: too many photos, or nothing that several see"
                .to_owned(),
        );
    }
    warnings.extend(photos.said_of_lenses(&model));
    let rows: Vec<PoseRow> = (model.photos.iter().enumerate())
        .map(|(number, photo)| PoseRow {
            camera: (model.cameras.len() > 1).then(|| model.cameras[photo.camera].name.clone()),
            stated: sure.as_ref().map(|sure| stated(sure, number)),
            ..PoseRow::of_pose(&photo.name, &photo.pose)
        })
        .collect();
    let poses = poses_csv(&rows).map_err(report)?;
    let mut of_surface = None;
    let cloud = match dense {
        None => Cow::Borrowed(&model.cloud),
        Some(DenseCloud {
            mut cloud,
            deviation,
        }) => {
            for point in &mut cloud.points {
                *point = placed.similarity.apply(*point);
            }
            of_surface = Some(deviation * placed.similarity.scale);
            Cow::Owned(cloud)
        }
    };
    let (surface, cloud) = surface(&cloud, placed).map_err(report)?;
    let flight = PosesFlight {
        name,
        poses: "poses.csv",
        cameras: &model.cameras,
        folder: Some(folder),
        surface,
        crs: placed.crs.as_deref(),
    };
    let mut settings = FlightSettings {
        unit: placed.unit,
        unit_known: true,
        ..FlightSettings::default()
    };
    settings.errors.world_scale = placed.stated_world_scale();
    let focal = sure.as_ref().and_then(|sure| {
        let cameras = 0..model.cameras.len();
        let found = cameras.filter_map(|camera| {
            found_focal(
                &sure.focal_in_scales,
                photos.camera_of(&model, camera),
                camera,
            )
        });
        found.reduce(f64::max)
    });
    settings.errors.focal = focal.map(stated_percent);
    settings.errors.surface = of_surface.map(four_digits);
    let text = FlightFile::for_poses(&flight, &settings).to_toml()?;
    Ok(FlightFiles {
        files: vec![
            (surface, cloud),
            ("poses.csv", poses.into_bytes()),
            ("flight.toml", text.into_bytes()),
        ],
        warnings,
        model,
        sure,
    })
}

/// Of a photo; rotations about the three axes go by their root mean square.
pub(crate) fn stated(sure: &Deviations, photo: usize) -> StatedDeviations {
    let (position, turn) = sure.poses[photo];
    StatedDeviations {
        position,
        angle: (turn.length_squared() / 3.0).sqrt().to_degrees(),
    }
}

/// Of the standard deviations of cameras' focal lengths that of this camera; `expected` is what was known of it
/// before. `None` for a given calibration, which is not found: how sure it is, is for whoever gave it to say.
pub(crate) fn found_focal(
    deviations: &[f64],
    expected: Option<&SurveyCamera>,
    camera: usize,
) -> Option<f64> {
    expected.filter(|expected| !expected.is_given)?;
    deviations.get(camera).copied()
}

fn surface(cloud: &Cloud, placed: &Georeferenced) -> Result<(&'static str, Vec<u8>), String> {
    let epsg = placed
        .crs
        .as_deref()
        .and_then(|crs| crs.strip_prefix("EPSG:"));
    let epsg = epsg.and_then(|code| code.parse().ok());
    match epsg.map(|epsg| laz(cloud, epsg, SOURCE)) {
        Some(Ok(bytes)) => Ok(("pile.laz", bytes)),
        _ => Ok(("pile.ply", ply(cloud, SOURCE)?)),
    }
}
