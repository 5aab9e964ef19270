//! PatchMatch over slanted planes at one size of one photo; what both back ends share.
//!
//! The plane at a pixel is the inverse depth there and its growth per pixel to the right and downwards:
//! the inverse depth of a plane in space is linear in the pixel. Another view sees pixel p at
//!
//! ```text
//! m = A (u, v, 1) + b q(u, v)       A = K' R K^-1, b = K' t, q the inverse depth
//! ```
//!
//! divided by its third component; m is linear in the pixel too. Within a window the map is taken as
//! affine about its centre: over 3 pixels of a focal length of 1000 that is off by under 0.01 px where the
//! plane is seen at 60 degrees.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub(crate) mod pair;
pub(crate) mod plane;
pub(crate) mod random;
mod window;

use std::sync::Arc;

use crate::fault::Fault;
use crate::jobs::Progress;
use pair::Pair;
use plane::Planes;

/// One photo at one size with those that it is compared with.
pub struct Problem {
    /// Grey levels of the reference and its size.
    pub(crate) luma: Arc<crate::luma::Luma>,
    /// The other views; the map into each.
    pub(crate) sources: Vec<Source>,
    /// The smallest and the greatest inverse depth.
    pub(crate) range: [f32; 2],
    /// The inverse depth that moves the pixel by one in a typical other view.
    pub(crate) per_pixel: f32,
    /// Focal length, for slopes without a unit.
    pub(crate) focal: f32,
    pub(crate) seed: u32,
}

/// Another view of a [`Problem`].
pub(crate) struct Source {
    pub(crate) luma: Arc<crate::luma::Luma>,
    pub(crate) pair: Pair,
    /// Its inverse depths and size, in the geometric pass. 0 where there is none.
    pub(crate) inverse_depths: Option<Arc<Vec<f32>>>,
}

/// One sweep over both colours of the checkerboard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// How far perturbed planes lie, in pixels of other views.
    pub(crate) amplitude: f32,
    /// Whether to try a plane from anywhere, too.
    pub(crate) anywhere: bool,
    /// The weight of the reprojection error, per pixel.
    pub(crate) geometric: f32,
    /// Distinguishes sweeps in the random numbers.
    pub(crate) salt: u32,
}

/// The window's pixels along each axis from its centre: stones are small and stand out of each other, and a wider window shows
/// parts of several.
pub(crate) const OFFSETS: [i32; 6] = [-3, -2, -1, 1, 2, 3];
/// The farthest of them.
pub(crate) const EDGE: f32 = OFFSETS[OFFSETS.len() - 1] as f32;
/// How many pixels a window has.
pub(crate) const SAMPLES: usize = OFFSETS.len() * OFFSETS.len();
/// Standard deviation of the bilateral weights, in grey levels and in pixels.
pub(crate) const SIGMA_GREY: f32 = 40.0;
pub(crate) const SIGMA_PIXELS: f32 = 2.5;
/// The variance, grey levels squared, under which a window has no texture to speak of.
pub(crate) const NOISE: f32 = 4.0;
/// How many views have to agree.
pub(crate) const BEST: usize = 2;
/// A plane that is dearer by more in the two best views of the plane so far is not looked at in the others.
pub(crate) const GATE: f32 = 0.05;
/// A plane that is dearer by more in the best view of the plane so far is not looked at in any other.
pub(crate) const FAR_DEARER: f32 = 0.2;
/// The cost of a view that does not see the point.
pub(crate) const UNSEEN: f32 = 2.0;
/// The reprojection error beyond which it costs no more, pixels.
pub(crate) const FARTHEST: f32 = 3.0;
/// Where the four directions' candidates lie: odd distances are of the other colour.
pub(crate) const REACH: [i32; 4] = [1, 3, 5, 9];
/// The steepest plane: growth of depth per depth and per unit of the image plane.
pub(crate) const STEEPEST: f32 = 4.0;
/// Candidates nearer than this, in pixels of other views, are the same plane.
pub(crate) const SAME: f32 = 0.04;
/// The most other views.
pub(crate) const MOST_SOURCES: usize = 8;

/// What runs the sweeps: the processor or a graphics card. Both count the same way, so that their answers
/// agree but for rounding: where two planes cost the same to the last digits they may choose differently.
pub trait Backend: Sync {
    /// What it is, for the log.
    fn name(&self) -> String;

    /// Improves the planes by sweeps.
    ///
    /// # Errors
    /// Where the device fails or the work was cancelled.
    fn sweep(
        &self,
        problem: &Problem,
        planes: &mut Planes,
        sweeps: &[Sweep],
        progress: &Progress,
    ) -> Result<(), Fault>;
}
