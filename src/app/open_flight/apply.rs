//! What commands do to the flight on the screen alone.

use glam::{DVec2, DVec3};

use crate::command::{Command, ViewChange};
use crate::flight::ScaleObject;
use crate::geometry::{Bounds, LevelBox, Ray};
use crate::linked::PointFrom;
use crate::open_flight::picker::Purpose;
use crate::open_flight::table::SortBy;
use crate::open_flight::{Measure, OpenFlight};
use crate::render::PhotoZoom;

impl OpenFlight {
    /// What concerns the flight on the screen alone.
    pub(crate) fn apply(&mut self, command: Command) {
        match command {
            Command::Click(ray) => {
                let purpose = if self.pointer.picked.is_on {
                    Purpose::Pick
                } else if self.pointer.drawn.is_some() {
                    Purpose::Draw
                } else if self.pointer.measure == Measure::Off {
                    Purpose::Select
                } else {
                    Purpose::Measure
                };
                self.pick(purpose, ray);
            }
            // What a photo shows is not clipped.
            Command::Hover(from, Some(ray)) if from != PointFrom::Pile => {
                self.points_from(from, ray);
                self.pick_in(Purpose::Hover, ray, None);
            }
            Command::Hover(from, Some(ray)) => {
                self.points_from(from, ray);
                self.pick(Purpose::Hover, ray);
            }
            Command::Hover(_, None) => {
                // What appears under a resting mouse takes it away for a frame: asked again, the two would take turns for ever.
                let asked = self.pointer.asked;
                self.point_at_nothing();
                self.pointer.asked = asked;
                self.ask_surveyor();
            }
            Command::DoubleClick(ray) if self.pointer.drawn.is_some() => {
                self.pick(Purpose::EndDrawing, ray);
            }
            Command::Survey(step) => self.survey(step),
            Command::Pick(step) => self.pick_step(step),
            Command::Clip(step) => self.clip_step(step),
            Command::Beside(step) => self.beside_step(step),
            Command::DoubleClick(ray) => self.pick(Purpose::Center, ray),
            Command::HoverPhoto(photo) => self.table.hovered = photo,
            Command::Sort(column) => {
                // The third click on a column is the flight's order again.
                if self.table.order.by != column {
                    (self.table.order.by, self.table.order.descending) = (column, false);
                } else if !self.table.order.descending {
                    self.table.order.descending = true;
                } else {
                    (self.table.order.by, self.table.order.descending) = (SortBy::Flight, false);
                }
                self.arrange();
            }
            Command::Filter(text) => {
                self.table.order.text = text;
                self.arrange();
            }
            Command::FilterVerdict(verdict) => {
                self.table.order.verdict = verdict;
                self.arrange();
            }
            Command::FilterDoubtful(on) => {
                self.table.order.doubtful = on;
                self.arrange();
            }
            Command::View(change) => self.change_view(change),
            Command::ToggleMeasure => {
                self.put_drawing_away();
                self.pointer.picked.is_on = false;
                self.pointer.measure = if self.pointer.measure == Measure::Off {
                    Measure::First
                } else {
                    Measure::Off
                };
            }
            Command::MeasureAnew if self.pointer.measure != Measure::Off => {
                self.pointer.measure = Measure::First;
            }
            _ => {}
        }
    }

    /// The command that changes a scale object; `None` where there is none at that place.
    pub fn change_object(
        &self,
        place: usize,
        change: impl FnOnce(&mut ScaleObject),
    ) -> Option<Command> {
        let mut settings = self.settings();
        change(settings.scale_objects.get_mut(place)?);
        Some(Command::Set(settings))
    }

    pub(crate) fn pick(&mut self, purpose: Purpose, ray: Ray) {
        self.pick_in(purpose, ray, self.clip.clipping());
    }

    fn pick_in(&mut self, purpose: Purpose, ray: Ray, clip: Option<LevelBox>) {
        let flight = self.flight().clone();
        if let Some(picker) = &mut self.pointer.picker {
            picker.ask(purpose, ray, clip, &flight);
        }
    }

    pub(crate) fn select(&mut self, photo: Option<usize>) {
        let before = self.selected;
        self.selected = photo.filter(|&photo| photo < self.review.count());
        if self.selected != before {
            // The points were on the other photo.
            self.objects.tracing = None;
            self.reviewing.reason = 0;
            self.leave_fragments();
        }
        // Looking through a camera goes on through the next one, all of it.
        if self.looking.through.is_some() && self.looking.through != self.selected {
            self.looking.through = self.selected;
            self.looking.into = PhotoZoom::default();
        }
    }

    /// Moves down the table's rows; with nothing selected, to the first row.
    pub(crate) fn select_by(&mut self, rows: i32) {
        let place = self
            .selected
            .and_then(|photo| self.table.shown.iter().position(|&shown| shown == photo));
        let Some(last) = self.table.shown.len().checked_sub(1) else {
            return;
        };
        let next = match place {
            Some(place) => place
                .saturating_add_signed(isize::try_from(rows).unwrap_or(0))
                .min(last),
            None => 0,
        };
        self.select(Some(self.table.shown[next]));
    }

    fn change_view(&mut self, change: ViewChange) {
        let looking = &mut self.looking;
        let orbit = &mut looking.orbit;
        match change {
            ViewChange::Blend(blend) => looking.blend = blend.clamp(0.0, 1.0),
            ViewChange::Resized(size) => {
                looking.size = Some(size);
                if !looking.turned {
                    self.fit();
                }
            }
            ViewChange::Through => {
                looking.into = PhotoZoom::default();
                looking.through = match looking.through {
                    Some(_) => None,
                    None => self.selected,
                };
            }
            ViewChange::Zoom { .. } | ViewChange::Pan(..) if looking.through.is_some() => {
                self.look_into_photo(change);
            }
            _ => {
                // Whatever turns the view leaves the camera.
                looking.through = None;
                looking.turned = true;
                match change {
                    ViewChange::Orbit(delta) => orbit.orbit(delta),
                    ViewChange::Pan(delta, size) => orbit.pan(delta, size),
                    ViewChange::Zoom {
                        cursor,
                        size,
                        factor,
                    } => orbit.zoom_to(cursor, size, factor, self.pointer.hover),
                    ViewChange::Top => orbit.top(),
                    ViewChange::Front => orbit.front(),
                    ViewChange::Side => orbit.side(),
                    ViewChange::Opposite => orbit.opposite(),
                    ViewChange::Turn { left, up } => {
                        orbit.turn(left.to_radians(), up.to_radians());
                    }
                    ViewChange::Fit => self.fit(),
                    ViewChange::FitAll => self.fit_box(self.extent.surface),
                    ViewChange::FitSelected => self.fit_selected(),
                    ViewChange::Center(point) => orbit.center_on(point),
                    ViewChange::Blend(_) | ViewChange::Resized(_) | ViewChange::Through => {}
                }
            }
        }
    }

    /// Looks into a part of the photo whose camera is looked through.
    fn look_into_photo(&mut self, change: ViewChange) {
        let photo = self
            .looking
            .through
            .and_then(|photo| self.review.photo(photo));
        let Some(camera) = photo.map(|photo| photo.camera) else {
            return;
        };
        let image = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        let into = self.looking.into;
        self.looking.into = match change {
            ViewChange::Zoom {
                cursor,
                size,
                factor,
            } => into.zoomed(cursor, 1.0 / factor, image, size),
            ViewChange::Pan(by, size) => into.panned(by, image, size),
            _ => into,
        };
    }

    fn points_from(&mut self, from: PointFrom, ray: Ray) {
        self.pointer.from = Some(from);
        self.pointer.asked = Some((from, ray));
    }

    /// The mouse left, or the surface under it is another one.
    pub(crate) fn point_at_nothing(&mut self) {
        self.pointer.hover = None;
        self.pointer.from = None;
        self.pointer.asked = None;
        self.pointer.linked = None;
    }

    /// Brings surface and cameras into sight, without the surface's outliers: a few points of a sparse cloud
    /// lie anywhere, and all else would be a dot.
    pub(super) fn fit(&mut self) {
        self.fit_box(self.extent.bulk);
    }

    /// Brings this box and the cameras into sight.
    fn fit_box(&mut self, surface: Bounds) {
        let (low, high) = (surface.min, surface.max);
        let corners = (0..8_u8).map(|corner| {
            let pick = |bit: u8, low: f64, high: f64| if corner & bit == 0 { low } else { high };
            DVec3::new(
                pick(1, low.x, high.x),
                pick(2, low.y, high.y),
                pick(4, low.z, high.z),
            )
        });
        let photos = self.flight().parts().photos.iter();
        let points: Vec<DVec3> = corners
            .chain(photos.map(|photo| photo.pose.center))
            .collect();
        self.fit_points(&points);
    }

    pub(super) fn fit_points(&mut self, points: &[DVec3]) {
        let size = self.looking.size.unwrap_or(DVec2::new(4.0, 3.0));
        self.looking.orbit.fit_into(points, size);
        // How far one can go in and out depends on the flight, not on what is in sight; as far at least as
        // that is.
        let orbit = &mut self.looking.orbit;
        let flight = self.extent.all.size().length() * 0.5;
        orbit.extent = flight.max(orbit.distance * 0.1);
    }

    fn fit_selected(&mut self) {
        let Some(photo) = self.selected else {
            return;
        };
        let Some(posed) = self.flight().parts().photos.get(photo) else {
            return;
        };
        let mut points = vec![posed.pose.center];
        if let Some(scale) = self.scale(photo) {
            points.extend(scale.corners.iter().filter_map(crate::scale::Corner::point));
        }
        self.fit_points(&points);
    }
}
