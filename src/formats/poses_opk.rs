//! Poses by omega, phi and kappa as photogrammetric programs list them; Orthority's documentation
//! ("CSV", "Legacy", "Orthority exterior parameters") states the three forms most fully.
//!
//! - A table with a header: `filename,x,y,z,omega,phi,kappa[,camera]` in any order; `easting`,
//!   `northing` and `altitude`, `height` or `alt` stand for x, y, z. Other columns are passed over.
//! - A table without: `name x y z omega phi kappa [camera]` on every line.
//! - RealityCapture's `#name,X/Lon,Y/Lat,Z/Alt,` and then `omega,phi,kappa` or `yaw,pitch,roll`, whose
//!   angles are its own (see `realitycapture`).
//! - GeoJSON whose features have the properties `filename`, `camera`, `xyz`, `opk` (radians here), and
//!   whose member `world_crs` states the system.
//!
//! Fields stand between commas, semicolons, tabs or white space, and may be quoted. Lines that begin
//! with # are comments, but for the header; one that names a yaw or heading in another form is refused. Angles are degrees; Rx(omega) Ry(phi) Rz(kappa) takes
//! photogrammetric camera axes (x right, y up, z back) to the world, as in poses.csv. The coordinate
//! system stands in a .prj beside the table.

use std::collections::HashMap;

use glam::DVec3;
use serde::Deserialize;

use super::fields::shown;
use super::input::text_from_bytes;
use super::json;
use super::poses_csv::{PoseLine, PosesFile};
use super::realitycapture;
use crate::camera::Pose;
use crate::fault::Fault;

/// What the columns may be called: the photo, x, y, z, omega, phi, kappa.
const COLUMNS: [&[&str]; 7] = [
    &["filename", "imagename", "image", "name", "file", "label"],
    &["x", "easting", "x/lon"],
    &["y", "northing", "y/lat"],
    &["z", "altitude", "height", "alt", "z/alt"],
    &["omega"],
    &["phi"],
    &["kappa"],
];

/// The columns of RealityCapture's other form.
const REALITYCAPTURE: [&[&str]; 7] = [
    &["name"],
    &["x/lon"],
    &["y/lat"],
    &["z/alt"],
    &["yaw"],
    &["pitch"],
    &["roll"],
];

/// Whether the first lines are such a table's.
pub(super) fn is_table(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    lines.find_map(|line| {
        let fields = fields(line);
        if header(&fields).is_some() {
            return Some(true);
        }
        let is_comment = line.trim_start().starts_with('#');
        (!is_comment).then(|| is_row(&fields))
    }) == Some(true)
}

/// Whether the bytes are GeoJSON of such poses.
pub(super) fn is_geojson(start: &[u8]) -> bool {
    let start = start.get(..4096).unwrap_or(start);
    let text = String::from_utf8_lossy(start);
    ["\"FeatureCollection\"", "\"opk\"", "\"xyz\""]
        .iter()
        .all(|word| text.contains(word))
}

fn fields(line: &str) -> Vec<&str> {
    let line = line.trim();
    let clean = |field: &'_ str| -> bool { !field.is_empty() };
    let split: Vec<&str> = match [',', ';', '\t'].into_iter().find(|c| line.contains(*c)) {
        Some(separator) => line.split(separator).collect(),
        None => line
            .split_whitespace()
            .filter(|field| clean(field))
            .collect(),
    };
    split
        .into_iter()
        .map(|field| field.trim().trim_matches('"'))
        .collect()
}

/// Where the columns stand.
#[derive(Debug, Clone, Copy)]
struct Header {
    places: [usize; 7],
    camera: Option<usize>,
    names: [&'static [&'static str]; 7],
    pose: fn(DVec3, [f64; 3]) -> Pose,
}

/// Of a table that does not say it.
const SILENT: Header = Header {
    places: [0, 1, 2, 3, 4, 5, 6],
    camera: Some(7),
    names: COLUMNS,
    pose: Pose::from_omega_phi_kappa,
};

/// Where the columns stand, if a line names them all.
fn header(fields: &[&str]) -> Option<Header> {
    let of = |names: [&'static [&'static str]; 7], pose: fn(DVec3, [f64; 3]) -> Pose| {
        let mut places = [0; 7];
        for (place, names) in places.iter_mut().zip(names) {
            *place = find(fields, names)?;
        }
        Some(Header {
            places,
            camera: find(fields, &["camera"]),
            names,
            pose,
        })
    };
    of(COLUMNS, Pose::from_omega_phi_kappa).or_else(|| of(REALITYCAPTURE, realitycapture::pose))
}

fn find(fields: &[&str], names: &[&str]) -> Option<usize> {
    fields.iter().position(|field| {
        let field = field.trim_start_matches('#').trim().to_ascii_lowercase();
        names.contains(&field.as_str())
    })
}

/// Whether the fields are those of a line without header.
fn is_row(fields: &[&str]) -> bool {
    let is_number = |field: &&str| field.parse::<f64>().is_ok();
    (7..=8).contains(&fields.len()) && !is_number(&fields[0]) && fields[1..7].iter().all(is_number)
}

/// Reads a table.
///
/// # Errors
/// With the line: a field that is missing or no finite number, a photo named twice; no photo.
pub(super) fn read_table(bytes: &[u8]) -> Result<PosesFile, Fault> {
    let text = text_from_bytes(bytes)?;
    let mut places = None;
    let mut list = List::default();
    for (line, text) in (1..).zip(text.lines()) {
        if text.trim().is_empty() {
            continue;
        }
        let fields = fields(text);
        if places.is_none() {
            places = header(&fields);
            if places.is_some() {
                continue;
            }
        }
        if text.trim_start().starts_with('#') {
            if places.is_none() && find(&fields, &["yaw", "heading"]).is_some() {
                let what = "its angles are not omega, phi and kappa";
                return Err(Fault::at(line, what, "write them as a poses.csv"));
            }
            continue;
        }
        let Header {
            places,
            camera,
            names,
            pose,
        } = *places.get_or_insert(SILENT);
        let field = |index: usize| {
            fields
                .get(places[index])
                .copied()
                .filter(|field| !field.is_empty())
                .ok_or_else(|| {
                    let what = format!("the line has no {}", names[index][0]);
                    Fault::at(line, what, "complete the line")
                })
        };
        let number = |index: usize| {
            let text = field(index)?;
            text.parse::<f64>()
                .ok()
                .filter(|n| n.is_finite())
                .ok_or_else(|| {
                    let name = names[index][0];
                    let what = format!("{name} is '{}', not a finite number", shown(text));
                    Fault::at(line, what, "write a number with a decimal point")
                })
        };
        let center = DVec3::new(number(1)?, number(2)?, number(3)?);
        let angles = [number(4)?, number(5)?, number(6)?];
        let camera = camera.and_then(|column| fields.get(column));
        list.add(PoseLine {
            photo: field(0)?.to_owned(),
            camera: camera
                .filter(|name| !name.is_empty())
                .map(|&name| name.to_owned()),
            pose: pose(center, angles),
            line,
        })?;
    }
    list.finish(None)
}

#[derive(Deserialize)]
struct Collection {
    world_crs: Option<String>,
    features: Vec<Feature>,
}

#[derive(Deserialize)]
struct Feature {
    properties: Properties,
}

#[derive(Deserialize)]
struct Properties {
    filename: String,
    camera: Option<String>,
    xyz: [f64; 3],
    opk: [f64; 3],
}

/// Reads GeoJSON.
///
/// # Errors
/// What is no such GeoJSON, with the line; a photo named twice; no photo.
pub(super) fn read_geojson(bytes: &[u8]) -> Result<PosesFile, Fault> {
    let collection: Collection = json::parse(bytes)?;
    let mut list = List::default();
    for (Feature { properties }, line) in collection.features.into_iter().zip(1..) {
        let angles = properties.opk.map(f64::to_degrees);
        list.add(PoseLine {
            photo: properties.filename,
            camera: properties.camera.filter(|name| !name.is_empty()),
            pose: Pose::from_omega_phi_kappa(DVec3::from_array(properties.xyz), angles),
            line,
        })?;
    }
    list.finish(collection.world_crs)
}

/// The poses so far; their names differ.
#[derive(Default)]
struct List {
    lines: Vec<PoseLine>,
    seen: HashMap<String, u64>,
}

impl List {
    fn add(&mut self, line: PoseLine) -> Result<(), Fault> {
        if let Some(first) = self.seen.insert(line.photo.clone(), line.line) {
            let what = format!("'{}' stands as number {first} already", shown(&line.photo));
            return Err(Fault::at(line.line, what, "keep one pose a photo"));
        }
        self.lines.push(line);
        Ok(())
    }

    fn finish(self, crs: Option<String>) -> Result<PosesFile, Fault> {
        if self.lines.is_empty() {
            return Err(Fault::new("it has no photos", "give a line for each photo"));
        }
        Ok(PosesFile {
            lines: self.lines,
            crs,
            warnings: Vec::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::formats::test_data::shared_data;

    /// RealityScan's documentation: with yaw, pitch and roll 0 the camera looks down and its right is
    /// east; a yaw of 90 turns it clockwise, a pitch of 90 looks to the horizon.
    #[test]
    fn realitycaptures_angles_are_its_own() {
        let of = |angles: &str| {
            let text = format!("#cameras 1\n#name,X/Lon,Y/Lat,Z/Alt,{angles}\n");
            assert!(is_table(text.as_bytes()));
            read_table(text.as_bytes()).unwrap().lines[0].pose
        };
        let down = of("yaw,pitch,roll\na.jpg,1,2,3,0,0,0");
        assert_eq!(down.center, DVec3::new(1.0, 2.0, 3.0));
        let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-12;
        assert!(near(down.rotation.z_axis, DVec3::NEG_Z) && near(down.rotation.x_axis, DVec3::X));
        assert_eq!(of("omega,phi,kappa\na.jpg,1,2,3,0,0,0"), down);
        let east = of("yaw,pitch,roll\na.jpg,1,2,3,90,90,0");
        assert!(near(east.rotation.z_axis, DVec3::X), "{east:?}");
        let other = "# name, x, y, z, yaw, pitch, roll\na.jpg 1 2 3 4 5 6\n";
        let fault = read_table(other.as_bytes()).unwrap_err();
        assert!(fault.what.contains("not omega"), "{fault}");
        assert_eq!(fault.line, Some(1));
        let label = "Label,X,Y,Z,Omega,Phi,Kappa\na.jpg,1,2,3,0,0,0\n";
        assert_eq!(read_table(label.as_bytes()).unwrap().lines[0].pose, down);
    }

    #[test]
    fn the_three_shared_forms_agree() {
        let Some(folder) = shared_data("orthority-ngi-opk") else {
            return;
        };
        let read = |name: &str| crate::formats::read_poses(&folder.join(name)).unwrap();
        let (csv, text) = (read("ngi_xyz_opk.csv"), read("camera_pos_ori.txt"));
        let geojson = read("ngi_ext_param.geojson");
        assert_eq!(
            csv.crs.as_deref().map(|crs| &crs[..12]),
            Some("+proj=tmerc ")
        );
        assert!(geojson.crs.unwrap().starts_with("PROJCS"));
        assert_eq!(text.lines.len(), 4);
        assert_eq!(text.lines[0].photo, "3324c_2015_1004_05_0182_RGB");
        assert_eq!(geojson.lines[0].camera.as_deref(), Some("Integraph DMC"));
        for other in [&csv.lines, &geojson.lines] {
            for (one, other) in text.lines.iter().zip(other) {
                assert_eq!(one.photo, other.photo);
                // The table is rounded to 0.001 m and 0.001 degrees.
                assert!((one.pose.center - other.pose.center).length() < 1e-3);
                let turned = one.pose.rotation.z_axis.dot(other.pose.rotation.z_axis);
                assert!(turned > 1.0 - 1e-9, "{turned}");
                // An aerial camera.
                assert!(other.pose.rotation.z_axis.z < -0.999);
            }
        }
    }

    #[test]
    fn columns_in_any_order() {
        let text = "# by hand\r\n#Name;Kappa;Phi;Omega;Northing;Easting;Alt;Camera;x_sigma\r\n\
            a b.tif;0;0;0;2;1;3;left;9\r\n";
        assert!(is_table(text.as_bytes()));
        let file = read_table(text.as_bytes()).unwrap();
        let line = &file.lines[0];
        assert_eq!(
            (line.photo.as_str(), line.camera.as_deref()),
            ("a b.tif", Some("left"))
        );
        assert_eq!(line.pose.center, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(line.pose.rotation.y_axis, DVec3::NEG_Y);
        for other in [
            "photo,x,y,z,omega,phi,kappa\n",
            "x y z\n1 2 3\n",
            "1 2 3 4 5 6 7\n",
            "a 1 2 3\n",
            "",
        ] {
            assert!(!is_table(other.as_bytes()), "{other}");
        }
    }

    #[test]
    fn mistakes_are_placed() {
        let fault = |text: &str| read_table(text.as_bytes()).unwrap_err();
        assert_eq!(fault("a 1 2 3 4 5 6\nb 1 2 3 4 5\n").line, Some(2));
        assert_eq!(fault("a 1 2 3 4 5 6\na 1 2 3 4 5 6\n").line, Some(2));
        assert!(fault("a 1 2 3 4 5 nan\n").what.contains("kappa is 'nan'"));
        assert!(
            fault("filename,x,y,z,omega,phi,kappa\n")
                .what
                .contains("no photos")
        );
        let geojson = |text: &str| read_geojson(text.as_bytes()).unwrap_err();
        assert!(geojson("{\"features\": []}").what.contains("no photos"));
        let broken = "{\"features\": [{\"properties\":\n {\"filename\": \"a\", \"xyz\": [1, 2], \"opk\": []}}]}";
        assert_eq!(geojson(broken).line, Some(2));
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "((a|b|,|;| |[0-9.e-]{1,5}|\\PC){0,20}\n){0,5}") {
            let _ = is_table(text.as_bytes());
            let _ = read_table(text.as_bytes());
            let _ = read_table(format!("filename,x,y,z,omega,phi,kappa\n{text}").as_bytes());
        }
    }
}
