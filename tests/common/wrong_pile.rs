//! Flights whose photos are not of their pile, although their scales look well: one taken from under
//! the surface, some exchanged with others.

#![allow(
    unreachable_pub,
    dead_code,
    reason = "each test binary is a crate of its own"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// The photos of [`under_surface`]: one above a plane, one as far under it that looks up.
pub const ABOVE_AND_UNDER: [&str; 2] = ["above.jpg", "under.jpg"];

/// Pixels per metre of both: a focal length of 320 px over a distance of 40 m.
pub const BOTH_SCALES: f64 = 8.0;

/// Two photos of the plane z = 0, in metres; writes flight.toml and what it names.
pub fn under_surface(folder: &Path) {
    let mut points = String::new();
    for i in 0..41 * 41 {
        let _ = writeln!(points, "{} {} 0", i % 41 * 4 - 80, i / 41 * 4 - 80);
    }
    let [above, under] = ABOVE_AND_UNDER;
    let poses = format!("photo,x,y,z,tilt,pan\n{above},1,2,40,90,0\n{under},1,2,-40,-90,0\n");
    let flight = "format = 1\nworld.unit = \"m\"\nsurface.file = \"plane.xyz\"\n\
        photos.poses = \"poses.csv\"\nphotos.folder = \"photos\"\n\
        [[camera]]\nwidth = 400\nheight = 300\nfx = 320\nfy = 320\ncx = 200\ncy = 150\n";
    for (name, text) in [
        ("plane.xyz", points.as_str()),
        ("poses.csv", &poses),
        ("flight.toml", flight),
    ] {
        fs::write(folder.join(name), text).expect("written");
    }
    fs::create_dir(folder.join("photos")).expect("made");
    for photo in ABOVE_AND_UNDER {
        let picture = image::RgbImage::from_pixel(400, 300, image::Rgb([90, 90, 90]));
        // Its first bytes say what it is, not its ending.
        let path = folder.join("photos").join(photo);
        let written = picture.save_with_format(path, image::ImageFormat::Png);
        written.expect("written");
    }
}

/// The places in the flight of the photos that [`swapped`] exchanges.
pub const SWAPPED: [usize; 4] = [0, 2, 4, 8];

/// The bundled flight with two pairs of its photos exchanged.
pub fn swapped(folder: &Path) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    for below in ["", "photos"] {
        fs::create_dir_all(folder.join(below)).expect("made");
        for entry in fs::read_dir(sample.join(below)).expect("the sample") {
            let path = entry.expect("an entry").path();
            if path.is_file() {
                let name = path.file_name().expect("a name");
                fs::copy(&path, folder.join(below).join(name)).expect("a copy");
            }
        }
    }
    let photo = |n: u32| folder.join(format!("photos/IMG_000{n}.jpg"));
    for (a, b) in [(1, 9), (3, 5)] {
        let aside = folder.join("aside");
        fs::rename(photo(a), &aside).expect("moved");
        fs::rename(photo(b), photo(a)).expect("moved");
        fs::rename(&aside, photo(b)).expect("moved");
    }
}

/// The photo of [`y_up`], taken straight down from 10 m: its scale is 32 px/m, within the hills' 5 %.
pub const OVER_HILLS: &str = "over.jpg";

/// One photo of 20 m of hills, 0.5 m high, whose mesh was written with y up.
pub fn y_up(folder: &Path) {
    let mut mesh = String::new();
    for at in 0..21 * 21 {
        let (x, y) = (f64::from(at % 21), f64::from(at / 21));
        let z = 0.5 * (x * 0.9).sin() * (y * 0.7).cos();
        let _ = writeln!(mesh, "v {x} {z} {}", -y);
    }
    for at in 0..21 * 20 {
        // OBJ counts from 1.
        if at % 21 < 20 {
            let _ = writeln!(mesh, "f {} {} {} {}", at + 1, at + 2, at + 23, at + 22);
        }
    }
    let poses = format!("photo,x,y,z,tilt,pan\n{OVER_HILLS},10,10,10,90,0\n");
    let flight = "format = 1\nworld.unit = \"m\"\nsurface.file = \"hills.obj\"\nphotos.poses = \"poses.csv\"\n\
        [[camera]]\nwidth = 400\nheight = 300\nfx = 320\nfy = 320\ncx = 200\ncy = 150\n";
    for (name, text) in [
        ("hills.obj", mesh.as_str()),
        ("poses.csv", &poses),
        ("flight.toml", flight),
    ] {
        fs::write(folder.join(name), text).expect("written");
    }
}
