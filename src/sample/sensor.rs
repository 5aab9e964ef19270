//! What a camera's sensor makes of radiance: exposure, vignetting, noise, tone, 8-bit sRGB.
//!
//! Noise after the EMVA 1288 standard's linear model: the variance of a signal of `e` electrons is
//! `e + read_noise^2`. The transfer function is IEC 61966-2-1 (sRGB).

use crate::noise::{hash, unit};

/// A camera's sensor and its development.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sensor {
    /// Signal per radiance; a signal of 1 is white. See [`Sensor::metered`].
    pub exposure: f64,
    /// How much of the light is lost in the corners, 0 to 1 (0.2: a fifth).
    pub vignetting: f64,
    /// Electrons at a signal of 1. A drone's one-inch sensor: about 9000; smaller is noisier.
    pub full_well: f64,
    /// Read noise, in electrons (standard deviation).
    pub read_noise: f64,
    /// Makes the noise of one photo its own.
    pub seed: u64,
}

impl Sensor {
    /// A drone's camera exposed so that radiance `average` becomes middle grey (signal 0.18, as
    /// light meters are made); an `average` that is not positive is taken for 1.
    #[must_use]
    pub(super) fn metered(average: f64, seed: u64) -> Self {
        let average = if average > 0.0 { average } else { 1.0 };
        Self {
            exposure: 0.18 / average,
            vignetting: 0.18,
            full_well: 9000.0,
            read_noise: 4.0,
            seed,
        }
    }

    /// The linear signal of one pixel, noise included: 1 is white, a little below 0 is noise.
    /// `x` and `y` count pixels from the top left, `size` is (width, height).
    #[must_use]
    pub(super) fn expose(&self, radiance: [f64; 3], x: u32, y: u32, size: (u32, u32)) -> [f64; 3] {
        let (width, height) = (f64::from(size.0.max(1)), f64::from(size.1.max(1)));
        let (dx, dy) = (
            (f64::from(x) + 0.5) * 2.0 - width,
            (f64::from(y) + 0.5) * 2.0 - height,
        );
        // 0 in the centre, 1 in the corners; the loss grows as the cosine to the fourth does.
        let off_axis = (dx * dx + dy * dy) / (width * width + height * height);
        let gain = self.exposure * (1.0 - self.vignetting * off_axis);
        let pixel = hash(self.seed ^ ((u64::from(y) << 32) | u64::from(x)));
        let mut channel = 0;
        radiance.map(|value| {
            channel += 2;
            let electrons = (value * gain).max(0.0) * self.full_well;
            let deviation = (electrons + self.read_noise * self.read_noise).sqrt();
            // Box & Muller (1958).
            let away = (-2.0 * (1.0 - unit(pixel, channel)).ln()).sqrt();
            let normal = away * (std::f64::consts::TAU * unit(pixel, channel + 1)).cos();
            (electrons + deviation * normal) / self.full_well
        })
    }

    /// The 8-bit sRGB pixel for a radiance: [`expose`](Self::expose), [`tone`], [`srgb`]. Rounds
    /// with a dither of its own noise, which leaves no bands.
    #[must_use]
    pub(super) fn develop(&self, radiance: [f64; 3], x: u32, y: u32, size: (u32, u32)) -> [u8; 3] {
        self.expose(radiance, x, y, size)
            .map(|signal| srgb(tone(signal)))
    }
}

/// The camera's curve: straight to 0.5, above that a shoulder that reaches 1 at infinity (at
/// a signal of 2 it has come to 0.95), so that sunlit dust is not cut off.
#[must_use]
pub(super) fn tone(signal: f64) -> f64 {
    let knee = 0.5;
    if signal <= knee {
        signal.max(0.0)
    } else {
        let over = (signal - knee) / (1.0 - knee);
        knee + (1.0 - knee) * (over / (1.0 + over.powf(1.6)).powf(1.0 / 1.6))
    }
}

/// The sRGB byte of a linear value, 0 to 1; beyond that it is cut.
#[must_use]
pub(super) fn srgb(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within 0..=255; a NaN becomes 0"
    )]
    let byte = (encoded * 255.0).round() as u8;
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (400, 300);

    #[test]
    fn srgb_has_the_standards_values() {
        assert_eq!(srgb(0.0), 0);
        assert_eq!(srgb(1.0), 255);
        assert_eq!(srgb(-1.0), 0);
        assert_eq!(srgb(7.0), 255);
        assert_eq!(srgb(f64::NAN), 0);
        // Known from outside: linear 0.18 is 46.1 % of full scale, one half is 73.5 %.
        assert_eq!(srgb(0.18), 118);
        assert_eq!(srgb(0.5), 188);
    }

    #[test]
    fn tone_rises_to_one() {
        let mut last = -1.0;
        for i in 0..1000 {
            let value = tone(f64::from(i) * 0.01);
            assert!(value > last && value < 1.0);
            last = value;
        }
        assert_eq!(tone(0.3), 0.3);
        assert_eq!(tone(-0.1), 0.0);
    }

    #[test]
    fn noise_has_the_variance_that_it_claims() {
        let sensor = Sensor {
            vignetting: 0.0,
            ..Sensor::metered(1.0, 5)
        };
        for level in [0.0, 0.1, 2.0] {
            let (mut sum, mut squares) = (0.0, 0.0);
            for y in 0..SIZE.1 {
                for x in 0..SIZE.0 {
                    let [_, green, _] = sensor.expose([level; 3], x, y, SIZE);
                    sum += green;
                    squares += green * green;
                }
            }
            let n = f64::from(SIZE.0 * SIZE.1);
            let mean = sum / n;
            let variance = squares / n - mean * mean;
            let electrons = level * 0.18 * 9000.0;
            let claimed = (electrons + 16.0) / (9000.0 * 9000.0);
            assert!((mean - level * 0.18).abs() < 5.0 * (claimed / n).sqrt());
            assert!((variance / claimed - 1.0).abs() < 0.02, "{level}");
        }
    }

    #[test]
    fn corners_lose_what_vignetting_says() {
        let sensor = Sensor {
            vignetting: 0.3,
            full_well: 1e12,
            ..Sensor::metered(1.0, 5)
        };
        let [corner, ..] = sensor.expose([1.0; 3], 0, 0, (4000, 3000));
        let [centre, ..] = sensor.expose([1.0; 3], 2000, 1500, (4000, 3000));
        assert!((corner / centre - 0.7).abs() < 1e-3);
    }

    #[test]
    fn a_pixel_is_the_same_whenever_it_is_asked_for() {
        let sensor = Sensor::metered(0.2, 5);
        let first = sensor.develop([0.2, 0.3, 0.1], 7, 9, SIZE);
        assert_eq!(first, sensor.develop([0.2, 0.3, 0.1], 7, 9, SIZE));
        let other = Sensor::metered(0.2, 6);
        assert_ne!(
            sensor.expose([0.2; 3], 7, 9, SIZE),
            other.expose([0.2; 3], 7, 9, SIZE)
        );
        assert_eq!(Sensor::metered(0.0, 1), Sensor::metered(1.0, 1));
    }
}
