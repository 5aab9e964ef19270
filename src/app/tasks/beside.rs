//! Reading and uploading clouds that are drawn beside the flight's surface.

use std::path::PathBuf;
use std::sync::Arc;

use super::work::Task;
use crate::jobs::Progress;
use crate::opening::second_surface;
use crate::render::BesideCloud;
use crate::state::State;

impl Task {
    /// Reading a cloud to be drawn beside the surface.
    pub const BESIDE: Self = Self::new("Cloud beside").of_flight();
    /// Uploading one.
    pub const UPLOAD_BESIDE: Self = Self::new("Preparing a cloud").of_flight().to_the_end();
}

impl State {
    /// Reads a cloud to be drawn beside the surface, in the flight's world.
    pub(crate) fn add_beside(&mut self, path: PathBuf) {
        self.asking = None;
        if self.is_busy(Task::BESIDE) {
            return;
        }
        self.read_second_surface(Task::BESIDE, path, second_surface, |open, path, second| {
            open.add_beside(path, second.surface);
        });
    }

    /// Uploads the next cloud beside the surface that is not, or has another colour by now.
    pub(crate) fn upload_beside(&mut self) {
        let (Some(open), Some(gpu)) = (&self.open, self.gpu.clone()) else {
            return;
        };
        let next = open.beside.iter().find(|beside| {
            let uploaded = beside.uploaded.as_ref().map(|(color, _)| *color);
            let wish = (beside.number, beside.color);
            let is_wanted = beside.is_shown && uploaded != Some(beside.color);
            is_wanted && self.work.may_start(Task::UPLOAD_BESIDE, &wish)
        });
        let Some(next) = next else {
            return;
        };
        let wish = (next.number, next.color);
        let ((number, color), frame) = (wish, open.extent.frame);
        let surface = next.surface.clone();
        let work = move |progress: &Progress| {
            progress.stage("uploading the cloud");
            let vertices = surface.vertices();
            let one = color.map(|color| vec![color; vertices.len()]);
            let colors = one.as_deref().unwrap_or(surface.colors());
            Ok(BesideCloud::new(&gpu, &frame, vertices, colors))
        };
        self.start_wished(Task::UPLOAD_BESIDE, wish, work, move |state, cloud| {
            let open = state.open.as_mut();
            let beside = open.and_then(|open| {
                let mut all = open.beside.iter_mut();
                all.find(|beside| beside.number == number)
            });
            if let Some(beside) = beside {
                beside.uploaded = Some((color, Arc::new(cloud)));
            }
        });
    }
}
