//! Noise that depends on its arguments only: the same stone looks the same in every photo.
//!
//! Gradient noise after Perlin, "Improving Noise" (SIGGRAPH 2002), with the quintic fade and the
//! analytic derivative of Quilez, "Gradient noise derivatives" (2017); cells after Worley, "A
//! Cellular Texture Basis Function" (SIGGRAPH 1996). The lattice is hashed with the finaliser of
//! Steele et al., "Fast Splittable Pseudorandom Number Generators" (OOPSLA 2014), so that nothing
//! repeats within a scene.

use fragscale_core::split_mix::{SplitMix, spread};
use glam::{DMat3, DVec3};

/// Hashes 64 bits to 64 bits (the finaliser of SplitMix64); a bijection.
#[must_use]
pub(super) const fn hash(value: u64) -> u64 {
    spread(value.wrapping_add(SplitMix::GOLDEN))
}

/// A number in 0..1 (1 excluded) for `seed`; `channel` counts independent draws.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "53 bits fit an f64")]
pub(super) fn unit(seed: u64, channel: u64) -> f64 {
    (hash(seed ^ hash(channel)) >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

/// A direction, evenly spread over the sphere, for `seed`; length 1.
#[must_use]
pub(super) fn direction(seed: u64, channel: u64) -> DVec3 {
    let height = 2.0 * unit(seed, channel) - 1.0;
    let (sin, cos) = (unit(seed, channel ^ 0x5bd1) * std::f64::consts::TAU).sin_cos();
    let radius = (1.0 - height * height).max(0.0).sqrt();
    DVec3::new(radius * cos, radius * sin, height)
}

/// Three numbers in -1..1 from the bits of a hash, 21 bits each.
fn three(h: u64) -> DVec3 {
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_wrap,
        reason = "21 bits fit; the signed conversion is one instruction"
    )]
    let part = |shift: u32| ((h >> shift) & 0x1f_ffff) as i64 as f64 * (2.0 / 2_097_151.0) - 1.0;
    DVec3::new(part(0), part(21), part(42))
}

/// Three even draws from -1..1 for `seed`: a cheap [`direction`] of uneven length.
#[must_use]
pub(super) fn jitter(seed: u64) -> DVec3 {
    three(hash(seed))
}

/// `floor` without the call that it is on processors before SSE 4.1.
fn floor(point: DVec3) -> DVec3 {
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        reason = "beyond 2^53 there is no fraction to take off"
    )]
    let one = |value: f64| {
        let whole = value as i64 as f64;
        if whole > value { whole - 1.0 } else { whole }
    };
    DVec3::new(one(point.x), one(point.y), one(point.z))
}

/// The lattice point of `at` as hash terms of it and of its successor, axis by axis.
fn lattice(at: DVec3) -> [[u64; 2]; 3] {
    const PRIMES: [u64; 3] = [
        0x9e37_79b1_85eb_ca87,
        0xc2b2_ae3d_27d4_eb4f,
        0x1656_67b1_9e37_79f9,
    ];
    let term = |value: f64, prime: u64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "floored; beyond 2^63 the cast saturates and the noise is merely constant"
        )]
        let low = (value as i64 as u64).wrapping_mul(prime);
        [low, low.wrapping_add(prime)]
    };
    let [px, py, pz] = PRIMES;
    [term(at.x, px), term(at.y, py), term(at.z, pz)]
}

/// The cheap half of [`hash`], for the corners of one cell, whose terms are already spread.
const fn corner(term: u64) -> u64 {
    let h = (term ^ (term >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    h ^ (h >> 32)
}

/// Gradient noise and its derivative at `point` (lattice spacing 1). Mean 0, within -1.5..1.5, in
/// practice within -0.9..0.9; twice continuously differentiable; 0 on the lattice.
#[must_use]
pub(super) fn gradient_noise(point: DVec3, seed: u64) -> (f64, DVec3) {
    let at = floor(point);
    let f = point - at;
    let [[x0, x1], [y0, y1], [z0, z1]] = lattice(at);
    let u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    let knot = |x: u64, y: u64, z: u64, offset: DVec3| {
        let gradient = three(corner(x ^ y ^ z ^ seed));
        (gradient.dot(f - offset), gradient)
    };
    let (va, ga) = knot(x0, y0, z0, DVec3::ZERO);
    let (vb, gb) = knot(x1, y0, z0, DVec3::X);
    let (vc, gc) = knot(x0, y1, z0, DVec3::Y);
    let (vd, gd) = knot(x1, y1, z0, DVec3::new(1.0, 1.0, 0.0));
    let (ve, ge) = knot(x0, y0, z1, DVec3::Z);
    let (vf, gf) = knot(x1, y0, z1, DVec3::new(1.0, 0.0, 1.0));
    let (vg, gg) = knot(x0, y1, z1, DVec3::new(0.0, 1.0, 1.0));
    let (vh, gh) = knot(x1, y1, z1, DVec3::ONE);
    // The trilinear form as a polynomial in u, so that its derivative is read off it.
    let (kx, ky, kz) = (vb - va, vc - va, ve - va);
    let (kxy, kyz, kzx) = (va - vb - vc + vd, va - vc - ve + vg, va - vb - ve + vf);
    let kxyz = vb + vc - va - vd + ve - vf - vg + vh;
    let value = va
        + u.x * kx
        + u.y * ky
        + u.z * kz
        + u.x * u.y * kxy
        + u.y * u.z * kyz
        + u.z * u.x * kzx
        + u.x * u.y * u.z * kxyz;
    let low = ga.lerp(gb, u.x).lerp(gc.lerp(gd, u.x), u.y);
    let high = ge.lerp(gf, u.x).lerp(gg.lerp(gh, u.x), u.y);
    let slope = low.lerp(high, u.z)
        + du * DVec3::new(
            kx + u.y * kxy + u.z * kzx + u.y * u.z * kxyz,
            ky + u.z * kyz + u.x * kxy + u.z * u.x * kxyz,
            kz + u.x * kzx + u.y * kyz + u.x * u.y * kxyz,
        );
    (value, slope)
}

/// Turns and doubles from octave to octave: lattice planes of two octaves never coincide.
const OCTAVE: DMat3 = DMat3::from_cols(
    DVec3::new(0.0, -1.6, -1.2),
    DVec3::new(1.6, 0.72, -0.96),
    DVec3::new(1.2, -0.96, 1.28),
);

/// The most octaves a sum runs over; what is finer than that is the sensor's noise.
const MOST_OCTAVES: f64 = 9.0;

fn octaves_of(octaves: f64) -> impl Iterator<Item = (u64, f64)> {
    let octaves = octaves.clamp(0.0, MOST_OCTAVES);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within 0..=9"
    )]
    let count = octaves.ceil() as u32;
    (0..count).map(move |i| (u64::from(i), (octaves - f64::from(i)).min(1.0)))
}

/// A fractal sum (Musgrave's fBm) and its derivative: `octaves` of [`gradient_noise`], each twice
/// as fine and `gain` times as strong. A fraction of an octave fades the finest in, so that a
/// texture loses detail with distance without a seam.
#[must_use]
pub(super) fn fbm(point: DVec3, seed: u64, octaves: f64, gain: f64) -> (f64, DVec3) {
    let (mut value, mut slope) = (0.0, DVec3::ZERO);
    let (mut octave_from_point, mut strength) = (DMat3::IDENTITY, 1.0);
    for (index, part) in octaves_of(octaves) {
        let (v, g) = gradient_noise(
            octave_from_point * point,
            seed ^ index.wrapping_mul(0x9e37_79b9_7f4a_7c15),
        );
        value += strength * part * v;
        slope += strength * part * (octave_from_point.transpose() * g);
        octave_from_point = OCTAVE * octave_from_point;
        strength *= gain;
    }
    (value, slope)
}

/// A fractal sum of ridges, `1 - |noise|` squared (Musgrave's ridged multifractal, without its
/// feedback), scaled to 0..1: near 1 along sheets, as cracks and veins run.
#[must_use]
pub(super) fn ridged(point: DVec3, seed: u64, octaves: f64) -> f64 {
    let (mut value, mut total, mut strength) = (0.0, 0.0, 1.0);
    let mut at = point;
    for (index, part) in octaves_of(octaves) {
        let (v, _) = gradient_noise(at, seed ^ index.wrapping_mul(0xd1b5_4a32_d192_ed03));
        let ridge = 1.0 - v.abs().min(1.0);
        value += strength * part * ridge * ridge;
        total += strength * part;
        at = OCTAVE * at;
        strength *= 0.5;
    }
    if total > 0.0 { value / total } else { 0.0 }
}

/// What [`cells`] knows about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    /// Distance to the nearest feature point.
    pub nearest: f64,
    /// Distance to the second nearest; `second - nearest` is 0 on the border of two cells.
    pub second: f64,
    /// From the nearest feature point to the point asked for.
    pub offset: DVec3,
    /// The nearest feature point's own random bits.
    pub id: u64,
}

/// Worley's cells: one feature point in every unit cube. Looks at the 27 cubes around `point`,
/// but only as far as the second nearest found so far reaches.
#[must_use]
pub(super) fn cells(point: DVec3, seed: u64) -> Cell {
    let at = floor(point);
    let f = point - at;
    let [[x, x1], [y, y1], [z, z1]] = lattice(at);
    // The cubes from near to far along each axis, with the squared distance to each.
    let steps = |low: u64, high: u64, f: f64| {
        let below = (low.wrapping_sub(high.wrapping_sub(low)), -1.0, f * f);
        let above = (high, 1.0, (1.0 - f) * (1.0 - f));
        let own = (low, 0.0, 0.0);
        if f < 0.5 {
            [own, below, above]
        } else {
            [own, above, below]
        }
    };
    let mut found = Cell {
        nearest: f64::MAX,
        second: f64::MAX,
        offset: DVec3::ZERO,
        id: 0,
    };
    let (xs, ys, zs) = (steps(x, x1, f.x), steps(y, y1, f.y), steps(z, z1, f.z));
    for (hz, dz, gap_z) in zs {
        for (hy, dy, gap_y) in ys {
            for (hx, dx, gap_x) in xs {
                if gap_x + gap_y + gap_z >= found.second {
                    break;
                }
                let id = corner(hx ^ hy ^ hz ^ seed);
                let feature = DVec3::new(dx, dy, dz) + three(id) * 0.5 + 0.5;
                let offset = f - feature;
                let squared = offset.length_squared();
                if squared < found.nearest {
                    found.second = found.nearest;
                    found.nearest = squared;
                    found.offset = offset;
                    found.id = id;
                } else if squared < found.second {
                    found.second = squared;
                }
            }
        }
    }
    found.nearest = found.nearest.sqrt();
    found.second = found.second.sqrt();
    found
}

/// 0 below `low`, 1 above `high`, a cubic between (Hermite's).
#[must_use]
pub(super) fn smoothstep(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk(count: u64) -> impl Iterator<Item = DVec3> {
        (0..count).map(|i| DVec3::new(unit(i, 1), unit(i, 2), unit(i, 3)) * 80.0 - 40.0)
    }

    #[test]
    fn uniform_numbers_have_the_moments_of_a_uniform() {
        let n = 100_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for i in 0..n {
            let u = unit(i, 7);
            assert!((0.0..1.0).contains(&u));
            sum += u;
            squares += u * u;
        }
        let mean = sum / n as f64;
        // Four standard errors: 4 * 0.2887 / sqrt(n).
        assert!((mean - 0.5).abs() < 0.004, "{mean}");
        assert!((squares / n as f64 - mean * mean - 1.0 / 12.0).abs() < 0.001);
    }

    #[test]
    fn gradient_noise_is_centred_and_bounded() {
        let (mut sum, mut squares) = (0.0, 0.0);
        let n = 50_000;
        for point in walk(n) {
            let (v, _) = gradient_noise(point, 3);
            assert!(v.abs() < 1.5);
            sum += v;
            squares += v * v;
        }
        assert!((sum / n as f64).abs() < 0.01);
        let deviation = (squares / n as f64).sqrt();
        assert!((0.1..0.4).contains(&deviation), "{deviation}");
        // Perlin's noise is 0 on its lattice, whatever the gradients.
        assert_eq!(gradient_noise(DVec3::new(3.0, -7.0, 11.0), 9).0, 0.0);
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let h = 1e-5;
        for point in walk(500) {
            let (_, slope) = fbm(point, 5, 3.4, 0.5);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let there = fbm(point + h * axis, 5, 3.4, 0.5).0;
                let back = fbm(point - h * axis, 5, 3.4, 0.5).0;
                assert!((slope.dot(axis) - (there - back) / (2.0 * h)).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn noise_is_continuous_across_the_lattice() {
        for point in walk(500) {
            let on = DVec3::new(point.x.floor(), point.y, point.z);
            let step = DVec3::X * 1e-9;
            let (a, b) = (
                gradient_noise(on - step, 1).0,
                gradient_noise(on + step, 1).0,
            );
            assert!((a - b).abs() < 1e-7);
            let (a, b) = (cells(on - step, 1), cells(on + step, 1));
            assert!((a.nearest - b.nearest).abs() < 1e-7);
        }
    }

    #[test]
    fn a_fraction_of_an_octave_lies_between_the_whole_ones() {
        for point in walk(100) {
            let [a, b, c] = [2.0, 2.5, 3.0].map(|octaves| fbm(point, 8, octaves, 0.5).0);
            assert!((b - (a + c) / 2.0).abs() < 1e-12);
            assert!((0.0..=1.0).contains(&ridged(point, 8, 3.0)));
        }
        assert_eq!(fbm(DVec3::ONE, 8, 0.0, 0.5).0, 0.0);
    }

    #[test]
    fn cells_find_the_nearest_of_all_feature_points() {
        for point in walk(300) {
            let found = cells(point, 4);
            let at = point.floor();
            let mut distances = Vec::new();
            for i in 0..125 {
                let cube = at
                    + DVec3::new(
                        f64::from(i % 5) - 2.0,
                        f64::from(i / 5 % 5) - 2.0,
                        f64::from(i / 25) - 2.0,
                    );
                let [[x, _], [y, _], [z, _]] = lattice(cube);
                let feature = cube + three(corner(x ^ y ^ z ^ 4)) * 0.5 + 0.5;
                distances.push(feature.distance(point));
            }
            distances.sort_by(f64::total_cmp);
            assert!((found.nearest - distances[0]).abs() < 1e-9);
            assert!((found.offset.length() - found.nearest).abs() < 1e-12);
            // Beyond the 27 cubes a second one may hide only if it is farther than a cube.
            assert!((found.second - distances[1]).abs() < 1e-9 || found.second > 1.0);
        }
    }

    #[test]
    fn the_same_arguments_give_the_same_noise() {
        for point in walk(50) {
            assert_eq!(fbm(point, 1, 4.0, 0.5), fbm(point, 1, 4.0, 0.5));
            assert_ne!(gradient_noise(point, 1).0, gradient_noise(point, 2).0);
        }
    }
}
