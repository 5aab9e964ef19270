//! DJI's WPML (Cloud API, "DJI WPML"): a zip file or folder `wpmz` of `waylines.wpml`, which is what the
//! drone flies, and `template.kml`, from which the app made it. Both are KML with elements of DJI's own;
//! the first is read, the second where the first is missing.
//!
//! Elements are known by their names whatever their namespace, of which there are seven versions under
//! two addresses (www.dji.com and www.uav.com). Coordinates are longitude, latitude.

mod actions;
mod folder;

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{BufReader, Cursor, Read};
use std::path::Path;

use roxmltree::{Document, Node};
use zip::ZipArchive;

use fragscale_core::plan::{
    Above, DroneCodes, Finish, Height, LostSignal, Mission, PayloadCodes, TakeOff,
};

use self::folder::add_folder;
use super::route::Route;
use super::{LARGEST, MissionFile, text_in};
use crate::fault::Fault;
use crate::files::{FileError, last_segment, open_file, text_from_bytes};
use crate::text::fields::shown;
use crate::text::notes::Notes;
use crate::text::xml_document::{Writer, child, line_of, parse_of, text};

const EXPORT: &str = "export the mission from DJI's app again";

/// A waypoint with many actions has about 300 nodes.
const DJI: Writer = Writer {
    name: None,
    if_damaged: EXPORT,
    if_foreign: EXPORT,
    longest_tag: 20_000,
    most_attributes: usize::MAX,
    has_namespaces: true,
    most_nodes: 4_000_000,
};

/// What is read, best first.
const FILES: [&str; 2] = ["waylines.wpml", "template.kml"];

/// Reads a .kmz.
pub(super) fn read_kmz(bytes: &[u8]) -> Result<MissionFile, Fault> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| broken(&error))?;
    let mut found = None;
    for file in FILES {
        let Some(text) = unpacked(&mut archive, file)? else {
            continue;
        };
        match &mut found {
            None => found = Some(read_xml(&text).map_err(|fault| in_file(file, fault))?),
            Some(found) => add_take_off(found, &text),
        }
    }
    let what = "it holds neither waylines.wpml nor template.kml";
    found.ok_or_else(|| Fault::new(what, super::KNOWN))
}

/// Whether a zip holds a file of a mission; not one that cannot be read.
pub(super) fn is_in_zip(path: &Path) -> bool {
    let archive = open_file(path)
        .ok()
        .map(BufReader::new)
        .map(ZipArchive::new);
    let Some(Ok(archive)) = archive else {
        return false;
    };
    let mut names = archive.file_names().filter_map(Result::ok);
    names.any(|name| FILES.contains(&last_segment(&name)))
}

/// Whether a folder holds a file of a mission, itself or in `wpmz`.
pub(super) fn is_folder(path: &Path) -> bool {
    let folders = [path.join("wpmz"), path.to_owned()];
    (folders.iter()).any(|folder| FILES.iter().any(|file| folder.join(file).is_file()))
}

fn broken(error: &dyn Display) -> Fault {
    Fault::new(format!("its zip is damaged ({error})"), EXPORT)
}

/// The text of the file of this name in a zip, whatever folder it is in.
fn unpacked(archive: &mut ZipArchive<Cursor<&[u8]>>, file: &str) -> Result<Option<String>, Fault> {
    let named = {
        let mut names = archive.file_names().filter_map(Result::ok);
        let is_it = |name: &str| last_segment(name) == file;
        names.find(|name| is_it(name)).map(Cow::into_owned)
    };
    let Some(name) = named else {
        return Ok(None);
    };
    let entry = archive.by_name(&name).map_err(|error| broken(&error))?;
    let mut inflated = Vec::new();
    let read = entry.take(LARGEST + 1).read_to_end(&mut inflated);
    read.map_err(|error| broken(&error))?;
    if inflated.len() as u64 > LARGEST {
        let what = format!("its {file} inflates to more than {} MB", LARGEST >> 20);
        return Err(Fault::new(what, EXPORT));
    }
    let text = text_from_bytes(&inflated).map_err(|fault| in_file(file, fault))?;
    Ok(Some(text.to_owned()))
}

/// A fault in a file inside of another, whose lines are not those of the other.
fn in_file(file: &str, fault: Fault) -> Fault {
    let place = match fault.line {
        Some(line) => format!("its {file}, line {line}"),
        None => format!("its {file}"),
    };
    Fault::new(format!("{place}: {}", fault.what), fault.remedy)
}

/// Reads a folder that holds what a .kmz holds.
pub(super) fn read_folder(path: &Path) -> Result<MissionFile, FileError> {
    let mut found = None;
    for file in FILES {
        for folder in [path.join("wpmz"), path.to_owned()] {
            let Some(text) = text_in(&folder, file)? else {
                continue;
            };
            let at = |fault| FileError::new(&folder.join(file), fault);
            match &mut found {
                None => found = Some(read_xml(&text).map_err(at)?),
                Some(found) => add_take_off(found, &text),
            }
            break;
        }
    }
    let what = "a folder without waylines.wpml and template.kml";
    found.ok_or_else(|| FileError::new(path, Fault::new(what, super::KNOWN)))
}

/// The place of take-off stands in templates alone. What is wrong with one beside good waylines is no
/// matter: the drone does not fly by it.
fn add_take_off(found: &mut MissionFile, template: &str) {
    if found.mission.take_off.is_none()
        && let Ok(document) = parse_of(template, &DJI)
        && let Some(config) = config_of(&document)
        && let Ok(take_off) = take_off(config)
    {
        found.mission.take_off = take_off;
    }
}

fn config_of<'a, 'd>(document: &'a Document<'d>) -> Option<Node<'a, 'd>> {
    let mut nodes = document.descendants();
    nodes.find(|node| node.has_tag_name("missionConfig"))
}

/// Reads a waylines.wpml or a template.kml.
pub(super) fn read_xml(xml: &str) -> Result<MissionFile, Fault> {
    let document = parse_of(xml, &DJI)?;
    let Some(config) = config_of(&document) else {
        let what = match document.root_element().has_tag_name("kml") {
            true => "KML without DJI's missionConfig is no mission",
            false => "XML that is not DJI's WPML is no mission",
        };
        return Err(Fault::new(what, super::KNOWN));
    };
    let mut notes = Notes::default();
    let mut mission = of_config(config, &mut notes)?;
    let mut route = Route::default();
    let folders = folders(&document);
    if folders.len() > 1 {
        notes.say(format!(
            "its {} waylines are read one behind the other",
            folders.len()
        ));
    }
    for folder in folders {
        let speed = add_folder(folder, &mut route, &mut notes)?;
        mission.speed = mission.speed.or(speed);
    }
    mission.stops = route.stops();
    Ok(MissionFile {
        mission,
        format: "a mission of DJI (WPML)",
        notes: notes.sentences(),
    })
}

fn folders<'a, 'd>(document: &'a Document<'d>) -> Vec<Node<'a, 'd>> {
    let nodes = document.descendants();
    nodes.filter(|node| node.has_tag_name("Folder")).collect()
}

/// What holds for the whole mission.
fn of_config(config: Node<'_, '_>, notes: &mut Notes) -> Result<Mission, Fault> {
    let finish = match child(config, "finishAction").map(text) {
        Some("goHome") => Finish::ReturnHome,
        Some("autoLand") => Finish::Land,
        Some("gotoFirstWaypoint") => Finish::FirstStop,
        None | Some("noAction") => Finish::Hover,
        Some(other) => {
            let other = shown(other);
            notes.say(format!(
                "what it does at the end ({other}) is not known: read as hovering"
            ));
            Finish::Hover
        }
    };
    let says = |name: &str| child(config, name).map(text);
    let lost_signal = match (says("exitOnRCLost"), says("executeRCLostAction")) {
        (Some("goContinue"), _) => Some(LostSignal::GoOn),
        (_, Some("goBack")) => Some(LostSignal::ReturnHome),
        (_, Some("hover")) => Some(LostSignal::Hover),
        (_, Some("landing")) => Some(LostSignal::Land),
        (_, None) => None,
        (_, Some(other)) => {
            let other = shown(other);
            notes.say(format!(
                "what it does where the radio is lost ({other}) is not known, and not read"
            ));
            None
        }
    };
    let codes = |info: &'static str, names: [&'static str; 3]| -> Result<_, Fault> {
        let Some(info) = child(config, info) else {
            return Ok(None);
        };
        let Some(kind) = whole(info, names[0])? else {
            return Ok(None);
        };
        let sub = whole(info, names[1])?.unwrap_or(0);
        Ok(Some((kind, sub, whole(info, names[2])?.unwrap_or(0))))
    };
    let drone = codes("droneInfo", ["droneEnumValue", "droneSubEnumValue", ""])?;
    let payload = codes(
        "payloadInfo",
        [
            "payloadEnumValue",
            "payloadSubEnumValue",
            "payloadPositionIndex",
        ],
    )?;
    let payload = payload.map(|(payload, payload_sub, position)| PayloadCodes {
        payload,
        payload_sub,
        position,
    });
    Ok(Mission {
        drone: drone.map(|(drone, drone_sub, _)| DroneCodes {
            drone,
            drone_sub,
            payload,
        }),
        take_off: take_off(config)?,
        safe_height: number(config, "takeOffSecurityHeight")?,
        return_height: number(config, "globalRTHHeight")?,
        finish,
        lost_signal,
        ..Mission::default()
    })
}

/// "Latitude, longitude, altitude", above the ellipsoid.
fn take_off(config: Node<'_, '_>) -> Result<Option<TakeOff>, Fault> {
    let Some(point) = child(config, "takeOffRefPoint") else {
        return Ok(None);
    };
    let numbers = numbers_of(point)?;
    let &[latitude, longitude, ref rest @ ..] = &numbers[..] else {
        return Err(fault(
            point,
            "takeOffRefPoint is no latitude,longitude,altitude",
        ));
    };
    let elevation = rest.first().map(|&metres| Height {
        metres,
        above: Above::Ellipsoid,
    });
    // FlightHub writes zeros where nobody chose a place.
    Ok((latitude != 0.0 || longitude != 0.0).then_some(TakeOff {
        latitude,
        longitude,
        elevation,
    }))
}

/// A fault at an element.
fn fault(node: Node<'_, '_>, what: impl Into<String>) -> Fault {
    Fault::at(line_of(node), what, EXPORT)
}

/// The finite number in an element directly inside another, if there is one.
fn number(node: Node<'_, '_>, name: &str) -> Result<Option<f64>, Fault> {
    let Some(child) = child(node, name).filter(|child| !text(*child).is_empty()) else {
        return Ok(None);
    };
    match numbers_of(child)?[..] {
        [number] => Ok(Some(number)),
        _ => Err(fault(child, format!("<{name}> is not one number"))),
    }
}

/// The whole number in an element directly inside another, if there is one.
fn whole(node: Node<'_, '_>, name: &str) -> Result<Option<u32>, Fault> {
    let Some(child) = child(node, name).filter(|child| !text(*child).is_empty()) else {
        return Ok(None);
    };
    text(child).parse().map(Some).map_err(|_| {
        let found = shown(text(child));
        fault(child, format!("<{name}> is '{found}', not a whole number"))
    })
}

/// The numbers between commas that an element consists of, finite all.
fn numbers_of(node: Node<'_, '_>) -> Result<Vec<f64>, Fault> {
    let words = text(node).split(',');
    let numbers = words.map(|word| match word.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => {
            let name = node.tag_name().name();
            let found = shown(word.trim());
            Err(fault(
                node,
                format!("<{name}> holds '{found}', not a number"),
            ))
        }
    });
    numbers.collect()
}

/// Whether an element directly inside another says yes.
fn is_on(node: Node<'_, '_>, name: &str) -> bool {
    child(node, name).is_some_and(|child| text(child) == "1")
}
