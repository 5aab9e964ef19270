//! The flight.toml of a flight whose poses lie in a poses.csv and whose cameras are said in it.

use super::{CameraEntry, FlightFile, FlightSettings, PhotosEntry, ReconstructionFlight};
use crate::camera::{Camera, Distortion};

/// What it says. Paths are relative to the file that it will be.
#[derive(Debug, Clone, Copy)]
pub struct PosesFlight<'a> {
    /// For people.
    pub name: &'a str,
    /// The poses.csv.
    pub poses: &'a str,
    /// As poses call them; pinholes or of OpenCV's models.
    pub cameras: &'a [Camera],
    /// The folder of the image files.
    pub folder: Option<&'a str>,
    /// The cloud or mesh.
    pub surface: &'a str,
    /// The coordinate system of the world.
    pub crs: Option<&'a str>,
}

impl FlightFile {
    /// Such a flight.
    pub fn for_poses(flight: &PosesFlight<'_>, settings: &FlightSettings) -> Self {
        let of_reconstruction = ReconstructionFlight {
            name: flight.name,
            folder: flight.folder,
            surface: Some(flight.surface),
            crs: flight.crs,
            ..ReconstructionFlight::default()
        };
        let base = Self::for_reconstruction(&of_reconstruction, settings);
        Self {
            cameras: flight.cameras.iter().map(inline).collect(),
            photos: PhotosEntry {
                poses: Some(flight.poses.to_owned()),
                reconstruction: None,
                ..base.photos
            },
            ..base
        }
    }
}

fn inline(camera: &Camera) -> CameraEntry {
    let coefficients = camera.distortion.coefficients();
    CameraEntry {
        name: Some(camera.name.clone()),
        file: None,
        width: Some(camera.width),
        height: Some(camera.height),
        fx: Some(camera.fx),
        fy: Some(camera.fy),
        cx: Some(camera.cx),
        cy: Some(camera.cy),
        skew: (camera.skew != 0.0).then_some(camera.skew),
        pixel_origin: None,
        distortion: match camera.distortion {
            Distortion::None => None,
            _ => Some(camera.distortion.name().to_owned()),
        },
        coefficients: (!coefficients.is_empty()).then(|| coefficients.to_vec()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Brown;
    use crate::flight::CameraSource;

    /// What is written reads back, digit for digit.
    #[test]
    fn cameras_read_back() {
        let lens = Brown::new([-0.1, 0.03, 1e-4, -2e-4, 0.0, 0.0, 0.0, 0.0]);
        let pinhole = Camera {
            name: "a b".to_owned(),
            width: 5472,
            height: 3648,
            fx: 3650.1234567890123,
            fy: 3649.9,
            cx: 2736.1,
            cy: 1823.7,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let cameras = [
            pinhole.clone(),
            Camera {
                name: "c".to_owned(),
                distortion: Distortion::Brown(lens),
                ..pinhole
            },
        ];
        let flight = PosesFlight {
            name: "flight \"1\"",
            poses: "poses.csv",
            cameras: &cameras,
            folder: Some("../photos"),
            surface: "pile.laz",
            crs: Some("EPSG:32632"),
        };
        let text = FlightFile::for_poses(&flight, &FlightSettings::default()).to_toml();
        let read = FlightFile::parse(&text.unwrap()).unwrap();
        for (entry, camera) in read.cameras.iter().zip(&cameras) {
            assert_eq!(
                entry.source().unwrap(),
                CameraSource::Inline(camera.clone())
            );
        }
        assert_eq!(read.cameras.len(), 2);
        assert_eq!(read.crs(), Some("EPSG:32632"));
    }
}
