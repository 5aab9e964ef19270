// PatchMatch over slanted planes: one colour of the checkerboard over a tile. The mathematics, the constants and
// the random numbers are those of src/dense/patch_match/ (window.rs, cpu.rs, random.rs), where they are
// explained; there the processor counts the same.

struct Settings {
    // Of the tile with its margins, and where it begins in the reference.
    tile: vec2<u32>,
    origin: vec2<u32>,
    // Of the reference.
    size: vec2<u32>,
    range: vec2<f32>,
    per_pixel: f32,
    focal: f32,
    amplitude: f32,
    geometric: f32,
    parity: u32,
    anywhere: u32,
    salt: u32,
    sources: u32,
    // What of the reference's grey levels is here.
    crop_origin: vec2<u32>,
    crop: vec2<u32>,
}

struct Source {
    there: array<vec4<f32>, 4>,
    back: array<vec4<f32>, 4>,
    // Where its grey levels and its inverse depths begin, and its size. No depths: the last is 0.
    levels: u32,
    depths: u32,
    width: u32,
    height: u32,
    // What of it is here: a rectangle that holds all that the tile sees at any depth.
    crop_origin: vec2<u32>,
    crop: vec2<u32>,
    has_depths: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

@group(0) @binding(0) var<uniform> settings: Settings;
// Inverse depth, its growth to the right and downwards, cost.
@group(0) @binding(1) var<storage, read_write> planes: array<vec4<f32>>;
// Four grey levels a word: of the reference first, then of the sources.
@group(0) @binding(2) var<storage, read> levels: array<u32>;
@group(0) @binding(3) var<storage, read> depths: array<f32>;
@group(0) @binding(4) var<storage, read> sources: array<Source>;

const SAMPLES = 36u;
const EDGE = 3.0;
const SIGMA_GREY = 40.0;
const SIGMA_PIXELS = 2.5;
const NOISE = 4.0;
const BEST = 2u;
const GATE = 0.05;
const FAR_DEARER = 0.2;
const UNSEEN = 2.0;
const FARTHEST = 3.0;
const STEEPEST = 4.0;
const SAME = 0.04;
const HUGE = 3.0e38;

fn mix_bits(bits: u32) -> u32 {
    var b = (bits ^ (bits >> 16u)) * 0x7feb352du;
    b = (b ^ (b >> 15u)) * 0x846ca68bu;
    return b ^ (b >> 16u);
}

var<private> random_state: u32;

fn random_at(at: vec2<u32>, salt: u32) {
    random_state = mix_bits(at.x ^ mix_bits(at.y ^ mix_bits(salt)));
}

fn signed_random() -> f32 {
    random_state += 0x9e3779b9u;
    return f32(mix_bits(random_state) >> 8u) * (1.0 / 8388608.0) - 1.0;
}

// The window of the reference.
var<private> weights: array<f32, 36>;
var<private> centred: array<f32, 36>;
var<private> base: f32;
var<private> own_variance: f32;
// The other views, cheapest first.
var<private> order: array<u32, 8>;

fn level_at(begin: u32, at: u32) -> f32 {
    let word = levels[begin + (at >> 2u)];
    return f32((word >> (8u * (at & 3u))) & 0xffu);
}

// One to three pixels to either side of the centre.
fn offset(i: u32) -> vec2<f32> {
    let place = vec2<u32>(i % 6u, i / 6u);
    return vec2<f32>(place) - select(vec2(3.0), vec2(2.0), place > vec2(2u));
}

fn prepare(at: vec2<u32>) {
    let corner = at - settings.crop_origin;
    base = level_at(0u, corner.y * settings.crop.x + corner.x);
    var total = 1e-12;
    var mean = 0.0;
    for (var i = 0u; i < SAMPLES; i++) {
        let offs = offset(i);
        let place = vec2<i32>(at) + vec2<i32>(offs);
        var weight = 0.0;
        var level = 0.0;
        if all(place >= vec2(0)) && all(place < vec2<i32>(settings.size)) {
            let here = vec2<u32>(place) - settings.crop_origin;
            level = level_at(0u, here.y * settings.crop.x + here.x) - base;
            let far = level / SIGMA_GREY;
            weight = exp(-0.5 * dot(offs, offs) / (SIGMA_PIXELS * SIGMA_PIXELS)) * exp(-0.5 * far * far);
        }
        weights[i] = weight;
        centred[i] = level;
        total += weight;
        mean += weight * level;
    }
    mean /= total;
    var variance = 0.0;
    for (var i = 0u; i < SAMPLES; i++) {
        let level = centred[i];
        weights[i] /= total;
        centred[i] = weights[i] * (level - mean);
        variance += centred[i] * level;
    }
    own_variance = max(variance, 0.0) + NOISE;
}

fn project(columns: array<vec4<f32>, 4>, pixel: vec2<f32>, inverse_depth: f32) -> vec3<f32> {
    return columns[0].xyz * pixel.x + columns[1].xyz * pixel.y + columns[2].xyz + columns[3].xyz * inverse_depth;
}

// How far one comes back from the pixel by way of the other view's depth.
fn miss(which: u32, pixel: vec2<f32>, m: vec3<f32>) -> f32 {
    let at = vec2<u32>(m.xy / m.z);
    let width = sources[which].width;
    if at.x >= width || at.y >= sources[which].height {
        return FARTHEST;
    }
    let origin = sources[which].crop_origin;
    let crop = sources[which].crop;
    let here = clamp(at, origin, origin + crop - 1u) - origin;
    let theirs = depths[sources[which].depths + here.y * crop.x + here.x];
    if theirs <= 0.0 {
        return FARTHEST;
    }
    let back = project(sources[which].back, m.xy / m.z, theirs);
    if back.z < 1e-6 {
        return FARTHEST;
    }
    return min(length(back.xy / back.z - pixel), FARTHEST);
}

fn photometric(which: u32, m: vec3<f32>, plane: vec4<f32>) -> f32 {
    let middle = m.xy / m.z;
    let width = sources[which].width;
    let size = vec2<f32>(f32(width), f32(sources[which].height));
    let b = sources[which].there[3].xyz;
    let x = sources[which].there[0].xyz + b * plane.y;
    let y = sources[which].there[1].xyz + b * plane.z;
    let right = (x.xy - middle * x.z) / m.z;
    let down = (y.xy - middle * y.z) / m.z;
    var mean = 0.0;
    var square = 0.0;
    var product = 0.0;
    let begin = sources[which].levels;
    let origin = sources[which].crop_origin;
    let crop = sources[which].crop;
    for (var i = 0u; i < SAMPLES; i++) {
        let offs = offset(i);
        let at = clamp(middle - 0.5 + right * offs.x + down * offs.y, vec2(0.0), size - 1.0);
        let whole = floor(at);
        let part = at - whole;
        let corner = clamp(vec2<u32>(whole), origin, origin + crop - 1u) - origin;
        let next = min(corner + 1u, crop - 1u);
        let above = corner.y * crop.x;
        let below = next.y * crop.x;
        let top = mix(level_at(begin, above + corner.x), level_at(begin, above + next.x), part.x);
        let bottom = mix(level_at(begin, below + corner.x), level_at(begin, below + next.x), part.x);
        let level = mix(top, bottom, part.y) - base;
        let weighted = weights[i] * level;
        mean += weighted;
        square += weighted * level;
        product += centred[i] * level;
    }
    let variance = max(square - mean * mean, 0.0) + NOISE;
    return 1.0 - product / sqrt(variance * own_variance);
}

fn cost_in(which: u32, pixel: vec2<f32>, plane: vec4<f32>) -> f32 {
    let m = project(sources[which].there, pixel, plane.x);
    let size = vec2<f32>(f32(sources[which].width), f32(sources[which].height));
    var is_seen = m.z >= 1e-6;
    if is_seen {
        let at = m.xy / m.z;
        is_seen = all(at >= vec2(0.0)) && all(at <= size);
    }
    var cost = UNSEEN;
    if is_seen {
        cost = photometric(which, m, plane);
    }
    if settings.geometric > 0.0 && sources[which].has_depths != 0u {
        var far = FARTHEST;
        if is_seen {
            far = miss(which, pixel, m);
        }
        cost += settings.geometric * far;
    }
    return cost;
}

// The mean cost of the best views; leaves the views in the order of their costs.
fn first_cost(pixel: vec2<f32>, plane: vec4<f32>) -> f32 {
    var costs: array<f32, 8>;
    for (var i = 0u; i < settings.sources; i++) {
        costs[i] = cost_in(i, pixel, plane);
        order[i] = i;
    }
    let wanted = min(BEST, settings.sources);
    var sum = 0.0;
    for (var i = 0u; i < settings.sources; i++) {
        for (var j = i + 1u; j < settings.sources; j++) {
            if costs[order[j]] < costs[order[i]] {
                let other = order[i];
                order[i] = order[j];
                order[j] = other;
            }
        }
        if i < wanted {
            sum += costs[order[i]];
        }
    }
    return sum / f32(max(wanted, 1u));
}

fn cost_of(pixel: vec2<f32>, plane: vec4<f32>, bound: f32) -> f32 {
    let wanted = min(BEST, settings.sources);
    var first = HUGE;
    var second = HUGE;
    for (var looked = 0u; looked < settings.sources; looked++) {
        let gate = select(GATE, FAR_DEARER, looked < wanted);
        if looked > 0u && looked <= wanted && first > bound + gate {
            break;
        }
        let cost = cost_in(order[looked], pixel, plane);
        if cost < first {
            second = first;
            first = cost;
        } else if cost < second {
            second = cost;
        }
    }
    if wanted < 2u {
        return first;
    }
    return (first + second) / 2.0;
}

fn is_possible(plane: vec4<f32>) -> bool {
    let steepest = STEEPEST * plane.x / settings.focal;
    return plane.x >= settings.range.x && plane.x <= settings.range.y
        && dot(plane.yz, plane.yz) <= steepest * steepest;
}

fn near(plane: vec4<f32>, depth: f32, slope: f32) -> vec4<f32> {
    let a = signed_random();
    let b = signed_random();
    let c = signed_random();
    return vec4(plane.x + depth * a, plane.y + slope / EDGE * b, plane.z + slope / EDGE * c, HUGE);
}

fn anywhere() -> vec4<f32> {
    let inverse_depth = settings.range.x + (settings.range.y - settings.range.x) * (0.5 * signed_random() + 0.5);
    let slope = 0.5 * STEEPEST * inverse_depth / settings.focal;
    let b = signed_random();
    let c = signed_random();
    return vec4(inverse_depth, slope * b, slope * c, HUGE);
}

// The cheapest plane in a direction, brought here; a cost below 0 says that there is none.
fn candidate(at: vec2<i32>, direction: vec2<i32>) -> vec4<f32> {
    var reaches = array<i32, 4>(1, 3, 5, 9);
    var found = vec4(0.0, 0.0, 0.0, -1.0);
    for (var i = 0u; i < 4u; i++) {
        let offs = direction * reaches[i];
        let there = at + offs;
        let in_photo = there + vec2<i32>(settings.origin);
        if any(there < vec2(0)) || any(there >= vec2<i32>(settings.tile))
            || any(in_photo >= vec2<i32>(settings.size)) {
            break;
        }
        let plane = planes[u32(there.y) * settings.tile.x + u32(there.x)];
        if found.w < 0.0 || plane.w < found.w {
            found = vec4(plane.x - plane.y * f32(offs.x) - plane.z * f32(offs.y), plane.yz, plane.w);
        }
    }
    return found;
}

@compute @workgroup_size(8, 8)
fn sweep(@builtin(global_invocation_id) id: vec3<u32>) {
    let row = id.y;
    // The checkerboard is the photo's, whatever the tile.
    let first = (row + settings.origin.y + settings.origin.x + settings.parity) % 2u;
    let at = vec2(2u * id.x + first, row);
    if any(at >= settings.tile) {
        return;
    }
    let here = at + settings.origin;
    let pixel = vec2<f32>(here) + 0.5;
    prepare(here);
    let index = at.y * settings.tile.x + at.x;
    var best = planes[index];
    best.w = first_cost(pixel, best);
    random_at(here, settings.salt);
    let reach = settings.amplitude * settings.per_pixel;
    let least = SAME * settings.per_pixel;
    let trials = select(7u, 8u, settings.anywhere != 0u);
    for (var trial = 0u; trial < trials; trial++) {
        var tried: vec4<f32>;
        switch trial {
            case 0u: { tried = candidate(vec2<i32>(at), vec2(1, 0)); }
            case 1u: { tried = candidate(vec2<i32>(at), vec2(-1, 0)); }
            case 2u: { tried = candidate(vec2<i32>(at), vec2(0, 1)); }
            case 3u: { tried = candidate(vec2<i32>(at), vec2(0, -1)); }
            case 4u: { tried = near(best, reach, reach); }
            case 5u: { tried = near(best, 0.5 * reach, 0.0); }
            case 6u: { tried = near(best, 0.0, 0.5 * reach); }
            default: { tried = anywhere(); }
        }
        let apart = abs(tried.xyz - best.xyz) * vec3(1.0, EDGE, EDGE);
        if tried.w < 0.0 || all(apart < vec3(least)) || !is_possible(tried) {
            continue;
        }
        let cost = cost_of(pixel, tried, best.w);
        if cost < best.w {
            best = vec4(tried.xyz, cost);
        }
    }
    planes[index] = best;
}
