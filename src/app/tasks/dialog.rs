//! The desktop's own dialog for files and folders.

use std::path::PathBuf;

use super::work::Task;
use crate::command::{Answers, Chooses, Command, Dialog};
use crate::jobs::Progress;
use crate::planning::PlanStep;
use crate::state::{Severity, State};

impl Task {
    /// Waiting for the desktop's own dialog.
    pub const DIALOG: Self = Self::new("Dialog");
}

impl State {
    /// Opens the desktop's own dialog on a thread of its own: its blocking form would freeze the
    /// window.
    pub(crate) fn browse(&mut self, dialog: Dialog) {
        let work = move |progress: &Progress| {
            progress.stage("waiting for the desktop's dialog");
            let native = rfd::AsyncFileDialog::new().set_title(dialog.title);
            let chosen = pollster::block_on(async {
                match dialog.chooses {
                    Chooses::File => native.pick_file().await,
                    Chooses::Folder => native.pick_folder().await,
                    Chooses::NewFile(name) => native.set_file_name(name).save_file().await,
                }
            });
            chosen.map(|file| file.path().to_owned())
        };
        self.start(Task::DIALOG, work, move |state, chosen| {
            state.take_chosen(dialog.answers, chosen);
        });
    }

    /// Takes what the person chose; `None` where she did not, or where the desktop has no dialog.
    fn take_chosen(&mut self, answers: Answers, chosen: Option<PathBuf>) {
        let Some(path) = chosen else {
            let text = "no file was chosen; where the desktop has no file dialog, type the path";
            self.say(Severity::Note, text);
            return;
        };
        match answers {
            Answers::Open => self.apply(Command::Open(path)),
            Answers::Asking => self.answered = Some(path),
            Answers::Areas(tool) => {
                let text = path.display().to_string();
                self.plan_step(PlanStep::ReadAreas(tool, text));
            }
            Answers::Flown => self.plan_step(PlanStep::Compare(path)),
            Answers::FromPhotos(field) => self.take_folder_of_photos(field, path),
            Answers::Season(field) => self.take_place_of_season(field, &path),
            Answers::Georeference(field) => {
                if let Some(open) = &self.open {
                    let mut form = open.georeferencing.form.clone();
                    *form.path(field) = path.display().to_string();
                    self.fill_georeference(form);
                }
            }
        }
    }
}
