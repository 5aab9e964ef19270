//! What outlined a photo's fragments first, as a file keeps it.

use crate::engine::Habits;
use crate::engines::engine_called;

/// What outlined a photo's fragments first, before any correction.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outliner {
    /// As it is named in files.
    pub engine: String,
    /// `None` of people and other tools, and where nobody knows it any more.
    pub habits: Option<Habits>,
    /// How far the photo's edges are spread, pixels, where that is known.
    pub spread: Option<f64>,
}

impl Outliner {
    /// The same with what is known today of an engine that the program brings along, in a photo of that size.
    #[must_use]
    pub fn of_today(self, width: u32, height: u32) -> Self {
        let today = engine_called(&self.engine);
        let today = today.map(|engine| engine.habits(width, height));
        Self {
            habits: today.or(self.habits),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Classical, Engine, Learned};

    /// Of an engine that comes along it is this version that knows; of another one what was kept.
    #[test]
    fn what_is_known_today() {
        let kept = Some(Habits {
            sizes_off: 9.0,
            ..Classical.habits(10, 10)
        });
        let of = |engine: &str| Outliner {
            engine: engine.to_owned(),
            habits: kept,
            spread: Some(0.5),
        };
        assert_eq!(
            of("learned").of_today(10, 10).habits,
            Some(Learned.habits(10, 10))
        );
        assert_eq!(of("mine").of_today(10, 10), of("mine"));
        assert_eq!(of("masks").of_today(10, 10).habits, kept);
    }
}
