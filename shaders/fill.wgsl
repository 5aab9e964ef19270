// The insides of footprints, translucent.
//
// On the surface: a pyramid from the camera centre through the image corners is drawn; of what the
// depth texture says is there, the part that the photo's corners enclose is tinted. So the fill lies
// on every stone, on points as on triangles. Where no surface is, but the ground, cells are given as
// triangles.

@group(1) @binding(0) var depth: texture_2d<f32>;

struct Pyramid {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) u: vec4<f32>,
    @location(1) @interpolate(flat) v: vec4<f32>,
    @location(2) @interpolate(flat) w: vec4<f32>,
    @location(3) @interpolate(flat) upper: vec4<f32>,
    @location(4) @interpolate(flat) lower: vec4<f32>,
    @location(5) @interpolate(flat) color: vec4<f32>,
    @location(6) @interpolate(flat) reach: f32,
}

// Four sides and a base of two triangles, counter-clockwise from outside where the image's corners
// go clockwise as seen by the camera. 4 is the apex.
const FACES = array<u32, 18>(4u, 0u, 1u, 4u, 1u, 2u, 4u, 2u, 3u, 4u, 3u, 0u, 0u, 2u, 1u, 0u, 3u, 2u);

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) apex: vec3<f32>,
    @location(1) top_left: vec3<f32>,
    @location(2) top_right: vec3<f32>,
    @location(3) bottom_right: vec3<f32>,
    @location(4) bottom_left: vec3<f32>,
    // Rows of image_from_local.
    @location(5) u: vec4<f32>,
    @location(6) v: vec4<f32>,
    @location(7) w: vec4<f32>,
    // The image corners in shares of the image: top left and top right, bottom right and bottom left.
    @location(8) upper: vec4<f32>,
    @location(9) lower: vec4<f32>,
    @location(10) color: vec4<f32>,
    @location(11) reach: f32,
) -> Pyramid {
    var corners = array<vec3<f32>, 5>(top_left, top_right, bottom_right, bottom_left, apex);
    var faces = FACES;
    var pyramid: Pyramid;
    pyramid.clip = frame.clip_from_local * vec4(corners[faces[index]], 1.0);
    pyramid.u = u;
    pyramid.v = v;
    pyramid.w = w;
    pyramid.upper = upper;
    pyramid.lower = lower;
    pyramid.color = color;
    pyramid.reach = reach;
    return pyramid;
}

// Whether a point is on the inner side of the edge from a to b, corners going clockwise on screen.
fn inner(a: vec2<f32>, b: vec2<f32>, p: vec2<f32>) -> bool {
    let edge = b - a;
    let to = p - a;
    return edge.x * to.y - edge.y * to.x >= 0.0;
}

@fragment
fn fragment(pyramid: Pyramid) -> @location(0) vec4<f32> {
    let there = textureLoad(depth, vec2<i32>(pyramid.clip.xy), 0).r;
    if there <= 0.0 {
        discard;
    }
    let at = frame.local_from_clip * vec4(ndc_of(pyramid.clip.xy), there, 1.0);
    let local = vec4(at.xyz / at.w, 1.0);
    let w = dot(pyramid.w, local);
    if w <= 0.0 || w > pyramid.reach {
        discard;
    }
    let share = vec2(dot(pyramid.u, local), dot(pyramid.v, local)) / w;
    let inside = inner(pyramid.upper.xy, pyramid.upper.zw, share)
        && inner(pyramid.upper.zw, pyramid.lower.xy, share)
        && inner(pyramid.lower.xy, pyramid.lower.zw, share)
        && inner(pyramid.lower.zw, pyramid.upper.xy, share);
    if !inside {
        discard;
    }
    return vec4(pyramid.color.rgb * pyramid.color.a, pyramid.color.a);
}

struct Cell {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn cell_vertex(@location(0) local: vec3<f32>, @location(1) color: vec4<f32>) -> Cell {
    return Cell(lifted(frame.clip_from_local * vec4(local, 1.0)), color);
}

@fragment
fn cell_fragment(cell: Cell) -> @location(0) vec4<f32> {
    return vec4(cell.color.rgb * cell.color.a, cell.color.a);
}
