//! Letters that egui's own fonts lack (Chinese, Japanese, Korean, Arabic, ...), from a font of the system.
//!
//! egui asks for a letter once. Then a thread looks for the first font of a short list that has the letter, in
//! the folders where systems keep fonts, and the window shows it a moment later. Nothing is read before such
//! a letter is on the screen; where no font has it, a box stays.
//!
//! eframe's own finder of system fonts reads them while the window waits, and brings a database of all fonts;
//! here a list of a dozen is enough.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use ab_glyph::{Font, FontRef};
use egui::epaint::text::{FallbackRequest, FontInsert, FontPriority, InsertFontFamily};
use egui::{FontData, FontFamily};

/// Names of font files, the best first. Each has letters that those before it may lack.
const FONTS: &[&str] = &[
    // Linux.
    "NotoSans-Regular.ttf",
    "NotoSansCJK-Regular.ttc",
    "NotoSansCJKsc-Regular.otf",
    "NotoSansArabic-Regular.ttf",
    "NotoSansDevanagari-Regular.ttf",
    "NotoSansThai-Regular.ttf",
    "NotoSansHebrew-Regular.ttf",
    "DejaVuSans.ttf",
    "DroidSansFallbackFull.ttf",
    "wqy-microhei.ttc",
    "wqy-zenhei.ttc",
    // Windows.
    "segoeui.ttf",
    "msyh.ttc",
    "YuGothM.ttc",
    "malgun.ttf",
    "Nirmala.ttc",
    // macOS.
    "Arial Unicode.ttf",
    "Hiragino Sans GB.ttc",
    "AppleSDGothicNeo.ttc",
    "GeezaPro.ttc",
    "STHeiti Light.ttc",
];

/// Larger files are left alone: the fonts of the list have up to 25 MB.
const LARGEST: u64 = 64 << 20;

/// Folders within folders, no deeper than this.
const DEEPEST: usize = 4;

/// So many files and folders are looked at.
const MOST_ENTRIES: usize = 20_000;

/// Shows letters that egui lacks from fonts of the system from now on.
pub(crate) fn use_system_fonts(context: &egui::Context) {
    let asked = Arc::new(Mutex::new(Asked::default()));
    let woken = context.clone();
    context.add_font_provider(Arc::new(move |request: &FallbackRequest<'_>| {
        let letter = request.cluster.chars().next()?;
        let mut asked_now = asked.lock().unwrap_or_else(PoisonError::into_inner);
        if asked_now.nowhere.contains(&letter) {
            return None;
        }
        asked_now.letters.push(letter);
        if !asked_now.is_looking {
            // Without a thread boxes stay.
            let (asked, woken) = (Arc::clone(&asked), woken.clone());
            let look = std::thread::Builder::new().name("fonts".to_owned());
            asked_now.is_looking = look.spawn(move || look_for(&asked, &woken)).is_ok();
        }
        None
    }));
}

/// What egui lacks.
#[derive(Default)]
struct Asked {
    letters: Vec<char>,
    /// Whether a thread takes what is asked.
    is_looking: bool,
    /// Letters that no font has.
    nowhere: HashSet<char>,
}

/// Finds fonts until nothing is asked any more.
fn look_for(asked: &Mutex<Asked>, context: &egui::Context) {
    let mut files = font_files(&folders());
    loop {
        // What one frame lacks is asked letter by letter.
        std::thread::sleep(std::time::Duration::from_millis(30));
        let mut letters = {
            let mut asked = asked.lock().unwrap_or_else(PoisonError::into_inner);
            if asked.letters.is_empty() {
                asked.is_looking = false;
                return;
            }
            std::mem::take(&mut asked.letters)
        };
        for (path, data) in fonts_with(&files, &mut letters) {
            context.add_font(insert(&path, data));
            files.retain(|file| *file != path);
        }
        context.request_repaint();
        let mut asked = asked.lock().unwrap_or_else(PoisonError::into_inner);
        asked.nowhere.extend(letters);
    }
}

/// Where systems keep fonts.
fn folders() -> Vec<PathBuf> {
    let below = |variable: &str, folder: &str| {
        let base = std::env::var_os(variable).filter(|base| !base.is_empty());
        base.map(|base| Path::new(&base).join(folder))
    };
    let known = [
        "/usr/share/fonts",
        "/usr/local/share/fonts",
        "/System/Library/Fonts",
        "/Library/Fonts",
    ];
    let own = [
        below("HOME", ".local/share/fonts"),
        below("HOME", ".fonts"),
        below("HOME", "Library/Fonts"),
        below("WINDIR", "Fonts"),
        below("LOCALAPPDATA", "Microsoft/Windows/Fonts"),
    ];
    let known = known.into_iter().map(PathBuf::from);
    known.chain(own.into_iter().flatten()).collect()
}

/// The files of the list that are there, in its order.
fn font_files(folders: &[PathBuf]) -> Vec<PathBuf> {
    let mut found: Vec<(usize, PathBuf)> = Vec::new();
    let mut waiting: Vec<(PathBuf, usize)> =
        folders.iter().map(|folder| (folder.clone(), 0)).collect();
    let mut entries = 0;
    while let Some((folder, depth)) = waiting.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            entries += 1;
            if entries > MOST_ENTRIES {
                break;
            }
            let Ok(kind) = entry.file_type() else {
                continue;
            };
            let name = entry.file_name();
            let place = FONTS
                .iter()
                .position(|font| name.eq_ignore_ascii_case(font));
            if kind.is_dir() && depth < DEEPEST {
                waiting.push((entry.path(), depth + 1));
            } else if let Some(place) = place
                && !found.iter().any(|(known, _)| *known == place)
            {
                found.push((place, entry.path()));
            }
        }
    }
    found.sort();
    found.into_iter().map(|(_, path)| path).collect()
}

/// The fonts that have these letters: each file that has some that those before it lack. What no file has
/// stays in `letters`.
fn fonts_with(files: &[PathBuf], letters: &mut Vec<char>) -> Vec<(PathBuf, Vec<u8>)> {
    let mut fonts = Vec::new();
    for path in files {
        if letters.is_empty() {
            break;
        }
        let Some(data) = read(path) else {
            continue;
        };
        let before = letters.len();
        if let Ok(font) = FontRef::try_from_slice_and_index(&data, 0) {
            letters.retain(|&letter| font.glyph_id(letter).0 == 0);
        }
        if letters.len() < before {
            fonts.push((path.clone(), data));
        }
    }
    fonts
}

/// The bytes of a font file that is not too large.
fn read(path: &Path) -> Option<Vec<u8>> {
    let metadata = std::fs::metadata(path).ok()?;
    let fits = metadata.is_file() && metadata.len() <= LARGEST;
    fits.then(|| std::fs::read(path).ok()).flatten()
}

/// Behind egui's own fonts, for both families.
fn insert(path: &Path, data: Vec<u8>) -> FontInsert {
    let families = [FontFamily::Proportional, FontFamily::Monospace];
    FontInsert::new(
        &path.display().to_string(),
        FontData::from_owned(data),
        families
            .map(|family| InsertFontFamily {
                family,
                priority: FontPriority::Lowest,
            })
            .to_vec(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of fonts: one of egui's own under a name of the list, damaged ones, and one that is not on
    /// the list.
    fn fonts() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("truetype/dejavu");
        std::fs::create_dir_all(&below).unwrap();
        let definitions = egui::FontDefinitions::default();
        let ubuntu: &[u8] = (*definitions.font_data["Ubuntu-Light"].font).as_ref();
        std::fs::write(below.join("dejavusans.TTF"), ubuntu).unwrap();
        std::fs::write(below.join("Other.ttf"), ubuntu).unwrap();
        std::fs::write(folder.path().join("NotoSans-Regular.ttf"), b"no font").unwrap();
        std::fs::write(folder.path().join("msyh.ttc"), &ubuntu[..200]).unwrap();
        folder
    }

    #[test]
    fn the_font_that_has_the_letter_is_found() {
        let folder = fonts();
        let nowhere = folder.path().join("not there");
        let files = font_files(&[nowhere, folder.path().to_owned()]);
        let names: Vec<_> = files.iter().filter_map(|p| p.file_name()).collect();
        assert_eq!(
            names,
            ["NotoSans-Regular.ttf", "dejavusans.TTF", "msyh.ttc"]
        );
        // Ubuntu has Cyrillic letters, but no Chinese ones.
        let mut letters = vec!['ж', '爆'];
        let found = fonts_with(&files, &mut letters);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0, files[1]);
        assert_eq!(letters, ['爆']);
        assert!(fonts_with(&files, &mut letters).is_empty());
        assert!(fonts_with(&[], &mut letters).is_empty());
    }

    /// What egui lacks is asked for, and what is given is drawn with: a window whose only font has no
    /// Cyrillic letters gets them.
    #[test]
    fn egui_draws_with_what_was_found() {
        let folder = fonts();
        let context = egui::Context::default();
        let mut definitions = egui::FontDefinitions::default();
        // The font of signs alone.
        for fonts in definitions.families.values_mut() {
            fonts.retain(|name| name.contains("emoji"));
        }
        context.set_fonts(definitions);
        let width = || {
            let mut width = 0.0;
            for _ in 0..2 {
                let mut output = context.run_ui(egui::RawInput::default(), |ui| {
                    let font = egui::FontId::proportional(20.0);
                    let color = egui::Color32::WHITE;
                    let galley = ui.painter().layout_no_wrap("жжж".to_owned(), font, color);
                    width = galley.size().x;
                });
                output.textures_delta.clear();
            }
            width
        };
        let boxes = width();
        let files = font_files(&[folder.path().to_owned()]);
        for (path, data) in fonts_with(&files, &mut vec!['ж']) {
            context.add_font(insert(&path, data));
        }
        assert!((width() - boxes).abs() > 1.0, "other letters than before");
    }
}
