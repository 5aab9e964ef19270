//! Changing the text of a flight.toml, so that its comments and its layout stay.

mod decisions;

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

use self::decisions::set_decisions;
use super::plan_entry::set_plan;
use super::uncertainty_entry::Axes;
use super::{FlightFile, FlightSettings, Placed, ScaleObject, unit_word, up_word};
use crate::fault::Fault;
use crate::scale::{Ground, ImageKind, ScalePair, StatedErrors};

/// The keys of a flight.toml that hold paths, with their tables.
const PATHS: [(&str, &str); 5] = [
    ("surface", "file"),
    ("photos", "poses"),
    ("photos", "reconstruction"),
    ("photos", "folder"),
    ("camera", "file"),
];

impl FlightFile {
    /// The text of a flight.toml with other settings. What is set already stays as it is written;
    /// what is not set any more goes.
    ///
    /// # Errors
    /// Where the text is no flight, or the settings cannot be those of one.
    pub fn text_with_settings(text: &str, settings: &FlightSettings) -> Result<String, Fault> {
        let old = Self::parse(text)?.settings();
        let mut document = document(text)?;
        if unit_word(settings) != unit_word(&old) {
            set(&mut document, "world", "unit", unit_word(settings))?;
        }
        if settings.ground != old.ground {
            match settings.ground {
                Ground::Auto => set(&mut document, "world", "ground", "auto")?,
                Ground::At(z) => set(&mut document, "world", "ground", z)?,
            }
        }
        let (new_surface, old_surface) = (settings.surface, old.surface);
        for (key, new, old) in [
            ("max_edge", new_surface.max_edge, old_surface.max_edge),
            ("thinning", new_surface.thinning, old_surface.thinning),
        ] {
            match new {
                _ if new == old => {}
                Some(length) => set(&mut document, "surface", key, length)?,
                None => unset(&mut document, "surface", key),
            }
        }
        if settings.surface_up != old.surface_up {
            match up_word(settings) {
                Some(axis) => set(&mut document, "surface", "up", axis)?,
                None => unset(&mut document, "surface", "up"),
            }
        }
        if settings.image != old.image {
            let image = match settings.image {
                ImageKind::Undistorted => "undistorted",
                ImageKind::AsShot => "as-shot",
            };
            set(&mut document, "scale", "image", image)?;
        }
        if settings.pair != old.pair {
            let pair = match settings.pair {
                ScalePair::Fitted => "fitted",
                ScalePair::Corners => "corners",
            };
            set(&mut document, "scale", "use", pair)?;
        }
        set_errors(&mut document, &old.errors, &settings.errors)?;
        if settings.scale_objects != old.scale_objects {
            set_scale_objects(&mut document, &old.scale_objects, &settings.scale_objects)?;
        }
        if settings.placed != old.placed {
            match &settings.placed {
                Some(placed) => set(&mut document, "world", "placed", inline(placed))?,
                None => unset(&mut document, "world", "placed"),
            }
        }
        if settings.decisions != old.decisions {
            set_decisions(&mut document, &old.decisions, &settings.decisions)?;
        }
        if settings.plan != old.plan {
            set_plan(&mut document, settings.plan.as_deref())?;
        }
        let text = with_line_ends_of(text, document.to_string());
        // What is read next time must be what was meant.
        let meant = FlightSettings {
            // They are in a file of their own.
            control: old.control,
            ..settings.clone()
        };
        if Self::parse(&text)?.settings() == meant {
            Ok(text)
        } else {
            Err(Fault::new(
                "the settings cannot be written into the flight file",
                "report this",
            ))
        }
    }

    /// The text of a flight.toml with another surface's file and another folder of image files, where
    /// they are given; paths relative to it.
    ///
    /// # Errors
    /// Where the text is no flight.
    pub fn text_with_files(
        text: &str,
        surface: Option<&str>,
        folder: Option<&str>,
    ) -> Result<String, Fault> {
        let old = Self::parse(text)?;
        let mut document = document(text)?;
        for (table, key, old, new) in [
            ("surface", "file", old.surface(), surface),
            ("photos", "folder", old.photo_folder(), folder),
        ] {
            if let Some(new) = new
                && old != Some(new)
            {
                set(&mut document, table, key, new)?;
                if key == "file"
                    && let Some(surface) = document.get_mut("surface").and_then(as_table)
                {
                    // It was said of the file before.
                    surface.remove("up");
                }
            }
        }
        Ok(with_line_ends_of(text, document.to_string()))
    }

    /// The text of a flight.toml with every path in it replaced by `path_for` of it: for a copy in
    /// another folder.
    ///
    /// # Errors
    /// Where the text is no flight, and those of `path_for`.
    pub fn text_with_paths(
        text: &str,
        path_for: impl Fn(&str) -> Result<String, Fault>,
    ) -> Result<String, Fault> {
        Self::parse(text)?;
        let mut document = document(text)?;
        let replace = |table: &mut dyn TableLike, key: &str| match table.get_mut(key) {
            Some(item) if item.is_str() => {
                let path = path_for(item.as_str().unwrap_or_default())?;
                put(item, path.into());
                Ok(())
            }
            _ => Ok(()),
        };
        for (table, key) in PATHS {
            match document.get_mut(table) {
                Some(Item::ArrayOfTables(tables)) => {
                    for table in tables.iter_mut() {
                        replace(table, key)?;
                    }
                }
                Some(Item::Value(Value::Array(tables))) => {
                    for table in tables.iter_mut().filter_map(Value::as_inline_table_mut) {
                        replace(table, key)?;
                    }
                }
                Some(item) => {
                    if let Some(table) = as_table(item) {
                        replace(table, key)?;
                    }
                }
                None => {}
            }
        }
        Ok(with_line_ends_of(text, document.to_string()))
    }
}

/// toml_edit writes LF alone; a file from Windows keeps its CRLF.
fn with_line_ends_of(before: &str, now: String) -> String {
    if before.contains("\r\n") {
        now.replace("\r\n", "\n").replace('\n', "\r\n")
    } else {
        now
    }
}

fn document(text: &str) -> Result<DocumentMut, Fault> {
    text.parse().map_err(|error: toml_edit::TomlError| {
        Fault::new(
            error.message().to_owned(),
            "see the flight file's format in docs/flights.md",
        )
    })
}

fn as_table(item: &mut Item) -> Option<&mut dyn TableLike> {
    item.as_table_like_mut()
}

/// Sets a key of a table, both of which may be missing so far.
fn set(
    document: &mut DocumentMut,
    table: &str,
    key: &str,
    value: impl Into<Value>,
) -> Result<(), Fault> {
    let item = document
        .entry(table)
        .or_insert_with(|| Item::Table(toml_edit::Table::new()));
    let table = as_table(item)
        .ok_or_else(|| Fault::new(format!("{table} is no table"), format!("write [{table}]")))?;
    put(table.entry(key).or_insert(Item::None), value.into());
    Ok(())
}

/// How the flight was brought to the world, as a value in one line.
fn inline(placed: &Placed) -> Value {
    let mut table = toml_edit::InlineTable::new();
    let transform: Array = placed.transform.iter().copied().collect();
    table.insert("transform", transform.into());
    if let Some(crs) = &placed.crs {
        table.insert("crs", crs.as_str().into());
    }
    table.into()
}

/// Takes a key out of a table, where there is one.
fn unset(document: &mut DocumentMut, table: &str, key: &str) {
    if let Some(table) = document.get_mut(table).and_then(as_table) {
        table.remove(key);
    }
}

/// Changes the keys of `[uncertainty]` that are to be others.
fn set_errors(
    document: &mut DocumentMut,
    old: &StatedErrors,
    new: &StatedErrors,
) -> Result<(), Fault> {
    let axes = |axes: glam::DVec3| match Axes::from(axes) {
        Axes::All(value) => Value::from(value),
        Axes::Each(values) => Value::from(values.into_iter().collect::<Array>()),
    };
    let values = |errors: &StatedErrors| {
        [
            ("position", errors.pose.position.map(axes)),
            ("angle", errors.pose.angle.map(axes)),
            ("focal", errors.focal.map(Value::from)),
            ("surface", errors.surface.map(Value::from)),
            ("world_scale", errors.world_scale.map(Value::from)),
        ]
    };
    let same = [
        old.pose.position == new.pose.position,
        old.pose.angle == new.pose.angle,
        old.focal == new.focal,
        old.surface == new.surface,
        old.world_scale == new.world_scale,
    ];
    for ((key, value), same) in values(new).into_iter().zip(same) {
        match value {
            _ if same => {}
            Some(value) => set(document, "uncertainty", key, value)?,
            None => unset(document, "uncertainty", key),
        }
    }
    Ok(())
}

/// Replaces the scale objects. Those that stay keep their tables as they are written; one that is
/// changed in its place keeps what was not changed.
fn set_scale_objects(
    document: &mut DocumentMut,
    old: &[ScaleObject],
    new: &[ScaleObject],
) -> Result<(), Fault> {
    let written = match document.remove("scale_object") {
        None => ArrayOfTables::new(),
        Some(item) => item.into_array_of_tables().map_err(|_| {
            Fault::new(
                "scale_object is no list of tables",
                "write [[scale_object]]",
            )
        })?,
    };
    let mut tables = ArrayOfTables::new();
    for (place, object) in new.iter().enumerate() {
        let same = old.iter().position(|before| before == object);
        let before = same.or_else(|| {
            let before = old.get(place)?;
            (!new.contains(before)).then_some(place)
        });
        let mut table = before
            .and_then(|before| written.get(before))
            .cloned()
            .unwrap_or_else(Table::new);
        let before = before.and_then(|before| old.get(before));
        let changed = |is_other: &dyn Fn(&ScaleObject) -> bool| before.is_none_or(is_other);
        if changed(&|before| before.photo != object.photo) {
            put_in(&mut table, "photo", object.photo.as_str());
        }
        if changed(&|before| before.kind != object.kind) {
            put_in(&mut table, "kind", object.kind.as_str());
        }
        if changed(&|before| before.size != object.size) {
            put_in(&mut table, "size", object.size);
        }
        if changed(&|before| before.outline != object.outline) {
            let points = object.outline.iter().map(|point| {
                let point: Array = point.to_array().into_iter().collect();
                Value::from(point)
            });
            put_in(&mut table, "outline", points.collect::<Array>());
        }
        if changed(&|before| before.mask != object.mask) {
            put_in(&mut table, "mask", object.mask);
        }
        tables.push(table);
    }
    if !tables.is_empty() {
        document.insert("scale_object", Item::ArrayOfTables(tables));
    }
    Ok(())
}

fn put_in(table: &mut Table, key: &str, value: impl Into<Value>) {
    put(table.entry(key).or_insert(Item::None), value.into());
}

/// Puts a value where another one is; the space and the comment around it stay.
fn put(item: &mut Item, mut value: Value) {
    if let Some(old) = item.as_value() {
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
}

#[cfg(test)]
mod tests;
