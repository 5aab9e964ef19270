//! The engines by name: what an engineer chooses between.

use crate::colmap::Colmap;
use crate::embedded::Embedded;
use crate::engine::Engine;
use crate::fault::Fault;

/// What finds the poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EngineName {
    /// The program's own.
    #[default]
    Embedded,
    /// COLMAP, where it is installed.
    Colmap,
}

impl EngineName {
    /// All, the one first that is always there.
    pub const ALL: [Self; 2] = [Self::Embedded, Self::Colmap];

    /// Its name on the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Embedded => "embedded",
            Self::Colmap => "colmap",
        }
    }

    /// What speaks for it.
    pub fn explained(self) -> &'static str {
        match self {
            Self::Embedded => "The program's own: nothing to install",
            Self::Colmap => {
                "COLMAP, where `colmap` is on the path; without CUDA it takes several times as long. Its poses are \
                 adjusted with the photos' positions as the embedded engine's are"
            }
        }
    }

    /// The engine.
    ///
    /// # Errors
    /// Where it is not installed, or does not start.
    pub fn engine(self) -> Result<Box<dyn Engine>, Fault> {
        Ok(match self {
            Self::Embedded => Box::new(Embedded::default()),
            Self::Colmap => Box::new(Colmap::on_path()?),
        })
    }
}
