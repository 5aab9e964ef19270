//! Orientations that can be read, and are probably not what their columns say: no photo of them is trusted.

use std::f64::consts::{PI, TAU};

use crate::flight::Doubt;

/// With fewer photos all angles may well be small.
const FEW: usize = 3;
/// Degrees. Who looks straight down along one line has none but small ones.
const SMALL: f64 = 0.5;
/// How far the length of a quaternion may be off 1 by rounding, or by a filter.
const LENGTH: f64 = 0.01;

/// The numbers of orientations, as a file has them.
#[derive(Debug, Default)]
pub(super) struct OddAngles {
    photos: usize,
    largest: f64,
    /// Whether one of them is below 0: else they may count from 0 to a whole turn.
    is_signed: bool,
    /// The first quaternion that is no rotation: its line and length.
    quaternion: Option<(u64, f64)>,
}

impl OddAngles {
    /// Takes the angles of a photo.
    pub(super) fn angles(&mut self, angles: &[f64]) {
        self.photos += 1;
        self.is_signed |= angles.iter().any(|angle| *angle < 0.0);
        let largest = angles.iter().map(|angle| angle.abs());
        self.largest = largest.fold(self.largest, f64::max);
    }

    /// Takes the quaternion of a photo.
    pub(super) fn quaternion(&mut self, line: u64, parts: &[f64]) {
        let length = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        if (length - 1.0).abs() > LENGTH {
            self.quaternion.get_or_insert((line, length));
        }
    }

    /// What is odd about them.
    pub(super) fn doubts(&self) -> Vec<Doubt> {
        let most = if self.is_signed { PI } else { TAU };
        // An angle that was rounded up to four digits is not beyond the turn.
        let in_radians = (SMALL..most + 1e-3).contains(&self.largest);
        let radians = (self.photos >= FEW && in_radians).then_some(Doubt::SmallAngles {
            largest: self.largest,
            photos: self.photos,
        });
        let quaternion = self.quaternion;
        let quaternion = quaternion.map(|(line, length)| Doubt::NoRotation { line, length });
        radians.into_iter().chain(quaternion).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(odd: &OddAngles) -> String {
        let doubts: Vec<String> = odd.doubts().iter().map(Doubt::to_string).collect();
        doubts.join("; ")
    }

    fn of(photos: &[[f64; 3]]) -> String {
        let mut odd = OddAngles::default();
        for angles in photos {
            odd.angles(angles);
        }
        said(&odd)
    }

    #[test]
    fn radians_are_suspected() {
        let radians = [
            [0.349, -0.262, 0.698],
            [0.349, -0.262, PI],
            [0.0, 0.1, -1.57],
        ];
        let said = of(&radians);
        assert!(said.contains("between -3.142 and 3.142"), "{said}");
        let degrees = radians.map(|angles| angles.map(f64::to_degrees));
        assert_eq!(of(&degrees), "");
        // Tilt and pan count from 0.
        let of_tilt = [[1.44, 0.02, 0.0], [1.45, 6.25, 0.0], [1.43, 3.2, 0.0]];
        assert!(of(&of_tilt).contains("6.25"), "{}", of(&of_tilt));
        assert_eq!(of(&[[0.3, -1.0, 6.25]; 3]), "");
        // Two photos, and a line of photos straight down.
        assert_eq!(of(&radians[..2]), "");
        assert_eq!(of(&[[0.1, -0.2, 0.3]; 4]), "");
    }

    #[test]
    fn quaternions_without_a_part_are_suspected() {
        let mut odd = OddAngles::default();
        odd.quaternion(2, &[0.5, 0.5, 0.5, 0.502]);
        assert_eq!(odd.doubts(), []);
        odd.quaternion(3, &[0.7, 0.0, 0.1, 0.0]);
        odd.quaternion(4, &[0.9, 0.3, 0.0, 0.0]);
        let said = said(&odd);
        assert!(said.contains("line 3 has the length 0.707"), "{said}");
    }
}
