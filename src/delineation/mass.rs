//! From the fragments of photos to a size distribution by mass.
//!
//! The steps, each of which can be left out:
//!
//! 1. What a photo's edge cuts is not measured, and large fragments are cut more often. Each whole one stands
//!    for 1 / ((1 - w / W) (1 - h / H)) of its kind, w and h its extent, W and H the photo's (Miles 1974,
//!    Lantuejoul 1980).
//! 2. The share of the visible area is taken for the share of the mass (Delesse 1847): the surface of the pile
//!    is as good as a cut through it.
//! 3. Of what nobody outlined a part is fines, and the rest fragments that were not found, of the same kinds as
//!    those that were: how large a part was measured on simulated piles, engine by engine. Its share of the area
//!    is the fines' share of the mass.

use fragscale_core::fault::Fault;
use fragscale_core::scale::ScaleField;
use fragscale_fragmentation::SizeDistribution;
use glam::DVec2;

use crate::labels::{FINES, LabelImage};
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

impl PhotoFragments {
    /// From a photo's label image, the scale field of all its pixels and the measures of its fragments; the narrowest
    /// that its engine outlines is `least_across` pixels.
    pub fn new(
        labels: &LabelImage,
        field: &ScaleField,
        fragments: Vec<Fragment>,
        least_across: f64,
    ) -> Self {
        let (mut fines, mut area, mut pixels) = (0.0, 0.0, 0.0);
        for (place, label) in labels.labels.iter().enumerate() {
            let (column, row) = (place % labels.width, place / labels.width);
            let Some(scale) = field.scale_at(column as u32, row as u32) else {
                continue;
            };
            let own = 1.0 / (scale * scale);
            pixels += 1.0;
            area += own;
            if *label == FINES {
                fines += own;
            }
        }
        let scale: f64 = (pixels / area).sqrt();
        Self {
            fragments,
            frame: DVec2::new(labels.width as f64, labels.height as f64),
            fines,
            limit: least_across / scale,
        }
    }
}

impl PhotoFragments {
    /// The same without any fragment.
    pub(crate) fn without_fragments(&self) -> Self {
        Self {
            fragments: Vec::new(),
            ..*self
        }
    }
}

/// Which steps are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Large fragments are cut more often.
    pub edges: bool,
    /// How much of what nobody outlined is fines, 0 to 1; the rest are fragments that were not found.
    pub fines: f64,
}

impl Default for Steps {
    fn default() -> Self {
        Self {
            edges: true,
            fines: 1.0,
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
    /// The share of the area that nobody outlined, 0 to 1.
    pub unfound: f64,
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
pub fn by_mass<'a>(
    photos: impl IntoIterator<Item = &'a PhotoFragments>,
    steps: Steps,
) -> Result<ByMass, Fault> {
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
            let stands_for = if steps.edges {
                1.0 / (seldom.x * seldom.y)
            } else {
                1.0
            };
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
    let fines_share = steps.fines * fines / (fines + rock);
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
        unfound: fines / (fines + rock),
        fines: fines_share,
        limit,
        area: fines + rock,
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use fragscale_core::split_mix::SplitMix;
    use glam::DVec3;

    use super::*;
    use crate::measures::Measures;

    pub(crate) fn fragment(size: f64, extent: f64, is_cut: bool) -> Fragment {
        let area = std::f64::consts::PI / 4.0 * size * size;
        Fragment {
            number: 1,
            pixels: 1,
            middle: DVec2::ZERO,
            is_cut,
            extent: DVec2::splat(extent),
            world: Some(Measures {
                place: DVec3::ZERO,
                scale: 1.0,
                area,
                surface_area: area,
                diameter: size,
                rectangle: [size; 2],
                widths: [size; 2],
                inscribed: size,
                roundness: 1.0,
                height: 0.0,
                sieve_size: size,
            }),
        }
    }

    /// Circles of 1 and 2: their areas are as 1 to 4. As much fines as rock.
    #[test]
    fn shares_by_hand() {
        let fragments = vec![fragment(1.0, 0.0, false), fragment(2.0, 0.0, false)];
        let rock: f64 = fragments.iter().filter_map(|of| Some(of.world?.area)).sum();
        let photo = PhotoFragments {
            fragments,
            frame: DVec2::splat(100.0),
            fines: rock,
            limit: 0.9,
        };
        let all = by_mass(std::slice::from_ref(&photo), Steps::default()).unwrap();
        assert_eq!((all.whole, all.cut, all.fines), (2, 0, 0.5));
        assert!((all.curve.percent_passing(1.5).unwrap() - 60.0).abs() < 1e-9);
        assert_eq!(all.curve.percent_passing(2.6), Some(100.0));
        let steps = Steps {
            fines: 0.0,
            ..Steps::default()
        };
        let rock_alone = by_mass(&[photo], steps).unwrap();
        assert!((rock_alone.curve.percent_passing(1.5).unwrap() - 20.0).abs() < 1e-9);
        assert!(by_mass(&[], Steps::default()).is_err());
    }

    /// Circles strewn evenly over far more than a frame of 100: those that it cuts are left out, more of the large
    /// ones. With the correction the shares are those of the strewn ones, without it they are not.
    #[test]
    fn edges_do_not_hide_the_large() {
        let mut random = SplitMix(11);
        let mut unit = || (random.next() >> 11) as f64 / (1u64 << 53) as f64;
        let mut fragments = Vec::new();
        for number in 0..200_000 {
            // As many of 10 as of 40.
            let size = if number % 2 == 0 { 10.0 } else { 40.0 };
            let middle = DVec2::new(unit(), unit()) * 200.0 - 50.0;
            let far = (middle - 50.0).abs().max_element() - 50.0;
            if far < size / 2.0 {
                fragments.push(fragment(size, size, far > -size / 2.0));
            }
        }
        let photo = PhotoFragments {
            fragments,
            frame: DVec2::splat(100.0),
            fines: 0.0,
            limit: 1.0,
        };
        let small = |steps: Steps| {
            let all = by_mass(std::slice::from_ref(&photo), steps).unwrap();
            all.curve.percent_passing(20.0).unwrap()
        };
        let strewn = 100.0 / 17.0;
        assert!(
            (small(Steps::default()) - strewn).abs() < 0.15,
            "{}",
            small(Steps::default())
        );
        let not = small(Steps {
            edges: false,
            ..Steps::default()
        });
        assert!(not > 11.0, "{not}");
    }
}
