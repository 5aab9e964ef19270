//! The engine that is always there: incremental structure from motion (Snavely 2008; Schönberger & Frahm,
//! "Structure-from-Motion Revisited", 2016) put together from cumulus3d's parts, in pure Rust.
//!
//! ```text
//! features      SIFT of each photo
//! preemptive    which of many pairs are worth comparing, where nobody knows neighbours
//! nearest_two   the two nearest descriptors, by a product of matrices
//! matching      pairs of photos: matches that one geometry explains
//! seed          the pair that a model begins with
//! growing       photo after photo joins the model
//! bundle        poses, points and lenses adjusted together
//! placing       the model brought to the photos' places, and adjusted with them
//! model_files   what comes out
//! ```
//!
//! Why cumulus3d, and how far: its SIFT, its two-view geometry (five, seven and eight points), its
//! registration (P3P) and its bundle adjustment (Levenberg-Marquardt with the points eliminated) agree
//! with COLMAP's on shared photos to 0.011 % of the scene and 0.012 degrees. Its matcher is slow (ours is
//! exact and five times as fast), its global mapper knows no positions and cannot be stopped, its errors are
//! in Korean and its asserts panic: [`guarded`] turns those into faults.

mod bundle;
mod features;
mod growing;
mod matching;
mod model_files;
mod nearest_two;
mod placing;
mod preemptive;
mod seed;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use cumulus3d_core::{FeatureStore, MatchGraph, MatchGraphOptions};

use crate::engine::{Engine, Sparse};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::{LeftOut, PhotoSet};

/// The engine.
#[derive(Debug, Clone, Copy, Default)]
pub struct Embedded;

/// Features and matches found so far, for a run that goes on.
const KEPT: &str = "features.bin";

impl Engine for Embedded {
    fn name(&self) -> String {
        "embedded (cumulus3d 0.11.1)".to_owned()
    }

    fn reconstruct(
        &self,
        photos: &PhotoSet,
        pairs: &[[usize; 2]],
        work: &Path,
        progress: &Progress,
    ) -> Result<Sparse, Fault> {
        guarded(|| {
            let kept = work.join(KEPT);
            // What was cut off while it was written is made again.
            let store = FeatureStore::load(&kept).unwrap_or_default();
            let mut left_out = features::find(&store, photos, &kept, progress)?;
            let pairs = preemptive::worth_comparing(&store, photos, pairs, progress)?;
            matching::compare(&store, photos, &pairs, &kept, progress)?;
            let graph = MatchGraph::from_store(&store, &MatchGraphOptions::default());
            let mut model = growing::grow(&store, &graph, photos, progress)?;
            placing::place(&mut model, photos, progress)?;
            for (number, photo) in photos.photos.iter().enumerate() {
                let is_known = left_out.iter().any(|left| left.photo == photo.name);
                if !is_known && !model.is_image_registered(image_id(number)) {
                    left_out.push(LeftOut {
                        photo: photo.name.clone(),
                        why: "it shows too little of what the others show".to_owned(),
                    });
                }
            }
            progress.stage("colouring points");
            model_files::colour(&mut model, photos, progress)?;
            Ok(Sparse {
                files: model_files::files(&model, work)?,
                left_out,
            })
        })
    }
}

/// cumulus3d's identifier of a photo.
fn image_id(number: usize) -> u32 {
    u32::try_from(number + 1).unwrap_or(u32::MAX)
}

/// cumulus3d's identifier of a camera.
fn camera_id(number: usize) -> u32 {
    u32::try_from(number + 1).unwrap_or(u32::MAX)
}

/// The place in the set of the photo with this identifier.
fn photo_of(image: u32) -> usize {
    image as usize - 1
}

/// What cumulus3d says went wrong; its own words are not the user's.
fn failed(doing: &str) -> Fault {
    let what = format!("{doing} failed");
    Fault::new(
        what,
        "leave out photos of other things, or report this with the photos",
    )
}

/// A panic inside of cumulus3d as a fault.
fn guarded<T>(work: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(failed("the reconstruction")))
}
