//! Which package wrote a JSON file: told by the keys of its root, because all of them are called
//! .json and may begin with any key.
//!
//! | root | keys | package |
//! |---|---|---|
//! | list of objects | shots | OpenSfM |
//! | object | views and one of intrinsics, poses, structure, version | Meshroom |
//! | object | frames | nerfstudio |
//! | object | extrinsic and intrinsic, or class_name and parameters | Open3D |
//!
//! A file that breaks off is told by the keys before that, so that its reader can say where. Files of
//! other names (.gltf, .geojson) are not looked into.

use std::fmt;
use std::path::Path;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use crate::Package;
use crate::files::read_bytes;

/// The package of a .json file whose first bytes are `start`.
pub(crate) fn of_file(path: &Path, start: &[u8]) -> Option<Package> {
    let is_json = path.extension()?.eq_ignore_ascii_case("json");
    if !is_json || !matches!(start.trim_ascii_start().first(), Some(b'{' | b'[')) {
        return None;
    }
    of_json(&read_bytes(path).ok()?)
}

fn of_json(json: &[u8]) -> Option<Package> {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    let mut root = Root::default();
    // What is wrong with the rest, the reader says.
    let _ = root.deserialize(&mut serde_json::Deserializer::from_slice(json));
    let has = |key: &str| root.keys.iter().any(|known| known == key);
    if root.is_list {
        return has("shots").then_some(Package::OpenSfm);
    }
    let of_scene = ["intrinsics", "poses", "structure", "version"];
    if has("views") && of_scene.into_iter().any(has) {
        return Some(Package::Meshroom);
    }
    if has("frames") {
        return Some(Package::Nerfstudio);
    }
    let of_open3d = [["extrinsic", "intrinsic"], ["class_name", "parameters"]];
    let is_open3d = of_open3d.iter().any(|pair| pair.iter().all(|key| has(key)));
    is_open3d.then_some(Package::Open3d)
}

/// The keys of the root object, or of the first object in a list.
#[derive(Default)]
struct Root {
    is_list: bool,
    keys: Vec<String>,
}

impl<'de> DeserializeSeed<'de> for &mut Root {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for &mut Root {
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
    fn packages_are_told_by_their_keys() {
        for (json, package) in [
            (r#"[{"x": [1, 2], "shots": {}}, 7]"#, Some(Package::OpenSfm)),
            (
                r#"[{"cameras": {}, "shots": {"a": tr"#,
                Some(Package::OpenSfm),
            ),
            (
                "\u{feff}{\"version\": [], \"views\": []}",
                Some(Package::Meshroom),
            ),
            (r#"{"views": [], "x": 1}"#, None),
            (r#"{"frames": "#, Some(Package::Nerfstudio)),
            (
                r#"{"class_name": "", "parameters": []}"#,
                Some(Package::Open3d),
            ),
            (
                r#"{"intrinsic": {}, "extrinsic": []}"#,
                Some(Package::Open3d),
            ),
            (r#"{"type": "FeatureCollection", "features": []}"#, None),
            (r#"{"a": {"frames": []}}"#, None),
            ("[[{\"shots\": 1}]]", None),
            ("[]", None),
            ("{", None),
            ("7", None),
        ] {
            assert_eq!(of_json(json.as_bytes()), package, "{json}");
        }
        assert_eq!(of_json("[".repeat(1_000_000).as_bytes()), None);
    }
}
