//! Clouds that are drawn beside the flight's surface. They are looked at: nothing is computed of them.

use std::path::PathBuf;
use std::sync::Arc;

use crate::open_flight::OpenFlight;
use crate::render::BesideCloud;
use crate::surface::Surface;

/// The colours of the first ones.
const COLORS: [[u8; 3]; 5] = [
    [230, 126, 34],
    [52, 152, 219],
    [155, 89, 182],
    [26, 188, 156],
    [241, 196, 15],
];

/// A cloud beside the surface.
#[derive(Debug)]
pub struct Beside {
    /// Counted, to tell it from others.
    pub number: usize,
    /// Its file.
    pub path: PathBuf,
    /// Its points, in the flight's world.
    pub surface: Arc<Surface>,
    /// Whether it is drawn.
    pub is_shown: bool,
    /// Its one colour; `None` has the file's own.
    pub color: Option<[u8; 3]>,
    /// On the graphics device, with the colour that it has there.
    pub uploaded: Option<(Option<[u8; 3]>, Arc<BesideCloud>)>,
}

impl Beside {
    /// What it is called in the list.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or(self.path.as_os_str());
        name.to_string_lossy().into_owned()
    }
}

/// Something to do with them; the first number is the place in the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BesideStep {
    /// Draws it or not.
    Show(usize, bool),
    /// Draws it in one colour, or in its file's own.
    Color(usize, Option<[u8; 3]>),
    /// Takes it away.
    Remove(usize),
}

impl OpenFlight {
    /// Does something with the clouds beside the surface.
    pub(crate) fn beside_step(&mut self, step: BesideStep) {
        match step {
            BesideStep::Show(place, shown) => {
                if let Some(beside) = self.beside.get_mut(place) {
                    beside.is_shown = shown;
                }
            }
            BesideStep::Color(place, color) => {
                if let Some(beside) = self.beside.get_mut(place) {
                    beside.color = color;
                }
            }
            BesideStep::Remove(place) => {
                if place < self.beside.len() {
                    self.beside.remove(place);
                }
            }
        }
    }

    /// Adds a cloud that was read.
    pub(crate) fn add_beside(&mut self, path: PathBuf, surface: Arc<Surface>) {
        let number = self.beside.iter().map(|beside| beside.number + 1).max();
        let number = number.unwrap_or(0);
        self.beside.push(Beside {
            number,
            path,
            surface,
            is_shown: true,
            color: Some(COLORS[number % COLORS.len()]),
            uploaded: None,
        });
    }

    /// Those that are drawn and uploaded.
    pub(crate) fn shown_beside(&self) -> Vec<Arc<BesideCloud>> {
        let shown = self.beside.iter().filter(|beside| beside.is_shown);
        shown
            .filter_map(|beside| Some(beside.uploaded.as_ref()?.1.clone()))
            .collect()
    }
}
