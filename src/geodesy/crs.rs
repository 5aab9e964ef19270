//! A coordinate system, and the way from it to places on WGS 84 and back.

use std::fmt;

use glam::{DMat3, DVec2, DVec3};
use proj4rs::Proj;
use proj4rs::transform::transform;

use super::definition::{Definition, utm_code};
use super::proj_text::ProjText;
use super::{Geographic, ecef_from_geographic, enu_axes, geographic_from_ecef};
use crate::fault::Fault;

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

impl Crs {
    /// Understands "EPSG:n" or "EPSG:n+m" (m: heights), "ECEF", WKT 1 or 2, a PROJ string, or
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

    /// The length of the unit of z in metres: the stated one, else that of x and y.
    pub fn vertical_unit_metres(&self) -> f64 {
        match (self.kind, self.definition.heights.unit_metres) {
            (CrsKind::Projected | CrsKind::Geographic, Some(metres)) => metres,
            _ => self.unit_metres(),
        }
    }

    /// What its heights count from, in words: "the ellipsoid", "the geoid EGM96", "not said".
    pub fn heights(&self) -> &str {
        self.definition
            .heights
            .name
            .as_deref()
            .unwrap_or("not said")
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
            return Err(Fault::new(
                what,
                "give the coordinate system that its coordinates are in, one that keeps lengths there, such as its zone of UTM",
            ));
        }
        Ok((off > POOR_GRID).then_some(sentence))
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
            (self.vertical_unit_metres() / other.vertical_unit_metres() - 1.0).abs() < 1e-9;
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
mod tests {
    use super::*;
    use crate::units::LengthUnit;

    fn at(crs: &str, x: f64, y: f64, z: f64) -> Geographic {
        let crs = Crs::understand(crs).unwrap();
        crs.to_geographic(DVec3::new(x, y, z)).unwrap()
    }

    fn refusal(text: &str) -> String {
        Crs::understand(text).unwrap_err().what
    }

    /// Degrees, minutes, seconds.
    fn dms(degrees: f64, minutes: f64, seconds: f64) -> f64 {
        degrees + minutes / 60.0 + seconds / 3600.0
    }

    /// Answers of PROJ through pyproj 3.
    #[test]
    fn known_places() {
        // (system, x, y, longitude, latitude, tolerance in degrees)
        for (crs, x, y, lon, lat, tolerance) in [
            (
                "EPSG:32633",
                500_000.0,
                5_000_000.0,
                15.0,
                45.153_477_183_4,
                1e-9,
            ),
            (
                "EPSG:32633",
                450_123.456,
                5_123_456.789,
                14.352_796_991_7,
                46.262_855_832_7,
                1e-9,
            ),
            (
                "EPSG:32719",
                496_523.2,
                7_321_456.7,
                -69.034_241_463_4,
                -24.219_628_998_0,
                1e-9,
            ),
            (
                "EPSG:2154",
                652_469.0,
                6_862_035.0,
                2.352_199_719_5,
                48.856_597_665_4,
                1e-9,
            ),
            (
                "EPSG:26910",
                491_000.0,
                5_459_000.0,
                -123.123_751_799_3,
                49.283_686_421_4,
                1e-8,
            ),
            (
                "EPSG:2193",
                1_749_000.0,
                5_428_000.0,
                174.779_336_132_3,
                -41.285_699_262_1,
                1e-8,
            ),
            (
                "EPSG:28350",
                400_000.0,
                6_450_000.0,
                115.940_382_706_2,
                -32.081_855_662_8,
                1e-8,
            ),
            (
                "EPSG:7850",
                400_000.0,
                6_450_000.0,
                115.940_382_706_2,
                -32.081_855_662_8,
                1e-8,
            ),
            (
                "EPSG:3857",
                1_000_000.0,
                6_000_000.0,
                8.983_152_841_2,
                47.353_704_702_4,
                1e-8,
            ),
            (
                "EPSG:2285",
                1_277_000.0,
                232_000.0,
                -122.307_191_116_4,
                47.626_477_520_8,
                1e-8,
            ),
            // PROJ uses grids or newer parameters here: some metres.
            (
                "EPSG:28992",
                121_687.0,
                487_484.0,
                4.898_009_893_4,
                52.374_218_164_1,
                5e-5,
            ),
            (
                "EPSG:27700",
                530_000.0,
                180_000.0,
                -0.128_353_940_5,
                51.503_990_827_6,
                5e-5,
            ),
        ] {
            let found = at(crs, x, y, 12.5);
            assert!(
                (found.longitude - lon).abs() < tolerance,
                "{crs}: {found:?}"
            );
            assert!((found.latitude - lat).abs() < tolerance, "{crs}: {found:?}");
        }
    }

    /// The worked examples of EPSG guidance note 7-2 (2019).
    #[test]
    fn worked_examples_of_epsg() {
        let place = |longitude, latitude| Geographic {
            longitude,
            latitude,
            height: 0.0,
        };
        for (crs, place, x, y) in [
            // 3.5.3, Transverse Mercator (South Orientated): westing and southing.
            (
                "EPSG:2053",
                place(dms(28.0, 16.0, 57.479), -dms(25.0, 43.0, 55.302)),
                71_984.49,
                2_847_342.74,
            ),
            // 3.3.2, Polar Stereographic (variant A).
            ("EPSG:32661", place(44.0, 73.0), 3_320_416.75, 632_668.43),
        ] {
            let crs = Crs::understand(crs).unwrap();
            let found = crs.from_geographic(place).unwrap();
            // The note gives the places to 0.001 seconds, 3 cm.
            assert!(
                (found.x - x).abs() < 0.02 && (found.y - y).abs() < 0.02,
                "{found}"
            );
        }
        // On their own datums: the shift is taken out by putting the ellipsoid in its place.
        for (text, place, x, y) in [
            // 3.5.1, Mercator (variant A), Makassar / NEIEZ.
            (
                "+proj=merc +lon_0=110 +k_0=0.997 +x_0=3900000 +y_0=900000 +ellps=bessel +nadgrids=@null",
                place(120.0, -3.0),
                5_009_726.58,
                569_150.82,
            ),
            // 3.1.1.2, Lambert Conic Conformal (1SP), JAD69 / Jamaica National Grid.
            (
                "+proj=lcc +lat_1=18 +lat_0=18 +lon_0=-77 +k_0=1 +x_0=250000 +y_0=150000 +ellps=clrk66 +nadgrids=@null",
                place(-dms(76.0, 56.0, 37.26), dms(17.0, 55.0, 55.80)),
                255_966.58,
                142_493.51,
            ),
            // 3.1.1.1, Lambert Conic Conformal (2SP), NAD27 / Texas South Central, in US feet.
            (
                "+proj=lcc +lat_1=28.38333333333333 +lat_2=30.28333333333333 +lat_0=27.83333333333333 +lon_0=-99 +x_0=609601.2192024384 +y_0=0 +ellps=clrk66 +nadgrids=@null +units=us-ft",
                place(-96.0, 28.5),
                2_963_503.91,
                254_759.80,
            ),
        ] {
            let found = Crs::understand(text)
                .unwrap()
                .from_geographic(place)
                .unwrap();
            assert!(
                (found.x - x).abs() < 0.01 && (found.y - y).abs() < 0.01,
                "{found}"
            );
        }
    }

    /// The prime meridian of Paris, 2 20 14.025 E: the origin of NTF / Lambert zone II lies on it.
    #[test]
    fn other_prime_meridians() {
        let text = "+proj=lcc +lat_1=46.8 +lat_0=46.8 +lon_0=0 +k_0=0.99987742 +x_0=600000 +y_0=2200000 +a=6378249.2 +b=6356515 +pm=paris +nadgrids=@null";
        let place = at(text, 600_000.0, 2_200_000.0, 0.0);
        assert!(
            (place.longitude - dms(2.0, 20.0, 14.025)).abs() < 1e-7,
            "{place:?}"
        );
        assert!((place.latitude - 46.8).abs() < 1e-9);
        // With its shift of (-168, -60, 320) m: PROJ's answer for those steps.
        let shifted = at("EPSG:27572", 700_000.0, 2_300_000.0, 0.0);
        assert!(
            (shifted.longitude - 3.668_692_443_289).abs() < 1e-9,
            "{shifted:?}"
        );
        assert!(
            (shifted.latitude - 47.691_879_000_030).abs() < 1e-9,
            "{shifted:?}"
        );
    }

    #[test]
    fn there_and_back() {
        for text in [
            "EPSG:32633",
            "EPSG:2154",
            "EPSG:2285",
            "EPSG:27700",
            "EPSG:28992",
            "EPSG:27572",
            "EPSG:2053",
            "EPSG:4326",
            "EPSG:4979",
            "ECEF",
            "EPSG:32617+6360",
            "EPSG:3857",
        ] {
            let crs = Crs::understand(text).unwrap();
            let middle = crs.definition.proj.central_meridian();
            let latitude = match text {
                "EPSG:2053" => -26.0,
                _ => 50.0,
            };
            let place = Geographic {
                longitude: middle + 1.25,
                latitude,
                height: 321.5,
            };
            let point = crs.from_geographic(place).unwrap();
            let back = crs.to_geographic(point).unwrap();
            let apart = ecef_from_geographic(back).distance(ecef_from_geographic(place));
            // Rotations of a datum are undone to the first order only (EPSG method 9606).
            assert!(apart < 5e-4, "{text}: {apart}");
            assert!((back.height - place.height).abs() < 1e-7);
        }
    }

    #[test]
    fn texts_that_mean_the_same() {
        let utm17 = Crs::understand("EPSG:32617").unwrap();
        for text in [
            "epsg : 32617",
            "urn:ogc:def:crs:EPSG::32617",
            "http://www.opengis.net/def/crs/EPSG/0/32617",
            "WGS84 UTM 17N",
            "WGS 84 / UTM zone 17N",
            "WGS_1984_UTM_Zone_17N",
            "+proj=utm +zone=17 +datum=WGS84 +units=m +no_defs +type=crs",
            "+proj=utm +zone=17 +ellps=WGS84 +units=m +no_defs=True",
            "+init=epsg:32617",
            "+proj=tmerc +lat_0=0 +lon_0=-81 +k=0.9996 +x_0=500000 +y_0=0 +datum=WGS84 +units=m",
            crs_definitions::from_code(32_617).unwrap().wkt,
        ] {
            let crs = Crs::understand(text).unwrap();
            assert_eq!(crs.name(), "EPSG:32617", "{text}");
            assert!(crs.same_as(&utm17));
        }
        let south = Crs::understand("WGS84 UTM 7S").unwrap();
        assert_eq!(south.name(), "EPSG:32707");
        assert!(!south.same_as(&utm17));
        for (text, name, kind) in [
            ("ECEF", "EPSG:4978", CrsKind::Geocentric),
            (
                "+proj=geocent +datum=WGS84 +units=m",
                "EPSG:4978",
                CrsKind::Geocentric,
            ),
            ("WGS 84", "EPSG:4326", CrsKind::Geographic),
            ("OGC:CRS84", "EPSG:4326", CrsKind::Geographic),
            ("EPSG:9518", "EPSG:4326+3855", CrsKind::Geographic),
            ("EPSG:25832+5783", "EPSG:25832+5783", CrsKind::Projected),
        ] {
            let crs = Crs::understand(text).unwrap();
            assert_eq!((crs.name(), crs.kind()), (name, kind), "{text}");
            assert!(Crs::understand(crs.name()).unwrap().same_as(&crs));
        }
        // A code that only its WKT explains.
        let wkt = crs_definitions::from_code(32_617).unwrap().wkt;
        let unknown = wkt.replace("32617", "65001").replace("500000", "500100");
        let crs = Crs::understand(&unknown).unwrap();
        assert_eq!(crs.name(), unknown);
        assert!(!crs.same_as(&utm17));
    }

    #[test]
    fn utm_zones() {
        for zone in 1..=60_u32 {
            for (latitude, base) in [(10.0, 32_600), (-10.0, 32_700)] {
                let place = Geographic {
                    longitude: f64::from(zone) * 6.0 - 184.0,
                    latitude,
                    height: 100.0,
                };
                let crs = Crs::utm_at(place);
                assert_eq!(crs.name(), format!("EPSG:{}", base + zone));
                assert!(crs.same_as(&Crs::understand(crs.name()).unwrap()));
                let point = crs.from_geographic(place).unwrap();
                assert!((200_000.0..800_000.0).contains(&point.x));
                assert_eq!(point.z, 100.0);
            }
        }
        let zone = |longitude| {
            Crs::utm_at(Geographic {
                longitude,
                latitude: 1.0,
                height: 0.0,
            })
            .name()
            .to_owned()
        };
        assert_eq!(zone(180.0), "EPSG:32601");
        assert_eq!(zone(-180.0), "EPSG:32601");
        assert_eq!(zone(179.999), "EPSG:32660");
        assert_eq!(zone(f64::NAN), "EPSG:32601");
    }

    #[test]
    fn units_and_heights() {
        let crs = Crs::understand("EPSG:2285").unwrap();
        assert!((crs.unit_metres() / LengthUnit::UsSurveyFoot.metres() - 1.0).abs() < 1e-12);
        assert_eq!(crs.vertical_unit_metres(), crs.unit_metres());
        assert_eq!(crs.heights(), "not said");
        let crs = Crs::understand("EPSG:32633+5773").unwrap();
        assert_eq!(
            (crs.vertical_unit_metres(), crs.heights()),
            (1.0, "the geoid EGM96")
        );
        assert_eq!(Crs::understand("ECEF").unwrap().heights(), "the ellipsoid");
        assert_eq!(
            Crs::understand("EPSG:4979").unwrap().heights(),
            "the ellipsoid"
        );
        let grid = Crs::understand(
            "+proj=utm +zone=33 +datum=WGS84 +geoidgrids=egm96_15.gtx +vunits=us-ft",
        )
        .unwrap();
        assert_eq!(grid.heights(), "the geoid of egm96_15.gtx");
        let place = Geographic {
            longitude: 15.0,
            latitude: 45.0,
            height: 1200.0 / 3937.0,
        };
        assert!((grid.from_geographic(place).unwrap().z - 1.0).abs() < 1e-12);
        assert!(!grid.same_as(&Crs::understand("EPSG:32633").unwrap()));
    }

    /// The convergence on a sphere is atan(tan(dlon) sin(lat)); the ellipsoid adds a few millionths.
    #[test]
    fn the_grid_turns_by_the_convergence() {
        let utm = Crs::understand("EPSG:32633").unwrap();
        let place = Geographic {
            longitude: 17.0,
            latitude: 50.0,
            height: 0.0,
        };
        let grid = utm.grid_from_enu(place).unwrap();
        let convergence = (2_f64.to_radians().tan() * 50_f64.to_radians().sin()).atan();
        // East of the central meridian, north leans to the west of grid north... seen from the grid,
        // true north points to the left.
        let north = grid * DVec3::Y;
        assert!(
            ((-north.x).atan2(north.y) - convergence).abs() < 2e-5,
            "{north}"
        );
        assert!((grid.determinant() - 1.0).abs() < 1e-14);
        assert_eq!(grid * DVec3::Z, DVec3::Z);
        let middle = Geographic {
            longitude: 15.0,
            ..place
        };
        let grid = utm.grid_from_enu(middle).unwrap();
        assert!((grid * DVec3::Y - DVec3::Y).length() < 1e-9);
        // South Africa's axes: west and south.
        let lo = Crs::understand("EPSG:2053").unwrap();
        let grid = lo
            .grid_from_enu(Geographic {
                longitude: 29.0,
                latitude: -26.0,
                height: 0.0,
            })
            .unwrap();
        assert!((grid * DVec3::Y - DVec3::NEG_Y).length() < 1e-9);
        assert!((grid * DVec3::X - DVec3::NEG_X).length() < 1e-9);
        let ecef = Crs::understand("ECEF").unwrap();
        assert_eq!(ecef.grid_from_enu(place), Some(enu_axes(place)));
    }

    /// UTM's factor in the middle of its zone; Web Mercator's a / (M cos(latitude)), with M the radius of
    /// the meridian (EPSG guidance note 7-2, 3.5.2).
    #[test]
    fn the_grid_is_longer_or_shorter_than_the_ground() {
        let place = Geographic {
            longitude: 15.0,
            latitude: 60.0,
            height: 0.0,
        };
        let scale = |name: &str| Crs::understand(name).unwrap().grid_scale(place).unwrap();
        assert!((scale("EPSG:32633") - 0.9996).abs() < 1e-9);
        let e2 = 0.006_694_379_990_14;
        let meridian = 6_378_137.0 * (1.0 - e2) / (1.0_f64 - e2 * 0.75).powf(1.5);
        let expected = 6_378_137.0 / (meridian * 0.5);
        assert!((scale("EPSG:3857") / expected - 1.0).abs() < 1e-9);
        assert_eq!(scale("ECEF"), 1.0);
        // In feet as in metres.
        let place = Geographic {
            longitude: -120.8,
            latitude: 47.9,
            height: 0.0,
        };
        let feet = Crs::understand("EPSG:2285").unwrap().grid_scale(place);
        assert!((feet.unwrap() - 1.0).abs() < 2e-4, "{feet:?}");
    }

    #[test]
    fn what_is_not_understood_says_why() {
        // NAD27 needs a grid.
        assert_eq!(
            refusal("EPSG:26710"),
            "how EPSG:26710 relates to WGS 84 is not known"
        );
        assert!(refusal("EPSG:65000").contains("65000"));
        assert!(refusal("EPSG:650000000").contains("650000000"));
        assert!(refusal("EPSG:x").contains("'x'"));
        assert!(refusal("").contains("empty"));
        assert!(refusal("mine grid 3").contains("'mine grid 3'"));
        assert!(refusal("+proj=nowhere +datum=WGS84").contains("projections"));
        assert!(refusal("+proj=utm +zone=17").contains("relates"));
        assert!(refusal("+proj=utm +zone=99 +datum=WGS84").contains("projections"));
        assert!(refusal("WGS84 UTM 61N").contains("not known"));
        assert!(refusal("LOCAL_CS[\"pit\",UNIT[\"m\",1]]").contains("no place"));
        // NTF (Paris) counts in grads.
        assert!(refusal("EPSG:4807").contains("not in degrees"));
        // Far outside, the projection has no answer rather than a wrong one.
        let utm = Crs::understand("EPSG:32633").unwrap();
        assert_eq!(utm.to_geographic(DVec3::new(1e9, 1e9, 0.0)), None);
        assert_eq!(utm.to_geographic(DVec3::new(f64::NAN, 0.0, 0.0)), None);
        let lonlat = Crs::understand("EPSG:4326").unwrap();
        assert_eq!(lonlat.to_geographic(DVec3::new(0.0, 91.0, 0.0)), None);
    }
}
