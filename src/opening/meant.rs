//! What is meant by a folder that holds no flight itself: the one below it, or a choice.

use std::path::{Path, PathBuf};

use crate::formats::{Candidate, Kind, Package, candidates, detect, is_of_photos};

/// The same paths, but for each folder above a single flight or reconstruction that one. Beside others a folder of
/// pictures is that of their photos, whatever lies in its folders.
///
/// # Errors
/// With the flights of the first folder that holds several, one or two levels down or in itself: the
/// choice is a person's.
pub fn meant_by(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Vec<Candidate>> {
    let meant = paths.iter().map(|path| {
        if !path.is_dir() || detect(path).is_ok() {
            return Ok(path.clone());
        }
        if let Some(photos) = of_their_photos(path, paths) {
            return Ok(photos);
        }
        let mut found = candidates(path);
        match found.len() {
            // `detect` says what is wrong with it.
            0 => Ok(path.clone()),
            1 => Ok(found.remove(0).path),
            _ => Err(found),
        }
    });
    meant.collect()
}

/// Whether a folder that was named with others is that of their photos.
pub(crate) fn is_of_their_photos(folder: &Path, named: &[PathBuf]) -> bool {
    of_their_photos(folder, named).is_some_and(|photos| photos == folder)
}

/// The folder of their photos that is meant by one that was named with others: itself where photos lie in it, or, beside a flight, the one
/// right above all folders of photos (a card's DCIM), where nothing else lies in its folders.
fn of_their_photos(folder: &Path, named: &[PathBuf]) -> Option<PathBuf> {
    let is_flight = |path: &PathBuf| match detect(path) {
        Ok(Kind::Flight(_)) => true,
        Ok(Kind::Reconstruction(package, _)) => package != Package::Photos,
        _ => false,
    };
    if named.len() < 2 {
        return None;
    }
    if is_of_photos(folder) {
        return Some(folder.to_owned());
    }
    if !named.iter().any(is_flight) {
        return None;
    }
    let found = candidates(folder);
    let above = found.first()?.path.parent()?;
    let is_one =
        |one: &Candidate| one.package == Some(Package::Photos) && one.path.parent() == Some(above);
    found.iter().all(is_one).then(|| above.to_owned())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::Dropped;

    /// A folder of screenshots above a flight stands for the flight; dropped with one, for its photos.
    #[test]
    fn pictures_above_a_flight_are_photos_only_beside_one() {
        let folder = tempfile::tempdir().unwrap();
        let flight = folder.path().join("may/flight.toml");
        fs::create_dir(folder.path().join("may")).unwrap();
        fs::write(&flight, "format = 1\n").unwrap();
        fs::write(folder.path().join("Screenshot 1.png"), "x").unwrap();
        let root = folder.path().to_owned();
        let meant = |paths: &[PathBuf]| meant_by(paths).unwrap();
        assert_eq!(
            meant(std::slice::from_ref(&root)),
            std::slice::from_ref(&flight)
        );
        let both = [flight.clone(), root.clone()];
        assert_eq!(meant(&both), both);
        let dropped = Dropped::sort(&both).unwrap();
        assert_eq!(dropped.flight, Some(flight));
        assert_eq!(dropped.options.photos, Some(root));
    }

    /// Photos in two folders are a choice of two flights, and beside a flight its photos.
    #[test]
    fn folders_of_photos_beside_a_flight_are_its_photos() {
        let folder = tempfile::tempdir().unwrap();
        let (flight, cloud) = (folder.path().join("f.toml"), folder.path().join("c.ply"));
        fs::write(&flight, "format = 1\n").unwrap();
        fs::write(&cloud, "ply\n").unwrap();
        let photos = folder.path().join("Fotos");
        for within in ["sub1", "sub2"] {
            fs::create_dir_all(photos.join(within)).unwrap();
            fs::write(photos.join(within).join("1.jpg"), "x").unwrap();
        }
        let both = [flight, photos.clone()];
        assert_eq!(meant_by(&both).unwrap(), both);
        let dropped = Dropped::sort(&both).unwrap();
        assert_eq!(dropped.options.photos.as_ref(), Some(&photos));
        assert_eq!(meant_by(&[cloud, photos.clone()]).unwrap_err().len(), 2);
        assert_eq!(meant_by(&[photos]).unwrap_err().len(), 2);
    }

    /// A card has its folders of photos in its DCIM: that is the folder of the photos, and no choice of flights.
    #[test]
    fn a_card_beside_a_flight_has_its_photos() {
        let folder = tempfile::tempdir().unwrap();
        let flight = folder.path().join("f.toml");
        fs::write(&flight, "format = 1\n").unwrap();
        let card = folder.path().join("card");
        let add = |within: &str| {
            fs::create_dir_all(card.join(within)).unwrap();
            fs::write(card.join(within).join("1.jpg"), "x").unwrap();
        };
        add("DCIM/100MEDIA");
        add("DCIM/101MEDIA");
        let meant = meant_by(&[flight.clone(), card.clone()]).unwrap();
        assert_eq!(meant, [flight.clone(), card.join("DCIM")]);
        let dropped = Dropped::sort(&meant).unwrap();
        assert_eq!(dropped.flight.as_ref(), Some(&flight));
        assert_eq!(dropped.options.photos, Some(card.join("DCIM")));
        assert_eq!(meant_by(std::slice::from_ref(&card)).unwrap_err().len(), 2);
        // Photos in folders of different ones are as many flights.
        add("other/100MEDIA");
        assert_eq!(meant_by(&[flight, card]).unwrap_err().len(), 3);
    }
}
