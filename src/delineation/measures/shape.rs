//! From what a photo shows of a fragment to the sieve opening that it passes.

/// How a sieve size follows from an outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SieveShape {
    /// As fragments of the simulated lab do, whose sieve sizes are known: see [`SieveShape::sieve_size`].
    #[default]
    Calibrated,
    /// The shorter side of the least rectangle: what lies flat passes a slot of it.
    Breadth,
    /// The diameter of the circle of its area.
    Circle,
}

/// Of the calibrated shape, by least squares of logarithms over visible outlines; see the log beside it.
const FACTOR: f64 = 0.88;
const OF_WIDTH: f64 = 1.04;

impl SieveShape {
    /// Names for the command line and files.
    pub const ALL: [(&'static str, Self); 3] = [
        ("calibrated", Self::Calibrated),
        ("breadth", Self::Breadth),
        ("circle", Self::Circle),
    ];

    /// The sieve size of an outline: the diameter of the circle of its area, its least width and the sides of
    /// its least rectangle, in one unit.
    pub fn sieve_size(self, diameter: f64, least_width: f64, rectangle: [f64; 2]) -> f64 {
        match self {
            Self::Calibrated => FACTOR * least_width.powf(OF_WIDTH) * diameter.powf(1.0 - OF_WIDTH),
            Self::Breadth => rectangle[1],
            Self::Circle => diameter,
        }
    }
}
