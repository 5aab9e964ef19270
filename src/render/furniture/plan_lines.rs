//! The plan as lines of the picture: what each photo will show, its camera, the way coloured by its clearance, areas.

use glam::{DVec2, DVec3};

use crate::camera::{Camera, Pose};
use crate::plan::{Plan, PlannedPhoto, Terrain, Way};
use crate::show::PlannedLine;

use super::photo_lines::SELECTED;

/// A photo that holds what was asked for.
pub(super) const GOOD: [u8; 3] = [70, 190, 130];
/// One that does not.
pub(super) const TROUBLED: [u8; 3] = [240, 150, 40];
/// What is photographed.
const AREA: [u8; 3] = [235, 235, 235];
/// What is kept out of, and a way that is as near to the ground as it may be.
pub(super) const KEEP_OUT: [u8; 3] = [225, 60, 60];
/// A way with twice the clearance, and one with more.
pub(super) const WAY: [[u8; 3]; 2] = [[240, 205, 60], [90, 160, 255]];
/// Points along a side of an area: it lies on the ground.
const PER_SIDE: u32 = 16;
/// The side of a camera, in the distance of its photo.
const CAMERA: f64 = 0.08;

/// The way in pieces that have one colour each.
pub fn plan_way(way: &Way, plan: &Plan) -> Vec<PlannedLine> {
    let (terrain, least) = (&plan.terrain, plan.wish.clearance);
    let color_of = |place: DVec3| match terrain.clearance(place, 2.0 * least) {
        near if near < 1.25 * least => KEEP_OUT,
        near if near < 2.0 * least => WAY[0],
        _ => WAY[1],
    };
    let up = way.take_off.truncate().extend(way.safe_height);
    let flown = way.points.iter().map(|point| point.place);
    let all: Vec<DVec3> = [way.take_off, up]
        .into_iter()
        .chain(flown)
        .chain([up])
        .collect();
    let mut lines: Vec<PlannedLine> = Vec::new();
    for (number, leg) in all.windows(2).enumerate() {
        let steps = (leg[0].distance(leg[1]) / least).ceil().clamp(1.0, 200.0);
        // `as` is exact: a few hundred.
        for step in 0..steps as u32 {
            let at = |step: f64| leg[0].lerp(leg[1], step / steps);
            let [from, to] = [f64::from(step), f64::from(step) + 1.0].map(at);
            // It stands on the ground there, and has to.
            let color = match number {
                0 => WAY[1],
                _ => color_of((from + to) / 2.0),
            };
            match lines.last_mut() {
                Some(line) if line.color == color => line.points.push(to),
                _ => lines.push(PlannedLine {
                    points: vec![from, to],
                    color,
                    width: 2.0,
                }),
            }
        }
    }
    lines
}

/// The photos, the selected one above the others.
pub fn plan_photos(plan: &Plan, selected: Option<usize>) -> Vec<PlannedLine> {
    let order = (0..plan.photos.len()).filter(|place| Some(*place) != selected);
    let order = order.chain(selected.filter(|place| *place < plan.photos.len()));
    let lines = order.flat_map(|place| {
        let photo = &plan.photos[place];
        let (color, width) = match () {
            () if Some(place) == selected => (SELECTED, 3.0),
            () if plan.troubles(place).is_empty() => (GOOD, 1.4),
            () => (TROUBLED, 1.4),
        };
        // Those of a survey lie over each other many times: beside photos for scales they hide these.
        let is_hidden = photo.purpose != plan.wish.pattern.main() && Some(place) != selected;
        let mut outline = match is_hidden {
            true => Vec::new(),
            false => photo.outline.clone(),
        };
        outline.extend(outline.first().copied());
        [outline, camera(photo, plan)].map(|points| PlannedLine {
            points,
            color,
            width,
        })
    });
    lines.collect()
}

/// A photo's camera as a small pyramid, in one line.
fn camera(photo: &PlannedPhoto, plan: &Plan) -> Vec<DVec3> {
    pyramid(&plan.camera, &photo.pose, CAMERA * photo.distance)
}

/// A camera at a pose as a pyramid of this height, in one line.
pub(super) fn pyramid(camera: &Camera, pose: &Pose, side: f64) -> Vec<DVec3> {
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let corner = |x: f64, y: f64| {
        let direction = camera.direction_undistorted(DVec2::new(x * width, y * height));
        pose.center + pose.rotation * direction * side
    };
    let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| corner(x, y));
    let eye = pose.center;
    vec![a, b, c, d, a, eye, b, c, eye, d]
}

/// What is photographed and what is kept out of.
pub fn plan_areas(plan: &Plan) -> Vec<PlannedLine> {
    let keep_out = plan.wish.keep_out.iter().map(|area| (area, KEEP_OUT));
    let all = [(&plan.area, AREA)].into_iter().chain(keep_out);
    let lines = all.map(|(area, color)| PlannedLine {
        points: on_ground(area.corners(), true, &plan.terrain),
        color,
        width: 2.0,
    });
    lines.collect()
}

/// A line through places of the map, lying on the ground; where there is none, at the height of what is beside it.
fn on_ground(places: &[DVec2], is_closed: bool, terrain: &Terrain) -> Vec<DVec3> {
    let ends = places.iter().zip(places.iter().cycle().skip(1));
    let sides = if is_closed {
        places.len()
    } else {
        places.len().saturating_sub(1)
    };
    let on_sides = ends.take(sides).flat_map(|(from, to)| {
        let step = |step: u32| from.lerp(*to, f64::from(step) / f64::from(PER_SIDE));
        (0..=PER_SIDE).map(step)
    });
    let mut last = None;
    let known = terrain
        .heights()
        .iter()
        .copied()
        .find(|height| !height.is_nan());
    let heights = on_sides.map(|place| {
        let height = terrain.height(place).or(last).or(known).unwrap_or(0.0);
        last = Some(height);
        place.extend(height)
    });
    heights.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jobs::Progress;
    use crate::plan::{Drone, Pattern, Size, WayPoint, Wish};
    use crate::surface::{Cloud, Surface};
    use fragscale_core::survey::Polygon;

    fn plan() -> Plan {
        let points =
            (0..121 * 121).map(|i| DVec3::new(f64::from(i % 121), f64::from(i / 121), 3.0));
        let cloud = Cloud {
            points: points.collect(),
            ..Cloud::default()
        };
        let surface = Surface::new(cloud).unwrap();
        let corners = [(40.0, 40.0), (80.0, 40.0), (80.0, 80.0), (40.0, 80.0)];
        let area = Polygon::new(&corners.map(DVec2::from)).unwrap();
        let camera = Drone::ALL[0].camera();
        let wish = Wish::usual(Pattern::Paper, Size::Distance(20.0), None, 1.0);
        Plan::new(&surface, &camera, area, wish, &Progress::default()).unwrap()
    }

    /// Over level ground, with a clearance of 5: up to 6.25 above it a way is red, up to 10 yellow, above blue; and the
    /// climb from the ground, where it stands, is blue all along.
    #[test]
    fn a_way_is_coloured_by_its_height_above_the_ground() {
        let plan = plan();
        let at = |x: f64, height: f64| WayPoint {
            place: DVec3::new(x, 60.0, 3.0 + height),
            photo: None,
        };
        let flown = Way {
            take_off: DVec3::new(20.0, 60.0, 3.0),
            safe_height: 3.0 + 20.0,
            points: vec![
                at(30.0, 20.0),
                at(40.0, 5.5),
                at(60.0, 5.5),
                at(60.0, 8.0),
                at(80.0, 8.0),
            ],
            length: 0.0,
        };
        let lines = plan_way(&flown, &plan);
        let color_at = |x: f64, height: f64| {
            let place = DVec3::new(x, 60.0, 3.0 + height);
            let holds = |line: &&PlannedLine| {
                line.points.windows(2).any(|leg| {
                    let along = (leg[1] - leg[0]).normalize_or_zero();
                    let on = (place - leg[0])
                        .dot(along)
                        .clamp(0.0, leg[0].distance(leg[1]));
                    (leg[0] + along * on).distance(place) < 1e-6
                })
            };
            lines.iter().find(holds).map(|line| line.color)
        };
        assert_eq!(color_at(20.0, 2.0), Some(WAY[1]));
        assert_eq!(color_at(25.0, 20.0), Some(WAY[1]));
        assert_eq!(color_at(50.0, 5.5), Some(KEEP_OUT));
        assert_eq!(color_at(70.0, 8.0), Some(WAY[0]));
        // It is one line from end to end.
        for pair in lines.windows(2) {
            assert_eq!(pair[0].points.last(), pair[1].points.first());
        }
    }

    /// A photo that holds what was asked for, one that does not, and the one that is looked at, above the others.
    #[test]
    fn photos_are_coloured_by_their_troubles() {
        let mut plan = plan();
        let count = plan.photos.len();
        plan.photos[1].forecast = None;
        let lines = plan_photos(&plan, Some(0));
        let color_of = |photo: usize| {
            let eye = plan.photos[photo].pose.center;
            let has = |line: &&PlannedLine| line.points.contains(&eye);
            lines.iter().find(has).unwrap().color
        };
        assert_eq!(
            [color_of(0), color_of(1), color_of(2)],
            [SELECTED, TROUBLED, GOOD]
        );
        assert_eq!(lines.len(), 2 * count);
        assert_eq!(lines.last().unwrap().color, SELECTED);
    }
}
