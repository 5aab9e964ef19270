//! Outlines of fragments in the forms that other tools read, so that reading them back gives the same label image to
//! the pixel (`formats::masks` reads them all).
//!
//! ```text
//! coco     one JSON for all photos: pycocotools, CVAT, Roboflow
//! cvat     one XML for all photos: CVAT for images 1.1
//! labelme  a JSON for each photo
//! geojson  a GeoJSON for each photo, in pixels: segmenteverygrain, QuPath
//! tiff     a label image of 32 bits for each photo: ImageGrains, Cellpose, scikit-image
//! trace    outlines along the sides of pixels
//! boxes    the least rectangle about each fragment
//! ```
//!
//! Corners are corners of pixels, (0, 0) that of the top left one. All are of the undistorted photo.

mod boxes;
mod coco;
mod cvat;
mod geojson;
mod labelme;
#[cfg(test)]
mod tests;
mod tiff;
mod trace;

pub use coco::CocoFile;
pub use cvat::CvatFile;
pub use geojson::fragments_geojson;
pub use labelme::labelme_json;
pub use tiff::labels_tiff;
pub(crate) use trace::parts;

/// How files of each form end behind a photo's name, or are called: COCO, CVAT, LabelMe, GeoJSON, TIFF.
pub const OUTLINE_ENDINGS: [&str; 5] = [
    "fragments_coco.json",
    "fragments_cvat.xml",
    "_labelme.json",
    "_fragments.geojson",
    "_labels.tif",
];

/// What regions are called in all of them; `formats::masks` knows these names.
const FRAGMENT: &str = "fragment";
const FINES_NAME: &str = "fines";
const NOT_ROCK_NAME: &str = "not rock";

/// Who wrote them, and of which photo they are.
const DESCRIPTION: &str = "Fragments outlined by fragscale, in pixels of the undistorted photos";
