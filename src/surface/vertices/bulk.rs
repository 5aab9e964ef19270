//! The box around a surface's bulk: what is worth looking at. A sparse cloud has points far behind
//! what was photographed, because rays that meet at a small angle meet anywhere.

use glam::DVec3;

use crate::geometry::Bounds;

/// The share of points, at either end of an axis, that may be outliers.
const TAIL: f64 = 0.02;

/// They are outliers where they reach beyond the other points by so many times the size of these.
const FAR: f64 = 2.0;

/// What is left around those, in their size.
const MARGIN: f64 = 0.1;

/// So many points stand for all.
const SAMPLE: usize = 200_000;

/// The box around all of these points but outliers, as [`Surface::bulk_bounds`](crate::surface::Surface::bulk_bounds);
/// `None` without points.
pub fn bulk_of(points: &[DVec3]) -> Option<Bounds> {
    Some(bulk(points.iter().copied(), Bounds::of(points)?))
}

/// The box around all points but the outliers; `whole` is the box around all. Without outliers it is
/// `whole`, to the last bit.
pub(super) fn bulk(points: impl ExactSizeIterator<Item = DVec3>, whole: Bounds) -> Bounds {
    let step = points.len().div_ceil(SAMPLE).max(1);
    let sample: Vec<DVec3> = points.step_by(step).collect();
    let axes = [|p: DVec3| p.x, |p: DVec3| p.y, |p: DVec3| p.z];
    let inner = axes.map(|along| {
        let mut values: Vec<f64> = sample.iter().map(|&point| along(point)).collect();
        // `as` saturates; at most a fiftieth of the length.
        let tail = (values.len() as f64 * TAIL) as usize;
        let last = values.len().checked_sub(tail + 1)?;
        let low = *values.select_nth_unstable_by(tail, f64::total_cmp).1;
        let high = *values.select_nth_unstable_by(last, f64::total_cmp).1;
        Some((low, high))
    });
    let [Some(x), Some(y), Some(z)] = inner else {
        return whole;
    };
    let size = [x, y, z]
        .into_iter()
        .fold(0.0, |size: f64, (low, high)| size.max(high - low));
    let cut = |(low, high): (f64, f64), least: f64, most: f64| {
        let (far, margin) = (FAR * size, MARGIN * size);
        (
            if low - least > far {
                low - margin
            } else {
                least
            },
            if most - high > far {
                high + margin
            } else {
                most
            },
        )
    };
    let (x, y, z) = (
        cut(x, whole.min.x, whole.max.x),
        cut(y, whole.min.y, whole.max.y),
        cut(z, whole.min.z, whole.max.z),
    );
    Bounds {
        min: DVec3::new(x.0, y.0, z.0),
        max: DVec3::new(x.1, y.1, z.1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 21 x 21 points, 20 wide, and others.
    fn around(others: &[DVec3]) -> (Bounds, Bounds) {
        let square = (0..441).map(|i| DVec3::new(f64::from(i % 21), f64::from(i / 21), 5.0));
        let points: Vec<DVec3> = square.chain(others.iter().copied()).collect();
        let whole = Bounds::of(&points).unwrap();
        (bulk(points.into_iter(), whole), whole)
    }

    #[test]
    fn outliers_are_left_out() {
        let others = [DVec3::new(900.0, 10.0, 5.0), DVec3::new(10.0, 8.0, -700.0)];
        let (found, whole) = around(&others);
        assert_eq!(whole.max.x, 900.0);
        // Two of a hundred at the end of x are those with x 20; 2 is a tenth of 20.
        assert_eq!(found.max.x, 22.0);
        assert_eq!((found.min.x, found.min.y, found.max.y), (0.0, 0.0, 20.0));
        assert_eq!((found.min.z, found.max.z), (3.0, 5.0));
    }

    #[test]
    fn what_belongs_to_it_stays() {
        // A mast on flat ground, and ground that goes on.
        let (found, whole) = around(&[DVec3::new(10.0, 10.0, 40.0), DVec3::new(55.0, 0.0, 5.0)]);
        assert_eq!(found, whole);
        assert_eq!(around(&[]).0, around(&[]).1);
        // Too few to say which of them are outliers.
        let few = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::splat(1e6)];
        let whole = Bounds::of(&few).unwrap();
        assert_eq!(bulk(few.into_iter(), whole), whole);
        assert_eq!(bulk([].into_iter(), whole), whole);
        let at_one_place = Bounds::of(&[DVec3::ONE]).unwrap();
        let points = [DVec3::ONE; 500];
        assert_eq!(bulk(points.into_iter(), at_one_place), at_one_place);
    }
}
