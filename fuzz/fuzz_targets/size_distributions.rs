#![no_main]
//! Size distributions in every layout: a file's bytes, then the same behind a good header of each.

use std::path::Path;

use fragscale::formats::{DistributionColumns, FileError, size_distributions, text_from_bytes};

const HEADERS: [&str; 5] = [
    "",
    "size_mm,passing,photo\n",
    "size;sieve;point cloud/1\n",
    "photo\t10 mm\t20 mm\n",
    "label,D10,D50,D90\n",
];

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = text_from_bytes(bytes) else {
        return;
    };
    for header in HEADERS {
        let read = size_distributions(&format!("{header}{text}"), &DistributionColumns::default());
        let lines = match read {
            Ok((_, warnings)) => warnings,
            Err(fault) => vec![FileError::new(Path::new("a.csv"), fault).to_string()],
        };
        assert!(lines.iter().all(|line| !line.contains('\n')), "{lines:?}");
    }
});
