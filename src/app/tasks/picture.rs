//! Writing a picture of the viewport.

use std::path::{Path, PathBuf};

use image::RgbaImage;

use super::work::Task;
use crate::command::{Command, Destination, PictureRequest};
use crate::fault::Fault;
use crate::files::{self, Inputs, Kind, marked_png};
use crate::jobs::Progress;
use crate::render::MOST_PIXELS;
use crate::state::{Severity, State};

impl Task {
    /// Writing a picture of the viewport.
    pub const PICTURE: Self = Self::new("Picture").writing();
}

impl State {
    /// Has the viewport draw a picture.
    pub(crate) fn ask_picture(&mut self, request: PictureRequest) {
        self.asking = None;
        let [width, height] = request.size.map(u64::from);
        if self.open.is_none() || self.is_busy(Task::PICTURE) {
            return;
        }
        if width * height > MOST_PIXELS {
            let most = MOST_PIXELS / 1_000_000;
            let text = format!(
                "a picture of {width} x {height} pixels is too large; choose at most {most} million pixels"
            );
            self.say(Severity::Error, &text);
            return;
        }
        let (read, again) = (self.read(), request.clone());
        let command = |to| Command::Picture(PictureRequest { to, ..again });
        if self.may_write(&request.to, Kind::Result, &read, command) {
            self.picture = Some(request);
        }
    }

    /// Writes the picture that the viewport has drawn.
    pub(crate) fn start_writing_picture(
        &mut self,
        to: Destination,
        drawn: Result<RgbaImage, Fault>,
    ) {
        let read = self.read();
        let work = move |progress: &Progress| {
            progress.stage("writing the picture");
            let path = to.path;
            match write(&path, to.replace, drawn, &read) {
                Ok(()) => Ok(path),
                Err(what) => Err(format!("{}: {what}", path.display())),
            }
        };
        self.start(Task::PICTURE, work, Self::take_written);
    }

    /// Tells that a file was written, or why not.
    pub(crate) fn take_written(&mut self, written: Result<PathBuf, String>) {
        match written {
            Ok(path) => self.say(Severity::Note, &format!("{}: written", path.display())),
            Err(message) => self.say(Severity::Error, &message),
        }
    }
}

fn write(
    path: &Path,
    replace: bool,
    drawn: Result<RgbaImage, Fault>,
    read: &Inputs,
) -> Result<(), String> {
    let picture = drawn.map_err(|fault| fault.to_string())?;
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .map_err(|error| error.to_string())?;
    let bytes = marked_png(bytes.into_inner());
    files::write(path, &bytes, Kind::Result, read, replace).map_err(|fault| fault.to_string())
}
