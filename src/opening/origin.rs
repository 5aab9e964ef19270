//! Where an opened flight came from, and the text that saves it, here or elsewhere.

use std::ffi::OsStr;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::fault::Fault;
use crate::files::{FileError, read_text};
use crate::flight::{FlightFile, FlightSettings, ReconstructionFlight};

/// Where an opened flight came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlightOrigin {
    /// The flight.toml, or the reconstruction that was opened directly.
    pub(crate) path: PathBuf,
    /// Which of the two.
    pub(crate) is_flight_file: bool,
    /// Whether the surface or the folder of the image files are others than it names.
    pub(crate) is_changed: bool,
    /// The flight's name.
    pub(crate) name: String,
    /// The folder of the image files, if any.
    pub(crate) photo_folder: Option<PathBuf>,
    /// The surface's file; `None` for the reconstruction's own points.
    pub(crate) surface: Option<PathBuf>,
    /// Whether it is a cloud or mesh without photos.
    pub(crate) is_surface: bool,
}

impl FlightOrigin {
    /// The flight.toml that the flight came from, or `None` where it was a reconstruction.
    pub fn flight_file(&self) -> Option<&Path> {
        self.is_flight_file.then_some(self.path.as_path())
    }

    /// The file or folder that the flight is of: its flight.toml, or a reconstruction.
    pub fn file(&self) -> &Path {
        &self.path
    }

    /// Whether the flight has another surface or other photos than its flight.toml names.
    pub fn has_other_files(&self) -> bool {
        self.is_flight_file && self.is_changed
    }

    /// The folder of the image files, if any.
    pub fn photo_folder(&self) -> Option<&Path> {
        self.photo_folder.as_deref()
    }

    /// The surface's file; `None` for the reconstruction's own points.
    pub fn surface(&self) -> Option<&Path> {
        self.surface.as_deref()
    }

    /// Whether it is a cloud or mesh without photos: no flight yet, so that it is saved only with a plan of one.
    pub fn is_surface_alone(&self) -> bool {
        self.is_surface
    }

    /// Whether it is such a cloud or mesh, and in no flight's file either.
    pub fn is_surface_in_no_flight(&self) -> bool {
        self.is_surface && !self.is_flight_file
    }

    /// Where to save it, if nobody says otherwise: in the flight.toml that it came from, or beside the
    /// reconstruction as NAME.toml.
    pub fn suggested_file(&self) -> PathBuf {
        if self.is_flight_file {
            return self.path.clone();
        }
        // Of "." or "sparse/.." the parent is known only when the links are followed.
        let beside = real(&self.path);
        let name: String = self
            .name
            .chars()
            .map(|c| {
                if c.is_control() || "/\\:*?\"<>|".contains(c) {
                    '-'
                } else {
                    c
                }
            })
            .collect();
        beside
            .parent()
            .unwrap_or(Path::new(""))
            .join(format!("{name}.toml"))
    }

    /// Whether there is something to be saved as a flight.
    ///
    /// # Errors
    /// Where it is a cloud, without photos and without the plan of a flight.
    pub fn check_saved(&self, settings: &FlightSettings) -> Result<(), Fault> {
        if self.is_surface && settings.plan.is_none() {
            return Err(Fault::new(
                "a cloud without photos makes no flight",
                "add its cameras first, or plan a flight over it",
            ));
        }
        Ok(())
    }

    /// The text of a flight.toml at `target` with these settings. Where the flight came from a
    /// flight.toml, its comments and layout stay; its paths, and those of a reconstruction, are
    /// written relative to `target`.
    ///
    /// Write it with `files::write`.
    ///
    /// # Errors
    /// Where the flight.toml cannot be read any more, the folder of `target` does not exist, a path is
    /// not Unicode, or `target` would hide the reconstruction that it names.
    pub fn text_at(&self, target: &Path, settings: &FlightSettings) -> Result<String, FileError> {
        let at_target = |fault| FileError::new(target, fault);
        self.check_saved(settings).map_err(at_target)?;
        let folder = fs::canonicalize(folder_of(target)).map_err(|e| {
            let what = format!("its folder cannot be found ({e})");
            at_target(Fault::new(what, "choose a folder that exists"))
        })?;
        if self.is_flight_file {
            let at_source = |fault| FileError::new(&self.path, fault);
            let text = read_text(&self.path)?;
            let old_folder = folder_of(&self.path);
            // Before the settings: which axis is up is said of the file that is named then.
            let text = match self.is_changed {
                true => self
                    .with_other_files(&text, old_folder)
                    .map_err(at_source)?,
                false => text,
            };
            let text = FlightFile::text_with_settings(&text, settings).map_err(at_source)?;
            if real(old_folder) == folder {
                return Ok(text);
            }
            let moved = |path: &str| match Path::new(path).is_absolute() {
                true => Ok(path.to_owned()),
                false => path_from(&folder, &old_folder.join(path)),
            };
            return FlightFile::text_with_paths(&text, moved).map_err(at_source);
        }
        // A folder is opened as the flight.toml that lies in it.
        if target.file_name().is_some_and(|name| name == "flight.toml")
            && real(&self.path) == folder
        {
            return Err(at_target(Fault::new(
                "a flight.toml in the folder of the reconstruction would be opened in its stead",
                "give the file another name or another folder",
            )));
        }
        let path = |path: &Path| path_from(&folder, path).map_err(at_target);
        if self.is_surface {
            let surface = path(self.surface.as_deref().unwrap_or(&self.path))?;
            return FlightFile::for_surface(&self.name, &surface, settings)
                .to_toml()
                .map_err(at_target);
        }
        let reconstruction = path(&self.path)?;
        let photos = self.photo_folder.as_deref().map(path).transpose()?;
        let surface = self.surface.as_deref().map(path).transpose()?;
        let flight = ReconstructionFlight {
            name: &self.name,
            reconstruction: &reconstruction,
            folder: photos.as_deref(),
            surface: surface.as_deref(),
            ..ReconstructionFlight::default()
        };
        FlightFile::for_reconstruction(&flight, settings)
            .to_toml()
            .map_err(at_target)
    }

    /// The text of the flight.toml in `folder` with the surface and the photos of now.
    fn with_other_files(&self, text: &str, folder: &Path) -> Result<String, Fault> {
        let folder = real(folder);
        let path = |path: &Option<PathBuf>| {
            let path = path.as_deref();
            path.map(|path| path_from(&folder, path)).transpose()
        };
        let (surface, photos) = (path(&self.surface)?, path(&self.photo_folder)?);
        FlightFile::text_with_files(text, surface.as_deref(), photos.as_deref())
    }

    /// The same flight once it was saved at `target`.
    #[must_use]
    pub fn saved_at(&self, target: &Path) -> Self {
        Self {
            path: target.to_owned(),
            is_flight_file: true,
            is_changed: false,
            ..self.clone()
        }
    }
}

/// The folder that a file is in.
pub(crate) fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A path from the root with its links followed, as far as it exists.
pub(crate) fn real(path: &Path) -> PathBuf {
    fs::canonicalize(path)
        .or_else(|_| std::path::absolute(path))
        .unwrap_or_else(|_| path.to_owned())
}

/// How a file in `folder` (canonical) names `path`: with slashes, relative where the two have more
/// than the root in common.
///
/// # Errors
/// Where it is not Unicode.
pub fn path_from(folder: &Path, path: &Path) -> Result<String, Fault> {
    let path = real(path);
    let text = |part: &OsStr| {
        part.to_str().map(str::to_owned).ok_or_else(|| {
            let what = format!("the path {} is not Unicode", path.display());
            Fault::new(what, "rename it")
        })
    };
    let shared = folder
        .components()
        .zip(path.components())
        .take_while(|(a, b)| a == b);
    let (mut depth, mut in_common) = (0, false);
    for (component, _) in shared {
        depth += 1;
        in_common |= matches!(component, Component::Normal(_));
    }
    if !in_common {
        return text(path.as_os_str());
    }
    let mut parts = vec!["..".to_owned(); folder.components().count() - depth];
    for component in path.components().skip(depth) {
        parts.push(text(component.as_os_str())?);
    }
    Ok(if parts.is_empty() {
        ".".to_owned()
    } else {
        parts.join("/")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jobs::Progress;
    use crate::scale::Ground;
    use crate::{OpenOptions, Opened, open_flight};

    fn open(path: &Path) -> Opened {
        open_flight(path, &OpenOptions::default(), &Progress::default()).unwrap()
    }

    fn scales(opened: &Opened) -> String {
        format!("{:?}", opened.flight.scales(&Progress::default()).unwrap())
    }

    fn fixture(name: &str) -> PathBuf {
        fragscale_test_data::repository()
            .join("tests/fixtures")
            .join(name)
    }

    #[test]
    fn paths_lead_from_the_folder_to_the_file() {
        let root = tempfile::tempdir().unwrap();
        let root = fs::canonicalize(root.path()).unwrap();
        fs::create_dir_all(root.join("a/b")).unwrap();
        let from = |folder: &str, path: &str| path_from(&root.join(folder), &root.join(path));
        assert_eq!(from("a", "a/b").as_deref(), Ok("b"));
        assert_eq!(from("a/b", "c.ply").as_deref(), Ok("../../c.ply"));
        assert_eq!(from("a/b", "a/b").as_deref(), Ok("."));
        assert_eq!(
            from("a", "a/b/../x").as_deref().map(|p| p.ends_with('x')),
            Ok(true)
        );
        // Nothing but the root in common.
        let elsewhere = path_from(&root, Path::new("/nowhere/c.ply"));
        #[cfg(unix)]
        assert_eq!(elsewhere.as_deref(), Ok("/nowhere/c.ply"));
    }

    /// A copy of a flight in another folder opens with the same scales, and keeps its comments.
    #[test]
    fn a_flight_saved_elsewhere_is_the_same_flight() {
        let sample = fragscale_test_data::repository().join("assets/sample/flight.toml");
        let opened = open(&sample);
        assert_eq!(opened.origin.flight_file(), Some(sample.as_path()));
        let there = tempfile::tempdir().unwrap();
        let target = there.path().join("copy.toml");
        let mut settings = opened.settings.clone();
        settings.ground = Ground::At(0.125);
        let text = opened.origin.text_at(&target, &settings).unwrap();
        fs::write(&target, text).unwrap();
        let copy = open(&target);
        assert_eq!(copy.settings, settings);
        assert_eq!(
            scales(&copy),
            scales(&Opened {
                flight: opened.flight.with_settings(&settings).unwrap().into(),
                ..open(&sample)
            })
        );
        assert_eq!(copy.photo_files.len(), opened.photo_files.len());
        assert!(copy.photo_files.iter().all(|file| file.path.is_some()));
        // Where it came from, nothing but the settings changes.
        let text = opened.origin.text_at(&sample, &opened.settings).unwrap();
        assert_eq!(text, fs::read_to_string(&sample).unwrap());
    }

    #[test]
    fn a_reconstruction_is_saved_beside_itself() {
        // COLMAP writes image sizes; VisualSFM's are those of the photos beside the file.
        for (parts, model) in [
            (&["colmap-text-points/sparse/0"][..], ""),
            (
                &["nvm-points-photos", "nvm-points-photos/my photos"],
                "model.nvm",
            ),
        ] {
            let copy = tempfile::tempdir().unwrap();
            let folder = copy.path().join("model");
            fs::create_dir(&folder).unwrap();
            for part in parts {
                for entry in fs::read_dir(fixture(part)).unwrap() {
                    let file = entry.unwrap().path();
                    if file.is_file() && file.extension().is_some_and(|e| e != "toml") {
                        fs::copy(&file, folder.join(file.file_name().unwrap())).unwrap();
                    }
                }
            }
            let reconstruction = folder.join(model);
            let opened = open(&reconstruction);
            assert_eq!(opened.origin.flight_file(), None);
            let target = opened.origin.suggested_file();
            assert_eq!(target.parent(), real(&reconstruction).parent());
            let text = opened.origin.text_at(&target, &opened.settings).unwrap();
            fs::write(&target, &text).unwrap();
            let saved = open(&target);
            assert_eq!(scales(&saved), scales(&opened), "{text}");
            let found = |opened: &Opened| {
                let files = opened.photo_files.iter();
                files.filter(|file| file.path.is_some()).count()
            };
            assert_eq!(found(&saved), found(&opened), "{text}");
            let again = opened.origin.saved_at(&target);
            assert_eq!(again.text_at(&target, &saved.settings), Ok(text));
            // Inside its folder it would stand in for it.
            let inside = folder.join("flight.toml");
            let refused = opened.origin.text_at(&inside, &opened.settings);
            assert_eq!(refused.is_err(), model.is_empty());
        }
    }

    /// A surface in a flight's file needs photos, or the plan of a flight: then it is opened by who can do without photos.
    #[test]
    fn a_surface_with_the_plan_of_a_flight_may_lack_photos() {
        let folder = tempfile::tempdir().unwrap();
        let cloud = folder.path().join("pile.xyz");
        fs::write(&cloud, "0 0 0\n9 0 0\n0 9 1\n9 9 2\n").unwrap();
        let target = folder.path().join("plan.toml");
        let open = |path: &Path, may_lack_photos| {
            let options = OpenOptions {
                may_lack_photos,
                ..OpenOptions::default()
            };
            open_flight(path, &options, &Progress::default())
        };
        let opened = open(&cloud, true).unwrap();
        let refused = opened.origin.text_at(&target, &opened.settings);
        assert!(refused.unwrap_err().to_string().contains("makes no flight"));
        let text = "format = 1\nworld.unit = \"m\"\nsurface.file = \"pile.xyz\"\n[plan]\npattern = \"slope\"\nscale = 30\nclearance = 6\n";
        fs::write(&target, text).unwrap();
        let planned = open(&target, true).unwrap();
        assert!(planned.origin.is_surface_alone());
        assert_eq!(planned.flight.parts().photos.len(), 0);
        assert_eq!(
            planned
                .origin
                .text_at(&target, &planned.settings)
                .as_deref(),
            Ok(text)
        );
        // As the window saves it the first time.
        let first = opened.origin.text_at(&target, &planned.settings).unwrap();
        let (of_first, of_text) = (FlightFile::parse(&first), FlightFile::parse(text));
        assert_eq!(of_first.unwrap().settings(), of_text.unwrap().settings());
        let refused = open(&target, false).unwrap_err().to_string();
        assert!(refused.ends_with(
            "plan.toml: it plans a flight over a surface, and has no photos yet; name the flight's photos in it"
        ), "{refused}");
        // Without a plan, or with a folder of photos alone, something was forgotten.
        let no_plan = text.split("[plan]").next().unwrap();
        for forgotten in [
            no_plan.to_owned(),
            format!("{text}[photos]\nfolder = \"photos\"\n"),
        ] {
            fs::write(&target, &forgotten).unwrap();
            let refused = open(&target, true).unwrap_err().to_string();
            assert!(
                refused.contains("photos has neither poses nor reconstruction"),
                "{refused}"
            );
        }
    }
}
