//! What cumulus3d does when something goes wrong: its errors are in Korean and its asserts panic.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::fault::Fault;

/// What cumulus3d says went wrong; its own words are not the user's.
pub(crate) fn failed(doing: &str) -> Fault {
    let what = format!("{doing} failed");
    Fault::new(
        what,
        "leave out photos of other things, or report this with the photos",
    )
}

/// A panic inside of cumulus3d as a fault.
///
/// # Errors
/// Those of `work`, and where it panics.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(failed("the reconstruction")))
}
