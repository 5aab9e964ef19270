//! A model grows from a pair: the photo that sees most of it joins, what it sees with others becomes points,
//! and all is adjusted.

use std::collections::{HashMap, HashSet};

use cumulus3d_core::{FeatureStore, MatchGraph, Reconstruction, Rigid3};
use cumulus3d_sfm::registration::{
    RegistrationOptions, add_missing_images, register_image, visibility_score,
};
use cumulus3d_sfm::triangulator::{TrackTriangulator, TrackTriangulatorOptions};

use super::growth::Watch;
use super::guided::{RADIUS_PX, seen_again};
use super::seed::{Seed, seeds};
use crate::adjusted::{
    Adjustment, FEWEST_PHOTOS, Weighed, Whose, adjust, failed, too_little_in_common,
};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::PhotoSet;

/// Pairs that are tried to begin with.
const SEEDS: usize = 5;
/// A photo that does not fit may fit later, when the model has grown.
const TRIES: usize = 3;
/// All is adjusted when the model has grown by this part; else what is around the new photo.
const GROWN: f64 = 0.2;
/// Photos around a new one that are adjusted with it.
const AROUND: usize = 6;
/// Points are looked for in more photos so often: what the first time finds is where more is found, a tenth as much.
const GUIDED: u64 = 2;

/// The model; it is shown to `watch` while it grows.
///
/// # Errors
/// Where no pair grows to three photos, or the work was cancelled.
pub(super) fn grow(
    store: &FeatureStore,
    graph: &MatchGraph,
    photos: &PhotoSet,
    watch: Option<&Watch<'_>>,
    progress: &Progress,
) -> Result<Reconstruction, Fault> {
    progress.stage("looking for a pair to begin with");
    let mut best: Option<Reconstruction> = None;
    for seed in seeds(store, graph).into_iter().take(SEEDS) {
        let model = Growing {
            store,
            graph,
            photos,
            watch,
            progress,
        }
        .from(&seed)?;
        let count = model.registered_image_count();
        let most = best
            .as_ref()
            .map_or(0, Reconstruction::registered_image_count);
        if count > most {
            best = Some(model);
        }
        // Most of them: another pair would hardly reach more.
        if count * 4 > graph.num_images() * 3 {
            break;
        }
    }
    best.filter(|model| model.registered_image_count() >= FEWEST_PHOTOS)
        .ok_or_else(too_little_in_common)
}

struct Growing<'a> {
    store: &'a FeatureStore,
    graph: &'a MatchGraph,
    photos: &'a PhotoSet,
    watch: Option<&'a Watch<'a>>,
    progress: &'a Progress,
}

impl Growing<'_> {
    fn from(&self, seed: &Seed) -> Result<Reconstruction, Fault> {
        let error = || failed("growing the model");
        let mut model = Reconstruction::new();
        add_missing_images(&mut model, self.store, self.graph).map_err(|_| error())?;
        for (image, pose) in seed.images.into_iter().zip([Rigid3::identity(), seed.pose]) {
            model.set_world_to_cam(image, pose).map_err(|_| error())?;
            model.register_image(image).map_err(|_| error())?;
        }
        self.triangulate(&mut model, seed.images[0])?;
        self.adjust(&mut model, HashSet::new(), 50)?;
        let mut tries: HashMap<u32, usize> = HashMap::new();
        let mut adjusted = 2.0;
        self.progress
            .stage(format!("placing {} photos", self.photos.photos.len()));
        while let Some(image) = self.next(&model, &tries) {
            let count = model.registered_image_count();
            if let Some(watch) = self.watch {
                watch.show(&model, self.photos.photos.len());
            }
            self.progress
                .advance(count as u64, self.photos.photos.len() as u64)?;
            let options = RegistrationOptions {
                remove_unregistered: false,
                ..RegistrationOptions::default()
            };
            let joined = register_image(&mut model, self.graph, image, &options);
            if !joined.map_err(|_| error())?.is_registered() {
                *tries.entry(image).or_default() += 1;
                continue;
            }
            self.triangulate(&mut model, image)?;
            let count = model.registered_image_count() as f64;
            if count >= adjusted * (1.0 + GROWN) || count < 10.0 {
                self.adjust(&mut model, HashSet::new(), 30)?;
                adjusted = count;
            } else {
                let around = self.around(&model, image);
                self.adjust(&mut model, around, 15)?;
            }
        }
        self.progress.stage("adjusting all");
        for round in 0..3 {
            if let Some(watch) = self.watch {
                watch.show(&model, self.photos.photos.len());
            }
            self.progress.advance(round, 4)?;
            let mut triangulator = TrackTriangulator::new(&model, self.graph, tracks());
            let again = triangulator.retriangulate(&mut model, None);
            again.map_err(|_| error())?;
            triangulator
                .complete_tracks(&mut model, None)
                .map_err(|_| error())?;
            triangulator
                .merge_tracks(&mut model, None)
                .map_err(|_| error())?;
            self.adjust(&mut model, HashSet::new(), 50)?;
        }
        self.progress.stage("looking for points in more photos");
        for round in 0..GUIDED {
            let done = [round, GUIDED];
            let again = seen_again(&model, self.store, self.progress, done)?;
            let mut triangulator = TrackTriangulator::new(&model, &again, guided_tracks());
            let longer = triangulator.complete_tracks(&mut model, None);
            longer.map_err(|_| error())?;
            let merged = triangulator.merge_tracks(&mut model, None);
            merged.map_err(|_| error())?;
            self.adjust(&mut model, HashSet::new(), 50)?;
        }
        model.remove_unregistered();
        Ok(model)
    }

    /// The photo outside of the model that sees most of it; those that failed come last.
    fn next(&self, model: &Reconstruction, tries: &HashMap<u32, usize>) -> Option<u32> {
        let tried = |image: &u32| tries.get(image).copied().unwrap_or(0);
        let outside = model
            .image_ids()
            .filter(|image| !model.is_image_registered(*image) && tried(image) < TRIES);
        let scored = outside.map(|image| {
            let score = visibility_score(model, self.graph, image);
            (
                std::cmp::Reverse(tried(&image)),
                score,
                std::cmp::Reverse(image),
            )
        });
        scored.max().map(|(.., image)| image.0)
    }

    /// Points of what a photo sees with others.
    fn triangulate(&self, model: &mut Reconstruction, image: u32) -> Result<(), Fault> {
        let error = |_| failed("triangulating points");
        let mut triangulator = TrackTriangulator::new(model, self.graph, tracks());
        triangulator
            .triangulate_image(model, image)
            .map_err(error)?;
        triangulator.complete_tracks(model, None).map_err(error)?;
        triangulator.merge_tracks(model, None).map_err(error)?;
        Ok(())
    }

    fn adjust(
        &self,
        model: &mut Reconstruction,
        images: HashSet<u32>,
        iterations: usize,
    ) -> Result<(), Fault> {
        let adjustment = Adjustment {
            images,
            places: HashMap::new(),
            whose: &Whose::of(model, self.photos),
            weighed: Weighed::APixel,
            iterations,
        };
        adjust(model, adjustment, self.progress)
    }

    /// A photo with those that share most points with it.
    fn around(&self, model: &Reconstruction, image: u32) -> HashSet<u32> {
        let mut shared: Vec<(usize, u32)> = model
            .registered_images()
            .into_iter()
            .filter(|&other| other != image)
            .map(|other| (self.graph.match_count_between(image, other), other))
            .collect();
        shared.sort_by(|a, b| b.cmp(a));
        let nearest = shared.into_iter().take(AROUND).map(|(_, other)| other);
        nearest.chain([image]).collect()
    }
}

/// Of what was looked for within so many pixels.
fn guided_tracks() -> TrackTriangulatorOptions {
    TrackTriangulatorOptions {
        merge_max_reproj_error: RADIUS_PX,
        complete_max_reproj_error: RADIUS_PX,
        ..tracks()
    }
}

fn tracks() -> TrackTriangulatorOptions {
    TrackTriangulatorOptions {
        // Points of two photos are most of a sparse survey's.
        skip_two_view_tracks: false,
        ..TrackTriangulatorOptions::default()
    }
}
