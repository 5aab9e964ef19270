//! Which coordinate system the world is in.
//!
//! Of what is there, the first of
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
//! Georeferencing chooses in the same way: there the list of known positions stands for the poses,
//! and the reconstruction for a surface that states nothing and has to fit.

use glam::DVec3;

use super::frame::WorldFrame;
use crate::fault::Fault;
use crate::geodesy::{Crs, CrsKind, Geographic};

/// Why no world can be chosen.
#[derive(Debug, Clone)]
pub(crate) enum NoWorld {
    /// This system is named, and its coordinates are no lengths over a map.
    NoMap(Box<Crs>),
    /// The positions are at no place on the Earth in this frame.
    NoPlace(String),
}

impl From<NoWorld> for Fault {
    /// As flight.toml names the system.
    fn from(error: NoWorld) -> Self {
        match error {
            NoWorld::NoMap(crs) => Self::new(
                format!(
                    "world.crs is {}, whose coordinates are no lengths over a map",
                    crs.name()
                ),
                "name a projected system, such as the UTM zone",
            ),
            NoWorld::NoPlace(frame) => Self::new(
                format!("its positions are at no place on the Earth in {frame}"),
                "check the coordinate system that it names",
            ),
        }
    }
}

/// What is known when the world has to be chosen.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    /// What flight.toml or the user names.
    pub named: Option<Crs>,
    /// The surface file's frame; `None` where nothing but the reconstruction's own
    /// points has to fit.
    pub surface: Option<WorldFrame>,
    /// The frame of the poses and their points.
    pub poses: WorldFrame,
    /// The system that the package works in, where its poses are in another.
    pub preferred: Option<Crs>,
    /// Where the flight is on the Earth: the middle of the camera centres, or a point of the surface
    /// where nobody says what the poses are in.
    pub place: Option<Geographic>,
}

impl Known {
    /// The frame of the flight.
    ///
    /// # Errors
    /// Where the one that is named is no map's, or the poses are at no place on the Earth.
    pub(crate) fn world(&self) -> Result<WorldFrame, NoWorld> {
        if let Some(crs) = &self.named {
            return match crs.kind() {
                CrsKind::Projected => Ok(WorldFrame::Named(crs.clone())),
                CrsKind::Geographic | CrsKind::Geocentric => {
                    Err(NoWorld::NoMap(Box::new(crs.clone())))
                }
            };
        }
        let surface = self.surface.clone();
        let projected = |frame: Option<WorldFrame>| frame.and_then(WorldFrame::projected);
        if let Some(frame) = projected(surface.clone())
            .or_else(|| projected(Some(self.poses.clone())))
            .or_else(|| {
                self.preferred
                    .clone()
                    .map(WorldFrame::Named)
                    .and_then(WorldFrame::projected)
            })
        {
            return Ok(frame);
        }
        let zone = || match self.place {
            Some(place) => Ok(WorldFrame::Named(Crs::utm_at(place))),
            None => Err(NoWorld::NoPlace(self.poses.in_words())),
        };
        if let Some(frame) = &surface
            && (frame.is(CrsKind::Geographic) || frame.is(CrsKind::Geocentric))
        {
            return zone();
        }
        match &self.poses {
            WorldFrame::AsIs(None) => Ok(surface.unwrap_or(WorldFrame::AsIs(None))),
            WorldFrame::AsIs(Some(_)) => Ok(self.poses.clone()),
            WorldFrame::Enu(_) => Ok(self.poses.clone()),
            WorldFrame::Named(crs) if crs.kind() == CrsKind::Geocentric && surface.is_none() => {
                self.place.map(WorldFrame::Enu).map_or_else(zone, Ok)
            }
            WorldFrame::Named(_) => zone(),
        }
    }
}

/// Where a flight is on the Earth: `middle` is that of its camera centres in `poses`, `on_surface` a
/// point of the surface's file.
pub(crate) fn place_of_flight(
    poses: &WorldFrame,
    middle: DVec3,
    surface: Option<&WorldFrame>,
    on_surface: DVec3,
) -> Option<Geographic> {
    match (poses, surface) {
        (WorldFrame::AsIs(_), Some(frame)) => frame.place(on_surface),
        (frame, _) => frame.place(middle),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesy::ecef_from_geographic;

    fn named(name: &str) -> WorldFrame {
        WorldFrame::Named(Crs::understand(name).unwrap())
    }

    const BRIGHTON: Geographic = Geographic {
        longitude: -91.994_0,
        latitude: 46.842_6,
        height: 160.0,
    };

    #[test]
    fn the_world_is_chosen_in_this_order() {
        let utm_surface = DVec3::new(576_700.0, 5_188_200.0, 180.0);
        let ecef = ecef_from_geographic(BRIGHTON);
        let degrees = DVec3::new(BRIGHTON.longitude, BRIGHTON.latitude, 180.0);
        let choose = |named_crs: Option<&str>,
                      surface: Option<WorldFrame>,
                      poses: WorldFrame,
                      middle: DVec3,
                      on_surface: DVec3| {
            let place = place_of_flight(&poses, middle, surface.as_ref(), on_surface);
            let known = Known {
                named: named_crs.map(|crs| Crs::understand(crs).unwrap()),
                surface,
                poses,
                preferred: None,
                place,
            };
            known
                .world()
                .map(|world| world.in_words())
                .map_err(|error| Fault::from(error).what)
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
            choose(
                None,
                in_degrees,
                WorldFrame::AsIs(None),
                DVec3::ZERO,
                degrees
            ),
            utm
        );
        assert_eq!(
            choose(
                None,
                Some(WorldFrame::AsIs(None)),
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
                Some(WorldFrame::AsIs(None)),
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
                Some(WorldFrame::AsIs(None)),
                WorldFrame::AsIs(None),
                DVec3::ONE,
                DVec3::ONE
            ),
            Ok("a frame of its own".to_owned())
        );
        // Numbers that are no place on the Earth.
        assert!(choose(None, None, named("ECEF"), DVec3::ONE, DVec3::ZERO).is_err());
    }
}
