//! Photos alone, opened with a cloud.

use std::path::{Path, PathBuf};

use crate::jobs::Progress;
use crate::{OpenOptions, info, open_flight};
use fragscale_test_data::shared_data;

/// With a cloud, photos alone are a flight: their scales against those of OpenDroneMap's own poses.
#[test]
fn brighton_photos_with_the_cloud_are_a_flight() {
    let Some(folder) = shared_data("odm-brighton-0") else {
        return;
    };
    let progress = Progress::default();
    let scales_of = |path: &Path, photos: Option<PathBuf>| {
        let options = OpenOptions {
            surface: Some(folder.join("model_full_pierotofy.laz")),
            photos,
            ..OpenOptions::default()
        };
        let opened = open_flight(path, &options, &progress).unwrap();
        assert_eq!(opened.crs.as_deref(), Some("EPSG:32615"));
        // The cameras are 35.9 m above the surface and 40.1 m above the take-off, which was from the
        // beach below: no contradiction.
        let contradicted = |warning: &String| warning.contains("above the take-off (");
        assert!(
            !opened.warnings.iter().any(contradicted),
            "{:#?}",
            opened.warnings
        );
        let outcomes = opened.flight.scales(&progress).unwrap();
        let photos = opened.flight.parts().photos.iter();
        let photo = photos
            .zip(outcomes)
            .find(|(photo, _)| photo.name == "DJI_0030.JPG");
        let scale = photo.unwrap().1;
        scale.scale().unwrap().scale
    };
    let alone = scales_of(&folder.join("images"), None);
    let solved = scales_of(&folder, Some(folder.join("images")));
    for (alone, solved) in [(alone.top, solved.top), (alone.left, solved.left)] {
        let (alone, solved) = (alone.unwrap(), solved.unwrap());
        // The 35 mm equivalent promises 10 %; measured 63.64 and 62.05 px/m at the top.
        assert!((alone / solved - 1.0).abs() < 0.1, "{alone} {solved}");
    }
    let told = info(&folder.join("images"), &progress).unwrap();
    assert_eq!(told["package"], "photos");
}
