//! The dense cloud of a model: its photos without their lenses, their depths (`dense`), and what several of
//! them agree on.
//!
//! - Each photo is looked at between the depths of the points that the model has in it: from the 1st to the 99th
//!   percentile of them, and [`WIDER`] times farther both ways. What lies beyond has no depth.
//! - Depths are kept in `unfinished/depths`, photo by photo, so that an interrupted run goes on; in memory lie
//!   the grey levels of all photos (1.3 bytes a pixel of the depth maps) and a gigabyte of depth maps.
//! - How sure its points are is one number (`Fused::deviation`): the root mean square, for the intervals of
//!   scales draw one error of one width at every corner, and the variance is what adds up. It is what matching
//!   leaves, and what errs alike in all photos ([`ALIKE`]); poses and lens are counted apart.
//! - Last it is held against the sparse cloud (`held_dense`).

use std::fs;
use std::path::{Path, PathBuf};

use image::RgbImage;

use crate::camera::{Camera, Distortion};
use crate::card::CardFirst;
use crate::dense::{
    DenseOptions, InFolder, Photos, Shelf, View, choose_neighbours, depth_maps, fuse,
};
use crate::engine::Workplace;
use crate::fault::{Fault, first_names};
use crate::formats::{Reconstruction, read_bytes};
use crate::held_dense::held;
use crate::jobs::Progress;
use crate::photo_set::PhotoSet;
use crate::picture;
use crate::surface::Cloud;

/// Points of the model in a photo at least, or nobody knows where to look for its depths.
const FEWEST: usize = 20;
/// How much farther than the model's points depths are looked for.
const WIDER: f64 = 1.25;
/// Standard deviation in pixels of the depth maps of what errs alike in all depths of a place, so that how far
/// they are apart says nothing of it: photos are undistorted to 0.05 pixels, read bilinearly between pixels, and
/// matched in windows that are taken as planes. Measured on rendered photos of a known surface (`tests.rs`).
const ALIKE: f64 = 0.05;
/// The folder in the unfinished work, and what its depths are of.
const KEPT: &str = "depths";
const OF: &str = "of.txt";

/// A dense cloud in the frame of its model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DenseCloud {
    pub(crate) cloud: Cloud,
    /// Standard deviation of its points along the rays that see them, units of the model.
    pub(crate) deviation: f64,
}

/// The dense cloud, and what is to be said of it, one sentence each. `None` where the photos have no depths
/// that agree: the sentences say why. `goes_on` is whether depths that were kept are of this model.
///
/// # Errors
/// Where a photo cannot be read, depths cannot be kept, or the work was cancelled.
pub(crate) fn dense_cloud(
    model: &Reconstruction,
    photos: &PhotoSet,
    options: &DenseOptions,
    at: &Workplace,
    goes_on: bool,
    progress: &Progress,
) -> Result<(Option<DenseCloud>, Vec<String>), Fault> {
    progress.stage("choosing photos to compare for their depths");
    let seen = seen(model, photos);
    let views: Vec<View> = seen.iter().map(|seen| seen.view.clone()).collect();
    let neighbours = choose_neighbours(&views, options.neighbours);
    let mut warnings = Vec::new();
    let sparse = "the cloud is the sparse one";
    if neighbours.iter().all(Vec::is_empty) {
        warnings.push(format!(
            "{sparse}: no photo shows what another one shows from an angle that serves for depths, 3 to 30 \
             degrees; take photos that overlap, from places apart"
        ));
        return Ok((None, warnings));
    }
    let has_none = |name: &String| {
        let its = seen.iter().position(|seen| seen.name == *name);
        its.is_none_or(|view| neighbours[view].is_empty())
    };
    let without: Vec<String> = (model.photos.iter().map(|photo| photo.name.clone()))
        .filter(has_none)
        .collect();
    if !without.is_empty() {
        warnings.push(format!(
            "{} of {} photos have no depths of their own: no other one shows the same from an angle of 3 to 30 \
             degrees ({})",
            without.len(),
            model.photos.len(),
            first_names(&without)
        ));
    }
    let shelf = shelf(at.folder, options, goes_on)?;
    let undistorted = Undistorted(&seen);
    let maps = depth_maps(
        &views,
        &undistorted,
        &neighbours,
        options,
        &CardFirst::new(at.card),
        &shelf,
        progress,
    )?;
    let fused = fuse(&maps, &undistorted, progress)?;
    // Photos of even surfaces agree by chance here and there.
    if fused.points.len() <= model.cloud.points.len() {
        warnings.push(format!(
            "{sparse}: hardly a place has the same depth in three photos; take sharp photos that overlap more"
        ));
        return Ok((None, warnings));
    }
    // It grows with the noise, both in pixels; of matching that is exact to the bit nothing is known.
    let noise = fused.noise_pixels.max(1e-6);
    let deviation = fused.deviation().unwrap_or(0.0) / noise * noise.hypot(ALIKE);
    let cloud = Cloud {
        points: fused.points,
        colors: fused.colors,
        triangles: Vec::new(),
    };
    progress.stage("holding the dense cloud against the sparse one");
    let cloud = held(cloud, &model.cloud, progress)?;
    Ok((Some(DenseCloud { cloud, deviation }), warnings))
}

/// A photo of the model that depths can be found for.
struct Seen {
    name: String,
    path: PathBuf,
    /// With its lens.
    camera: Camera,
    view: View,
}

fn seen(model: &Reconstruction, photos: &PhotoSet) -> Vec<Seen> {
    let mut depths: Vec<Vec<f64>> = vec![Vec::new(); model.photos.len()];
    for seen in &model.observations {
        let photo = seen.photo as usize;
        let point = model.cloud.points[seen.point as usize];
        let depth = model.photos[photo].pose.camera_from_world(point).z;
        if depth > 0.0 {
            depths[photo].push(depth);
        }
    }
    let of = |(posed, mut depths): (&crate::formats::PosedPhoto, Vec<f64>)| {
        let camera = model.cameras[posed.camera].clone();
        Some(Seen {
            name: posed.name.clone(),
            path: photos.named(&posed.name)?.path.clone(),
            view: View {
                camera: Camera {
                    distortion: Distortion::None,
                    ..camera.clone()
                },
                pose: posed.pose,
                depths: range(&mut depths)?,
            },
            camera,
        })
    };
    model.photos.iter().zip(depths).filter_map(of).collect()
}

/// Between which depths to look; `None` where too few points say so.
fn range(depths: &mut [f64]) -> Option<[f64; 2]> {
    if depths.len() < FEWEST {
        return None;
    }
    depths.sort_by(f64::total_cmp);
    let last = depths.len() - 1;
    Some([
        depths[last / 100] / WIDER,
        depths[last - last / 100] * WIDER,
    ])
}

/// The folder for depths, without those of another model or of other options.
fn shelf(work: &Path, options: &DenseOptions, goes_on: bool) -> Result<InFolder, Fault> {
    let folder = work.join(KEPT);
    let cannot = |error: std::io::Error| {
        let what = format!("{} cannot be written ({error})", folder.display());
        Fault::new(what, "choose a folder that may be written to")
    };
    let shelf = InFolder::new(folder.clone());
    let of = format!("{options:?}\n").into_bytes();
    if goes_on && shelf.get(OF).is_some_and(|before| before == of) {
        return Ok(shelf);
    }
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(cannot)?;
    }
    fs::create_dir_all(&folder).map_err(cannot)?;
    shelf.put(OF, of)?;
    Ok(shelf)
}

/// The photos without their lenses.
struct Undistorted<'a>(&'a [Seen]);

impl Photos for Undistorted<'_> {
    fn photo(&self, view: usize) -> Result<RgbImage, Fault> {
        let Seen {
            name, path, camera, ..
        } = &self.0[view];
        let bytes = read_bytes(path).map_err(|error| error.fault)?;
        let photo = picture::decode(&bytes).map_err(|fault| {
            let what = format!("photo '{name}': {}", fault.what);
            Fault::new(what, "take it out of the folder and start again")
        })?;
        if photo.dimensions() != (camera.width, camera.height) {
            let what = format!("photo '{name}' has changed since its place was found");
            return Err(Fault::new(what, "start again in another folder"));
        }
        Ok(picture::undistorted(&photo, camera, u32::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_points_elsewhere_do_not_widen_the_range() {
        let mut depths: Vec<f64> = (0..300).map(|i| 20.0 + 0.01 * f64::from(i)).collect();
        depths.extend([0.1, 5000.0]);
        let [near, far] = range(&mut depths).unwrap();
        assert!((near - 20.01 / 1.25).abs() < 0.05, "{near}");
        assert!((far - 22.98 * 1.25).abs() < 0.05, "{far}");
        assert_eq!(range(&mut depths[..19]), None);
    }

    #[test]
    fn depths_of_something_else_are_thrown_away() {
        let work = tempfile::tempdir().unwrap();
        let options = crate::Quality::Normal.dense().unwrap();
        let put = |options: &DenseOptions, goes_on: bool| {
            let shelf = shelf(work.path(), options, goes_on).unwrap();
            let was_there = shelf.get("first-0").is_some();
            shelf.put("first-0", vec![1]).unwrap();
            was_there
        };
        assert!(!put(&options, true));
        assert!(put(&options, true));
        assert!(!put(&options, false), "of another model");
        let other = crate::Quality::Best.dense().unwrap();
        assert!(!put(&other, true));
        assert!(put(&other, true));
    }
}
