//! Measures what is drawn on the surface, on a thread of its own: the window must not wait for the
//! triangles of a large polygon. Of waiting requests only the newest is measured.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use glam::DVec2;

use super::{BaseChoice, SurveyTool};
use crate::fault::Fault;
use crate::surface::Surface;
use crate::survey::{Base, Polygon, Profile, SurveyError, Volume, volume};

/// What to measure.
#[derive(Debug, Clone)]
pub struct Request {
    /// A line or a polygon.
    pub tool: SurveyTool,
    /// Its places, in the world.
    pub places: Vec<DVec2>,
    /// What the volume is over.
    pub base: BaseChoice,
    /// The second surface that it may be over.
    pub second: Option<Arc<Surface>>,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq)]
pub enum Measured {
    /// Over a line.
    Profile(Profile),
    /// Inside a polygon.
    Volume(Volume),
}

/// A request with its answer, and how many requests that answers.
struct Answer {
    request: Request,
    measured: Result<Measured, String>,
    answered: usize,
}

/// Measures for the window.
#[derive(Debug)]
pub struct Surveyor {
    ask: Sender<Request>,
    answers: Receiver<Answer>,
    waiting: usize,
}

impl Surveyor {
    /// Begins on this surface. The thread ends when the surveyor is dropped.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub fn new(surface: Arc<Surface>, context: egui::Context) -> Result<Self, Fault> {
        let (ask, asked) = channel::<Request>();
        let (answer, answers) = channel();
        std::thread::Builder::new()
            .name("surveyor".to_owned())
            .spawn(move || {
                while let Ok(first) = asked.recv() {
                    let mut request = first;
                    let mut answered = 1;
                    for newer in asked.try_iter() {
                        request = newer;
                        answered += 1;
                    }
                    let measured = measure(&surface, &request).map_err(|error| error.to_string());
                    let answered = Answer {
                        request,
                        measured,
                        answered,
                    };
                    if answer.send(answered).is_err() {
                        return;
                    }
                    context.request_repaint();
                }
            })
            .map_err(|e| Fault::new(format!("no thread for measuring: {e}"), "close programs"))?;
        Ok(Self {
            ask,
            answers,
            waiting: 0,
        })
    }

    /// Asks for something.
    pub fn ask(&mut self, request: Request) {
        if self.ask.send(request).is_ok() {
            self.waiting += 1;
        }
    }

    /// The answers that have come.
    pub fn answers(&mut self) -> Vec<(Request, Result<Measured, String>)> {
        let answers: Vec<Answer> = self.answers.try_iter().collect();
        let answered = answers.iter().map(|answer| answer.answered).sum();
        self.waiting = self.waiting.saturating_sub(answered);
        let pair = |answer: Answer| (answer.request, answer.measured);
        answers.into_iter().map(pair).collect()
    }

    /// Whether an answer is still to come.
    pub fn is_waiting(&self) -> bool {
        self.waiting > 0
    }
}

fn measure(surface: &Surface, request: &Request) -> Result<Measured, SurveyError> {
    match request.tool {
        SurveyTool::Profile => Profile::along(surface, &request.places).map(Measured::Profile),
        SurveyTool::Volume => {
            let polygon = Polygon::new(&request.places)?;
            let base = match (request.base, &request.second) {
                (BaseChoice::Height(height), _) => Base::Height(height),
                (BaseChoice::Second, Some(second)) => Base::Surface(second),
                (BaseChoice::Rim | BaseChoice::Second, _) => Base::Rim,
            };
            volume(surface, &polygon, base).map(Measured::Volume)
        }
    }
}
