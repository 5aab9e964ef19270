//! From the fragments of photos to a size distribution by mass.
//!
//! The steps, each of which can be left out:
//!
//! 1. What a photo's edge cuts is not measured, and large fragments are cut more often. Each whole one stands
//!    for 1 / ((1 - w / W) (1 - h / H)) of its kind, w and h its extent, W and H the photo's (Miles 1974,
//!    Lantuejoul 1980).
//! 2. The share of the visible area is taken for the share of the mass (Delesse 1847): the surface of the pile
//!    is as good as a cut through it.
//! 3. What was outlined by nobody is fines: its share of the area is their share of the mass.

use fragscale_core::fault::Fault;
use fragscale_fragmentation::SizeDistribution;
use glam::DVec2;

use crate::measures::Fragment;

/// What a photo contributes. Lengths in one unit.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoFragments {
    /// All that were outlined.
    pub fragments: Vec<Fragment>,
    /// Width and height of the photo, pixels.
    pub frame: DVec2,
    /// The area of what is fines, on planes parallel to the image.
    pub fines: f64,
    /// The size of the smallest fragment that the photo can show.
    pub limit: f64,
}

/// Which steps are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Steps {
    /// Large fragments are cut more often.
    pub edges: bool,
    /// What nobody outlined is fines.
    pub fines: bool,
}

impl Default for Steps {
    fn default() -> Self {
        Self {
            edges: true,
            fines: true,
        }
    }
}

/// A size distribution by mass, and what it rests on.
#[derive(Debug, Clone, PartialEq)]
pub struct ByMass {
    /// Sizes in the fragments' unit.
    pub curve: SizeDistribution,
    /// Fragments that count.
    pub whole: usize,
    /// Fragments that an edge cuts.
    pub cut: usize,
    /// The share of the mass that is taken for fines, 0 to 1.
    pub fines: f64,
    /// The size below which nothing is claimed.
    pub limit: f64,
    /// The area that the photos show.
    pub area: f64,
}

/// Sizes per factor of ten.
const PER_DECADE: f64 = 10.0;

/// The distribution of all photos together.
///
/// # Errors
/// Where no photo shows a whole fragment.
pub fn by_mass(photos: &[PhotoFragments], steps: Steps) -> Result<ByMass, Fault> {
    let (mut whole, mut cut, mut fines, mut rock) = (Vec::new(), 0, 0.0, 0.0);
    let mut limit: f64 = 0.0;
    for photo in photos {
        limit = limit.max(photo.limit);
        fines += photo.fines;
        for fragment in &photo.fragments {
            let Some(world) = fragment.world else {
                continue;
            };
            rock += world.area;
            if fragment.is_cut {
                cut += 1;
                continue;
            }
            let seldom = (DVec2::ONE - fragment.extent / photo.frame).max(DVec2::splat(0.02));
            let stands_for = if steps.edges { 1.0 / (seldom.x * seldom.y) } else { 1.0 };
            whole.push((world.sieve_size, world.area * stands_for));
        }
    }
    let nothing = || {
        let what = "no photo shows a whole fragment on the surface";
        Fault::new(what, "take photos from farther away, or another engine")
    };
    whole.sort_by(|a, b| a.0.total_cmp(&b.0));
    let largest = whole.last().ok_or_else(nothing)?.0;
    let total: f64 = whole.iter().map(|(_, mass)| mass).sum();
    let fines_share = if steps.fines { fines / (fines + rock) } else { 0.0 };
    let mut points = Vec::new();
    let first = (limit.max(largest * 1e-4).log10() * PER_DECADE).ceil() as i32;
    for step in first.. {
        let size = 10f64.powf(f64::from(step) / PER_DECADE);
        let passed: f64 = whole
            .iter()
            .take_while(|(own, _)| *own <= size)
            .map(|(_, mass)| mass)
            .sum();
        let share = (passed / total).min(1.0);
        let all = size >= largest;
        let share = if all { 1.0 } else { share };
        points.push([size, 100.0 * (fines_share + (1.0 - fines_share) * share)]);
        // A curve has two points.
        if all && points.len() > 1 {
            break;
        }
    }
    Ok(ByMass {
        curve: SizeDistribution::new(points)?,
        whole: whole.len(),
        cut,
        fines: fines_share,
        limit,
        area: fines + rock,
    })
}
