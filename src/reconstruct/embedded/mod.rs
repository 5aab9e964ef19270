//! The engine that is always there: incremental structure from motion (Snavely 2008; Schönberger & Frahm,
//! "Structure-from-Motion Revisited", 2016) put together from cumulus3d's parts, in pure Rust.
//!
//! ```text
//! features      SIFT of each photo
//! preemptive    which of many pairs are worth comparing, where nobody knows neighbours
//! nearest_two   the two nearest descriptors, by a product of matrices
//! on_card       the same on a graphics card
//! matching      pairs of photos: matches that one geometry explains
//! seed          the pair that a model begins with
//! growing       photo after photo joins the model
//! guided        its points looked for in more photos
//! growth        what is shown of it meanwhile
//! ```
//!
//! Why cumulus3d, and how far: its SIFT, its two-view geometry (five, seven and eight points), its
//! registration (P3P) and its bundle adjustment (Levenberg-Marquardt with the points eliminated) agree
//! with COLMAP's on shared photos to 0.011 % of the scene and 0.012 degrees. Its matcher is slow (ours is
//! exact and five times as fast), its global mapper knows no positions and cannot be stopped, its errors
//! and panics become faults in `adjusted`.

mod features;
mod growing;
mod growth;
mod guided;
mod matching;
mod nearest_two;
#[cfg(feature = "gpu")]
mod on_card;
mod preemptive;
mod seed;
mod small_photos;

use cumulus3d_core::{FeatureStore, MatchGraph, MatchGraphOptions};

use crate::adjusted::guarded;
use crate::engine::{Engine, Found, Workplace};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::PhotoSet;
use growth::Watch;
pub use growth::{Growth, OnGrowth};
use small_photos::SmallPhotos;

/// The engine.
#[derive(Default)]
pub struct Embedded {
    /// Is shown the model while it grows; the result is the same.
    pub on_growth: Option<OnGrowth>,
}

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
        at: &Workplace,
        progress: &Progress,
    ) -> Result<Found, Fault> {
        guarded(|| {
            let kept = at.folder.join(KEPT);
            // What was cut off while it was written is made again.
            let store = FeatureStore::load(&kept).unwrap_or_default();
            let mut small = SmallPhotos::default();
            let shown = self.on_growth.is_some().then_some(&mut small);
            let left_out = features::find(&store, photos, &kept, shown, progress)?;
            let pairs = preemptive::worth_comparing(&store, photos, pairs, progress)?;
            matching::compare(&store, photos, &pairs, &kept, at.card, progress)?;
            let graph = MatchGraph::from_store(&store, &MatchGraphOptions::default());
            let watch = self.on_growth.as_ref();
            let watch = watch.map(|on_growth| Watch::new(on_growth, &store, &small));
            Ok(Found {
                model: growing::grow(&store, &graph, photos, watch.as_ref(), progress)?,
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
