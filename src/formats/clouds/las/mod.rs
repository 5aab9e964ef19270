//! LAS and LAZ: ASPRS "LAS Specification 1.4 - R15" and the versions before it; LAZ is LASzip's
//! compression of the same records.
//!
//! - Coordinates are integers with a scale and an offset in the header, so UTM values keep all
//!   their digits: x = X * scale + offset.
//! - Colours are 16 bits wide; many programs write 8-bit values into them all the same, which shows
//!   in the largest value.
//! - Withheld points and those that are classified as noise are points as all others: no point is dropped. How many they are is
//!   said (`flags`).
//! - The coordinate system stands in a variable length record: WKT (OGC 01-009), or GeoTIFF keys, of
//!   which 3072 (projected) or 2048 (geographic) hold an EPSG code, and 4096 and 4099 that of heights (`geo_keys`).
//!
//! Decoding is done by the las crate, in portions, after [`claims`] has held the header against the
//! file, so that a header that claims too much ends in an error instead of in memory. Its decompressor asserts on damaged data; that panic is caught here
//! and becomes an error like any other.

pub(super) mod claims;
mod flags;
pub(crate) mod sample;

use std::io::{Read, Seek};
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use las::PointDataBuilder;
use las::crs::GeoTiffData;

use claims::WithCount;
use flags::{Marked, mark_of};

use crate::clouds::cloud_file::{CloudFile, counts_degrees, first_not_finite};
use crate::clouds::geo_keys::{GEODETIC_CRS, MODEL_TYPE, PROJECTED_CRS, StatedHeights, code};
use crate::clouds::pieces::copc;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::surface::CloudFacts;

/// How many points are decoded at once: ten compressed chunks, so that all cores have work.
const PORTION: u64 = 500_000;

/// The most bytes of records that are decoded at once.
const PORTION_BYTES: u64 = 64 << 20;

/// Reads a LAS or LAZ file.
///
/// # Errors
/// Where it is no such file, is cut off, or a coordinate is not finite.
pub(crate) fn read(
    mut input: impl Read + Seek + Send + Sync + 'static,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    // Nothing outlives the closure that a panic could have left half-done.
    catch_unwind(AssertUnwindSafe(|| {
        let count = claims::check(&mut input)?;
        let facts = facts(&mut input, count.found);
        input.rewind().map_err(|error| {
            Fault::new(format!("it cannot be read ({error})"), "check the disk")
        })?;
        let mut file = match count.warning() {
            None => decode(input, progress)?,
            Some(_) => decode(WithCount::new(input, count.found), progress)?,
        };
        file.warnings.extend(count.warning());
        file.facts = facts;
        Ok(file)
    }))
    .unwrap_or_else(|_| {
        Err(Fault::new(
            "its compressed points are damaged",
            "copy or export it again",
        ))
    })
}

/// What an octree says of its cloud; `None` where there is none, or none that can be used.
fn facts(input: &mut (impl Read + Seek), records: u32) -> Option<CloudFacts> {
    let header = las::Header::new(WithCount::new(&mut *input, records)).ok()?;
    header.copc_info_vlr()?;
    copc::Tree::read(input, &header)
        .ok()??
        .facts(input, &header)
        .ok()
}

fn decode(
    input: impl Read + Seek + Send + Sync + 'static,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let broken = |error: las::Error| {
        Fault::new(
            format!("it cannot be read as LAS or LAZ ({error})"),
            "copy or export it again",
        )
    };
    let mut reader = las::Reader::new(input).map_err(broken)?;
    let total = reader.header().number_of_points();
    let (mut file, heights) = stated(reader.header());
    let mut portion = PointDataBuilder::new().for_header(reader.header()).build();
    let portion_size = PORTION.min(PORTION_BYTES / portion.record_len().max(1) as u64);
    let mut colors = Colors::default();
    let is_extended = reader.header().point_format().is_extended;
    let (mut done, mut marked) = (0_u64, Marked::default());
    loop {
        progress.advance(done, total)?;
        let read = reader.fill_points(portion_size, &mut portion).map_err(|error| {
            Fault::new(
                format!("it breaks off after about {done} of the {total} points that its header promises ({error})"),
                "copy or export it again",
            )
        })?;
        if read == 0 {
            break;
        }
        done += read;
        let records = portion.raw_bytes().chunks_exact(portion.record_len());
        for mark in records.filter_map(|record| mark_of(record, is_extended)) {
            marked.add(mark);
        }
        let coordinates = portion.x().zip(portion.y()).zip(portion.z());
        file.cloud
            .points
            .extend(coordinates.map(|((x, y), z)| DVec3::new(x, y, z * heights)));
        if let Some(wide) = portion.rgb() {
            colors.extend(wide.map(|(r, g, b)| [r, g, b]));
        }
    }
    file.warnings.extend(marked.warning());
    if let Some(index) = first_not_finite(&file.cloud.points) {
        return Err(Fault::new(
            format!("point {index} (counted from 0) has a coordinate that is not a finite number"),
            "check the scale and offset in its header",
        ));
    }
    file.cloud.colors = colors.finish();
    Ok(file)
}

/// Colours of 16 bits, of which eight are kept: the lower ones as long as all channels fit into them, and the
/// higher ones of all as soon as one does not. (Twice the memory would be in use otherwise.)
#[derive(Debug, Default)]
struct Colors {
    kept: Vec<[u8; 3]>,
    is_wide: bool,
}

impl Colors {
    fn extend(&mut self, colors: impl Iterator<Item = [u16; 3]>) {
        for color in colors {
            if !self.is_wide && color.iter().any(|&channel| channel >= 256) {
                self.is_wide = true;
                // The higher eight bits of those before.
                self.kept.fill([0; 3]);
            }
            let shift = if self.is_wide { 8 } else { 0 };
            // Both fit.
            self.kept
                .push(color.map(|channel| (channel >> shift) as u8));
        }
    }

    fn finish(self) -> Vec<[u8; 3]> {
        self.kept
    }
}

/// A file without points that has the coordinate system which a header states, and what its heights are to be multiplied by to
/// count in the unit of that.
pub(super) fn stated(header: &las::Header) -> (CloudFile, f64) {
    let mut file = CloudFile::default();
    let keys = header.get_geotiff_crs().ok().flatten();
    let number = |key: u16| {
        let mut entries = keys.as_ref()?.entries.iter();
        entries.find_map(|entry| match entry.data {
            GeoTiffData::U16(value) if entry.id == key => Some(value),
            _ => None,
        })
    };
    if let Some(wkt) = wkt(header) {
        file.crs = Some(wkt);
    } else {
        let projected = number(PROJECTED_CRS);
        let code = match code(projected) {
            // The base of a projection that is defined by parameters is not its own system.
            None if projected.is_none() || number(MODEL_TYPE) == Some(2) => {
                code(number(GEODETIC_CRS))
            }
            of_projection => of_projection,
        };
        file.crs = code.map(|code| format!("EPSG:{code}"));
    }
    let in_degrees = match &file.crs {
        Some(crs) => counts_degrees(crs),
        None => number(MODEL_TYPE) == Some(2),
    };
    file.set_geographic(in_degrees);
    // A WKT says itself what heights are.
    let is_code = |crs: &String| crs.starts_with("EPSG:");
    if file.crs.as_ref().is_some_and(|crs| !is_code(crs)) {
        return (file, 1.0);
    }
    let factor = StatedHeights::of(number).tell(&mut file);
    (file, factor)
}

fn wkt(header: &las::Header) -> Option<String> {
    let text = String::from_utf8_lossy(header.get_wkt_crs_bytes()?);
    let text = text.trim_matches(|c: char| c == '\0' || c.is_whitespace());
    (!text.is_empty()).then(|| text.to_owned())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use las::{Builder, Color, Point, Transform, Vector, Writer};
    use proptest::prelude::*;

    use super::*;

    /// A hundred points of a format and version, at UTM coordinates.
    fn sample(format: u8, minor: u8, compressed: bool) -> Vec<u8> {
        let mut builder = Builder::from((1, minor));
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
        let (has_color, has_time, has_nir) = (
            builder.point_format.has_color,
            builder.point_format.has_gps_time,
            builder.point_format.has_nir,
        );
        let mut writer =
            Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
        for i in 0..100_u16 {
            let step = f64::from(i);
            let point = Point {
                x: 500_000.0 + step * 0.5,
                y: 5_000_000.125 - step,
                z: 161.001 + step,
                color: has_color.then(|| Color::new(256 * i, 512, 65_535)),
                gps_time: has_time.then_some(step),
                nir: has_nir.then_some(7),
                ..Point::default()
            };
            writer.write_point(point).unwrap();
        }
        writer.into_inner().unwrap().into_inner()
    }

    fn read_bytes(bytes: Vec<u8>) -> Result<CloudFile, Fault> {
        read(Cursor::new(bytes), &Progress::default())
    }

    /// UTM with heights in feet, by the key of their unit and by that of their system; California in feet with heights in metres.
    /// One point of ground, one withheld, one of noise: all count, and the two are told.
    #[test]
    fn withheld_points_and_noise_are_told() {
        use las::point::Classification;
        for (format, minor) in [(2, 2), (3, 4), (7, 4)] {
            for compressed in [false, true] {
                let mut builder = Builder::from((1, minor));
                builder.point_format = las::point::Format::new(format).unwrap();
                builder.point_format.is_compressed = compressed;
                let has_time = builder.point_format.has_gps_time;
                let header = builder.into_header().unwrap();
                let mut writer = Writer::new(Cursor::new(Vec::new()), header).unwrap();
                for (x, is_withheld, classification) in [
                    (1.0, false, Classification::Ground),
                    (2.0, true, Classification::Ground),
                    (3.0, false, Classification::LowPoint),
                ] {
                    let point = Point {
                        x,
                        is_withheld,
                        classification,
                        color: Some(Color::new(x as u16, 0, 0)),
                        gps_time: has_time.then_some(0.0),
                        ..Point::default()
                    };
                    writer.write_point(point).unwrap();
                }
                writer.close().unwrap();
                let bytes = writer.into_inner().unwrap().into_inner();
                let file = read(Cursor::new(bytes), &Progress::default()).unwrap();
                assert_eq!(file.cloud.points.len(), 3, "{format}");
                assert_eq!(
                    file.warnings,
                    [
                        "1 points that it marks as withheld and 1 that it classifies as noise (7, 18) are taken as rock like all others: if \
                         they are none, export the file without them"
                    ]
                );
            }
        }
    }

    #[test]
    fn heights_in_another_unit() {
        let with_keys = |keys: &[[u16; 4]]| {
            let mut builder = Builder::from((1, 2));
            let mut data: Vec<u16> = vec![1, 1, 0, keys.len() as u16];
            data.extend(keys.iter().flatten());
            builder.vlrs.push(las::Vlr {
                user_id: "LASF_Projection".to_owned(),
                record_id: 34_735,
                description: String::new(),
                data: data
                    .iter()
                    .flat_map(|number| number.to_le_bytes())
                    .collect(),
            });
            let header = builder.into_header().unwrap();
            let mut writer = Writer::new(Cursor::new(Vec::new()), header).unwrap();
            for (x, z) in [(0.0, 100.0), (1.0, 200.0), (2.0, 300.0)] {
                let (x, y) = (500_000.0 + x, 1_000_000.0 + x * x);
                let point = Point {
                    x,
                    y,
                    z,
                    ..Point::default()
                };
                writer.write_point(point).unwrap();
            }
            let bytes = writer.into_inner().unwrap().into_inner();
            let file = read_bytes(bytes).unwrap();
            (file.cloud.points[0].z, file.crs.unwrap_or_default())
        };
        let system = |code: u16| [3072, 0, 1, code];
        let (z, crs) = with_keys(&[[1024, 0, 1, 1], system(32_633), [4099, 0, 1, 9003]]);
        assert!((z - 100.0 * 1200.0 / 3937.0).abs() < 1e-9, "{z}");
        assert_eq!(crs, "EPSG:32633");
        let (z, crs) = with_keys(&[[1024, 0, 1, 1], system(32_633), [4096, 0, 1, 6360]]);
        // The way to the world knows it of the system.
        assert_eq!((z, crs.as_str()), (100.0, "EPSG:32633+6360"));
        let metres = [system(2226), [4096, 0, 1, 5703], [4099, 0, 1, 9001]];
        assert_eq!(with_keys(&metres), (100.0, "EPSG:2226+5703".to_owned()));
    }

    #[test]
    fn every_point_format_without_waveforms() {
        for compressed in [false, true] {
            for (format, minor) in [
                (0, 0),
                (0, 1),
                (1, 1),
                (2, 2),
                (3, 3),
                (6, 4),
                (7, 4),
                (8, 4),
            ] {
                // LASzip starts at version 1.2 of the las crate's writer.
                if compressed && minor < 2 {
                    continue;
                }
                let file = read_bytes(sample(format, minor, compressed)).unwrap();
                let last = *file.cloud.points.last().unwrap();
                let expected = DVec3::new(500_049.5, 4_999_901.125, 260.001);
                assert_eq!(file.cloud.points.len(), 100);
                assert!((last - expected).length() < 1e-9, "format {format}: {last}");
                if [2, 3, 7, 8].contains(&format) {
                    assert_eq!(file.cloud.colors[99], [99, 2, 255], "format {format}");
                } else {
                    assert!(file.cloud.colors.is_empty());
                }
                assert_eq!(file.crs, None);
            }
        }
    }

    #[test]
    fn truncation_is_an_error() {
        for compressed in [false, true] {
            let whole = sample(3, 2, compressed);
            for end in (0..whole.len() - 60).step_by(7) {
                let fault = read_bytes(whole[..end].to_vec());
                assert!(
                    fault.is_err(),
                    "cut at {end} of {} (compressed: {compressed})",
                    whole.len()
                );
            }
        }
    }

    #[test]
    fn a_lying_count_is_an_error() {
        for compressed in [false, true] {
            let mut bytes = sample(3, 2, compressed);
            // Number of point records, at byte 107 of headers before 1.4.
            bytes[107..111].copy_from_slice(&4_000_000_000_u32.to_le_bytes());
            let fault = read_bytes(bytes).unwrap_err();
            assert!(compressed || fault.what.contains("4000000000"), "{fault}");
        }
    }

    /// Found by the fuzzer: the las crate asked for 585 472 246 525 460 480 bytes, and the program was
    /// ended.
    #[test]
    fn extended_records_that_claim_more_than_the_file_are_refused() {
        for compressed in [false, true] {
            let mut bytes = sample(6, 4, compressed);
            let start = bytes.len() as u64;
            // Of header 1.4: where the first one begins, and how many there are.
            bytes[235..243].copy_from_slice(&start.to_le_bytes());
            bytes[243..247].copy_from_slice(&1_u32.to_le_bytes());
            let with_record = |claimed: u64| {
                let mut record = [0; 60];
                record[20..28].copy_from_slice(&claimed.to_le_bytes());
                [&bytes[..], &record, b"abcde"].concat()
            };
            assert_eq!(read_bytes(with_record(5)).unwrap().cloud.points.len(), 100);
            for claimed in [6, 585_472_246_525_460_480, u64::MAX] {
                let fault = read_bytes(with_record(claimed)).unwrap_err();
                assert!(fault.what.contains("extended variable length"), "{fault}");
            }
            bytes[235..243].copy_from_slice(&u64::MAX.to_le_bytes());
            assert!(read_bytes(bytes).is_err());
        }
    }

    /// Found by the fuzzer: 57 664 316 192 bytes were asked for, for the chunks of no point.
    #[test]
    fn a_lying_chunk_table_is_refused_without_points_too() {
        let mut bytes = sample(3, 2, true);
        bytes[107..111].fill(0);
        let begin = u32::from_le_bytes(bytes[96..100].try_into().unwrap()) as usize;
        let place = u64::from_le_bytes(bytes[begin..begin + 8].try_into().unwrap()) as usize;
        bytes[place + 4..place + 8].copy_from_slice(&u32::MAX.to_le_bytes());
        let fault = read_bytes(bytes).unwrap_err();
        assert!(fault.what.contains("4294967295 chunks"), "{fault}");
    }

    #[test]
    fn scales_that_are_no_numbers_are_refused() {
        let mut bytes = sample(0, 2, false);
        // The x scale, at byte 131.
        bytes[131..139].copy_from_slice(&f64::NAN.to_le_bytes());
        assert!(
            read_bytes(bytes)
                .unwrap_err()
                .what
                .contains("not a finite number")
        );
    }

    /// The sample with these variable length records, and their number overwritten.
    fn with_records(
        records: &[las::Vlr],
        compressed: bool,
        stated: impl Fn(u32) -> u32,
    ) -> Vec<u8> {
        let mut builder = Builder::from((1, 4));
        builder.point_format = las::point::Format::new(6).unwrap();
        builder.point_format.is_compressed = compressed;
        builder.has_wkt_crs = true;
        builder.vlrs = records.to_vec();
        let axis = Transform {
            scale: 0.01,
            offset: 0.0,
        };
        builder.transforms = Vector {
            x: axis,
            y: axis,
            z: axis,
        };
        let header = builder.into_header().unwrap();
        let mut writer = Writer::new(Cursor::new(Vec::new()), header).unwrap();
        let (x, y, z) = (3_980_581.0, -11_903.0, 4_966_824.0);
        for i in 0..10 {
            let x = x + f64::from(i);
            let point = Point {
                x,
                y,
                z,
                gps_time: Some(0.0),
                ..Point::default()
            };
            writer.write_point(point).unwrap();
        }
        let mut bytes = writer.into_inner().unwrap().into_inner();
        let count = u32::from_le_bytes(bytes[100..104].try_into().unwrap());
        bytes[100..104].copy_from_slice(&stated(count).to_le_bytes());
        bytes
    }

    fn wkt_record(wkt: &str) -> las::Vlr {
        las::Vlr {
            user_id: "LASF_Projection".to_owned(),
            record_id: 2112,
            description: String::new(),
            data: wkt.as_bytes().to_vec(),
        }
    }

    #[test]
    fn a_wrong_count_of_records_is_said_and_mended() {
        let records = [wkt_record("EPSG:32633")];
        for compressed in [false, true] {
            let read = |stated: &dyn Fn(u32) -> u32| {
                let file = read_bytes(with_records(&records, compressed, stated)).unwrap();
                assert_eq!(file.cloud.points.len(), 10);
                assert_eq!(file.crs.as_deref(), Some("EPSG:32633"));
                file.warnings.join("\n")
            };
            assert_eq!(read(&|count| count), "");
            for wrong in [0, 9, u32::MAX] {
                let said = read(&|_| wrong);
                assert!(said.contains(&format!("states {wrong} variable")), "{said}");
            }
        }
    }

    /// WKT 2 as PROJ writes it for EPSG:4978, with its code and without, and WKT 1.
    #[test]
    fn positions_from_the_earths_centre_are_no_degrees() {
        let wkt2 = r#"GEODCRS["WGS 84",ENSEMBLE["World Geodetic System 1984 ensemble",MEMBER["World Geodetic System 1984 (G2139)"],ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]],ENSEMBLEACCURACY[2.0]],PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]],CS[Cartesian,3],AXIS["(X)",geocentricX,ORDER[1],LENGTHUNIT["metre",1]],AXIS["(Y)",geocentricY,ORDER[2],LENGTHUNIT["metre",1]],AXIS["(Z)",geocentricZ,ORDER[3],LENGTHUNIT["metre",1]]"#;
        let wkt1 = r#"GEOCCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["metre",1],AUTHORITY["EPSG","4978"]]"#;
        let texts = [
            format!("{wkt2},ID[\"EPSG\",4978]]"),
            format!("{wkt2}]"),
            wkt1.to_owned(),
        ];
        for text in texts {
            let bytes = with_records(&[wkt_record(&text)], true, |count| count);
            let file = read_bytes(bytes).unwrap();
            assert!(
                !file.geographic && file.warnings.is_empty(),
                "{:?}",
                file.warnings
            );
            let crs = crate::geodesy::Crs::understand(file.crs.as_deref().unwrap()).unwrap();
            assert_eq!(crs.kind(), crate::geodesy::CrsKind::Geocentric);
        }
        let degrees = with_records(&[wkt_record("EPSG:4326")], false, |count| count);
        assert!(read_bytes(degrees).unwrap().geographic);
        for empty in ["", " \0\0", "\0"] {
            let bytes = with_records(&[wkt_record(empty)], false, |count| count);
            assert_eq!(read_bytes(bytes).unwrap().crs, None);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn no_damage_panics(at in 0..5000_usize, byte in any::<u8>(), compressed in any::<bool>()) {
            let mut bytes = sample(3, 2, compressed);
            let at = at % bytes.len();
            bytes[at] = byte;
            let _ = read_bytes(bytes);
        }
    }
}
