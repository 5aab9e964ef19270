//! What the pixels of a photo vote for, and what that says of a region.
//!
//! An engine may say of every pixel how large the fragment is that it lies on, and where its centroid is. The pixels of
//! a region that is one whole fragment then agree with it: their sizes are its own, and their ways end in its middle.
//! Those of a part of a fragment vote for a larger one with its middle elsewhere; those of two fragments that were joined
//! for two smaller ones (votes for centroids as in Neven et al. 2019, who make the regions of them; here the tree
//! proposes the regions).

use glam::DVec2;

use crate::measures::circle_diameter;

/// The votes of all pixels, row by row from the top left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Votes {
    /// The diameter of the circle with the fragment's area, pixels, as a power of two: 255 is the tenth.
    pub size: Vec<u8>,
    /// The way to the fragment's centroid, in those diameters: 0 is one to the left, 255 one to the right.
    pub right: Vec<u8>,
    /// And 0 one up, 255 one down.
    pub down: Vec<u8>,
}

/// What power of two a size of 1 (of 255) stands for.
pub(crate) const SIZE_OF_ONE: f32 = 10.0;
/// Steps of a size, of 255, to a power of two.
const STEPS: f64 = 255.0 / SIZE_OF_ONE as f64;

/// What of the votes of a region adds up. In whole numbers and halves, so exact in whatever order.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VoteSums {
    /// Of the sizes, 0 to 255 each.
    size: f64,
    size_squared: f64,
    /// Of the ways, a diameter is 255.
    way: DVec2,
    way_squared: f64,
    /// Of each way times its pixel's place.
    way_along: f64,
}

impl VoteSums {
    /// Takes in the vote of a pixel, whose middle is at this place.
    pub(crate) fn count(&mut self, votes: &Votes, pixel: usize, place: DVec2) {
        let [size, right, down] =
            [&votes.size, &votes.right, &votes.down].map(|plane| f64::from(plane[pixel]));
        let way = DVec2::new(2.0 * right - 255.0, 2.0 * down - 255.0);
        self.size += size;
        self.size_squared += size * size;
        self.way += way;
        self.way_squared += way.length_squared();
        self.way_along += way.dot(place);
    }

    /// Both together.
    pub(crate) fn and(&self, other: &Self) -> Self {
        Self {
            size: self.size + other.size,
            size_squared: self.size_squared + other.size_squared,
            way: self.way + other.way,
            way_squared: self.way_squared + other.way_squared,
            way_along: self.way_along + other.way_along,
        }
    }

    /// How far the votes of so many pixels are from their region: its `place` and `squares` are the sums of the pixels'
    /// places and of their squared distances from the origin. `None` where nobody voted.
    pub(crate) fn against(&self, area: f64, place: DVec2, squares: f64) -> Option<Against> {
        if self.way_squared == 0.0 {
            return None;
        }
        let diameter = circle_diameter(area);
        let size = self.size / area;
        let spread = (self.size_squared / area - size * size).max(0.0).sqrt();
        let middle = place / area;
        // The mean square of each vote less the way from the pixel to the middle, in the region's own diameters.
        let ways = self.way_squared / (255.0 * 255.0);
        let along = (self.way.dot(middle) - self.way_along) / 255.0;
        let around = squares - area * middle.length_squared();
        let off = (ways - 2.0 * along / diameter + around / (diameter * diameter)) / area;
        Some(Against {
            size: size / STEPS - diameter.log2(),
            spread: spread / STEPS,
            middle: off.max(0.0).sqrt(),
            bias: self.way.length() / 255.0 / area,
        })
    }
}

/// How far votes are from their region: 0 each where they agree with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Against {
    /// Of the sizes in the mean, as a power of two: above 0 for a larger fragment.
    pub size: f64,
    /// The deviation of the sizes, likewise.
    pub spread: f64,
    /// Of the centroids, root mean square, in the region's diameters.
    pub middle: f64,
    /// How long the mean of all ways is.
    pub bias: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Votes of a square of pixels, as its middle and size have them, and what its left half makes of them.
    #[test]
    fn a_whole_agrees_and_its_half_does_not() {
        let side = 40;
        let diameter = (f64::from(side * side) * 4.0 / std::f64::consts::PI).sqrt();
        let places: Vec<DVec2> = (0..side * side)
            .map(|pixel| DVec2::new(f64::from(pixel % side) + 0.5, f64::from(pixel / side) + 0.5))
            .collect();
        let to = |of: fn(DVec2) -> f64| -> Vec<u8> {
            let ways = places.iter().map(|place| of(DVec2::splat(20.0) - *place));
            ways.map(|way| (127.5 + 127.5 * way / diameter).round() as u8)
                .collect()
        };
        let votes = Votes {
            size: vec![(diameter.log2() * STEPS).round() as u8; places.len()],
            right: to(|way| way.x),
            down: to(|way| way.y),
        };
        let of = |is_in: &dyn Fn(DVec2) -> bool| {
            let (mut sums, mut area, mut place, mut squares) =
                (VoteSums::default(), 0.0, DVec2::ZERO, 0.0);
            for (pixel, at) in places.iter().enumerate().filter(|(_, at)| is_in(**at)) {
                sums.count(&votes, pixel, *at);
                area += 1.0;
                place += *at;
                squares += at.length_squared();
            }
            sums.against(area, place, squares).unwrap()
        };
        let whole = of(&|_| true);
        assert!(whole.size.abs() < 0.02 && whole.spread == 0.0, "{whole:?}");
        assert!(whole.middle < 0.005 && whole.bias < 0.005, "{whole:?}");
        let half = of(&|at| at.x < 20.0);
        // Its diameter is that of the whole over the root of two.
        assert!((half.size - 0.5).abs() < 0.02, "{half:?}");
        // Its ways lead 10 pixels to the right in the mean, in diameters of the whole.
        assert!((half.bias - 10.0 / diameter).abs() < 0.005, "{half:?}");
        let own = diameter / 2.0_f64.sqrt();
        let by_hand = places.iter().filter(|at| at.x < 20.0).map(|at| {
            let vote = (DVec2::splat(20.0) - *at) / diameter;
            (vote - (DVec2::new(10.0, 20.0) - *at) / own).length_squared()
        });
        let by_hand = (by_hand.sum::<f64>() / 800.0).sqrt();
        assert!((half.middle - by_hand).abs() < 0.005, "{half:?} {by_hand}");
        assert_eq!(VoteSums::default().against(9.0, DVec2::ONE, 30.0), None);
    }
}
