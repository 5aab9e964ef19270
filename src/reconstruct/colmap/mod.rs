//! COLMAP (Schönberger & Frahm, "Structure-from-Motion Revisited", 2016), where it is installed: the
//! engine that others measure by.
//!
//! ```text
//! program   the program on the path, run with progress and cancelled with all that it started
//! options   which of a command's options this version has
//! log       how far it is, from what it prints
//! ```
//!
//! Tried with 3.8; 3.9 to 4 name some options otherwise, which `options` looks up in the command's own
//! help. Pairs are ours (`pairs`), as its own exhaustive matching takes minutes of processor for 26 photos.
//! Its database stays in the folder of unfinished work, so that a second run goes on where the first was cut
//! off. Its model has a frame of its own: positions come in afterwards, by georeferencing.

mod log;
mod options;
mod program;
#[cfg(test)]
#[cfg(unix)]
mod tests;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use self::options::{Options, Setting};
use self::program::Program;
use crate::camera::Camera;
use crate::engine::{Engine, Sparse};
use crate::fault::Fault;
use crate::files::{self, Inputs, Kind};
use crate::jobs::Progress;
use crate::photo_set::{LeftOut, PhotoSet, SurveyCamera};

/// COLMAP as an engine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Colmap {
    program: Program,
}

const FILES: [&str; 3] = ["cameras.txt", "images.txt", "points3D.txt"];

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
        work: &Path,
        progress: &Progress,
    ) -> Result<Sparse, Fault> {
        let blank = |name: &str| name.contains(char::is_whitespace);
        if let Some(photo) = photos.photos.iter().find(|photo| blank(&photo.name)) {
            let what = format!(
                "COLMAP's list of pairs cannot name '{}': blanks end a name there",
                photo.name
            );
            return Err(Fault::new(what, "rename it, or take the embedded engine"));
        }
        let run = Run {
            program: &self.program,
            photos,
            folder: photos_folder(photos),
            database: work.join("database.db"),
            work,
            progress,
        };
        run.features()?;
        run.matches(pairs)?;
        let model = run.largest_model()?;
        let files = run.text_of(&model)?;
        let left_out = missing(photos, &files[1].1);
        Ok(Sparse { files, left_out })
    }
}

/// One reconstruction.
struct Run<'a> {
    program: &'a Program,
    photos: &'a PhotoSet,
    folder: PathBuf,
    database: PathBuf,
    work: &'a Path,
    progress: &'a Progress,
}

impl Run<'_> {
    /// SIFT of all photos; a camera's photos share its intrinsics.
    fn features(&self) -> Result<(), Fault> {
        let command = "feature_extractor";
        let options = Options::of(self.program, command)?;
        let count = self.photos.photos.len() as u64;
        let mut done = 0;
        for (number, camera) in self.photos.cameras.iter().enumerate() {
            let names = self.photos.photos.iter();
            let names = names.filter(|photo| photo.camera == number);
            let names: Vec<&str> = names.map(|photo| photo.name.as_str()).collect();
            let list = self.work.join(format!("camera-{number}.txt"));
            self.write(&list, &(names.join("\n") + "\n"))?;
            let mut settings = vec![
                Setting::path("database_path", &self.database),
                Setting::path("image_path", &self.folder),
                Setting::path("image_list_path", &list),
                Setting::text("ImageReader.single_camera", "1"),
                Setting::text("ImageReader.camera_model", "OPENCV"),
            ];
            if let Some(intrinsics) = intrinsics(camera) {
                settings.push(Setting::text("ImageReader.camera_params", intrinsics));
            }
            settings.extend(options.use_gpu("Extraction", self.program.has_cuda));
            self.progress.stage("COLMAP: features of photos");
            let said = |line: &str| {
                if let Some((at, _)) = log::of_total(line) {
                    let _ = self.progress.advance(done + at, count);
                }
            };
            (self.program).run(command, &settings, said, self.progress)?;
            done += names.len() as u64;
        }
        Ok(())
    }

    /// Matches of the pairs that may show the same.
    fn matches(&self, pairs: &[[usize; 2]]) -> Result<(), Fault> {
        let command = "matches_importer";
        let options = Options::of(self.program, command)?;
        let name = |at: usize| self.photos.photos[at].name.as_str();
        let lines = pairs
            .iter()
            .map(|&[a, b]| format!("{} {}\n", name(a), name(b)));
        let list = self.work.join("pairs.txt");
        self.write(&list, &lines.collect::<String>())?;
        let mut settings = vec![
            Setting::path("database_path", &self.database),
            Setting::path("match_list_path", &list),
            Setting::text("match_type", "pairs"),
        ];
        settings.extend(options.use_gpu("Matching", self.program.has_cuda));
        self.progress.stage("COLMAP: matches of photos");
        let said = |line: &str| {
            if let Some((at, total)) = log::of_total(line) {
                // It says when it begins a block.
                let _ = self.progress.advance(at.saturating_sub(1), total);
            }
        };
        (self.program).run(command, &settings, said, self.progress)
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
        ];
        self.progress.stage("COLMAP: poses and points");
        let count = self.photos.photos.len() as u64;
        let said = |line: &str| {
            if let Some(registered) = log::registered(line) {
                let _ = self.progress.advance(registered, count);
            }
        };
        (self.program).run("mapper", &settings, said, self.progress)?;
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
        largest.ok_or_else(|| {
            Fault::new(
                "no two of the photos show enough of the same",
                "take photos that overlap by two thirds at least",
            )
        })
    }

    /// A model as text.
    fn text_of(&self, model: &Path) -> Result<[(&'static str, Vec<u8>); 3], Fault> {
        let text = self.work.join("model");
        fs::create_dir_all(&text).map_err(|error| cannot_write(&text, &error))?;
        let settings = [
            Setting::path("input_path", model),
            Setting::path("output_path", &text),
            Setting::text("output_type", "TXT"),
        ];
        (self.program).run("model_converter", &settings, |_| (), self.progress)?;
        let read = |name: &'static str| -> Result<_, Fault> {
            let bytes = fs::read(text.join(name));
            let bytes = bytes.map_err(|error| {
                let what = format!("COLMAP wrote no {name} ({error})");
                Fault::new(what, "report this with the version of COLMAP")
            })?;
            Ok((name, bytes))
        };
        Ok([read(FILES[0])?, read(FILES[1])?, read(FILES[2])?])
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

fn photos_folder(photos: &PhotoSet) -> PathBuf {
    let parent = photos.photos.first().and_then(|photo| photo.path.parent());
    parent.unwrap_or_else(|| Path::new(".")).to_owned()
}

/// fx, fy, cx, cy, k1, k2, p1, p2 where the photos state a focal length: COLMAP then begins with it. (Of
/// the lens photos say nothing.)
fn intrinsics(camera: &SurveyCamera) -> Option<String> {
    camera.focal_error?;
    let Camera { fx, fy, cx, cy, .. } = camera.camera;
    Some(format!("{fx},{fy},{cx},{cy},0,0,0,0"))
}

/// Photos that a model's images.txt does not name.
fn missing(photos: &PhotoSet, images: &[u8]) -> Vec<LeftOut> {
    let text = String::from_utf8_lossy(images);
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    // A line of the pose, the name its last word, and one of observations in turn.
    let names: Vec<&str> = lines
        .step_by(2)
        .filter_map(|line| line.splitn(10, ' ').nth(9))
        .collect();
    let is_missing = |name: &str| !names.contains(&name);
    let photos = photos.photos.iter();
    photos
        .filter(|photo| is_missing(&photo.name))
        .map(|photo| LeftOut {
            photo: photo.name.clone(),
            why: "it shows too little of what the others show".to_owned(),
        })
        .collect()
}
