//! Tests of samples.

use las::{Builder, Color, Point, Transform, Vector, Writer};

use super::*;

/// Places on a sheet of 2000 points to a row, 1 apart, brighter to the east.
fn sheet(count: u64, format: u8, compressed: bool) -> Vec<u8> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.is_compressed = compressed;
    let axis = |offset| Transform {
        scale: 0.001,
        offset,
    };
    builder.transforms = Vector {
        x: axis(500_000.0),
        y: axis(5_000_000.0),
        z: axis(0.0),
    };
    let mut writer = Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
    for i in 0..count {
        let (column, row) = (i % 2000, i / 2000);
        let bright = u16::try_from(column * 32).unwrap();
        writer
            .write_point(Point {
                x: 500_000.0 + column as f64,
                y: 5_000_000.0 + row as f64,
                z: 100.0,
                gps_time: Some(0.0),
                color: Some(Color::new(bright, bright, bright)),
                ..Point::default()
            })
            .unwrap();
    }
    writer.into_inner().unwrap().into_inner()
}

/// Every row of a large file has points in its sample, each with its own colour.
#[test]
fn a_sample_is_from_all_over_the_file() {
    for compressed in [false, true] {
        let bytes = sheet(SAMPLED_FROM, 7, compressed);
        let (file, total) = read_sample(Cursor::new(bytes), &Progress::default()).unwrap();
        assert_eq!(total, SAMPLED_FROM);
        let count = file.cloud.points.len();
        assert!((700_000..=900_000).contains(&count), "{count}");
        let tenths: std::collections::BTreeSet<i64> = (file.cloud.points.iter())
            .map(|point| ((point.y - 5_000_000.0) / 100.0) as i64)
            .collect();
        assert_eq!(tenths.len(), 10);
        for (point, color) in file.cloud.points.iter().zip(&file.cloud.colors) {
            let column = point.x - 500_000.0;
            assert!((0.0..2000.0).contains(&column) && point.z == 100.0);
            assert_eq!(f64::from(color[0]), (column * 32.0 / 256.0).floor());
        }
    }
}

#[test]
fn a_small_file_has_no_sample_and_a_damaged_one_none_either() {
    let progress = Progress::default();
    assert!(read_sample(Cursor::new(sheet(1000, 7, true)), &progress).is_none());
    assert!(read_sample(Cursor::new(b"LASF".to_vec()), &progress).is_none());
    let mut cut = sheet(SAMPLED_FROM, 7, true);
    cut.truncate(cut.len() / 2);
    assert!(read_sample(Cursor::new(cut), &progress).is_none());
}
