//! Mission Planner's plain text (mavlink.io, "Mission Plain-Text File Format"): home is line 0 and counts
//! in the indices, though it is no stop.

use std::fmt::Write;

use fragscale_core::plan::Mission;

use super::mavlink::{commands, home};
use super::{degrees, metres};
use crate::fault::Fault;
use crate::files::WAYPOINTS_MARK;

/// The file of a mission.
pub(super) fn bytes(mission: &Mission, notes: &mut Vec<String>) -> Result<Vec<u8>, Fault> {
    let home = home(mission, notes)?;
    let elevation = home.elevation.map_or(0.0, |height| height.metres);
    let mut text = String::from("QGC WPL 110\n");
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{WAYPOINTS_MARK}{}\t{}\t{}\t1",
        degrees(home.latitude),
        degrees(home.longitude),
        metres(elevation)
    );
    for (command, index) in commands(mission, notes)?.iter().zip(1..) {
        let _ = write!(text, "{index}\t0\t{}\t{}", command.frame, command.command);
        for (parameter, position) in command.parameters.iter().zip(1..) {
            text.push('\t');
            text += &match position {
                5 | 6 => degrees(*parameter),
                _ => metres(*parameter),
            };
        }
        text += "\t1\n";
    }
    Ok(text.into_bytes())
}
