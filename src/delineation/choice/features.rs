//! What is measured of a node to tell whether it is a fragment. None of it depends on the size of the photo.

use std::f64::consts::PI;

use crate::hull;
use crate::tree::{Node, Tree};

/// How many there are.
pub const COUNT: usize = 22;

/// Each about 0 to 1. Their numbers, from 0, are what `train_score.py` can leave out.
pub fn features(tree: &Tree, place: usize) -> [f64; COUNT] {
    let node = &tree.nodes[place];
    let sums = &node.sums;
    let area = sums.area.max(1.0);
    let inner = (sums.outline - sums.at_edge).max(1.0);
    let parent = node
        .parent
        .and_then(|parent| tree.nodes.get(parent as usize));
    let children = node
        .children
        .map(|[a, b]| [&tree.nodes[a as usize], &tree.nodes[b as usize]]);
    let lesser = children.map(|[a, b]| if a.sums.area < b.sums.area { a } else { b });
    let gray = sums.gray / area;
    let [elongation, ellipse] = shape(node);
    let votes = against(node);
    [
        sums.strength / inner / 255.0,
        sums.weak / inner,
        f64::from(node.joined_at) / 255.0,
        parent.map_or(1.0, |parent| f64::from(parent.joined_at) / 255.0),
        sums.border / area / 255.0,
        sums.rock / area / 255.0,
        sums.middle / area / 255.0,
        f64::from(sums.most_middle) / 255.0,
        lesser.map_or(0.0, |lesser| f64::from(lesser.sums.most_middle) / 255.0),
        area / hull::area(&node.hull).max(area),
        // Sides of pixels are longer than what they stand for: 4 / pi times on a circle.
        (4.0 * PI * area / (sums.outline * PI / 4.0).powi(2).max(1.0)).min(1.5),
        ellipse,
        elongation,
        // 13.
        area.log10() / 5.0,
        sums.at_edge / sums.outline.max(1.0),
        // 15.
        (sums.gray_squared / area - gray * gray).max(0.0).sqrt() / 64.0,
        lesser.map_or(0.0, |lesser| lesser.sums.area / area),
        parent.map_or(1.0, |parent| area / parent.sums.area.max(1.0)),
        // 18 to 21.
        votes[0],
        votes[1],
        votes[2],
        votes[3],
    ]
}

/// How far the votes of its pixels are from it ([`crate::votes`]): size, spread, middle, bias; 0 where nobody voted.
fn against(node: &Node) -> [f64; 4] {
    let sums = &node.sums;
    let squares = sums.squares[0] + sums.squares[2];
    let votes = sums.votes.against(sums.area.max(1.0), sums.place, squares);
    votes.map_or([0.0; 4], |off| {
        [
            (off.size / 4.0).clamp(-1.0, 1.0),
            (off.spread / 2.0).min(1.0),
            off.middle.min(1.5),
            off.bias.min(1.0),
        ]
    })
}

/// The lesser over the greater axis, and the area over that of the ellipse with the same second moments:
/// 1 of an ellipse, 0.95 of a rectangle, less of what is forked or hollow.
fn shape(node: &Node) -> [f64; 2] {
    let sums = &node.sums;
    let area = sums.area.max(1.0);
    let middle = sums.place / area;
    // A pixel is a square, not a point.
    let own = 1.0 / 12.0;
    let xx = sums.squares[0] / area - middle.x * middle.x + own;
    let xy = sums.squares[1] / area - middle.x * middle.y;
    let yy = sums.squares[2] / area - middle.y * middle.y + own;
    let half = 0.5 * (xx + yy);
    let apart = (0.25 * (xx - yy).powi(2) + xy * xy).sqrt();
    let (greater, lesser) = ((half + apart).max(own), (half - apart).max(own));
    let ellipse = area / (4.0 * PI * (greater * lesser).sqrt());
    [(lesser / greater).sqrt(), ellipse.min(1.5)]
}
