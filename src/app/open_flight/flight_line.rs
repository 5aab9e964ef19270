//! The flight line: through the photos as they were taken, however the flight's file orders them.

use std::sync::Arc;

use super::OpenFlight;
use crate::render::{Taken, flight_line};

impl OpenFlight {
    /// Orders the line by what is known of the photos now.
    pub(super) fn order_line(&mut self) {
        let photos = self.flight().parts().photos.iter();
        let taken = photos.zip(&self.pictures.times).map(|(photo, time)| Taken {
            name: &photo.name,
            time: time.as_deref(),
        });
        let line = flight_line(&taken.collect::<Vec<_>>());
        if *self.line != line {
            self.line = Arc::new(line);
        }
    }

    /// Takes when a photo was taken. The last one that was missing orders the line: each one for itself
    /// would be work that grows with the flight, in every frame.
    pub(crate) fn take_time(&mut self, photo: usize, time: Option<String>) {
        let Some(place) = self.pictures.times.get_mut(photo) else {
            return;
        };
        *place = time;
        if self.pictures.times.iter().all(Option::is_some) {
            self.order_line();
        }
    }
}
