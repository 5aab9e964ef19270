//! How ways, areas and the take-off are drawn, on the map and in its legend.

use glam::DVec2;

use crate::drawing::{Colour, Dash, Pen};

pub(super) const WAY: Colour = [25, 70, 160];
const AREA: Colour = [90, 20, 110];
const KEEP_OUT: Colour = [190, 15, 40];
/// From the middle of a leg to the tip of its arrow.
const ARROW: f64 = 5.0;
/// A leg that is shorter has none.
const SHORTEST_WITH_ARROW: f64 = 26.0;
/// Half the width of the mark of the take-off.
pub(super) const TAKE_OFF: f64 = 6.0;

/// The ways of batteries are told apart by these, in turn.
pub(super) const DASHES: [Dash; 4] = [Dash::Solid, Dash::Long, Dash::Short, Dash::DashDot];

pub(super) fn way_line(places: &[[f64; 2]], dash: Dash, pen: &mut Pen) {
    pen.line(places, [255; 3], 3.4, Dash::Solid);
    pen.line(places, WAY, 1.4, dash);
    for leg in places.windows(2) {
        let [from, to] = [leg[0], leg[1]].map(DVec2::from);
        let long = from.distance(to);
        if long < SHORTEST_WITH_ARROW {
            continue;
        }
        let along = (to - from) / long * ARROW;
        let (middle, aside) = ((from + to) / 2.0, along.perp() * 0.7);
        let corners = [
            middle + along,
            middle - along + aside,
            middle - along - aside,
        ];
        pen.area(&corners.map(|corner| corner.to_array()), WAY, 1.0);
    }
}

pub(super) fn area_line(points: &[[f64; 2]], pen: &mut Pen) {
    pen.line(points, AREA, 1.8, Dash::DashDot);
}

/// An area that is not flown over.
pub(super) fn keep_out_area(corners: &[[f64; 2]], pen: &mut Pen) {
    pen.area(corners, KEEP_OUT, 0.25);
    let around: Vec<[f64; 2]> = corners.iter().chain(corners.first()).copied().collect();
    pen.line(&around, KEEP_OUT, 2.4, Dash::Solid);
}
