//! Surfaces whose z is not up.

use super::*;
use fragscale_test_data::shared_data;

/// Opens a flight over that surface, as the file has it or with `more` below [surface].
fn opened(surface: &Path, more: &str) -> Opened {
    let folder = tempfile::tempdir().unwrap();
    let flight = folder.path().join("flight.toml");
    let text = format!(
        "format = 1\nworld.unit = \"m\"\n[surface]\nfile = '{}'\n{more}\n[[camera]]\nwidth = 4\nheight = 3\n\
         fx = 4\nfy = 4\ncx = 2\ncy = 1.5\n[photos]\nposes = \"poses.csv\"\n",
        surface.display()
    );
    std::fs::write(&flight, text).unwrap();
    let poses = "photo,x,y,z,qx,qy,qz,qw\na.jpg,50,-300,250,1,0,0,0\n";
    std::fs::write(folder.path().join("poses.csv"), poses).unwrap();
    open_flight(&flight, &OpenOptions::default(), &Progress::default()).unwrap()
}

#[test]
fn a_quarry_with_y_up() {
    let Some(folder) = shared_data("authume-quarry-terrain/Geometries") else {
        return;
    };
    let mut area = 0.0;
    for name in ["DTM_Blue_zone.stl", "DTM_Gray_zone.stl", "DTM_Red_zone.stl"] {
        let path = folder.join("STL").join(name);
        let as_it_is = opened(&path, "");
        let doubts = |opened: &Opened| {
            let about_up = |warning: &&String| warning.contains("up = \"y\"");
            opened.warnings.iter().filter(about_up).count()
        };
        assert_eq!(doubts(&as_it_is), 1, "{:?}", as_it_is.warnings);
        let turned = opened(&path, "up = \"y\"");
        assert_eq!(doubts(&turned), 0);
        let surface = &turned.flight.parts().surface;
        let bounds = surface.bounds();
        assert!(bounds.min.z > 153.0 && bounds.max.z < 214.5, "{bounds:?}");
        let vertices: Vec<_> = surface.vertices().collect();
        for triangle in surface.triangles().unwrap() {
            let [a, b, c] = triangle.map(|corner| vertices[corner as usize].truncate());
            area += (b - a).perp_dot(c - a).abs() / 2.0;
        }
    }
    // The README's number.
    assert!((area - 21_465.0).abs() < 1.0, "{area}");
    let cloud = opened(&folder.join("Point_cloud/Terrain.xyz"), "up = \"y\"");
    let bounds = cloud.flight.parts().surface.bounds();
    assert!(bounds.min.z > 153.0 && bounds.max.z < 214.5, "{bounds:?}");
}
