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
pub mod tail;

use fragscale_core::fault::Fault;
use fragscale_core::scale::ScaleField;
use fragscale_core::units::LengthUnit;
use fragscale_fragmentation::SizeDistribution;
use glam::DVec2;

use self::counted::Counted;
use crate::bare::bare;
use crate::engine::{Habits, LEAST_PIXELS_ACROSS};
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::measures::{Fragment, Measures};
use crate::outlined_by::OutlinedBy;

/// The largest circle within the outline of a ball, over the circle of its area: 0.97 and more in the nine photos of the
/// bundled flight, while no fragment among the largest 200 has over 0.93.
const AS_A_BALL: f64 = 0.95;
/// A ball is to be seen from afar: 1.8 to 2.3 times the next there.
const ALONE: f64 = 1.3;

/// What a photo contributes. Lengths in one unit.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoFragments {
    /// All that were outlined.
    pub fragments: Vec<Fragment>,
    /// Width and height of the photo, pixels.
    pub frame: DVec2,
    /// The area of what is fines, on planes parallel to the image.
    pub fines: f64,
    /// The size of the smallest fragment that the photo can show.
    pub limit: f64,
    /// How many millimetres one of these lengths is.
    pub mm: f64,
}

impl PhotoFragments {
    /// From a photo's label image, the scale field of all its pixels and the measures of its fragments, both in `unit`; the narrowest
    /// that its engine outlines is `least_across` pixels. Of what other tools and people outlined (`None`) the limit is the
    /// smallest that counts and is as wide as the narrowest that an engine outlines, or that width where none is: a speck and a
    /// line of pixels say nothing of the rest.
    pub fn new(
        labels: &LabelImage,
        field: &ScaleField,
        fragments: Vec<Fragment>,
        least_across: Option<f64>,
        unit: LengthUnit,
    ) -> Self {
        let (mut fines, mut area, mut pixels) = (0.0, 0.0, 0.0);
        for (place, label) in labels.labels.iter().enumerate() {
            let (column, row) = (place % labels.width, place / labels.width);
            let Some(scale) = field.scale_at(column as u32, row as u32) else {
                continue;
            };
            let own = 1.0 / (scale * scale);
            pixels += 1.0;
            area += own;
            if *label == FINES {
                fines += own;
            }
        }
        let scale: f64 = (pixels / area).sqrt();
        let counts = (fragments.iter()).filter(|of| !of.is_cut && !is_speck(of));
        let sizes = counts.filter_map(|of| Some(of.world?.sieve_size));
        let of_others = || {
            sizes
                .reduce(f64::min)
                .unwrap_or(LEAST_PIXELS_ACROSS / scale)
        };
        let limit = least_across.map_or_else(of_others, |across| across / scale);
        Self {
            frame: DVec2::new(labels.width as f64, labels.height as f64),
            fines,
            limit,
            fragments,
            mm: unit.in_units_of(LengthUnit::Millimetre),
        }
    }
}

/// Whether a fragment has fewer pixels than the narrowest that an engine outlines, or is not as wide.
fn is_speck(fragment: &Fragment) -> bool {
    let width = fragment.world.map(|of| of.widths[0] * of.scale);
    (fragment.pixels as f64) < std::f64::consts::PI / 4.0 * LEAST_PIXELS_ACROSS.powi(2)
        || width.is_some_and(|width| width < LEAST_PIXELS_ACROSS)
}

impl PhotoFragments {
    /// That there are outlines too small for the limit, where people and other tools made some.
    fn specks(&self) -> Option<String> {
        let is_below = |of: &&Fragment| {
            let size = of.world.filter(|_| !of.is_cut).map(|of| of.sieve_size);
            is_speck(of) && size.is_some_and(|size| size < self.limit)
        };
        let count = self.fragments.iter().filter(is_below).count();
        let outlines = if count == 1 { "outline" } else { "outlines" };
        (count > 0).then(|| {
            format!(
                "{count} {outlines} of less than {LEAST_PIXELS_ACROSS} pixels across: too small to be measured, and below the limit"
            )
        })
    }

    /// That some lie where nothing can be measured.
    fn off_surface(&self) -> Option<String> {
        let is_off = |of: &&Fragment| !of.is_cut && of.world.is_none();
        let count = self.fragments.iter().filter(is_off).count();
        let outlines = if count == 1 { "outline" } else { "outlines" };
        (count > 0).then(|| {
            format!(
                "{count} {outlines} of which too little lies on the surface, as over a hole of the cloud: not measured, and counted nowhere"
            )
        })
    }

    /// That the largest one seems to be a ball, which nobody traced as a scale object.
    fn ball(&self) -> Option<String> {
        let whole = self.fragments.iter().filter(|of| !of.is_cut);
        let mut whole: Vec<&Measures> = whole.filter_map(|of| of.world.as_ref()).collect();
        whole.sort_by(|a, b| b.sieve_size.total_cmp(&a.sieve_size));
        let [largest, next, ..] = whole[..] else {
            return None;
        };
        let is_ball = largest.inscribed > AS_A_BALL * largest.diameter
            && largest.sieve_size > ALONE * next.sieve_size;
        is_ball.then(|| {
            "its largest fragment is a circle, much larger than the next, and counts as rock; if it is a ball, trace it as a scale \
             object, or exclude it (window, page Fragments, tool Exclude)"
                .to_owned()
        })
    }

    /// That less of it is outlined than not.
    fn little(&self, labels: &LabelImage) -> Option<String> {
        let of =
            |wanted: fn(u32) -> bool| labels.labels.iter().filter(|label| wanted(**label)).count();
        let fines = of(|label| label == FINES);
        let rock = of(|label| label != FINES && label != NOT_ROCK);
        (rock > 0 && fines > rock).then(|| {
            format!(
                "only {:.0} % of it is outlined: where the rest is no fines (grass, floor, other things), its sizes say nothing; \
                 exclude that, or leave the photo out",
                100.0 * rock as f64 / (fines + rock) as f64
            )
        })
    }

    /// What is to be said of a photo's outlines, one sentence each. `by_engine`: of an engine's it is no wonder that some are narrower
    /// than its limit.
    pub fn notes(&self, labels: &LabelImage, by_engine: bool) -> Vec<String> {
        let little = self.little(labels);
        // That is more than a large piece of it.
        let bare = if little.is_none() { bare(labels) } else { None };
        let specks = if by_engine { None } else { self.specks() };
        let notes = [specks, self.off_surface(), self.ball(), bare, little];
        notes.into_iter().flatten().collect()
    }

    /// The same without any fragment.
    pub(crate) fn without_fragments(&self) -> Self {
        Self {
            fragments: Vec::new(),
            ..*self
        }
    }
}

/// Which steps are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Large fragments are cut more often.
    pub edges: bool,
    /// How many times too large the engine's sizes are; 1 where they are taken as they are.
    pub engine: f64,
    /// The porosity of the pile, between 0 and 1, where small bodies are seen deeper down between large ones; `None` where
    /// its surface is taken for a cut.
    pub pores: Option<f64>,
    /// How much of what nobody outlined is fines, 0 to 1; the rest are fragments that were not found.
    pub fines: f64,
}

impl Default for Steps {
    fn default() -> Self {
        Self {
            edges: true,
            engine: 1.0,
            pores: None,
            fines: 1.0,
        }
    }
}

impl Steps {
    /// The usual ones for what an engine outlined, or other tools and people (`None`). What these leave without an outline is
    /// fines. An engine does not find small fragments as often as large ones, which makes its sizes too large; without the pores
    /// they are too small, and the two make up for each other on simulated piles (docs/fragments.md): so the pores are left out there.
    pub fn of(engine: Option<Habits>) -> Self {
        Self {
            edges: true,
            engine: engine.map_or(1.0, |habits| habits.sizes_off),
            pores: engine.is_none().then_some(LOOSE),
            fines: engine.map_or(1.0, |habits| habits.fines_of_unfound),
        }
    }
}

/// The steps that somebody asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct WantedSteps {
    /// These alone; `None` where the usual ones are wanted.
    pub named: Option<Vec<Step>>,
    /// The porosity of the pile, where the pores are among them.
    pub porosity: f64,
}

impl Default for WantedSteps {
    fn default() -> Self {
        Self {
            named: None,
            porosity: LOOSE,
        }
    }
}

impl WantedSteps {
    /// Those for a photo that was outlined by this.
    pub fn of(&self, outlined: OutlinedBy<'_>) -> Steps {
        let usual = Steps::of(outlined.habits());
        let Some(named) = &self.named else {
            return Steps {
                pores: usual.pores.map(|_| self.porosity),
                ..usual
            };
        };
        let all = Steps {
            pores: Some(self.porosity),
            ..usual
        };
        named
            .iter()
            .fold(Steps::NONE, |steps, step| steps.with(*step, &all))
    }
}

/// The porosity of coarse crushed rock that was dumped and not compacted: 0.40 to 0.50 (void content of loose coarse aggregate,
/// ASTM C29; Kosmatka and Wilson, "Design and Control of Concrete Mixtures", 2011, chapter 6).
pub const LOOSE: f64 = 0.45;

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

/// The steps that can be left out, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Fragments by the area that is seen of them: where the way begins.
    Seen,
    /// [`Steps::edges`].
    Edges,
    /// [`Steps::engine`].
    Engine,
    /// [`Steps::pores`].
    Pores,
    /// [`Steps::fines`].
    Fines,
}

impl Steps {
    /// None of them.
    const NONE: Self = Self {
        edges: false,
        engine: 1.0,
        pores: None,
        fines: 0.0,
    };

    /// Which they are, in their order: "edges, pores and fines".
    pub fn in_words(&self) -> String {
        let all = [
            (Step::Edges, "edges"),
            (Step::Engine, "engine"),
            (Step::Pores, "pores"),
            (Step::Fines, "fines"),
        ];
        let taken = all.into_iter().filter(|(step, _)| self.takes(*step));
        let names: Vec<&str> = taken.map(|(_, name)| name).collect();
        match names.split_last() {
            None => "none".to_owned(),
            Some((only, [])) => (*only).to_owned(),
            Some((last, others)) => format!("{} and {last}", others.join(", ")),
        }
    }

    /// Whether a step is among them.
    fn takes(&self, step: Step) -> bool {
        match step {
            Step::Seen => true,
            Step::Edges => self.edges,
            Step::Engine => self.engine != 1.0,
            Step::Pores => self.pores.is_some(),
            Step::Fines => self.fines > 0.0,
        }
    }

    /// The same with a step as `other` takes it.
    fn with(self, step: Step, other: &Self) -> Self {
        match step {
            Step::Seen => self,
            Step::Edges => Self {
                edges: other.edges,
                ..self
            },
            Step::Engine => Self {
                engine: other.engine,
                ..self
            },
            Step::Pores => Self {
                pores: other.pores,
                ..self
            },
            Step::Fines => Self {
                fines: other.fines,
                ..self
            },
        }
    }
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
    use glam::DVec3;

    use super::*;

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

    /// Of four pixels one is rock, one no rock: less than half is outlined; of three it is half.
    #[test]
    fn little_of_a_photo_is_said() {
        let photo = PhotoFragments {
            fragments: Vec::new(),
            frame: DVec2::ONE,
            fines: 0.0,
            limit: 0.0,
            mm: 1.0,
        };
        let said = |labels: &[u32]| {
            photo.little(&LabelImage {
                width: labels.len(),
                height: 1,
                labels: labels.to_vec(),
            })
        };
        let little = said(&[1, NOT_ROCK, FINES, FINES]).unwrap();
        assert!(little.contains("only 33 % of it is outlined"), "{little}");
        assert_eq!(said(&[1, NOT_ROCK, FINES]), None);
        assert_eq!(said(&[FINES, FINES]), None);
    }

    /// A circle of twice the next is taken for a ball; a square one, a larger next one and a cut one are not.
    #[test]
    fn a_ball_is_round_and_alone() {
        let photo = |fragments: Vec<Fragment>| PhotoFragments {
            fragments,
            frame: DVec2::splat(100.0),
            fines: 0.0,
            limit: 0.1,
            mm: 1.0,
        };
        let [small, large] = [1.0, 2.0].map(|size| fragment(size, 0.0, false));
        assert!(photo(vec![small, large]).ball().is_some());
        assert_eq!(photo(vec![fragment(1.6, 0.0, false), large]).ball(), None);
        assert_eq!(photo(vec![small, fragment(2.0, 0.0, true)]).ball(), None);
        assert_eq!(photo(vec![large]).ball(), None);
        let mut square = large;
        // The circle of a square's area is 1.13 times its side.
        square.world.as_mut().unwrap().inscribed = 2.0 / 1.13;
        assert_eq!(photo(vec![small, square]).ball(), None);
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
