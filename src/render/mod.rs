//! wgpu: scene -> picture. Knows no egui, reads no file.
