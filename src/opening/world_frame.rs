//! One frame for a flight: what a package wrote and what lies in the surface's file are brought to
//! the world's coordinate system before any ray is cast.
//!
//! The world is, of what is there, the first of
//! 1. the system that flight.toml names (`world.crs`, or that of the frame which its `transform` leads to),
//! 2. the projected system of the surface's file,
//! 3. the projected system of the reconstruction, or the one that its package works in,
//! 4. east, north and up around the photos (ENU), where positions count from the Earth's centre
//!    and no surface file has to fit,
//! 5. the UTM zone of the photos, where positions are longitude and latitude or from the Earth's
//!    centre; without any, that of the cloud,
//! 6. the frame as it is, where nobody says what it is.
//!
//! Degrees are never triangulated. A frame that states nothing is taken to be the world as it is.
//!
//! Poses are moved photo by photo: the centre through WGS 84, the rotation by the turn between the
//! two systems' axes at that place (the convergence of a map's meridians, the curvature between
//! two places). Heights are carried as numbers: nobody here knows a geoid.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::camera::Pose;
use crate::fault::Fault;
use crate::formats::CloudFile;
use crate::geodesy::is_stated;
use crate::geodesy::{
    Crs, CrsKind, Geographic, ecef_from_geographic, enu_axes, geographic_from_ecef,
    stated_unit_metres,
};
use crate::units::LengthUnit;

/// The system of longitudes and latitudes of which nothing else is said.
const WGS84: &str = "EPSG:4326";

/// What coordinates mean.
#[derive(Debug, Clone)]
pub(crate) enum Frame {
    /// Nobody says, or only a name that is not understood: coordinates are taken as they are.
    AsIs(Option<String>),
    /// Metres east, north and up of this place.
    Enu(Geographic),
    /// A system with a name.
    Named(Crs),
}

impl Frame {
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
    fn heights_factor(&self) -> f64 {
        match self {
            Self::Named(crs) if crs.kind() == CrsKind::Projected => {
                crs.vertical_unit_metres() / crs.unit_metres()
            }
            _ => 1.0,
        }
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

    /// The way from here to another frame.
    pub(crate) fn to<'a>(&'a self, to: &'a Self) -> Move<'a> {
        Move { from: self, to }
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

    fn is(&self, kind: CrsKind) -> bool {
        matches!(self, Self::Named(crs) if crs.kind() == kind)
    }

    /// Whether nothing has to be moved between the two.
    fn same_as(&self, other: &Self) -> bool {
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
    fn heights(&self) -> &str {
        match self {
            Self::AsIs(_) => "not said",
            Self::Enu(_) => "the ellipsoid at its origin",
            Self::Named(crs) if crs.kind() == CrsKind::Geocentric => "the ellipsoid",
            Self::Named(crs) => crs.heights(),
        }
    }

    /// The place of a point; `None` outside of what the system covers.
    fn place(&self, point: DVec3) -> Option<Geographic> {
        match self {
            Self::AsIs(_) => None,
            Self::Enu(origin) => {
                geographic_from_ecef(ecef_from_geographic(*origin) + enu_axes(*origin) * point)
            }
            Self::Named(crs) => crs.to_geographic(point),
        }
    }

    /// The point of a place.
    fn point(&self, place: Geographic) -> Option<DVec3> {
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
    fn axes_in_enu(&self, place: Geographic) -> Option<DMat3> {
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

/// What is known when the world has to be chosen.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    /// What flight.toml names.
    pub named: Option<Crs>,
    /// The surface file's frame; `None` where the reconstruction's own points are the surface.
    pub surface: Option<Frame>,
    /// The frame of the poses and their points.
    pub poses: Frame,
    /// The system that the package works in, where its poses are in another.
    pub preferred: Option<Crs>,
    /// The middle of the camera centres, in `poses`.
    pub middle: DVec3,
    /// Some point of the surface's file, in `surface`.
    pub on_surface: DVec3,
}

impl Known {
    /// The frame of the flight.
    ///
    /// # Errors
    /// Where flight.toml names one that is no map's, or the poses are at no place on the Earth.
    pub(crate) fn world(&self) -> Result<Frame, Fault> {
        if let Some(crs) = &self.named {
            return match crs.kind() {
                CrsKind::Projected => Ok(Frame::Named(crs.clone())),
                CrsKind::Geographic | CrsKind::Geocentric => Err(Fault::new(
                    format!(
                        "world.crs is {}, whose coordinates are no lengths over a map",
                        crs.name()
                    ),
                    "name a projected system, such as the UTM zone",
                )),
            };
        }
        let surface = self.surface.clone();
        let projected = |frame: Option<Frame>| frame.and_then(Frame::projected);
        if let Some(frame) = projected(surface.clone())
            .or_else(|| projected(Some(self.poses.clone())))
            .or_else(|| {
                self.preferred
                    .clone()
                    .map(Frame::Named)
                    .and_then(Frame::projected)
            })
        {
            return Ok(frame);
        }
        let place = match (&self.poses, &surface) {
            (Frame::AsIs(_), Some(frame)) => frame.place(self.on_surface),
            (frame, _) => frame.place(self.middle),
        };
        let zone = || {
            place
                .map(|place| Frame::Named(Crs::utm_at(place)))
                .ok_or_else(|| {
                    Fault::new(
                        format!(
                            "its positions are at no place on the Earth in {}",
                            self.poses.in_words()
                        ),
                        "check the coordinate system that it names",
                    )
                })
        };
        if let Some(frame) = &surface
            && (frame.is(CrsKind::Geographic) || frame.is(CrsKind::Geocentric))
        {
            return zone();
        }
        match &self.poses {
            Frame::AsIs(None) => Ok(surface.unwrap_or(Frame::AsIs(None))),
            Frame::AsIs(Some(_)) => Ok(self.poses.clone()),
            Frame::Enu(_) => Ok(self.poses.clone()),
            Frame::Named(crs) if crs.kind() == CrsKind::Geocentric && surface.is_none() => {
                place.map(Frame::Enu).map_or_else(zone, Ok)
            }
            Frame::Named(_) => zone(),
        }
    }
}

/// The way from one frame to another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Move<'a> {
    from: &'a Frame,
    to: &'a Frame,
}

impl Move<'_> {
    /// Whether it leaves everything where it is, to the last bit.
    pub(crate) fn is_none(&self) -> bool {
        self.only_heights() == Some(1.0)
    }

    /// Where nothing has to be moved but the unit of heights: their factor.
    fn only_heights(&self) -> Option<f64> {
        self.from
            .same_as(self.to)
            .then(|| self.from.heights_factor())
    }

    /// A pose there.
    ///
    /// # Errors
    /// Where it lies outside of what a system covers; `photo` is its name.
    pub(crate) fn pose(&self, photo: &str, pose: &Pose) -> Result<Pose, Fault> {
        if self.is_none() {
            return Ok(*pose);
        }
        self.moved_pose(pose)
            .ok_or_else(|| self.outside(&format!("photo '{photo}'")))
    }

    fn moved_pose(&self, pose: &Pose) -> Option<Pose> {
        if let Some(factor) = self.only_heights() {
            let center = pose.center.with_z(pose.center.z * factor);
            return Some(Pose { center, ..*pose });
        }
        let place = self.from.place(pose.center)?;
        let center = self.to.point(place).filter(|center| center.is_finite())?;
        let turn = self.to.axes_in_enu(place)?.transpose() * self.from.axes_in_enu(place)?;
        Some(Pose {
            rotation: turn * pose.rotation,
            center,
        })
    }

    /// Puts points there.
    ///
    /// # Errors
    /// Where one lies outside of what a system covers.
    pub(crate) fn points(&self, points: &mut [DVec3]) -> Result<(), Fault> {
        if self.is_none() {
            return Ok(());
        }
        if let Some(factor) = self.only_heights() {
            points.iter_mut().for_each(|point| point.z *= factor);
            return Ok(());
        }
        points.par_iter_mut().try_for_each(|point| {
            let place = self.from.place(*point);
            let moved = place.and_then(|place| self.to.point(place));
            *point = moved.filter(|moved| moved.is_finite()).ok_or_else(|| {
                self.outside(&format!("the point {}, {}, {}", point.x, point.y, point.z))
            })?;
            Ok(())
        })
    }

    /// What it did, for people: "WHAT, in A, are brought to B".
    pub(crate) fn in_words(&self, what: &str) -> Option<String> {
        let (from, to) = (self.from.in_words(), self.to.in_words());
        match self.only_heights() {
            Some(1.0) => None,
            Some(factor) => Some(format!(
                "the heights of {what} are in another unit than x and y ({from}): they are multiplied by {factor:.7}"
            )),
            None => Some(format!(
                "{what}, in {from}, are brought to {to}; heights count from what they counted from ({})",
                self.from.heights()
            )),
        }
    }

    fn outside(&self, what: &str) -> Fault {
        let (from, to) = (self.from.in_words(), self.to.in_words());
        Fault::new(
            format!("{what} cannot be brought from {from} to {to}"),
            "check the coordinate systems, or name another as world.crs in a flight.toml",
        )
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

    fn named(name: &str) -> Frame {
        Frame::Named(Crs::understand(name).unwrap())
    }

    const BRIGHTON: Geographic = Geographic {
        longitude: -91.994_0,
        latitude: 46.842_6,
        height: 160.0,
    };

    /// Over a tangential plane the meridians of a map converge by atan(tan(lon - lon0) sin lat)
    /// (Snyder, Map Projections, eq. 8-18 on the sphere; the ellipsoid differs by under 0.001
    /// degrees within a zone), and its lengths are 0.9996 (1 + x^2 / 2 R^2) of those on the ellipsoid.
    #[test]
    fn a_pose_turns_by_the_convergence_and_lengths_by_the_grids_scale() {
        let (frame, world) = (Frame::Enu(BRIGHTON), named("EPSG:32615"));
        let way = frame.to(&world);
        let north = Pose::from_tilt_pan(DVec3::ZERO, [90.0, 0.0]);
        let moved = way.pose("a", &north).unwrap();
        let up = -moved.rotation.y_axis;
        let from_central = BRIGHTON.longitude + 93.0;
        let convergence =
            (from_central.to_radians().tan() * BRIGHTON.latitude.to_radians().sin()).atan();
        // East of the central meridian, true north lies to the west of grid north.
        let turn = (-up.x).atan2(up.y);
        assert!(
            (turn - convergence).abs().to_degrees() < 1e-3,
            "{turn} {convergence}"
        );
        let mut ends = [DVec3::ZERO, DVec3::new(0.0, 100.0, 0.0)];
        way.points(&mut ends).unwrap();
        assert!((ends[0] - moved.center).length() < 1e-9);
        let x = ends[0].x - 500_000.0;
        let radius = 6_380_000.0_f64;
        let on_map = 0.9996 * (1.0 + (x / 0.9996).powi(2) / (2.0 * radius.powi(2)));
        let scale = on_map / (1.0 + BRIGHTON.height / radius);
        let length = (ends[1] - ends[0]).truncate().length();
        assert!((length / 100.0 - scale).abs() < 2e-6, "{length} {scale}");
    }

    #[test]
    fn from_the_earths_centre_to_east_north_up_nothing_is_bent() {
        let (frame, world) = (named("ECEF"), Frame::Enu(BRIGHTON));
        let way = frame.to(&world);
        let there = ecef_from_geographic(BRIGHTON);
        let axes = enu_axes(BRIGHTON);
        let mut points = [there + axes * DVec3::new(3.0, 4.0, 12.0)];
        way.points(&mut points).unwrap();
        assert!(
            (points[0] - DVec3::new(3.0, 4.0, 12.0)).length() < 1e-8,
            "{}",
            points[0]
        );
        let pose = Pose {
            rotation: axes,
            center: there + axes * DVec3::new(200.0, 0.0, 0.0),
        };
        let moved = way.pose("a", &pose).unwrap();
        assert!((moved.center - DVec3::new(200.0, 0.0, 0.0)).length() < 1e-8);
        assert!((moved.rotation.x_axis - DVec3::X).length() < 1e-12);
        assert!((moved.rotation.z_axis - DVec3::Z).length() < 1e-12);
    }

    #[test]
    fn a_pose_on_longitude_and_latitude_is_told_in_east_north_up() {
        let (frame, world) = (named("EPSG:4326"), Frame::Enu(BRIGHTON));
        let center = DVec3::new(
            BRIGHTON.longitude,
            BRIGHTON.latitude,
            BRIGHTON.height + 40.0,
        );
        let pose = Pose::from_tilt_pan(center, [90.0, 30.0]);
        let moved = frame.to(&world).pose("a", &pose).unwrap();
        assert!((moved.center - DVec3::new(0.0, 0.0, 40.0)).length() < 1e-8);
        assert!((moved.rotation.x_axis - pose.rotation.x_axis).length() < 1e-12);
    }

    #[test]
    fn the_same_frame_moves_nothing_by_a_bit() {
        let pose = Pose::from_tilt_pan(
            DVec3::new(500_000.123_456_7, 5e6 + 1.0 / 3.0, 0.1),
            [80.0, 1.0],
        );
        for (from, to) in [
            (named("EPSG:32615"), named("EPSG:32615")),
            (Frame::AsIs(None), named("EPSG:32615")),
            (Frame::Enu(BRIGHTON), Frame::Enu(BRIGHTON)),
        ] {
            let way = from.to(&to);
            assert_eq!(way.pose("a", &pose), Ok(pose));
            assert_eq!(way.in_words("x"), None);
        }
    }

    /// A US survey foot is 1200/3937 m, the unit of EPSG:2263's x and y.
    #[test]
    fn heights_in_another_unit_are_brought_to_that_of_x_and_y() {
        let name = r#"COMPD_CS["NAD83 / New York Long Island (ftUS) + NAVD88 height",PROJCS["NAD83 / New York Long Island (ftUS)",GEOGCS["NAD83",DATUM["North_American_Datum_1983",SPHEROID["GRS 1980",6378137,298.257222101,AUTHORITY["EPSG","7019"]],AUTHORITY["EPSG","6269"]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4269"]],PROJECTION["Lambert_Conformal_Conic_2SP"],PARAMETER["standard_parallel_1",41.03333333333333],PARAMETER["standard_parallel_2",40.66666666666666],PARAMETER["latitude_of_origin",40.16666666666666],PARAMETER["central_meridian",-74],PARAMETER["false_easting",984250],PARAMETER["false_northing",0],UNIT["US survey foot",0.3048006096012192],AUTHORITY["EPSG","2263"]],VERT_CS["NAVD88 height",VERT_DATUM["North American Vertical Datum 1988",2005],UNIT["metre",1]]]"#;
        let (frame, world) = (named(name), named("EPSG:2263"));
        let way = frame.to(&world);
        let mut points = [DVec3::new(1_000_000.0, 200_000.0, 12.0)];
        way.points(&mut points).unwrap();
        assert!(
            (points[0].z - 12.0 * 3937.0 / 1200.0).abs() < 1e-9,
            "{}",
            points[0]
        );
        assert_eq!((points[0].x, points[0].y), (1_000_000.0, 200_000.0));
        assert!(way.in_words("the points").unwrap().contains("3.2808333"));
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
        let utm = named("EPSG:32633").check_lengths(DVec3::new(500_000.0, 5e6, 0.0));
        assert_eq!(utm, Ok(None));
    }

    #[test]
    fn the_world_is_chosen_in_this_order() {
        let utm_surface = DVec3::new(576_700.0, 5_188_200.0, 180.0);
        let ecef = ecef_from_geographic(BRIGHTON);
        let degrees = DVec3::new(BRIGHTON.longitude, BRIGHTON.latitude, 180.0);
        let choose = |named_crs: Option<&str>,
                      surface: Option<Frame>,
                      poses: Frame,
                      middle: DVec3,
                      on_surface: DVec3| {
            let known = Known {
                named: named_crs.map(|crs| Crs::understand(crs).unwrap()),
                surface,
                poses,
                preferred: None,
                middle,
                on_surface,
            };
            known
                .world()
                .map(|world| world.in_words())
                .map_err(|fault| fault.what)
        };
        let utm = Ok("EPSG:32615".to_owned());
        // Named in flight.toml.
        let surface = Some(named("EPSG:26915"));
        assert_eq!(
            choose(
                Some("EPSG:32615"),
                surface.clone(),
                named("ECEF"),
                ecef,
                utm_surface
            ),
            utm
        );
        assert!(choose(Some("EPSG:4326"), None, named("ECEF"), ecef, utm_surface).is_err());
        // That of the surface, then of the poses.
        assert_eq!(
            choose(None, surface, named("EPSG:32615"), utm_surface, utm_surface),
            Ok("EPSG:26915".to_owned())
        );
        assert_eq!(
            choose(None, None, named("EPSG:32615"), utm_surface, DVec3::ZERO),
            utm
        );
        // The zone of what is in degrees.
        let in_degrees = Some(named("EPSG:4326"));
        assert_eq!(
            choose(
                None,
                in_degrees.clone(),
                named("EPSG:4326"),
                degrees,
                degrees
            ),
            utm
        );
        assert_eq!(
            choose(None, in_degrees, Frame::AsIs(None), DVec3::ZERO, degrees),
            utm
        );
        assert_eq!(
            choose(
                None,
                Some(Frame::AsIs(None)),
                named("EPSG:4326"),
                degrees,
                DVec3::ZERO
            ),
            utm
        );
        // ECEF stays true to length where no surface has to fit.
        assert!(
            choose(None, None, named("ECEF"), ecef, DVec3::ZERO)
                .unwrap()
                .starts_with("metres east")
        );
        assert_eq!(
            choose(
                None,
                Some(Frame::AsIs(None)),
                named("ECEF"),
                ecef,
                DVec3::ZERO
            ),
            utm
        );
        // Where nobody says anything, everything stays.
        assert_eq!(
            choose(
                None,
                Some(Frame::AsIs(None)),
                Frame::AsIs(None),
                DVec3::ONE,
                DVec3::ONE
            ),
            Ok("a frame of its own".to_owned())
        );
        // Numbers that are no place on the Earth.
        assert!(choose(None, None, named("ECEF"), DVec3::ONE, DVec3::ZERO).is_err());
    }
}
