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
        let is_picture = is_png(beginning) || is_tiff(beginning) || is_pdf(beginning);
        let is_result = is_picture || is_kmz(beginning) || is_text(beginning);
        is_result.then_some(Self::Result)
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

fn is_text(beginning: &[u8]) -> bool {
    let text = String::from_utf8_lossy(beginning);
    let mut lines = text.lines();
    let [first, second] = [(); 2].map(|()| lines.next().unwrap_or_default());
    let begins = |start: &str| text.starts_with(start);
    let has = |part: &str| text.contains(part);
    let (svg, html) = (SVG_MARK.trim_end(), HTML_MARK.trim_end());
    begins("<svg ") && has(svg)
        || begins("<!DOCTYPE html>") && has(html)
        || text.lines().nth(6).is_some_and(|line| line.starts_with(WORLD_FILE_MARK))
        || is_csv(first)
        || is_table(first)
        // The scales of a flight.
        || begins("{\"flight\":") && has(",\"world_unit\":\"")
        // Fitted functions, one or several.
        || (begins("{\"model\":\"") || begins("[{\"curve\":\"") || begins("[{\"model\":\""))
            && has("\"weighted\":")
            && has("\"standard_errors\":{")
        // A comparison.
        || begins("{\"unit\":\"") && has("\"model\":\"") && has("\"envelope_percent\":")
        // An analysis of variance.
        || begins("{\"between\":{\"df\":")
        // What is kept of a photo while others are outlined.
        || begins("{\"delineated\":\"") && has("\"files\":[")
        // What outlines of fragments are of.
        || begins("{\"outlines\":\"") && has("\"lens\":[[")
        // A season of flights, and what of one of them was read and written.
        || begins("{\"blast\":\"") && has(",\"verdicts\":")
        || begins("{\n  \"fragscale_batch\": ")
        // Times.
        || begins("{\"unit\":\"min\",\"columns\":[")
        // A plan of photos, and what was flown of it.
        || begins("{\n  \"area\": [\n    [\n")
        || begins("{\n  \"flight\": \"") && has("\n  \"photos\": [\n    {\n      \"center\": [")
        // Missions: QGroundControl's, GeoJSON's.
        || begins("{\n  \"fileType\": \"Plan\",\n  \"groundStation\": \"fragscale\",")
        || begins("{\"type\":\"FeatureCollection\",\"fragscale\":\"mission")
        // Mission Planner's, Litchi's.
        || begins("QGC WPL 110\n") && second.starts_with(WAYPOINTS_MARK)
        || begins("latitude,longitude,altitude(m),") && second.ends_with(LITCHI_MARK)
        // Outlines of fragments: COCO, LabelMe, GeoJSON in pixels.
        || begins("{\"info\":{\"description\":\"Fragments outlined by fragscale")
        || begins("{\"version\":\"5.5.0\",\"fragscale\":\"fragments")
        || begins("{\"type\":\"FeatureCollection\",\"fragscale\":\"fragments")
        // KML, and outlines of fragments for CVAT.
        || begins("<?xml ") && second == svg
}

/// The heads of our CSV files.
fn is_csv(first: &str) -> bool {
    // Scales, by photo.
    first.starts_with("photo,width_px,height_px,top_px_per_")
        // Fitted functions.
        || first == "curve,model,quantity,unit,value,standard_error,band_low,band_high"
        // A comparison.
        || first.starts_with("method,size_")
            && first.ends_with(",mean_percent_passing,standard_deviation,trials")
        // An analysis of variance, perhaps with a column in front.
        || first.ends_with(
            "source,degrees_of_freedom,sum_of_squares,mean_square,f,critical_f,p,note",
        )
        // Times.
        || first.starts_with("step,") && first.ends_with(",total_min,average_min")
        // A profile, a volume, picked points.
        || first.starts_with("distance_") && first.ends_with(",part")
        || first.starts_with("flight,base,fill_")
        || first.starts_with("point,x_") && first.contains(",y_") && first.contains(",z_")
        // A plan of photos, and what was flown of it.
        || first.starts_with("photo,x_") && first.ends_with(",troubles")
        || first.starts_with("planned,photo,x_")
        // Outlined fragments, and their size distributions.
        || first.starts_with("photo,percent_passing,size_")
        || first.starts_with("photo,fragment,column_px,row_px,pixels,cut,x_")
        || first.starts_with("method,photo,size_") && first.contains(",percent_passing,area")
        // A season of flights.
        || first.starts_with("blast,date,state,photos,") && first.ends_with(",flight,results")
        // Of the window's frames.
        || first.starts_with("start_s,logic,panels,upload,draw,commands,")
}

/// The first lines of our tables for people.
fn is_table(first: &str) -> bool {
    let has = |part: &str| first.contains(part);
    // A plan of photos, and what was flown of it.
    has(": plan of ") && has(" photos; scales in px/")
        || has(": flown less planned, lengths in ")
        // Scales.
        || has(": scales of the ") && has(" in pixels per ")
        // What was looked at.
        || first == CHECK_MARK
        || first == FAILED_MARK
        // Fitted functions.
        || has(" fitted to ") && has(" points") && has("; sizes in ")
        // A comparison.
        || has(", the reference: ") && first.ends_with(" percentage points")
        // An analysis of variance.
        || first.starts_with("source ") && has("  sum of squares  ") && has("  critical F  ")
        // Times.
        || first.starts_with("step (minutes)  ") && first.ends_with("  average")
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
