//! COLMAP (Schönberger & Frahm, "Structure-from-Motion Revisited", 2016), where it is installed: the
//! engine that others measure by.
//!
//! ```text
//! called    photos under names that its lists can hold
//! program   the program on the path, run with progress and cancelled with all that it started
//! options   which of a command's options this version has
//! log       how far it is, from what it prints
//! ```
//!
//! Tried with 3.8; 3.9 to 4 name some options otherwise, which `options` looks up in the command's own
//! help. Pairs are ours (`pairs`), as its own exhaustive matching takes minutes of processor for 26 photos.
//! Its database stays in the folder of unfinished work, so that a second run goes on where the first was cut
//! off. Its mapper knows no positions: they come in afterwards, as with every engine (`adjusted`).

mod called;
mod log;
mod options;
mod program;
mod setting;
#[cfg(test)]
#[cfg(unix)]
mod tests;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use cumulus3d_core::Reconstruction;
use rayon::prelude::*;

use self::called::Called;
use self::options::Options;
use self::program::Program;
use self::setting::Setting;
use crate::adjusted::{guarded, in_order, read, too_little_in_common};
use crate::camera::Camera;
use crate::engine::{Engine, Found, Workplace};
use crate::fault::Fault;
use crate::files::{self, Inputs, Kind};
use crate::jobs::Progress;
use crate::photo_set::{LeftOut, PhotoSet, SurveyCamera, SurveyPhoto};

/// COLMAP as an engine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Colmap {
    program: Program,
}

/// The command that finds features.
const EXTRACTOR: &str = "feature_extractor";
/// Its database, in the folder of unfinished work.
const DATABASE: &str = "database.db";
/// Pairs that are compared between two looks how far it is: half a minute of processor with 12 000 features a photo, and a run
/// that is cut off loses no more. To start COLMAP and to read their features anew takes a second.
const PAIRS_AT_ONCE: usize = 16;

impl Colmap {
    /// The COLMAP on the path.
    ///
    /// # Errors
    /// Where there is none, or where it does not start.
    pub fn on_path() -> Result<Self, Fault> {
        let program = Program::on_path()?;
        Ok(Self { program })
    }
}

impl Engine for Colmap {
    fn name(&self) -> String {
        self.program.version.clone()
    }

    fn reconstruct(
        &self,
        photos: &PhotoSet,
        pairs: &[[usize; 2]],
        at: &Workplace,
        progress: &Progress,
    ) -> Result<Found, Fault> {
        let broken = broken(photos, progress)?;
        let Called { names, folder } = Called::of(photos, at.folder)?;
        let run = Run {
            broken,
            program: &self.program,
            photos,
            called: names,
            folder,
            database: at.folder.join(DATABASE),
            work: at.folder,
            progress,
        };
        run.features()?;
        let is_whole = |pair: &&[usize; 2]| pair.iter().all(|&at| run.broken[at].is_none());
        run.matches(&pairs.iter().filter(is_whole).copied().collect::<Vec<_>>())?;
        let model = run.largest_model()?;
        Ok(Found {
            model: run.read(&model)?,
            left_out: run.left_out(),
        })
    }
}

/// One reconstruction.
struct Run<'a> {
    program: &'a Program,
    photos: &'a PhotoSet,
    /// Of each photo: why it cannot be read.
    broken: Vec<Option<String>>,
    /// Of each photo: its name in `folder`.
    called: Vec<String>,
    folder: PathBuf,
    database: PathBuf,
    work: &'a Path,
    progress: &'a Progress,
}

impl Run<'_> {
    /// SIFT of all photos; a camera's photos share its intrinsics.
    fn features(&self) -> Result<(), Fault> {
        let options = Options::of(self.program, EXTRACTOR)?;
        self.progress.stage("COLMAP: features of photos");
        self.cameras(&options)?;
        let count = self.photos.photos.len() as u64;
        let mut done = 0;
        for (id, number) in (1..).zip(self.seen_cameras()) {
            let names = self.names(number);
            let its = Setting::text("ImageReader.existing_camera_id", id.to_string());
            let said = |line: &str| {
                if let Some((at, _)) = log::of_total(line) {
                    let _ = self.progress.advance(done + at, count);
                }
            };
            self.extract(&options, number, &names, [its], said)?;
            done += names.len() as u64;
        }
        Ok(())
    }

    /// The database with the cameras, numbered from 1 in their order. COLMAP makes a camera with the first of its photos
    /// that has no features yet: a run that goes on would give the rest of the photos a second one.
    fn cameras(&self, options: &Options) -> Result<(), Fault> {
        let whole = self.work.join("cameras-made.txt");
        if whole.exists() {
            return Ok(());
        }
        // Of a run that was cut off before: which cameras it made nobody knows.
        for end in ["", "-wal", "-shm"] {
            let _ = fs::remove_file(self.work.join(format!("{DATABASE}{end}")));
        }
        for number in self.seen_cameras() {
            let first = self.names(number).into_iter().take(1);
            let first: Vec<&str> = first.collect();
            let mut settings = vec![
                Setting::text("ImageReader.single_camera", "1"),
                Setting::text("ImageReader.camera_model", "OPENCV"),
            ];
            if let Some(intrinsics) = intrinsics(&self.photos.cameras[number]) {
                settings.push(Setting::text("ImageReader.camera_params", intrinsics));
            }
            self.extract(options, number, &first, settings, |_| ())?;
        }
        self.write(&whole, "")
    }

    /// SIFT of photos of a camera.
    fn extract(
        &self,
        options: &Options,
        camera: usize,
        names: &[&str],
        of_camera: impl IntoIterator<Item = Setting>,
        said: impl FnMut(&str),
    ) -> Result<(), Fault> {
        let list = self.work.join(format!("camera-{camera}.txt"));
        self.write(&list, &(names.join("\n") + "\n"))?;
        let mut settings = vec![
            Setting::path("database_path", &self.database),
            Setting::path("image_path", &self.folder),
            Setting::path("image_list_path", &list),
        ];
        settings.extend(of_camera);
        settings.extend(options.use_gpu("Extraction", self.program.has_cuda));
        (self.program).run(EXTRACTOR, &settings, said, self.progress)
    }

    /// Cameras of which a photo can be read.
    fn seen_cameras(&self) -> impl Iterator<Item = usize> {
        let all = 0..self.photos.cameras.len();
        all.filter(|&camera| !self.names(camera).is_empty())
    }

    /// The photos of a camera that can be read.
    fn names(&self, camera: usize) -> Vec<&str> {
        let its = self.photos.photos.iter().zip(&self.broken);
        let its = its.zip(&self.called);
        its.filter(|((photo, broken), _)| photo.camera == camera && broken.is_none())
            .map(|(_, called)| called.as_str())
            .collect()
    }

    fn left_out(&self) -> Vec<LeftOut> {
        let photos = self.photos.photos.iter().zip(&self.broken);
        let broken = photos.filter_map(|(photo, why)| {
            Some(LeftOut {
                photo: photo.name.clone(),
                why: why.clone()?,
            })
        });
        broken.collect()
    }

    /// Matches of the pairs that may show the same. COLMAP writes them into the database when it has all of a list, and
    /// says nothing before: so it gets short ones.
    fn matches(&self, pairs: &[[usize; 2]]) -> Result<(), Fault> {
        let command = "matches_importer";
        let options = Options::of(self.program, command)?;
        let name = |at: usize| self.called[at].as_str();
        let list = self.work.join("pairs.txt");
        let mut settings = vec![
            Setting::path("database_path", &self.database),
            Setting::path("match_list_path", &list),
            Setting::text("match_type", "pairs"),
        ];
        settings.extend(options.use_gpu("Matching", self.program.has_cuda));
        let count = pairs.len() as u64;
        (self.progress).stage(format!("COLMAP: matches of {count} pairs of photos"));
        let mut done = 0;
        for some in pairs.chunks(PAIRS_AT_ONCE) {
            self.progress.advance(done, count)?;
            let lines = some.iter();
            let lines = lines.map(|&[a, b]| format!("{} {}\n", name(a), name(b)));
            self.write(&list, &lines.collect::<String>())?;
            (self.program).run(command, &settings, |_| (), self.progress)?;
            done += some.len() as u64;
        }
        Ok(())
    }

    /// The folder of the model that holds most photos.
    fn largest_model(&self) -> Result<PathBuf, Fault> {
        let models = self.work.join("models");
        // Of a run that was cut off: a model is made in one go.
        let _ = fs::remove_dir_all(&models);
        fs::create_dir_all(&models).map_err(|error| cannot_write(&models, &error))?;
        let settings = [
            Setting::path("database_path", &self.database),
            Setting::path("image_path", &self.folder),
            Setting::path("output_path", &models),
            // They are taken from the photos for every engine alike.
            Setting::text("Mapper.extract_colors", "0"),
        ];
        self.progress.stage("COLMAP: poses and points");
        let count = self.photos.photos.len() as u64;
        let mut finds_nothing = false;
        let said = |line: &str| {
            finds_nothing |= log::finds_nothing(line);
            if let Some(registered) = log::registered(line) {
                let _ = self.progress.advance(registered, count);
            }
        };
        let run = (self.program).run("mapper", &settings, said, self.progress);
        if finds_nothing {
            return Err(too_little_in_common());
        }
        run?;
        let found = fs::read_dir(&models).map_err(|error| cannot_write(&models, &error))?;
        let mut sizes: Vec<(u64, PathBuf)> = found
            .filter_map(|entry| {
                let path = entry.ok()?.path();
                let size = fs::metadata(path.join("images.bin")).ok()?.len();
                Some((size, path))
            })
            .collect();
        // Of equal ones the first; files of images are as long as they have observations.
        sizes.sort_by(|a, b| b.0.cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
        let largest = sizes.into_iter().next().map(|(_, path)| path);
        largest.ok_or_else(too_little_in_common)
    }

    /// A model by way of its text, which all versions write alike.
    fn read(&self, model: &Path) -> Result<Reconstruction, Fault> {
        // A folder of its own: files of rigs beside it, of another writer, would be read with it.
        let text = self.work.join("colmap-text");
        fs::create_dir_all(&text).map_err(|error| cannot_write(&text, &error))?;
        let settings = [
            Setting::path("input_path", model),
            Setting::path("output_path", &text),
            Setting::text("output_type", "TXT"),
        ];
        (self.program).run("model_converter", &settings, |_| (), self.progress)?;
        guarded(|| {
            let model = read(&text, &self.program.version)?;
            in_order(&model, self.photos, &self.called)
        })
    }

    fn write(&self, path: &Path, text: &str) -> Result<(), Fault> {
        files::write(
            path,
            text.as_bytes(),
            Kind::Result,
            &Inputs::default(),
            true,
        )
    }
}

fn cannot_write(path: &Path, error: &io::Error) -> Fault {
    let what = format!("{} cannot be written ({error})", path.display());
    Fault::new(what, "make room on the disk")
}

/// Of each photo why it cannot be read: COLMAP takes what is there of a file that was cut off.
fn broken(photos: &PhotoSet, progress: &Progress) -> Result<Vec<Option<String>>, Fault> {
    progress.stage("reading the photos");
    progress.advance(0, 1)?;
    let why = |photo: &SurveyPhoto| {
        // What is asked of a photo after that is not used.
        if progress.is_cancelled() {
            return None;
        }
        photo.pixels(&photos.cameras[photo.camera].camera).err()
    };
    let broken = photos.photos.par_iter().map(why).collect();
    progress.advance(1, 1)?;
    Ok(broken)
}

/// fx, fy, cx, cy, k1, k2, p1, p2 where the photos state a focal length: COLMAP then begins with it. (Of
/// the lens photos say nothing.)
fn intrinsics(camera: &SurveyCamera) -> Option<String> {
    camera.focal_error?;
    let Camera { fx, fy, cx, cy, .. } = camera.camera;
    Some(format!("{fx},{fy},{cx},{cy},0,0,0,0"))
}
