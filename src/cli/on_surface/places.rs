//! Places that are typed or in a file.

use std::path::Path;

use glam::DVec2;

use crate::formats::{read_places, typed_places};

/// `x,y;x,y;…`, or a file with a place a line. With what was mended of the file.
pub(in crate::cli) fn places(text: &str) -> Result<(Vec<DVec2>, Vec<String>), String> {
    match typed_places(text) {
        Ok(places) => Ok((places, Vec::new())),
        Err(fault) => {
            let path = Path::new(text);
            // Who types semicolons or nothing but numbers means no file.
            let means_file = path.exists() || text.chars().any(char::is_alphabetic);
            match means_file && !text.contains(';') {
                true => read_places(path).map_err(|error| error.to_string()),
                false => Err(fault.to_string()),
            }
        }
    }
}

/// One place, `x,y`.
pub(in crate::cli) fn place(text: &str) -> Result<DVec2, String> {
    match typed_places(text).map_err(|fault| fault.to_string())?[..] {
        [place] => Ok(place),
        _ => Err("give one place: x,y".to_owned()),
    }
}
