// Four samples become one pixel.

@group(1) @binding(0) var sampled: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return cover(index);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy) * 2;
    var sum = vec4(0.0);
    for (var i = 0; i < 4; i++) {
        sum += textureLoad(sampled, at + vec2(i & 1, i >> 1u), 0);
    }
    return sum * 0.25;
}
