//! What a photo says of itself.

/// What a photo says about how it was taken. What is `None` is not written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PhotoMetadata {
    /// The maker of the camera; ASCII.
    pub make: Option<String>,
    /// The camera; ASCII.
    pub model: Option<String>,
    /// As EXIF writes it: "YYYY:MM:DD HH:MM:SS".
    pub date_time_original: Option<String>,
    /// Seconds; written as 1/n where it is one.
    pub exposure_time_s: Option<f64>,
    /// Focal length / aperture.
    pub f_number: Option<f64>,
    /// ISO speed.
    pub iso: Option<u16>,
    /// Millimetres.
    pub focal_length_mm: Option<f64>,
    /// Millimetres on 35 mm film.
    pub focal_length_35mm: Option<u16>,
    /// Where the camera was.
    pub gps: Option<GpsPosition>,
    /// Standard deviations of the place that RTK states: east, north, up, metres.
    pub rtk: Option<[f64; 3]>,
    /// What DJI's XMP says.
    pub dji: Option<DjiGimbal>,
}

/// A position in WGS 84.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GpsPosition {
    /// Degrees, north positive. EXIF keeps a millionth of a second of arc (0.03 mm).
    pub latitude: f64,
    /// Degrees, east positive.
    pub longitude: f64,
    /// Metres; EXIF keeps millimetres.
    pub altitude: f64,
}

/// What DJI writes about the gimbal, rounded as DJI does: angles to 0.01 degrees, altitudes to 0.001
/// metres, positions to 1e-9 degrees. The latter two come from [`PhotoMetadata::gps`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DjiGimbal {
    /// Degrees.
    pub roll: f64,
    /// Degrees, clockwise from north.
    pub yaw: f64,
    /// Degrees; -90 looks straight down.
    pub pitch: f64,
    /// Metres above the place of take-off.
    pub relative_altitude: f64,
}
