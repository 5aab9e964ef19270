//! Files of another run in the output's folder, which somebody would take for results of this one.

use std::path::Path;

use super::OUTLINED_ENDINGS;
use crate::fault::first_names;
use crate::masks::OUTLINE_ENDINGS;

/// Those that are named as results and are none of these; a sentence, where there are any.
pub fn left_over(to: &Path, written: &[&Path]) -> Option<String> {
    let files = to.read_dir().ok()?.flatten();
    let is_result = |name: &str| {
        let mut endings = OUTLINED_ENDINGS.into_iter().chain(OUTLINE_ENDINGS);
        endings.any(|ending| name.ends_with(ending))
    };
    let mut others: Vec<String> = files
        .filter(|file| !written.contains(&file.path().as_path()))
        .map(|file| file.file_name().to_string_lossy().into_owned())
        .filter(|name| is_result(name))
        .collect();
    others.sort();
    let first = first_names(&others);
    match others.len() {
        0 => None,
        1 => Some(format!(
            "{first} in {} is of another run: take it away",
            to.display()
        )),
        count => Some(format!(
            "{count} files in {} are of another run ({first}): take them away, or name another folder",
            to.display()
        )),
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    #[test]
    fn names_what_it_did_not_write() {
        let folder = tempfile::tempdir().unwrap();
        let to = folder.path();
        let path = |name: &str| -> PathBuf { to.join(name) };
        for name in [
            "a_labels.png",
            "b_labels.png",
            "notes.txt",
            "sizes.csv",
            "fragments_coco.json",
        ] {
            std::fs::write(path(name), "x").unwrap();
        }
        let [own, other, coco] = ["a_labels.png", "b_labels.png", "fragments_coco.json"].map(path);
        let said = left_over(to, &[&own]).unwrap();
        assert!(
            said.starts_with("2 files in ") && said.contains("(b_labels.png, fragments_coco.json)")
        );
        assert!(
            left_over(to, &[&own, &coco])
                .unwrap()
                .starts_with("b_labels.png in ")
        );
        assert_eq!(left_over(to, &[&own, &coco, &other]), None);
        assert_eq!(left_over(&path("none"), &[]), None);
    }
}
