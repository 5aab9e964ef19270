//! The photo of a flight that somebody names.

use super::Flight;
use crate::fault::Fault;
use crate::files::same_name;

impl Flight {
    /// The place of the photo that somebody types: where none has that name to the letter, the only one whose name a shell or a
    /// file system spells so (`files::same_name`).
    ///
    /// # Errors
    /// Where there is none; the nearest name is said.
    pub fn photo_typed(&self, name: &str) -> Result<usize, Fault> {
        self.photo_named(name).or_else(|fault| {
            let wanted = same_name::key(name);
            let photos = self.parts.photos.iter().zip(0..);
            let mut alike = photos.filter(|(photo, _)| same_name::key(&photo.name) == wanted);
            match (alike.next(), alike.next()) {
                (Some((_, found)), None) => Ok(found),
                _ => Err(fault),
            }
        })
    }

    /// The place of the photo with this name, as a file of the flight has it.
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
