//! LAZ: ASPRS "LAS Specification 1.4 - R15", compressed by LASzip, as written by the las crate.
//!
//! - Point format 7 (colour) where the cloud has colours, 6 where it has none; one return a point,
//!   class 1 (unclassified), GPS time 0.
//! - Coordinates in steps of 0.001 m from a whole offset below the smallest one.
//! - Colours are 16 bits wide, as the specification wants them: value * 257.
//! - The coordinate system is WKT (OGC 01-009) of WGS 84 / UTM, in the record LASF_Projection 2112,
//!   with its closing zero.
//! - No date (0 in the header): the same cloud is the same bytes on every day.
//!
//! LAS has no faces: those of the cloud are left out.

use std::io::Cursor;

use glam::DVec3;
use las::point::{Classification, Format};
use las::{Builder, Color, Point, Transform, Vector, Writer};

use crate::geometry::Bounds;
use crate::surface::Cloud;

/// Metres between neighbouring values of a coordinate.
const SCALE: f64 = 0.001;

/// The points and colours of a cloud in metres as a LAZ file in WGS 84 / UTM, `epsg` 32601 to 32660
/// (north) or 32701 to 32760 (south). Coordinates are rounded to a millimetre. `source` is where points come
/// from ("simulated"), at most 32 letters of ASCII.
///
/// # Errors
/// Where the EPSG code is another one, there is no point, a coordinate is not finite, the cloud is
/// wider than the 2147 km that fit 32 bits, or there is not one colour a point (or none at all).
pub fn laz(cloud: &Cloud, epsg: u16, source: &str) -> Result<Vec<u8>, String> {
    let wkt = utm_wkt(epsg)?;
    let (points, colors) = (&cloud.points, &cloud.colors);
    let colored = !colors.is_empty();
    if colored && colors.len() != points.len() {
        return Err(format!(
            "{} colours for {} points",
            colors.len(),
            points.len()
        ));
    }
    if let Some(point) = points.iter().find(|point| !point.is_finite()) {
        return Err(format!("the point {point} is not finite"));
    }
    let bounds = Bounds::of(points).ok_or("a LAZ file of no points says nothing")?;
    let offset = bounds.min.floor();
    // Looked at here: the las crate's writer panics when it is dropped after such a point.
    let width = (bounds.max - offset).max_element();
    if width / SCALE > f64::from(i32::MAX) {
        return Err(format!(
            "the cloud is {width} m wide, too much for LAS in millimetres"
        ));
    }

    let failed = |error: las::Error| format!("the LAZ file cannot be written ({error})");
    let mut builder = Builder::from((1, 4));
    builder.date = None;
    builder.generating_software = "fragscale".to_owned();
    builder.system_identifier = source.to_owned();
    builder.point_format = Format::new(if colored { 7 } else { 6 }).map_err(failed)?;
    builder.point_format.is_compressed = true;
    let DVec3 { x, y, z } = offset;
    let axis = |offset| Transform {
        scale: SCALE,
        offset,
    };
    builder.transforms = Vector {
        x: axis(x),
        y: axis(y),
        z: axis(z),
    };
    let mut header = builder.into_header().map_err(failed)?;
    let mut text = wkt.into_bytes();
    text.push(0);
    header.set_wkt_crs(text).map_err(failed)?;

    let mut writer = Writer::new(Cursor::new(Vec::new()), header).map_err(failed)?;
    let mut colors = colors.iter();
    for point in points {
        let color = colors.next().map(|color| {
            let [red, green, blue] = color.map(|channel| u16::from(channel) * 257);
            Color::new(red, green, blue)
        });
        writer
            .write_point(Point {
                x: point.x,
                y: point.y,
                z: point.z,
                return_number: 1,
                number_of_returns: 1,
                classification: Classification::Unclassified,
                gps_time: Some(0.0),
                color,
                ..Point::default()
            })
            .map_err(failed)?;
    }
    Ok(writer.into_inner().map_err(failed)?.into_inner())
}

/// WGS 84 / UTM as WKT (OGC 01-009, the form that LAS 1.4 asks for), with EPSG's codes.
fn utm_wkt(epsg: u16) -> Result<String, String> {
    let (zone, hemisphere, false_northing) = match epsg {
        32_601..=32_660 => (epsg - 32_600, 'N', 0),
        32_701..=32_760 => (epsg - 32_700, 'S', 10_000_000),
        _ => {
            return Err(format!(
                "EPSG:{epsg} is no UTM zone of WGS 84 (32601 to 32660, 32701 to 32760)"
            ));
        }
    };
    let meridian = i32::from(zone) * 6 - 183;
    Ok(format!(
        r#"PROJCS["WGS 84 / UTM zone {zone}{hemisphere}",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",{meridian}],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",{false_northing}],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","{epsg}"]]"#
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jobs::Progress;
    use fragscale_formats::read_cloud;
    use fragscale_test_data::written;

    fn cloud() -> Cloud {
        let points = (0..70_000).map(|i| {
            let i = f64::from(i);
            DVec3::new(
                500_000.123_4 + i * 0.037,
                5_000_000.9 - i * 0.011,
                -1.5 + (i * 0.1).sin(),
            )
        });
        Cloud {
            points: points.collect(),
            colors: (0..70_000_u32)
                .map(|i| i.to_le_bytes()[..3].try_into().unwrap())
                .collect(),
            triangles: vec![[0, 1, 2]],
        }
    }

    /// More than one chunk of 50 000 points; half a step is the rounding that the header states.
    #[test]
    fn reads_back_to_half_a_millimetre() {
        let cloud = cloud();
        let bytes = laz(&cloud, 32_612, "test").unwrap();
        assert_eq!(laz(&cloud, 32_612, "test").unwrap(), bytes);
        // Version 1.4, format 7 compressed (bit 7), no date: LAS 1.4 R15, table 3.
        assert_eq!(bytes[24..26], [1, 4]);
        assert_eq!(bytes[90..94], [0; 4]);
        assert_eq!(bytes[104], 7 | 128);
        let (_folder, path) = written("a.laz", bytes);
        let file = read_cloud(&path, &Progress::default()).unwrap();
        assert_eq!(file.cloud.points.len(), 70_000);
        for (read, known) in file.cloud.points.iter().zip(&cloud.points) {
            assert!((*read - *known).abs().max_element() <= 0.000_500_01);
        }
        assert_eq!(file.cloud.colors, cloud.colors);
        assert!(file.cloud.triangles.is_empty());
        assert_eq!((file.geographic, file.warnings.len()), (false, 0));
        let crs = file.crs.unwrap();
        assert!(crs.starts_with(r#"PROJCS["WGS 84 / UTM zone 12N""#));
        assert!(crs.contains(r#"PARAMETER["central_meridian",-111]"#));
        assert!(crs.ends_with(r#"AUTHORITY["EPSG","32612"]]"#));
    }

    #[test]
    fn without_colours() {
        let mut cloud = cloud();
        cloud.colors.clear();
        let (_folder, path) = written("a.laz", laz(&cloud, 32_733, "test").unwrap());
        let file = read_cloud(&path, &Progress::default()).unwrap();
        assert!(file.cloud.colors.is_empty());
    }

    #[test]
    fn zones() {
        // EPSG's registry: 32601 has -177, 32660 177; 32719 is 19S, false northing 10 000 km.
        assert!(utm_wkt(32_601).unwrap().contains(r#"meridian",-177]"#));
        assert!(utm_wkt(32_660).unwrap().contains(r#"meridian",177]"#));
        let south = utm_wkt(32_719).unwrap();
        assert!(south.starts_with(r#"PROJCS["WGS 84 / UTM zone 19S""#));
        assert!(south.contains(r#"meridian",-69]"#) && south.contains(r#"northing",10000000]"#));
        for wkt in [utm_wkt(32_601).unwrap(), south] {
            assert_eq!(wkt.matches('[').count(), wkt.matches(']').count());
        }
        for other in [0, 4326, 32_600, 32_661, 32_700, 32_761] {
            assert!(utm_wkt(other).is_err(), "{other}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let refuse = |cloud: &Cloud| laz(cloud, 32_612, "test").unwrap_err();
        assert!(refuse(&Cloud::default()).contains("no points"));
        let mut short = cloud();
        short.colors.pop();
        assert!(refuse(&short).contains("69999 colours"));
        let mut nan = cloud();
        nan.points[7].z = f64::NAN;
        assert!(refuse(&nan).contains("not finite"));
        let mut wide = cloud();
        wide.points[7].x = 1e7;
        assert!(refuse(&wide).contains("too much for LAS"));
    }
}
