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
    /// Standard deviation of fx and fy together, percent, where it is stated.
    pub focal: Option<f64>,
    /// Standard deviation of all lengths of the world, percent, where it is stated.
    pub world_scale: Option<f64>,
}

/// The text of a flight.toml; everything that is not said stays as the program takes it by default.
///
/// # Errors
/// Where the program would not take it: a path is empty, a standard deviation is negative.
pub fn flight_toml(flight: &FlightText) -> Result<String, String> {
    let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
    let folder = flight.photos.map_or_else(String::new, |folder| {
        format!("folder = {}\n", quoted(folder))
    });
    let stated = |key: &str, value: Option<f64>| {
        let value = value.map(|value| format!("{key} = {}\n", toml::Value::Float(value)));
        value.unwrap_or_default()
    };
    let mut uncertainty = stated("focal", flight.focal);
    uncertainty += &stated("world_scale", flight.world_scale);
    if !uncertainty.is_empty() {
        uncertainty.insert_str(0, "\n[uncertainty]\n");
    }
    let text = format!(
        "format = 1\nname = {}\n\n[world]\nunit = {}\n\n[surface]\nfile = {}\n\n[[camera]]\n\
         file = {}\n\n[photos]\nposes = {}\n{folder}{uncertainty}",
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
    use crate::scale::StatedErrors;

    const FLIGHT: FlightText = FlightText {
        name: "Lab \"1\" \\ ä",
        unit: LengthUnit::UsSurveyFoot,
        surface: "my pile.ply",
        camera: "ost.yaml",
        poses: "poses.csv",
        photos: Some("photos"),
        focal: None,
        world_scale: None,
    };

    #[test]
    fn what_is_stated_of_errors_reads_back() {
        for (focal, world_scale) in [
            (None, None),
            (Some(0.1), None),
            (None, Some(1.0)),
            (Some(0.0), Some(1e-9)),
        ] {
            let text = flight_toml(&FlightText {
                focal,
                world_scale,
                ..FLIGHT
            });
            let expected = StatedErrors {
                focal,
                world_scale,
                ..StatedErrors::default()
            };
            let errors = FlightFile::parse(&text.unwrap()).unwrap().errors();
            assert_eq!(errors, expected);
        }
        let focal = Some(-0.1);
        assert!(flight_toml(&FlightText { focal, ..FLIGHT }).is_err());
    }

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
