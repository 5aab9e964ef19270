//! Mission Planner's and QGroundControl's plain text (mavlink.io, "Mission Plain-Text File Format"): the
//! line `QGC WPL 110`, then one command a line: index, current, frame, command, parameters 1 to 7,
//! autocontinue. The first one is home, if it is a waypoint with an absolute height (ArduPilot keeps home
//! there); it counts in the indices.

use fragscale_core::plan::{Above, Mission, TakeOff};

use super::MissionFile;
use super::mavlink::{Autopilot, Item, Place, above, home, told};
use crate::fault::Fault;
use crate::text::fields::{Fields, shown};
use crate::text::notes::Notes;

const EXPORT: &str = "save the mission again";

/// Reads a file whose first line begins with `QGC WPL`.
pub(super) fn read(text: &str) -> Result<MissionFile, Fault> {
    let mut lines = (1..).zip(text.lines());
    let (_, head) = lines.next().unwrap_or_default();
    if head.trim() != "QGC WPL 110" {
        let what = format!("'{}': a version that is not known", shown(head.trim()));
        return Err(Fault::at(1, what, "save it as QGC WPL 110"));
    }
    let mut notes = Notes::default();
    let mut items = Vec::new();
    for (line, text) in lines {
        if text.trim().is_empty() || text.starts_with('#') {
            continue;
        }
        let mut fields = Fields::new(line, text, EXPORT);
        let index: usize = fields.whole("the index")?;
        if index != items.len() {
            notes.at(
                "indices do not count on: the order of the lines is taken",
                format_args!("line {line}"),
            );
        }
        let _current: u32 = fields.whole("the mark of the current command")?;
        let frame = fields.whole("the frame")?;
        let command = fields.whole("the command")?;
        let mut parameters = [0.0; 7];
        for parameter in &mut parameters {
            let word = fields.word("a parameter")?;
            // NaN is what a vehicle is to choose.
            *parameter = match word.parse::<f64>() {
                Ok(number) if !number.is_infinite() => number,
                _ => return Err(fields.fault(format!("'{}' is not a number", shown(word)))),
            };
        }
        let place = Place::Line(line);
        items.push(Item {
            command,
            frame,
            parameters,
            place,
        });
    }
    let mut take_off = None;
    if let Some(first) = items.first()
        && first.command == 16
        && above(first.frame) == Some(Above::Geoid)
    {
        let [.., latitude, longitude, metres] = first.parameters;
        take_off = home(latitude, longitude, metres);
        items.remove(0);
    }
    let told = told(&items, Autopilot::ArduPilot, &mut notes)?;
    let take_off = take_off.or(told.take_off.map(|[latitude, longitude]| TakeOff {
        latitude,
        longitude,
        elevation: None,
    }));
    let mission = Mission {
        take_off,
        speed: told.speed,
        safe_height: told.safe_height,
        finish: told.finish,
        stops: told.stops,
        ..Mission::default()
    };
    Ok(MissionFile {
        mission,
        format: "a .waypoints of Mission Planner",
        notes: notes.sentences(),
    })
}
