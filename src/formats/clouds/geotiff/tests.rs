use std::fs;
use std::io::Cursor;

use glam::DVec3;
use tiff::encoder::colortype::{ColorType as Pixel, Gray8, Gray16, Gray32Float, GrayI16, RGB8};
use tiff::encoder::{Compression, TiffEncoder, TiffValue};

use super::*;
use crate::geometry::Bounds;
use fragscale_test_data::shared_data;

fn read_bytes(bytes: &[u8]) -> Result<CloudFile, Fault> {
    read(Cursor::new(bytes), bytes.len() as u64, &Progress::default())
}

/// What a file says beside its cells.
#[derive(Clone)]
struct Tags {
    scale: Option<[f64; 3]>,
    tie: Option<Vec<f64>>,
    matrix: Option<[f64; 16]>,
    keys: Vec<[u16; 4]>,
    texts: Option<String>,
    no_data: Option<&'static str>,
    metadata: Option<&'static str>,
}

/// Cells of half a metre, the corner of the first at (500 000, 5 000 000), UTM 30 north.
fn utm() -> Tags {
    Tags {
        scale: Some([0.5, 0.5, 0.0]),
        tie: Some(vec![0.0, 0.0, 0.0, 500_000.0, 5_000_000.0, 0.0]),
        matrix: None,
        keys: vec![[1024, 0, 1, 1], [1025, 0, 1, 1], [3072, 0, 1, 32_630]],
        texts: None,
        no_data: None,
        metadata: None,
    }
}

fn written<C: Pixel>(width: u32, cells: &[C::Inner], tags: &Tags) -> Vec<u8>
where
    [C::Inner]: TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut bytes).unwrap();
    let mut encoder = encoder.with_compression(Compression::Deflate(Default::default()));
    let height = cells.len() as u32 / width / C::BITS_PER_SAMPLE.len() as u32;
    let mut image = encoder.new_image::<C>(width, height).unwrap();
    image.rows_per_strip(2).unwrap();
    let directory = image.encoder();
    if let Some(scale) = &tags.scale {
        directory
            .write_tag(Tag::ModelPixelScaleTag, &scale[..])
            .unwrap();
    }
    if let Some(tie) = &tags.tie {
        directory
            .write_tag(Tag::ModelTiepointTag, &tie[..])
            .unwrap();
    }
    if let Some(matrix) = &tags.matrix {
        directory
            .write_tag(Tag::ModelTransformationTag, &matrix[..])
            .unwrap();
    }
    if !tags.keys.is_empty() {
        let mut keys = vec![1, 1, 0, tags.keys.len() as u16];
        keys.extend(tags.keys.as_flattened());
        directory
            .write_tag(Tag::GeoKeyDirectoryTag, &keys[..])
            .unwrap();
    }
    if let Some(texts) = &tags.texts {
        directory
            .write_tag(Tag::GeoAsciiParamsTag, texts.as_str())
            .unwrap();
    }
    if let Some(no_data) = tags.no_data {
        directory.write_tag(Tag::GdalNodata, no_data).unwrap();
    }
    if let Some(metadata) = tags.metadata {
        let tag = Tag::from_u16_exhaustive(GDAL_METADATA);
        directory.write_tag(tag, metadata).unwrap();
    }
    image.write_data(cells).unwrap();
    bytes.into_inner()
}

/// 3 x 5 cells, of which one has no elevation.
const CELLS: [f32; 15] = [
    1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, -9999.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.5,
];

#[test]
fn cells_become_points_at_their_middle() {
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &utm())).unwrap();
    assert_eq!(file.cloud.points.len(), 14);
    assert_eq!(
        file.cloud.points[0],
        DVec3::new(500_000.25, 4_999_999.75, 1.0)
    );
    assert_eq!(
        file.cloud.points[13],
        DVec3::new(500_001.25, 4_999_997.75, 15.5)
    );
    assert_eq!(file.crs.as_deref(), Some("EPSG:32630"));
    assert!(!file.geographic);
    assert_eq!(file.warnings, ["1 of 15 cells have no elevation"]);
    assert!(file.cloud.triangles.is_empty());
    // A writer's minus before the height of a cell, which others take for its size.
    let mut minus = utm();
    minus.scale = Some([0.5, -0.5, 0.0]);
    let same = read_bytes(&written::<Gray32Float>(3, &CELLS, &minus)).unwrap();
    assert_eq!(same.cloud.points, file.cloud.points);
}

#[test]
fn values_may_belong_to_corners_and_grids_be_turned() {
    let mut tags = utm();
    tags.keys[1] = [1025, 0, 1, 2];
    // The tie point may be any cell's.
    tags.tie = Some(vec![2.0, 1.0, 0.0, 500_000.0, 5_000_000.0, 0.0]);
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert_eq!(
        file.cloud.points[0],
        DVec3::new(499_999.0, 5_000_000.5, 1.0)
    );
    assert_eq!(
        file.cloud.points[5],
        DVec3::new(500_000.0, 5_000_000.0, 6.0)
    );

    // Columns run north, rows east, 2 apart.
    let mut matrix = [0.0; 16];
    (matrix[1], matrix[4]) = (2.0, 2.0);
    (matrix[3], matrix[7], matrix[15]) = (100.0, 200.0, 1.0);
    tags.matrix = Some(matrix);
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert_eq!(file.cloud.points[1], DVec3::new(100.0, 202.0, 2.0));
    assert_eq!(file.cloud.points[3], DVec3::new(102.0, 200.0, 4.0));
}

#[test]
fn whole_numbers_with_a_scale() {
    let mut tags = utm();
    tags.no_data = Some("0");
    tags.metadata = Some(
        "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.01</Item>\
         <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">100</Item></GDALMetadata>",
    );
    let file = read_bytes(&written::<Gray16>(2, &[0, 150, 65_535, 1], &tags)).unwrap();
    let elevations: Vec<f64> = file.cloud.points.iter().map(|p| p.z).collect();
    assert_eq!(elevations, [101.5, 755.35, 100.01]);
    let file = read_bytes(&written::<GrayI16>(2, &[0, -150, -32_768, 1], &utm())).unwrap();
    assert_eq!(file.cloud.points[1].z, -150.0);
    assert_eq!(file.cloud.points.len(), 3);
}

#[test]
fn coordinate_systems() {
    let mut tags = utm();
    tags.keys = vec![[1024, 0, 1, 2], [2048, 0, 1, 4326]];
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert_eq!(file.crs.as_deref(), Some("EPSG:4326"));
    assert!(file.geographic);

    // As GDAL, ArcGIS and fragscale (`exports::geo_tags`) write a system that has no code.
    let wkt = "PROJCS[\"Mine grid\",GEOGCS[\"WGS 84\"]]";
    let text = format!("ESRI PE String = {wkt}|");
    let length = text.len() as u16;
    tags.keys = vec![
        [1024, 0, 1, 32_767],
        [3072, 0, 1, 32_767],
        [3073, 34_737, length, 0],
    ];
    tags.texts = Some(text);
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert_eq!((file.crs.as_deref(), file.geographic), (Some(wkt), false));
    tags.texts = None;

    // A projection by parameters is not its geographic base.
    tags.keys = vec![[1024, 0, 1, 1], [2048, 0, 1, 4326], [3072, 0, 1, 32_767]];
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert_eq!((file.crs, file.geographic), (None, false));
    assert!(file.warnings[0].contains("defined by parameters"));

    tags.keys = vec![[1024, 0, 1, 1], [3076, 0, 1, 9001], [4099, 0, 1, 9003]];
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert!(file.warnings[0].contains("heights are in us-ft, not in m"));
    // CELLS begin with 1: 1200/3937 m.
    let foot = 1200.0 / 3937.0;
    assert!((file.cloud.points[0].z - foot).abs() < 1e-12);

    // NAVD88 in feet over UTM, and by GDAL's word, which goes before the key.
    tags.keys = vec![[1024, 0, 1, 1], [3072, 0, 1, 32_630], [4096, 0, 1, 6360]];
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert_eq!(file.crs.as_deref(), Some("EPSG:32630+6360"));
    assert_eq!(file.cloud.points[0].z, 1.0);
    tags.keys = vec![[1024, 0, 1, 1], [3072, 0, 1, 32_630], [4099, 0, 1, 9001]];
    tags.metadata = Some(
        "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">cm</Item></GDALMetadata>",
    );
    let file = read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).unwrap();
    assert!(
        (file.cloud.points[0].z - 0.01).abs() < 1e-15,
        "{:?}",
        file.warnings
    );
    tags.metadata = None;

    tags.keys = vec![[1024, 0, 1, 3]];
    assert!(read_bytes(&written::<Gray32Float>(3, &CELLS, &tags)).is_err());
}

#[test]
fn pictures_and_bare_rasters_are_refused() {
    let mut bare = utm();
    (bare.scale, bare.tie) = (None, None);
    let refused = |bytes: Vec<u8>| read_bytes(&bytes).unwrap_err().what;
    assert!(refused(written::<RGB8>(2, &[7; 12], &bare)).contains("a picture"));
    assert!(refused(written::<RGB8>(2, &[7; 12], &utm())).contains("a picture"));
    assert!(refused(written::<Gray8>(2, &[7; 4], &bare)).contains("a picture"));
    assert!(refused(written::<Gray32Float>(3, &CELLS, &bare)).contains("no georeferencing"));
    bare.tie = Some(vec![1.0; 18]);
    assert!(refused(written::<Gray32Float>(3, &CELLS, &bare)).contains("3 control points"));
    let nothing = [f32::NAN; 4];
    assert!(refused(written::<Gray32Float>(2, &nothing, &utm())).contains("none of its cells"));
    let mut flat = utm();
    flat.scale = Some([0.0, 0.5, 0.0]);
    assert!(refused(written::<Gray32Float>(3, &CELLS, &flat)).contains("no size"));
}

/// 20 x 18 cells in tiles of 16 x 16, big-endian, not compressed; the second tile is not stored. The
/// value of a cell is 100 row + column.
fn tiled() -> Vec<u8> {
    let (mut data, mut offsets, mut lengths) = (vec![0; 8], Vec::new(), Vec::new());
    for (down, across) in [(0, 0), (0, 16), (16, 0), (16, 16)] {
        let stored = (down, across) != (0, 16);
        offsets.push(if stored { data.len() as u32 } else { 0 });
        lengths.push(if stored { 1024 } else { 0 });
        for cell in (0..256_u16).filter(|_| stored) {
            let value = 100 * (down + cell / 16) + across + cell % 16;
            data.extend(f32::from(value).to_be_bytes());
        }
    }
    let directory = data.len() as u32;
    data[..4].copy_from_slice(b"MM\0*");
    data[4..8].copy_from_slice(&directory.to_be_bytes());
    let longs = |values: &[u32]| {
        values
            .iter()
            .flat_map(|v| v.to_be_bytes())
            .collect::<Vec<u8>>()
    };
    let doubles = |values: &[f64]| values.iter().flat_map(|v| v.to_be_bytes()).collect();
    let entries: [(u16, u16, u32, Vec<u8>); 13] = [
        (256, 4, 1, longs(&[20])),
        (257, 4, 1, longs(&[18])),
        (258, 4, 1, longs(&[32])),
        (259, 4, 1, longs(&[1])),
        (262, 4, 1, longs(&[1])),
        (277, 4, 1, longs(&[1])),
        (322, 4, 1, longs(&[16])),
        (323, 4, 1, longs(&[16])),
        (324, 4, 4, longs(&offsets)),
        (325, 4, 4, longs(&lengths)),
        (339, 4, 1, longs(&[3])),
        (33550, 12, 3, doubles(&[1.0, 1.0, 0.0])),
        (33922, 12, 6, doubles(&[0.0, 0.0, 0.0, -0.5, 0.5, 0.0])),
    ];
    data.extend((entries.len() as u16).to_be_bytes());
    let mut behind = directory + 2 + 12 * entries.len() as u32 + 4;
    let mut values = Vec::new();
    for (tag, kind, count, bytes) in entries {
        data.extend(tag.to_be_bytes());
        data.extend(kind.to_be_bytes());
        data.extend(count.to_be_bytes());
        if bytes.len() > 4 {
            data.extend(behind.to_be_bytes());
            behind += bytes.len() as u32;
            values.extend(bytes);
        } else {
            data.extend(bytes);
        }
    }
    data.extend([0; 4]);
    data.extend(values);
    data
}

#[test]
fn tiles_reach_beyond_the_edge_and_may_be_missing() {
    let file = read_bytes(&tiled()).unwrap();
    // The missing tile has 4 x 16 cells within the raster.
    assert_eq!(file.cloud.points.len(), 20 * 18 - 64);
    for point in &file.cloud.points {
        assert_eq!(point.z, -100.0 * point.y + point.x, "{point}");
    }
    assert_eq!(file.warnings, ["64 of 360 cells have no elevation"]);
}

#[test]
fn large_rasters_are_thinned() {
    assert_eq!(step_for(5000, 5000), 1);
    assert_eq!(step_for(5001, 5000), 2);
    assert_eq!(step_for(10_000, 10_000), 2);
    assert_eq!(step_for(u32::MAX, u32::MAX), 858_994);
    // Steps go on across strips and keep to the raster's own grid.
    let bytes = written::<Gray32Float>(3, &CELLS, &utm());
    let mut tiff = TiffFile::open(Cursor::new(&bytes), bytes.len() as u64).unwrap();
    let layout = tiff.layout().unwrap();
    let cells = Cells::of(&mut tiff, layout).unwrap();
    let mut taken = Vec::new();
    let progress = Progress::default();
    cells
        .read(&mut tiff, 2, &progress, |column, row, z| {
            taken.push((column, row, z))
        })
        .unwrap();
    assert_eq!(
        taken,
        [
            (0, 0, Some(1.0)),
            (2, 0, Some(3.0)),
            (0, 2, Some(7.0)),
            (2, 2, Some(9.0)),
            (0, 4, Some(13.0)),
            (2, 4, Some(15.5))
        ]
    );
}

#[test]
fn a_real_elevation_model() {
    let Some(folder) = shared_data("orthority-ngi-opk") else {
        return;
    };
    let file = read_bytes(&fs::read(folder.join("dem.tif")).unwrap()).unwrap();
    // 327 x 508 cells of 24 m; the corner of the first is at (-60454, -3723500).
    assert_eq!(file.cloud.points.len(), 327 * 508);
    let bounds = Bounds::of(&file.cloud.points).unwrap();
    assert_eq!((bounds.min.x, bounds.max.y), (-60_442.0, -3_723_512.0));
    assert_eq!(bounds.max.x, -60_442.0 + 326.0 * 24.0);
    assert_eq!(bounds.min.y, -3_723_512.0 - 507.0 * 24.0);
    assert!(bounds.min.z > 0.0 && bounds.max.z < 1000.0);
    let photo = fs::read(folder.join("3324c_2015_1004_05_0182_RGB.tif")).unwrap();
    assert!(read_bytes(&photo).unwrap_err().what.contains("a picture"));
}

#[test]
fn truncation_and_damage_are_errors_or_the_same() {
    let whole = written::<Gray32Float>(3, &CELLS, &utm());
    for end in 0..whole.len() {
        // What is cut off may be a tag that this reader does not use.
        let _ = read_bytes(&whole[..end]);
        for byte in [0, 0xff] {
            let mut bytes = whole.clone();
            bytes[end] = byte;
            let _ = read_bytes(&bytes);
        }
    }
    assert!(read_bytes(&whole[..whole.len() / 2]).is_err());
}
