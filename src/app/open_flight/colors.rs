//! What the colours of the surface mean: their limits, and how the values are spread.

use std::sync::Arc;

use crate::flight::{Flight, Review};
use crate::geometry::LocalFrame;
use crate::jobs::Progress;
use crate::open_flight::OpenFlight;
use crate::render::{ColorBy, PhotoGeometry};
use crate::surface::Surface;

/// Columns of a histogram.
const COLUMNS: usize = 64;
/// Every so many-th of the values is looked at, so that these many are: enough for a histogram.
const LOOKED_AT: usize = 100_000;

/// What values are of: the way of colouring; for scales the photo; where surface and footprints lie in
/// memory.
type Of = (ColorBy, Option<usize>, usize, usize);

/// How values are spread.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// The values at its two ends: all but the extreme thousandths.
    pub ends: [f64; 2],
    /// The share of each column of equal width, of the highest one.
    pub columns: Vec<f64>,
    /// The limits of the colours where nobody sets others.
    pub usual: [f64; 2],
}

impl Histogram {
    /// Of values with their weights; `usual` are the shares of the values under the usual limits, or
    /// the limits themselves. `None` without values.
    fn of(mut values: Vec<(f64, f64)>, usual: Usual) -> Option<Self> {
        values.retain(|(value, weight)| value.is_finite() && *weight > 0.0);
        values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let last = values.len().checked_sub(1)?;
        // `as` is exact for so few.
        let at = |share: f64| values[(last as f64 * share) as usize].0;
        let (usual, ends) = match usual {
            Usual::Shares(shares) => (shares.map(at), [at(0.001), at(0.999)]),
            Usual::Limits(limits) => (limits, limits),
        };
        let [low, high] = ends;
        let width = ((high - low) / COLUMNS as f64).max(f64::MIN_POSITIVE);
        let mut columns = vec![0.0; COLUMNS];
        for (value, weight) in values {
            if (low..=high).contains(&value) {
                // `as` saturates.
                let column = ((value - low) / width) as usize;
                columns[column.min(COLUMNS - 1)] += weight;
            }
        }
        let most = columns.iter().copied().fold(0.0, f64::max);
        for column in &mut columns {
            *column /= most.max(f64::MIN_POSITIVE);
        }
        Some(Self {
            ends,
            columns,
            usual,
        })
    }
}

/// Where the colours end if nobody says otherwise, as the renderer has it.
enum Usual {
    /// At these shares of the values.
    Shares([f64; 2]),
    /// At these values.
    Limits([f64; 2]),
}

/// The limits of the colours, and what is known of their values.
#[derive(Debug, Default)]
pub struct Colors {
    /// For elevation, slope and scale, where somebody has set them: world units, degrees, pixels per
    /// world unit.
    limits: [Option<[f64; 2]>; 3],
    /// The values, as far as they were looked at.
    histogram: Option<(Of, Arc<Histogram>)>,
    /// What was asked for last.
    asked: Option<Of>,
}

fn place(by: ColorBy) -> Option<usize> {
    match by {
        ColorBy::Rgb => None,
        ColorBy::Elevation => Some(0),
        ColorBy::Slope => Some(1),
        ColorBy::Scale => Some(2),
    }
}

impl Colors {
    /// The limits that somebody has set.
    pub fn limits(&self, by: ColorBy) -> Option<[f64; 2]> {
        self.limits[place(by)?]
    }

    /// Sets them; what are no limits changes nothing.
    pub(crate) fn set(&mut self, by: ColorBy, limits: Option<[f64; 2]>) {
        let are_limits = |[low, high]: [f64; 2]| low.is_finite() && high.is_finite() && low < high;
        if let Some(place) = place(by)
            && limits.is_none_or(are_limits)
        {
            self.limits[place] = limits;
        }
    }

    /// Takes over the limits that were set of the same flight before it was read again.
    pub(crate) fn keep_limits(&mut self, before: &Self) {
        self.limits = before.limits;
    }

    /// How the values are spread, once they were looked at.
    pub fn histogram(&self, by: ColorBy) -> Option<&Histogram> {
        let (of, histogram) = self.histogram.as_ref()?;
        (of.0 == by).then_some(&**histogram)
    }

    pub(crate) fn take(&mut self, of: Of, histogram: Option<Histogram>) {
        if self.asked == Some(of) {
            self.histogram = histogram.map(|histogram| (of, Arc::new(histogram)));
        }
    }
}

/// What a job looks at.
pub(crate) struct ToLookAt {
    pub(crate) of: Of,
    flight: Arc<Flight>,
    photo: Option<PhotoGeometry>,
}

impl OpenFlight {
    /// The values that are to be looked at for this way of colouring; `None` where they are known or on
    /// their way.
    pub(crate) fn values_to_look_at(&mut self, by: ColorBy) -> Option<ToLookAt> {
        place(by)?;
        let of_photo = self.selected.filter(|_| by == ColorBy::Scale);
        let views = self.review.views().filter(|_| of_photo.is_some());
        let views = views.map_or(0, |views| Arc::as_ptr(views).addr());
        let flight = self.flight().clone();
        let surface = Arc::as_ptr(&flight.parts().surface).addr();
        let of = (by, of_photo, surface, views);
        if self.colors.asked == Some(of) {
            return None;
        }
        self.colors.asked = Some(of);
        let photo = of_photo.and_then(|photo| geometry(&self.extent.frame, &self.review, photo));
        Some(ToLookAt { of, flight, photo })
    }
}

fn geometry(frame: &LocalFrame, review: &Review, photo: usize) -> Option<PhotoGeometry> {
    let photo = review.photo(photo)?;
    let pose = &photo.photo.pose;
    let scale = photo.scale();
    Some(PhotoGeometry::new(
        frame,
        photo.camera,
        pose,
        scale,
        photo.view,
    ))
}

impl ToLookAt {
    /// Looks at the values: work for a thread.
    pub(crate) fn look(&self, progress: &Progress) -> Option<Histogram> {
        progress.stage("looking at the values");
        let surface = &self.flight.parts().surface;
        match self.of.0 {
            ColorBy::Rgb => None,
            ColorBy::Elevation => {
                let step = (surface.vertices().len() / LOOKED_AT).max(1);
                let heights = surface.vertices().step_by(step);
                let heights = heights.map(|vertex| (vertex.z, 1.0)).collect();
                Histogram::of(heights, Usual::Shares([0.01, 0.99]))
            }
            ColorBy::Slope => Histogram::of(slopes(surface)?, Usual::Limits([0.0, 90.0])),
            ColorBy::Scale => {
                let scales = self.photo.as_ref()?.scales();
                let scales = scales.map(|scale| (scale, 1.0)).collect();
                Histogram::of(scales, Usual::Shares([0.02, 0.98]))
            }
        }
    }
}

/// The triangles' angles to the horizontal in degrees, with their areas.
fn slopes(surface: &Surface) -> Option<Vec<(f64, f64)>> {
    let triangles = surface.triangles().ok()?;
    let vertices: Vec<_> = surface.vertices().collect();
    let step = (triangles.len() / LOOKED_AT).max(1);
    let slope = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|index| vertices[index as usize]);
        let normal = (b - a).cross(c - a);
        let angle = normal.truncate().length().atan2(normal.z.abs());
        (angle.to_degrees(), normal.length() * 0.5)
    };
    Some(triangles.iter().step_by(step).map(slope).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thousand and one values from 0 to 100: their hundredths are known; a column is 99.8 / 64 wide.
    #[test]
    fn a_histogram_of_even_values_is_even() {
        let values = (0..=1000).map(|i| (f64::from(i) / 10.0, 1.0)).collect();
        let found = Histogram::of(values, Usual::Shares([0.02, 0.98])).unwrap();
        assert_eq!(found.usual, [2.0, 98.0]);
        assert!((found.ends[0] - 0.1).abs() < 1e-9 && (found.ends[1] - 99.9).abs() < 1e-9);
        // 15 or 16 values in each.
        assert!(found.columns.iter().all(|share| *share >= 15.0 / 17.0));
        assert!(Histogram::of(Vec::new(), Usual::Shares([0.0, 1.0])).is_none());
        let level = Histogram::of(vec![(3.0, 1.0); 5], Usual::Shares([0.01, 0.99])).unwrap();
        assert_eq!(level.usual, [3.0, 3.0]);
    }

    #[test]
    fn weights_count_and_outliers_do_not() {
        let mut values = vec![(10.0, 1.0), (10.0, 3.0), (80.0, 2.0)];
        values.push((f64::NAN, 1.0));
        let found = Histogram::of(values, Usual::Limits([0.0, 90.0])).unwrap();
        let full: Vec<(usize, f64)> = (found.columns.iter().copied().enumerate())
            .filter(|(_, share)| *share > 0.0)
            .collect();
        // 10 of 90 in 64 columns is in column 7, 80 in column 56; 2 of 4 is a half.
        assert_eq!(full, [(7, 1.0), (56, 0.5)]);
    }

    #[test]
    fn what_are_no_limits_changes_nothing() {
        let mut colors = Colors::default();
        colors.set(ColorBy::Elevation, Some([1.0, 2.0]));
        for wrong in [[2.0, 2.0], [3.0, 1.0], [f64::NAN, 1.0]] {
            colors.set(ColorBy::Elevation, Some(wrong));
        }
        assert_eq!(colors.limits(ColorBy::Elevation), Some([1.0, 2.0]));
        assert_eq!(colors.limits(ColorBy::Slope), None);
        colors.set(ColorBy::Elevation, None);
        assert_eq!(colors.limits(ColorBy::Elevation), None);
    }
}
