//! Brings nodes to the graphics card: a thread that makes their vertices and uploads them, the most
//! wanted first. What nobody wishes for any more is not begun.

use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use glam::Vec3;

use super::StreamSource;
use crate::device::gpu::Gpu;
use crate::primitives::tile::Tile;
use crate::scene::{Normals, vertex};

/// Nodes that may have arrived and not been taken: a frame takes no more.
const IN_FLIGHT: usize = 16;

/// What the picture wants.
#[derive(Debug, Default)]
struct Wishes {
    /// The most wanted last.
    nodes: Vec<usize>,
    /// The node that is being made.
    begun: Option<usize>,
    is_over: bool,
}

#[derive(Debug, Default)]
struct Shared {
    wishes: Mutex<Wishes>,
    changed: Condvar,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Wishes> {
        self.wishes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next node to bring; waits for one, and is `None` where there will be no more.
    fn next(&self) -> Option<usize> {
        let mut wishes = self.lock();
        wishes.begun = None;
        loop {
            if wishes.is_over {
                return None;
            }
            if let Some(node) = wishes.nodes.pop() {
                wishes.begun = Some(node);
                return Some(node);
            }
            let waited = self.changed.wait(wishes);
            wishes = waited.unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// The thread's other end. The thread ends when this is dropped.
#[derive(Debug)]
pub(super) struct Loader {
    shared: Arc<Shared>,
    arrived: Receiver<(usize, Tile)>,
}

impl Loader {
    pub(super) fn new(gpu: &Gpu, source: &StreamSource) -> Self {
        let shared = Arc::new(Shared::default());
        let (send, arrived) = sync_channel(IN_FLIGHT);
        let (theirs, gpu, source) = (Arc::clone(&shared), gpu.clone(), source.clone());
        let work = move || {
            while let Some(node) = theirs.next() {
                if send.send((node, load(&gpu, &source, node))).is_err() {
                    return;
                }
            }
        };
        // Where the system has no thread left, the coarse picture of a moment ago stays.
        let _ = std::thread::Builder::new()
            .name("points".to_owned())
            .spawn(work);
        Self { shared, arrived }
    }

    /// The nodes that have arrived since the last call.
    pub(super) fn arrived(&self) -> Vec<(usize, Tile)> {
        self.arrived.try_iter().take(IN_FLIGHT).collect()
    }

    /// Wishes for these nodes, the most wanted first, and for no others.
    pub(super) fn wish(&self, mut nodes: Vec<usize>) {
        let mut wishes = self.shared.lock();
        nodes.retain(|node| wishes.begun != Some(*node));
        nodes.reverse();
        wishes.nodes = nodes;
        drop(wishes);
        self.shared.changed.notify_one();
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.shared.lock().is_over = true;
        self.shared.changed.notify_one();
    }
}

/// A node with its points on the card.
pub(super) fn load(gpu: &Gpu, source: &StreamSource, node: usize) -> Tile {
    let StreamSource { levels, frame, .. } = source;
    let Some(node) = levels.nodes().get(node) else {
        return Tile::new(gpu, &[], source.extent(&levels.surface().bounds()));
    };
    let colors = levels.surface().colors();
    let points = levels.points_of(node).into_iter();
    let vertices: Vec<_> = points
        .map(|(index, point)| {
            let place: Vec3 = crate::scene::narrow(frame.local_from_world(point));
            // A surface has under 2^32 vertices.
            let index = u32::try_from(index).unwrap_or(u32::MAX);
            vertex(place, index, colors, &Normals::default())
        })
        .collect();
    let tile = Tile::new(gpu, &vertices, source.extent(&node.bounds));
    gpu.hand_over();
    tile
}
