//! A flight within a memory: opened again with more of its cloud, as long as something lacks.

use std::path::Path;

use super::{OpenOptions, Opened, open};
use crate::in_part::{InPart, Memory};
use crate::jobs::Progress;

/// Opens a flight within a memory and does something with it that reads its surface. Where the cloud is larger, a
/// part of it is read; then `work` may be called several times, and what it returns counts only the last time. It
/// must not write anything: see [`Opened::is_settled`] for what has to.
///
/// # Errors
/// In one line, where the flight cannot be opened, or not within the memory; what `work` says.
pub fn with_flight<T>(
    path: &Path,
    options: &OpenOptions,
    memory: Memory,
    progress: &Progress,
    mut work: impl FnMut(&Opened) -> Result<T, String>,
) -> Result<(Opened, T), String> {
    let mut part = InPart::new(memory);
    loop {
        let opened = open(path, options, None, Some(&mut part), progress);
        let opened = opened.map_err(|error| error.to_string())?;
        let found = work(&opened);
        let wanted = opened.flight.parts().surface.wanted();
        if wanted.is_nothing() {
            return Ok((opened, found?));
        }
        // Also of a failure: it may have come of what is missing.
        progress.advance(0, 1).map_err(|fault| fault.to_string())?;
        part.want(wanted);
    }
}
