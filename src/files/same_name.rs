//! Whether two names of photos are the same one: macOS keeps letters and their accents apart in the names of files (Unicode's NFD),
//! other systems and packages together (NFC), and the eye sees no difference. Names are compared by what this file makes of them,
//! and written as they came.

use unicode_normalization::UnicodeNormalization;

use super::stem;

/// By what names are compared where the case of letters makes no difference: equal for names that are the same.
pub fn key(name: &str) -> String {
    match name.is_ascii() {
        // Nearly all are, and every file is held against every photo.
        true => name.to_ascii_lowercase(),
        false => name.to_lowercase().nfc().collect(),
    }
}

/// Whether both are the same name, the case of letters counted.
pub fn is_same(one: &str, other: &str) -> bool {
    one.nfc().eq(other.nfc())
}

/// Whether the names of two files are the same without folders and endings, the case of letters counted: how outlines name their photo.
pub fn is_same_stem(one: &str, other: &str) -> bool {
    is_same(stem(one), stem(other))
}

/// The other ways to spell a path, for systems that take each for another file.
pub fn other_spellings(path: &str) -> impl Iterator<Item = String> {
    let both: [String; 2] = [path.nfc().collect(), path.nfd().collect()];
    both.into_iter().filter(move |spelt| spelt != path)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// U+00C4 is U+0041 and U+0308 (UnicodeData.txt), the Angstrom sign U+212B the letter U+00C5.
    #[test]
    fn letters_and_accents_together_or_apart_are_one_name() {
        for (one, other) in [
            ("H\u{c4}NGE_1.JPG", "HA\u{308}NGE_1.JPG"),
            ("\u{212b}sen.jpg", "A\u{30a}sen.jpg"),
            ("plain.jpg", "plain.jpg"),
        ] {
            assert!(is_same(one, other) && is_same(other, one), "{one}");
            assert_eq!(key(one), key(other));
        }
        assert_eq!(key("HA\u{308}NGE_1.JPG"), "h\u{e4}nge_1.jpg");
        assert!(!is_same("H\u{c4}NGE.jpg", "HANGE.jpg"));
        assert!(!is_same("h\u{e4}nge.jpg", "H\u{c4}NGE.jpg"));
        assert!(is_same_stem("a/H\u{c4}NGE.JPG", "b\\HA\u{308}NGE.png"));
        assert!(!is_same_stem("a.b.jpg", "a.jpg"));
    }
}
