//! What is to be said of several files that one command writes.

use std::path::Path;

/// What is to be said of files, each sentence once: of several files behind the names of those that it is true of.
pub(super) fn notes_of_files(notes: Vec<(&Path, Vec<String>)>) -> Vec<String> {
    let is_one = notes.len() == 1;
    let mut said: Vec<(String, Vec<String>)> = Vec::new();
    for (path, notes) in notes {
        let file = path.display().to_string();
        for note in notes {
            match said.iter_mut().find(|(known, _)| *known == note) {
                Some((_, files)) => files.push(file.clone()),
                None => said.push((note, vec![file.clone()])),
            }
        }
    }
    let said = said.into_iter().map(|(note, files)| match is_one {
        true => note,
        false => format!("{}: {note}", files.join(", ")),
    });
    said.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_names_the_files_that_it_is_true_of() {
        let say = |words: &[&str]| {
            let words = words.iter().map(|word| (*word).to_owned());
            words.collect::<Vec<String>>()
        };
        let (plan, csv) = (Path::new("a.plan"), Path::new("a.csv"));
        let notes = vec![
            (plan, say(&["no radio", "look"])),
            (csv, say(&["no fences", "no radio"])),
        ];
        let said = notes_of_files(notes);
        let wanted = [
            "a.plan, a.csv: no radio",
            "a.plan: look",
            "a.csv: no fences",
        ];
        assert_eq!(said, wanted);
        assert_eq!(notes_of_files(vec![(csv, say(&["look"]))]), ["look"]);
    }
}
