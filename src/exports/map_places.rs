//! Places of the world as GeoJSON's positions.
//!
//! RFC 7946 knows longitude and latitude on WGS 84 only. Where the coordinate system of the flight is
//! known and can be projected back, that is what a file holds, without heights. Else the positions
//! are x, y, z of the flight's world, and the foreign member "coordinates" says so: "local, in m".

use glam::DVec3;

use crate::fault::Fault;
use crate::geodesy::{Crs, CrsKind};
use crate::units::LengthUnit;

/// How places of a flight's world are written.
#[derive(Debug)]
pub struct MapPlaces {
    /// The flight's coordinate system, where it leads to longitude and latitude.
    crs: Option<Crs>,
    fault: Option<Fault>,
    unit: LengthUnit,
}

impl MapPlaces {
    /// Those of a world in this coordinate system, as it is stated, and unit.
    pub fn new(crs: Option<&str>, unit: LengthUnit) -> Self {
        let (crs, fault) = match crs.map(|crs| map_system(crs, unit)) {
            None => (None, None),
            Some(Ok(system)) => (Some(system), None),
            Some(Err(fault)) => (None, Some(fault)),
        };
        Self { crs, fault, unit }
    }

    /// Whether longitudes and latitudes are known.
    pub fn are_on_maps(&self) -> bool {
        self.crs.is_some()
    }

    /// Why a stated coordinate system is not used.
    pub fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    /// What the positions are: "WGS 84 longitude, latitude", or "local, in m".
    pub fn words(&self) -> String {
        match self.are_on_maps() {
            true => "WGS 84 longitude, latitude".to_owned(),
            false => format!("local, in {}", self.unit),
        }
    }

    /// A place's position: longitude and latitude, or x, y, z. `None` where it has none on maps.
    pub(crate) fn position(&self, point: DVec3) -> Option<Vec<f64>> {
        match &self.crs {
            Some(crs) => {
                let place = crs.to_geographic(point)?;
                Some(vec![place.longitude, place.latitude])
            }
            None => Some(point.to_array().to_vec()),
        }
    }
}

/// The coordinate system of a flight: a projected one whose unit is the flight's.
fn map_system(crs: &str, unit: LengthUnit) -> Result<Crs, Fault> {
    let refuse = |what: String| Fault::new(what, "the places stay in local coordinates");
    let crs = Crs::understand(crs).map_err(|fault| refuse(fault.what))?;
    let name = crs.name();
    if crs.kind() != CrsKind::Projected {
        return Err(refuse(format!("{name} is no projected system")));
    }
    // A US survey foot and a foot differ by 2 parts in a million: a metre on a state's northing.
    if (crs.unit_metres() / unit.metres() - 1.0).abs() > 1e-7 {
        let what = format!("{name} is not in {unit}, the unit of the flight");
        return Err(refuse(what));
    }
    Ok(crs)
}

/// A linear ring of RFC 7946: the first position again at the end, counterclockwise; empty with fewer
/// than three positions.
pub(crate) fn closed_ring(mut ring: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let [first, _, _, ..] = &ring[..] else {
        return Vec::new();
    };
    let first = first.clone();
    // The shoelace formula, from the first position, which loses no digit to large coordinates.
    let twice_area: f64 = ring
        .windows(2)
        .map(|pair| {
            let [ax, ay] = [pair[0][0] - first[0], pair[0][1] - first[1]];
            let [bx, by] = [pair[1][0] - first[0], pair[1][1] - first[1]];
            ax * by - ay * bx
        })
        .sum();
    ring.push(first);
    if twice_area < 0.0 {
        ring.reverse();
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leads_to_no_map_says_why() {
        let why = |crs, unit| map_system(crs, unit).unwrap_err().what;
        assert!(why("EPSG:4326", LengthUnit::Metre).contains("no projected system"));
        assert!(why("ECEF", LengthUnit::Metre).contains("no projected system"));
        assert!(why("EPSG:32633", LengthUnit::Foot).contains("not in ft"));
        assert!(why("EPSG:2285", LengthUnit::Foot).contains("not in ft"));
        assert!(why("EPSG:65000", LengthUnit::Metre).contains("65000"));
        assert!(map_system("EPSG:2285", LengthUnit::UsSurveyFoot).is_ok());
        assert!(map_system("EPSG:32633", LengthUnit::Metre).is_ok());
    }

    #[test]
    fn rings_are_closed_and_counterclockwise() {
        let [a, b, c] = [vec![0.0, 0.0], vec![0.0, 1.0], vec![1.0, 0.0]];
        let clockwise = vec![a.clone(), b.clone(), c.clone()];
        let expected = vec![a.clone(), c.clone(), b.clone(), a.clone()];
        assert_eq!(closed_ring(clockwise), expected);
        assert_eq!(closed_ring(vec![a.clone(), c, b]), expected);
        assert!(closed_ring(vec![a.clone(), a]).is_empty());
    }
}
