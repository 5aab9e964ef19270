//! Which ground is to be photographed: a polygon, or the pile found by itself.

use glam::{DVec2, DVec3};

use super::terrain::{Terrain, plane_through};
use crate::fault::Fault;
use crate::geometry::median;
use crate::jobs::Progress;
use crate::numbers::significant_digits;
use crate::surface::{Surface, UpAxis, convex_hull};
use crate::survey::Polygon;

/// Pixels along the longer side of the raster that the pile is looked for on.
const ACROSS: f64 = 200.0;
/// Stones and bridges between them are no pile: a pixel is where most of the pixels up to so far along both axes are.
const BESIDE: usize = 4;
/// The share of the surface's pixels that count as its rim: where the floor is looked for.
const RIM: f64 = 0.15;
/// What stands above the floor by so many standard deviations of the floor is no floor.
const STANDS_OUT: f64 = 3.0;
/// The least share of the surface that stands out, or it is a stone.
const LEAST: f64 = 0.005;
/// What stands above the floor by so much of the pile's height is pile; 98 of 100 of the pixels that stand out are
/// lower than that.
const PILE: f64 = 0.1;
/// The share of its height that ground is not thinner than along x or y.
const LYING: f64 = 0.5;
/// So many points tell a median well enough.
const MOST_HEIGHTS: usize = 100_000;
/// How often what stands out of the floor is taken away from it.
const ROUNDS: usize = 6;

/// The outline of the pile: the convex hull of the largest piece of the surface that stands above the floor around
/// it. The floor is the plane that lies best under the rim of the surface.
///
/// # Errors
/// Where nothing stands out; where the surface cannot be triangulated, or the work was cancelled.
pub fn pile(surface: &Surface, progress: &Progress) -> Result<Polygon, Fault> {
    let bounds = surface.bulk_bounds();
    let size = bounds.size().truncate().max_element();
    let over = [bounds.min.truncate(), bounds.max.truncate()];
    let terrain = Terrain::of(surface, over, size / ACROSS, None, progress)?;
    let none = || {
        let what = "no pile stands out of the floor around it";
        match lying(surface) {
            Some(words) => Fault::new(
                format!("{what}; {words}"),
                "turn it, or draw the area (--area on the command line)",
            ),
            None => Fault::new(what, "draw the area (--area on the command line)"),
        }
    };
    let floor = floor(&terrain).ok_or_else(none)?;
    let raster = terrain.raster();
    let columns = raster.columns as usize;
    let above: Vec<f64> = (0..raster.rows)
        .flat_map(|row| (0..raster.columns).map(move |column| (column, row)))
        .map(|(column, row)| {
            let point = terrain.point(column, row);
            point.map_or(f64::NAN, |point| point.z - floor.at(point.truncate()))
        })
        .collect();
    let stands_out = STANDS_OUT * floor.roughness;
    let known = above.iter().filter(|z| !z.is_nan()).count();
    let mut sorted: Vec<f64> = (above.iter().copied())
        .filter(|z| *z > stands_out.max(1e-9 * size))
        .collect();
    sorted.sort_by(f64::total_cmp);
    if (sorted.len() as f64) < LEAST * known as f64 {
        return Err(none());
    }
    let highest = sorted.get(sorted.len() * 98 / 100).copied();
    let highest = highest.ok_or_else(none)?;
    let is_pile: Vec<bool> = above
        .iter()
        .map(|z| *z > (PILE * highest).max(stands_out))
        .collect();
    let piece = largest_piece(&where_most_are(&is_pile, columns), columns);
    if (piece.len() as f64) < LEAST * known as f64 {
        return Err(none());
    }
    let middles: Vec<DVec3> = piece
        .iter()
        .map(|place| {
            let (column, row) = (place % columns, place / columns);
            let middle = DVec2::new(column as f64, row as f64) + 0.5;
            raster.world_from_pixel(middle).extend(0.0)
        })
        .collect();
    let hull = convex_hull(&middles);
    let corners: Vec<DVec2> = hull.iter().map(|corner| corner.truncate()).collect();
    Polygon::new(&corners).map_err(|_| none())
}

/// Ground is wider than high. What is said of a surface that is much thinner along another axis than along z: a file whose
/// up is that axis, or a wall. `None` of ground.
pub fn lying(surface: &Surface) -> Option<String> {
    let size = surface.bulk_bounds().size();
    let (axis, thinnest) = match size.x < size.y {
        true => (UpAxis::X, size.x),
        false => (UpAxis::Y, size.y),
    };
    (thinnest < LYING * size.z).then(|| {
        let (axis, high) = (axis.name(), significant_digits(size.z, 2));
        let thin = significant_digits(thinnest, 2);
        format!(
            "the surface is {high} high and {thin} along {axis}: where {axis} is up in its file, write up = \"{axis}\" below [surface] in a flight.toml, or --up {axis} behind the command (a wall looks the same)"
        )
    })
}

/// A plane that is nearly level.
struct Floor {
    from: DVec2,
    /// Height there, and its growth to the east and to the north.
    z: DVec3,
    /// Standard deviation of what it was found from.
    roughness: f64,
}

impl Floor {
    fn at(&self, place: DVec2) -> f64 {
        let off = place - self.from;
        self.z.x + self.z.y * off.x + self.z.z * off.y
    }
}

/// The plane under the rim of the surface: fitted to the outermost pixels again and again, without those that stand
/// more than two standard deviations above it.
fn floor(terrain: &Terrain) -> Option<Floor> {
    let raster = terrain.raster();
    let [min, max] = raster.bounds();
    let from = (min + max) / 2.0;
    let half = (max - min) / 2.0;
    let mut points: Vec<(f64, DVec3)> = (terrain.points())
        .map(|point| {
            let off = ((point.truncate() - from) / half).abs().max_element();
            (off, point)
        })
        .collect();
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    // `as` saturates; a share of the length.
    let rim = (points.len() as f64 * RIM).ceil() as usize;
    let mut rim: Vec<DVec3> = points
        .into_iter()
        .take(rim)
        .map(|(_, point)| point)
        .collect();
    let base = rim.first()?.z;
    let mut floor = None;
    for _ in 0..ROUNDS {
        let Some((z, _)) = plane_through(rim.iter().copied(), from.extend(base), half) else {
            break;
        };
        let mut found = Floor {
            from,
            z: DVec3::new(base + z.x, z.y / half.x, z.z / half.y),
            roughness: 0.0,
        };
        let off = |point: &DVec3| point.z - found.at(point.truncate());
        let sum: f64 = rim.iter().map(|point| off(point).powi(2)).sum();
        let roughness = (sum / rim.len() as f64).sqrt();
        let kept: Vec<DVec3> = (rim.iter().copied())
            .filter(|point| off(point) <= 2.0 * roughness)
            .collect();
        found.roughness = roughness;
        floor = Some(found);
        rim = kept;
    }
    floor
}

/// Pixels in whose neighbourhood most pixels are in.
fn where_most_are(is_in: &[bool], columns: usize) -> Vec<bool> {
    let rows = is_in.len() / columns.max(1);
    let around = |at: usize, count: usize| at.saturating_sub(BESIDE)..(at + BESIDE + 1).min(count);
    (0..is_in.len())
        .map(|place| {
            let (columns_near, rows_near) = (
                around(place % columns, columns),
                around(place / columns, rows),
            );
            let size = columns_near.len() * rows_near.len();
            let near = rows_near.flat_map(|row| &is_in[row * columns..][columns_near.clone()]);
            2 * near.filter(|near| **near).count() > size
        })
        .collect()
}

/// The pixels of the largest piece whose pixels touch along their sides.
fn largest_piece(is_in: &[bool], columns: usize) -> Vec<usize> {
    let mut seen = vec![false; is_in.len()];
    let mut largest = Vec::new();
    for start in 0..is_in.len() {
        if !is_in[start] || seen[start] {
            continue;
        }
        seen[start] = true;
        let mut piece = vec![start];
        let mut next = 0;
        while let Some(&place) = piece.get(next) {
            next += 1;
            let column = place % columns;
            let neighbours = [
                (column > 0).then(|| place - 1),
                (column + 1 < columns).then_some(place + 1),
                place.checked_sub(columns),
                Some(place + columns).filter(|place| *place < is_in.len()),
            ];
            for place in neighbours.into_iter().flatten() {
                if is_in[place] && !seen[place] {
                    seen[place] = true;
                    piece.push(place);
                }
            }
        }
        if piece.len() > largest.len() {
            largest = piece;
        }
    }
    largest
}

/// The median heights of the surface's points in an area and outside of it: a terrace behind a crest may be taken for a pile. `None`
/// where one of both has none.
pub fn heights_in_and_about(surface: &Surface, area: &Polygon) -> Option<[f64; 2]> {
    let points = surface.vertices();
    let step = (points.len() / MOST_HEIGHTS).max(1);
    let (mut within, mut about) = (Vec::new(), Vec::new());
    for point in points.step_by(step) {
        let place = point.truncate();
        match area.distance_to_leg(place, place) <= 0.0 {
            true => within.push(point.z),
            false => about.push(point.z),
        }
    }
    Some([median(&mut within)?, median(&mut about)?])
}

/// The same for people.
pub fn heights_in_words([within, about]: [f64; 2], unit: &str) -> String {
    format!("at heights about {within:.1} {unit} where all else is about {about:.1} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Cloud;

    /// A cone of radius 10 and height 5 at (1003, 2001) on a floor that falls to the east by 2 in 100.
    #[test]
    fn a_cone_on_a_slope_is_found() {
        let middle = DVec2::new(1003.0, 2001.0);
        let points = (0..101 * 101).map(|i| {
            let place = DVec2::new(f64::from(i % 101), f64::from(i / 101)) * 0.8 - 40.0 + middle;
            let cone = (5.0 - 0.5 * place.distance(middle + 2.0)).max(0.0);
            place.extend(100.0 - 0.02 * (place.x - middle.x) + cone)
        });
        let cloud = Cloud {
            points: points.collect(),
            ..Cloud::default()
        };
        let surface = Surface::new(cloud).unwrap();
        let found = pile(&surface, &Progress::default()).unwrap();
        // A tenth of the height is cut off all around, so nine tenths of the radius are left, to a pixel of 0.4.
        for corner in found.corners() {
            let radius = corner.distance(middle + 2.0);
            assert!((radius - 9.0).abs() < 0.9, "{radius}");
        }
        let area = std::f64::consts::PI * 81.0;
        assert!((found.area() / area - 1.0).abs() < 0.08, "{}", found.area());
        // Half of its area lies within 9 / sqrt(2) of its middle: 5 - 0.5 * 6.36 above a floor of 99.96 there, and of 100 elsewhere.
        let [within, about] = heights_in_and_about(&surface, &found).unwrap();
        assert!((within - 101.78).abs() < 0.1, "{within}");
        assert!((about - 100.0).abs() < 0.02, "{about}");
        assert_eq!(
            heights_in_words([within, about], "m"),
            "at heights about 101.8 m where all else is about 100.0 m"
        );
    }

    /// A pile whose file has y up lies on its side: that is said, and what to write; of the pile itself nothing is.
    #[test]
    fn what_lies_on_its_side_is_said() {
        let cone = |turned: bool| {
            let points = (0..61 * 61).map(|i| {
                let place = DVec2::new(f64::from(i % 61), f64::from(i / 61)) - 30.0;
                let z = (6.0 - 0.5 * place.length()).max(0.0);
                match turned {
                    true => DVec3::new(place.x, z, -place.y),
                    false => place.extend(z),
                }
            });
            let cloud = Cloud {
                points: points.collect(),
                ..Cloud::default()
            };
            Surface::new(cloud).unwrap()
        };
        assert_eq!(lying(&cone(false)), None);
        let said = lying(&cone(true)).unwrap();
        assert!(said.contains("up = \"y\""), "{said}");
    }

    #[test]
    fn a_floor_alone_has_no_pile() {
        let points = (0..400).map(|i| {
            let bump = f64::from((i * 7919) % 13) * 0.01;
            DVec3::new(f64::from(i % 20), f64::from(i / 20), bump)
        });
        let cloud = Cloud {
            points: points.collect(),
            ..Cloud::default()
        };
        let surface = Surface::new(cloud).unwrap();
        let fault = pile(&surface, &Progress::default()).unwrap_err();
        assert!(fault.what.contains("no pile"), "{fault}");
    }
}
