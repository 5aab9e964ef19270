//! Pictures of a flight with wgpu: the same [`Renderer`] draws in the window and into files.
//!
//! Knows no egui and reads no file. World data come in f64 and leave it in `scene`, the one place
//! where f64 becomes f32, after the flight's local origin is subtracted. Each primitive has a file
//! here and a shader of the same name in `shaders/`.
//!
//! A frame is drawn in passes, all with reverse-z depth (1 at the near plane, 0 at infinity):
//!
//! ```text
//! surface   mesh and points, with their colours           -> colour, depth
//! edl       relief from depth, over the background        -> colour
//! fill      footprints, draped where the depth says       -> colour
//! overlay   ground grid, photos on their image planes or in front of a look through a camera, lines
//! resolve   four samples become one pixel
//! ```

mod colormap;
mod cover;
mod edl;
mod fill;
mod frame;
mod furniture;
mod gpu;
mod images;
mod labels;
mod lines;
mod mesh;
mod orbit;
mod part;
mod passes;
mod photo_geometry;
mod photo_image;
mod photo_lines;
mod pipeline;
mod points;
mod readback;
mod renderer;
mod resolve;
mod scene;
mod shaders;
mod show;
mod sight;
mod surface;
mod targets;
mod tiles;
mod view;
mod words;

use fragscale_core::{camera, fault, geometry, numbers, picture, scale, units};

pub use colormap::viridis;
pub use gpu::{Gpu, device_descriptor};
pub use labels::{Label, Legend, ScaleBar};
pub use mesh::MeshBuffers;
pub use orbit::Orbit;
pub use photo_geometry::PhotoGeometry;
pub use photo_image::PhotoImage;
pub use points::CloudBuffers;
pub use renderer::{Drawn, MOST_PIXELS, Renderer};
pub use scene::{CloudGeometry, MeshGeometry, Normals};
pub use show::{Background, ColorBy, PhotoLook, Scope, Show};
pub use surface::LargePhoto;
pub use view::{Projection, View};
