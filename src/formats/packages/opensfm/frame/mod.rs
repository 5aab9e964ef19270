//! Which of two frames a `reconstruction.json` is in, told by what it holds itself.
//!
//! Written from OpenSfM's `opensfm/align.py` and OpenDroneMap's `opendm/osfm.py`
//! (`write_reference_lla`), `opendm/location.py`, `stages/run_opensfm.py` and, in its copy of OpenSfM,
//! `opensfm/actions/export_geocoords.py`.
//!
//! - OpenSfM solves east, north, up at `reference_lla`. A shot's gps_position is in that frame.
//! - OpenDroneMap (since February 2021) maps the shots' poses and the points to its zone of UTM on
//!   WGS 84, less an offset in whole metres, and writes the result over `reconstruction.json`. The map
//!   is affine: the projection's derivative at the reference. Every gps_position stays as it was.
//!   Since July 2021 the offset is also the reference, at height 0.
//!
//! So the two readings differ by the convergence of the meridians, up to several degrees, and by the
//! projection's scale, and the positions tell which one it is: camera centres are turned and scaled
//! against gps_position by nothing, or by just that. OpenSfM aligns with least squares, from the
//! centres to the positions, so this fit comes out exactly (1e-8 where the receivers were metres off),
//! unless control points or the adjustment pulled it away; then the fit's own scatter says what can be
//! told.

use glam::{DMat2, DVec2, DVec3};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::geodesy::{Crs, Geographic, ecef_from_geographic, enu_axes, geographic_from_ecef};
use crate::geometry::median;

/// How far, in metres, an offset in whole metres may be from them: degrees are written to 1e-9 m.
const WHOLE: f64 = 1e-3;

/// The same where the offset is found from the positions themselves.
const WHOLE_BY_POSITIONS: f64 = 0.01;

/// The part of the readings' difference within which a fit is one of them, whatever its scatter.
const SAME: f64 = 0.1;

/// How far, in metres, the positions may be off as a whole: no receiver errs so much for all photos.
const MOST_SHIFT: f64 = 30.0;

/// A difference of the readings, relative, that no scale shows.
const NEGLIGIBLE: f64 = 1e-3;

/// How sure the rejection of a reading must be.
const CONFIDENCE: f64 = 0.999;

/// What other signs than the positions say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Hint {
    /// Nothing.
    None,
    /// OpenDroneMap's name for what OpenSfM solved.
    Topocentric,
    /// Files beside that OpenDroneMap writes with the projected coordinates.
    Projected,
}

/// The frame that was found.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Frame {
    /// East, north, up at the reference.
    Topocentric,
    /// Coordinates of this system, less this offset.
    Projected { crs: String, offset: DVec2 },
    /// Not known where on the Earth.
    Unknown,
}

/// Tells the frame by `pairs`, what the receiver said (east, north, up at `origin`) and the camera
/// centre of each photo that has both. Returns a sentence where anything suggests that it is not what
/// OpenSfM writes.
pub(super) fn frame_of(
    pairs: &[(DVec3, DVec3)],
    origin: Geographic,
    hint: Hint,
) -> (Frame, Option<String>) {
    let Some(projection) = Projection::at(origin) else {
        return (Frame::Topocentric, None);
    };
    let whole = projection.offset;
    let name = &projection.name;
    let pairs: Vec<Pair> = pairs
        .iter()
        .map(|&(measured, center)| Pair {
            topocentric: measured.truncate(),
            projected: projection.grid_from_enu * measured.truncate(),
            center: center.truncate(),
        })
        .collect();
    let [of_enu, of_grid] = [|pair: &Pair| pair.topocentric, |pair: &Pair| pair.projected]
        .map(|predicted| Misfit::of(&pairs, predicted));
    let grid = |offset: DVec2| format!("{name} less {:.0} {:.0}", offset.x, offset.y);
    match projection.evidence(&pairs, &of_enu, &of_grid) {
        Evidence::Topocentric => {
            let said = (whole.is_some() || hint == Hint::Projected).then(|| {
                format!(
                    "it is taken to be east, north, up at its reference, which fits the photos' GPS positions to {}; {name} less an offset, which OpenDroneMap writes, misfits by {}",
                    of_enu.in_words(),
                    of_grid.in_words()
                )
            });
            (Frame::Topocentric, said)
        }
        Evidence::Projected => {
            let by_positions = projection.reference - of_grid.shift;
            let offset = whole.or_else(|| whole_metres(by_positions, WHOLE_BY_POSITIONS));
            let fits = format!(
                "that fits the photos' GPS positions to {}; east, north, up at its reference, as OpenSfM has it, misfits by {}",
                of_grid.in_words(),
                of_enu.in_words()
            );
            let Some(offset) = offset else {
                let said = format!(
                    "OpenDroneMap has put projected coordinates ({name}) less an offset into it: {fits}; the offset is not known, open the project's folder to have them in the world"
                );
                return (Frame::Unknown, Some(said));
            };
            let said = format!(
                "it is taken to be {}, as OpenDroneMap writes it: {fits}",
                grid(offset)
            );
            let crs = name.clone();
            (Frame::Projected { crs, offset }, Some(said))
        }
        Evidence::Neither => {
            let said = format!(
                "where it stands on the Earth is not known: the photos' GPS positions fit neither east, north, up at its reference, as OpenSfM has it (off by {}), nor {name} less an offset, as OpenDroneMap has it (off by {}); give its coordinates in the world (fragscale georeference)",
                of_enu.in_words(),
                of_grid.in_words()
            );
            (Frame::Unknown, Some(said))
        }
        Evidence::None => match (hint, whole) {
            (Hint::Topocentric, _) | (Hint::None, None) => (Frame::Topocentric, None),
            (Hint::Projected, None) => {
                let said = "OpenDroneMap has put projected coordinates less an offset into it; open \
                            the project's folder to have them in the world";
                (Frame::Unknown, Some(said.to_owned()))
            }
            (Hint::Projected, Some(offset)) => {
                let said = format!(
                    "it is taken to be {}, as OpenDroneMap writes it: the files beside it and its reference, which is in whole metres there, say so",
                    grid(offset)
                );
                let crs = name.clone();
                (Frame::Projected { crs, offset }, Some(said))
            }
            (Hint::None, Some(offset)) => {
                let difference = projection.difference();
                if difference < NEGLIGIBLE {
                    let said = format!(
                        "it is taken to be {}, as OpenDroneMap writes it, because its reference is in whole metres there; east, north, up at its reference differs by {:.2} % only",
                        grid(offset),
                        100.0 * difference
                    );
                    let crs = name.clone();
                    return (Frame::Projected { crs, offset }, Some(said));
                }
                let why = match pairs.len() {
                    0 => "it has no GPS positions that tell".to_owned(),
                    count => format!(
                        "the GPS positions of its {count} photos do not tell (off by {} and {})",
                        of_grid.in_words(),
                        of_enu.in_words()
                    ),
                };
                let said = format!(
                    "where it stands on the Earth is not known: its reference is in whole metres of {name}, as OpenDroneMap sets it, so it may be {} or, as OpenSfM has it, east, north, up at its reference, and {why}; open the project's folder, or give its coordinates in the world (fragscale georeference)",
                    grid(offset)
                );
                (Frame::Unknown, Some(said))
            }
        },
    }
}

/// A photo's position, in the horizontal plane of either reading, and its camera centre.
struct Pair {
    topocentric: DVec2,
    projected: DVec2,
    center: DVec2,
}

/// What the positions say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Evidence {
    Topocentric,
    Projected,
    Neither,
    /// Nothing for sure.
    None,
}

/// The zone of UTM that OpenDroneMap takes.
struct Projection {
    name: String,
    /// Where the reference is in it.
    reference: DVec2,
    /// The same where it is in whole metres: OpenDroneMap's offset.
    offset: Option<DVec2>,
    /// The derivative at the reference, from east and north in metres.
    grid_from_enu: DMat2,
}

impl Projection {
    /// That in whose whole metres the reference is: the zone of the reference, or the one beside
    /// it, because OpenDroneMap takes the first photo's. Else that of the reference.
    fn at(origin: Geographic) -> Option<Self> {
        let zones = [0.0, -6.0, 6.0].map(|east| {
            Self::of(
                Crs::utm_at(Geographic {
                    longitude: origin.longitude + east,
                    ..origin
                }),
                origin,
            )
        });
        let is_whole =
            |zone: &Option<Self>| zone.as_ref().is_some_and(|zone| zone.offset.is_some());
        let whole = zones.iter().position(is_whole).unwrap_or_default();
        zones.into_iter().nth(whole)?
    }

    fn of(crs: Crs, origin: Geographic) -> Option<Self> {
        let (center, axes) = (ecef_from_geographic(origin), enu_axes(origin));
        let at = |point: DVec3| {
            let place = geographic_from_ecef(center + axes * point)?;
            Some(crs.from_geographic(place)?.truncate())
        };
        let reference = crs.from_geographic(origin)?.truncate();
        Some(Self {
            name: crs.name().to_owned(),
            reference,
            offset: whole_metres(reference, WHOLE),
            grid_from_enu: DMat2::from_cols(
                at(DVec3::X)? - at(DVec3::ZERO)?,
                at(DVec3::Y)? - at(DVec3::ZERO)?,
            ),
        })
    }

    /// By how much of a length the readings differ.
    fn difference(&self) -> f64 {
        (self.grid_from_enu.x_axis - DVec2::X).length()
    }

    fn evidence(&self, pairs: &[Pair], of_enu: &Misfit, of_grid: &Misfit) -> Evidence {
        let Some(fit) = Fit::of(&pairs.iter().collect::<Vec<_>>()) else {
            return Evidence::None;
        };
        let mut evidence = self.evidence_of(&fit, true);
        // A few photos that are far off must not hide what the others say.
        if matches!(evidence, Evidence::None | Evidence::Neither) {
            let better = if of_enu.distance <= of_grid.distance {
                of_enu
            } else {
                of_grid
            };
            let kept = better.without_outliers(pairs);
            if kept.len() < pairs.len()
                && 2 * kept.len() > pairs.len()
                && let Some(fit) = Fit::of(&kept)
            {
                evidence = self.evidence_of(&fit, false);
            }
        }
        let is_near = |misfit: &Misfit| misfit.shift.length() <= MOST_SHIFT;
        match evidence {
            Evidence::Topocentric if !is_near(of_enu) => Evidence::Neither,
            // Else the offset is another one than the reference.
            Evidence::Projected if self.offset.is_some() && !is_near(of_grid) => Evidence::Neither,
            evidence => evidence,
        }
    }

    /// `is_whole`: whether the fit is over all photos, as OpenSfM's own alignment is.
    fn evidence_of(&self, fit: &Fit, is_whole: bool) -> Evidence {
        // The positions are those of `topocentric`, the fit leads from the centres to them.
        let of_grid = self.grid_from_enu.x_axis;
        let expected = DVec2::new(of_grid.x, -of_grid.y) / of_grid.length_squared();
        let readings = [
            (fit.turn.distance(DVec2::X), Evidence::Topocentric),
            (fit.turn.distance(expected), Evidence::Projected),
        ];
        let [(near, reading), (far, _)] = if readings[0].0 <= readings[1].0 {
            readings
        } else {
            [readings[1], readings[0]]
        };
        if is_whole && near <= SAME * self.difference() {
            return reading;
        }
        let Some(limit) = fit.limit() else {
            return Evidence::None;
        };
        match (near > limit, far > limit) {
            (true, _) => Evidence::Neither,
            (false, true) if far >= 2.0 * near => reading,
            _ => Evidence::None,
        }
    }
}

/// A place in whole metres, if it is there to within `tolerance`.
fn whole_metres(place: DVec2, tolerance: f64) -> Option<DVec2> {
    let whole = place.round();
    ((place - whole).abs().max_element() <= tolerance).then_some(whole)
}

/// The turn and scale that lead from the camera centres to the measured positions, by least squares.
struct Fit {
    /// scale (cos, sin) of the turn.
    turn: DVec2,
    /// Its standard error in either coordinate; `None` where there are no more photos than needed.
    error: Option<f64>,
    degrees_of_freedom: usize,
}

impl Fit {
    fn of(pairs: &[&Pair]) -> Option<Self> {
        let residuals = Residuals::of(pairs)?;
        let degrees_of_freedom = (2 * pairs.len()).checked_sub(4)?;
        let squares: f64 = residuals.lengths.iter().map(|length| length * length).sum();
        let error = (degrees_of_freedom > 0)
            .then(|| (squares / degrees_of_freedom as f64 / residuals.spread).sqrt());
        Some(Self {
            turn: residuals.turn,
            error,
            degrees_of_freedom,
        })
    }

    /// How far from the true turn and scale it hardly ever is.
    fn limit(&self) -> Option<f64> {
        let distribution = FisherSnedecor::new(2.0, self.degrees_of_freedom as f64).ok()?;
        let limit = self.error? * (2.0 * distribution.inverse_cdf(CONFIDENCE)).sqrt();
        limit.is_finite().then_some(limit)
    }
}

/// What the fit leaves of every photo.
struct Residuals {
    turn: DVec2,
    /// The sum of the squared distances of the centres from their mean.
    spread: f64,
    lengths: Vec<f64>,
}

impl Residuals {
    /// `None` where the centres are all in one place, or there are fewer than two.
    fn of(pairs: &[&Pair]) -> Option<Self> {
        let count = pairs.len() as f64;
        let center = pairs.iter().map(|pair| pair.center).sum::<DVec2>() / count;
        let measured = pairs.iter().map(|pair| pair.topocentric).sum::<DVec2>() / count;
        let from_middle: Vec<(DVec2, DVec2)> = pairs
            .iter()
            .map(|pair| (pair.center - center, pair.topocentric - measured))
            .collect();
        let spread: f64 = from_middle.iter().map(|(c, _)| c.length_squared()).sum();
        let product: DVec2 = from_middle
            .iter()
            .map(|(c, m)| DVec2::new(c.dot(*m), c.perp_dot(*m)))
            .sum();
        let turn = product / spread;
        let lengths = from_middle
            .iter()
            .map(|(c, m)| (*m - turn.rotate(*c)).length())
            .collect();
        (spread > 0.0 && turn.is_finite()).then_some(Self {
            turn,
            spread,
            lengths,
        })
    }
}

/// How the camera centres lie to where a reading puts the measured positions.
struct Misfit {
    /// The median over all photos.
    shift: DVec2,
    /// How far each photo is off beside that.
    distances: Vec<f64>,
    /// Their median; 0 of none.
    distance: f64,
}

impl Misfit {
    fn of(pairs: &[Pair], predicted: fn(&Pair) -> DVec2) -> Self {
        let off: Vec<DVec2> = pairs
            .iter()
            .map(|pair| pair.center - predicted(pair))
            .collect();
        let middle = |axis: fn(&DVec2) -> f64| {
            median(&mut off.iter().map(axis).collect::<Vec<f64>>()).unwrap_or_default()
        };
        let shift = DVec2::new(middle(|off| off.x), middle(|off| off.y));
        let distances: Vec<f64> = off.iter().map(|off| off.distance(shift)).collect();
        Self {
            shift,
            distance: median(&mut distances.clone()).unwrap_or_default(),
            distances,
        }
    }

    /// The photos within four of their robust standard deviations.
    fn without_outliers<'a>(&self, pairs: &'a [Pair]) -> Vec<&'a Pair> {
        // The median length of normal deviations in two axes is 1.1774 of their standard deviation.
        let most = 4.0 * self.distance / 1.1774;
        let all = pairs.iter().zip(&self.distances);
        all.filter(|(_, distance)| **distance <= most)
            .map(|(pair, _)| pair)
            .collect()
    }

    fn in_words(&self) -> String {
        let distance = self.distance;
        let digits = if distance < 0.1 { 3 } else { 2 };
        let all = self.shift.length();
        if all > 1.0 && all > distance {
            return format!("{distance:.digits$} m beside {all:.1} m for all");
        }
        format!("{distance:.digits$} m")
    }
}

#[cfg(test)]
mod tests;
