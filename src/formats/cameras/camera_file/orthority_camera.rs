//! Orthority's (simple-ortho's) interior parameters, from its documentation ("Orthority interior
//! parameters") and its `FrameCamera._get_intrinsic`:
//!
//! ```text
//! <name>:                        or all of it below "camera:" (config.yaml), or without a name
//!     type: pinhole              pinhole, brown, opencv, fisheye
//!     im_size: [640, 1152]       width, height in pixels
//!     focal_len: 120.0           one, or [x, y], in the unit of sensor_size
//!     sensor_size: [92.16, 165.888]
//!     cx: 0.0, cy: 0.0           offsets of the principal point from the image's middle,
//!                                in the longer side
//!     k1, k2, p1, p2, k3 ...     OpenCV's
//! ```
//!
//! Without sensor_size the focal length is in widths. The middle is that of the pixels' centres,
//! (width - 1) / 2 there: half the width here.

use crate::camera::{Brown, Camera, Distortion, Fisheye};
use crate::fault::Fault;

use super::yaml_tree::{Node, Value, quoted};

const REMEDY: &str = "write it as Orthority's documentation says";

/// The named cameras of a tree, or `None` where it is not Orthority's.
pub(super) fn cameras(tree: &Node) -> Option<Vec<(&str, &Node)>> {
    let tree = tree.get("camera").map_or(tree, |entry| &entry.node);
    if tree.get("focal_len").is_some() {
        let name = tree
            .get("name")
            .and_then(|entry| entry.node.text("name").ok());
        return Some(vec![(name.unwrap_or_default(), tree)]);
    }
    let Value::Mapping(entries) = &tree.value else {
        return None;
    };
    let is_camera = |node: &Node| node.get("focal_len").is_some();
    let found: Vec<_> = entries
        .iter()
        .filter(|entry| is_camera(&entry.node))
        .map(|entry| (entry.key.as_str(), &entry.node))
        .collect();
    (!found.is_empty()).then_some(found)
}

/// The camera of a file that has one.
pub(super) fn from_tree(cameras: &[(&str, &Node)]) -> Result<Camera, Fault> {
    let &[(name, node)] = cameras else {
        let names: Vec<_> = cameras.iter().map(|(name, _)| *name).collect();
        let what = format!("it holds {} cameras: {}", names.len(), names.join(", "));
        return Err(Fault::new(what, "give each camera a file of its own"));
    };
    let entry = |key: &str| node.get(key).map(|entry| &entry.node);
    let needed = |key: &str| {
        entry(key).ok_or_else(|| Fault::at(node.line, format!("there is no {key}"), REMEDY))
    };
    let pair = |node: &Node, key: &str| match node.numbers(key)?.as_slice() {
        &[x, y] => Ok([x, y]),
        _ => Err(Fault::at(
            node.line,
            format!("{key} is not two numbers"),
            REMEDY,
        )),
    };
    let size = needed("im_size")?;
    let side = |index: usize| match &size.value {
        Value::Sequence(items) if items.len() == 2 => items[index].whole("im_size"),
        _ => Err(Fault::at(
            size.line,
            "im_size is not [width, height]",
            REMEDY,
        )),
    };
    let (width, height) = (side(0)?, side(1)?);
    let focal = needed("focal_len")?;
    let [focal_x, focal_y] = match &focal.value {
        Value::Sequence(_) => pair(focal, "focal_len")?,
        _ => [focal.number("focal_len")?; 2],
    };
    let (w, h) = (f64::from(width), f64::from(height));
    let (fx, fy) = match entry("sensor_size") {
        None => (focal_x * w, focal_y * w),
        Some(sensor) => {
            let [x, y] = pair(sensor, "sensor_size")?;
            (focal_x * w / x, focal_y * h / y)
        }
    };
    let number = |key: &str| entry(key).map_or(Ok(0.0), |node| node.number(key));
    let longer = w.max(h);
    let kind = needed("type")?.text("type")?.to_ascii_lowercase();
    let (distortion, known): (_, &[&str]) = match kind.as_str() {
        "pinhole" => (Distortion::None, &[]),
        "fisheye" => {
            let known = &["k1", "k2", "k3", "k4"];
            let [k1, k2, k3, k4] = known.map(number);
            (
                Distortion::Fisheye(Fisheye::new([k1?, k2?, k3?, k4?])),
                known,
            )
        }
        "brown" | "opencv" => {
            let known = &["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];
            let mut values = [0.0; 8];
            for (value, key) in values.iter_mut().zip(known) {
                *value = number(key)?;
            }
            (Distortion::Brown(Brown::new(values)), known)
        }
        other => {
            let what = format!("the camera type {} is not known", quoted(other));
            return Err(Fault::at(node.line, what, REMEDY));
        }
    };
    let about = [
        "type",
        "name",
        "im_size",
        "focal_len",
        "sensor_size",
        "cx",
        "cy",
    ];
    for entry in node.entries("the camera", REMEDY)? {
        let key = entry.key.as_str();
        let is_zero = || entry.node.number(key) == Ok(0.0);
        if !about.contains(&key) && !known.contains(&key) && !is_zero() {
            let what = format!("{} cannot be read for a camera of type {kind}", quoted(key));
            return Err(Fault::at(
                entry.line,
                what,
                "remove it, or calibrate without it",
            ));
        }
    }
    let camera = Camera {
        name: name.to_owned(),
        width,
        height,
        fx,
        fy,
        cx: w / 2.0 + longer * number("cx")?,
        cy: h / 2.0 + longer * number("cy")?,
        skew: 0.0,
        distortion,
    };
    camera
        .validate()
        .map_err(|error| Fault::at(node.line, error.to_string(), REMEDY))?;
    Ok(camera)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cameras::camera_file::read;
    use fragscale_test_data::shared_data;

    #[test]
    fn the_shared_cameras() {
        for file in ["ngi_int_param.yaml", "config.yaml"] {
            let Some(path) = shared_data(&format!("orthority-ngi-opk/{file}")) else {
                return;
            };
            let camera = read(&std::fs::read_to_string(path).unwrap()).unwrap();
            assert!(camera.name.ends_with("DMC"), "{}", camera.name);
            assert_eq!((camera.width, camera.height), (640, 1152));
            // The README: 833.3 px.
            assert!((camera.fx - 833.3).abs() < 0.05 && (camera.fy - camera.fx).abs() < 1e-9);
            assert_eq!((camera.cx, camera.cy), (320.0, 576.0));
            assert_eq!(camera.distortion, Distortion::None);
        }
    }

    const BROWN: &str = "a:\n  type: brown\n  im_size: [100, 50]\n  focal_len: [1, 1.1]\n  cx: 0.1\n  \
        cy: -0.2\n  k1: 1\n  k2: 2\n  k3: 5\n  p1: 3\n  p2: 4\n";

    #[test]
    fn normalised_lengths() {
        let camera = read(BROWN).unwrap();
        assert_eq!((camera.fx, camera.fy), (100.0, 110.00000000000001));
        assert_eq!((camera.cx, camera.cy), (60.0, 5.0));
        let expected = Brown::new([1.0, 2.0, 3.0, 4.0, 5.0, 0.0, 0.0, 0.0]);
        assert_eq!(camera.distortion, Distortion::Brown(expected));
        let fisheye = read(
            &BROWN
                .replace("brown", "fisheye")
                .replace("  p1: 3\n  p2: 4\n", ""),
        )
        .unwrap();
        assert_eq!(
            fisheye.distortion,
            Distortion::Fisheye(Fisheye::new([1.0, 2.0, 5.0, 0.0]))
        );
    }

    #[test]
    fn mistakes_are_placed() {
        for (from, to, what) in [
            ("brown", "rpc", "'rpc' is not known"),
            ("brown", "pinhole", "'k1' cannot be read"),
            ("[100, 50]", "[100]", "[width, height]"),
            ("[100, 50]", "[0, 50]", "image size"),
            ("[1, 1.1]", "-1", "focal length"),
            ("[1, 1.1]", "[1, 2, 3]", "two numbers"),
            ("cx: 0.1", "cx: .nan", "finite"),
            ("  im_size: [100, 50]\n", "", "no im_size"),
            ("k1: 1", "k1: 1\n  s1: 0.5", "'s1' cannot be read"),
        ] {
            let broken = BROWN.replace(from, to);
            assert_ne!(broken, BROWN, "{from}");
            let fault = read(&broken).unwrap_err();
            assert!(fault.what.contains(what) && fault.line.is_some(), "{fault}");
        }
        let two = format!("{BROWN}{}", BROWN.replace("a:", "b:"));
        assert!(read(&two).unwrap_err().what.contains("2 cameras: a, b"));
    }
}
