//! What stands beside a label image that was saved to go on with: how sure its fragments are, and what it is of.
//!
//! A line of JSON: `{"outlines": photo, "picture": "SHA-256", "engine": name, "lens": [[x, y] ...], "spread": pixels, "sure": {number: 0 to 1 ...}}`,
//! and of an engine of the user's `"habits"`: how it errs, which the program does not know of it by its name.
//! `picture` is the checksum of the photo's file, where it was there: photos of other flights have the same names, and their
//! outlines may lie in the same folder. `lens` says where nine places of the undistorted photo lie in the photo as shot: outlines are of the undistorted
//! one, and with another lens that is another picture. `spread` is how far the photo's edges are spread, null where that is
//! not known.

use std::collections::BTreeMap;

use fragscale_core::camera::Camera;
use fragscale_core::fault::Fault;
use glam::DVec2;
use serde_json::{Value, json};

use crate::engine::Habits;
use crate::engines::engine_called;
use crate::outlined_by::Outliner;

/// How far a place may lie elsewhere in the photo, pixels: no fragment changes by it.
const SAME_PLACE: f64 = 0.5;

/// What outlines are of, and how sure they are.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedOutlines {
    /// As the flight names the photo.
    pub photo: String,
    /// SHA-256 of the photo's file, in hexadecimal; `None` where it was not there, and in files of before.
    pub picture: Option<String>,
    /// What outlined it first.
    pub by: Outliner,
    /// Where places of the undistorted photo lie in the photo as shot; NaN where nowhere.
    pub lens: Vec<DVec2>,
    /// How sure the fragments are that nobody looked at, by number.
    pub sure: BTreeMap<u32, f64>,
}

impl SavedOutlines {
    /// As a file's text.
    pub fn to_json(&self) -> String {
        let Self {
            photo,
            picture,
            by,
            lens,
            sure,
        } = self;
        let picture = picture.as_ref();
        let picture =
            picture.map_or_else(String::new, |sum| format!(",\"picture\":{}", json!(sum)));
        let lens: Vec<Value> = lens.iter().map(|place| json!([place.x, place.y])).collect();
        // The order is that of the documentation, whatever the map of the library keeps.
        let own = by.habits.filter(|_| engine_called(&by.engine).is_none());
        let habits = own.map_or_else(String::new, |own| format!(",\"habits\":{}", own.to_json()));
        format!(
            "{{\"outlines\":{}{picture},\"engine\":{},\"lens\":{},\"spread\":{},\"sure\":{}{habits}}}\n",
            json!(photo),
            json!(by.engine),
            json!(lens),
            json!(by.spread),
            json!(sure)
        )
    }

    /// From a file's text.
    ///
    /// # Errors
    /// Where it is none.
    pub fn from_json(text: &str) -> Result<Self, Fault> {
        let none = || {
            let what = "it does not say what its outlines are of";
            Fault::new(
                what,
                "remove it with its picture, or save the outlines again",
            )
        };
        let value: Value = serde_json::from_str(text).map_err(|_| none())?;
        let word = |key: &str| value.get(key)?.as_str().map(str::to_owned);
        let number = |value: Option<&Value>| value.and_then(Value::as_f64).unwrap_or(f64::NAN);
        let lens = value.get("lens").and_then(Value::as_array);
        let lens = lens.ok_or_else(none)?.iter();
        let lens = lens.map(|place| DVec2::new(number(place.get(0)), number(place.get(1))));
        let spread = value.get("spread").and_then(Value::as_f64);
        let sure = value.get("sure").and_then(Value::as_object);
        let sure = sure.ok_or_else(none)?.iter().map(|(number, sure)| {
            let sure = sure.as_f64().filter(|sure| (0.0..=1.0).contains(sure));
            Some((number.parse::<u32>().ok()?, sure?))
        });
        Ok(Self {
            photo: word("outlines").ok_or_else(none)?,
            picture: word("picture"),
            by: Outliner {
                engine: word("engine").ok_or_else(none)?,
                habits: value.get("habits").and_then(Habits::from_json),
                spread: spread.filter(|spread| *spread >= 0.0),
            },
            lens: lens.collect(),
            sure: sure.collect::<Option<_>>().ok_or_else(none)?,
        })
    }

    /// Whether outlines are of the photo as this camera undistorts it.
    pub fn is_of(&self, camera: &Camera) -> bool {
        let now = lens_of(camera);
        let is_same = |(a, b): (&DVec2, &DVec2)| {
            a.is_nan() == b.is_nan() && (a.is_nan() || a.distance(*b) <= SAME_PLACE)
        };
        now.len() == self.lens.len() && now.iter().zip(&self.lens).all(is_same)
    }
}

/// Where nine places of the undistorted photo lie in the photo as shot, pixels; NaN where nowhere.
pub fn lens_of(camera: &Camera) -> Vec<DVec2> {
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let shares = [1.0 / 6.0, 0.5, 5.0 / 6.0];
    let places = shares
        .into_iter()
        .flat_map(|y| shares.map(|x| DVec2::new(x, y)));
    let as_shot = |share: DVec2| {
        let direction = camera.direction_undistorted(share * size);
        camera.pixel_as_shot(direction).unwrap_or(DVec2::NAN)
    };
    places.map(as_shot).collect()
}

#[cfg(test)]
mod tests {
    use fragscale_core::camera::{Brown, Distortion};

    use super::*;
    use crate::{Classical, Engine};

    fn camera(distortion: Distortion) -> Camera {
        Camera {
            name: String::new(),
            width: 4000,
            height: 3000,
            fx: 3000.0,
            fy: 3000.0,
            cx: 2000.0,
            cy: 1500.0,
            skew: 0.0,
            distortion,
        }
    }

    #[test]
    fn reads_back_and_knows_its_lens() {
        let pinhole = camera(Distortion::None);
        let saved = SavedOutlines {
            photo: "a \"b\"\\c.jpg".to_owned(),
            picture: Some("ba78".to_owned()),
            by: Outliner {
                engine: "mine".to_owned(),
                habits: Some(Classical.habits(4000, 3000)),
                spread: Some(0.75),
            },
            lens: lens_of(&pinhole),
            sure: BTreeMap::from([(1, 0.25), (70_000, 1.0)]),
        };
        assert_eq!(SavedOutlines::from_json(&saved.to_json()).unwrap(), saved);
        assert!(saved.is_of(&pinhole));
        // Without a lens both photos are the same, whatever the focal length is.
        let longer = Camera {
            fx: 3300.0,
            fy: 3300.0,
            ..pinhole
        };
        assert!(saved.is_of(&longer));
        // k1 of 0.1 at (1000, 0) of f 3000: 1000 * 0.1 / 9, eleven pixels.
        let brown = Brown::new([0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(!saved.is_of(&camera(Distortion::Brown(brown))));
        // Earlier versions did not say which picture, nor the spread.
        let earlier = saved.to_json().replace("\"picture\":\"ba78\",", "");
        let earlier = SavedOutlines::from_json(&earlier).unwrap();
        assert_eq!(earlier.picture, None);
        assert_eq!(
            SavedOutlines::from_json(&earlier.to_json()).unwrap(),
            earlier
        );
        let earlier = saved.to_json().replace("\"spread\":0.75,", "");
        assert_eq!(SavedOutlines::from_json(&earlier).unwrap().by.spread, None);
        for broken in ["", "{}", "{\"outlines\":1}", "[]"] {
            assert!(SavedOutlines::from_json(broken).is_err());
        }
        let wrong = saved.to_json().replace("0.25", "7");
        assert!(SavedOutlines::from_json(&wrong).is_err());
    }
}
