//! Which files of OpenDroneMap's project are asked for, by their places in it: what a flight is made of, and what the
//! user's options make besides. Nothing else is computed into the archive, and nothing else is unpacked.
//!
//! The places are those of ODM's `opendm/types.py` and of its stages; which of them a flight is read from is said in
//! `formats/packages/odm`.

use serde::Deserialize;
use serde_json::Value;

/// What a flight is made of.
const OF_A_FLIGHT: [&str; 20] = [
    "odm_georeferencing/odm_georeferenced_model.laz",
    "odm_georeferencing/coords.txt",
    "odm_georeferencing/proj.txt",
    "odm_georeferencing/alignment_matrix.json",
    "odm_georeferencing/gcp_list.txt",
    "opensfm/gcp_list.txt",
    "odm_georeferencing/ground_control_points.geojson",
    "opensfm/reconstruction.json",
    "opensfm/reconstruction.topocentric.json",
    "opensfm/reference_lla.json",
    "opensfm/geocoords_transformation.txt",
    "opensfm/exported_geocoords.txt",
    "opensfm/tracks.csv",
    "odm_report/shots.geojson",
    "odm_report/stats.json",
    "odm_report/report.pdf",
    "img_list.txt",
    "images.json",
    "cameras.json",
    "geo.txt",
];

/// What an option makes that is switched on; a folder stands for all that is in it.
const OF_OPTIONS: [(&str, &[&str]); 12] = [
    ("dsm", &["odm_dem/dsm.tif"]),
    ("dtm", &["odm_dem/dtm.tif"]),
    (
        "dem-euclidean-map",
        &["odm_dem/dsm.euclideand.tif", "odm_dem/dtm.euclideand.tif"],
    ),
    (
        "pc-las",
        &["odm_georeferencing/odm_georeferenced_model.las"],
    ),
    (
        "pc-csv",
        &["odm_georeferencing/odm_georeferenced_model.csv"],
    ),
    (
        "pc-copc",
        &["odm_georeferencing/odm_georeferenced_model.copc.laz"],
    ),
    ("pc-ept", &["entwine_pointcloud"]),
    ("orthophoto-png", &["odm_orthophoto/odm_orthophoto.png"]),
    ("orthophoto-kmz", &["odm_orthophoto/odm_orthophoto.kmz"]),
    (
        "orthophoto-cutline",
        &[
            "odm_orthophoto/cutline.gpkg",
            "odm_orthophoto/odm_orthophoto_cut.tif",
        ],
    ),
    ("tiles", &["orthophoto_tiles", "dsm_tiles", "dtm_tiles"]),
    ("3d-tiles", &["3d_tiles"]),
];

/// Steps that are left out unless they are wanted: the option that leaves them out, and what they make.
const STEPS: [(&str, &[&str]); 2] = [
    ("skip-3dmodel", &["odm_texturing"]),
    ("skip-orthophoto", &["odm_orthophoto/odm_orthophoto.tif"]),
];

/// Whether an option makes no sense where the step is left out that `skip` leaves out.
pub(crate) fn needs(option: &str, value: &Value, skip: &str) -> bool {
    let needs = match skip {
        "skip-3dmodel" => ["gltf", "3d-tiles"].contains(&option),
        "skip-orthophoto" => option.starts_with("orthophoto-") || option == "fast-orthophoto",
        _ => false,
    };
    needs && *value != Value::Bool(false)
}

/// What is asked for, where these options are sent.
pub(crate) fn outputs(options: &str) -> Vec<&'static str> {
    #[derive(Deserialize)]
    struct Option {
        name: String,
        value: Value,
    }
    let options: Vec<Option> = serde_json::from_str(options).unwrap_or_default();
    let value = |name: &str| {
        let option = options.iter().find(|option| option.name == name);
        option.map(|option| &option.value)
    };
    let mut outputs = OF_A_FLIGHT.to_vec();
    for (skip, makes) in STEPS {
        let is_made = match value(skip) {
            Some(skips) => *skips == Value::Bool(false),
            None => options.iter().any(|of| needs(&of.name, &of.value, skip)),
        };
        if is_made {
            outputs.extend(makes);
        }
    }
    for (name, makes) in OF_OPTIONS {
        if value(name) == Some(&Value::Bool(true)) {
            outputs.extend(makes);
        }
    }
    outputs
}

/// Whether a file of an archive is one of what was asked for.
pub(crate) fn is_asked_for(name: &str, outputs: &[&str]) -> bool {
    let lies_in = |folder: &str| {
        let inside = name.strip_prefix(folder);
        inside.is_some_and(|inside| inside.is_empty() || inside.starts_with('/'))
    };
    !name.ends_with('/') && outputs.iter().any(|output| lies_in(output))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_options_make_is_asked_for() {
        let usual = r#"[{"name":"skip-3dmodel","value":true},{"name":"skip-orthophoto","value":true},{"name":"dsm","value":false}]"#;
        assert_eq!(outputs(usual), OF_A_FLIGHT);
        assert_eq!(outputs("[]"), OF_A_FLIGHT);
        let more = |options: &str| outputs(options).split_off(OF_A_FLIGHT.len());
        let all = r#"[{"name":"dsm","value":true},{"name":"skip-orthophoto","value":false},{"name":"pc-ept","value":true},
            {"name":"pc-quality","value":"high"},{"name":"skip-3dmodel","value":false}]"#;
        assert_eq!(
            more(all),
            [
                "odm_texturing",
                "odm_orthophoto/odm_orthophoto.tif",
                "odm_dem/dsm.tif",
                "entwine_pointcloud"
            ]
        );
        // (Not said to be left out, as it makes no sense without.)
        assert_eq!(
            more(r#"[{"name":"orthophoto-png","value":true}]"#),
            [
                "odm_orthophoto/odm_orthophoto.tif",
                "odm_orthophoto/odm_orthophoto.png"
            ]
        );
        let not =
            r#"[{"name":"orthophoto-png","value":true},{"name":"skip-orthophoto","value":true}]"#;
        assert_eq!(more(not), ["odm_orthophoto/odm_orthophoto.png"]);
    }

    #[test]
    fn a_folder_is_all_that_is_in_it() {
        let asked = ["odm_texturing", "odm_dem/dsm.tif"];
        for name in [
            "odm_texturing/a.mtl",
            "odm_texturing/b/c.png",
            "odm_dem/dsm.tif",
        ] {
            assert!(is_asked_for(name, &asked), "{name}");
        }
        for name in [
            "odm_texturing/",
            "odm_texturing_25d/a.mtl",
            "odm_dem/dsm.tif.aux.xml",
            "a/odm_texturing/b",
        ] {
            assert!(!is_asked_for(name, &asked), "{name}");
        }
    }
}
