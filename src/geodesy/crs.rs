//! A coordinate system, and the way from it to places on WGS 84 and back.

use std::fmt;

use glam::{DMat3, DVec2, DVec3};
use proj4rs::Proj;
use proj4rs::transform::transform;

use super::definition::{Definition, utm_code};
use super::heights::{ELLIPSOID_WORD, Heights};
use super::proj_text::ProjText;
use super::{Geographic, ecef_from_geographic, enu_axes, geographic_from_ecef};
use crate::fault::Fault;
use crate::units::LengthUnit;

/// How far, in units of the system, going there and back may be off before the projection is not
/// believed.
const THERE_AND_BACK: f64 = 1e-3;
/// Degrees, some 10 m: the central difference over twice that errs by far less than a millionth of a
/// degree.
const STEP: f64 = 1e-4;

/// What kind of coordinates a system has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrsKind {
    /// (east, north, up) on a map, in a unit of length.
    Projected,
    /// (degrees east, degrees north, metres up).
    Geographic,
    /// x, y, z from the Earth's centre, in a unit of length.
    Geocentric,
}

/// How far lengths on a grid may be off: no map zone made for measuring is off by half of that.
const WRONG_GRID: f64 = 0.005;

/// Beyond the edge of a UTM zone, where it is said.
const POOR_GRID: f64 = 0.001;

/// A coordinate system that is understood.
///
/// Its axes are always (east, north, up), whatever order its definition writes; only systems that
/// count to the west and the south (South Africa's Lo) do so here too. Heights are carried through as
/// they are, in metres: a geoid is never added, and the shift of a datum moves positions only.
#[derive(Clone)]
pub struct Crs {
    name: String,
    definition: Definition,
    kind: CrsKind,
    unit_metres: f64,
    /// From it to longitude and latitude; geocentric systems need none.
    projections: Option<Box<Projections>>,
    /// Degrees of a geographic system's prime meridian east of Greenwich.
    prime_meridian: f64,
}

impl fmt::Debug for Crs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Crs")
            .field("name", &self.name)
            .field("kind", &self.kind)
            .finish_non_exhaustive()
    }
}

/// Units that differ by a smaller share are one, written with more or fewer digits.
const SAME_LENGTH: f64 = 1e-9;

impl Crs {
    /// Understands "EPSG:n" or "EPSG:n+m" (m: heights, or "ellipsoid"), "ECEF", WKT 1 or 2, a PROJ string, or
    /// "WGS84 UTM 17N".
    ///
    /// # Errors
    /// Where it is not understood, or how it relates to WGS 84 is not known, with the reason.
    pub fn understand(text: &str) -> Result<Self, Fault> {
        let definition = Definition::of(text)?;
        // A name has to be understood again; a WKT may hold more than the table knows of its code.
        let is_in_table =
            |code: &u32| Definition::of_code(*code).is_ok_and(|known| known.proj.has_known_datum());
        let code = definition.code.filter(is_in_table);
        let name = match (code, definition.heights.code) {
            (Some(code), Some(heights)) => format!("EPSG:{code}+{heights}"),
            // A map's system with heights of its own, which no code says.
            (Some(code), None)
                if definition.heights == Heights::ellipsoidal()
                    && Definition::of_code(code)
                        .is_ok_and(|known| known.heights != definition.heights) =>
            {
                format!("EPSG:{code}+{ELLIPSOID_WORD}")
            }
            (Some(code), None) => format!("EPSG:{code}"),
            (None, _) => text.trim_start_matches('\u{feff}').trim().to_owned(),
        };
        Self::new(name, definition)
    }

    /// The plain UTM zone of a place on WGS 84 (EPSG:326zz, EPSG:327zz), without the exceptions
    /// around Norway and Svalbard.
    pub fn utm_at(place: Geographic) -> Self {
        let east = (place.longitude + 180.0).rem_euclid(360.0);
        // 1 to 60: the remainder is below 360, and what is not finite counts as zone 1.
        let zone = (east / 6.0).floor().clamp(0.0, 59.0) as u32 + 1;
        let definition = Definition::utm(zone, place.latitude < 0.0);
        Self {
            name: format!("EPSG:{}", utm_code(zone, place.latitude < 0.0)),
            kind: CrsKind::Projected,
            unit_metres: 1.0,
            // Never `None`: the text is ours, and a test goes through all zones.
            projections: Projections::of(&definition.proj).ok().map(Box::new),
            prime_meridian: 0.0,
            definition,
        }
    }

    fn new(name: String, mut definition: Definition) -> Result<Self, Fault> {
        let refuse = |what: String| Err(Fault::new(what, "give one that is, as \"EPSG:n\""));
        let short = short(&name);
        let proj = &mut definition.proj;
        if !proj.has_known_datum() {
            return refuse(format!("how {short} relates to WGS 84 is not known"));
        }
        let kind = match proj.get("proj") {
            Some("geocent" | "cart") => CrsKind::Geocentric,
            Some("longlat" | "latlong" | "lonlat" | "latlon") => CrsKind::Geographic,
            _ => CrsKind::Projected,
        };
        let prime_meridian = match kind {
            CrsKind::Projected => proj.count_from_greenwich().map(|()| 0.0),
            CrsKind::Geographic | CrsKind::Geocentric => proj.prime_meridian(),
        };
        let Some(prime_meridian) = prime_meridian else {
            return refuse(format!("the prime meridian of {short} is not known"));
        };
        if kind == CrsKind::Geocentric && proj.has_shift() {
            return refuse(format!("{short} is geocentric and not fixed to WGS 84"));
        }
        let projections = match Projections::of(proj) {
            Ok(projections) => projections,
            Err(e) => return refuse(format!("{short} is not among the known projections ({e})")),
        };
        let unit_metres = projections.own.to_meter();
        if !(unit_metres.is_finite() && unit_metres > 0.0) {
            return refuse(format!("the unit of {short} has no length"));
        }
        Ok(Self {
            name,
            kind,
            unit_metres,
            projections: (kind != CrsKind::Geocentric).then(|| Box::new(projections)),
            prime_meridian,
            definition,
        })
    }

    /// "EPSG:n" where the code is known ("EPSG:n+m" with that of the heights), else the text given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What kind of coordinates it has.
    pub fn kind(&self) -> CrsKind {
        self.kind
    }

    /// The length of the horizontal unit in metres; 1 for geographic systems, whose unit is the
    /// degree.
    pub fn unit_metres(&self) -> f64 {
        match self.kind {
            CrsKind::Geographic => 1.0,
            CrsKind::Projected | CrsKind::Geocentric => self.unit_metres,
        }
    }

    /// The unit of the x and y of a map, where it is one that lengths are given in; degrees are none, and geocentric systems are no maps.
    pub fn unit(&self) -> Option<LengthUnit> {
        match self.kind {
            CrsKind::Projected => LengthUnit::of_metres(self.unit_metres),
            CrsKind::Geographic | CrsKind::Geocentric => None,
        }
    }

    /// The length of the unit of z in metres: the stated one, else that of x and y.
    pub fn vertical_unit_metres(&self) -> f64 {
        match (self.kind, self.definition.heights.unit_metres) {
            (CrsKind::Projected | CrsKind::Geographic, Some(metres)) => metres,
            _ => self.unit_metres(),
        }
    }

    /// What heights are multiplied by to count in the unit of x and y, as all of a flight does: some systems of maps have them in
    /// another one.
    pub fn heights_factor(&self) -> f64 {
        match self.kind {
            CrsKind::Projected => {
                let factor = self.vertical_unit_metres() / self.unit_metres();
                // One foot in two roundings.
                let is_one = (factor - 1.0).abs() <= SAME_LENGTH;
                if is_one { 1.0 } else { factor }
            }
            CrsKind::Geographic | CrsKind::Geocentric => 1.0,
        }
    }

    /// That heights count in another unit than x and y, where they do, in words.
    pub fn heights_apart(&self) -> Option<String> {
        (self.heights_factor() != 1.0).then(|| {
            format!(
                "{} has its heights in units of {} m, x and y in units of {} m",
                self.name(),
                self.vertical_unit_metres(),
                self.unit_metres()
            )
        })
    }

    /// What its heights count from, in words: "the ellipsoid", "the geoid EGM96", "not said".
    pub fn heights(&self) -> &str {
        self.definition
            .heights
            .name
            .as_deref()
            .unwrap_or("not said")
    }

    /// Its name without that of its heights: "EPSG:32632" of "EPSG:32632+5773".
    pub fn map_name(&self) -> &str {
        self.name().split('+').next().unwrap_or_default()
    }

    /// Whether it says what its heights count from.
    pub fn states_heights(&self) -> bool {
        self.definition.heights.name.is_some()
    }

    /// The place of a point; z becomes the height in metres, and counts from what it counted from.
    /// `None` where the point is not finite, or lies where the projection does not hold.
    pub fn to_geographic(&self, point: DVec3) -> Option<Geographic> {
        if !point.is_finite() {
            return None;
        }
        let height = point.z * self.vertical_unit_metres();
        match self.kind {
            CrsKind::Geocentric => geographic_from_ecef(point * self.unit_metres),
            CrsKind::Geographic => {
                if point.y.abs() > 90.0 || point.x.abs() > 360.0 {
                    return None;
                }
                let x = (point.x + self.prime_meridian).to_radians();
                let (longitude, latitude) = self
                    .projections
                    .as_ref()?
                    .to_wgs84(x, point.y.to_radians())?;
                Some(Geographic {
                    longitude,
                    latitude,
                    height,
                })
            }
            CrsKind::Projected => {
                let projections = self.projections.as_ref()?;
                let (longitude, latitude) = projections.to_wgs84(point.x, point.y)?;
                let place = Geographic {
                    longitude,
                    latitude,
                    height,
                };
                let back = self.from_geographic(place)?;
                let off = (back - point).truncate().length();
                (off < THERE_AND_BACK).then_some(place)
            }
        }
    }

    /// The point of a place; the height becomes z in the unit of z. `None` where the projection does
    /// not reach.
    pub fn from_geographic(&self, place: Geographic) -> Option<DVec3> {
        let Geographic {
            longitude,
            latitude,
            height,
        } = place;
        if !(longitude.is_finite() && latitude.abs() <= 90.0 && height.is_finite()) {
            return None;
        }
        if self.kind == CrsKind::Geocentric {
            return Some(ecef_from_geographic(place) / self.unit_metres);
        }
        let projections = self.projections.as_ref()?;
        let point = match self.kind {
            CrsKind::Geographic => {
                let (x, y) = projections.of_wgs84(longitude, latitude)?;
                (x.to_degrees() - self.prime_meridian, y.to_degrees())
            }
            _ => projections.of_wgs84(longitude, latitude)?,
        };
        let z = height / self.vertical_unit_metres();
        let point = DVec3::new(point.0, point.1, z);
        point.is_finite().then_some(point)
    }

    /// East, north and up at a place in the axes of the grid: takes a vector in (east, north, up)
    /// there to one in the system's axes. For projected systems that is a turn about the vertical by
    /// the convergence of the meridians, for geographic ones no turn, for geocentric ones
    /// [`enu_axes`]. `None` where the projection does not hold, or its axes are left-handed.
    pub fn grid_from_enu(&self, place: Geographic) -> Option<DMat3> {
        match self.kind {
            CrsKind::Geographic => Some(DMat3::IDENTITY),
            CrsKind::Geocentric => Some(enu_axes(place)),
            CrsKind::Projected => {
                let (east, north) = self.grid_steps(place)?;
                let north = north.try_normalize()?;
                let across = DVec3::new(north.y, -north.x, 0.0);
                (across.truncate().dot(east) > 0.0)
                    .then(|| DMat3::from_cols(across, north.extend(0.0), DVec3::Z))
            }
        }
    }

    /// Whether a metre of the grid is one on the ground at a place: in Web Mercator, made for looking,
    /// it is not. Returns a sentence where it is doubtful.
    ///
    /// # Errors
    /// Where lengths on the grid are wrong by more than a scale may be.
    pub fn check_lengths(&self, place: Geographic) -> Result<Option<String>, Fault> {
        let Some(scale) = self.grid_scale(place) else {
            return Ok(None);
        };
        let sentence = format!(
            "a metre of {} is {:.4} m on the ground there",
            self.name(),
            1.0 / scale
        );
        let off = (scale - 1.0).abs();
        if off > WRONG_GRID {
            // Coordinates of another system lie anywhere in this one.
            let what = format!(
                "{sentence}, which is latitude {:.2}, longitude {:.2}",
                place.latitude, place.longitude
            );
            let remedy = match self.holds_swapped(place) {
                true => {
                    "give the easting first, then the northing: the other way round they lie where the system is made for"
                }
                false => {
                    "give the coordinate system that its coordinates are in, one that keeps lengths there, such as its zone of UTM"
                }
            };
            return Err(Fault::new(what, remedy));
        }
        Ok((off > POOR_GRID).then_some(sentence))
    }

    /// Whether a metre is one where the coordinates of a place are, read the other way round.
    fn holds_swapped(&self, place: Geographic) -> bool {
        let swapped = self
            .from_geographic(place)
            .and_then(|point| self.to_geographic(DVec3::new(point.y, point.x, point.z)));
        let scale = swapped.and_then(|place| self.grid_scale(place));
        scale.is_some_and(|scale| (scale - 1.0).abs() <= POOR_GRID)
    }

    /// How many metres of the grid are one on the ellipsoid at a place, towards the north: 0.9996 in
    /// the middle of a UTM zone, 2 in Web Mercator at 60 degrees. 1 for systems that are not
    /// projected; `None` where the projection does not hold.
    pub fn grid_scale(&self, place: Geographic) -> Option<f64> {
        if self.kind != CrsKind::Projected {
            return Some(1.0);
        }
        let ends = [STEP, -STEP].map(|step| {
            ecef_from_geographic(Geographic {
                latitude: place.latitude + step,
                height: 0.0,
                ..place
            })
        });
        let (_, north) = self.grid_steps(place)?;
        Some(north.length() * self.unit_metres / ends[0].distance(ends[1]))
    }

    /// How the grid's coordinates change over two [`STEP`]s to the east and to the north.
    fn grid_steps(&self, place: Geographic) -> Option<(DVec2, DVec2)> {
        let at = |east: f64, north: f64| {
            let point = self.from_geographic(Geographic {
                longitude: place.longitude + east,
                latitude: place.latitude + north,
                height: 0.0,
            });
            point.map(DVec3::truncate)
        };
        Some((
            at(STEP, 0.0)? - at(-STEP, 0.0)?,
            at(0.0, STEP)? - at(0.0, -STEP)?,
        ))
    }

    /// Whether coordinates mean the same in both: by their codes, else by what they are made of: both
    /// take places all along their central meridian to the same coordinates, and neither contradicts
    /// the other about heights.
    pub fn same_as(&self, other: &Self) -> bool {
        if self.name == other.name {
            return true;
        }
        let (ours, theirs) = (&self.definition.heights, &other.definition.heights);
        let heights_agree =
            ours.name.is_none() || theirs.name.is_none() || ours.name == theirs.name;
        let units_agree =
            (self.vertical_unit_metres() / other.vertical_unit_metres() - 1.0).abs() <= SAME_LENGTH;
        if self.kind != other.kind || !heights_agree || !units_agree {
            return false;
        }
        if let (Some(a), Some(b)) = (self.definition.code, other.definition.code) {
            return a == b;
        }
        self.agrees_at_places(other)
    }

    fn agrees_at_places(&self, other: &Self) -> bool {
        // Degrees agree where they would be under a millimetre.
        let tolerance = match self.kind {
            CrsKind::Geographic => 1e-8,
            _ => THERE_AND_BACK,
        };
        let middle = self.definition.proj.central_meridian();
        let mut compared = 0;
        for latitude in (-80..=80).step_by(10).map(f64::from) {
            for longitude in [middle - 1.0, middle + 0.5] {
                let place = Geographic {
                    longitude,
                    latitude,
                    height: 0.0,
                };
                match (self.from_geographic(place), other.from_geographic(place)) {
                    (Some(a), Some(b)) if (a - b).length() < tolerance => compared += 1,
                    (None, None) => {}
                    _ => return false,
                }
            }
        }
        compared > 0
    }
}

/// proj4rs's two ends.
#[derive(Clone)]
struct Projections {
    own: Proj,
    wgs84: Proj,
}

impl Projections {
    fn of(proj: &ProjText) -> Result<Self, proj4rs::errors::Error> {
        Ok(Self {
            own: Proj::from_proj_string(&proj.for_proj4rs())?,
            wgs84: Proj::from_proj_string("+proj=longlat +datum=WGS84")?,
        })
    }

    /// Longitude and latitude in degrees on WGS 84 of a point at height 0.
    fn to_wgs84(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let mut point = (x, y, 0.0);
        transform(&self.own, &self.wgs84, &mut point).ok()?;
        Some((point.0.to_degrees(), point.1.to_degrees()))
    }

    fn of_wgs84(&self, longitude: f64, latitude: f64) -> Option<(f64, f64)> {
        let start = (longitude.to_radians(), latitude.to_radians());
        let mut point = (start.0, start.1, 0.0);
        transform(&self.wgs84, &self.own, &mut point).ok()?;
        if point.2 == 0.0 {
            return Some((point.0, point.1));
        }
        // The datum's shift gave the place a height; height 0 in the system itself is meant, and
        // that moves x and y by a millimetre.
        point = (start.0, start.1, -point.2);
        transform(&self.wgs84, &self.own, &mut point).ok()?;
        Some((point.0, point.1))
    }
}

/// The name for a sentence.
fn short(name: &str) -> &str {
    match name.find(['[', '(']) {
        Some(_) => name.split('"').nth(1).unwrap_or("the coordinate system"),
        None => name,
    }
}

#[cfg(test)]
mod tests;
