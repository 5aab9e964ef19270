//! The words of laboratories and instruments: what they call sizes, masses, percents, what passes and what stays.

/// What masses are called; here and below also in German, French, Spanish, Italian, Portuguese, Polish, Swedish, Turkish and Russian.
pub(super) const MASS_NAMES: &[&str] = &[
    "mass",
    "masses",
    "weight",
    "weights",
    "wt",
    "masse",
    "gewicht",
    "poids",
    "masa",
    "peso",
    "massa",
    "vikt",
    "kütle",
    "масса",
];

/// What percents are called.
pub(super) const PERCENT_NAMES: &[&str] = &[
    "percent",
    "pct",
    "percentage",
    "prozent",
    "procent",
    "yüzde",
    "процент",
];

/// What says that each sieve's share is meant, not the sum down to it.
pub(super) const EACH_NAMES: &[&str] = &[
    "each",
    "individual",
    "incremental",
    "differential",
    "partial",
    "parcial",
    "parziale",
    "simples",
];

/// What is within the name of a size of sieves or fragments.
pub(super) const SIZE_NAMES: &[&str] = &[
    "size",
    "opening",
    "aperture",
    "diameter",
    "siebweite",
    "siebgröße",
    "siebgrösse",
    "siebgroesse",
    "sieböffnung",
    "maschenweite",
    "korngröße",
    "korngrösse",
    "korngroesse",
    "ouverture",
    "tamis",
    "abertura",
    "apertura",
    "tamiz",
    "tamaño",
    "malla",
    "durchmesser",
    "diamètre",
    "diámetro",
    "diametro",
    "diâmetro",
    "setaccio",
    "vaglio",
    "peneira",
    "tamanho",
    "średnica",
    "rozmiar",
    "maskvidd",
    "kornstorlek",
    "açıklığı",
    "çapı",
    "размер",
    "диаметр",
];

/// Words that are names of sieves and sizes by themselves, and parts of other words.
pub(super) const SIZE_WORDS: &[&str] = &[
    "sieb",
    "maglia",
    "sito",
    "oczko",
    "sikt",
    "elek",
    "çap",
    "сито",
    "ячейка",
];

/// What is within the name of what passes.
pub(super) const PASSING_NAMES: &[&str] = &[
    "passing",
    "passed",
    "finer",
    "undersize",
    "passes",
    "durchgang",
    "passant",
    "pasante",
    "passando",
    "przechodz",
    "przesiew",
    "passerande",
    "passerat",
    "geçen",
    "проход",
    "прошло",
    "просев",
];

/// What is within the name of what stays on sieves.
pub(super) const RETAINED_NAMES: &[&str] = &[
    "retained",
    "oversize",
    "coarser",
    "residue",
    "rückstand",
    "rückständ",
    "rueckstand",
    "rueckstaend",
    "refus",
    "retenid",
    "retid",
    "trattenut",
    "pozostał",
    "kvarstannat",
    "kalan",
    "остаток",
];

/// What columns are called that say how it was measured.
pub(super) const METHOD_NAMES: &[&str] = &[
    "method",
    "methods",
    "technique",
    "source",
    "methode",
    "methoden",
    "verfahren",
    "messverfahren",
    "méthode",
    "método",
    "metodo",
    "metoda",
    "metod",
    "yöntem",
    "метод",
];

/// What columns are called that say which repetition it is; a laboratory's sample is one.
pub(super) const TRIAL_NAMES: &[&str] = &[
    "trial",
    "trials",
    "trialnumber",
    "trialno",
    "run",
    "repetition",
    "replicate",
    "repeat",
    "test",
    "versuch",
    "versuchnr",
    "versuchsnr",
    "probe",
    "probenr",
    "probennr",
    "wiederholung",
    "essai",
    "échantillon",
    "echantillon",
    "répétition",
    "ensayo",
    "muestra",
    "repetición",
    "repeticion",
    "prova",
    "campione",
    "ensaio",
    "amostra",
    "próba",
    "próbka",
    "försök",
    "prov",
    "deneme",
    "numune",
    "опыт",
    "проба",
];

/// What columns are called that say which photo it is, the surest first.
pub(super) const PHOTO_NAMES: &[&str] = &[
    "photo",
    "photos",
    "photoname",
    "photofile",
    "foto",
    "fotos",
    "image",
    "images",
    "imagename",
    "imagefile",
    "picture",
    "bild",
    "bilder",
    "imagen",
    "immagine",
    "imagem",
    "zdjęcie",
    "fotoğraf",
    "фото",
    "file",
    "filename",
    "label",
    "sample",
    "samplename",
    "name",
];

/// Whether a word says that percents or masses are cumulative.
pub(super) fn says_cumulative(word: &str) -> bool {
    ["cum", "kum", "acum", "накоп"]
        .iter()
        .any(|start| word.starts_with(start))
}

/// Whether words speak of mass.
pub(super) fn says_mass(words: &[String]) -> bool {
    let units = ["g", "kg", "t", "gram", "grams", "tonnes", "lb", "lbs"];
    let is_mass = |word: &str| MASS_NAMES.contains(&word) || units.contains(&word);
    words.iter().any(|word| is_mass(word))
}

/// Whether words speak of percents.
pub(super) fn says_percent(words: &[String]) -> bool {
    words
        .iter()
        .any(|word| PERCENT_NAMES.contains(&word.as_str()))
}

/// The words of a name in small letters: "PercentPassing", "percent_passing" and "% passing" are the
/// same; a quotation mark is inches.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut after_small = false;
    for c in name.chars() {
        let sign = match c {
            '%' => "percent",
            '"' | '″' => "in",
            _ => "",
        };
        if !sign.is_empty() {
            words.extend([sign.to_owned(), String::new()]);
        } else if c.is_alphanumeric() {
            if c.is_uppercase() && after_small {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.extend(c.to_lowercase());
            }
        } else {
            words.push(String::new());
        }
        after_small = c.is_lowercase();
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Whether a word speaks of sizes.
pub(super) fn says_size(word: &str) -> bool {
    let word = word.to_lowercase();
    let more = [
        "größe",
        "groesse",
        "taille",
        "dimensioni",
        "dimensione",
        "sieve",
        "siebe",
    ];
    (SIZE_NAMES.iter().chain(&more)).any(|part| word.contains(part))
        || SIZE_WORDS.contains(&word.as_str())
}

/// Whether a name says that something stays on sieves.
pub(super) fn says_retained(name: &str) -> bool {
    is_retained(&words(name))
}

pub(super) fn is_retained(words: &[String]) -> bool {
    let joined = words.concat();
    RETAINED_NAMES.iter().any(|part| joined.contains(part))
        || words.iter().any(|word| word == "ret")
}
