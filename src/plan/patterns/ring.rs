//! A ring of photos around an area, all aslant and looking into it: what a reconstruction needs beside photos that look
//! straight down, to see steep faces and to keep its lens from bending the ground into a bowl (James & Robson 2014).
//!
//! The ring runs along the convex hull of the area and around its corners. Each photo looks straight in over the
//! hull's side, at a place half a footprint inside, or in the middle where the area is narrower than that. Along a side
//! neighbours share what the survey's photos share; around a corner they turn by at most [`TURN`] degrees besides.

use glam::{DVec2, DVec3};

use super::{Ground, MOST, azimuth};
use crate::plan::photo::{PlannedPhoto, Refused};
use crate::surface::convex_hull;

/// The tilt of photos that look aslant, degrees below the horizon.
pub(in crate::plan) const ASLANT: f64 = 50.0;
/// How much neighbours around a corner turn at most, degrees: features of photos that turn by more are seldom found
/// again (SIFT finds half of them at some 30 degrees out of the plane; Mikolajczyk & Schmid 2005).
pub(in crate::plan) const TURN: f64 = 15.0;

/// A piece of the ring.
enum Piece {
    /// Along a side of the hull, with its direction and length.
    Side(DVec2, DVec2, f64),
    /// Around a corner, from one direction inwards by an angle clockwise, radians.
    Corner(DVec2, DVec2, f64),
}

impl Ground<'_> {
    /// The ring around the area.
    pub(super) fn ring(&self) -> (Vec<PlannedPhoto>, Vec<Refused>) {
        let corners = self.area.corners().iter();
        let corners: Vec<DVec3> = corners.map(|corner| corner.extend(0.0)).collect();
        let hull: Vec<DVec2> = (convex_hull(&corners).iter())
            .map(|corner| corner.truncate())
            .collect();
        let half = self.footprint().y / ASLANT.to_radians().sin() / 2.0;
        let step = self.footprint().x * (1.0 - self.overlap());
        // Of each piece, how many photos it takes.
        let photos = |piece: &Piece| match piece {
            Piece::Side(.., length) => length / step,
            Piece::Corner(.., angle) => angle.abs() * (half / step).max(1.0 / TURN.to_radians()),
        };
        let pieces = pieces(&hull);
        let whole: f64 = pieces.iter().map(photos).sum();
        let count = whole.ceil().clamp(1.0, MOST as f64);
        let (mut planned, mut refused) = (Vec::new(), Vec::new());
        let (mut pieces, mut before) = (pieces.iter().peekable(), 0.0);
        for index in 0..count as u32 {
            let at = (f64::from(index) + 0.5) * whole / count;
            while let Some(piece) = pieces.peek()
                && before + photos(piece) < at
            {
                before += photos(piece);
                if pieces.len() == 1 {
                    break;
                }
                pieces.next();
            }
            let Some(piece) = pieces.peek() else { break };
            let share = ((at - before) / photos(piece)).clamp(0.0, 1.0);
            let (on_hull, inwards) = match piece {
                Piece::Side(from, along, length) => {
                    (*from + *along * *length * share, along.perp())
                }
                Piece::Corner(corner, inwards, angle) => {
                    (*corner, DVec2::from_angle(*angle * share).rotate(*inwards))
                }
            };
            let inside = half.min(chord(&hull, on_hull, inwards) / 2.0);
            let place = on_hull + inwards * inside;
            match self.terrain.plane(place, self.footprint().max_element()) {
                Some(ground) => {
                    let target = place.extend(self.level());
                    planned.push(self.looking_at(target, [ASLANT, azimuth(inwards)], ground));
                }
                None => refused.push(Refused::without_ground(place)),
            }
        }
        (planned, refused)
    }
}

/// The sides of a hull, counter-clockwise, each with the corner behind it.
fn pieces(hull: &[DVec2]) -> Vec<Piece> {
    let side = |at: usize| {
        let (from, to) = (hull[at % hull.len()], hull[(at + 1) % hull.len()]);
        (from, to, (to - from).normalize_or(DVec2::X))
    };
    let pieces = (0..hull.len()).flat_map(|at| {
        let (from, to, along) = side(at);
        let (.., next) = side(at + 1);
        [
            Piece::Side(from, along, from.distance(to)),
            Piece::Corner(to, along.perp(), along.angle_to(next)),
        ]
    });
    pieces.collect()
}

/// How far a line goes inside a hull from a place on it.
fn chord(hull: &[DVec2], from: DVec2, direction: DVec2) -> f64 {
    let ends = hull.iter().zip(hull.iter().cycle().skip(1));
    let meets = ends.filter_map(|(a, b)| {
        let (side, off) = (*b - *a, *a - from);
        let cross = direction.perp_dot(side);
        let along = off.perp_dot(side) / cross;
        let on_side = off.perp_dot(direction) / cross;
        ((-1e-9..=1.0 + 1e-9).contains(&on_side) && along.is_finite()).then_some(along)
    });
    meets.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the middle of the side of a square straight in it is its side, from a corner along the diagonal that, from an
    /// acute corner outwards nothing.
    #[test]
    fn chords_of_a_square() {
        let at = |x: f64, y: f64| DVec2::new(x, y);
        let square = [at(0.0, 0.0), at(10.0, 0.0), at(10.0, 10.0), at(0.0, 10.0)];
        let diagonal = at(1.0, 1.0).normalize();
        assert!((chord(&square, at(5.0, 0.0), DVec2::Y) - 10.0).abs() < 1e-9);
        assert!((chord(&square, at(0.0, 0.0), diagonal) - 200.0_f64.sqrt()).abs() < 1e-9);
        assert!(chord(&square, at(0.0, 0.0), -diagonal) < 1e-6);
    }

    /// Once around: the turns at the corners are 360 degrees, whatever the hull.
    #[test]
    fn a_ring_turns_once() {
        let at = |x: f64, y: f64| DVec2::new(x, y);
        for hull in [
            vec![at(0.0, 0.0), at(10.0, 0.0), at(2.0, 5.0)],
            vec![
                at(0.0, 0.0),
                at(9.0, 1.0),
                at(12.0, 7.0),
                at(3.0, 9.0),
                at(-1.0, 4.0),
            ],
        ] {
            let turned: f64 = (pieces(&hull).iter())
                .map(|piece| match piece {
                    Piece::Side(..) => 0.0,
                    Piece::Corner(.., angle) => *angle,
                })
                .sum();
            assert!((turned - std::f64::consts::TAU).abs() < 1e-12, "{turned}");
        }
    }
}
