//! Which flight the export in a folder is of. A flight is known by its file: names repeat.

use std::fs;
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

/// The flight that an export is of.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct FlightOfExport {
    /// For people.
    name: String,
    /// Its file or folder, from the root with links followed.
    file: PathBuf,
    /// The same from the exported folder, so that both can be moved together. Nothing where the two
    /// have only the root in common.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    from_here: Option<PathBuf>,
}

impl FlightOfExport {
    /// That of the flight `name` in `file`, exported to `folder`.
    pub(super) fn new(name: &str, file: &Path, folder: &Path) -> Self {
        let (file, folder) = (real(file), real(folder));
        Self {
            name: name.to_owned(),
            from_here: from(&folder, &file),
            file,
        }
    }

    /// Whether it is the same flight: in the same place, or still in the same place beside the export.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.file == other.file || self.from_here.is_some() && self.from_here == other.from_here
    }

    /// For people.
    pub(super) fn in_words(&self) -> String {
        format!("'{}' ({})", self.name, self.file.display())
    }
}

/// A path from the root with its links followed, as far as it exists.
fn real(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut missing = Vec::new();
    let mut there = path.as_path();
    loop {
        if let Ok(mut real) = fs::canonicalize(there) {
            real.extend(missing.iter().rev());
            return real;
        }
        match (there.parent(), there.file_name()) {
            (Some(parent), Some(name)) => {
                missing.push(name.to_owned());
                there = parent;
            }
            _ => return path,
        }
    }
}

/// How `path` is named from `folder`, both from the root.
fn from(folder: &Path, path: &Path) -> Option<PathBuf> {
    let same = folder
        .components()
        .zip(path.components())
        .take_while(|(a, b)| a == b);
    let same: Vec<Component<'_>> = same.map(|(component, _)| component).collect();
    let in_common = |component: &Component<'_>| matches!(component, Component::Normal(_));
    same.iter().any(in_common).then(|| {
        let up = folder
            .components()
            .skip(same.len())
            .map(|_| Component::ParentDir);
        up.chain(path.components().skip(same.len())).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_is_known_by_its_place() {
        let root = tempfile::tempdir().unwrap();
        let root = fs::canonicalize(root.path()).unwrap();
        fs::create_dir(root.join("a")).unwrap();
        fs::write(root.join("a/flight.toml"), "").unwrap();
        let of = |file: &str, folder: &str| {
            FlightOfExport::new("x", &root.join(file), &root.join(folder))
        };
        let one = of("a/flight.toml", "a/new/export");
        assert_eq!(one.from_here, Some(PathBuf::from("../../flight.toml")));
        assert!(one.is(&of("a/../a/flight.toml", "elsewhere")));
        assert!(
            one.is(&of("b/flight.toml", "b/new/export")),
            "moved together"
        );
        assert!(!one.is(&of("b/flight.toml", "a/new/export")));
        let apart = FlightOfExport::new("x", Path::new("/nowhere/f"), &root);
        #[cfg(unix)]
        assert_eq!(apart.from_here, None);
        assert!(!apart.is(&one) && apart.is(&apart.clone()));
    }
}
