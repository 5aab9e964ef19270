use std::fs;

use proptest::prelude::*;

use super::*;
use fragscale_test_data::shared_data;

fn read_bytes(bytes: &[u8]) -> Result<CloudFile, Fault> {
    read(bytes, bytes.len() as u64, &Progress::default())
}

/// Three points (the second missing) with padding and packed colours, in each storage.
fn sample(storage: &str) -> Vec<u8> {
    let points = [
        (1.5_f64, -2.0_f64, 3.25_f64, 0x00ff_8001_u32),
        (f64::NAN, f64::NAN, f64::NAN, 0),
        (500_000.125, 5_000_000.5, 161.75, 0x0010_2030),
    ];
    let mut bytes = format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y _ z rgb\nSIZE 8 8 1 8 4\nTYPE F F U F F\nCOUNT 1 1 3 1 1\n\
         WIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA {storage}\n"
    )
    .into_bytes();
    match storage {
        "ascii" => {
            for (x, y, z, rgb) in points {
                let rgb = f32::from_bits(rgb);
                bytes.extend(format!("{x} {y} 7 7 7 {z} {rgb:e}\n").bytes());
            }
        }
        "binary" => {
            for (x, y, z, rgb) in points {
                bytes.extend(x.to_le_bytes());
                bytes.extend(y.to_le_bytes());
                bytes.extend([7, 7, 7]);
                bytes.extend(z.to_le_bytes());
                bytes.extend(rgb.to_le_bytes());
            }
        }
        _ => {
            let mut arrays = Vec::new();
            arrays.extend(points.iter().flat_map(|p| p.0.to_le_bytes()));
            arrays.extend(points.iter().flat_map(|p| p.1.to_le_bytes()));
            arrays.extend(points.iter().flat_map(|p| p.2.to_le_bytes()));
            arrays.extend(points.iter().flat_map(|p| p.3.to_le_bytes()));
            // Compression that repeats nothing.
            let mut packed = Vec::new();
            for run in arrays.chunks(32) {
                packed.push(run.len() as u8 - 1);
                packed.extend(run);
            }
            bytes.extend((packed.len() as u32).to_le_bytes());
            bytes.extend((arrays.len() as u32).to_le_bytes());
            bytes.extend(packed);
        }
    }
    bytes
}

const STORAGES: [&str; 3] = ["ascii", "binary", "binary_compressed"];

#[test]
fn every_storage_gives_the_same_points() {
    for storage in STORAGES {
        let file = read_bytes(&sample(storage)).unwrap();
        assert_eq!(
            file.cloud.points,
            [
                DVec3::new(1.5, -2.0, 3.25),
                DVec3::new(500_000.125, 5_000_000.5, 161.75)
            ],
            "{storage}"
        );
        assert_eq!(
            file.cloud.colors,
            [[255, 128, 1], [16, 32, 48]],
            "{storage}"
        );
        assert_eq!(file.warnings.len(), 1, "{:?}", file.warnings);
        assert!(file.warnings[0].starts_with("1 of 3 points"));
    }
}

#[test]
fn older_headers_and_other_types() {
    let text = "COLUMNS x y z r g b\nSIZE 2 4 4 1 1 1\nTYPE I F F U U U\nWIDTH 2\nHEIGHT 1\nDATA ascii\r\n\
                -3 2 1 255 0 7\r\n4 5 6 1 2 3\r\n";
    let file = read_bytes(text.as_bytes()).unwrap();
    assert_eq!(file.cloud.points[0], DVec3::new(-3.0, 2.0, 1.0));
    assert_eq!(file.cloud.colors, [[255, 0, 7], [1, 2, 3]]);

    let mut bytes =
        b"FIELDS x y z\nSIZE 2 4 4\nTYPE I I F\nVIEWPOINT 1 2 3 1 0 0 0\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n"
            .to_vec();
    bytes.extend((-300_i16).to_le_bytes());
    bytes.extend((-70_000_i32).to_le_bytes());
    bytes.extend(0.5_f32.to_le_bytes());
    let file = read_bytes(&bytes).unwrap();
    assert_eq!(file.cloud.points, [DVec3::new(-300.0, -70_000.0, 0.5)]);
    assert!(
        file.warnings
            .iter()
            .any(|w| w.contains("VIEWPOINT (1 2 3 1 0 0 0)"))
    );
}

#[test]
fn real_file() {
    let Some(path) = shared_data("pointclouds-pdal/pcd/utm17_space.pcd") else {
        return;
    };
    let file = read_bytes(&fs::read(path).unwrap()).unwrap();
    assert_eq!(file.cloud.points.len(), 10);
    assert_eq!(
        file.cloud.points[9],
        DVec3::new(289_818.50, 4_320_980.59, 170.58)
    );
    assert_eq!(file.warnings, Vec::<String>::new());
}

#[test]
fn truncation_is_an_error() {
    for storage in STORAGES {
        let whole = sample(storage);
        // The last line may lack its end, and the last number some of its digits.
        for end in 0..whole.len() - 20 {
            assert!(read_bytes(&whole[..end]).is_err(), "{storage} cut at {end}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let good = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
    assert!(read_bytes(good.as_bytes()).is_ok());
    for (from, to, what) in [
        ("FIELDS x y z", "FIELDS x y w", "no field z"),
        ("SIZE 4 4 4", "SIZE 4 4", "2 sizes"),
        ("SIZE 4 4 4", "SIZE 4 4 3", "values of 3 bytes"),
        ("TYPE F F F", "TYPE F F Q", "type 'Q'"),
        ("POINTS 1", "POINTS 2", "WIDTH x HEIGHT are 1"),
        ("DATA ascii", "DATA zip", "'zip'"),
        ("1 2 3", "1 2", "2 values"),
        ("1 2 3", "1 2 x", "'x' is not a number"),
        ("1 2 3", "nan nan nan", "no points"),
        ("1 2 3\n", "1 2 3\n4 5 6\n", "goes on"),
        ("ascii\n1 2 3\n", "binary\n1 2 3\n", "promises 1 points"),
        ("WIDTH 1", "WIDTH 4000000000", "WIDTH x HEIGHT"),
    ] {
        let bad = good.replace(from, to);
        assert_ne!(bad, good);
        let fault = read_bytes(bad.as_bytes());
        // A binary point of 6 bytes passes the look at the whole file's size and is cut off.
        let fault = fault.unwrap_err();
        assert!(
            fault.what.contains(what) || fault.what.contains("it ends after"),
            "{fault}"
        );
    }
    let huge = good
        .replace("WIDTH 1", "WIDTH 4000000000")
        .replace("POINTS 1", "POINTS 4000000000")
        .replace("ascii", "binary");
    assert!(
        read_bytes(huge.as_bytes())
            .unwrap_err()
            .what
            .contains("promises")
    );
}

proptest! {
    #[test]
    fn no_damage_panics(at in 0..600_usize, byte in any::<u8>(), storage in 0..3_usize) {
        let mut bytes = sample(STORAGES[storage]);
        let at = at % bytes.len();
        bytes[at] = byte;
        let _ = read_bytes(&bytes);
    }
}
