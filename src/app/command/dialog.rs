//! The desktop's own dialog, as data.

use crate::from_photos::FolderField;
use crate::open_flight::georeferencing::PathField;
use crate::planning::PlanTool;
use crate::season::SeasonField;

/// The desktop's own dialog for a file or folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialog {
    /// What it says on top.
    pub title: &'static str,
    /// What is chosen in it.
    pub chooses: Chooses,
    /// What is done with that.
    pub answers: Answers,
}

/// What is chosen in a dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chooses {
    /// A file that is there.
    File,
    /// A folder.
    Folder,
    /// A file to write, with this name if nobody types another.
    NewFile(&'static str),
}

/// What is done with what was chosen in a dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answers {
    /// It is opened.
    Open,
    /// It stands in the field of the small window that is open.
    Asking,
    /// It stands in this field of georeferencing.
    Georeference(PathField),
    /// It is an area of the plan, or ground to keep out of.
    Areas(PlanTool),
    /// It is compared with the flight that came of it.
    Flown,
    /// It stands in this field of a new flight from photos.
    FromPhotos(FolderField),
    /// It stands in this field of a season.
    Season(SeasonField),
}

impl Dialog {
    /// For a file, for the small window that is open.
    pub const fn file(title: &'static str) -> Self {
        Self {
            title,
            chooses: Chooses::File,
            answers: Answers::Asking,
        }
    }

    /// For a folder, for the small window that is open.
    pub const fn folder(title: &'static str) -> Self {
        Self {
            chooses: Chooses::Folder,
            ..Self::file(title)
        }
    }

    /// For a file to write, for the small window that is open.
    pub const fn new_file(title: &'static str, name: &'static str) -> Self {
        Self {
            chooses: Chooses::NewFile(name),
            ..Self::file(title)
        }
    }

    /// The same with another answer.
    #[must_use]
    pub const fn answering(self, answers: Answers) -> Self {
        Self { answers, ..self }
    }
}
