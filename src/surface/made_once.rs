//! What is made once, by whoever comes first, while the others make something else.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

/// A value that is made when somebody asks.
#[derive(Debug)]
pub(super) struct MadeOnce<T> {
    is_begun: AtomicBool,
    value: OnceLock<T>,
}

impl<T> Default for MadeOnce<T> {
    fn default() -> Self {
        Self {
            is_begun: AtomicBool::new(false),
            value: OnceLock::new(),
        }
    }
}

impl<T: Send + Sync> MadeOnce<T> {
    /// The value; waits where another thread is making it.
    pub(super) fn get(&self, make: impl FnOnce() -> T) -> &T {
        self.value.get_or_init(make)
    }

    /// Makes those of these values that nobody has begun, on all cores. Two photos want the same tiles in
    /// the same order: waiting for each other they would work as one.
    pub(super) fn make_all<'a, I: Sync>(
        items: &'a [I],
        of: impl Fn(&'a I) -> &'a Self + Sync,
        make: impl Fn(&'a I) -> T + Sync,
    ) where
        T: 'a,
    {
        items.par_iter().for_each(|item| {
            let this = of(item);
            if !this.is_begun.swap(true, Ordering::Relaxed) {
                this.get(|| make(item));
            }
        });
    }
}
