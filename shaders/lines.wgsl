// Straight strokes with round ends, as wide as they are on the screen, with smooth edges, whole or
// dashed. An instance is a stroke; one without length is a dot.

// How much of a stroke shows: all, or a trace where it is behind something.
override opacity: f32 = 1.0;

struct Stroke {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) from_texel: vec2<f32>,
    @location(1) @interpolate(flat) to_texel: vec2<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
    // Half the width in texels; length of a dash with its gap in world units, 0 for none.
    @location(3) @interpolate(flat) shape: vec2<f32>,
    // Along the line, world units.
    @location(4) along: f32,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) from_local: vec4<f32>,
    @location(1) to_local: vec4<f32>,
    @location(2) color: vec4<f32>,
    @location(3) width: f32,
) -> Stroke {
    var a = frame.clip_from_local * vec4(from_local.xyz, 1.0);
    var b = frame.clip_from_local * vec4(to_local.xyz, 1.0);
    var along = vec2(from_local.w, from_local.w + distance(from_local.xyz, to_local.xyz));
    // What is behind the eye has no place on the screen: cut there.
    let cut = (frame.nearest - a.w) / (b.w - a.w);
    if a.w < frame.nearest && b.w > frame.nearest {
        a = mix(a, b, cut);
        along.x = mix(along.x, along.y, cut);
    } else if b.w < frame.nearest && a.w > frame.nearest {
        b = mix(a, b, cut);
        along.y = mix(along.x, along.y, cut);
    }
    var stroke: Stroke;
    if a.w < frame.nearest || b.w < frame.nearest {
        // All of it is behind the eye.
        stroke.clip = vec4(2.0, 2.0, 2.0, 1.0);
        return stroke;
    }
    let half_size = frame.size * 0.5;
    let from_texel = (a.xy / a.w * vec2(1.0, -1.0) + 1.0) * half_size;
    let to_texel = (b.xy / b.w * vec2(1.0, -1.0) + 1.0) * half_size;
    var direction = to_texel - from_texel;
    let length = length(direction);
    direction = select(vec2(1.0, 0.0), direction / length, length > 1e-6);
    let normal = vec2(-direction.y, direction.x);
    let half_width = width * 0.5 * frame.point;
    // One texel more, for the smooth edge.
    let reach = half_width + 1.0;
    let end = f32(index >> 1u);
    let side = f32(index & 1u) * 2.0 - 1.0;
    let texel = mix(from_texel, to_texel, end)
        + direction * reach * (end * 2.0 - 1.0)
        + normal * reach * side;
    let clip = lifted(mix(a, b, end));
    stroke.clip = vec4(ndc_of(texel) * clip.w, clip.zw);
    stroke.from_texel = from_texel;
    stroke.to_texel = to_texel;
    stroke.color = color;
    stroke.shape = vec2(half_width, to_local.w);
    stroke.along = mix(along.x, along.y, end);
    return stroke;
}

@fragment
fn fragment(stroke: Stroke) -> @location(0) vec4<f32> {
    let line = stroke.to_texel - stroke.from_texel;
    let here = stroke.clip.xy - stroke.from_texel;
    let share = clamp(dot(here, line) / max(dot(line, line), 1e-9), 0.0, 1.0);
    let off = length(here - line * share);
    var cover = clamp(stroke.shape.x - off + 0.5, 0.0, 1.0);
    let along = stroke.along / max(stroke.shape.y, 1e-20);
    let edge = fwidth(along);
    if stroke.shape.y > 0.0 {
        // Three fifths of a dash are drawn; where dashes are finer than texels, all is drawn paler.
        let place = abs(fract(along) - 0.5);
        let dash = smoothstep(0.3 + edge, 0.3 - edge, place);
        cover *= mix(dash, 0.6, clamp(edge * 2.0 - 0.5, 0.0, 1.0));
    }
    let alpha = stroke.color.a * cover * opacity;
    if alpha <= 0.0 {
        discard;
    }
    return vec4(stroke.color.rgb * alpha, alpha);
}
