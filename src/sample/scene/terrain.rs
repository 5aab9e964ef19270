//! The ground that fragments come to lie on: a floor, and on it the body of the heap, whose inside
//! nobody sees, as a height over (x, y).

use glam::DVec2;

/// The shape of a heap. Lengths in metres, about the heap's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Terrain {
    /// A ridge along x with rounded ends: what a truck or a blast leaves.
    Windrow {
        /// Half the length of its crest.
        half_crest: f64,
        /// Height of the crest above the floor.
        height: f64,
        /// Slope of its flanks: the tangent of the angle of repose.
        slope: f64,
    },
    /// A cone under a conveyor.
    Cone {
        /// Height above the floor.
        height: f64,
        /// Slope of its flank.
        slope: f64,
    },
    /// A bench face with debris at its toe; the face looks towards -y.
    Bench {
        /// Height of the face.
        height: f64,
        /// Slope of the face.
        face: f64,
        /// Height of the debris at the face.
        debris: f64,
        /// Slope of the debris.
        slope: f64,
    },
}

impl Terrain {
    /// The steepest slope anywhere, as a tangent.
    pub fn steepest(&self) -> f64 {
        match *self {
            Self::Windrow { slope, .. } | Self::Cone { slope, .. } => slope,
            Self::Bench { face, slope, .. } => face.max(slope),
        }
    }

    /// The height above the floor at a place.
    pub fn height(&self, at: DVec2) -> f64 {
        match *self {
            Self::Windrow {
                half_crest,
                height,
                slope,
            } => {
                let from_crest = DVec2::new((at.x.abs() - half_crest).max(0.0), at.y).length();
                rounded(height - slope * from_crest, height)
            }
            Self::Cone { height, slope } => rounded(height - slope * at.length(), height),
            Self::Bench {
                height,
                face,
                debris,
                slope,
            } => {
                let wall = (face * at.y).clamp(0.0, height);
                let heap = debris + slope * at.y;
                wall.max(rounded(heap.min(debris), debris))
            }
        }
    }
}

/// Zero below, softened near 0 and near the top: no real heap has edges as sharp as a formula's.
fn rounded(z: f64, top: f64) -> f64 {
    let soft = top * 0.15;
    if soft <= 0.0 {
        return 0.0;
    }
    // Two smooth ramps: max(z, 0) and min(z, top), each with a parabola of half width `soft`.
    let above = if z <= -soft {
        0.0
    } else if z >= soft {
        z
    } else {
        (z + soft).powi(2) / (4.0 * soft)
    };
    let below_top = top - above;
    if below_top >= soft {
        above
    } else {
        top - (below_top + soft).powi(2) / (4.0 * soft)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heaps_have_their_height_and_slope() {
        let cone = Terrain::Cone {
            height: 1.0,
            slope: 0.75,
        };
        // The rounded top is lower by a quarter of the softness, 0.15.
        assert!((cone.height(DVec2::ZERO) - 0.9625).abs() < 1e-12);
        assert_eq!(cone.height(DVec2::new(5.0, 0.0)), 0.0);
        let flank = cone.height(DVec2::new(0.5, 0.0)) - cone.height(DVec2::new(0.6, 0.0));
        assert!((flank - 0.075).abs() < 1e-12);
        let windrow = Terrain::Windrow {
            half_crest: 1.0,
            height: 0.2,
            slope: 0.7,
        };
        let along = windrow.height(DVec2::new(0.9, 0.1));
        assert_eq!(along, windrow.height(DVec2::new(-0.2, -0.1)));
        let bench = Terrain::Bench {
            height: 10.0,
            face: 4.0,
            debris: 3.0,
            slope: 0.7,
        };
        assert_eq!(bench.height(DVec2::new(0.0, 5.0)), 10.0);
        assert_eq!(bench.height(DVec2::new(0.0, -9.0)), 0.0);
    }
}
