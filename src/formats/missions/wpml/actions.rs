//! The actions of WPML: those that aim, wait and shoot.

use roxmltree::Node;

use super::{is_on, number};
use crate::fault::Fault;
use crate::missions::route::Route;
use crate::text::fields::shown;
use crate::text::notes::Notes;
use crate::text::xml_document::{child, children, text};

/// Adds what a group of actions does where it begins.
///
/// # Errors
/// With the line, where a number is none.
pub(super) fn act(
    group: Node<'_, '_>,
    route: &mut Route,
    notes: &mut Notes,
    place: &str,
) -> Result<(), Fault> {
    let trigger = child(group, "actionTrigger");
    let kind = trigger.and_then(|trigger| child(trigger, "actionTriggerType"));
    match kind.map_or("reachPoint", text) {
        "reachPoint" => {}
        "multipleTiming" | "multipleDistance" => {
            notes.at("photos by distance or time are no stops: not read", place);
            return Ok(());
        }
        other => {
            let what = format!("actions on the way ({}) are not read", shown(other));
            notes.at(what, place);
            return Ok(());
        }
    }
    for action in children(group, "action") {
        one(action, route, notes, place)?;
    }
    Ok(())
}

/// The same of the group that is done before the first waypoint, of which only the gimbal counts.
pub(super) fn act_at_start(
    group: Node<'_, '_>,
    route: &mut Route,
    notes: &mut Notes,
) -> Result<(), Fault> {
    for action in children(group, "action") {
        if function(action) == "gimbalRotate" {
            one(action, route, notes, "the start")?;
        } else {
            passed_over(function(action), notes, "the start");
        }
    }
    Ok(())
}

fn function<'a>(action: Node<'a, '_>) -> &'a str {
    child(action, "actionActuatorFunc").map_or("", text)
}

fn one(
    action: Node<'_, '_>,
    route: &mut Route,
    notes: &mut Notes,
    place: &str,
) -> Result<(), Fault> {
    // Without parameters an action does nothing that is read.
    let of = child(action, "actionActuatorFuncParam").unwrap_or(action);
    match function(action) {
        "gimbalRotate" => {
            let is_relative = child(of, "gimbalRotateMode").map(text) == Some("relativeAngle");
            if is_relative {
                notes.at("a gimbal's turn by an angle is not read", place);
                return Ok(());
            }
            if is_on(of, "gimbalPitchRotateEnable")
                && let Some(pitch) = number(of, "gimbalPitchRotateAngle")?
            {
                route.pitch(pitch);
            }
            if is_on(of, "gimbalYawRotateEnable")
                && let Some(yaw) = number(of, "gimbalYawRotateAngle")?
            {
                let is_of_nose = child(of, "gimbalHeadingYawBase").map(text) == Some("aircraft");
                match route.heading() {
                    _ if !route.has_place() => {}
                    _ if !is_of_nose => route.turn(yaw),
                    Some(nose) if yaw != 0.0 => route.turn(nose + yaw),
                    _ => {}
                }
            }
        }
        "rotateYaw" => {
            if let Some(angle) = number(of, "aircraftHeading")? {
                route.turn(angle);
            }
        }
        "hover" => {
            if let Some(seconds) = number(of, "hoverTime")? {
                route.wait(seconds.max(0.0));
            }
        }
        "takePhoto" => {
            route.shoot(suffix(of, "fileSuffix"));
        }
        "orientedShoot" | "accurateShoot" => {
            if let Some(pitch) = number(of, "gimbalPitchRotateAngle")? {
                route.pitch(pitch);
            }
            let heading = number(of, "aircraftHeading")?;
            if let Some(angle) = heading.or(number(of, "gimbalYawRotateAngle")?) {
                route.turn(angle);
            }
            let name =
                suffix(of, "orientedFileSuffix").or_else(|| suffix(of, "accurateFileSuffix"));
            route.shoot(name);
        }
        // What does not change where the camera looks.
        "focus" | "customDirName" => {}
        other => passed_over(other, notes, place),
    }
    Ok(())
}

fn passed_over(function: &str, notes: &mut Notes, place: &str) {
    match function {
        "startRecord" | "stopRecord" => notes.at("video is not read", place),
        other => notes.at(format!("the action {} is passed over", shown(other)), place),
    }
}

fn suffix(of: Node<'_, '_>, name: &str) -> Option<String> {
    let suffix = child(of, name).map(text).filter(|text| !text.is_empty());
    suffix.map(str::to_owned)
}
