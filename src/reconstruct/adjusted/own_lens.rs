//! Photos that were zoomed, cropped or stabilised, which their files do not say: under one lens with the others they bend the whole
//! model. They are found by a trial in which each photo has a lens of its own: the focal lengths of photos of one camera then
//! agree but for theirs, and for those of photos at the rim that see little: without its own lens a photo that was zoomed makes points
//! and places fit worse. Where lengths do not agree, because small blocks tell none well or many were zoomed, the farthest are tried
//! one by one.
//!
//! Photos of one lens come out apart by 0.01 to 0.05 % (simulated, seen to 0.1 pixels), and by 0.1 and 0.3 % (Sceaux and Kermit's
//! doll, eleven real photos each; medians).

use std::collections::{HashMap, HashSet};

use cumulus3d_core::reconstruction::Image;
use cumulus3d_core::{Error, Reconstruction, Vec3};

use super::bundle::{Adjustment, FARTHEST_PX, Weighed, adjust, off_px, pixel_deviation};
use super::in_order::{add_camera, add_image, with_cameras_of};
use super::{Whose, failed};
use crate::fault::Fault;
use crate::geometry::median_with_deviation;
use crate::jobs::Progress;
use crate::opening::covariance::counted_deviation;

/// Photos of a camera of which some can be told from the others.
const FEWEST: usize = 5;
/// A part of a focal length by which photos of one lens come out apart, ...
const LEAST: f64 = 0.005;
/// ... and so many times their own deviation from each other.
const TIMES: f64 = 6.0;
/// A photo's lens of its own makes a model fit better by so many squares of what is off over its deviation. One that it does not
/// have makes 8 of it, its numbers (5 and -1: simulated, and Kermit's doll); 3.5 % of one photo of six, with RTK, made 1560.
const BETTER: f64 = 60.0;

/// So many photos are tried one by one at most.
const ONE_BY_ONE: usize = 4;
/// So many of those that stand out are looked at once more, those that see least.
const MOST_TESTED: usize = 8;

/// What the trials adjust with: see [`Adjustment`].
pub(super) struct Trials<'a> {
    pub(super) places: &'a HashMap<u32, (Vec3, f64)>,
    pub(super) whose: &'a Whose<'a>,
    pub(super) progress: &'a Progress,
}

impl Trials<'_> {
    /// Photos whose focal lengths are others than those of most photos of their camera.
    ///
    /// # Errors
    /// Where a trial has no solution, or the work was cancelled.
    pub(super) fn of_another_length(&self, model: &Reconstruction) -> Result<HashSet<u32>, Fault> {
        let mut of_camera: HashMap<u32, Vec<u32>> = HashMap::new();
        for image in model.registered_images() {
            if let Some(camera) = model.image(image).map(|image| image.camera_id) {
                of_camera.entry(camera).or_default().push(image);
            }
        }
        of_camera.retain(|_, images| images.len() >= FEWEST);
        let images: HashSet<u32> = of_camera.values().flatten().copied().collect();
        if images.is_empty() {
            return Ok(HashSet::new());
        }
        let tried = self.adjusted(model, &images)?;
        let mut apart: Vec<Apart> = (of_camera.values())
            .flat_map(|images| apart(&tried, images))
            .collect();
        if apart.is_empty() {
            return Ok(HashSet::new());
        }
        let trial = Trial {
            trials: self,
            model,
            // What does not fit is taken away: it counts as if it did just so.
            most: off_px(model).count(),
            pixel: counted_pixel(&tried),
        };
        let clear = apart.iter().filter(|apart| apart.is_clear);
        let clear: Vec<u32> = clear.map(|apart| apart.image).collect();
        if !clear.is_empty() {
            return trial.sure_of(clear);
        }
        apart.sort_by(|a, b| b.by.total_cmp(&a.by));
        trial.one_by_one(&apart, &tried)
    }

    /// The model adjusted, with lenses of their own for these photos.
    fn adjusted(
        &self,
        model: &Reconstruction,
        own: &HashSet<u32>,
    ) -> Result<Reconstruction, Fault> {
        let mut tried = with_own_lenses(model, own)?;
        let whose = &self.whose.again(&tried);
        // What is stated counts little once points fit: not before lenses are nearly right.
        for number in 0..2 {
            self.progress.advance(number, 2)?;
            let trial = Adjustment {
                images: HashSet::new(),
                places: self.places.clone(),
                whose,
                weighed: Weighed::ItsPixels,
                iterations: 30,
            };
            adjust(&mut tried, trial, self.progress)?;
        }
        Ok(tried)
    }
}

/// How well a model fits with some lenses or others.
struct Trial<'a> {
    trials: &'a Trials<'a>,
    model: &'a Reconstruction,
    /// Observations before.
    most: usize,
    /// What a pixel counts.
    pixel: f64,
}

impl Trial<'_> {
    /// Of photos that stand out those without whose own lenses the model fits worse: one at the rim of a survey, which sees little,
    /// stands out by chance, too.
    fn sure_of(&self, mut clear: Vec<u32>) -> Result<HashSet<u32>, Fault> {
        let seen = |&image: &u32| {
            let image = self.model.image(image);
            image.map_or(0, |image| {
                let points = image.points2d().iter();
                points.filter(|point| point.has_point3d()).count()
            })
        };
        clear.sort_by_key(seen);
        let mut own: HashSet<u32> = clear.iter().copied().collect();
        let mut least = self.with(&own)?;
        for image in clear.iter().take(MOST_TESTED) {
            own.remove(image);
            let without = self.with(&own)?;
            if without > least + BETTER {
                own.insert(*image);
            } else {
                least = without;
            }
        }
        Ok(own)
    }

    /// Those of these photos, the farthest first, with whose own lenses the model fits better; `tried` is that in which each has one.
    fn one_by_one(&self, apart: &[Apart], tried: &Reconstruction) -> Result<HashSet<u32>, Fault> {
        let mut own = HashSet::new();
        let mut least = self.with(&own)?;
        // Frames of a stabilised film are all cropped otherwise: with a lens of its own for one the others bend it still.
        let all: HashSet<u32> = apart.iter().map(|apart| apart.image).collect();
        let is_of_all = self.misfit(tried) + BETTER * (all.len() as f64) < least;
        for next in apart.iter().take(ONE_BY_ONE) {
            own.insert(next.image);
            let with = self.with(&own)?;
            if with + BETTER > least {
                own.remove(&next.image);
                break;
            }
            least = with;
        }
        let is_of_some = (1..ONE_BY_ONE).contains(&own.len());
        Ok(match is_of_all && !is_of_some {
            true => all,
            false => own,
        })
    }

    /// The misfit with lenses of their own for these photos.
    fn with(&self, own: &HashSet<u32>) -> Result<f64, Fault> {
        Ok(self.misfit(&self.trials.adjusted(self.model, own)?))
    }

    /// Squares of how far points lie from where photos see them, and cameras from their places, over the deviations.
    fn misfit(&self, model: &Reconstruction) -> f64 {
        let missing = self.most.saturating_sub(off_px(model).count());
        let off = off_px(model).chain(std::iter::repeat_n(FARTHEST_PX, missing));
        let points: f64 = off.map(|off| (off / self.pixel).powi(2)).sum();
        let places = self.trials.places.iter();
        let places = places.filter_map(|(&image, (place, deviation))| {
            let off = (model.projection_center(image)? - place).norm();
            Some((off / deviation).powi(2))
        });
        points + places.sum::<f64>()
    }
}

/// As what a pixel counts where photos see points so well.
fn counted_pixel(model: &Reconstruction) -> f64 {
    let (observations, photos) = (off_px(model).count(), model.registered_image_count());
    counted_deviation(pixel_deviation(model), observations, photos)
}

/// A photo whose focal length came out apart from that of most photos of its camera.
struct Apart {
    image: u32,
    /// The logarithm of how many times as long.
    by: f64,
    /// Whether the others are together beside that.
    is_clear: bool,
}

/// Those of these photos of one camera, in a model where each has a lens of its own.
fn apart(tried: &Reconstruction, images: &[u32]) -> Vec<Apart> {
    let length = |image: u32| {
        let camera = tried.camera(tried.image(image)?.camera_id)?;
        Some((image, camera.mean_focal().ln()))
    };
    let lengths: Vec<(u32, f64)> = images.iter().filter_map(|&image| length(image)).collect();
    let mut numbers: Vec<f64> = lengths.iter().map(|(_, length)| *length).collect();
    let Some([middle, deviation]) = median_with_deviation(&mut numbers) else {
        return Vec::new();
    };
    let all = lengths.into_iter().map(|(image, length)| {
        let by = (length - middle).abs();
        let is_clear = by > TIMES * deviation;
        Apart {
            image,
            by,
            is_clear,
        }
    });
    all.filter(|apart| apart.by > LEAST).collect()
}

/// The same model with a lens of its own for each of these photos, which begins as that of the others.
///
/// # Errors
/// Where the model contradicts itself.
pub(super) fn with_own_lenses(
    model: &Reconstruction,
    images: &HashSet<u32>,
) -> Result<Reconstruction, Fault> {
    made(model, images).map_err(|_| failed("making a camera"))
}

fn made(model: &Reconstruction, images: &HashSet<u32>) -> Result<Reconstruction, Error> {
    let mut made = with_cameras_of(model)?;
    let mut own = HashMap::new();
    let free = model.cameras().keys().max().map_or(1, |most| most + 1);
    let mut sorted: Vec<u32> = images.iter().copied().collect();
    sorted.sort_unstable();
    for (id, image) in (free..).zip(sorted) {
        let of = model
            .image(image)
            .and_then(|image| model.camera(image.camera_id));
        if let Some(camera) = of {
            let mut camera = camera.clone();
            camera.camera_id = id;
            add_camera(&mut made, camera)?;
            own.insert(image, id);
        }
    }
    for image in model.images() {
        let id = image.image_id;
        let camera = own.get(&id).copied().unwrap_or(image.camera_id);
        let pixels = image.points2d().iter().map(|point| point.xy);
        let new = Image::new(id, &image.name, camera, pixels);
        add_image(&mut made, new, model.world_to_cam(id))?;
    }
    for (id, point) in model.points3d() {
        made.add_point3d_with_id(id, point.clone())?;
    }
    Ok(made)
}
