//! The figure's shapes.

use glam::{DVec2, DVec3};

use super::FlownFigure;
use super::names::{NamesRoom, WIDER};
use super::style::{INK, MARK, NAME};
use super::view::{AZIMUTH, ELEVATION, View};
use crate::drawing::{Anchor, Colour, Dash, Marker, Pen, Shape, png};
use crate::flown_report::flown_summary;
use crate::geometry::{Bounds, LevelBox};
use crate::numbers::significant_digits;
use crate::plan::photos::shortened;

/// Width of the figure, CSS pixels; its height goes by the box.
const WIDE: f64 = 900.0;
const MARGIN: f64 = 24.0;
/// Above and below the view, and beside it for the lengths.
const HEAD: f64 = 74.0;
const LEGEND: f64 = 78.0;
const SIDE: f64 = 76.0;
/// The view's own height at most, and at least, so that the arrow to the north has room.
const HIGHEST: f64 = 520.0;
const LOWEST: f64 = 170.0;
const TITLE: f64 = 21.0;
const TEXT: f64 = 14.0;
const ROW: f64 = 19.0;

const SOFT: Colour = [150; 3];
const FLOOR: Colour = [235, 238, 241];
/// Okabe and Ito's, apart in grey, too.
const PLANNED: Colour = [0, 114, 178];
const FLOWN: Colour = [213, 94, 0];
const UNPLANNED: Colour = [0, 158, 115];

/// The shapes, and the figure's width and height.
pub(super) fn draw(figure: &FlownFigure<'_>) -> (Vec<Shape>, [f64; 2]) {
    let planned: Vec<DVec3> = (figure.report.planned.iter())
        .map(|plan| plan.pose.center)
        .collect();
    let all: Vec<DVec3> = planned.iter().chain(figure.places).copied().collect();
    let mut pen = Pen::default();
    let Some(bounds) = Bounds::of(&all) else {
        return (pen.shapes, [WIDE, HEAD]);
    };
    let at = [SIDE, HEAD];
    let most = View::of(&bounds, at, [WIDE - 2.0 * SIDE, HIGHEST]);
    let high = |view: &View| {
        let heights = bounds.corners().map(|corner| view.place(corner)[1]);
        heights.iter().copied().fold(f64::MIN, f64::max)
            - heights.iter().copied().fold(f64::MAX, f64::min)
    };
    let room = [WIDE - 2.0 * SIDE, high(&most).clamp(LOWEST, HIGHEST)];
    let view = View::of(&bounds, at, room);
    let foot = HEAD + room[1] + 40.0;
    let drawing = Drawing {
        figure,
        view,
        bounds,
        planned,
    };
    drawing.head(&mut pen);
    drawing.box_behind(&mut pen);
    drawing.paths(&mut pen);
    drawing.photos(&mut pen);
    let mut room = NamesRoom::beside(drawing.places(all), WIDE);
    drawing.box_before(&mut room, &mut pen);
    drawing.names(room, &mut pen);
    drawing.north([WIDE - MARGIN - 34.0, HEAD + 10.0], &mut pen);
    drawing.legend([MARGIN, foot], &mut pen);
    (pen.shapes, [WIDE, (foot + LEGEND).ceil()])
}

struct Drawing<'a> {
    figure: &'a FlownFigure<'a>,
    view: View,
    /// Around all places.
    bounds: Bounds,
    /// Where photos were planned.
    planned: Vec<DVec3>,
}

impl Drawing<'_> {
    fn places(&self, points: impl IntoIterator<Item = DVec3>) -> Vec<[f64; 2]> {
        points
            .into_iter()
            .map(|point| self.view.place(point))
            .collect()
    }

    /// The foot of a place on the floor of the box.
    fn foot(&self, point: DVec3) -> DVec3 {
        point.truncate().extend(self.bounds.min.z)
    }

    /// Each planned place with that of its photo, where it was taken.
    fn pairs(&self) -> impl Iterator<Item = (DVec3, Option<DVec3>)> {
        let residuals = self.figure.report.flown.residuals.iter();
        let flown = residuals.map(|residual| {
            let photo = residual.as_ref()?.photo;
            self.figure.places.get(photo).copied()
        });
        self.planned.iter().copied().zip(flown)
    }

    /// Photos that nobody planned: their names and places.
    fn unplanned(&self) -> impl Iterator<Item = (&str, DVec3)> {
        let (report, places) = (self.figure.report, self.figure.places);
        let photos = report.flown.unplanned.iter();
        photos.filter_map(|photo| Some((report.photos.get(*photo)?.as_str(), *places.get(*photo)?)))
    }

    fn head(&self, pen: &mut Pen) {
        let report = self.figure.report;
        let title = format!("{}: planned and flown", shortened(report.flight));
        let at = [MARGIN, MARGIN];
        pen.text(at, TITLE, &title, Anchor::Left, INK);
        let said = flown_summary(report);
        let said = said.iter().map(|(name, words)| format!("{name} {words}"));
        let said: Vec<String> = said.collect();
        let at = [MARGIN, MARGIN + TITLE + 5.0];
        pen.text(at, TEXT, &said.join("; "), Anchor::Left, INK);
    }

    /// Whether an edge ends in the corner that the box hides: the farthest of its floor.
    fn is_hidden(&self, [from, to]: &[DVec3; 2]) -> bool {
        let behind = self.bounds.max.truncate().extend(self.bounds.min.z);
        [from, to].into_iter().any(|end| *end == behind)
    }

    fn edges(&self) -> [[DVec3; 2]; 12] {
        LevelBox::of(&self.bounds).edges()
    }

    fn box_behind(&self, pen: &mut Pen) {
        let (min, max) = (self.bounds.min, self.bounds.max);
        let floor = [
            (min.x, min.y),
            (max.x, min.y),
            (max.x, max.y),
            (min.x, max.y),
        ];
        let floor = floor.map(|(x, y)| DVec3::new(x, y, min.z));
        pen.area(&self.places(floor), FLOOR, 1.0);
        for edge in self.edges().iter().filter(|edge| self.is_hidden(edge)) {
            pen.line(&self.places(*edge), SOFT, 1.0, Dash::Short);
        }
        let places = self.planned.iter().chain(self.figure.places);
        for place in places {
            let line = self.places([*place, self.foot(*place)]);
            pen.line(&line, [180; 3], 0.7, Dash::Solid);
        }
    }

    /// Edges that are seen, and the lengths of those at its near foot.
    fn box_before(&self, room: &mut NamesRoom, pen: &mut Pen) {
        for edge in self.edges().iter().filter(|edge| !self.is_hidden(edge)) {
            pen.line(&self.places(*edge), INK, 1.0, Dash::Solid);
        }
        let (min, max) = (self.bounds.min, self.bounds.max);
        let size = self.bounds.size();
        let near = DVec2::new(0.0, 13.0);
        for (axis, from, to, anchor, off) in [
            (0, min, DVec3::new(max.x, min.y, min.z), Anchor::Left, near),
            (1, min, DVec3::new(min.x, max.y, min.z), Anchor::Right, near),
            (
                2,
                DVec3::new(max.x, min.y, min.z),
                DVec3::new(max.x, min.y, max.z),
                Anchor::Left,
                DVec2::new(7.0, 0.0),
            ),
        ] {
            let middle = DVec2::from(self.view.place((from + to) / 2.0)) + off;
            let name = ["x", "y", "z"][axis];
            let length = significant_digits(size[axis], 3);
            let words = format!("{name} {length} {}", self.figure.report.unit);
            pen.text(middle.to_array(), TEXT, &words, anchor, INK);
            let long = png::text_width(TEXT, &words) * WIDER;
            let left = match anchor {
                Anchor::Right => middle.x - long,
                Anchor::Left | Anchor::Middle => middle.x,
            };
            let half = TEXT / 2.0;
            room.take([[left, middle.y - half], [left + long, middle.y + half]]);
        }
    }

    fn paths(&self, pen: &mut Pen) {
        planned_line(&self.places(self.planned.iter().copied()), pen);
        flown_line(&self.places(self.figure.places.iter().copied()), pen);
        for (planned, flown) in self.pairs() {
            if let Some(flown) = flown {
                pen.line(&self.places([planned, flown]), INK, 1.6, Dash::Solid);
            }
        }
    }

    fn photos(&self, pen: &mut Pen) {
        for (planned, flown) in self.pairs() {
            let at = self.view.place(planned);
            pen.marker(at, Marker::Circle, MARK, PLANNED);
            match flown {
                Some(flown) => pen.marker(self.view.place(flown), Marker::Triangle, MARK, FLOWN),
                None => missing_mark(at, pen),
            }
        }
        for (_, place) in self.unplanned() {
            pen.marker(self.view.place(place), Marker::Square, MARK, UNPLANNED);
        }
    }

    /// Names where they have room: of what was not planned or is missing first, then of the first and the last, then
    /// of the others.
    fn names(&self, mut room: NamesRoom, pen: &mut Pen) {
        for (name, place) in self.unplanned() {
            room.name(self.view.place(place), name, pen);
        }
        let planned = || self.figure.report.planned.iter().zip(self.pairs());
        let missing = planned().filter(|(_, (_, flown))| flown.is_none());
        let ends = planned().take(1).chain(planned().last());
        for (plan, (place, _)) in missing.chain(ends).chain(planned()) {
            room.name(self.view.place(place), &plan.name, pen);
        }
    }

    /// North, lying on the level, as the view shows it.
    fn north(&self, at: [f64; 2], pen: &mut Pen) {
        let at = DVec2::from(at);
        let (north, east) = (
            self.view.along(DVec3::Y) * 30.0,
            self.view.along(DVec3::X) * 9.0,
        );
        let (tip, back) = (at + north, at - north);
        let [left, right] = [back - east, back + east];
        let heel = at - north * 0.6;
        let half = [tip, right, heel];
        pen.area(&half.map(|corner| corner.to_array()), INK, 1.0);
        let around = [tip, right, heel, left, tip];
        pen.line(
            &around.map(|corner| corner.to_array()),
            INK,
            1.0,
            Dash::Solid,
        );
        let letter = if self.figure.is_on_map { "N" } else { "y" };
        let at = tip + north.normalize_or_zero() * 10.0;
        pen.text(at.to_array(), TEXT + 2.0, letter, Anchor::Middle, INK);
    }

    fn legend(&self, [left, top]: [f64; 2], pen: &mut Pen) {
        let missing = self.pairs().filter(|(_, flown)| flown.is_none()).count();
        let unplanned = self.unplanned().count();
        let mut rows: Vec<(Sign, String)> = vec![
            (
                Sign::Planned,
                format!("planned: {} photos", self.planned.len()),
            ),
            (
                Sign::Flown,
                format!("flown: {} photos", self.figure.places.len()),
            ),
            (Sign::Apart, "from a plan to its photo".to_owned()),
        ];
        if missing > 0 {
            rows.push((Sign::Missing, format!("not taken: {missing}")));
        }
        if unplanned > 0 {
            rows.push((Sign::Unplanned, format!("not planned: {unplanned}")));
        }
        for (number, (sign, words)) in rows.iter().enumerate() {
            let x = left + (number % 3) as f64 * 225.0;
            let y = top + (number / 3) as f64 * ROW;
            let middle = [x + 16.0, y];
            let ends = [[x, y], [x + 32.0, y]];
            match sign {
                Sign::Planned => {
                    planned_line(&ends, pen);
                    pen.marker(middle, Marker::Circle, MARK, PLANNED);
                }
                Sign::Flown => {
                    flown_line(&ends, pen);
                    pen.marker(middle, Marker::Triangle, MARK, FLOWN);
                }
                Sign::Apart => pen.line(&ends, INK, 1.6, Dash::Solid),
                Sign::Missing => {
                    pen.marker(middle, Marker::Circle, MARK, PLANNED);
                    missing_mark(middle, pen);
                }
                Sign::Unplanned => pen.marker(middle, Marker::Square, MARK, UNPLANNED),
            }
            pen.text([x + 40.0, y], TEXT, words, Anchor::Left, INK);
        }
        let words = format!(
            "Box around all places; seen from azimuth {AZIMUTH}°, {ELEVATION}° above the horizon, without perspective; \
             lines go down to its floor"
        );
        let y = top + 2.0 * ROW + 6.0;
        pen.text([left, y], NAME, &words, Anchor::Left, INK);
    }
}

enum Sign {
    Planned,
    Flown,
    Apart,
    Missing,
    Unplanned,
}

fn planned_line(points: &[[f64; 2]], pen: &mut Pen) {
    pen.line(points, PLANNED, 1.4, Dash::Long);
}

fn flown_line(points: &[[f64; 2]], pen: &mut Pen) {
    pen.line(points, FLOWN, 1.4, Dash::Solid);
}

/// Over the mark of a planned photo.
fn missing_mark(at: [f64; 2], pen: &mut Pen) {
    pen.marker(at, Marker::Cross, MARK * 2.0, [185, 15, 40]);
}
