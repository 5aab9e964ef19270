//! A surface whose file names no coordinate system, beside photos that have one: it is taken to be in
//! theirs, which is said; where it cannot be, that is said with the numbers.

use glam::{DVec2, DVec3};

use super::frame::WorldFrame;
use crate::fault::Fault;
use crate::geometry::Bounds;

/// No drone photographs ground that begins so many metres away.
const OUT_OF_SIGHT: f64 = 20_000.0;

/// What is said of such a surface, or of one in a system that is not understood (`own`). `centers` are those of the photos, in
/// `world`.
///
/// # Errors
/// Where it lies so far from the photos that its coordinates are in another system.
pub(crate) fn taken_to_be_in(
    own: &WorldFrame,
    world: &WorldFrame,
    points: &[DVec3],
    centers: &[DVec3],
) -> Result<String, Fault> {
    let states = match own.crs() {
        None => "it states no coordinate system",
        Some(_) => "it states a coordinate system that fragscale cannot convert",
    };
    let taken = format!("{states} and is taken to be in {}", world.in_words());
    let (Some(surface), Some(photos)) = (Bounds::of(points), Bounds::of(centers)) else {
        return Ok(taken);
    };
    // A system of another unit fails elsewhere.
    let metres = world.unit()?.map_or(1.0, |unit| unit.metres());
    let gap = (surface.min - photos.max).max(photos.min - surface.max);
    let gap = gap.truncate().max(DVec2::ZERO).length() * metres;
    if gap <= OUT_OF_SIGHT {
        return Ok(taken);
    }
    let about = |bounds: &Bounds| {
        let middle = bounds.center();
        format!("({:.0}, {:.0}, {:.0})", middle.x, middle.y, middle.z)
    };
    Err(Fault::new(
        format!(
            "{states}, and cannot be in the photos' ({}): its points are around {}, the photos around {}, {:.0} km away",
            world.in_words(),
            about(&surface),
            about(&photos),
            gap / 1000.0
        ),
        "export it in that system, or in one that its file names",
    ))
}

#[cfg(test)]
mod tests {
    use crate::flight::Doubt;
    use crate::jobs::Progress;
    use crate::{OpenOptions, Opened, open_flight};

    /// A flight of one photo in UTM, over a cloud at this place that names no system.
    fn opened(east: f64, north: f64) -> Result<Opened, String> {
        let photo = ("EPSG:32633", "500010,5000010,130");
        opened_in("world.unit = \"m\"", photo, [east, north])
    }

    /// The same of another world, with the photo in that system, there.
    fn opened_in(
        world: &str,
        (system, photo): (&str, &str),
        [east, north]: [f64; 2],
    ) -> Result<Opened, String> {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text).unwrap();
        };
        write(
            "flight.toml",
            &format!(
                "format = 1\n{world}\nsurface.file = \"pile.xyz\"\nphotos.poses = \"poses.csv\"\n\
                 [[camera]]\nwidth = 4\nheight = 3\nfx = 4\nfy = 4\ncx = 2\ncy = 1.5\n"
            ),
        );
        write(
            "poses.csv",
            &format!("photo,x,y,z,tilt,pan\na.jpg,{photo},90,0\n"),
        );
        write("poses.prj", system);
        let corners = [(0.0, 0.0), (40.0, 0.0), (0.0, 40.0), (40.0, 40.0)];
        let pile = corners.map(|(x, y)| format!("{} {} 100\n", east + x, north + y));
        write("pile.xyz", &pile.concat());
        let options = OpenOptions::default();
        let opened = open_flight(folder.path(), &options, &Progress::default());
        opened.map_err(|error| error.to_string())
    }

    #[test]
    fn what_it_is_taken_for_is_said() {
        let warnings = opened(500_000.0, 5_000_000.0).unwrap().warnings;
        let said = warnings.iter().filter(|warning| {
            warning.contains(
                "pile.xyz: it states no coordinate system and is taken to be in EPSG:32633",
            )
        });
        assert_eq!(said.count(), 1, "{warnings:?}");
    }

    /// From the local frame's corner to the photo: 500 and 5000 km, less the 40 m of the cloud.
    #[test]
    fn what_it_cannot_be_in_is_refused_with_numbers() {
        let error = opened(0.0, 0.0).unwrap_err();
        for part in [
            "pile.xyz: it states no coordinate system, and cannot be in the photos' (EPSG:32633)",
            "its points are around (20, 20, 100), the photos around (500010, 5000010, 130), 5025 km away",
        ] {
            assert!(error.contains(part), "{error}");
        }
    }

    /// EPSG:2227 counts in US survey feet of 1200/3937 m and EPSG:5703 in metres: a cloud that is taken to be in both has its
    /// heights of 100 m at 328.0833 ft, as the photos have theirs.
    #[test]
    fn heights_of_another_unit_are_those_of_its_system() {
        let photo = ("EPSG:2227+5703", "6000010,2000010,130");
        let opened = opened_in("world.unit = \"us-ft\"", photo, [6e6, 2e6]).unwrap();
        let parts = opened.flight.parts();
        let (surface, photo) = (parts.surface.bounds(), parts.photos[0].pose.center);
        let feet = 3937.0 / 1200.0;
        for (found, metres) in [
            (surface.min.z, 100.0),
            (surface.max.z, 100.0),
            (photo.z, 130.0),
        ] {
            assert!((found - metres * feet).abs() < 1e-9, "{found}");
        }
        let said = |what: &str| opened.warnings.iter().any(|warning| warning.contains(what));
        assert!(said(
            "pile.xyz: the heights of the points are in another unit"
        ));
        assert!(said("the heights of the poses are in another unit"));
    }

    /// Receivers' heights over a cloud that is taken to be in a system with heights over a geoid, and over one in a system
    /// that says nothing of heights.
    #[test]
    fn heights_that_it_may_have_of_its_system_are_no_ellipsoids() {
        let photo = ("EPSG:4979", "15.000127,45.15361,130");
        for (system, is_doubted) in [("EPSG:32633+5773", true), ("EPSG:32633", false)] {
            let world = format!("world.unit = \"m\"\nworld.crs = \"{system}\"");
            let opened = opened_in(&world, photo, [500_000.0, 5_000_000.0]).unwrap();
            let evidence = &opened.looked_up.evidence[0];
            let found = evidence.doubts.iter().find_map(|doubt| match doubt {
                Doubt::OtherHeights { surface, .. } => Some(surface.clone()),
                _ => None,
            });
            assert_eq!(found.is_some(), is_doubted, "{:?}", opened.warnings);
            let says = found.is_none_or(|found| found.ends_with("its file does not say)"));
            assert!(says, "{:?}", opened.warnings);
        }
    }
}
