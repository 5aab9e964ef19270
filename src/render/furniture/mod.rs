//! What helps to read a picture and is no data: the ground's grid, the axes, the scale bar.

mod clip_box;
pub(crate) mod crowd;
mod drawn;
pub(crate) mod flight_line;
pub(crate) mod flown_lines;
pub(crate) mod image_edge;
pub(crate) mod labels;
pub(crate) mod measured;
pub(crate) mod photo_lines;
mod picked;
pub(crate) mod plan_lines;
pub(crate) mod words;

use glam::{DVec2, DVec3};

use crate::numbers::round_down;
use crate::picture::Anchor;
use crate::primitives::lines::{Pen, Stroke};
use crate::show::Show;
use crate::view::View;
use labels::{Label, ScaleBar};
use photo_lines::ink;

/// Points of the user interface between furniture and the picture's edge.
const MARGIN: f64 = 18.0;
/// Letters that stand over the middle of a scale bar of any length.
const MOST_OVER_THE_MIDDLE: usize = 8;
/// Length of an axis in points.
const AXIS: f64 = 30.0;
const AXES: [(&str, DVec3, [u8; 3]); 3] = [
    ("x", DVec3::X, [222, 77, 77]),
    ("y N", DVec3::Y, [88, 170, 76]),
    ("z", DVec3::Z, [72, 132, 232]),
];

/// The scale bar that suits a view: at most a fifth of the viewport's width. `None` where a length
/// cannot be given, in a view without extent.
pub(crate) fn scale_bar(view: &View, size: DVec2) -> Option<ScaleBar> {
    let pixels_per_unit = view.pixels_per_unit(size, view.focus);
    let most = size.x * 0.2 / pixels_per_unit;
    let length = round_down(most)?;
    Some(ScaleBar {
        length,
        pixels: length * pixels_per_unit,
    })
}

/// Where the scale bar begins and ends, in pixels.
fn scale_bar_ends(view: &View, show: &Show, size: DVec2) -> Option<(ScaleBar, [DVec2; 2])> {
    let bar = scale_bar(view, size)?;
    let end = size - DVec2::splat(MARGIN * show.pixels_per_point);
    Some((bar, [end - DVec2::X * bar.pixels, end]))
}

/// Where the axes begin and end in the picture, the farthest first.
fn axis_ends(view: &View, show: &Show, size: DVec2) -> Vec<(usize, DVec2, DVec2)> {
    let point = show.pixels_per_point;
    let start = DVec2::new(MARGIN + AXIS, size.y / point - MARGIN - AXIS) * point;
    let view_from_world = view.world_from_view.transpose();
    let mut axes: Vec<(usize, DVec3)> = AXES
        .iter()
        .map(|(_, axis, _)| view_from_world * *axis)
        .enumerate()
        .collect();
    axes.sort_by(|a, b| b.1.z.total_cmp(&a.1.z));
    axes.into_iter()
        .map(|(i, axis)| (i, start, start + axis.truncate() * AXIS * point))
        .collect()
}

/// The strokes of axes and scale bar, in pixels of the picture.
pub(crate) fn on_screen(view: &View, show: &Show, size: DVec2) -> Vec<Stroke> {
    let mut strokes = Vec::new();
    let at = |pixel: DVec2| pixel.extend(0.0);
    if show.axes {
        for (i, from, to) in axis_ends(view, show, size) {
            strokes.push(Pen::new(AXES[i].2, 2.4).line(at(from), at(to)));
        }
    }
    if show.scale_bar
        && let Some((_, [from, to])) = scale_bar_ends(view, show, size)
    {
        let tick = DVec2::Y * 4.0 * show.pixels_per_point;
        let parts = [
            (from, to),
            (from - tick, from + tick),
            (to - tick, to + tick),
        ];
        // A rim in the background's shade keeps it readable on any surface.
        let rim = ink(show).map(|channel| 255 - channel);
        for pen in [Pen::new(rim, 4.5).pale(0.55), Pen::new(ink(show), 2.0)] {
            strokes.extend(parts.map(|(from, to)| pen.line(at(from), at(to))));
        }
    }
    strokes.extend(clip_box::strokes(view, show, size));
    strokes.extend(drawn::strokes(view, show, size));
    strokes.extend(measured::strokes(view, show, size));
    strokes.extend(picked::strokes(view, show, size));
    strokes
}

/// The words to [`on_screen`].
pub(crate) fn labels(view: &View, show: &Show, size: DVec2) -> Vec<Label> {
    let mut labels = Vec::new();
    if show.axes {
        for (i, from, to) in axis_ends(view, show, size) {
            let direction = (to - from).normalize_or_zero();
            labels.push(Label {
                at: to + direction * 9.0 * show.pixels_per_point,
                text: AXES[i].0.to_owned(),
                anchor: Anchor::Middle,
                color: AXES[i].2,
            });
        }
    }
    if show.scale_bar
        && let Some((bar, [from, to])) = scale_bar_ends(view, show, size)
    {
        let text = format!("{} {}", bar.length, show.lengths_in);
        // "2 units of the file" over a short bar would reach beyond the picture.
        let (at, anchor) = match text.chars().count() > MOST_OVER_THE_MIDDLE {
            true => (to, Anchor::BottomRight),
            false => ((from + to) * 0.5, Anchor::BottomMiddle),
        };
        labels.push(Label {
            at: at - DVec2::Y * 5.0 * show.pixels_per_point,
            text,
            anchor,
            color: ink(show),
        });
    }
    labels.extend(measured::labels(view, show, size));
    labels.extend(picked::labels(view, show, size));
    labels
}

/// A grid at `ground` (local elevation) under a box given by its middle and radius: every tenth line
/// is stronger.
pub(crate) fn ground_grid(
    ground: f64,
    middle: DVec3,
    radius: f64,
    origin: DVec3,
    show: &Show,
) -> Vec<Stroke> {
    let Some(cell) = round_down(radius / 8.0) else {
        return Vec::new();
    };
    let reach = (radius * 1.3 / cell).ceil();
    let mut strokes = Vec::new();
    // Lines at whole multiples in the world, as on a map.
    let number = |local: f64, origin: f64| ((local + origin) / cell).round();
    let (column, row) = (number(middle.x, origin.x), number(middle.y, origin.y));
    let ends = [-reach, reach];
    // `as` saturates.
    for step in -(reach as i32)..=reach as i32 {
        let pen = |number: f64| {
            let strong = number.rem_euclid(10.0) < 0.5;
            Pen::new(ink(show), 1.0).pale(if strong { 0.5 } else { 0.22 })
        };
        let step = f64::from(step);
        let x = (column + step) * cell - origin.x;
        let y = (row + step) * cell - origin.y;
        let [south, north] = ends.map(|end| (row + end) * cell - origin.y);
        let [west, east] = ends.map(|end| (column + end) * cell - origin.x);
        strokes.push(
            pen(column + step).line(DVec3::new(x, south, ground), DVec3::new(x, north, ground)),
        );
        strokes
            .push(pen(row + step).line(DVec3::new(west, y, ground), DVec3::new(east, y, ground)));
    }
    strokes
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::Projection;

    /// Two points that are the bar's length apart across the axis at the focus are the bar's pixels
    /// apart in the picture; in parallel projection at any depth.
    #[test]
    fn the_scale_bar_is_true() {
        let size = DVec2::new(1280.0, 720.0);
        let tilted = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_x(2.2);
        for (projection, depths) in [
            (Projection::Perspective { fov_y: 0.8 }, &[37.0][..]),
            (
                Projection::Orthographic { height: 55.0 },
                &[1.0, 37.0, 900.0][..],
            ),
        ] {
            let view = View {
                eye: DVec3::new(500_000.0, 5_000_000.0, 200.0),
                world_from_view: tilted,
                projection,
                focus: 37.0,
            };
            let bar = scale_bar(&view, size).unwrap();
            assert!(bar.pixels <= 256.0 && bar.pixels > 90.0, "{bar:?}");
            for depth in depths {
                let at = view.eye + tilted * DVec3::new(3.0, -2.0, *depth);
                let from = view.project(at, size).unwrap();
                let to = view.project(at + tilted.x_axis * bar.length, size).unwrap();
                assert!((from.distance(to) - bar.pixels).abs() < 1e-6);
            }
        }
    }

    /// Long words over a short bar end where the bar does, short ones stand over its middle.
    #[test]
    fn the_scale_bars_words_stay_in_the_picture() {
        let size = DVec2::new(600.0, 400.0);
        let view = View {
            eye: DVec3::ZERO,
            world_from_view: DMat3::IDENTITY,
            projection: Projection::Orthographic { height: 55.0 },
            focus: 37.0,
        };
        for (lengths_in, ends_there) in [("m", false), ("units of the file", true)] {
            let show = Show {
                axes: false,
                lengths_in,
                ..Show::default()
            };
            let (_, [from, to]) = scale_bar_ends(&view, &show, size).unwrap();
            let labels = labels(&view, &show, size);
            let words = labels
                .iter()
                .find(|label| label.text.ends_with(lengths_in))
                .unwrap();
            let (at, anchor) = match ends_there {
                true => (to.x, Anchor::BottomRight),
                false => ((from.x + to.x) / 2.0, Anchor::BottomMiddle),
            };
            assert_eq!((words.at.x, words.anchor), (at, anchor), "{lengths_in}");
        }
    }
}
