//! What she does on the page of the fragments, as data. Places are in pixels of the undistorted photo.

use std::path::PathBuf;

use glam::DVec2;

use super::EngineChoice;
use crate::command::Destination;
use crate::scale::ImageKind;

/// One thing to do on the page of the fragments.
#[derive(Debug, Clone, PartialEq)]
pub enum FragmentStep {
    /// Outlines the fragments of the selected photo, whatever is outlined there.
    Outline,
    /// Outlines all photos that are not outlined yet, on the screen or in files, one after the other.
    OutlineAll,
    /// Takes the outlines of the selected photo from a file of another tool, or a folder of them.
    Masks {
        /// The file or folder.
        path: PathBuf,
        /// Which photo they were outlined in; `None`: fragscale's own files in the undistorted one, all others as shot.
        of: Option<ImageKind>,
    },
    /// The engine that does.
    Engine(EngineChoice),
    /// Reads a network of hers that this file describes, which does from then on.
    Network(PathBuf),
    /// What the mouse does from now on; what was drawn halfway is forgotten.
    Tool(FragmentTool),
    /// Half the width of the brush, pixels.
    Brush(f64),
    /// The mouse was drawn along here with the tool.
    Stroke(Vec<DVec2>),
    /// A click with the tool.
    Click(DVec2),
    /// Ends the outline whose corners are clicked.
    Finish,
    /// Takes the last corner of it back.
    RemoveCorner,
    /// Takes all its corners back; the tool stays.
    RemoveCorners,
    /// Looks at this fragment, or at none.
    Select(Option<u32>),
    /// Looks at this fragment, brought into the middle.
    Show(u32),
    /// The selected fragment is none.
    Delete,
    /// The selected fragment is no rock: neither fragment nor fines.
    NoRock,
    /// The selected fragment is right as it is; on to the next doubtful one.
    IsRight,
    /// On to the most doubtful fragment behind the selected one.
    NextDoubtful,
    /// A larger region under the cursor.
    Coarser(DVec2),
    /// A smaller one.
    Finer(DVec2),
    /// Takes the photo's size distribution over to its page.
    TakeDistribution,
    /// Measures all photos that are outlined, together.
    MeasureAll,
    /// Takes the size distributions of all of them over to their page.
    TakeAllDistributions,
    /// Writes tables, report and outlines of all photos that are outlined into this folder.
    Export(Destination),
}

impl FragmentStep {
    /// Whether outlines become others by it.
    pub(super) fn changes_outlines(&self) -> bool {
        match self {
            Self::Outline
            | Self::OutlineAll
            | Self::Masks { .. }
            | Self::Stroke(_)
            | Self::Click(_)
            | Self::Finish
            | Self::Delete
            | Self::NoRock
            | Self::IsRight
            | Self::Coarser(_)
            | Self::Finer(_) => true,
            Self::Engine(_)
            | Self::Network(_)
            | Self::Tool(_)
            | Self::Brush(_)
            | Self::RemoveCorner
            | Self::RemoveCorners
            | Self::Select(_)
            | Self::Show(_)
            | Self::NextDoubtful
            | Self::TakeDistribution
            | Self::MeasureAll
            | Self::TakeAllDistributions
            | Self::Export(_) => false,
        }
    }
}

/// What the mouse does in the photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FragmentTool {
    /// Selects a fragment; dragging moves the photo.
    #[default]
    Select,
    /// A stroke through a fragment parts it.
    Split,
    /// A stroke joins what it touches.
    Merge,
    /// An outline is a new fragment.
    Outline,
    /// An outline is the selected fragment's new one.
    Redraw,
    /// A click lets a fragment grow where none is.
    Grow,
    /// What is brushed over is fines.
    Brush,
    /// What is outlined is no rock.
    Exclude,
    /// What is outlined and was no rock may be rock again.
    Include,
}

impl FragmentTool {
    /// Whether its outlines can be clicked corner by corner.
    pub fn outlines(self) -> bool {
        matches!(
            self,
            Self::Outline | Self::Redraw | Self::Exclude | Self::Include
        )
    }
}
