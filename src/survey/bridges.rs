//! What of a volume or a profile lies on triangles that bridge a hole of the cloud: they are far longer than most.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::surface::longest_edge;

/// Edges of so many times the median one bridge a hole: between points of chance none is longer than five times.
pub const BRIDGE: f64 = 10.0;

/// Of a grid, whose triangles are all of one size, those that are so many times longer bridge cells without a height.
const GRID_BRIDGE: f64 = 1.5;

/// A grid has so large a share of its triangles within an eighth of a power of two about the median; of points of chance no more than
/// a third is.
const GRID_SHARE: f64 = 0.7;

/// A smaller part of what is measured that triangles bridge is not worth a word.
pub const LEAST_BRIDGED: f64 = 0.005;

/// The sum of a line's ways over single triangles that are longer than [`BRIDGE`] times the median one.
pub(super) fn long(ways: impl Iterator<Item = f64>) -> f64 {
    let mut ways: Vec<f64> = ways.collect();
    // At a bend of the line two of its points may lie within rounding of each other.
    let least = 1e-6 * ways.iter().sum::<f64>() / ways.len().max(1) as f64;
    ways.retain(|way| *way > least);
    let place = ways.len() / 2;
    if place >= ways.len() {
        return 0.0;
    }
    let median = *ways.select_nth_unstable_by(place, f64::total_cmp).1;
    ways.iter().filter(|way| **way > BRIDGE * median).sum()
}

/// Triangles by the length of their longest edges over (x, y), in eighths of powers of two.
#[derive(Debug, Clone, Default)]
pub(super) struct Edges(BTreeMap<i32, (u64, f64)>);

impl Edges {
    /// Adds a triangle of which this area counts.
    pub(super) fn add(&mut self, corners: [DVec3; 3], area: f64) {
        let longest = longest_edge(corners.map(|at| at.with_z(0.0)));
        // `as` saturates: a triangle without length is among the shortest.
        let step = (longest.log2() * 8.0).floor() as i32;
        let (count, sum) = self.0.entry(step).or_default();
        *count += 1;
        *sum += area;
    }

    pub(super) fn and(mut self, other: Self) -> Self {
        for (step, (count, area)) in other.0 {
            let entry = self.0.entry(step).or_default();
            *entry = (entry.0 + count, entry.1 + area);
        }
        self
    }

    /// The area of those that are longer than [`BRIDGE`] times the median one, of a grid than [`GRID_BRIDGE`] times.
    pub(super) fn bridged(&self) -> f64 {
        let all: u64 = self.0.values().map(|(count, _)| count).sum();
        let mut passed = 0;
        let median = self.0.iter().find(|(_, (count, _))| {
            passed += count;
            2 * passed >= all
        });
        let Some((median, _)) = median else {
            return 0.0;
        };
        let about = median.saturating_sub(1)..=median.saturating_add(1);
        let about: u64 = self.0.range(about).map(|(_, (count, _))| count).sum();
        let times = match about as f64 > GRID_SHARE * all as f64 {
            true => GRID_BRIDGE,
            false => BRIDGE,
        };
        let limit = median.saturating_add((times.log2() * 8.0) as i32);
        let longer = self.0.range(limit.saturating_add(1)..);
        longer.map(|(_, (_, area))| area).sum()
    }
}
