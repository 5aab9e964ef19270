//! Photos: their size, what their metadata say, and which file belongs to which name.

pub mod image_names;
pub mod photo_folder;
pub mod photo_metadata;
pub mod photo_size;
pub mod photos_below;
