//! Photos that are done while others are not: what a stopped `fragscale delineate` goes on with.
//!
//! Of each photo a file `unfinished/NAME.json` in the output's folder has its measures, the checksums of the files that were
//! written for it, and a key: the checksum of all that the work rests on (the program's version, the options, the flight's files,
//! the photo, its saved outlines, the user's model). It counts as long as the key is the same and the files are. At the end
//! the folder is removed.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::cli::outputs::Outputs;
use crate::delineation::Habits;
use crate::delineation::mass::PhotoFragments;
use crate::files::{Kind, note_kept, read_bytes};
use crate::files::{sha256_of_bytes, sha256_of_file};
use crate::jobs::Progress;

/// What is kept of a photo.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KeptPhoto {
    /// What was measured.
    pub(super) fragments: PhotoFragments,
    /// Whether its outlines were saved in the window, what outlined them now, and how that errs.
    pub(super) is_saved: bool,
    pub(super) engine: String,
    pub(super) habits: Option<Habits>,
    /// How far its edges are spread, pixels.
    pub(super) spread: Option<f64>,
    /// What was mended or left out.
    pub(super) notes: Vec<String>,
}

/// The folder of what is kept.
pub(super) struct Unfinished {
    folder: PathBuf,
    /// What all photos rest on; `None` where nothing is kept.
    of_all: Option<String>,
}

impl Unfinished {
    /// In the output's folder. `options` are those that the results rest on, `read` the files of the flight and of the engine.
    /// Of files that cannot be read nothing is kept.
    pub(super) fn new(to: &Path, options: &str, read: &[PathBuf], progress: &Progress) -> Self {
        let sums = read
            .iter()
            .map(|path| sha256_of_file(path, || progress.is_cancelled()));
        let sums: Result<Vec<String>, _> = sums.collect();
        let of_all = sums.ok().map(|sums| {
            let version = env!("CARGO_PKG_VERSION");
            sha256_of_bytes(format!("{version}\n{options}\n{}", sums.join("\n")).as_bytes())
        });
        Self {
            folder: to.join("unfinished"),
            of_all,
        }
    }

    /// One that keeps nothing.
    pub(super) fn nothing(to: &Path) -> Self {
        Self {
            folder: to.join("unfinished"),
            of_all: None,
        }
    }

    fn file(&self, stem: &str) -> PathBuf {
        self.folder.join(format!("{stem}.json"))
    }

    /// The key of a photo that rests on these files besides; those that are not there do not count.
    pub(super) fn key(&self, files: &[PathBuf], progress: &Progress) -> Option<String> {
        let files = files.iter().filter(|path| path.is_file());
        let sums = files.map(|path| sha256_of_file(path, || progress.is_cancelled()));
        let sums: Vec<String> = sums.collect::<Result<_, _>>().ok()?;
        let all = format!("{}\n{}", self.of_all.as_ref()?, sums.join("\n"));
        Some(sha256_of_bytes(all.as_bytes()))
    }

    /// What is kept of a photo, where its key is this one and all files of it are as they were written.
    pub(super) fn kept(
        &self,
        stem: &str,
        key: Option<&str>,
        written: &[PathBuf],
        progress: &Progress,
    ) -> Option<KeptPhoto> {
        let bytes = read_bytes(&self.file(stem)).ok()?;
        let value: Value = serde_json::from_slice(&bytes).ok()?;
        let word = |key: &str| value.get(key)?.as_str().map(str::to_owned);
        if word("key")? != key? {
            return None;
        }
        let sums = value.get("files")?.as_array()?;
        let is_same = |(path, sum): (&PathBuf, &Value)| {
            sha256_of_file(path, || progress.is_cancelled())
                .is_ok_and(|own| sum.as_str() == Some(&own))
        };
        if sums.len() != written.len() || !written.iter().zip(sums).all(is_same) {
            return None;
        }
        let notes = value.get("notes")?.as_array()?.iter();
        let notes = notes.map(|note| note.as_str().map(str::to_owned));
        let kept = KeptPhoto {
            fragments: PhotoFragments::from_json(value.get("measured")?)?,
            is_saved: value.get("saved")?.as_bool()?,
            engine: word("engine")?,
            habits: value.get("habits").and_then(Habits::from_json),
            spread: value.get("spread")?.as_u64().map(f64::from_bits),
            notes: notes.collect::<Option<_>>()?,
        };
        written.iter().for_each(|path| note_kept(path));
        Some(kept)
    }

    /// Keeps a photo, once its files are written.
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub(super) fn keep(
        &self,
        stem: &str,
        photo: &str,
        key: Option<&str>,
        written: &[(PathBuf, Vec<u8>)],
        of: &KeptPhoto,
        outputs: &Outputs<'_>,
    ) -> Result<(), String> {
        let Some(key) = key else {
            return Ok(());
        };
        let sums: Vec<String> = written
            .iter()
            .map(|(_, bytes)| sha256_of_bytes(bytes))
            .collect();
        let rest = json!({
            "key": key,
            "files": sums,
            "saved": of.is_saved,
            "engine": of.engine,
            "habits": of.habits.map(|habits| habits.to_json()),
            "spread": of.spread.map(f64::to_bits),
            "notes": of.notes,
            "measured": of.fragments.to_json(),
        });
        // The photo's name comes first: by that the file is known as ours.
        let rest = rest.to_string();
        let text = format!("{{\"delineated\":{},{}\n", json!(photo), &rest[1..]);
        outputs.make_folder(&self.folder)?;
        outputs.write(&self.file(stem), text.as_bytes(), Kind::Result)
    }

    /// Everything is done: what was kept of these photos is removed, and the folder where nothing else lies in it. Returns that
    /// something does.
    pub(super) fn remove<'s>(&self, stems: impl Iterator<Item = &'s str>) -> Option<String> {
        for stem in stems {
            // What cannot be removed is a file too many, and no harm.
            let _ = std::fs::remove_file(self.file(stem));
        }
        let _ = std::fs::remove_dir(&self.folder);
        self.folder.is_dir().then(|| {
            let folder = self.folder.display();
            format!("{folder} is of another run, which was stopped: take it away, or start that one again")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_run_left_is_said() {
        let to = tempfile::tempdir().unwrap();
        let unfinished = Unfinished::nothing(to.path());
        assert_eq!(unfinished.remove(["a"].into_iter()), None);
        let folder = to.path().join("unfinished");
        std::fs::create_dir(&folder).unwrap();
        for name in ["a.json", "b.json"] {
            std::fs::write(folder.join(name), "x").unwrap();
        }
        let said = unfinished.remove(["a"].into_iter()).unwrap();
        assert!(said.contains("unfinished is of another run"), "{said}");
        assert!(!folder.join("a.json").exists() && folder.join("b.json").exists());
        assert_eq!(unfinished.remove(["b"].into_iter()), None);
        assert!(!folder.exists());
    }
}
