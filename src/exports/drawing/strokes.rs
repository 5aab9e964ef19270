//! What tells points and lines apart beside their colour.

/// The shape of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// A disc.
    Circle,
    /// A square on its side.
    Square,
    /// A triangle on its side.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// A triangle on its corner.
    TriangleDown,
    /// Two strokes from corner to corner.
    Cross,
}

/// The pattern of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Without gaps.
    Solid,
    /// Long strokes.
    Long,
    /// Short strokes.
    Short,
    /// A long and a short stroke in turn.
    DashDot,
}

impl Dash {
    /// Lengths of stroke and gap in turn, in widths of the line; empty without gaps.
    pub fn pattern(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Long => &[6.0, 3.0],
            Self::Short => &[2.5, 2.5],
            Self::DashDot => &[6.0, 2.5, 1.5, 2.5],
        }
    }
}
