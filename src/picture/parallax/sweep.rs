//! How well patches match in another photo, by the factor of their distance.

use glam::DVec3;

use super::patches::{PIXELS, Patch, Patches, normalised};
use super::small_photo::shrunk;
use super::{Sighted, WORTH_SAYING, ray_in};
use crate::camera::{Camera, Pose};
use crate::geometry::{median, median_with_deviation};

/// The distance is looked for from so much nearer to so much farther, as the logarithm of the factor: a third nearer, a half farther.
const FARTHEST: f64 = 0.405;

/// Patches are moved by so many pixels of the small photo from step to step: they match over two or three.
const STEP: f64 = 0.7;

/// With less parallax than this, pixels of the small photo for a percent of the distance, two percent are not seen.
const LEAST_PARALLAX: f64 = 0.4;

/// Fewer patches say nothing.
const FEWEST: usize = 40;

/// What is seen stands out of what wrong factors give by so many of its deviations. There are a few hundred of these, which
/// follow each other: of noise one would be beyond five in a thousand pairs.
const CLEAR: f64 = 6.0;

/// A mean correlation that counts: of right ones it is 0.2 to 0.8, of moved ones 0.1 and more.
const LEAST_MATCH: f64 = 0.08;

/// Within so many pixels of the best factor the patches still match.
const ITS_OWN: f64 = 3.0;

/// What is seen where the surface is lies within so many pixels of it.
const THERE: f64 = 1.5;

/// Where another photo sees the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenAt {
    /// At so many times its distance.
    pub factor: f64,
    /// The mean correlation of the patches there.
    pub there: f64,
    /// Their mean correlation where the surface is.
    pub here: f64,
    /// Whether that is another place than the surface's, by more than the pixels can be wrong.
    pub is_elsewhere: bool,
}

/// How a photo sees points of the surface that lie on the rays of another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parallax {
    /// By how many pixels of the small photo they move with each percent of their distance from the other camera, the median.
    pub pixels_a_percent: f64,
    /// The share of the points that it shows.
    pub share: f64,
}

impl Parallax {
    /// Of points that are seen from `eye`; `None` where the photo shows none of them.
    pub fn of(points: &[DVec3], eye: DVec3, camera: &Camera, pose: &Pose) -> Option<Self> {
        let shrunk = shrunk(camera);
        let moved = |point: &DVec3| {
            let [a, b] = ray_in(camera, pose, eye, *point);
            let pixel = |factor: f64| {
                let p = a + b * factor;
                (p.z > 0.0).then(|| (p / p.z).truncate())
            };
            let (at, after) = (pixel(1.0)?, pixel(1.01)?);
            camera.contains(at).then(|| at.distance(after) * shrunk)
        };
        let mut all: Vec<f64> = points.iter().filter_map(moved).collect();
        let share = all.len() as f64 / points.len().max(1) as f64;
        let pixels_a_percent = median(&mut all)?;
        Some(Self {
            pixels_a_percent,
            share,
        })
    }

    /// Whether two percent of the distance can be seen.
    pub fn tells(&self) -> bool {
        self.pixels_a_percent >= LEAST_PARALLAX
    }
}

/// The mean correlation of patches at one factor.
#[derive(Debug, Clone, Copy)]
struct Match {
    /// The logarithm of the factor.
    moved: f64,
    mean: f64,
    patches: usize,
}

impl Match {
    /// How much it says: the mean of n patches deviates by one over the root of n.
    fn weight(&self) -> f64 {
        self.mean * (self.patches as f64).sqrt()
    }
}

/// Where the other photo sees the surface on which the patches lie; `None` where it does not tell.
pub fn seen_at(patches: &Patches, other: &Sighted<'_>) -> Option<SeenAt> {
    let middles: Vec<DVec3> = patches
        .patches
        .iter()
        .map(|patch| patch.points[PIXELS / 2])
        .collect();
    let parallax = Parallax::of(&middles, patches.eye, other.camera, other.pose)?;
    if !parallax.tells() {
        return None;
    }
    let sweep = |every: usize| Sweep::new(patches, other, parallax.pixels_a_percent, every);
    // Nearly always the surface is where it is seen, and stands out so far that a look at some patches and factors tells.
    let quick = sweep(QUICK.into()).seen(
        |at| at.abs() <= 3 || at % i32::from(QUICK) == 0,
        2.0 * CLEAR,
    );
    let quick = quick.filter(|seen| !seen.is_elsewhere);
    quick.or_else(|| sweep(1).seen(|_| true, CLEAR))
}

/// For a quick look one of so many patches and of so many factors.
const QUICK: u8 = 4;

/// Patches that are moved along their rays, all by the same factor.
struct Sweep<'a> {
    /// Each with the rays of its pixels in the other photo.
    patches: Vec<(&'a Patch, Vec<[DVec3; 2]>)>,
    other: &'a Sighted<'a>,
    /// Pixels of the small photo for a percent of the distance.
    pixels_a_percent: f64,
}

impl<'a> Sweep<'a> {
    /// Of one of `every` so many patches.
    fn new(
        patches: &'a Patches,
        other: &'a Sighted<'a>,
        pixels_a_percent: f64,
        every: usize,
    ) -> Self {
        let rays = |patch: &Patch| {
            let of = |point: &DVec3| ray_in(other.camera, other.pose, patches.eye, *point);
            patch.points.iter().map(of).collect()
        };
        let some = patches.patches.iter().step_by(every);
        Self {
            patches: some.map(|patch| (patch, rays(patch))).collect(),
            other,
            pixels_a_percent,
        }
    }

    /// The logarithm of the factor that moves them by so many pixels.
    fn of_pixels(&self, pixels: f64) -> f64 {
        pixels / self.pixels_a_percent * 0.01
    }

    /// What is seen where of the steps that are `looked_at`, counted from the surface, if it stands out by so many deviations.
    fn seen(&self, looked_at: impl Fn(i32) -> bool, clear: f64) -> Option<SeenAt> {
        let step = self.of_pixels(STEP).min(0.01);
        let most = (FARTHEST / step) as i32;
        let steps = (-most..=most).filter(|at| looked_at(*at));
        let all: Vec<Match> = steps
            .filter_map(|at| self.matched(f64::from(at) * step))
            .collect();
        let here = self.matched(0.0)?;
        let weight = |(_, found): &(usize, &Match)| found.weight();
        let best = all.iter().enumerate();
        let (place, best) = best.max_by(|a, b| weight(a).total_cmp(&weight(b)))?;
        let own = self.of_pixels(ITS_OWN);
        let others = all
            .iter()
            .filter(|other| (other.moved - best.moved).abs() > own);
        let mut wrong: Vec<f64> = others.map(Match::weight).collect();
        let [usual, deviation] = median_with_deviation(&mut wrong)?;
        // Of a normal distribution the median deviation is 0.6745 of the standard one.
        let deviation = deviation / 0.6745;
        if best.mean < LEAST_MATCH || best.weight() - usual < clear * deviation {
            return None;
        }
        let moved = top_of(&all, place);
        let is_elsewhere = moved.abs() > self.of_pixels(THERE).max(WORTH_SAYING);
        if is_elsewhere && best.weight() - here.weight() <= clear * deviation {
            return None;
        }
        Some(SeenAt {
            factor: moved.exp(),
            there: best.mean,
            here: here.mean,
            is_elsewhere,
        })
    }

    /// The mean correlation of the patches that the other photo shows whole.
    fn matched(&self, moved: f64) -> Option<Match> {
        let factor = moved.exp();
        let each = self.patches.iter();
        let each = each.filter_map(|(patch, rays)| correlation(patch, rays, self.other, factor));
        let (sum, count) = each.fold((0.0, 0), |(sum, count), r| (sum + r, count + 1));
        (count >= FEWEST).then(|| Match {
            moved,
            mean: sum / count as f64,
            patches: count,
        })
    }
}

/// The top of the parabola through the best match and those beside it.
fn top_of(all: &[Match], place: usize) -> f64 {
    let best = &all[place];
    let beside = place
        .checked_sub(1)
        .and_then(|before| Some((all.get(before)?, all.get(place + 1)?)));
    let Some((before, after)) = beside else {
        return best.moved;
    };
    let (left, right) = (before.mean - best.mean, after.mean - best.mean);
    let bend = left + right;
    match bend < 0.0 {
        true => {
            best.moved
                + (after.moved - best.moved) * ((left - right) / (2.0 * bend)).clamp(-0.5, 0.5)
        }
        false => best.moved,
    }
}

/// Pearson's r of a patch and what the other photo shows at its points; `None` where that is not all of it, or one colour.
fn correlation(
    patch: &Patch,
    rays: &[[DVec3; 2]],
    other: &Sighted<'_>,
    factor: f64,
) -> Option<f64> {
    let mut seen = [0.0; PIXELS];
    for (seen, [a, b]) in seen.iter_mut().zip(rays) {
        let p = *a + *b * factor;
        if p.z <= 0.0 {
            return None;
        }
        *seen = other.photo.at((p / p.z).truncate())?;
    }
    if !normalised(&mut seen) {
        return None;
    }
    Some(patch.shades.iter().zip(&seen).map(|(a, b)| a * b).sum())
}
