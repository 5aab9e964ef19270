//! A profile, going out.

use serde_json::{Value, json};

use super::{MeasuredUnit, bridged, coordinate, csv_of, percent, rows_of_text};
use crate::survey::{Face, Profile, ProfilePoint};

/// A profile and what it is of.
#[derive(Debug, Clone, Copy)]
pub struct ProfileReport<'a> {
    /// The flight's name.
    pub flight: &'a str,
    /// Of its lengths.
    pub unit: MeasuredUnit,
    /// What was found.
    pub profile: &'a Profile,
}

/// What the sides of the crest are called.
const SIDES: [&str; 2] = ["before", "after"];

/// What an engineer should know of a profile, a sentence each.
pub fn profile_warnings(profile: &Profile) -> Vec<String> {
    bridged("the line", profile.bridged, "")
        .into_iter()
        .collect()
}

/// Crest, toes and angles of repose as text.
pub fn profile_table(report: &ProfileReport<'_>) -> String {
    let ProfileReport {
        flight,
        unit,
        profile,
    } = report;
    let unit = unit.length();
    let place = |at: &ProfilePoint| {
        let [distance, height] = [at.distance, at.point.z].map(coordinate);
        format!("{height} {unit} at {distance} {unit} along the line")
    };
    let mut rows = vec![
        (
            "length in plan",
            format!("{} {unit}", coordinate(profile.length)),
        ),
        ("points", profile.points().count().to_string()),
        ("covered by the surface", percent(profile.covered())),
    ];
    if let (Some(crest), Some(lowest)) = (profile.crest(), profile.lowest()) {
        rows.push(("crest", place(crest)));
        rows.push(("lowest", place(lowest)));
    }
    let faces = profile.faces();
    let stones = stone_sides(&faces, profile);
    for ((side, face), is_of_a_stone) in SIDES.into_iter().zip(&faces).zip(stones) {
        let Some(face) = face else {
            continue;
        };
        let [toe, angle, overall] = match side {
            "before" => [
                "toe before",
                "angle of repose before",
                "crest to toe before",
            ],
            _ => ["toe after", "angle of repose after", "crest to toe after"],
        };
        rows.push((toe, place(&face.toe)));
        rows.push((angle, repose(face, is_of_a_stone, &unit)));
        let height = coordinate(face.height());
        rows.push((
            overall,
            format!("{:.1}°, {height} {unit} high", face.overall),
        ));
    }
    let mut text = format!("{flight}: profile\n\n{}", rows_of_text(&rows));
    if faces.iter().any(Option::is_some) {
        text += "\nThe angle of repose is the slope of the steepest line fitted to a stretch that falls by half \
                 of the height between crest and toe.\n";
    } else {
        text +=
            "\nNo side of the crest falls by a tenth of the profile's relief: there is no face.\n";
    }
    text
}

/// A stretch of less of the line is a stone's side, no slope of the pile.
const LEAST_STRETCH: f64 = 0.05;

/// A face that is less gentle than its steepest stretch, degrees, is as steep all over: a wall, where it is high.
const WALL: f64 = 10.0;

/// The part of the profile's relief that a wall falls by. The side of a stone at the crest is as steep all over, too, and ends above
/// the stones below it.
const WALLS_FALL: f64 = 0.5;

/// The part of the profile's relief that the other flank of a spike falls by, at least. Behind a wall's crest is a bench or a slope; a
/// stone that lies on its edge is lower.
const SPIKES_FALL: f64 = 0.25;

/// Of each face of a profile whether its angle of repose is that of a stone's side: of a short stretch of the profile that is much
/// steeper than the face, of a face that is low, or of a spike, which falls within as little on the other side of the crest.
pub fn stone_sides(faces: &[Option<Face>; 2], profile: &Profile) -> [bool; 2] {
    let [before, after] = faces;
    [[before, after], [after, before]].map(|[face, other]| {
        (face.as_ref()).is_some_and(|face| is_of_a_stone(face, other.as_ref(), profile))
    })
}

fn is_of_a_stone(face: &Face, other: Option<&Face>, profile: &Profile) -> bool {
    let relief = (profile.lowest()).map_or(0.0, |lowest| face.crest.point.z - lowest.point.z);
    let is_short = |face: &Face| {
        let stretch = face.fitted.map(|[from, to]| (to - from).abs());
        stretch.is_some_and(|stretch| stretch < LEAST_STRETCH * profile.length)
    };
    let is_spike =
        other.is_some_and(|other| is_short(other) && other.height() >= SPIKES_FALL * relief);
    let is_steep_all_over = (face.repose).is_some_and(|repose| repose - face.overall < WALL);
    let is_wall = is_steep_all_over && face.height() >= WALLS_FALL * relief && !is_spike;
    is_short(face) && !is_wall
}

fn repose(face: &Face, is_of_a_stone: bool, unit: &str) -> String {
    match (face.repose, face.fitted) {
        (Some(repose), Some([from, to])) => {
            let [from, to] = [from, to].map(coordinate);
            let doubt = match is_of_a_stone {
                true => ": a stone's side rather than a slope, the stretch is so short",
                false => "",
            };
            format!("{repose:.1}°, from {from} to {to} {unit} along the line{doubt}")
        }
        _ => "none: holes in the surface".to_owned(),
    }
}

/// A line for each point: where it is, and in which part between holes it is, counted from 1. Numbers
/// read back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn profile_csv(report: &ProfileReport<'_>) -> Result<String, csv::Error> {
    let unit = report.unit.in_names();
    let mut header: Vec<String> = ["distance", "x", "y", "height"]
        .map(|name| format!("{name}_{unit}"))
        .to_vec();
    header.push("part".to_owned());
    let runs = report.profile.runs.iter().enumerate();
    let lines = runs.flat_map(|(part, run)| {
        run.iter().map(move |at| {
            let numbers = [at.distance, at.point.x, at.point.y, at.point.z];
            let mut line: Vec<String> = numbers.map(|number| number.to_string()).to_vec();
            line.push((part + 1).to_string());
            line
        })
    });
    csv_of(std::iter::once(header).chain(lines))
}

/// All of it as JSON.
///
/// # Errors
/// Where memory runs out.
pub fn profile_json(report: &ProfileReport<'_>) -> Result<String, serde_json::Error> {
    let profile = report.profile;
    let at = |at: &ProfilePoint| json!({"distance": at.distance, "point": at.point.to_array()});
    let faces: Vec<Value> = (SIDES.into_iter().zip(profile.faces()))
        .filter_map(|(side, face)| {
            let face = face?;
            Some(json!({
                "side": side,
                "crest": at(&face.crest),
                "toe": at(&face.toe),
                "height": face.height(),
                "crest_to_toe_degrees": face.overall,
                "angle_of_repose_degrees": face.repose,
                "fitted_between": face.fitted,
            }))
        })
        .collect();
    let runs: Vec<Value> = (profile.runs.iter())
        .map(|run| run.iter().map(at).collect())
        .collect();
    let value = json!({
        "flight": report.flight,
        "unit": report.unit.symbol,
        "length": profile.length,
        "covered": profile.covered(),
        "crest": profile.crest().map(at),
        "lowest": profile.lowest().map(at),
        "faces": faces,
        "parts": runs,
    });
    Ok(serde_json::to_string_pretty(&value)? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// The profile over a line of 20 through these places: distance, height.
    fn through(places: &[[f64; 2]]) -> Profile {
        let point = |&[distance, height]: &[f64; 2]| ProfilePoint {
            distance,
            point: DVec3::new(distance, 0.0, height),
        };
        Profile {
            runs: vec![places.iter().map(point).collect()],
            length: 20.0,
            bridged: 0.0,
        }
    }

    /// Both are as steep all over: a wall from the floor to the crest, and the side of a stone at the crest.
    #[test]
    fn a_wall_is_high_and_a_stone_is_not() {
        let wall = through(&[
            [0.0, 0.0],
            [5.0, 0.0],
            [5.01, 4.0],
            [12.0, 0.0],
            [20.0, 0.0],
        ]);
        let stone = through(&[
            [0.0, 3.6],
            [5.0, 3.4],
            [5.01, 4.0],
            [12.0, 0.0],
            [20.0, 0.0],
        ]);
        for (profile, is_stone) in [(&wall, false), (&stone, true)] {
            let faces = profile.faces();
            let before = faces[0].as_ref().expect("a face");
            assert!(before.repose.is_some_and(|repose| repose > 85.0));
            assert_eq!(stone_sides(&faces, profile), [is_stone, false]);
        }
    }

    /// Its left side is as steep all over as a wall and as high as all of the profile; its right one runs out.
    #[test]
    fn a_spike_is_a_stone_on_both_sides() {
        let spike = through(&[
            [0.0, 0.0],
            [9.9, 0.0],
            [10.0, 2.0],
            [10.1, 1.0],
            [10.9, 0.3],
            [20.0, 0.0],
        ]);
        let faces = spike.faces();
        assert!(faces.iter().all(Option::is_some));
        assert_eq!(stone_sides(&faces, &spike), [true, true]);
        // A stone on the edge of a wall is low: the wall stays one.
        let on_edge = through(&[
            [0.0, 0.0],
            [9.9, 0.0],
            [10.0, 10.0],
            [10.1, 9.0],
            [10.9, 8.5],
            [20.0, 8.8],
        ]);
        let faces = on_edge.faces();
        assert_eq!(stone_sides(&faces, &on_edge), [false, true]);
    }
}
