//! What the coordinates of a package, a list or a surface's file mean.

use glam::{DMat3, DVec3};

use crate::fault::Fault;
use crate::formats::CloudFile;
use crate::geodesy::is_stated;
use crate::geodesy::{
    Crs, CrsKind, Geographic, ecef_from_geographic, enu_axes, geographic_from_ecef,
    stated_unit_metres,
};
use crate::units::LengthUnit;

/// What heights above an ellipsoid count from, in words.
const ELLIPSOID: &str = "the ellipsoid";

/// Whether heights of which two differ count from the ellipsoid on one side: tens of metres off the other in most places.
pub(crate) fn is_one_ellipsoidal(both: &[String; 2]) -> bool {
    both.iter().any(|heights| heights == ELLIPSOID)
}

/// The system of longitudes and latitudes of which nothing else is said.
const WGS84: &str = "EPSG:4326";

/// What coordinates mean.
#[derive(Debug, Clone)]
pub(crate) enum WorldFrame {
    /// Nobody says, or only a name that is not understood: coordinates are taken as they are.
    AsIs(Option<String>),
    /// Metres east, north and up of this place.
    Enu(Geographic),
    /// A system with a name.
    Named(Crs),
}

impl WorldFrame {
    /// Of what a package says: the name of a system, or where the origin stands of a frame whose
    /// axes are east, north and up. A name that is not understood is said in `warnings`.
    ///
    /// # Errors
    /// Where the system has to be understood, because it counts in degrees, and is not.
    pub(crate) fn of_poses(
        crs: Option<&str>,
        origin: Option<Geographic>,
        warnings: &mut Vec<String>,
    ) -> Result<Self, Fault> {
        match (crs.filter(|crs| is_stated(crs)), origin) {
            (Some(crs), _) => Self::of_name(crs, is_geographic_wkt(crs), warnings),
            (None, Some(origin)) => Ok(Self::Enu(origin)),
            (None, None) => Ok(Self::AsIs(None)),
        }
    }

    /// The frame of a cloud. A name that is not understood is said in `warnings`.
    ///
    /// # Errors
    /// Where the system has to be understood, because it counts in degrees, and is not.
    pub(crate) fn of_cloud(file: &CloudFile, warnings: &mut Vec<String>) -> Result<Self, Fault> {
        match file.crs.as_deref().filter(|crs| is_stated(crs)) {
            Some(crs) => Self::of_name(crs, file.geographic, warnings),
            None if file.geographic => Self::of_name(WGS84, true, warnings),
            None => Ok(Self::AsIs(None)),
        }
    }

    fn of_name(crs: &str, in_degrees: bool, warnings: &mut Vec<String>) -> Result<Self, Fault> {
        match Crs::understand(crs) {
            Ok(crs) => Ok(Self::Named(crs)),
            Err(fault) if in_degrees => Err(fault),
            Err(fault) => {
                warnings.push(format!(
                    "its coordinates are taken as they are: {}",
                    fault.what
                ));
                Ok(Self::AsIs(Some(crs.to_owned())))
            }
        }
    }

    /// What heights are multiplied by to count in the unit of x and y: some systems have them in
    /// another one.
    pub(super) fn heights_factor(&self) -> f64 {
        match self {
            Self::Named(crs) => crs.heights_factor(),
            Self::AsIs(_) | Self::Enu(_) => 1.0,
        }
    }

    /// Where heights count in another unit than x and y: what becomes of them, for whoever sees them as they are in the file.
    pub(crate) fn heights_in_words(&self) -> Option<String> {
        let factor = self.heights_factor();
        (factor != 1.0).then(|| {
            format!(
                "its heights are in another unit than x and y, and stand here as the file has them: for all else they are \
                 multiplied by {factor:.7}"
            )
        })
    }

    /// Whether lengths in it are lengths on the ground, around a point.
    ///
    /// # Errors
    /// Where they are not.
    pub(crate) fn check_lengths(&self, point: DVec3) -> Result<Option<String>, Fault> {
        match (self, self.place(point)) {
            (Self::Named(crs), Some(place)) => crs.check_lengths(place),
            _ => Ok(None),
        }
    }

    /// The unit of its lengths; `None` where nobody says it.
    ///
    /// # Errors
    /// Where it is a unit that no flight can have: kilometres, links.
    pub(crate) fn unit(&self) -> Result<Option<LengthUnit>, Fault> {
        match self {
            Self::AsIs(None) => Ok(None),
            // A local system may state one for all that.
            Self::AsIs(Some(crs)) => Ok(stated_unit_metres(crs).and_then(LengthUnit::of_metres)),
            Self::Enu(_) => Ok(Some(LengthUnit::Metre)),
            Self::Named(crs) => match LengthUnit::of_metres(crs.unit_metres()) {
                Some(unit) => Ok(Some(unit)),
                None => Err(Fault::new(
                    format!("the unit of {} is {} m long", crs.name(), crs.unit_metres()),
                    "name a system in metres or feet as world.crs in a flight.toml",
                )),
            },
        }
    }

    /// Metres in the unit of its lengths; those of longitudes and latitudes count in metres.
    pub(super) fn metres(&self) -> f64 {
        match self {
            Self::Named(crs) => crs.unit_metres(),
            Self::Enu(_) | Self::AsIs(_) => 1.0,
        }
    }

    /// Whether nobody says what its coordinates are.
    pub(crate) fn is_as_it_is(&self) -> bool {
        matches!(self, Self::AsIs(_))
    }

    /// The name of its system, if it has one.
    pub(crate) fn crs(&self) -> Option<&str> {
        match self {
            Self::Named(crs) => Some(crs.name()),
            Self::AsIs(name) => name.as_deref(),
            Self::Enu(_) => None,
        }
    }

    /// Itself, where it is a map's.
    pub(crate) fn projected(self) -> Option<Self> {
        matches!(&self, Self::Named(crs) if crs.kind() == CrsKind::Projected).then_some(self)
    }

    /// Whether its numbers are lengths, and no degrees.
    pub(crate) fn has_lengths(&self) -> bool {
        !self.is(CrsKind::Geographic)
    }

    pub(super) fn is(&self, kind: CrsKind) -> bool {
        matches!(self, Self::Named(crs) if crs.kind() == kind)
    }

    /// Whether nothing has to be moved between the two.
    pub(super) fn same_as(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::AsIs(_), _) | (_, Self::AsIs(_)) => true,
            (Self::Enu(a), Self::Enu(b)) => a == b,
            (Self::Named(a), Self::Named(b)) => a.same_as(b),
            _ => false,
        }
    }

    /// For people.
    pub(crate) fn in_words(&self) -> String {
        match self {
            Self::AsIs(_) => "a frame of its own".to_owned(),
            Self::Enu(place) => format!(
                "metres east, north and up of {:.6} N, {:.6} E",
                place.latitude, place.longitude
            ),
            Self::Named(crs) if crs.kind() == CrsKind::Geocentric => {
                "positions from the Earth's centre (ECEF)".to_owned()
            }
            Self::Named(crs) => crs.name().to_owned(),
        }
    }

    /// What heights count from, in words.
    pub(super) fn heights(&self) -> &str {
        match self {
            Self::AsIs(_) => "not said",
            Self::Enu(_) => "the ellipsoid at its origin",
            Self::Named(crs) if crs.kind() == CrsKind::Geocentric => ELLIPSOID,
            Self::Named(crs) => crs.heights(),
        }
    }

    /// Whether the other is the same map without a word of heights, and heights here count in another unit than x and y.
    pub(crate) fn is_same_map_with_heights(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Named(own), Self::Named(other)) => {
                own.heights_factor() != 1.0
                    && other.heights_factor() == 1.0
                    && own.map_name() == other.map_name()
            }
            _ => false,
        }
    }

    /// Whether it says what its heights count from.
    pub(crate) fn states_heights(&self) -> bool {
        matches!(self, Self::Named(crs) if crs.states_heights())
    }

    /// That heights here count from the ellipsoid and there from something else, or the other way round, in words for here and
    /// there; `None` where one of them does not say.
    pub(crate) fn other_heights(&self, there: &Self) -> Option<[String; 2]> {
        self.heights_apart_from(there).filter(is_one_ellipsoidal)
    }

    /// What heights count from here and there, in words, where that is not the same; `None` where one of them does not say. What
    /// a local frame's origin counts from is not sure.
    pub(crate) fn heights_apart_from(&self, there: &Self) -> Option<[String; 2]> {
        let stated = |frame: &Self| match frame {
            Self::Named(crs) if frame.states_heights() => Some(crs.heights().to_owned()),
            _ => None,
        };
        let both = [stated(self)?, stated(there)?];
        (both[0] != both[1]).then_some(both)
    }

    /// The place of a point; `None` outside of what the system covers.
    pub(super) fn place(&self, point: DVec3) -> Option<Geographic> {
        match self {
            Self::AsIs(_) => None,
            Self::Enu(origin) => {
                geographic_from_ecef(ecef_from_geographic(*origin) + enu_axes(*origin) * point)
            }
            Self::Named(crs) => crs.to_geographic(point),
        }
    }

    /// The point of a place.
    pub(super) fn point(&self, place: Geographic) -> Option<DVec3> {
        match self {
            Self::AsIs(_) => None,
            Self::Enu(origin) => {
                let from_origin = ecef_from_geographic(place) - ecef_from_geographic(*origin);
                Some(enu_axes(*origin).transpose() * from_origin)
            }
            Self::Named(crs) => {
                let point = crs.from_geographic(place)?;
                Some(point.with_z(point.z * self.heights_factor()))
            }
        }
    }

    /// The axes in which rotations are told, as columns in east, north, up at a place.
    pub(super) fn axes_in_enu(&self, place: Geographic) -> Option<DMat3> {
        match self {
            Self::AsIs(_) => None,
            Self::Enu(origin) => Some(enu_axes(place).transpose() * enu_axes(*origin)),
            Self::Named(crs) => match crs.kind() {
                CrsKind::Geocentric => Some(enu_axes(place).transpose()),
                // By agreement: Reconstruction::crs.
                CrsKind::Geographic => Some(DMat3::IDENTITY),
                CrsKind::Projected => Some(crs.grid_from_enu(place)?.transpose()),
            },
        }
    }
}

/// Whether a WKT that is not understood is one of degrees: no map projection of them.
fn is_geographic_wkt(text: &str) -> bool {
    let text = text.to_ascii_uppercase();
    let has = |words: &[&str]| words.iter().any(|word| text.contains(word));
    has(&["GEOGCS[", "GEOGCRS[", "GEOGRAPHICCRS["])
        && !has(&["PROJCS[", "PROJCRS[", "PROJECTEDCRS["])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> WorldFrame {
        WorldFrame::Named(Crs::understand(name).unwrap())
    }

    #[test]
    fn a_map_that_is_made_for_looking_is_refused() {
        // Mercator stretches by 1 / cos(latitude): 60 degrees north is at y = 8 399 737.89.
        let refused = named("EPSG:3857").check_lengths(DVec3::new(0.0, 8_399_737.89, 0.0));
        let what = refused.unwrap_err().what;
        assert!(
            what.starts_with("a metre of EPSG:3857 is 0.49")
                || what.starts_with("a metre of EPSG:3857 is 0.50"),
            "{what}"
        );
        // What `info` says of heights as a file has them: 1200 / 3937.
        let told = named("EPSG:32632+6360").heights_in_words().unwrap();
        assert!(told.ends_with("multiplied by 0.3048006"), "{told}");
        assert_eq!(named("EPSG:32632+5703").heights_in_words(), None);
        let utm = named("EPSG:32633").check_lengths(DVec3::new(500_000.0, 5e6, 0.0));
        assert_eq!(utm, Ok(None));
    }

    #[test]
    fn heights_of_the_ellipsoid_are_not_those_of_a_geoid() {
        let apart = |from: &str, to: &str| named(from).other_heights(&named(to));
        let [here, there] = apart("ECEF", "EPSG:32632+5773").unwrap();
        assert_eq!(here, "the ellipsoid");
        assert!(there.contains("EGM96"), "{there}");
        assert!(apart("EPSG:32632+5773", "EPSG:4979").is_some());
        // Where one does not say, or both say the same, nothing is known to be apart.
        for (from, to) in [
            ("ECEF", "EPSG:32632"),
            ("ECEF", "EPSG:4979"),
            ("EPSG:32632+5773", "EPSG:32633+5773"),
            ("EPSG:4326", "EPSG:32632+5773"),
        ] {
            assert_eq!(apart(from, to), None, "{from} {to}");
        }
    }

    /// EPSG:2227 counts in US survey feet, EPSG:5703 in metres, EPSG:6360 in feet.
    #[test]
    fn a_map_without_a_word_of_heights_may_be_the_poses() {
        for (poses, surface, expected) in [
            ("EPSG:2227+5703", "EPSG:2227", true),
            ("EPSG:2227+5703", "EPSG:2227+5703", false),
            ("EPSG:2227+5703", "EPSG:2226", false),
            ("EPSG:2227+6360", "EPSG:2227", false),
            ("EPSG:2227", "EPSG:2227", false),
        ] {
            let found = named(poses).is_same_map_with_heights(&named(surface));
            assert_eq!(found, expected, "{poses} {surface}");
        }
    }

    /// As OPF writes it.
    #[test]
    fn the_authority_may_be_named_twice() {
        let twice = Crs::understand("EPSG:32632+EPSG:5773").unwrap();
        assert_eq!(twice.name(), "EPSG:32632+5773");
    }
}
