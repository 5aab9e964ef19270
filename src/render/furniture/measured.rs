//! The distance tool on the picture: its points, the line between them, the distance with its level and
//! upright parts.

use glam::{DVec2, DVec3};

use super::labels::Label;
use super::photo_lines::ink;
use crate::numbers::significant_digits;
use crate::picture::Anchor;
use crate::primitives::lines::{Pen, Stroke};
use crate::show::Show;
use crate::view::View;

/// Of the points and the line, and of all that is measured by hand.
pub const MEASURED: [u8; 3] = [255, 60, 180];
/// From here on a part is drawn: nearly along the line it would only thicken that, in pixels.
const LEAST_PART: f64 = 6.0;

/// Where the points are seen, in pixels.
fn places(view: &View, show: &Show, size: DVec2) -> Vec<DVec2> {
    let points = show.measured.iter();
    points.filter_map(|&p| view.project(p, size)).collect()
}

/// Where the level and the upright part meet: beside the lower point, under or over the other.
fn elbow([a, b]: [DVec3; 2]) -> DVec3 {
    let (low, high) = if a.z <= b.z { (a, b) } else { (b, a) };
    high.with_z(low.z)
}

/// The line and its points, in pixels of the picture; over everything, wherever the points are.
pub(super) fn strokes(view: &View, show: &Show, size: DVec2) -> Vec<Stroke> {
    let places = places(view, show, size);
    let at = |pixel: DVec2| pixel.extend(0.0);
    let rim = ink(show).map(|channel| 255 - channel);
    let pens = [Pen::new(rim, 4.5).pale(0.55), Pen::new(MEASURED, 2.0)];
    let mut strokes = Vec::new();
    if let ([from, to], [a, b]) = (&places[..], &show.measured[..])
        && let Some(corner) = view.project(elbow([*a, *b]), size)
    {
        let least = LEAST_PART * show.pixels_per_point;
        for end in [*from, *to] {
            if end.distance(corner) > least {
                strokes.push(Pen::new(rim, 3.0).pale(0.4).line(at(end), at(corner)));
                strokes.push(Pen::new(MEASURED, 1.2).pale(0.8).line(at(end), at(corner)));
            }
        }
    }
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

/// The distance over the middle of the line, and under it how far that is level and up.
pub(super) fn labels(view: &View, show: &Show, size: DVec2) -> Vec<Label> {
    let [a, b] = show.measured[..] else {
        return Vec::new();
    };
    let [from, to] = places(view, show, size)[..] else {
        return Vec::new();
    };
    let unit = show.lengths_in;
    let way = b - a;
    let distance = significant_digits(way.length(), 4);
    // Its parts are no surer than the whole.
    let decimals = distance
        .split_once('.')
        .map_or(0, |(_, behind)| behind.len());
    let [level, up] = [way.truncate().length(), way.z].map(|length| {
        let length = format!("{length:.decimals$}");
        let is_none = length.chars().all(|sign| matches!(sign, '-' | '0' | '.'));
        match is_none {
            true => length.trim_start_matches('-').to_owned(),
            false => length,
        }
    });
    let middle = (from + to) * 0.5;
    let away = DVec2::Y * 8.0 * show.pixels_per_point;
    let label = |at, text, anchor| Label {
        at,
        text,
        anchor,
        color: MEASURED,
    };
    vec![
        label(
            middle - away,
            format!("{distance} {unit}"),
            Anchor::BottomMiddle,
        ),
        label(
            middle + away,
            format!("level {level} {unit}, up {up} {unit}"),
            Anchor::TopMiddle,
        ),
    ]
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
        let [told, parts] = &labels(&view, &show, size)[..] else {
            panic!("two labels");
        };
        assert_eq!(told.text, "13.00 m");
        // 3 and 4 give 5.
        assert_eq!(parts.text, "level 5.00 m, up 12.00 m");
        assert!(parts.at.distance(DVec2::new(315.0, 228.0)) < 1e-6);
        // Ten pixels a unit: 1.5 and 2 units off the middle, and 8 pixels up.
        assert!(
            told.at.distance(DVec2::new(315.0, 212.0)) < 1e-6,
            "{}",
            told.at
        );
        // The line and two dots with their rims, and the level part; the upright one is along the view.
        assert_eq!(strokes(&view, &show, size).len(), 8);
        let down = Show {
            measured: show.measured.iter().rev().copied().collect(),
            ..Show::default()
        };
        assert_eq!(
            labels(&view, &down, size)[1].text,
            "level 5.00 m, up -12.00 m"
        );
        let nearly_level = Show {
            measured: vec![origin, origin + DVec3::new(3.0, 4.0, -0.001)],
            ..Show::default()
        };
        assert_eq!(
            labels(&view, &nearly_level, size)[1].text,
            "level 5.000 m, up -0.001 m"
        );
        let level = Show {
            measured: vec![origin, origin + DVec3::new(30.0, 40.0, -0.001)],
            ..Show::default()
        };
        assert_eq!(
            labels(&view, &level, size)[1].text,
            "level 50.00 m, up 0.00 m"
        );
        view.projection = Projection::Perspective { fov_y: 0.8 };
        view.eye = origin + DVec3::Z * 6.0;
        assert_eq!(labels(&view, &show, size), []);
        assert_eq!(strokes(&view, &show, size).len(), 2);
    }
}
