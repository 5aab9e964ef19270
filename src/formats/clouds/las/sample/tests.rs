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

/// A COPC file of a root with `coarse` points (at z 1) and four nodes below it with more each (at z 2), one
/// chunk a node, the root's last: as the specification has it, less the record that repeats the hierarchy.
fn octree(coarse: usize, fine: usize) -> Vec<u8> {
    use laz::laszip::{LasZipCompressor, LazVlr};
    use laz::{LazItemRecordBuilder, LazVlrBuilder};
    let total = coarse + 4 * fine;
    let items = LazItemRecordBuilder::default_for_point_format_id(7, 0).unwrap();
    let laz: LazVlr = LazVlrBuilder::new(items).with_variable_chunk_size().build();
    let mut laszip = Vec::new();
    laz.write_to(&mut laszip).unwrap();
    let record = |user: &str, id: u16, data: Vec<u8>| las::Vlr {
        user_id: user.to_owned(),
        record_id: id,
        description: String::new(),
        data,
    };
    // Uncompressed first: header and records are right, and so are the points.
    let mut builder = Builder::from((1, 4));
    builder.point_format = las::point::Format::new(7).unwrap();
    builder.vlrs = vec![
        record("copc", 1, vec![0; 160]),
        record("laszip encoded", 22204, laszip),
    ];
    let header = builder.into_header().unwrap();
    let mut writer = Writer::new(Cursor::new(Vec::new()), header).unwrap();
    let places = (0..fine * 4)
        .map(|i| (i, 2.0))
        .chain((0..coarse).map(|i| (i, 1.0)));
    for (i, z) in places {
        let point = Point {
            x: (i % 1000) as f64,
            y: (i / 1000) as f64,
            z,
            gps_time: Some(0.0),
            color: Some(Color::new(5, 6, 7)),
            ..Point::default()
        };
        writer.write_point(point).unwrap();
    }
    let plain = writer.into_inner().unwrap().into_inner();
    let begin = u32::from_le_bytes(plain[96..100].try_into().unwrap()) as usize;
    let record = usize::from(u16::from_le_bytes(plain[105..107].try_into().unwrap()));
    let points = &plain[begin..begin + total * record];
    let mut file = Cursor::new(plain[..begin].to_vec());
    file.set_position(begin as u64);
    let mut compressor = LasZipCompressor::new(&mut file, laz).unwrap();
    let (mut entries, mut from) = (Vec::new(), 0);
    compressor.reserve_offset_to_chunk_table().unwrap();
    for (level, count) in [(1_i32, fine), (1, fine), (1, fine), (1, fine), (0, coarse)] {
        let at = compressor.get_mut().position();
        compressor
            .compress_many(&points[from * record..(from + count) * record])
            .unwrap();
        compressor.finish_current_chunk().unwrap();
        let size = compressor.get_mut().position() - at;
        let size = i32::try_from(size).unwrap();
        entries.push((level, at, size, i32::try_from(count).unwrap()));
        from += count;
    }
    compressor.done().unwrap();
    drop(compressor);
    let mut bytes = file.into_inner();
    // The points are compressed.
    bytes[104] |= 0x80;
    let (place, size) = (bytes.len() as u64, (entries.len() * ENTRY) as u64);
    // The first record's data stand behind the header of 375 bytes and its own of 54.
    bytes[429 + 40..429 + 48].copy_from_slice(&place.to_le_bytes());
    bytes[429 + 48..429 + 56].copy_from_slice(&size.to_le_bytes());
    for (number, (level, at, size, count)) in (0_i32..).zip(entries) {
        for value in [level, number % 2, number / 2 % 2, 0] {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend(at.to_le_bytes());
        bytes.extend(size.to_le_bytes());
        bytes.extend(count.to_le_bytes());
    }
    bytes
}

/// The coarse level comes first, wherever it stands in the file, and the finer one only as far as needed. Read
/// whole, the file has all points.
#[test]
fn of_an_octree_the_coarse_levels_come_first() {
    let progress = Progress::default();
    let (coarse, fine) = (1_000_000, 250_001);
    let bytes = octree(coarse, fine);
    let whole = crate::clouds::las::read(Cursor::new(bytes.clone()), &progress).unwrap();
    assert_eq!(whole.cloud.points.len(), coarse + 4 * fine);
    let (file, total) = read_sample(Cursor::new(bytes.clone()), &progress).unwrap();
    assert_eq!(total, (coarse + 4 * fine) as u64);
    assert_eq!(file.cloud.points.len(), coarse);
    assert!(file.cloud.points.iter().all(|point| point.z == 1.0));
    assert!(file.cloud.colors.iter().all(|color| *color == [5, 6, 7]));
    // A root that is not enough, and entries that lie.
    let (coarse, fine) = (100_000, 500_000);
    let bytes = octree(coarse, fine);
    let (file, _) = read_sample(Cursor::new(bytes.clone()), &progress).unwrap();
    assert_eq!(file.cloud.points.len(), coarse + 2 * fine);
    let last = bytes.len() - 4;
    for lie in [i32::MAX, 1_000_000_000] {
        let mut lying = bytes.clone();
        lying[last..].copy_from_slice(&lie.to_le_bytes());
        assert!(read_sample(Cursor::new(lying), &progress).is_none());
    }
}
