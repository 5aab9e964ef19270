//! What a run takes away of earlier runs, in words.

use std::collections::BTreeMap;

use crate::numbers::counted;

/// Of each file or folder of earlier runs that is gone: of how many flights, and how many files.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TakenAway(BTreeMap<String, (usize, usize)>);

impl TakenAway {
    /// Counts what one flight took away: how many results, by the file or folder (with a slash) that they were or lay in.
    pub fn add(&mut self, of_flight: &BTreeMap<String, usize>) {
        for (kind, files) in of_flight {
            let (flights, all_files) = self.0.entry(kind.clone()).or_default();
            *flights += 1;
            *all_files += files;
        }
    }

    /// A line for each file or folder, with how many flights it was of.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(kind, &(flights, files))| {
            let files = match kind.ends_with('/') {
                true => format!(" ({})", counted(files, "file")),
                false => String::new(),
            };
            let flights = counted(flights, "flight");
            format!("taken away: {kind}{files} of {flights}, which an earlier run wrote and this one does not")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_file_and_folder_is_a_line_with_its_flights() {
        let mut away = TakenAway::default();
        assert_eq!(away.lines().count(), 0);
        let of = |kinds: &[(&str, usize)]| {
            let kinds = kinds.iter().map(|&(kind, files)| (kind.to_owned(), files));
            kinds.collect::<BTreeMap<String, usize>>()
        };
        away.add(&of(&[("check.txt", 1), ("fragments/", 9)]));
        away.add(&of(&[("check.txt", 1)]));
        let lines: Vec<String> = away.lines().collect();
        assert_eq!(
            lines,
            [
                "taken away: check.txt of 2 flights, which an earlier run wrote and this one does not",
                "taken away: fragments/ (9 files) of 1 flight, which an earlier run wrote and this one does not",
            ]
        );
    }
}
