//! The tiles of the photo that are on the graphics card, and the thread that makes them.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::camera::Camera;
use crate::fault::Fault;
use crate::picture::{PhotoPyramid, TileKey};

/// The most tiles as textures: 1 MB each.
pub const MOST_TILES: usize = 96;

/// Tiles taken over in one frame: each is copied to the graphics card, a fraction of a millisecond.
const TILES_A_FRAME: usize = 4;

/// Makes tiles on a thread of its own. It ends when this is dropped.
#[derive(Debug)]
struct Maker {
    wish: Sender<Vec<TileKey>>,
    made: Receiver<(TileKey, egui::ColorImage)>,
}

impl Maker {
    fn new(
        pyramid: Arc<PhotoPyramid>,
        lens: Option<Camera>,
        context: egui::Context,
    ) -> Result<Self, Fault> {
        let (wish, wishes) = channel::<Vec<TileKey>>();
        let (send, made) = channel();
        std::thread::Builder::new()
            .name("photo tiles".to_owned())
            .spawn(move || {
                let mut left = Vec::new();
                loop {
                    if left.is_empty() {
                        match wishes.recv() {
                            Ok(wish) => left = wish,
                            Err(_) => return,
                        }
                    }
                    // What was wanted before is not in sight any more.
                    if let Some(newest) = wishes.try_iter().last() {
                        left = newest;
                    }
                    if left.is_empty() {
                        continue;
                    }
                    let key = left.remove(0);
                    let Some(tile) = pyramid.tile(key, lens.as_ref()) else {
                        continue;
                    };
                    let size = [tile.width() as usize, tile.height() as usize];
                    let tile = egui::ColorImage::from_rgb(size, tile.as_raw());
                    if send.send((key, tile)).is_err() {
                        return;
                    }
                    context.request_repaint();
                }
            })
            .map_err(|e| Fault::new(format!("no thread for tiles: {e}"), "close programs"))?;
        Ok(Self { wish, made })
    }
}

/// The tiles of one image of one photo.
#[derive(Default)]
pub struct Tiles {
    maker: Option<Maker>,
    wanted: Vec<TileKey>,
    textures: BTreeMap<TileKey, egui::TextureHandle>,
}

impl Tiles {
    /// Begins anew, with this photo; undistorted where its camera is given.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn begin(
        &mut self,
        pyramid: Arc<PhotoPyramid>,
        lens: Option<Camera>,
        context: egui::Context,
    ) -> Result<(), Fault> {
        *self = Self::default();
        self.maker = Some(Maker::new(pyramid, lens, context)?);
        Ok(())
    }

    /// Those that are wanted.
    pub fn wanted(&self) -> &[TileKey] {
        &self.wanted
    }

    /// Says which are in sight, the most wanted first: those that are not there will be made.
    pub(super) fn want(&mut self, mut wanted: Vec<TileKey>) {
        wanted.truncate(MOST_TILES);
        let Some(maker) = &self.maker else {
            return;
        };
        let missing = wanted.iter().filter(|key| !self.textures.contains_key(key));
        // It is gone only where the program ends.
        let _ = maker.wish.send(missing.copied().collect());
        self.wanted = wanted;
        self.let_go();
    }

    /// Frees tiles that are out of sight where there are too many.
    fn let_go(&mut self) {
        let (wanted, mut too_many) = (&self.wanted, self.textures.len());
        self.textures.retain(|key, _| {
            let keeps = too_many <= MOST_TILES || wanted.contains(key);
            too_many -= usize::from(!keeps);
            keeps
        });
    }

    /// Takes tiles that were made; false where more are there than a frame takes.
    pub(crate) fn take(&mut self, context: &egui::Context) -> bool {
        let Some(maker) = &self.maker else {
            return true;
        };
        let made: Vec<_> = maker.made.try_iter().take(TILES_A_FRAME).collect();
        let all = made.len() < TILES_A_FRAME;
        for (key, tile) in made {
            let options = egui::TextureOptions::LINEAR;
            let texture = context.load_texture("photo tile", tile, options);
            self.textures.insert(key, texture);
        }
        self.let_go();
        all
    }

    /// Whether one that is wanted is still to come.
    pub fn is_waiting(&self) -> bool {
        let is_missing = |key: &TileKey| !self.textures.contains_key(key);
        self.maker.is_some() && self.wanted.iter().any(is_missing)
    }

    /// Those that are there, the coarsest first.
    pub fn there(&self) -> impl Iterator<Item = (TileKey, &egui::TextureHandle)> {
        self.textures
            .iter()
            .rev()
            .map(|(key, texture)| (*key, texture))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use image::{Rgb, RgbImage};

    /// What is wanted comes; of what is wanted no more, no more than the most stay.
    #[test]
    fn what_is_wanted_comes() {
        let context = egui::Context::default();
        let photo = RgbImage::from_pixel(7000, 7000, Rgb([9, 8, 7]));
        let pyramid = Arc::new(PhotoPyramid::new(photo));
        let mut tiles = Tiles::default();
        tiles.begin(pyramid.clone(), None, context.clone()).unwrap();
        for (from, to) in [(0.0, 0.4), (0.3, 0.7), (0.6, 1.0)] {
            let wanted = pyramid.tiles_in(0, DVec2::splat(from), DVec2::splat(to));
            tiles.want(wanted);
            while tiles.is_waiting() {
                tiles.take(&context);
                std::thread::yield_now();
            }
            assert!(tiles.textures.len() <= MOST_TILES);
            assert!(tiles.wanted().len() >= 25);
        }
        assert!(tiles.there().count() > 60);
    }
}
