//! What image files are called: one list, because lists that disagree find a photo here and miss it
//! there.

/// Who writes files of an ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Ending {
    /// Cameras, with EXIF and XMP that are read. TIFF files are elevation models as often, and their
    /// metadata are not looked into.
    Photo,
    /// Programs too; pixels and sizes are read.
    Image,
    /// Cameras, raw: packages name them, and nothing of them is read.
    Raw,
    /// Telephones: nothing of them is read, and no package names them.
    Unread,
}

/// In the order in which they are tried behind a photo's name.
const ENDINGS: [(&str, Ending); 8] = [
    ("jpg", Ending::Photo),
    ("jpeg", Ending::Photo),
    ("tif", Ending::Image),
    ("tiff", Ending::Image),
    ("png", Ending::Photo),
    ("dng", Ending::Raw),
    ("heic", Ending::Unread),
    ("heif", Ending::Unread),
];

/// The endings of files that can be read as images.
pub(crate) fn readable() -> impl Iterator<Item = &'static str> {
    let readable = ENDINGS.iter().filter(|(_, of)| *of <= Ending::Image);
    readable.map(|(ending, _)| *ending)
}

/// Whether an ending, without its dot and in any case, is one of these or of those before them.
pub(crate) fn is_ending(ending: &str, most: Ending) -> bool {
    let mut known = ENDINGS.iter();
    known.any(|(known, of)| *of <= most && ending.eq_ignore_ascii_case(known))
}

/// Whether a file is called as an image is that can be read.
pub fn is_image(name: &str) -> bool {
    is_called(name, Ending::Image)
}

/// Whether a name has one of these endings or of those before them.
pub(crate) fn is_called(name: &str, most: Ending) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    is_ending(ending, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_for_decides() {
        for (name, photo, image, raw) in [
            ("DJI_0025.JPG", true, true, true),
            ("a.b.png", true, true, true),
            ("DJI_0025.JPG.tif", false, true, true),
            ("x.DNG", false, false, true),
            ("jpg", false, false, false),
            ("a.txt", false, false, false),
        ] {
            let told = [Ending::Photo, Ending::Image, Ending::Raw].map(|of| is_called(name, of));
            assert_eq!(told, [photo, image, raw], "{name}");
        }
    }
}
