//! Metashape's lists of poses, opened with a surface.

use std::fs;

use glam::DVec3;

use crate::geodesy::{Crs, Geographic};
use crate::jobs::Progress;
use crate::scale::{Ground, GroundFinder, ImageKind, PhotoScale};
use crate::{OpenOptions, open_flight};
use fragscale_test_data::shared_data;

/// A flight.toml names the angle text as its poses: the camera looks straight down from 100 m, its
/// 100 x 100 pixels with f = 100 see 100 m of flat ground: 1 px/m. Degrees are refused with a word.
#[test]
fn angles_serve_as_the_poses_of_a_flight() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let opk = |x: &str, y: &str| {
        format!(
            "# Cameras (2)\n# PhotoID, X, Y, Z, Omega, Phi, Kappa\n\
             a.JPG\t{x}0\t{y}0\t100\t0\t0\t0\nb.JPG\t{x}1\t{y}1\t100\t0\t0\t90\n"
        )
    };
    write("opk.txt", &opk("500000.", "5000000."));
    write(
        "ground.xyz",
        "499000 4999000 0\n501000 4999000 0\n501000 5001000 0\n499000 5001000 0\n",
    );
    write(
        "flight.toml",
        "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"ground.xyz\"\n[[camera]]\nwidth = 100\nheight = 100\n\
         fx = 100.0\nfy = 100.0\ncx = 50.0\ncy = 50.0\n[photos]\nposes = \"opk.txt\"\n",
    );
    let options = OpenOptions::default();
    let open = || open_flight(folder.path(), &options, &Progress::default());
    let opened = open().unwrap();
    let parts = opened.flight.parts();
    let center = parts.photos[1].pose.center;
    assert!(
        (center - DVec3::new(500_000.1, 5_000_000.1, 100.0)).length() < 1e-12,
        "{center}"
    );
    let caster = &mut parts.surface.caster().unwrap();
    let ground = &mut GroundFinder::new(Ground::At(0.0), &parts.surface);
    let scale = PhotoScale::compute(
        &parts.cameras[0],
        &parts.photos[0].pose,
        ImageKind::Undistorted,
        ground,
        caster,
    );
    let top = scale.unwrap().scale.top.unwrap();
    assert!((top - 1.0).abs() < 1e-9, "{top}");
    write("opk.txt", &opk("-64.71", "18.38"));
    // In degrees they are brought to the zone, which is not where this surface lies.
    let error = open().unwrap_err().to_string();
    let what =
        "ground.xyz: it states no coordinate system, and cannot be in the photos' (EPSG:32620)";
    assert!(error.contains(what), "{error}");
}

/// The covariance of the first camera is in the chunk's frame, which lies askew in that of the Earth's
/// centre; towards east, north and up its deviations are 19.1, 15.5 and 67.1 mm (computed from the file
/// by another program). The grid's north is within a degree of the true one.
#[test]
fn what_the_wheat_field_states_of_its_errors_comes_to_the_world() {
    let Some(psx) = shared_data("metashape-wheat-gcp/wheat_tanashi.psx") else {
        return;
    };
    // Flat ground below it, in UTM.
    let crs = Crs::understand("EPSG:32654").unwrap();
    let place = Geographic {
        longitude: 139.540_516,
        latitude: 35.737_999,
        height: 100.0,
    };
    let middle = crs.from_geographic(place).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut ground = String::new();
    for (x, y) in [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)] {
        ground += &format!("{} {} 100\n", middle.x + x, middle.y + y);
    }
    let file = folder.path().join("ground.xyz");
    fs::write(&file, ground).unwrap();
    let options = OpenOptions {
        surface: Some(file),
        ..OpenOptions::default()
    };
    let opened = open_flight(&psx, &options, &Progress::default()).unwrap();
    assert_eq!(opened.crs.as_deref(), Some("EPSG:32654"));
    let photo = &opened.flight.parts().photos[0];
    let errors = opened.flight.errors(photo);
    let position = errors.pose.position.unwrap();
    let off = position - DVec3::new(0.019_112, 0.015_527, 0.067_108);
    assert!(off.length() < 2e-4, "{position}");
    let focal = errors.focal.unwrap();
    assert!((focal - 0.196_289).abs() < 1e-6, "{focal}");
    assert_eq!((errors.surface, errors.world_scale), (None, None));
}
