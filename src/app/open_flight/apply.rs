//! What commands do to the flight on the screen alone.

use glam::{DVec2, DVec3};

use crate::command::{Choice, Command, ViewChange};
use crate::flight::{ScaleObject, Verdict};
use crate::open_flight::picker::Purpose;
use crate::open_flight::table::SortBy;
use crate::open_flight::{Measure, OpenFlight};

impl OpenFlight {
    /// What concerns the flight on the screen alone.
    pub(crate) fn apply(&mut self, command: Command) {
        match command {
            Command::Click(ray) => {
                let purpose = if self.pointer.measure == Measure::Off {
                    Purpose::Select
                } else {
                    Purpose::Measure
                };
                self.pick(purpose, ray);
            }
            Command::Hover(Some(ray)) => self.pick(Purpose::Hover, ray),
            Command::Hover(None) => self.pointer.hover = None,
            Command::DoubleClick(ray) => self.pick(Purpose::Center, ray),
            Command::HoverPhoto(photo) => self.table.hovered = photo,
            Command::Choose(photo, chosen) => {
                let mut edit = self.history.now().clone();
                if let Some(place) = edit.chosen.get_mut(photo) {
                    *place = chosen;
                }
                self.history.set(edit);
                self.arrange();
            }
            // Nothing is trusted before it was looked at.
            Command::ChooseAll(Choice::Trusted) if !self.review.is_looked_at() => {}
            Command::ChooseAll(choice) => {
                let mut edit = self.history.now().clone();
                for (place, photo) in edit.chosen.iter_mut().zip(self.review.photos()) {
                    *place = match choice {
                        Choice::WithScale => photo.verdict != Verdict::NoScale,
                        Choice::Trusted => photo.verdict == Verdict::Trust,
                        Choice::None => false,
                    };
                }
                self.history.set(edit);
                self.arrange();
            }
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
            Command::View(change) => self.change_view(change),
            Command::ToggleMeasure => {
                self.pointer.measure = if self.pointer.measure == Measure::Off {
                    Measure::First
                } else {
                    Measure::Off
                };
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

    fn pick(&mut self, purpose: Purpose, ray: crate::geometry::Ray) {
        if let Some(picker) = &mut self.pointer.picker {
            picker.ask(purpose, ray);
        }
    }

    pub(crate) fn select(&mut self, photo: Option<usize>) {
        let before = self.selected;
        self.selected = photo.filter(|&photo| photo < self.review.count());
        if self.selected != before {
            // The points were on the other photo.
            self.objects.tracing = None;
        }
        // Looking through a camera goes on through the next one.
        if self.looking.through.is_some() {
            self.looking.through = self.selected;
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
                looking.through = match looking.through {
                    Some(_) => None,
                    None => self.selected,
                };
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
                    ViewChange::Fit => self.fit(),
                    ViewChange::FitSelected => self.fit_selected(),
                    ViewChange::Center(point) => orbit.center_on(point),
                    ViewChange::Blend(_) | ViewChange::Resized(_) | ViewChange::Through => {}
                }
            }
        }
    }

    /// Brings surface and cameras into sight.
    fn fit(&mut self) {
        let (low, high) = (self.extent.bulk.min, self.extent.bulk.max);
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

    fn fit_points(&mut self, points: &[DVec3]) {
        let size = self.looking.size.unwrap_or(DVec2::new(4.0, 3.0));
        self.looking.orbit.fit_into(points, size);
        // How far one can go in and out depends on the flight, not on what is in sight.
        self.looking.orbit.extent = self.extent.all.size().length() * 0.5;
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
