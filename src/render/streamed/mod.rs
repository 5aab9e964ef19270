//! A cloud of any size on the graphics card: of its levels of detail (`surface::Levels`) those nodes that
//! the picture is made of, brought there as they are wanted.
//!
//! Each picture chooses its nodes anew, from the top, the coarsest first, until they are as fine as half a pixel
//! or the budget of points is spent ([`POINTS`], or less while the view moves). What of them is on the
//! card is drawn; the others are wished for, and [`loader`], a thread, makes their vertices and uploads
//! them. A frame takes what has arrived, at most 16 nodes of at most 0.7 MB, so it never waits,
//! and its own work grows with the nodes that are looked at (for six million points 1500: under
//! a millisecond). Nodes that were not wanted for longest leave the card when there are more than
//! [`MEMORY`] bytes.
//!
//! The points of a picture have one size in texels at least: the distance of the points of the nodes whose
//! children are not there. So a coarse picture has no holes, and becomes finer without growing dots.

mod loader;

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use glam::DVec3;

use crate::device::gpu::Gpu;
use crate::geometry::{Bounds, LevelBox, LocalFrame};
use crate::primitives::tile::Tile;
use crate::renderer::part::Most;
use crate::scene::{Extent, elevation, narrow};
use crate::surface::{LevelNode, Levels};
use loader::Loader;

/// Most points in a picture, with a graphics card and without one.
pub const POINTS: [usize; 2] = [6_000_000, 1_000_000];

/// Most bytes of points on the card: 25 million.
pub const MEMORY: u64 = 512 << 20;

/// A cloud made ready to be streamed: its levels, and the frame that its pictures are made in. Clones share
/// the levels.
#[derive(Debug, Clone)]
pub(crate) struct StreamSource {
    pub(crate) levels: Arc<Levels>,
    pub(crate) frame: LocalFrame,
    /// About how far neighbouring points are apart, world units.
    pub(crate) spacing: f64,
    /// Elevations in the world, without the extreme hundredths.
    pub(crate) elevation: [f64; 2],
}

impl StreamSource {
    pub(crate) fn new(levels: Levels, frame: &LocalFrame) -> Self {
        let root = levels.nodes().first();
        let places: Vec<_> = root
            .map(|root| levels.points_of(root))
            .unwrap_or_default()
            .into_iter()
            .map(|(_, point)| narrow(frame.local_from_world(point)))
            .collect();
        Self {
            spacing: levels.spacing(),
            elevation: elevation(frame, &places),
            frame: *frame,
            levels: Arc::new(levels),
        }
    }

    fn extent(&self, bounds: &Bounds) -> Extent {
        Extent {
            min: narrow(self.frame.local_from_world(bounds.min)),
            max: narrow(self.frame.local_from_world(bounds.max)),
        }
    }
}

/// What a picture looks from, for choosing nodes.
pub(crate) struct Looking<'a> {
    /// The eye in the local frame, and the way that it looks.
    pub(crate) eye: DVec3,
    pub(crate) ahead: DVec3,
    pub(crate) parallel: bool,
    /// World size of a texel at distance 1, in parallel projection everywhere.
    pub(crate) texel: f64,
    /// Points this near to each other, in texels, need no others between them.
    pub(crate) fine: f64,
    /// Nearer than this along the axis nothing is seen.
    pub(crate) nearest: f64,
    /// Whether a box may be in the picture.
    pub(crate) in_sight: &'a dyn Fn(&Extent) -> bool,
    /// What is outside of it is cut away.
    pub(crate) clip: Option<LevelBox>,
}

impl Looking<'_> {
    /// Whether anything of a node may be seen.
    fn sees(&self, node: &LevelNode, source: &StreamSource) -> bool {
        let is_cut_away = self.clip.is_some_and(|clip| {
            let middle = clip.from_world(node.bounds.center());
            let off = middle.distance(middle.clamp(clip.low, clip.high));
            // A box is within the ball around it, however the clipping box is turned.
            off > node.bounds.size().length() * 0.5
        });
        !is_cut_away && (self.in_sight)(&source.extent(&node.bounds))
    }

    /// How far points of a node appear to be apart at its nearest place, in texels.
    fn apart(&self, node: &LevelNode, frame: &LocalFrame) -> f64 {
        if self.parallel {
            return node.spacing / self.texel;
        }
        let (min, max) = (
            frame.local_from_world(node.bounds.min) - self.eye,
            frame.local_from_world(node.bounds.max) - self.eye,
        );
        // Along the axis the nearest corner.
        let near = DVec3::select(self.ahead.cmpge(DVec3::ZERO), min, max).dot(self.ahead);
        node.spacing / (self.texel * near.max(self.nearest))
    }
}

/// What is on the card of a picture's nodes.
#[derive(Debug, Default)]
pub(crate) struct Present {
    pub(crate) tiles: Vec<Tile>,
    /// Least radius of a point, in texels.
    pub(crate) least: f64,
    /// Another number for every other list of nodes.
    pub(crate) key: u64,
    /// Whether nodes are still on their way.
    pub(crate) awaited: bool,
}

/// A node on the card.
#[derive(Debug)]
struct Resident {
    tile: Tile,
    /// The number of the picture that wanted it last.
    wanted: u64,
}

/// A cloud being streamed.
#[derive(Debug)]
pub(crate) struct Streamed {
    pub(crate) source: StreamSource,
    gpu: Gpu,
    residents: HashMap<usize, Resident>,
    bytes: u64,
    /// Most of them: [`MEMORY`].
    memory: u64,
    /// How many pictures were made.
    pictures: u64,
    /// The nodes that the main picture lacks, and those beside it.
    wishes: [Vec<usize>; 2],
    loader: Loader,
}

impl Streamed {
    /// Begins; nothing is on the card yet.
    pub(crate) fn new(gpu: &Gpu, source: &StreamSource) -> Self {
        Self {
            loader: Loader::new(gpu, source),
            source: source.clone(),
            gpu: gpu.clone(),
            residents: HashMap::new(),
            bytes: 0,
            memory: MEMORY,
            pictures: 0,
            wishes: Default::default(),
        }
    }

    /// Around all points.
    pub(crate) fn extent(&self) -> Option<Extent> {
        let root = self.source.levels.nodes().first()?;
        Some(self.source.extent(&root.bounds))
    }

    /// What is there for a picture of at most `most` points. For a file all of it is: this call brings what
    /// is missing.
    pub(crate) fn present(
        &mut self,
        looking: &Looking<'_>,
        most: usize,
        for_what: Most,
    ) -> Present {
        let wait = for_what == Most::All;
        self.pictures += 1;
        for (node, tile) in self.loader.arrived() {
            self.keep(node, tile);
        }
        let source = self.source.clone();
        let budget = POINTS[usize::from(self.gpu.software)].min(most);
        let chosen = source.levels.choose(budget, looking.fine, |node| {
            let seen = looking.sees(node, &source);
            seen.then(|| looking.apart(node, &source.frame))
        });
        let mut present = Present::default();
        let mut missing = Vec::new();
        let mut key = DefaultHasher::new();
        for &node in &chosen.nodes {
            if wait && !self.residents.contains_key(&node) {
                let tile = loader::load(&self.gpu, &source, node);
                self.keep(node, tile);
            }
            match self.residents.get_mut(&node) {
                Some(resident) => {
                    resident.wanted = self.pictures;
                    present.tiles.push(resident.tile.clone());
                    node.hash(&mut key);
                }
                None => missing.push(node),
            }
        }
        present.key = key.finish();
        present.least = 0.5 * self.gap(&chosen.nodes, looking);
        present.awaited = !missing.is_empty();
        match for_what {
            Most::All => {}
            Most::Portion(_) => self.wishes[0] = missing,
            Most::Aside => {
                // Several of them may follow each other; what has come is no wish any more.
                let residents = &self.residents;
                let aside = &mut self.wishes[1];
                aside.retain(|node| !residents.contains_key(node) && !missing.contains(node));
                aside.extend(missing);
            }
        }
        self.wishes[1].retain(|node| !self.residents.contains_key(node));
        let [of_main, aside] = &self.wishes;
        self.loader
            .wish(aside.iter().chain(of_main).copied().collect());
        self.let_go();
        present
    }

    /// How far the points appear to be apart in most places where finer ones are not there: three quarters
    /// of the nodes that lack children show less.
    fn gap(&self, chosen: &[usize], looking: &Looking<'_>) -> f64 {
        let nodes = self.source.levels.nodes();
        let is_drawn = |node: &usize| {
            let resident = self.residents.get(node);
            resident.is_some_and(|resident| resident.wanted == self.pictures)
        };
        let in_sight = |node: &usize| looking.sees(&nodes[*node], &self.source);
        let lacks = chosen
            .iter()
            .filter(|node| is_drawn(node))
            .filter(|&&node| {
                let below = nodes[node].children.clone();
                below
                    .into_iter()
                    .any(|child| !is_drawn(&child) && in_sight(&child))
            });
        let mut apart: Vec<f64> = lacks
            .map(|&node| looking.apart(&nodes[node], &self.source.frame))
            .collect();
        apart.sort_unstable_by(f64::total_cmp);
        apart.get(apart.len() * 3 / 4).copied().unwrap_or(0.0)
    }

    fn keep(&mut self, node: usize, tile: Tile) {
        self.bytes += tile.bytes();
        let wanted = self.pictures;
        if let Some(before) = self.residents.insert(node, Resident { tile, wanted }) {
            self.bytes -= before.tile.bytes();
        }
    }

    /// Nodes that were not wanted for longest leave the card until there is room.
    fn let_go(&mut self) {
        if self.bytes <= self.memory {
            return;
        }
        let unwanted = self.residents.iter();
        let mut unwanted: Vec<(u64, usize)> = unwanted
            .filter(|(_, resident)| resident.wanted < self.pictures)
            .map(|(node, resident)| (resident.wanted, *node))
            .collect();
        unwanted.sort_unstable();
        for (_, node) in unwanted {
            if self.bytes <= self.memory {
                break;
            }
            if let Some(gone) = self.residents.remove(&node) {
                self.bytes -= gone.tile.bytes();
            }
        }
    }
}

#[cfg(test)]
mod tests;
