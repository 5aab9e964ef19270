//! Size distributions as a table: what Split-Desktop's results, a sieve's protocol or a spreadsheet
//! give. Cumulative percent passing, in one of four layouts.

mod long;

use std::path::Path;

use super::input::FileError;
use super::table::{Table, read_bounded};
use crate::fault::Fault;
use crate::fragmentation::DistributionSet;
use crate::units::LengthUnit;

/// Which columns hold what. What is not named is found by its name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DistributionColumns {
    /// Sizes. Named with `passing` the table has one line a point.
    pub size: Option<String>,
    /// Cumulative percent passing.
    pub passing: Option<String>,
    /// How it was measured.
    pub method: Option<String>,
    /// Which repetition.
    pub trial: Option<String>,
    /// Which photo.
    pub photo: Option<String>,
    /// Area or mass that the distribution stands for.
    pub weight: Option<String>,
    /// The unit of sizes, where the table does not state it.
    pub unit: Option<LengthUnit>,
}

/// Reads size distributions from the text of a table, with what was mended or passed over.
///
/// # Errors
/// With the line and the remedy.
pub fn size_distributions(
    text: &str,
    columns: &DistributionColumns,
) -> Result<(DistributionSet, Vec<String>), Fault> {
    long::read(&Table::read(text)?, columns)
}

/// Reads size distributions from a file; see [`size_distributions`].
///
/// # Errors
/// With the file, the line and the remedy.
pub fn read_size_distributions(
    path: &Path,
    columns: &DistributionColumns,
) -> Result<(DistributionSet, Vec<String>), FileError> {
    let text = read_bounded(path)?;
    size_distributions(&text, columns).map_err(|fault| FileError::new(path, fault))
}
