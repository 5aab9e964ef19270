//! The plan on a page of A4: the map at a round scale with grid and coordinates, title, legend, north, bar.
//!
//! Lengths are CSS pixels, 96 to an inch; x to the right, y down.

use super::furniture::{self, A_MILLIMETRE, LABEL, TEXT, round_scale};
use super::inks::dash;
use super::photos::{
    self, RoomForNames, camera_mark, measured_line, middle_mark, sample, shortened,
};
use super::{Grid, MapFrame, MeasuredOutline, Plan, PlanGround, PlanInks};
use crate::drawing::{Anchor, Pen, Shape};
use crate::flight::Verdict;
use crate::numbers::{counted, significant_digits};
use crate::tiff_pages::PROGRAM;
use crate::units::LengthUnit;

/// A4, the longer and the shorter side.
const LONG: f64 = 297.0 * A_MILLIMETRE;
const SHORT: f64 = 210.0 * A_MILLIMETRE;

const MARGIN: f64 = 34.0;
const TITLE: f64 = 21.0;
/// What is beside the map, in landscape; under it, in portrait, as high.
const BLOCK: f64 = 232.0;
const BLOCK_HIGH: f64 = 176.0;
const GAP: f64 = 16.0;
/// Between lines of the block.
const ROW: f64 = 19.0;
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
        let round = plan.unit_known.then(|| round_scale(fit, plan.unit));
        let (scale, denominator) = match round.flatten() {
            Some((scale, denominator)) => (scale, Some(denominator)),
            None => (fit, None),
        };
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
        furniture::grid_lines(&self.frame, &grid, inks, &mut pen);
        let room = RoomForNames::all_of(&self.frame);
        photos::draw(plan, &self.frame, &room, inks, &mut pen);
        furniture::border(&self.frame, &grid, inks, &mut pen);
        self.head(plan, inks, &mut pen);
        self.block(plan, &grid, unit, inks, &mut pen);
        pen.shapes
    }

    fn edges(&self) -> [f64; 4] {
        let ([left, top], [width, height]) = (self.frame.at, self.frame.size);
        [left, top, left + width, top + height]
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
        furniture::north(plan, at, inks, pen);
        if let Some(bar) = plan.bar(self.frame.scale, BAR, unit) {
            furniture::scale_bar(&bar, [at[0], at[1] + 74.0], inks, pen);
        }
        let at = next(0.0);
        for (index, note) in self.notes(plan, grid).iter().enumerate() {
            let place = [at[0], at[1] + (index as f64 + 0.5) * ROW];
            pen.text(place, TEXT, note, Anchor::Left, inks.ink);
        }
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

/// The ground where it lies.
pub(crate) fn ground(plan: &Plan, frame: &MapFrame) -> Shape {
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
                format!("{verdict}: {}", counted(*count, "photo"))
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
