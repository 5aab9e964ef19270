//! glTF 2.0: "glTF 2.0 Specification", Khronos Group (ISO/IEC 12113), as .gltf and as .glb.
//!
//! - .glb: magic "glTF", version 2, length; then chunks of a length, a type (JSON or BIN) and bytes.
//! - Buffers are the .glb's BIN chunk, a data URI in base64, or a file in the same folder: no other
//!   place is read.
//! - The default scene's nodes, each with its transform on its parent's, place meshes. Triangles,
//!   strips and fans become triangles, points stay points, lines are left out and said.
//! - Positions are f32, or integers with KHR_mesh_quantization. COLOR_0 are linear colours of the
//!   vertices; they are taken without the sRGB curve, as most programs that write clouds do.
//! - y is up by specification: (x, y, z) becomes (x, -z, y), and a warning says so.
//! - Skins, morph targets and instances by extension are not applied. Compressed meshes (Draco,
//!   meshopt) and every other extension that a file requires and that changes shapes are refused.
//!
//! By hand on serde_json and not with the gltf crate (1.4): that one panics on an index that points
//! nowhere, refuses files for materials that do not matter here, and reads the nodes' translations as
//! f32, where UTM coordinates lose half a metre.

mod accessor;
mod document;

use std::collections::HashMap;
use std::io::Read;
use std::path::{Component, Path};

use glam::{DMat4, DVec3};

use crate::clouds::cloud_file::{CloudFile, Rounded};
use crate::fault::Fault;
use crate::files::read_bytes;
use crate::jobs::Progress;
use accessor::Data;
use document::{Document, Primitive};

const REMEDY: &str = "export it again";

/// Reads a glTF file; `beside` reads a file that it names.
///
/// # Errors
/// Where it is no such file, needs what is not known here, or something points nowhere.
pub(crate) fn read(
    mut input: impl Read,
    beside: &dyn Fn(&str) -> Result<Vec<u8>, Fault>,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut bytes = Vec::new();
    input
        .read_to_end(&mut bytes)
        .map_err(|e| Fault::new(format!("it cannot be read ({e})"), "check the disk"))?;
    let (json, binary) = if bytes.starts_with(b"glTF") {
        chunks(&bytes)?
    } else {
        (bytes.as_slice(), None)
    };
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    let document: Document = serde_json::from_slice(json).map_err(|e| {
        let what = format!("it cannot be read as glTF ({e})");
        Fault::at(e.line() as u64, what, REMEDY)
    })?;
    if document.asset.version.split('.').next() != Some("2") {
        let version = &document.asset.version;
        return Err(Fault::new(
            format!("it is glTF {version}; only 2.0 is known"),
            "export glTF 2.0",
        ));
    }
    check_extensions(&document)?;
    let mut buffers = Vec::new();
    for (index, buffer) in document.buffers.iter().enumerate() {
        let bytes = match (&buffer.uri, binary) {
            (Some(uri), _) => match uri.strip_prefix("data:") {
                Some(data) => from_data_uri(data).ok_or_else(|| {
                    Fault::new(format!("buffer {index} is no base64 data"), REMEDY)
                })?,
                None => beside(uri)?,
            },
            (None, Some(binary)) if index == 0 => binary.to_vec(),
            (None, _) => {
                let what = format!("buffer {index} is nowhere in the file");
                return Err(Fault::new(what, REMEDY));
            }
        };
        if bytes.len() < buffer.byte_length {
            return Err(Fault::new(
                format!(
                    "buffer {index} has {} of the {} bytes that it should",
                    bytes.len(),
                    buffer.byte_length
                ),
                "copy or export it again",
            ));
        }
        buffers.push(bytes);
    }
    let mut scene = Scene {
        budget: buffers.iter().map(Vec::len).sum(),
        data: Data {
            document: &document,
            buffers,
        },
        file: CloudFile::default(),
        lines: 0,
    };
    scene.read(progress)?;
    let Scene {
        mut file, lines, ..
    } = scene;
    file.expect_points()?;
    if file.cloud.points.iter().any(|point| !point.is_finite()) {
        return Err(Fault::new(
            "a vertex has a coordinate that is not a finite number",
            REMEDY,
        ));
    }
    for point in &mut file.cloud.points {
        *point = DVec3::new(point.x, -point.z, point.y);
    }
    file.warnings.push(
        "glTF has y up: its coordinates (x, y, z) were turned to (x, -z, y), with z up".to_owned(),
    );
    if lines > 0 {
        file.warnings
            .push(format!("{lines} of its primitives are lines and left out"));
    }
    Ok(file)
}

/// Reads a file that the glTF file at `path` names: one of its own folder or below, and no other.
///
/// # Errors
/// Where the name leads elsewhere, or the file cannot be read.
pub(crate) fn read_beside(path: &Path, uri: &str) -> Result<Vec<u8>, Fault> {
    let outside = || {
        Fault::new(
            format!("its buffer '{uri}' is not in its own folder"),
            "export it as .glb, or put the file beside it",
        )
    };
    let name = percent_decoded(uri).ok_or_else(outside)?;
    let inside = Path::new(&name)
        .components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !inside || name.contains(':') || name.contains('\\') {
        return Err(outside());
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let file = folder.join(&name);
    // Links may lead out of the folder.
    if let (Ok(file), Ok(folder)) = (file.canonicalize(), folder.canonicalize())
        && !file.starts_with(folder)
    {
        return Err(outside());
    }
    read_bytes(&file).map_err(|error| {
        Fault::new(
            format!("its buffer '{uri}': {}", error.fault.what),
            error.fault.remedy,
        )
    })
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = uri.bytes();
    let mut decoded = Vec::new();
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let digits = [bytes.next()?, bytes.next()?];
            let digits = std::str::from_utf8(&digits).ok()?;
            decoded.push(u8::from_str_radix(digits, 16).ok()?);
        } else {
            decoded.push(byte);
        }
    }
    String::from_utf8(decoded).ok()
}

/// The bytes of a data URI behind "data:".
fn from_data_uri(data: &str) -> Option<Vec<u8>> {
    let (kind, text) = data.split_once(',')?;
    if !kind.ends_with(";base64") {
        return None;
    }
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0_u32, 0);
    for byte in text.trim_end_matches('=').bytes() {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(six);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    Some(bytes)
}

/// The JSON and the BIN chunk of a .glb.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let damaged = |what: &str| Fault::new(format!("its {what}"), "copy or export it again");
    let word = |at: usize| {
        let four = bytes.get(at..)?.first_chunk::<4>()?;
        Some(u32::from_le_bytes(*four))
    };
    let version = word(4).unwrap_or(0);
    if version != 2 {
        return Err(Fault::new(
            format!("it is binary glTF {version}; only 2 is known"),
            "export glTF 2.0",
        ));
    }
    let mut at = 12;
    let (mut json, mut binary) = (None, None);
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let begin = at + 8;
        let chunk = usize::try_from(length)
            .ok()
            .and_then(|length| bytes.get(begin..begin.checked_add(length)?))
            .ok_or_else(|| damaged("chunks reach beyond its end"))?;
        // "JSON" and "BIN\0"; others may follow and are to be passed over.
        match kind {
            0x4e4f_534a if json.is_none() => json = Some(chunk),
            0x004e_4942 if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at = begin + chunk.len();
    }
    let json = json.ok_or_else(|| damaged("JSON chunk is missing"))?;
    Ok((json, binary))
}

/// Looks and lights do not change where things are.
fn check_extensions(document: &Document) -> Result<(), Fault> {
    // Used, though not required: without it all is somewhere else.
    if document
        .extensions_used
        .iter()
        .any(|name| name == "CESIUM_RTC")
    {
        return Err(Fault::new(
            "its coordinates count from a place that an extension names (CESIUM_RTC), which is not read",
            "export it with the offset as a node's translation",
        ));
    }
    for name in &document.extensions_required {
        let harmless = [
            "KHR_materials_",
            "KHR_texture_",
            "KHR_lights_",
            "EXT_texture_",
            "MSFT_texture_",
        ];
        if name == "KHR_mesh_quantization" || harmless.iter().any(|start| name.starts_with(start)) {
            continue;
        }
        return Err(match name.as_str() {
            "KHR_draco_mesh_compression"
            | "EXT_meshopt_compression"
            | "KHR_meshopt_compression" => Fault::new(
                format!("its meshes are compressed ({name})"),
                "export it without compression",
            ),
            _ => Fault::new(
                format!("it requires the extension {name}, which is not known here"),
                "export it without",
            ),
        });
    }
    Ok(())
}

/// What is made of a scene.
struct Scene<'a> {
    data: Data<'a>,
    file: CloudFile,
    /// How many vertices may still come: nodes may repeat meshes without end.
    budget: usize,
    /// Primitives that are lines.
    lines: usize,
}

impl Scene<'_> {
    fn read(&mut self, progress: &Progress) -> Result<(), Fault> {
        let document = self.data.document;
        let nowhere =
            |what: &str, index: usize| Fault::new(format!("there is no {what} {index}"), REMEDY);
        let roots: Vec<usize> = match (document.scene, document.scenes.first()) {
            (Some(scene), _) => {
                let scene_there = document.scenes.get(scene);
                let scene = scene_there.ok_or_else(|| nowhere("scene", scene))?;
                scene.nodes.clone()
            }
            (None, Some(scene)) => scene.nodes.clone(),
            (None, None) => {
                let mut is_child = vec![false; document.nodes.len()];
                for &child in document.nodes.iter().flat_map(|node| &node.children) {
                    *is_child
                        .get_mut(child)
                        .ok_or_else(|| nowhere("node", child))? = true;
                }
                (0..document.nodes.len())
                    .filter(|&node| is_child.get(node) == Some(&false))
                    .collect()
            }
        };
        let mut seen = vec![false; document.nodes.len()];
        let mut done = 0;
        let mut waiting: Vec<(usize, DMat4)> = roots
            .into_iter()
            .map(|root| (root, DMat4::IDENTITY))
            .collect();
        while let Some((index, world_from_parent)) = waiting.pop() {
            let (Some(node), Some(seen)) = (document.nodes.get(index), seen.get_mut(index)) else {
                return Err(nowhere("node", index));
            };
            if std::mem::replace(seen, true) {
                return Err(Fault::new(
                    format!("node {index} hangs in its tree twice"),
                    REMEDY,
                ));
            }
            progress.advance(done, document.nodes.len() as u64)?;
            done += 1;
            let world_from_node = world_from_parent * node.parent_from_node();
            if let Some(mesh) = node.mesh {
                let mesh_there = document.meshes.get(mesh);
                let mesh = mesh_there.ok_or_else(|| nowhere("mesh", mesh))?;
                // Primitives of one mesh often share their vertices.
                let mut known = HashMap::new();
                for primitive in &mesh.primitives {
                    self.add(primitive, &world_from_node, &mut known)?;
                }
            }
            waiting.extend(node.children.iter().map(|&child| (child, world_from_node)));
        }
        Ok(())
    }

    fn add(
        &mut self,
        primitive: &Primitive,
        world_from_node: &DMat4,
        known: &mut HashMap<(usize, Option<usize>), u32>,
    ) -> Result<(), Fault> {
        if (1..=3).contains(&primitive.mode) {
            self.lines += 1;
            return Ok(());
        }
        let attributes = &primitive.attributes;
        let Some(position) = attributes.position else {
            return Err(Fault::new("a primitive has no POSITION", REMEDY));
        };
        let count = self.data.accessor(position)?.count;
        let base = match known.get(&(position, attributes.color)) {
            Some(base) => *base,
            None => {
                let base = self.add_vertices(position, attributes.color, world_from_node)?;
                known.insert((position, attributes.color), base);
                base
            }
        };
        let corners: Vec<u32> = match primitive.indices {
            Some(indices) => {
                let indices: Vec<[f64; 1]> = self.data.read(indices, &["SCALAR"])?;
                self.take(indices.len())?;
                indices
                    .into_iter()
                    .map(|[index]| {
                        if index < 0.0 || index >= count as f64 || index.fract() != 0.0 {
                            let what =
                                format!("a face names vertex {index}, but there are {count}");
                            return Err(Fault::new(what, REMEDY));
                        }
                        // Below the number of points, which fits.
                        Ok(base + index as u32)
                    })
                    .collect::<Result<_, _>>()?
            }
            None => (base..).take(count).collect(),
        };
        let triangles = &mut self.file.cloud.triangles;
        match primitive.mode {
            0 => {}
            4 => triangles.extend(corners.as_chunks::<3>().0),
            5 => triangles.extend(corners.array_windows::<3>()),
            6 => self.file.cloud.add_polygon(&corners),
            mode => {
                let what = format!("a primitive has the mode {mode}");
                return Err(Fault::new(what, REMEDY));
            }
        }
        Ok(())
    }

    /// Adds vertices; returns the number of the first.
    fn add_vertices(
        &mut self,
        position: usize,
        color: Option<usize>,
        world_from_node: &DMat4,
    ) -> Result<u32, Fault> {
        let base = self.file.cloud.points.len();
        let positions: Vec<[f64; 3]> = self.data.read(position, &["VEC3"])?;
        self.take(positions.len())?;
        if base + positions.len() >= u32::MAX as usize {
            let what = "it has over 4 294 967 295 vertices";
            return Err(Fault::new(what, "reduce the mesh"));
        }
        let colors: Option<Vec<[f64; 4]>> = color
            .map(|color| self.data.read(color, &["VEC3", "VEC4"]))
            .transpose()?;
        // Integers that are no fractions are not allowed for colours, and are written all the same.
        let full = match color.map(|color| self.data.accessor(color)).transpose()? {
            Some(accessor) if !accessor.normalized => match accessor.component_type {
                5121 => 255.0,
                5123 => 65_535.0,
                _ => 1.0,
            },
            _ => 1.0,
        };
        let own: Vec<DVec3> = positions.into_iter().map(DVec3::from_array).collect();
        if let Some(rounded) = Rounded::of(&own)
            && self.data.accessor(position)?.component_type == 5126
        {
            self.file.take_rounded(rounded, rounded.to_string());
        }
        for (index, point) in own.into_iter().enumerate() {
            let color = colors.as_ref().and_then(|colors| colors.get(index));
            // `as` saturates.
            let color =
                color.map(|[r, g, b, _]| [r, g, b].map(|c| (c / full * 255.0).round() as u8));
            self.file
                .push(world_from_node.transform_point3(point), color);
        }
        Ok(base as u32)
    }

    /// Notes that so many vertices or indices are taken from the file, each of which is at least a byte.
    fn take(&mut self, count: usize) -> Result<(), Fault> {
        self.budget = self.budget.checked_sub(count).ok_or_else(|| {
            Fault::new(
                "its nodes repeat its meshes too often",
                "export each piece once",
            )
        })?;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
