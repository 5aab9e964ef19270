//! Integrals under a piece of a triangle.

use glam::{DVec2, DVec3};

/// A corner of a flat piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Corner {
    /// On the surface.
    pub(super) at: DVec3,
    /// How far it lies over the base.
    pub(super) above: f64,
}

impl Corner {
    fn between(a: Self, b: Self, share: f64) -> Self {
        Self {
            at: a.at + (b.at - a.at) * share,
            above: a.above + (b.above - a.above) * share,
        }
    }
}

/// The part of a convex piece where this function of its corners, linear over the piece, is not negative.
pub(super) fn clip(piece: &[Corner], of: impl Fn(&Corner) -> f64) -> Vec<Corner> {
    let mut kept = Vec::with_capacity(piece.len() + 1);
    let Some(&last) = piece.last() else {
        return kept;
    };
    let mut before = (last, of(&last));
    for &corner in piece {
        let value = of(&corner);
        if (before.1 < 0.0) != (value < 0.0) {
            let share = before.1 / (before.1 - value);
            kept.push(Corner::between(before.0, corner, share));
        }
        if value >= 0.0 {
            kept.push(corner);
        }
        before = (corner, value);
    }
    kept
}

/// The part of a convex piece over a triangle in plan, counter-clockwise; empty where there is none.
pub(super) fn clip_to(piece: &[Corner], triangle: &[DVec2; 3]) -> Vec<Corner> {
    let [a, b, c] = *triangle;
    let mut piece = piece.to_vec();
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let inside = |corner: &Corner| (to - from).perp_dot(corner.at.truncate() - from);
        if piece.iter().any(|corner| inside(corner) < 0.0) {
            piece = clip(&piece, inside);
        }
        if piece.len() < 3 {
            return Vec::new();
        }
    }
    piece
}

/// What lies under pieces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Sums {
    /// Over the base, where the surface is higher.
    pub(super) above: f64,
    /// Under the base, where it is lower; positive.
    pub(super) below: f64,
    /// In plan; negative where a piece looks down.
    pub(super) plan: f64,
    /// In plan, of pieces that look down; positive.
    pub(super) down: f64,
    /// Along the pieces.
    pub(super) along: f64,
}

impl Sums {
    /// With a flat convex piece.
    pub(super) fn add(&mut self, piece: &[Corner]) {
        let Some((&first, rest)) = piece.split_first() else {
            return;
        };
        let [mut plan, mut along] = [0.0; 2];
        for pair in rest.windows(2) {
            let (one, other) = (pair[0].at - first.at, pair[1].at - first.at);
            plan += one.truncate().perp_dot(other.truncate()) / 2.0;
            along += one.cross(other).length() / 2.0;
        }
        self.plan += plan;
        self.along += along;
        self.down += (-plan).max(0.0);
        if piece.iter().all(|corner| corner.above >= 0.0) {
            self.above += volume(piece);
        } else if piece.iter().all(|corner| corner.above <= 0.0) {
            self.below -= volume(piece);
        } else {
            self.above += volume(&clip(piece, |corner| corner.above));
            self.below -= volume(&clip(piece, |corner| -corner.above));
        }
    }

    /// With the other sign, where the factor is -1: of pieces that look the other way.
    pub(super) fn times(self, sign: f64) -> Self {
        Self {
            above: self.above * sign,
            below: self.below * sign,
            plan: self.plan * sign,
            // What looked up looks down now.
            down: if sign < 0.0 {
                self.down + self.plan
            } else {
                self.down
            },
            along: self.along,
        }
    }

    /// Two sums of pieces that do not overlap.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            above: self.above + other.above,
            below: self.below + other.below,
            plan: self.plan + other.plan,
            down: self.down + other.down,
            along: self.along + other.along,
        }
    }
}

/// Between a piece and the base, with the sign of its area in plan: triangular prisms, exact.
fn volume(piece: &[Corner]) -> f64 {
    let Some((first, rest)) = piece.split_first() else {
        return 0.0;
    };
    let prisms = rest.windows(2).map(|pair| {
        let from = first.at.truncate();
        let (one, other) = (pair[0].at.truncate() - from, pair[1].at.truncate() - from);
        one.perp_dot(other) * (first.above + pair[0].above + pair[1].above) / 6.0
    });
    prisms.sum()
}
