//! Names of photos that tell them apart: drones begin to count at DJI_0001 again in each folder.

use std::collections::HashMap;

/// How many parts a name gets: no drone makes deeper folders.
const MOST_PARTS: usize = 16;

/// What a camera may be called.
pub(super) struct Named<'a> {
    /// Its id.
    pub(super) id: &'a str,
    /// Its file's path, or group and label: the last part is the name.
    pub(super) parts: Vec<&'a str>,
}

/// The name of each item: its last part where no other has the same, else as many parts, joined by
/// `/`, as make it unique. What has no name, or one that stays the same, gets its id, which is said
/// in `warnings`.
pub(super) fn distinct_names<'a, T>(
    items: &[T],
    named: impl Fn(&T) -> Named<'a>,
    warnings: &mut Vec<String>,
) -> Vec<String> {
    let items: Vec<Named<'a>> = items.iter().map(named).collect();
    let mut lengths = vec![1; items.len()];
    let name = |item: &Named<'_>, length: usize| {
        let start = item.parts.len().saturating_sub(length);
        item.parts.get(start..).unwrap_or_default().join("/")
    };
    let mut names = Vec::new();
    for _ in 0..MOST_PARTS {
        let parts = items.iter().zip(&lengths);
        names = parts
            .map(|(item, &length)| name(item, length))
            .collect::<Vec<_>>();
        let counts = count(&names);
        let mut clash = false;
        for ((name, item), length) in names.iter().zip(&items).zip(&mut lengths) {
            if counts.get(name) != Some(&1) && *length < item.parts.len() {
                *length += 1;
                clash = true;
            }
        }
        if !clash {
            break;
        }
    }
    let counts = count(&names);
    let mut same = 0;
    let names = names.iter().zip(&items).map(|(name, item)| {
        if !name.is_empty() && counts.get(name) == Some(&1) {
            return name.clone();
        }
        same += 1;
        format!("{name} (camera {})", item.id).trim().to_owned()
    });
    let names = names.collect();
    if same > 0 {
        warnings.push(format!(
            "{same} photos have no name of their own and are named with their camera's id"
        ));
    }
    names
}

fn count(names: &[String]) -> HashMap<String, usize> {
    let mut counts = HashMap::new();
    for name in names {
        *counts.entry(name.clone()).or_default() += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(paths: &[&str]) -> (Vec<String>, usize) {
        let mut warnings = Vec::new();
        let names = distinct_names(
            paths,
            |path| Named {
                id: "7",
                parts: path.split('/').filter(|part| !part.is_empty()).collect(),
            },
            &mut warnings,
        );
        (names, warnings.len())
    }

    #[test]
    fn as_many_folders_as_it_takes() {
        let (found, warnings) =
            names(&["x/100/1.JPG", "x/101/1.JPG", "y/100/1.JPG", "x/100/2.JPG"]);
        assert_eq!(found, ["x/100/1.JPG", "101/1.JPG", "y/100/1.JPG", "2.JPG"]);
        assert_eq!(warnings, 0);
    }

    #[test]
    fn what_stays_the_same_gets_its_id() {
        let (found, warnings) = names(&["a", "", "b", "b"]);
        assert_eq!(found, ["a", "(camera 7)", "b (camera 7)", "b (camera 7)"]);
        assert_eq!(warnings, 1);
        assert_eq!(names(&[]).0.len(), 0);
    }
}
