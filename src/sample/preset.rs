//! The simulated places: the paper's lab, a muckpile after a blast, a stockpile, a bench face.

use glam::{DVec2, DVec3};

use super::flight_plan::FlightPlan;
use super::scene::fragment::BROKEN;
use super::scene::pile::PilePlan;
use super::scene::terrain::Terrain;
use super::sfm_cloud::CloudPlan;
use crate::camera::{Brown, Camera, Distortion, Fisheye};
use crate::fault::Fault;
use crate::fragmentation::Swebrec;

/// A simulated place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Preset {
    /// The paper's lab: coarse gravel of 19 mm down to sand under 4 mm, photos from 0.5 m.
    Lab,
    /// A muckpile with blocks to 1.5 m, in UTM coordinates, photos from 30 m.
    Muckpile,
    /// A stockpile of primary-crushed ore under a conveyor.
    Stockpile,
    /// A bench face with debris at its toe.
    Bench,
}

/// The lens of the simulated camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lens {
    /// A pinhole.
    None,
    /// Mild barrel distortion, as a mapping drone has.
    Brown,
    /// A fish-eye, as the paper's Bebop has.
    Fisheye,
}

/// Everything that makes a simulated flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// The flight's name.
    pub name: &'static str,
    /// Where the lab's middle lies in the world, whole metres.
    pub origin: DVec3,
    /// The world's coordinate system, where it has one.
    pub epsg: Option<u16>,
    /// The pile.
    pub pile: PilePlan,
    /// Half the extent of the ground.
    pub reach: DVec2,
    /// The flight.
    pub flight: FlightPlan,
    /// The camera.
    pub camera: Camera,
    /// Diameter of the scale spheres.
    pub sphere: f64,
    /// The cloud.
    pub cloud: CloudPlan,
}

impl Preset {
    /// By its name on the command line.
    pub const ALL: [(&'static str, Self); 4] = [
        ("lab", Self::Lab),
        ("muckpile", Self::Muckpile),
        ("stockpile", Self::Stockpile),
        ("bench", Self::Bench),
    ];

    /// The recipe of this place.
    ///
    /// # Errors
    /// Never for the presets: their distributions are valid.
    pub fn recipe(self, lens: Lens) -> Result<Recipe, Fault> {
        // Lengths of the lab times this.
        let k = match self {
            Self::Lab => 1.0,
            Self::Stockpile => 10.0,
            Self::Muckpile | Self::Bench => 60.0,
        };
        let sizes = Swebrec::new(0.0105 * k, 0.025 * k, 2.2)
            .map_err(|e| Fault::new(e.to_string(), "report this"))?;
        let half_extent = DVec2::new(1.05, 0.62) * k;
        let terrain = match self {
            Self::Lab | Self::Muckpile => Terrain::Windrow {
                half_crest: 0.55 * k,
                height: 0.11 * k,
                slope: 0.5,
            },
            Self::Stockpile => Terrain::Cone {
                height: 0.2 * k,
                slope: 0.62,
            },
            Self::Bench => Terrain::Bench {
                height: 0.2 * k,
                face: 2.6,
                debris: 0.1 * k,
                slope: 0.55,
            },
        };
        let utm = DVec3::new(452_310.0, 5_411_860.0, 312.0);
        Ok(Recipe {
            name: match self {
                Self::Lab => "Lab trial 1",
                Self::Muckpile => "Muckpile, simulated",
                Self::Stockpile => "Stockpile, simulated",
                Self::Bench => "Bench face, simulated",
            },
            origin: match self {
                Self::Lab => DVec3::ZERO,
                _ => utm,
            },
            epsg: (self != Self::Lab).then_some(32632),
            pile: PilePlan {
                terrain,
                sizes,
                smallest: 0.004 * k,
                half_extent,
                thickness: 0.0075 * k,
                corners: BROKEN,
                bodies: 300,
            },
            reach: half_extent * 1.6,
            flight: FlightPlan {
                height: 0.5 * k,
                tilt: 83.0,
                spacing: DVec2::new(0.68, 0.4) * k,
                count: [3, 3],
                position_error: 0.01 * k,
                angle_error: 0.6,
            },
            camera: camera(lens),
            sphere: 0.06 * k,
            cloud: CloudPlan {
                points: 60_000,
                noise_px: 0.5,
                flying: 0.0003,
            },
        })
    }
}

/// 1280 x 720 as in the paper, about 65 degrees wide.
fn camera(lens: Lens) -> Camera {
    Camera {
        name: "bebop".to_owned(),
        width: 1280,
        height: 720,
        fx: 1012.5,
        fy: 1011.25,
        cx: 637.75,
        cy: 362.25,
        skew: 0.0,
        distortion: match lens {
            Lens::None => Distortion::None,
            Lens::Brown => Distortion::Brown(Brown::new([
                -0.062, 0.031, 0.0004, -0.0003, -0.006, 0.0, 0.0, 0.0,
            ])),
            Lens::Fisheye => Distortion::Fisheye(Fisheye::new([-0.021, 0.006, -0.002, 0.0])),
        },
    }
}
