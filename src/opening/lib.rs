//! Files become a flight in one world: what the user names is read by `formats/`, brought into one
//! frame, and built into a [`Flight`](crate::flight::Flight).
//!
//! ```text
//! open         the flight of a flight.toml, a package's folder, or loose files
//! flight_poses the poses of a flight.toml, in whatever file they are
//! photo_files  the image file of each photo
//! photo_checks, photo_places  what files' sizes, metadata and places say against photos
//! georeferencing  a model of its own frame brought to the world by positions, control points and lengths
//! covariance   how sure poses and lenses of a reconstruction are
//! areas        outlines and places, typed or in a file
//! dropped      which of several files is what
//! meant        which flight is meant by a folder above it
//! flown        a mission against the flight that came of it
//! health       a flight's unit, coordinates, colours, ... at a glance
//! in_part      flights whose cloud is larger than the memory
//! evidence     what speaks against scales, as far as files' headers and places tell; pixels: as far as the photos show
//! info         what a file holds, for `fragscale info`
//! outlines     outlines of fragments that were saved beside a flight; of_others: those that other tools made
//! named_engine a network that the user names, to outline fragments
//! origin       from which files a flight came, and the flight.toml that says so
//! second_surface  another surface brought to the world of a flight
//! world        the coordinate system that surface and photos share
//! ```

mod areas;
pub mod covariance;
mod dropped;
mod evidence;
mod flight_poses;
mod flown;
mod georeferencing;
mod health;
mod in_part;
mod info;
mod meant;
mod named_engine;
mod open;
mod origin;
mod outlines;
mod photo_checks;
mod photo_files;
mod photo_places;
mod pixels;
mod second_surface;
mod world;

use fragscale_core::{
    camera, control, fault, files, flight, geodesy, geometry, georeference, jobs, labels, numbers,
    picture, scale, surface, units,
};
use fragscale_delineation as delineation;
use fragscale_formats as formats;
use fragscale_fragmentation as fragmentation;

pub use areas::{Areas, places};
pub use dropped::Dropped;
pub use evidence::look_up;
pub use flown::{ComparedFlight, FlightOfMission, StatedTakeOff, compare_flown};
pub use georeferencing::{
    BehindFlight, GeoreferenceRequest, Georeferenced, KnownDistance, KnownEnds, KnownKind,
    LengthResidual, PositionResidual, behind_flight, control_file, control_text, flight_text_of,
    georeference, georeference_flight, georeference_model, read_control,
};
pub use health::{Health, HealthFinding, HealthItem, Remedy, StatedOfFlight, flight_health};
pub use in_part::{Memory, half_of_the_machines, memory_in_words, memory_size};
pub use info::info;
pub use meant::meant_by;
pub use named_engine::read_named_engine;
pub use open::{
    FlightReconstruction, OnSample, OpenOptions, Opened, SurfaceSample, open_flight,
    open_flight_sampled, with_flight,
};
pub use origin::{FlightOrigin, path_from};
pub use outlines::{OutlinesOfOthers, OutlinesRead, outline_files, read_outlines, saved_outlines};

pub use photo_files::{PhotoFile, apart_from_photos};
pub use pixels::{
    Colours, ComparedPixels, PhotosTogether, Together, compare_all_pixels, compare_pixels,
    take_compared,
};
pub use second_surface::{SecondSurface, StatedWorld, second_surface, volume_base};

#[cfg(test)]
mod tests;
