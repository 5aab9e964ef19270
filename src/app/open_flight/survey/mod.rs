//! The tools that draw a line or a polygon on the surface and say what is measured there.

pub mod clip;
pub mod picked;
pub mod surveyor;
mod tables;

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::OpenFlight;
use crate::exports::MeasuredUnit;
use crate::surface::Surface;
use crate::survey::{Profile, Volume};
use surveyor::{Measured, Request};

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurveyTool {
    /// A line with the profile over it.
    Profile,
    /// A polygon with the area and volume inside.
    Volume,
}

/// What a volume is over.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum BaseChoice {
    /// The plane through the polygon's rim.
    #[default]
    Rim,
    /// An elevation, world units.
    Height(f64),
    /// The second surface that was read for it.
    Second,
}

/// A second surface that volumes can be over, in the flight's world.
#[derive(Debug, Clone)]
pub struct SecondBase {
    /// Its file.
    pub path: PathBuf,
    /// Its triangles.
    pub surface: Arc<Surface>,
    /// What its heights count from and the flight's, where it is not the same.
    pub other_heights: Option<[String; 2]>,
}

/// Something to do with them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurveyStep {
    /// Takes this tool, or puts it away.
    Toggle(SurveyTool),
    /// Takes the last point back.
    RemoveLast,
    /// Takes all points of what is being drawn back; the tool stays.
    RemoveAll,
    /// Ends the line, closes the polygon; the next click begins anew.
    Finish,
    /// What the volume is over.
    Base(BaseChoice),
    /// Puts the tool away.
    Leave,
}

/// A line or polygon that is drawn on the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Which of them.
    pub tool: SurveyTool,
    /// Its points on the surface, in the world.
    pub points: Vec<DVec3>,
    /// Whether no more points are added: the next click begins anew.
    pub finished: bool,
    /// What the volume is over.
    pub base: BaseChoice,
    /// What was measured last, while drawing that of a moment ago; an error says why nothing.
    pub measured: Option<Result<Measured, String>>,
    /// What was asked last.
    asked: Option<(Vec<DVec2>, BaseChoice)>,
    /// The finished one that this was begun over: it is back when this one's last point is taken back.
    before: Option<Box<Self>>,
}

impl Drawn {
    fn new(tool: SurveyTool, base: BaseChoice) -> Self {
        Self {
            tool,
            points: Vec::new(),
            finished: false,
            base,
            measured: None,
            asked: None,
            before: None,
        }
    }

    /// Whether its last point can be taken back as a change of one's mind: it is being drawn.
    pub fn is_in_hand(&self) -> bool {
        !self.finished && !self.points.is_empty()
    }

    /// To the finished one that it was begun over, where nothing is left of it.
    fn go_back(&mut self) {
        if self.points.is_empty()
            && let Some(before) = self.before.take()
        {
            *self = *before;
            self.asked = None;
        }
    }

    /// Its points, the mouse the last of them while it is drawn.
    pub fn outline(&self, hover: Option<DVec3>) -> Vec<DVec3> {
        let mut points = self.points.clone();
        if !self.finished && !points.is_empty() {
            points.extend(hover);
        }
        points
    }

    /// How many points it needs.
    fn least(&self) -> usize {
        match self.tool {
            SurveyTool::Profile => 2,
            SurveyTool::Volume => 3,
        }
    }

    /// The profile, where it is one.
    pub fn profile(&self) -> Option<&Profile> {
        match &self.measured {
            Some(Ok(Measured::Profile(profile))) => Some(profile),
            _ => None,
        }
    }

    /// What lies inside the polygon, where it is one.
    pub fn volume(&self) -> Option<&Volume> {
        match &self.measured {
            Some(Ok(Measured::Volume(volume))) => Some(volume),
            _ => None,
        }
    }
}

impl OpenFlight {
    /// Of what is measured.
    pub fn measured_unit(&self) -> MeasuredUnit {
        MeasuredUnit::of(self.flight().parts())
    }

    /// Does something with the tools.
    pub(crate) fn survey(&mut self, step: SurveyStep) {
        let drawn = &mut self.pointer.drawn;
        match (step, drawn.as_mut()) {
            (SurveyStep::Toggle(tool), before) => {
                let same = before.as_ref().is_some_and(|drawn| drawn.tool == tool);
                let base = before.map_or_else(BaseChoice::default, |drawn| drawn.base);
                self.put_drawing_away();
                if !same {
                    let of_tool = |drawn: &Drawn| drawn.tool == tool;
                    let place = self.pointer.put_away.iter().position(of_tool);
                    let kept = place.map(|place| self.pointer.put_away.swap_remove(place));
                    self.pointer.drawn = Some(kept.unwrap_or_else(|| Drawn::new(tool, base)));
                }
                self.pointer.measure = super::Measure::Off;
                self.pointer.picked.is_on = false;
            }
            (SurveyStep::Leave, _) => self.put_drawing_away(),
            (SurveyStep::RemoveLast, Some(drawn)) => {
                drawn.points.pop();
                drawn.finished = false;
                drawn.go_back();
            }
            (SurveyStep::RemoveAll, Some(drawn)) if drawn.is_in_hand() => {
                drawn.points.clear();
                drawn.go_back();
            }
            (SurveyStep::Finish, Some(drawn)) => {
                drawn.finished = drawn.points.len() >= drawn.least();
            }
            // What is no number would never be the same as before.
            (SurveyStep::Base(BaseChoice::Height(height)), _) if !height.is_finite() => {}
            (SurveyStep::Base(BaseChoice::Second), _) if self.pointer.second.is_none() => {}
            (SurveyStep::Base(base), Some(drawn)) => drawn.base = base,
            // What is finished goes with its tool.
            (SurveyStep::RemoveAll, Some(_)) | (_, None) => {}
        }
        self.ask_surveyor();
    }

    /// Another tool is taken: what was finished is there again when its own is.
    pub(crate) fn put_drawing_away(&mut self) {
        let Some(mut drawn) = self.pointer.drawn.take().filter(|drawn| drawn.finished) else {
            return;
        };
        // The surface may be another one by then.
        drawn.asked = None;
        // The one of this tool was taken from there.
        self.pointer.put_away.push(drawn);
    }

    /// Adds a point to what is drawn.
    pub(crate) fn draw_at(&mut self, point: DVec3) {
        if let Some(drawn) = &mut self.pointer.drawn {
            if drawn.finished {
                let new = Drawn::new(drawn.tool, drawn.base);
                let before = std::mem::replace(drawn, new);
                drawn.before = Some(Box::new(Drawn {
                    before: None,
                    ..before
                }));
            }
            // A double click ends the drawing where its first click put a point.
            if drawn.points.last() != Some(&point) {
                drawn.points.push(point);
            }
        }
        self.ask_surveyor();
    }

    /// Has measured what is drawn now, where it has changed.
    pub(crate) fn ask_surveyor(&mut self) {
        let hover = self.pointer.hover;
        let Some(drawn) = &mut self.pointer.drawn else {
            return;
        };
        let outline = drawn.outline(hover);
        let mut places: Vec<DVec2> = outline.iter().map(|point| point.truncate()).collect();
        places.dedup();
        if places.len() < drawn.least() {
            (drawn.measured, drawn.asked) = (None, None);
            return;
        }
        let asked = Some((places.clone(), drawn.base));
        if drawn.asked == asked {
            return;
        }
        drawn.asked = asked;
        let request = Request {
            tool: drawn.tool,
            places,
            base: drawn.base,
            second: self
                .pointer
                .second
                .as_ref()
                .map(|base| base.surface.clone()),
        };
        if let Some(surveyor) = &mut self.pointer.surveyor {
            surveyor.ask(request);
        }
    }

    /// Takes a second surface for volumes to be over, and the one that is drawn is.
    pub(crate) fn take_second_base(&mut self, second: SecondBase) {
        self.pointer.second = Some(second);
        if let Some(drawn) = &mut self.pointer.drawn {
            drawn.base = BaseChoice::Second;
        }
        self.survey_anew();
    }

    /// How the second surface is called that the volume is over.
    pub fn base_name(&self, drawn: &Drawn) -> Option<String> {
        let second = self.pointer.second.as_ref()?;
        (drawn.base == BaseChoice::Second).then(|| second.path.display().to_string())
    }

    /// What the heights of the second surface that the volume is over count from, and those of the flight's, where it is not
    /// the same.
    pub fn other_heights(&self, drawn: &Drawn) -> Option<&[String; 2]> {
        let second = self.pointer.second.as_ref()?;
        let is_over = drawn.base == BaseChoice::Second;
        second.other_heights.as_ref().filter(|_| is_over)
    }

    /// Measures again, on another surface.
    pub(crate) fn survey_anew(&mut self) {
        if let Some(drawn) = &mut self.pointer.drawn {
            drawn.asked = None;
        }
        self.ask_surveyor();
    }

    /// Takes what was measured.
    pub(crate) fn take_measured(&mut self, request: &Request, measured: Result<Measured, String>) {
        if let Some(drawn) = &mut self.pointer.drawn
            && drawn.tool == request.tool
            && drawn.asked.is_some()
        {
            drawn.measured = Some(measured);
        }
    }
}
