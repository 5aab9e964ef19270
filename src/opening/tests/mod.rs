//! What packages and recordings wrote, opened as a flight.

mod doubted;
mod drone_photos;
mod meshes;
mod metashape;
mod odm;
mod places;
mod ros_topics;
