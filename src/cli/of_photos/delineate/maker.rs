//! One photo: outlined, measured, and its files.

use std::path::PathBuf;

use image::RgbImage;

use super::DelineateArguments;
use super::chosen_engine::ChosenEngine;
use super::unfinished::KeptPhoto;
use crate::delineation::mass::PhotoFragments;
use crate::delineation::{Engine, LabelImage, OutlinedBy, delineate as outline, photo};
use crate::exports::{MapPlaces, PhotoOutlined};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::opening::{Opened, OutlinesOfOthers, read_outlines, saved_outlines};
use crate::picture::edge_spread;
use crate::units::LengthUnit;

/// What all photos of a flight are outlined by.
pub(super) struct Maker<'a> {
    pub(super) arguments: &'a DelineateArguments,
    /// Of photos whose outlines are neither saved nor another tool's.
    pub(super) engine: &'a dyn Engine,
    pub(super) opened: &'a Opened,
    /// Outlines in place of an engine's.
    pub(super) others: Option<&'a OutlinesOfOthers>,
    /// Whether one photo alone is asked for.
    pub(super) is_only: bool,
    /// What the files of each photo are called.
    pub(super) stems: &'a [String],
    /// How places of the world are written.
    pub(super) places: &'a MapPlaces,
    /// Of the world, and of what is written.
    pub(super) units: [LengthUnit; 2],
    pub(super) progress: &'a Progress,
}

/// A photo's files and fragments.
pub(super) struct Made<'a> {
    /// Label image, outlines over the photo and in the world.
    pub(super) files: [Vec<u8>; 3],
    pub(super) labels: LabelImage,
    pub(super) fragments: PhotoFragments,
    pub(super) outlined: OutlinedBy<'a>,
    pub(super) spread: Option<f64>,
    /// What was mended or left out.
    pub(super) notes: Vec<String>,
}

/// A photo's outlines, before they are measured.
struct Outlined<'a> {
    labels: LabelImage,
    by: OutlinedBy<'a>,
    /// How far the photo's edges are spread, pixels.
    spread: Option<f64>,
    notes: Vec<String>,
}

impl<'a> Maker<'a> {
    pub(super) fn make(&self, index: usize) -> Result<Made<'a>, Fault> {
        let flight = &self.opened.flight;
        let photo = &flight.parts().photos[index];
        let camera = flight.camera(photo);
        let image = photo::undistorted(&self.opened.pixels_of(index)?, camera)?;
        let left_out = photo::left_out(&self.opened.settings, photo, camera);
        let Outlined {
            labels,
            by,
            spread,
            mut notes,
        } = self.outlined(index, &image, &left_out)?;
        let of = PhotoOutlined {
            flight,
            index,
            pixels: &image,
            labels: &labels,
            by,
            spread,
            shape: self.arguments.shape.into(),
        };
        let measured = of.measured(self.places, self.units, self.progress)?;
        notes.extend(measured.notes);
        Ok(Made {
            files: measured.bytes,
            fragments: measured.fragments,
            labels,
            outlined: by,
            spread,
            notes,
        })
    }

    fn outlined(
        &self,
        index: usize,
        image: &RgbImage,
        left_out: &[bool],
    ) -> Result<Outlined<'a>, Fault> {
        let flight = &self.opened.flight;
        let photo = &flight.parts().photos[index];
        let camera = flight.camera(photo);
        let spread = edge_spread(image);
        if let Some(others) = self.others {
            let file = self.opened.photo_files.get(index);
            let of = (index, file.and_then(|file| file.path.as_deref()));
            let masks = others.of_flights_photo(flight, of, Some(image), left_out, self.is_only)?;
            return Ok(Outlined {
                labels: masks.labels,
                by: OutlinedBy::Masks,
                spread,
                notes: masks.notes,
            });
        }
        if let Some(files) = self.saved_of(index) {
            let file = self.opened.photo_files.get(index);
            let file = file.and_then(|file| file.path.as_deref());
            let read = read_outlines(&files, &photo.name, camera, file);
            let read =
                read.map_err(|error| Fault::new(error.to_string(), "or say --engine learned"))?;
            let by = OutlinedBy::Saved(read.by.habits);
            let (mut labels, mut notes) = (read.outlines.into_labels(), read.notes);
            let settings = &self.opened.settings;
            let taken_off = photo::take_off_objects(&mut labels, settings, photo, camera);
            notes.extend(taken_off.note);
            return Ok(Outlined {
                labels,
                by,
                spread,
                notes,
            });
        }
        let by = OutlinedBy::engine(self.engine, camera.width, camera.height);
        let labels = outline(self.engine, image, left_out, self.progress)?;
        Ok(Outlined {
            labels,
            by,
            spread,
            notes: Vec::new(),
        })
    }

    /// All that a photo's outlines rest on besides the flight.
    pub(super) fn files_of(&self, index: usize) -> Vec<PathBuf> {
        let photo = self.opened.photo_files.get(index);
        let photo = photo.and_then(|file| file.path.clone());
        let saved = self.saved_of(index).into_iter().flatten();
        photo.into_iter().chain(saved).collect()
    }

    /// What outlined a photo that was kept; `None` where that is not known any more.
    pub(super) fn outlined_by(&self, kept: &KeptPhoto) -> Option<OutlinedBy<'_>> {
        match kept.is_saved {
            true => Some(OutlinedBy::Saved(kept.habits)),
            false if kept.engine == self.engine.name() => Some(OutlinedBy::Engine {
                name: self.engine.name(),
                habits: kept.habits?,
            }),
            false => None,
        }
    }

    /// The files of a photo's saved outlines, where those are to be taken.
    fn saved_of(&self, index: usize) -> Option<[PathBuf; 2]> {
        match self.arguments.engine {
            None | Some(ChosenEngine::Saved) => saved_files(self.opened, self.stems.get(index)?),
            Some(_) => None,
        }
    }
}

/// The files of a photo's saved outlines, where there are any.
pub(super) fn saved_files(opened: &Opened, stem: &str) -> Option<[PathBuf; 2]> {
    let (flight_file, _) = opened.file.as_ref()?;
    saved_outlines(flight_file, stem)
}
