//! The distance tool on the picture: its points, the line between them, the distance.

use glam::DVec2;

use super::labels::Label;
use super::photo_lines::ink;
use crate::numbers::significant_digits;
use crate::picture::Anchor;
use crate::primitives::lines::{Pen, Stroke};
use crate::show::Show;
use crate::view::View;

/// Of the points and the line.
const COLOR: [u8; 3] = [255, 60, 180];

/// Where the points are seen, in pixels.
fn places(view: &View, show: &Show, size: DVec2) -> Vec<DVec2> {
    let points = show.measured.iter();
    points.filter_map(|&p| view.project(p, size)).collect()
}

/// The line and its points, in pixels of the picture; over everything, wherever the points are.
pub(super) fn strokes(view: &View, show: &Show, size: DVec2) -> Vec<Stroke> {
    let places = places(view, show, size);
    let at = |pixel: DVec2| pixel.extend(0.0);
    let rim = ink(show).map(|channel| 255 - channel);
    let pens = [Pen::new(rim, 4.5).pale(0.55), Pen::new(COLOR, 2.0)];
    let mut strokes = Vec::new();
    for pen in pens {
        if let [from, to] = places[..] {
            strokes.push(pen.line(at(from), at(to)));
        }
        for &place in &places {
            let dot = Pen {
                width: pen.width + 6.0,
                ..pen
            };
            strokes.push(dot.dot(at(place)));
        }
    }
    strokes
}

/// The distance, over the middle of the line.
pub(super) fn label(view: &View, show: &Show, size: DVec2) -> Option<Label> {
    let [a, b] = show.measured[..] else {
        return None;
    };
    let [from, to] = places(view, show, size)[..] else {
        return None;
    };
    let distance = significant_digits(a.distance(b), 4);
    Some(Label {
        at: (from + to) * 0.5 - DVec2::Y * 8.0 * show.pixels_per_point,
        text: format!("{distance} {}", show.lengths_in),
        anchor: Anchor::BottomMiddle,
        color: COLOR,
    })
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;
    use crate::Projection;

    /// 3, 4 and 12 give 13, whose line's middle is seen where the points' middle is in parallel
    /// projection; a point behind the eye has no line.
    #[test]
    fn the_distance_is_told_over_the_middle() {
        let size = DVec2::new(600.0, 400.0);
        let origin = DVec3::new(500_000.0, 5_000_000.0, 160.0);
        let mut view = View {
            eye: origin - DVec3::Z * 50.0,
            world_from_view: DMat3::IDENTITY,
            projection: Projection::Orthographic { height: 40.0 },
            focus: 50.0,
        };
        let show = Show {
            measured: vec![origin, origin + DVec3::new(3.0, 4.0, 12.0)],
            ..Show::default()
        };
        let told = label(&view, &show, size).unwrap();
        assert_eq!(told.text, "13.00 m");
        // Ten pixels a unit: 1.5 and 2 units off the middle, and 8 pixels up.
        assert!(
            told.at.distance(DVec2::new(315.0, 212.0)) < 1e-6,
            "{}",
            told.at
        );
        assert_eq!(strokes(&view, &show, size).len(), 6);
        view.projection = Projection::Perspective { fov_y: 0.8 };
        view.eye = origin + DVec3::Z * 6.0;
        assert_eq!(label(&view, &show, size), None);
        assert_eq!(strokes(&view, &show, size).len(), 2);
    }
}
