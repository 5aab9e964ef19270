//! Paths with `*` (any characters) and `?` (one) in the names of their parts.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// Whether a name, or a path, has characters that stand for others.
pub(super) fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?'])
}

/// Whether a path stands for others: it has such characters, and is not there as it is.
pub(super) fn stands_for_others(path: &Path) -> bool {
    is_pattern(&path.to_string_lossy()) && !path.exists()
}

/// What stands in front of the first part of a path that stands for others.
pub(super) fn fixed_part(path: &Path) -> PathBuf {
    let components = path.components();
    let is_fixed = |component: &Component<'_>| !matches!(component, Component::Normal(name) if is_pattern(&name.to_string_lossy()));
    components.take_while(is_fixed).collect()
}

/// What a path stands for, by name: itself where it has no `*` and no `?`, or is there as it is. Hidden files are
/// matched by nothing but themselves.
pub(super) fn matches(path: &Path) -> Vec<PathBuf> {
    if !stands_for_others(path) {
        return vec![path.to_owned()];
    }
    let mut found = vec![PathBuf::new()];
    for component in path.components() {
        let text = component.as_os_str().to_string_lossy();
        if !matches!(component, Component::Normal(_)) || !is_pattern(&text) {
            for path in &mut found {
                path.push(component);
            }
            continue;
        }
        let mut next = Vec::new();
        for folder in &found {
            let place = match folder.as_os_str().is_empty() {
                true => Path::new("."),
                false => folder.as_path(),
            };
            for entry in fs::read_dir(place).into_iter().flatten().flatten() {
                let name = entry.file_name();
                let shown = name.to_string_lossy();
                if !shown.starts_with('.') && fits(&text, &shown) {
                    next.push(folder.join(name));
                }
            }
        }
        found = next;
    }
    found.retain(|path| path.exists());
    found.sort();
    found
}

/// Whether a name fits a pattern: from left to right, going back to the last `*` where it does not go on.
fn fits(pattern: &str, name: &str) -> bool {
    let pattern: Vec<char> = pattern.chars().collect();
    let name: Vec<char> = name.chars().collect();
    let (mut at, mut in_name) = (0, 0);
    let mut last: Option<(usize, usize)> = None;
    while in_name < name.len() {
        match pattern.get(at) {
            Some('*') => {
                last = Some((at, in_name));
                at += 1;
            }
            Some(c) if *c == '?' || name.get(in_name) == Some(c) => {
                at += 1;
                in_name += 1;
            }
            _ => {
                let Some((star, taken)) = last else {
                    return false;
                };
                last = Some((star, taken + 1));
                (at, in_name) = (star + 1, taken + 1);
            }
        }
    }
    pattern.iter().skip(at).all(|c| *c == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fit_as_in_a_shell() {
        for (pattern, name, is_fit) in [
            ("*", "a", true),
            ("a*", "abc", true),
            ("a*c", "abcbc", true),
            ("a*d", "abcbc", false),
            ("2026-0?-*", "2026-05-31", true),
            ("2026-0?-*", "2026-15-31", false),
            ("?", "", false),
            ("**", "", true),
            ("*ab*ab", "abab", true),
            ("*ab*ab", "aba", false),
            ("blast-é?", "blast-éx", true),
        ] {
            assert_eq!(fits(pattern, name), is_fit, "{pattern} {name}");
        }
        // No exponent in the number of stars.
        assert!(!fits(&"*a".repeat(30), &"a".repeat(29)));
    }

    #[test]
    fn folders_are_gone_through_by_name() {
        let root = tempfile::tempdir().unwrap();
        for name in ["b/x1", "a/x2", "a/y", ".c/x3"] {
            fs::create_dir_all(root.path().join(name)).unwrap();
        }
        let found = matches(&root.path().join("*/x?"));
        assert_eq!(found, ["a/x2", "b/x1"].map(|name| root.path().join(name)));
        assert!(matches(&root.path().join("*/z*")).is_empty());
        let missing = root.path().join("none");
        assert_eq!(matches(&missing), [missing]);
    }
}
