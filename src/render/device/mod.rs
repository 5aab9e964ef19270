//! The graphics device: asking for it, making pipelines on it, computing with it, reading pictures back.

pub(crate) mod compute;
pub(crate) mod gpu;
pub(crate) mod pipeline;
pub(crate) mod readback;
