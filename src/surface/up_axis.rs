//! Which axis of a file points up. The world's is z.

use std::str::FromStr;

use glam::DVec3;

use super::Cloud;

/// The axis of a surface's file that points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UpAxis {
    /// x is up.
    X,
    /// y is up, as in most programs for pictures and games.
    Y,
    /// z is up, as in the world.
    #[default]
    Z,
}

impl UpAxis {
    /// The point in a world with z up: a turn, so that left stays left.
    pub fn to_z_up(self, point: DVec3) -> DVec3 {
        match self {
            Self::X => DVec3::new(point.y, point.z, point.x),
            Self::Y => DVec3::new(point.x, -point.z, point.y),
            Self::Z => point,
        }
    }

    /// As flight.toml has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

impl FromStr for UpAxis {
    type Err = String;

    /// Reads x, y or z; the error quotes what it is instead.
    fn from_str(text: &str) -> Result<Self, String> {
        [Self::X, Self::Y, Self::Z]
            .into_iter()
            .find(|axis| axis.name() == text)
            .ok_or_else(|| format!("is '{text}'"))
    }
}

/// Another axis than z that a mesh's triangles say is up, with the share of the area seen along it,
/// and along z, that faces one way.
///
/// Seen along what is up, nearly all of a terrain faces one way (it may be written inside out), and
/// most of its area is seen. A wall that is seen from one side looks the same along its normal; but
/// its ledges still face up, so that only where a good part of the area faces down as well is
/// anything said. A cloud without faces says nothing.
pub fn doubtful_up(cloud: &Cloud) -> Option<(UpAxis, f64, f64)> {
    let (mut signed, mut seen) = (DVec3::ZERO, DVec3::ZERO);
    for triangle in &cloud.triangles {
        let corner = |index: u32| cloud.points.get(index as usize).copied();
        let [a, b, c] = triangle.map(corner);
        let (a, b, c) = (a?, b?, c?);
        let area = (b - a).cross(c - a) / 2.0;
        signed += area;
        seen += area.abs();
    }
    let one_way = signed.abs() / seen;
    let (axis, index) = if seen.x > seen.y {
        (UpAxis::X, 0)
    } else {
        (UpAxis::Y, 1)
    };
    let is_doubtful = seen[index] > 2.0 * seen.z && one_way[index] > 0.95 && one_way.z < 0.7;
    is_doubtful.then_some((axis, one_way[index], one_way.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_keep_handedness_and_bring_up_to_z() {
        for (axis, up) in [
            (UpAxis::X, DVec3::X),
            (UpAxis::Y, DVec3::Y),
            (UpAxis::Z, DVec3::Z),
        ] {
            assert_eq!(axis.to_z_up(up), DVec3::Z);
            let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|v| axis.to_z_up(v));
            assert_eq!(x.cross(y), z);
            assert_eq!(axis.name().parse(), Ok(axis));
        }
        assert!("Y".parse::<UpAxis>().is_err());
    }

    /// A grid of 20 x 20 cells with hills of that height, in a file with that axis up.
    fn hills(height: f64, up: UpAxis) -> Cloud {
        let point = |i: u32, j: u32| {
            let (x, y) = (f64::from(i), f64::from(j));
            let p = DVec3::new(x, y, height * (x * 0.9).sin() * (y * 0.7).cos());
            match up {
                UpAxis::X => DVec3::new(p.z, p.x, p.y),
                UpAxis::Y => DVec3::new(p.x, p.z, -p.y),
                UpAxis::Z => p,
            }
        };
        let mut cloud = Cloud::default();
        for i in 0..20 {
            for j in 0..20 {
                cloud.points.push(point(i, j));
                if i > 0 && j > 0 {
                    let at = 20 * i + j;
                    cloud.add_polygon(&[at - 21, at - 1, at, at - 20]);
                }
            }
        }
        cloud
    }

    #[test]
    fn hills_show_what_is_up() {
        for up in [UpAxis::X, UpAxis::Y] {
            let found = doubtful_up(&hills(0.5, up)).unwrap();
            assert_eq!(found.0, up);
            assert!(found.1 > 0.999 && found.2 < 0.3, "{found:?}");
        }
        assert_eq!(doubtful_up(&hills(0.5, UpAxis::Z)), None);
    }

    #[test]
    fn walls_and_solids_are_left_alone() {
        // A bench of steps: faces towards -y, ledges up.
        let mut bench = Cloud::default();
        for step in 0..5_u32 {
            let (y, z) = (f64::from(step), 3.0 * f64::from(step));
            let first = bench.points.len() as u32;
            for (dy, dz) in [(0.0, 0.0), (0.0, 3.0), (1.0, 3.0)] {
                bench.points.push(DVec3::new(0.0, y + dy, z + dz));
                bench.points.push(DVec3::new(9.0, y + dy, z + dz));
            }
            bench.add_polygon(&[first, first + 1, first + 3, first + 2]);
            bench.add_polygon(&[first + 2, first + 3, first + 5, first + 4]);
        }
        assert_eq!(doubtful_up(&bench), None);
        // A box faces every way.
        let mut solid = Cloud::default();
        for corner in 0..8_u32 {
            let bit = |n: u32| f64::from(corner >> n & 1);
            solid.points.push(DVec3::new(bit(0), 5.0 * bit(1), bit(2)));
        }
        for face in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            solid.add_polygon(&face);
        }
        assert_eq!(doubtful_up(&solid), None);
        assert_eq!(doubtful_up(&Cloud::default()), None);
    }
}
