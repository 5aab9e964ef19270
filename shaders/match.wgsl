// The nearest two descriptors among `others` of each of `own`: the greatest products of their bytes.
//
// A descriptor is 128 bytes, 32 words. A product of two is below 128 * 255 * 255 < 2^23: whole numbers all the
// way, so that the answer is the processor's to the bit, whatever the device. One invocation has one descriptor
// and goes through a part of the others, which its group fetches together, TILE at a time. Parts are merged by
// whoever reads: each begins with nothing, and of equal products the first counts.

const WORDS: u32 = 8u;      // of four words each: a descriptor
const TILE: u32 = 64u;      // descriptors that a group fetches together, one an invocation

struct Settings {
    own: u32,       // how many descriptors there are
    others: u32,
    part: u32,      // how many of the others one group goes through, a multiple of TILE
    padding: u32,
}

@group(0) @binding(0) var<uniform> settings: Settings;
@group(0) @binding(1) var<storage, read> own: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> others: array<vec4<u32>>;
// The best product, its place among the others (2^32 - 1 for none), the second best, and nothing.
@group(0) @binding(3) var<storage, read_write> nearest: array<vec4<u32>>;

var<workgroup> fetched: array<vec4<u32>, 512>;

fn product(a: vec4<u32>, b: vec4<u32>) -> u32 {
    return dot4U8Packed(a.x, b.x) + dot4U8Packed(a.y, b.y)
        + dot4U8Packed(a.z, b.z) + dot4U8Packed(a.w, b.w);
}

@compute @workgroup_size(64)
fn nearest_two(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = group.x * TILE + lane;
    // Invocations beyond the last descriptor help to fetch, and write nothing.
    let read = min(row, settings.own - 1u) * WORDS;
    var mine: array<vec4<u32>, 8>;
    for (var i = 0u; i < WORDS; i++) {
        mine[i] = own[read + i];
    }
    var best = 0u;
    var place = 0xffffffffu;
    var second = 0u;
    let first = group.y * settings.part;
    let end = min(first + settings.part, settings.others);
    for (var from_place = first; from_place < end; from_place += TILE) {
        workgroupBarrier();
        for (var i = 0u; i < WORDS; i++) {
            let word = i * TILE + lane;
            let there = from_place * WORDS + word;
            if there < settings.others * WORDS {
                fetched[word] = others[there];
            }
        }
        workgroupBarrier();
        let count = min(TILE, end - from_place);
        for (var other = 0u; other < count; other++) {
            let at = other * WORDS;
            var sum = 0u;
            for (var i = 0u; i < WORDS; i++) {
                sum += product(mine[i], fetched[at + i]);
            }
            if sum > best {
                second = best;
                best = sum;
                place = from_place + other;
            } else if sum > second {
                second = sum;
            }
        }
    }
    if row < settings.own {
        nearest[group.y * settings.own + row] = vec4<u32>(best, place, second, 0u);
    }
}
