//! What a file is called, by a path that a text names.

/// The last part of a path as it is written in a file, of whatever system: behind the last slash or backslash. A path
/// that ends in one has an empty last part.
///
/// Not `Path::file_name`, which knows the separators of this system alone.
pub fn last_segment(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// The last part of a path without what is behind its last dot.
pub fn stem(path: &str) -> &str {
    let name = last_segment(path);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_of_either_system_have_a_last_segment() {
        for (path, last) in [
            ("a.jpg", "a.jpg"),
            ("/flights/7/a.jpg", "a.jpg"),
            (r"D:\flights\7\a.jpg", "a.jpg"),
            (r"flights\7/a.jpg", "a.jpg"),
            ("flights/7/", ""),
            ("", ""),
        ] {
            assert_eq!(last_segment(path), last, "{path}");
        }
    }

    #[test]
    fn a_stem_ends_at_the_last_dot() {
        for (path, found) in [
            (r"D:\v1.2\a.b.jpg", "a.b"),
            ("v1.2/a", "a"),
            ("a.", "a"),
            (".a", ""),
        ] {
            assert_eq!(stem(path), found, "{path}");
        }
    }
}
