//! What is drawn, one file a shader of the same name in `shaders/`: its pipeline, its buffers, its draw
//! calls. `frame` and `surface` are what shaders share; `cover` draws over the whole picture, a `tile` is a
//! piece of a cloud.

pub(crate) mod cover;
pub(crate) mod edl;
pub(crate) mod fill;
pub(crate) mod frame;
pub(crate) mod images;
pub(crate) mod lines;
pub(crate) mod mesh;
pub(crate) mod points;
pub(crate) mod resolve;
pub(crate) mod surface;
pub(crate) mod tile;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::pipeline::Shader;

    const SHADERS: [Shader; 7] = [
        points::SHADER,
        mesh::SHADER,
        lines::SHADER,
        images::SHADER,
        fill::SHADER,
        edl::SHADER,
        resolve::SHADER,
    ];

    /// A shader that is not in the list would not be looked at by the tests.
    #[test]
    fn every_shader_is_in_the_list() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders");
        let files = std::fs::read_dir(folder).unwrap();
        let names = files.map(|file| file.unwrap().path().file_stem().unwrap().to_owned());
        // Parts of others; and what draws nothing, which the tests of `dense` and `reconstruct` run.
        let apart = ["frame", "surface", "patch_match", "match"];
        for name in names.filter(|name| !apart.iter().any(|apart| name == apart)) {
            assert!(SHADERS.iter().any(|shader| name == shader.0), "{name:?}");
        }
    }

    /// Without a graphics card: what naga refuses, no driver ever sees.
    #[test]
    fn every_shader_is_valid() {
        for (name, parts) in SHADERS {
            let source = parts.concat();
            let module = match naga::front::wgsl::parse_str(&source) {
                Ok(module) => module,
                Err(error) => panic!("{name}: {}", error.emit_to_string(&source)),
            };
            let mut validator = naga::valid::Validator::new(
                naga::valid::ValidationFlags::all(),
                naga::valid::Capabilities::empty(),
            );
            if let Err(error) = validator.validate(&module) {
                panic!("{name}: {}", error.emit_to_string(&source));
            }
        }
    }

    /// The uniform's size in the shader is that of the struct that fills it.
    #[test]
    fn the_frame_uniform_has_one_layout() {
        let module = naga::front::wgsl::parse_str(frame::WGSL).unwrap();
        let (_, kind) = module
            .types
            .iter()
            .find(|(_, kind)| kind.name.as_deref() == Some("Frame"))
            .unwrap();
        let naga::TypeInner::Struct { span, members } = &kind.inner else {
            panic!("Frame is no struct");
        };
        assert_eq!(*span as usize, size_of::<frame::FrameUniform>());
        let offset = |name: &str| {
            let member = members.iter().find(|m| m.name.as_deref() == Some(name));
            member.unwrap().offset as usize
        };
        use frame::FrameUniform;
        assert_eq!(
            offset("box_turn"),
            std::mem::offset_of!(FrameUniform, box_turn)
        );
        assert_eq!(offset("range"), std::mem::offset_of!(FrameUniform, range));
        assert_eq!(
            offset("color_by"),
            std::mem::offset_of!(FrameUniform, color_by)
        );
        assert_eq!(
            offset("viridis"),
            std::mem::offset_of!(FrameUniform, viridis)
        );
    }
}
