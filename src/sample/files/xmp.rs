//! DJI's XMP (ISO 16684-1; the fields from DJI's "Media File Metadata White Paper", part 2): one
//! `rdf:Description` with the values as attributes in the namespace drone-dji, each with its sign.

use super::photo_metadata::{DjiGimbal, GpsPosition};

/// The packet of a photo. Position and absolute altitude are there where the position is known.
///
/// # Errors
/// Where a number is not finite.
pub(super) fn dji_packet(
    gimbal: &DjiGimbal,
    gps: Option<&GpsPosition>,
    rtk: Option<[f64; 3]>,
) -> Result<String, String> {
    let mut values = Vec::new();
    if let Some(gps) = gps {
        values.push(("GpsLatitude", gps.latitude, 9));
        values.push(("GpsLongitude", gps.longitude, 9));
        values.push(("AbsoluteAltitude", gps.altitude, 3));
    }
    if let Some([east, north, up]) = rtk {
        // 50: fixed.
        values.push(("RtkFlag", 50.0, 0));
        values.push(("RtkStdLon", east, 5));
        values.push(("RtkStdLat", north, 5));
        values.push(("RtkStdHgt", up, 5));
    }
    values.push(("RelativeAltitude", gimbal.relative_altitude, 3));
    values.push(("GimbalRollDegree", gimbal.roll, 2));
    values.push(("GimbalYawDegree", gimbal.yaw, 2));
    values.push(("GimbalPitchDegree", gimbal.pitch, 2));
    let mut attributes = String::new();
    for (name, value, decimals) in values {
        if !value.is_finite() {
            return Err(format!("{name} is {value}"));
        }
        let mut text = format!("{value:+.decimals$}");
        // What rounds to nothing has no side.
        if !text.contains(|c: char| ('1'..='9').contains(&c)) {
            text = text.replace('-', "+");
        }
        attributes += &format!("\n   drone-dji:{name}=\"{text}\"");
    }
    Ok(format!(
        "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n\
         <x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n \
         <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n  \
         <rdf:Description rdf:about=\"DJI Meta Data\"\n   \
         xmlns:drone-dji=\"http://www.dji.com/drone-dji/1.0/\"{attributes}/>\n \
         </rdf:RDF>\n</x:xmpmeta>\n<?xpacket end=\"w\"?>"
    ))
}
