//! A reconstruction in a frame of its own whose place in the world is known.

#![allow(unreachable_pub, reason = "each test binary is a crate of its own")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Camera centres in the model's frame, where all cameras look along +z, 10 units above a plane.
pub(crate) const CENTERS: [[f64; 3]; 5] = [
    [0.0, 0.0, 0.0],
    [4.0, 0.0, 0.0],
    [4.0, 3.0, 0.0],
    [0.0, 3.0, 0.0],
    [2.0, 1.0, 0.0],
];

/// A COLMAP model with a focal length of 1000 px.
pub(crate) fn model(folder: &Path) {
    fs::write(
        folder.join("cameras.txt"),
        "1 PINHOLE 800 600 1000 1000 400 300\n",
    )
    .expect("written");
    let (mut images, mut points) = (String::new(), String::new());
    for (i, [x, y, z]) in CENTERS.iter().enumerate() {
        let id = i + 1;
        writeln!(images, "{id} 1 0 0 0 {} {} {} 1 IMG_{id}.JPG\n", -x, -y, -z).expect("written");
    }
    for i in 0..21 * 21 {
        let (x, y) = (f64::from(i % 21) - 8.0, f64::from(i / 21) - 8.0);
        writeln!(points, "{} {x} {y} 10 200 200 200 0.5", i + 1).expect("written");
    }
    fs::write(folder.join("images.txt"), images).expect("written");
    fs::write(folder.join("points3D.txt"), points).expect("written");
}

/// Where the cameras stand in the world: 3 m to a unit, turned about x so that z is up.
#[allow(
    dead_code,
    reason = "not every test binary brings the model to the world"
)]
pub(crate) fn positions() -> String {
    let mut list = "photo,x,y,z\n".to_owned();
    for (i, [x, y, z]) in CENTERS.iter().enumerate() {
        let (x, y, z) = (5e5 + 3.0 * x, 5e6 - 3.0 * y, 150.0 - 3.0 * z);
        writeln!(list, "img_{}.jpg,{x},{y},{z}", i + 1).expect("written");
    }
    list
}
