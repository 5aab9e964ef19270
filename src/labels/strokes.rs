//! The pixels under a stroke of the mouse.

use glam::DVec2;

use super::LabelImage;

impl LabelImage {
    /// Where in the order of rows the pixel lies that holds a place; `None` outside of the image.
    pub fn place_of(&self, place: DVec2) -> Option<usize> {
        let inside = place.x >= 0.0
            && place.y >= 0.0
            && place.x < self.width as f64
            && place.y < self.height as f64;
        inside.then(|| place.y as usize * self.width + place.x as usize)
    }

    /// The pixels that a stroke goes through, in its order, each once in a row: neighbours touch at sides or
    /// corners, so that what has sides in common lies on one side of it.
    pub(super) fn under(&self, stroke: &[DVec2]) -> Vec<usize> {
        let size = DVec2::new(self.width as f64, self.height as f64);
        // No stroke of a mouse goes farther out; a line to somewhere else would take for ever.
        let near = |place: &DVec2| place.clamp(DVec2::splat(-1.0), size + 1.0);
        let corners = stroke.iter().filter(|place| place.is_finite()).map(near);
        let corners: Vec<DVec2> = corners.collect();
        let mut places: Vec<usize> = Vec::new();
        let mut through = |place: DVec2| {
            let place = self.place_of(place);
            if let Some(place) = place
                && places.last() != Some(&place)
            {
                places.push(place);
            }
        };
        if let [only] = corners[..] {
            through(only);
        }
        for pair in corners.windows(2) {
            // Two a pixel: of one a pixel rounding leaves some out.
            let length = (pair[1] - pair[0]).abs().max_element();
            let steps = (2.0 * length).ceil().max(1.0);
            for step in 0..=steps as usize {
                through(pair[0].lerp(pair[1], step as f64 / steps));
            }
        }
        places
    }

    /// The pixels whose centres lie within `radius` of a stroke's, in the order of rows.
    pub(super) fn brushed(&self, stroke: &[DVec2], radius: f64) -> Vec<usize> {
        let radius = radius.min(self.width.max(self.height) as f64).max(0.5);
        let mut is_brushed = vec![false; self.labels.len()];
        let reach = radius as usize;
        for place in self.under(stroke) {
            let (x, y) = (place % self.width, place / self.width);
            for row in y.saturating_sub(reach)..=(y + reach).min(self.height - 1) {
                let off = row.abs_diff(y) as f64;
                let half = (radius * radius - off * off).max(0.0).sqrt() as usize;
                let from = row * self.width + x.saturating_sub(half);
                let to = row * self.width + (x + half).min(self.width - 1);
                is_brushed[from..=to].fill(true);
            }
        }
        let places = is_brushed.iter().enumerate();
        places
            .filter_map(|(place, is)| is.then_some(place))
            .collect()
    }
}
