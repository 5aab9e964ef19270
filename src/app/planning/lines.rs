//! The plan as lines of the picture: what each photo will show, its camera, the way coloured by its clearance, areas.

use glam::{DVec2, DVec3};

use crate::plan::{Plan, PlannedPhoto, Terrain, Way};
use crate::render::{PlannedLine, SELECTED};

/// A photo that holds what was asked for.
const GOOD: [u8; 3] = [70, 190, 130];
/// One that does not.
const TROUBLED: [u8; 3] = [240, 150, 40];
/// What is photographed.
const AREA: [u8; 3] = [235, 235, 235];
/// What is kept out of, and a way that is as near to the ground as it may be.
const KEEP_OUT: [u8; 3] = [225, 60, 60];
/// A way with twice the clearance, and one with more.
const WAY: [[u8; 3]; 2] = [[240, 205, 60], [90, 160, 255]];
/// Points along a side of an area: it lies on the ground.
const PER_SIDE: u32 = 16;
/// The side of a camera, in the distance of its photo.
const CAMERA: f64 = 0.08;

/// The way in pieces that have one colour each.
pub(super) fn way(way: &Way, plan: &Plan) -> Vec<PlannedLine> {
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
pub(super) fn photos(plan: &Plan, selected: Option<usize>) -> Vec<PlannedLine> {
    let order = (0..plan.photos.len()).filter(|place| Some(*place) != selected);
    let order = order.chain(selected.filter(|place| *place < plan.photos.len()));
    let lines = order.flat_map(|place| {
        let photo = &plan.photos[place];
        let (color, width) = match () {
            () if Some(place) == selected => (SELECTED, 3.0),
            () if plan.troubles(place).is_empty() => (GOOD, 1.4),
            () => (TROUBLED, 1.4),
        };
        let mut outline = photo.outline.clone();
        outline.extend(photo.outline.first());
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
    let camera = &plan.camera;
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let corner = |x: f64, y: f64| {
        let direction = camera.direction_undistorted(DVec2::new(x * width, y * height));
        photo.pose.center + photo.pose.rotation * direction * (CAMERA * photo.distance)
    };
    let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| corner(x, y));
    let eye = photo.pose.center;
    vec![a, b, c, d, a, eye, b, c, eye, d]
}

/// What is photographed and what is kept out of.
pub(super) fn areas(plan: &Plan) -> Vec<PlannedLine> {
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
pub(super) fn on_ground(places: &[DVec2], is_closed: bool, terrain: &Terrain) -> Vec<DVec3> {
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
