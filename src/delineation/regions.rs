//! All regions of a photo that might be fragments, for who looks for another one by hand: coarser or finer under
//! the cursor, or a fragment where none was found.

use fragscale_core::fault::Fault;
use fragscale_core::labels::{Change, Outlines, Painting};
use glam::DVec2;

use crate::labels::{FINES, NOT_ROCK};
use crate::tree::{NOWHERE, Tree};

/// A step coarser or finer changes the area by more than this factor: the tree joins a pixel's breadth at a time.
const STEP: f64 = 1.15;

/// Of the regions up to so many times as large as the next one, the likeliest is taken.
const REACH: f64 = 2.0;

/// A photo's regions, and how likely each is a fragment.
#[derive(Debug, Clone, PartialEq)]
pub struct Regions {
    tree: Tree,
    scores: Vec<f64>,
    least_area: f64,
}

impl Regions {
    /// Of a tree with a score for each node. Fragments have `least_area` pixels.
    pub fn new(tree: Tree, scores: Vec<f64>, least_area: f64) -> Self {
        Self {
            tree,
            scores,
            least_area,
        }
    }

    /// A larger region under the cursor: the likeliest of the next ones takes the place of the fragment there, or of
    /// none, and of all that lies in it.
    ///
    /// # Errors
    /// Where there is none.
    pub fn coarser(&self, outlines: &Outlines, at: DVec2) -> Result<Change, Fault> {
        let own = outlines.fragment_at(at);
        let area = own.map_or(0.0, |own| area_of(outlines, own));
        let least = (area * STEP).max(self.least_area);
        let above = self.above(at).into_iter();
        let larger: Vec<u32> = above.filter(|node| self.area(*node) >= least).collect();
        let nothing = || Fault::new("there is no larger region here", "merge by a stroke (M)");
        let least = larger.first().map(|node| self.area(*node));
        let reach = least.ok_or_else(nothing)? * REACH;
        let near = larger.into_iter().filter(|node| self.area(*node) <= reach);
        let node = self.likeliest(near).ok_or_else(nothing)?;
        let number = own.unwrap_or_else(|| outlines.next_number());
        let mut is_in = vec![false; self.tree.leaves];
        self.each_leaf(node, |leaf| is_in[leaf] = true);
        Ok(self.paint(outlines, &[number], |leaf, label| {
            (is_in[leaf] && label != NOT_ROCK).then_some(number)
        }))
    }

    /// A smaller region under the cursor keeps the fragment's number; the other parts of the fragment become
    /// fragments of their own.
    ///
    /// # Errors
    /// Where there is no fragment, or none smaller.
    pub fn finer(&self, outlines: &Outlines, at: DVec2) -> Result<Change, Fault> {
        let none = || Fault::new("there is no fragment here", "point at one");
        let own = outlines.fragment_at(at).ok_or_else(none)?;
        let area = area_of(outlines, own);
        let above = self.above(at);
        let smaller = above.iter().copied();
        let smaller =
            smaller.filter(|node| (self.least_area..=area / STEP).contains(&self.area(*node)));
        let smaller: Vec<u32> = smaller.collect();
        let nothing = || Fault::new("there is no smaller region here", "split by a stroke (S)");
        let most = smaller.last().map(|node| self.area(*node));
        let reach = most.ok_or_else(nothing)? / REACH;
        let near = smaller.into_iter().filter(|node| self.area(*node) >= reach);
        let node = self.likeliest(near).ok_or_else(nothing)?;
        // What the fragment was joined of, from that region on.
        let mut number_of = vec![FINES; self.tree.leaves];
        let mut numbers = vec![own];
        self.each_leaf(node, |leaf| number_of[leaf] = own);
        let path = above.into_iter().skip_while(|above| *above != node);
        let path: Vec<u32> = path.collect();
        for pair in path.windows(2) {
            if self.area(pair[1]) > area * STEP {
                break;
            }
            let children = self.tree.nodes[pair[1] as usize].children;
            let sibling = children.and_then(|two| two.into_iter().find(|child| *child != pair[0]));
            let Some(sibling) = sibling else {
                continue;
            };
            let mut number = own;
            if self.area(sibling) >= self.least_area {
                number = outlines.next_number() + numbers.len() as u32 - 1;
                numbers.push(number);
            }
            self.each_leaf(sibling, |leaf| number_of[leaf] = number);
        }
        Ok(self.paint(outlines, &numbers, |leaf, label| {
            (label == own && number_of[leaf] != FINES).then_some(number_of[leaf])
        }))
    }

    /// A fragment where none was found: the likeliest region under the cursor, as far as it is no fragment yet.
    ///
    /// # Errors
    /// Where there is a fragment already, or no region.
    pub fn grown(&self, outlines: &Outlines, at: DVec2) -> Result<Change, Fault> {
        if outlines.at(at) != Some(FINES) {
            let what = "there is a fragment already, or no rock";
            return Err(Fault::new(what, "click where none is outlined"));
        }
        let above = self.above(at).into_iter();
        let large = above.filter(|node| self.area(*node) >= self.least_area);
        let nothing = || Fault::new("there is no region here", "draw its outline (O)");
        let node = self.likeliest(large).ok_or_else(nothing)?;
        let number = outlines.next_number();
        let mut is_in = vec![false; self.tree.leaves];
        self.each_leaf(node, |leaf| is_in[leaf] = true);
        Ok(self.paint(outlines, &[number], |leaf, label| {
            (is_in[leaf] && label == FINES).then_some(number)
        }))
    }

    /// The regions that hold a place, the smallest first.
    fn above(&self, at: DVec2) -> Vec<u32> {
        let inside = at.x >= 0.0
            && at.y >= 0.0
            && at.x < self.tree.width as f64
            && at.y < self.tree.height as f64;
        let place = at.y as usize * self.tree.width + at.x as usize;
        let leaf = self.tree.leaf_of.get(place).filter(|_| inside);
        let leaf = leaf.copied().filter(|leaf| *leaf != NOWHERE);
        let parent = |node: &u32| self.tree.nodes[*node as usize].parent;
        std::iter::successors(leaf, parent).collect()
    }

    fn area(&self, node: u32) -> f64 {
        self.tree.nodes[node as usize].sums.area
    }

    fn likeliest(&self, nodes: impl Iterator<Item = u32>) -> Option<u32> {
        let score = |node: &u32| self.scores.get(*node as usize).copied().unwrap_or(0.0);
        nodes.max_by(|a, b| score(a).total_cmp(&score(b)))
    }

    fn each_leaf(&self, node: u32, mut each: impl FnMut(usize)) {
        let mut open = vec![node];
        while let Some(node) = open.pop() {
            match self.tree.nodes[node as usize].children {
                Some(children) => open.extend(children),
                None => each(node as usize),
            }
        }
    }

    /// A change of the pixels that get another label by their leaf and the label of now.
    fn paint(
        &self,
        outlines: &Outlines,
        shaped: &[u32],
        label: impl Fn(usize, u32) -> Option<u32>,
    ) -> Change {
        let labels = outlines.labels();
        let mut painting = Painting::on(labels);
        for (place, (leaf, now)) in self.tree.leaf_of.iter().zip(&labels.labels).enumerate() {
            if *leaf != NOWHERE
                && let Some(after) = label(*leaf as usize, *now)
            {
                painting.paint(place, after);
            }
        }
        outlines.painted(painting, shaped)
    }
}

fn area_of(outlines: &Outlines, number: u32) -> f64 {
    let labels = outlines.labels().labels.iter();
    labels.filter(|label| **label == number).count() as f64
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use fragscale_core::jobs::Progress;
    use fragscale_core::labels::{Editing, LabelImage};

    use super::*;
    use crate::evidence::Evidence;
    use crate::tree::tree;

    const WIDTH: usize = 60;
    const HEIGHT: usize = 40;

    /// Three blocks of twenty columns: a strong border between the second and the third, a weak one between the first
    /// and the second. Likeliest is what has the wanted area.
    fn regions(wanted: f64) -> Regions {
        let border = |place: usize| match place % WIDTH {
            19 | 20 => 120,
            39 | 40 => 250,
            // A little unrest, so that there are more regions than three.
            column => ((column * 7 + place / WIDTH * 13) % 11) as u8,
        };
        let of = |value: fn(usize) -> u8| (0..WIDTH * HEIGHT).map(value).collect::<Vec<u8>>();
        let evidence = Evidence {
            width: WIDTH,
            height: HEIGHT,
            border: (0..WIDTH * HEIGHT).map(border).collect(),
            rock: of(|_| 255),
            middle: of(|_| 0),
            gray: of(|_| 128),
            votes: None,
        };
        let tree = tree(&evidence, &[], &Progress::default()).unwrap();
        let score = |area: f64| 1.0 / (1.0 + (area - wanted).abs());
        let scores = tree.nodes.iter().map(|node| score(node.sums.area));
        let scores = scores.collect();
        Regions::new(tree, scores, 30.0)
    }

    fn nothing() -> Outlines {
        let labels = LabelImage {
            width: WIDTH,
            height: HEIGHT,
            labels: vec![FINES; WIDTH * HEIGHT],
        };
        Outlines::new(labels, BTreeMap::new())
    }

    fn areas(outlines: &Outlines) -> Vec<usize> {
        let mut areas = outlines.labels().areas();
        areas.retain(|area| *area > 0);
        areas
    }

    #[test]
    fn a_block_grows_and_joins_its_neighbour() {
        let block = (WIDTH / 3 * HEIGHT) as f64;
        let at = DVec2::new(10.0, 20.0);
        let regions = regions(block);
        let mut editing = Editing::new(nothing());
        editing.make(regions.grown(editing.now(), at).unwrap());
        let [rest, own] = areas(editing.now())[..] else {
            panic!("{:?}", areas(editing.now()));
        };
        assert_eq!(rest + own, WIDTH * HEIGHT);
        assert!((own as f64 / block - 1.0).abs() < 0.1, "{own}");
        assert!(regions.grown(editing.now(), at).is_err());
        // Behind the weak seam lies the second block, behind the strong one the third.
        editing.make(regions.coarser(editing.now(), at).unwrap());
        let two = editing.now();
        assert_eq!(two.fragment_at(DVec2::new(30.0, 20.0)), Some(1));
        assert_eq!(two.fragment_at(DVec2::new(50.0, 20.0)), None);
        editing.make(regions.coarser(editing.now(), at).unwrap());
        assert_eq!(areas(editing.now()), [WIDTH * HEIGHT]);
        assert!(regions.coarser(editing.now(), at).is_err());
        while editing.undo() {}
        assert_eq!(*editing.now(), nothing());
    }

    #[test]
    fn finer_leaves_no_pixel_behind() {
        let at = DVec2::new(10.0, 20.0);
        let regions = regions((WIDTH / 3 * HEIGHT) as f64);
        let mut editing = Editing::new(nothing());
        while let Ok(change) = regions.coarser(editing.now(), at) {
            editing.make(change);
        }
        assert!(regions.finer(editing.now(), DVec2::splat(-1.0)).is_err());
        let mut before = 1;
        while let Ok(change) = regions.finer(editing.now(), at) {
            editing.make(change);
            let areas = areas(editing.now());
            assert_eq!(areas.iter().sum::<usize>(), WIDTH * HEIGHT);
            assert_eq!(editing.now().labels().areas()[0], 0, "no fines");
            assert!(areas.len() >= before);
            before = areas.len();
        }
        assert!(before > 2, "{before}");
    }
}
