//! Pixels of photos: decoding, undistorting, reducing, drawing on them.
//!
//! It takes bytes and images and knows no files. Photos are 8-bit RGB in the pixel order in which
//! the file stores them, because poses and calibrations are for the stored pixels: an EXIF
//! orientation turns nothing here.

mod agreement;
mod canvas;
mod decode;
mod drape;
mod encode;
mod exif_says;
mod image_size;
mod isolines;
mod jpeg;
mod mask;
mod overlay;
mod parallax;
mod pyramid;
mod reduce;
mod resample;
mod scale_bar;
mod sharpness;
mod text;
mod tiff_photo;
mod tint;
mod undistort;
mod warp;

pub use agreement::{Agreement, Flip, Mismatch, NotComparable, brightness, for_comparing};
pub use canvas::{Canvas, Color, Halo};
pub use decode::{DecodedPhoto, PhotoFormat, decode, decode_photo};
pub use drape::{Draping, PhotoAbove};
pub use encode::encode;
pub use exif_says::{SizeInExif, size_in_exif, turned_in_exif};
pub use image_size::check_size_of;
pub use isolines::{Isoline, isolines, round_levels};
pub use mask::{LEFT_OUT, mask_of_regions, paint_regions};
pub use overlay::overlay;
pub use parallax::{Look, PairSight, Parallax, Patches, SeenAt, Sighted, SmallPhoto, seen_at};
pub use pyramid::part::Part;
pub use pyramid::{PhotoPyramid, TILE, TileKey};
pub use reduce::{reduced, reduced_size};
pub use scale_bar::{BarEdge, ScaleBar, scale_bars};
pub use sharpness::{edge_spread, full_width};
pub use text::{Anchor, Typeface, text_width};
pub use tint::{VIRIDIS_STOPS, ValueColors, value_picture, viridis};
pub use undistort::{undistorted, undistorted_labels, undistorted_part};
pub use warp::{bar_below, warped};
