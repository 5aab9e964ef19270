//! A crude scene to look at: hundreds of convex stones on fines. For eyes, not for the program:
//! it writes a picture only where `FRAGSCALE_LOOK` says so.

#![allow(
    clippy::print_stdout,
    clippy::cast_possible_wrap,
    reason = "it speaks only to whoever asked for a picture"
)]

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::sample::light::Light;
use crate::sample::material::{Edge, Material, Spot};
use crate::sample::noise::{direction, hash, unit};
use crate::sample::sensor::Sensor;

struct Stone {
    id: u64,
    centre: DVec3,
    turn: DQuat,
    size: f64,
    planes: Vec<(DVec3, f64)>,
}

struct Block {
    centre: DVec3,
    radius: f64,
    stones: Vec<Stone>,
}

struct Scene {
    blocks: Vec<Block>,
    unit: f64,
    stones: Material,
    floor: Material,
    light: Light,
}

impl Stone {
    fn new(id: u64, size: f64, unit_seed: u64) -> Self {
        let seed = hash(id ^ unit_seed);
        let u = |c| unit(seed, c);
        let half = DVec3::new(0.5, 0.34 + 0.12 * u(1), 0.22 + 0.16 * u(2)) * size;
        let mut planes = Vec::new();
        for (i, axis) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            for side in [-1.0, 1.0] {
                let slant = direction(seed, 40 + 2 * i as u64 + (side > 0.0) as u64) * 0.36;
                let normal = (axis * side + slant).normalize();
                planes.push((
                    normal,
                    half.dot(axis) * (0.8 + 0.2 * u(60 + planes.len() as u64)),
                ));
            }
        }
        for i in 0..(5 + (u(3) * 6.0) as u64) {
            let normal = (direction(seed, 80 + i) / half).normalize();
            let reach = (normal * half).length();
            planes.push((normal, reach * (0.72 + 0.3 * u(100 + i))));
        }
        let turn = DQuat::from_rotation_z(u(4) * TAU)
            * DQuat::from_axis_angle(
                direction(seed, 5).with_z(0.0).normalize(),
                0.9 * u(6) * u(6),
            );
        Self {
            id,
            centre: DVec3::ZERO,
            turn,
            size,
            planes,
        }
    }

    /// Distance and face.
    fn hit(&self, from: DVec3, along: DVec3, most: f64) -> Option<(f64, usize)> {
        let to = self.centre - from;
        let near = to.dot(along);
        let reach = 0.7 * self.size;
        if to.length_squared() - near * near > reach * reach || near < -reach || near - reach > most
        {
            return None;
        }
        let back = self.turn.inverse();
        let (o, d) = (back * -to, back * along);
        let (mut enter, mut leave, mut face) = (1e-7 * self.size, most, usize::MAX);
        for (i, (n, w)) in self.planes.iter().enumerate() {
            let (slope, gap) = (n.dot(d), w - n.dot(o));
            if slope < 0.0 {
                if gap / slope > enter {
                    (enter, face) = (gap / slope, i);
                }
            } else if gap < 0.0 {
                return None;
            } else if slope > 0.0 {
                leave = leave.min(gap / slope);
            }
            if enter > leave {
                return None;
            }
        }
        (face != usize::MAX).then_some((enter, face))
    }
}

impl Scene {
    fn new(unit_length: f64, stones: Material, floor: Material, light: Light, seed: u64) -> Self {
        let mut placed: Vec<Stone> = Vec::new();
        for id in 0..900 {
            let u = |c| unit(hash(id ^ (seed << 20)), c);
            let size = unit_length * (0.36 + 2.1 * u(1).powi(5)) * if id < 14 { 1.6 } else { 1.0 };
            let mut stone = Stone::new(id, size, seed);
            let (r, a) = (u(2).sqrt() * 10.0 * unit_length, u(3) * TAU);
            let (x, y) = (r * a.cos() * 1.35, r * a.sin() * 0.8);
            let mut z: f64 = 0.22 * size;
            for other in &placed {
                let flat = (other.centre.x - x).hypot(other.centre.y - y);
                let apart = 0.41 * (size + other.size);
                if flat < apart {
                    z = z.max(other.centre.z + 0.62 * (apart * apart - flat * flat).sqrt());
                }
            }
            stone.centre = DVec3::new(x, y, z);
            placed.push(stone);
        }
        let mut blocks: Vec<Block> = Vec::new();
        placed.sort_by_key(|s| {
            let cell = |v: f64| (v / (2.2 * unit_length)).floor() as i64;
            (cell(s.centre.x), cell(s.centre.y))
        });
        for stone in placed {
            let cell = |p: DVec3| (p / (2.2 * unit_length)).floor().truncate();
            match blocks.last_mut() {
                Some(b) if cell(b.stones[0].centre) == cell(stone.centre) => b.stones.push(stone),
                _ => blocks.push(Block {
                    centre: stone.centre,
                    radius: 0.0,
                    stones: vec![stone],
                }),
            }
        }
        for b in &mut blocks {
            b.centre = b.stones.iter().map(|s| s.centre).sum::<DVec3>() / b.stones.len() as f64;
            b.radius = b
                .stones
                .iter()
                .map(|s| s.centre.distance(b.centre) + 0.7 * s.size)
                .fold(0.0, f64::max);
        }
        Self {
            blocks,
            unit: unit_length,
            stones,
            floor,
            light,
        }
    }

    fn hit(&self, from: DVec3, along: DVec3, most: f64) -> Option<(f64, usize, &Stone)> {
        let mut best: Option<(f64, usize, &Stone)> = None;
        let mut most = most;
        for b in &self.blocks {
            let to = b.centre - from;
            let near = to.dot(along);
            if to.length_squared() - near * near > b.radius * b.radius
                || near < -b.radius
                || near - b.radius > most
            {
                continue;
            }
            for s in &b.stones {
                if let Some((t, face)) = s.hit(from, along, most) {
                    most = t;
                    best = Some((t, face, s));
                }
            }
        }
        best
    }

    /// What comes along one ray.
    fn radiance(&self, from: DVec3, along: DVec3, pixel_angle: f64) -> [f64; 3] {
        let ground = if along.z < 0.0 {
            -from.z / along.z
        } else {
            1e9
        };
        let seen = self.hit(from, along, ground);
        let (t, normal, appearance) = match seen {
            Some((t, face, s)) => {
                let back = s.turn.inverse();
                let point = back * (from + t * along - s.centre);
                let (normal, _) = s.planes[face];
                let edge = s
                    .planes
                    .iter()
                    .enumerate()
                    .filter(|(i, _)| *i != face)
                    .map(|(_, (n, w))| Edge {
                        distance: w - n.dot(point),
                        normal: *n,
                    })
                    .min_by(|a, b| a.distance.total_cmp(&b.distance));
                let spot = Spot {
                    fragment: s.id,
                    point,
                    normal,
                    up: back * DVec3::Z,
                    size: s.size,
                    pixel: t * pixel_angle,
                    edge,
                };
                (
                    t,
                    s.turn * normal,
                    self.stones.surface(&spot).turned(s.turn),
                )
            }
            None => {
                let spot = Spot {
                    fragment: 0,
                    point: from + ground * along,
                    normal: DVec3::Z,
                    up: DVec3::Z,
                    size: self.unit,
                    pixel: ground * pixel_angle,
                    edge: None,
                };
                (ground, DVec3::Z, self.floor.surface(&spot))
            }
        };
        let at = from + t * along + normal * (1e-5 * self.unit);
        let seed = hash(along.x.to_bits() ^ hash(along.y.to_bits()));
        let (mut open, rays) = (0, 10);
        for i in 0..rays {
            let d = (normal + 0.999 * direction(seed, 900 + i)).normalize();
            // Upwards a near stone hides the sky; downwards only the pile's flanks see past it.
            let reach = if d.z > 0.0 { 3.0 * self.unit } else { 1e9 };
            if (d.z > 0.0 || at.z > self.unit) && self.hit(at, d, reach).is_none() {
                open += 1;
            }
        }
        let openness = open as f64 / rays as f64;
        self.light.shade(
            &appearance,
            normal,
            -along,
            |d| self.hit(at, d, 1e9).is_some(),
            openness,
        )
    }

    fn picture(&self, path: &str, width: u32, height: u32, rays: u64, near: f64) {
        let eye = DVec3::new(0.0, -9.0, 17.0) * self.unit * near;
        let forward = (DVec3::new(0.0, -0.4, 0.5) * self.unit - eye).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let down = forward.cross(right);
        let focal = 1.05 * f64::from(width);
        let row = |y: u32| -> Vec<[f64; 3]> {
            (0..width)
                .map(|x| {
                    let mut sum = [0.0; 3];
                    for i in 0..rays {
                        let seed = hash((u64::from(x) << 32) | u64::from(y));
                        let dx = f64::from(x) + unit(seed, 2 * i) - 0.5 * f64::from(width);
                        let dy = f64::from(y) + unit(seed, 2 * i + 1) - 0.5 * f64::from(height);
                        let along = (forward * focal + right * dx + down * dy).normalize();
                        let one = self.radiance(eye, along, 1.0 / focal);
                        for (s, v) in sum.iter_mut().zip(one) {
                            *s += v / rays as f64;
                        }
                    }
                    sum
                })
                .collect()
        };
        let rows: Vec<u32> = (0..height).collect();
        let halves: Vec<Vec<Vec<[f64; 3]>>> = std::thread::scope(|scope| {
            let parts: Vec<_> = rows
                .chunks(height.div_ceil(2) as usize)
                .map(|part| scope.spawn(move || part.iter().map(|y| row(*y)).collect()))
                .collect();
            parts.into_iter().map(|p| p.join().unwrap()).collect()
        });
        let lines: Vec<&Vec<[f64; 3]>> = halves.iter().flatten().collect();
        let mean = lines
            .iter()
            .flat_map(|l| l.iter())
            .map(|p| p[1])
            .sum::<f64>()
            / f64::from(width * height);
        let sensor = Sensor::metered(mean, 11);
        let image = image::RgbImage::from_fn(width, height, |x, y| {
            image::Rgb(sensor.develop(lines[y as usize][x as usize], x, y, (width, height)))
        });
        image.save(path).unwrap();
    }
}

/// `FRAGSCALE_LOOK=/tmp/look cargo test --release look_at_it`: `/tmp/look-gravel.png` and so on.
#[test]
fn look_at_it() {
    let Ok(stem) = std::env::var("FRAGSCALE_LOOK") else {
        return;
    };
    let rays = std::env::var("FRAGSCALE_LOOK_RAYS").map_or(1, |s| s.parse().unwrap());
    let sun = Light::sun(2.4, 0.75);
    let scenes = [
        (
            "gravel",
            Scene::new(
                0.045,
                Material::gravel(),
                Material::fines(),
                Light::lab(),
                1,
            ),
        ),
        (
            "blasted",
            Scene::new(0.55, Material::blasted_rock(), Material::fines(), sun, 2),
        ),
        (
            "stockpile",
            Scene::new(
                0.12,
                Material::stockpile(),
                Material::quarry_floor(),
                sun,
                3,
            ),
        ),
    ];
    let only = std::env::var("FRAGSCALE_LOOK_ONLY").unwrap_or_default();
    for (name, scene) in scenes {
        if name.contains(&only) {
            scene.picture(&format!("{stem}-{name}.png"), 800, 450, rays, 1.0);
            scene.picture(&format!("{stem}-{name}-near.png"), 800, 450, rays, 0.45);
        }
    }
}

/// Not a benchmark, but enough to see the microseconds; prints only when looked at.
#[test]
fn the_cost_of_a_hit() {
    if std::env::var("FRAGSCALE_LOOK").is_err() {
        return;
    }
    for (name, material) in [
        ("gravel", Material::gravel()),
        ("blasted", Material::blasted_rock()),
        ("fines", Material::fines()),
        ("concrete", Material::concrete_floor()),
        ("painted", Material::painted_sphere()),
    ] {
        let light = Light::lab();
        let (mut cost, mut surface_cost, mut sum) = (f64::MAX, f64::MAX, 0.0);
        // The least of many short runs: what the machine does besides does not count.
        for run in 0..200_u64 {
            let spots: Vec<Spot> = (0..1000)
                .map(|i| Spot {
                    fragment: i % 50,
                    point: direction(i + 1000 * run, 1) * 0.05,
                    normal: direction(i % 7, 0),
                    up: DVec3::Z,
                    size: 0.1,
                    pixel: 0.0002,
                    edge: Some(Edge {
                        distance: 0.002,
                        normal: DVec3::Z,
                    }),
                })
                .collect();
            let start = std::time::Instant::now();
            let seen: Vec<_> = spots.iter().map(|spot| material.surface(spot)).collect();
            surface_cost = surface_cost.min(start.elapsed().as_secs_f64() * 1e3);
            for (spot, seen) in spots.iter().zip(seen) {
                let [red, ..] = light.shade(&seen, spot.normal, DVec3::Z, |_| false, 0.8);
                sum += red;
            }
            cost = cost.min(start.elapsed().as_secs_f64() * 1e3);
        }
        println!("{name}: {surface_cost:.2} us a surface, {cost:.2} us with its shade ({sum:.0})");
    }
}
