// What every shader knows of the frame; put in front of each of them. src/render/frame.rs fills it.

struct Frame {
    // Reverse-z: depth 1 at the near plane, 0 at infinity (in parallel projection at the far plane).
    clip_from_local: mat4x4<f32>,
    local_from_clip: mat4x4<f32>,
    // Of the selected photo: (u w, v w, w, 1), w its depth, (0, 0) to (1, 1) across the image.
    image_from_local: mat4x4<f32>,
    // Premultiplied.
    background: vec4<f32>,
    // Of lines that stand out from the background.
    ink: vec4<f32>,
    // The eye in the local frame and 1; in parallel projection the way to it and 0.
    eye: vec4<f32>,
    // The clipping box: its middle in the local frame; half of its edges; cosine and sine of its turn about
    // the vertical, and 1 where it is on.
    box_middle: vec4<f32>,
    box_half: vec4<f32>,
    box_turn: vec4<f32>,
    // Of the picture, in texels.
    size: vec2<f32>,
    // Perspective: (near, 0). Parallel: (far, far - near).
    depths: vec2<f32>,
    // World size of a texel: at distance 1, in parallel projection everywhere.
    texel: f32,
    // 1 in parallel projection.
    parallel: f32,
    // Texels in a point of the user interface.
    point: f32,
    // Nearer than this along the axis nothing can be projected.
    nearest: f32,
    // How far lines are lifted off the surface: a factor on depth, and a summand.
    lift: vec2<f32>,
    // World units at the colour map's ends.
    range: vec2<f32>,
    // Radius of a point of the cloud, world units.
    radius: f32,
    // Near plane of the photo's own depth texture.
    photo_near: f32,
    // Pixels per world unit of the photo at depth 1.
    photo_scale: f32,
    // World elevation of local z = 0.
    elevation: f32,
    // 0 own colours, 1 elevation, 2 slope, 3 scale.
    color_by: u32,
    // 1: the photo is laid on the surface.
    project: u32,
    // Eye-dome lighting: 0 is off.
    relief: f32,
    // Radius of a point of the cloud at least, texels: where nearer neighbours are not there.
    least: f32,
    viridis: array<vec4<f32>, 17>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Whether a piece of surface lies outside of the clipping box.
fn is_clipped(local: vec3<f32>) -> bool {
    let turn = frame.box_turn;
    let off = local - frame.box_middle.xyz;
    let along = vec3(turn.x * off.x + turn.y * off.y, turn.x * off.y - turn.y * off.x, off.z);
    return turn.z > 0.5 && any(abs(along) > frame.box_half.xyz);
}

// Distance along the view axis of a depth.
fn distance_of(depth: f32) -> f32 {
    if frame.parallel > 0.5 {
        return frame.depths.x - depth * frame.depths.y;
    }
    return frame.depths.x / depth;
}

// Toward the eye by a few texels, so that what lies on the surface is not buried in it.
fn lifted(clip: vec4<f32>) -> vec4<f32> {
    return vec4(clip.xy, clip.z * frame.lift.x + frame.lift.y * clip.w, clip.w);
}

// Where texel coordinates (from the top left) are in normalised device coordinates.
fn ndc_of(texel: vec2<f32>) -> vec2<f32> {
    return vec2(2.0, -2.0) * texel / frame.size + vec2(-1.0, 1.0);
}

// A triangle that covers the picture.
fn cover(index: u32) -> vec4<f32> {
    let x = f32(index & 1u) * 4.0 - 1.0;
    let y = f32(index >> 1u) * 4.0 - 1.0;
    return vec4(x, y, 0.0, 1.0);
}
