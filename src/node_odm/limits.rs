//! How long is waited, and how much is taken.

use std::time::Duration;

/// Limits of a run on a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// How long nothing may move on a line.
    pub idle: Duration,
    /// The same while a node puts all photos in their place.
    pub commit: Duration,
    /// How long a node that does not answer is asked again once it has a task of ours.
    pub give_up: Duration,
    /// The shortest and the longest time between two questions how far it is.
    pub shortest_pause: Duration,
    /// See `shortest_pause`.
    pub longest_pause: Duration,
    /// The most bytes that a result may have.
    pub download: u64,
    /// The most bytes that come out of it.
    pub unpacked: u64,
    /// How many files are sent at once.
    pub at_once: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            idle: Duration::from_secs(60),
            // As long as NodeODM allows itself.
            commit: Duration::from_mins(20),
            give_up: Duration::from_mins(10),
            shortest_pause: Duration::from_millis(500),
            longest_pause: Duration::from_secs(10),
            download: 100 << 30,
            unpacked: 200 << 30,
            at_once: 4,
        }
    }
}

impl Limits {
    /// The same for a node that is given up after so many minutes without an answer.
    #[must_use]
    pub fn giving_up_after(self, minutes: f64) -> Self {
        let minutes = if minutes.is_finite() { minutes } else { 0.0 };
        // A year is for ever, and is no overflow.
        let give_up = Duration::from_secs_f64(minutes.clamp(0.0, 525_600.0) * 60.0);
        Self {
            give_up,
            idle: self.idle.min(give_up),
            commit: self.commit.min(give_up),
            longest_pause: self.longest_pause.min(give_up),
            shortest_pause: self.shortest_pause.min(give_up),
            ..self
        }
    }
}
