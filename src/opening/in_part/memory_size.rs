//! Sizes of memory, as people write them and read them; what the machine has is one.

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// Half of the machine's memory, bytes: what may be used where nobody says how much.
pub fn half_of_the_machines() -> u64 {
    let kind = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(kind);
    match system.map_or(0, |system| system.total_memory()) / 2 {
        // It does not say: what machines have at least.
        0 => 4_000_000_000,
        half => half,
    }
}

/// Bytes of a size: "8GB", "500 MB", "1.5 GiB".
///
/// # Errors
/// In words, where it is none.
pub fn memory_size(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let factor = match text[digits.len()..].to_ascii_lowercase().as_str() {
        "kb" => 1e3,
        "mb" | "m" => 1e6,
        "gb" | "g" => 1e9,
        "tb" => 1e12,
        "kib" => 1024.0,
        "mib" => 1024.0 * 1024.0,
        "gib" => 1024.0 * 1024.0 * 1024.0,
        _ => f64::NAN,
    };
    let number: f64 = digits.trim().parse().unwrap_or(f64::NAN);
    let bytes = number * factor;
    match bytes > 0.0 && bytes < 1e18 {
        // Whole and positive.
        true => Ok(bytes as u64),
        false => Err("give a size with its unit, as 8GB or 500MB".to_owned()),
    }
}

/// A size for people, rounded up: "500 MB", "23 GB".
pub fn memory_in_words(bytes: u64) -> String {
    match bytes {
        0..1_000_000 => format!("{} kB", bytes.div_ceil(1000)),
        1_000_000..10_000_000_000 => format!("{} MB", bytes.div_ceil(1_000_000)),
        _ => format!("{} GB", bytes.div_ceil(1_000_000_000)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_a_unit() {
        for (text, size) in [
            ("8GB", 8_000_000_000),
            ("500 mb", 500_000_000),
            (" 1.5 GiB", 1_610_612_736),
            ("2g", 2_000_000_000),
        ] {
            assert_eq!(memory_size(text), Ok(size), "{text}");
        }
        for wrong in [
            "",
            "8",
            "GB",
            "-1GB",
            "8 parsecs",
            "nanGB",
            "infGB",
            "1TBB",
            "1e99TB",
        ] {
            assert!(memory_size(wrong).is_err(), "{wrong}");
        }
        assert!(half_of_the_machines() > 100_000_000);
    }

    #[test]
    fn sizes_are_said_rounded_up() {
        for (bytes, said) in [
            (5, "1 kB"),
            (10_000_001, "11 MB"),
            (8_000_000_000, "8000 MB"),
            (22_000_000_001, "23 GB"),
        ] {
            assert_eq!(memory_in_words(bytes), said);
        }
    }
}
