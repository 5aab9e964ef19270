//! `*_pix4d_calibrated_internal_camera_parameters.cam`: the calibration of each camera in
//! millimetres, without a size in pixels.
//!
//! ```text
//! Pix4D camera calibration file 0
//! #Focal Length mm assuming a sensor width of 17.5x13.125mm
//! F 15.0117
//! #Principal Point mm
//! Px 8.4821
//! Py 6.3343
//! #Symmetrical Lens Distortion Coeffs
//! K1 .. K2 .. K3 ..            each on its own line
//! #Tangential Lens Distortion Coeffs
//! T1 .. T2 ..
//! ```
//!
//! Px, Py count from the sensor's top-left corner. `*_calibrated_internal_camera_parameters.cam`
//! without `_pix4d` is INPHO's form (`FOCAL`, `XPOFF`, `SYM_DIST`), whose distortion is a polynomial
//! in millimetres towards the other side: it is not read.

use crate::camera::Camera;
use crate::fault::Fault;
use crate::text::fields::Fields;

use super::calibrated::distortion;

const GIVE: &str = "give *_calibrated_camera_parameters.txt of the same params folder";

/// Reads the file of one perspective camera. Lengths are in units of the sensor's longer side, and
/// cx, cy count from the middle of the image (see `ImageUnit::LongerSide`).
///
/// # Errors
/// INPHO's form, a fish-eye, several cameras, a number that is missing.
pub(super) fn read(text: &str) -> Result<Camera, Fault> {
    let mut sensor = None;
    let mut values: Vec<(&str, f64)> = Vec::new();
    let mut cameras = 0;
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.trim();
        if text.starts_with("Pix4D camera calibration") {
            cameras += 1;
        } else if let Some((_, size)) = text.split_once("assuming a sensor width of ") {
            sensor = sensor.or_else(|| sensor_size(size));
        } else if !text.is_empty() && !text.starts_with('#') {
            let mut fields = Fields::new(line, text, GIVE);
            let key = fields.word("a keyword")?;
            if !["F", "Px", "Py", "K1", "K2", "K3", "T1", "T2"].contains(&key) {
                let what = format!("'{key}' is no part of a perspective lens in Pix4D's own form");
                return Err(fields.fault(what));
            }
            values.push((key, fields.number(key)?));
        }
    }
    if cameras > 1 {
        let what = format!("it holds {cameras} cameras, and which photo is of which is not said");
        return Err(Fault::new(what, GIVE));
    }
    let value = |key: &str| {
        let found = values.iter().find(|(known, _)| *known == key);
        found
            .map(|(_, value)| *value)
            .ok_or_else(|| Fault::new(format!("it has no {key}"), GIVE))
    };
    let (width, height) =
        sensor.ok_or_else(|| Fault::new("it does not say the sensor's size in mm", GIVE))?;
    let longer = width.max(height);
    let focal = value("F")? / longer;
    if focal <= 0.0 {
        return Err(Fault::new("the focal length F is not positive", GIVE));
    }
    Ok(Camera {
        name: "1".to_owned(),
        width: 0,
        height: 0,
        fx: focal,
        fy: focal,
        cx: (value("Px")? - width / 2.0) / longer,
        cy: (value("Py")? - height / 2.0) / longer,
        skew: 0.0,
        distortion: distortion(
            [value("K1")?, value("K2")?, value("K3")?],
            [value("T1")?, value("T2")?],
        ),
    })
}

/// "17.5x13.125mm"
fn sensor_size(text: &str) -> Option<(f64, f64)> {
    let (width, height) = text.trim().strip_suffix("mm")?.split_once('x')?;
    let side = |text: &str| {
        let side = text.trim().parse::<f64>().ok()?;
        (side.is_finite() && side > 0.0).then_some(side)
    };
    Some((side(width)?, side(height)?))
}
