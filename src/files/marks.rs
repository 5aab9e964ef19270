//! What tells a file that fragscale wrote: how its text begins, or a mark where its format has a place
//! for one that changes nothing else. The tables that other programs read have no such place; they are
//! known by their head.

/// The first line of a flight file that fragscale made.
pub const FLIGHT_MARK: &str = "# Written by fragscale.\n";

/// Inside a figure, after the first tag.
pub const SVG_MARK: &str = "<!-- Written by fragscale. -->\n";

/// A line of a PDF, below the one that says its version and the one that says that it is no text.
pub const PDF_MARK: &str = "% Written by fragscale.\n";

/// In the head of a page.
pub const HTML_MARK: &str = "<meta name=\"generator\" content=\"fragscale\"/>\n";

/// Who wrote DJI's template of a mission, as its author says: the first file in its zip, not deflated.
pub const KMZ_MARK: &str = "fragscale";

/// The first line of what `fragscale check` says.
pub const CHECK_MARK: &str = "colours of photo and surface (r is 1 where they match)";

/// How the line begins that stands below the six of a world file.
pub const WORLD_FILE_MARK: &str = "fragscale: ";

/// How the second line of a mission for Mission Planner begins: of home nothing but its place counts, so that its last
/// parameter may be written as no other program does. The format has no comments that all ground stations skip.
pub const WAYPOINTS_MARK: &str = "0\t1\t0\t16\t0\t0\t0\t-0\t";

/// How a line of a mission for Litchi ends, likewise: no point of interest is at 0, 0 (others' readers take a minus sign there,
/// and in none of the columns behind).
pub const LITCHI_MARK: &str = ",0,-0,0,0,-1,-1";

/// A `tEXt` chunk of PNG (its specification, section 11.3.3.2): length, type, keyword and text, CRC.
const PNG_MARK: &[u8] = b"\0\0\0\x12tEXtSoftware\0fragscale\xf4\x7d\x57\xef";

/// The first line of the word that a flight of a season failed.
pub const FAILED_MARK: &str = "This flight failed the last time that fragscale batch looked at it:";

/// Where a TIFF's own data begin: behind its header, which says the byte order and where the first
/// directory is. The texts of that directory are put there, the program's name first.
const TIFF_HEAD: usize = 8;

/// Where the first chunk of a PNG ends: the signature, and IHDR, which always comes first.
const PNG_HEAD: usize = 8 + 25;

/// How much of a file is looked at.
pub(super) const LOOKED_AT: u64 = 4096;

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A flight file or a list of control points: what a person has set is in it, so no result takes its place.
    Flight,
    /// Anything that can be made again from what was read: tables, figures, pictures, reports.
    Result,
}

impl Kind {
    /// Of a file that fragscale wrote, told by its beginning; `None` of any other.
    pub(super) fn of(beginning: &[u8]) -> Option<Self> {
        // The first line of a list of control points names its coordinate system.
        let mut lines = beginning.split(|byte| *byte == b'\n').take(2);
        let mark = FLIGHT_MARK.trim_end().as_bytes();
        if lines.any(|line| line.starts_with(mark)) {
            return Some(Self::Flight);
        }
        result_in_words(beginning).map(|_| Self::Result)
    }
}

/// A PNG with a mark that says who wrote it; anything else as it is.
pub fn marked_png(mut bytes: Vec<u8>) -> Vec<u8> {
    if bytes.starts_with(b"\x89PNG") && bytes.len() > PNG_HEAD {
        bytes.splice(PNG_HEAD..PNG_HEAD, PNG_MARK.iter().copied());
    }
    bytes
}

/// Whether fragscale wrote a file as a result, told by its first bytes.
pub fn is_own_result(bytes: &[u8]) -> bool {
    let beginning = bytes.get(..LOOKED_AT as usize).unwrap_or(bytes);
    Kind::of(beginning) == Some(Kind::Result)
}

/// What of fragscale's results a file is, told by its beginning; `None` of any other file.
pub(super) fn result_in_words(beginning: &[u8]) -> Option<&'static str> {
    let of_bytes = [
        (is_png(beginning) || is_tiff(beginning), "a picture"),
        (is_pdf(beginning), "a page (PDF)"),
        (is_kmz(beginning), "a mission"),
    ];
    first_that_is(of_bytes).or_else(|| text_in_words(beginning))
}

/// The words of the first that it is.
fn first_that_is(all: impl IntoIterator<Item = (bool, &'static str)>) -> Option<&'static str> {
    let mut all = all.into_iter();
    all.find_map(|(is_it, words)| is_it.then_some(words))
}

fn is_png(beginning: &[u8]) -> bool {
    beginning.starts_with(b"\x89PNG")
        && (beginning.get(PNG_HEAD..)).is_some_and(|rest| rest.starts_with(PNG_MARK))
}

fn is_tiff(beginning: &[u8]) -> bool {
    (beginning.starts_with(b"II*\0") || beginning.starts_with(b"MM\0*"))
        && (beginning.get(TIFF_HEAD..)).is_some_and(|rest| rest.starts_with(b"fragscale "))
}

fn is_pdf(beginning: &[u8]) -> bool {
    let mut lines = beginning.split_inclusive(|byte| *byte == b'\n');
    beginning.starts_with(b"%PDF-") && lines.nth(2) == Some(PDF_MARK.as_bytes())
}

fn is_kmz(beginning: &[u8]) -> bool {
    let author = format!("<wpml:author>{KMZ_MARK}</wpml:author>");
    let mut windows = beginning.windows(author.len());
    beginning.starts_with(b"PK\x03\x04") && windows.any(|window| window == author.as_bytes())
}

fn text_in_words(beginning: &[u8]) -> Option<&'static str> {
    let text = String::from_utf8_lossy(beginning);
    let mut lines = text.lines();
    let [first, second] = [(); 2].map(|()| lines.next().unwrap_or_default());
    let begins = |start: &str| text.starts_with(start);
    let has = |part: &str| text.contains(part);
    let (svg, html) = (SVG_MARK.trim_end(), HTML_MARK.trim_end());
    let seventh = text.lines().nth(6).unwrap_or_default();
    let is_fit = begins("{\"model\":\"") || begins("[{\"curve\":\"") || begins("[{\"model\":\"");
    // Mission Planner's, Litchi's.
    let is_mission = begins("QGC WPL 110\n") && second.starts_with(WAYPOINTS_MARK)
        || begins("latitude,longitude,altitude(m),") && second.ends_with(LITCHI_MARK)
        // QGroundControl's, GeoJSON's.
        || begins("{\n  \"fileType\": \"Plan\",\n  \"groundStation\": \"fragscale\",")
        || begins("{\"type\":\"FeatureCollection\",\"fragscale\":\"mission");
    // COCO, LabelMe, GeoJSON in pixels.
    let are_outlines = begins("{\"info\":{\"description\":\"Fragments outlined by fragscale")
        || begins("{\"version\":\"5.5.0\",\"fragscale\":\"fragments")
        || begins("{\"type\":\"FeatureCollection\",\"fragscale\":\"fragments");
    let found = first_that_is([
        (begins("<svg ") && has(svg), "a figure"),
        (begins("<!DOCTYPE html>") && has(html), "a page"),
        (seventh.starts_with(WORLD_FILE_MARK), "a world file"),
    ]);
    let found = found.or_else(|| csv_in_words(first));
    let found = found.or_else(|| table_in_words(first));
    found.or_else(|| {
        first_that_is([
            (
                begins("{\"flight\":") && has(",\"world_unit\":\""),
                "scales",
            ),
            // One or several.
            (
                is_fit && has("\"weighted\":") && has("\"standard_errors\":{"),
                "fitted functions",
            ),
            (
                begins("{\"unit\":\"") && has("\"model\":\"") && has("\"envelope_percent\":"),
                "a comparison of size distributions",
            ),
            (begins("{\"between\":{\"df\":"), "an analysis of variance"),
            (
                begins("{\"delineated\":\"") && has("\"files\":["),
                "what is kept of a photo while others are outlined",
            ),
            (
                begins("{\"outlines\":\"") && has("\"lens\":[["),
                "what outlines of fragments are of",
            ),
            (
                begins("{\"blast\":\"") && has(",\"verdicts\":"),
                "a season's lines",
            ),
            // What of one flight was read and written.
            (
                begins("{\n  \"fragscale_batch\": "),
                "the record of a season's flight",
            ),
            (
                begins("{\"unit\":\"min\",\"columns\":["),
                "a table of times",
            ),
            (begins("{\n  \"area\": [\n    [\n"), "a plan of photos"),
            (
                begins("{\n  \"flight\": \"")
                    && has("\n  \"photos\": [\n    {\n      \"center\": ["),
                "a comparison of what was planned and flown",
            ),
            (is_mission, "a mission"),
            (are_outlines, "outlines of fragments"),
            // KML, and outlines of fragments for CVAT.
            (
                begins("<?xml ") && second == svg,
                "places or outlines as XML",
            ),
        ])
    })
}

/// The heads of our CSV files.
fn csv_in_words(first: &str) -> Option<&'static str> {
    let begins = |start: &str| first.starts_with(start);
    let ends = |end: &str| first.ends_with(end);
    let has = |part: &str| first.contains(part);
    first_that_is([
        // By photo.
        (
            begins("photo,width_px,height_px,top_px_per_"),
            "a table of scales",
        ),
        (
            first == "curve,model,quantity,unit,value,standard_error,band_low,band_high",
            "a table of fitted functions",
        ),
        (
            begins("method,size_") && ends(",mean_percent_passing,standard_deviation,trials"),
            "a comparison of size distributions",
        ),
        // Perhaps with a column in front.
        (
            ends("source,degrees_of_freedom,sum_of_squares,mean_square,f,critical_f,p,note"),
            "an analysis of variance",
        ),
        (
            begins("step,") && ends(",total_min,average_min"),
            "a table of times",
        ),
        (begins("distance_") && ends(",part"), "a profile"),
        (begins("flight,base,fill_"), "a volume"),
        (
            begins("point,x_") && has(",y_") && has(",z_"),
            "a table of picked points",
        ),
        (begins("photo,x_") && ends(",troubles"), "a plan of photos"),
        (
            begins("planned,photo,x_"),
            "a comparison of what was planned and flown",
        ),
        (
            begins("photo,percent_passing,size_"),
            "a table of size distributions",
        ),
        (
            begins("photo,fragment,column_px,row_px,pixels,cut,x_"),
            "a table of fragments",
        ),
        (
            begins("method,photo,size_") && has(",percent_passing,area"),
            "a table of size distributions",
        ),
        (
            begins("blast,date,state,photos,") && ends(",flight,results"),
            "the table of a season",
        ),
        // Of the window's.
        (
            begins("start_s,logic,panels,upload,draw,commands,"),
            "a table of frames",
        ),
    ])
}

/// The first lines of our tables for people.
fn table_in_words(first: &str) -> Option<&'static str> {
    let has = |part: &str| first.contains(part);
    let begins = |start: &str| first.starts_with(start);
    first_that_is([
        (
            has(": plan of ") && has(" photos; scales in px/"),
            "a plan of photos",
        ),
        (
            has(": flown less planned, lengths in "),
            "a comparison of what was planned and flown",
        ),
        (
            has(": scales of the ") && has(" in pixels per "),
            "a table of scales",
        ),
        (first == CHECK_MARK, "what was looked at in a flight"),
        (
            first == FAILED_MARK,
            "the word that a flight of a season failed",
        ),
        (
            has(" fitted to ") && has(" points") && has("; sizes in "),
            "a table of fitted functions",
        ),
        (
            has(", the reference: ") && first.ends_with(" percentage points"),
            "a comparison of size distributions",
        ),
        (
            begins("source ") && has("  sum of squares  ") && has("  critical F  "),
            "an analysis of variance",
        ),
        (
            begins("step (minutes)  ") && first.ends_with("  average"),
            "a table of times",
        ),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_leaves_a_png_whole() {
        let image = image::RgbImage::from_pixel(3, 2, image::Rgb([1, 2, 3]));
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        let plain = bytes.into_inner();
        assert_eq!(Kind::of(&plain), None);
        let marked = marked_png(plain.clone());
        assert_eq!(Kind::of(&marked), Some(Kind::Result));
        assert_eq!(image::load_from_memory(&marked).unwrap().to_rgb8(), image);
        assert_eq!(
            marked_png(b"\xff\xd8 a photo".to_vec()),
            b"\xff\xd8 a photo"
        );
        assert_eq!(marked_png(b"\x89PNG".to_vec()), b"\x89PNG");
    }

    #[test]
    fn a_result_is_told_in_words() {
        let of = |text: &str| result_in_words(text.as_bytes());
        let scales = "photo,width_px,height_px,top_px_per_cm,bottom_px_per_cm\n";
        assert_eq!(of(scales), Some("a table of scales"));
        let plan = "photo,x_m,y_m,z_m,troubles\n";
        assert_eq!(of(plan), Some("a plan of photos"));
        let page = format!("<!DOCTYPE html>\n<html>\n<head>\n{HTML_MARK}");
        assert_eq!(of(&page), Some("a page"));
        assert_eq!(
            of("{\"between\":{\"df\":2}}"),
            Some("an analysis of variance")
        );
        assert_eq!(of("photo,x,y,z\n"), None);
    }

    /// What people have beside a flight is none of ours.
    #[test]
    fn files_of_others_are_not_taken_for_ours() {
        for text in [
            "",
            "\n",
            "format = 1\nname = \"a\"\n",
            "photo,x,y,z,omega,phi,kappa\n",
            "photo,width_px,height_px\n",
            "method,size_mm,passing\n",
            "step,trial 1,trial 2\n",
            "source,degrees\n",
            "{\"flight\":\"a\"}",
            "{\"model\":\"pinhole\",\"width\":1}",
            "{\"unit\":\"m\"}",
            "[{\"cameras\": {}}]",
            "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>",
            "<!DOCTYPE html>\n<html><head></head></html>",
            "%PDF-1.7\n%\u{e2}\n1 0 obj\n",
            "NVM_V3\n",
            "ply\nformat ascii 1.0\n",
        ] {
            assert_eq!(Kind::of(text.as_bytes()), None, "{text}");
        }
        assert_eq!(Kind::of(b"\xff\xd8\xff\xe1"), None);
        assert_eq!(
            Kind::of(format!("{FLIGHT_MARK}format = 1\n").as_bytes()),
            Some(Kind::Flight)
        );
    }
}
