//! A second surface beside that of a flight: what a volume is over, or a cloud to look at. It is brought to
//! the flight's coordinate system as a surface's file is; where that cannot be, it is refused.

use std::path::Path;
use std::sync::Arc;

use crate::fault::Fault;
use crate::files::{FileError, Inputs, Recording};
use crate::formats::read_cloud;
use crate::geodesy::Crs;
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::surface::Surface;
use crate::units::LengthUnit;
use crate::world::{WorldFrame, is_one_ellipsoidal, taken_to_be_in};

/// Of two surfaces whose files say nothing of their world, one that lies farther away than so many times
/// the other's size is in another world.
const FARTHEST: f64 = 20.0;

/// The world of a flight, as its files state it.
#[derive(Debug, Clone, Copy)]
pub struct StatedWorld<'a> {
    /// Its coordinate system: "EPSG:n" or WKT.
    pub crs: Option<&'a str>,
    /// Its unit, where it is known.
    pub unit: Option<LengthUnit>,
    /// Around its surface.
    pub around: Bounds,
}

/// A second surface, in the world of the flight.
#[derive(Debug)]
pub struct SecondSurface {
    /// Its triangles.
    pub surface: Arc<Surface>,
    /// What its heights count from and the flight's, in words, where both say it and that is not the same.
    pub other_heights: Option<[String; 2]>,
    /// What was noticed, one sentence each with the file in front.
    pub warnings: Vec<String>,
    /// The files that were read.
    pub read: Inputs,
}

/// Reads a cloud or mesh and brings it to the world of a flight.
///
/// # Errors
/// With the file: where it cannot be read, or is in another world.
pub fn second_surface(
    path: &Path,
    world: &StatedWorld<'_>,
    progress: &Progress,
) -> Result<SecondSurface, FileError> {
    let at = |fault| FileError::new(path, fault);
    let recording = Recording::start();
    let mut file = read_cloud(path, progress)?;
    let mut said = std::mem::take(&mut file.warnings);
    let own = WorldFrame::of_cloud(&file, &mut said).map_err(at)?;
    said.extend(bring(&own, &mut file.cloud.points, world).map_err(at)?);
    let other_heights = own.heights_apart_from(&frame_of(world));
    if let Some([own, theirs]) = &other_heights {
        said.push(format!(
            "its heights count from {own}, the flight's from {theirs}: they are as far apart as these are, decimetres to metres between geoids, tens of metres to the ellipsoid"
        ));
    }
    progress.stage("building the second surface");
    let surface = Surface::new(file.cloud)
        .map_err(|error| at(Fault::new(error.to_string(), "check the file")))?;
    let name = path.display();
    Ok(SecondSurface {
        surface: Arc::new(surface),
        other_heights,
        warnings: said.iter().map(|said| format!("{name}: {said}")).collect(),
        read: Inputs::of([path]).with_opened(&recording.files()),
    })
}

/// Reads a cloud or mesh that a volume is to be over, as [`second_surface`].
///
/// # Errors
/// As that, and where the heights of one count from the ellipsoid and those of the other do not: they are tens of metres
/// apart in most places, and so would the volume be.
pub fn volume_base(
    path: &Path,
    world: &StatedWorld<'_>,
    progress: &Progress,
) -> Result<SecondSurface, FileError> {
    let second = second_surface(path, world, progress)?;
    match &second.other_heights {
        Some(both) if is_one_ellipsoidal(both) => {
            let [own, theirs] = both;
            let what = format!(
                "its heights count from {own}, the flight's from {theirs}, which are tens of metres apart in most places"
            );
            let remedy =
                "export both with heights above the same, for no volume between them is true";
            Err(FileError::new(path, Fault::new(what, remedy)))
        }
        _ => Ok(second),
    }
}

/// Brings points to the world; says what was done.
fn bring(
    own: &WorldFrame,
    points: &mut [glam::DVec3],
    world: &StatedWorld<'_>,
) -> Result<Option<String>, Fault> {
    let theirs = frame_of(world);
    match (own.is_as_it_is(), theirs.is_as_it_is()) {
        (false, false) => {
            let way = own.to(&theirs);
            way.points(points)?;
            Ok(way.in_words("the points"))
        }
        (false, true) => Err(Fault::new(
            format!(
                "it is in {}, and the flight's coordinate system is not known",
                own.in_words()
            ),
            "name that as world.crs in its flight.toml, or export both in one system",
        )),
        (true, stated) => {
            same_unit(own, world)?;
            let middle = Bounds {
                min: world.around.center(),
                max: world.around.center(),
            };
            if !stated {
                return taken_to_be_in(own, &theirs, points, &[middle.min]).map(Some);
            }
            near(points, &world.around)?;
            let text = "taken to be in the flight's own frame: neither of the two states a coordinate system";
            Ok(Some(text.to_owned()))
        }
    }
}

fn frame_of(world: &StatedWorld<'_>) -> WorldFrame {
    match world.crs.map(Crs::understand) {
        Some(Ok(crs)) => WorldFrame::Named(crs),
        _ => WorldFrame::AsIs(world.crs.map(str::to_owned)),
    }
}

/// Refuses what counts in another unit.
fn same_unit(own: &WorldFrame, world: &StatedWorld<'_>) -> Result<(), Fault> {
    match (own.unit()?, world.unit) {
        (Some(own), Some(theirs)) if own != theirs => Err(Fault::new(
            format!("it is in {own}, the flight in {theirs}"),
            "give both in the same unit",
        )),
        _ => Ok(()),
    }
}

/// Refuses what lies so far away that it is in another world.
fn near(points: &[glam::DVec3], flight: &Bounds) -> Result<(), Fault> {
    let Some(own) = Bounds::of(points) else {
        return Ok(());
    };
    let gap = (own.min - flight.max).max(flight.min - own.max);
    let gap = gap.max(glam::DVec3::ZERO).length();
    let size = own.size().length().max(flight.size().length());
    if gap <= FARTHEST * size {
        return Ok(());
    }
    let about = |bounds: &Bounds| {
        let middle = bounds.center();
        format!("({:.0}, {:.0}, {:.0})", middle.x, middle.y, middle.z)
    };
    Err(Fault::new(
        format!(
            "it is not in the flight's frame: its points are around {}, the flight's surface around {}, and \
             neither states a coordinate system",
            about(&own),
            about(flight)
        ),
        "export both in one coordinate system",
    ))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geodesy::Geographic;

    fn named(name: &str) -> WorldFrame {
        WorldFrame::Named(Crs::understand(name).unwrap())
    }

    fn around(middle: DVec3) -> Bounds {
        Bounds {
            min: middle - 20.0,
            max: middle + 20.0,
        }
    }

    const UTM: DVec3 = DVec3::new(500_000.0, 5_000_000.0, 100.0);

    /// 15 degrees east is the central meridian of zone 33: x is 500 000 there.
    #[test]
    fn what_states_its_system_is_brought_to_the_flights() {
        let world = StatedWorld {
            crs: Some("EPSG:32633"),
            unit: Some(LengthUnit::Metre),
            around: around(UTM),
        };
        let place = Crs::understand("EPSG:32633").unwrap().to_geographic(UTM);
        let Geographic {
            longitude,
            latitude,
            height,
        } = place.unwrap();
        assert!((longitude - 15.0).abs() < 1e-9);
        let mut points = [DVec3::new(longitude, latitude, height)];
        let said = bring(&named("EPSG:4326"), &mut points, &world).unwrap();
        assert!(points[0].distance(UTM) < 1e-6, "{}", points[0]);
        assert!(said.unwrap().contains("EPSG:32633"));
        // The other way there is no way.
        let unknown = StatedWorld { crs: None, ..world };
        let refused = bring(&named("EPSG:32633"), &mut [UTM], &unknown).unwrap_err();
        assert!(refused.what.contains("is not known"), "{}", refused.what);
    }

    #[test]
    fn what_states_nothing_is_taken_where_it_can_be_and_refused_where_not() {
        let own = WorldFrame::AsIs(None);
        for (crs, here) in [(Some("EPSG:32633"), UTM), (None, DVec3::ONE)] {
            let world = StatedWorld {
                crs,
                unit: Some(LengthUnit::Metre),
                around: around(here),
            };
            let said = bring(&own, &mut [here, here + 10.0], &world).unwrap();
            assert!(said.unwrap().contains("taken to be in"));
            let far = bring(&own, &mut [here + 1e6, here + 1e6 + 10.0], &world);
            assert!(far.is_err(), "{crs:?}");
        }
    }
}
