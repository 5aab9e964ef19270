use std::fs;

use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;

fn parse(bytes: &[u8]) -> Result<CloudFile, Fault> {
    let beside = |name: &str| Err(Fault::new(format!("'{name}' is not here"), ""));
    read(bytes, &beside, &Progress::default())
}

/// Four corners of a square with indices and colours; returns the document and its buffer.
fn square() -> (Value, Vec<u8>) {
    let mut buffer = Vec::new();
    for corner in [
        [0.0_f32, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [4.0, 1.0, -2.0],
        [0.0, 1.0, -2.0],
    ] {
        buffer.extend(corner.iter().flat_map(|c| c.to_le_bytes()));
    }
    for index in [0_u16, 1, 2, 0, 2, 3] {
        buffer.extend(index.to_le_bytes());
    }
    for color in [
        [255_u8, 0, 0, 255],
        [0, 255, 0, 255],
        [0, 0, 255, 255],
        [51, 102, 153, 0],
    ] {
        buffer.extend(color);
    }
    let document = json!({
        "asset": {"version": "2.0", "generator": "by hand"},
        "extensionsRequired": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"children": [1], "translation": [500000.125, 0.0, -5000000.0]},
            {"mesh": 0, "scale": [2.0, 1.0, 1.0]},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 2, "NORMAL": 7}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
            {"buffer": 0, "byteOffset": 60, "byteLength": 16, "byteStride": 4},
        ],
        "buffers": [{"byteLength": 76}],
    });
    (document, buffer)
}

fn glb(document: &Value, buffer: &[u8]) -> Vec<u8> {
    let mut json = serde_json::to_vec(document).unwrap();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((28 + json.len() as u32 + buffer.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_slice()), (b"BIN\0", buffer)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

fn changed(change: impl FnOnce(&mut Value)) -> Result<CloudFile, Fault> {
    let (mut document, buffer) = square();
    change(&mut document);
    parse(&glb(&document, &buffer))
}

#[test]
fn nodes_place_meshes_and_y_is_up() {
    let file = changed(|_| {}).unwrap();
    assert_eq!(
        file.cloud.points,
        [
            DVec3::new(500_000.125, 5_000_000.0, 0.0),
            DVec3::new(500_008.125, 5_000_000.0, 0.0),
            DVec3::new(500_008.125, 5_000_002.0, 1.0),
            DVec3::new(500_000.125, 5_000_002.0, 1.0)
        ]
    );
    assert_eq!(file.cloud.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(file.cloud.colors[0], [255, 0, 0]);
    assert_eq!(file.cloud.colors[3], [51, 102, 153]);
    assert_eq!(file.warnings.len(), 1, "{:?}", file.warnings);
    assert!(file.warnings[0].contains("(x, -z, y)"));
}

#[test]
fn a_rotation_and_a_matrix_do_the_same() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // A quarter turn about glTF's y: z becomes x.
    let turned =
        changed(|d| d["nodes"][1] = json!({"mesh": 0, "rotation": [0.0, half, 0.0, half]}));
    let matrix = [
        0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ];
    let by_matrix = changed(|d| d["nodes"][1] = json!({"mesh": 0, "matrix": matrix}));
    let (turned, by_matrix) = (turned.unwrap().cloud, by_matrix.unwrap().cloud);
    // (4, 1, -2) becomes (-2, 1, -4), then z up (-2, 4, 1).
    let expected = DVec3::new(499_998.125, 5_000_004.0, 1.0);
    assert!((turned.points[2] - expected).length() < 1e-8);
    assert!((by_matrix.points[2] - expected).length() < 1e-8);
}

#[test]
fn strips_fans_points_and_lines() {
    let with_mode = |mode: u32| {
        changed(|d| {
            d["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}, "mode": mode});
        })
    };
    assert_eq!(with_mode(4).unwrap().cloud.triangles, [[0, 1, 2]]);
    assert_eq!(
        with_mode(5).unwrap().cloud.triangles,
        [[0, 1, 2], [1, 2, 3]]
    );
    assert_eq!(
        with_mode(6).unwrap().cloud.triangles,
        [[0, 1, 2], [0, 2, 3]]
    );
    let points = with_mode(0).unwrap().cloud;
    assert_eq!((points.points.len(), points.triangles.len()), (4, 0));
    assert!(with_mode(1).is_err());
    assert!(with_mode(7).is_err());
    let both = changed(|d| {
        let line = json!({"attributes": {"POSITION": 0}, "mode": 3});
        d["meshes"][0]["primitives"]
            .as_array_mut()
            .unwrap()
            .push(line);
    });
    assert!(both.unwrap().warnings[1].starts_with("1 of its primitives"));
}

#[test]
fn primitives_share_vertices() {
    let file = changed(|d| {
        let primitives = d["meshes"][0]["primitives"].as_array_mut().unwrap();
        primitives.push(primitives[0].clone());
    });
    let cloud = file.unwrap().cloud;
    assert_eq!((cloud.points.len(), cloud.triangles.len()), (4, 4));
}

#[test]
fn sparse_and_quantized_values() {
    // The third corner is replaced by the second's bytes.
    let file = changed(|d| {
        d["accessors"][0]["sparse"] = json!({
            "count": 1,
            "indices": {"bufferView": 1, "byteOffset": 4, "componentType": 5123},
            "values": {"bufferView": 0, "byteOffset": 12},
        });
    });
    let points = file.unwrap().cloud.points;
    assert_eq!(points[2], points[1]);
    // Colours' bytes as positions: whole numbers, then fractions.
    for (normalized, x) in [(false, 51.0), (true, 0.2)] {
        let file = changed(|d| {
            d["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
            d["nodes"] = json!([{"mesh": 0}]);
            d["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 3});
            let quantized = json!({"bufferView": 2, "componentType": 5121, "normalized": normalized, "count": 4, "type": "VEC3"});
            d["accessors"].as_array_mut().unwrap().push(quantized);
        });
        let last = file.unwrap().cloud.points[3];
        assert!(
            (last - DVec3::new(x, -3.0 * x, 2.0 * x)).length() < 1e-12,
            "{last}"
        );
    }
}

#[test]
fn buffers_in_text_and_beside() {
    let (mut document, buffer) = square();
    // RFC 4648's example of 10 bits and more, then the whole buffer.
    assert_eq!(
        from_data_uri("application/octet-stream;base64,Zm9vYg==").unwrap(),
        b"foob"
    );
    assert_eq!(from_data_uri("text/plain,foob"), None);
    assert_eq!(from_data_uri("a;base64,Zm9v*g=="), None);
    document["buffers"][0]["uri"] = json!("part%20one.bin");
    let text = serde_json::to_vec(&document).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.gltf");
    fs::write(&path, &text).unwrap();
    fs::write(folder.path().join("part one.bin"), &buffer).unwrap();
    let beside = |name: &str| read_beside(&path, name);
    let file = read(text.as_slice(), &beside, &Progress::default()).unwrap();
    assert_eq!(file.cloud.points.len(), 4);

    for outside in [
        "../x.bin",
        "%2e%2e/x.bin",
        "/etc/passwd",
        "http://a/b.bin",
        "file:///etc/passwd",
        "..\\x",
        "%2",
    ] {
        let fault = read_beside(&path, outside).unwrap_err();
        assert!(
            fault.what.contains("not in its own folder"),
            "{outside}: {fault}"
        );
    }
    assert!(
        read_beside(&path, "none.bin")
            .unwrap_err()
            .what
            .contains("no such file")
    );
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/etc/passwd", folder.path().join("link.bin")).unwrap();
        let fault = read_beside(&path, "link.bin").unwrap_err();
        assert!(fault.what.contains("not in its own folder"), "{fault}");
    }
}

#[test]
fn what_is_not_known_is_refused_in_words() {
    for (name, what) in [
        ("KHR_draco_mesh_compression", "compressed"),
        ("EXT_meshopt_compression", "compressed"),
        (
            "EXT_mesh_gpu_instancing",
            "requires the extension EXT_mesh_gpu_instancing",
        ),
    ] {
        let fault = changed(|d| d["extensionsRequired"] = json!([name])).unwrap_err();
        assert!(fault.what.contains(what), "{fault}");
    }
    let fault = changed(|d| d["extensionsUsed"] = json!(["CESIUM_RTC"])).unwrap_err();
    assert!(fault.what.contains("CESIUM_RTC"), "{fault}");
    let fault = changed(|d| d["asset"]["version"] = json!("1.0")).unwrap_err();
    assert!(fault.what.contains("glTF 1.0"), "{fault}");
}

#[test]
fn what_points_nowhere_is_an_error() {
    let cases: [(&str, Value); 15] = [
        ("/scene", json!(3)),
        ("/scenes/0/nodes/0", json!(9)),
        ("/nodes/0/children/0", json!(9)),
        // A circle.
        ("/nodes/1/children", json!([0])),
        ("/nodes/1/mesh", json!(1)),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(9)),
        ("/meshes/0/primitives/0/indices", json!(9)),
        ("/accessors/0/count", json!(1_000_000_000_000_u64)),
        ("/accessors/0/byteOffset", json!(u64::MAX)),
        ("/accessors/0/type", json!("MAT4")),
        ("/accessors/0/componentType", json!(5130)),
        ("/accessors/1/bufferView", json!(9)),
        ("/bufferViews/0/byteOffset", json!(u64::MAX)),
        ("/bufferViews/2/byteStride", json!(0)),
        ("/buffers/0/byteLength", json!(77)),
    ];
    for (pointer, value) in cases {
        let (mut document, buffer) = square();
        match document.pointer_mut(pointer) {
            Some(place) => *place = value,
            None => {
                let (parent, key) = pointer.rsplit_once('/').unwrap();
                document.pointer_mut(parent).unwrap()[key] = value;
            }
        }
        assert!(parse(&glb(&document, &buffer)).is_err(), "{pointer}");
    }
    // Zeros that take no room, and a mesh repeated without end.
    let zeros = changed(|d| {
        d["accessors"][0] =
            json!({"componentType": 5126, "count": 1_000_000_000_000_u64, "type": "VEC3"});
    });
    assert!(zeros.is_err());
    let repeated = changed(|d| {
        d["scenes"][0]["nodes"] = (0..100).collect();
        d["nodes"] = (0..100).map(|_| json!({"mesh": 0})).collect();
    });
    assert!(repeated.unwrap_err().what.contains("repeat"));
}

#[test]
fn truncation_is_an_error() {
    let (document, buffer) = square();
    let whole = glb(&document, &buffer);
    for end in 0..whole.len() {
        assert!(parse(&whole[..end]).is_err(), "cut at {end}");
    }
    let deep = format!("{{\"asset\":{}", "[".repeat(100_000));
    assert!(parse(deep.as_bytes()).is_err());
}

proptest! {
    #[test]
    fn no_damage_panics(at in 0..2000_usize, byte in any::<u8>()) {
        let (document, buffer) = square();
        let mut bytes = glb(&document, &buffer);
        let at = at % bytes.len();
        bytes[at] = byte;
        let _ = parse(&bytes);
    }
}
