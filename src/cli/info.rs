//! `fragscale info`: what a file or folder holds.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::Answer;
use crate::batch::Season;
use crate::exports::crs_in_words;
use crate::fault::one_line;
use crate::files::{FileError, read_text};
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::numbers::counted;
use crate::opening;

#[derive(Debug, Args)]
pub(super) struct InfoArguments {
    /// Any file or folder that fragscale reads.
    file: PathBuf,
    /// How to write it.
    #[arg(long, value_enum, default_value = "text")]
    format: InfoFormat,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum InfoFormat {
    Text,
    Json,
}

pub(super) fn info(arguments: &InfoArguments, progress: &Progress) -> Result<Answer, String> {
    let value = match season(&arguments.file) {
        Some(season) => season,
        None => opening::info(&arguments.file, progress),
    };
    let value = value.map_err(|error| error.to_string())?;
    let text = match arguments.format {
        InfoFormat::Json => format!("{value}\n"),
        InfoFormat::Text => info_text(&value),
    };
    Ok(Answer::new(text, Vec::new()))
}

/// What a SEASON.toml names, or what is wrong with it; `None` of any other file.
fn season(path: &Path) -> Option<Result<Value, FileError>> {
    if !Season::is_season(path) {
        return None;
    }
    let season = match Season::read(path) {
        Ok(season) => season,
        // A flight of which much is missing still is one, and its own faults are said.
        Err(error) => return names_flights(path).then_some(Err(error)),
    };
    Some(season_info(&season))
}

/// Whether a text has the tables of a season, which no flight has.
fn names_flights(path: &Path) -> bool {
    let text = read_text(path).unwrap_or_default();
    text.lines().any(|line| line.trim() == "[[flight]]")
}

fn season_info(season: &Season) -> Result<Value, FileError> {
    // Without one there are none to be told from flights.
    let found = season.flights(season.to.as_deref().unwrap_or(Path::new("")))?;
    let flights = found.flights.iter().map(|flight| {
        json!({
            "blast": flight.blast,
            "date": flight.date.map(|date| date.to_string()),
            "path": flight.path.display().to_string(),
        })
    });
    let flights: Vec<Value> = flights.collect();
    let steps = season.asked.steps.iter();
    let steps: Vec<&str> = steps.map(|asked| asked.step.as_str()).collect();
    let count = counted(flights.len(), "flight");
    Ok(json!({
        "kind": "season",
        "what": format!("a season of {count}: 'fragscale batch' goes through it"),
        "name": season.name,
        "unit": season.asked.unit,
        "steps": steps,
        "flights": flights,
        "warnings": found.notes,
    }))
}

/// The top level of an `info` value, a line each; of lists how long they are.
fn info_text(value: &Value) -> String {
    let mut text = String::new();
    let are_photos_alone = value["kind"] == "photos";
    // A trajectory's and a recording's are of no photos yet, and state no coordinate system.
    let are_poses_alone = value["over_time"] == true;
    let crs = value["crs"].as_str();
    let is_camera = value["kind"] == "camera";
    for (key, value) in value.as_object().into_iter().flatten() {
        if are_poses_alone && ["over_time", "crs"].contains(&key.as_str()) {
            continue;
        }
        let shown = match value {
            Value::Null => "not stated".to_owned(),
            Value::Number(_) if key == "speed" => format!("{} m/s", short(value)),
            Value::Number(_) if ["safe_height", "return_height"].contains(&key.as_str()) => {
                format!("{} m above the take-off", short(value))
            }
            Value::Object(_) if key == "take_off" => take_off(value),
            Value::Object(_) if key == "bounds" => bounds(value, crs),
            Value::String(text) if key == "crs" => system(text),
            Value::String(text) => text.clone(),
            Value::Array(list) if key == "warnings" => {
                for warning in list {
                    text += &format!("warning: {}\n", warning.as_str().unwrap_or_default());
                }
                continue;
            }
            Value::Array(list) if key == "topics" => {
                for topic in list {
                    let of = |key: &str| topic[key].as_str().unwrap_or_default();
                    let poses = match topic["gives_poses"].as_bool() {
                        Some(true) => ", gives poses",
                        _ => "",
                    };
                    let (name, kind, count) = (of("name"), of("type"), &topic["messages"]);
                    text += &format!("topic: {name} ({kind}), {count} messages{poses}\n");
                }
                continue;
            }
            Value::Array(list) if key == "cameras" && are_photos_alone => {
                for camera in list {
                    let name = camera["name"].as_str().unwrap_or("not stated");
                    let (width, height) = (&camera["width"], &camera["height"]);
                    let photos = &camera["photos"];
                    text +=
                        &format!("camera: {name}, {width} x {height} pixels, photos: {photos}\n");
                }
                continue;
            }
            Value::Array(list) if key == "cameras" && is_camera => {
                text.extend(list.iter().map(camera));
                continue;
            }
            Value::Array(list) if key == "steps" => {
                let steps = list.iter().filter_map(Value::as_str);
                steps.collect::<Vec<_>>().join(", ")
            }
            Value::Array(list) if key == "photos" && are_poses_alone => {
                text += &format!("poses: {}\n", list.len());
                continue;
            }
            Value::Array(list) => list.len().to_string(),
            other => in_words(other),
        };
        text += &format!("{}: {shown}\n", key.replace('_', " "));
    }
    text
}

/// A number to a hundredth.
fn short(number: &Value) -> String {
    let number = number.as_f64().unwrap_or(f64::NAN);
    ((number * 100.0).round() / 100.0).to_string()
}

/// Where a drone takes off, as `fragscale mission` says it.
fn take_off(value: &Value) -> String {
    let of = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let (latitude, longitude) = (of(&value["latitude"]), of(&value["longitude"]));
    let elevation = &value["elevation"];
    let elevation = elevation["above"].as_str().map(|above| {
        let metres = of(&elevation["metres"]);
        format!(", {metres:.2} m above {above}")
    });
    format!(
        "{latitude:.7}, {longitude:.7}{}",
        elevation.unwrap_or_default()
    )
}

/// The least coordinates before the greatest, and what they are in where the system says one unit of all.
fn bounds(value: &Value, crs: Option<&str>) -> String {
    let crs = crs.and_then(|text| Crs::understand(text).ok());
    let is_of_heights = |crs: &Crs| (crs.vertical_unit_metres() - crs.unit_metres()).abs() < 1e-9;
    let unit = crs.filter(is_of_heights).and_then(|crs| crs.unit());
    let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    format!("min {}, max {}{unit}", value["min"], value["max"])
}

/// A camera's name, size and focal length in a line.
fn camera(value: &Value) -> String {
    let name = value["name"].as_str().filter(|name| !name.is_empty());
    let name = name.unwrap_or("not stated");
    let (width, height) = (&value["width"], &value["height"]);
    let [across, down] = ["fx", "fy"].map(|name| short(&value[name]));
    let focal = match across == down {
        true => across,
        false => format!("{across} x {down}"),
    };
    format!("camera: {name}, {width} x {height} pixels, focal length {focal} px\n")
}

/// A coordinate system in a line: its code, of one in WKT the name, and the code where there is one.
fn system(text: &str) -> String {
    let name = one_line(&crs_in_words(Some(text)));
    match Crs::understand(text) {
        Ok(crs) if crs.name().starts_with("EPSG:") && crs.name() != name => {
            format!("{name} ({})", crs.name())
        }
        _ => name,
    }
}

/// A value with what is in it, in a line.
fn in_words(value: &Value) -> String {
    match value {
        Value::Null => "not stated".to_owned(),
        Value::String(text) => text.clone(),
        Value::Object(parts) => {
            let parts = parts.iter().map(|(name, part)| match part {
                Value::Object(_) => format!("{name} ({})", in_words(part)),
                part => format!("{name} {}", in_words(part)),
            });
            parts.collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// EPSG:32633 as GDAL writes it (WKT 1, shortened by its datum's authority codes).
    const UTM_33: &str = r#"PROJCS["WGS 84 / UTM zone 33N",
        GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],
            PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],
        PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",15],
        PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],
        UNIT["metre",1],AUTHORITY["EPSG","32633"]]"#;

    #[test]
    fn a_system_is_a_name_and_a_code_in_one_line() {
        let text = info_text(&json!({"kind": "cloud", "crs": UTM_33}));
        assert_eq!(
            text,
            "crs: WGS 84 / UTM zone 33N (EPSG:32633)\nkind: cloud\n"
        );
        // One that no code is known of has its name alone.
        let own = UTM_33.replace("WGS 84 / UTM zone 33N", "Pit grid");
        let own = own.replace(",AUTHORITY[\"EPSG\",\"32633\"]", "");
        let own = own.replace("500000", "500123");
        let own = info_text(&json!({"crs": format!("\u{feff}{own}\n")}));
        assert_eq!(own, "crs: Pit grid\n");
        let code = info_text(&json!({"crs": "EPSG:32633"}));
        assert_eq!(code, "crs: EPSG:32633\n");
    }

    #[test]
    fn a_season_is_none_of_the_flights() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("SEASON.toml");
        let info = |text: &str| {
            fs::write(&path, text).unwrap();
            season(&path)
        };
        let start = "format = 1\nname = \"North\"\n";
        let flights = "[[flight]]\npath = \"a\"\n[[flight]]\npath = \"b\"\n";
        for name in ["a", "b"] {
            fs::create_dir(folder.path().join(name)).unwrap();
        }
        let text = format!("{start}steps = [\"scales\", \"check\"]\n{flights}");
        let said = info_text(&info(&text).unwrap().unwrap());
        assert!(said.contains("what: a season of 2 flights:"), "{said}");
        assert!(said.contains("steps: scales, check\n"), "{said}");
        let error = info(&format!("{start}color = 1\n{flights}")).unwrap();
        let error = error.unwrap_err().to_string();
        assert!(error.contains("unknown key 'color'"), "{error}");
        // A flight of which much is missing.
        assert!(info("format = 1\n[surface]\nfile = \"pile.ply\"\n").is_none());
    }

    #[test]
    fn photos_that_cannot_be_placed_are_told_by_their_cameras() {
        let camera = json!({"name": "DJI FC6310R", "width": 5472, "height": 3648, "photos": 2});
        let photos =
            json!({"kind": "photos", "cameras": [camera], "photos": ["a", "b"], "positions": 0});
        assert_eq!(
            info_text(&photos),
            "camera: DJI FC6310R, 5472 x 3648 pixels, photos: 2\nkind: photos\nphotos: 2\npositions: 0\n"
        );
    }

    #[test]
    fn a_mission_says_what_its_numbers_are_in() {
        let elevation = json!({"metres": 488.931_017_520_017_63, "above": "the geoid EGM96"});
        let take_off =
            json!({"latitude": 34.98, "longitude": -106.612_345_678_9, "elevation": elevation});
        let mission = json!({"kind": "mission", "take_off": take_off, "speed": 15.0, "safe_height": 20.5, "return_height": null});
        assert_eq!(
            info_text(&mission),
            "kind: mission\nreturn height: not stated\nsafe height: 20.5 m above the take-off\nspeed: 15 m/s\n\
             take off: 34.9800000, -106.6123457, 488.93 m above the geoid EGM96\n"
        );
        let on_ground =
            json!({"take_off": {"latitude": 50.0, "longitude": 7.0, "elevation": null}});
        assert_eq!(info_text(&on_ground), "take off: 50.0000000, 7.0000000\n");
    }

    #[test]
    fn bounds_begin_with_the_least_and_have_the_unit_of_their_system() {
        let cloud = |crs: Value| json!({"kind": "cloud", "crs": crs, "bounds": {"max": [4.0, 5.5, 6.0], "min": [1.0, 2.0, 3.0]}});
        let line = |crs: Value| info_text(&cloud(crs)).lines().next().unwrap().to_owned();
        let least = "bounds: min [1.0,2.0,3.0], max [4.0,5.5,6.0]";
        assert_eq!(line(json!("EPSG:32633")), format!("{least} m"));
        // Degrees with metres have no unit in common.
        assert_eq!(line(json!("EPSG:4326")), least);
        assert_eq!(line(Value::Null), least);
    }

    #[test]
    fn a_camera_is_told_in_a_line() {
        let camera = |fy: f64| {
            let camera =
                json!({"name": "bebop", "width": 1280, "height": 720, "fx": 980.254, "fy": fy});
            info_text(&json!({"kind": "camera", "cameras": [camera], "warnings": []}))
        };
        let start = "camera: bebop, 1280 x 720 pixels, focal length 980.25";
        assert_eq!(camera(980.254), format!("{start} px\nkind: camera\n"));
        assert_eq!(camera(981.5), format!("{start} x 981.5 px\nkind: camera\n"));
    }

    /// Those of poses.csv are of photos.
    #[test]
    fn poses_over_time_are_no_photos() {
        let poses = json!({"kind": "poses", "crs": null, "over_time": true, "photos": ["a", "b"]});
        assert_eq!(info_text(&poses), "kind: poses\nposes: 2\n");
        let of_photos = json!({"kind": "poses", "crs": null, "photos": ["a", "b"]});
        assert!(info_text(&of_photos).contains("photos: 2\n"));
    }
}
