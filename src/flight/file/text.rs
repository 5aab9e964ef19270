//! Changing the text of a flight.toml, so that its comments and its layout stay.

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

use super::decisions_text::set_decisions;
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

pub(super) fn put_in(table: &mut Table, key: &str, value: impl Into<Value>) {
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
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::control::ControlList;
    use crate::flight::{Date, Decision, DecisionKind, ReconstructionFlight};
    use crate::plan::{
        AskedPlan, Drone, Edit, Flying, Pattern, PhotoAt, Positioning, Size, SurveyWish,
    };
    use crate::scale::PoseErrors;
    use crate::scale::ScaleObjectKind;
    use crate::surface::{SurfaceOptions, UpAxis};
    use crate::units::LengthUnit;
    use glam::DVec2;

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

    /// Said of the surface's own file; z need not be said, and without a file nothing can be.
    #[test]
    fn another_axis_is_up() {
        let up = |surface_up| FlightSettings {
            surface_up,
            ..settings()
        };
        let text = FlightFile::text_with_settings(COMMENTED, &up(UpAxis::Y)).unwrap();
        assert_eq!(FlightFile::parse(&text).unwrap().surface_up(), UpAxis::Y);
        let back = FlightFile::text_with_settings(&text, &up(UpAxis::Z)).unwrap();
        let expected = FlightFile::text_with_settings(COMMENTED, &settings()).unwrap();
        assert_eq!(back, expected);
        let other = FlightFile::text_with_files(&text, Some("other.ply"), None).unwrap();
        assert_eq!(FlightFile::parse(&other).unwrap().surface_up(), UpAxis::Z);
        let without = "format = 1\nworld.unit = \"m\"\nphotos.reconstruction = \"a.nvm\"\n";
        assert!(FlightFile::text_with_settings(without, &up(UpAxis::Y)).is_err());
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
        let objects = prop::collection::vec(any_object(), 0..4);
        let settings = (0..LengthUnit::ALL.len(), ground, image, length(), length());
        let axes = || prop::option::of((0.0..2.0_f64, 0.0..2.0_f64, any::<bool>()));
        let errors = (axes(), axes(), length(), length(), length(), any::<bool>());
        let axes = |axes: Option<(f64, f64, bool)>| {
            axes.map(|(x, y, same)| glam::DVec3::new(x, if same { x } else { y }, x))
        };
        let errors = errors.prop_map(
            move |(position, angle, focal, surface, world_scale, corners)| {
                let pose = PoseErrors {
                    position: axes(position),
                    angle: axes(angle),
                };
                let errors = StatedErrors {
                    pose,
                    focal,
                    surface,
                    world_scale,
                };
                let pair = match corners {
                    true => ScalePair::Corners,
                    false => ScalePair::Fitted,
                };
                (errors, pair)
            },
        );
        let placed = prop::option::of((0.1..9.0_f64, -1e7..1e7_f64, any::<bool>()));
        let plan = prop::option::of(any_plan());
        (settings, errors, objects, any_decisions(), placed, plan).prop_map(
            |(
                (unit, ground, image, max_edge, thinning),
                (errors, pair),
                scale_objects,
                decisions,
                placed,
                plan,
            )| {
                let placed = placed.map(|(scale, x, is_named)| Placed {
                    transform: Box::new([
                        scale,
                        0.0,
                        0.0,
                        x,
                        0.0,
                        scale,
                        0.0,
                        5e6,
                        0.0,
                        0.0,
                        scale,
                        1.0 / 3.0,
                        0.0,
                        0.0,
                        0.0,
                        1.0,
                    ]),
                    crs: is_named.then(|| "EPSG:32633".to_owned()),
                });
                FlightSettings {
                    pair,
                    errors,
                    unit: LengthUnit::ALL[unit],
                    unit_known: true,
                    ground,
                    image,
                    surface: SurfaceOptions { max_edge, thinning },
                    surface_up: UpAxis::Z,
                    scale_objects,
                    decisions,
                    placed,
                    plan: plan.map(Box::new),
                    control: ControlList::default(),
                }
            },
        )
    }

    fn any_plan() -> impl Strategy<Value = AskedPlan> {
        let size = || {
            (
                1.0..900.0_f64,
                prop::option::of(0.1..9.0_f64),
                any::<bool>(),
            )
                .prop_map(|(value, within, is_scale)| match is_scale {
                    true => Size::Scale {
                        pixels: value,
                        within,
                    },
                    false => Size::Distance(value),
                })
        };
        let place = || (-1e7..1e7_f64, 0.0..1e7_f64).prop_map(|(x, y)| DVec2::new(x, y));
        let edit = (0..3, place(), place()).prop_map(|(kind, at, place)| {
            let photo = |name: &str| PhotoAt {
                name: name.to_owned(),
                at,
            };
            match kind {
                0 => Edit::Move(photo("P \"1\""), place),
                1 => Edit::Add(place),
                _ => Edit::Leave(photo("P2")),
            }
        });
        let area = || {
            (place(), 1.0..90.0_f64).prop_map(|(at, side)| {
                vec![at, at + DVec2::new(side, 0.0), at + DVec2::new(0.0, side)]
            })
        };
        let photos = (
            prop::sample::select(Pattern::ALL.to_vec()),
            size(),
            prop::option::of(size()),
            prop::option::of(prop::sample::select(Drone::ALL.to_vec())),
            prop::sample::select(Positioning::ALL.to_vec()),
            any::<[bool; 3]>(),
        );
        let places = (
            prop::option::of(area()),
            prop::collection::vec(area(), 0..3),
            prop::option::of(place()),
            prop::collection::vec(edit, 0..4),
        );
        let numbers = (
            prop::array::uniform8(0.0..90.0_f64),
            prop::option::of(1.0..60.0_f64),
            prop::option::of(Just("2026-11-22T10:00+01:00".to_owned())),
        );
        (photos, places, numbers).prop_map(
            |(
                (pattern, size, of_survey, drone, positioning, [fill_gaps, cross, ring]),
                (area, keep_out, take_off, edits),
                (n, battery, when),
            )| AskedPlan {
                pattern,
                size,
                overlap: n[0] / 100.0,
                survey: SurveyWish {
                    overlap: n[1] / 100.0,
                    cross,
                    ring,
                    size: of_survey,
                },
                fill_gaps,
                tilt: n[2],
                off_normal: n[3],
                drone,
                positioning,
                clearance: n[4],
                area,
                keep_out,
                take_off,
                flying: Flying {
                    speed: n[5],
                    settle: n[6],
                    battery,
                    climb: n[7],
                    descent: n[7] / 3.0,
                    steepest: battery.map(|minutes| minutes / 2.0),
                },
                when,
                edits,
            },
        )
    }

    /// Of three photos at most, each once.
    fn any_decisions() -> impl Strategy<Value = Vec<Decision>> {
        let kind = prop_oneof![Just(DecisionKind::Accepted), Just(DecisionKind::LeftOut)];
        let note = prop::sample::select(vec!["", "flat toe", "\"ä\" # \\"]);
        let date = prop::option::of((1..=9999_u16, 1..=12_u8, 1..=28_u8));
        let reasons = prop::sample::subsequence(vec!["flat-view", "off-line", "ratio"], 0..4);
        let decided = (kind, note, date, prop::option::of(reasons));
        prop::collection::hash_map(0..3_usize, decided, 0..4).prop_map(|decided| {
            let decided = decided.into_iter();
            let of_photo = decided.map(|(photo, (kind, note, date, reasons))| Decision {
                photo: ["a.jpg", "ä \"1\".jpg", "c"][photo].to_owned(),
                kind,
                note: note.to_owned(),
                date: date.and_then(|(year, month, day)| Date::new(year, month, day)),
                reasons: reasons.map(|kinds| kinds.into_iter().map(str::to_owned).collect()),
            });
            of_photo.collect()
        })
    }

    /// Few photos and sizes, so that some objects are the same.
    fn any_object() -> impl Strategy<Value = ScaleObject> {
        let photo = prop::sample::select(vec!["a.jpg", "ä \"1\".jpg"]);
        let points = prop::collection::vec((-9.0..4e3_f64, 0..3000_i32), 3..6);
        (photo, any::<bool>(), 1..4_i32, points, any::<bool>()).prop_map(
            |(photo, is_bar, size, points, mask)| {
                let points = points.into_iter().map(|(x, y)| DVec2::new(x, f64::from(y)));
                ScaleObject {
                    photo: photo.to_owned(),
                    kind: match is_bar {
                        true => ScaleObjectKind::Bar,
                        false => ScaleObjectKind::Sphere,
                    },
                    size: f64::from(size) / 4.0,
                    outline: points.take(if is_bar { 2 } else { 9 }).collect(),
                    mask,
                }
            },
        )
    }

    const OBJECTS: &str = r#"
# The red ball at the toe.
[[scale_object]]
photo = "a.jpg"
kind = "sphere"
size = 0.25          # by calliper
outline = [[1, 2], [3, 4.5], [5, 6]]

# The board.
[[scale_object]]
photo = "b.jpg"
kind = "bar"
size = 2
outline = [[10.0, 20.0], [30.0, 40.0]]
mask = false
"#;

    #[test]
    fn scale_objects_keep_what_is_not_changed() {
        let text = COMMENTED.to_owned() + OBJECTS;
        let mut settings = FlightFile::parse(&text).unwrap().settings();
        let changed = |settings: &FlightSettings| FlightFile::text_with_settings(&text, settings);
        assert_eq!(changed(&settings).unwrap(), text);
        assert!(settings.scale_objects[0].mask && !settings.scale_objects[1].mask);
        settings.scale_objects[0].size = 0.3;
        settings.scale_objects[1].outline[0].x = 11.5;
        let expected = text
            .replace("size = 0.25 ", "size = 0.3 ")
            .replace("[10.0, 20.0]", "[11.5, 20.0]");
        assert_eq!(changed(&settings).unwrap(), expected);
        // Without the first the second stays with its comment.
        let mut settings = FlightFile::parse(&text).unwrap().settings();
        let first = settings.scale_objects.remove(0);
        let (before, board) = text.split_once("\n# The red").unwrap();
        let board = &board[board.find("\n# The board").unwrap()..];
        assert_eq!(changed(&settings).unwrap(), before.to_owned() + board);
        settings.scale_objects.clear();
        assert_eq!(changed(&settings).unwrap(), COMMENTED);
        settings.scale_objects = vec![first];
        let text = FlightFile::text_with_settings(COMMENTED, &settings).unwrap();
        let added = "\n[[scale_object]]\nphoto = \"a.jpg\"\nkind = \"sphere\"\nsize = 0.25\n\
            outline = [[1.0, 2.0], [3.0, 4.5], [5.0, 6.0]]\nmask = true\n";
        assert_eq!(text, COMMENTED.to_owned() + added);
    }

    /// The ways in which TOML writes one thing.
    const TEXTS: [&str; 6] = [
        COMMENTED,
        "format = 1\nworld.unit = \"m\"\nphotos.reconstruction = \"a.nvm\"\nscale_object = [{ photo = \"a.jpg\", kind = \"bar\", size = 0.25, outline = [[1, 2], [3, 4]] }]\n",
        "format = 1\n[[scale_object]]\nphoto = \"a.jpg\"\nkind = \"bar\"\nsize = 1\noutline = [[1, 2], [3, 4]]\n\n[world]\nunit = \"ft\"\n[photos]\nreconstruction = \"a.nvm\"\n",
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
