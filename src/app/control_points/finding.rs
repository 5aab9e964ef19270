//! What follows from the marks: made anew when one of them, the flight or what is chosen changes, not in each frame.

use std::sync::Arc;

use glam::DVec2;

use crate::control::{ControlList, ControlPoint, EpipolarLine, Located, MarkedView, locate};
use crate::flight::Flight;
use crate::scale::{ImageKind, Sighting};

/// What the rest follows from.
#[derive(Debug)]
pub(super) struct Basis<'a> {
    pub(super) flight: &'a Arc<Flight>,
    pub(super) list: &'a ControlList,
    /// Which point.
    pub(super) chosen: Option<usize>,
    /// Which photo.
    pub(super) selected: Option<usize>,
    /// Which image of it.
    pub(super) image: ImageKind,
}

/// The same, kept to be compared with.
#[derive(Debug)]
struct Kept {
    flight: Arc<Flight>,
    list: ControlList,
    chosen: Option<usize>,
    selected: Option<usize>,
    image: ImageKind,
}

/// What follows from the marks. Pixels are those of the image that the photo view shows.
#[derive(Debug, Default)]
pub struct Found {
    from: Option<Kept>,
    /// Of each point of the list: where it is, or why that is not known yet, in a line.
    pub points: Vec<Result<Located, String>>,
    /// Photos without a mark of the chosen point in which it should be, by their indices.
    pub seen_in: Vec<usize>,
    /// In the selected photo, where it has no mark of the chosen point: the epipolar lines of its marks.
    pub lines: Vec<Vec<DVec2>>,
    /// And where it should be.
    pub predicted: Option<DVec2>,
}

/// The marks of a point that are in photos of the flight, with these photos.
fn marks<'a>(flight: &'a Flight, point: &ControlPoint) -> Vec<(usize, MarkedView<'a>)> {
    let photos = &flight.parts().photos;
    let view = |(name, pixel): &(String, DVec2)| {
        let place = photos.iter().position(|photo| photo.name == *name)?;
        let photo = photos.get(place)?;
        let view = MarkedView {
            camera: flight.camera(photo),
            pose: &photo.pose,
            pixel: *pixel,
        };
        Some((place, view))
    };
    point.marks.iter().filter_map(view).collect()
}

impl Found {
    /// Whether it follows from this.
    pub(super) fn is_of(&self, basis: &Basis<'_>) -> bool {
        self.from.as_ref().is_some_and(|from| {
            Arc::ptr_eq(&from.flight, basis.flight)
                && (from.chosen, from.selected, from.image)
                    == (basis.chosen, basis.selected, basis.image)
                && from.list == *basis.list
        })
    }

    /// What follows from this.
    pub(super) fn of(basis: &Basis<'_>) -> Self {
        let points: Vec<Result<Located, String>> = (basis.list.points.iter())
            .map(|point| {
                let views: Vec<MarkedView<'_>> = (marks(basis.flight, point).into_iter())
                    .map(|(_, view)| view)
                    .collect();
                locate(&views).map_err(|fault| fault.what)
            })
            .collect();
        let mut found = Self {
            from: Some(Kept {
                flight: basis.flight.clone(),
                list: basis.list.clone(),
                chosen: basis.chosen,
                selected: basis.selected,
                image: basis.image,
            }),
            points,
            ..Self::default()
        };
        if let Some(chosen) = basis.chosen {
            found.look_for(basis, chosen);
        }
        found
    }

    /// Where photos show the chosen point.
    fn look_for(&mut self, basis: &Basis<'_>, chosen: usize) {
        let Some(point) = basis.list.points.get(chosen) else {
            return;
        };
        let (flight, image) = (basis.flight, basis.image);
        let marks = marks(flight, point);
        let place = self
            .points
            .get(chosen)
            .and_then(|found| found.as_ref().ok());
        let place = place.map(|located| located.point);
        let photos = &flight.parts().photos;
        if let Some(place) = place {
            let sees = |photo: &usize| {
                let posed = &photos[*photo];
                let camera = flight.camera(posed);
                point.mark_in(&posed.name).is_none()
                    && Sighting::in_frame(camera, &posed.pose, ImageKind::AsShot, place).is_some()
            };
            self.seen_in = (0..photos.len()).filter(sees).collect();
        }
        let selected = basis.selected.and_then(|photo| photos.get(photo));
        let Some(posed) = selected.filter(|posed| point.mark_in(&posed.name).is_none()) else {
            return;
        };
        let camera = flight.camera(posed);
        let project = |direction| image.pixel(camera, direction);
        for (_, view) in marks {
            // Where a lens shows nothing at a mark there is no line.
            if let Ok(line) = EpipolarLine::new((view.camera, view.pose), view.pixel, &posed.pose) {
                self.lines.extend(line.runs(camera, project));
            }
        }
        let project = |place| image.pixel(camera, posed.pose.camera_from_world(place));
        self.predicted = place.and_then(project);
    }
}
