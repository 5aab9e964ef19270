//! What a photo contributes: its fragments, its fines, and the limit below which it shows nothing.

use fragscale_core::scale::ScaleField;
use fragscale_core::units::LengthUnit;
use glam::DVec2;

use crate::engine::LEAST_PIXELS_ACROSS;
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
    /// How many millimetres one of these lengths is.
    pub mm: f64,
}

impl PhotoFragments {
    /// From a photo's label image, the scale field of all its pixels and the measures of its fragments, both in `unit`; the narrowest
    /// that its engine outlines is `least_across` pixels. Of what other tools and people outlined (`None`) the limit is the
    /// smallest that counts and is as wide as the narrowest that an engine outlines, or that width where none is: a speck and a
    /// line of pixels say nothing of the rest.
    pub fn new(
        labels: &LabelImage,
        field: &ScaleField,
        fragments: Vec<Fragment>,
        least_across: Option<f64>,
        unit: LengthUnit,
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
        let counts = (fragments.iter()).filter(|of| !of.is_cut && !is_speck(of));
        let sizes = counts.filter_map(|of| Some(of.world?.sieve_size));
        let of_others = || {
            sizes
                .reduce(f64::min)
                .unwrap_or(LEAST_PIXELS_ACROSS / scale)
        };
        let limit = least_across.map_or_else(of_others, |across| across / scale);
        Self {
            frame: DVec2::new(labels.width as f64, labels.height as f64),
            fines,
            limit,
            fragments,
            mm: unit.in_units_of(LengthUnit::Millimetre),
        }
    }

    /// The same without any fragment.
    pub(crate) fn without_fragments(&self) -> Self {
        Self {
            fragments: Vec::new(),
            ..*self
        }
    }
}

/// Whether a fragment has fewer pixels than the narrowest that an engine outlines, or is not as wide.
pub(super) fn is_speck(fragment: &Fragment) -> bool {
    let width = fragment.world.map(|of| of.widths[0] * of.scale);
    (fragment.pixels as f64) < std::f64::consts::PI / 4.0 * LEAST_PIXELS_ACROSS.powi(2)
        || width.is_some_and(|width| width < LEAST_PIXELS_ACROSS)
}
