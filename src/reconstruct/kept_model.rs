//! What an engine found, kept in the unfinished work and in the finished flight: whoever goes on with the dense
//! cloud does not find it again.

use std::fs;
use std::path::Path;

use crate::dense::{InFolder, Shelf};
use crate::engine::Sparse;
use crate::fault::Fault;
use crate::photo_set::LeftOut;

/// The folder in the unfinished work.
const KEPT: &str = "sparse";
/// COLMAP's files.
const FILES: [&str; 3] = ["cameras.txt", "images.txt", "points3D.txt"];
/// Photos that are not in the model, a line each: why, a tab, the name. Written last: with it the model is whole.
const LEFT_OUT: &str = "left_out.txt";

/// The model that is kept in `work`, else the one that `find` finds, which is kept then. The second is
/// whether it was kept.
///
/// # Errors
/// Those of `find`, and where the model cannot be written.
pub(crate) fn kept_or_found(
    work: &Path,
    find: impl FnOnce() -> Result<Sparse, Fault>,
) -> Result<(Sparse, bool), Fault> {
    let folder = work.join(KEPT);
    if let Some(sparse) = kept_in(&folder) {
        return Ok((sparse, true));
    }
    let sparse = find()?;
    keep(work, &sparse)?;
    Ok((sparse, false))
}

/// Keeps a model in `work`, for [`kept_or_found`].
///
/// # Errors
/// Where it cannot be written.
pub(crate) fn keep(work: &Path, sparse: &Sparse) -> Result<(), Fault> {
    let folder = work.join(KEPT);
    let Some(files) = files_of(sparse) else {
        return Ok(());
    };
    fs::create_dir_all(&folder).map_err(|error| {
        let what = format!("{} cannot be made ({error})", folder.display());
        Fault::new(what, "choose a folder that may be written to")
    })?;
    let shelf = InFolder::new(folder);
    files
        .into_iter()
        .try_for_each(|(name, bytes)| shelf.put(name, bytes))
}

/// The files that keep a model, by name, in the order in which they have to be written; `None` where its words
/// cannot be kept: a name with a line break is found again rather than misread.
pub(crate) fn files_of(sparse: &Sparse) -> Option<Vec<(&'static str, Vec<u8>)>> {
    let is_plain = |out: &LeftOut| !(out.photo.contains('\n') || out.why.contains(['\n', '\t']));
    if !sparse.left_out.iter().all(is_plain) {
        return None;
    }
    let line = |out: &LeftOut| format!("{}\t{}\n", out.why, out.photo);
    let lines: String = sparse.left_out.iter().map(line).collect();
    let mut files = sparse.files.to_vec();
    files.push((LEFT_OUT, lines.into_bytes()));
    Some(files)
}

/// The model that is kept in a folder, whole.
pub(crate) fn kept_in(folder: &Path) -> Option<Sparse> {
    let shelf = InFolder::new(folder.to_owned());
    let lines = String::from_utf8(shelf.get(LEFT_OUT)?).ok()?;
    let left_out = lines.lines().map(|line| {
        let (why, photo) = line.split_once('\t')?;
        Some(LeftOut {
            photo: photo.to_owned(),
            why: why.to_owned(),
        })
    });
    let file = |name: &'static str| Some((name, shelf.get(name)?));
    let [cameras, images, points] = FILES;
    Some(Sparse {
        files: [file(cameras)?, file(images)?, file(points)?],
        left_out: left_out.collect::<Option<_>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn found_once() {
        let work = tempfile::tempdir().unwrap();
        let sparse = Sparse {
            files: FILES.map(|name| (name, name.as_bytes().to_vec())),
            left_out: vec![LeftOut {
                photo: "a\tb.jpg".to_owned(),
                why: "it is blurred".to_owned(),
            }],
        };
        let failed = || Err(Fault::new("cancelled", "start again"));
        assert!(kept_or_found(work.path(), failed).is_err());
        let found = kept_or_found(work.path(), || Ok(sparse.clone())).unwrap();
        assert_eq!(found, (sparse.clone(), false));
        let again = kept_or_found(work.path(), failed).unwrap();
        assert_eq!(again, (sparse, true));
        // Killed before the last file was written.
        fs::remove_file(work.path().join("sparse/left_out.txt")).unwrap();
        assert!(kept_or_found(work.path(), failed).is_err());
    }
}
