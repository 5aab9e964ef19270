//! What all files of outlines come down to: of each image its masks, of each mask what it means and its pieces.

use glam::DVec2;

use crate::text::notes::Notes;

/// The masks of an image.
#[derive(Debug, Default)]
pub(super) struct OutlinedImage {
    /// As the file names it; `None` where it does not.
    pub(super) name: Option<String>,
    /// Width and height in pixels, where they are stated.
    pub(super) size: Option<(u32, u32)>,
    pub(super) masks: Vec<Mask>,
    /// What was mended or left out while it was read.
    pub(super) notes: Notes,
}

/// A region of an image.
#[derive(Debug)]
pub(super) struct Mask {
    pub(super) meaning: Meaning,
    /// The name of its class; empty where it has none.
    pub(super) class: String,
    /// The number that the file says its fragment has, where it is one of ours.
    pub(super) number: Option<u32>,
    /// Where in the file it stands ("annotation 7").
    pub(super) place: String,
    /// Together they are the region.
    pub(super) pieces: Vec<Piece>,
}

/// What a region is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Meaning {
    Fragment,
    Fines,
    NotRock,
}

/// The names of classes that are no fragments, in small letters, with spaces between words, of one. `fines` and `not rock` are
/// what we write.
const FINES_NAMES: [&str; 11] = [
    "fine",
    "fine material",
    "fine rock",
    "sand",
    "soil",
    "mud",
    "dirt",
    "dust",
    "clay",
    "matrix",
    "silt",
];
const NOT_ROCK_NAMES: [&str; 54] = [
    "not rock",
    "no rock",
    "notrock",
    "non rock",
    "background",
    "bg",
    "sky",
    "vegetation",
    "grass",
    "tree",
    "bush",
    "plant",
    "machine",
    "machinery",
    "equipment",
    "vehicle",
    "truck",
    "car",
    "excavator",
    "loader",
    "shovel",
    "bucket",
    "drill",
    "drone",
    "person",
    "people",
    "human",
    "worker",
    "scale",
    "scale object",
    "scaleobject",
    "scale bar",
    "scalebar",
    "scale ball",
    "reference",
    "ball",
    "sphere",
    "target",
    "marker",
    "water",
    "puddle",
    "road",
    "building",
    "shade",
    "shadow",
    "ignore",
    "ignored",
    "void",
    "hole",
    "exclude",
    "excluded",
    "masked",
    "unlabeled",
    "unlabelled",
];
/// Those of fragments; other names are taken for fragments, too, and said.
const FRAGMENT_NAMES: [&str; 24] = [
    "",
    "fragment",
    "rock",
    "rock fragment",
    "stone",
    "block",
    "boulder",
    "cobble",
    "pebble",
    "gravel",
    "grain",
    "clast",
    "particle",
    "ore",
    "muck",
    "rubble",
    "ballast",
    "aggregate",
    "lump",
    "coarse",
    "object",
    "instance",
    "segment",
    "mask",
];

impl Meaning {
    /// Of a class by its name: all that is not known for something else is a fragment.
    pub(super) fn of_class(name: &str) -> Self {
        let words = in_words(name);
        if is_one_of(&FINES_NAMES, &words) {
            Self::Fines
        } else if is_one_of(&NOT_ROCK_NAMES, &words) {
            Self::NotRock
        } else {
            Self::Fragment
        }
    }
}

/// Whether a class has a name that nobody gives to fragments but perhaps its maker: "stone 12" is one.
pub(super) fn is_odd_of_fragments(class: &str) -> bool {
    let words = in_words(class);
    let name = words.trim_end_matches(|c: char| c.is_numeric()).trim_end();
    !is_one_of(&FRAGMENT_NAMES, name)
}

/// In small letters, with spaces between words.
fn in_words(name: &str) -> String {
    let words = name.split(|c: char| !c.is_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join(" ").to_lowercase()
}

/// One of several, too.
fn is_one_of(names: &[&str], name: &str) -> bool {
    let singular = name.strip_suffix('s').unwrap_or(name);
    names
        .iter()
        .any(|known| *known == name || *known == singular)
}

/// A part of a region.
#[derive(Debug)]
pub(super) enum Piece {
    /// What an odd number of rings goes about: an outline and its holes. Corners in pixels, (0, 0) at the outer corner of
    /// the top left one.
    Rings(Vec<Vec<DVec2>>),
    Runs(Runs),
}

impl Piece {
    /// An outline without holes.
    pub(super) fn ring(corners: Vec<DVec2>) -> Self {
        Self::Rings(vec![corners])
    }

    /// A rectangle, turned about its middle by an angle in degrees, clockwise as the photo is seen.
    pub(super) fn rectangle(a: DVec2, b: DVec2, degrees: f64) -> Self {
        let (middle, half) = (a.midpoint(b), (b - a) / 2.0);
        let turn = DVec2::from_angle(degrees.to_radians());
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corner = |sides: [f64; 2]| middle + turn.rotate(half * DVec2::from(sides));
        Self::ring(match degrees == 0.0 {
            true => vec![a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)],
            false => corners.map(corner).to_vec(),
        })
    }

    /// An ellipse, turned as a rectangle is: of so many corners that no pixel is off.
    pub(super) fn ellipse(middle: DVec2, half: DVec2, degrees: f64) -> Self {
        const CORNERS: u32 = 1440;
        let turn = DVec2::from_angle(degrees.to_radians());
        let corner = |at: u32| {
            let angle = f64::from(at) / f64::from(CORNERS) * std::f64::consts::TAU;
            middle + turn.rotate(half * DVec2::from_angle(angle))
        };
        Self::ring((0..CORNERS).map(corner).collect())
    }
}

/// A rectangle of pixels, told by how many are outside and how many inside, in turns.
#[derive(Debug)]
pub(super) struct Runs {
    /// Its first column and row in the image, which may lie outside.
    pub(super) left: i64,
    pub(super) top: i64,
    pub(super) width: u32,
    pub(super) height: u32,
    /// Whether pixels go column by column (COCO) and not row by row (CVAT).
    pub(super) by_columns: bool,
    /// The first count is of pixels outside. Together they are all pixels.
    pub(super) counts: Vec<u32>,
}

impl Runs {
    /// Whether the counts together are all pixels: else they are of something else, or damaged.
    pub(super) fn are_whole(&self) -> bool {
        let sum: u64 = self.counts.iter().map(|count| u64::from(*count)).sum();
        sum == u64::from(self.width) * u64::from(self.height)
    }
}
