//! Files as such: which were read, what may be written over, and writing whole.
//!
//! ```text
//! overwrite     what may be written over; every file that goes out is written here
//! inputs        the files that were read, known by identity and not by name
//! recording     which files are opened on the way
//! input         opening files: whole bytes, text, errors with the file's name
//! last_segment  what a file is called, by a path that a text names, with its ending and without
//! same_name     whether two names of files are one, whatever their case and accents
//! marks         what tells a file that fragscale wrote
//! atomic        files and folders that are there whole or not at all
//! ```
//!
//! The one place of the lower floors that knows paths.

mod atomic;
mod checksum;
mod input;
mod inputs;
mod last_segment;
mod lock;
mod marks;
mod overwrite;
mod recording;
pub mod same_name;

pub use atomic::write_whole;
pub use atomic::{is_unfinished, make_folder_whole, remove_unfinished};
pub use checksum::{of_bytes as sha256_of_bytes, of_file as sha256_of_file};
pub use input::{
    FileError, cannot_be, open_file, read_bytes, read_small, read_text, text_from_bytes,
    unreadable_folder,
};
pub use inputs::{Inputs, is_same_file};
pub use last_segment::{last_segment, stem};
pub use lock::lock;
pub use marks::{
    CHECK_MARK, FAILED_MARK, FLIGHT_MARK, HTML_MARK, KMZ_MARK, Kind, LITCHI_MARK, PDF_MARK,
    SVG_MARK, WAYPOINTS_MARK, WORLD_FILE_MARK, is_own_result, marked_png,
};
pub use overwrite::{
    Standing, has_folder, make_folder, may_write, result_in_words, standing, write,
};
pub use recording::{Recording, note_kept, note_opened};
