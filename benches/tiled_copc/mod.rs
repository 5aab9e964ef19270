//! The sample's pile laid side by side as COPC, node by node in the order of a Z curve: of a thousand million points
//! only some nodes are in memory.

use std::path::Path;

use fragscale_core::geometry::Bounds;
use fragscale_core::split_mix::SplitMix;
use fragscale_test_data::copc::{CopcWriter, Cube, Node};
use glam::DVec3;

const SCALE: f64 = 0.000_01;

/// Points of a node, about.
const OF_NODE: f64 = 50_000.0;

/// Nodes that are compressed at once.
const AT_ONCE: usize = 64;

/// Writes at least `count` points; how many.
pub(super) fn write(path: &Path, pile: &[DVec3], count: f64) -> u64 {
    let bounds = Bounds::of(pile).expect("points");
    let size = bounds.size();
    // A leaf is a square of the map about as large as a pile.
    let side = size.max_element();
    let density = pile.len() as f64 / (size.x * size.y);
    let leaves = (count / (density * side * side)).sqrt().ceil().max(1.0) as i32;
    let levels = (leaves - 1).max(1).ilog2().cast_signed() + 1;
    let across = 1 << levels;
    let middle = f64::from(leaves / 2);
    let low = bounds.min - DVec3::new(middle, middle, 0.0) * side - DVec3::new(0.0, 0.0, SCALE);
    let cube = Cube {
        low: low.to_array(),
        side: side * f64::from(across),
    };
    // Of the points under a node of each level, which share is its own.
    let shares: Vec<f64> = (0..=levels)
        .map(|level| {
            let under = density * side * side * 4_f64.powi(levels - level);
            if level == levels {
                1.0
            } else {
                OF_NODE / under
            }
        })
        .collect();
    let mut writer = CopcWriter::create(path, SCALE, cube);
    let mut open: Vec<Node> = (0..levels)
        .map(|level| ([level, 0, 0, 0], Vec::new()))
        .collect();
    let (mut done, mut written): (Vec<Node>, u64) = (Vec::new(), 0);
    for place in 0..4_u64.pow(levels as u32) {
        let bits = |shift: u32| {
            (0..16).fold(0, |all, bit| {
                all | ((place >> (2 * bit + shift) & 1) << bit)
            })
        };
        let (column, row) = (bits(0) as i32, bits(1) as i32);
        if column >= leaves || row >= leaves {
            continue;
        }
        for (level, node) in (0..).zip(&mut open) {
            let up = levels - level;
            let key = [level, column >> up, row >> up, 0];
            if node.0 != key {
                done.push(std::mem::replace(node, (key, Vec::new())));
            }
        }
        let mut leaf: Node = ([levels, column, row, 0], Vec::new());
        let at = low + DVec3::new(f64::from(column), f64::from(row), 0.0) * side;
        let tile = |axis: usize, add: f64| {
            ((at[axis] + add - bounds.min[axis]) / size[axis]).floor() as i32
        };
        for tile_row in tile(1, 0.0)..=tile(1, side) {
            for tile_column in tile(0, 0.0)..=tile(0, side) {
                let moved = DVec3::new(f64::from(tile_column), f64::from(tile_row), 0.0) * size;
                let mut random = SplitMix(i64::from(tile_row * 1_000_003 + tile_column) as u64);
                for point in pile {
                    let drawn = random.next();
                    // No tile is exactly another one moved, so that nothing in it is either.
                    let shift = (drawn % 1000) as f64 * 1e-6;
                    let point = *point + moved + DVec3::new(shift, shift, 0.0);
                    let off = point - at;
                    if off.x < 0.0 || off.y < 0.0 || off.x >= side || off.y >= side {
                        continue;
                    }
                    let step = (point / SCALE).floor().to_array().map(|step| step as i32);
                    let mut left = (drawn >> 11) as f64 / (1_u64 << 53) as f64;
                    let level = shares.iter().position(|share| {
                        left -= share;
                        left < 0.0
                    });
                    let node = level
                        .and_then(|level| open.get_mut(level))
                        .unwrap_or(&mut leaf);
                    node.1.push(step);
                    written += 1;
                }
            }
        }
        done.push(leaf);
        if done.len() >= AT_ONCE {
            writer.add(&done);
            done.clear();
        }
    }
    done.append(&mut open);
    writer.add(&done);
    writer.finish();
    written
}
