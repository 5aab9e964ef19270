//! What of a volume or a profile lies on triangles that bridge a hole of the cloud: they are far longer than most.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::surface::longest_edge;

/// Edges of so many times the median one bridge a hole: between points of chance none is longer than five times.
pub const BRIDGE: f64 = 10.0;

/// A smaller part of what is measured that triangles bridge is not worth a word.
pub const LEAST_BRIDGED: f64 = 0.005;

/// The sum of a line's ways over single triangles that are longer than [`BRIDGE`] times the median one.
pub(super) fn long(ways: impl Iterator<Item = f64>) -> f64 {
    let mut ways: Vec<f64> = ways.filter(|way| *way > 0.0).collect();
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

    /// The area of those that are longer than [`BRIDGE`] times the median one.
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
        let limit = median.saturating_add((BRIDGE.log2() * 8.0) as i32);
        let longer = self.0.range(limit.saturating_add(1)..);
        longer.map(|(_, (_, area))| area).sum()
    }
}
