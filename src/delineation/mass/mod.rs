//! From the fragments of photos to a size distribution by mass.
//!
//! The steps, each of which can be left out:
//!
//! 1. What a photo's edge cuts is not measured, and large fragments are cut more often. Each whole one stands
//!    for 1 / ((1 - w / W) (1 - h / H)) of its kind, w and h its extent, W and H the photo's (Miles 1974,
//!    Lantuejoul 1980). What that lacks to the area of all, cut ones included, is of fragments too large to be seen whole: it
//!    widens the intervals upwards (`intervals.rs`).
//! 2. An engine joins some fragments and does not find others, small ones before large ones: its sizes are too large, by how much
//!    was measured on simulated piles. They are taken smaller by as much, and with them the limit.
//! 3. The share of the visible area is taken for the share of the mass (Delesse 1847), which is right on a cut through
//!    rock.
//! 4. A pile's surface is no cut: whole bodies lie on it, and one looks down between them. A body whose middle lies at the
//!    surface or below shows all of its shadow as long as its top does not lie under the surface, over half of its size d;
//!    deeper down it is seen along lines that no other body meets, whose share falls off with the depth as exp(-depth / l).
//!    l is the mean free path between bodies, 4 (pores' volume) / (their surface) (Tomkeieff 1945), for round ones
//!    (2/3) e / (1 - e) D: e the porosity, D their mean size by surface (Sauter 1928). So a class with the volume V in a
//!    volume of the pile shows a share of the surface as V (d/2 + l) / d, and of what is seen an area A stands for a mass as
//!    A d / (d/2 + l). Without it small bodies count for too much: by ideal outlines of simulated piles, as loose as that, P50
//!    is 12 % and P80 7 % too small. A pile whose pores are full of fines is a cut, nearly: l is 0 then.
//! 5. Of what nobody outlined a part is fines, and the rest fragments that were not found, of the same kinds as
//!    those that were: how large a part was measured on simulated piles, engine by engine. Its share of the area
//!    is the fines' share of the mass.
//! 6. How the fines are distributed no photo shows. A law may say it (`tail.rs`).

mod counted;
mod drawn;
mod ends;
pub mod intervals;
mod notes;
mod photo_fragments;
mod steps;
pub mod tail;

use fragscale_core::fault::Fault;
use fragscale_fragmentation::SizeDistribution;

pub use self::photo_fragments::PhotoFragments;
pub use self::steps::{LOOSE, Step, Steps, WantedSteps};

use self::counted::Counted;

/// A size distribution by mass, and what it rests on.
#[derive(Debug, Clone, PartialEq)]
pub struct ByMass {
    /// Sizes in the fragments' unit.
    pub curve: SizeDistribution,
    /// Fragments that count.
    pub whole: usize,
    /// Fragments that an edge cuts.
    pub cut: usize,
    /// The share of the area that nobody outlined, 0 to 1.
    pub unfound: f64,
    /// The share of the mass that is taken for fines, 0 to 1.
    pub fines: f64,
    /// The size below which nothing is claimed.
    pub limit: f64,
    /// The area that the photos show.
    pub area: f64,
}

/// The distribution of all photos together, each by its own steps.
///
/// # Errors
/// Where no photo shows a whole fragment.
pub fn by_mass<'a>(
    photos: impl IntoIterator<Item = (&'a PhotoFragments, Steps)>,
) -> Result<ByMass, Fault> {
    by_mass_of(&Counted::of(photos)?)
}

fn by_mass_of(counted: &Counted) -> Result<ByMass, Fault> {
    Ok(ByMass {
        curve: counted.curve()?,
        whole: counted.whole.len(),
        cut: counted.cut,
        unfound: counted.fines / (counted.fines + counted.rock),
        fines: counted.fines_share(),
        limit: counted.limit,
        area: counted.fines + counted.rock,
    })
}

/// A step on the way from what is seen to the mass.
#[derive(Debug, Clone, PartialEq)]
pub struct StepTaken {
    /// Which.
    pub step: Step,
    /// The share of the mass that it moves from one size to another, 0 to 1; of fines what they are; all, where all sizes become
    /// others.
    pub share: f64,
    /// The distribution behind it.
    pub curve: SizeDistribution,
}

/// What each of the steps does that are taken for any of the photos.
///
/// # Errors
/// As [`by_mass`].
pub fn steps_taken(photos: &[(&PhotoFragments, Steps)]) -> Result<Vec<StepTaken>, Fault> {
    let mut so_far = vec![Steps::NONE; photos.len()];
    let of = |so_far: &[Steps]| -> Result<(Counted, ByMass), Fault> {
        let photos = photos.iter().zip(so_far);
        let counted = Counted::of(photos.map(|((photo, _), steps)| (*photo, *steps)))?;
        let by_mass = by_mass_of(&counted)?;
        Ok((counted, by_mass))
    };
    let (mut before, seen) = of(&so_far)?;
    let mut taken = vec![StepTaken {
        step: Step::Seen,
        share: 1.0,
        curve: seen.curve,
    }];
    for step in [Step::Edges, Step::Engine, Step::Pores, Step::Fines] {
        if !photos.iter().any(|(_, steps)| steps.takes(step)) {
            continue;
        }
        for (so_far, (_, steps)) in so_far.iter_mut().zip(photos) {
            *so_far = so_far.with(step, steps);
        }
        let (counted, now) = of(&so_far)?;
        let share = match step {
            Step::Fines => now.fines,
            Step::Engine => 1.0,
            _ => before.moved(&counted),
        };
        before = counted;
        taken.push(StepTaken {
            step,
            share,
            curve: now.curve,
        });
    }
    Ok(taken)
}

#[cfg(test)]
pub(crate) mod tests {
    use fragscale_core::split_mix::SplitMix;
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::measures::{Fragment, Measures};

    pub(crate) fn fragment(size: f64, extent: f64, is_cut: bool) -> Fragment {
        let area = std::f64::consts::PI / 4.0 * size * size;
        Fragment {
            number: 1,
            pixels: 1,
            middle: DVec2::ZERO,
            is_cut,
            is_at_edge: is_cut,
            extent: DVec2::splat(extent),
            world: Some(Measures {
                place: DVec3::ZERO,
                scale: 1.0,
                area,
                surface_area: area,
                diameter: size,
                rectangle: [size; 2],
                widths: [size; 2],
                inscribed: size,
                roundness: 1.0,
                height: Some(0.0),
                sieve_size: size,
            }),
        }
    }

    /// Circles of 1 and 2: their areas are as 1 to 4. As much fines as rock.
    fn two_circles() -> PhotoFragments {
        let fragments = vec![fragment(1.0, 0.0, false), fragment(2.0, 0.0, false)];
        let rock: f64 = fragments.iter().filter_map(|of| Some(of.world?.area)).sum();
        PhotoFragments {
            fragments,
            frame: DVec2::splat(100.0),
            fines: rock,
            limit: 0.9,
            mm: 1.0,
        }
    }

    #[test]
    fn shares_by_hand() {
        let photo = two_circles();
        let all = by_mass([(&photo, Steps::default())]).unwrap();
        assert_eq!((all.whole, all.cut, all.fines), (2, 0, 0.5));
        assert!((all.curve.percent_passing(1.5).unwrap() - 60.0).abs() < 1e-9);
        assert_eq!(all.curve.percent_passing(2.6), Some(100.0));
        let steps = Steps {
            fines: 0.0,
            ..Steps::default()
        };
        let rock_alone = by_mass([(&photo, steps)]).unwrap();
        assert!((rock_alone.curve.percent_passing(1.5).unwrap() - 20.0).abs() < 1e-9);
        assert!(by_mass([]).is_err());
    }

    /// Circles strewn evenly over far more than a frame of 100: those that it cuts are left out, more of the large
    /// ones. With the correction the shares are those of the strewn ones, without it they are not.
    #[test]
    fn edges_do_not_hide_the_large() {
        let mut random = SplitMix(11);
        let mut unit = || random.unit();
        let mut fragments = Vec::new();
        for number in 0..200_000 {
            // As many of 10 as of 40.
            let size = if number % 2 == 0 { 10.0 } else { 40.0 };
            let middle = DVec2::new(unit(), unit()) * 200.0 - 50.0;
            let far = (middle - 50.0).abs().max_element() - 50.0;
            if far < size / 2.0 {
                fragments.push(fragment(size, size, far > -size / 2.0));
            }
        }
        let photo = PhotoFragments {
            fragments,
            frame: DVec2::splat(100.0),
            fines: 0.0,
            limit: 1.0,
            mm: 1.0,
        };
        let small = |steps: Steps| {
            let all = by_mass([(&photo, steps)]).unwrap();
            all.curve.percent_passing(20.0).unwrap()
        };
        let strewn = 100.0 / 17.0;
        assert!(
            (small(Steps::default()) - strewn).abs() < 0.15,
            "{}",
            small(Steps::default())
        );
        let not = small(Steps {
            edges: false,
            ..Steps::default()
        });
        assert!(not > 11.0, "{not}");
    }

    #[test]
    fn steps_say_what_they_move() {
        let photo = two_circles();
        let steps = Steps {
            edges: true,
            engine: 1.0,
            pores: Some(0.5),
            fines: 1.0,
        };
        let taken = steps_taken(&[(&photo, steps)]).unwrap();
        let names: Vec<Step> = taken.iter().map(|of| of.step).collect();
        assert_eq!(names, [Step::Seen, Step::Edges, Step::Pores, Step::Fines]);
        // An engine's sizes, a quarter too large: all are smaller by that, the limit, too, and shares stay.
        let of_engine = Steps {
            engine: 1.25,
            ..steps
        };
        let by_engine = steps_taken(&[(&photo, of_engine)]).unwrap();
        assert_eq!((by_engine[2].step, by_engine[2].share), (Step::Engine, 1.0));
        let [before, after] = [steps, of_engine].map(|steps| by_mass([(&photo, steps)]).unwrap());
        for size in [1.0, 2.0] {
            let [before, after] = [(&before, size), (&after, size / 1.25)]
                .map(|(of, size)| of.curve.percent_passing(size).unwrap());
            assert!((before - after).abs() < 1e-9, "{before} {after}");
        }
        assert_eq!(after.limit, before.limit / 1.25);
        // Nothing is near an edge; half is fines.
        assert_eq!((taken[1].share, taken[3].share), (0.0, 0.5));
        let [before, now] = [&taken[1], &taken[2]].map(|of| of.curve.percent_passing(1.5).unwrap());
        assert!((taken[2].share - (before - now) / 100.0).abs() < 1e-9);
        assert!(before > now);
        assert_eq!(taken[3].curve, by_mass([(&photo, steps)]).unwrap().curve);
    }

    /// A photo of people's outlines beside one of an engine's: fines are summed over both areas, each by its own share; pores
    /// move masses among the fragments of the first alone, which keep their share of all.
    #[test]
    fn each_photo_by_its_own_steps() {
        let photo = two_circles();
        let other = PhotoFragments {
            fragments: vec![fragment(8.0, 0.0, false)],
            fines: 1.0,
            ..photo.without_fragments()
        };
        let rock = |of: &PhotoFragments| -> f64 {
            of.fragments
                .iter()
                .filter_map(|of| Some(of.world?.area))
                .sum()
        };
        let [of_people, of_engine] = [
            Steps {
                pores: Some(0.5),
                ..Steps::default()
            },
            Steps {
                fines: 0.6,
                ..Steps::default()
            },
        ];
        let all = [(&photo, of_people), (&other, of_engine)];
        let area = rock(&photo) + rock(&other) + photo.fines + other.fines;
        let fines = (photo.fines + 0.6 * other.fines) / area;
        let found = by_mass(all).unwrap();
        assert!((found.fines - fines).abs() < 1e-12);
        let small = found.curve.percent_passing(3.0).unwrap() / 100.0;
        let wanted = fines + (1.0 - fines) * rock(&photo) / (rock(&photo) + rock(&other));
        assert!((small - wanted).abs() < 1e-9, "{small} {wanted}");
        let taken = steps_taken(&all).unwrap();
        assert_eq!(taken.last().unwrap().curve, found.curve);
        assert!(taken.iter().any(|of| of.step == Step::Pores));
    }
}
