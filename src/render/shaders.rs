//! The shaders, each with what it needs in front of it.

/// The shared frame uniform.
const FRAME: &str = include_str!("../../shaders/frame.wgsl");
/// What points and mesh share.
const SURFACE: &str = include_str!("../../shaders/surface.wgsl");

/// A shader's name and its text in parts.
pub(super) type Shader = (&'static str, &'static [&'static str]);

pub(super) const POINTS: Shader = (
    "points",
    &[FRAME, SURFACE, include_str!("../../shaders/points.wgsl")],
);
pub(super) const MESH: Shader = (
    "mesh",
    &[FRAME, SURFACE, include_str!("../../shaders/mesh.wgsl")],
);
pub(super) const LINES: Shader = ("lines", &[FRAME, include_str!("../../shaders/lines.wgsl")]);
pub(super) const IMAGES: Shader = (
    "images",
    &[FRAME, include_str!("../../shaders/images.wgsl")],
);
pub(super) const FILL: Shader = ("fill", &[FRAME, include_str!("../../shaders/fill.wgsl")]);
pub(super) const EDL: Shader = ("edl", &[FRAME, include_str!("../../shaders/edl.wgsl")]);
pub(super) const RESOLVE: Shader = (
    "resolve",
    &[FRAME, include_str!("../../shaders/resolve.wgsl")],
);

#[cfg(test)]
mod tests {
    use super::*;

    /// Without a graphics card: what naga refuses, no driver ever sees.
    #[test]
    fn every_shader_is_valid() {
        for (name, parts) in [POINTS, MESH, LINES, IMAGES, FILL, EDL, RESOLVE] {
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
        let module = naga::front::wgsl::parse_str(FRAME).unwrap();
        let (_, kind) = module
            .types
            .iter()
            .find(|(_, kind)| kind.name.as_deref() == Some("Frame"))
            .unwrap();
        let naga::TypeInner::Struct { span, members } = &kind.inner else {
            panic!("Frame is no struct");
        };
        assert_eq!(*span as usize, size_of::<crate::frame::Frame>());
        let offset = |name: &str| {
            let member = members.iter().find(|m| m.name.as_deref() == Some(name));
            member.unwrap().offset as usize
        };
        use crate::frame::Frame;
        assert_eq!(offset("range"), std::mem::offset_of!(Frame, range));
        assert_eq!(offset("color_by"), std::mem::offset_of!(Frame, color_by));
        assert_eq!(offset("viridis"), std::mem::offset_of!(Frame, viridis));
    }
}
