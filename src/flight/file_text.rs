//! Changing the text of a flight.toml, so that its comments and its layout stay.

use toml_edit::{DocumentMut, Item, TableLike, Value};

use super::{FlightFile, FlightSettings};
use crate::fault::Fault;
use crate::scale::{Ground, ImageKind};

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
        if settings.unit != old.unit {
            set(&mut document, "world", "unit", settings.unit.symbol())?;
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
                None => {
                    if let Some(table) = document.get_mut("surface").and_then(as_table) {
                        table.remove(key);
                    }
                }
            }
        }
        if settings.image != old.image {
            let image = match settings.image {
                ImageKind::Undistorted => "undistorted",
                ImageKind::AsShot => "as-shot",
            };
            set(&mut document, "scale", "image", image)?;
        }
        let text = with_line_ends_of(text, document.to_string());
        // What is read next time must be what was meant.
        if Self::parse(&text)?.settings() == *settings {
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
            "see the flight file's format in README",
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

/// Puts a value where another one is; the space and the comment around it stay.
fn put(item: &mut Item, mut value: Value) {
    if let Some(old) = item.as_value() {
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::flight::ReconstructionFlight;
    use crate::surface::SurfaceOptions;
    use crate::units::LengthUnit;

    const COMMENTED: &str = r#"# The east bench, shot 12.
format = 1

[world]
unit = "m"       # UTM 30N
ground = 160     # toe of the face

[surface]
file = 'pile.ply'
max_edge = 2.50  # shadow behind the shovel

# Two devices.
[[camera]]
file = "ost.yaml"

[photos]
poses = "poses.csv"
folder = "photos"
"#;

    fn settings() -> FlightSettings {
        FlightFile::parse(COMMENTED).unwrap().settings()
    }

    #[test]
    fn nothing_changes_where_nothing_is_changed() {
        let text = FlightFile::text_with_settings(COMMENTED, &settings()).unwrap();
        assert_eq!(text, COMMENTED);
    }

    #[test]
    fn only_what_is_changed_changes() {
        let mut settings = settings();
        settings.ground = Ground::At(161.25);
        settings.surface.thinning = Some(0.1);
        settings.image = ImageKind::AsShot;
        let text = FlightFile::text_with_settings(COMMENTED, &settings).unwrap();
        let expected = COMMENTED
            .replace("ground = 160     #", "ground = 161.25     #")
            .replace("behind the shovel\n", "behind the shovel\nthinning = 0.1\n")
            + "\n[scale]\nimage = \"as-shot\"\n";
        assert_eq!(text, expected);
        settings.surface = SurfaceOptions::default();
        settings.ground = Ground::Auto;
        let text = FlightFile::text_with_settings(&text, &settings).unwrap();
        assert!(text.contains("ground = \"auto\"     # toe"), "{text}");
        assert!(!text.contains("max_edge") && !text.contains("thinning"));
        assert!(text.starts_with("# The east bench, shot 12.\n"));
    }

    #[test]
    fn a_file_from_windows_keeps_its_line_ends() {
        let text = COMMENTED.replace('\n', "\r\n");
        let mut settings = settings();
        assert_eq!(
            FlightFile::text_with_settings(&text, &settings).unwrap(),
            text
        );
        settings.ground = Ground::At(161.25);
        assert_eq!(
            FlightFile::text_with_settings(&text, &settings).unwrap(),
            text.replace("= 160 ", "= 161.25 ")
        );
    }

    #[test]
    fn what_cannot_be_set_is_refused() {
        let mut settings = settings();
        settings.surface.max_edge = Some(f64::NAN);
        assert!(FlightFile::text_with_settings(COMMENTED, &settings).is_err());
        assert!(FlightFile::text_with_settings("format = 1", &settings).is_err());
    }

    #[test]
    fn paths_are_replaced_wherever_they_stand() {
        let moved = |path: &str| Ok(format!("../old/{path}"));
        let text = FlightFile::text_with_paths(COMMENTED, moved).unwrap();
        let mut expected = COMMENTED.replace("'pile.ply'", "\"../old/pile.ply\"");
        for path in ["ost.yaml", "poses.csv", "photos"] {
            expected = expected.replace(&format!("\"{path}\""), &format!("\"../old/{path}\""));
        }
        assert_eq!(text, expected);
        let short = "format = 1\nworld.unit = \"m\"\nphotos = { reconstruction = \"a.nvm\" }\n\
            camera = [{ width = 3, height = 2 }]\nsurface.file = \"b.ply\"\n";
        let text = FlightFile::text_with_paths(short, moved).unwrap();
        assert!(
            text.contains("reconstruction = \"../old/a.nvm\" }"),
            "{text}"
        );
        assert!(text.contains("surface.file = \"../old/b.ply\"\n"), "{text}");
        let refused = |_: &str| Err(Fault::new("no", "way"));
        assert!(FlightFile::text_with_paths(short, refused).is_err());
    }

    fn any_settings() -> impl Strategy<Value = FlightSettings> {
        let length = || prop::option::of(1e-6..1e6_f64);
        let ground = prop_oneof![
            Just(Ground::Auto),
            (-1e4..1e4_f64).prop_map(Ground::At),
            (-100..100_i32).prop_map(|z| Ground::At(f64::from(z))),
        ];
        let image = prop_oneof![Just(ImageKind::Undistorted), Just(ImageKind::AsShot)];
        (0..LengthUnit::ALL.len(), ground, image, length(), length()).prop_map(
            |(unit, ground, image, max_edge, thinning)| FlightSettings {
                unit: LengthUnit::ALL[unit],
                ground,
                image,
                surface: SurfaceOptions { max_edge, thinning },
            },
        )
    }

    /// The ways in which TOML writes one thing.
    const TEXTS: [&str; 4] = [
        COMMENTED,
        "format = 1\n[photos]\nreconstruction = \"sparse/0\"\n[world]\nunit = \"us-ft\"",
        "format = 1\nworld = { unit = \"mm\" }\nphotos = { reconstruction = \"a.nvm\" }\n",
        "format = 1\r\nworld.unit = \"ft\"\r\nphotos.reconstruction = \"a.nvm\"\r\nsurface.thinning = 1_0.0\r\nscale = { image = \"as-shot\", }\r\n",
    ];

    proptest! {
        #[test]
        fn what_is_set_reads_back(
            which in 0..TEXTS.len(),
            steps in prop::collection::vec(any_settings(), 1..4),
        ) {
            let mut text = TEXTS[which].to_owned();
            let first = FlightFile::parse(&text).unwrap();
            for settings in steps {
                text = FlightFile::text_with_settings(&text, &settings).unwrap();
                let file = FlightFile::parse(&text).unwrap();
                prop_assert_eq!(file.settings(), settings);
                prop_assert_eq!(file.photo_source(), first.photo_source());
                prop_assert_eq!(&file.cameras, &first.cameras);
                prop_assert_eq!(file.surface(), first.surface());
            }
        }

        #[test]
        fn a_reconstructions_flight_reads_back(
            settings in any_settings(),
            name in "\\PC*",
            surface in prop::option::of("[a-z ü\"\\\\]{1,9}"),
        ) {
            let flight = ReconstructionFlight {
                name: &name,
                reconstruction: "../odm",
                transform: Some([0.1, 0.0, 0.0, 5e5, 0.0, 0.1, 0.0, 5e6, 0.0, 0.0, 0.1, 1.0 / 3.0, 0.0, 0.0, 0.0, 1.0]),
                folder: Some("../odm/images"),
                surface: surface.as_deref(),
                crs: Some("EPSG:32633"),
            };
            let file = FlightFile::for_reconstruction(&flight, &settings);
            let read = FlightFile::parse(&file.to_toml().unwrap()).unwrap();
            prop_assert_eq!(read.settings(), settings);
            prop_assert_eq!(read, file);
        }
    }
}
