//! Whole fragments with the mass that each stands for, and the curve that they come to.
//!
//! The curve's rows are sizes of the R10 series (ten to a factor of ten, ISO 3) of millimetres, whatever the world's lengths count in, from the limit on, so that sieves find
//! theirs, and about each tenth of the mass the two fragments between which it lies: P10, P20 ... P90 of the curve are
//! those of the fragments themselves, and not of a line from row to row. What a row says is what passes there, exactly.

use fragscale_core::fault::Fault;
use fragscale_fragmentation::SizeDistribution;
use glam::DVec2;

use crate::mass::{PhotoFragments, Steps};

/// Sizes per factor of ten.
const PER_DECADE: f64 = 10.0;

/// What photos show, and what their fragments count.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Counted {
    /// Of each fragment that counts, in the order of the photos: its size, and the mass that it stands for.
    pub(crate) whole: Vec<[f64; 2]>,
    /// How much of the area that nobody outlined is fines.
    pub(crate) of_fines: f64,
    /// How many an edge cuts.
    pub(crate) cut: usize,
    /// The area of all fragments.
    pub(crate) rock: f64,
    /// The area that nobody outlined.
    pub(crate) fines: f64,
    /// Below this size nothing is claimed.
    pub(crate) limit: f64,
    /// How many millimetres one of these lengths is.
    pub(crate) mm: f64,
    /// The area of fragments that are too large to be seen whole: see [`Counted::size_at_most`].
    pub(crate) unseen: f64,
    /// The mass that one of their area stands for: as that of the largest whole one.
    pub(crate) mass_of_unseen: f64,
}

impl Counted {
    /// Of all photos together, each by its own steps: 1 to 5 of [`crate::mass`].
    ///
    /// # Errors
    /// Where no photo shows a whole fragment.
    pub(crate) fn of<'a>(
        photos: impl IntoIterator<Item = (&'a PhotoFragments, Steps)>,
    ) -> Result<Self, Fault> {
        let once = photos.into_iter();
        Self::of_drawn(once.map(|(photo, steps)| (photo, steps, None)))
    }

    /// The same of fragments that were drawn: each photo with how many times each of its fragments is there, in their order;
    /// `None` where each is there once.
    ///
    /// # Errors
    /// Where no whole one is among them.
    pub(crate) fn of_drawn<'a>(
        photos: impl IntoIterator<Item = (&'a PhotoFragments, Steps, Option<&'a [f64]>)>,
    ) -> Result<Self, Fault> {
        let mut counted = Self {
            whole: Vec::new(),
            of_fines: 0.0,
            cut: 0,
            rock: 0.0,
            fines: 0.0,
            limit: 0.0,
            mm: 1.0,
            unseen: 0.0,
            mass_of_unseen: 1.0,
        };
        let mut off_surface = 0;
        // Those seen between others, by their places in `whole`.
        let (mut between, mut pores) = (Vec::new(), None);
        for (photo, steps, times) in photos {
            let first = counted.whole.len();
            let (rock_before, mut beside_no_rock) = (counted.rock, 0.0);
            counted.of_fines += steps.fines * photo.fines;
            counted.limit = counted.limit.max(photo.limit / steps.engine);
            counted.fines += photo.fines;
            counted.mm = photo.mm;
            for (place, fragment) in photo.fragments.iter().enumerate() {
                let times = times.map_or(1.0, |times| times[place]);
                if times == 0.0 {
                    continue;
                }
                let Some(world) = fragment.world else {
                    off_surface += 1;
                    continue;
                };
                counted.rock += times * world.area;
                if fragment.is_cut {
                    counted.cut += 1;
                    if !fragment.is_at_edge {
                        beside_no_rock += times * world.area;
                    }
                    continue;
                }
                let stands_for = match steps.edges {
                    true => {
                        let seldom =
                            (DVec2::ONE - fragment.extent / photo.frame).max(DVec2::splat(0.02));
                        1.0 / (seldom.x * seldom.y)
                    }
                    false => 1.0,
                };
                let mass = times * world.area * stands_for;
                counted.whole.push([world.sieve_size / steps.engine, mass]);
            }
            if steps.edges {
                let stands_for = counted.whole[first..].iter().map(|[_, area]| area);
                // What was left out cuts small ones as it cuts large ones, and of it nothing is known beforehand.
                let at_edge_or_whole = counted.rock - rock_before - beside_no_rock;
                counted.unseen += at_edge_or_whole - stands_for.sum::<f64>();
            }
            if steps.pores.is_some() {
                pores = steps.pores;
                between.extend(first..counted.whole.len());
            }
        }
        if counted.whole.is_empty() {
            return Err(counted.nothing(off_surface));
        }
        counted.unseen = counted.unseen.max(0.0);
        let sizes = counted.whole.iter().enumerate();
        let largest = sizes.max_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
        let largest = largest.map(|(place, [_, area])| (place, *area));
        if let Some(porosity) = pores {
            counted.seen_between(&between, porosity);
        }
        if let Some((place, area)) = largest {
            counted.mass_of_unseen = counted.whole[place][1] / area;
        }
        Ok(counted)
    }

    /// The size that a percent of the mass passes at most; infinite where it lies among fragments that are too large to be seen whole.
    ///
    /// What whole fragments stand for by step 1 is, but for chance, all area that is covered, that of the cut ones included (Miles
    /// 1974). What it lacks is of fragments that a photo hardly ever shows whole, of sizes that nobody knows: larger than the whole
    /// ones. On the curve they are spread over all sizes, at most they are the largest.
    pub(crate) fn size_at_most(&self, curve: &SizeDistribution, percent: f64) -> Option<f64> {
        let (fines, share) = (self.fines_share(), percent / 100.0);
        let seen: f64 = self.whole.iter().map(|[_, mass]| mass).sum();
        let unseen = self.unseen * self.mass_of_unseen / seen;
        let among_seen = (share - fines) / (1.0 - fines) * (1.0 + unseen);
        match among_seen {
            1.0.. if unseen > 0.0 => Some(f64::INFINITY),
            0.0..=1.0 => curve.size_at(100.0 * (fines + (1.0 - fines) * among_seen)),
            // Among the fines, or all is fines.
            _ => curve.size_at(percent),
        }
    }

    /// Takes these fragments for seen between others. Together they keep their share of the mass beside those of photos that
    /// are taken otherwise.
    fn seen_between(&mut self, places: &[usize], porosity: f64) {
        let mut those: Vec<[f64; 2]> = places.iter().map(|place| self.whole[*place]).collect();
        let sum = |of: &[[f64; 2]]| of.iter().map(|[_, mass]| mass).sum::<f64>();
        let before = sum(&those);
        seen_between(&mut those, porosity);
        let factor = before / sum(&those);
        for (place, [_, mass]) in places.iter().zip(&those) {
            self.whole[*place][1] = mass * factor;
        }
    }

    /// The share of the mass that is fines, 0 to 1.
    pub(crate) fn fines_share(&self) -> f64 {
        self.of_fines / (self.fines + self.rock)
    }

    /// Why there is no whole fragment.
    fn nothing(&self, off_surface: usize) -> Fault {
        if self.cut > 0 {
            let what =
                "every fragment is cut by the photo's edge or by what is excluded or no rock";
            let remedy = "look whether the outlines are of fragments and not of what lies between; or take photos from farther away";
            return Fault::new(what, remedy);
        }
        if off_surface > 0 {
            let what = "no fragment lies on the surface";
            return Fault::new(what, "reconstruct the pile where the photo shows it");
        }
        let remedy = "look at the outlines, and whether they are of this photo; outline it by another engine, or by hand";
        Fault::new("no fragment is outlined", remedy)
    }

    /// The distribution, fines and all.
    ///
    /// # Errors
    /// Where a size is no number.
    pub(crate) fn curve(&self) -> Result<SizeDistribution, Fault> {
        let fines = self.fines_share();
        let passed = self.ascending();
        let Some(&[largest, total]) = passed.last() else {
            return SizeDistribution::new(Vec::new());
        };
        let percent_at = |size: f64| {
            let behind = passed.partition_point(|[own, _]| *own <= size);
            let passed = behind.checked_sub(1).map_or(0.0, |last| passed[last][1]);
            match size >= largest {
                true => 100.0,
                false => 100.0 * (fines + (1.0 - fines) * (passed / total).min(1.0)),
            }
        };
        let start = self.limit.max(largest * 1e-4);
        let mut sizes = vec![start, largest];
        for ten in 1..10 {
            let wanted = f64::from(10 * ten);
            let reached = passed.partition_point(|[size, _]| percent_at(*size) < wanted);
            let about = reached.saturating_sub(1)..=reached;
            sizes.extend(
                passed
                    .get(about)
                    .into_iter()
                    .flatten()
                    .map(|[size, _]| size),
            );
        }
        let preferred = |step: i32| 10f64.powf(f64::from(step) / PER_DECADE) / self.mm;
        let first = ((start * self.mm).log10() * PER_DECADE).ceil() as i32;
        sizes.extend((first..).map(preferred).take_while(|size| *size < largest));
        sizes.retain(|size| *size >= start);
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        if sizes.len() < 2 {
            // A curve has two points.
            sizes.push(start * 10f64.powf(1.0 / PER_DECADE));
        }
        SizeDistribution::new(
            sizes
                .into_iter()
                .map(|size| [size, percent_at(size)])
                .collect(),
        )
    }

    /// The sizes that there are, ascending, each with the mass of what is not larger.
    fn ascending(&self) -> Vec<[f64; 2]> {
        let mut sorted = self.whole.clone();
        sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut ascending: Vec<[f64; 2]> = Vec::new();
        let mut passed = 0.0;
        for [size, mass] in sorted {
            passed += mass;
            match ascending.last_mut().filter(|last| last[0] == size) {
                Some(last) => last[1] = passed,
                None => ascending.push([size, passed]),
            }
        }
        ascending
    }

    /// The share of the mass, 0 to 1, that lies with other fragments than in `now`, which are the same fragments counted
    /// otherwise: half of the sum of what they differ by.
    pub(crate) fn moved(&self, now: &Self) -> f64 {
        let total = |of: &Self| of.whole.iter().map(|[_, mass]| mass).sum::<f64>();
        let (before, after) = (total(self), total(now));
        let pairs = self.whole.iter().zip(&now.whole);
        pairs
            .map(|(a, b)| (a[1] / before - b[1] / after).abs())
            .sum::<f64>()
            / 2.0
    }
}

/// From areas to what they stand for: step 4 of [`crate::mass`]. Sizes with their weights.
fn seen_between(fragments: &mut [[f64; 2]], porosity: f64) {
    let porosity = porosity.clamp(0.0, 0.9);
    let areas: Vec<f64> = fragments.iter().map(|[_, area]| *area).collect();
    // The mean size by surface is that of the masses, which follow from it: in the first rounds it comes near.
    for _ in 0..20 {
        let mass: f64 = fragments.iter().map(|[_, mass]| mass).sum();
        let surface: f64 = fragments.iter().map(|[size, mass]| mass / size).sum();
        let free = 2.0 / 3.0 * porosity / (1.0 - porosity) * mass / surface;
        for ([size, mass], area) in fragments.iter_mut().zip(&areas) {
            *mass = area * *size / (0.5 * *size + free);
        }
    }
}

#[cfg(test)]
mod tests {
    use fragscale_core::split_mix::SplitMix;
    use glam::DVec3;

    use super::*;
    use crate::mass::by_mass;
    use crate::mass::tests::fragment;

    fn counted(fragments: &[[f64; 2]], limit: f64, of_fines: f64) -> Counted {
        Counted {
            whole: fragments.to_vec(),
            of_fines,
            cut: 0,
            rock: 0.5,
            fines: 0.5,
            limit,
            mm: 1.0,
            unseen: 0.0,
            mass_of_unseen: 1.0,
        }
    }

    /// 1000 fragments of all masses: each tenth lies between two neighbours of the sorted list, found here one by one, and
    /// every row says what passes it.
    #[test]
    fn tenths_are_those_of_the_fragments() {
        let mut random = SplitMix(7);
        let mut unit = || random.unit();
        let fragments: Vec<[f64; 2]> = (0..1000)
            .map(|_| [10f64.powf(unit() * 1.3), unit()])
            .collect();
        for fines in [0.0, 0.23] {
            let curve = counted(&fragments, 1.0, fines).curve().unwrap();
            let total: f64 = fragments.iter().map(|of| of[1]).sum();
            let passing = |size: f64| {
                let own = fragments.iter().filter(|of| of[0] <= size);
                100.0 * (fines + (1.0 - fines) * own.map(|of| of[1]).sum::<f64>() / total)
            };
            for [size, percent] in curve.points() {
                assert!((percent - passing(*size)).abs() < 1e-9, "{size}");
            }
            let mut sorted: Vec<f64> = fragments.iter().map(|of| of[0]).collect();
            sorted.sort_by(f64::total_cmp);
            for percent in [30.0, 50.0, 80.0, 90.0] {
                let reached = sorted.iter().position(|size| passing(*size) >= percent);
                let reached = reached.unwrap();
                let found = curve.size_at(percent).unwrap();
                assert!((sorted[reached - 1]..=sorted[reached]).contains(&found));
            }
            // Of fewer than the fines nothing is said.
            assert_eq!(curve.size_at(20.0).is_some(), fines < 0.2);
            assert_eq!(curve.points().last(), Some(&[sorted[999], 100.0]));
        }
    }

    /// The same fragments in feet have the same rows.
    #[test]
    fn rows_are_round_millimetres_in_every_unit() {
        let in_mm = counted(&[[3.0, 1.0], [7.0, 2.0], [30.0, 1.0]], 2.5, 0.1);
        let mut in_feet = in_mm.clone();
        in_feet.mm = 304.8;
        in_feet.limit /= 304.8;
        in_feet.whole.iter_mut().for_each(|of| of[0] /= 304.8);
        let rows = |of: &Counted| -> Vec<[f64; 2]> {
            let curve = of.curve().unwrap();
            let points = curve.points().iter();
            points
                .map(|[size, percent]| [size * of.mm, *percent])
                .collect()
        };
        let (in_mm, in_feet) = (rows(&in_mm), rows(&in_feet));
        assert_eq!(in_mm.len(), in_feet.len());
        for (a, b) in in_mm.iter().zip(&in_feet) {
            assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9);
        }
        assert!(
            in_feet.iter().any(|of| (of[0] - 10.0).abs() < 1e-9),
            "{in_feet:?}"
        );
    }

    /// As a newcomer found: equal discs, a little nearer and farther. All of their sizes are in the curve, from the smallest on.
    #[test]
    fn nearly_equal_ones_hide_nothing() {
        let fragments: Vec<[f64; 2]> = (0..240)
            .map(|of| [1.145 + 0.875 * f64::from(of) / 239.0, 1.0])
            .collect();
        let curve = counted(&fragments, 1.145, 0.0).curve().unwrap();
        assert_eq!(curve.points()[0][0], 1.145);
        for percent in [20.0, 50.0, 80.0] {
            let wanted = 1.145 + 0.875 * percent / 100.0;
            let found = curve.size_at(percent).unwrap();
            assert!((found - wanted).abs() < 0.004, "P{percent}: {found}");
        }
    }

    /// As much area as the whole ones stand for is of fragments that none is whole of: half of the mass is larger than all that is
    /// seen, and what half of it passes is the largest.
    #[test]
    fn what_is_too_large_to_be_seen_whole() {
        let mut seen = counted(&[[1.0, 1.0], [2.0, 1.0], [3.0, 2.0]], 0.5, 0.0);
        let curve = seen.curve().unwrap();
        assert_eq!(seen.size_at_most(&curve, 50.0), curve.size_at(50.0));
        seen.unseen = 4.0;
        assert_eq!(seen.size_at_most(&curve, 25.0), curve.size_at(50.0));
        assert_eq!(
            seen.size_at_most(&curve, 49.9).map(|size| size > 2.9),
            Some(true)
        );
        assert_eq!(seen.size_at_most(&curve, 51.0), Some(f64::INFINITY));
    }

    /// One fragment, and many of one size, have a curve.
    #[test]
    fn one_size_alone() {
        for count in [1, 5] {
            let curve = counted(&vec![[2.0, 1.0]; count], 2.0, 0.1).curve().unwrap();
            assert_eq!(curve.points()[0], [2.0, 100.0]);
            assert_eq!(curve.points().len(), 2);
            let coarse = counted(&vec![[2.0, 1.0]; count], 0.5, 0.1).curve().unwrap();
            assert_eq!(coarse.points().last(), Some(&[2.0, 100.0]));
            assert!((coarse.points()[0][1] - 10.0).abs() < 1e-12);
        }
        // All of it below the limit: nothing is claimed but that.
        let hidden = counted(&[[2.0, 1.0], [1.0, 1.0]], 3.0, 0.0)
            .curve()
            .unwrap();
        assert_eq!(hidden.points()[0], [3.0, 100.0]);
    }

    #[test]
    fn says_why_there_is_none() {
        let photo = |fragments| PhotoFragments {
            fragments,
            frame: DVec2::splat(100.0),
            fines: 1.0,
            limit: 0.0,
            mm: 1.0,
        };
        let off = |is_cut| crate::measures::Fragment {
            world: None,
            ..fragment(1.0, 1.0, is_cut)
        };
        for (fragments, wanted) in [
            (vec![], "no fragment is outlined"),
            (
                vec![fragment(1.0, 1.0, true), off(false)],
                "every fragment is cut",
            ),
            (vec![off(false)], "no fragment lies on the surface"),
        ] {
            let fault = by_mass([(&photo(fragments), Steps::default())]).unwrap_err();
            assert!(fault.what.contains(wanted), "{fault}");
        }
    }

    /// Balls strewn through a volume at random, so that they overlap (a Boolean model, of which the free path is known to be
    /// exponential), and cut off at a level: those whose middle lies below it are seen from above. As much of the volume in
    /// small ones as in large ones: by area the small ones are far more, with the pores both are as many.
    #[test]
    fn what_is_seen_between_others() {
        let mut random = SplitMix(5);
        let mut unit = || random.unit();
        let (side, deep) = (150.0, 15.0);
        let sizes: [f64; 2] = [1.0, 4.0];
        // Each class would fill a quarter if none overlapped.
        let mut balls: Vec<(DVec3, f64)> = Vec::new();
        for size in sizes {
            let count = 0.25 * side * side * deep / (std::f64::consts::PI / 6.0 * size.powi(3));
            for _ in 0..count as usize {
                let place = DVec3::new(unit() * side, unit() * side, -deep * unit());
                balls.push((place, size / 2.0));
            }
        }
        // The highest over each of 600 x 600 places.
        let cells = 600;
        let mut top = vec![(f64::NEG_INFINITY, 0.0); cells * cells];
        let step = side / cells as f64;
        for (place, radius) in &balls {
            let first = |at: f64| (((at - radius) / step).ceil().max(0.0)) as usize;
            let last =
                |at: f64| ((((at + radius) / step).floor()).max(0.0) as usize).min(cells - 1);
            for y in first(place.y)..=last(place.y) {
                for x in first(place.x)..=last(place.x) {
                    let off = DVec2::new(x as f64 * step - place.x, y as f64 * step - place.y);
                    let below = radius * radius - off.length_squared();
                    let height = place.z + below.max(0.0).sqrt();
                    let own = &mut top[y * cells + x];
                    if below >= 0.0 && height > own.0 {
                        *own = (height, 2.0 * radius);
                    }
                }
            }
        }
        let area = |size: f64| top.iter().filter(|(_, own)| *own == size).count() as f64;
        let mut seen: Vec<[f64; 2]> = sizes.iter().map(|size| [*size, area(*size)]).collect();
        assert!(seen[0][1] > 1.5 * seen[1][1], "{seen:?}");
        // Where balls overlap the free path is 4 / (their surface in a volume) = (2/3) D / 0.5, that of bodies that do not
        // with e / (1 - e) = 2.
        seen_between(&mut seen, 2.0 / 3.0);
        let ratio = seen[0][1] / seen[1][1];
        assert!((0.9..1.1).contains(&ratio), "{ratio}");
        // Without pores it is a cut: nothing moves.
        let mut cut = [[1.0, 3.0], [4.0, 5.0]];
        seen_between(&mut cut, 0.0);
        assert!((cut[0][1] / cut[1][1] - 0.6).abs() < 1e-12);
    }
}
