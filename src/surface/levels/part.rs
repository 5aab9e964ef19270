//! The part of a cloud that a node and all below it hold, and what the node takes of it.

use std::ops::Range;

use super::{GROUPS, LEAF};
use crate::surface::sites::{Cells, Sites};

/// A part of the sites.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Part {
    /// Those in a block of cells.
    Block(Cells),
    /// Some of one cell that has too many of them.
    Run(Range<usize>),
}

impl Part {
    /// All sites.
    pub(super) fn whole(sites: &Sites) -> Self {
        let (columns, rows) = sites.grid_size();
        Self::Block(Cells {
            columns: 0..columns,
            rows: 0..rows,
        })
    }

    /// The indices of its sites, in ranges.
    pub(super) fn ranges(&self, sites: &Sites) -> impl Iterator<Item = Range<usize>> {
        let (block, run) = match self {
            Self::Block(cells) => (Some(cells), None),
            Self::Run(range) => (None, Some(range.clone())),
        };
        let of_block = block.map(|cells| sites.ranges_of(cells));
        of_block.into_iter().flatten().chain(run)
    }

    /// How many sites it has.
    pub(super) fn len(&self, sites: &Sites) -> usize {
        self.ranges(sites).map(|range| range.len()).sum()
    }

    /// Cuts it into parts that are less, those without a site left out.
    pub(super) fn split(&self, sites: &Sites) -> Vec<Self> {
        let halves = |range: &Range<usize>| {
            let middle = range.start + range.len() / 2;
            [range.start..middle, middle..range.end]
        };
        let parts: Vec<Self> = match self {
            Self::Block(cells) if cells.columns.len() * cells.rows.len() == 1 => {
                let run = sites.ranges_of(cells).next().unwrap_or_default();
                Self::Run(run).split(sites)
            }
            Self::Block(cells) => {
                // A strip is cut into shorter strips.
                let (columns, rows) = (cells.columns.len(), cells.rows.len());
                let columns = match columns * 2 > rows {
                    true => halves(&cells.columns).to_vec(),
                    false => vec![cells.columns.clone()],
                };
                let rows = match rows * 2 > cells.columns.len() {
                    true => halves(&cells.rows).to_vec(),
                    false => vec![cells.rows.clone()],
                };
                let blocks = rows.iter().flat_map(|rows| {
                    columns.iter().map(|columns| {
                        Self::Block(Cells {
                            columns: columns.clone(),
                            rows: rows.clone(),
                        })
                    })
                });
                blocks.collect()
            }
            Self::Run(run) => halves(run).into_iter().map(Self::Run).collect(),
        };
        let mut parts = parts;
        parts.retain(|part| part.len(sites) > 0);
        parts
    }

    /// How many sites a node and those above it have of this part when it is an inner one, about: as many
    /// as there are groups with sites.
    pub(super) fn groups(&self, sites: &Sites) -> usize {
        match self {
            Self::Block(cells) => {
                let groups = Groups::of(cells);
                let with_sites = groups.all().filter(|group| {
                    let mut ranges = sites.ranges_of(group);
                    ranges.any(|range| !range.is_empty())
                });
                with_sites.count() * groups.each
            }
            Self::Run(run) => run.len().min(LEAF / 2),
        }
    }

    /// Takes one site from each group that has sites and of which none was taken; of few, full groups more
    /// than one.
    pub(super) fn pick(&self, sites: &Sites, is_picked: &mut Picked, picked: &mut Vec<u32>) {
        match self {
            Self::Block(cells) => {
                let groups = Groups::of(cells);
                for group in groups.all() {
                    if groups.each == 1 && is_picked.any(sites.ranges_of(&group)) {
                        continue;
                    }
                    if let Some(range) = middle(sites, &group) {
                        take_evenly(range, groups.each, is_picked, picked);
                    }
                }
            }
            Self::Run(run) => take_evenly(run.clone(), LEAF / 2, is_picked, picked),
        }
    }
}

/// The groups of cells of a block.
struct Groups {
    columns: Vec<Range<usize>>,
    rows: Vec<Range<usize>>,
    /// How many sites are taken from each: more than one where cells are few and full.
    each: usize,
}

impl Groups {
    fn of(cells: &Cells) -> Self {
        let cut = |range: &Range<usize>| -> Vec<Range<usize>> {
            let groups = range.len().min(GROUPS);
            let at = |group: usize| range.start + range.len() * group / groups.max(1);
            (0..groups).map(|group| at(group)..at(group + 1)).collect()
        };
        let (columns, rows) = (cut(&cells.columns), cut(&cells.rows));
        let each = (GROUPS * GROUPS / (columns.len() * rows.len()).max(1)).max(1);
        Self {
            columns,
            rows,
            each,
        }
    }

    fn all(&self) -> impl Iterator<Item = Cells> {
        self.rows.iter().flat_map(|rows| {
            self.columns.iter().map(|columns| Cells {
                columns: columns.clone(),
                rows: rows.clone(),
            })
        })
    }
}

/// The sites of that row of a group which is nearest to its middle among those that have any.
fn middle(sites: &Sites, group: &Cells) -> Option<Range<usize>> {
    let rows = group.rows.clone();
    let half = rows.start + rows.len() / 2;
    let outward = (half..rows.end).map(Some).zip(
        (rows.start..half)
            .rev()
            .map(Some)
            .chain(std::iter::repeat(None)),
    );
    let in_order = outward
        .flat_map(|(after, before)| [after, before])
        .flatten();
    in_order
        .filter_map(|row| {
            let row = Cells {
                columns: group.columns.clone(),
                rows: row..row + 1,
            };
            sites.ranges_of(&row).next()
        })
        .find(|range| !range.is_empty())
}

/// Takes about `most` of a range's sites that are not taken yet, evenly spread.
fn take_evenly(range: Range<usize>, most: usize, is_picked: &mut Picked, picked: &mut Vec<u32>) {
    let count = most.min(range.len());
    for i in 0..count {
        // In the middle of each of so many pieces.
        let site = range.start + (2 * i + 1) * range.len() / (2 * count);
        if !is_picked.has(site)
            && let Ok(index) = u32::try_from(site)
        {
            is_picked.add(site);
            picked.push(index);
        }
    }
}

/// A set of sites.
#[derive(Debug, Clone)]
pub(super) struct Picked(Vec<u64>);

impl Picked {
    /// None of `count` sites.
    pub(super) fn none(count: usize) -> Self {
        Self(vec![0; count.div_ceil(64)])
    }

    pub(super) fn has(&self, site: usize) -> bool {
        self.0[site / 64] >> (site % 64) & 1 == 1
    }

    fn add(&mut self, site: usize) {
        self.0[site / 64] |= 1 << (site % 64);
    }

    /// How many sites of ranges are in it.
    pub(super) fn count(&self, ranges: impl Iterator<Item = Range<usize>>) -> usize {
        let words = ranges.flat_map(|range| self.words(range));
        words.map(|word| word.count_ones() as usize).sum()
    }

    /// Whether any site of ranges is in it.
    fn any(&self, mut ranges: impl Iterator<Item = Range<usize>>) -> bool {
        ranges.any(|range| self.words(range).any(|word| word != 0))
    }

    /// The words of a range of sites, without the bits of others.
    fn words(&self, range: Range<usize>) -> impl Iterator<Item = u64> {
        let words = match range.is_empty() {
            true => 0..0,
            false => range.start / 64..(range.end - 1) / 64 + 1,
        };
        words.map(move |word| {
            let first = word * 64;
            let below = range.start.saturating_sub(first);
            let above = (first + 64).saturating_sub(range.end);
            self.0[word] & (u64::MAX << below) & (u64::MAX >> above)
        })
    }
}
