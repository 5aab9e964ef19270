//! Where the mouse points on the surface: an f64 ray against the triangles, on a thread of its own.
//!
//! The first ray over a part of a large cloud has to triangulate that part; the window must not wait
//! for it. So rays go to a thread that keeps its caster, and answers come back a frame later. Of
//! waiting rays for the same purpose only the newest is cast.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::fault::Fault;
use crate::geometry::Ray;
use crate::surface::{Hit, Surface};

/// What a ray is cast for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// The coordinates under the mouse.
    Hover,
    /// A click that selects a photo.
    Select,
    /// A double click that moves the centre of the view.
    Center,
    /// A point of the distance tool.
    Measure,
}

/// A ray and what it met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Picked {
    /// What it was cast for.
    pub purpose: Purpose,
    /// The ray, in the world.
    pub ray: Ray,
    /// The nearest place on the surface.
    pub hit: Option<Hit>,
    /// How many rays this answers: itself, and older ones that nobody needs any more.
    answered: usize,
}

/// Casts rays for the window.
#[derive(Debug)]
pub struct Picker {
    ask: Sender<(Purpose, Ray)>,
    answers: Receiver<Picked>,
    /// How many rays were asked and not answered.
    waiting: usize,
}

impl Picker {
    /// Begins on this surface. The thread ends when the picker is dropped.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub fn new(surface: Arc<Surface>, context: egui::Context) -> Result<Self, Fault> {
        let (ask, asked) = channel::<(Purpose, Ray)>();
        let (answer, answers) = channel();
        std::thread::Builder::new()
            .name("picker".to_owned())
            .spawn(move || {
                // A surface that gives no caster meets no ray; opening the flight has said so.
                let Ok(mut caster) = surface.caster() else {
                    return;
                };
                while let Ok(first) = asked.recv() {
                    let mut batch = vec![first];
                    batch.extend(asked.try_iter());
                    let mut answered = 0;
                    for (place, &(purpose, ray)) in batch.iter().enumerate() {
                        answered += 1;
                        let newer = batch[place + 1..].iter().any(|(p, _)| *p == purpose);
                        if purpose == Purpose::Hover && newer {
                            continue;
                        }
                        let picked = Picked {
                            purpose,
                            ray,
                            hit: caster.cast(&ray),
                            answered: std::mem::take(&mut answered),
                        };
                        if answer.send(picked).is_err() {
                            return;
                        }
                    }
                    context.request_repaint();
                }
            })
            .map_err(|e| Fault::new(format!("no thread for the mouse: {e}"), "close programs"))?;
        Ok(Self {
            ask,
            answers,
            waiting: 0,
        })
    }

    /// Asks what a ray meets.
    pub fn ask(&mut self, purpose: Purpose, ray: Ray) {
        // The thread is gone only where the surface has no caster.
        if self.ask.send((purpose, ray)).is_ok() {
            self.waiting += 1;
        }
    }

    /// The answers that have come.
    pub fn answers(&mut self) -> Vec<Picked> {
        let answers: Vec<Picked> = self.answers.try_iter().collect();
        let answered = answers.iter().map(|picked| picked.answered).sum();
        self.waiting = self.waiting.saturating_sub(answered);
        answers
    }

    /// Whether an answer is still to come.
    pub fn is_waiting(&self) -> bool {
        self.waiting > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Cloud;
    use glam::DVec3;

    /// A level square at z = 2: the answer is known.
    #[test]
    fn a_ray_is_answered() {
        let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let surface = Surface::new(Cloud {
            points: points.map(|(x, y)| DVec3::new(x, y, 2.0)).to_vec(),
            ..Cloud::default()
        })
        .unwrap();
        let mut picker = Picker::new(Arc::new(surface), egui::Context::default()).unwrap();
        let ray = Ray {
            origin: DVec3::new(1.0, 3.0, 10.0),
            direction: DVec3::NEG_Z,
        };
        picker.ask(Purpose::Select, ray);
        assert!(picker.is_waiting());
        let picked = loop {
            if let Some(picked) = picker.answers().pop() {
                break picked;
            }
            std::thread::yield_now();
        };
        assert_eq!(picked.purpose, Purpose::Select);
        assert_eq!(picked.hit.unwrap().point, DVec3::new(1.0, 3.0, 2.0));
        assert!(!picker.is_waiting());
    }
}
