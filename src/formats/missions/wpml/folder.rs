//! One wayline of WPML: its heights, its waypoints, and which actions belong to which.

use std::collections::HashMap;

use roxmltree::Node;

use fragscale_core::plan::{Above, Height};

use super::actions::{act, act_at_start};
use super::{fault, is_on, number, numbers_of, whole};
use crate::fault::Fault;
use crate::missions::route::Route;
use crate::text::fields::shown;
use crate::text::notes::Notes;
use crate::text::xml_document::{child, children, text};

/// What waypoints of a template have in common unless they say otherwise.
struct Common<'a, 'd> {
    above: Above,
    is_template: bool,
    height: Option<f64>,
    heading: Option<Node<'a, 'd>>,
    has_pitch: bool,
}

/// Adds the waypoints of a wayline; its speed in m/s.
///
/// # Errors
/// With the line: heights that count from what is not known, a waypoint without place or height; a
/// template that is none of waypoints.
pub(super) fn add_folder(
    folder: Node<'_, '_>,
    route: &mut Route,
    notes: &mut Notes,
) -> Result<Option<f64>, Fault> {
    let kind = child(folder, "templateType");
    if let Some(kind) = kind
        && text(kind) != "waypoint"
    {
        let what = format!(
            "a template of the kind '{}' has no waypoints",
            shown(text(kind))
        );
        let remedy = "give the .kmz with its waylines.wpml";
        return Err(Fault::at(
            crate::text::xml_document::line_of(kind),
            what,
            remedy,
        ));
    }
    let placemarks: Vec<Node<'_, '_>> = children(folder, "Placemark").collect();
    if placemarks.is_empty() {
        return Ok(None);
    }
    let common = Common {
        above: above(folder)?,
        is_template: kind.is_some(),
        height: number(folder, "globalHeight")?,
        heading: child(folder, "globalWaypointHeadingParam"),
        has_pitch: child(folder, "gimbalPitchMode").map(text) == Some("usePointSetting"),
    };
    if let Some(start) = child(folder, "startActionGroup") {
        act_at_start(start, route, notes)?;
    }
    let groups = groups(&placemarks)?;
    let mut speeds = Vec::new();
    let global = number(folder, "autoFlightSpeed")?;
    for (placemark, order) in placemarks.into_iter().zip(0_u32..) {
        let index = whole(placemark, "index")?.unwrap_or(order);
        let place = format!("waypoint {index}");
        arrive(placemark, &common, route, notes, &place)?;
        if !is_on(placemark, "useGlobalSpeed") {
            speeds.extend(number(placemark, "waypointSpeed")?);
        }
        for group in groups.get(&index).into_iter().flatten() {
            act(*group, route, notes, &place)?;
        }
    }
    let own = speeds.first().copied();
    let is_same = speeds.iter().all(|speed| Some(*speed) == own);
    Ok(match own {
        Some(own) if is_same => Some(own),
        Some(_) => {
            notes.say("waypoints have speeds of their own: only that of the wayline is read");
            global
        }
        None => global,
    }
    .filter(|speed| *speed > 0.0))
}

/// What heights count from: `executeHeightMode` of a wayline, `heightMode` of a template.
fn above(folder: Node<'_, '_>) -> Result<Above, Fault> {
    let system = child(folder, "waylineCoordinateSysParam");
    let mode = child(folder, "executeHeightMode")
        .or_else(|| system.and_then(|system| child(system, "heightMode")));
    let Some(mode) = mode else {
        return Err(fault(
            folder,
            "a wayline that does not say what heights count from",
        ));
    };
    match text(mode) {
        "WGS84" => Ok(Above::Ellipsoid),
        "EGM96" => Ok(Above::Geoid),
        "relativeToStartPoint" => Ok(Above::TakeOff),
        "aboveGroundLevel" | "realTimeFollowSurface" => Ok(Above::Ground),
        other => {
            let what = format!("heights count from '{}', which is not known", shown(other));
            Err(fault(mode, what))
        }
    }
}

/// The groups of actions by the index of the waypoint where they begin.
fn groups<'a, 'd>(placemarks: &[Node<'a, 'd>]) -> Result<HashMap<u32, Vec<Node<'a, 'd>>>, Fault> {
    let mut groups: HashMap<u32, Vec<Node<'_, '_>>> = HashMap::new();
    for (placemark, order) in placemarks.iter().zip(0_u32..) {
        let own = whole(*placemark, "index")?.unwrap_or(order);
        for group in children(*placemark, "actionGroup") {
            let start = whole(group, "actionGroupStartIndex")?.unwrap_or(own);
            groups.entry(start).or_default().push(group);
        }
    }
    Ok(groups)
}

/// The place of a waypoint, its height, heading and pitch.
fn arrive(
    placemark: Node<'_, '_>,
    common: &Common<'_, '_>,
    route: &mut Route,
    notes: &mut Notes,
    place: &str,
) -> Result<(), Fault> {
    let point = child(placemark, "Point").and_then(|point| child(point, "coordinates"));
    let Some(point) = point else {
        return Err(fault(placemark, format!("{place} has no <Point>")));
    };
    let &[longitude, latitude, ..] = &numbers_of(point)?[..] else {
        return Err(fault(
            point,
            format!("{place} has no longitude and latitude"),
        ));
    };
    let own = match common.is_template {
        true if is_on(placemark, "useGlobalHeight") => common.height,
        true => number(placemark, "height")?.or(common.height),
        false => number(placemark, "executeHeight")?,
    };
    let Some(metres) = own else {
        return Err(fault(placemark, format!("{place} has no height")));
    };
    let above = common.above;
    route.arrive(latitude, longitude, Height { metres, above });
    let heading = match is_on(placemark, "useGlobalHeadingParam") {
        true => common.heading,
        false => child(placemark, "waypointHeadingParam"),
    };
    if let Some(heading) = heading {
        turn(heading, route, notes, place)?;
    }
    if common.has_pitch
        && let Some(pitch) = number(placemark, "gimbalPitchAngle")?
    {
        route.pitch(pitch);
    }
    let turn = child(placemark, "waypointTurnParam");
    let mode = turn
        .and_then(|turn| child(turn, "waypointTurnMode"))
        .map(text);
    if matches!(
        mode,
        Some("coordinateTurn" | "toPointAndPassWithContinuityCurvature")
    ) {
        notes.at("waypoints that are flown through are read as stops", place);
    }
    Ok(())
}

/// Where the drone's nose, and with it the camera, looks.
fn turn(
    heading: Node<'_, '_>,
    route: &mut Route,
    notes: &mut Notes,
    place: &str,
) -> Result<(), Fault> {
    let mode = child(heading, "waypointHeadingMode").map_or("", text);
    let has_angle = mode == "smoothTransition" || is_on(heading, "waypointHeadingAngleEnable");
    match number(heading, "waypointHeadingAngle")? {
        Some(angle) if has_angle => route.turn(angle),
        _ if mode == "towardPOI" => notes.at("looking at a point (POI) is not read", place),
        // Along the path or by hand: left to the drone.
        _ => {}
    }
    Ok(())
}
