//! What a cloud of many points costs: makes one of the bundled sample, tiled, and opens it.
//!
//! ```text
//! cargo bench -p fragscale-sample --bench many_points -- write FOLDER MILLIONS [laz|las|copc]
//! cargo bench -p fragscale-sample --bench many_points -- open FLIGHT
//! cargo bench -p fragscale-sample --bench many_points -- scales FLIGHT [whole|part]
//! ```
//!
//! `write` makes a flight of the sample's pile laid side by side, with the sample's nine photos in the middle
//! (`flight.toml`) and with the same nine high enough to see everything (`flight_all.toml`). `open` opens one
//! as the window does and prints, after each step, the seconds that it took and the memory that the process has
//! ever held. `scales` computes all that the command of that name does, of the whole cloud or of the part that the
//! photos see, and prints a checksum of every digit of it: both have the same.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Instant;

use fragscale_core::geometry::Bounds;
use fragscale_core::jobs::Progress;
use fragscale_core::split_mix::SplitMix;
use fragscale_core::surface::Levels;
use fragscale_formats::read_cloud;
use fragscale_opening::{
    Memory, OpenOptions, Opened, open_flight, open_flight_sampled, with_flight,
};

mod tiled_copc;

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["write", folder, millions] => write(Path::new(folder), millions, "laz"),
        ["write", folder, millions, format] => write(Path::new(folder), millions, format),
        ["open", flight] => open(Path::new(flight)),
        ["scales", flight, way] => scales(Path::new(flight), way == "part"),
        // All benches are run at once with other arguments.
        _ => println!(
            "write FOLDER MILLIONS [laz|las|copc], open FLIGHT, or scales FLIGHT [whole|part]"
        ),
    }
}

fn sample() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/sample"))
}

fn write(folder: &Path, millions: &str, format: &str) {
    let millions: f64 = millions.parse().expect("a number of millions");
    fs::create_dir_all(folder).expect("a folder");
    let pile = read_cloud(&sample().join("pile.ply"), &Progress::default()).expect("the sample");
    let cloud = pile.cloud;
    if format == "copc" {
        let path = folder.join("pile.copc.laz");
        let count = tiled_copc::write(&path, &cloud.points, millions * 1e6);
        write_flights(folder, "pile.copc.laz", 1.0);
        println!("{count} points");
        return;
    }
    let bounds = Bounds::of(&cloud.points).expect("points");
    let size = bounds.size();
    let tiles = millions * 1e6 / cloud.points.len() as f64;
    let side = tiles.sqrt().ceil().max(1.0);
    let middle = (side / 2.0).floor();
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(7).expect("a format");
    builder.point_format.is_compressed = format == "laz";
    let axis = las::Transform {
        scale: 0.000_01,
        offset: 0.0,
    };
    builder.transforms = las::Vector {
        x: axis,
        y: axis,
        z: axis,
    };
    let file = format!("pile.{format}");
    let header = builder.into_header().expect("a header");
    let mut writer = las::Writer::from_path(folder.join(&file), header).expect("a writer");
    let mut count = 0;
    let mut tile = 0.0;
    while tile < tiles {
        let (column, row) = (tile % side - middle, (tile / side).floor() - middle);
        for (index, (point, color)) in cloud.points.iter().zip(&cloud.colors).enumerate() {
            // No tile is exactly another one moved, so that nothing in it is either.
            let shift = ((tile * 7919.0 + index as f64 * 104_729.0) % 1000.0) * 1e-6;
            let [r, g, b] = color.map(|channel| u16::from(channel) * 257);
            writer
                .write_point(las::Point {
                    x: point.x + column * size.x + shift,
                    y: point.y + row * size.y + shift,
                    z: point.z,
                    gps_time: Some(0.0),
                    color: Some(las::Color::new(r, g, b)),
                    ..las::Point::default()
                })
                .expect("written");
            count += 1;
        }
        tile += 1.0;
    }
    writer.close().expect("closed");
    write_flights(folder, &file, side);
    println!("{count} points");
}

/// With the sample's photos, and with the same from `side` times as far.
fn write_flights(folder: &Path, file: &str, side: f64) {
    fs::copy(sample().join("ost.yaml"), folder.join("ost.yaml")).expect("copied");
    let poses = fs::read_to_string(sample().join("poses.csv")).expect("poses");
    fs::write(folder.join("poses.csv"), &poses).expect("written");
    fs::write(folder.join("poses_all.csv"), raised(&poses, side)).expect("written");
    for (name, poses) in [
        ("flight.toml", "poses.csv"),
        ("flight_all.toml", "poses_all.csv"),
    ] {
        let text = format!(
            "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"{file}\"\n[[camera]]\nfile = \"ost.yaml\"\n\
             [photos]\nposes = \"{poses}\"\n"
        );
        fs::write(folder.join(name), text).expect("written");
    }
}

/// The same photos from so many times as far.
fn raised(poses: &str, times: f64) -> String {
    let mut lines = poses.lines();
    let mut text = format!("{}\n", lines.next().unwrap_or_default());
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let [name, x, y, z, rest @ ..] = &cells[..] else {
            continue;
        };
        let far = |cell: &str| cell.parse::<f64>().expect("a number") * times;
        let (x, y, z) = (far(x), far(y), far(z));
        writeln!(text, "{name},{x},{y},{z},{}", rest.join(",")).expect("written");
    }
    text
}

/// The most memory that the process has held, and what it holds now, GB.
fn memory() -> (f64, f64) {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let of = |key: &str| {
        let line = status.lines().find(|line| line.starts_with(key));
        let kilobytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
        kilobytes.unwrap_or(f64::NAN) * 1024.0 / 1e9
    };
    (of("VmHWM:"), of("VmRSS:"))
}

fn open(path: &Path) {
    let progress = Progress::default();
    let begun = Instant::now();
    let mut last = begun;
    let mut say = |what: &str| {
        let (most, now) = memory();
        println!(
            "{what:<44} {:7.1} s, {:7.1} s in all; {now:5.2} GB, at most {most:5.2} GB",
            last.elapsed().as_secs_f64(),
            begun.elapsed().as_secs_f64()
        );
        last = Instant::now();
    };
    let on_sample = |sample: fragscale_opening::SurfaceSample, _: &Progress| {
        let (count, of) = (sample.cloud.points.len(), sample.of);
        let seconds = begun.elapsed().as_secs_f64();
        println!("a sample: {count} of {of} points after {seconds:.2} s");
    };
    let options = OpenOptions {
        may_lack_photos: true,
        ..OpenOptions::default()
    };
    let opened = open_flight_sampled(path, &options, Some(&on_sample), &progress).expect("open");
    say("reading, and sorting the points");
    let outcomes = opened.flight.scales(&progress).expect("scales");
    say("scales");
    let surface = &opened.flight.parts().surface;
    let (bounds, _) = (surface.bounds(), surface.bulk_bounds());
    say("bounds");
    let levels = Levels::new(surface, &progress).expect("not cancelled");
    let levels = levels.expect("a cloud");
    say("levels of detail");
    let eye = bounds.center();
    let times = 200;
    let mut looked_at = 0;
    for i in 0..times {
        // Over the middle, from near to far.
        let height = bounds.size().x * (f64::from(i) + 1.0) / f64::from(times);
        let chosen = levels.choose(6_000_000, 1.0, |node| {
            let eye = eye.with_z(height);
            let distance = eye.distance(eye.clamp(node.bounds.min, node.bounds.max));
            Some(1200.0 * node.spacing / distance.max(1e-3))
        });
        looked_at = looked_at.max(chosen.looked_at);
    }
    let nodes = levels.nodes().len();
    say(&format!(
        "choosing {times} times, {looked_at} of {nodes} nodes"
    ));
    opened.flight.views(&outcomes, &progress).expect("views");
    say("footprints");
    opened.flight.fields(&outcomes, &progress).expect("fields");
    say("scale fields");
}

/// Everything that `fragscale scales` computes, once or as often as a part has to grow.
fn scales(path: &Path, in_part: bool) {
    let (options, progress) = (OpenOptions::default(), Progress::default());
    let begun = Instant::now();
    let say = |what: &str| {
        let (most, _) = memory();
        let seconds = begun.elapsed().as_secs_f64();
        println!("{what:<44} {seconds:7.1} s in all; at most {most:5.2} GB");
    };
    let compute = |opened: &Opened| {
        say("opened");
        let flight = &opened.flight;
        let outcomes = flight.scales(&progress).expect("scales");
        let views = flight.views(&outcomes, &progress).expect("views");
        let fields = flight.fields(&outcomes, &progress).expect("fields");
        let all = format!("{outcomes:?} {views:?} {fields:?}");
        let checksum = all.bytes().fold(SplitMix(0), |sum, byte| {
            SplitMix(SplitMix(sum.0 ^ u64::from(byte)).next())
        });
        say("scales, footprints, fields, uncertainties");
        println!("checksum {:016x} of {} letters", checksum.0, all.len());
        Ok(())
    };
    if in_part {
        let memory = Memory {
            most: 1 << 40,
            always_in_part: true,
        };
        with_flight(path, &options, memory, &progress, compute).expect("a part");
    } else {
        let opened = open_flight(path, &options, &progress).expect("a flight");
        let _: Result<(), String> = compute(&opened);
    }
    say("done");
}
