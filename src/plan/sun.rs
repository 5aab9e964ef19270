//! Where the sun stands when the photos are taken, and what then lies in shadow: outlines of rock are not seen there, and a
//! shadow's edge looks like one.

use chrono::{DateTime, Datelike, Timelike, Utc};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, RefractionCorrection, SolarPositions};

use super::Plan;
use super::cover::seen_by;
use crate::fault::Fault;
use crate::geodesy::Crs;
use crate::geometry::extent;

/// How long terrestrial time is before that of the Earth's turning, seconds: 69 in 2020 to 2030; a second more turns the
/// sun by nothing that is seen here.
const DELTA_T: f64 = 69.2;

/// Where the sun stands (Reda & Andreas 2004, by the crate `solar-positioning`), with the bending of its light in usual
/// air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sun {
    /// Degrees above the horizon; below zero it is night.
    pub elevation: f64,
    /// Degrees clockwise from true north.
    pub azimuth: f64,
    /// From the ground towards it, in the world, of length 1.
    pub toward: DVec3,
}

/// The share of what lies in shadow, 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Shadows {
    /// Of the area.
    pub area: f64,
    /// Of what each photo shows of the surface.
    pub photos: Vec<f64>,
}

impl Sun {
    /// Over a place of the world at a time: RFC 3339, as `2026-06-01T10:00+02:00`; seconds may be left out.
    ///
    /// # Errors
    /// Where the text is no time with its difference from UTC, or the place lies where the coordinate system does not hold.
    pub fn at(when: &str, place: DVec3, crs: &Crs) -> Result<Self, Fault> {
        let time = utc(when).ok_or_else(|| {
            let what = "the time is none, or lacks its difference from UTC";
            Fault::new(what, "give it as 2026-06-01T10:00+02:00, or with Z for UTC")
        })?;
        let off = || {
            let what = format!("the area lies where {} does not hold", crs.name());
            Fault::new(what, "check the coordinate system of the surface")
        };
        let geographic = crs.to_geographic(place).ok_or_else(off)?;
        let axes = crs.grid_from_enu(geographic).ok_or_else(off)?;
        let second = f64::from(time.second());
        let julian = JulianDate::from_utc(
            time.year(),
            time.month(),
            time.day(),
            time.hour(),
            time.minute(),
            second,
            DELTA_T,
        );
        let location = Location {
            latitude: geographic.latitude,
            longitude: geographic.longitude,
        };
        let air = Some(RefractionCorrection::standard());
        let found = julian.and_then(|time| {
            SolarPositions::new().at_from_julian(time, location, geographic.height, air)
        });
        let found = found.map_err(|error| {
            let what = format!("the sun's place is not known: {error}");
            Fault::new(what, "give another time")
        })?;
        let (elevation, azimuth) = (found.elevation_angle(), found.azimuth());
        let level = DVec2::from_angle((90.0 - azimuth).to_radians()) * elevation.to_radians().cos();
        let enu = level.extend(elevation.to_radians().sin());
        Ok(Self {
            elevation,
            azimuth,
            toward: axes * enu,
        })
    }
}

fn utc(text: &str) -> Option<DateTime<Utc>> {
    let text = text.trim().replacen(' ', "T", 1);
    let text = text.replace(' ', "");
    let whole = DateTime::parse_from_rfc3339(&text);
    // Without seconds: "2026-06-01T10:00" is 16 characters long.
    let short = || {
        let (minutes, zone) = (text.get(..16)?, text.get(16..)?);
        DateTime::parse_from_rfc3339(&format!("{minutes}:00{zone}")).ok()
    };
    Some(whole.ok().or_else(short)?.to_utc())
}

impl Plan {
    /// Where the sun stands over the middle of the area at a time ([`Sun::at`]), and what then lies in shadow.
    ///
    /// # Errors
    /// As [`Sun::at`].
    pub fn sun_at(&self, when: &str, crs: &Crs) -> Result<(Sun, Shadows), Fault> {
        let [min, max] = extent(self.area.corners());
        let sun = Sun::at(when, ((min + max) / 2.0).extend(0.0), crs)?;
        Ok((sun, self.shadows(&sun)))
    }

    /// What lies in shadow of other ground while the sun stands there, by the pixels of the terrain; at night all of it.
    pub fn shadows(&self, sun: &Sun) -> Shadows {
        let terrain = &self.terrain;
        let columns = terrain.raster().columns as usize;
        let known = terrain
            .heights()
            .iter()
            .copied()
            .filter(|height| !height.is_nan());
        let highest = known.fold(f64::MIN, f64::max);
        let is_dark: Vec<bool> = (0..terrain.heights().len())
            .into_par_iter()
            .map(|place| {
                // `as` is exact: both are counts of pixels.
                let point = terrain.point((place % columns) as u32, (place / columns) as u32);
                point.is_some_and(|point| terrain.is_shadowed(point, sun.toward, highest))
            })
            .collect();
        let share = |places: &mut dyn Iterator<Item = usize>| {
            let (mut dark, mut all) = (0_usize, 0_usize);
            for place in places {
                dark += usize::from(is_dark[place]);
                all += 1;
            }
            dark as f64 / all.max(1) as f64
        };
        let in_area = terrain.is_in(&self.area);
        let photos = self.photos.par_iter().map(|photo| {
            let seen = seen_by(photo, &self.camera, terrain);
            share(&mut seen.into_iter())
        });
        Shadows {
            area: share(&mut (0..is_dark.len()).filter(|place| in_area[*place] == (true, true))),
            photos: photos.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the algorithm's report (Reda & Andreas 2008, NREL/TP-560-34302, A.5): 17 October 2003, 12:30:30 seven hours
    /// behind UTC, 39.742476 N 105.1786 W, 1830.14 m: zenith 50.11162, azimuth 194.34024 degrees, with 820 hPa and 11 degrees.
    #[test]
    fn the_sun_stands_where_the_report_says() {
        let crs = Crs::understand("EPSG:4326").unwrap();
        let place = DVec3::new(-105.1786, 39.742_476, 1830.14);
        let sun = Sun::at("2003-10-17T12:30:30-07:00", place, &crs).unwrap();
        // Usual air and another second of the Earth's turning: a hundredth of a degree.
        assert!(
            (sun.elevation - (90.0 - 50.11162)).abs() < 0.01,
            "{}",
            sun.elevation
        );
        assert!((sun.azimuth - 194.34024).abs() < 0.01, "{}", sun.azimuth);
        let east = sun.elevation.to_radians().cos() * 194.34024_f64.to_radians().sin();
        assert!((sun.toward.x - east).abs() < 1e-3 && sun.toward.z > 0.0);
    }

    #[test]
    fn times_have_a_difference_from_utc() {
        let at = |text: &str| utc(text).map(|time| time.timestamp());
        // By `date -u -d ... +%s`.
        let expected = Some(1_780_300_800);
        for text in [
            "2026-06-01T10:00:00+02:00",
            "2026-06-01T10:00+02:00",
            "2026-06-01 10:00 +02:00",
            "2026-06-01T08:00Z",
        ] {
            assert_eq!(at(text), expected, "{text}");
        }
        for wrong in [
            "2026-06-01T10:00",
            "2026-13-01T10:00Z",
            "noon",
            "",
            "2026-06-01",
        ] {
            assert_eq!(at(wrong), None, "{wrong}");
        }
    }
}
