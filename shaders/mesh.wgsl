// The surface's triangles, and their edges.

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
    @location(1) color: vec3<f32>,
    @location(2) normal: vec3<f32>,
}

@vertex
fn vertex(
    @location(0) local: vec3<f32>,
    @location(1) color: vec4<f32>,
    @location(2) normal: vec4<f32>,
) -> Corner {
    var corner: Corner;
    corner.clip = frame.clip_from_local * vec4(local, 1.0);
    corner.local = local;
    corner.color = color.rgb;
    corner.normal = normal.xyz;
    return corner;
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4<f32> {
    let face = cross(dpdx(corner.local), dpdy(corner.local));
    let normal = seen_side(corner.normal, face, corner.local);
    let color = surface_color(corner.local, corner.color, normal);
    if is_clipped(corner.local) {
        discard;
    }
    return color;
}

struct EdgePoint {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
}

// An edge lies on its triangles.
@vertex
fn edge_vertex(@location(0) local: vec3<f32>) -> EdgePoint {
    return EdgePoint(lifted(frame.clip_from_local * vec4(local, 1.0)), local);
}

@fragment
fn edge_fragment(point: EdgePoint) -> @location(0) vec4<f32> {
    if is_clipped(point.local) {
        discard;
    }
    return frame.ink * 0.28;
}
