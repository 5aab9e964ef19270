//! The photo of a flight that somebody names.

use super::Flight;
use crate::fault::Fault;

impl Flight {
    /// The place of the photo with this name.
    ///
    /// # Errors
    /// Where there is none; the nearest name is said.
    pub fn photo_named(&self, name: &str) -> Result<usize, Fault> {
        let photos = &self.parts.photos;
        if let Some(found) = photos.iter().position(|photo| photo.name == name) {
            return Ok(found);
        }
        let likeness = |other: &str| {
            strsim::normalized_damerau_levenshtein(&name.to_lowercase(), &other.to_lowercase())
        };
        let names = photos.iter().map(|photo| photo.name.as_str());
        let nearest = names.max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
        // A flight has at least one photo; of a surface to look at nobody asks.
        let nearest = nearest.unwrap_or_default();
        let remedy = match likeness(nearest) > 0.5 {
            true => format!("the nearest name is '{nearest}'"),
            false => format!("name one of the flight, like '{nearest}'"),
        };
        Err(Fault::new(format!("there is no photo '{name}'"), remedy))
    }
}
