//! Where a photo lies in its frame: fitted, or so many times larger around a place of it.

use glam::DVec2;

/// The most pixels of the screen for one of the photo.
const LARGEST: f64 = 32.0;

/// How a photo is placed in a frame. Sizes and places of frames are in pixels of the screen, those of images
/// in their own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placing {
    /// Pixels of the screen for one of the photo; `None` shows all of it.
    pub zoom: Option<f64>,
    /// Which place of the photo is in the frame's middle, as a share of its width and height.
    pub middle: DVec2,
}

impl Default for Placing {
    fn default() -> Self {
        Self {
            zoom: None,
            middle: DVec2::splat(0.5),
        }
    }
}

/// The zoom that shows all of an image.
fn fit(image: DVec2, frame: DVec2) -> f64 {
    (frame / image).min_element()
}

impl Placing {
    /// Pixels of the screen for one of the image.
    pub fn scale(&self, image: DVec2, frame: DVec2) -> f64 {
        self.zoom.unwrap_or_else(|| fit(image, frame))
    }

    /// Where the image's top left corner is in the frame.
    pub fn corner(&self, image: DVec2, frame: DVec2) -> DVec2 {
        frame * 0.5 - self.middle * image * self.scale(image, frame)
    }

    /// Larger by a factor, with what is under the cursor staying there. No smaller than fitted.
    #[must_use]
    pub fn zoomed(self, cursor: DVec2, factor: f64, image: DVec2, frame: DVec2) -> Self {
        let before = self.scale(image, frame);
        let least = fit(image, frame);
        let scale = (before * factor).clamp(least.min(LARGEST), LARGEST.max(least));
        if scale.is_nan() || scale <= least * 1.000_001 {
            return Self::default();
        }
        let under = (cursor - self.corner(image, frame)) / before;
        let corner = cursor - under * scale;
        let middle = (frame * 0.5 - corner) / (image * scale);
        Self {
            zoom: Some(scale),
            middle,
        }
        .held()
    }

    /// Moved by so many pixels of the screen.
    #[must_use]
    pub fn panned(self, by: DVec2, image: DVec2, frame: DVec2) -> Self {
        let middle = self.middle - by / (image * self.scale(image, frame));
        Self { middle, ..self }.held()
    }

    /// With this pixel in the middle, one to one at least.
    #[must_use]
    pub fn at(self, pixel: DVec2, image: DVec2) -> Self {
        Self {
            zoom: Some(self.zoom.unwrap_or(1.0).max(1.0)),
            middle: (pixel / image).clamp(DVec2::ZERO, DVec2::ONE),
        }
    }

    /// Not lost from sight: some place of the photo is in the frame's middle.
    fn held(self) -> Self {
        Self {
            middle: self.middle.clamp(DVec2::ZERO, DVec2::ONE),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const IMAGE: DVec2 = DVec2::new(4000.0, 3000.0);
    const FRAME: DVec2 = DVec2::new(1000.0, 600.0);

    /// 600 of 3000 rows: a fifth, 800 wide, 100 free at each side.
    #[test]
    fn fitted_it_is_in_the_middle() {
        let placing = Placing::default();
        assert_eq!(placing.scale(IMAGE, FRAME), 0.2);
        assert!(
            placing
                .corner(IMAGE, FRAME)
                .distance(DVec2::new(100.0, 0.0))
                < 1e-9
        );
    }

    #[test]
    fn the_wheel_keeps_what_is_under_the_cursor() {
        let mut placing = Placing::default();
        let cursor = DVec2::new(700.0, 200.0);
        // (700 - 100) / 0.2 and 200 / 0.2.
        let under = DVec2::new(3000.0, 1000.0);
        for factor in [1.5, 4.0, 3.0, 0.5] {
            placing = placing.zoomed(cursor, factor, IMAGE, FRAME);
            let scale = placing.scale(IMAGE, FRAME);
            let there = placing.corner(IMAGE, FRAME) + under * scale;
            assert!(there.distance(cursor) < 1e-6, "{there} at {scale}");
        }
        assert!((placing.scale(IMAGE, FRAME) - 1.8).abs() < 1e-9);
        let most = placing.zoomed(cursor, 1e9, IMAGE, FRAME);
        assert_eq!(most.scale(IMAGE, FRAME), LARGEST);
        // All the way back it is fitted, wherever the cursor is.
        assert_eq!(
            placing.zoomed(cursor, 1e-9, IMAGE, FRAME),
            Placing::default()
        );
    }

    #[test]
    fn a_drag_moves_it_and_does_not_lose_it() {
        let placing = Placing::default().at(DVec2::new(4000.0, 0.0), IMAGE);
        // The top right corner in the middle of the frame, one to one.
        assert_eq!(placing.corner(IMAGE, FRAME), DVec2::new(-3500.0, 300.0));
        let moved = placing.panned(DVec2::new(10.0, -20.0), IMAGE, FRAME);
        assert!(
            moved
                .corner(IMAGE, FRAME)
                .distance(DVec2::new(-3490.0, 280.0))
                < 1e-9
        );
        let lost = placing.panned(DVec2::new(-1e9, 1e9), IMAGE, FRAME);
        assert_eq!(lost.middle, DVec2::new(1.0, 0.0));
    }
}
