//! From where the pile is looked at.

use crate::open_flight::OpenFlight;
use crate::render::View;
use crate::size_distributions::Page;
use crate::state::State;

impl State {
    /// What the viewport looks from: the orbit, else the camera that is looked through.
    pub(crate) fn view(&self, open: &OpenFlight) -> View {
        let orbit = || open.looking.orbit.view();
        if self.page == Page::Plan {
            return planned(open).unwrap_or_else(orbit);
        }
        let through = open.looking.through;
        match through.and_then(|photo| open.review.photo(photo)) {
            None => orbit(),
            Some(photo) => {
                View::through(&photo, open.looking.orbit.distance).into_photo(open.looking.into)
            }
        }
    }
}

/// The selected photo of the plan, while its camera is looked through.
fn planned(open: &OpenFlight) -> Option<View> {
    let planning = &open.planning;
    let (_, photo) = planning.photo().filter(|_| planning.through)?;
    let camera = &planning.made.as_ref()?.plan.camera;
    Some(View::of_photo(camera, &photo.pose, photo.distance))
}
