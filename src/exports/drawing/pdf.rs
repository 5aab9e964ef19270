//! Shapes on a page of PDF 1.4 (Adobe's PDF Reference, third edition): lines and areas as paths, words in
//! Helvetica, which every reader brings, pictures with their opacity.
//!
//! Helvetica has the letters of western Europe (WinAnsiEncoding); any other is a question mark.

use std::fmt::Write as _;
use std::io::{self, Write as _};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use image::RgbaImage;

use super::shapes::{Anchor, Colour, Shape};
use crate::fault::Fault;
use crate::files::PDF_MARK;

/// Points of PDF (1/72 inch) to a unit of the figure (a CSS pixel, 1/96 inch).
const POINTS: f64 = 0.75;

/// Heights of a line to an em, as in the SVG.
const LINE: f64 = 1.24;

/// Half the height of Helvetica's capitals, in ems (its AFM file: CapHeight 718).
const HALF_CAPITAL: f64 = 0.359;

/// Widths of Helvetica's letters from space to tilde, thousandths of an em (Adobe's AFM file).
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// A document of one page of this size; `title` is what readers show above it.
///
/// # Errors
/// Only where a picture cannot be deflated.
pub(crate) fn document(
    shapes: &[Shape],
    [width, height]: [f64; 2],
    title: &str,
) -> Result<Vec<u8>, Fault> {
    let mut page = Page::default();
    let [wide, high] = [width * POINTS, height * POINTS];
    // y down, as the shapes count it.
    page.say(format_args!("{POINTS} 0 0 -{POINTS} 0 {high} cm 1 j\n"));
    for shape in shapes {
        page.draw(shape);
    }
    page.document([wide, high], title).map_err(|error| {
        let what = format!("the page cannot be written ({error})");
        Fault::new(what, "report it: this is a defect")
    })
}

#[derive(Default)]
struct Page<'a> {
    content: String,
    pictures: Vec<&'a RgbaImage>,
    /// Opacities of areas, per mille.
    opacities: Vec<u32>,
}

impl<'a> Page<'a> {
    /// Writing to a string does not fail.
    fn say(&mut self, words: std::fmt::Arguments<'_>) {
        let _ = self.content.write_fmt(words);
    }

    fn path(&mut self, points: &[[f64; 2]]) {
        for (index, [x, y]) in points.iter().enumerate() {
            let operator = if index == 0 { 'm' } else { 'l' };
            self.say(format_args!("{x:.2} {y:.2} {operator}\n"));
        }
    }

    fn draw(&mut self, shape: &'a Shape) {
        match shape {
            Shape::Line {
                points,
                colour,
                width,
                dash,
            } => {
                let dashes = dash.pattern().iter().map(|l| format!("{:.2}", l * width));
                let dashes: Vec<String> = dashes.collect();
                let cap = u8::from(dashes.is_empty());
                let colour = colour_of(*colour);
                let dashes = dashes.join(" ");
                self.say(format_args!(
                    "{colour} RG {width:.2} w {cap} J [{dashes}] 0 d\n"
                ));
                self.path(points);
                self.say(format_args!("S\n"));
            }
            Shape::Area {
                outline,
                colour,
                opacity,
            } => {
                let opacity = (opacity.clamp(0.0, 1.0) * 1000.0).round() as u32;
                let state = match self.opacities.iter().position(|known| *known == opacity) {
                    Some(place) => place,
                    None => {
                        self.opacities.push(opacity);
                        self.opacities.len() - 1
                    }
                };
                let colour = colour_of(*colour);
                self.say(format_args!("q /G{state} gs {colour} rg\n"));
                self.path(outline);
                self.say(format_args!("f Q\n"));
            }
            Shape::Text {
                at: [x, y],
                size,
                text,
                anchor,
                upwards,
                colour,
            } => {
                let em = size / LINE;
                let letters: Vec<u8> = text.chars().map(letter).collect();
                let along = match anchor {
                    Anchor::Left => 0.0,
                    Anchor::Middle => -width_of(&letters) * em / 2.0,
                    Anchor::Right => -width_of(&letters) * em,
                };
                let down = HALF_CAPITAL * em;
                // Letters would stand on their heads where y goes down.
                let matrix = match upwards {
                    false => format!("1 0 0 -1 {:.2} {:.2}", x + along, y + down),
                    true => format!("0 -1 -1 0 {:.2} {:.2}", x + down, y - along),
                };
                let (colour, words) = (colour_of(*colour), quoted(&letters));
                self.say(format_args!(
                    "BT {colour} rg /F0 {em:.2} Tf {matrix} Tm {words} Tj ET\n"
                ));
            }
            Shape::Picture { at, size, pixels } => {
                let (index, [x, y], [width, height]) = (self.pictures.len(), at, size);
                self.pictures.push(pixels);
                let foot = y + height;
                self.say(format_args!(
                    "q {width:.2} 0 0 -{height:.2} {x:.2} {foot:.2} cm /P{index} Do Q\n"
                ));
            }
        }
    }

    fn document(&self, [wide, high]: [f64; 2], title: &str) -> io::Result<Vec<u8>> {
        let mut file = File::new();
        // Catalogue, pages, page, content, font and what is known of it come first.
        let first_state = 7;
        let first_picture = first_state + self.opacities.len();
        let states = (0..self.opacities.len()).map(|i| format!("/G{i} {} 0 R", first_state + i));
        let states: Vec<String> = states.collect();
        // Each has its opacity behind it.
        let pictures =
            (0..self.pictures.len()).map(|i| format!("/P{i} {} 0 R", first_picture + 2 * i));
        let pictures: Vec<String> = pictures.collect();
        file.object("<< /Type /Catalog /Pages 2 0 R >>");
        file.object("<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
        file.object(&format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {wide:.2} {high:.2}] /Contents 4 0 R \
             /Resources << /Font << /F0 5 0 R >> /ExtGState << {} >> /XObject << {} >> >> >>",
            states.join(" "),
            pictures.join(" ")
        ));
        file.stream("", self.content.as_bytes())?;
        file.object(
            "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        );
        // UTF-16 with its mark.
        let title: String = title.encode_utf16().map(|u| format!("{u:04X}")).collect();
        file.object(&format!("<< /Title <FEFF{title}> /Producer (fragscale) >>"));
        for opacity in &self.opacities {
            let opacity = f64::from(*opacity) / 1000.0;
            file.object(&format!("<< /Type /ExtGState /ca {opacity} >>"));
        }
        for (index, pixels) in self.pictures.iter().enumerate() {
            let (width, height) = pixels.dimensions();
            let mask = first_picture + 2 * index + 1;
            let head = |space: &str| {
                format!(
                    "/Type /XObject /Subtype /Image /Width {width} /Height {height} \
                     /ColorSpace /{space} /BitsPerComponent 8"
                )
            };
            let colours: Vec<u8> = pixels.pixels().flat_map(|p| [p[0], p[1], p[2]]).collect();
            let opacity: Vec<u8> = pixels.pixels().map(|p| p[3]).collect();
            file.stream(
                &format!("{} /SMask {mask} 0 R", head("DeviceRGB")),
                &colours,
            )?;
            file.stream(&head("DeviceGray"), &opacity)?;
        }
        Ok(file.end())
    }
}

/// Objects with their places, as the table at the end of a file lists them.
struct File {
    bytes: Vec<u8>,
    places: Vec<usize>,
}

impl File {
    fn new() -> Self {
        // Bytes beyond ASCII say that it is no text.
        let mut bytes = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n".to_vec();
        bytes.extend(PDF_MARK.as_bytes());
        Self {
            bytes,
            places: Vec::new(),
        }
    }

    fn begin(&mut self) {
        self.places.push(self.bytes.len());
        let number = self.places.len();
        self.bytes.extend(format!("{number} 0 obj\n").bytes());
    }

    fn object(&mut self, text: &str) {
        self.begin();
        self.bytes.extend(format!("{text}\nendobj\n").bytes());
    }

    fn stream(&mut self, entries: &str, data: &[u8]) -> io::Result<()> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(data)?;
        let data = encoder.finish()?;
        self.begin();
        let head = format!(
            "<< {entries} /Filter /FlateDecode /Length {} >>\nstream\n",
            data.len()
        );
        self.bytes.extend(head.bytes());
        self.bytes.extend(data);
        self.bytes.extend(b"\nendstream\nendobj\n");
        Ok(())
    }

    fn end(mut self) -> Vec<u8> {
        let table = self.bytes.len();
        let count = self.places.len() + 1;
        let mut text = format!("xref\n0 {count}\n0000000000 65535 f \n");
        for place in &self.places {
            text += &format!("{place:010} 00000 n \n");
        }
        text += &format!(
            "trailer\n<< /Size {count} /Root 1 0 R /Info 6 0 R >>\nstartxref\n{table}\n%%EOF\n"
        );
        self.bytes.extend(text.bytes());
        self.bytes
    }
}

fn colour_of(colour: Colour) -> String {
    let [red, green, blue] = colour.map(|channel| f64::from(channel) / 255.0);
    format!("{red:.3} {green:.3} {blue:.3}")
}

/// A letter in WinAnsiEncoding (PDF Reference, appendix D.1).
fn letter(c: char) -> u8 {
    match c {
        '\u{20}'..='\u{7e}' | '\u{a0}'..='\u{ff}' => u8::try_from(u32::from(c)).unwrap_or(b'?'),
        '\u{20ac}' => 0x80,
        '\u{2026}' => 0x85,
        '\u{2018}' => 0x91,
        '\u{2019}' => 0x92,
        '\u{201c}' => 0x93,
        '\u{201d}' => 0x94,
        '\u{2013}' | '\u{2212}' => 0x96,
        '\u{2014}' => 0x97,
        c if c.is_control() => b' ',
        _ => b'?',
    }
}

/// In ems.
fn width_of(letters: &[u8]) -> f64 {
    let width = |letter: &u8| {
        let place = usize::from(*letter).checked_sub(0x20);
        let known = place.and_then(|place| WIDTHS.get(place)).copied();
        // Most of the letters with accents, of digits and of signs are as wide.
        f64::from(known.unwrap_or(556)) / 1000.0
    };
    letters.iter().map(width).sum()
}

fn quoted(letters: &[u8]) -> String {
    let mut text = "(".to_owned();
    for &letter in letters {
        match letter {
            b'(' | b')' | b'\\' => {
                text.push('\\');
                text.push(char::from(letter));
            }
            0x20..=0x7e => text.push(char::from(letter)),
            _ => text += &format!("\\{letter:03o}"),
        }
    }
    text + ")"
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use flate2::read::ZlibDecoder;

    use super::*;
    use crate::drawing::Dash;

    /// The table at the end leads to every object, and the content has the operators of the PDF
    /// Reference (4.4, 4.5, 5.3) at their places.
    #[test]
    fn every_shape_is_its_operators_and_every_object_is_found() {
        let pixels = std::sync::Arc::new(RgbaImage::from_pixel(2, 1, image::Rgba([1, 2, 3, 4])));
        let shapes = [
            Shape::Line {
                points: vec![[0.0, 1.0], [2.5, 3.0]],
                colour: [255, 0, 0],
                width: 2.0,
                dash: Dash::Short,
            },
            Shape::Area {
                outline: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
                colour: [0, 255, 0],
                opacity: 0.25,
            },
            Shape::Text {
                at: [10.0, 20.0],
                size: 12.4,
                text: "A (ü) 岩".to_owned(),
                anchor: Anchor::Left,
                upwards: false,
                colour: [0; 3],
            },
            Shape::Picture {
                at: [5.0, 6.0],
                size: [20.0, 10.0],
                pixels,
            },
        ];
        let bytes = document(&shapes, [400.0, 300.0], "岩").unwrap();
        let text = String::from_utf8_lossy(&bytes).into_owned();
        assert!(text.starts_with("%PDF-1.4\n") && text.ends_with("%%EOF\n"));
        for words in [
            "/MediaBox [0 0 300.00 225.00]",
            "/Title <FEFF5CA9>",
            "/ca 0.25",
        ] {
            assert!(text.contains(words), "{words}");
        }
        let find = |bytes: &[u8], what: &[u8]| bytes.windows(what.len()).position(|w| w == what);
        let table = find(&bytes, b"xref\n0 ").unwrap();
        let entries = String::from_utf8(bytes[table..].to_vec()).unwrap();
        let places = entries.lines().filter(|line| line.ends_with(" n "));
        let places: Vec<usize> = places.map(|line| line[..10].parse().unwrap()).collect();
        assert_eq!(places.len(), 9);
        for (index, place) in places.iter().enumerate() {
            let head = format!("{} 0 obj\n", index + 1);
            assert!(bytes[*place..].starts_with(head.as_bytes()), "{index}");
        }
        let content = &bytes[places[3]..];
        let begin = find(content, b"stream\n").unwrap() + 7;
        let mut drawn = String::new();
        let mut decoder = ZlibDecoder::new(&content[begin..]);
        decoder.read_to_string(&mut drawn).unwrap();
        for line in [
            "0.75 0 0 -0.75 0 225 cm 1 j",
            "1.000 0.000 0.000 RG 2.00 w 0 J [5.00 5.00] 0 d",
            "0.00 1.00 m",
            "2.50 3.00 l",
            "q /G0 gs 0.000 1.000 0.000 rg",
            "BT 0.000 0.000 0.000 rg /F0 10.00 Tf 1 0 0 -1 10.00 23.59 Tm (A \\(\\374\\) ?) Tj ET",
            "q 20.00 0 0 -10.00 5.00 16.00 cm /P0 Do Q",
        ] {
            assert!(
                drawn.lines().any(|drawn| drawn == line),
                "{line} in {drawn}"
            );
        }
    }

    /// Adobe's AFM file: W 944, a 556, v 500, e 556.
    #[test]
    fn words_are_as_wide_as_helvetica() {
        let letters: Vec<u8> = "Wave".chars().map(letter).collect();
        assert!((width_of(&letters) - 2.556).abs() < 1e-12);
    }
}
