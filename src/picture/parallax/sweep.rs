//! How well patches match in another photo, by the factor of their distance.

use glam::{DVec3, Vec2};

use super::patches::{PIXELS, Patch, Patches, dot, normalised};
use super::small_photo::shrunk;
use super::{Sighted, SmallPhoto, WORTH_SAYING, ray_in};
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

/// Another photo that shows fewer of the patches, or a smaller share of them, may match none by chance.
const MANY: usize = 100;
const MUCH: f64 = 0.15;

/// Of fewer patches of a photo that is much farther away even a right one may match none clearly: of 44 and 42 so seen one did not, of 50 and
/// more all did.
const FEWEST_OF_NONE: usize = 60;

/// A match that is not clear is one of chance below this mean correlation times the root of its patches: of other photos the best of some
/// hundred factors were below 1.0 (66 to 96 patches) and below 1.4 (126 and more, where [`LEAST_MATCH`] of all patches is the limit), right
/// ones with 50 and more patches were above 1.6, and clear.
const BY_CHANCE: f64 = 1.2;

/// What both photos show is looked at in so many parts along each side, where patches match or do not.
const PARTS: usize = 4;

/// A part with fewer patches says nothing.
const FEWEST_OF_PART: usize = 15;

/// Of fewer parts nothing is said.
const FEWEST_PARTS: f64 = 4.0;

/// A part matches where its mean correlation stands out by so much, and by so many deviations, of what wrong factors give.
const PART_MATCH: f64 = 0.04;
const PART_CLEAR: f64 = 3.0;

/// A part that is elsewhere by less is one of a rough surface that has few points.
const WORTH_SAYING_OF_PART: f64 = 0.03;

/// It is looked for so far nearer and farther, and by one of so many patches: farther off it would be most of what is shown.
const FARTHEST_OF_PART: f64 = 0.16;
const SOME: usize = 2;

/// These wrong factors move patches by so many pixels of the small photo.
const WRONG: [f64; 8] = [-14.0, -11.0, -8.0, -5.0, 5.0, 8.0, 11.0, 14.0];

/// What patches of a photo say in another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Look {
    /// There they match.
    At(SeenAt),
    /// By its pose the other photo shows many of them, and it looks like them at no distance.
    Nowhere,
    /// The same of few of them, or of a small share: where the other way round it is [`Self::Nowhere`], so it is of both.
    FewNowhere,
    /// They do not tell: hardly any parallax, few that the other shows, or they match at no distance clearly.
    Unclear,
}

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
    /// The share of the parts of what both photos show that match there, of those that can be told; 1 where few can, and elsewhere.
    pub share: f64,
    /// At how many times its distance a part of it matches better than there, if one does clearly.
    pub part_elsewhere: Option<f64>,
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

/// Where the other photo sees the surface on which the patches lie.
pub fn seen_at(patches: &Patches, other: &Sighted<'_>) -> Look {
    let middles: Vec<DVec3> = patches
        .patches
        .iter()
        .map(|patch| patch.points[PIXELS / 2])
        .collect();
    let parallax = Parallax::of(&middles, patches.eye, other.camera, other.pose);
    let Some(parallax) = parallax.filter(Parallax::tells) else {
        return Look::Unclear;
    };
    let sweep = |every: usize| Sweep::new(patches, other, parallax.pixels_a_percent, every);
    // Nearly always the surface is where it is seen, and stands out so far that a look at some patches and factors tells.
    let quick = sweep(QUICK.into()).seen(
        |at| at.abs() <= 3 || at % i32::from(QUICK) == 0,
        2.0 * CLEAR,
    );
    let all = sweep(1);
    let look = match quick {
        Look::At(seen) if !seen.is_elsewhere => quick,
        _ => all.seen(|_| true, CLEAR),
    };
    match look {
        Look::At(seen) if !seen.is_elsewhere => Look::At(SeenAt {
            share: all.share_of_parts(&seen),
            part_elsewhere: sweep(SOME).part_elsewhere(&seen),
            ..seen
        }),
        other => other,
    }
}

/// For a quick look one of so many patches and of so many factors.
const QUICK: u8 = 4;

/// The rays of a patch's pixels as the small photo of another shows them: (a + f b) / its third is the place that it shows at so
/// many times the distance. Coordinate by coordinate and in single precision, a ten thousandth of a pixel, as nearly all the time goes
/// into these.
struct Rays {
    a: [[f32; PIXELS]; 3],
    b: [[f32; PIXELS]; 3],
}

impl Rays {
    /// Of a patch of a photo that was taken from `eye`.
    fn of(patch: &Patch, eye: DVec3, other: &Sighted<'_>) -> Self {
        let (shrunk, half) = other.photo.placed();
        let (mut a, mut b) = ([[0.0; PIXELS]; 3], [[0.0; PIXELS]; 3]);
        for (at, point) in patch.points.iter().enumerate() {
            let rays = ray_in(other.camera, other.pose, eye, *point);
            for (ray, to) in rays.iter().zip([&mut a, &mut b]) {
                let of = (ray.truncate() * shrunk - half * ray.z).extend(ray.z);
                for (to, of) in to.iter_mut().zip(of.to_array()) {
                    to[at] = of as f32;
                }
            }
        }
        Self { a, b }
    }

    /// Columns and rows at so many times the distance, and how far ahead of the other camera that is.
    fn places(&self, factor: f32) -> [[f32; PIXELS]; 3] {
        let mut places = self.a;
        for (place, b) in places.iter_mut().zip(&self.b) {
            for (place, b) in place.iter_mut().zip(b) {
                *place += b * factor;
            }
        }
        let [columns, rows, ahead] = &mut places;
        for ((column, row), z) in columns.iter_mut().zip(rows).zip(ahead) {
            *column /= *z;
            *row /= *z;
        }
        places
    }
}

/// Patches that are moved along their rays, all by the same factor.
struct Sweep<'a> {
    /// Each with the rays of its pixels in the other photo.
    patches: Vec<(&'a Patch, Rays)>,
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
        let rays = |patch: &Patch| Rays::of(patch, patches.eye, other);
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
    fn seen(&self, looked_at: impl Fn(i32) -> bool, clear: f64) -> Look {
        self.best(looked_at, clear).unwrap_or(Look::Unclear)
    }

    /// The same; `None` where the other photo shows too few of the patches.
    fn best(&self, looked_at: impl Fn(i32) -> bool, clear: f64) -> Option<Look> {
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
            return Some(not_clear(best, here.patches, self.patches.len()));
        }
        let moved = top_of(&all, place);
        let is_elsewhere = moved.abs() > self.of_pixels(THERE).max(WORTH_SAYING);
        if is_elsewhere && best.weight() - here.weight() <= clear * deviation {
            return None;
        }
        Some(Look::At(SeenAt {
            factor: moved.exp(),
            there: best.mean,
            here: here.mean,
            is_elsewhere,
            share: 1.0,
            part_elsewhere: None,
        }))
    }

    /// See [`SeenAt::share`]. A part is told where what the whole gives would stand out in it twice as far as it must.
    fn share_of_parts(&self, seen: &SeenAt) -> f64 {
        let parts = self.parts();
        let moved = seen.factor.ln();
        let right = self.by_part(&parts, moved);
        let wrong = WRONG.map(|pixels| self.by_part(&parts, moved + self.of_pixels(pixels)));
        let (mut told, mut matching) = (0.0, 0.0);
        for (part, right) in right.iter().enumerate() {
            let of_wrong: Vec<f64> = wrong.iter().filter_map(|wrong| wrong[part]).collect();
            let Some(right) = right.filter(|_| of_wrong.len() * 2 > WRONG.len()) else {
                continue;
            };
            let count = of_wrong.len() as f64;
            let usual = of_wrong.iter().sum::<f64>() / count;
            let squares: f64 = of_wrong.iter().map(|wrong| (wrong - usual).powi(2)).sum();
            let deviation = (squares / (count - 1.0)).sqrt();
            let least = PART_MATCH.max(PART_CLEAR * deviation);
            if seen.there > 2.0 * least {
                told += 1.0;
                matching += f64::from(u8::from(right - usual > least));
            }
        }
        match told < FEWEST_PARTS {
            true => 1.0,
            false => matching / told,
        }
    }

    /// See [`SeenAt::part_elsewhere`]. A part counts that matches best there, stands out as far as a whole photo must, and matches
    /// half as well as the whole does where that is seen: it may lie there by half.
    fn part_elsewhere(&self, seen: &SeenAt) -> Option<f64> {
        let parts = self.parts();
        let step = self.of_pixels(2.0 * STEP).min(0.02);
        let most = (FARTHEST_OF_PART / step) as i32;
        let all: Vec<(f64, [Option<f64>; PARTS * PARTS])> = (-most..=most)
            .map(|at| f64::from(at) * step)
            .map(|moved| (moved, self.by_part(&parts, moved)))
            .collect();
        let own = self.of_pixels(ITS_OWN);
        let here = seen.factor.ln();
        let away = own.max(WORTH_SAYING_OF_PART);
        let clearest = (0..PARTS * PARTS).filter_map(|part| {
            let of_part = all.iter();
            let of_part = of_part.filter_map(|(moved, means)| Some((*moved, means[part]?)));
            let of_part: Vec<(f64, f64)> = of_part.collect();
            let best = of_part.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1));
            let (best, mean) = best?;
            if (best - here).abs() <= away || mean < 0.5 * seen.there {
                return None;
            }
            let wrong = (of_part.iter()).filter(|(moved, _)| (moved - best).abs() > own);
            let mut wrong: Vec<f64> = wrong.map(|(_, mean)| *mean).collect();
            let [usual, deviation] = median_with_deviation(&mut wrong)?;
            let clear = (mean - usual) / (deviation / 0.6745);
            (clear >= CLEAR).then(|| (clear, (best - here).exp()))
        });
        let clearest = clearest.max_by(|a, b| a.0.total_cmp(&b.0));
        clearest.map(|(_, factor)| factor)
    }

    /// In which part of what the other photo shows each patch lies, by where it is on the surface; `None` of those that it does
    /// not show.
    fn parts(&self) -> Vec<Option<usize>> {
        let place = |rays: &Rays| {
            let [x, y, z] = rays.places(1.0).map(|of| of[PIXELS / 2]);
            let place = (z > 0.0).then(|| Vec2::new(x, y))?;
            self.other.photo.at(&[x], &[y]).map(|_| place)
        };
        let places: Vec<Option<Vec2>> = self.patches.iter().map(|(_, rays)| place(rays)).collect();
        let shown = || places.iter().flatten();
        let min = shown().fold(Vec2::INFINITY, |min, at| min.min(*at));
        let max = shown().fold(Vec2::NEG_INFINITY, |max, at| max.max(*at));
        let side = (max - min).max(Vec2::splat(f32::MIN_POSITIVE)) / PARTS as f32;
        let part = |at: &Vec2| {
            let place = ((*at - min) / side).to_array();
            let [column, row] = place.map(|at| (at as usize).min(PARTS - 1));
            row * PARTS + column
        };
        places.iter().map(|at| at.as_ref().map(part)).collect()
    }

    /// The mean correlation of the patches in each of their [parts](Self::parts).
    fn by_part(&self, parts: &[Option<usize>], moved: f64) -> [Option<f64>; PARTS * PARTS] {
        let factor = moved.exp();
        let mut means = [(0.0, 0_usize); PARTS * PARTS];
        for ((patch, rays), part) in self.patches.iter().zip(parts) {
            let Some(part) = *part else { continue };
            if let Some(r) = correlation(patch, rays, self.other.photo, factor) {
                means[part].0 += r;
                means[part].1 += 1;
            }
        }
        means.map(|(sum, count)| (count >= FEWEST_OF_PART).then(|| sum / count as f64))
    }

    /// The mean correlation of the patches that the other photo shows whole.
    fn matched(&self, moved: f64) -> Option<Match> {
        let factor = moved.exp();
        let each = self.patches.iter();
        let each =
            each.filter_map(|(patch, rays)| correlation(patch, rays, self.other.photo, factor));
        let (sum, count) = each.fold((0.0, 0), |(sum, count), r| (sum + r, count + 1));
        (count >= FEWEST).then(|| Match {
            moved,
            mean: sum / count as f64,
            patches: count,
        })
    }
}

/// What a best match says that is not clear, of the patches that the other photo shows at the surface and of all.
fn not_clear(best: &Match, shown: usize, all: usize) -> Look {
    let is_told = shown >= MANY && shown as f64 / all as f64 >= MUCH;
    let is_chance = best.weight() < (LEAST_MATCH * (shown as f64).sqrt()).max(BY_CHANCE);
    match best.mean < LEAST_MATCH || is_chance {
        true if is_told => Look::Nowhere,
        true if shown >= FEWEST_OF_NONE => Look::FewNowhere,
        _ => Look::Unclear,
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
fn correlation(patch: &Patch, rays: &Rays, photo: &SmallPhoto, factor: f64) -> Option<f64> {
    let [columns, rows, ahead] = rays.places(factor as f32);
    if !ahead.iter().all(|z| *z > 0.0) {
        return None;
    }
    let mut seen = photo.at(&columns, &rows)?;
    normalised(&mut seen).then(|| f64::from(dot(&patch.shades, &seen)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Best matches that were not clear, as they were seen: of flights whose photos were renamed (the lab and piles with a ring), and of
    /// right ones (a bench with a ring, streets in Berlin that are nearly in one line). Nothing may be said of the right ones alone.
    #[test]
    fn what_is_not_clear_is_nowhere_or_nothing() {
        for (mean, patches, shown, all, wanted) in [
            (0.124, 110, 505, 2949, Look::Nowhere),
            (0.049, 700, 716, 2975, Look::Nowhere),
            (0.016, 2856, 2856, 2955, Look::Nowhere),
            (0.102, 82, 81, 2689, Look::FewNowhere),
            (0.072, 87, 87, 2573, Look::FewNowhere),
            (0.041, 300, 356, 2689, Look::FewNowhere),
            // Right ones.
            (0.199, 44, 44, 2532, Look::Unclear),
            (0.157, 42, 42, 2547, Look::Unclear),
            (0.388, 1400, 1459, 1462, Look::Unclear),
            (0.160, 2600, 2688, 2743, Look::Unclear),
        ] {
            let best = Match {
                moved: 0.1,
                mean,
                patches,
            };
            assert_eq!(not_clear(&best, shown, all), wanted, "{mean} of {shown}");
        }
    }
}
