//! The beginning of a file, by which packages are told: its name, its first bytes, and in a .json file
//! the keys of its root, because all of them are called .json and may begin with any key.

use std::cell::OnceCell;
use std::fmt;
use std::path::{Path, PathBuf};

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use crate::files::read_bytes;

/// What is looked at to tell a file.
pub(crate) struct FileStart<'a> {
    /// The file.
    pub(crate) path: &'a Path,
    /// Its name in lower case.
    pub(crate) name: String,
    /// Its first 4096 bytes at most.
    pub(crate) bytes: &'a [u8],
    /// The same without a byte order mark.
    pub(crate) text: &'a [u8],
    json: OnceCell<JsonRoot>,
}

impl<'a> FileStart<'a> {
    /// Of these first bytes; `None` where the path has no name.
    pub(crate) fn new(path: &'a Path, bytes: &'a [u8]) -> Option<Self> {
        Some(Self {
            path,
            name: path.file_name()?.to_string_lossy().to_ascii_lowercase(),
            bytes,
            text: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes),
            json: OnceCell::new(),
        })
    }

    /// The file itself, where that is what has to be read.
    pub(crate) fn is(&self, told: bool) -> Option<PathBuf> {
        told.then(|| self.path.to_owned())
    }

    /// Whether a word stands in the first bytes.
    pub(crate) fn has(&self, word: &str) -> bool {
        self.text
            .windows(word.len())
            .any(|window| window == word.as_bytes())
    }

    /// The keys of a .json file's root; none where it is no such file. Files of other names (.gltf,
    /// .geojson) are not looked into.
    pub(crate) fn json(&self) -> &JsonRoot {
        self.json.get_or_init(|| {
            let extension = self.path.extension().unwrap_or_default();
            let is_json = extension.eq_ignore_ascii_case("json");
            if !is_json || !matches!(self.text.trim_ascii_start().first(), Some(b'{' | b'[')) {
                return JsonRoot::default();
            }
            read_bytes(self.path).map_or_else(|_| JsonRoot::default(), |json| JsonRoot::of(&json))
        })
    }
}

/// The keys of the root object, or of the first object in a list.
#[derive(Default)]
pub(crate) struct JsonRoot {
    is_list: bool,
    keys: Vec<String>,
}

impl JsonRoot {
    /// A file that breaks off is told by the keys before that, so that its reader can say where.
    fn of(json: &[u8]) -> Self {
        let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
        let mut root = Self::default();
        // What is wrong with the rest, the reader says.
        let _ = root.deserialize(&mut serde_json::Deserializer::from_slice(json));
        root
    }

    /// Whether the root is an object with all these keys.
    pub(crate) fn has(&self, keys: &[&str]) -> bool {
        !self.is_list && self.has_keys(keys)
    }

    /// Whether the root is a list, whose first object has all these keys.
    pub(crate) fn is_list_of(&self, keys: &[&str]) -> bool {
        self.is_list && self.has_keys(keys)
    }

    fn has_keys(&self, keys: &[&str]) -> bool {
        let has = |key: &&str| self.keys.iter().any(|known| known == key);
        keys.iter().all(has)
    }
}

impl<'de> DeserializeSeed<'de> for &mut JsonRoot {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for &mut JsonRoot {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object, or a list of them")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        if !self.is_list {
            self.is_list = true;
            // The others are like the first; what follows it need not be read.
            seq.next_element_seed(self)?;
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key()? {
            self.keys.push(key);
            map.next_value::<IgnoredAny>()?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keys_of_a_root_that_breaks_off_are_told() {
        for (json, is_list, keys) in [
            (
                r#"[{"x": [1, 2], "shots": {}}, 7]"#,
                true,
                &["x", "shots"][..],
            ),
            (
                r#"[{"cameras": {}, "shots": {"a": tr"#,
                true,
                &["cameras", "shots"],
            ),
            (
                "\u{feff}{\"version\": [], \"views\": []}",
                false,
                &["version", "views"],
            ),
            (r#"{"frames": "#, false, &["frames"]),
            (r#"{"a": {"frames": []}}"#, false, &["a"]),
            ("[]", true, &[]),
            ("{", false, &[]),
            ("7", false, &[]),
        ] {
            let root = JsonRoot::of(json.as_bytes());
            assert_eq!(root.is_list, is_list, "{json}");
            assert_eq!(root.keys, keys, "{json}");
        }
        JsonRoot::of("[".repeat(1_000_000).as_bytes());
    }
}
