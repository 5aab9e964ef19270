//! Thinning: one point of each square cell over (x, y).

use glam::{DVec2, DVec3};

use super::SurfaceError;

/// A point and what decides whether it stays.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    /// Whole numbers, kept as f64 because they may be large.
    cell: DVec2,
    /// From the cell's middle, squared.
    distance: f64,
    z: f64,
    index: u32,
}

/// Keeps of the points (world, finite) in each square cell of `size` the one nearest to the cell's
/// middle, of equally near ones the highest, of equally high ones the first. Cells lie at whole
/// multiples of `size`. What stays keeps its order and its colour, where there are any.
///
/// # Errors
/// With more points than u32 counts.
pub(super) fn thin(
    points: &mut Vec<DVec3>,
    colors: &mut Vec<[u8; 3]>,
    size: f64,
) -> Result<(), SurfaceError> {
    if u32::try_from(points.len()).is_err() {
        return Err(SurfaceError::TooManyPoints(points.len()));
    }
    let mut candidates: Vec<Candidate> = (0..)
        .zip(points.iter())
        .map(|(index, point)| {
            let place = point.truncate();
            // + 0: of -0 and 0 only 0 is left, so that they are one cell.
            let cell = (place / size).floor() + 0.0;
            Candidate {
                cell,
                distance: place.distance_squared((cell + 0.5) * size),
                z: point.z,
                index,
            }
        })
        .collect();
    candidates.sort_unstable_by(|a, b| {
        (a.cell.y.total_cmp(&b.cell.y))
            .then(a.cell.x.total_cmp(&b.cell.x))
            .then(a.distance.total_cmp(&b.distance))
            .then(b.z.total_cmp(&a.z))
            .then(a.index.cmp(&b.index))
    });
    candidates.dedup_by(|b, a| a.cell == b.cell);
    let mut kept: Vec<u32> = candidates.into_iter().map(|c| c.index).collect();
    kept.sort_unstable();
    if !colors.is_empty() {
        *colors = kept.iter().map(|&i| colors[i as usize]).collect();
    }
    *points = kept.iter().map(|&i| points[i as usize]).collect();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thinned(points: &[(f64, f64, f64)], size: f64) -> Vec<f64> {
        let mut points: Vec<DVec3> = points.iter().map(|&p| p.into()).collect();
        let mut colors: Vec<[u8; 3]> = points.iter().map(|p| [p.z as u8, 0, 0]).collect();
        thin(&mut points, &mut colors, size).unwrap();
        let reds: Vec<u8> = points.iter().map(|p| p.z as u8).collect();
        assert_eq!(colors.iter().map(|c| c[0]).collect::<Vec<_>>(), reds);
        points.iter().map(|p| p.z).collect()
    }

    /// Cells of 2: (0.9, 1.2) is nearest to the middle (1, 1) of its cell; (2, 0) begins the next
    /// cell, and (-0.1, 0.1) ends the one before.
    #[test]
    fn the_point_nearest_to_the_middle_stays() {
        let points = [
            (0.1, 0.1, 1.0),
            (0.9, 1.2, 2.0),
            (2.0, 0.0, 3.0),
            (-0.1, 0.1, 4.0),
            (1.9, 1.9, 5.0),
        ];
        assert_eq!(thinned(&points, 2.0), [2.0, 3.0, 4.0]);
    }

    #[test]
    fn of_equally_near_points_the_highest_stays() {
        let points = [(0.5, 1.0, 7.0), (1.5, 1.0, 9.0), (1.0, 0.5, 8.0)];
        assert_eq!(thinned(&points, 2.0), [9.0]);
    }

    /// What stays in a part of the cloud does not depend on the rest of it, nor on the order.
    #[test]
    fn the_extent_and_the_order_do_not_matter() {
        let mut points: Vec<(f64, f64, f64)> = (0..200)
            .map(|i| {
                let i = f64::from(i);
                ((i * 0.37) % 10.0 + 500_000.0, (i * 0.73) % 10.0, i)
            })
            .collect();
        let mut one = thinned(&points, 3.0);
        points.reverse();
        let mut other = thinned(&points, 3.0);
        points.push((499_000.0, -300.0, 250.0));
        let more = thinned(&points, 3.0);
        assert_eq!(more[..more.len() - 1], other);
        one.sort_by(f64::total_cmp);
        other.sort_by(f64::total_cmp);
        assert_eq!(one, other);
        // Point by point: it stays if no other of its cell is nearer to the middle.
        let place = |p: &(f64, f64, f64)| DVec2::new(p.0, p.1);
        let cell = |p: &(f64, f64, f64)| (place(p) / 3.0).floor();
        let away = |p: &(f64, f64, f64)| place(p).distance(cell(p) * 3.0 + 1.5);
        let beaten = |p: &(f64, f64, f64)| {
            points
                .iter()
                .any(|q| cell(p) == cell(q) && away(q) < away(p))
        };
        let mut expected: Vec<f64> = points.iter().filter(|p| !beaten(p)).map(|p| p.2).collect();
        expected.retain(|&z| z < 200.0);
        expected.sort_by(f64::total_cmp);
        assert_eq!(one, expected);
    }
}
