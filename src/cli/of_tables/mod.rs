//! Commands that need no flight: tables of size distributions, of values in groups, of times.

pub(super) mod anova;
mod distribution_arguments;
pub(super) mod effort;
pub(super) mod psd;
pub(super) mod psd_compare;
mod psd_fit;
