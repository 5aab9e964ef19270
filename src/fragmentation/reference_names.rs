//! How the method is called that the others are held against, where nobody has chosen one: in the languages that tables are read in,
//! English, German, French, Spanish, Italian, Portuguese, Polish, Swedish, Turkish and Russian. Words in small letters.

/// A sieve, by the bare word.
const SIEVES: &[&str] = &[
    "sieve", "sieves", "sieb", "siebe", "tamis", "tamiz", "tamices", "criba", "cribas", "setaccio",
    "setacci", "vaglio", "vagli", "peneira", "peneiras", "sito", "sita", "sikt", "siktar", "elek",
    "elekler", "сито", "сита",
];

/// What is done with it.
const SIEVING: &[&str] = &[
    "sieving",
    "sieve analysis",
    "siebung",
    "siebanalyse",
    "tamisage",
    "criblage",
    "tamizado",
    "tamizaje",
    "cribado",
    "setacciatura",
    "vagliatura",
    "peneiramento",
    "przesiewanie",
    "analiza sitowa",
    "siktning",
    "siktanalys",
    "eleme",
    "elek analizi",
    "просеивание",
    "рассев",
    "ситовый анализ",
];

/// The reference itself.
const REFERENCES: &[&str] = &[
    "reference",
    "referenz",
    "référence",
    "referencia",
    "riferimento",
    "referência",
    "odniesienie",
    "referens",
    "referans",
    "эталон",
];

/// As this program calls the fragments of its own flights.
const KNOWN: &[&str] = &["known fragments"];

/// All of them, in the order in which they are looked for.
const CALLED: [&[&str]; 4] = [SIEVES, SIEVING, REFERENCES, KNOWN];

/// An example of each, as a sentence goes on behind "no method is called".
pub(super) const IN_WORDS: &str =
    "'sieve', 'sieving', 'reference' or 'known fragments', nor so in another language";

/// Whether a name is the bare word for a sieve, as a method is called by it, in any case of letters.
pub fn names_sieve(name: &str) -> bool {
    SIEVES.contains(&plain(name).as_str())
}

/// Whether a name is the bare word for sieving.
pub fn names_sieving(name: &str) -> bool {
    SIEVING.contains(&plain(name).as_str())
}

/// The method that is called as a reference is; the first of several that are called alike.
pub(super) fn called_reference(methods: &[String]) -> Option<&String> {
    CALLED.iter().find_map(|words| {
        let mut methods = methods.iter();
        methods.find(|method| words.contains(&plain(method).as_str()))
    })
}

/// A name in small letters, with one blank between its words.
fn plain(name: &str) -> String {
    let name = name.to_lowercase().replace('_', " ");
    name.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Words from dictionaries of these languages; that of a camera is none.
    #[test]
    fn sieves_in_ten_languages() {
        for name in [
            "Sieve", "SIEB", "tamis", "Tamiz", "setaccio", "peneira", "Sito", "sikt", "elek",
            "Сито",
        ] {
            assert!(names_sieve(name) && !names_sieving(name), "{name}");
        }
        for name in [
            "Sieve_analysis",
            "Siebung",
            "tamisage",
            "Cribado",
            "vagliatura",
            "peneiramento",
            "przesiewanie",
            "Siktning",
            "eleme",
            " Ситовый  анализ",
        ] {
            assert!(names_sieving(name) && !names_sieve(name), "{name}");
        }
        for name in ["", "Kamera", "Siebgröße", "Sieb (mm)", "sieve 1"] {
            assert!(!names_sieve(name) && !names_sieving(name), "{name}");
        }
    }

    /// What was sieved goes before what calls itself a reference.
    #[test]
    fn sieves_go_first() {
        let methods = ["Referenz", "Siebung", "Kamera", "tamis"].map(str::to_owned);
        for (methods, wanted) in [
            (&methods[..], Some("tamis")),
            (&methods[..3], Some("Siebung")),
            (&methods[..1], Some("Referenz")),
            (&methods[2..3], None),
        ] {
            let found = called_reference(methods);
            assert_eq!(found.map(String::as_str), wanted, "{methods:?}");
        }
    }
}
