//! One `[[camera]]` table of a flight.toml: a calibration file, a camera inline, or only a size.

use serde::{Deserialize, Serialize};

use crate::camera::{Brown, Camera, Distortion, Fisheye};
use crate::fault::Fault;

/// One `[[camera]]` table, as it stands in the text.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraEntry {
    /// What poses call it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// A calibration file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<u32>,
    /// Pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<u32>,
    /// Pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fx: Option<f64>,
    /// Pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fy: Option<f64>,
    /// Pixels, from `pixel_origin`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cx: Option<f64>,
    /// Pixels, from `pixel_origin`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cy: Option<f64>,
    /// Pixels; 0 if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skew: Option<f64>,
    /// "corner" (if left out) or "center": where cx and cy count from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixel_origin: Option<String>,
    /// "none" (if left out), "brown" or "fisheye".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distortion: Option<String>,
    /// In OpenCV's order; missing ones are 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coefficients: Option<Vec<f64>>,
}

/// Where a camera comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum CameraSource<'a> {
    /// A calibration file, relative to flight.toml.
    File(&'a str),
    /// Only a size, for a reconstruction that has none.
    Size(u32, u32),
    /// The table itself.
    Inline(Camera),
}

impl CameraEntry {
    /// What the table says: a file, a size, or a camera.
    ///
    /// # Errors
    /// Where it says more than one of these, or half of one.
    pub fn source(&self) -> Result<CameraSource<'_>, Fault> {
        let named = match &self.name {
            Some(name) => format!("camera '{name}'"),
            None => "the camera".to_owned(),
        };
        let fault = |what: &str, remedy: &str| Fault::new(format!("{named} {what}"), remedy);
        let only_size = self.fx.is_none()
            && self.fy.is_none()
            && self.cx.is_none()
            && self.cy.is_none()
            && self.skew.is_none()
            && self.pixel_origin.is_none()
            && self.distortion.is_none()
            && self.coefficients.is_none();
        if let Some(file) = &self.file {
            if !only_size || self.width.is_some() || self.height.is_some() {
                return Err(fault("has a file and numbers", "keep one of the two"));
            }
            return Ok(CameraSource::File(file));
        }
        let needed = |value: Option<f64>, key: &str| {
            value.ok_or_else(|| {
                fault(
                    &format!("has no {key}"),
                    "add it, or name a calibration file",
                )
            })
        };
        let pixels = |value: Option<u32>, key: &str| {
            value.ok_or_else(|| fault(&format!("has no {key}"), "add it, in pixels"))
        };
        let (width, height) = (pixels(self.width, "width")?, pixels(self.height, "height")?);
        if only_size {
            return Ok(CameraSource::Size(width, height));
        }
        let origin = match self.pixel_origin.as_deref() {
            None | Some("corner") => 0.0,
            Some("center") => 0.5,
            Some(other) => {
                let what = format!("has the pixel_origin '{other}'");
                return Err(fault(&what, "write \"corner\" or \"center\""));
            }
        };
        Ok(CameraSource::Inline(Camera {
            name: self.name.clone().unwrap_or_default(),
            width,
            height,
            fx: needed(self.fx, "fx")?,
            fy: needed(self.fy, "fy")?,
            cx: needed(self.cx, "cx")? + origin,
            cy: needed(self.cy, "cy")? + origin,
            skew: self.skew.unwrap_or(0.0),
            distortion: self.lens().map_err(|what| {
                fault(
                    &what,
                    "see the coefficients of each model in docs/flights.md",
                )
            })?,
        }))
    }

    /// Three numbers of `brown` are k1 k2 p1 here, and the k1 k2 k3 of a report where somebody copied them: a sentence
    /// that says so.
    pub fn may_mean_others(&self) -> Option<String> {
        let [_, _, third] = self.coefficients.as_deref()? else {
            return None;
        };
        let is_brown = self.distortion.as_deref() == Some("brown");
        (is_brown && *third != 0.0).then(|| {
            let third = format!("{third} is taken as p1, a decentring coefficient");
            format!("three coefficients of a brown lens are k1 k2 p1 ({third}): where it is k3, write k1 k2 0 0 k3")
        })
    }

    fn lens(&self) -> Result<Distortion, String> {
        let given = self.coefficients.as_deref().unwrap_or_default();
        if given.iter().any(|c| !c.is_finite()) {
            return Err("has a distortion coefficient that is not finite".to_owned());
        }
        let too_many = |model: &str, most: usize| {
            let count = given.len();
            format!("has {count} coefficients for the distortion '{model}', which takes {most}")
        };
        match self.distortion.as_deref() {
            None | Some("none") if given.iter().all(|&c| c == 0.0) => Ok(Distortion::None),
            None | Some("none") => Err(too_many("none", 0)),
            Some("brown") => padded(given)
                .map(|c| Distortion::Brown(Brown::new(c)))
                .ok_or_else(|| too_many("brown", 8)),
            Some("fisheye") => padded(given)
                .map(|c| Distortion::Fisheye(Fisheye::new(c)))
                .ok_or_else(|| too_many("fisheye", 4)),
            Some(other) => Err(format!(
                "has the distortion '{other}', not one of none, brown, fisheye"
            )),
        }
    }
}

/// `given`, filled up with zeros; `None` where it is too long.
fn padded<const N: usize>(given: &[f64]) -> Option<[f64; N]> {
    let mut all = [0.0; N];
    all.get_mut(..given.len())?.copy_from_slice(given);
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole() -> CameraEntry {
        CameraEntry {
            name: Some("other".to_owned()),
            width: Some(1280),
            height: Some(720),
            fx: Some(1000.0),
            fy: Some(1001.0),
            cx: Some(639.5),
            cy: Some(359.5),
            pixel_origin: Some("center".to_owned()),
            distortion: Some("brown".to_owned()),
            coefficients: Some(vec![0.1, -0.2]),
            ..CameraEntry::default()
        }
    }

    #[test]
    fn three_coefficients_of_brown_may_be_meant_otherwise() {
        let of = |coefficients: &[f64], distortion: &str| {
            let entry = CameraEntry {
                coefficients: Some(coefficients.to_vec()),
                distortion: Some(distortion.to_owned()),
                ..whole()
            };
            entry.may_mean_others()
        };
        let said = of(&[-0.1, 0.02, 0.003], "brown").unwrap();
        assert!(said.contains("0.003 is taken as p1"), "{said}");
        for clear in [
            &[-0.1, 0.02][..],
            &[-0.1, 0.02, 0.0],
            &[-0.1, 0.02, 0.0, 0.0, 0.003],
        ] {
            assert_eq!(of(clear, "brown"), None, "{clear:?}");
        }
        assert_eq!(of(&[0.1, 0.2, 0.3], "fisheye"), None);
    }

    #[test]
    fn half_a_camera_is_refused() {
        let source = |change: fn(&mut CameraEntry)| {
            let mut entry = whole();
            change(&mut entry);
            entry.source().map(|_| ()).unwrap_err().what
        };
        assert!(source(|c| c.file = Some("a.yaml".to_owned())).contains("a file and numbers"));
        assert!(source(|c| c.fy = None).contains("no fy"));
        assert!(source(|c| c.width = None).contains("no width"));
        assert!(source(|c| c.distortion = Some("barrel".to_owned())).contains("barrel"));
        assert!(source(|c| c.distortion = None).contains("takes 0"));
        assert!(source(|c| c.coefficients = Some(vec![0.0; 9])).contains("takes 8"));
        assert!(source(|c| c.pixel_origin = Some("middle".to_owned())).contains("middle"));
    }
}
