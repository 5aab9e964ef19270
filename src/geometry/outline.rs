//! Closed outlines in plan: what they surround, and how far they reach.

use glam::DVec2;

/// Whether a closed outline surrounds a place: a ray to the east crosses it an odd number of times.
pub fn surrounds(outline: &[DVec2], place: DVec2) -> bool {
    let next = outline.iter().cycle().skip(1);
    let crossed = outline.iter().zip(next).filter(|(a, b)| {
        let reaches = (a.y > place.y) != (b.y > place.y);
        reaches && place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

/// The least and the greatest x and y of places; of none the greatest numbers and the least.
pub fn extent(places: &[DVec2]) -> [DVec2; 2] {
    let begin = [DVec2::MAX, DVec2::MIN];
    (places.iter()).fold(begin, |[min, max], place| {
        [min.min(*place), max.max(*place)]
    })
}

/// Twice the area within a ring of corners, positive where they run counter-clockwise.
pub fn twice_signed_area(corners: &[DVec2]) -> f64 {
    let Some(&from) = corners.first() else {
        return 0.0;
    };
    // From its first corner: squares of UTM coordinates would lose the digits.
    let pairs = corners.windows(2);
    let twice = pairs.map(|pair| (pair[0] - from).perp_dot(pair[1] - from));
    twice.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_reaches_as_far_as_its_corners() {
        let outline = [(3.0, -1.0), (-2.0, 5.0), (0.0, 7.0)].map(DVec2::from);
        assert_eq!(
            extent(&outline),
            [DVec2::new(-2.0, -1.0), DVec2::new(3.0, 7.0)]
        );
    }

    #[test]
    fn an_outline_surrounds_what_is_inside() {
        // An L.
        let outline = [
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ];
        let outline = outline.map(DVec2::from);
        for (place, inside) in [
            ((0.5, 2.5), true),
            ((3.5, 0.5), true),
            ((2.0, 2.0), false),
            ((-0.1, 0.5), false),
            ((0.5, 3.5), false),
        ] {
            assert_eq!(surrounds(&outline, place.into()), inside, "{place:?}");
        }
        assert!(!surrounds(&[], DVec2::ZERO));
    }

    #[test]
    fn inside_is_inside() {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)];
        let corners = corners.map(DVec2::from);
        for (x, y, expected) in [
            (1.0, 0.5, true),
            (2.0, 2.0, false),
            (3.9, 3.5, true),
            (-1.0, 0.5, false),
            (5.0, 0.5, false),
        ] {
            assert_eq!(surrounds(&corners, DVec2::new(x, y)), expected, "{x} {y}");
        }
    }
}
