//! The two nearest descriptors on a graphics card: `shaders/match.wgsl`, to the bit what [`Products`] finds.

use bytemuck::{Pod, Zeroable};
use cumulus3d_matching::{MatcherBackend, Top2};
use fragscale_render::Gpu;
use wgpu::BufferUsages;

use super::nearest_two::{LENGTH, Products};
use crate::card::Card;
use crate::fault::Fault;

/// Descriptors of a work group, and how many of the others it goes through: parts enough for all of a card.
const TILE: usize = 64;
const PART: usize = 2048;

/// Descriptors are compared by a card; where it fails, the processor goes on.
pub(super) struct OnCard<'a> {
    card: &'a Card,
    pipeline: wgpu::ComputePipeline,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Settings {
    own: u32,
    others: u32,
    part: u32,
    padding: u32,
}

impl<'a> OnCard<'a> {
    /// `None` where the card cannot do it: the card knows why.
    pub(super) fn new(card: &'a Card) -> Option<Self> {
        let shader = include_str!("../../../shaders/match.wgsl");
        let pipeline = card.try_on(|gpu| gpu.compute_pipeline("match", shader, "nearest_two"))?;
        Some(Self { card, pipeline })
    }

    /// Of each of `own` the nearest two among `others`.
    fn rows(
        &self,
        gpu: &Gpu,
        own: &wgpu::Buffer,
        others: &wgpu::Buffer,
    ) -> Result<Vec<Top2>, Fault> {
        let count = |buffer: &wgpu::Buffer| buffer.size() as usize / LENGTH;
        let (rows, columns) = (count(own), count(others));
        let parts = columns.div_ceil(PART);
        let word = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let settings = Settings {
            own: word(rows),
            others: word(columns),
            part: word(PART),
            padding: 0,
        };
        let settings = bytemuck::bytes_of(&settings);
        let settings = gpu.buffer("settings", settings, BufferUsages::UNIFORM);
        let found = gpu.empty_buffer("nearest", 16 * rows * parts);
        let buffers = [&settings, own, others, &found];
        let groups = [word(rows.div_ceil(TILE)), word(parts)];
        gpu.compute(&self.pipeline, &buffers, groups)?;
        let found = gpu.contents(&found)?;
        let mut nearest = vec![Top2::default(); rows];
        for (number, four) in found.chunks_exact(16).enumerate() {
            let [best, idx, second, _] = bytemuck::pod_read_unaligned::<[u32; 4]>(four);
            nearest[number % rows].merge(&Top2 { best, idx, second });
        }
        Ok(nearest)
    }
}

impl MatcherBackend for OnCard<'_> {
    fn top2(&self, d1: &[u8], n1: usize, d2: &[u8], n2: usize) -> (Vec<Top2>, Vec<Top2>) {
        let on_card = |gpu: &Gpu| {
            let storage = |bytes| gpu.buffer("descriptors", bytes, BufferUsages::STORAGE);
            let (first, second) = (storage(d1), storage(d2));
            let rows = self.rows(gpu, &first, &second)?;
            Ok((rows, self.rows(gpu, &second, &first)?))
        };
        let is_empty = n1 == 0 || n2 == 0;
        let found = (!is_empty).then(|| self.card.try_on(on_card)).flatten();
        found.unwrap_or_else(|| Products.top2(d1, n1, d2, n2))
    }
}

#[cfg(test)]
mod tests {
    use fragscale_core::split_mix::SplitMix;

    use super::*;

    /// The processor's answer to the bit, of counts around tiles and parts, with ties, up to the largest product.
    #[test]
    fn the_card_finds_what_the_processor_finds() {
        let own = Card::on(Gpu::fastest().unwrap());
        let card = OnCard::new(&own).unwrap();
        let mut random = SplitMix(5);
        for (n1, n2) in [(1, 1), (0, 5), (63, 65), (64, 2048), (300, 4100)] {
            for levels in [2, 256] {
                let mut bytes = |count: usize| -> Vec<u8> {
                    let byte = |_| ((random.next() >> 20) % levels * (255 / (levels - 1))) as u8;
                    (0..count * LENGTH).map(byte).collect()
                };
                let (d1, d2) = (bytes(n1), bytes(n2));
                let expected = Products.top2(&d1, n1, &d2, n2);
                assert_eq!(card.top2(&d1, n1, &d2, n2), expected, "{n1} {n2} {levels}");
            }
        }
        let (d1, d2) = (vec![255; 2 * 128], vec![255; 3 * 128]);
        assert_eq!(card.top2(&d1, 2, &d2, 3), Products.top2(&d1, 2, &d2, 3));
        assert!(own.said().is_ok());
    }

    /// A card that is lost in the middle of the work costs time and nothing else, and it is known why.
    #[test]
    fn the_processor_goes_on_where_the_card_is_lost() {
        let gpu = Gpu::fastest().unwrap();
        let own = Card::on(gpu.clone());
        let card = OnCard::new(&own).unwrap();
        gpu.device.destroy();
        let (d1, d2) = (vec![7; 2 * 128], vec![9; 3 * 128]);
        assert_eq!(card.top2(&d1, 2, &d2, 3), Products.top2(&d1, 2, &d2, 3));
        let said = own.said().unwrap_err();
        assert!(said.contains("the processor went on"), "{said}");
    }
}
