// Eye-dome lighting (Boucheny 2009), from depth alone: a texel is darker where it lies deeper than
// the mean of two opposite neighbours, as in a gap between stones or behind an edge. Opposite pairs
// cancel out the slope, so that plain ground stays plain however flat the view. Puts the surface on
// its background, and its depths to where photos and lines are drawn.

@group(1) @binding(0) var surface: texture_2d<f32>;
@group(1) @binding(1) var depth: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return cover(index);
}

// How much nearer a neighbour is; the background is no neighbour.
fn nearer(at: vec2<i32>, here: f32) -> f32 {
    let there = textureLoad(depth, clamp(at, vec2(0), vec2<i32>(frame.size) - 1), 0).r;
    if there <= 0.0 {
        return 0.0;
    }
    return here - distance_of(there);
}

struct Texel {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> Texel {
    let at = vec2<i32>(position.xy);
    let there = textureLoad(depth, at, 0).r;
    return Texel(lit(at, there), there);
}

fn lit(at: vec2<i32>, there: f32) -> vec4<f32> {
    if there <= 0.0 {
        return frame.background;
    }
    let color = textureLoad(surface, at, 0).rgb;
    if frame.relief <= 0.0 {
        return vec4(color, 1.0);
    }
    let here = distance_of(there);
    let texel = frame.texel * select(here, 1.0, frame.parallel > 0.5);
    var sum = 0.0;
    // Two rings: fine cracks, and the gaps between stones.
    for (var ring = 0; ring < 2; ring++) {
        let radius = frame.point * select(1.5, 4.5, ring == 1);
        for (var i = 0; i < 4; i++) {
            let angle = (f32(i) + f32(ring) * 0.5) * 0.7853982;
            let step = vec2<i32>(round(vec2(cos(angle), sin(angle)) * radius));
            let pair = 0.5 * (nearer(at + step, here) + nearer(at - step, here));
            // In steps of 45 degrees across the ring; a cliff is not darker than a deep gap.
            sum += clamp(pair / (texel * radius), 0.0, 2.0);
        }
    }
    return vec4(color * exp(-frame.relief * sum / 8.0), 1.0);
}
