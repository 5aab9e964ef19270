//! Looks up what speaks against the scales of a flight's photos, outside of the flight's own numbers:
//! where they stand, what their files say of themselves, whose size nobody has seen. Reviews are made of it, and every front
//! end asks here; what the photos show is looked at in [`crate::pixels`].

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use crate::fault::first_names;
use crate::flight::{Doubt, Evidence, Flight, LookedUp, PhotoFileState};
use crate::photo_checks::photo_checks;
use crate::photo_files::PhotoFile;
use crate::photo_places::Finding;

/// Looks up what the files' headers and the places of the photos say; `files` are parallel to the
/// flight's photos. No photo is decoded: for that see [`crate::compare_pixels`].
pub fn look_up(flight: &Flight, files: &[PhotoFile]) -> LookedUp {
    let parts = flight.parts();
    let mut evidence: Vec<Evidence> = files
        .iter()
        .map(|file| Evidence {
            file: file.state.clone(),
            ..Evidence::default()
        })
        .collect();
    let mut warnings = Vec::new();
    if !parts.unit_known {
        warnings.push(Doubt::UnitUnknown.to_string());
    }
    let of_unit = parts.unit_doubt();
    warnings.extend(of_unit.iter().map(Doubt::to_string));
    // What was read has been said where it was read.
    let of_all: Vec<Doubt> = of_unit
        .into_iter()
        .chain(parts.as_read.doubts.clone())
        .collect();
    for evidence in &mut evidence {
        evidence.doubts.clone_from(&of_all);
    }
    let (of_files, metadata) = photo_checks(flight, files);
    if metadata.turned > 0 {
        warnings.push(format!(
            "viewers turn {} of {} photos (their EXIF Orientation): top, bottom, left and right are those of the pixels as they are stored, and of an \
             exported photo in every viewer",
            metadata.turned, metadata.looked_at
        ));
    }
    let (of_single, of_files): (Vec<_>, Vec<_>) = of_files
        .into_iter()
        .partition(|(doubt, _)| matches!(doubt, Doubt::OtherPlace { usual: Some(_), .. }));
    let of_photos = parts.as_read.of_photos.iter().cloned();
    let of_photos = of_photos
        .chain(shared_files(flight, files))
        .chain(each_photo(of_single));
    let of_photos: Vec<(usize, Doubt)> = of_photos.collect();
    warnings.extend(in_words(flight, &of_photos));
    warnings.extend(doubt_sizes(flight, files, &mut evidence));
    let placement = flight.placement();
    warnings.extend(placement.warnings(flight));
    let of_places = placement.doubts(parts.unit_known.then_some(parts.unit));
    warnings.extend(of_files.iter().map(|(doubt, _)| doubt.to_string()));
    let of_files = each_photo(of_files);
    for (photo, doubt) in of_photos.into_iter().chain(of_places).chain(of_files) {
        if let Some(evidence) = evidence.get_mut(photo) {
            evidence.doubts.push(doubt);
        }
    }
    LookedUp {
        evidence,
        warnings,
        metadata,
    }
}

/// Findings, a photo each.
fn each_photo(findings: Vec<Finding>) -> impl Iterator<Item = (usize, Doubt)> {
    let of_all = |(doubt, photos): Finding| {
        let each = photos.into_iter();
        each.map(move |photo| (photo, doubt.clone()))
    };
    findings.into_iter().flat_map(of_all)
}

/// What speaks against single photos, the same of many in a sentence.
fn in_words(flight: &Flight, of_photos: &[(usize, Doubt)]) -> Vec<String> {
    let photos = &flight.parts().photos;
    let said = of_photos
        .iter()
        .filter_map(|(photo, doubt)| Some((photos.get(*photo)?.name.as_str(), doubt)));
    let mut kinds: Vec<(&'static str, Vec<&str>, String)> = Vec::new();
    for (name, doubt) in said {
        match kinds.iter_mut().find(|(kind, ..)| *kind == doubt.kind()) {
            Some((_, names, _)) => names.push(name),
            None => kinds.push((doubt.kind(), vec![name], doubt.to_string())),
        }
    }
    let sentence = |(_, names, first): (&str, Vec<&str>, String)| match names.len() {
        1 => format!("{}: {first}", names[0]),
        count => format!("{count} photos ({}): {first}", first_names(names)),
    };
    kinds.into_iter().map(sentence).collect()
}

/// Photos that have their file in common: of those in two folders one's is missing, and the other's was found in its place. Whose
/// name with its folder is the file's is not doubted.
fn shared_files(flight: &Flight, files: &[PhotoFile]) -> Vec<(usize, Doubt)> {
    let photos = &flight.parts().photos;
    let mut of_path: BTreeMap<&Path, Vec<usize>> = BTreeMap::new();
    for (photo, file) in files.iter().enumerate().take(photos.len()) {
        if let Some(path) = file.path.as_deref() {
            of_path.entry(path).or_default().push(photo);
        }
    }
    let mut doubts = Vec::new();
    for (path, sharing) in of_path {
        let is_its = |photo: usize| path.ends_with(photos[photo].name.replace('\\', "/"));
        for &photo in &sharing {
            let is_own = is_its(photo);
            let mut others = sharing.iter().filter(|other| **other != photo);
            if let Some(&other) = others.find(|other| !is_own || is_its(**other)) {
                let other = photos[other].name.clone();
                doubts.push((photo, Doubt::SameFile { other }));
            }
        }
    }
    doubts
}

/// Doubts scales for images that nobody may have: of photos whose files are not there, while the
/// package names another size for them or is known to solve on reduced ones.
fn doubt_sizes(flight: &Flight, files: &[PhotoFile], evidence: &mut [Evidence]) -> Vec<String> {
    let photos = &flight.parts().photos;
    let found = photos.iter().zip(files).filter(|(photo, file)| {
        let camera = flight.camera(photo);
        let (width, height) = (camera.width, camera.height);
        file.state == PhotoFileState::Found { width, height }
    });
    let fitted: HashSet<usize> = found.map(|(photo, _)| photo.camera).collect();
    let mut warnings = Vec::new();
    let mut unknown = Vec::new();
    for ((photo, file), evidence) in photos.iter().zip(files).zip(evidence) {
        let camera = flight.camera(photo);
        let size = (camera.width, camera.height);
        if !matches!(
            file.state,
            PhotoFileState::Missing | PhotoFileState::NotNamed
        ) {
            continue;
        }
        let original = file.named_size.filter(|named| *named != size);
        // Of a camera that was fitted to other photos' files only this photo's own size is not known.
        let is_fitted = fitted.contains(&photo.camera);
        if original.is_none() && (is_fitted || !file.may_be_reduced) {
            unknown.push(size);
            continue;
        }
        let doubt = Doubt::ReducedPhotos { size, original };
        let said = doubt.to_string();
        if !warnings.contains(&said) {
            warnings.push(said);
        }
        evidence.doubts.push(doubt);
    }
    if let Some((width, height)) = unknown.first() {
        warnings.push(format!(
            "the size of {} of {} photos is not known, for their files are not: their scales are for images of the size of their camera ({width} x {height} px{})",
            unknown.len(),
            photos.len(),
            match unknown.iter().all(|size| *size == (*width, *height)) {
                true => "",
                false => ", ...",
            }
        ));
    }
    warnings
}
