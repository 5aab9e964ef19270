//! What is to be said of a photo's outlines.

use crate::bare::bare;
use crate::engine::LEAST_PIXELS_ACROSS;
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::mass::photo_fragments::{PhotoFragments, is_speck};
use crate::measures::{Fragment, Measures};

/// The largest circle within the outline of a ball, over the circle of its area: 0.97 and more in the nine photos of the
/// bundled flight, while no fragment among the largest 200 has over 0.93.
const AS_A_BALL: f64 = 0.95;
/// A ball is to be seen from afar: 1.8 to 2.3 times the next there.
const ALONE: f64 = 1.3;

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
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::mass::tests::fragment;

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
}
