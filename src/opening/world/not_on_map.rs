//! A surface whose file names a map's system although its coordinates are a model's own: programs that save a cloud anew keep the
//! system of the file that they opened, whatever was done to its points since.

use glam::DVec3;

use super::frame::WorldFrame;
use crate::geodesy::CrsKind;

/// Maps put their origin beside what they show: no place of one lies within so many metres of it along both axes.
const NEAR_ORIGIN: f64 = 5000.0;

/// That coordinates about `point` are none of the map that the file of a surface names, in words; `None` where they may be, or
/// it names none.
pub(crate) fn not_on_its_map(frame: &WorldFrame, point: DVec3) -> Option<String> {
    let is_near = point.truncate().abs().max_element() * frame.metres() < NEAR_ORIGIN;
    (frame.is(CrsKind::Projected) && is_near).then(|| {
        format!(
            "it names {}, but its points, about ({:.0}, {:.0}), are at that map's origin, where nothing is: they are taken to be in a frame \
             of their own (where they are in it all the same, say so as world.crs in a flight.toml)",
            frame.in_words(),
            point.x,
            point.y
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesy::Crs;

    #[test]
    fn a_models_own_numbers_are_no_place_of_a_map() {
        let named = |name: &str| WorldFrame::Named(Crs::understand(name).unwrap());
        let said = |frame: &WorldFrame, x: f64, y: f64| {
            not_on_its_map(frame, DVec3::new(x, y, 300.0)).is_some()
        };
        let utm = named("EPSG:32632");
        assert!(said(&utm, -12.0, 7.5));
        // A pile in UTM, one on the equator, and one at the edge of a zone.
        for (x, y) in [
            (452_309.0, 5_411_860.0),
            (500_000.0, 10.0),
            (166_021.0, 0.0),
        ] {
            assert!(!said(&utm, x, y));
        }
        // In feet: 5000 m are 16404 of them.
        assert!(said(&named("EPSG:2263"), 16_000.0, 16_000.0));
        assert!(!said(&named("EPSG:2263"), 17_000.0, 16_000.0));
        // Degrees and frames without a name are no maps.
        assert!(!said(&named("EPSG:4326"), 9.0, 48.0));
        assert!(!said(&WorldFrame::AsIs(None), 0.0, 0.0));
    }
}
