//! Where a photo's receiver put it, from the metadata of a view.
//!
//! Written from AliceVision's `numeric/gps.cpp` and `sfmData/ImageInfo.cpp`: "GPS:Latitude" is degrees,
//! minutes and seconds separated by commas ("47, 13, 55.13"), with N or S in "GPS:LatitudeRef";
//! longitude likewise with E or W; "GPS:Altitude" is in metres, below sea level where
//! "GPS:AltitudeRef" is 1.

use super::loose::GpsTags;
use crate::geodesy::Geographic;

/// The position that the tags say, where they say all of it.
pub(super) fn position(tags: &GpsTags) -> Option<Geographic> {
    let tag = |name: &str| {
        let mut tags = tags.0.iter();
        tags.find(|(key, _)| key.strip_prefix("GPS:") == Some(name))
            .map(|(_, value)| value.as_str())
    };
    let angle = |name: &str, positive: &str, negative: &str| {
        let size = degrees(tag(name)?)?;
        match tag(&format!("{name}Ref"))?.trim() {
            reference if reference.eq_ignore_ascii_case(positive) => Some(size),
            reference if reference.eq_ignore_ascii_case(negative) => Some(-size),
            _ => None,
        }
    };
    let altitude: f64 = tag("Altitude")?.trim().parse().ok()?;
    let below = tag("AltitudeRef").is_some_and(|reference| reference.trim() == "1");
    let position = Geographic {
        longitude: angle("Longitude", "E", "W")?,
        latitude: angle("Latitude", "N", "S")?,
        height: if below { -altitude } else { altitude },
    };
    let on_earth = position.latitude.abs() <= 90.0 && position.longitude.abs() <= 180.0;
    (on_earth && altitude.abs() < 1e6).then_some(position)
}

/// The degrees of "d, m, s", of which minutes and seconds may be left out.
fn degrees(text: &str) -> Option<f64> {
    let mut sum = 0.0;
    let mut unit = 1.0;
    for part in text.split(',') {
        let part: f64 = part.trim().parse().ok()?;
        if part < 0.0 {
            return None;
        }
        sum += part / unit;
        unit *= 60.0;
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(tags: &[(&str, &str)]) -> Option<Geographic> {
        let tags = tags
            .iter()
            .map(|(key, value)| (format!("GPS:{key}"), (*value).to_owned()));
        position(&GpsTags(tags.collect()))
    }

    #[test]
    fn degrees_minutes_and_seconds() {
        let tags = [
            ("Latitude", "47, 30, 36"),
            ("LatitudeRef", "S"),
            ("Longitude", "39,45.0"),
            ("LongitudeRef", "E"),
            ("Altitude", "93.4"),
            ("AltitudeRef", "1"),
        ];
        let place = of(&tags).unwrap();
        assert!((place.latitude + 47.51).abs() < 1e-12);
        assert_eq!((place.longitude, place.height), (39.75, -93.4));
        for (at, bad) in [
            (0, "x"),
            (0, "95"),
            (0, "-47"),
            (1, "E"),
            (4, "nan"),
            (4, "1e9"),
        ] {
            let mut tags = tags;
            tags[at].1 = bad;
            assert_eq!(of(&tags), None, "{bad}");
        }
        assert_eq!(of(&tags[..4]), None);
        assert_eq!(of(&tags[..5]).unwrap().height, 93.4);
    }
}
