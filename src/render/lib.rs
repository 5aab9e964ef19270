//! Pictures of a flight with wgpu: the same [`Renderer`] draws in the window and into files.
//!
//! Knows no egui and reads no file. World data come in f64 and leave it in `scene`, the one place
//! where f64 becomes f32, after the flight's local origin is subtracted. Each primitive has a file in
//! `primitives/` and a shader of the same name in `shaders/`.
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

mod device;
mod furniture;
mod primitives;
mod renderer;
mod scene;
mod show;
mod streamed;
mod surface_buffers;
mod view;

use fragscale_core::{
    camera, fault, flight, geometry, jobs, numbers, picture, plan, scale, surface, units,
};

pub use device::gpu::{Gpu, device_descriptor};
pub use fragscale_core::picture::viridis;
pub use furniture::flight_line::{Taken, flight_line};
pub use furniture::flown_lines::flown_lines;
pub use furniture::labels::{Label, Legend, ScaleBar};
pub use furniture::measured::MEASURED;
pub use furniture::photo_lines::SELECTED;
pub use furniture::plan_lines::{plan_areas, plan_photos, plan_way};
pub use primitives::mesh::MeshBuffers;
pub use primitives::points::CloudBuffers;
pub use primitives::surface::LargePhoto;
pub use renderer::{Aside, BesideCloud, Drawn, MOST_PIXELS, Renderer};
pub use scene::ground::drawn_ground;
pub use scene::photo_geometry::PhotoGeometry;
pub use scene::photo_image::PhotoImage;
pub use scene::{CloudGeometry, MeshGeometry, Normals};
pub use show::{Background, ColorBy, PhotoLook, PlannedLine, Scope, Show};
pub use streamed::{MEMORY as STREAMED_MEMORY, POINTS as STREAMED_POINTS};
pub use surface_buffers::{MOST_TRIANGULATED, Shapes, SurfaceBuffers};
pub use view::orbit::Orbit;
pub use view::{PhotoZoom, Projection, View};
