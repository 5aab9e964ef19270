//! What is shown of a model while it grows: some of its points, and the cameras found so far.

use std::cell::Cell;
use std::time::{Duration, Instant};

use cumulus3d_core::{FeatureStore, Reconstruction};
use glam::DVec3;

use super::small_photos::SmallPhotos;
use crate::adjusted::{point, pose};
use crate::camera::Pose;

/// No more often than this, so that showing costs the engine nothing that is felt.
const PAUSE: Duration = Duration::from_secs(1);

/// Of more points every so many.
const MOST_POINTS: usize = 40_000;

/// A model as it is while it grows, in a frame of its own that may be another one each time.
#[derive(Debug, Clone, PartialEq)]
pub struct Growth {
    /// Some of its points.
    pub points: Vec<DVec3>,
    /// As many colours; empty where none is known yet.
    pub colors: Vec<[u8; 3]>,
    /// How many points it has.
    pub of: usize,
    /// The cameras found so far.
    pub cameras: Vec<Pose>,
    /// How many photos there are.
    pub photos: usize,
}

/// Takes it over; called by the engine's own thread, so it must not wait.
pub type OnGrowth = Box<dyn Fn(Growth) + Send + Sync>;

/// Who is shown a model, and when last.
pub(super) struct Watch<'a> {
    on_growth: &'a OnGrowth,
    store: &'a FeatureStore,
    small: &'a SmallPhotos,
    last: Cell<Option<Instant>>,
}

impl<'a> Watch<'a> {
    pub(super) fn new(
        on_growth: &'a OnGrowth,
        store: &'a FeatureStore,
        small: &'a SmallPhotos,
    ) -> Self {
        Self {
            on_growth,
            store,
            small,
            last: Cell::new(None),
        }
    }

    /// Shows the model of one in so many photos, unless that was done just now.
    pub(super) fn show(&self, model: &Reconstruction, photos: usize) {
        let is_early = self.last.get().is_some_and(|last| last.elapsed() < PAUSE);
        if is_early {
            return;
        }
        (self.on_growth)(self.growth(model, photos));
        self.last.set(Some(Instant::now()));
    }

    fn growth(&self, model: &Reconstruction, photos: usize) -> Growth {
        let of = model.num_points3d();
        let step = of.div_ceil(MOST_POINTS).max(1);
        let shown = || model.points3d().step_by(step).map(|(_, point)| point);
        let cameras = model.registered_images().into_iter();
        let cameras = cameras.filter_map(|image| model.world_to_cam(image));
        let tracks = shown().map(|point| point.track.as_slice());
        Growth {
            points: shown().map(|shown| point(&shown.xyz)).collect(),
            colors: self.small.colors(self.store, tracks),
            of,
            cameras: cameras.map(|found| pose(&found)).collect(),
            photos,
        }
    }
}
