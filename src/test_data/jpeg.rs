//! JPEG headers with EXIF and XMP for tests: no pixels, because none are read.

#![expect(
    clippy::unwrap_used,
    reason = "a test file that cannot be made fails the test"
)]

use std::io::Cursor;

use exif::experimental::Writer;
use exif::{Field, In, Rational, Tag, Value};

/// A segment with its marker and length.
pub fn segment(marker: u8, payload: &[u8]) -> Vec<u8> {
    let length = u16::try_from(payload.len() + 2).unwrap().to_be_bytes();
    [&[0xff, marker][..], &length, payload].concat()
}

/// A JPEG's header up to the start of the scan.
pub fn jpeg(size: (u16, u16), exif: &[Field], packets: &[&str]) -> Vec<u8> {
    let mut bytes = vec![0xff, 0xd8];
    if !exif.is_empty() {
        bytes.extend(segment(
            0xe1,
            &[b"Exif\0\0", tiff(exif).as_slice()].concat(),
        ));
    }
    for packet in packets {
        let payload = format!("http://ns.adobe.com/xap/1.0/\0{packet}");
        bytes.extend(segment(0xe1, payload.as_bytes()));
    }
    let ([h1, h0], [w1, w0]) = (size.1.to_be_bytes(), size.0.to_be_bytes());
    bytes.extend(segment(0xc0, &[8, h1, h0, w1, w0, 1, 1, 0x11, 0]));
    bytes.extend(segment(0xda, &[1, 1, 0, 0, 63, 0]));
    bytes
}

/// The TIFF of an EXIF block.
pub fn tiff(fields: &[Field]) -> Vec<u8> {
    let mut writer = Writer::new();
    for field in fields {
        writer.push_field(field);
    }
    let mut bytes = Cursor::new(Vec::new());
    writer.write(&mut bytes, false).unwrap();
    bytes.into_inner()
}

fn field(tag: Tag, value: Value) -> Field {
    Field {
        tag,
        ifd_num: In::PRIMARY,
        value,
    }
}

/// A text field.
pub fn text(tag: Tag, value: &str) -> Field {
    field(tag, Value::Ascii(vec![value.as_bytes().to_vec()]))
}

/// A field of small whole numbers.
pub fn short(tag: Tag, value: u16) -> Field {
    field(tag, Value::Short(vec![value]))
}

/// A field of fractions.
pub fn rationals(tag: Tag, values: &[(u32, u32)]) -> Field {
    let rational = |&(num, denom): &(u32, u32)| Rational { num, denom };
    field(tag, Value::Rational(values.iter().map(rational).collect()))
}

/// 47 30' 0.36" north, 16 15' 0.18" west, 200.5 m above sea level: (-16.25005, 47.5001).
pub fn gps() -> Vec<Field> {
    vec![
        text(Tag::GPSLatitudeRef, "N"),
        rationals(Tag::GPSLatitude, &[(47, 1), (30, 1), (36, 100)]),
        text(Tag::GPSLongitudeRef, "W"),
        rationals(Tag::GPSLongitude, &[(16, 1), (15, 1), (18, 100)]),
        field(Tag::GPSAltitudeRef, Value::Byte(vec![0])),
        rationals(Tag::GPSAltitude, &[(2005, 10)]),
    ]
}

/// An XMP packet around descriptions, with every maker's namespace and padding. `drone` is the prefix
/// under which Autel writes DJI's.
pub fn packet(descriptions: &str) -> String {
    let padding = " ".repeat(200);
    format!(
        "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n\
         <x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n\
         <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"\n\
         xmlns:drone-dji=\"http://www.dji.com/drone-dji/1.0/\"\n\
         xmlns:drone=\"http://www.dji.com/drone-dji/1.0/\"\n\
         xmlns:Camera=\"http://pix4d.com/camera/1.0/\"\n\
         xmlns:sense=\"http://ns.sensefly.com/Camera/1.0/\"\n\
         xmlns:drone-parrot=\"http://www.parrot.com/drone-parrot/1.0/\"\n\
         xmlns:drone-skydio=\"https://www.skydio.com/drone-skydio/1.0/\"\n\
         xmlns:tiff=\"http://ns.adobe.com/tiff/1.0/\">\n\
         {descriptions}\n</rdf:RDF>\n</x:xmpmeta>\n{padding}\n<?xpacket end=\"w\"?>\0\0"
    )
}
