//! Points that were picked on the surface, with their names.

use glam::DVec2;

use super::labels::Label;
use super::photo_lines::ink;
use crate::picture::Anchor;
use crate::primitives::lines::{Pen, Stroke};
use crate::show::Show;
use crate::view::View;

/// Of the points and their names.
const COLOR: [u8; 3] = [255, 150, 30];

/// A dot for each point that is before the eye, in pixels of the picture; over everything.
pub(super) fn strokes(view: &View, show: &Show, size: DVec2) -> Vec<Stroke> {
    let rim = ink(show).map(|channel| 255 - channel);
    let places = show.picked.iter();
    let places = places.filter_map(|(_, point)| view.project(*point, size));
    let dots = |place: DVec2| {
        [Pen::new(rim, 11.0).pale(0.7), Pen::new(COLOR, 8.0)].map(|pen| pen.dot(place.extend(0.0)))
    };
    places.flat_map(dots).collect()
}

/// Their names, at the right of the dots.
pub(super) fn labels(view: &View, show: &Show, size: DVec2) -> Vec<Label> {
    let label = |(name, point): &(String, _)| {
        Some(Label {
            at: view.project(*point, size)? + DVec2::X * 9.0 * show.pixels_per_point,
            text: name.clone(),
            anchor: Anchor::MiddleLeft,
            color: COLOR,
        })
    };
    show.picked.iter().filter_map(label).collect()
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;
    use crate::Projection;

    /// Ten pixels a unit, the name nine beside the dot; a point behind the eye is not there.
    #[test]
    fn a_point_is_seen_with_its_name() {
        let size = DVec2::new(600.0, 400.0);
        let mut view = View {
            eye: DVec3::ZERO,
            world_from_view: DMat3::IDENTITY,
            projection: Projection::Orthographic { height: 40.0 },
            focus: 50.0,
        };
        let show = Show {
            picked: vec![("P1".to_owned(), DVec3::new(3.0, 4.0, -2.0))],
            ..Show::default()
        };
        let [told] = &labels(&view, &show, size)[..] else {
            panic!("one name");
        };
        assert_eq!(told.text, "P1");
        assert!(told.at.distance(DVec2::new(339.0, 240.0)) < 1e-9);
        assert_eq!(strokes(&view, &show, size).len(), 2);
        view.projection = Projection::Perspective { fov_y: 0.8 };
        assert_eq!(labels(&view, &show, size), []);
        assert!(strokes(&view, &show, size).is_empty());
    }
}
