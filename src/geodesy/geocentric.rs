//! Earth-centred, Earth-fixed coordinates (ECEF, EPSG:4978): metres, z through the north pole, x
//! through Greenwich.

use glam::{DMat3, DVec3};

use super::Geographic;

/// WGS 84: the semi-major axis in metres.
const A: f64 = 6_378_137.0;
/// WGS 84: the flattening.
const F: f64 = 1.0 / 298.257_223_563;
/// The first eccentricity squared.
const E2: f64 = F * (2.0 - F);

/// From a place to ECEF (EPSG guidance note 7-2, method 9602).
pub fn ecef_from_geographic(place: Geographic) -> DVec3 {
    let (sin_lat, cos_lat) = place.latitude.to_radians().sin_cos();
    let (sin_lon, cos_lon) = place.longitude.to_radians().sin_cos();
    let normal = A / (1.0 - E2 * sin_lat * sin_lat).sqrt();
    DVec3::new(
        (normal + place.height) * cos_lat * cos_lon,
        (normal + place.height) * cos_lat * sin_lon,
        (normal * (1.0 - E2) + place.height) * sin_lat,
    )
}

/// From ECEF to a place, by fixed-point iteration on the latitude: exact to a nanometre between
/// 10 km under and 10 000 km above the ellipsoid. `None` near the centre of the Earth, where no
/// survey is: such numbers are no ECEF coordinates.
pub fn geographic_from_ecef(point: DVec3) -> Option<Geographic> {
    // A survey's x, y, z are some 6 371 km from the centre; a local frame's are not.
    if !point.is_finite() || point.length() < 6.0e6 {
        return None;
    }
    let p = point.truncate().length();
    let longitude = point.y.atan2(point.x);
    let mut latitude = point.z.atan2(p * (1.0 - E2));
    for _ in 0..20 {
        let sin = latitude.sin();
        let normal = A / (1.0 - E2 * sin * sin).sqrt();
        let next = (point.z + E2 * normal * sin).atan2(p);
        let step = (next - latitude).abs();
        latitude = next;
        if step < 1e-16 {
            break;
        }
    }
    let (sin, cos) = latitude.sin_cos();
    // Holds at the poles as well, where p / cos does not.
    let height = p * cos + point.z * sin - A * (1.0 - E2 * sin * sin).sqrt();
    Some(Geographic {
        longitude: longitude.to_degrees(),
        latitude: latitude.to_degrees(),
        height,
    })
}

/// East, north and up at a place, as columns, in ECEF axes.
pub fn enu_axes(place: Geographic) -> DMat3 {
    let (sin_lat, cos_lat) = place.latitude.to_radians().sin_cos();
    let (sin_lon, cos_lon) = place.longitude.to_radians().sin_cos();
    DMat3::from_cols(
        DVec3::new(-sin_lon, cos_lon, 0.0),
        DVec3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat),
        DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worked_example_of_epsg() {
        // EPSG guidance note 7-2, 4.1.1: 53 48 33.820 N, 2 07 46.380 E, 73.0 m.
        let place = Geographic {
            longitude: 2.0 + 7.0 / 60.0 + 46.38 / 3600.0,
            latitude: 53.0 + 48.0 / 60.0 + 33.82 / 3600.0,
            height: 73.0,
        };
        let ecef = ecef_from_geographic(place);
        let expected = DVec3::new(3_771_793.968, 140_253.342, 5_124_304.349);
        assert!((ecef - expected).length() < 2e-3, "{ecef}");
    }

    #[test]
    fn there_and_back() {
        for latitude in [-90.0, -45.5, 0.0, 1e-9, 35.7, 89.999_999, 90.0] {
            for longitude in [-179.9, 0.0, 139.5] {
                for height in [-500.0, 0.0, 4_000.0] {
                    let place = Geographic {
                        longitude,
                        latitude,
                        height,
                    };
                    let ecef = ecef_from_geographic(place);
                    let back = geographic_from_ecef(ecef).unwrap();
                    assert!(
                        (ecef_from_geographic(back) - ecef).length() < 1e-8,
                        "{place:?}"
                    );
                    assert!((back.height - height).abs() < 1e-8, "{place:?} {back:?}");
                }
            }
        }
        assert_eq!(geographic_from_ecef(DVec3::new(1.0, 2.0, 3.0)), None);
    }

    #[test]
    fn axes_are_east_north_up() {
        let at = enu_axes(Geographic {
            longitude: 90.0,
            latitude: 0.0,
            height: 0.0,
        });
        assert!((at.x_axis - DVec3::NEG_X).length() < 1e-15);
        assert!((at.y_axis - DVec3::Z).length() < 1e-15);
        assert!((at.z_axis - DVec3::Y).length() < 1e-15);
    }
}
