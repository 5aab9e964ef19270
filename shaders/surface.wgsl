// What points and mesh share: the colour of a piece of surface.

// The selected photo, undistorted, and how deep it sees.
@group(1) @binding(0) var photo: texture_2d_array<f32>;
@group(1) @binding(1) var photo_sampler: sampler;
@group(1) @binding(2) var photo_depth: texture_2d<f32>;

fn viridis(share: f32) -> vec3<f32> {
    let place = clamp(share, 0.0, 1.0) * 16.0;
    let below = min(u32(place), 15u);
    return mix(frame.viridis[below].rgb, frame.viridis[below + 1u].rgb, place - f32(below));
}

// Soft light: the sky, and a sun in the north-west as on maps. Level ground gets 1.
fn light(normal: vec3<f32>) -> f32 {
    if dot(normal, normal) < 0.1 {
        return 1.0;
    }
    let n = normalize(normal);
    let sun = vec3(-0.53, 0.42, 0.74);
    let sky = 0.5 + 0.5 * n.z;
    let lit = 0.30 + 0.22 * sky + 0.65 * max(dot(n, sun), 0.0);
    return lit;
}

// How much of a piece of surface the photo sees, from its own depths: the four texels around,
// weighted, so that edges are smooth. `at` is (u w, v w, w).
fn seen(at: vec3<f32>) -> f32 {
    let size = vec2<f32>(textureDimensions(photo_depth));
    let place = at.xy / at.z * size - 0.5;
    let corner = floor(place);
    let part = place - corner;
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        let step = vec2(f32(i & 1), f32(i >> 1u));
        let texel = clamp(corner + step, vec2(0.0), size - 1.0);
        let depth = textureLoad(photo_depth, vec2<i32>(texel), 0).r;
        // One hundredth deeper than what the photo sees is still seen: texels are coarse.
        let visible = at.z * depth <= frame.photo_near * 1.01;
        let weight = mix(1.0 - part, part, step);
        sum += select(0.0, weight.x * weight.y, visible);
    }
    return sum;
}

// The normal on the side that is seen: files wind their triangles either way. `face` is across the
// piece of surface, to whichever side.
fn seen_side(normal: vec3<f32>, face: vec3<f32>, local: vec3<f32>) -> vec3<f32> {
    let to_eye = frame.eye.xyz - local * frame.eye.w;
    return select(normal, -normal, dot(normal, face) * dot(face, to_eye) < 0.0);
}

fn surface_color(local: vec3<f32>, own: vec3<f32>, normal: vec3<f32>) -> vec4<f32> {
    let image = frame.image_from_local * vec4(local, 1.0);
    let share = image.xy / image.z;
    // Here, where every neighbour comes by.
    let across = dpdx(share);
    let down = dpdy(share);
    let shade = light(normal);
    let grey = vec3(0.62, 0.62, 0.61);

    var color = own;
    switch frame.color_by {
        case 1u: {
            let z = local.z + frame.elevation;
            color = viridis((z - frame.range.x) / (frame.range.y - frame.range.x));
        }
        case 2u: {
            color = grey;
            if dot(normal, normal) > 0.1 {
                let slope = degrees(acos(min(abs(normalize(normal).z), 1.0)));
                color = viridis((slope - frame.range.x) / (frame.range.y - frame.range.x));
            }
        }
        default: {}
    }
    // Colour photographs bring their own light and shadow along.
    color *= mix(1.0, shade, select(0.85, 0.6, frame.color_by == 0u));

    if frame.color_by == 3u || frame.project == 1u {
        var inside = 0.0;
        if image.z > 0.0 && all(share >= vec2(0.0)) && all(share <= vec2(1.0)) {
            inside = seen(image.xyz);
        }
        if frame.color_by == 3u {
            let scale = frame.photo_scale / image.z;
            let mapped = viridis((scale - frame.range.x) / (frame.range.y - frame.range.x));
            color = mix(grey * shade, mapped * mix(1.0, shade, 0.6), inside);
        }
        if frame.project == 1u {
            let texel = textureSampleGrad(photo, photo_sampler, share, 0, across, down);
            color = mix(color, texel.rgb, inside);
        }
    }
    return vec4(color, 1.0);
}
