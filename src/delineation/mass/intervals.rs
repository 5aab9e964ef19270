//! How sure the sizes of a distribution by mass are: 95 % intervals from draws.
//!
//! Of each draw photos and fragments are drawn anew with replacement (the bootstrap: Efron 1979), which says how
//! far chance has chosen them; the share of fines is drawn about what was measured of the engine
//! on simulated piles, which says how far its outlines and the model are off. What sizes as a whole are off by that, and by the
//! scale's standard error, goes with the draws as it is (`ends.rs`). Photos are drawn where there are three or more: of fewer nobody
//! knows how they differ.
//!
//! Ends are not to change where hardly anything does, as with a small fragment that is taken away: so each fragment is drawn by
//! numbers of its own (`drawn.rs`), and nothing is drawn that can be reckoned.
//!
//! Drawing whole fragments anew gives none that is larger than those. Where the coarse end of a pile hardly fits into the photos, most of
//! it is cut by their edges; how much is larger than what is whole follows from the area of the cut ones
//! (`Counted::size_at_most`), and upper ends are drawn with that. Where an upper end lies among them, there
//! is none.

use fragscale_core::fault::Fault;
use fragscale_core::scale::Draws;
use fragscale_core::split_mix::{SplitMix, spread};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};

use crate::engine::Habits;
use crate::mass::counted::Counted;
use crate::mass::drawn::Redrawn;
use crate::mass::ends::at_share;
use crate::mass::{ByMass, PhotoFragments, Steps};

/// Of outlines that are as right as they can be. Nobody knows a pile's porosity: by outlines of simulated piles a P50 is as it
/// is by the sieves with the usual one, 11 % too small with none, 3 % too large with 0.5.
const OF_OTHERS: [f64; 2] = [0.07, 0.2];

/// How many draws: the ends of an interval are known to a fiftieth of its width by the draws alone, and the better the more of the width
/// is of errors that are not drawn.
const DRAWS: u32 = 1000;

/// Photos from which on they are drawn, too.
const FEW: usize = 3;

/// The part of the draws beyond each end.
const TAIL: f64 = 0.025;

/// What is not known but for chance. Standard errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Doubts {
    /// Of all sizes together, relative: outlines, and what a sieve makes of them.
    pub sizes: f64,
    /// Of the share of what is not outlined that is fines, 0 to 1.
    pub fines: f64,
    /// Of the scale, relative.
    pub scale: f64,
}

impl Doubts {
    /// Of what an engine outlined, `None` for other tools and people, in photos whose scale has this relative
    /// standard error.
    pub fn of(engine: Option<Habits>, scale: Option<f64>) -> Self {
        let [sizes, fines] = engine.map_or(OF_OTHERS, |habits| habits.doubts);
        Self {
            sizes,
            fines,
            scale: scale.unwrap_or(0.0),
        }
    }
}

impl Doubts {
    /// The greater of both, each by itself.
    #[must_use]
    pub fn or_greater(self, other: Self) -> Self {
        Self {
            sizes: self.sizes.max(other.sizes),
            fines: self.fines.max(other.fines),
            scale: self.scale.max(other.scale),
        }
    }
}

/// The 95 % interval of the size that a percent of the mass passes; an end is `None` where it lies outside of
/// what was measured: below the limit, or among fragments too large to be seen whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SizeInterval {
    /// The percent.
    pub percent: f64,
    /// The lower end, in the fragments' unit.
    pub low: Option<f64>,
    /// The upper end.
    pub high: Option<f64>,
}

impl SizeInterval {
    /// The percents that engineers speak of.
    pub const PERCENTS: [f64; 3] = [20.0, 50.0, 80.0];
}

/// The intervals of these percents. The same on every run, and by any number of threads.
///
/// # Errors
/// Where no photo shows a whole fragment.
pub fn intervals(
    photos: &[(&PhotoFragments, Steps)],
    doubts: Doubts,
    percents: &[f64],
) -> Result<Vec<SizeInterval>, Fault> {
    let limit = Counted::of(photos.iter().copied())?.limit;
    let photos = photos
        .iter()
        .map(|(photo, steps)| Redrawn::of(photo, *steps));
    let photos: Vec<Redrawn> = photos.collect();
    let normal = Normal::standard();
    let drawn = (0..DRAWS).into_par_iter().map(|draw| {
        // One from each of as many equally likely parts: fragments are drawn by chance, whichever comes with which.
        let more = normal.inverse_cdf((f64::from(draw) + 0.5) / f64::from(DRAWS));
        drawn_sizes(&photos, u64::from(draw), doubts.fines * more, percents)
    });
    let drawn: Vec<_> = drawn.collect();
    let drawn = drawn.into_iter().filter_map(Result::transpose);
    let drawn = drawn.collect::<Result<Vec<_>, Fault>>()?;
    let deviation = doubts.sizes.hypot(doubts.scale);
    let end = |place: usize, side: usize, share: f64| {
        let logarithms = drawn.iter().map(|of| of[place][side]).collect();
        let end = at_share(logarithms, deviation, share);
        // What is below the limit is not claimed, and an end there neither.
        (end.is_finite() && end >= limit.ln()).then(|| end.exp())
    };
    let percents = percents.iter().enumerate();
    Ok(percents
        .map(|(place, percent)| SizeInterval {
            percent: *percent,
            low: end(place, 0, TAIL),
            high: end(place, 1, 1.0 - TAIL),
        })
        .collect())
}

/// Of each percent the size that it passes in a draw, and what that is at most, as logarithms: what is below the limit of what is
/// seen is less than all that is above it. Of what nobody outlined `more_fines` more are fines. `None` where a draw holds none but
/// cut ones.
fn drawn_sizes(
    photos: &[Redrawn],
    draw: u64,
    more_fines: f64,
    percents: &[f64],
) -> Result<Option<Vec<[f64; 2]>>, Fault> {
    let mut seeds = SplitMix(spread(draw));
    let one = |place: usize| {
        let seed = seeds.next();
        let photo = &photos[match photos.len() < FEW {
            true => place,
            false => Draws::new(seed).place(photos.len()),
        }];
        (photo, photo.times(seed))
    };
    let drawn: Vec<(&Redrawn, Vec<f64>)> = (0..photos.len()).map(one).collect();
    let drawn = drawn.iter().map(|(of, times)| {
        let fines = (of.steps.fines + more_fines).clamp(0.0, 1.0);
        (&of.photo, Steps { fines, ..of.steps }, Some(&times[..]))
    });
    let Ok(all) = Counted::of_drawn(drawn) else {
        return Ok(None);
    };
    let curve = all.curve()?;
    let sizes = percents.iter().map(|percent| {
        let sizes = [curve.size_at(*percent), all.size_at_most(&curve, *percent)];
        sizes.map(|size| size.map_or(f64::NEG_INFINITY, f64::ln))
    });
    Ok(Some(sizes.collect()))
}

/// That sizes have no upper end, because too much of what is coarse is cut; `None` where all have one.
pub fn coarse_end_not_shown(by_mass: &ByMass, intervals: &[SizeInterval]) -> Option<String> {
    let open = intervals.iter().filter(|of| {
        let size = by_mass.curve.size_at(of.percent);
        of.high.is_none() && size.is_some_and(|size| size > by_mass.limit)
    });
    let names: Vec<String> = open.map(|of| format!("P{}", of.percent)).collect();
    let (whole, cut) = (by_mass.whole, by_mass.cut);
    (!names.is_empty()).then(|| {
        format!(
            "{cut} of {} fragments are cut by the photo's edge or what is no rock, and cover more than the whole ones stand for: the coarse end is \
             not shown, and {} \
             {} no upper end; take photos from farther away",
            whole + cut,
            names.join(" and "),
            if names.len() == 1 { "has" } else { "have" }
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass::tests::fragment;

    const NONE: Doubts = Doubts {
        sizes: 0.0,
        fines: 0.0,
        scale: 0.0,
    };

    /// Sizes of 1 to 10, their logarithms as likely: by area (s^2 - 1) / 99 of them are smaller than s, and half
    /// below the root of 50.5.
    fn photo(count: usize, draws: &mut Draws) -> PhotoFragments {
        let size = |draws: &mut Draws| 10f64.powf(draws.place(1 << 20) as f64 / (1 << 20) as f64);
        let fragments = (0..count).map(|_| fragment(size(draws), 0.0, false));
        PhotoFragments {
            fragments: fragments.collect(),
            frame: glam::DVec2::splat(100.0),
            fines: 0.0,
            limit: 0.9,
            mm: 1.0,
        }
    }

    #[test]
    fn chance_is_within_the_interval_as_often_as_it_says() {
        let truth = 50.5f64.sqrt();
        let mut draws = Draws::new(3);
        let holds = (0..100).filter(|_| {
            let photo = photo(250, &mut draws);
            let found = intervals(&[(&photo, Steps::default())], NONE, &[50.0]).unwrap()[0];
            (found.low.unwrap()..=found.high.unwrap()).contains(&truth)
        });
        let holds = holds.count();
        assert!((88..=100).contains(&holds), "{holds}");
    }

    /// As a user found: one small fragment of 1361 less moved P50 by 0.02 % and its upper end by 4.6 %. Each in turn becomes fines,
    /// with all doubts and with none.
    #[test]
    fn a_small_fragment_less_moves_no_end() {
        let mut photo = photo(1000, &mut Draws::new(12));
        for (number, fragment) in (0_u32..).zip(&mut photo.fragments) {
            let place = glam::DVec2::new(f64::from(number % 40), f64::from(number / 40));
            fragment.middle = 25.3 * place;
        }
        photo.fines = 1700.0;
        let sizes = photo.fragments.iter().map(|of| of.world.unwrap());
        let small = sizes.enumerate().filter(|(_, of)| of.sieve_size < 2.5);
        let small: Vec<(usize, f64)> = small.map(|(place, of)| (place, of.area)).collect();
        for (steps, doubts) in [
            (Steps::of(None), Doubts::of(None, Some(0.01))),
            (Steps::default(), NONE),
        ] {
            let ends = |of: &PhotoFragments| -> Vec<f64> {
                let found = intervals(&[(of, steps)], doubts, &SizeInterval::PERCENTS).unwrap();
                let ends = found.iter().flat_map(|of| [of.low, of.high]);
                ends.map(Option::unwrap).collect()
            };
            let before = ends(&photo);
            for (place, area) in small.iter().step_by(40) {
                let mut less = photo.clone();
                less.fragments.remove(*place);
                less.fines += area;
                for (now, before) in ends(&less).iter().zip(&before) {
                    let off = now / before - 1.0;
                    assert!(off.abs() < 0.002, "{place}: {now}, before {before}");
                }
            }
        }
    }

    #[test]
    fn ends_are_the_same_in_every_order_and_by_one_thread() {
        let mut draws = Draws::new(5);
        let mut photos: Vec<PhotoFragments> = (0..3).map(|_| photo(60, &mut draws)).collect();
        for photo in &mut photos {
            for (number, fragment) in (0_u32..).zip(&mut photo.fragments) {
                fragment.middle.x = 10.0 * f64::from(number);
            }
        }
        let doubts = Doubts::of(None, Some(0.02));
        let all = |photos: &[PhotoFragments]| -> Vec<SizeInterval> {
            let photos = photos.iter().map(|of| (of, Steps::of(None)));
            let photos: Vec<(&PhotoFragments, Steps)> = photos.collect();
            intervals(&photos, doubts, &SizeInterval::PERCENTS).unwrap()
        };
        let found = all(&photos);
        assert!(found.iter().all(|of| of.low < of.high));
        let one = rayon::ThreadPoolBuilder::new().num_threads(1);
        assert_eq!(one.build().unwrap().install(|| all(&photos)), found);
        for photo in &mut photos {
            photo.fragments.reverse();
        }
        assert_eq!(all(&photos), found);
    }

    /// Discs of 30 and of 8 strewn evenly over far more than a frame of 40 by 30, as much area of each: hardly one of 30 is ever whole.
    /// 80 % pass 30, which the upper end holds or does not state.
    #[test]
    fn what_hardly_fits_into_the_photo_is_within_the_interval() {
        let mut draws = Draws::new(8);
        let (frame, mut holds, mut open) = (glam::DVec2::new(40.0, 30.0), 0, 0);
        for _ in 0..60 {
            let mut fragments = Vec::new();
            for size in [8.0_f64, 30.0] {
                // So many that their discs would cover half of it all.
                let around = frame + size;
                let count = (0.5 * around.x * around.y / (std::f64::consts::PI / 4.0 * size * size))
                    as usize;
                for _ in 0..count.max(1) {
                    let unit = |draws: &mut Draws| draws.place(1 << 20) as f64 / f64::from(1 << 20);
                    let middle =
                        glam::DVec2::new(unit(&mut draws), unit(&mut draws)) * around - size / 2.0;
                    let inside = (middle.min(frame - middle)).min_element() / size;
                    let mut one = fragment(size, size, inside < 0.5);
                    // Of a cut one about so much is seen.
                    if let Some(world) = one.world.as_mut() {
                        world.area *= (0.5 + inside).clamp(0.0, 1.0);
                    }
                    fragments.push(one);
                }
            }
            let photo = PhotoFragments {
                fragments,
                frame,
                fines: 0.0,
                limit: 1.0,
                mm: 1.0,
            };
            let steps = Steps::default();
            let Ok(found) = intervals(&[(&photo, steps)], NONE, &[80.0]) else {
                continue;
            };
            holds += usize::from(found[0].high.is_none_or(|high| high >= 30.0));
            open += usize::from(found[0].high.is_none());
            let by_mass = crate::mass::by_mass([(&photo, steps)]).unwrap();
            let said = coarse_end_not_shown(&by_mass, &found);
            assert_eq!(said.is_some(), found[0].high.is_none(), "{said:?}");
        }
        assert!(holds >= 54 && open > 30, "{holds} {open}");
    }

    /// What was left out in the midst of a photo cuts fragments of all sizes: that says nothing of the coarse end.
    #[test]
    fn what_is_left_out_hides_no_coarse_end() {
        let mut photo = photo(400, &mut Draws::new(9));
        photo.frame = glam::DVec2::splat(1e6);
        let before = intervals(&[(&photo, Steps::default())], NONE, &[80.0]).unwrap()[0];
        for fragment in photo.fragments.iter_mut().step_by(5) {
            fragment.is_cut = true;
        }
        let found = intervals(&[(&photo, Steps::default())], NONE, &[80.0]).unwrap()[0];
        let [before, found] = [before, found].map(|of| of.high.unwrap());
        assert!((found / before - 1.0).abs() < 0.1, "{found} {before}");
        // By the photo's edge, of which there is none to speak of here, it would.
        for fragment in photo.fragments.iter_mut().step_by(5) {
            fragment.is_at_edge = true;
        }
        let found = intervals(&[(&photo, Steps::default())], NONE, &[80.0]).unwrap()[0];
        assert!(
            found.high.is_none_or(|high| high > 1.05 * before),
            "{found:?}"
        );
    }

    /// Of very many fragments chance says nothing: what is left is what was put in, 1.96 standard errors each way.
    #[test]
    fn doubts_are_as_wide_as_they_are() {
        let photo = photo(6000, &mut Draws::new(4));
        let doubts = Doubts {
            sizes: 0.08,
            scale: 0.06,
            ..NONE
        };
        let found = intervals(&[(&photo, Steps::default())], doubts, &[50.0]).unwrap()[0];
        let width = (found.high.unwrap() / found.low.unwrap()).ln();
        assert!((width / (2.0 * 1.96 * 0.1) - 1.0).abs() < 0.12, "{width}");
        // Below the limit of what is seen nothing is said.
        let mut dusty = photo;
        dusty.fines = dusty
            .fragments
            .iter()
            .filter_map(|of| Some(of.world?.area))
            .sum();
        let found = intervals(&[(&dusty, Steps::default())], doubts, &[20.0, 80.0]).unwrap();
        assert_eq!((found[0].low, found[0].high), (None, None));
        assert!(found[1].low.is_some());
    }
}
