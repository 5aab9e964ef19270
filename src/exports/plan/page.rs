//! The plan on a page of A4: the map at a round scale with grid and coordinates, title, legend, north, bar.
//!
//! Lengths are CSS pixels, 96 to an inch; x to the right, y down.

use glam::DVec2;

use super::inks::dash;
use super::photos::{
    self, RoomForNames, camera_mark, measured_line, middle_mark, sample, shortened,
};
use super::{Grid, MapFrame, MeasuredOutline, Plan, PlanGround, PlanInks};
use crate::drawing::{Anchor, Dash, Pen, Shape};
use crate::flight::Verdict;
use crate::numbers::{round_down, significant_digits};
use crate::tiff_pages::PROGRAM;
use crate::units::LengthUnit;

/// A4, the longer and the shorter side.
const LONG: f64 = 297.0 * A_MILLIMETRE;
const SHORT: f64 = 210.0 * A_MILLIMETRE;
const A_MILLIMETRE: f64 = 96.0 / 25.4;

const MARGIN: f64 = 34.0;
const TITLE: f64 = 21.0;
const TEXT: f64 = 13.5;
const LABEL: f64 = 11.5;
/// What is beside the map, in landscape; under it, in portrait, as high.
const BLOCK: f64 = 232.0;
const BLOCK_HIGH: f64 = 176.0;
const GAP: f64 = 16.0;
/// Between lines of the block.
const ROW: f64 = 19.0;
/// The grid lies under everything else.
const GRID_WIDTH: f64 = 0.7;
/// The longest bar.
const BAR: f64 = 170.0;

/// A plan laid out on its page.
#[derive(Debug)]
pub(super) struct Page {
    /// Width and height.
    pub(super) size: [f64; 2],
    /// Where the map is.
    pub(super) frame: MapFrame,
    /// 1 : this, where the unit is known.
    pub(super) denominator: Option<f64>,
    is_wide: bool,
}

impl Page {
    /// The way of laying the page that shows the plan larger.
    pub(super) fn new(plan: &Plan) -> Self {
        let (wide, high) = (Self::laid(plan, true), Self::laid(plan, false));
        match high.frame.scale > wide.frame.scale {
            true => high,
            false => wide,
        }
    }

    fn laid(plan: &Plan, is_wide: bool) -> Self {
        let size = match is_wide {
            true => [LONG, SHORT],
            false => [SHORT, LONG],
        };
        let at = [MARGIN + LABEL + 6.0, MARGIN + TITLE + TEXT + 16.0];
        let foot = MARGIN + LABEL + 6.0;
        let room = match is_wide {
            true => [
                size[0] - at[0] - MARGIN - BLOCK - GAP,
                size[1] - at[1] - foot,
            ],
            false => [
                size[0] - at[0] - MARGIN,
                size[1] - at[1] - foot - BLOCK_HIGH - GAP,
            ],
        };
        let [min, max] = plan.extent;
        let whole = max - min;
        let fit = (room[0] / whole.x).min(room[1] / whole.y);
        // Units of the drawing to a unit of the world, 1 : 1.
        let life = plan.unit.metres() * 1000.0 * A_MILLIMETRE;
        let denominator = plan.unit_known.then(|| round_above(life / fit)).flatten();
        let scale = denominator.map_or(fit, |denominator| life / denominator);
        Self {
            size,
            frame: MapFrame::around((min + max) / 2.0, at, room, scale),
            denominator,
            is_wide,
        }
    }

    /// Everything on it, from the back to the front; the bar in `unit`.
    pub(super) fn shapes(&self, plan: &Plan, unit: LengthUnit) -> Vec<Shape> {
        let inks = &PlanInks::PAPER;
        let mut pen = Pen::default();
        pen.shapes.push(ground(plan, &self.frame));
        let grid = Grid::of(&self.frame);
        self.grid_lines(&grid, inks, &mut pen);
        let room = RoomForNames::all_of(&self.frame);
        photos::draw(plan, &self.frame, &room, inks, &mut pen);
        self.border(&grid, inks, &mut pen);
        self.head(plan, inks, &mut pen);
        self.block(plan, &grid, unit, inks, &mut pen);
        pen.shapes
    }

    fn edges(&self) -> [f64; 4] {
        let ([left, top], [width, height]) = (self.frame.at, self.frame.size);
        [left, top, left + width, top + height]
    }

    fn grid_lines(&self, grid: &Grid, inks: &PlanInks, pen: &mut Pen) {
        let [left, top, right, bottom] = self.edges();
        for line in &grid.across {
            let [x, _] = self.frame.place(DVec2::new(line.at, 0.0));
            pen.line(&[[x, top], [x, bottom]], inks.grid, GRID_WIDTH, Dash::Solid);
        }
        for line in &grid.up {
            let [_, y] = self.frame.place(DVec2::new(0.0, line.at));
            pen.line(&[[left, y], [right, y]], inks.grid, GRID_WIDTH, Dash::Solid);
        }
    }

    fn border(&self, grid: &Grid, inks: &PlanInks, pen: &mut Pen) {
        let [left, top, right, bottom] = self.edges();
        let middle = (left + right) / 2.0;
        // From the middle of a side: all four corners are joints.
        let around = [
            [middle, top],
            [right, top],
            [right, bottom],
            [left, bottom],
            [left, top],
            [middle, top],
        ];
        pen.line(&around, inks.ink, 1.2, Dash::Solid);
        for line in &grid.across {
            let [x, _] = self.frame.place(DVec2::new(line.at, 0.0));
            pen.line(
                &[[x, bottom], [x, bottom + 5.0]],
                inks.ink,
                1.0,
                Dash::Solid,
            );
            let at = [x, bottom + 7.0 + LABEL / 2.0];
            pen.text(at, LABEL, &line.label, Anchor::Middle, inks.ink);
        }
        for line in &grid.up {
            let [_, y] = self.frame.place(DVec2::new(0.0, line.at));
            pen.line(&[[left - 5.0, y], [left, y]], inks.ink, 1.0, Dash::Solid);
            let at = [left - 7.0 - LABEL / 2.0, y];
            pen.text_upwards(at, LABEL, &line.label, inks.ink);
        }
    }

    fn head(&self, plan: &Plan, inks: &PlanInks, pen: &mut Pen) {
        let [left, ..] = self.edges();
        let title = shortened(&plan.flight);
        pen.text(
            [left, MARGIN + TITLE / 2.0],
            TITLE,
            &title,
            Anchor::Left,
            inks.ink,
        );
        let mut words = format!("Coordinates: {}", plan.crs_in_words());
        words += &format!(", {}", plan.unit_of_lengths());
        if let Some(taken) = &plan.taken {
            words += &format!("; photos taken {taken}");
        }
        let at = [left, MARGIN + TITLE + 4.0 + TEXT / 2.0];
        pen.text(at, TEXT, &words, Anchor::Left, inks.ink);
    }

    /// Legend, north, bar and notes: below each other beside the map, or beside each other below it.
    fn block(&self, plan: &Plan, grid: &Grid, unit: LengthUnit, inks: &PlanInks, pen: &mut Pen) {
        let [left, top, right, bottom] = self.edges();
        let [mut x, mut y] = match self.is_wide {
            true => [right + GAP, top + 4.0],
            false => [left, bottom + LABEL + GAP + 8.0],
        };
        let is_wide = self.is_wide;
        let mut next = |height: f64| {
            let at = [x, y];
            match is_wide {
                true => y += height + GAP,
                false => x += BLOCK,
            }
            at
        };
        let rows = legend_rows(plan);
        legend(&rows, next(rows.len() as f64 * ROW), inks, pen);
        let at = next(110.0);
        north(plan, at, inks, pen);
        self.bar(plan, [at[0], at[1] + 74.0], unit, inks, pen);
        let at = next(0.0);
        for (index, note) in self.notes(plan, grid).iter().enumerate() {
            let place = [at[0], at[1] + (index as f64 + 0.5) * ROW];
            pen.text(place, TEXT, note, Anchor::Left, inks.ink);
        }
    }

    fn bar(&self, plan: &Plan, at: [f64; 2], unit: LengthUnit, inks: &PlanInks, pen: &mut Pen) {
        let Some(bar) = plan.bar(self.frame.scale, BAR, unit) else {
            return;
        };
        let long = bar.long;
        let [x, y] = at;
        // Four parts, every other one filled.
        for part in 0..4_u32 {
            let (from, to) = (f64::from(part) / 4.0, f64::from(part + 1) / 4.0);
            let (from, to) = (x + from * long, x + to * long);
            let outline = [[from, y], [to, y], [to, y + 6.0], [from, y + 6.0]];
            let colour = if part % 2 == 0 { inks.ink } else { inks.paper };
            pen.area(&outline, colour, 1.0);
        }
        let around = [
            [x, y],
            [x + long, y],
            [x + long, y + 6.0],
            [x, y + 6.0],
            [x, y],
        ];
        pen.line(&around, inks.ink, 1.0, Dash::Solid);
        pen.text(
            [x, y + 8.0 + TEXT / 2.0],
            TEXT,
            &bar.words(),
            Anchor::Left,
            inks.ink,
        );
    }

    fn notes(&self, plan: &Plan, grid: &Grid) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(denominator) = self.denominator {
            notes.push(format!("1 : {denominator} on A4"));
        }
        let lengths = plan.unit_of_lengths();
        notes.push(format!("Grid every {} {lengths}", grid.step));
        let light = plan.light;
        let ground = match plan.ground_kind {
            PlanGround::Relief => Some(format!(
                "Hillshade: light from {}°, {}° high,",
                light.azimuth, light.altitude
            )),
            PlanGround::Photos => Some("Ground: the photos over the surface,".to_owned()),
            PlanGround::Colours => Some("Ground: the colours of the points,".to_owned()),
            PlanGround::Plain => None,
        };
        if let Some(ground) = ground {
            notes.push(ground);
            let pixel = significant_digits(plan.raster.pixel, 1);
            notes.push(format!("pixels of {pixel} {lengths}"));
        }
        notes.push(PROGRAM.to_owned());
        notes
    }
}

/// 1, 1.25, 1.5, 2, 2.5, 3, 4, 5 or 7.5 times a power of ten, the least that is no less.
fn round_above(number: f64) -> Option<f64> {
    let below = round_down(number)?;
    let power = 10_f64.powf(below.log10().floor());
    let all = [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5, 10.0];
    let all = all.map(|digits| digits * power);
    let found = all
        .into_iter()
        .find(|round| *round >= number * (1.0 - 1e-12))?;
    // What its text says is rounded once.
    format!("{found:.6e}").parse().ok()
}

/// The ground where it lies.
pub(super) fn ground(plan: &Plan, frame: &MapFrame) -> Shape {
    let raster = &plan.raster;
    let size =
        [raster.columns, raster.rows].map(|side| f64::from(side) * raster.pixel * frame.scale);
    Shape::Picture {
        at: frame.place(raster.corner),
        size,
        pixels: plan.ground.clone(),
    }
}

/// A line of the legend.
enum Row {
    Footprint(Option<Verdict>, usize),
    Camera,
    Middle,
    Measured(bool),
}

fn legend_rows(plan: &Plan) -> Vec<Row> {
    let count = |verdict: Option<Verdict>| {
        let photos = plan.photos.iter();
        photos.filter(|photo| photo.verdict == verdict).count()
    };
    let verdicts = Verdict::ALL.into_iter().map(Some).chain([None]);
    let verdicts = verdicts.map(|verdict| Row::Footprint(verdict, count(verdict)));
    let there = verdicts.filter(|row| !matches!(row, Row::Footprint(_, 0)));
    let measured = [false, true].into_iter().filter(|is_polygon| {
        let of_kind = |outline: &MeasuredOutline| outline.is_polygon == *is_polygon;
        plan.measured.iter().any(of_kind)
    });
    let marks = [Row::Camera, Row::Middle].into_iter();
    there
        .chain(marks)
        .chain(measured.map(Row::Measured))
        .collect()
}

fn legend(rows: &[Row], [left, top]: [f64; 2], inks: &PlanInks, pen: &mut Pen) {
    for (index, row) in rows.iter().enumerate() {
        let y = top + (index as f64 + 0.5) * ROW;
        let words = match row {
            Row::Footprint(verdict, count) => {
                let (from, to) = ([left, y - 5.5], [left + 26.0, y + 5.5]);
                sample(from, to, inks.of(*verdict), dash(*verdict), pen);
                let verdict = verdict.map_or("not settled", Verdict::as_str);
                let photos = if *count == 1 { "photo" } else { "photos" };
                format!("{verdict}: {count} {photos}")
            }
            Row::Camera => {
                camera_mark([left + 13.0, y], inks, pen);
                "camera".to_owned()
            }
            Row::Middle => {
                middle_mark([left + 13.0, y], inks.ink, pen);
                "middle of a photo".to_owned()
            }
            Row::Measured(is_polygon) => {
                let ends = [[left, y + 3.0], [left + 26.0, y - 3.0]];
                measured_line(&ends, inks, pen);
                match is_polygon {
                    true => "measured polygon".to_owned(),
                    false => "measured line".to_owned(),
                }
            }
        };
        pen.text([left + 34.0, y], TEXT, &words, Anchor::Left, inks.ink);
    }
}

/// An arrow to the grid's north; in a frame of its own, along y.
fn north(plan: &Plan, [left, top]: [f64; 2], inks: &PlanInks, pen: &mut Pen) {
    let (letter, words) = match plan.is_on_map() {
        true => ("N", "grid north"),
        false => ("y", "y of the flight's frame"),
    };
    let x = left + 13.0;
    pen.text([x, top + 8.0], TEXT + 3.0, letter, Anchor::Middle, inks.ink);
    let (tip, foot) = (top + 19.0, top + 58.0);
    pen.area(&[[x, tip], [x + 8.0, foot], [x, foot - 8.0]], inks.ink, 1.0);
    let around = [
        [x, tip],
        [x + 8.0, foot],
        [x, foot - 8.0],
        [x - 8.0, foot],
        [x, tip],
    ];
    pen.line(&around, inks.ink, 1.0, Dash::Solid);
    pen.text(
        [left + 34.0, foot - 14.0],
        TEXT,
        words,
        Anchor::Left,
        inks.ink,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round_and_show_everything() {
        for (number, round) in [
            (183.0, 200.0),
            (200.0, 200.0),
            (201.0, 250.0),
            (251.0, 300.0),
            (700.0, 750.0),
            (1.2, 1.25),
            (0.09, 0.1),
            (9999.0, 10_000.0),
        ] {
            assert_eq!(round_above(number), Some(round), "{number}");
        }
        assert_eq!(round_above(f64::NAN), None);
    }
}
