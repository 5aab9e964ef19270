//! The sweeps on a graphics card: `shaders/patch_match.wgsl`, tile by tile.
//!
//! A tile has a margin as wide as its sweeps reach, so that the answer does not depend on the tiles. Of the
//! other views it brings along what the tile can see at any depth. Tiles shrink until every buffer is
//! under 100 MiB: what a photo of 100 megapixels needs at a time stays far under 2 GiB.

use bytemuck::{Pod, Zeroable};
use wgpu::BufferUsages;

use super::pair::project;
use super::plane::{Plane, Planes};
use super::{Backend, OFFSETS, Problem, REACH, Source, Sweep};
use crate::fault::Fault;
use crate::jobs::Progress;

/// The largest buffer, in words of four bytes: what every device binds, with some room.
const MOST_WORDS: usize = 25 << 20;
/// The side that tiles begin with, pixels.
const LARGEST_TILE: usize = 1024;
/// What windows in other views stick out beyond their centres, pixels: more is read at the edge of the rectangle.
const STICKS_OUT: f32 = 32.0;

/// A graphics card.
#[derive(Debug)]
pub struct Gpu {
    gpu: fragscale_render::Gpu,
    pipeline: wgpu::ComputePipeline,
    largest_tile: usize,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Settings {
    tile: [u32; 2],
    origin: [u32; 2],
    size: [u32; 2],
    range: [f32; 2],
    per_pixel: f32,
    focal: f32,
    amplitude: f32,
    geometric: f32,
    parity: u32,
    anywhere: u32,
    salt: u32,
    sources: u32,
    crop_origin: [u32; 2],
    crop: [u32; 2],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Other {
    there: [[f32; 4]; 4],
    back: [[f32; 4]; 4],
    levels: u32,
    depths: u32,
    size: [u32; 2],
    crop_origin: [u32; 2],
    crop: [u32; 2],
    has_depths: u32,
    padding: [u32; 3],
}

/// A rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Crop {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
}

impl Crop {
    /// Grown on all sides, within an image.
    fn grown(self, by: usize, width: usize, height: usize) -> Self {
        let (x, y) = (self.x.saturating_sub(by), self.y.saturating_sub(by));
        Self {
            x,
            y,
            width: (self.x + self.width + by).min(width) - x,
            height: (self.y + self.height + by).min(height) - y,
        }
    }

    fn pixels(self) -> usize {
        self.width * self.height
    }

    /// Its rows of an image's list.
    fn rows<T>(self, list: &[T], width: usize) -> impl Iterator<Item = &[T]> {
        (self.y..self.y + self.height)
            .map(move |y| &list[y * width + self.x..y * width + self.x + self.width])
    }

    fn origin(self) -> [u32; 2] {
        [word(self.x), word(self.y)]
    }

    fn size(self) -> [u32; 2] {
        [word(self.width), word(self.height)]
    }
}

fn word(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

impl Gpu {
    /// On this device.
    ///
    /// # Errors
    /// Where the device refuses the shader.
    pub fn on(gpu: fragscale_render::Gpu) -> Result<Self, Fault> {
        let shader = include_str!("../../../shaders/patch_match.wgsl");
        Ok(Self {
            pipeline: gpu.compute_pipeline("patch match", shader, "sweep")?,
            gpu,
            largest_tile: LARGEST_TILE,
        })
    }

    /// The sweeps over one tile; hands back its planes, margins and all.
    fn tile(
        &self,
        problem: &Problem,
        planes: &Planes,
        outer: Crop,
        sweeps: &[Sweep],
        progress: &Progress,
    ) -> Result<Vec<[f32; 4]>, Fault> {
        let (width, height) = (problem.luma.width, problem.luma.height);
        let own = outer.grown(5, width, height);
        let mut levels = Vec::new();
        pack(&mut levels, own.rows(&problem.luma.levels, width));
        let mut depths: Vec<f32> = Vec::new();
        let mut others = Vec::new();
        for source in &problem.sources {
            let crop = seen(problem, source, outer);
            let begin = word(levels.len());
            pack(
                &mut levels,
                crop.rows(&source.luma.levels, source.luma.width),
            );
            let depths_begin = word(depths.len());
            if let Some(theirs) = &source.inverse_depths {
                for row in crop.rows(theirs, source.luma.width) {
                    depths.extend_from_slice(row);
                }
            }
            others.push(Other {
                there: source.pair.there.map(|[x, y, z]| [x, y, z, 0.0]),
                back: source.pair.back.map(|[x, y, z]| [x, y, z, 0.0]),
                levels: begin,
                depths: depths_begin,
                size: [word(source.luma.width), word(source.luma.height)],
                crop_origin: crop.origin(),
                crop: crop.size(),
                has_depths: u32::from(source.inverse_depths.is_some()),
                padding: [0; 3],
            });
        }
        depths.push(0.0);
        let mut own_planes: Vec<[f32; 4]> = Vec::with_capacity(outer.pixels());
        for row in outer.rows(&planes.planes, width) {
            own_planes.extend(row.iter().map(|plane| {
                let cost = if plane.cost.is_nan() {
                    f32::MAX
                } else {
                    plane.cost
                };
                [plane.inverse_depth, plane.slope[0], plane.slope[1], cost]
            }));
        }
        let storage = |label, contents: &[u8]| {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            self.gpu.buffer(label, contents, usage)
        };
        let state = storage("planes", bytemuck::cast_slice(&own_planes));
        let levels = storage("grey levels", bytemuck::cast_slice(&levels));
        let depths = storage("depths", bytemuck::cast_slice(&depths));
        let others_buffer = storage("views", bytemuck::cast_slice(&others));
        for sweep in sweeps {
            for parity in 0..2 {
                if progress.is_cancelled() {
                    progress.advance(0, 1)?;
                }
                let settings = Settings {
                    tile: outer.size(),
                    origin: outer.origin(),
                    size: [word(width), word(height)],
                    range: problem.range,
                    per_pixel: problem.per_pixel,
                    focal: problem.focal,
                    amplitude: sweep.amplitude,
                    geometric: sweep.geometric,
                    parity,
                    anywhere: u32::from(sweep.anywhere),
                    salt: sweep.salt,
                    sources: word(others.len()),
                    crop_origin: own.origin(),
                    crop: own.size(),
                };
                let bytes = bytemuck::bytes_of(&settings);
                let settings = self.gpu.buffer("settings", bytes, BufferUsages::UNIFORM);
                let columns = outer.width.div_ceil(2);
                self.gpu.compute(
                    &self.pipeline,
                    &[&settings, &state, &levels, &depths, &others_buffer],
                    [word(columns.div_ceil(8)), word(outer.height.div_ceil(8))],
                )?;
            }
        }
        let bytes = self.gpu.contents(&state)?;
        let planes = bytes.chunks_exact(16);
        Ok(planes
            .map(bytemuck::pod_read_unaligned::<[f32; 4]>)
            .collect())
    }
}

/// Adds grey levels, four a word; the last word is filled up.
fn pack<'a>(levels: &mut Vec<u32>, rows: impl Iterator<Item = &'a [u8]>) {
    let bytes: Vec<u8> = rows.flatten().copied().collect();
    levels.extend(bytes.chunks(4).map(|four| {
        let mut word = [0; 4];
        word[..four.len()].copy_from_slice(four);
        u32::from_le_bytes(word)
    }));
}

/// What a view shows of a tile at any depth; all of it where a part of the tile may lie behind it.
fn seen(problem: &Problem, source: &Source, tile: Crop) -> Crop {
    let (width, height) = (source.luma.width, source.luma.height);
    let mut least = [f32::MAX; 2];
    let mut most = [f32::MIN; 2];
    for x in [tile.x, tile.x + tile.width] {
        for y in [tile.y, tile.y + tile.height] {
            // Straight lines stay straight: corners at the ends of the range bound the rest.
            for inverse_depth in problem.range {
                let m = project(&source.pair.there, [x as f32, y as f32], inverse_depth);
                if m[2] < 1e-3 {
                    return Crop {
                        x: 0,
                        y: 0,
                        width,
                        height,
                    };
                }
                for i in 0..2 {
                    least[i] = least[i].min(m[i] / m[2] - STICKS_OUT);
                    most[i] = most[i].max(m[i] / m[2] + STICKS_OUT);
                }
            }
        }
    }
    // One pixel at least, for what is not seen at all.
    let begin = |i: usize, size: usize| (least[i].max(0.0) as usize).min(size - 1);
    let end = |i: usize, size: usize| (most[i].max(1.0).ceil() as usize).min(size);
    let (x, y) = (begin(0, width), begin(1, height));
    Crop {
        x,
        y,
        width: end(0, width).max(x + 1) - x,
        height: end(1, height).max(y + 1) - y,
    }
}

/// How far sweeps carry planes, pixels: each colour once by the longest step.
fn reach(sweeps: &[Sweep]) -> usize {
    let longest = REACH.iter().copied().max().unwrap_or(1);
    2 * sweeps.len() * usize::try_from(longest).unwrap_or(1) + OFFSETS.len()
}

/// The words of the largest buffer for a tile.
fn words(problem: &Problem, outer: Crop) -> usize {
    let crops: usize = problem
        .sources
        .iter()
        .map(|source| seen(problem, source, outer).pixels())
        .sum();
    (4 * outer.pixels()).max(crops)
}

impl Backend for Gpu {
    fn name(&self) -> String {
        self.gpu.name.clone()
    }

    fn sweep(
        &self,
        problem: &Problem,
        planes: &mut Planes,
        sweeps: &[Sweep],
        progress: &Progress,
    ) -> Result<(), Fault> {
        let (width, height) = (planes.width, planes.height);
        let margin = reach(sweeps);
        let before = planes.clone();
        let mut open = Vec::new();
        for y in (0..height).step_by(self.largest_tile) {
            for x in (0..width).step_by(self.largest_tile) {
                open.push(Crop {
                    x,
                    y,
                    width: self.largest_tile.min(width - x),
                    height: self.largest_tile.min(height - y),
                });
            }
        }
        while let Some(inner) = open.pop() {
            let outer = inner.grown(margin, width, height);
            if words(problem, outer) > MOST_WORDS && inner.width.max(inner.height) > 64 {
                let halves = |size: usize| [(0, size / 2), (size / 2, size - size / 2)];
                for (dy, tall) in halves(inner.height) {
                    for (dx, wide) in halves(inner.width) {
                        open.push(Crop {
                            x: inner.x + dx,
                            y: inner.y + dy,
                            width: wide,
                            height: tall,
                        });
                    }
                }
                continue;
            }
            if inner.pixels() == 0 {
                continue;
            }
            let found = self.tile(problem, &before, outer, sweeps, progress)?;
            for y in inner.y..inner.y + inner.height {
                for x in inner.x..inner.x + inner.width {
                    let [inverse_depth, right, down, cost] =
                        found[(y - outer.y) * outer.width + x - outer.x];
                    planes.planes[y * width + x] = Plane {
                        inverse_depth,
                        slope: [right, down],
                        cost,
                    };
                }
            }
        }
        Ok(())
    }
}
