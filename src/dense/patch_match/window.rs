//! The photometric cost: one minus the correlation of a window with what another view shows there,
//! weighted by likeness to the window's centre and nearness to it (bilaterally), so that a window at an
//! edge speaks for the centre's side.

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

/// Where the window's pixels lie.
const fn places() -> [[f32; SAMPLES]; 2] {
    let mut places = [[0.0; SAMPLES]; 2];
    let mut i = 0;
    while i < SAMPLES {
        places[0][i] = OFFSETS[i % OFFSETS.len()] as f32;
        places[1][i] = OFFSETS[i / OFFSETS.len()] as f32;
        i += 1;
    }
    places
}

const PLACES: [[f32; SAMPLES]; 2] = places();

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
    weights: [f32; SAMPLES],
    /// Weighted grey levels about their mean.
    centred: [f32; SAMPLES],
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
        let mut own = [0.0_f32; SAMPLES];
        let mut levels = [0.0_f32; SAMPLES];
        for (row, dy) in OFFSETS.into_iter().enumerate() {
            let Some(y) = y
                .checked_add_signed(dy as isize)
                .filter(|y| *y < luma.height)
            else {
                continue;
            };
            let line = &luma.levels[y * luma.width..(y + 1) * luma.width];
            for (column, dx) in OFFSETS.into_iter().enumerate() {
                let Some(level) = x
                    .checked_add_signed(dx as isize)
                    .and_then(|x| line.get(x).copied())
                else {
                    continue;
                };
                let i = row * OFFSETS.len() + column;
                own[i] = weights.place[i] * weights.grey[usize::from(level.abs_diff(base))];
                levels[i] = f32::from(level) - f32::from(base);
            }
        }
        let total: f32 = own.iter().sum::<f32>().max(1e-12);
        let own = own.map(|weight| weight / total);
        let mean: f32 = own.iter().zip(&levels).map(|(w, l)| w * l).sum();
        let centred: [f32; SAMPLES] = std::array::from_fn(|i| own[i] * (levels[i] - mean));
        let variance: f32 = centred.iter().zip(&levels).map(|(c, l)| c * l).sum();
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
        let grow = |i: usize| {
            let z = there[i][2] + there[3][2] * slope[i];
            let x = there[i][0] + there[3][0] * slope[i];
            let y = there[i][1] + there[3][1] * slope[i];
            [(x - u * z) * by, (y - v * z) * by]
        };
        let (right, down) = (grow(0), grow(1));
        self.compare(image, [u - 0.5, v - 0.5], right, down)
    }

    /// The same for an affine map.
    #[inline(always)]
    fn compare(&self, image: &Fours, [u, v]: [f32; 2], right: [f32; 2], down: [f32; 2]) -> f32 {
        // Adding 2^23 leaves no bits for fractions: it rounds, in any width of registers.
        const WHOLE: f32 = 8_388_608.0;
        let (last_u, last_v) = (image.width as f32 - 1.0, image.height as f32 - 1.0);
        let mut part_u = [0.0_f32; SAMPLES];
        let mut part_v = [0.0_f32; SAMPLES];
        let mut column = [0_u32; SAMPLES];
        let mut row = [0_u32; SAMPLES];
        let [places_x, places_y] = &PLACES;
        for i in 0..SAMPLES {
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
        let mut fours = [0_u32; SAMPLES];
        for i in 0..SAMPLES {
            let at = row[i] as usize * image.width + column[i] as usize;
            fours[i] = image.fours.get(at).copied().unwrap_or_default();
        }
        let mut levels = [0.0_f32; SAMPLES];
        for i in 0..SAMPLES {
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
        let weights = self.weights.as_chunks::<LANES>().0;
        let centred = self.centred.as_chunks::<LANES>().0;
        for ((weights, centred), levels) in
            weights.iter().zip(centred).zip(levels.as_chunks::<LANES>().0)
        {
            for lane in 0..LANES {
                let weighted = weights[lane] * levels[lane];
                mean[lane] += weighted;
                square[lane] += weighted * levels[lane];
                product[lane] += centred[lane] * levels[lane];
            }
        }
        let (mean, square, product) = (sum(mean), sum(square), sum(product));
        let variance = (square - mean * mean).max(0.0) + NOISE;
        1.0 - product / (variance * self.variance).sqrt()
    }
}

/// Sums run in so many lanes, side by side.
const LANES: usize = 12;

#[inline(always)]
fn sum(lanes: [f32; LANES]) -> f32 {
    let four: [f32; 4] = std::array::from_fn(|i| lanes[i] + lanes[i + 4] + lanes[i + 8]);
    (four[0] + four[1]) + (four[2] + four[3])
}
