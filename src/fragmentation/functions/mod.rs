//! The functions that size distributions are fitted with.

mod gates_gaudin_schuhmann;
mod rosin_rammler;
mod swebrec;
mod swebrec5;

pub use gates_gaudin_schuhmann::{GatesGaudinSchuhmann, GatesGaudinSchuhmannError};
pub use rosin_rammler::{RosinRammler, RosinRammlerError};
pub use swebrec::{Swebrec, SwebrecError};
pub(crate) use swebrec5::ln_exp_m1;
pub use swebrec5::{Swebrec5, Swebrec5Error};

/// A family of functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Model {
    /// Three parameters: xmax, x50, b.
    #[default]
    Swebrec,
    /// Its extension with five: xmax, x50, b, a, c.
    Swebrec5,
    /// x50, n.
    RosinRammler,
    /// xmax, m.
    GatesGaudinSchuhmann,
}

impl Model {
    /// All, in the order in which people are offered them.
    pub const ALL: [Self; 4] = [
        Self::Swebrec,
        Self::Swebrec5,
        Self::RosinRammler,
        Self::GatesGaudinSchuhmann,
    ];

    /// Its name on the command line and in JSON.
    pub fn key(self) -> &'static str {
        match self {
            Self::Swebrec => "swebrec",
            Self::Swebrec5 => "swebrec5",
            Self::RosinRammler => "rosin-rammler",
            Self::GatesGaudinSchuhmann => "ggs",
        }
    }

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Swebrec => "Swebrec",
            Self::Swebrec5 => "extended Swebrec (5 parameters)",
            Self::RosinRammler => "Rosin-Rammler",
            Self::GatesGaudinSchuhmann => "Gates-Gaudin-Schuhmann",
        }
    }

    /// The names of its parameters, in the order of `Fit::parameters`.
    pub fn parameter_names(self) -> &'static [&'static str] {
        match self {
            Self::Swebrec => &["xmax", "x50", "b"],
            Self::Swebrec5 => &["xmax", "x50", "b", "a", "c"],
            Self::RosinRammler => &["x50", "n"],
            Self::GatesGaudinSchuhmann => &["xmax", "m"],
        }
    }
}

/// One function of a family.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curve {
    /// See [`Swebrec`].
    Swebrec(Swebrec),
    /// See [`Swebrec5`].
    Swebrec5(Swebrec5),
    /// See [`RosinRammler`].
    RosinRammler(RosinRammler),
    /// See [`GatesGaudinSchuhmann`].
    GatesGaudinSchuhmann(GatesGaudinSchuhmann),
}

impl Curve {
    /// The family that it is of.
    pub fn model(&self) -> Model {
        match self {
            Self::Swebrec(_) => Model::Swebrec,
            Self::Swebrec5(_) => Model::Swebrec5,
            Self::RosinRammler(_) => Model::RosinRammler,
            Self::GatesGaudinSchuhmann(_) => Model::GatesGaudinSchuhmann,
        }
    }

    /// Its parameters, in the order of `Model::parameter_names`.
    pub fn parameters(&self) -> Vec<f64> {
        match self {
            Self::Swebrec(curve) => vec![curve.xmax(), curve.x50(), curve.b()],
            Self::Swebrec5(curve) => {
                vec![curve.xmax(), curve.x50(), curve.b(), curve.a(), curve.c()]
            }
            Self::RosinRammler(curve) => vec![curve.x50(), curve.n()],
            Self::GatesGaudinSchuhmann(curve) => vec![curve.xmax(), curve.m()],
        }
    }

    /// Percent passing a sieve of opening `size`, 0 to 100.
    pub fn percent_passing(&self, size: f64) -> f64 {
        let share = match self {
            Self::Swebrec(curve) => curve.passing(size),
            Self::Swebrec5(curve) => curve.passing(size),
            Self::RosinRammler(curve) => curve.passing(size),
            Self::GatesGaudinSchuhmann(curve) => curve.passing(size),
        };
        100.0 * share
    }

    /// The size that a percent passes. 100 % passes the largest size, which Rosin-Rammler puts at
    /// infinity.
    pub fn size_at(&self, percent: f64) -> f64 {
        let share = percent / 100.0;
        match self {
            Self::Swebrec(curve) => curve.size_at(share),
            Self::Swebrec5(curve) => curve.size_at(share),
            Self::RosinRammler(curve) => curve.size_at(share),
            Self::GatesGaudinSchuhmann(curve) => curve.size_at(share),
        }
    }
}
