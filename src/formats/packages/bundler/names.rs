//! The photos' names of a Bundler file, which stand in a list beside it.
//!
//! | from | for |
//! |---|---|
//! | the file itself | v0.4 |
//! | `X.list.txt`, `X_list.txt` beside `X.out` or `X.bundle.out` (COLMAP and others) | that file |
//! | `X.out.list.txt` beside `X.out` (COLMAP's window) | that file |
//! | `list.rd.txt` beside `X.rd.out` (Bundler's undistorted photos) | that file |
//! | `list.txt` beside, or in the folder above (Bundler's own `bundle/` folder) | any |
//! | `prepare/list.txt` beside or in the folder above (`RunBundler.sh` copies it from there) | any |
//! | the image files beside, sorted by name | where there are as many as cameras, with a warning |
//! | the cameras' numbers from 0 | else, with a warning |
//!
//! A line of the list is a name, which may be followed by ` 0` and a focal length guessed from EXIF:
//! "./kermit000.jpg 0 660.80306". Sorting is what Bundler's own script does to make the list.

use std::fs;
use std::path::{Path, PathBuf};

use crate::fault::Fault;
use crate::files::{FileError, read_text};
use crate::photos::image_names::is_image;

/// Where Bundler's script makes the list, of photos in the folder above.
const PREPARE: &str = "prepare";

/// The names, or how to make them.
pub(super) struct Names {
    /// By the camera's index; empty where they are numbered.
    names: Vec<String>,
    /// The folder that the names are relative to.
    pub(super) folder: Option<PathBuf>,
    /// What was assumed.
    pub(super) warning: Option<String>,
}

impl Names {
    /// Names that the file itself holds.
    pub(super) fn of_bundle(names: Vec<String>) -> Self {
        Self {
            names: names.iter().map(|name| plain(name)).collect(),
            folder: None,
            warning: None,
        }
    }

    /// The names of `count` cameras of the file at `path`.
    ///
    /// # Errors
    /// A list that cannot be read or that is of other photos.
    pub(super) fn beside(path: &Path, count: usize) -> Result<Self, FileError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        if let Some(list) = list_file(path) {
            let names = names_of_list(&read_text(&list)?);
            if names.len() != count {
                let what = format!(
                    "it lists {} photos, {} has {count} cameras",
                    names.len(),
                    path.display()
                );
                let remedy =
                    "put the list of the same reconstruction beside it, or remove the list";
                return Err(FileError::new(&list, Fault::new(what, remedy)));
            }
            let mut folder = list.parent();
            if folder.is_some_and(|folder| folder.ends_with(PREPARE)) {
                folder = folder.and_then(Path::parent);
            }
            let folder = folder.map(Path::to_owned);
            return Ok(Self {
                names,
                folder,
                warning: None,
            });
        }
        let mut names = images_in(folder);
        names.sort_unstable();
        let missing = "no list.txt beside it names the photos";
        if count > 0 && names.len() == count {
            let (first, last) = (names.first().cloned(), names.last().cloned());
            let (first, last) = (first.unwrap_or_default(), last.unwrap_or_default());
            return Ok(Self {
                names,
                folder: Some(folder.to_owned()),
                warning: Some(format!(
                    "{missing}: the {count} image files beside it are taken in the order of their names, {first} to {last}"
                )),
            });
        }
        Ok(Self {
            names: Vec::new(),
            folder: None,
            warning: Some(format!(
                "{missing}: they are numbered from 0, as in the file"
            )),
        })
    }

    pub(super) fn name(&self, index: usize) -> String {
        self.names
            .get(index)
            .cloned()
            .unwrap_or_else(|| index.to_string())
    }
}

/// The list that belongs to the file.
fn list_file(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let stem = name.strip_suffix(".out").unwrap_or(name);
    let stems = [stem, stem.strip_suffix(".bundle").unwrap_or(stem)];
    let own = stems.into_iter().flat_map(|stem| {
        ["list.txt", ".list.txt", "_list.txt"]
            .map(|end| path.with_file_name(format!("{stem}{end}")))
    });
    let of_name = path.with_file_name(format!("{name}.list.txt"));
    let own = own.chain([of_name]);
    let folder = path.parent().unwrap_or(Path::new(""));
    let undistorted = name.ends_with(".rd.out");
    let own = own.chain(undistorted.then(|| folder.join("list.rd.txt")));
    let any = [
        "list.txt",
        "../list.txt",
        "prepare/list.txt",
        "../prepare/list.txt",
    ]
    .map(|name| folder.join(name));
    own.chain(any).find(|file| file.is_file())
}

/// The names of a list's lines that are not empty.
fn names_of_list(text: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.map(|line| plain(without_focal(line))).collect()
}

/// A line without ` 0 <focal length>` at its end; names may hold spaces.
fn without_focal(line: &str) -> &str {
    let last_word = |text: &str| {
        let (rest, word) = text.rsplit_once(char::is_whitespace)?;
        Some((rest.trim_end().len(), word.to_owned()))
    };
    let Some((end, focal)) = last_word(line) else {
        return line;
    };
    let before = line.get(..end).unwrap_or(line);
    if focal == "0" {
        return before;
    }
    match last_word(before) {
        Some((end, zero)) if zero == "0" && focal.parse::<f64>().is_ok() => {
            line.get(..end).unwrap_or(line)
        }
        _ => line,
    }
}

fn plain(name: &str) -> String {
    name.strip_prefix("./").unwrap_or(name).to_owned()
}

/// The image files of a folder.
fn images_in(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    names.filter(|name| is_image(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_in_every_form() {
        let list =
            "./a.jpg\r\nimages/b 1.jpg 0 660.80306\n\nc 0.jpg\nd.jpg 0\ne.jpg\t0\t1e3\nf 7.5\n0\n";
        let names = [
            "a.jpg",
            "images/b 1.jpg",
            "c 0.jpg",
            "d.jpg",
            "e.jpg",
            "f 7.5",
            "0",
        ];
        assert_eq!(names_of_list(list), names);
    }

    #[test]
    fn the_list_is_the_files_own_or_the_folders() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        fs::create_dir(at("bundle")).unwrap();
        let bundle = at("bundle/x.bundle.out");
        assert_eq!(list_file(&bundle), None);
        fs::create_dir(at("prepare")).unwrap();
        fs::write(at("prepare/list.txt"), "./made.jpg 0 2587.05416").unwrap();
        let made = Names::beside(&bundle, 1).unwrap();
        assert_eq!(made.name(0), "made.jpg");
        assert_eq!(made.folder, Some(at("bundle/..")));
        fs::write(at("list.txt"), "up.jpg").unwrap();
        assert_eq!(Names::beside(&bundle, 1).unwrap().name(0), "up.jpg");
        fs::write(at("bundle/list.rd.txt"), "flat.jpg").unwrap();
        assert_eq!(Names::beside(&bundle, 1).unwrap().name(0), "up.jpg");
        let undistorted = at("bundle/bundle.rd.out");
        assert_eq!(Names::beside(&undistorted, 1).unwrap().name(0), "flat.jpg");
        fs::write(at("bundle/x.bundle.out.list.txt"), "named.jpg").unwrap();
        assert_eq!(Names::beside(&bundle, 1).unwrap().name(0), "named.jpg");
        fs::write(at("bundle/x.list.txt"), "own.jpg").unwrap();
        let names = Names::beside(&bundle, 1).unwrap();
        assert_eq!(
            (names.name(0), names.folder),
            ("own.jpg".to_owned(), Some(at("bundle")))
        );
        let error = Names::beside(&bundle, 2)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(error.contains("x.list.txt: it lists 1 photos"), "{error}");
    }

    #[test]
    fn without_a_list_files_or_numbers_stand_in_and_it_is_said() {
        let dir = tempfile::tempdir().unwrap();
        for name in ["b.JPG", "a.jpg", "notes.txt"] {
            fs::write(dir.path().join(name), "").unwrap();
        }
        let bundle = dir.path().join("bundle.out");
        let names = Names::beside(&bundle, 2).unwrap();
        assert_eq!(
            (names.name(0), names.name(1)),
            ("a.jpg".to_owned(), "b.JPG".to_owned())
        );
        assert!(names.warning.unwrap().contains("a.jpg to b.JPG"));
        let names = Names::beside(&bundle, 3).unwrap();
        assert_eq!((names.name(2), names.folder), ("2".to_owned(), None));
        assert!(names.warning.unwrap().contains("numbered"));
    }
}
