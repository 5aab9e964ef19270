//! Which of the surfaces that OpenDroneMap makes is taken.
//!
//! Written from ODM's `opendm/types.py`, `opendm/point_cloud.py`, `opendm/entwine.py` and
//! `stages/odm_dem.py`. All of these are in the georeferenced frame:
//!
//! | file | written with |
//! |---|---|
//! | `odm_georeferencing/odm_georeferenced_model.laz`, in older versions `.las`, `.ply` | always |
//! | `odm_georeferencing/odm_georeferenced_model.copc.laz` | `--pc-copc` |
//! | `entwine_pointcloud/ept.json` | `--pc-ept` |
//! | `odm_dem/dsm.tif` | `--dsm` |
//!
//! The first is the dense cloud itself, the next two are made of it, the elevation model has lost
//! what overhangs. The terrain model (`dtm.tif`) has lost the rocks, and the textured mesh is in a
//! frame less an offset: neither is taken.

use std::path::{Path, PathBuf};

use crate::clouds::ept;
use crate::files::read_bytes;

/// The best first.
const SURFACES: [&str; 6] = [
    "odm_georeferencing/odm_georeferenced_model.laz",
    "odm_georeferencing/odm_georeferenced_model.las",
    "odm_georeferencing/odm_georeferenced_model.ply",
    "odm_georeferencing/odm_georeferenced_model.copc.laz",
    EPT,
    "odm_dem/dsm.tif",
];

const EPT: &str = "entwine_pointcloud/ept.json";

/// The surface of a project, and what there is to say: which one of several it is, or where none was.
pub(super) fn surface(dir: &Path) -> (Option<PathBuf>, Option<String>) {
    let mut found = Vec::new();
    let mut refused = None;
    for name in SURFACES.into_iter().filter(|name| dir.join(name).is_file()) {
        let why = if name == EPT {
            refusal(&dir.join(name))
        } else {
            None
        };
        match why {
            Some(why) => refused = Some(format!("{name} cannot be used: {why}")),
            None => found.push(name),
        }
    }
    let note = match found.as_slice() {
        [] => {
            let mut looked = SURFACES.join(", ");
            if let Some(refused) = refused {
                looked = format!("{looked}; {refused}");
            }
            Some(format!("no surface was found; looked for {looked}"))
        }
        [_] => None,
        [taken, others @ ..] => Some(format!(
            "of its surfaces {taken} is taken, not {}",
            others.join(", ")
        )),
    };
    (found.first().map(|name| dir.join(name)), note)
}

/// Why the tiles below this header cannot be read, if so.
fn refusal(header: &Path) -> Option<String> {
    match read_bytes(header) {
        Ok(bytes) => ept::refusal(&bytes),
        Err(error) => Some(error.fault.what),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn with(files: &[&str], ept: &str) -> (tempfile::TempDir, Option<String>, Option<String>) {
        let dir = tempfile::tempdir().unwrap();
        for name in files {
            let file = dir.path().join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, if *name == EPT { ept } else { "" }).unwrap();
        }
        let (file, note) = surface(dir.path());
        let file = file.map(|file| {
            let inside = file.strip_prefix(dir.path()).unwrap();
            inside.to_string_lossy().replace('\\', "/")
        });
        (dir, file, note)
    }

    #[test]
    fn the_best_is_taken_and_named_where_there_are_several() {
        let ept = r#"{"dataType": "laszip", "hierarchyType": "json"}"#;
        for (index, name) in SURFACES.into_iter().enumerate() {
            assert_eq!(with(&[name], ept).1.as_deref(), Some(name));
            assert_eq!(with(&[name], ept).2, None);
            for other in &SURFACES[index + 1..] {
                let (_dir, file, note) = with(&[other, name], ept);
                assert_eq!(file.as_deref(), Some(name));
                let note = note.unwrap();
                assert!(
                    note.contains(&format!("{name} is taken, not {other}")),
                    "{note}"
                );
            }
        }
    }

    #[test]
    fn where_none_is_it_lists_where_it_looked() {
        let (_dir, file, note) = with(&["odm_dem/dtm.tif"], "");
        assert_eq!(file, None);
        for name in SURFACES {
            assert!(note.as_deref().unwrap().contains(name), "{note:?}");
        }
        let other = r#"{"dataType": "zstandard", "hierarchyType": "json"}"#;
        let (_dir, file, note) = with(&[EPT], other);
        assert_eq!(file, None);
        assert!(note.unwrap().contains("\"zstandard\""));
        // Another surface is taken without a word about what cannot be.
        let (_dir, file, note) = with(&[EPT, "odm_dem/dsm.tif"], "{");
        assert_eq!((file.as_deref(), note), (Some("odm_dem/dsm.tif"), None));
    }
}
