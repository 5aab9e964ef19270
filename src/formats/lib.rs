//! Files that others wrote: bytes become the core's types plus a list of warnings. One file a
//! format; its header comment is the specification it was written from.
//!
//! ```text
//! detect      what kind a file or folder is
//! candidates  the reconstructions that lie in a folder
//! meant       which of them a path may stand for
//! read        which reader takes it
//! clouds  cameras  packages  poses  photos  tables      the readers
//! missions    of drones, each told by what is in it
//! masks       fragments that other tools outlined, as label images
//! areas       polygons on the Earth, as maps keep them
//! text        numbers, lines, JSON and XML with their places
//! ```
//!
//! A reader knows no path: it returns a [`Fault`](crate::fault::Fault), and what calls it puts the
//! file's name in front.

pub mod areas;
pub mod cameras;
mod candidates;
pub mod clouds;
mod detect;
pub mod masks;
mod meant;
pub mod missions;
pub mod packages;
pub mod photos;
pub mod poses;
mod read;
pub mod tables;
pub mod text;

use fragscale_core::{
    camera, control, fault, files, flight, geodesy, geometry, jobs, labels, raster, scale, surface,
    units,
};
use fragscale_fragmentation as fragmentation;

pub use areas::{MapAreas, areas, holds_areas, read_areas, read_rings};
pub use candidates::Candidate;
pub use clouds::{CloudFile, CloudPiece, CloudPieces};
pub use detect::{CloudFormat, FAILED, Kind, MODEL, UNFINISHED, detect};
pub use files::{FileError, open_file, read_bytes, read_text, text_from_bytes};
pub use masks::{MaskFile, Masks, OutlinedPhoto, read_masks};
pub use meant::{candidates, is_of_photos};
pub use missions::{MissionFile, read_mission};
pub use packages::Package;
pub use packages::drone_photos::{
    Cameras as PhotoCameras, PhotosAlone, expected_deviation, read_alone as read_photos,
};
pub use packages::pose_covariance::PoseCovariance;
pub use packages::reconstruction::{
    ImageUnit, MeasuredPosition, Observation, Origin, PosedPhoto, Project, Reconstruction, Sizes,
};
pub use photos::photos_below::PhotosBelow;
pub use poses::poses_csv::{PoseLine, PosesFile};
pub use poses::position_list::{
    ControlPoints, KnownPlaces, NamedPosition, PositionList, control_list_text,
    positions_of_photos, read_control_points, read_known_places, read_positions,
};
pub use poses::trajectory::TrajectoryFormat;
pub use read::{
    no_surface_but_places, read_camera, read_camera_mount, read_cloud, read_cloud_bytes,
    read_cloud_sample, read_poses, read_project, read_trajectory,
};
pub use tables::effort_table::{effort_table, read_effort_table};
pub use tables::grouped_values::{GroupedValues, Groups, grouped_values, read_grouped_values};
pub use tables::places::{places, read_places, typed_places};
pub use tables::size_distributions::{
    DistributionColumns, PointWeights, SizesRead, read_point_weights, read_size_distributions,
    read_sizes, size_distributions, without_options,
};
pub use tables::table::{NumberRepairs, Row, Table, may_be_thousands};
