//! The columns of the tables: what they may be called, and what their angles turn.

use glam::{DMat3, DVec3};

use crate::camera::Pose;
use crate::packages::realitycapture;

/// What the columns may be called: the photo, x, y, z, omega, phi, kappa.
const COLUMNS: [&[&str]; 7] = [
    &["filename", "imagename", "image", "name", "file", "label"],
    &["x", "easting", "x/lon"],
    &["y", "northing", "y/lat"],
    &["z", "altitude", "height", "alt", "z/alt"],
    &["omega"],
    &["phi"],
    &["kappa"],
];

/// The columns of RealityCapture's other form.
const REALITYCAPTURE: [&[&str]; 7] = [
    &["name"],
    &["x/lon"],
    &["y/lat"],
    &["z/alt"],
    &["yaw"],
    &["pitch"],
    &["roll"],
];

/// The columns of Orthority's other forms.
const ROLL_PITCH_YAW: [&[&str]; 7] = [
    &["filename"],
    &["x", "easting"],
    &["y", "northing"],
    &["z", "altitude"],
    &["roll"],
    &["pitch"],
    &["yaw"],
];
const DEGREES_ROLL_PITCH_YAW: [&[&str]; 7] = [
    &["filename"],
    &["longitude"],
    &["latitude"],
    &["altitude"],
    &["roll"],
    &["pitch"],
    &["yaw"],
];
const DEGREES_OMEGA_PHI_KAPPA: [&[&str]; 7] = [
    &["filename"],
    &["longitude"],
    &["latitude"],
    &["altitude"],
    &["omega"],
    &["phi"],
    &["kappa"],
];

/// Longitude, latitude and the height above the ellipsoid of WGS 84.
pub(super) const DEGREES: &str = "EPSG:4979";

/// What a table's angles turn, and to which axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Angles {
    /// Photogrammetric camera axes to the world's.
    OmegaPhiKappa,
    RealityCapture,
    /// The drone's body to north, east and down.
    OfBody,
}

impl Angles {
    pub(super) fn pose(self, center: DVec3, angles: [f64; 3]) -> Pose {
        match self {
            Self::OmegaPhiKappa => Pose::from_omega_phi_kappa(center, angles),
            Self::RealityCapture => realitycapture::pose(center, angles),
            Self::OfBody => of_body(center, angles),
        }
    }
}

/// The pose of a camera that looks down out of a drone with these angles, axes east, north, up.
fn of_body(center: DVec3, [roll, pitch, yaw]: [f64; 3]) -> Pose {
    // Columns: where north, east and down lie in east, north, up, and where the camera's right, down
    // and forward lie in the body's front, right, down.
    let enu_from_ned = DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::NEG_Z);
    let body_from_camera = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
    let ned_from_body = DMat3::from_rotation_z(yaw.to_radians())
        * DMat3::from_rotation_y(pitch.to_radians())
        * DMat3::from_rotation_x(roll.to_radians());
    Pose {
        rotation: enu_from_ned * ned_from_body * body_from_camera,
        center,
    }
}

/// Where the columns stand.
#[derive(Debug, Clone, Copy)]
pub(super) struct Header {
    /// Of the photo, three coordinates, three angles.
    pub(super) places: [usize; 7],
    pub(super) camera: Option<usize>,
    /// What each may be called.
    pub(super) names: [&'static [&'static str]; 7],
    pub(super) angles: Angles,
    /// Whether the positions are longitude, latitude and height.
    pub(super) in_degrees: bool,
}

/// Of a table that does not say it.
pub(super) const SILENT: Header = Header {
    places: [0, 1, 2, 3, 4, 5, 6],
    camera: Some(7),
    names: COLUMNS,
    angles: Angles::OmegaPhiKappa,
    in_degrees: false,
};

impl Header {
    /// Where the columns stand, if a line names them all.
    pub(super) fn of(fields: &[String]) -> Option<Self> {
        let forms = [
            (COLUMNS, Angles::OmegaPhiKappa, false),
            (REALITYCAPTURE, Angles::RealityCapture, false),
            (ROLL_PITCH_YAW, Angles::OfBody, false),
            (DEGREES_ROLL_PITCH_YAW, Angles::OfBody, true),
            (DEGREES_OMEGA_PHI_KAPPA, Angles::OmegaPhiKappa, true),
        ];
        let of = |(names, angles, in_degrees): ([&'static [&'static str]; 7], Angles, bool)| {
            let mut places = [0; 7];
            for (place, names) in places.iter_mut().zip(names) {
                *place = find(fields, names)?;
            }
            Some(Self {
                places,
                camera: find(fields, &["camera"]),
                names,
                angles,
                in_degrees,
            })
        };
        forms.into_iter().find_map(of)
    }
}

/// Where the first column with one of these names stands.
pub(super) fn find(fields: &[String], names: &[&str]) -> Option<usize> {
    fields.iter().position(|field| {
        let field = field.trim_start_matches('#').trim().to_ascii_lowercase();
        names.contains(&field.as_str())
    })
}

/// Whether the fields are those of a line without header.
pub(super) fn is_row(fields: &[String]) -> bool {
    let is_number = |field: &String| {
        let point = field.replace(',', ".");
        point.parse::<f64>().is_ok()
    };
    match fields {
        [name, numbers @ ..] if (6..=7).contains(&numbers.len()) => {
            !is_number(name) && numbers.iter().take(6).all(is_number)
        }
        _ => false,
    }
}
