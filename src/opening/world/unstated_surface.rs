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
    use crate::jobs::Progress;
    use crate::{OpenOptions, Opened, open_flight};

    /// A flight of one photo in UTM, over a cloud at this place that names no system.
    fn opened(east: f64, north: f64) -> Result<Opened, String> {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text).unwrap();
        };
        write(
            "flight.toml",
            "format = 1\nworld.unit = \"m\"\nsurface.file = \"pile.xyz\"\nphotos.poses = \"poses.csv\"\n\
             [[camera]]\nwidth = 4\nheight = 3\nfx = 4\nfy = 4\ncx = 2\ncy = 1.5\n",
        );
        write(
            "poses.csv",
            "photo,x,y,z,tilt,pan\na.jpg,500010,5000010,130,90,0\n",
        );
        write("poses.prj", "EPSG:32633");
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
}
