//! Where the mouse points on the surface: an f64 ray against the triangles, on a thread of its own.
//!
//! The first ray over a part of a large cloud has to triangulate that part; the window must not wait
//! for it. So rays go to a thread that keeps its caster, and answers come back a frame later. Of
//! waiting rays for the same purpose only the newest is cast.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::fault::Fault;
use crate::flight::Flight;
use crate::geometry::{LevelBox, Ray};
use crate::linked::LinkedPoint;
use crate::surface::{Caster, Hit, Surface};

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
    /// A point of what is drawn on the surface.
    Draw,
    /// The double click that ends what is drawn on the surface, behind the points before it.
    EndDrawing,
    /// A point for the list.
    Pick,
    /// A click on the page of the flight plan.
    Plan,
    /// The double click that ends an area there, behind its corners.
    EndArea,
}

/// A ray and what it met.
#[derive(Debug, Clone, PartialEq)]
pub struct Picked {
    /// What it was cast for.
    pub purpose: Purpose,
    /// The ray, in the world.
    pub ray: Ray,
    /// The nearest place on the surface.
    pub hit: Option<Hit>,
    /// What else is known of that place, where the mouse hovers.
    pub linked: Option<LinkedPoint>,
    /// How many rays this answers: itself, and older ones that nobody needs any more.
    answered: usize,
}

/// A ray to cast, in this flight, and the box that it meets the surface in.
type Asked = (Purpose, Ray, Option<LevelBox>, Arc<Flight>);

/// Casts rays for the window.
#[derive(Debug)]
pub struct Picker {
    ask: Sender<Asked>,
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
        let (ask, asked) = channel::<Asked>();
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
                    for (place, (purpose, ray, clip, flight)) in batch.iter().enumerate() {
                        let (purpose, ray) = (*purpose, *ray);
                        answered += 1;
                        let newer = batch[place + 1..].iter().any(|(p, ..)| *p == purpose);
                        if purpose == Purpose::Hover && newer {
                            continue;
                        }
                        let hit = cast(&mut caster, &ray, clip.as_ref());
                        let hovered = hit.filter(|_| purpose == Purpose::Hover);
                        let linked = hovered
                            .map(|hit| LinkedPoint::new(hit.point, flight, &surface, &mut caster));
                        let picked = Picked {
                            purpose,
                            ray,
                            hit,
                            linked,
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

    /// Asks what a ray meets, in the clipping box where there is one.
    pub fn ask(
        &mut self,
        purpose: Purpose,
        ray: Ray,
        clip: Option<LevelBox>,
        flight: &Arc<Flight>,
    ) {
        // The thread is gone only where the surface has no caster.
        if self.ask.send((purpose, ray, clip, flight.clone())).is_ok() {
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

/// What a ray meets first in the clipping box.
fn cast(caster: &mut Caster<'_>, ray: &Ray, clip: Option<&LevelBox>) -> Option<Hit> {
    let Some(clip) = clip else {
        return caster.cast(ray);
    };
    let [from, to] = clip.inside(ray)?;
    let inside = Ray {
        origin: ray.at(from),
        ..*ray
    };
    let hit = caster.cast(&inside)?;
    let t = from + hit.t;
    (t <= to).then_some(Hit { t, ..hit })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Distortion, Pose};
    use crate::flight::{FlightParts, Photo};
    use crate::scale::{Ground, ImageKind, PoseErrors, ScalePair, StatedErrors};
    use crate::surface::Cloud;
    use crate::units::LengthUnit;
    use glam::{DVec2, DVec3};

    /// Two level squares, at z = 2 and 0: from above the upper is met; where the box ends under it, the
    /// lower; where the box has neither, nothing.
    #[test]
    fn what_is_clipped_is_not_met() {
        let square = |z: f64| {
            [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec3::new(x, y, z))
        };
        let surface = Surface::new(Cloud {
            points: [square(2.0), square(0.0)].concat(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            ..Cloud::default()
        });
        let surface = surface.unwrap();
        let mut caster = surface.caster().unwrap();
        let ray = Ray {
            origin: DVec3::new(1.5, 2.5, 10.0),
            direction: DVec3::NEG_Z,
        };
        let mut met = |low: f64, high: f64| {
            let clip = LevelBox {
                pivot: DVec2::ZERO,
                turn: 0.0,
                low: DVec3::new(0.0, 0.0, low),
                high: DVec3::new(4.0, 4.0, high),
            };
            let hit = cast(&mut caster, &ray, Some(&clip))?;
            assert!((hit.t - (10.0 - hit.point.z)).abs() < 1e-12);
            Some(hit.point.z)
        };
        assert_eq!(met(-1.0, 3.0), Some(2.0));
        assert_eq!(met(-1.0, 1.0), Some(0.0));
        assert_eq!(met(0.5, 1.0), None);
        assert_eq!(cast(&mut caster, &ray, None).unwrap().point.z, 2.0);
    }

    /// A level square at z = 2 under a camera 10 above its middle, 1000 px a unit at 1: the answers are
    /// known.
    #[test]
    fn a_ray_is_answered() {
        let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let surface = Surface::new(Cloud {
            points: points.map(|(x, y)| DVec3::new(x, y, 2.0)).to_vec(),
            ..Cloud::default()
        })
        .unwrap();
        let surface = Arc::new(surface);
        let camera = Camera {
            name: String::new(),
            width: 200,
            height: 200,
            fx: 1000.0,
            fy: 1000.0,
            cx: 100.0,
            cy: 100.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        // It sees one unit to each side; the second photo another place.
        let photo = |name: &str, x: f64| Photo {
            name: name.to_owned(),
            camera: 0,
            pose: Pose::from_yaw_pitch_roll(DVec3::new(x, 2.0, 12.0), [0.0, -90.0, 0.0]),
            trouble: None,
            errors: PoseErrors::default(),
            package_errors: PoseErrors::default(),
        };
        let flight = Flight::new(FlightParts {
            name: String::new(),
            unit: LengthUnit::Metre,
            unit_known: true,
            ground: Ground::Auto,
            image: ImageKind::Undistorted,
            pair: ScalePair::default(),
            errors: StatedErrors::default(),
            package_errors: StatedErrors::default(),
            surface: surface.clone(),
            cameras: vec![camera],
            as_read: Default::default(),
            photos: vec![photo("a", 2.0), photo("b", 3.5)],
        });
        let flight = Arc::new(flight.unwrap());
        let mut picker = Picker::new(surface, egui::Context::default()).unwrap();
        let ray = Ray {
            origin: DVec3::new(1.5, 2.5, 10.0),
            direction: DVec3::NEG_Z,
        };
        for purpose in [Purpose::Select, Purpose::Hover] {
            picker.ask(purpose, ray, None, &flight);
            assert!(picker.is_waiting());
            let picked = loop {
                if let Some(picked) = picker.answers().pop() {
                    break picked;
                }
                std::thread::yield_now();
            };
            let point = DVec3::new(1.5, 2.5, 2.0);
            assert_eq!(picked.purpose, purpose);
            assert_eq!(picked.hit.unwrap().point, point);
            assert!(!picker.is_waiting());
            let Some(linked) = picked.linked else {
                assert_eq!(purpose, Purpose::Select);
                continue;
            };
            // Half a unit to the left and up, 100 px a unit; ten centimetres around it.
            let [(0, seen)] = linked.seen[..] else {
                panic!("{:?}", linked.seen);
            };
            assert!(seen.pixel.distance(DVec2::new(50.0, 50.0)) < 1e-9);
            assert!((seen.scale - 100.0).abs() < 1e-9);
            assert!((linked.radius - 0.1).abs() < 1e-12 && linked.is_ten_centimetres);
            for end in linked.ring.iter().flatten() {
                assert!((end.distance(point) - 0.1).abs() < 1e-9 && (end.z - 2.0).abs() < 1e-9);
            }
            assert!(linked.ring.len() >= 64);
        }
    }
}
