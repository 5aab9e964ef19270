//! The way from one frame to another, for poses and points.
//!
//! Poses are moved photo by photo: the centre through WGS 84, the rotation by the turn between the
//! two systems' axes at that place (the convergence of a map's meridians, the curvature between
//! two places). Heights are carried as numbers: nobody here knows a geoid.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::frame::WorldFrame;
use crate::camera::Pose;
use crate::fault::Fault;

impl WorldFrame {
    /// The way from here to another frame.
    pub(crate) fn to<'a>(&'a self, to: &'a Self) -> Way<'a> {
        Way { from: self, to }
    }
}

/// The way from one frame to another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way<'a> {
    from: &'a WorldFrame,
    to: &'a WorldFrame,
}

impl Way<'_> {
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

    /// What takes small differences between positions at a photo's place to those there, given its
    /// pose before and after; of a frame of longitudes and latitudes differences are metres towards
    /// east, north and up. A map's scale factor is left out: it is a few parts in ten thousand.
    pub(crate) fn differences(&self, before: &Pose, after: &Pose) -> DMat3 {
        if let Some(factor) = self.only_heights() {
            return DMat3::from_diagonal(DVec3::new(1.0, 1.0, factor));
        }
        let turn = after.rotation * before.rotation.transpose();
        turn * (self.from.metres() / self.to.metres())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesy::{Crs, Geographic, ecef_from_geographic, enu_axes};

    fn named(name: &str) -> WorldFrame {
        WorldFrame::Named(Crs::understand(name).unwrap())
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
        let (frame, world) = (WorldFrame::Enu(BRIGHTON), named("EPSG:32615"));
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
        let (frame, world) = (named("ECEF"), WorldFrame::Enu(BRIGHTON));
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
        let (frame, world) = (named("EPSG:4326"), WorldFrame::Enu(BRIGHTON));
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

    /// The axes of the Earth's centre are turned to east, north, up; a foot of EPSG:2263 is
    /// 1200/3937 m, and with x = rho sin t, y = rho0 - rho cos t, t = n (lon - lon0) (Snyder, eq. 14-1
    /// to 14-4) east is (cos t, sin t) there; n = 0.654 between its parallels of 40.67 and 41.03 degrees.
    #[test]
    fn differences_turn_and_count_in_the_worlds_unit() {
        let there = ecef_from_geographic(BRIGHTON);
        let pose = Pose::from_tilt_pan(there, [80.0, 30.0]);
        let (frame, world) = (named("ECEF"), WorldFrame::Enu(BRIGHTON));
        let way = frame.to(&world);
        let turn = way.differences(&pose, &way.pose("a", &pose).unwrap());
        let up = turn * (enu_axes(BRIGHTON) * DVec3::new(0.0, 0.0, 2.0));
        assert!((up - DVec3::new(0.0, 0.0, 2.0)).length() < 1e-12, "{up}");
        let (frame, world) = (named("EPSG:4326"), named("EPSG:2263"));
        let pose = Pose::from_tilt_pan(DVec3::new(-73.0, 40.85, 10.0), [80.0, 30.0]);
        let way = frame.to(&world);
        let east = way.differences(&pose, &way.pose("a", &pose).unwrap()) * DVec3::X;
        assert!((east.length() - 3937.0 / 1200.0).abs() < 1e-9, "{east}");
        let angle = east.y.atan2(east.x).to_degrees();
        assert!((angle - 0.654).abs() < 1e-3, "{angle}");
    }

    #[test]
    fn the_same_frame_moves_nothing_by_a_bit() {
        let pose = Pose::from_tilt_pan(
            DVec3::new(500_000.123_456_7, 5e6 + 1.0 / 3.0, 0.1),
            [80.0, 1.0],
        );
        for (from, to) in [
            (named("EPSG:32615"), named("EPSG:32615")),
            (WorldFrame::AsIs(None), named("EPSG:32615")),
            (WorldFrame::Enu(BRIGHTON), WorldFrame::Enu(BRIGHTON)),
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
}
