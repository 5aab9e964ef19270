// Photos on planes in the world. An instance is a photo; its corners are those of the image.

@group(1) @binding(0) var photos: texture_2d_array<f32>;
@group(1) @binding(1) var photo_sampler: sampler;

struct Place {
    @builtin(position) clip: vec4<f32>,
    @location(0) share: vec2<f32>,
    @location(1) @interpolate(flat) layer: u32,
    @location(2) @interpolate(flat) opacity: f32,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) top_left: vec3<f32>,
    @location(1) across: vec3<f32>,
    @location(2) down: vec3<f32>,
    @location(3) layer: u32,
    @location(4) opacity: f32,
) -> Place {
    let share = vec2(f32(index & 1u), f32(index >> 1u));
    var place: Place;
    place.clip = frame.clip_from_local * vec4(top_left + across * share.x + down * share.y, 1.0);
    place.share = share;
    place.layer = layer;
    place.opacity = opacity;
    return place;
}

@fragment
fn fragment(place: Place) -> @location(0) vec4<f32> {
    let color = textureSample(photos, photo_sampler, place.share, place.layer);
    let alpha = color.a * place.opacity;
    return vec4(color.rgb * alpha, alpha);
}
