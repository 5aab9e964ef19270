//! How the files of one photo are called.

/// The files of one photo below the exported folder, with slashes.
#[derive(Debug, Clone)]
pub(super) struct PhotoNames {
    pub photo: String,
    pub overlay: String,
    pub thumbnail: String,
    /// Where something is left out of the analysis.
    pub mask: Option<String>,
    /// Where it is asked for: the photo seen squarely, and its world file.
    pub rectified: Option<[String; 2]>,
}

impl PhotoNames {
    pub(super) fn all(&self) -> Vec<String> {
        let pictures = [&self.photo, &self.overlay, &self.thumbnail].into_iter();
        let rectified = self.rectified.iter().flatten();
        pictures
            .chain(&self.mask)
            .chain(rectified)
            .cloned()
            .collect()
    }
}
