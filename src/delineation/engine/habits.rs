//! How an engine errs: all that sizes and mass ask of what outlined a photo, once the outlines are there.

use fragscale_core::picture::full_width;
use serde_json::{Value, json};

/// Fragments narrower than this are fines: the diameter of the circle of as many pixels that the engine sees. An
/// outline is known to about a pixel, so that of ten is measured to a fifth.
pub(crate) const LEAST_PIXELS_ACROSS: f64 = 10.0;

/// How an engine errs in a photo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Habits {
    /// How many pixels of the photo, along a side, are one to the engine: of a large photo it may look at a smaller one.
    pub sees_every: u32,
    /// How much of the area that it leaves without an outline is fines and not fragments that it did not find, as
    /// measured on simulated piles.
    pub fines_of_unfound: f64,
    /// How many times the sieves' its sizes are, as measured on simulated piles: what it joins and what it does not find
    /// makes them too large.
    pub sizes_off: f64,
    /// The standard errors of all its sizes together, relative, and of [`Habits::fines_of_unfound`], as measured on
    /// simulated piles.
    pub doubts: [f64; 2],
}

impl Habits {
    /// The narrowest fragment that is outlined in a photo whose edges are spread by a bell of deviation `spread` (pixels;
    /// `picture::edge_spread`): the diameter of the circle of as many pixels.
    ///
    /// Pixels show detail of two pixels and no finer (Nyquist). Where edges are spread further than that, the bell's full
    /// width at half of its maximum stands for those two pixels.
    pub fn least_across(&self, spread: Option<f64>) -> f64 {
        let shown = spread.map_or(0.0, |spread| full_width(spread) / 2.0);
        LEAST_PIXELS_ACROSS * f64::from(self.sees_every).max(shown)
    }

    /// As a file has them.
    pub fn to_json(&self) -> Value {
        json!({
            "sees_every": self.sees_every,
            "fines_of_unfound": self.fines_of_unfound,
            "sizes_off": self.sizes_off,
            "doubts": self.doubts,
        })
    }

    /// From a file; `None` where it has none, or such as cannot be.
    pub fn from_json(value: &Value) -> Option<Self> {
        let number = |value: &Value| {
            value
                .as_f64()
                .filter(|number| (0.0..=100.0).contains(number))
        };
        let sees_every = u32::try_from(value.get("sees_every")?.as_u64()?).ok()?;
        let [sizes, fines] = value.get("doubts")?.as_array()?.as_slice() else {
            return None;
        };
        let habits = Self {
            sees_every,
            fines_of_unfound: number(value.get("fines_of_unfound")?)?,
            sizes_off: number(value.get("sizes_off")?)?,
            doubts: [number(sizes)?, number(fines)?],
        };
        let can_be = (1..=1 << 16).contains(&sees_every)
            && habits.fines_of_unfound <= 1.0
            && habits.sizes_off > 0.0;
        can_be.then_some(habits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Classical, Engine, Learned};

    #[test]
    fn read_back_or_not_at_all() {
        let habits = Habits {
            sees_every: 4,
            fines_of_unfound: 0.6,
            sizes_off: 1.25,
            doubts: [0.2, 0.1],
        };
        let value = habits.to_json();
        assert_eq!(Habits::from_json(&value), Some(habits));
        for (key, wrong) in [
            ("sees_every", json!(0)),
            ("sees_every", json!(-1)),
            ("fines_of_unfound", json!(1.5)),
            ("sizes_off", json!(0)),
            ("sizes_off", json!("1")),
            ("doubts", json!([0.1])),
            ("doubts", json!([0.1, null])),
        ] {
            let mut value = value.clone();
            value[key] = wrong;
            assert_eq!(Habits::from_json(&value), None, "{value}");
        }
        assert_eq!(Habits::from_json(&json!({})), None);
    }

    /// Ten pixels as the engine sees them; an edge that is spread by 3 pixels is 7.06 wide at half of its height
    /// (2 sqrt(2 ln 2) deviations), and stands for two.
    #[test]
    fn the_narrowest_by_what_is_seen_and_shown() {
        let habits = Classical.habits(4000, 3000);
        assert_eq!(habits.least_across(None), 10.0);
        assert_eq!(habits.least_across(Some(0.5)), 10.0);
        let wide = habits.least_across(Some(3.0));
        assert!(
            (wide - 10.0 * 3.0 * 2.354_820_045 / 2.0).abs() < 1e-6,
            "{wide}"
        );
        let every = Learned.habits(20_000, 15_000).sees_every;
        assert_eq!(
            Learned.habits(20_000, 15_000).least_across(Some(0.1)),
            10.0 * f64::from(every)
        );
    }
}
