//! Two known positions that have each other's coordinates: named, where the others cannot say it by outvoting them.

use glam::DVec3;

use super::Known;
use crate::georeference::similarity_of;

/// More positions outvote two that are wrong.
const MOST: usize = 12;
/// How many times better all have to fit once two are exchanged, better than as they are and than with any other two.
const BETTER: f64 = 5.0;

/// The names of the two of `known` with which exchanged all fit well, and only these two.
pub(in crate::georeferencing) fn exchanged<'a>(known: &[&'a Known]) -> Option<[&'a str; 2]> {
    if !(3..=MOST).contains(&known.len()) {
        return None;
    }
    // Coordinates of the Earth would eat the digits.
    let middle = known.iter().map(|known| known.pair.target).sum::<DVec3>() / known.len() as f64;
    let sources: Vec<DVec3> = known.iter().map(|known| known.pair.source).collect();
    let mut targets: Vec<DVec3> = (known.iter())
        .map(|known| known.pair.target - middle)
        .collect();
    let as_they_are = off(&sources, &targets)?;
    let mut found = Vec::new();
    for one in 0..targets.len() {
        for other in 0..one {
            targets.swap(one, other);
            found.extend(off(&sources, &targets).map(|off| (off, [other, one])));
            targets.swap(one, other);
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (best, two) = *found.first()?;
    let next = found.get(1).map_or(f64::INFINITY, |next| next.0);
    (best * BETTER < as_they_are.min(next)).then(|| two.map(|index| known[index].name.as_str()))
}

/// The summed squares' root of what the positions are off their fit.
fn off(sources: &[DVec3], targets: &[DVec3]) -> Option<f64> {
    let pairs: Vec<_> = (sources.iter().zip(targets))
        .map(|(source, target)| (*source, *target, 1.0))
        .collect();
    let fit = similarity_of(&pairs)?;
    let squares: f64 = (pairs.iter())
        .map(|(source, target, _)| target.distance_squared(fit.apply(*source)))
        .sum();
    Some(squares.sqrt())
}
