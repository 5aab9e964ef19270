//! Orientations that can be read, and are probably not what their columns say: a warning says so.

use std::f64::consts::PI;

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
    /// The first quaternion that is no rotation: its line and length.
    quaternion: Option<(u64, f64)>,
}

impl OddAngles {
    /// Takes the angles of a photo.
    pub(super) fn angles(&mut self, angles: &[f64]) {
        self.photos += 1;
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
    pub(super) fn warnings(&self) -> Vec<String> {
        // An angle that was rounded up to four digits is not beyond half a turn.
        let in_radians = (SMALL..PI + 1e-3).contains(&self.largest);
        let radians = (self.photos >= FEW && in_radians).then(|| {
            format!(
                "all angles of its {} photos lie between -{largest} and {largest}: they are read as degrees, and look like radians",
                self.photos,
                largest = fragscale_core::numbers::to_digits(self.largest, 4)
            )
        });
        let quaternion = self.quaternion.map(|(line, length)| {
            format!(
                "the quaternion on line {line} has the length {}, where one of a rotation has 1: it is taken as its direction; a column may be \
                 wrong",
                fragscale_core::numbers::to_digits(length, 3)
            )
        });
        radians.into_iter().chain(quaternion).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(photos: &[[f64; 3]]) -> String {
        let mut odd = OddAngles::default();
        for angles in photos {
            odd.angles(angles);
        }
        odd.warnings().join("; ")
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
        // Two photos, and a line of photos straight down.
        assert_eq!(of(&radians[..2]), "");
        assert_eq!(of(&[[0.1, -0.2, 0.3]; 4]), "");
    }

    #[test]
    fn quaternions_without_a_part_are_suspected() {
        let mut odd = OddAngles::default();
        odd.quaternion(2, &[0.5, 0.5, 0.5, 0.502]);
        assert_eq!(odd.warnings(), Vec::<String>::new());
        odd.quaternion(3, &[0.7, 0.0, 0.1, 0.0]);
        odd.quaternion(4, &[0.9, 0.3, 0.0, 0.0]);
        let said = odd.warnings().join("; ");
        assert!(said.contains("line 3 has the length 0.707"), "{said}");
    }
}
