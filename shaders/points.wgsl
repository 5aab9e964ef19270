// The cloud: round points that face the eye, larger where they are nearer. An instance is a point.

struct Point {
    @builtin(position) clip: vec4<f32>,
    @location(0) corner: vec2<f32>,
    @location(1) local: vec3<f32>,
    @location(2) color: vec3<f32>,
    @location(3) normal: vec3<f32>,
    @location(4) @interpolate(flat) radius: f32,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) local: vec3<f32>,
    @location(1) color: vec4<f32>,
    @location(2) normal: vec4<f32>,
) -> Point {
    let corner = vec2(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let clip = frame.clip_from_local * vec4(local, 1.0);
    let least = max(0.7 * frame.point, frame.least);
    let radius = clamp(frame.radius / (frame.texel * clip.w), least, max(16.0 * frame.point, least));
    var point: Point;
    point.clip = vec4(clip.xy + corner * radius * 2.0 / frame.size * clip.w, clip.zw);
    point.corner = corner;
    point.local = local;
    point.color = color.rgb;
    point.normal = normal.xyz;
    point.radius = radius;
    if is_clipped(local) {
        point.clip = vec4(2.0, 2.0, 2.0, 1.0);
    }
    return point;
}

@fragment
fn fragment(point: Point) -> @location(0) vec4<f32> {
    let color = surface_color(
        point.local,
        point.color,
        seen_side(point.normal, point.normal, point.local),
    );
    // The smallest ones are squares: a circle of one texel would have holes.
    if point.radius > 1.0 && dot(point.corner, point.corner) > 1.0 {
        discard;
    }
    return color;
}
