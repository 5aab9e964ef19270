//! Taking what jobs and rays have brought, a little in each frame.

use std::sync::Arc;

use crate::command::Command;
use crate::flight::{ColoursFound, Verdict};
use crate::open_flight::picker::{Picked, Picker, Purpose};
use crate::open_flight::{Measure, OpenFlight, Preview};
use crate::opening::OpenOptions;
use crate::state::{Severity, State};
use crate::tasks::work::{DialogFor, Done, Loaded, NotOpened, Task, Thumbnail};

/// Thumbnails taken in one frame: uploading each takes a fraction of a millisecond.
const THUMBNAILS_A_FRAME: usize = 8;

impl State {
    /// Takes what is there, and asks for another frame while something is under way.
    pub fn poll(&mut self) {
        while let Some(done) = self.work.finished() {
            match done {
                Ok((done, took)) => {
                    self.measure(&done, took);
                    self.take(done);
                }
                Err(fault) => self.say(Severity::Error, &fault.to_string()),
            }
        }
        for thumbnail in self.work.thumbnails(THUMBNAILS_A_FRAME) {
            self.take_thumbnail(thumbnail);
        }
        if let Some(open) = &mut self.open {
            let answers = open.picker.as_mut().map(Picker::answers);
            let before = open.selected;
            for picked in answers.into_iter().flatten() {
                open.take_picked(picked);
            }
            if open.selected != before {
                self.load_preview();
            }
        }
        if !self.work.is_idle() {
            // Often enough for a progress bar; idle windows draw nothing. A dialog can take minutes.
            let only_dialog = self.work.running().all(|(task, _)| task == Task::Dialog);
            let pause = if only_dialog { 500 } else { 100 };
            self.context
                .request_repaint_after(std::time::Duration::from_millis(pause));
        }
    }

    fn take(&mut self, done: Done) {
        match done {
            Done::Opened(result) => match *result {
                Ok(loaded) => self.take_flight(loaded),
                Err(not_opened) => {
                    let NotOpened { why, tried } = *not_opened;
                    self.say(Severity::Error, &why);
                    // A wrong surface does not make forget the flight that it was for.
                    self.tried = tried.or_else(|| self.tried.take());
                    self.take_back_settings();
                }
            },
            Done::Scales(Ok((flight, outcomes, looked_up, settings))) => {
                let Some(open) = &mut self.open else {
                    return;
                };
                let before = open.flight().parts();
                let after = flight.parts();
                let other_image = before.image != after.image;
                // Of one reading of the file the points are the same.
                let other_surface = before.surface.max_edge() != after.surface.max_edge();
                let said_before = &open.review.looked_up().warnings;
                let said = looked_up.warnings_of(open.path.display());
                let new: Vec<String> = said
                    .zip(&looked_up.warnings)
                    .filter(|(_, bare)| !said_before.contains(bare))
                    .map(|(warning, _)| warning)
                    .collect();
                open.take_scales(flight, outcomes, looked_up, settings);
                for warning in new {
                    self.say(Severity::Warning, &warning);
                }
                if other_surface {
                    self.start_geometry();
                    self.start_picker();
                }
                if other_image {
                    self.load_preview();
                    self.start_thumbnails();
                }
                self.start_views();
                self.start_comparing();
            }
            Done::Compared(compared) => self.take_compared(compared),
            Done::Views(Ok(views)) => {
                if let Some(open) = &mut self.open {
                    open.take_views(views);
                }
            }
            Done::Geometry(Ok(geometry)) => {
                if let Some(open) = &mut self.open {
                    open.geometry = Some(Arc::from(geometry));
                }
            }
            Done::Scales(Err(fault)) => {
                self.say(Severity::Error, &fault.to_string());
                self.take_back_settings();
            }
            Done::Views(Err(fault)) | Done::Geometry(Err(fault)) => {
                self.say(Severity::Error, &fault.to_string());
            }
            Done::Thumbnails | Done::Cancelled => {}
            Done::Preview { photo, picture } => {
                if let Some(open) = &mut self.open
                    && open.selected == Some(photo)
                {
                    let number = open.preview.as_ref().map_or(0, |preview| preview.number) + 1;
                    open.preview = Some(Preview {
                        photo,
                        picture,
                        number,
                    });
                }
            }
            Done::Exported(Ok((sentence, warnings))) => {
                for warning in warnings {
                    self.say(Severity::Warning, &warning);
                }
                self.say(Severity::Note, &sentence);
            }
            Done::Picture(Ok(path)) => {
                self.say(Severity::Note, &format!("{}: written", path.display()));
            }
            Done::Exported(Err(message)) | Done::Picture(Err(message)) => {
                self.say(Severity::Error, &message);
            }
            Done::Saved(_, Err(message)) => {
                self.after_saving = None;
                self.say(Severity::Error, &message);
            }
            Done::Saved(flight, Ok((origin, settings))) => {
                if let Some(path) = origin.flight_file() {
                    let path = path.to_owned();
                    self.preferences.remember(&path);
                    self.say(Severity::Note, &format!("{}: saved", path.display()));
                }
                // She may have gone on to another flight meanwhile.
                let on_screen = self.open.as_mut().filter(|open| open.origin == flight);
                if let Some(open) = on_screen {
                    if let Some(path) = origin.flight_file() {
                        open.path = path.to_owned();
                        // They stand in the file now.
                        open.options = OpenOptions::default();
                    }
                    open.bundled = false;
                    if let Some(path) = origin.flight_file() {
                        open.read.add(path);
                    }
                    open.origin = origin;
                    open.saved = settings;
                }
                let changed = self.open.as_ref().is_some_and(|open| open.is_changed());
                match self.after_saving.take() {
                    // Changed again meanwhile: she is asked again.
                    Some(held_back) if changed => self.held_back = Some(held_back),
                    Some(held_back) => self.go_on(held_back),
                    None => {}
                }
            }
            Done::Georeferenced(photos, result) => {
                if let Some(open) = &mut self.open {
                    open.georeferencing.outcome = Some((photos, *result));
                }
            }
            Done::SavedGeoreferenced(Ok(path)) => {
                self.say(Severity::Note, &format!("{}: saved", path.display()));
                self.apply(Command::Open(path));
            }
            Done::ReadEffort(path, read) => self.take_effort(&path, read),
            Done::ReadDistributions(read) => self.take_distributions(read),
            Done::Fitted(result) => self.take_fitted(result),
            Done::SavedDistributions(Ok(path)) => {
                self.say(Severity::Note, &format!("{}: written", path.display()));
            }
            Done::SavedDistributions(Err(message)) => self.say(Severity::Error, &message),
            Done::SavedGeoreferenced(Err(message)) => self.say(Severity::Error, &message),
            Done::Dialog(what, Some(path)) => match what {
                DialogFor::Georeference(field) => {
                    if let Some(open) = &self.open {
                        let mut form = open.georeferencing.form.clone();
                        *form.path(field) = path.display().to_string();
                        self.fill_georeference(form);
                    }
                }
                DialogFor::Open => self.apply(Command::Open(path)),
                DialogFor::Add
                | DialogFor::Export
                | DialogFor::SaveAs
                | DialogFor::Picture
                | DialogFor::Distributions
                | DialogFor::Effort
                | DialogFor::Figure
                | DialogFor::Report => {
                    self.answered = Some(path);
                }
            },
            Done::Dialog(..) => self.say(
                Severity::Note,
                "no file was chosen; where the desktop has no file dialog, type the path",
            ),
        }
    }

    /// Where neither scales nor the file are on their way any more, a change of the settings that
    /// was not computed goes.
    pub(crate) fn take_back_settings(&mut self) {
        let on_the_way = self.work.is_running(Task::Scales) || self.work.is_running(Task::Open);
        if let Some(open) = &mut self.open
            && !on_the_way
        {
            open.take_back_settings();
        }
    }

    fn take_flight(&mut self, loaded: Loaded) {
        let count = loaded.outcomes.len();
        let again = match (loaded.again_for, self.open.take()) {
            // The same flight with other surface options: what the engineer did stays, unless its
            // files have other photos by now.
            (Some(number), Some(before)) if number == before.number => {
                // Scales of the flight before would come over those of this one.
                self.work.cancel(Task::Scales);
                Some(before).filter(|before| before.review.count() == count)
            }
            // She has gone on to another flight meanwhile.
            (Some(_), other) => {
                self.open = other;
                return;
            }
            (None, before) => {
                if let Some(before) = before {
                    before.let_go();
                }
                None
            }
        };
        if again.is_none() {
            self.work.cancel_for_flight();
            self.preferences.remember(&loaded.path);
        }
        for warning in loaded.opened.all_warnings() {
            // Read again with other settings, a file can have something new to say.
            let known = again
                .as_ref()
                .is_some_and(|before| before.all_warnings().contains(&warning));
            if !known {
                self.say(Severity::Warning, &warning);
            }
        }
        self.opened += 1;
        self.tried = None;
        let read_with = loaded.opened.settings.clone();
        let limits = self.preferences.limits;
        let mut open = Box::new(OpenFlight::new(self.opened, loaded, &limits));
        if let Some(before) = again {
            open.keep_from(before);
            open.arrange();
        }
        self.open = Some(open);
        self.start_picker();
        self.start_views();
        self.start_comparing();
        self.start_geometry();
        self.load_preview();
        self.start_thumbnails();
        let Some(open) = &self.open else {
            return;
        };
        if !open.settings().gives_the_scales_of(&read_with) {
            // Changed again while the file was read.
            self.settings_changed();
            return;
        }
        let sentence = format!(
            "{}: {} photos, {} without a scale",
            open.flight().parts().name,
            open.review.count(),
            open.review.count_of(Verdict::NoScale)
        );
        self.say(Severity::Note, &sentence);
    }

    fn start_picker(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        open.hover = None;
        let surface = open.flight().parts().surface.clone();
        match Picker::new(surface, self.context.clone()) {
            Ok(picker) => open.picker = Some(picker),
            Err(fault) => self.say(Severity::Error, &fault.to_string()),
        }
    }

    fn take_thumbnail(&mut self, thumbnail: Thumbnail) {
        let Thumbnail {
            flight,
            photo,
            small,
            image,
            colours,
        } = thumbnail;
        let Some(open) = &mut self.open else {
            return;
        };
        if open.number != flight || photo >= open.thumbnails.len() {
            return;
        }
        if let Some(small) = small {
            let options = egui::TextureOptions::LINEAR;
            let texture = self
                .context
                .load_texture(format!("thumbnail {photo}"), small, options);
            open.thumbnails[photo] = Some(texture);
        }
        open.images[photo] = image.map(Arc::new);
        let evidence = open.review.looked_up().evidence.get(photo);
        let is_known =
            evidence.is_some_and(|evidence| evidence.colours != ColoursFound::NotCompared);
        let doubt = colours.doubt().filter(|_| !is_known);
        let said = doubt.map(|doubt| format!("photo '{}': {doubt}", open.name(photo)));
        open.take_colours(photo, &colours);
        if let Some(said) = said {
            self.say(Severity::Warning, &said);
        }
    }

    /// Whether nothing is under way.
    pub fn is_idle(&self) -> bool {
        let waiting = |open: &OpenFlight| open.picker.as_ref().is_some_and(Picker::is_waiting);
        self.work.is_idle() && !self.open.as_deref().is_some_and(waiting)
    }

    /// Whether a flight is being read.
    pub fn is_opening(&self) -> bool {
        self.work.is_running(Task::Open)
    }
}

impl OpenFlight {
    /// Takes over what the engineer did from the flight before it was read again.
    fn keep_from(&mut self, mut before: Box<Self>) {
        self.saved = before.saved.clone();
        // Saved elsewhere while the file was read.
        self.path.clone_from(&before.path);
        self.options.clone_from(&before.options);
        self.origin = before.origin.clone();
        self.opened_file.clone_from(&before.opened_file);
        self.read.extend(&before.read);
        self.bundled = before.bundled;
        self.measure = before.measure;
        self.tracing = before.tracing.take();
        self.trace_sizes = before.trace_sizes;
        std::mem::swap(&mut self.georeferencing, &mut before.georeferencing);
        std::mem::swap(&mut self.history, &mut before.history);
        self.proposed = before.proposed;
        self.selected = before.selected;
        std::mem::swap(&mut self.order, &mut before.order);
        self.looking = before.looking;
        before.let_go();
    }

    fn take_picked(&mut self, picked: Picked) {
        let point = picked.hit.map(|hit| hit.point);
        match picked.purpose {
            Purpose::Hover => self.hover = point,
            Purpose::Center => {
                if let Some(point) = point {
                    self.looking.through = None;
                    self.looking.orbit.center_on(point);
                }
            }
            Purpose::Measure => {
                if let Some(point) = point {
                    self.measure = match self.measure {
                        Measure::Off => Measure::Off,
                        Measure::First | Measure::Both(..) => Measure::Second(point),
                        Measure::Second(first) => Measure::Both(first, point),
                    };
                }
            }
            Purpose::Select => {
                if let Some(photo) = self.photo_at(&picked) {
                    self.select(Some(photo));
                }
            }
        }
    }

    /// The photo that a click means: the camera next to the ray, else the photo that sees the place
    /// nearest to its middle.
    fn photo_at(&self, picked: &Picked) -> Option<usize> {
        let photos = &self.flight().parts().photos;
        // A camera is hit within this share of its distance: about ten pixels on the screen.
        let reach = 0.012;
        let camera = photos
            .iter()
            .enumerate()
            .filter_map(|(index, photo)| {
                let way = photo.pose.center - picked.ray.origin;
                let along = way.dot(picked.ray.direction);
                let beside = (way - picked.ray.direction * along).length();
                let before_surface = picked.hit.is_none_or(|hit| along < hit.t);
                (along > 0.0 && before_surface && beside < reach * along)
                    .then_some((index, beside / along))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((index, _)) = camera {
            return Some(index);
        }
        let point = picked.hit?.point;
        photos
            .iter()
            .enumerate()
            .filter_map(|(index, photo)| {
                let camera = self.flight().camera(photo);
                let pixel = camera.pixel_undistorted(photo.pose.camera_from_world(point))?;
                let half =
                    glam::DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
                camera
                    .contains(pixel)
                    .then(|| (index, ((pixel - half) / half).abs().max_element()))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }
}
