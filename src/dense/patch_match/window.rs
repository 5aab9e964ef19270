//! The photometric cost: one minus the correlation of a window with what another view shows there,
//! weighted by likeness to the window's centre and nearness to it (bilaterally), so that a window at an
//! edge speaks for the centre's side.

#![expect(clippy::cast_possible_wrap, reason = "sides of images are small")]

use super::pair::project;
use super::{NOISE, OFFSETS, SAMPLES, SIGMA_GREY, SIGMA_PIXELS, UNSEEN};
use crate::luma::Luma;

/// An image of which one reads between pixels.
pub(crate) struct Fours {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// See [`Luma::fours`].
    pub(crate) fours: Vec<u32>,
}

impl Fours {
    pub(crate) fn of(luma: &Luma) -> Self {
        Self {
            width: luma.width,
            height: luma.height,
            fours: luma.fours(),
        }
    }
}

/// The bilateral weights as factors: by the pixel's place in the window, and by the grey levels between.
pub(crate) struct Weights {
    place: [f32; SAMPLES],
    grey: [f32; 256],
}

/// Windows are filled up with pixels of no weight to whole registers.
const PADDED: usize = SAMPLES.next_multiple_of(LANES);

/// Where the window's pixels lie.
const fn places() -> [[f32; PADDED]; 2] {
    let mut places = [[0.0; PADDED]; 2];
    let mut i = 0;
    while i < SAMPLES {
        places[0][i] = OFFSETS[i % OFFSETS.len()] as f32;
        places[1][i] = OFFSETS[i / OFFSETS.len()] as f32;
        i += 1;
    }
    places
}

const PLACES: [[f32; PADDED]; 2] = places();

impl Weights {
    pub(crate) fn new() -> Self {
        let bell = |x: f32| (-0.5 * x * x).exp();
        let [x, y] = PLACES;
        Self {
            place: std::array::from_fn(|i| bell(x[i].hypot(y[i]) / SIGMA_PIXELS)),
            grey: std::array::from_fn(|level| bell(level as f32 / SIGMA_GREY)),
        }
    }
}

/// A window of the reference, ready to be compared.
pub(crate) struct Window {
    /// Weights that sum to 1.
    weights: [f32; PADDED],
    /// Weighted grey levels about their mean.
    centred: [f32; PADDED],
    /// The centre's grey level: taken off first, so that squares lose no digits.
    base: f32,
    /// The window's weighted variance plus that of noise.
    variance: f32,
}

impl Window {
    /// About pixel (x, y), which lies in the image; what lies outside has no weight.
    #[inline(always)]
    pub(crate) fn at(luma: &Luma, weights: &Weights, x: usize, y: usize) -> Self {
        let base = luma.levels[y * luma.width + x];
        let mut own = [0.0_f32; PADDED];
        let mut levels = [0.0_f32; PADDED];
        // Plain loops, here and below: closures are not inlined into code for another kind of processor.
        let (mut total, mut mean, mut i) = (1e-12_f32, 0.0_f32, 0);
        while i < SAMPLES {
            let row = y as i32 + OFFSETS[i / OFFSETS.len()];
            let column = x as i32 + OFFSETS[i % OFFSETS.len()];
            if row >= 0 && column >= 0 {
                let (row, column) = (row as usize, column as usize);
                if row < luma.height && column < luma.width {
                    let level = luma.levels[row * luma.width + column];
                    let weight = weights.place[i] * weights.grey[usize::from(level.abs_diff(base))];
                    own[i] = weight;
                    levels[i] = f32::from(level) - f32::from(base);
                    total += weight;
                    mean += weight * levels[i];
                }
            }
            i += 1;
        }
        mean /= total;
        let by = total.recip();
        let mut centred = [0.0_f32; PADDED];
        let mut variance = 0.0_f32;
        for i in 0..PADDED {
            own[i] *= by;
            centred[i] = own[i] * (levels[i] - mean);
            variance += centred[i] * levels[i];
        }
        Self {
            weights: own,
            centred,
            base: f32::from(base),
            variance: variance.max(0.0) + NOISE,
        }
    }

    /// The cost, 0 to 2, of another view for a plane: the window's centre lies at `pixel` of the
    /// reference, the view maps it by `there`.
    #[inline(always)]
    pub(crate) fn cost(
        &self,
        image: &Fours,
        there: &[[f32; 3]; 4],
        pixel: [f32; 2],
        inverse_depth: f32,
        slope: [f32; 2],
    ) -> f32 {
        let m = project(there, pixel, inverse_depth);
        if m[2] < 1e-6 {
            return UNSEEN;
        }
        let by = m[2].recip();
        let (u, v) = (m[0] * by, m[1] * by);
        let (width, height) = (image.width as f32, image.height as f32);
        // Also where it is not a number.
        let is_inside = u >= 0.0 && v >= 0.0 && u <= width && v <= height;
        if !is_inside {
            return UNSEEN;
        }
        // How the place grows per pixel of the reference, to the right and downwards.
        let (mut right, mut down) = ([0.0; 2], [0.0; 2]);
        let z = there[0][2] + there[3][2] * slope[0];
        right[0] = (there[0][0] + there[3][0] * slope[0] - u * z) * by;
        right[1] = (there[0][1] + there[3][1] * slope[0] - v * z) * by;
        let z = there[1][2] + there[3][2] * slope[1];
        down[0] = (there[1][0] + there[3][0] * slope[1] - u * z) * by;
        down[1] = (there[1][1] + there[3][1] * slope[1] - v * z) * by;
        self.compare(image, [u - 0.5, v - 0.5], right, down)
    }

    /// The same for an affine map.
    #[inline(always)]
    fn compare(&self, image: &Fours, [u, v]: [f32; 2], right: [f32; 2], down: [f32; 2]) -> f32 {
        // Adding 2^23 leaves no bits for fractions: it rounds, in any width of registers.
        const WHOLE: f32 = 8_388_608.0;
        let (last_u, last_v) = (image.width as f32 - 1.0, image.height as f32 - 1.0);
        let mut part_u = [0.0_f32; PADDED];
        let mut part_v = [0.0_f32; PADDED];
        let mut column = [0_u32; PADDED];
        let mut row = [0_u32; PADDED];
        let [places_x, places_y] = &PLACES;
        for i in 0..PADDED {
            let x = u + right[0] * places_x[i] + down[0] * places_y[i];
            let y = v + right[1] * places_x[i] + down[1] * places_y[i];
            let x = if x > 0.0 { x } else { 0.0 };
            let y = if y > 0.0 { y } else { 0.0 };
            let x = if x < last_u { x } else { last_u };
            let y = if y < last_v { y } else { last_v };
            let (whole_x, whole_y) = ((x - 0.5) + WHOLE, (y - 0.5) + WHOLE);
            part_u[i] = x - (whole_x - WHOLE);
            part_v[i] = y - (whole_y - WHOLE);
            column[i] = whole_x.to_bits() & 0x7f_ffff;
            row[i] = whole_y.to_bits() & 0x7f_ffff;
        }
        let mut fours = [0_u32; PADDED];
        for i in 0..PADDED {
            let at = row[i] as usize * image.width + column[i] as usize;
            if at < image.fours.len() {
                fours[i] = image.fours[at];
            }
        }
        let mut levels = [0.0_f32; PADDED];
        for i in 0..PADDED {
            let four = fours[i].cast_signed();
            let left = (four & 0xff) as f32;
            let right = ((four >> 8) & 0xff) as f32;
            let above = left + part_u[i] * (right - left);
            let left = ((four >> 16) & 0xff) as f32;
            let right = ((four >> 24) & 0xff) as f32;
            let below = left + part_u[i] * (right - left);
            levels[i] = above + part_v[i] * (below - above) - self.base;
        }
        let mut mean = [0.0_f32; LANES];
        let mut square = [0.0_f32; LANES];
        let mut product = [0.0_f32; LANES];
        let mut begin = 0;
        while begin < PADDED {
            for lane in 0..LANES {
                let level = levels[begin + lane];
                let weighted = self.weights[begin + lane] * level;
                mean[lane] += weighted;
                square[lane] += weighted * level;
                product[lane] += self.centred[begin + lane] * level;
            }
            begin += LANES;
        }
        let (mean, square, product) = (sum(&mean), sum(&square), sum(&product));
        let variance = (square - mean * mean).max(0.0) + NOISE;
        1.0 - product / (variance * self.variance).sqrt()
    }
}

/// Sums run in so many lanes, side by side.
const LANES: usize = 8;

#[inline(always)]
fn sum(lanes: &[f32; LANES]) -> f32 {
    let mut sum = 0.0;
    for i in 0..4 {
        sum += lanes[i] + lanes[i + 4];
    }
    sum
}
