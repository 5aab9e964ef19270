//! flight.toml (contract, section 3) of a flight with one camera from a calibration file.

use crate::flight::FlightFile;
use crate::units::LengthUnit;

/// What the flight.toml of a sample says. Paths are relative to it, with slashes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightText<'a> {
    /// For people.
    pub name: &'a str,
    /// Of all world coordinates.
    pub unit: LengthUnit,
    /// The cloud or mesh.
    pub surface: &'a str,
    /// The camera's calibration.
    pub camera: &'a str,
    /// The poses.csv.
    pub poses: &'a str,
    /// Where the image files are.
    pub photos: Option<&'a str>,
}

/// The text of a flight.toml; everything that is not said stays as the program takes it by default.
///
/// # Errors
/// Where the program would not take it: a path is empty.
pub fn flight_toml(flight: &FlightText) -> Result<String, String> {
    let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
    let folder = flight.photos.map_or_else(String::new, |folder| {
        format!("folder = {}\n", quoted(folder))
    });
    let text = format!(
        "format = 1\nname = {}\n\n[world]\nunit = {}\n\n[surface]\nfile = {}\n\n[[camera]]\n\
         file = {}\n\n[photos]\nposes = {}\n{folder}",
        quoted(flight.name),
        quoted(flight.unit.symbol()),
        quoted(flight.surface),
        quoted(flight.camera),
        quoted(flight.poses),
    );
    FlightFile::parse(&text).map_err(|fault| fault.to_string())?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::{CameraSource, PhotoSource};

    const FLIGHT: FlightText = FlightText {
        name: "Lab \"1\" \\ ä",
        unit: LengthUnit::UsSurveyFoot,
        surface: "my pile.ply",
        camera: "ost.yaml",
        poses: "poses.csv",
        photos: Some("photos"),
    };

    #[test]
    fn reads_back() {
        for photos in [None, Some("photos")] {
            let flight = FlightText { photos, ..FLIGHT };
            let text = flight_toml(&flight).unwrap();
            assert_eq!(flight_toml(&flight).unwrap(), text);
            let file = FlightFile::parse(&text).unwrap();
            assert_eq!(file.name.as_deref(), Some(flight.name));
            assert_eq!(file.unit(), Some(flight.unit));
            assert_eq!(file.surface(), Some(flight.surface));
            assert_eq!(file.cameras.len(), 1);
            let camera = CameraSource::File(flight.camera);
            assert_eq!(file.cameras[0].source(), Ok(camera));
            assert_eq!(file.photo_source(), PhotoSource::Poses(flight.poses));
            assert_eq!(file.photo_folder(), photos);
        }
    }

    #[test]
    fn empty_paths_are_refused() {
        let camera = "";
        assert!(flight_toml(&FlightText { camera, ..FLIGHT }).is_err());
        assert!(
            flight_toml(&FlightText {
                surface: "",
                ..FLIGHT
            })
            .is_err()
        );
    }
}
