//! Planes at the pixels of an image.

use super::random::Random;
use super::{Problem, STEEPEST};

/// A plane at a pixel, in the camera of its image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plane {
    /// At the pixel's centre, one over the world's unit.
    pub(crate) inverse_depth: f32,
    /// Its growth per pixel to the right and downwards.
    pub(crate) slope: [f32; 2],
    /// What the search minimises; NaN where not counted yet.
    pub(crate) cost: f32,
}

impl Plane {
    /// The same plane, at a pixel that is so many to the right and below.
    #[inline(always)]
    pub(crate) fn moved(self, x: f32, y: f32) -> Self {
        let inverse_depth = self.inverse_depth + self.slope[0] * x + self.slope[1] * y;
        Self {
            inverse_depth,
            ..self
        }
    }

    /// Whether it lies in the range of depths and is not seen edge on.
    #[inline(always)]
    pub(crate) fn is_possible(self, problem: &Problem) -> bool {
        let [least, most] = problem.range;
        let steepest = STEEPEST * self.inverse_depth / problem.focal;
        let [x, y] = self.slope;
        self.inverse_depth >= least
            && self.inverse_depth <= most
            && x * x + y * y <= steepest * steepest
    }

    /// A plane from anywhere.
    #[inline(always)]
    pub(crate) fn anywhere(problem: &Problem, random: &mut Random) -> Self {
        let [least, most] = problem.range;
        let inverse_depth = least + (most - least) * (0.5 * random.signed() + 0.5);
        let slope = 0.5 * STEEPEST * inverse_depth / problem.focal;
        Self {
            inverse_depth,
            slope: [slope * random.signed(), slope * random.signed()],
            cost: f32::NAN,
        }
    }

    /// A plane nearby, the depth and the slopes off by up to so many pixels of other views, the slopes
    /// at the window's edge.
    #[inline(always)]
    pub(crate) fn near(self, depth: f32, slope: f32, random: &mut Random) -> Self {
        let slope = slope / 5.0;
        let (a, b, c) = (random.signed(), random.signed(), random.signed());
        Self {
            inverse_depth: self.inverse_depth + depth * a,
            slope: [self.slope[0] + slope * b, self.slope[1] + slope * c],
            cost: f32::NAN,
        }
    }
}

/// A plane for every pixel of an image.
#[derive(Debug, Clone, PartialEq)]
pub struct Planes {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) planes: Vec<Plane>,
}

impl Planes {
    /// From anywhere.
    pub(crate) fn anywhere(problem: &Problem) -> Self {
        let (width, height) = (problem.luma.width, problem.luma.height);
        let mut planes = Vec::with_capacity(width * height);
        for (y, _) in (0_u32..).zip(0..height) {
            for (x, _) in (0_u32..).zip(0..width) {
                let mut random = Random::at(x, y, problem.seed);
                planes.push(Plane::anywhere(problem, &mut random));
            }
        }
        Self {
            width,
            height,
            planes,
        }
    }

    /// For an image of twice the size: the same planes in space.
    pub(crate) fn doubled(&self, width: usize, height: usize) -> Self {
        let mut planes = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let at = (y / 2).min(self.height - 1) * self.width + (x / 2).min(self.width - 1);
                // Centres of the fine pixels lie a quarter of a coarse one from its centre.
                let quarter = |odd: usize| if odd == 1 { 0.25 } else { -0.25 };
                let plane = self.planes[at].moved(quarter(x % 2), quarter(y % 2));
                let slope = plane.slope.map(|slope| 0.5 * slope);
                planes.push(Plane { slope, ..plane });
            }
        }
        Self {
            width,
            height,
            planes,
        }
    }
}
