//! Planes at the pixels of an image.

use super::random::Random;
use super::{EDGE, Problem, STEEPEST};

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
        let slope = slope / EDGE;
        let (a, b, c) = (random.signed(), random.signed(), random.signed());
        Self {
            inverse_depth: self.inverse_depth + depth * a,
            slope: [self.slope[0] + slope * b, self.slope[1] + slope * c],
            cost: f32::NAN,
        }
    }
}

/// What begins the bytes of planes; another format has another.
const MARK: [u8; 8] = *b"planes 1";
/// Bytes before the planes, and of each.
const HEADER: usize = 16;
const EACH: usize = 16;

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

    /// The mark, width and height (u32), then inverse depth, slopes to the right and downwards and cost of each
    /// plane (f32), row by row; all of them with the lowest byte first.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let side = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX).to_le_bytes();
        let mut bytes = Vec::with_capacity(HEADER + EACH * self.planes.len());
        bytes.extend(MARK);
        bytes.extend(side(self.width));
        bytes.extend(side(self.height));
        for plane in &self.planes {
            let [right, down] = plane.slope;
            for number in [plane.inverse_depth, right, down, plane.cost] {
                bytes.extend(number.to_le_bytes());
            }
        }
        bytes
    }

    /// Of an image of this size; `None` where the bytes are of another one or not whole.
    pub(crate) fn from_bytes(bytes: &[u8], width: usize, height: usize) -> Option<Self> {
        let (header, planes) = bytes.split_at_checked(HEADER)?;
        let side = |at: usize| {
            let side: [u8; 4] = header.get(at..at + 4)?.try_into().ok()?;
            usize::try_from(u32::from_le_bytes(side)).ok()
        };
        let is_right = header.starts_with(&MARK)
            && (side(8)?, side(12)?) == (width, height)
            && planes.len() == EACH * width * height;
        let plane = |bytes: &[u8]| {
            let number =
                |i: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[4 * i + byte]));
            Plane {
                inverse_depth: number(0),
                slope: [number(1), number(2)],
                cost: number(3),
            }
        };
        is_right.then(|| Self {
            width,
            height,
            planes: planes.chunks_exact(EACH).map(plane).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_there_and_back() {
        let plane = |number: u8| Plane {
            inverse_depth: f32::from(number) / 3.0,
            slope: [1e-7, -2e-5],
            cost: 0.25,
        };
        let planes = Planes {
            width: 3,
            height: 2,
            planes: (0..6).map(plane).collect(),
        };
        let bytes = planes.to_bytes();
        assert_eq!(Planes::from_bytes(&bytes, 3, 2), Some(planes));
        // Of another size, cut off, something else.
        assert_eq!(Planes::from_bytes(&bytes, 2, 3), None);
        assert_eq!(Planes::from_bytes(&bytes[..bytes.len() - 1], 3, 2), None);
        assert_eq!(Planes::from_bytes(&bytes[1..], 3, 2), None);
        assert_eq!(Planes::from_bytes(b"planes", 3, 2), None);
    }
}
