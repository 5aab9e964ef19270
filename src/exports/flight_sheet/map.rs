//! The map of a sheet: as wide as A4 has room for, at a round scale, true where the page is printed at 100 %.
//!
//! Lengths are CSS pixels, 96 to an inch; x to the right, y down.

use std::sync::Arc;

use glam::DVec2;
use image::{Rgba, RgbaImage};

use super::FlightSheet;
use super::legend::legend;
use super::signs::{DASHES, TAKE_OFF, WAY, area_line, keep_out_area, way_line};
use crate::drawing::{Anchor, Marker, Pen, png, svg};
use crate::fault::Fault;
use crate::flight::Verdict;
use crate::plan::furniture::{self, A_MILLIMETRE, LABEL};
use crate::plan::photos::{FootprintStyle, NAME, footprints, marks_and_names};
use crate::plan::{Grid, MapFrame, Plan, PlanGround, PlanInks, PlanPhoto, RoomForNames, clip};
use crate::surface::{Light, MapRaster, hillshade};
use fragscale_core::plan::{Plan as FlightPlan, Terrain, Way};

/// What a browser leaves of A4 between the page's margins and those of a figure.
const WIDE: f64 = 180.0 * A_MILLIMETRE;
/// So high at most, with the legend: title and numbers go on the same page.
const HIGH: f64 = 185.0 * A_MILLIMETRE;
/// Left of the map: its coordinates. They reach beyond its other sides by half their length.
const LEFT: f64 = LABEL + 10.0;
const TOP: f64 = 22.0;
const RIGHT: f64 = 18.0;
/// Below the map: its coordinates, the legend.
const COORDINATES: f64 = LABEL + 20.0;
const ROW: f64 = 18.0;
const COLUMN: f64 = 218.0;
/// North, and below it the bar.
const NORTH: f64 = 104.0;
/// The longest bar.
const BAR: f64 = 170.0;
/// What is left free around everything, in its larger side.
const ROOM: f64 = 0.03;
/// The most pixels of the ground.
const MOST: u32 = 1_000_000;

/// Photos that share more than this, in the mean, lie in layers.
const LAYERS: f64 = 0.5;

/// Paler than the relief of a map: the lines over it are what the pilot looks at.
const DARKEST: f64 = 140.0;
const LIGHT: f64 = 110.0;

/// From the middle of a photo's mark to a name.
const MARK: f64 = 5.0;
/// Fonts of viewers are wider than ours by no more.
const WIDER: f64 = 1.06;
/// The map as a document of SVG.
///
/// # Errors
/// Where the plan has no size, or the ground cannot be encoded.
pub(super) fn map(sheet: &FlightSheet<'_>) -> Result<String, Fault> {
    let photos = photos(sheet.report.plan);
    let extent = extent(sheet, &photos);
    let whole = extent[1] - extent[0];
    let legend = legend(sheet);
    let below = COORDINATES + NORTH.max(legend.len().div_ceil(2) as f64 * ROW);
    let room = [WIDE - LEFT - RIGHT, HIGH - TOP - below];
    let fit = (room[0] / whole.x).min(room[1] / whole.y);
    let round = furniture::round_scale(fit, sheet.report.world);
    let (scale, denominator) = round.ok_or_else(|| {
        let what = "the plan has no size that could be drawn";
        Fault::new(what, "report it: this is a defect")
    })?;
    let high = (whole.y * scale).clamp(room[1].min(120.0), room[1]);
    let middle = (extent[0] + extent[1]) / 2.0;
    let frame = MapFrame::around(middle, [LEFT, TOP], [room[0], high], scale);
    let (raster, ground) = ground(&sheet.report.plan.terrain, &frame);
    let plan = Plan {
        flight: sheet.report.flight.to_owned(),
        crs: sheet.crs.map(str::to_owned),
        taken: None,
        unit: sheet.report.world,
        unit_known: true,
        extent,
        raster,
        ground: Arc::new(ground),
        ground_kind: PlanGround::Relief,
        warnings: Vec::new(),
        light: Light::default(),
        photos,
        measured: Vec::new(),
    };
    let size = [WIDE, TOP + high + below];
    let mut pen = Pen::default();
    on_the_ground(sheet, &plan, &frame, &mut pen);
    let foot = TOP + high + COORDINATES;
    for (index, row) in legend.iter().enumerate() {
        let (column, line) = (index % 2, index / 2);
        let at = [
            LEFT + column as f64 * COLUMN,
            foot + (line as f64 + 0.5) * ROW,
        ];
        row.draw(at, &mut pen);
    }
    let at = [LEFT + 2.0 * COLUMN + 10.0, foot];
    let inks = &PlanInks::PAPER;
    furniture::north(&plan, at, inks, &mut pen);
    if let Some(bar) = plan.bar(scale, BAR, sheet.report.world) {
        furniture::scale_bar(&bar, [at[0], at[1] + 68.0], inks, &mut pen);
    }
    let words = format!("1 : {denominator}, printed at 100 %");
    let place = [at[0], at[1] + 96.0];
    pen.text(place, LABEL, &words, Anchor::Left, inks.ink);
    let title = format!("Map of the plan over {}", sheet.report.flight);
    svg::document(&pen.shapes, size.map(hundredth), &title)
}

fn hundredth(length: f64) -> f64 {
    (length * 100.0).round() / 100.0
}

/// Everything within the frame, and its edge.
fn on_the_ground(sheet: &FlightSheet<'_>, plan: &Plan, frame: &MapFrame, pen: &mut Pen) {
    let inks = &PlanInks::PAPER;
    let ([left, top], [width, height]) = (frame.at, frame.size);
    let bounds = [[left, top], [left + width, top + height]];
    pen.shapes.push(crate::plan::ground_shape(plan, frame));
    let grid = Grid::of(frame);
    furniture::grid_lines(frame, &grid, inks, pen);
    footprints(plan, frame, style(sheet), inks, pen);
    let place = |corner: &DVec2| frame.place(*corner);
    let plan_of_photos = sheet.report.plan;
    for keep_out in &plan_of_photos.wish.keep_out {
        let corners: Vec<[f64; 2]> = keep_out.corners().iter().map(place).collect();
        keep_out_area(&clip::area(&corners, bounds), pen);
    }
    let corners = plan_of_photos.area.corners();
    let around: Vec<[f64; 2]> = corners.iter().chain(corners.first()).map(place).collect();
    for part in clip::line(&around, bounds) {
        area_line(&part, pen);
    }
    for (number, way) in sheet.report.ways.iter().enumerate() {
        let places: Vec<[f64; 2]> = level(way).iter().map(place).collect();
        way_line(&places, DASHES[number % DASHES.len()], pen);
    }
    let mut room = RoomForNames::all_of(frame);
    let take_off = take_off(sheet).map(|place| frame.place(place));
    let words = "take-off";
    let beside = take_off.map(|at| beside(at, png::text_width(NAME, words) * WIDER, plan, frame));
    room.covered.extend(beside);
    marks_and_names(plan, frame, &room, inks, pen);
    if let (Some(at), Some([[x0, y0], [x1, y1]])) = (take_off, beside) {
        pen.marker(at, Marker::Diamond, TAKE_OFF, WAY);
        pen.area(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]], inks.paper, 0.72);
        pen.text(
            [x0 + 2.0, (y0 + y1) / 2.0],
            NAME,
            words,
            Anchor::Left,
            inks.ink,
        );
    }
    furniture::border(frame, &grid, inks, pen);
}

/// Where the words of the take-off stand, of this length: right of its mark, left, above or below, off the marks of
/// photos and inside the frame where one of these is; else right.
fn beside([x, y]: [f64; 2], long: f64, plan: &Plan, frame: &MapFrame) -> clip::Box2 {
    let (off, half) = (TAKE_OFF + 4.0, NAME / 2.0);
    let around = |left: f64, y: f64| [[left - 2.0, y - half], [left + long + 2.0, y + half]];
    let places = [
        around(x + off, y),
        around(x - off - long, y),
        around(x - long / 2.0, y - off - half),
        around(x - long / 2.0, y + off + half),
    ];
    let marks = plan
        .photos
        .iter()
        .flat_map(|photo| photo.middle.into_iter().chain([photo.camera]));
    let marks: Vec<[f64; 2]> = marks.map(|mark| frame.place(mark)).collect();
    let is_in = |[x, y]: &[f64; 2], [low, high]: &clip::Box2, room: f64| {
        let [left, right] = [low[0] - room, high[0] + room];
        let [top, bottom] = [low[1] - room, high[1] + room];
        (left..=right).contains(x) && (top..=bottom).contains(y)
    };
    let ([left, top], [width, height]) = (frame.at, frame.size);
    let all = [[left, top], [left + width, top + height]];
    let free = places.iter().find(|place| {
        let inside = place.iter().all(|corner| is_in(corner, &all, 0.0));
        inside && !marks.iter().any(|mark| is_in(mark, place, MARK))
    });
    free.copied().unwrap_or(places[0])
}

/// Footprints that lie over each other in layers are lines alone: ground and way are seen through them.
fn style(sheet: &FlightSheet<'_>) -> FootprintStyle {
    let plan = sheet.report.plan;
    let main = plan.wish.pattern.main();
    let shared = plan.photos.iter().zip(&plan.cover.shared);
    let shared: Vec<f64> = shared
        .filter(|(photo, _)| photo.purpose == main)
        .map(|(_, shared)| *shared)
        .collect();
    let mean = shared.iter().sum::<f64>() / shared.len().max(1) as f64;
    match mean > LAYERS {
        true => FootprintStyle {
            outline: 0.6,
            shade: 0.0,
        },
        false => FootprintStyle::default(),
    }
}

/// Where the ways begin and end.
fn take_off(sheet: &FlightSheet<'_>) -> Option<DVec2> {
    Some(sheet.report.ways.first()?.take_off.truncate())
}

/// The places of a way as they are seen from above, from take-off to take-off; climbs are none.
fn level(way: &Way) -> Vec<DVec2> {
    let take_off = way.take_off.truncate();
    let points = way.points.iter().map(|point| point.place.truncate());
    let mut places: Vec<DVec2> = [take_off].into_iter().chain(points).collect();
    places.push(take_off);
    places.dedup();
    places
}

/// The photos with what they show on the surface, and the refused ones as places without footprint or camera.
fn photos(plan: &FlightPlan) -> Vec<PlanPhoto> {
    let planned = plan.photos.iter().enumerate().map(|(number, photo)| {
        let verdict = match plan.troubles(number).is_empty() {
            true => Verdict::Trust,
            false => Verdict::Check,
        };
        // Those of a survey lie over each other many times: beside photos for scales they are cameras alone.
        let is_main = photo.purpose == plan.wish.pattern.main();
        let outline = photo.outline.iter().filter(|_| is_main);
        let outline = outline.map(|point| point.truncate());
        PlanPhoto {
            name: photo.name.clone(),
            verdict: Some(verdict),
            outline: outline.collect(),
            middle: is_main.then(|| photo.target.truncate()),
            camera: photo.pose.center.truncate(),
        }
    });
    let refused = plan.refused.iter().zip(1..);
    let refused = refused.map(|(refused, number)| PlanPhoto {
        name: super::words::refused_name(number),
        verdict: Some(Verdict::NoScale),
        outline: Vec::new(),
        middle: Some(refused.place),
        // Nowhere.
        camera: DVec2::NAN,
    });
    planned.chain(refused).collect()
}

/// Least and greatest coordinates of what the map holds, with room around. What a photo shows far beside the area
/// does not make the map small.
fn extent(sheet: &FlightSheet<'_>, photos: &[PlanPhoto]) -> [DVec2; 2] {
    let plan = sheet.report.plan;
    let cameras = photos.iter().map(|photo| photo.camera);
    let refused = plan.refused.iter().map(|refused| refused.place);
    let keep_out = plan.wish.keep_out.iter().flat_map(|area| area.corners());
    let places: Vec<DVec2> = (plan.area.corners().iter().chain(keep_out).copied())
        .chain(cameras)
        .chain(refused)
        .chain(take_off(sheet))
        .filter(|place| place.is_finite())
        .collect();
    let [min, max] = crate::geometry::extent(&places);
    let far = plan.footprint.max_element();
    let shown = photos
        .iter()
        .flat_map(|photo| photo.outline.iter().copied());
    let shown = shown.filter(|point| point.cmpge(min - far).all() && point.cmple(max + far).all());
    let all: Vec<DVec2> = [min, max].into_iter().chain(shown).collect();
    let [min, max] = crate::geometry::extent(&all);
    let room = (max - min).max_element() * ROOM;
    [min - room, max + room]
}

/// The relief of what lies within a frame, and where its pixels lie.
fn ground(terrain: &Terrain, frame: &MapFrame) -> (MapRaster, RgbaImage) {
    let raster = terrain.raster();
    let shades = hillshade(raster, terrain.heights(), Light::default());
    let [min, max] = frame.bounds();
    let first = raster.pixel_from_world(DVec2::new(min.x, max.y)).ceil();
    let last = raster.pixel_from_world(DVec2::new(max.x, min.y)).floor();
    // `as` saturates; whole pixels inside both.
    let from = [first.x.max(0.0) as u32, first.y.max(0.0) as u32];
    let to = [
        (last.x as u32).min(raster.columns),
        (last.y as u32).min(raster.rows),
    ];
    let [columns, rows] = [0, 1].map(|axis| to[axis].saturating_sub(from[axis]));
    let step = (f64::from(columns) * f64::from(rows) / f64::from(MOST))
        .sqrt()
        .ceil()
        .max(1.0) as u32;
    let part = MapRaster {
        corner: raster.world_from_pixel(DVec2::new(f64::from(from[0]), f64::from(from[1]))),
        pixel: raster.pixel * f64::from(step),
        columns: (columns / step).max(1),
        rows: (rows / step).max(1),
    };
    let picture = RgbaImage::from_fn(part.columns, part.rows, |column, row| {
        let (column, row) = (from[0] + column * step, from[1] + row * step);
        let place = row as usize * raster.columns as usize + column as usize;
        match shades.get(place) {
            Some(shade) if !shade.is_nan() => {
                // At most 250.
                let grey = (DARKEST + LIGHT * shade).round() as u8;
                Rgba([grey, grey, grey, 255])
            }
            _ => Rgba([255, 255, 255, 0]),
        }
    });
    (part, picture)
}
