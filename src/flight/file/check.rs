//! What a flight.toml must keep to that its types do not say.

use super::{FlightFile, UNKNOWN_UNIT};
use crate::fault::Fault;
use crate::geometry::Similarity;
use crate::scale::Ground;
use crate::surface::{SurfaceError, UpAxis};
use crate::units::LengthUnit;

impl FlightFile {
    /// Refuses what contradicts itself; `line` tells where a key of a table stands.
    pub(super) fn check(&self, line: impl Fn(&str, &str) -> u64) -> Result<(), Fault> {
        let at = |table: &str, key: &str, what: String, remedy: &str| {
            Err(Fault::at(line(table, key), what, remedy))
        };
        if self.format != 1 {
            let what = format!("format {} is not known", self.format);
            return at(
                "",
                "format",
                what,
                "write format = 1, or use a newer fragscale",
            );
        }
        if self.world.unit != UNKNOWN_UNIT
            && let Err(unknown) = self.world.unit.parse::<LengthUnit>()
        {
            let what = format!("world.unit {unknown}");
            return at("world", "unit", what, "name the unit of the coordinates");
        }
        if let Ground::At(z) = self.world.ground.0
            && !z.is_finite()
        {
            return at(
                "world",
                "ground",
                format!("the ground is {z}"),
                "give a finite elevation or \"auto\"",
            );
        }
        if self.crs() == Some("") {
            let what = "world.crs is empty".to_owned();
            return at("world", "crs", what, "name a system, or remove the key");
        }
        if let Some(placed) = &self.world.placed {
            let sixteen: Option<&[f64; 16]> = placed.transform.as_slice().try_into().ok();
            let trouble = match sixteen.map(Similarity::from_row_major) {
                None => Some(format!("it has {} numbers", placed.transform.len())),
                Some(Err(error)) => Some(error.to_string()),
                Some(Ok(_)) => None,
            };
            if let Some(trouble) = trouble {
                let what = format!("world.placed.transform: {trouble}");
                return at(
                    "world",
                    "placed",
                    what,
                    "give the 16 of a row-major 4x4 similarity",
                );
            }
        }
        let photos = &self.photos;
        let camera_files = self
            .cameras
            .iter()
            .map(|camera| ("camera", "file", &camera.file));
        let files = [
            ("photos", "poses", &photos.poses),
            ("photos", "reconstruction", &photos.reconstruction),
            ("photos", "folder", &photos.folder),
            ("photos", "topic", &photos.topic),
        ];
        for (table, key, file) in files.into_iter().chain(camera_files) {
            if file.as_deref() == Some("") {
                return at(
                    table,
                    key,
                    format!("{table}.{key} is empty"),
                    if key == "topic" {
                        "name a topic, or remove the key"
                    } else {
                        "name a file, or remove the key"
                    },
                );
            }
        }
        if self.surface() == Some("") {
            return at(
                "surface",
                "file",
                "surface.file is empty".to_owned(),
                "name a cloud or mesh",
            );
        }
        if let Some(up) = self.surface.as_ref().and_then(|s| s.up.as_deref()) {
            if let Err(unknown) = up.parse::<UpAxis>() {
                let what = format!("surface.up {unknown}");
                return at("surface", "up", what, "write \"x\", \"y\" or \"z\"");
            }
            if self.surface().is_none() {
                let what = "surface.up belongs to surface.file".to_owned();
                return at("surface", "up", what, "remove it, or name the file");
            }
        }
        if let Err(SurfaceError::Option { name, value }) = self.surface_options().validate() {
            return at(
                "surface",
                name,
                format!("surface.{name} is {value}"),
                "give a positive length in the world's unit, or remove the key",
            );
        }
        if let Some((key, value)) = self.errors().trouble() {
            return at(
                "uncertainty",
                key,
                format!("uncertainty.{key} is {value}"),
                "give a standard deviation that is neither negative nor beyond all measure, or remove the key",
            );
        }
        match (&photos.poses, &photos.reconstruction) {
            (Some(_), Some(_)) => {
                let what = "photos has both poses and reconstruction".to_owned();
                return at("photos", "poses", what, "keep the one that holds");
            }
            // Over a surface a flight may be planned before there is one.
            (None, None)
                if self.plan.is_some() && self.surface().is_some() && photos.is_empty() => {}
            (None, None) => {
                let what = "photos has neither poses nor reconstruction".to_owned();
                return at(
                    "photos",
                    "folder",
                    what,
                    "name the poses.csv or the reconstruction",
                );
            }
            (Some(_), None) if self.surface().is_none() => {
                let what = "there is no surface".to_owned();
                return at("", "world", what, "add [surface] file = \"...\"");
            }
            _ => {}
        }
        if let Some(transform) = &photos.transform {
            if photos.reconstruction.is_none() {
                let what = "photos.transform belongs to a reconstruction".to_owned();
                return at(
                    "photos",
                    "transform",
                    what,
                    "remove it, or use reconstruction",
                );
            }
            if transform.len() != 16 {
                let what = format!("photos.transform has {} numbers", transform.len());
                return at(
                    "photos",
                    "transform",
                    what,
                    "give the 16 of a row-major 4x4",
                );
            }
        }
        Ok(())
    }
}
